"""Advice before and after a run: what to model, and whether the assumptions held.

The proposal is checked against a finer model: all modes, and a quarter of the step.
"""

import exudyn
import ngsolve
import numpy as np
from netgen import occ

from exudyn_rotor import SolidRotor, Support, add_rotor, check_run, craig_bampton_modes, propose

SPEED, BEARING, DAMPING, ACCURACY = 300.0, 2e6, 4e3, 1e-2  # rad/s, N/m, N s/m
shaft = occ.Cylinder(occ.Pnt(0, 0, -0.3), occ.Z, 0.015, 0.6)
solid = shaft + occ.Cylinder(occ.Pnt(0, 0, -0.02), occ.Z, 0.12, 0.04)
solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = "left", "right"
mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.04, curvaturesafety=1.0))
steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
rotor = SolidRotor.from_ngsolve(mesh, steel, axis="z").center_interfaces()
rotor = rotor.add_point_mass([0.12, 0, 0], 0.005)
modes = craig_bampton_modes(rotor, 10, coupling="RBE3")
reduced = rotor.reduce(modes, prestress=True)  # more modes than will be needed

supports = [Support(name, BEARING * np.eye(3), DAMPING * np.eye(3)) for name in ("left", "right")]
proposal = propose(reduced, speeds=SPEED, supports=supports, accuracy=ACCURACY)
print(proposal)


def run(model, per_turn: int):
    """Return the body and the orbit of the right journal over the last revolutions [m]."""
    SC = exudyn.SystemContainer()
    mbs = SC.AddSystem()
    body = add_rotor(mbs, model, gravity=[0, -9.81, 0], **proposal.options())
    ground = mbs.CreateGround()
    for name, z in (("left", -0.3), ("right", 0.3)):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body.marker(name)],
            localPosition0=[0, 0, z],
            stiffness=[BEARING] * 3,
            damping=[DAMPING] * 3,
        )
    orbit = body.add_interface_sensor("right", exudyn.OutputVariableType.Displacement)
    body.start_recording()
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    integration = settings.timeIntegration
    integration.numberOfSteps, integration.endTime = TURNS * per_turn, TURNS * PERIOD
    integration.verboseMode, settings.solution.file.write = 0, False
    settings.solution.sensors.writePeriod = PERIOD / steps
    mbs.SolveDynamic(settings)
    return body, mbs.GetSensorStoredData(orbit)[-3 * steps :, 1:3]


TURNS, PERIOD = 30, 2 * np.pi / SPEED
steps = int(np.ceil(PERIOD / proposal.step))  # a revolution
body, orbit = run(proposal.truncated(reduced), steps)
_, finer = run(reduced, 4 * steps)
check = check_run(body, reduced=reduced, proposal=proposal)
print(check)

error = np.abs(orbit - finer).max() / np.abs(finer - finer.mean(axis=0)).max()
print(
    f"{proposal.count} of {proposal.total} modes, {steps} steps a revolution: "
    f"the orbit is {error:.1e} off that of all modes with a quarter of the step"
)
assert error < ACCURACY
assert check.ok
