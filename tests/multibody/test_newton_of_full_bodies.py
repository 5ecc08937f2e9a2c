"""Recommended settings keep their accuracy in runs of full bodies with stiff parts."""

import exudyn
import numpy as np
import pytest
from models import disc_rotor
from test_full_bodies import STEP, tight_settings

from exudyn_rotor import Support, add_rotor, add_supports, recommended_settings
from exudyn_rotor.solid.clamp import clamped_coordinates

UNEVEN = np.diag([2e7, 3e7, 1e7])


def with_disc(rotor):
    return rotor.add_disc(0.1, 3.0, [2e-2, 1.2e-2], 0.1)


STIFF = {
    "clamped": (lambda rotor: rotor.clamped("left"), ["right"]),
    "clamped in part": (lambda rotor: rotor.clamped("left", ["x", "z"]), ["right"]),
    "clamped across": (lambda rotor: rotor.clamped("left", ["radial"]), ["right"]),
    "with a rigid disc": (with_disc, ["left", "right"]),
}


@pytest.mark.parametrize("case", STIFF)
def test_newtons_errors_are_below_the_accuracy(case):
    """On supports whose stiffness changes as the rotor turns, so that Newton has to iterate.

    The accuracy of recommended_settings by default is 1e-4; the reference is converged to 1e-6.
    """
    make, held = STIFF[case]
    rotor = make(disc_rotor(order=1))
    paths = []
    for settings_of in (recommended, converged):
        mbs = exudyn.SystemContainer().AddSystem()
        body = add_rotor(mbs, rotor, spin=400.0, translation="none", gravity=[1.0, -9.81, 3.0])
        add_supports(body, [Support(name, UNEVEN, 500.0 * np.eye(3)) for name in held])
        path = body.add_interface_sensor("right", exudyn.OutputVariableType.Displacement)
        mbs.Assemble()
        mbs.SolveDynamic(settings_of(body))
        paths.append(mbs.GetSensorStoredData(path)[:, 1:])
    assert np.abs(paths[0] - paths[1]).max() < 1e-4 * np.abs(paths[1]).max()


def recommended(body):
    settings = converged(body)
    return recommended_settings(30 * STEP, STEP, body=body, settings=settings)


def converged(body):
    settings = tight_settings(body, STEP, 30)
    settings.timeIntegration.newton.relativeTolerance = 1e-9
    return settings


def test_springs_to_the_ground_are_no_clamps():
    """A coordinate on a spring alone is clamped where that is far stiffer than all the rest."""
    stiffness = disc_rotor(order=1).clamped("left", "y").stiffness
    nodes = disc_rotor(order=1).interfaces["left"].nodes
    assert np.array_equal(np.flatnonzero(clamped_coordinates(stiffness)), np.sort(3 * nodes + 1))
    softer = stiffness.copy()
    softer.data[stiffness.data == stiffness.data.max()] *= 1e-3
    assert not clamped_coordinates(softer).any()
    assert not clamped_coordinates(type(stiffness)(np.diag([1e9, 1.0, 1e15]))).any()
