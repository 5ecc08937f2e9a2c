"""Lanczos iteration for the lowest modes."""

from collections.abc import Callable

import numpy as np
import pytest
import scipy.sparse as sp

from exudyn_rotor.solvers.lanczos import lanczos_modes

SIZE = 400


def oscillators(springs: np.ndarray, masses: np.ndarray) -> tuple[sp.csr_array, Callable]:
    """Return mass matrix and inverse stiffness of uncoupled oscillators."""
    mass = sp.csr_array(sp.diags_array(masses))
    return mass, lambda load: load / springs[:, None]


@pytest.mark.parametrize("count", [1, 3, 20])
def test_eigenvalues_of_oscillators(count):
    springs, masses = np.arange(1.0, SIZE + 1.0) ** 2, np.full(SIZE, 4.0)
    mass, inverse = oscillators(springs, masses)
    values, modes = lanczos_modes(mass, inverse, count, 1e-12)
    np.testing.assert_allclose(values, springs[:count] / 4.0, rtol=1e-13)
    # residuals of 1e-12 turn modes by that over the distance of eigenvalues
    np.testing.assert_allclose(np.abs(modes[:count]), 0.5 * np.eye(count), atol=1e-9)


def test_restarts_where_eigenvalues_lie_close():
    """Fifteen columns are kept for one mode; neighbours 0.1 % away take many more."""
    springs = 1.0 + 1e-3 * np.arange(SIZE)
    mass, inverse = oscillators(springs, np.ones(SIZE))
    asked = []
    values, _ = lanczos_modes(mass, lambda load: asked.append(1) or inverse(load), 1, 1e-9)
    assert len(asked) > 15
    np.testing.assert_allclose(values, springs[:1], rtol=1e-13)


def test_pairs_and_fewer_masses_than_coordinates():
    """A block holds both motions of a pair; five masses move in five motions, and no more."""
    springs, masses = np.full(SIZE, 10.0), np.zeros(SIZE)
    masses[:6], springs[:6] = 1.0, [1.0, 1.0, 2.0, 2.0, 3.0, 3.0]
    mass, inverse = oscillators(springs, masses)
    values, modes = lanczos_modes(mass, inverse, 6, 1e-10)
    np.testing.assert_allclose(values, springs[:6], rtol=1e-13)
    np.testing.assert_allclose(modes.T @ (mass @ modes), np.eye(6), atol=1e-13)
    with pytest.raises(ValueError, match="only 6 of 7 modes converged to 1e-10; ask for more"):
        lanczos_modes(mass, inverse, 7, 1e-10)


@pytest.mark.parametrize(("copies", "count"), [(3, 4), (5, 6), (9, 11), (13, 18)])
def test_more_copies_than_a_block_has_columns(copies, count):
    """Blades alike, or a rotor on springs that are equal in all directions."""
    springs = np.sort(
        np.concatenate([np.full(copies, 2.0), np.arange(1.0, SIZE - copies + 1) ** 2])
    )
    mass, inverse = oscillators(springs, np.ones(SIZE))
    values, modes = lanczos_modes(mass, inverse, count, 1e-10)
    np.testing.assert_allclose(values, springs[:count], rtol=1e-12)
    np.testing.assert_allclose(modes.T @ (mass @ modes), np.eye(count), atol=1e-12)
