"""Scenes far from the origin, where rounding in positions is a force on stiff supports."""

import exudyn as exu
import numpy as np
import pytest
from rings import rings

from exudyn_rotor import Support, add_rotor, add_supports, recommended_settings


def path(position, stiffness, tilt_stiffness=0.0):
    """Return the last coordinates of an unbalanced rotor on stiff supports."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(
        mbs, rings(heavy=0.01).reduce(0), spin=60.0, translation="none", position=position
    )
    supports = [Support(name, stiffness, 0.0, tilt_stiffness) for name in ("left", "right")]
    add_supports(body, supports)
    mbs.Assemble()
    settings = recommended_settings(4e-3, 2e-4, accuracy=1e-8, body=body)
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.adaptiveStep = False  # a step that fails is an error at once
    settings.solution.file.write = False
    mbs.SolveDynamic(settings)
    return body.coordinates()[0]


@pytest.mark.parametrize("distance", [10.0, 1e3])
def test_stiff_supports_far_from_the_origin(distance):
    """Forces are left of 1e-15 of stiffness times distance, and their motion is that over k."""
    far = path(distance * np.array([0.5, -0.4, 0.8]), 1e10)
    near = path(np.zeros(3), 1e10)
    np.testing.assert_allclose(far, near, rtol=0.0, atol=1e-13 * distance)


def test_supports_stiff_against_tilts():
    assert np.all(np.isfinite(path(np.zeros(3), 1e3, 1e11)))


def test_rounding_bounds_the_tolerance():
    """Ten times the rounding of 1.0, of the stiffness times the distance."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rings().reduce(0), spin=60.0, position=[3.0, 0.0, 4.0])
    without = recommended_settings(0.1, 1e-3, accuracy=1e-8, body=body)
    add_supports(body, [Support("left", 1e9, 0.0, 1e7), Support("right", 1e6)])
    given = recommended_settings(0.1, 1e-3, accuracy=1e-8, body=body)
    assert without.timeIntegration.newton.absoluteTolerance < 1e-10
    farthest = np.hypot(3.0, 4.15)
    expected = 10.0 * 2.0**-52 * 1e9 * farthest
    assert given.timeIntegration.newton.absoluteTolerance == pytest.approx(expected, rel=1e-6)
