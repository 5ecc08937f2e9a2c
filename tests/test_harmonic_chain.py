"""Hill's equations solved harmonic by harmonic, against the same as one matrix."""

import numpy as np
import pytest

from exudyn_rotor.linear.periodic.harmonic_chain import solved
from exudyn_rotor.linear.periodic.harmonics import (
    adjoint_slopes,
    convolved,
    hill_matrices,
    slopes,
)
from exudyn_rotor.linear.periodic.inverse_iteration import moved_together
from exudyn_rotor.linear.periodic.periodic_system import EPSILON, ConstantSystems, PeriodicSystem

SIZE, PORTS = 5, 2


def random(*shape: int) -> np.ndarray:
    rng = np.random.default_rng(shape)
    return rng.normal(size=shape) + 1j * rng.normal(size=shape)


def system_of(multiples: tuple[int, ...]) -> PeriodicSystem:
    """Return equations whose coefficients vary with multiples of θ, at a few places only."""
    at = random(PORTS, SIZE).real

    def terms(number: int, size: float) -> dict[int, np.ndarray]:
        Y = random(SIZE, SIZE, number)[:, :, 0].real
        result = {0: size * (Y @ Y.T + np.eye(SIZE))}
        for n in multiples:
            X = 0.1 * size * at.T @ random(PORTS, PORTS, number, n)[:, :, 0, 0] @ at
            result |= {n: X, -n: X.conj()}
        return result

    return PeriodicSystem(3.0, terms(1, 1.0), terms(2, 0.5), terms(3, 20.0))


@pytest.mark.parametrize("multiples", [(), (2,), (1, 2), (1, 3), (2, 4, 6)])
@pytest.mark.parametrize("count", [0, 1, 2, 5])
def test_both_sides_and_slopes_are_those_of_the_whole_matrix(multiples, count):
    system = system_of(multiples)
    orders = (system.step or 1) * np.arange(-count, count + 1)
    X, Y = random(2, len(orders), SIZE, 3)
    values = random(3)
    z, w = solved(system, orders, values, X, Y)
    M, D, K = hill_matrices(system, orders)
    given = convolved(system.M, X, orders), slopes(system, values, X, orders)
    adjoint = adjoint_slopes(system, values, Y, orders)
    for j, rate in enumerate(values):
        H, slope = rate**2 * M + rate * D + K, 2.0 * rate * M + D
        rounding = 1e3 * EPSILON * np.linalg.cond(H)
        for found, expected in (
            (z, np.linalg.solve(H, X[..., j].ravel())),
            (w, np.linalg.solve(H.conj().T, Y[..., j].ravel())),
            (given[0], M @ X[..., j].ravel()),
            (given[1], slope @ X[..., j].ravel()),
            (adjoint, slope.conj().T @ Y[..., j].ravel()),
        ):
            apart = np.linalg.norm(found[..., j].ravel() - expected)
            assert apart <= rounding * np.linalg.norm(expected)


def test_only_motions_at_periodic_coefficients_are_coupled():
    assert system_of(()).ports.shape == (SIZE, 0)
    assert system_of((1, 2)).ports.shape == (SIZE, PORTS)


def test_ports_are_where_any_coefficient_acts_or_is_acted_on():
    unit = np.eye(SIZE)
    terms = {2: 1e-9 * np.outer(unit[0], unit[0])}, {2: 1e9j * np.outer(unit[2], unit[1])}
    D, K = ({0: unit, **part, -2: part[2].conj()} for part in terms)
    ports = PeriodicSystem(3.0, {0: unit}, D, K).ports
    apart = ports @ ports.T - np.diag([1.0, 1.0, 1.0, 0.0, 0.0])
    assert np.abs(apart).max() <= 10.0 * EPSILON


def test_systems_that_stand_still_are_iterated_together():
    system, unit, none = system_of(()), np.eye(SIZE), np.zeros((SIZE, SIZE))
    M, D, K = (terms[0] for terms in (system.M, system.D, system.K))
    terms = np.array([(M, D, K), (M, D, 2.0 * K), (unit, none, none)]).real
    systems = ConstantSystems(*terms.swapaxes(0, 1))
    exact, states = np.linalg.eig(
        [
            np.block([[none, unit], [-np.linalg.solve(m, k), -np.linalg.solve(m, d)]])
            for m, d, k in terms
        ]
    )
    shapes = states[:, :SIZE] / np.linalg.norm(states[:, :SIZE], axis=1, keepdims=True)
    values, wanted = exact * (1.0 + 1e-4), np.ones(exact.shape, dtype=bool)
    wanted[1, ::2] = False
    found = moved_together(systems, values, shapes + 1e-4 * random(*shapes.shape), wanted)
    assert np.array_equal(found[~wanted], values[~wanted])
    # cubic: 1e-12 times the squared condition of the eigenvalues
    np.testing.assert_allclose(found[:2][wanted[:2]], exact[:2][wanted[:2]], rtol=1e-9)
    assert np.all(np.isnan(found[2]))  # a singular matrix
