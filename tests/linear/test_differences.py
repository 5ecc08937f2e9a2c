"""Slopes of a scene's forces by differences, against functions whose slopes are known."""

import numpy as np
import pytest

from exudyn_rotor.linear.model.scene.differences import CURVATURE, differences, slopes

STEP = 1e-4


def test_straight_forces_take_two_calls_for_each_column_and_two_more():
    """Slopes of ``A x``: rounding is 1e-16 of terms of the order of the differences themselves."""
    A = np.random.default_rng(1).normal(size=(3, 4))
    moves, calls = STEP * np.random.default_rng(2).normal(size=(4, 5)), []

    def force(x):
        calls.append(x)
        return A @ x

    found, error = differences(force, moves)
    np.testing.assert_allclose(found, A @ moves, rtol=0.0, atol=1e-13 * np.abs(A @ moves).max())
    assert error < CURVATURE**2
    assert len(calls) == 2 * 5 + 2


@pytest.mark.parametrize("curvature", [1.0, 1e2, 1e4])
def test_third_powers_are_extrapolated(curvature):
    """Central differences of ``x + a x³`` have the error ``a h²``, and those of 2h four times it.

    With ``a h²`` of 1e-8 the extrapolated ones have that of rounding, 1e-16 in three terms.
    """
    found, error = differences(lambda x: x + curvature * x**3, STEP * np.eye(2))
    np.testing.assert_allclose(found, STEP * np.eye(2), rtol=0.0, atol=1e-14 * STEP)
    assert error == pytest.approx(curvature * STEP**2, rel=1e-3)


@pytest.mark.parametrize("gap", [0.5, 1.5])
def test_a_contact_within_two_steps_is_seen(gap):
    """Two columns move the place both ways, which cancels where all move at once."""

    def force(x):
        return np.maximum(x[:1] - x[1:] - gap * STEP, 0.0)

    moves = STEP * np.eye(2)
    assert differences(force, moves)[1] > 0.1
    np.testing.assert_array_equal(slopes(force, moves), 0.0)
