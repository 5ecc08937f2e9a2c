"""How far a run from a sudden start drifts in phase, beside the row `step` of `check_run`.

The rotor of `examples/advice.py`, on stiff and on soft bearings of little damping, begins at rest
in its bearings, or in its steady state, with the step that `propose` gives. Its right journal's
orbit over the last three revolutions is compared with that of a quarter of the step. 'phase' is
what the row adds up to, 2π times it in each period of the lowest forward whirl [rad].

    python -m validation sudden_start [--quick]
"""

from __future__ import annotations

import argparse
import warnings

import exudyn
import ngsolve
import numpy as np
from netgen import occ

from exudyn_rotor import (
    ReducedRotor,
    RotorBody,
    SolidRotor,
    Support,
    add_rotor,
    add_supports,
    campbell,
    check_run,
    craig_bampton_modes,
    propose,
    steady_state,
)

STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
SPEED = 900.0  # rad/s
NAMES = ("left", "right")
BEARINGS = {"stiff": (2e7, 4e3), "soft": (2e6, 40.0)}  # N/m, N s/m
FINER = 4  # times as many steps
ACCURACY = 1e-2


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="30 revolutions alone")
    quick = parser.parse_args(arguments).quick
    reduced = rotor()
    print(
        f"{'bearings, begins':20}{'turns':>6}{'damping':>10}{'step':>10}{'phase':>8}{'error':>10}"
    )
    for name, given in BEARINGS.items():
        supports = [Support(end, given[0] * np.eye(3), given[1] * np.eye(3)) for end in NAMES]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of what the row shows
            for turns in (30,) if quick else (30, 200):
                for settled in (False, True):
                    start = f"{name}, {'steady' if settled else 'sudden'}"
                    print(
                        f"{start:20}{turns:6d}{line(reduced, supports, turns, settled)}", flush=True
                    )


def rotor() -> ReducedRotor:
    """Return the rotor of `examples/advice.py`, reduced to its interfaces and ten modes."""
    shaft = occ.Cylinder(occ.Pnt(0, 0, -0.3), occ.Z, 0.015, 0.6)
    shape = shaft + occ.Cylinder(occ.Pnt(0, 0, -0.02), occ.Z, 0.12, 0.04)
    shape.faces.Min(occ.Z).name, shape.faces.Max(occ.Z).name = NAMES
    mesh = ngsolve.Mesh(occ.OCCGeometry(shape).GenerateMesh(maxh=0.04, curvaturesafety=1.0))
    solid = SolidRotor.from_ngsolve(mesh, STEEL, axis="z").center_interfaces()
    solid = solid.add_point_mass([0.12, 0, 0], 0.005)
    return solid.reduce(craig_bampton_modes(solid, 10, coupling="RBE3"))


def line(reduced: ReducedRotor, supports: list[Support], turns: int, settled: bool) -> str:
    """Return the lowest forward whirl's damping, the row, phase [rad] and error of the orbit."""
    whirl = campbell(reduced, [SPEED], supports=supports)
    forward = int(np.flatnonzero(np.array(whirl.whirl)[0] == "forward")[0])
    step = propose(reduced, speeds=SPEED, supports=supports, accuracy=ACCURACY).step
    steps = int(np.ceil(2 * np.pi / SPEED / step))
    body, coarse = run(reduced, supports, turns, steps, settled)
    finer = run(reduced, supports, turns, FINER * steps, settled)[1][::FINER]
    row = check_run(body, warn=False)["step"].value
    phase = 2 * np.pi * row * turns * whirl.frequencies_inertial[0, forward] / SPEED
    return (
        f"{whirl.damping_ratio[0, forward]:10.1e}{row:10.1e}{phase:8.2f}{off(coarse, finer):10.1e}"
    )


def run(
    reduced: ReducedRotor, supports: list[Support], turns: int, steps: int, settled: bool
) -> tuple[RotorBody, np.ndarray]:
    """Return the body after a run, and the right journal's orbit in its last three turns [m]."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, spin=SPEED, gravity=[0, -9.81, 0])
    add_supports(body, supports)
    orbit = body.add_interface_sensor("right", exudyn.OutputVariableType.Displacement)
    body.start_recording()
    mbs.Assemble()
    if settled:
        body.start_from(steady_state(body).state())
    settings = exudyn.SimulationSettings()
    integration, period = settings.timeIntegration, 2 * np.pi / SPEED
    integration.numberOfSteps, integration.endTime = turns * steps, turns * period
    integration.verboseMode, settings.solution.file.write = 0, False
    settings.solution.sensors.writePeriod = period / steps
    mbs.SolveDynamic(settings)
    return body, mbs.GetSensorStoredData(orbit)[-3 * steps :, 1:3][::-1]


def off(orbit: np.ndarray, finer: np.ndarray) -> float:
    """Return the largest difference over the largest distance from the mean."""
    return np.abs(orbit - finer).max() / np.abs(finer - finer.mean(axis=0)).max()


if __name__ == "__main__":
    main()
