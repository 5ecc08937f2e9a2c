"""Rows of numbers: printed as a table, and closed by a verdict."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

Row = dict[str, "str | float | None"]


def print_rows(title: str, rows: Sequence[Row], names: Sequence[str] | None = None) -> None:
    """Print rows as aligned columns; `names` chooses the columns."""
    names = list(rows[0] if names is None else names)
    cells = [names, *([_cell(row[name]) for name in names] for row in rows)]
    widths = [max(len(line[i]) for line in cells) for i in range(len(names))]
    print(f"\n{title}")
    for line in cells:
        print("  ".join(text.rjust(width) for text, width in zip(line, widths, strict=True)))


def _cell(value: str | float | None) -> str:
    if isinstance(value, str):
        return value
    return "-" if value is None or value != value else f"{value:.4g}"


def verdict(numbers: Mapping[str, tuple[float, float]]) -> int:
    """Print each number beside the most that it may be; return 0 if all hold, 1 if not."""
    held = {name: abs(value) <= most for name, (value, most) in numbers.items()}
    print()
    for name, (value, most) in numbers.items():
        word = "holds" if held[name] else "FAILS"
        print(f"{word}: {name}: {value:.2g}, at most {most:g}")
    return int(not all(held.values()))
