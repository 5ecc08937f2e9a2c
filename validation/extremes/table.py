"""How far every input can be pushed, what breaks first, and what the user is told there.

Run ``python -m validation extremes``, with ``--quick`` for less than a minute.
"""

from __future__ import annotations

import argparse
import textwrap
from collections.abc import Callable

from tqdm import tqdm

from validation.extremes import holding, sizes, spin
from validation.extremes.rows import Row

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
        sizes.far_axis,
        sizes.eccentricity,
    ),
}


def printed(row: Row) -> str:
    """Return a row as lines of text."""
    reason = f" ({row.reason})" if row.reason else ""
    lines = [
        f"{row.criterion}: {row.measured:.3g} (limit {row.limit:.3g})",
        f"breaks at: {row.breaks_at}{reason}",
        f"told: {row.told}" if row.told else "",
    ]
    rest = "\n".join(textwrap.fill(line, 92) for line in lines)
    title = f"{'ok  ' if row.passed else 'FAIL'} {row.pushed}: {row.reach}"
    return f"{title}\n{textwrap.indent(rest, ' ' * 8)}"


def main() -> None:
    """Measure all rows; ends with an error code if one fails."""
    parser = argparse.ArgumentParser(description="How far every input can be pushed.")
    parser.add_argument("--quick", action="store_true", help="fewer points of each range")
    options = parser.parse_args()
    rows = {}
    for group, makers in GROUPS.items():
        print(f"\n{group}\n{'-' * len(group)}")
        rows[group] = [make(quick=options.quick) for make in tqdm(makers, group, leave=False)]
        print("\n".join(printed(row) for row in rows[group]))
    failed = sum(not row.passed for entries in rows.values() for row in entries)
    if failed:
        raise SystemExit(f"{failed} rows failed")
