"""Films answer by their tangents where Exudyn differentiates connectors by differences."""

import numpy as np
import pytest

from exudyn_rotor import JournalBearing, OilFilm, grooved_pads
from exudyn_rotor.bearings.film.reynolds import CAVITATION

CLEARANCE, SPEED = 1e-4, 580.0

MOTION = np.array([0.3, -0.4, 0.05, 0.02]) * CLEARANCE * np.array([1.0, 1.0, SPEED, SPEED])
SIZES = CLEARANCE * np.array([1.0, 1.0, SPEED, SPEED])
STEP = 1e-5  # of SIZES: the error of central differences is its square, beside 1e-15/STEP


def differences(function, at, sizes):
    """Return central differences of a function by each of its arguments, in columns."""
    moves = np.diag(STEP * sizes)
    ends = [np.subtract(function(at + move), function(at - move)) for move in moves]
    return np.array(ends).T / (2.0 * STEP * sizes)


@pytest.mark.parametrize("cavitation", CAVITATION)
def test_tangent_of_a_film_is_its_derivative(cavitation):
    pads = grooved_pads(CLEARANCE, [0.19], np.radians(20.0))
    film = OilFilm(0.05, 0.05, 0.02, pads, cavitation, nodes=24, axial_nodes=0)
    bearing = JournalBearing(interface="left", film=film)
    found = -np.hstack(bearing.slopes(*MOTION, 0.0, SPEED))
    expected = differences(lambda at: bearing.law(*at, 0.0, SPEED), MOTION, SIZES)
    np.testing.assert_allclose(
        found * SIZES, expected * SIZES, rtol=0.0, atol=1e-7 * np.abs(expected * SIZES).max()
    )
