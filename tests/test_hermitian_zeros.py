"""Speeds at which a Hermitian matrix function is singular."""

import numpy as np
import pytest
import scipy.linalg as la

from exudyn_rotor.linear.modal import zeros_between
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


def test_zeros_below_the_first_bracket_are_found():
    """Brackets up to 100 begin at 0.5; what nothing holds, −Ω², is negative without a zero."""

    def matrix(speed: float) -> np.ndarray:
        return np.diag([0.123**2 - speed**2, 0.02**2 - speed**2, 60.0 - speed, -(speed**2)]) + 0j

    speeds = [speed for speed, _ in zeros_of_eigenvalues(matrix, 100.0)]
    np.testing.assert_allclose(speeds, [0.02, 0.123, 60.0], rtol=0.0, atol=2e-10)


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


def tabulated(seed: int, size: int = 7):
    """Return ``K(Ω) − Ω²B`` with a random table of K, which is interpolated linearly, to 100."""
    rng = np.random.default_rng(seed)

    def hermitian() -> np.ndarray:
        X = rng.normal(size=(size, size)) + 1j * rng.normal(size=(size, size))
        return X + X.conj().T

    knots = np.linspace(0.0, 100.0, 7)
    table = np.array([hermitian() + 10.0 * np.eye(size) for _ in knots])
    B = 0.004 * (np.diag(rng.uniform(0.2, 2.0, size)) + 0.05 * hermitian())
    if seed % 2:  # two of each
        table, B = (np.kron(X, np.eye(2)) for X in (table, B))

    def matrix(speed: float) -> np.ndarray:
        above = min(max(int(np.searchsorted(knots, speed)), 1), len(knots) - 1)
        share = (speed - knots[above - 1]) / (knots[above] - knots[above - 1])
        return (1.0 - share) * table[above - 1] + share * table[above] - speed**2 * B

    return matrix


@pytest.mark.parametrize("seed", range(8))
def test_zeros_of_tables_are_those_of_a_dense_scan(seed):
    """As many as signs change in every 20th of the parts that are looked at, at few matrices."""
    matrix, calls = tabulated(seed), []

    def counted(speed: float) -> np.ndarray:
        calls.append(speed)
        return matrix(speed)

    zeros = zeros_of_eigenvalues(counted, 100.0)
    speeds = np.array([speed for speed, _ in zeros])
    dense = np.linspace(0.5, 100.0, 200 * 20 - 19)
    eigenvalues = np.linalg.eigvalsh(np.array([matrix(speed) for speed in dense]))
    changes = np.abs(np.diff(np.count_nonzero(eigenvalues < 0.0, axis=1)))
    assert changes.sum() >= 4
    np.testing.assert_array_equal(np.histogram(speeds, dense)[0], changes)
    for speed, vector in zeros:
        H = matrix(speed)
        assert np.linalg.norm(H @ vector) < 1e-9 * la.norm(H)
    if seed % 2:  # the vectors of a double zero are orthogonal
        pairs = np.array([vector for _, vector in zeros]).reshape(-1, 2, 14)
        assert np.abs(np.einsum("pi,pi->p", pairs[:, 0].conj(), pairs[:, 1])).max() < 1e-9
    assert len(calls) < 200 + 12 * len(zeros)


def test_two_zeros_of_opposite_sense_do_not_stand_for_two_others():
    """In one part of the range three eigenvalues get positive and one negative, amid these."""
    places, senses = np.array([10.1, 10.2, 10.3, 10.45]), np.array([1.0, 1.0, -1.0, 1.0])
    rng = np.random.default_rng(5)
    turn, _ = np.linalg.qr(rng.normal(size=(4, 4)) + 1j * rng.normal(size=(4, 4)))

    def matrix(speed: float) -> np.ndarray:
        return (turn * (senses * (speed - places))) @ turn.conj().T

    speeds = [speed for speed, _ in zeros_of_eigenvalues(matrix, 100.0)]
    assert len(speeds) == 2
    assert speeds[0] == pytest.approx(10.1, rel=1e-11)
    assert np.abs(places[1:] - speeds[1]).min() < 1e-9


def test_zeros_that_are_nearly_one_are_two(monkeypatch):
    """They differ by a share of 1e-10 to 1e-3 of the range; without Brent's method."""
    monkeypatch.setattr(zeros_between, "_bisected", None)
    rng = np.random.default_rng(8)
    turn, _ = np.linalg.qr(rng.normal(size=(6, 6)) + 1j * rng.normal(size=(6, 6)))
    for apart in 10.0 ** np.arange(-8.0, 0.0):
        places = np.array([30.3, 30.3 + apart, 70.2, 71.2, 72.2, 73.2])

        def matrix(speed: float, places: np.ndarray = places) -> np.ndarray:
            return (turn * (speed**2 - places**2)) @ turn.conj().T

        speeds = [speed for speed, _ in zeros_of_eigenvalues(matrix, 100.0)]
        np.testing.assert_allclose(speeds, places, rtol=0.0, atol=3e-11)


def test_zeros_that_are_missed_are_looked_for_between_others(monkeypatch):
    """Eigenvalues ``(p/Ω)⁶ − 1`` with zeros p, far from linear; each as a whole takes 116 matrices.

    Without Brent's method.
    """
    monkeypatch.setattr(zeros_between, "_bisected", None)
    rng = np.random.default_rng(0)
    turn, _ = np.linalg.qr(rng.normal(size=(6, 6)) + 1j * rng.normal(size=(6, 6)))
    places, calls = np.linspace(10.5, 19.5, 6), []

    def matrix(speed: float) -> np.ndarray:
        calls.append(speed)
        return (turn * ((places / speed) ** 6 - 1.0)) @ turn.conj().T

    zeros = zeros_between.zeros_between(matrix, (10.0, 20.0), (0, 6), 100.0)
    np.testing.assert_allclose([speed for speed, _ in zeros], places, rtol=0.0, atol=1e-10)
    assert len(calls) < 90
