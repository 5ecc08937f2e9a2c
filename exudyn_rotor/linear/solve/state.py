"""First-order form of linear equations, scaled so that stiff supports cost few digits.

With the modes V and frequencies ω of the mean stiffness, ``VᵀKV = diag(ω²)`` in mass-orthonormal
coordinates, the state is ``z = (ω Vᵀx, Vᵀẋ)``. Without damping ``ż = A z`` then has a skew matrix
of the size of the largest ω, where the usual companion matrix has entries of the size of ω²:
growth is exact to rounding of ω even on supports of 1e14 N/m.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.linalg as la

from exudyn_rotor.linear.equations import PeriodicSystem

EPSILON = float(np.finfo(float).eps)
_LEAST = 1e-6  # of the largest ω: a motion with next to no stiffness is scaled by it
_FREE = 1e-12  # of matrices with diagonals of one: a free motion


class States(NamedTuple):
    """``ż = Σ A_n exp(inθ) z`` and ``x = shape z``: Fourier terms A_n (2k, 2k), shape (k, 2k)."""

    A: dict[int, np.ndarray]
    shape: np.ndarray


def states_of(system: PeriodicSystem) -> States:
    """Return the first-order form of a system."""
    M, k = system.M, system.size
    root = None
    if np.any(np.eye(k) != M):  # Lᵀx are mass-orthonormal coordinates
        root = la.solve_triangular(la.cholesky(M, lower=True), np.eye(k), lower=True).T
    D, K = _terms(system, root)
    symmetric = 0.5 * (K[0] + K[0].T)
    squares, V = np.linalg.eigh(symmetric)
    omega = np.sqrt(np.abs(squares))
    omega = np.maximum(omega, max(_LEAST * omega.max(initial=0.0), 1e-3))
    A = {}
    for n in sorted({*D, *K}):
        damping, stiffness = (V.T @ X[n] @ V if n in X else np.zeros((k, k)) for X in (D, K))
        if n == 0:
            stiffness = V.T @ (K[0] - symmetric) @ V + np.diag(squares)
        A[n] = np.zeros((2 * k, 2 * k), dtype=stiffness.dtype if n == 0 else complex)
        A[n][k:, :k], A[n][k:, k:] = -stiffness / omega, -damping
    A[0][:k, k:] = np.diag(omega)
    shape = (V if root is None else root @ V) / omega
    return States(A, np.hstack([shape, np.zeros((k, k))]))


def _terms(system: PeriodicSystem, root: np.ndarray | None) -> tuple[dict, dict]:
    """Return damping and stiffness per unit of mass; at rest the sum of all harmonics."""
    if system.speed == 0.0:
        _, D, K = system.matrices()
        D, K = {0: D}, {0: K}
    else:
        D, K = system.D, system.K
    if root is None:
        return dict(D), dict(K)
    return tuple({n: root.T @ X @ root for n, X in terms.items()} for terms in (D, K))


def free_directions(systems: list[PeriodicSystem]) -> np.ndarray:
    """Return motions that neither stiffness nor damping resist at any of some speeds.

    Columns, mass-orthonormal, shape (k, f). Coordinates by themselves come as they are.
    """
    k = systems[0].size
    matrices = [X for s in systems for terms in (s.D, s.K) for X in terms.values()]
    parts = [part for X in matrices for part in (X.real, X.imag) if np.any(part)]
    if not parts:
        return _orthonormal(np.eye(k), systems[0].M)
    rows, columns = (np.max([np.abs(X).max(axis=axis) for X in parts], axis=0) for axis in (1, 0))
    size = np.maximum(rows, columns)
    alone = size <= _FREE * size.max()
    scale = 1.0 / np.sqrt(np.where(alone, 1.0, size))
    stack = np.vstack([(scale[:, None] * X * scale)[:, ~alone] for X in parts])
    _, values, vectors = np.linalg.svd(stack, full_matrices=False)
    free = np.zeros((k, int(alone.sum()) + int((values <= _FREE * values[0]).sum())))
    free[np.flatnonzero(alone), np.arange(int(alone.sum()))] = 1.0
    combined = vectors[values <= _FREE * values[0]].T
    free[~alone, int(alone.sum()) :] = scale[~alone, None] * combined
    return _orthonormal(free, systems[0].M)


def _orthonormal(columns: np.ndarray, M: np.ndarray) -> np.ndarray:
    if not columns.shape[1]:
        return columns
    return la.solve_triangular(
        la.cholesky(columns.T @ M @ columns, lower=True), columns.T, lower=True
    ).T


def others(free: np.ndarray, M: np.ndarray) -> np.ndarray:
    """Return all motions that are mass-orthogonal to free ones, as columns (k, k − f)."""
    if not free.shape[1]:
        return np.eye(len(M))
    momenta = M @ free
    touched = np.flatnonzero(np.abs(momenta).max(axis=1) > 1e-12 * np.abs(momenta).max())
    rest = la.null_space(momenta[touched].T)
    untouched = np.setdiff1d(np.arange(len(M)), touched)
    basis = np.zeros((len(M), len(untouched) + rest.shape[1]))
    basis[untouched, np.arange(len(untouched))] = 1.0
    basis[touched, len(untouched) :] = rest
    return basis
