"""Largest exponent of linear equations that change at a few places, over a given period.

    M ẍ + D ẋ + K x = −Pᵀ [δD(t) P ẋ + δK(t) P x]                                          (1)

The states (x, ẋ) are taken over every step by the exact solution of the left side, and by an
impulse of the right one in its middle; of second order in the step, G. Strang, SIAM J. Numer. Anal.
5 (1968), 506. The product over a period is the monodromy matrix, whose multipliers μ make the
exponents ``log|μ|/T``. Motions that the right side does not feel keep the exponents of the left
one, and are left aside.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg

_CHUNK = 512  # steps whose matrices are made at once
_FELT = 1e-6  # of the fastest frequency: an exponent that changes by less is not felt
_LEAST = 1e-300

Changes = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray | None]]


@dataclass(frozen=True, eq=False)
class ChangingEquations:
    """Equations (1).

    Attributes
    ----------
    M, D, K : ndarray, shape (k, k)
    places : ndarray, shape (p, k)
        P.
    changes : callable
        Of times (t,) [s]; returns δK (t, p, p), and δD alike, or None where it is zero.
    fastest : float
        Largest frequency that δK makes [rad/s].
    """

    M: np.ndarray
    D: np.ndarray
    K: np.ndarray
    places: np.ndarray
    changes: Changes
    fastest: float

    def largest_exponent(self, period: float, steps: int) -> float:
        """Return the largest exponent of a motion that the right side feels [1/s].

        By so many steps; NaN where it feels none. Multipliers that are rounding count as that.
        """
        monodromy, log = self._monodromy(period / steps, steps)
        sizes = np.abs(np.linalg.eigvals(monodromy))
        rounding = np.finfo(float).eps * sizes.max()
        values, felt = self._felt(monodromy)
        largest = np.abs(values[felt]).max(initial=rounding)
        return float((np.log(largest + _LEAST) + log) / period)

    def standing_exponent(self, time: float) -> float:
        """Return the largest one of the equations as they are at an instant; NaN as above."""
        stiffness, damping = self.changes(np.array([time]))
        P = self.places
        K = self.K + P.T @ stiffness[0] @ P
        D = self.D if damping is None else self.D + P.T @ damping[0] @ P
        values, felt = self._felt(self._scaled(self._rates(D, K)))
        return float(values[felt].real.max(initial=-np.inf)) if felt.any() else np.nan

    @cached_property
    def _pulled(self) -> np.ndarray:
        """``M⁻¹Pᵀ``, shape (k, p)."""
        return np.linalg.solve(self.M, self.places.T)

    def _rates(self, D: np.ndarray, K: np.ndarray) -> np.ndarray:
        """Return A of ``ż = A z``, z = (x, ẋ)."""
        size = len(self.M)
        A = np.zeros((2 * size, 2 * size))
        A[:size, size:] = np.eye(size)
        A[size:] = -np.linalg.solve(self.M, np.hstack([K, D]))
        return A

    def _scaled(self, A: np.ndarray) -> np.ndarray:
        """Return a matrix of states for (ωx, ẋ), ω the fastest frequency."""
        scale = np.repeat([self.fastest, 1.0], len(self.M))
        return scale[:, None] * A / scale

    def _felt(self, A: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the eigenvalues of a matrix of scaled states, and which motions are felt."""
        size = len(self.M)
        values, right = np.linalg.eig(A)
        left = np.linalg.pinv(right)
        reach = np.linalg.norm(self._pulled, 2)
        # change of an exponent by a stiffness at the places, over the fastest frequency
        by = np.linalg.norm(left[:, size:] @ self._pulled, axis=1)
        of = np.linalg.norm(self.places @ right[:size], axis=0)
        return values, by * of > _FELT * reach * np.linalg.norm(self.places, 2)

    def _monodromy(self, step: float, steps: int) -> tuple[np.ndarray, float]:
        """Return what steps make of scaled states, over a size, and the logarithm of that."""
        size = len(self.M)
        over = scipy.linalg.expm(step * self._rates(self.D, self.K))
        P, zero = self.places, np.zeros_like(self.places)
        seen = np.block([[P, zero], [zero, P]])
        pulled = over[:, size:] @ self._pulled
        found, log = np.eye(2 * size), 0.0
        for first in range(0, steps, _CHUNK):
            times = step * (np.arange(first, min(first + _CHUNK, steps)) + 0.5)
            found = _product(over + pulled @ self._impulses(times, step) @ seen) @ found
            largest = np.abs(found).max()
            found, log = found / largest, log + np.log(largest)
        return self._scaled(found), log

    def _impulses(self, times: np.ndarray, step: float) -> np.ndarray:
        """Return impulses by (P x, P ẋ) before them, at times (t,); shape (t, p, 2p)."""
        stiffness, damping = self.changes(times)
        if damping is None:
            return -step * np.concatenate([stiffness, np.zeros_like(stiffness)], axis=-1)
        both = -step * np.concatenate([stiffness, damping], axis=-1)
        # of dampers by the mean of the velocities before and after
        moved = np.eye(len(self.places)) + 0.5 * step * damping @ (self.places @ self._pulled)
        return np.linalg.solve(moved, both)


def _product(matrices: np.ndarray) -> np.ndarray:
    """Return the product of matrices (n, k, k), the last one on the left."""
    while len(matrices) > 1:
        last = matrices[-1:] if len(matrices) % 2 else matrices[:0]
        even = matrices[: len(matrices) // 2 * 2]
        matrices = np.concatenate([even[1::2] @ even[::2], last])
    return matrices[0]
