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
    """``ż = Σ A_n exp(inθ) z`` and ``x = shape z``: Fourier terms A_n (2k, 2k), shape (k, 2k).

    Of a stack of equations both have the axis of the speeds first.
    """

    A: dict[int, np.ndarray]
    shape: np.ndarray


def states_of(system: PeriodicSystem) -> States:
    """Return the first-order form of a system, or of a stack."""
    M, k = system.M, system.size
    root = None
    if np.any(np.eye(k) != M):  # Lᵀx are mass-orthonormal coordinates
        root = _transposed(np.linalg.inv(np.linalg.cholesky(M)))
    D, K = _terms(system, root)
    symmetric = 0.5 * (K[0] + _transposed(K[0]))
    squares, V = np.linalg.eigh(symmetric)
    omega = np.sqrt(np.abs(squares))
    least = _LEAST * omega.max(axis=-1, keepdims=True, initial=0.0)
    omega = np.maximum(omega, np.maximum(least, 1e-3))
    A, diagonal, across = {}, np.arange(k), _transposed(V)
    for n in sorted({*D, *K}):
        A[n] = np.zeros((*V.shape[:-2], 2 * k, 2 * k), dtype=complex if n else float)
        if n in D:
            A[n][..., k:, k:] = -(across @ D[n] @ V)
        if n in K:
            stiffness = across @ (K[0] - symmetric if n == 0 else K[n]) @ V
            A[n][..., k:, :k] = -stiffness / omega[..., None, :]
    A[0][..., k + diagonal, diagonal] -= squares / omega
    A[0][..., diagonal, k + diagonal] = omega
    shape = np.zeros((*V.shape[:-1], 2 * k))
    shape[..., :k] = (V if root is None else root @ V) / omega[..., None, :]
    return States(A, shape)


def _transposed(X: np.ndarray) -> np.ndarray:
    return np.swapaxes(X, -1, -2)


def _terms(system: PeriodicSystem, root: np.ndarray | None) -> tuple[dict, dict]:
    """Return damping and stiffness per unit of mass; at rest the sum of all harmonics."""
    D, K = system.D, system.K
    if np.ndim(system.speed) == 0 and system.speed == 0.0:
        _, D, K = system.matrices()
        D, K = {0: D}, {0: K}
    if root is None:
        return dict(D), dict(K)
    across = _transposed(root)
    return tuple({n: across @ X @ root for n, X in terms.items()} for terms in (D, K))


def free_directions(stack: PeriodicSystem) -> np.ndarray:
    """Return motions that neither stiffness nor damping resist at the first and last speed.

    Columns, mass-orthonormal, shape (k, f). Coordinates by themselves come as they are.
    """
    k, M = stack.size, stack.M if stack.M.ndim == 2 else stack.M[0]
    ends = [0, -1] if len(stack.speed) > 1 else [0]
    matrices = [X[i] for terms in (stack.D, stack.K) for X in terms.values() for i in ends]
    parts = [part for X in matrices for part in (X.real, X.imag) if np.any(part)]
    if not parts:
        return _orthonormal(np.eye(k), M)
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
    return _orthonormal(free, M)


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
