"""CPU and wall time of linear analyses and `reduce`, also beside another version of the package.

The demonstration's rotor on two bearings. Each version runs the cases in processes of its own, with
one thread of the linear algebra libraries and with their default number; all take turns, and the
shortest time of each case counts. Analyses of another rotor come first, so that no case loads
libraries; every case is the first one of its kind of its rotor. With ``--busy N`` as many other
processes compute meanwhile, as on a machine that is shared.

python -m validation linear [--against FOLDER] [--busy N] [--json FILE] [--quick]
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

REPEATS = 3
NAMES = ("left", "right")
STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
REDUCE = "reduce to 20 free modes, with prestress"
FIRST = "reduce, then a first Campbell diagram"
WANTED = {  # ratios; seconds where below 1
    "Campbell, 26 coordinates, 25 speeds": 8.0,
    "Campbell, tables of 8 coefficients, 22 speeds": 15.0,
    "critical speed map, 25 stiffnesses": 15.0,
    "unstable ranges, 22 coordinates, 5 speeds": 5.0,
    REDUCE: 2.0,
    FIRST: None,
    "Campbell, 40 coordinates, 31 speeds": 0.25,
}
THREADS = {"one thread": "1", "default threads": None}
_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
Times = dict[str, tuple[float, float]]
TILT = {"stiffening": "tilt"}  # the default differs between versions


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
        # what a rotor keeps from its first analysis is in the case FIRST
        campbell(each, [10.0], supports=[Support(name, 1e6) for name in NAMES], **TILT)
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
    prestress = {"prestress": solid.prestress()}
    _warm_up()
    calls = (
        lambda: campbell(rotor, speeds, supports=even, **TILT),
        lambda: campbell(rotor, np.linspace(50.0, 950.0, 22), supports=tables, **TILT),
        lambda: critical_speed_map(rotor, NAMES, stiffnesses, **TILT),
        lambda: unstable_ranges(
            few, np.linspace(100.0, 1500.0, 5), supports=uneven + inner, **TILT
        ),
        lambda: solid.reduce(20, **prestress),
        lambda: campbell(solid.reduce(20, **prestress), speeds, supports=even, **TILT),
        lambda: campbell(many, np.linspace(0.0, 800.0, 31), supports=even, **TILT),
    )
    return dict(zip(WANTED, calls, strict=True))


def _warm_up() -> None:
    """Analyse two masses on a rod, so that libraries are loaded."""
    from exudyn_rotor import SolidRotor, Support, campbell, critical_speed_map, unstable_ranges

    rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]
    rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    supports = [Support(name, [[2e4, 0.0], [0.0, 3e4]], damping=10.0) for name in NAMES]
    campbell(rotor, [0.0, 50.0], supports=supports)
    critical_speed_map(rotor, NAMES, [1e4])
    unstable_ranges(rotor, [50.0, 100.0], supports=supports)


def measured(quick: bool) -> Times:
    """Return the CPU and wall time of each case [s]."""
    times = {}
    for name, call in cases(quick).items():
        start = time.process_time(), time.perf_counter()
        call()
        times[name] = time.process_time() - start[0], time.perf_counter() - start[1]
    return times


def measured_in(folder: Path, threads: str | None, quick: bool) -> Times:
    """Return the times of the version in a folder, from a process of its own."""
    command = [sys.executable, __file__, "--child", *(["--quick"] if quick else [])]
    environment = os.environ | {"PYTHONPATH": str(folder), "PYTHONWARNINGS": "ignore"}
    for variable in _VARIABLES:
        environment.pop(variable, None)
        if threads is not None:
            environment[variable] = threads
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return json.loads(done.stdout.splitlines()[-1])


@contextmanager
def others_computing(count: int) -> Iterator[None]:
    """Keep `count` other processes busy, each with one thread."""
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
    try:
        yield
    finally:
        for process in busy:
            process.kill()
            process.wait()


def shortest(runs: list[Times]) -> Times:
    """Return the shortest CPU time and the shortest wall time of each case."""
    return {
        name: tuple(map(min, zip(*(run[name] for run in runs), strict=True))) for name in WANTED
    }


def print_table(how: str, own: Times, other: Times | None) -> None:
    """Print seconds, and with another version the ratios and those wanted."""
    more = "" if other is None else "     other CPU    wall   ratio CPU  wall (wanted)"
    print(f"\n{how + ', times [s]':48}{'CPU':>8}{'wall':>8}{more}")
    for name, seconds in own.items():
        line = f"{name:48}{seconds[0]:8.3f}{seconds[1]:8.3f}"
        if other is not None:
            limit = WANTED[name]
            shown = ""
            if limit is not None:
                shown = f" ({limit:g})" if limit > 1.0 else f" (here < {limit:g} s)"
            ratios = [there / here for there, here in zip(other[name], seconds, strict=True)]
            line += f"{other[name][0]:14.3f}{other[name][1]:8.3f}{ratios[0]:12.1f}{ratios[1]:6.1f}"
            line += shown
        print(line)


def main() -> None:
    """Measure and print a table for each number of threads."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--against", type=Path, help="folder with another version's exudyn_rotor")
    parser.add_argument("--busy", type=int, default=0, help="processes that compute beside it")
    parser.add_argument("--json", type=Path, help="write the numbers to this file")
    parser.add_argument("--quick", action="store_true", help="a coarse mesh, one repeat")
    parser.add_argument("--child", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.child:
        warnings.simplefilter("ignore")
        print(json.dumps(measured(options.quick)))
        return
    folders = [Path(__file__).resolve().parents[2], *filter(None, [options.against])]
    runs: dict[str, list[list[Times]]] = {how: [[] for _ in folders] for how in THREADS}
    with others_computing(options.busy):
        for _ in range(1 if options.quick else REPEATS):
            for how, threads in THREADS.items():
                for done, folder in zip(runs[how], folders, strict=True):
                    done.append(measured_in(folder.resolve(), threads, options.quick))
    result = {}
    for how, versions in runs.items():
        own, *others = result[how] = [shortest(done) for done in versions]
        print_table(how, own, others[0] if others else None)
    if options.json:
        options.json.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
