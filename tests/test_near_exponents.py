"""Exponents of periodic equations that are nearly one: how they are found, and their bounds."""

import numpy as np
import pytest
from test_between_samples import chain

from exudyn_rotor import linear_model
from exudyn_rotor.linear.periodic.exponents import motions
from exudyn_rotor.linear.periodic.fundamental import floquet_motions
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem


def apart(values: np.ndarray, others: np.ndarray, base: float) -> np.ndarray:
    """Return the distances of real parts of exponents from those of the same motions."""
    differences = values[:, None] - others
    differences -= 1j * base * np.rint(differences.imag / base)
    nearest = np.argmin(np.abs(differences), axis=1)
    return np.abs(differences[np.arange(len(values)), nearest].real)


def turned_flutter(speed: float, excess: float) -> tuple[PeriodicSystem, np.ndarray]:
    """Return a unit mass on uneven springs seen from axes that turn, and its exponents modulo 2iΩ.

    ``ÿ + 2aẏ + [[k − d, q], [−q, k + d]] y = 0`` has ``(λ + a)² = a² − k ± √(d² − q²)``, where two
    meet at q = d.
    """
    a, k, d = 1e-5, 400.0, 30.0
    q = d * (1.0 + excess)
    J = np.array([[0.0, -1.0], [1.0, 0.0]])
    split = -0.5 * d * (np.diag([1.0, -1.0]) + 1j * J @ np.diag([1.0, -1.0]))
    mean = (k - speed**2) * np.eye(2) + (2.0 * a * speed - q) * J
    damping = 2.0 * (a * np.eye(2) + speed * J)
    system = PeriodicSystem(
        speed, {0: np.eye(2)}, {0: damping}, {0: mean, 2: split, -2: split.conj()}
    )
    inner = np.sqrt(np.array([1.0, -1.0]) * np.sqrt(d**2 - q**2 + 0j) + a**2 - k)
    at_rest = np.concatenate([inner, -inner]) - a
    return system, at_rest + 1j * speed  # of motions seen with one harmonic, ±1


@pytest.mark.parametrize("excess", [1e-12, 1e-8, 1e-4])
def test_bounds_by_floquets_method_are_those_of_the_matrix_not_of_the_tolerance(excess):
    """The first steps meet a loose tolerance by far: growth that it hid is told."""
    system, exact = turned_flutter(30.0, excess)
    for tolerance in (1e-4, 1e-9):
        values, _, bounds = floquet_motions(system, tolerance)
        assert np.all(apart(values, exact, system.base) <= bounds)
        assert bounds.max() < 1e-2
    if excess == 1e-4:
        values, _, bounds = floquet_motions(system, 1e-4)
        assert values.real.max() > 5.0 * bounds.max()


def near_meeting(seed: int) -> PeriodicSystem:
    """Return random equations with terms of the first harmonic, beside a range of instability."""
    rng = np.random.default_rng(seed)
    size, step = int(rng.integers(2, 4)), int(rng.integers(1, 3))
    decay = 10.0 ** rng.uniform(-7.0, -2.0)
    X = rng.normal(size=(size, size))
    M = X @ X.T / size + np.eye(size)
    X = rng.normal(size=(size, size))
    K = 300.0 * (X @ X.T / size + np.eye(size))
    X = rng.normal(size=(2, size, size)) * rng.choice([5.0, 50.0, 150.0]) / size
    wave = X[0] + X[0].T + 1j * (X[1] + X[1].T)
    X = rng.normal(size=(size, size))
    G = 0.1 * (X - X.T) * rng.choice([0.0, 1.0])
    speed = 15.24433863078714
    damping, stiffness = 2.0 * decay * M + speed * G, K + decay * speed * G
    return PeriodicSystem(
        speed, {0: M}, {0: damping}, {0: stiffness, step: wave, -step: wave.conj()}
    )


def test_exponents_that_follow_into_larger_truncations_are_within_their_bounds():
    """They erred by twice these: a step that is small beside Ω is not beside their distance.

    Against Floquet's method at 1e-12, which errs by 3e-11 [1/s]; the shift by the first harmonics
    left out, which the bounds are, is of first order.
    """
    system = near_meeting(3)
    found = motions(system, "hill")
    values, _, _ = floquet_motions(system, 1e-12)
    errors = apart(found.values, values, system.base)
    assert found.bounds.max() < 1e-7
    assert np.all(errors <= 1.2 * found.bounds + 1e-10)


def test_motions_near_copies_of_others_have_the_harmonics_of_these():
    """Hill's method failed its check here; by Floquet's, bounds were 2e-4 1/s."""
    rotor, supports = chain(0, 0.3)
    space = linear_model(rotor, supports=supports).space(0, 500.0, held=True)
    found, system = space.motions(451.3, "hill", 1e-9, False)
    values, _, bounds = floquet_motions(system)
    assert bounds.max() > 1e-5
    assert found.bounds.max() < 1e-7
    assert np.all(apart(found.values, values, system.base) <= found.bounds + 1e-9)
