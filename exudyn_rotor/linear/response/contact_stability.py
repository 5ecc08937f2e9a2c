"""Stability of a steady motion on rolling bearings: do small motions beside it grow?

Beside the motion (1) of :mod:`contact_balance` the contacts are springs that change with the ball
pass and the spin, on the rest that is linear:

    M δẍ + D δẋ + K δx = Cᵀ (k₀ − k(ψ, θ)) C δx                                              (1)

with C(θ) the motion of the inner rings against the outer ones, k the stiffness of the contacts at
the steady motion, and k₀ the springs that K holds in their place. The steady motion is stable where
the largest exponent of (1) is below zero.

Ball pass and spin need no common period. One has nearby spin speeds at which m balls pass in n
revolutions, m/n close to Zκ. The frequency of the ball pass is kept, so that such a speed changes
gyroscopic terms by a little, and the harmonics of the spin. Two fractions tell the error by that,
two steps that of the step.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from exudyn_rotor.linear.equations import PeriodicSystem, Terms
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.response.contact_balance import ContactBalance
from exudyn_rotor.linear.response.contact_rest import resisted, ring_motions
from exudyn_rotor.linear.solve.impulses import ChangingEquations

_PER_CYCLE = 12  # steps in a cycle of the fastest motion on the contacts
_PER_WAVE = 8  # and in the shortest wave of the steady motion, as its grid has points
_MOST_STEPS = 40_000
_NEAR = 0.03  # relative change of the spin speed that is looked at
_SAME = 1e-12  # relative difference of ratios that is rounding
_SURE = 0.1  # of the exponent: an error that is small enough
_HALVINGS = 2  # of a step
_ROUNDED = -30.0  # logarithm of a multiplier that may be rounding
_SLOW = 400  # cycles in a ball pass, from which on the bearings are looked at as they stand
_ANGLES = 16  # of the cage, there, and for means
_DEPENDENT = 1e-10  # of singular values of motions of unit length


def growth(balance: ContactBalance, c: np.ndarray, model: LinearModel) -> tuple[float, float]:
    """Return the largest exponent of motions beside a steady one, and its error [1/s].

    Parameters
    ----------
    balance : ContactBalance
    c : ndarray, shape (h, d)
        Harmonics of the steady motion.
    model : LinearModel
        The rest at any spin speed.

    Returns
    -------
    tuple of float
        NaN and infinity where it would take too many steps; a bound above where a motion decays
        within a ball pass to what is rounding beside others. At rest, and where balls pass so
        slowly that motions beside it do not feel them pass, the largest one at any angle of the
        cage.
    """
    rest = balance.rest
    beside = _Beside(balance, c, model, rest.speed)
    cycle = 2.0 * np.pi / beside.fastest
    if rest.passing * cycle * _SLOW < 2.0 * np.pi:
        angles = 2.0 * np.pi * np.arange(_ANGLES) / _ANGLES
        values = np.array([beside.equations(psi).standing_exponent(0.0) for psi in angles])
        return float(values.max()), 1e-9 * beside.fastest
    shortest = (
        2.0 * np.pi / (max(balance.reach[0], 4) * rest.passing + balance.reach[1] * rest.speed)
    )
    step = min(cycle / _PER_CYCLE, shortest / _PER_WAVE)
    ratio, value, error, last, by_step = rest.passing / rest.speed, np.nan, np.inf, np.nan, np.nan
    for m, n in _near(ratio, int(_MOST_STEPS * step * rest.speed / (2.0 * np.pi))):
        period = 2.0 * np.pi * m / rest.passing
        near = _Beside(balance, c, model, 2.0 * np.pi * n / period).equations()
        if np.isnan(by_step):
            step, found, by_step = _small_enough(near, period, step)
        else:
            found = near.largest_exponent(period, int(np.ceil(period / step)))
        if found * period < _ROUNDED:  # beside motions that do not decay it is rounding: a bound
            return (value, error) if error < np.inf else (found, _SURE * abs(found))
        by_speed = 0.0 if abs(m - n * ratio) <= _SAME * m else abs(found - last)
        if not np.isnan(by_speed):
            value, error = found + 4.0 / 3.0 * by_step, by_speed + abs(by_step)
        if error <= _SURE * abs(value):
            break
        last = found
    return value, error


def _small_enough(
    near: ChangingEquations, period: float, step: float
) -> tuple[float, float, float]:
    """Return a step [s], the exponent by it and by how much one by half of it is larger [1/s].

    The step's error falls with its square.
    """
    steps = int(np.ceil(period / step))
    found = near.largest_exponent(period, steps)
    most = steps * 2**_HALVINGS
    while True:
        finer = near.largest_exponent(period, 2 * steps)
        by_step = finer - found
        if steps == most or abs(by_step) <= 0.5 * _SURE * abs(finer):
            return period / steps, found, by_step
        steps, found = 2 * steps, finer


def _near(ratio: float, most: int) -> Iterator[tuple[int, int]]:
    """Yield fractions m/n near a ratio, n up to `most`, each twice as near as the one before."""
    nearest = 2.0 * _NEAR
    for n in range(1, most + 1):
        m = round(n * ratio)
        off = abs(m / (n * ratio) - 1.0)
        if off <= 0.5 * nearest:
            yield m, n
            nearest = off


@dataclass(frozen=True, eq=False)
class _Beside:
    """Equations (1) beside harmonics c (h, d), of a rest at a nearby spin speed."""

    balance: ContactBalance
    c: np.ndarray
    model: LinearModel
    speed: float

    @cached_property
    def system(self) -> PeriodicSystem:
        """The rest without motions that nothing holds."""
        return self.model.at(self.speed).projected(resisted(self.model))

    @cached_property
    def rings(self) -> Terms:
        """C: Fourier terms (d, r)."""
        basis = resisted(self.model)
        moved = ring_motions(self.model, self.balance.rest.bearings, self.speed)
        return {n: np.delete(U, slice(2, None, 3), axis=0) @ basis for n, U in moved.items()}

    @cached_property
    def places(self) -> np.ndarray:
        """Motions (p, r), orthonormal, that contacts and varying coefficients act on."""
        system = self.system
        varying = [X for terms in (system.D, system.K) for n, X in terms.items() if n > 0]
        if not system.speed:
            varying = []
        rows = [*self.rings.values(), *varying]
        rows = [part / max(np.abs(X).max(), 1e-300) for X in rows for part in (X.real, X.imag)]
        _, sizes, V = np.linalg.svd(np.vstack(rows), full_matrices=False)
        return V[sizes > _DEPENDENT * sizes[0]]

    def _turned(self, theta: np.ndarray) -> np.ndarray:
        """Return C at angles, by motions of the places, (t, d, p)."""
        terms = {n: C @ self.places.T for n, C in self.rings.items()}
        return sum(np.exp(1j * n * theta)[:, None, None] * C for n, C in terms.items()).real

    @cached_property
    def fastest(self) -> float:
        """Largest frequency of the places on the stiffest contacts [rad/s]."""
        slopes = self.balance.contacts(self.balance.values(self.c))[2]
        stiffest = (np.abs(slopes).max(axis=(0, 1, 3, 4)) + self.balance.springs[::2]).max()
        C = self._turned(np.zeros(1))[0] @ self.places
        moved = C @ np.linalg.solve(self.system.M, C.T)
        return float(np.sqrt(stiffest * np.linalg.norm(moved, 2)))

    def equations(self, psi: float | None = None) -> ChangingEquations:
        """Return the equations over time; with balls that stand at an angle ψ, if it is given."""
        M, D, K = self.system.M, *(self._mean_of(X) for X in (self.system.D, self.system.K))
        P = self.places
        K = K + P.T @ self._mean @ P
        return ChangingEquations(M, D, K, P, partial(self._changes, psi), self.fastest)

    def _mean_of(self, terms: Terms) -> np.ndarray:
        return terms[0] if self.speed else sum(terms.values()).real

    def _changes(
        self, psi: float | None, times: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray | None]:
        """Return changes of stiffness and damping (t, p, p) at the places, see (1)."""
        passed = self.balance.rest.passing * times if psi is None else np.full(len(times), psi)
        theta = self.speed * times
        stiffness = self._of_contacts(passed, theta) - self._mean
        if self.system.is_constant:
            return stiffness, None
        stiffness += self._varying(self.system.K, theta)
        return stiffness, self._varying(self.system.D, theta)

    def _varying(self, terms: Terms, theta: np.ndarray) -> np.ndarray:
        """Return the part of Fourier terms that varies with θ, (t, p, p)."""
        found = np.zeros((len(theta), len(self.places), len(self.places)))
        for n, X in terms.items():
            if n:
                part = self.places @ X @ self.places.T
                found += (np.exp(1j * n * theta)[:, None, None] * part).real
        return found

    @cached_property
    def _mean(self) -> np.ndarray:
        """Mean (p, p) of the contacts' part: what is constant needs no small steps."""
        angles = 2.0 * np.pi * np.arange(_ANGLES) / _ANGLES
        both = np.meshgrid(angles, angles)
        return self._of_contacts(both[0].ravel(), both[1].ravel()).mean(axis=0)

    def _of_contacts(self, psi: np.ndarray, theta: np.ndarray) -> np.ndarray:
        """Return ``−Cᵀ(k₀ − k)C``, (t, p, p)."""
        C = self._turned(theta)
        pairs = C.reshape(len(theta), -1, 2, C.shape[2])
        slopes = self._slopes(psi, theta)
        return -np.einsum("tbip,tbij,tbjq->tpq", pairs, slopes, pairs, optimize=True)

    def _slopes(self, psi: np.ndarray, theta: np.ndarray) -> np.ndarray:
        """Return ``k₀ − k`` of the bearings at the steady motion, shape (t, B, 2, 2)."""
        K, N = self.balance.reach
        harmonics = self.c.reshape(2 * K + 1, -1)
        passed = np.exp(1j * np.outer(psi, np.arange(-K, K + 1))) @ harmonics
        spun = np.exp(1j * np.outer(theta, np.arange(-N, N + 1)))
        q = np.einsum("tn,tnd->td", spun, passed.reshape(len(psi), 2 * N + 1, -1)).real
        return self.balance.contacts(q.reshape(len(psi), -1, 2), psi)[2]
