"""Sensitivity of a magnetic bearing against its loop in closed form."""

import numpy as np
import pytest

from exudyn_rotor import (
    LinearActuator,
    MagneticBearing,
    PIDController,
    SolidRotor,
    Support,
    sensitivity,
)

MASS, GAIN, NEGATIVE = 2.0, 80.0, 3e5


@pytest.fixture(scope="module")
def point():
    return SolidRotor.from_matrices(
        MASS * np.eye(3), np.zeros((3, 3)), [[0, 0, 0]], axis="z", interfaces={"disc": [0]}
    ).reduce(0)


def bearing(proportional: float) -> MagneticBearing:
    controller = PIDController(
        proportional=proportional, derivative=20.0, filter_frequency=2e4, amplifier_frequency=1e4
    )
    return MagneticBearing(
        interface="disc", actuator=LinearActuator(GAIN, NEGATIVE), controller=controller
    )


@pytest.mark.parametrize("speed", [0.0, 400.0])
@pytest.mark.parametrize("extra", [0.0, 1e5])
def test_loop_of_one_mass(point, speed, extra):
    """``S = 1/(1 + L)``, L = k_i G/(−mω² − k_s + k) with the controller's frequency response."""
    one = bearing(2e4)
    frequencies = np.geomspace(10.0, 2e4, 30)
    supports = [one, *([Support("disc", extra)] if extra else [])]
    found = sensitivity(point, frequencies, supports=supports, speed=speed)
    s = 1j * found.frequencies
    butterworth = 1.0 + np.sqrt(2.0) * s / 2e4 + (s / 2e4) ** 2
    response = (2e4 + 20.0 * s) / butterworth / (1.0 + s / 1e4)
    loop = GAIN * response / (MASS * s**2 - NEGATIVE + extra)
    for values in found.values:
        np.testing.assert_allclose(values, 1.0 / (1.0 + loop), rtol=1e-6)


def test_a_peak_beside_own_frequencies_is_found_with_few_points(point):
    few, many = (
        sensitivity(point, np.geomspace(10.0, 2e4, count), supports=[bearing(2e4)]).peaks
        for count in (10, 3000)
    )
    np.testing.assert_allclose(few, many, rtol=1e-5)


def test_an_unstable_loop_is_refused(point):
    with pytest.raises(ValueError, match=r"unstable at 0 rad/s: a motion of .* grows by"):
        sensitivity(point, [10.0, 20.0], supports=[bearing(1e3)])
