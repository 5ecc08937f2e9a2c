"""Mass matrices and pseudo forces from the positions of the nodes, by differentiation alone."""

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp

STEP = 1e-30  # of a complex derivative: exact, as positions are analytic functions


def jacobian(positions: Callable, q: np.ndarray) -> np.ndarray:
    """Return ``∂p/∂q`` of nodal positions (n, 3), shape (3n, size)."""
    unit = np.eye(len(q))
    columns = [positions(q + 1j * STEP * unit[i]).imag.ravel() / STEP for i in range(len(q))]
    return np.stack(columns, axis=-1)


def inertia(positions: Callable, mass: sp.csr_array, q: np.ndarray) -> np.ndarray:
    """Return the mass matrix ``JᵀMJ``."""
    J = jacobian(positions, q)
    return J.T @ (mass @ J)


def pseudo_forces(
    positions: Callable, mass: sp.csr_array, q: np.ndarray, q_t: np.ndarray
) -> np.ndarray:
    """Return ``−JᵀM(J̇ q̇)``, what moves with q̇ and without acceleration resists."""

    def velocity(s: float) -> np.ndarray:
        return positions(q + s * q_t + 1j * STEP * q_t).imag.ravel() / STEP

    return -jacobian(positions, q).T @ (mass @ derivative(velocity))


def derivative(function: Callable, step: float = 2e-3) -> np.ndarray:
    """Return d/ds at s = 0, sixth-order central difference."""
    weights = {1: 45.0, 2: -9.0, 3: 1.0}
    sides = (w * (function(i * step) - function(-i * step)) for i, w in weights.items())
    return sum(sides) / (60.0 * step)
