"""Films answer by their tangents where Exudyn differentiates connectors by differences."""

import numpy as np
import pytest
from void_films import CLEARANCE, SPEED, oil

from exudyn_rotor.bearings.film.reynolds import CAVITATION
from exudyn_rotor.bearings.journal_bearing import FilmLaw, RememberingLaw

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
    """Of one that conserves mass within a step, from the voids at its beginning."""
    film = oil(cavitation=cavitation)
    law = FilmLaw(film, torque=False)
    if cavitation == "mass-conserving":
        law = RememberingLaw(film, torque=False)
        law.begin(0.0, *MOTION, SPEED, 1e-4)
        law.begin(1e-4, *(0.9 * MOTION), SPEED, 3e-4)
    found = -np.hstack(law.slopes(*MOTION, 0.0, SPEED))
    expected = differences(lambda at: law(*at, 0.0, SPEED), MOTION, SIZES)
    np.testing.assert_allclose(
        found * SIZES, expected * SIZES, rtol=0.0, atol=1e-7 * np.abs(expected * SIZES).max()
    )
