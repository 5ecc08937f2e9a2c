"""How far every input can be pushed, what breaks first, and what the user is told there.

Run ``python -m validation extremes``, with ``--quick`` for less than a minute, ``--json FILE`` to
keep the rows.
"""

from __future__ import annotations

import argparse
import json
import textwrap
from collections.abc import Callable
from functools import partial

from tqdm import tqdm

from validation.extremes import bad_numbers, bases, holding, sizes, spin, steps, turning, unbalance
from validation.extremes.rows import Row

GROUPS: dict[str, tuple[Callable[..., Row], ...]] = {
    "Spin speed": (
        spin.speeds_of_campbell,
        spin.definiteness,
        spin.false_instability,
        spin.false_verdict,
        spin.speeds_of_runs,
        spin.backwards,
    ),
    "Revolutions and torques": (
        turning.phase,
        turning.node_phase,
        turning.free_phase,
        turning.rigid_torque,
        turning.flexible_torque,
    ),
    "Supports, damping, asymmetry": (
        holding.supports_linear,
        holding.supports_run,
        holding.supports_unresolved,
        holding.contrast,
        holding.internal_damping,
        holding.asymmetry,
        holding.no_interface,
    ),
    "Mode bases": (
        bases.many_modes,
        bases.eigen_residual,
        bases.dependent_columns,
        bases.nothing_left,
    ),
    "Step sizes": (
        *(partial(steps.explicit_row, solver) for solver in steps.POLYNOMIALS),
        *(partial(steps.unstable_row, solver) for solver in steps.UNSTABLE),
        steps.adaptive_row,
        *(partial(steps.implicit_row, solver) for solver in steps.IMPLICIT),
        steps.verlet_row,
        steps.tiny_steps,
    ),
    "Sizes, units, materials": (
        sizes.lengths,
        sizes.units,
        sizes.analyses,
        sizes.poisson,
        sizes.densities,
        sizes.far_axis,
        sizes.eccentricity,
        unbalance.limit_of_small_tilts,
    ),
    "Bad numbers": (
        bad_numbers.not_finite,
        bad_numbers.later_nan,
        bad_numbers.axis_length,
        bad_numbers.denormals,
        bad_numbers.overflow,
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


def write_json(path: str, rows: dict[str, list[Row]]) -> None:
    """Write the rows as strict JSON: null where there is no number."""
    plain = {group: [row.plain() for row in entries] for group, entries in rows.items()}
    with open(path, "w", encoding="utf-8") as file:
        json.dump(plain, file, indent=1, allow_nan=False, ensure_ascii=False)


def main() -> None:
    """Measure all rows; ends with an error code if one fails."""
    parser = argparse.ArgumentParser(description="How far every input can be pushed.")
    parser.add_argument("--quick", action="store_true", help="fewer points of each range")
    parser.add_argument("--json", metavar="FILE", help="write the rows to FILE")
    options = parser.parse_args()
    rows = measured(options.quick)
    print(printed(rows))
    if options.json:
        write_json(options.json, rows)
    failed = sum(not row.passed for entries in rows.values() for row in entries)
    if failed:
        raise SystemExit(f"{failed} rows failed")
