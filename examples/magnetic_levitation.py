"""A rotor levitates from its back-up bearings and runs up through its bending critical speed.

At rest the shaft lies in two back-up bearings, half the air gap below the centre. Two magnetic
bearings lift it: saturating actuators, PID controllers with filter, amplifier and delay. Then the
speed goes up, and stays at the critical speed for a while: the motion there is that of the linear
analysis, which takes the same bearings, linearised where the magnets hold the weight.
"""

import exudyn
import ngsolve
import numpy as np
from netgen import occ

import exudyn_rotor as er
from exudyn_rotor import plotting

ENDS, WEIGHT, CLEARANCE = ("left", "right"), [0.0, -9.81, 0.0], 2e-4  # SI units
shaft = occ.Cylinder((0, 0, -0.3), occ.Z, 0.013, 0.6)
solid = shaft + occ.Cylinder((0, 0, -0.02), occ.Z, 0.08, 0.04)
for place in (-0.3, 0.24):
    solid += occ.Cylinder((0, 0, place), occ.Z, 0.035, 0.06)  # sleeves for the magnets
mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.08, curvaturesafety=1.0))
steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
rotor = er.SolidRotor.from_ngsolve(mesh, steel, axis="z")
rotor = rotor.add_point_mass([0.08, 0.0, 0.0], 2e-3)  # unbalance: 0.16 g m
for name, place in (("left", -0.27), ("disc", 0.0), ("right", 0.27)):
    rotor = rotor.interface_at(name, place, width=0.04)
reduced = rotor.center_interfaces().reduce(4).without_shapes()

magnets = er.SaturatingActuator(
    constant=2e-6, bias_current=2.0, gap=2 * CLEARANCE, current_limit=4.0
)
controller = er.PIDController(
    proportional=1.2e4,
    integral=2e5,
    derivative=14.0,
    filter_frequency=4e4,
    amplifier_frequency=2e4,
    delay=1e-5,
)
loads = er.bearing_loads(reduced, ENDS, WEIGHT)
bearings = [
    er.MagneticBearing(
        interface=end, actuator=magnets, controller=controller, angle=np.pi / 4, load=load
    )
    for end, load in zip(ENDS, loads, strict=True)
]
stop = {"radius": 0.035, "clearance": CLEARANCE, "stiffness": 1e7, "damping": 5e4}

speeds = np.arange(200.0, 451.0, 10.0)
expected = er.unbalance_response(reduced, speeds, supports=bearings, accuracy=None)
critical, most = expected.peak("disc")
margin = er.sensitivity(reduced, np.geomspace(10.0, 3e4, 60), supports=bearings, speed=critical)
print(margin.table())
assert set(margin.zones) == {"A"}

LIFT, RAMP, HOLD = 0.1, 0.15, 0.12  # s: at rest, up to the critical speed, there; and up again
ramps = (
    (LIFT, er.PrescribedMotion.run_up(0.0, critical, RAMP)),
    (LIFT + RAMP + HOLD, er.PrescribedMotion.run_up(0.0, critical, RAMP)),
)


def both(kind: str):
    """Return the sum of both ramps over time: of their 'value', 'rate' or 'acceleration'."""
    return lambda t: sum(getattr(ramp, kind)(t - start) for start, ramp in ramps if t > start)


mbs = exudyn.SystemContainer().AddSystem()
spin = er.PrescribedMotion(both("value"), both("rate"), both("acceleration"))
body = er.add_rotor(mbs, reduced, spin=spin, gravity=WEIGHT, markers="position")
er.add_supports(body, [*bearings, *(er.ClearanceStop(interface=end, **stop) for end in ENDS)])
sensors = [
    body.add_interface_sensor(place, exudyn.OutputVariableType.Displacement)
    for place in ("left", "disc")
]
mbs.Assemble()
q = np.array(mbs.systemData.GetODE2Coordinates())
q[1] = -CLEARANCE - np.abs(loads[0, 1]) / stop["stiffness"]  # at rest in the stops
body.start_from(er.StartState(q, 0.0 * q, 0.0, 0.0))
paths, end = [], LIFT + 2.0 * RAMP + HOLD
for begin, until, step in ((0.0, 0.04, 3e-5), (0.04, end, 2e-4)):  # the jump at the start is fast
    settings = er.recommended_settings(end_time=until, step=step)
    settings.timeIntegration.startTime = begin
    settings.timeIntegration.numberOfSteps = round((until - begin) / step)
    settings.timeIntegration.newton.modifiedNewtonContractivity = 0.5  # few Jacobians
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = step
    mbs.SolveDynamic(settings, updateInitialValues=True)
    paths.append([np.array(mbs.GetSensorStoredData(sensor)[:, :3]) for sensor in sensors])
left, disc = (np.vstack(parts) for parts in zip(*paths, strict=True))
time = left[:, 0]

lifted = left[np.abs(time - LIFT) < 0.01, 1:].mean(axis=0)
print(f"lifted from {1e6 * left[0, 2]:.0f} µm to {1e6 * lifted[1]:.1f} µm")
assert left[0, 2] < -CLEARANCE
assert np.abs(lifted).max() < 0.03 * CLEARANCE  # the integral takes its time
start = LIFT + RAMP + HOLD
held = disc[(time > start - 4.0 * np.pi / critical) & (time <= start), 1:]  # two revolutions
radius = np.linalg.norm(held - held.mean(axis=0), axis=1).mean()
print(f"at {critical:.0f} rad/s {1e6 * radius:.1f} µm, by linear analysis {1e6 * most:.1f} µm")
assert abs(radius / most - 1.0) < 0.03

figure, panels = plotting.figure(1, 3, size=(14.0, 4.0))
for name, path in (("disc", disc), ("left", left)):
    panels[0].plot(time, 1e6 * path[:, 2], lw=0.7, label=name)
panels[0].axhline(-1e6 * CLEARANCE, color="0.6", lw=3.0)
panels[0].set_xlabel("time [s]")
panels[0].set_ylabel("height [µm]")
panels[0].legend()
panels[1].plot(1e6 * left[:, 1], 1e6 * left[:, 2], lw=0.5)
circle = 1e6 * CLEARANCE * np.exp(2j * np.pi * np.linspace(0.0, 1.0, 181))
panels[1].plot(circle.real, circle.imag, color="0.6", lw=3.0)
panels[1].set_aspect("equal")
panels[1].set_xlabel("left journal in its stop [µm]")
margin.plot(panels[2])
plotting.save(figure, "magnetic_levitation.png")
