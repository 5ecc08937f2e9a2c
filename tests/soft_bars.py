"""A soft bar of few nodes, and a run of it on two bearings, full or reduced."""

import exudyn
import netgen.occ as occ
import ngsolve
import numpy as np

from exudyn_rotor import SolidRotor, SpinAxis, add_rotor, recommended_settings

STEP, STEPS = 2e-4, 60  # no more instants than are looked at
RUBBER = {"youngsModulus": 2.1e9, "poissonsRatio": 0.3, "density": 7850.0}
AXES = {"y": ([0.0, 1.0, 0.0], [0.01, 0.0, 0.0]), "z": ([0.0, 0.0, 1.0], [0.0, 0.0, 0.0])}


def bar(name):
    """A soft bar of 20 nodes with an unbalance, about z, or about an axis beside it along y."""
    along, shift = map(np.array, AXES[name])
    across = np.roll(along, 1)
    low = -0.03 * across - 0.025 * np.roll(across, 1)
    solid = occ.Box(tuple(low), tuple(0.3 * along - low))
    direction = occ.Y if name == "y" else occ.Z
    solid.faces.Min(direction).name, solid.faces.Max(direction).name = "left", "right"
    mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.3))
    rotor = SolidRotor.from_ngsolve(mesh, RUBBER, SpinAxis(along, shift), order=1)
    return rotor.add_point_mass(0.03 * across + 0.3 * along, 0.2).with_damping(stiffness=1e-4)


def run(rotor, model, damping=200.0, **options):
    """Run on two bearings, with the weight; all steps are recorded."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = add_rotor(mbs, model, gravity=[1.0, -9.81, 3.0], markers="position", **options)
    ground = mbs.CreateGround()
    for name in ("left", "right"):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body.marker(name)],
            localPosition0=rotor.interfaces[name].reference,
            stiffness=[2e5] * 3,
            damping=[damping] * 3,
        )
    body.start_recording()
    mbs.Assemble()
    settings = recommended_settings(STEPS * STEP, STEP, body=body)
    settings.timeIntegration.newton.relativeTolerance = 1e-9
    settings.timeIntegration.newton.absoluteTolerance = 1e-12
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = STEP
    mbs.SolveDynamic(settings)
    return body
