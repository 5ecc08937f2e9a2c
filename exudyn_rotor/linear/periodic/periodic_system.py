"""Linear equations whose coefficients repeat every revolution.

    M(θ) ẍ + D(θ) ẋ + K(θ) x = f(t),    θ = Ω t

with the matrices given by their Fourier terms in θ; constant where only the term 0 exists.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import gcd

import numpy as np
import scipy.linalg as la

from exudyn_rotor.cached import cached_property

EPSILON = float(np.finfo(float).eps)
Terms = Mapping[int, np.ndarray]


class UnconvergedError(ValueError):
    """A truncation does not reach the tolerance asked for."""


@dataclass(frozen=True, eq=False)
class PeriodicSystem:
    """Linear equations with coefficients that repeat every revolution.

    Attributes
    ----------
    speed : float
        Spin speed Ω [rad/s].
    M, D, K : mapping of int to ndarray, shape (k, k)
        Fourier terms: ``K(θ) = Σ K[n] exp(i n θ)``; K[−n] is the conjugate of K[n].
    H : ndarray, shape (k, k), optional
        Structural damping: a motion ``e^{iνt}`` has the stiffness ``K + i sign(ν) H``. Only
        :func:`forced_motion` knows the frequency ν; all else leaves it out.
    rounding : float
        Relative error of the entries of D and K, that of one operation by default.
    drift : float
        Share of the rates, of Ω and decay, with which a motion that stands still in space drifts
        by what the equations neglect.
    """

    speed: float
    M: Terms
    D: Terms
    K: Terms
    H: np.ndarray | None = None
    rounding: float = EPSILON
    drift: float = 0.0

    @property
    def size(self) -> int:
        """Number of coordinates k."""
        return len(self.M[0])

    @property
    def order(self) -> int:
        """Highest harmonic of any coefficient; 0 for a constant system."""
        return max(abs(n) for terms in (self.M, self.D, self.K) for n in terms)

    @property
    def is_constant(self) -> bool:
        """True when no coefficient depends on θ."""
        return self.order == 0

    @cached_property
    def step(self) -> int:
        """Common step p of the coefficients' harmonics: 2 for anisotropic supports, 0: constant.

        The coefficients repeat p times a revolution.
        """
        return gcd(*(n for terms in (self.M, self.D, self.K) for n in terms))

    @property
    def stands_still(self) -> bool:
        """True where the coefficients do not change in time."""
        return self.is_constant or self.speed == 0.0

    @property
    def base(self) -> float:
        """Frequency pΩ of the coefficients [rad/s]; 0 where they are constant."""
        return self.step * self.speed

    def harmonics(self, order: int) -> np.ndarray:
        """Return the harmonics −N … N that are coupled with 0, N ≤ `order`, shape (2N/p + 1,)."""
        if self.step == 0:
            return np.array([0])
        highest = self.step * (order // self.step)
        return np.arange(-highest, highest + 1, self.step)

    @cached_property
    def ports(self) -> np.ndarray:
        """Orthonormal motions that coefficients which are not constant act on and by, (k, p)."""
        terms = [X for terms in (self.M, self.D, self.K) for n, X in terms.items() if n > 0]
        sides = [part for X in terms for Y in (X, X.T) for part in (Y.real, Y.imag)]
        sides = np.reshape(sides, (-1, self.size, self.size))
        sizes = np.abs(sides).max(axis=(-2, -1), initial=0.0)
        sides = sides[sizes > 0.0] / sizes[sizes > 0.0, None, None]
        found, noise, left = np.zeros((self.size, 0)), self.size * EPSILON, np.ones(len(sides))
        while np.any(left > noise) and found.shape[1] < self.size:
            first = int(np.argmax(left > noise))
            found = _range(np.hstack([found, sides[first]]), noise)
            # most act at places that are known
            left = np.abs(sides - found @ (found.T @ sides)).max(axis=(-2, -1))
            left[: first + 1] = 0.0
        return found

    @cached_property
    def between_ports(self) -> PeriodicSystem:
        """The equations of these motions, by which harmonics are coupled."""
        return self.projected(self.ports)

    @cached_property
    def _together(self) -> dict[int, tuple[list[int], np.ndarray]]:
        """Of each Fourier term the matrices that there are as rows, and which of M, D, K these."""
        given = {n for terms in (self.M, self.D, self.K) for n in terms}
        result = {}
        for n in given:
            entries = [terms.get(n) for terms in (self.M, self.D, self.K)]
            kept = [i for i, X in enumerate(entries) if X is not None]
            result[n] = kept, _rows([entries[i] for i in kept])
        return result

    def dynamic(self, n: int, rates: np.ndarray) -> np.ndarray | None:
        """Return ``λ²M + λD + K`` of Fourier term n at λ of `rates` (j,), shape (j, k, k).

        None where there is no such term.
        """
        if n not in self._together:
            return None
        kept, given = self._together[n]
        return (_powers(rates)[:, kept] @ given).reshape(-1, self.size, self.size)

    def matrices(self, theta: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return M, D, K at a spin angle [rad]."""
        return tuple(_sum(terms, theta) for terms in (self.M, self.D, self.K))

    def projected(self, basis: np.ndarray) -> PeriodicSystem:
        """Return the equations of motions in a real basis (k, r)."""
        parts = (
            {n: basis.T @ X @ basis for n, X in terms.items()} for terms in (self.M, self.D, self.K)
        )
        H = None if self.H is None else basis.T @ self.H @ basis
        return PeriodicSystem(self.speed, *parts, H, self.rounding, self.drift)


@dataclass(frozen=True, eq=False)
class ConstantSystems:
    """Systems at several speeds whose coefficients do not change in time.

    Attributes
    ----------
    M : ndarray, shape (1, k, k) or (s, k, k)
        One matrix where all systems have the same.
    D, K : ndarray, shape (s, k, k)
    rounding : float
        See :class:`PeriodicSystem`.
    """

    M: np.ndarray
    D: np.ndarray
    K: np.ndarray
    rounding: float = EPSILON

    @classmethod
    def of(cls, systems: Iterable[PeriodicSystem]) -> ConstantSystems | None:
        """Return systems together; None where one changes in time, or their rounding differs."""
        matrices, roundings = [], set()
        for system in systems:
            roundings.add(system.rounding)
            if not system.stands_still or len(roundings) > 1:
                return None
            matrices.append(system.matrices(0.0))
        M, D, K = (np.array(each) for each in zip(*matrices, strict=True))
        return cls(M[:1] if np.all(M[0] == M) else M, D, K, *roundings)

    def projected(self, basis: np.ndarray) -> ConstantSystems:
        """Return the equations of motions in a real basis (k, r)."""
        parts = (basis.T @ X @ basis for X in (self.M, self.D, self.K))
        return ConstantSystems(*parts, self.rounding)

    def parts(self, entries: int) -> Iterator[ConstantSystems]:
        """Yield some at a time, of so few that D and K have not more than `entries` each."""
        at_once = max(1, entries // self.D[0].size)
        for first in range(0, len(self.D), at_once):
            few = slice(first, first + at_once)
            M = self.M if len(self.M) == 1 else self.M[few]
            yield ConstantSystems(M, self.D[few], self.K[few], self.rounding)


def times(matrices: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Return real matrices (…, n, k) times complex vectors (…, k, j), by real products."""
    parts = np.ascontiguousarray(vectors, dtype=complex).view(float)
    return (matrices @ parts).view(complex)


def dynamic_matrices(terms: Sequence[np.ndarray], rates: np.ndarray) -> np.ndarray:
    """Return ``λ²M + λD + K`` of constant matrices at all λ of `rates` (j,), shape (j, k, k)."""
    return (_powers(rates) @ _rows(terms)).reshape(-1, *terms[0].shape)


def _rows(matrices: Sequence[np.ndarray]) -> np.ndarray:
    """Return matrices as rows, complex: one product is faster than those of two real parts."""
    return np.stack([X.ravel() for X in matrices]).astype(complex)


def _powers(rates: np.ndarray) -> np.ndarray:
    """Return λ², λ and 1 of each rate, (j, 3)."""
    powers = np.ones((len(rates), 3), dtype=complex)
    powers[:, 0], powers[:, 1] = rates * rates, rates
    return powers


def _range(X: np.ndarray, noise: float) -> np.ndarray:
    """Return orthonormal columns that span those of X but for noise, relative to the largest."""
    Q, R, _ = la.qr(X, mode="economic", pivoting=True)
    sizes = np.abs(np.diagonal(R))
    return Q[:, sizes > noise * sizes[0]]


def fold(exponents: np.ndarray, base: float) -> np.ndarray:
    """Bring imaginary parts into (−base/2, base/2]; no change for ``base = 0``."""
    if base == 0.0:
        return exponents
    return exponents - 1j * base * np.ceil(exponents.imag / base - 0.5)


def _sum(terms: Terms, theta: float) -> np.ndarray:
    if len(terms) == 1:
        return terms[0].real
    return sum(term * np.exp(1j * n * theta) for n, term in terms.items()).real
