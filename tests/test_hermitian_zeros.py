"""Speeds at which a Hermitian matrix function is singular."""

import numpy as np
import pytest
import scipy.linalg as la

from exudyn_rotor.linear.modal.hermitian_zeros import zeros_of_eigenvalues
from exudyn_rotor.linear.periodic.periodic_system import UnconvergedError

# a pair in one bracket, a repeated one, one that is touched twice, one above the range
ROOTS = np.array([12.345, 12.346, 40.0, 40.0, 77.7, 120.0])


@pytest.fixture(scope="module")
def found():
    """Return the speeds found with their vectors, those expected, and the matrix function."""
    rng = np.random.default_rng(3)
    turn, _ = np.linalg.qr(rng.normal(size=(8, 8)) + 1j * rng.normal(size=(8, 8)))

    def matrix(speed: float) -> np.ndarray:
        # the seventh is free at all speeds, the eighth never, and negative
        values = [*(ROOTS**2 - speed**2), 0.0, -1.0 - speed]
        H = (turn * values) @ turn.conj().T
        return 0.5 * (H + H.conj().T)

    return zeros_of_eigenvalues(matrix, 100.0), matrix, turn


def test_every_zero_is_found_with_its_vector(found):
    pairs, matrix, turn = found
    # 1e-12 of the range is asked for, and rounding of 1e4 ε moves zeros by 1e-12
    speeds = [speed for speed, _ in pairs]
    np.testing.assert_allclose(speeds, ROOTS[:5], rtol=0.0, atol=2e-10)
    vectors = np.array([vector for _, vector in pairs]).T
    np.testing.assert_allclose(vectors.conj().T @ vectors, np.eye(5), atol=1e-9)
    for speed, vector in pairs:
        assert np.linalg.norm(matrix(speed) @ vector) < 1e-9 * la.norm(matrix(speed))
        assert abs(np.vdot(turn[:, 6], vector)) < 1e-6


def test_a_motion_that_is_free_up_to_some_speed_is_no_free_one():
    """Nothing holds it up to 50; then its stiffness is negative, and none again at 70."""

    def matrix(speed: float) -> np.ndarray:
        above = max(speed - 50.0, 0.0)
        return np.diag([2.0 * above**2 - 40.0 * above, 900.0 - speed**2]).astype(complex)

    speeds = np.array([speed for speed, _ in zeros_of_eigenvalues(matrix, 100.0)])
    for expected in (30.0, 70.0):
        assert np.abs(speeds - expected).min() < 1e-9


def thin_below_forty(speed: float) -> np.ndarray:
    """Return a matrix with zeros at 30 and 60, where a film is not too thin."""
    if speed < 40.3:
        raise UnconvergedError("too thin")
    return np.diag([30.0 - speed, 60.0 - speed]).astype(complex)


def test_speeds_without_equations_are_told():
    with pytest.warns(UserWarning, match=r"up to 40 rad/s none are looked for.*: too thin"):
        found = zeros_of_eigenvalues(thin_below_forty, 100.0)
    np.testing.assert_allclose([speed for speed, _ in found], [60.0], rtol=1e-12)
    with pytest.raises(UnconvergedError, match="too thin"):
        zeros_of_eigenvalues(thin_below_forty, 40.0)
