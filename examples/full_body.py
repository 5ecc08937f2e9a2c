"""A full body: all nodal displacements in a scene, beside component modes, with its stress.

The same rotor runs twice, at constant speed under gravity and an unbalance: in full and with twelve
Craig–Bampton modes, whose frequencies are within a per cent here. So must the motion be.
"""

import exudyn
import ngsolve
import numpy as np
from netgen import occ

from exudyn_rotor import (
    SolidRotor,
    add_rotor,
    craig_bampton_modes,
    plotting,
    recommended_settings,
)

SPEED, STEP, STEPS = 200.0, 2e-4, 150  # rad/s, s

solid = occ.Cylinder(occ.Pnt(0, 0, -0.2), occ.Z, 0.02, 0.4)
solid += occ.Cylinder(occ.Pnt(0, 0, 0.05), occ.Z, 0.08, 0.03)
solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = "left", "right"
mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.1, curvaturesafety=0.5))
steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
rotor = SolidRotor.from_ngsolve(mesh, steel, axis="z").center_interfaces()
rotor = rotor.add_point_mass([0.08, 0, 0.065], 0.01)


def journal(source):
    """Return the body and the motion of its right journal."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = add_rotor(
        mbs, source, spin=SPEED, translation="none", gravity=[0, -9.81, 0], markers="position"
    )
    for name, z in (("left", -0.2), ("right", 0.2)):
        ground = mbs.CreateGround(referencePosition=[0, 0, z])
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body.marker(name)], stiffness=[5e6] * 3, damping=[1e3] * 3
        )
    sensor = body.add_interface_sensor("right", exudyn.OutputVariableType.Displacement)
    mbs.Assemble()
    settings = recommended_settings(STEPS * STEP, STEP, body=body)
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = STEP
    mbs.SolveDynamic(settings)
    return body, mbs.GetSensorStoredData(sensor)[:, 1:]


full, in_full = journal(rotor)
_, in_modes = journal(rotor.reduce(craig_bampton_modes(rotor, 12, coupling="RBE3")))
print(full.report())
difference = np.abs(in_full - in_modes).max() / np.abs(in_full).max()
print(f"{full.node_count} nodes, journal within {difference:.1e} of that in 12 modes")
stress = full.stress()
print(f"largest axial stress at the end: {np.abs(stress[:, 2]).max() / 1e6:.2f} MPa")
bent = rotor.nodes + 3e3 * full.displacement()
axial = stress[:, 2] / 1e6
axes = plotting.draw_surface(
    bent, rotor.triangles, axial, "axial stress [MPa]; displacements × 3000"
)
plotting.save(axes, "full_body.png")
assert difference < 1e-2
