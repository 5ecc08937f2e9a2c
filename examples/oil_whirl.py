"""Oil whirl and whip: at which speed do two journal bearings make a flexible shaft whirl?

Two runs start a little beside the equilibrium of the journals: below the limit the whirl dies down,
above it grows. The speed between them at which it would do neither is that of the linear analysis,
which takes the same two bearings. A run-up goes on beyond: the whirl begins at half the speed, and
then stays at the shaft's first bending frequency, however fast it spins (whip).
"""

import exudyn
import ngsolve
import numpy as np
from netgen import occ

import exudyn_rotor as er
from exudyn_rotor import plotting

ENDS, WEIGHT = ("left", "right"), [0.0, -9.81, 0.0]
solid = occ.Cylinder((0, 0, -0.3), occ.Z, 0.02, 0.6) + occ.Cylinder((0, 0, -0.02), occ.Z, 0.1, 0.04)
mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.06, curvaturesafety=1.0))
steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
rotor = er.SolidRotor.from_ngsolve(mesh, steel, axis="z")
for name, place in (("left", -0.28), ("right", 0.28)):
    rotor = rotor.interface_at(name, place, width=0.04)
rotor = rotor.center_interfaces()
reduced = rotor.reduce(4).without_shapes()
size = {"radius": 0.02, "length": 0.012, "clearance": 4e-5, "viscosity": 0.02}  # VG 32, warm
loads = er.bearing_loads(reduced, ENDS, WEIGHT)
bearings = [
    er.ShortJournalBearing(interface=end, load=load, **size)
    for end, load in zip(ENDS, loads, strict=True)
]


def run(spin, end_time: float, push: float, step: float) -> tuple[np.ndarray, er.SteadyState]:
    """Return time [s] and path x, y of the left journal [m], and the steady motion without push.

    `push` is how far the rotor starts beside that motion, as a share of its displacement.
    """
    mbs = exudyn.SystemContainer().AddSystem()
    options = {"translation": "none", "markers": "position"}
    body = er.add_rotor(mbs, reduced, spin=spin, gravity=WEIGHT, **options)
    er.add_supports(body, bearings)
    sensor = body.add_interface_sensor("left", exudyn.OutputVariableType.Displacement)
    mbs.Assemble()
    steady = er.steady_state(body)
    start = steady.state()
    body.start_from(er.StartState((1.0 + push) * start.q, start.q_t, start.angle, start.speed))
    settings = er.recommended_settings(end_time=end_time, step=step)
    settings.timeIntegration.newton.useModifiedNewton = False  # a thin film stiffens in a step
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = step
    mbs.SolveDynamic(settings)
    return mbs.GetSensorStoredData(sensor)[:, :3], steady


def growth(speed: float) -> float:
    """Return the growth [1/s] of what the push adds to the steady motion of the left journal."""
    path, steady = run(speed, 0.18, push=0.05, step=2e-4)
    late = path[path[:, 0] > 0.08]  # all other motions have died down
    at_rest = [steady.interface_motion("left", speed * t)[:2] for t in late[:, 0]]
    return np.polyfit(late[:, 0], np.log(np.linalg.norm(late[:, 1:] - at_rest, axis=1)), 1)[0]


speeds = np.array([1020.0, 1070.0])
rates = np.array([growth(speed) for speed in speeds])
limit = speeds[0] - rates[0] * (speeds[1] - speeds[0]) / (rates[1] - rates[0])
expected = er.stability_threshold(reduced, 1000.0, 1100.0, supports=bearings).values[0]
print(f"limit by runs {limit:.1f} rad/s, by linear analysis {expected:.1f} rad/s")
assert abs(limit / expected - 1.0) < 0.01

pinned = [er.Support(end, 1e10) for end in ENDS]
bending = er.campbell(er.linear_model(reduced, supports=pinned), [0.0], modes=4).frequencies_rotor
bending = bending[bending > 1.0].min()
spin = er.PrescribedMotion.run_up(1150.0, 2400.0, duration=0.24)
path, _ = run(spin, 0.3, push=0.2, step=1.5e-4)
speed = np.array([spin.rate(t) for t in path[:, 0]])
found = er.spectra(path[:, 0], path[:, 1:], speed, length=0.09, overlap=0.85)
axes = found.plot(orders=[0.5, 1.0])
axes.axvline(bending / (2.0 * np.pi), color="0.4", lw=0.9, label="first bending")
axes.set_xlim(-50.0, 3000.0 / (2.0 * np.pi))
plotting.legend_above(axes, 4)
plotting.save(axes, "oil_whirl.png")


def whirl(start: float) -> tuple[float, float]:
    """Return frequency of the whirl and spin speed [rad/s], means of 0.07 s."""
    part = (path[:, 0] > start) & (path[:, 0] < start + 0.07)
    orbit = path[part, 1] + 1j * path[part, 2]
    turned = np.unwrap(np.angle(orbit - orbit.mean()))
    return np.polyfit(path[part, 0], turned, 1)[0], speed[part].mean()


for start in (0.04, 0.13, 0.23):
    frequency, at = whirl(start)
    print(f"spin {at:.0f} rad/s: whirls at {frequency:.0f} rad/s, {frequency / at:.2f} of it")
print(f"first bending frequency of the shaft, pinned: {bending:.0f} rad/s")
assert 0.95 < frequency / bending < 1.0  # the films give a little
assert frequency / at < 0.36
assert found.amplitudes[-1].max() > 0.8 * size["clearance"]
