"""CPU time of linear analyses, also beside another version of the package, in one run.

The demonstration's rotor on two bearings. The other version runs the same cases in a process of its
own; both take turns, and the shortest time of each case counts. The number of threads is that of
the environment, by default the linear algebra library's own.

python -m validation linear [--against FOLDER] [--json FILE] [--quick]
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np

REPEATS = 3
NAMES = ("left", "right")
STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
WANTED = {  # ratios, and seconds of the last
    "Campbell, 26 coordinates, 25 speeds": 8.0,
    "Campbell, tables of 8 coefficients, 22 speeds": 15.0,
    "critical speed map, 25 stiffnesses": 15.0,
    "unstable ranges, 22 coordinates, 5 speeds": 5.0,
    "Campbell, 40 coordinates, 31 speeds": 0.25,
}


def cases(quick: bool) -> dict[str, Callable[[], object]]:
    """Return the cases, with calls that both versions have."""
    from exudyn_rotor import (
        SolidRotor,
        Support,
        campbell,
        critical_speed_map,
        unstable_ranges,
    )
    from exudyn_rotor.demo.scene import disc_on_shaft

    solid = SolidRotor.from_ngsolve(disc_on_shaft(0.1 if quick else 0.05), STEEL, axis="x")
    few, rotor, many = (solid.center_interfaces().reduce(n) for n in (16, 20, 34))
    for each in (few, rotor, many):
        # version 0.1 computes these in `reduce`, this one when they are first asked for
        getattr(each, "with_attachments", None)
    even = [Support(name, 2e7, 500.0) for name in NAMES]
    uneven = [Support(name, np.diag([2e7, 1.2e7]), np.diag([500.0, 300.0])) for name in NAMES]
    inner = [Support(name, damping=300.0, frame="rotor") for name in NAMES]
    at = np.linspace(0.0, 1000.0, 9)
    growing = at[:, None, None] / 1000.0
    K = np.array([[2e7, 0.0], [0.0, 1.4e7]]) * (1.0 + 0.4 * growing)
    K = K + np.array([[0.0, 3e6], [-3e6, 0.0]]) * growing
    D = np.array([[500.0, 50.0], [50.0, 400.0]]) * (1.0 + 0.4 * growing)
    tables = [Support(name, (at, K), (at, D)) for name in NAMES]
    speeds, stiffnesses = np.linspace(0.0, 800.0, 25), np.geomspace(1e5, 1e10, 25)
    tilt = {"stiffening": "tilt"}  # the default differs between versions
    calls = (
        lambda: campbell(rotor, speeds, supports=even, **tilt),
        lambda: campbell(rotor, np.linspace(50.0, 950.0, 22), supports=tables, **tilt),
        lambda: critical_speed_map(rotor, NAMES, stiffnesses, **tilt),
        lambda: unstable_ranges(
            few, np.linspace(100.0, 1500.0, 5), supports=uneven + inner, **tilt
        ),
        lambda: campbell(many, np.linspace(0.0, 800.0, 31), supports=even, **tilt),
    )
    return dict(zip(WANTED, calls, strict=True))


def measured(quick: bool) -> dict[str, float]:
    """Return the CPU time of each case [s]."""
    times = {}
    for name, call in cases(quick).items():
        start = time.process_time()
        call()
        times[name] = time.process_time() - start
    return times


def measured_in(folder: Path, quick: bool) -> dict[str, float]:
    """Return the CPU times of the version in a folder, from a process of its own."""
    command = [sys.executable, __file__, "--child", *(["--quick"] if quick else [])]
    environment = os.environ | {"PYTHONPATH": str(folder), "PYTHONWARNINGS": "ignore"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return json.loads(done.stdout.splitlines()[-1])


def shortest(runs: list[dict[str, float]]) -> dict[str, float]:
    """Return the shortest time of each case."""
    return {name: min(run[name] for run in runs) for name in WANTED}


def print_table(own: dict[str, float], other: dict[str, float] | None) -> None:
    """Print seconds, and with another version the ratios and those wanted."""
    print(
        f"{'CPU time [s]':48}{'here':>8}" + ("" if other is None else "   other   ratio (wanted)")
    )
    for name, seconds in own.items():
        line = f"{name:48}{seconds:8.3f}"
        if other is not None:
            limit = WANTED[name]
            shown = f"({limit:g})" if limit > 1.0 else f"(here < {limit:g} s)"
            line += f"{other[name]:8.3f}{other[name] / seconds:8.1f} {shown}"
        print(line)


def main() -> None:
    """Measure and print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--against", type=Path, help="folder with another version's exudyn_rotor")
    parser.add_argument("--json", type=Path, help="write the numbers to this file")
    parser.add_argument("--quick", action="store_true", help="a coarse mesh, one repeat")
    parser.add_argument("--child", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.child:
        warnings.simplefilter("ignore")
        print(json.dumps(measured(options.quick)))
        return
    folders = [Path(__file__).resolve().parents[2], *filter(None, [options.against])]
    runs: list[list[dict[str, float]]] = [[] for _ in folders]
    for _ in range(1 if options.quick else REPEATS):
        for done, folder in zip(runs, folders, strict=True):
            done.append(measured_in(folder.resolve(), options.quick))
    own, *others = (shortest(done) for done in runs)
    print_table(own, others[0] if others else None)
    if options.json:
        options.json.write_text(json.dumps({"here": own, "other": others}, indent=1) + "\n")


if __name__ == "__main__":
    main()
