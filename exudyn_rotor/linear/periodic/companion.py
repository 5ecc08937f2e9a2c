"""First-order form of ``M ẍ + D ẋ + K x = 0``: its eigenvalues and how rounding changes them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.periodic.periodic_system import EPSILON, times
from exudyn_rotor.threads import eig

# so large a left vector is that of a defective eigenvalue
_LARGE = 1e100
# asymmetry of a mass matrix, relative to its largest entry, that rounding may leave
_ASYMMETRY = 1e-6


@dataclass(frozen=True, eq=False)
class Companion:
    """First-order form ``ż = A z`` in which the length of z is its energy.

    With ``M = LLᵀ`` and the symmetric part of the stiffness ``L⁻¹K₊L⁻ᵀ = VΛVᵀ``, ``x = L⁻ᵀV q``
    and ``z = (S q, q̇)``, ``S² = |Λ|``: without damping and circulatory forces and with Λ > 0, A is
    skew-symmetric, its eigenvectors are orthogonal, and rounding of A shifts no eigenvalue by more
    than its own size, however stiff some springs are. Of one system, or of several that have the
    mass matrix in common: then everything has one more axis in front.

    Attributes
    ----------
    A : ndarray, shape (…, 2k, 2k)
    axes : ndarray, shape (…, k, k)
        ``L⁻ᵀV``: displacements of q.
    sizes : ndarray, shape (…, k)
        Diagonal of S [1/s].
    noises : ndarray, shape (3, …)
        Rounding of ``L⁻¹K₊L⁻ᵀ`` [1/s²] and ``L⁻¹DL⁻ᵀ`` [1/s], and of the skew part of the stiffness
        by storing it in one matrix with K₊ [1/s²]; Frobenius norms.
    scale : ndarray, shape (…)
        Largest frequency [1/s].
    given : tuple of ndarray
        M, D and K.
    rounding : float
        Relative error of D and K, see :meth:`of`.
    found, z : ndarray, shapes (…, 2k), (…, 2k, 2k)
        Eigenvalues, and vectors z as columns of unit length.
    """

    A: np.ndarray
    axes: np.ndarray
    sizes: np.ndarray
    noises: np.ndarray
    scale: np.ndarray
    given: tuple[np.ndarray, np.ndarray, np.ndarray]
    rounding: float
    found: np.ndarray
    z: np.ndarray

    @classmethod
    def of(
        cls, M: np.ndarray, D: np.ndarray, K: np.ndarray, rounding: float = EPSILON
    ) -> Companion:
        """Return the form of ``M ẍ + D ẋ + K x = 0``.

        `rounding` is the relative error of the entries of D and K. Larger than that of one
        operation, it is that of differences of forces: without symmetry, and a share of the length
        of its row, in coordinates of unit mass, for each entry that is not zero.

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
        symmetric = 0.5 * (K + _transposed(K))
        noise = rounding_of(symmetric, inverse.T, rounding)
        stiffness = _congruent(symmetric, inverse.T, 1)
        if not np.all(np.isfinite(stiffness)):
            raise ValueError("the system matrices have entries that are not finite")
        _, turn = np.linalg.eigh(stiffness)
        # Rayleigh quotients: eigh errs by the largest entry, even where that is of other axes
        squares = np.sum(turn * (stiffness @ turn), axis=-2)
        axes = inverse.T @ turn
        circulatory = _congruent(0.5 * (K - _transposed(K)), axes, -1)
        damping = sum(_congruent(0.5 * (D + n * _transposed(D)), axes, n) for n in (1, -1))
        sides = np.linalg.norm(circulatory, axis=-2)
        squared = np.maximum(np.abs(squares), np.maximum(sides, noise[..., None]))
        fastest = np.sqrt(squared.max(axis=-1, initial=0.0))
        scale = np.maximum(fastest, np.abs(damping).max(axis=(-2, -1), initial=0.0))
        scale = np.where(scale > 0.0, scale, 1.0)
        sizes = np.sqrt(np.where(squared > 0.0, squared, scale[..., None] ** 2))
        one, size = np.eye(len(M)), len(M)
        A = np.zeros((*K.shape[:-2], 2 * size, 2 * size))
        A[..., :size, size:] = one * sizes[..., None]
        A[..., size:, :size] = -(one * squares[..., None] + circulatory) / sizes[..., None, :]
        A[..., size:, size:] = -damping
        if not np.all(np.isfinite(A)):
            raise ValueError("the system matrices have entries that are not finite")
        # in one matrix with K₊
        stored = np.where(np.any(circulatory, axis=(-2, -1)), noise, 0.0) / (4.0 * size)
        noises = np.stack([noise, rounding_of(D, inverse.T, rounding), stored])
        return cls(A, axes, sizes, noises, scale, (M, D, K), rounding, *eig(A))

    @cached_property
    def _left(self) -> np.ndarray:
        """Left eigenvectors as rows."""
        values, z = self.found, self.z
        sense = np.sign(values.imag)[..., None]
        # real and imaginary parts of conjugate pairs, which stand side by side, +i first
        rows = _inverse(np.where(_transposed(sense) < 0.0, -z.imag, z.real))
        rows = np.clip(rows, -_LARGE, _LARGE)
        share, left = np.where(sense == 0.0, 1.0, 0.5), np.empty(rows.shape, dtype=complex)
        left.real = share * np.where(sense < 0.0, np.roll(rows, 1, axis=-2), rows)
        left.imag = -0.5 * sense * np.where(sense > 0.0, np.roll(rows, -1, axis=-2), rows)
        return left

    @cached_property
    def _amounts(self) -> np.ndarray:
        """Coordinates q of the vectors, from both halves by least squares, shape (…, k, 2k)."""
        values, z = self.found, self.z
        values, sizes, count = values[..., None, :], self.sizes[..., None], self.sizes.shape[-1]
        squared = sizes**2 + np.abs(values) ** 2
        return (sizes * z[..., :count, :] + values.conj() * z[..., count:, :]) / squared

    def values(self) -> np.ndarray:
        """Return all 2k eigenvalues."""
        return self.found

    def modes(self) -> tuple[np.ndarray, np.ndarray]:
        """Return all 2k eigenvalues, and vectors (x, λx/s) of unit length, s the scale."""
        return self.values(), self._states[0]

    @cached_property
    def _states(self) -> tuple[np.ndarray, np.ndarray]:
        """Unit vectors (x, λx/s), and the length of those that belong to unit vectors z."""
        displacement = times(self.axes, self._amounts)
        rates = self.values() / self.scale[..., None]
        lengths = np.linalg.norm(displacement, axis=-2) * np.hypot(1.0, np.abs(rates))
        displacement = displacement / lengths[..., None, :]
        states = np.concatenate([displacement, displacement * rates[..., None, :]], axis=-2)
        return states, lengths

    @cached_property
    def errors(self) -> tuple[np.ndarray, np.ndarray]:
        """By how much rounding can change eigenvalues and their real parts, each (…, 2k) [1/s].

        To first order, with the left eigenvectors w of unit product with z: the eigensolver's own
        error is that of a matrix ``A + E``, ``‖E‖ ≤ 2kε‖A‖``, and counts by the condition
        ``‖w‖‖z‖``; source: LAPACK Users' Guide, Sect. 4.8. Rounding of K₊, ``w ΔK q``, is
        symmetric but for its last digit: it changes no real part of an undamped motion. Where
        copies of an eigenvalue have one vector, as those of a free motion, the first order has no
        end; a double one moves by no more than the root of ``‖A‖‖E‖``.
        """
        z, left, count = self.z, self._left, self.sizes.shape[-1]
        most, amounts = np.linalg.norm(self.A, axis=(-2, -1))[..., None], self._amounts
        stiff, damped, stored = self.noises[..., None]
        operation = EPSILON / self.rounding
        with np.errstate(over="ignore"):  # of left vectors of a defective eigenvalue
            forced = np.ascontiguousarray(_transposed(left[..., count:]))
            condition = np.linalg.norm(left, axis=-1) * np.linalg.norm(z, axis=-2)
            whole = np.linalg.norm(forced, axis=-2) * np.linalg.norm(amounts, axis=-2)
            real = _symmetric_norm(forced, amounts) if self.rounding == EPSILON else whole
            unsymmetric = damped * np.abs(self.values()) + stored
            solver = 2.0 * count * EPSILON * most * condition + operation * unsymmetric * whole
            if self.rounding > EPSILON:
                solver = solver + self._by_entries(forced, amounts)
            double = np.sqrt(2.0 * count * self.rounding) * most + np.sqrt(unsymmetric + stiff)
            stiff = operation * stiff
            whole, real = (np.minimum(solver + stiff * each, double) for each in (whole, real))
        # of what may be zero, the first order in the error says nothing about the sign of λ²
        return whole, np.where(np.abs(self.values()) <= whole, whole, real)

    def _by_entries(self, forced: np.ndarray, amounts: np.ndarray) -> np.ndarray:
        """Return by how much errors of the entries of D and K change eigenvalues (…, 2k) [1/s].

        ``|w|ᵀ (|ΔK| + |λ| |ΔD|) |x|``, entry by entry: the norm of all would let what is stiff, as
        a controller, count for motions that it does not take part in.
        """
        M, D, K = self.given
        unit = np.sqrt(np.diag(M))
        left, moved = (unit[:, None] * np.abs(self.axes @ each) for each in (forced, amounts))
        by_damping, by_stiffness = (
            np.sum(left * (_error_of_rows(X / unit[:, None] / unit) @ moved), axis=-2)
            for X in (D, K)
        )
        return self.rounding * (by_stiffness + np.abs(self.values()) * by_damping)

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


def _inverse(vectors: np.ndarray) -> np.ndarray:
    """Return the inverse; rigid motions can make eigenvectors dependent."""
    try:
        return np.linalg.inv(vectors)
    except np.linalg.LinAlgError:
        if vectors.ndim == 2:
            return np.linalg.pinv(vectors)
        return np.stack([_inverse(each) for each in vectors])


def _transposed(X: np.ndarray) -> np.ndarray:
    """Return the transpose of each matrix."""
    return X.swapaxes(-1, -2)


def _error_of_rows(X: np.ndarray) -> np.ndarray:
    """Return the length of its row for each entry that is not zero."""
    return np.where(X == 0.0, 0.0, np.linalg.norm(X, axis=-1, keepdims=True))


def rounding_of(X: np.ndarray, axes: np.ndarray, relative: float) -> np.ndarray:
    """Return by how much rounding of the entries changes ``AᵀXA``, Frobenius norm."""
    size = np.abs(axes)
    changed = np.linalg.norm(size.T @ np.abs(X) @ size, axis=(-2, -1))
    return 2.0 * X.shape[-1] * relative * changed


def _symmetric_norm(left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Return the largest ``Re(wᵀEx)`` of real symmetric E of unit Frobenius norm, column by column.

    That is the norm of the symmetric part of ``Re(w xᵀ) = p uᵀ − q vᵀ``.
    """
    p, q, u, v = left.real, left.imag, right.real, right.imag

    def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return np.einsum("...ij,...ij->...j", a, b)

    whole = dot(p, p) * dot(u, u) + dot(q, q) * dot(v, v) - 2.0 * dot(p, q) * dot(u, v)
    crossed = dot(p, u) ** 2 + dot(q, v) ** 2 - 2.0 * dot(p, v) * dot(q, u)
    return np.sqrt(np.maximum(0.5 * (whole + crossed), 0.0))


def _congruent(X: np.ndarray, axes: np.ndarray, sign: int) -> np.ndarray:
    """Return ``AᵀXA`` exactly as symmetric (sign 1) or skew-symmetric (−1) as X is."""
    Y = _transposed(axes) @ X @ axes
    return 0.5 * (Y + sign * _transposed(Y))
