"""Cost of a time step: Exudyn's 3D body, the fixed-axis body, and the floor without Python.

The scene is the demonstration's rotor on two anisotropic bearings. All bodies have the same modes
and the same steps; every body runs with Exudyn's default tolerances and with the recommended ones.

python -m validation speed [--quick]
"""

from __future__ import annotations

import argparse

import exudyn
from exudyn.FEM import FEMinterface
from tqdm import tqdm

from exudyn_rotor import recommended_settings
from exudyn_rotor.demo.scene import AddRotor
from validation.rows import verdict
from validation.speed.scenes import (
    BODIES,
    POINT_BODIES,
    STEP,
    Model,
    assemble,
    default_settings,
    python_calls,
    seconds,
)

ELEMENT_SIZE, QUICK_SIZE = 0.0155, 0.05  # m: 10 400 and 6800 nodes
MODE_COUNTS, QUICK_COUNTS = (8, 20, 40), (8, 20)
REPEATS = 3
REFERENCES = ("3D, markers on all face nodes", "3D, virtual nodes")
TARGETS = {  # wanted speed ratios at 8, 20, 40 modes, against the two references
    "fixed axis, constant speed": ((8, 15, 25), (3, 5, 10)),
    "fixed axis, free spin": ((4, 8, 12), (1.5, 3, 6)),
}
FLOOR_TARGETS = {"fixed axis, constant speed": 1.3, "fixed axis, free spin": 2.0}


def recommended(steps: int) -> exudyn.SimulationSettings:
    """Return the recommended settings without output."""
    return recommended_settings(steps * STEP, STEP, settings=default_settings(steps))


SETTINGS = {"default": default_settings, "recommended": recommended}
SCENES = {  # marker kind, tolerances, bodies
    ("rigid", "default"): BODIES,
    ("rigid", "recommended"): BODIES,
    ("position", "recommended"): POINT_BODIES,
}


def measure(model: Model, mode_count: int, steps: int, progress: tqdm) -> list[dict]:
    """Return one row per body and settings; repeats are interleaved and the shortest one counts.

    The slow reference runs a tenth of the steps.
    """
    fem, best = model.with_modes(mode_count), {}
    for _ in range(REPEATS):
        for (markers, tolerances), bodies in SCENES.items():
            for name, add_rotor in bodies.items():
                count = steps // 10 if name == REFERENCES[0] else steps
                mbs, _ = assemble(add_rotor, fem)
                cost = 1e6 * seconds(mbs, SETTINGS[tolerances](count)) / count
                key = name, markers, tolerances
                best[key] = min(best.get(key, cost), cost)
                progress.update()
    rows = []
    for (name, markers, tolerances), cost in best.items():
        row = {"modes": mode_count, "body": name, "markers": markers, "tolerances": tolerances}
        add_rotor = SCENES[markers, tolerances][name]
        calls = _calls(add_rotor, fem, SETTINGS[tolerances](steps), steps)
        rows.append(row | {"microseconds": cost} | calls)
    return rows


def _calls(
    add_rotor: AddRotor, fem: FEMinterface, settings: exudyn.SimulationSettings, steps: int
) -> dict:
    calls = python_calls(add_rotor, fem, settings)
    return {
        "calls": {kind: count / steps for kind, count in calls.count.items()},
        "microseconds_per_call": calls.microseconds,
    }


def ratios(rows: list[dict]) -> list[dict]:
    """Return the speed ratios of the fixed-axis bodies at equal settings, with the targets.

    The 3D body with standard markers always has rigid ones, as its own call makes them.
    """
    keys = ("modes", "body", "markers", "tolerances")
    cost = {tuple(row[key] for key in keys): row["microseconds"] for row in rows}
    found = []
    for (modes, body, markers, tolerances), own in cost.items():
        if body not in TARGETS:
            continue
        standard = cost[modes, REFERENCES[0], "rigid", tolerances] / own
        virtual = cost[modes, REFERENCES[1], markers, tolerances] / own
        floor = own / cost[modes, f"{body}, floor", markers, tolerances]
        column = MODE_COUNTS.index(modes)
        wanted = [targets[column] for targets in TARGETS[body]] + [FLOOR_TARGETS[body]]
        found.append(
            dict(zip(keys, (modes, body, markers, tolerances), strict=True))
            | {"standard": standard, "virtual": virtual, "floor": floor}
            | dict(zip(("standard target", "virtual target", "floor target"), wanted, strict=True))
        )
    return found


def print_table(rows: list[dict], summary: list[dict]) -> None:
    """Print costs, calls, and ratios with targets."""
    head = f"{'modes':>5}  {'body':34}{'markers':10}{'tolerances':13}"
    print(f"{head}{'µs/step':>9}  Python calls per step (µs per call)")
    for row in rows:
        calls = ", ".join(
            f"{kind} {count:.3g} ({row['microseconds_per_call'][kind]:.1f})"
            for kind, count in row["calls"].items()
        )
        print(f"{_head(row)}{row['microseconds']:9.1f}  {calls or 'none'}")
    print("\nspeed ratios, and cost over that of the same scene without Python; (targets)")
    print(f"{head}{'standard markers':>18}{'virtual nodes':>18}{'floor':>18}")
    for row in summary:
        cells = (
            f"{row[name]:.2f} ({row[f'{name} target']:g})"
            for name in ("standard", "virtual", "floor")
        )
        print(_head(row) + "".join(f"{cell:>18}" for cell in cells))


def _head(row: dict) -> str:
    return f"{row['modes']:5d}  {row['body']:34}{row['markers']:10}{row['tolerances']:13}"


def main(argv: list[str] | None = None) -> int:
    """Measure, print the table and the verdict."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="coarse mesh, fewer modes and steps")
    options = parser.parse_args(argv)
    counts = QUICK_COUNTS if options.quick else MODE_COUNTS
    steps = 500 if options.quick else 2000
    model = Model.of(QUICK_SIZE if options.quick else ELEMENT_SIZE, max(counts))
    print(f"{model.node_count} nodes, {steps} steps of {STEP} s")
    total = len(counts) * REPEATS * sum(map(len, SCENES.values()))
    with tqdm(total=total, unit="run") as progress:
        rows = [row for count in counts for row in measure(model, count, steps, progress)]
    summary = ratios(rows)
    print_table(rows, summary)
    numbers = ("standard", "virtual")
    shares = [row[f"{name} target"] / row[name] for row in summary for name in numbers]
    return verdict({"speed ratio aimed at over the one measured": (max(shares), 1.0)})
