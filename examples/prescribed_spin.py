"""Prescribed spin θ(t) and the torque that it takes.

A rotor is run up smoothly from rest. Its bearings are frictionless, so the impulse of the drive
torque must equal the gain of angular momentum, Θ Ω.
"""

import exudyn
import ngsolve
import numpy as np
from netgen import occ

from exudyn_rotor import PrescribedMotion, SolidRotor, add_rotor, plotting

END_SPEED, DURATION = 250.0, 0.2  # rad/s, s
STEP = 1e-4

shaft = occ.Cylinder(occ.Pnt(0, -0.2, 0), occ.Y, 0.012, 0.4)
solid = shaft + occ.Cylinder(occ.Pnt(0, 0.05, 0), occ.Y, 0.08, 0.03)
solid.faces.Min(occ.Y).name, solid.faces.Max(occ.Y).name = "left", "right"
mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.04, curvaturesafety=1.0))
steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
reduced = SolidRotor.from_ngsolve(mesh, steel, axis="y").center_interfaces().reduce(9)

SC = exudyn.SystemContainer()
mbs = SC.AddSystem()
run_up = PrescribedMotion.run_up(0.0, END_SPEED, DURATION)
body = add_rotor(mbs, reduced, spin=run_up)
ground = mbs.CreateGround()
for name, y in (("left", -0.2), ("right", 0.2)):
    mbs.CreateCartesianSpringDamper(
        itemNumbers=[ground, body.marker(name)],
        localPosition0=[0, y, 0],
        stiffness=[2e6] * 3,
        damping=[1e3] * 3,
    )
torque, spin = body.add_drive_torque_sensor(), body.add_spin_sensor()

mbs.Assemble()
settings = exudyn.SimulationSettings()
settings.timeIntegration.numberOfSteps = round(1.2 * DURATION / STEP)
settings.timeIntegration.endTime = 1.2 * DURATION
settings.timeIntegration.verboseMode = 0
settings.solution.file.write = False
settings.solution.sensors.writePeriod = STEP
mbs.SolveDynamic(settings)

time, moment = mbs.GetSensorStoredData(torque).T
speed = mbs.GetSensorStoredData(spin)[:, 2]
momentum = body.motion.invariants.Theta * END_SPEED
impulse = np.trapezoid(moment, time)
print(f"impulse {impulse:.6f} N m s, gain of angular momentum {momentum:.6f} N m s")

made, (above, below) = plotting.figure(2, 1, size=(6.5, 5.0), sharex=True)
above.plot(time, speed)
above.set_ylabel("spin speed [rad/s]")
below.plot(time, moment)
below.set_ylabel("drive torque [N m]")
below.set_xlabel("time [s]")
plotting.save(made, "prescribed_spin.png")

assert abs(impulse / momentum - 1.0) < 1e-4
