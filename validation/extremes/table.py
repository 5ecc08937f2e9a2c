"""How far every input can be pushed, what breaks first, and what the user is told there.

Run ``python -m validation extremes``, with ``--quick`` for less than a minute, ``--json FILE`` to
keep the rows.
"""

from __future__ import annotations

import argparse
import textwrap
from collections.abc import Callable

from tqdm import tqdm

from validation.extremes import holding, sizes, spin
from validation.extremes.rows import Row
from validation.rows import write_json

GROUPS: dict[str, tuple[Callable[..., Row], ...]] = {
    "Spin speed": (
        spin.speeds_of_campbell,
        spin.definiteness,
        spin.false_instability,
        spin.speeds_of_runs,
    ),
    "Supports and damping": (
        holding.supports_linear,
        holding.supports_run,
        holding.supports_unresolved,
        holding.internal_damping,
    ),
    "Sizes, units, materials": (
        sizes.lengths,
        sizes.units,
        sizes.poisson,
        sizes.densities,
        sizes.far_axis,
        sizes.eccentricity,
    ),
}


def measured(quick: bool = False) -> dict[str, list[Row]]:
    """Return the rows of all groups; `quick` takes fewer points of each range."""
    found: dict[str, list[Row]] = {}
    cases = [(group, make) for group, makers in GROUPS.items() for make in makers]
    for group, make in (bar := tqdm(cases, desc="extremes")):
        bar.set_postfix_str(group)
        found.setdefault(group, []).append(make(quick=quick))
    return found


def printed(rows: dict[str, list[Row]]) -> str:
    """Return the rows as text, one block each."""
    lines = []
    for group, entries in rows.items():
        lines += [f"\n{group}", "-" * len(group)]
        for row in entries:
            verdict = "ok  " if row.passed else "FAIL"
            lines.append(f"{verdict} {row.pushed}: {row.reach}")
            lines += _wrapped(f"{row.criterion}: {row.measured:.3g} (limit {row.limit:.3g})")
            reason = f" ({row.reason})" if row.reason else ""
            lines += _wrapped(f"breaks at: {row.breaks_at}{reason}")
            if row.told:
                lines += _wrapped(f"told: {row.told}")
    return "\n".join(lines)


def _wrapped(text: str) -> list[str]:
    return textwrap.wrap(text, 100, initial_indent=" " * 8, subsequent_indent=" " * 10)


def main() -> None:
    """Measure all rows; ends with an error code if one fails."""
    parser = argparse.ArgumentParser(description="How far every input can be pushed.")
    parser.add_argument("--quick", action="store_true", help="fewer points of each range")
    parser.add_argument("--json", metavar="FILE", help="write the rows to FILE")
    options = parser.parse_args()
    rows = measured(options.quick)
    print(printed(rows))
    if options.json:
        plain = {group: [row.plain() for row in entries] for group, entries in rows.items()}
        write_json(options.json, plain)
    failed = sum(not row.passed for entries in rows.values() for row in entries)
    if failed:
        raise SystemExit(f"{failed} rows failed")
