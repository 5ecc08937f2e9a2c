"""Peaks of responses that are sharper than the steps of the speed, or not there."""

import numpy as np
import pytest
from test_response import rings

from exudyn_rotor import (
    HarmonicForce,
    SolidRotor,
    Support,
    Unbalance,
    harmonic_response,
    unbalance_response,
)


@pytest.mark.parametrize("count", [5, 50, 500])
def test_a_sharp_peak_is_found_between_few_speeds(count):
    """The largest ``m e Ω² / √((k − mΩ²)² + (cΩ)²)`` is ``e / (2D√(1 − D²))`` at ``ω/√(1 − 2D²)``.

    Between two of 50 speeds are thirty times the width Dω; 1 % is what a phase of 0.3 rad leaves.
    """
    mass, frequency, damping = 1.0, 100.0, 1e-3
    support = Support("at", mass * frequency**2, 2.0 * damping * frequency * mass)
    place = [[0.0, 0.0, 0.0]]
    point = SolidRotor.from_matrices(mass * np.eye(3), np.zeros((3, 3)), place, "z")
    point = point.with_interface("at", [0])
    expected = 1e-5 / (2.0 * damping * np.sqrt(1.0 - damping**2))
    given = {"supports": [support], "own": False}
    speeds = np.linspace(10.0, 163.0, count)
    response = unbalance_response(
        point, speeds, [Unbalance("at", 1e-5 * mass)], refine=True, **given
    )
    speed, size = response.peak()
    assert speed == pytest.approx(frequency / np.sqrt(1.0 - 2.0 * damping**2), rel=0.1 * damping)
    assert size == pytest.approx(expected, rel=0.01)
    assert np.isin(speeds, response.speeds).all()
    assert len(response.speeds) < count + 150
    shaken = harmonic_response(point, speeds, HarmonicForce("at", (1.0, 0.0)), refine=True, **{
        "supports": [support]
    })  # fmt: skip
    static = 1.0 / (mass * frequency**2)
    assert shaken.peak()[1] == pytest.approx(0.5 * static / damping, rel=0.01)


def test_a_peak_is_told_to_be_coarse_or_outside():
    rotor, ends = rings(modes=6), ("left", "right")
    supports = [Support(name, 1e5, 1.0) for name in ends]
    unbalances = [Unbalance("left", 1e-4)]
    given = {"supports": supports, "own": False}
    coarse = unbalance_response(rotor, np.linspace(100.0, 200.0, 12), unbalances, **given)
    with pytest.warns(UserWarning, match=r"left: the points around the peak at .* refine=True"):
        coarse.peak("left")
    below = unbalance_response(rotor, np.linspace(1.0, 50.0, 12), unbalances, **given)
    with pytest.raises(ValueError, match="left: the motion has no peak between 1 and 50 rad/s"):
        below.peak("left")
