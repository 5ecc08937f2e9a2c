"""A rotor as Exudyn's full 3D body."""

import exudyn
import numpy as np
import pytest
from point_rotors import random_rotor

from exudyn_rotor.theory.axis import rotations, translations
from validation.exudyn_3d.spatial_body import add_spatial_rotor

KINDS = exudyn.OutputVariableType


def settings(duration: float, steps: int) -> exudyn.SimulationSettings:
    made = exudyn.SimulationSettings()
    made.solution.file.write = False
    made.timeIntegration.endTime = duration
    made.timeIntegration.numberOfSteps = steps
    made.timeIntegration.verboseMode = 0
    made.timeIntegration.generalizedAlpha.spectralRadius = 0.9
    made.timeIntegration.newton.relativeTolerance = 1e-10
    made.timeIntegration.newton.absoluteTolerance = 1e-12
    made.linearSolver.solverType = exudyn.LinearSolverType.EigenSparse
    return made


@pytest.fixture(scope="module")
def rotor():
    return random_rotor(1).with_interface("end", [1, 4], [1.0, 3.0])


def test_fall_with_a_spin(rotor):
    """The centre of mass falls by ``v t + g t²/2``; no rigid motion goes into the displacements."""
    gravity, velocity, t = np.array([1.0, -2.0, 3.0]), np.array([0.3, 0.1, 0.2]), 0.2
    mbs = exudyn.SystemContainer().AddSystem()
    body = add_spatial_rotor(
        mbs,
        rotor,
        gravity=gravity,
        velocity=velocity,
        angular_velocity=rotor.axis.direction,
    )
    mbs.Assemble()
    mbs.SolveDynamic(settings(t, 50))
    found = mbs.GetNodeOutput(body.frame, KINDS.Displacement)
    # quadratic in time: exact for the integrator, Newton's tolerance remains
    np.testing.assert_allclose(found, velocity * t + 0.5 * gravity * t**2, rtol=0, atol=1e-9)
    flexible = mbs.systemData.GetODE2Coordinates()[7:]
    assert np.linalg.norm(flexible) > 1e-3
    nodes = rotor.nodes - rotor.center_of_mass
    rigid = np.hstack([translations(len(nodes)), rotations(nodes, np.zeros(3))])
    moments = rigid.T @ (rotor.mass @ flexible)
    np.testing.assert_allclose(moments, 0.0, atol=1e-9)
