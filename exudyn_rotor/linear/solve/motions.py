"""Motions of linear equations: eigenvalues where these are constant, Floquet exponents else.

The 2k exponents of k coordinates are conjugate pairs and an even number of real ones. One of every
conjugate pair stands for both (Im λ > 0), and of the real ones the less damped half, so that k
motions stand for all. A free motion, which nothing resists, has λ = 0.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from exudyn_rotor.linear.equations import (
    EPSILON,
    PeriodicSystem,
    States,
    free_directions,
    others,
    states_of,
)
from exudyn_rotor.linear.solve.floquet import floquet_motions
from exudyn_rotor.linear.solve.hill import Beside, Exponents, hill_motions

METHODS = ("auto", "hill", "floquet")
_ROUNDING = 100.0 * EPSILON  # of the size of a state matrix: what a real part may be off by
_PERIODIC = 10.0  # times that of periodic equations, which have many harmonics
_SOUGHT = 3.0  # |λ| over Ω up to which Floquet's method seeks a motion that was lost
REAL = 1e-9  # share of |λ|: a frequency that is rounding
_AT_ONCE = 2_000_000  # entries of matrices that are solved at once


@dataclass(frozen=True, eq=False)
class Motions:
    """Motions ``exp(λt) Σ_m X_m exp(imΩt)`` at s speeds, or of s models.

    Attributes
    ----------
    speeds : ndarray, shape (s,)
        Ω [rad/s].
    values : ndarray of complex, shape (s, k)
        λ [1/s], Im λ ≥ 0 but for motions of periodic equations; NaN where it did not converge, and
        where there are no equations.
    vectors : ndarray of complex, shape (s, h, c, k)
        Harmonics X_m, all together of unit length.
    orders : ndarray of int, shape (h,)
        The harmonics m; only 0 of constant equations.
    bounds : ndarray, shape (s,)
        By how much rounding can change a real part [1/s].
    lost : sequence of (float, float)
        Speeds [rad/s] at which motions did not converge that are no decays over at once, and about
        the lowest frequency of these [rad/s].
    beside : Beside, optional
        All motions at the last speed of periodic equations, from which a search near it can begin.
    """

    speeds: np.ndarray
    values: np.ndarray
    vectors: np.ndarray
    orders: np.ndarray
    bounds: np.ndarray
    lost: Sequence[tuple[float, float]] = ()
    beside: Beside | None = None

    @property
    def known(self) -> np.ndarray:
        """Speeds at which there are equations, as indices."""
        return np.flatnonzero(~np.isnan(self.bounds))

    def __getitem__(self, rows: np.ndarray | slice) -> Motions:
        """Return the motions at some of the speeds."""
        kept = (each[rows] for each in (self.speeds, self.values, self.vectors))
        return Motions(*kept, self.orders, self.bounds[rows], self.lost)

    def columns(self, chosen: np.ndarray) -> Motions:
        """Return at each speed some of the motions, `chosen` (s, j)."""
        values = np.take_along_axis(self.values, chosen, 1)
        vectors = np.take_along_axis(self.vectors, chosen[:, None, None, :], 3)
        return replace(self, values=values, vectors=vectors)

    @property
    def main(self) -> np.ndarray:
        """The largest harmonic of every motion, shape (s, c, k)."""
        if len(self.orders) == 1:
            return self.vectors[:, 0]
        strongest = np.argmax(np.linalg.norm(self.vectors, axis=2), axis=1)
        return np.take_along_axis(self.vectors, strongest[:, None, None], axis=1)[:, 0]

    def in_all(self, basis: np.ndarray, still: np.ndarray) -> Motions:
        """Return motions of a `basis` (c, r) in all coordinates, after free motions (c, f).

        What stands `still` has λ = 0. Each model of a stack may have its own, (s, c, …).
        """
        basis, still = (X if X.ndim == 3 else X[None] for X in (basis, still))
        vectors = basis[:, None] @ self.vectors
        vectors = vectors * (1.0 / np.linalg.norm(vectors, axis=(1, 2), keepdims=True))
        free = np.zeros((*vectors.shape[:3], still.shape[2]), dtype=complex)
        free[:, self.orders == 0] = (still / np.linalg.norm(still, axis=1, keepdims=True))[:, None]
        zero = np.where(np.isnan(self.bounds)[:, None], np.nan, np.zeros(still.shape[2]))
        values = np.hstack([zero, self.values])
        joined = np.concatenate([free, vectors], axis=3)
        return replace(self, values=values, vectors=joined)


def motions_of(
    stack: PeriodicSystem,
    method: str = "auto",
    tolerance: float = 1e-6,
    *,
    beside: Beside | None = None,
    told: Callable[[int], object] | None = None,
) -> Motions:
    """Return the motions of a stack of equations; NaN where it has none.

    Parameters
    ----------
    stack : PeriodicSystem
        At s speeds.
    method : {'auto', 'hill', 'floquet'}
        For periodic equations: harmonics, or the monodromy matrix. 'auto' takes harmonics, but
        where these miss a slow motion that grows.
    tolerance : float
        Largest relative error of λ by harmonics that are left out.
    beside : Beside, optional
        See :attr:`Motions.beside`: of periodic equations much like these.
    told : callable, optional
        Is told of how many speeds more are solved.
    """
    known = np.flatnonzero(stack.known)
    reduced, free, basis = _resisted(stack[known])
    if reduced.is_constant:
        parts = _constant(reduced, told)
    else:
        parts = _periodic(reduced, method, tolerance, beside, told)
    found = joined_motions(stack.speed, [(known[places], part) for places, part in parts])
    return found if basis is None else found.in_all(basis, free)


def _resisted(
    stack: PeriodicSystem,
) -> tuple[PeriodicSystem, np.ndarray, np.ndarray | None]:
    """Return equations without what nothing resists at any speed, those motions, and a basis."""
    free = free_directions(stack)
    if not free.shape[1]:
        return stack, free, None
    basis = others((stack.M if stack.M.ndim == 2 else stack.M[0]) @ free)
    return stack.projected(basis), free, basis


def _constant(
    stack: PeriodicSystem, told: Callable[[int], object] | None = None
) -> list[tuple[np.ndarray, Motions]]:
    """Return the motions of constant equations, with their places in the stack."""
    k, parts = stack.size, []
    count = max(1, _AT_ONCE // (2 * k + 1) ** 2)
    for first in range(0, len(stack.speed), count):
        places = np.arange(first, min(first + count, len(stack.speed)))
        few = stack[places]
        made = states_of(few)
        values, vectors = np.linalg.eig(made.A[0])
        values, chosen = values.astype(complex), one_of_each_pair(values)
        shapes = made.shape @ np.take_along_axis(vectors, chosen[:, None], 2)
        shapes = shapes / np.linalg.norm(shapes, axis=1, keepdims=True)
        values = np.take_along_axis(values, chosen, 1)
        given = values, shapes[:, None].astype(complex), np.array([0]), _bounds(made)
        parts.append((places, Motions(few.speed, *given)))
        if told is not None:
            told(len(places))
    return parts


def _periodic(
    stack: PeriodicSystem,
    method: str,
    tolerance: float,
    beside: Beside | None,
    told: Callable[[int], object] | None,
) -> list[tuple[np.ndarray, Motions]]:
    """Return the motions of equations that repeat every revolution, one speed after the other."""
    parts = []
    for place in range(len(stack.speed)):
        places, system = np.array([place]), stack[place]
        if system.is_constant:  # at rest
            M, D, K = (X[None] for X in system.matrices())  # the sum of all harmonics
            still = PeriodicSystem(np.array([system.speed]), M, {0: D}, {0: K}, system.H)
            parts += [(places, part) for _, part in _constant(still)]
            continue
        made = states_of(system)
        bound = _PERIODIC * float(_bounds(made))
        if method == "floquet":
            exponents = floquet_motions(system, made)
        else:
            exponents, beside = hill_motions(system, made, tolerance, beside)
            most = max(np.nanmax(exponents.values.real, initial=-np.inf), bound)
            # a slow motion that Hill's method has lost may be the one that grows
            slow = exponents.lost[np.abs(exponents.lost) <= _SOUGHT * abs(system.speed)]
            if method == "auto" and slow.size:
                other = floquet_motions(system, made)
                if np.nanmax(other.values.real, initial=-np.inf) > most:
                    exponents = other
        ascending = _ascending(system.speed, exponents, made, bound)
        parts.append((places, replace(ascending, beside=beside)))
        if told is not None:
            told(1)
    return parts


def _ascending(speed: float, found: Exponents, made: States, bound: float) -> Motions:
    """Return motions in ascending order, in the coordinates of the system."""
    vectors = made.shape @ found.states
    sizes = np.linalg.norm(vectors, axis=(0, 1))
    vectors = vectors / np.where(sizes > 0.0, sizes, 1.0)
    order = np.lexsort((found.values.real, np.abs(found.values.imag)))
    given = found.values[order][None], vectors[None, :, :, order], found.orders
    lost = [(speed, float(np.abs(found.lost.imag).min()))] if found.lost.size else ()
    return Motions(np.array([speed]), *given, np.array([bound]), lost)


def joined_motions(speeds: np.ndarray, parts: Sequence[tuple[np.ndarray, Motions]]) -> Motions:
    """Return parts, each with its places among the speeds (s,), as one; NaN elsewhere."""
    if len(parts) == 1 and len(parts[0][0]) == len(speeds):
        return parts[0][1]
    orders = np.unique(np.concatenate([part.orders for _, part in parts]))
    _, _, c, k = parts[0][1].vectors.shape
    values, bounds = np.full((len(speeds), k), np.nan + 0j), np.full(len(speeds), np.nan)
    vectors = np.full((len(speeds), len(orders), c, k), np.nan + 0j)
    for places, part in parts:
        values[places], bounds[places], vectors[places] = part.values, part.bounds, 0.0
        vectors[np.ix_(places, np.searchsorted(orders, part.orders))] = part.vectors
    lost = [v for _, part in parts for v in part.lost]
    return Motions(speeds, values, vectors, orders, bounds, lost, parts[-1][1].beside)


def _bounds(made: States) -> np.ndarray:
    """Return by how much rounding can change a real part [1/s], (s,) of a stack."""
    absolute = [np.abs(X) for X in made.A.values()]
    sizes = (
        X.sum(axis=-1).max(axis=-1, initial=0.0) * X.sum(axis=-2).max(axis=-1, initial=0.0)
        for X in absolute
    )
    return _ROUNDING * sum(np.sqrt(size) for size in sizes)


def one_of_each_pair(values: np.ndarray) -> np.ndarray:
    """Return which of 2k eigenvalues of real matrices (s, 2k) stand for all, (s, k), ascending."""
    real = np.abs(values.imag) <= REAL * np.abs(values.real)
    lower = ~real & (values.imag <= 0.0)
    chosen = np.lexsort((np.where(real, -values.real, 0.0), real + 2.0 * lower), axis=-1)
    chosen = chosen[:, : values.shape[1] // 2]
    kept = np.take_along_axis(values, chosen, 1)
    return np.take_along_axis(chosen, np.lexsort((kept.real, np.abs(kept.imag)), axis=-1), 1)
