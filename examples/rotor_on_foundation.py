"""A rotor on a sprung foundation: unbalance response below and above the critical speed.

One description of the block serves a linear analysis and runs of a scene. At constant speed the
rotor's equations have constant matrices and the block's are native, so a time step calls no Python.
The rotor is stiff against its bearings, and the mean of the response must obey the closed form for
two rigid masses in a row: foundation and rotor.
"""

import exudyn
import ngsolve
import numpy as np
from netgen import occ

from exudyn_rotor import (
    Foundation,
    Mount,
    SolidRotor,
    Support,
    add_foundation,
    add_rotor,
    add_supports,
    linear_model,
    plotting,
    unbalance_response,
)

BEARING, FOUNDATION = 2e5, 1e6  # stiffness of a bearing and of a foundation spring [N/m]
BEARING_DAMPING, FOUNDATION_DAMPING = 200.0, 2000.0  # [N s/m]
PERIODS, STEPS_PER_PERIOD = 60, 60

shaft = occ.Cylinder(occ.Pnt(-0.15, 0, 0), occ.X, 0.02, 0.3)
solid = shaft + occ.Cylinder(occ.Pnt(-0.02, 0, 0), occ.X, 0.1, 0.04)
solid.faces.Min(occ.X).name, solid.faces.Max(occ.X).name = "left", "right"
mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.08, curvaturesafety=1.0))
steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
rotor = SolidRotor.from_ngsolve(mesh, steel, axis="x").center_interfaces()
rotor = rotor.add_point_mass([0.0, 0.1, 0.0], 0.01)
reduced = rotor.reduce(6)
places = {"left": [-0.15, 0.0, 0.0], "right": [0.15, 0.0, 0.0]}
supports = [Support(n, BEARING * np.eye(3), BEARING_DAMPING * np.eye(3)) for n in places]
corners = [[x, y, -0.25] for x in (-0.15, 0.15) for y in (-0.1, 0.1)]
block = Foundation.rigid(
    mass=30.0,  # concrete, 0.4 by 0.3 by 0.1 m
    inertia=[0.25, 0.425, 0.625],
    center=[0.0, 0.0, -0.2],
    mounts=[Mount(corner, FOUNDATION, FOUNDATION_DAMPING) for corner in corners],
    points=places,
)


def amplitudes(speed: float) -> tuple[float, float]:
    """Return the vertical amplitudes of rotor and foundation in a run [m], at a speed [rad/s]."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, spin=speed)
    base = add_foundation(mbs, block)
    add_supports(body, supports, base=base)
    moved = exudyn.OutputVariableType.Displacement
    sensors = [body.add_interface_sensor(name, moved) for name in places]
    sensors += [base.add_sensor(name) for name in places]
    mbs.Assemble()
    period = 2.0 * np.pi / speed
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = PERIODS * STEPS_PER_PERIOD
    settings.timeIntegration.endTime = PERIODS * period
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = period / STEPS_PER_PERIOD
    mbs.SolveDynamic(settings)
    left, right, *below = (mbs.GetSensorStoredData(sensor) for sensor in sensors)
    last = slice(-10 * STEPS_PER_PERIOD, None)  # ten whole periods
    harmonic = 2.0 * np.exp(-1j * speed * left[last, 0]) / len(left[last])
    journals, seats = left[last, 3] + right[last, 3], below[0][last, 3] + below[1][last, 3]
    return abs(harmonic @ journals) / 2.0, abs(harmonic @ seats) / 2.0


def closed_form(speed: float) -> tuple[float, float]:
    """Return the amplitudes of two rigid masses in a row under the unbalance force."""
    bearing = 2.0 * (BEARING + 1j * speed * BEARING_DAMPING)
    ground = 4.0 * (FOUNDATION + 1j * speed * FOUNDATION_DAMPING)
    mass = reduced.invariants.mass
    offset = np.linalg.norm(reduced.axis.radial(reduced.center_of_mass))
    stiffness = [[bearing - mass * speed**2, -bearing], [-bearing, bearing + ground]]
    stiffness[1][1] -= block.mass[0, 0] * speed**2
    return tuple(np.abs(np.linalg.solve(stiffness, [mass * offset * speed**2, 0.0])))


speeds = np.array([100.0, 160.0, 190.0, 220.0, 300.0, 400.0])
measured = np.array([amplitudes(speed) for speed in speeds])
expected = np.array([closed_form(speed) for speed in speeds])
for speed, ours, theirs in zip(speeds, measured, expected, strict=True):
    print(
        f"{speed:5.0f} rad/s: rotor {1e6 * ours[0]:7.2f} µm ({1e6 * theirs[0]:7.2f} rigid),"
        f" foundation {1e6 * ours[1]:6.2f} µm ({1e6 * theirs[1]:6.2f} rigid)"
    )

# ------------------------------------------------------------------ the same by linear analysis
model = linear_model(reduced, supports=supports, foundation=block, stiffening="tilt")
fine = np.linspace(60.0, 420.0, 46)
response = unbalance_response(model, np.union1d(fine, speeds), accuracy=None)
upwards = reduced.axis.plane[2]  # z by n1 and n2
linear = []
for names in (places, [f"{name} (foundation)" for name in places]):
    moved = sum(
        upwards[0] * response.phasor(name, "n1") + upwards[1] * response.phasor(name, "n2")
        for name in names
    )
    linear.append(np.abs(moved) / 2.0)
linear = np.stack(linear, axis=1)

made, axes = plotting.figure(size=(6.5, 4.0))
axes.semilogy(response.speeds, 1e6 * linear)
axes.set_prop_cycle(None)
axes.semilogy(speeds, 1e6 * measured, "o")
axes.set_xlabel("spin speed [rad/s]")
axes.set_ylabel("vertical amplitude [µm]")
axes.legend(["rotor, linear", "foundation, linear", "rotor, run", "foundation, run"])
plotting.save(made, "rotor_on_foundation.png")

at_speeds = linear[np.searchsorted(response.speeds, speeds)]
print(f"runs against linear analysis: {np.abs(measured / at_speeds - 1.0).max():.2%}")
assert np.all(np.abs(measured / expected - 1.0) < 0.02)
assert np.all(np.abs(measured / at_speeds - 1.0) < 0.02)
