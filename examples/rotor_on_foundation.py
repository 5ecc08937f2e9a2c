"""A rotor on a sprung foundation: unbalance response below and above the critical speed.

At constant speed the rotor's equations have constant matrices, so a time step calls no Python. The
rotor is stiff against its bearings, and the mean of the response must obey the closed form for two
rigid masses in a row: foundation and rotor.
"""

import exudyn
import ngsolve
import numpy as np
from exudyn.rigidBodyUtilities import InertiaCuboid
from netgen import occ

from exudyn_rotor import SolidRotor, add_rotor, plotting

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
block = InertiaCuboid(density=2500.0, sideLengths=[0.4, 0.3, 0.1])


def amplitudes(speed: float) -> tuple[float, float]:
    """Return the vertical amplitudes of rotor and foundation at a spin speed [rad/s], [m]."""
    SC = exudyn.SystemContainer()
    mbs = SC.AddSystem()
    body = add_rotor(mbs, reduced, spin=speed, markers="position")
    base = mbs.CreateRigidBody(inertia=block, referencePosition=[0, 0, -0.2])
    ground = mbs.CreateGround()
    for x, y in ((-0.15, -0.1), (-0.15, 0.1), (0.15, -0.1), (0.15, 0.1)):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, base],
            localPosition0=[x, y, -0.25],
            localPosition1=[x, y, -0.05],
            stiffness=[FOUNDATION] * 3,
            damping=[FOUNDATION_DAMPING] * 3,
        )
    for name, x in (("left", -0.15), ("right", 0.15)):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[base, body.marker(name)],
            localPosition0=[x, 0, 0.2],
            stiffness=[BEARING] * 3,
            damping=[BEARING_DAMPING] * 3,
        )
    kinds = exudyn.OutputVariableType
    sensors = [body.add_interface_sensor(name, kinds.Displacement) for name in ("left", "right")]
    node = mbs.GetObject(base)["nodeNumber"]
    sensors.append(
        mbs.AddSensor(
            exudyn.itemInterface.SensorNode(
                nodeNumber=node, outputVariableType=kinds.Displacement, storeInternal=True
            )
        )
    )
    mbs.Assemble()
    period = 2.0 * np.pi / speed
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = PERIODS * STEPS_PER_PERIOD
    settings.timeIntegration.endTime = PERIODS * period
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = period / STEPS_PER_PERIOD
    mbs.SolveDynamic(settings)
    left, right, foundation = (mbs.GetSensorStoredData(sensor) for sensor in sensors)
    last = slice(-10 * STEPS_PER_PERIOD, None)  # ten whole periods
    harmonic = 2.0 * np.exp(-1j * speed * left[last, 0]) / len(left[last])
    journal = 0.5 * (left[last, 3] + right[last, 3])
    return abs(harmonic @ journal), abs(harmonic @ foundation[last, 3])


def closed_form(speed: float) -> tuple[float, float]:
    """Return the amplitudes of two rigid masses in a row under the unbalance force."""
    bearing = 2.0 * (BEARING + 1j * speed * BEARING_DAMPING)
    ground = 4.0 * (FOUNDATION + 1j * speed * FOUNDATION_DAMPING)
    mass = reduced.invariants.mass
    offset = np.linalg.norm(reduced.axis.radial(reduced.center_of_mass))
    stiffness = [[bearing - mass * speed**2, -bearing], [-bearing, bearing + ground]]
    stiffness[1][1] -= block.Mass() * speed**2
    return tuple(np.abs(np.linalg.solve(stiffness, [mass * offset * speed**2, 0.0])))


speeds = np.array([100.0, 160.0, 190.0, 220.0, 300.0, 400.0])
measured = np.array([amplitudes(speed) for speed in speeds])
expected = np.array([closed_form(speed) for speed in speeds])
for speed, ours, theirs in zip(speeds, measured, expected, strict=True):
    print(
        f"{speed:5.0f} rad/s: rotor {1e6 * ours[0]:7.2f} µm ({1e6 * theirs[0]:7.2f} rigid),"
        f" foundation {1e6 * ours[1]:6.2f} µm ({1e6 * theirs[1]:6.2f} rigid)"
    )

made, axes = plotting.figure(size=(6.5, 4.0))
fine = np.linspace(60.0, 420.0, 400)
axes.semilogy(fine, 1e6 * np.array([closed_form(speed) for speed in fine]))
axes.set_prop_cycle(None)
axes.semilogy(speeds, 1e6 * measured, "o")
axes.set_xlabel("spin speed [rad/s]")
axes.set_ylabel("vertical amplitude [µm]")
axes.legend(["rotor, closed form", "foundation, closed form", "rotor", "foundation"])
plotting.save(made, "rotor_on_foundation.png")

assert np.all(np.abs(measured / expected - 1.0) < 0.02)
