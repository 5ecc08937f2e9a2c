"""A rotor at speed in an earthquake: how much of the clearances a record uses, and whether it rubs.

The record is made by a formula: white noise of a fixed seed, filtered by the ground as by Kanai and
Tajimi, in an envelope of a strong phase of four seconds. It shakes a rotor on a block, at speed and
at rest; the peaks of the journals against their bearings are compared with the clearance, and the
linear motion with a run of the whole scene.
"""

import exudyn
import ngsolve
import numpy as np
from netgen import occ
from scipy.signal import lsim

from exudyn_rotor import (
    BaseRecord,
    Foundation,
    Mount,
    SolidRotor,
    Support,
    Unbalance,
    add_base_motion,
    add_foundation,
    add_rotor,
    add_supports,
    base_response,
    linear_model,
    plotting,
    recommended_settings,
    unbalance_response,
)

SPEED, CLEARANCE = 300.0, 260e-6  # rad/s, m
SEATS = {"left": [0.0, 0.0, -0.5], "right": [0.0, 0.0, 0.5]}

# ------------------------------------------------------------------ the ground: 0.35 g, 2.5 Hz
time = np.arange(0.0, 8.0, 0.005)
noise = np.random.default_rng(2026).normal(size=(3, len(time)))
soil, ratio = 2.0 * np.pi * 2.5, 0.6  # of Kanai and Tajimi: frequency and damping of the soil
soil_filter = [2.0 * ratio * soil, soil**2], [1.0, 2.0 * ratio * soil, soil**2]
envelope = np.minimum(1.0, time / 1.5) * np.exp(-np.maximum(time - 5.5, 0.0))
shaking = np.stack([envelope * lsim(soil_filter, one, time)[1] for one in noise], axis=1)
shaking *= 9.80665 * np.array([0.35, 0.25, 0.3]) / np.abs(shaking).max(axis=0)  # y is upwards
record = BaseRecord(time, shaking).with_baseline()
print(record)

# ------------------------------------------------------------------ rotor and block
shaft = occ.Cylinder((0, 0, -0.5), occ.Z, 0.045, 1.0) + occ.Cylinder(
    (0, 0, 0.05), occ.Z, 0.22, 0.08
)
shaft.faces.Min(occ.Z).name, shaft.faces.Max(occ.Z).name = "left", "right"
mesh = ngsolve.Mesh(occ.OCCGeometry(shaft).GenerateMesh(maxh=0.15, curvaturesafety=1.0))
steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
rotor = SolidRotor.from_ngsolve(mesh, steel, axis="z").center_interfaces()
reduced = rotor.reduce(4, prestress=False)
corners = [[x, -0.5, z] for x in (-0.4, 0.4) for z in (-0.6, 0.6)]
block = Foundation.rigid(
    mass=600.0,
    inertia=[85.0, 105.0, 40.0],
    center=[0.0, -0.3, 0.0],
    mounts=[Mount(corner, [4e5, 8e5, 4e5], [3e3, 5e3, 3e3]) for corner in corners],
    points=SEATS,
)
held = np.diag([2e6, 4e6, 2e6])  # across, upwards, along the axis [N/m]
bearings = [Support(name, held, 2e3) for name in SEATS]
model = linear_model(reduced, supports=bearings, foundation=block, stiffening="tilt")
print(reduced, block, sep="\n")

# ------------------------------------------------------------------ use of the clearance
# measured from where the journals are under their weight; peaks of quake and whirl may meet
balance = Unbalance([0.22, 0.0, 0.09], 1.5e-3)
whirl = unbalance_response(model, [SPEED], balance, accuracy=None)
used, shaken = {}, {}
for speed in (0.0, SPEED):
    shaken[speed] = base_response(model, record, speed=speed, tolerance=1e-4)
    for name in SEATS:
        below = f"{name} (foundation)"
        quake, when = shaken[speed].peak(name, below)
        sides = [abs(whirl.phasor(name, n) - whirl.phasor(below, n))[0] for n in ("n1", "n2")]
        alone = np.hypot(*sides) if speed else 0.0
        used[name, speed] = (quake + alone) / CLEARANCE
        print(
            f"{name} at {speed:g} rad/s: {1e6 * quake:.1f} µm at {when:.2f} s, unbalance "
            f"{1e6 * alone:.1f} µm, of the clearance {used[name, speed]:.0%}"
        )


# ------------------------------------------------------------------ 1.5 s of the whole scene
def run(*records: BaseRecord) -> tuple[np.ndarray, np.ndarray]:
    """Return time and motion of the right journal against its bearing, (t, 3) [m]."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, spin=SPEED, stiffening="tilt")
    base = add_foundation(mbs, block)
    add_supports(body, bearings, base=base)
    for each in records:
        add_base_motion(mbs, each, [body, base])
    journal = body.add_interface_sensor("right", exudyn.OutputVariableType.Displacement)
    pedestal = base.add_sensor("right")
    mbs.Assemble()
    settings = recommended_settings(end_time=1.5, step=1e-3)
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 1e-3
    mbs.SolveDynamic(settings)
    at, above = (mbs.GetSensorStoredData(sensor) for sensor in (journal, pedestal))
    return at[:, 0], at[:, 1:4] - above[:, 1:4]


instants, moved = run(record)
moved = moved - run()[1]  # less what the mesh's own unbalance does
linear = shaken[SPEED]
plane = reduced.axis.plane  # n1 and n2 in x, y, z
n1, n2 = linear.displacement("right", "right (foundation)")[:, :2].T
expected = np.column_stack([np.interp(instants, linear.time, one) for one in (n1, n2)])
apart = np.abs(moved @ plane - expected).max() / np.abs(expected).max()
print(f"scene against linear motion: {apart:.2%} of the largest displacement")

made, (left, right) = plotting.figure(1, 2, size=(11.0, 4.5))
left.plot(record.times, record.accelerations[:, 0], color="0.6", lw=0.8)
left.set_xlabel("time [s]")
left.set_ylabel("acceleration across [m/s²]")
right.plot(1e6 * n1, 1e6 * n2, lw=0.6, label="linear, eight seconds")
right.plot(*(1e6 * moved @ plane).T, lw=0.6, label="scene, first 1.5 s")
turn = np.linspace(0.0, 2.0 * np.pi, 200)
right.plot(1e6 * CLEARANCE * np.cos(turn), 1e6 * CLEARANCE * np.sin(turn), "k", label="clearance")
right.set_aspect("equal")
right.set_xlabel("right journal against its bearing, n1 [µm]")
right.set_ylabel("n2 [µm]")
right.legend(loc="lower left")
plotting.save(made, "earthquake.png")

assert apart < 0.01
assert 0.9 < used["right", SPEED] < 1.0
assert used["right", 0.0] < 0.9
