"""Error against cost: which body, modes, step and settings reach an accuracy in the least time.

The scene is the demonstration's rotor on two anisotropic bearings, with unbalance and gravity, at
180 rad/s. Every simulation is compared at equal times with one reference: Exudyn's 3D body with
many Craig–Bampton modes, extrapolated to the step zero. An error is the largest distance of the
orbits of both journals and the disc's middle, and of the wobble of its rim, relative to the motion;
it holds the errors of the step, of the modes and of the formulation together, so they need not be
added. The mesh is the same for all; what it costs is in a table of its own. The time is that of
the whole simulation without the set-up.

    python -m validation trade [--quick]
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence

import exudyn

from validation.rows import print_rows
from validation.trade.error import Row, cheapest, crossing, front
from validation.trade.linear import mesh_errors, reduction_errors
from validation.trade.plan import plan, run_up
from validation.trade.run import AXES, USERS, Bench, contributions, measure, tilts
from validation.trade.scene import CRAIG_BAMPTON, TORQUE, VIRTUAL, Body, Rotor

ACCURACIES = (1e-2, 1e-3, 1e-4)
CLAIM = (1e-4, 20.0)  # accuracy, wanted speed ratio
AMPLITUDES = (1e-4, 1e-3, 1e-2, 3e-2, 1e-1, 3e-1)  # rad
SIZE, QUICK_SIZE = 0.0155, 0.1  # m
MESHES = [(2, 0.1), (2, 0.03), (1, 0.1), (1, SIZE)]
QUICK_MESHES = [(2, QUICK_SIZE), (1, QUICK_SIZE)]
FINEST, QUICK_FINEST = SIZE, 0.07  # m
LEADING = ("family", "basis", "modes", "step", "solver", "markers")


def advice(points: Iterable[Row], accuracies: Sequence[float] = ACCURACIES) -> list[Row]:
    """Return the cheapest row of every group for every accuracy, with the ratio to the users' 3D.

    ``ratio`` is the time of the 3D body as users write it over the own one, both at their cheapest
    for this accuracy; None where users do not reach it. A group that does not reach it has no
    ``seconds``.
    """
    points = list(points)
    groups = dict.fromkeys(row["group"] for row in points)
    rows = []
    for accuracy in accuracies:
        best = {
            name: cheapest([row for row in points if row["group"] == name], accuracy)
            for name in groups
        }
        users = best.get(USERS)
        for name, row in best.items():
            kept = {key: None if row is None else row[key] for key in (*LEADING, "total")}
            seconds = None if row is None else row["seconds"]
            ratio = None if None in (row, users) else users["seconds"] / seconds
            own = {"accuracy": accuracy, "group": name, "seconds": seconds, "ratio": ratio}
            rows.append(own | kept)
    return rows


def verdict(rows: Iterable[Row]) -> list[str]:
    """Return one sentence per fixed-axis group on the claim of the speed ratio."""
    accuracy, wanted = CLAIM
    lines = []
    for row in rows:
        if row["accuracy"] != accuracy or not row["group"].startswith("fixed axis"):
            continue
        if row["seconds"] is None:
            found = "does not reach this accuracy: refuted"
        elif row["ratio"] is None:
            found = f"{row['seconds']:.3g} s; the 3D body as users write it does not get there"
        else:
            word = "holds" if row["ratio"] >= wanted else "refuted"
            found = f"{row['ratio']:.1f} times faster: {word}"
        lines.append(f"{row['group']}: {found}")
    return lines


def limits(rows: Sequence[Row], accuracies: Sequence[float] = ACCURACIES) -> list[Row]:
    """Return the tilts [rad] above which a fixed axis misses an accuracy, by what is looked at."""
    x = [row["tilt"] for row in rows]
    return [
        {"accuracy": a} | {name: crossing(x, [row[name] for row in rows], a) for name in AXES}
        for a in accuracies
    ]


def everything(quick: bool) -> dict:
    """Run all parts; return their tables."""
    bench = Bench(Rotor.of(QUICK_SIZE if quick else SIZE))
    many, steps = (20, 16) if quick else (60, 25)
    body = Body(VIRTUAL, CRAIG_BAMPTON, many, markers="position")
    reference, own = bench.converged(body, steps)
    driven = Body(VIRTUAL, CRAIG_BAMPTON, 20 if quick else 40, torque=TORQUE)
    reference_up, own_up = bench.converged(driven, 8 if quick else 25)
    repeats = 1 if quick else 2
    points = measure(bench, plan(quick), reference, repeats)
    rising = measure(bench, run_up(quick), reference_up, repeats)
    parts = contributions(bench, reference, 12, 32 if quick else 50)
    if not quick:
        parts += contributions(bench, reference_up, 12, torque=TORQUE)
    return {
        "scene": {
            "nodes": bench.rotor.solid.node_count,
            "face nodes": [len(one.nodes) for one in bench.rotor.solid.interfaces.values()],
            "reference modes": many,
            "reference error": own,
            "reference error, run-up": own_up,
            "size [m]": reference.size,
        },
        "points": points,
        "run-up": rising,
        "contributions": parts,
        "modes": reduction_errors(bench.rotor, quick),
        "meshes": mesh_errors(QUICK_MESHES if quick else MESHES, QUICK_FINEST if quick else FINEST),
        "tilts": tilts(AMPLITUDES[2::3] if quick else AMPLITUDES),
    }


def with_conclusions(data: dict) -> dict:
    """Add to the tables what follows from them."""
    rows = advice(data["points"])
    return data | {
        "front": front(data["points"]),
        "advice": rows,
        "advice, run-up": advice(data["run-up"]),
        "limits": limits(data["tilts"]),
        "verdict": verdict(rows),
    }


def report(data: dict) -> None:
    """Print all tables."""
    for name, value in data["scene"].items():
        print(f"{name}: {value}")
    shown = ("journal", "disc", "rim", "total", "seconds", "set-up")
    columns = (*LEADING, "stiffening", *shown)
    print_rows("All simulations at constant speed", data["points"], columns)
    print_rows(f"Run-up by {TORQUE:g} N m", data["run-up"], (*LEADING, *shown))
    print_rows("Pareto front", data["front"], (*LEADING, "total", "seconds"))
    print_rows("What errors are made of", data["contributions"])
    print_rows("Modes, and stiffening in full models: steady response", data["modes"])
    print_rows("Meshes against the finest", data["meshes"])
    print_rows("Deviation from the 3D body by tilt [rad]", data["tilts"])
    print_rows("Largest tilt [rad] for an accuracy", data["limits"])
    chosen = (
        "accuracy",
        "group",
        "basis",
        "modes",
        "step",
        "solver",
        "markers",
        "seconds",
        "ratio",
    )
    print_rows("Advice at constant speed", data["advice"], chosen)
    print_rows("Advice for the run-up", data["advice, run-up"], chosen)
    accuracy, wanted = CLAIM
    print(f"\nAt an error of {accuracy:g}, {wanted:g} times faster than the 3D body as users write")
    print("it (markers on all face nodes, default solver settings)?")
    print("\n".join(f"  {line}" for line in data["verdict"]))


def main(argv: list[str] | None = None) -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="coarse mesh, few simulations")
    options = parser.parse_args(argv)
    # warnings about memory that user functions allocate would tear the tables
    exudyn.SetWriteToConsole(False)
    data = with_conclusions(everything(options.quick))
    report(data)
