"""Eigenvalues of ``λ²M + λD + K`` with real matrices, by the companion form.

2k eigenvalues for matrices of size k: conjugate pairs and an even number of real ones. Copies of a
defective double eigenvalue (a free rigid motion) come out split by the root of the rounding error;
their mean is exact.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg as la

from exudyn_rotor.linear.periodic.periodic_system import EPSILON

# a double root of a defective eigenvalue splits by the root of the rounding error
_SPLIT = 4.0 * np.sqrt(EPSILON)
# so large a left vector is that of a defective eigenvalue
_LARGE = 1e100
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
    """First-order form ``ż = A z`` in which the length of z is its energy.

    With ``M = LLᵀ`` and the symmetric part of the stiffness ``L⁻¹K₊L⁻ᵀ = VΛVᵀ``, ``x = L⁻ᵀV q``
    and ``z = (S q, q̇)``, ``S² = |Λ|``: without damping and circulatory forces and with Λ > 0, A is
    skew-symmetric, its eigenvectors are orthogonal, and rounding of A shifts no eigenvalue by more
    than its own size, however stiff some springs are.

    Attributes
    ----------
    A : ndarray, shape (2k, 2k)
    axes : ndarray, shape (k, k)
        ``L⁻ᵀV``: displacements of q.
    sizes : ndarray, shape (k,)
        Diagonal of S [1/s].
    noises : tuple of float
        Rounding of ``L⁻¹K₊L⁻ᵀ`` [1/s²] and ``L⁻¹DL⁻ᵀ`` [1/s], and of the skew part of the stiffness
        by storing it in one matrix with K₊ [1/s²]; Frobenius norms.
    scale : float
        Largest frequency [1/s].
    rounding : float
        Relative error of the entries of D and K.
    """

    A: np.ndarray
    axes: np.ndarray
    sizes: np.ndarray
    noises: tuple[float, float, float]
    scale: float
    rounding: float

    @classmethod
    def of(
        cls, M: np.ndarray, D: np.ndarray, K: np.ndarray, rounding: float = EPSILON
    ) -> Companion:
        """Return the form of ``M ẍ + D ẋ + K x = 0``.

        `rounding` is the relative error of the entries of D and K; larger than that of one
        operation, it is taken for an error without symmetry.

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
        inverse = la.solve_triangular(lower, np.eye(len(M)), lower=True)
        noise = _rounding(0.5 * (K + K.T), inverse.T, rounding)
        stiffness = _congruent(0.5 * (K + K.T), inverse.T)
        if not np.all(np.isfinite(stiffness)):
            raise ValueError("the system matrices have entries that are not finite")
        squares, turn = la.eigh(stiffness)
        axes = inverse.T @ turn
        circulatory, damping = _congruent(0.5 * (K - K.T), axes), _congruent(D, axes)
        sides = np.linalg.norm(circulatory, axis=0)
        squared = np.maximum(np.abs(squares), np.maximum(sides, noise))
        scale = max(np.sqrt(squared.max(initial=0.0)), np.abs(damping).max(initial=0.0)) or 1.0
        sizes = np.sqrt(np.where(squared > 0.0, squared, scale**2))
        lower_left = -(np.diag(squares) + circulatory) / sizes
        A = np.block([[np.zeros_like(damping), np.diag(sizes)], [lower_left, -damping]])
        if not np.all(np.isfinite(A)):
            raise ValueError("the system matrices have entries that are not finite")
        stored = noise if np.any(circulatory) else 0.0  # in one matrix with K₊
        noises = noise, _rounding(D, inverse.T, rounding), stored / (4.0 * len(M))
        return cls(A, axes, sizes, noises, float(scale), rounding)

    @cached_property
    def _solved(self) -> tuple[np.ndarray, np.ndarray]:
        """Eigenvalues, and vectors z as columns of unit length."""
        return np.linalg.eig(self.A)

    @cached_property
    def _left(self) -> np.ndarray:
        """Left eigenvectors as rows; rigid motions can make the vectors dependent."""
        try:
            return np.linalg.inv(self._solved[1])
        except np.linalg.LinAlgError:
            return np.linalg.pinv(self._solved[1])

    @cached_property
    def _amounts(self) -> np.ndarray:
        """Coordinates q of the vectors, from both halves by least squares, shape (k, 2k)."""
        values, z = self._solved
        sizes, count = self.sizes[:, None], len(self.sizes)
        squared = sizes**2 + np.abs(values) ** 2
        return (sizes * z[:count] + values.conj() * z[count:]) / squared

    def values(self) -> np.ndarray:
        """Return all 2k eigenvalues."""
        return self._solved[0]

    def modes(self) -> tuple[np.ndarray, np.ndarray]:
        """Return all 2k eigenvalues, and vectors (x, λx/s) of unit length, s the scale."""
        return self.values(), self._states[0]

    @cached_property
    def _states(self) -> tuple[np.ndarray, np.ndarray]:
        """Unit vectors (x, λx/s), and the length of those that belong to unit vectors z."""
        displacement = self.axes @ self._amounts
        states = np.vstack([displacement, displacement * (self.values() / self.scale)])
        lengths = np.linalg.norm(states, axis=0)
        return states / lengths, lengths

    @cached_property
    def errors(self) -> tuple[np.ndarray, np.ndarray]:
        """By how much rounding can change eigenvalues and their real parts, each (2k,) [1/s].

        To first order, with the left eigenvectors w of unit product with z: the eigensolver's own
        error is that of a matrix ``A + E``, ``‖E‖ ≤ 2kε‖A‖``, and counts by the condition
        ``‖w‖‖z‖``; source: LAPACK Users' Guide, Sect. 4.8. Rounding of K₊, ``w ΔK q``, is
        symmetric but for its last digit: it changes no real part of an undamped motion. No error is
        larger than ``‖A‖``.
        """
        z, left, count = self._solved[1], self._left, len(self.sizes)
        most, amounts = np.linalg.norm(self.A), self._amounts
        with np.errstate(over="ignore"):  # of left vectors of a defective eigenvalue
            left = np.clip(left.real, -_LARGE, _LARGE) + 1j * np.clip(left.imag, -_LARGE, _LARGE)
            forced = left[:, count:].T
            condition = np.linalg.norm(left, axis=1) * np.linalg.norm(z, axis=0)
            whole = np.linalg.norm(forced, axis=0) * np.linalg.norm(amounts, axis=0)
            real = _symmetric_norm(forced, amounts) if self.rounding == EPSILON else whole
            solver = 2.0 * count * self.rounding * most * condition
            solver += (self.noises[1] * np.abs(self.values()) + self.noises[2]) * whole
            whole, real = (
                np.minimum(solver + self.noises[0] * each, most) for each in (whole, real)
            )
        # of what may be zero, the first order in the error says nothing about the sign of λ²
        return whole, np.where(np.abs(self.values()) <= whole, whole, real)

    def shifts(self, loads: np.ndarray, columns: np.ndarray) -> np.ndarray:
        """Return by how much forces on the left-hand side shift eigenvalues, to first order.

        Parameters
        ----------
        loads : ndarray, shape (k, j)
            What is added to ``(λ²M + λD + K) x`` of each mode of :meth:`modes`.
        columns : ndarray of int, shape (j,)
            Which modes these are.
        """
        left = self._left[columns, len(self.sizes) :]
        accelerations = (self.axes.T @ loads) * self._states[1][columns]
        return -np.einsum("jr,rj->j", left, accelerations)


def _rounding(X: np.ndarray, axes: np.ndarray, relative: float) -> float:
    """Return by how much rounding of the entries changes ``AᵀXA``, Frobenius norm."""
    size = np.abs(axes)
    return float(2.0 * len(X) * relative * np.linalg.norm(size.T @ np.abs(X) @ size))


def _symmetric_norm(left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Return the largest ``Re(wᵀEx)`` of real symmetric E of unit Frobenius norm, column by column.

    That is the norm of the symmetric part of ``Re(w xᵀ) = p uᵀ − q vᵀ``.
    """
    p, q, u, v = left.real, left.imag, right.real, right.imag

    def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return np.sum(a * b, axis=0)

    whole = dot(p, p) * dot(u, u) + dot(q, q) * dot(v, v) - 2.0 * dot(p, q) * dot(u, v)
    crossed = dot(p, u) ** 2 + dot(q, v) ** 2 - 2.0 * dot(p, v) * dot(q, u)
    return np.sqrt(np.maximum(0.5 * (whole + crossed), 0.0))


def _congruent(X: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Return ``AᵀXA`` with exactly symmetric and skew parts."""
    parts = [axes.T @ (0.5 * (X + sign * X.T)) @ axes for sign in (1.0, -1.0)]
    return sum(0.5 * (Y + sign * Y.T) for Y, sign in zip(parts, (1.0, -1.0), strict=True))


def _within(lower: np.ndarray, X: np.ndarray) -> np.ndarray:
    """Return ``L⁻¹ X L⁻ᵀ``."""
    return la.solve_triangular(lower, la.solve_triangular(lower, X, lower=True).T, lower=True).T


def resolved(values: np.ndarray, errors: np.ndarray) -> np.ndarray:
    """Return eigenvalues with zero for those that rounding may have made of it."""
    return np.where(np.abs(values) <= errors, 0.0, values)


def resolution_of(values: np.ndarray) -> float:
    """Return the size below which differences of eigenvalues are round-off [1/s]."""
    return float(_SPLIT * np.abs(values).max(initial=0.0))


def quadratic_modes(
    M: np.ndarray, D: np.ndarray, K: np.ndarray, rounding: float = EPSILON
) -> tuple[np.ndarray, np.ndarray, float, np.ndarray]:
    """Return one eigenvalue of each pair of ``λ²M + λD + K``, with its vector.

    Parameters
    ----------
    M, D, K : ndarray, shape (k, k)
        Real; M symmetric positive definite.
    rounding : float, optional
        See :meth:`Companion.of`.

    Returns
    -------
    values : ndarray, shape (k,)
        Ascending in |Im λ|: one of every conjugate pair (Im λ > 0), and of the real ones the less
        damped half.
    vectors : ndarray, shape (k, k)
        Displacements, columns of unit length.
    resolution : float
        Size below which differences of eigenvalues are round-off [1/s].
    bounds : ndarray, shape (k,)
        By how much rounding can change the real parts [1/s].

    Raises
    ------
    ValueError
        If the mass matrix is not positive definite, or the eigenvalues are not finite.
    """
    companion = Companion.of(M, D, K, rounding)
    values, states = companion.modes()
    size, resolution = len(M), resolution_of(values)
    errors, bounds = companion.errors
    values = merged(resolved(values, errors), states, resolution)
    chosen = _one_of_each_pair(values, size)
    vectors = inverse_iterated(values[chosen], states[:size, chosen], M, D, K)
    free = values[chosen] == 0.0
    vectors[:, free] = _null_space(M, K, vectors[:, free])
    return values[chosen], vectors, resolution, bounds[chosen]


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
    """Replace copies of a defective eigenvalue by their mean."""
    result = values.copy()
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
