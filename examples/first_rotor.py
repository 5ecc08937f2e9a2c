"""The first rotor: mesh, reduce, add to a scene, couple, run, look at the orbit."""

import exudyn
import ngsolve
import numpy as np
from netgen import occ

import exudyn_rotor

shaft = occ.Cylinder(occ.Pnt(0, 0, -0.3), occ.Z, 0.015, 0.6)
solid = shaft + occ.Cylinder(occ.Pnt(0, 0, -0.02), occ.Z, 0.12, 0.04)
solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = "left", "right"
mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.05))
steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
rotor = exudyn_rotor.SolidRotor.from_ngsolve(mesh, steel, axis="z").center_interfaces()
reduced = rotor.add_point_mass([0.12, 0, 0], 0.005).reduce(12)

SC = exudyn.SystemContainer()
mbs = SC.AddSystem()
body = exudyn_rotor.add_rotor(mbs, reduced, spin=200.0, gravity=[0, -9.81, 0])
ground = mbs.CreateGround()
for name, z in (("left", -0.3), ("right", 0.3)):
    mbs.CreateCartesianSpringDamper(
        itemNumbers=[ground, body.marker(name)],
        localPosition0=[0, 0, z],
        stiffness=[2e6] * 3,
        damping=[2e3] * 3,
    )
orbit = body.add_interface_sensor("right", exudyn.OutputVariableType.Displacement)

mbs.Assemble()
settings = exudyn.SimulationSettings()
settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 4000, 0.8
settings.timeIntegration.verboseMode, settings.solution.file.write = 0, False
settings.solution.sensors.writePeriod = 2e-4
mbs.SolveDynamic(settings)
axes = {"components": [1], "componentsX": [0], "xLabel": "x [m]", "yLabel": "y [m]"}
mbs.PlotSensor([orbit], **axes, labels=["right journal"], fileName="first_rotor.png")

# the journals sag by half the weight over the stiffness of a bearing, and circle around that
time, _, y, _ = mbs.GetSensorStoredData(orbit).T
turns = time > time[-1] - 10 * 2 * np.pi / 200.0  # the last ten revolutions
sag = reduced.invariants.mass * 9.81 / (2 * 2e6)
print(body.report())
print(f"mean vertical displacement {1e6 * y[turns].mean():.2f} µm, m g / 2k = {1e6 * sag:.2f} µm")
assert abs(y[turns].mean() + sag) < 0.02 * sag
