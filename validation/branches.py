"""A sweep of 60 speeds by harmonic balance, beside runs in Exudyn at some of them.

A shaft with a disc under its weight on two short journal bearings, out of balance. A run begins in
the motion of the speed before, and lasts until what is left of that has decayed to the tolerance of
the sweep, by the growth that the sweep tells; its step keeps the amplitude to the same tolerance.
"""

from __future__ import annotations

import argparse
import time

import exudyn
import ngsolve
import numpy as np
from netgen import occ

import exudyn_rotor as er

TOLERANCE, PER_TURN = 1e-3, 200
WEIGHT = [0.0, -9.81, 0.0]
POINTS = 60


def rotor() -> er.SolidRotor:
    """Return a shaft with a disc, 0.2 kg mm out of balance."""
    shaft = occ.Cylinder((0, 0, -0.3), occ.Z, 0.02, 0.6)
    solid = shaft + occ.Cylinder((0, 0, -0.03), occ.Z, 0.09, 0.06)
    solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = "left", "right"
    mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.06, curvaturesafety=1.0))
    steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
    found = er.SolidRotor.from_ngsolve(mesh, steel, axis="z").center_interfaces()
    for z in (-0.03, 0.03):
        found = found.add_point_mass([0.09, 0.0, z], 1e-4 / 0.09)
    return found


BEARINGS = [
    er.ShortJournalBearing(
        interface=end, radius=0.02, length=0.012, clearance=4e-5, viscosity=0.02
    )
    for end in ("left", "right")
]  # fmt: skip


def sweep(modes: int) -> tuple[er.ReducedRotor, er.PeriodicResponse, float]:
    """Return the reduced rotor, its branches, and the processor time of the sweep [s]."""
    reduced = rotor().reduce(modes)
    speeds = np.linspace(200.0, 700.0, POINTS)
    begin = time.process_time()
    found = er.periodic_response(
        reduced, speeds, supports=BEARINGS, gravity=WEIGHT, tolerance=TOLERANCE
    )
    return reduced, found, time.process_time() - begin


def run(reduced: er.ReducedRotor, found: er.PeriodicResponse, point: int) -> tuple[float, float]:
    """Return the processor time of a run [s], and how far its amplitude is from the branch."""
    speed = found.speeds[point]
    mbs = exudyn.SystemContainer().AddSystem()
    body = er.add_rotor(
        mbs, reduced, spin=speed, translation="none", gravity=WEIGHT, markers="position"
    )
    er.add_supports(body, BEARINGS)
    sensor = body.add_interface_sensor("left", exudyn.OutputVariableType.Displacement)
    mbs.Assemble()
    before = found.state(point - 1, body)
    body.start_from(er.StartState(before.q, before.q_t, before.angle, speed))
    turn = 2.0 * np.pi / speed
    turns = int(np.ceil(np.log(1.0 / TOLERANCE) / -found.growth[point] / turn)) + 1
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


def main(arguments: list[str] | None = None) -> None:
    """Print times and deviations."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="two runs, two numbers of modes")
    options = parser.parse_args(arguments)
    reduced, found, spent = sweep(20)
    stable = np.flatnonzero(found.stable & np.array([kind == "value" for kind in found.kinds]))
    chosen = stable[np.linspace(1, len(stable) - 1, 2 if options.quick else 6).astype(int)]
    times = []
    for point in chosen:
        one, away = run(reduced, found, int(point))
        times.append(one)
        print(f"{found.speeds[point]:6.1f} rad/s: run {one:6.2f} s, amplitude off by {away:.1e}")
    at_values = sum(kind == "value" for kind in found.kinds)
    print(f"20 modes: {at_values} wanted of {len(found.values)} points, {spent:.2f} s")
    print(
        f"  a run {np.mean(times):.2f} s, {at_values * np.mean(times) / spent:.0f} times the sweep"
    )
    for modes in (10, 40) if options.quick else (5, 10, 40, 80):
        _, found, spent = sweep(modes)
        print(f"{modes:2d} modes: {len(found.values)} points, {spent:.2f} s")


if __name__ == "__main__":
    main()
