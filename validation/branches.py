"""A sweep of 60 speeds through a fold by harmonic balance, beside runs in Exudyn at some of them.

A shaft with a disc under its weight on two short journal bearings, far out of balance. A run
begins in the motion of the speed before on the branch. It lasts until the difference from that
motion has decayed to the tolerance of the sweep, by the growth that the sweep tells, and a
revolution more. Its step keeps the amplitude to about the same tolerance.
"""

from __future__ import annotations

import argparse
import time
from itertools import pairwise

import exudyn
import ngsolve
import numpy as np
from netgen import occ

import exudyn_rotor as er
from validation.rows import verdict

TOLERANCE, PER_TURN = 1e-3, 100
WEIGHT = [0.0, -9.81, 0.0]
POINTS = 60


def rotor() -> er.SolidRotor:
    """Return a shaft with a disc, 1.7 kg mm out of balance."""
    shaft = occ.Cylinder((0, 0, -0.3), occ.Z, 0.02, 0.6)
    solid = shaft + occ.Cylinder((0, 0, -0.03), occ.Z, 0.09, 0.06)
    solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = "left", "right"
    mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.06, curvaturesafety=1.0))
    steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
    found = er.SolidRotor.from_ngsolve(mesh, steel, axis="z").center_interfaces()
    for z, radius, amount in ((0.03, 0.09, 1e-4), (0.3, 0.02, 7.5e-4)):
        for side in (-1.0, 1.0):
            found = found.add_point_mass([radius, 0.0, side * z], amount / radius)
    return found


BEARINGS = [
    er.ShortJournalBearing(
        interface=end, radius=0.02, length=0.012, clearance=6e-5, viscosity=0.015
    )
    for end in ("left", "right")
]  # fmt: skip


def sweep(modes: int) -> tuple[er.ReducedRotor, er.PeriodicResponse, float]:
    """Return the reduced rotor, its branches, and the processor time of the sweep [s]."""
    reduced = rotor().reduce(modes)
    speeds = np.linspace(450.0, 700.0, POINTS)
    begin = time.process_time()
    found = er.periodic_response(
        reduced, speeds, supports=BEARINGS, gravity=WEIGHT, tolerance=TOLERANCE
    )
    return reduced, found, time.process_time() - begin


def run(
    reduced: er.ReducedRotor, found: er.PeriodicResponse, point: int, before: int
) -> tuple[float, float]:
    """Return the processor time of a run [s], and how far its amplitude is from the branch.

    It begins in the motion of another point.
    """
    speed = found.speeds[point]
    mbs = exudyn.SystemContainer().AddSystem()
    body = er.add_rotor(
        mbs, reduced, spin=speed, translation="none", gravity=WEIGHT, markers="position"
    )
    er.add_supports(body, BEARINGS)
    sensor = body.add_interface_sensor("left", exudyn.OutputVariableType.Displacement)
    mbs.Assemble()
    state = found.state(before, body)
    body.start_from(er.StartState(state.q, state.q_t, state.angle, speed))
    turn = 2.0 * np.pi / speed
    ends = [found.displacement(p, np.linspace(0.0, turn, 50), "left") for p in (before, point)]
    apart = np.abs(ends[0] - ends[1]).max() / found.amplitudes("left")[point]
    decay = np.log(max(apart / TOLERANCE, 1.0)) / -found.growth[point]
    turns = int(np.ceil(decay / turn)) + 1
    settings = er.recommended_settings(end_time=turns * turn, step=turn / PER_TURN)
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = turn / PER_TURN
    settings.timeIntegration.verboseMode = 0
    begin = time.process_time()
    mbs.SolveDynamic(settings)
    spent = time.process_time() - begin
    path = mbs.GetSensorStoredData(sensor)[-PER_TURN:, 1:3]
    amplitude = np.linalg.norm(path - path.mean(axis=0), axis=1).max()
    return spent, float(abs(amplitude / found.amplitudes("left")[point] - 1.0))


def main(arguments: list[str] | None = None) -> int:
    """Print times and deviations, and the verdict."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer runs and numbers of modes")
    quick = parser.parse_args(arguments).quick
    sweep(2)  # imports
    reduced, found, spent = sweep(20)
    wanted = np.flatnonzero([kind == "value" for kind in found.kinds])
    pairs = [(p, q) for q, p in pairwise(wanted) if found.stable[p] and found.stable[q]]
    pairs = [(p, q) for p, q in pairs if found.branches[p] == found.branches[q]]
    chosen = np.linspace(0, len(pairs) - 1, 3 if quick else 8).astype(int)
    times, off = [], []
    for point, before in (pairs[i] for i in chosen):
        one, away = run(reduced, found, int(point), int(before))
        times.append(one)
        off.append(away)
        print(f"{found.speeds[point]:6.1f} rad/s: run {one:6.2f} s, amplitude off by {away:.1e}")
    ratio = found.stable[wanted].sum() * np.mean(times) / spent
    print(f"20 modes: {len(wanted)} wanted of {len(found.values)} points, {spent:.2f} s")
    print(f"  a run {np.mean(times):.2f} s, runs at all stable points {ratio:.0f} times the sweep")
    few, many = (10, 41) if quick else (10, 81)
    spans = [sweep(modes)[2] for modes in (few, many)]
    print(f"{few} modes {spans[0]:.2f} s, {many} modes {spans[1]:.2f} s")
    return verdict(
        {
            "sweep over runs": (1.0 / ratio, 1.0 / 20.0),
            "amplitudes of runs": (max(off), 5.0 * TOLERANCE),
            "growth of the time over the growth of the modes": (
                spans[1] / spans[0] / (many / few),
                1.0,
            ),
        }
    )
