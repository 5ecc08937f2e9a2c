"""Lanczos iteration for the lowest modes."""

from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.sparse as sp

from exudyn_rotor.solvers.inertia_relief import free_rigid_motions
from exudyn_rotor.solvers.modes import check_modes, dense_modes, lanczos_modes

SIZE = 400


def oscillators(springs: np.ndarray, masses: np.ndarray) -> tuple[sp.csr_array, Callable]:
    """Return mass matrix and inverse stiffness of uncoupled oscillators."""
    mass = sp.csr_array(sp.diags_array(masses))
    return mass, lambda load: (load.T / springs).T


@pytest.mark.parametrize("count", [1, 3, 20])
def test_eigenvalues_of_oscillators(count):
    springs, masses = np.arange(1.0, SIZE + 1.0) ** 2, np.full(SIZE, 4.0)
    mass, inverse = oscillators(springs, masses)
    values, modes = lanczos_modes(mass, inverse, count, 1e-12)
    np.testing.assert_allclose(values, springs[:count] / 4.0, rtol=1e-13)
    # residuals of 1e-12 turn modes by that over the distance of eigenvalues
    np.testing.assert_allclose(np.abs(modes[:count]), 0.5 * np.eye(count), atol=1e-9)


def test_pairs_are_found_whole():
    springs = np.repeat(np.arange(1.0, SIZE / 2 + 1.0) ** 2, 2)
    mass, inverse = oscillators(springs, np.full(SIZE, 4.0))
    values, modes = lanczos_modes(mass, inverse, 20, 1e-10)
    np.testing.assert_allclose(values, springs[:20] / 4.0, rtol=1e-13)
    np.testing.assert_allclose(modes.T @ (mass @ modes), np.eye(20), atol=1e-13)


FEW = np.where(np.arange(SIZE) < 6, 1.0, 0.0)
INVERSE = SimpleNamespace(without_reactions=lambda forces: forces, precision=1e-16)
MASS, SPRINGS = sp.eye_array(9, format="csr"), sp.diags_array(np.arange(1.0, 10.0), format="csr")
REFUSED = [
    (lambda: lanczos_modes(*oscillators(1.0 + FEW, FEW), 7, 1e-10), "not all nodes may have mass"),
    (lambda: dense_modes(-MASS, np.copy, 1), "not positive definite"),
    (lambda: check_modes(SPRINGS, MASS, INVERSE, np.ones(2), np.eye(9, 2)), "eigenmode 2 does not"),
    (lambda: free_rigid_motions(np.eye(3), MASS, SPRINGS, 6), "claims 6 free .* holds supports"),
]


@pytest.mark.parametrize(("call", "message"), REFUSED)
def test_what_has_no_modes_is_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()
