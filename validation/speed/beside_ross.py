"""Processor time of linear analyses beside ROSS, with as many coordinates.

A disc on a shaft on two bearings whose stiffness differs in two planes: in ROSS of beam elements,
here a solid with Craig–Bampton modes. Both take turns in one process, and the shortest time counts.
ROSS is not installed with the package: ``pip install ross-rotordynamics "plotly<6"``.

python -m validation beside_ross [--nodes N]
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Callable

import numpy as np

from exudyn_rotor import (
    ReducedRotor,
    SolidRotor,
    Support,
    Unbalance,
    campbell,
    craig_bampton_modes,
    critical_speed_map,
    critical_speeds,
    unbalance_response,
)
from exudyn_rotor.demo.scene import BEARINGS, STEEL, disc_on_shaft
from validation.rows import verdict

LENGTH, SHAFT, DISC, WIDTH = 0.6, 0.04, 0.24, 0.04  # m
STIFFNESS, DAMPING = (2e7, 4e7), 2e3  # N/m, N s/m
SPEEDS = np.linspace(1.0, 600.0, 51)  # rad/s
REPEATS = 3


def ross_rotor(nodes: int) -> object:
    """Return ROSS's rotor of beam elements."""
    import ross

    steel = ross.Material("steel", rho=7850.0, E=2.1e11, Poisson=0.3)
    length = LENGTH / (nodes - 1)
    shaft = [ross.ShaftElement(length, 0.0, SHAFT, material=steel) for _ in range(nodes - 1)]
    disc = ross.DiskElement.from_geometry(nodes // 2, steel, WIDTH, SHAFT, DISC)
    (kxx, kyy), c = STIFFNESS, DAMPING
    bearings = [ross.BearingElement(n, kxx, c, kyy=kyy, cyy=c) for n in (0, nodes - 1)]
    return ross.Rotor(shaft, [disc], bearings)


def solid_rotor(size: int) -> ReducedRotor:
    """Return a reduced solid rotor of `size` coordinates, or one more."""
    solid = SolidRotor.from_ngsolve(disc_on_shaft(0.05, 1.0), STEEL, axis="x").center_interfaces()
    rigid = solid.reduce(craig_bampton_modes(solid, 0, list(BEARINGS), coupling="RBE3")).size
    modes = craig_bampton_modes(solid, size - rigid, list(BEARINGS), coupling="RBE3")
    return solid.reduce(modes)


def shortest(call: Callable[[], object]) -> float:
    """Return the processor time of the quickest of some calls [s]."""
    times = []
    for _ in range(REPEATS):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return min(times)


def main() -> int:
    """Print the times and their ratio; return 0 where each analysis is faster here."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--nodes", type=int, default=8, help="nodes of ROSS's shaft")
    nodes = parser.parse_args().nodes
    warnings.simplefilter("ignore")
    size = ross_rotor(nodes).ndof
    reduced = solid_rotor(size)
    supports = [Support(name, np.diag(STIFFNESS), DAMPING) for name in BEARINGS]
    given = {"supports": supports}
    stiffnesses = np.geomspace(1e6, 1e9, 16)
    unbalance = [Unbalance(reduced.center_of_mass, 1e-3)]
    theirs = {"unbalance_magnitude": [1e-3], "unbalance_phase": [0.0], "frequency": SPEEDS}
    # a new rotor of ROSS each time, for it keeps results
    calls = {
        "Campbell diagram, 51 speeds": (
            lambda: ross_rotor(nodes).run_campbell(SPEEDS, frequencies=8),
            lambda: campbell(reduced, SPEEDS, modes=8, accuracy=None, **given),
        ),
        "unbalance response, 51 speeds": (
            lambda: ross_rotor(nodes).run_unbalance_response(node=[nodes // 2], **theirs),
            lambda: unbalance_response(reduced, SPEEDS, unbalance, accuracy=None, **given),
        ),
        "critical speeds": (
            lambda: ross_rotor(nodes).run_critical_speed(num_modes=12),
            lambda: critical_speeds(reduced, max_speed=SPEEDS[-1], accuracy=None, **given),
        ),
        "critical speed map, 16 stiffnesses": (
            lambda: ross_rotor(nodes).run_ucs(num_modes=8, bearing_frequency_range=None),
            lambda: critical_speed_map(
                reduced, list(BEARINGS), stiffnesses, max_speed=2000.0, accuracy=None
            ),
        ),
    }
    print(f"{size} coordinates in ROSS, {reduced.size} here")
    print(f"{'analysis':36}{'ROSS [s]':>10}{'here [s]':>10}{'ratio':>8}")
    ratios = []
    for name, (ross_call, our_call) in calls.items():
        one, other = shortest(ross_call), shortest(our_call)
        ratios.append(one / other)
        print(f"{name:36}{one:10.3f}{other:10.3f}{ratios[-1]:8.1f}")
    return verdict({"time over that of ROSS": (1.0 / min(ratios), 1.0)})
