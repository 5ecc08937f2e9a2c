"""Forced harmonics by what couples them, against the same equations as one matrix."""

import numpy as np
import pytest

from exudyn_rotor.linear.periodic import coupled_harmonics, harmonic_balance
from exudyn_rotor.linear.periodic.coupled_harmonics import (
    CoupledHarmonics,
    inverted,
    links_of,
    norm_of_inverse,
)
from exudyn_rotor.linear.periodic.harmonic_balance import forced_motion, forced_motions
from exudyn_rotor.linear.periodic.harmonics import hill_matrices
from exudyn_rotor.linear.periodic.periodic_system import EPSILON, PeriodicSystem

SIZE, PORTS, SPEED = 8, 3, 1.3
ORDERS = {1: np.arange(-3, 4), 2: np.arange(-4, 5, 2)}


def system_of(
    multiples: tuple[int, ...], damping: float = 0.3, H: np.ndarray | None = None
) -> PeriodicSystem:
    """Return equations whose coefficients vary with multiples of θ, at a few places only."""
    rng = np.random.default_rng(len(multiples))
    at = rng.normal(size=(PORTS, SIZE))

    def terms(size: float) -> dict[int, np.ndarray]:
        Y = rng.normal(size=(SIZE, SIZE))
        result = {0: size * (Y @ Y.T / SIZE + np.eye(SIZE))}
        for n in multiples:
            small = rng.normal(size=(2, PORTS, PORTS))
            X = 0.02 * size * at.T @ (small[0] + 1j * small[1]) @ at
            result |= {n: X, -n: X.conj()}
        return result

    return PeriodicSystem(SPEED, terms(1.0), terms(damping), terms(20.0), H)


def coupled(system: PeriodicSystem, orders: np.ndarray, rate: float) -> CoupledHarmonics:
    matrices = system.dynamic(0, 1j * (rate + orders * system.speed))
    ports = np.broadcast_to(system.ports, (len(orders), *system.ports.shape))
    links = links_of(system.between_ports, orders, rate)
    return CoupledHarmonics(matrices, inverted(matrices), ports, links)


def as_one(system: PeriodicSystem, orders: np.ndarray, rate: float) -> np.ndarray:
    M, D, K = hill_matrices(system, orders)
    return K + 1j * rate * D - rate**2 * M


@pytest.mark.parametrize("rate", [0.0, 0.7])
@pytest.mark.parametrize("multiples", [(2,), (1, 2), (1, 3)])
def test_harmonics_and_condition_are_those_of_one_matrix(multiples, rate):
    system = system_of(multiples)
    orders = ORDERS[system.step]
    load = np.random.default_rng(1).normal(size=(2, len(orders), SIZE))
    load = load[0] + 1j * load[1]
    A, harmonics = as_one(system, orders, rate), coupled(system, orders, rate)
    found, condition = harmonics.solved(load)
    exact = np.linalg.solve(A, load.ravel()).reshape(load.shape)
    assert np.linalg.norm(found - exact) < 30 * EPSILON * np.linalg.cond(A) * np.linalg.norm(exact)
    assert harmonics._norm >= np.linalg.norm(A, 1)
    back = harmonics._back(load[..., None])[..., 0]
    exact = np.linalg.solve(A.conj().T, load.ravel()).reshape(load.shape)
    assert np.linalg.norm(back - exact) < 30 * EPSILON * np.linalg.cond(A) * np.linalg.norm(exact)
    # the norm is a bound, that of the inverse an estimate: Higham has it within a factor of 3
    true = 1.0 / np.linalg.cond(A, 1)
    assert true / 10.0 < condition < 3.0 * true


def test_nothing_couples_harmonics_of_constant_coefficients(capfd):
    """Masses of 1 kg on springs of 2 to 3 N/m at 0.5 rad/s, F/(k − ω²); LAPACK has no complaint."""
    size = 2 * coupled_harmonics._LARGE
    stiffness = np.linspace(2.0, 3.0, size)
    system = PeriodicSystem(1.0, {0: np.eye(size)}, {0: np.zeros((size, size))},
                            {0: np.diag(stiffness)})  # fmt: skip
    found = forced_motion(system, {0: np.ones(size, dtype=complex)}, 0.5, 1e-10)
    np.testing.assert_allclose(found[0], 1.0 / (stiffness - 0.25), rtol=1e-13)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("seed", range(8))
def test_norm_of_an_inverse_is_estimated_from_below(seed):
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(12, 12)) + 1j * rng.normal(size=(12, 12))
    A[:, seed] *= 1e-6  # one column of the inverse is much larger
    inverse = np.linalg.inv(A)
    found = norm_of_inverse(inverse.__matmul__, inverse.conj().T.__matmul__, 12)
    exact = np.linalg.norm(inverse, 1)
    assert exact / 3.0 <= found <= (1.0 + 1e-12) * exact


def both_ways(
    monkeypatch, system: PeriodicSystem, *given, alone: bool = True
) -> list[dict[int, np.ndarray]]:
    """Return the motion by what couples harmonics, `alone` if that has to do, and as one matrix."""
    found = []
    for least, forbidden in ((0, alone), (10**9, False)):
        with monkeypatch.context() as changed:
            changed.setattr(coupled_harmonics, "_LARGE", least)
            if forbidden:
                changed.delattr(harmonic_balance, "_factorised")
            found.append(forced_motion(system, *given))
    return found


def assert_alike(found: list[dict[int, np.ndarray]], tolerance: float) -> None:
    one, other = (np.array([X for _, X in sorted(motion.items())]) for motion in found)
    assert one.shape == other.shape
    assert np.linalg.norm(one - other) <= tolerance * np.linalg.norm(other)


@pytest.mark.parametrize("multiples", [(2,), (1, 2)])
def test_structural_damping_and_a_drive_are_in_each_harmonic(multiples, monkeypatch):
    H = np.diag(np.linspace(0.5, 2.0, SIZE))
    system = system_of(multiples, H=H)
    loads = {0: np.linspace(1.0, 2.0, SIZE) + 0j, 2: np.full(SIZE, 1j)}
    # round-off times a condition of about 1e3
    found = both_ways(monkeypatch, system, loads, 0.0, 1e-10, [2])
    assert found[0][0][2] == 0.0
    assert_alike(found, 1e-12)
    assert_alike(both_ways(monkeypatch, system, loads, 0.7, 1e-10, [2]), 1e-12)


def test_a_motion_that_nothing_holds_stays_where_it_is(monkeypatch):
    system = system_of((2,))
    free = {n: np.pad(X, (0, 1)) for n, X in system.K.items()}
    M = {n: np.pad(X, (0, 1)) for n, X in system.M.items()}
    M[0][-1, -1], M[0][-1, 0], M[0][0, -1] = 1.0, 0.1, 0.1
    D = {n: np.pad(X, (0, 1)) for n, X in system.D.items()}
    given = {0: np.append(np.ones(SIZE), 0.0) + 0j}
    found = both_ways(monkeypatch, PeriodicSystem(SPEED, M, D, free), given, 0.0, 1e-10)
    assert abs(found[0][0][-1]) < 1e-14
    assert_alike(found, 1e-12)


@pytest.mark.parametrize(("close", "alone"), [(0.0, False), (1e-13, False), (1e-6, True)])
def test_a_harmonic_at_resonance_that_others_hold(close, alone, monkeypatch):
    """Without the coefficients that turn, the matrix of this harmonic is singular, or close to."""
    system = system_of((2,))
    # one coordinate alone: its mean stiffness balances its inertia
    for terms in (system.M, system.D, system.K):
        terms[0][0, 1:] = terms[0][1:, 0] = 0.0
    system.D[0][0, 0] = 0.0
    system.K[0][0, 0] = (1.0 + close) * (2.0 * SPEED) ** 2 * system.M[0][0, 0]
    system = PeriodicSystem(SPEED, system.M, system.D, system.K)
    matrix = system.dynamic(0, np.array([2j * SPEED]))[0]
    assert np.linalg.cond(matrix) > 1e6
    A = as_one(system, np.arange(-6, 7, 2), 0.0)
    assert np.linalg.cond(A) < 1e5
    found = both_ways(monkeypatch, system, {0: np.ones(SIZE) + 0j}, 0.0, 1e-10, alone=alone)
    assert_alike(found, 10 * EPSILON * np.linalg.cond(A))


def test_a_singular_whole_is_refused(monkeypatch):
    """An undamped coordinate beside others at its resonance: what couples harmonics misses it."""
    monkeypatch.setattr(coupled_harmonics, "_LARGE", 0)
    system = system_of((2,))
    frequency = np.sqrt(12.0)

    def beside(terms: dict, value: float) -> dict:
        result = {n: np.pad(X, (0, 1)) for n, X in terms.items()}
        result[0][-1, -1] = value
        return result

    terms = beside(system.M, 1.0), beside(system.D, 0.0), beside(system.K, frequency**2)
    system = PeriodicSystem(SPEED, *terms)
    with pytest.raises(ValueError, match="the equations are singular: a resonance"):
        forced_motion(system, {0: np.ones(SIZE + 1) + 0j}, frequency, 1e-9)
    assert harmonic_balance.worth_it(system, 3)


def test_several_loads_are_answered_as_each_alone():
    """Loads of other harmonics, with other numbers of further ones that they need."""
    system = system_of((1, 2))
    loads = [{n: np.eye(SIZE)[n] + 0j} for n in range(3)]
    found = forced_motions(system, loads, 0.7, 1e-9)
    for load, motion in zip(loads, found, strict=True):
        alone = forced_motion(system, load, 0.7, 1e-9)
        assert list(motion) == list(alone)
        most = max(np.abs(x).max() for x in alone.values())
        for n, x in alone.items():
            np.testing.assert_allclose(motion[n], x, atol=1e-12 * most)


def test_several_loads_leave_other_motions_free():
    """Constant forces of 1 N: F/k where they act on a soft motion, which else stays put."""
    stiffness = np.array([1.0, 1e-13])  # of masses of 1 kg that turn at 1 rad/s
    system = PeriodicSystem(1.0, {0: np.eye(2)}, {0: np.zeros((2, 2))}, {0: np.diag(stiffness)})
    loads = [{0: np.array([1.0, y], dtype=complex)} for y in (0.0, 1.0)]
    found = forced_motions(system, loads, 0.0, 1e-9)
    np.testing.assert_allclose([x[0] for x in found], [[1.0, 0.0], 1.0 / stiffness], rtol=1e-10)
