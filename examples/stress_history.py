"""Stress of a bored disc over a run-up: the static part, the dynamic part, and the peak.

The centrifugal stress comes from the static solution that ``stiffening='full'`` uses anyway; the
bending stress from the recorded modal coordinates. The sum is largest at the bore.
"""

import exudyn
import ngsolve
import numpy as np
from exudyn.itemInterface import SensorNode
from netgen import occ

from exudyn_rotor import (
    PrescribedMotion,
    SolidRotor,
    StressField,
    add_rotor,
    plotting,
    recommended_settings,
    stress_history,
)

BORE, RIM, THICKNESS = 0.03, 0.18, 0.02  # m
END_SPEED, DURATION, STEP = 1500.0, 0.3, 1e-4  # rad/s, s, s

tube = occ.Cylinder(occ.Pnt(0, 0, -0.2), occ.Z, BORE + 0.006, 0.4)
solid = tube + occ.Cylinder(occ.Pnt(0, 0, 0.02), occ.Z, RIM, THICKNESS)
solid = solid - occ.Cylinder(occ.Pnt(0, 0, -0.3), occ.Z, BORE, 0.6)
solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = "left", "right"
mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.03, curvaturesafety=1.0))
steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
rotor = SolidRotor.from_ngsolve(mesh, steel, axis="z").center_interfaces()
rotor = rotor.add_point_mass([RIM, 0, 0.03], 0.002)
reduced = rotor.reduce(11, stress=True, prestress=True)

mbs = exudyn.SystemContainer().AddSystem()
run_up = PrescribedMotion.run_up(0.0, END_SPEED, DURATION)
body = add_rotor(mbs, reduced, spin=run_up, stiffening="full", markers="position")
ground = mbs.CreateGround()
for name, z in (("left", -0.2), ("right", 0.2)):
    mbs.CreateCartesianSpringDamper(
        itemNumbers=[ground, body.marker(name)],
        localPosition0=[0, 0, z],
        stiffness=[8e6] * 3,
        damping=[1.5e3] * 3,
    )
modes = mbs.AddSensor(
    SensorNode(
        nodeNumber=body.nodes["modes"],
        outputVariableType=exudyn.OutputVariableType.Coordinates,
        storeInternal=True,
        writeToFile=False,
    )
)
mbs.Assemble()
settings = recommended_settings(DURATION, STEP)
settings.timeIntegration.verboseMode = 0
settings.solution.file.write = False
settings.solution.sensors.writePeriod = STEP
mbs.SolveDynamic(settings)

record = mbs.GetSensorStoredData(modes)
time, modal_coordinates = record[:, 0], record[:, 1:]
speed = np.array([run_up.rate(t) for t in time])
field = StressField.of(reduced, body.selection)
history = stress_history(field, time, modal_coordinates, speed, count=5)
print(history.table())
plotting.save(history.plot(), "stress_history.png")
plotting.save(history.plot_peak(), "stress_peak.png")

# the hoop stress at the bore of a plain annulus; the tube stiffens the bore of this one
ratio = steel["poissonsRatio"]
hoop = RIM**2 + (1 - ratio) / (3 + ratio) * BORE**2
hoop *= steel["density"] * END_SPEED**2 * (3 + ratio) / 4
at_end = history.principal[-1, 0, 0]
shown = f"{1e-6 * at_end:.0f} MPa, plain annulus {1e-6 * hoop:.0f} MPa at the bore"
print(f"largest principal stress at the hottest node {shown}")
place = history.positions[history.hottest]
assert np.hypot(place[0], place[1]) < BORE + 0.01
assert 0.7 * hoop < at_end < hoop
