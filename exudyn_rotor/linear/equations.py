"""Linear equations whose coefficients may repeat every revolution.

    M ẍ + D(θ) ẋ + K(θ) x = f(t),    θ = Ω t

D and K are given by their Fourier terms in θ; the equations are constant where only the term 0
exists, or where the rotor does not spin.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import gcd
from typing import NamedTuple

import numpy as np
import scipy.linalg as la

from exudyn_rotor.theory.rotating_axes import turning_harmonics

Terms = Mapping[int, np.ndarray]
_ROUNDING = 1e-13  # share of a matrix that is round-off
EPSILON = float(np.finfo(float).eps)
_LEAST = 1e-6  # of the largest ω: a motion with next to no stiffness is scaled by it
_DEPENDENT = 1e-14  # share of the largest column: what others span but for rounding
_FREE = 1e-12  # of matrices with diagonals of one: a free motion


class UnconvergedError(ValueError):
    """A truncation or an iteration does not reach its tolerance."""


@dataclass(frozen=True, eq=False)
class PeriodicSystem:
    """Linear equations at one spin speed, or a stack of equations at s speeds.

    Attributes
    ----------
    speed : float or ndarray, shape (s,)
        Spin speed Ω [rad/s].
    M : ndarray, shape (k, k) or (s, k, k)
    D, K : mapping of int to ndarray, shape (k, k) or (s, k, k)
        Fourier terms: ``K(θ) = Σ K[n] exp(i n θ)``; K[−n] is the conjugate of K[n]. NaN at speeds
        of a stack at which there are no equations.
    H : sequence of (float, ndarray), optional
        Structural damping: a motion ``e^{iνt}`` has the stiffness ``K + i Σ sign(ν − nΩ) H_n``,
        with the frequency ν − nΩ that the rotor sees. Only forced motions know the frequency ν;
        all other analyses leave structural damping out.
    """

    speed: float | np.ndarray
    M: np.ndarray
    D: Terms
    K: Terms
    H: Sequence[tuple[float, np.ndarray]] = ()

    @property
    def size(self) -> int:
        """Number of coordinates k."""
        return self.M.shape[-1]

    @property
    def step(self) -> int:
        """Common step p of the harmonics of the coefficients; 0 where they are constant."""
        return 0 if np.all(self.speed == 0.0) else gcd(*self.D, *self.K)

    @property
    def highest(self) -> int:
        """Highest harmonic of the coefficients."""
        return max(map(abs, (*self.D, *self.K)))

    @property
    def is_constant(self) -> bool:
        """True where the coefficients do not change in time."""
        return self.step == 0

    @property
    def known(self) -> np.ndarray:
        """Which speeds of a stack have equations, (s,)."""
        return np.isfinite(self.K[0].sum(axis=(1, 2)))

    def __getitem__(self, place: int | slice | np.ndarray) -> PeriodicSystem:
        """Return the equations at one speed, or at some speeds, of a stack."""
        is_part = isinstance(place, slice)  # of a stack, with its terms
        M = self.M if self.M.ndim == 2 else self.M[place]
        D, K = (
            {n: X[place] for n, X in terms.items() if n == 0 or is_part or np.any(X[place])}
            for terms in (self.D, self.K)
        )
        return PeriodicSystem(self.speed[place], M, D, K, self.H)

    def matrices(self, theta: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return M, D, K at a spin angle [rad]."""
        return self.M, at_angle(self.D, theta), at_angle(self.K, theta)

    def projected(self, basis: np.ndarray) -> PeriodicSystem:
        """Return the equations of motions in a real basis (k, r)."""
        D, K = ({n: basis.T @ X @ basis for n, X in terms.items()} for terms in (self.D, self.K))
        H = [(n, basis.T @ X @ basis) for n, X in self.H]
        return PeriodicSystem(self.speed, basis.T @ self.M @ basis, D, K, H)


def at_angle(terms: Terms, theta: float | np.ndarray) -> np.ndarray:
    """Return a matrix at a spin angle [rad], or matrices at angles, stacked."""
    if len(terms) == 1 and np.ndim(theta) == 0:
        return terms[0].real
    return sum(np.multiply.outer(np.exp(1j * n * theta), X) for n, X in terms.items()).real


def add(
    terms: dict[int, np.ndarray], more: Terms, factor: float | np.ndarray | None = None
) -> None:
    """Add Fourier terms, or a multiple of them, to others; the term 0 is real."""
    for n, X in more.items():
        part = X.real if n == 0 else X
        terms[n] = terms.get(n, 0.0) + (part if factor is None else factor * part)


def turned(motion: Terms, turns: int) -> dict[int, np.ndarray]:
    """Return the Fourier terms of ``R(turns·θ) U(θ)`` for a motion U of whole triples of rows."""
    if turns == 0:
        return dict(motion)
    result: dict[int, np.ndarray] = {}
    for m, U in motion.items():
        for n, R in turning_harmonics(len(U)).items():
            add(result, {m + turns * n: R @ U})
    return without_rounding(result)


def without_rounding(terms: Terms) -> dict[int, np.ndarray]:
    """Return Fourier terms without those that are rounding beside the largest; 0 always stays."""
    if len(terms) == 1 and 0 in terms:
        return dict(terms)
    sizes = {n: np.abs(X).max(initial=0.0) for n, X in terms.items()}
    least = _ROUNDING * max(sizes.values())
    return {n: X for n, X in terms.items() if n == 0 or sizes[n] > least}


def stacked(motions: Sequence[Terms]) -> dict[int, np.ndarray]:
    """Return motions (p, …) one below the other."""
    none = [np.zeros_like(next(iter(motion.values()))) for motion in motions]
    orders = sorted({n for motion in motions for n in motion})
    pairs = list(zip(motions, none, strict=True))
    return {n: np.concatenate([motion.get(n, zero) for motion, zero in pairs]) for n in orders}


def difference(one: Terms, other: Terms) -> dict[int, np.ndarray]:
    """Return the Fourier terms of one motion less another."""
    orders = sorted({*one, *other})
    return {n: one.get(n, 0.0) - other.get(n, 0.0) for n in orders}


def congruent(U: Terms, X: np.ndarray) -> dict[int, np.ndarray]:
    """Return the Fourier terms of ``Uᵀ(θ) X U(θ)``, of a matrix (p, p) or a stack (s, p, p).

    The symmetric and the skew part of X stay exactly that: the rounding of a stiff support would
    else be a circulatory force.
    """
    result: dict[int, np.ndarray] = {}
    acting = np.any(X, axis=(*range(X.ndim - 2), -1)) | np.any(X, axis=(*range(X.ndim - 2), -2))
    U, X = {n: Y[acting] for n, Y in U.items()}, X[..., acting, :][..., acting]
    for sign in (1.0, -1.0):
        part = 0.5 * (X + sign * _transposed(X))
        if np.any(part):
            for n, Y in products(U, part, U, 0).items():
                Y = 0.5 * (Y + sign * _transposed(Y))
                add(result, {n: Y, -n: Y.conj()} if n else {0: Y})
    return result


def products(U: Terms, X: np.ndarray, V: Terms, least: float = -np.inf) -> dict[int, np.ndarray]:
    """Return the Fourier terms of ``Uᵀ(θ) X V(θ)`` from the order `least` on."""
    result: dict[int, np.ndarray] = {}
    for a, left in U.items():
        for b, right in V.items():
            if a + b >= least:
                add(result, {a + b: left.T @ X @ right})
    return result


def joined(systems: Sequence[PeriodicSystem]) -> PeriodicSystem:
    """Return equations of equally many coordinates, each at one speed, as a stack."""
    speeds = np.array([one.speed for one in systems], dtype=float)
    return spread(speeds, [(place, one) for place, one in enumerate(systems)])


def spread(
    speeds: np.ndarray, parts: Sequence[tuple[int | np.ndarray, PeriodicSystem]]
) -> PeriodicSystem:
    """Return parts of a stack, each with its places among the speeds (s,), as one; else NaN."""
    first = parts[0][1]
    if np.ndim(first.speed) and np.array_equal(parts[0][0], np.arange(len(speeds))):
        return first
    shape = len(speeds), first.size, first.size
    alike = all(part.M is first.M or np.array_equal(part.M, first.M) for _, part in parts)
    M = first.M if alike and first.M.ndim == 2 else np.full(shape, np.nan)
    known = np.zeros(len(speeds), dtype=bool)
    D, K = {}, {}
    for places, part in parts:
        known[places] = True
        if M is not first.M:
            M[places] = part.M
        for terms, given in ((D, part.D), (K, part.K)):
            for n, X in given.items():
                terms.setdefault(n, np.zeros(shape, dtype=float if n == 0 else complex))
                terms[n][places] = X
    for X in (*D.values(), *K.values()):
        X[~known] = np.nan
    return PeriodicSystem(speeds, M, D, K, first.H)


def rate_of(U: Terms) -> dict[int, np.ndarray]:
    """Return the Fourier terms of ``dU/dθ``."""
    return {n: 1j * n * X for n, X in U.items() if n}


class States(NamedTuple):
    """``ż = Σ A_n exp(inθ) z`` and ``x = shape z``: Fourier terms A_n (2k, 2k), shape (k, 2k).

    Of a stack of equations both have the axis of the speeds first.
    """

    A: dict[int, np.ndarray]
    shape: np.ndarray


def states_of(system: PeriodicSystem) -> States:
    """Return the first-order form of a system, or of a stack."""
    k, inverse = system.size, np.linalg.inv(np.linalg.cholesky(system.M))
    root = _transposed(inverse)  # to mass-orthonormal coordinates
    D, K = ({n: inverse @ X @ root for n, X in each.items()} for each in (system.D, system.K))
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
    shape[..., :k] = root @ V / omega[..., None, :]
    return States(A, shape)


def _transposed(X: np.ndarray) -> np.ndarray:
    return np.swapaxes(X, -1, -2)


def free_directions(stack: PeriodicSystem) -> np.ndarray:
    """Return motions that neither stiffness nor damping resist at the first and last speed.

    Columns, mass-orthonormal, shape (k, f). Coordinates by themselves come as they are.
    """
    M = stack.M if stack.M.ndim == 2 else stack.M[0]
    ends = [0, -1] if len(stack.speed) > 1 else [0]
    matrices = [X[i] for terms in (stack.D, stack.K) for X in terms.values() for i in ends]
    parts = [part for X in matrices for part in (X.real, X.imag) if np.any(part)]
    free = np.eye(stack.size)
    if parts:
        size = np.max([np.abs(X).max(axis=axis) for X in parts for axis in (0, 1)], axis=0)
        alone = size <= _FREE * size.max()
        scale = 1.0 / np.sqrt(np.where(alone, 1.0, size))
        acting = np.where(alone, 0.0, scale)
        rows = np.vstack([acting[:, None] * X * acting for X in parts])
        free = scale[:, None] * others(np.linalg.qr(rows, mode="r").T, _FREE)
    if not free.shape[1]:
        return free
    return la.solve_triangular(la.cholesky(free.T @ M @ free, lower=True), free.T, lower=True).T


def spanned(columns: np.ndarray) -> np.ndarray:
    """Return an orthonormal basis (k, r) of columns (k, n), without what is rounding of these."""
    Q, R, _ = la.qr(columns, mode="economic", pivoting=True)
    sizes = np.abs(R.diagonal())
    return Q[:, sizes > _DEPENDENT * sizes[0]]


def others(columns: np.ndarray, rounding: float | None = None) -> np.ndarray:
    """Return what is orthogonal to columns (k, f), orthonormal, as columns (k, k − f).

    Coordinates that the columns do not touch stay as they are. Singular values of columns are zero
    up to the share `rounding` of the largest.
    """
    size = np.abs(columns).max(axis=1, initial=0.0)
    touched = np.flatnonzero(size > 1e-12 * size.max(initial=0.0))
    rest = la.null_space(columns[touched].T, rcond=rounding)
    untouched = np.setdiff1d(np.arange(len(columns)), touched)
    basis = np.zeros((len(columns), len(untouched) + rest.shape[1]))
    basis[untouched, np.arange(len(untouched))] = 1.0
    basis[touched, len(untouched) :] = rest
    return basis
