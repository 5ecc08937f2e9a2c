"""Eigenvalues of ``λ²M + λD + K`` with real matrices, by the companion form.

2k eigenvalues for matrices of size k: conjugate pairs and an even number of real ones. Copies of a
defective double eigenvalue (a free rigid motion) come out split by the root of the rounding error;
their mean is exact.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

# a double root of a defective eigenvalue splits by the root of the rounding error
_SPLIT = 4.0 * np.sqrt(np.finfo(float).eps)
# relative distance from an eigenvalue that keeps its matrix invertible
_OFF_ROOT = 1e-9
# 1 − MAC of the state vectors of two copies of a defective eigenvalue
_PARALLEL = 1e-4
# share of the largest stiffness per mass that is none
_NULL = 1e-12
# asymmetry of a mass matrix, relative to its largest entry, that rounding may leave
_ASYMMETRY = 1e-6


@dataclass(frozen=True, eq=False)
class Companion:
    """First-order form ``ż = A z``, ``z = (Lᵀx, Lᵀẋ/s)`` with ``M = LLᵀ``.

    In the axes of L symmetric matrices stay symmetric; s balances the two halves.

    Attributes
    ----------
    A : ndarray, shape (2k, 2k)
    lower : ndarray, shape (k, k)
        L.
    scale : float
        s [1/s].
    """

    A: np.ndarray
    lower: np.ndarray
    scale: float

    @classmethod
    def of(cls, M: np.ndarray, D: np.ndarray, K: np.ndarray) -> Companion:
        """Return the form of ``M ẍ + D ẋ + K x = 0``.

        Raises
        ------
        ValueError
            If the mass matrix is not symmetric positive definite, or entries are not finite.
        """
        if not all(np.all(np.isfinite(X)) for X in (M, D, K)):
            raise ValueError("the system matrices have entries that are not finite")
        if np.abs(M - M.T).max(initial=0.0) > _ASYMMETRY * np.abs(M).max(initial=0.0):
            raise ValueError("the mass matrix is not symmetric")
        try:
            lower = la.cholesky(M, lower=True)
        except la.LinAlgError as error:
            raise ValueError(f"the mass matrix is not positive definite ({error})") from error
        stiffness, damping = (_within(lower, X) for X in (K, D))
        scale = max(np.sqrt(np.abs(stiffness).max(initial=0.0)), np.abs(damping).max(initial=0.0))
        scale, one = scale or 1.0, np.eye(len(M))
        A = np.block([[0.0 * one, scale * one], [-stiffness / scale, -damping]])
        if not np.all(np.isfinite(A)):
            raise ValueError("the system matrices have entries that are not finite")
        return cls(A, lower, float(scale))

    def values(self) -> np.ndarray:
        """Return all 2k eigenvalues."""
        return np.linalg.eigvals(self.A)

    def modes(self) -> tuple[np.ndarray, np.ndarray]:
        """Return all 2k eigenvalues, and vectors (x, λx/s) of unit length as columns."""
        values, states = np.linalg.eig(self.A)
        displacement = la.solve_triangular(self.lower.T, states[: len(self.lower)], lower=False)
        states = np.vstack([displacement, displacement * (values / self.scale)])
        return values, states / np.linalg.norm(states, axis=0)

    def shifts(self, states: np.ndarray, loads: np.ndarray, columns: np.ndarray) -> np.ndarray:
        """Return by how much forces on the left-hand side shift eigenvalues, to first order.

        Parameters
        ----------
        states : ndarray, shape (2k, 2k)
            All vectors, from :meth:`modes`.
        loads : ndarray, shape (k, j)
            What is added to ``(λ²M + λD + K) x`` of each mode.
        columns : ndarray of int, shape (j,)
            Which modes these are.
        """
        size = len(self.lower)
        right = np.vstack([self.lower.T @ states[:size], self.lower.T @ states[size:]])
        left = _inverse(right)[columns, size:]
        accelerations = la.solve_triangular(self.lower, loads, lower=True) / self.scale
        return -np.einsum("jr,rj->j", left, accelerations)


def _within(lower: np.ndarray, X: np.ndarray) -> np.ndarray:
    """Return ``L⁻¹ X L⁻ᵀ``."""
    return la.solve_triangular(lower, la.solve_triangular(lower, X, lower=True).T, lower=True).T


def _inverse(vectors: np.ndarray) -> np.ndarray:
    """Return the left eigenvectors as rows; rigid motions can make the vectors dependent."""
    try:
        return np.linalg.inv(vectors)
    except np.linalg.LinAlgError:
        return np.linalg.pinv(vectors)


def resolution_of(values: np.ndarray) -> float:
    """Return the size below which eigenvalues and their differences are round-off [1/s]."""
    return float(_SPLIT * np.abs(values).max(initial=0.0))


def quadratic_modes(
    M: np.ndarray, D: np.ndarray, K: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """Return one eigenvalue of each pair of ``λ²M + λD + K``, with its vector.

    Parameters
    ----------
    M, D, K : ndarray, shape (k, k)
        Real; M symmetric positive definite.

    Returns
    -------
    values : ndarray, shape (k,)
        Ascending in |Im λ|: one of every conjugate pair (Im λ > 0), and of the real ones the less
        damped half.
    vectors : ndarray, shape (k, k)
        Displacements, columns of unit length.
    resolution : float
        Size below which eigenvalues and their differences are round-off [1/s].

    Raises
    ------
    ValueError
        If the mass matrix is not positive definite, or the eigenvalues are not finite.
    """
    values, states = Companion.of(M, D, K).modes()
    size, resolution = len(M), resolution_of(values)
    values = merged(values, states, resolution)
    chosen = _one_of_each_pair(values, size)
    vectors = inverse_iterated(values[chosen], states[:size, chosen], M, D, K)
    free = values[chosen] == 0.0
    vectors[:, free] = _null_space(M, K, vectors[:, free])
    return values[chosen], vectors, resolution


def _null_space(M: np.ndarray, K: np.ndarray, otherwise: np.ndarray) -> np.ndarray:
    """Return unit vectors of free motions, ``Kx = 0``; as many as, and else, those given.

    Copies of one free motion (a Jordan block at zero) would hide another.
    """
    count = otherwise.shape[1]
    if count < 2:
        return otherwise
    lower = la.cholesky(M, lower=True)
    _, lengths, rows = la.svd(_within(lower, K))
    if lengths[-count] > _NULL * lengths[0]:
        return otherwise
    vectors = la.solve_triangular(lower.T, rows[-count:].conj().T, lower=False)
    return vectors / np.linalg.norm(vectors, axis=0)


def inverse_iterated(
    values: np.ndarray, vectors: np.ndarray, M: np.ndarray, D: np.ndarray, K: np.ndarray
) -> np.ndarray:
    """Return unit vectors after two inverse iterations.

    Next to stiff static modes, a free motion (a Jordan block at zero) mixes into the vectors of all
    slow modes by rounding; the eigenvalues do not suffer. It can leave so little of a mode that one
    iteration is not enough.
    """
    refined = np.array(vectors, dtype=complex)
    mass, size = M.astype(complex), len(M)
    terms = np.stack([M.T, D.T, K.T]).astype(complex).reshape(3, -1)
    # LAPACK itself: with so many small matrices scipy's checks would take longer than the solutions
    factorise, solve = la.get_lapack_funcs(("getrf", "getrs"), (refined,))
    for column, value in enumerate(values):
        if value != 0.0:
            shifted = value * (1.0 + _OFF_ROOT)
            dynamic = np.array([shifted**2, shifted, 1.0]) @ terms
            lu, pivots, _ = factorise(dynamic.reshape(size, size).T, overwrite_a=True)
            vector = refined[:, column]
            for _ in range(2):
                vector, _ = solve(lu, pivots, mass @ vector)
                vector = vector / max(np.sqrt(np.vdot(vector, vector).real), 1e-300)
            refined[:, column] = vector
    return refined / np.maximum(np.linalg.norm(refined, axis=0), 1e-300)


def merged(values: np.ndarray, states: np.ndarray, resolution: float) -> np.ndarray:
    """Replace copies of a defective eigenvalue by their mean, and unresolved ones by zero."""
    result = values.copy()
    result[np.abs(values) <= resolution] = 0.0
    for group in groups(values, resolution):
        if len(group) < 2 or not np.any(result[group]):
            continue
        overlap = np.abs(states[:, group].conj().T @ states[:, group]) ** 2
        copies = overlap[0] > 1.0 - _PARALLEL
        if np.count_nonzero(copies) > 1:
            result[group[copies]] = values[group[copies]].mean()
    return result


def groups(values: np.ndarray, resolution: float) -> list[np.ndarray]:
    """Return the indices of values that `resolution` does not tell apart, group by group."""
    order = np.argsort(values.imag, kind="stable")
    result = []
    ends = np.flatnonzero(np.diff(values.imag[order]) > resolution) + 1
    for first, end in zip([0, *ends], [*ends, order.size], strict=True):
        left = order[first:end]
        while left.size > 1:
            near = np.abs(values[left] - values[left[0]]) <= resolution
            result.append(left[near])
            left = left[~near]
        if left.size:
            result.append(left)
    return result


def _one_of_each_pair(values: np.ndarray, count: int) -> np.ndarray:
    """Return the indices of `count` values that stand for all, ascending in |Im λ|.

    Raises
    ------
    ValueError
        If the values are not conjugate pairs and an even number of real ones.
    """
    upper = np.flatnonzero(values.imag > 0.0)
    real = np.flatnonzero(values.imag == 0.0)
    real = real[np.argsort(-values[real].real, kind="stable")][: len(real) // 2]
    chosen = np.concatenate([real, upper])
    if len(chosen) != count or not np.all(np.isfinite(values)):
        raise ValueError(
            f"{len(chosen)} pairs of eigenvalues were found where there are {count}; "
            "the matrices may be badly scaled: check the units"
        )
    return chosen[np.lexsort((values[chosen].real, values[chosen].imag))]
