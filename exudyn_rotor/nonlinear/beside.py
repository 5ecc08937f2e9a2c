"""Stability of a steady motion: do small motions beside it grow?

    M δẍ + D δẋ + K δx = Cᵀ [G δq + G' δq̇],    δq = C(θ) δx                                 (1)

with the derivatives G, G' of :mod:`.balance` along the motion. In the motions of the rest with the
mean of the right side, ``ż = λ z + B u``, what is left of that side, u, acts at few places. Gauss's
method with two stages in a step, of fourth order and stable for all that loses energy, needs of the
laws a rank of four for each place: the matrix of a period, the monodromy matrix, takes k²
operations a step for k coordinates: those slower than ten times the highest harmonic, and static
ones for all that is faster. Its eigenvalues μ are the multipliers: the motion is stable
where all are inside the unit circle. One of a limit cycle is 1: the shift in time. Motions that the
laws do not feel keep their exponents. A round rotor is taken in axes that stand still.

A motion with two frequencies, of the ball pass and the spin, has no period. Its multipliers are
those over a time in which both nearly repeat.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exudyn_rotor.linear.equations import PeriodicSystem, Terms
from exudyn_rotor.nonlinear.balance import Balance
from exudyn_rotor.nonlinear.rest import real_rows

_A = np.array([[0.25, 0.25 - np.sqrt(3.0) / 6.0], [0.25 + np.sqrt(3.0) / 6.0, 0.25]])  # Gauss
_PER_CYCLE = 6  # steps in a cycle of the fastest motion on the laws
_PER_WAVE = 8  # and in the shortest wave of the steady motion
_FEWEST, _MOST = 64, 2_000  # steps
_STATIC = 10.0  # times the highest harmonic: motions that are faster follow as springs do
_FELT = 1e-6  # of the motion that laws act on most: one that they do not act on
_DEPENDENT = 1e-10  # of singular values of motions of unit length
_NEAR = 2e-3  # relative difference of frequencies that are taken for the same
_TURNS = 60  # revolutions at most until two frequencies repeat
_NEUTRAL = 1e-7  # of the frequency: growth that is rounding of an undamped motion
_SLOW = 400  # cycles in a ball pass, from which on bearings are looked at as they stand
_ANGLES = 16


@dataclass(frozen=True, eq=False)
class Beside:
    """Equations (1) beside harmonics c (h, d)."""

    balance: Balance
    c: np.ndarray

    @cached_property
    def _rest(self) -> tuple[PeriodicSystem, Terms]:
        """Equations and C of the rest, as far as it is slow."""
        waves = np.abs(self.balance.reach) @ np.abs(self.balance.rest.rates)
        return self.balance.rest.unloaded.for_stability.up_to(_STATIC * waves or np.inf)

    @cached_property
    def _places(self) -> np.ndarray:
        """Orthonormal motions (p, r) that laws act on."""
        _, sizes, V = np.linalg.svd(real_rows(self._rest[1]), full_matrices=False)
        return V[sizes > _DEPENDENT * sizes[0]]

    def _changes(self, phi: np.ndarray, theta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return stiffness and damping (t, p, p) of laws less springs and dampers, at phases."""
        balance, rest = self.balance, self.balance.rest
        k, n = balance.orders.T
        waves = np.exp(1j * (np.outer(phi, k) + np.outer(theta / rest.revolutions, n)))
        q, v = (waves @ self.c).real, (waves @ (1j * balance.nu[:, None] * self.c)).real
        motion = np.concatenate([each.reshape(len(q), -1, 2) for each in (q, v)], axis=-1)
        slopes = -balance.laws.along(motion, phi, theta, rest.speed)[1]
        G, G_t = slopes[..., :2], slopes[..., 2:]
        C, C_t = np.zeros((2, len(q), self.c.shape[1], len(self._places)), dtype=complex)
        for m, U in self._rest[1].items():
            part = np.exp(1j * m * theta)[:, None, None] * (U @ self._places.T)
            C, C_t = C + part, C_t + 1j * m * rest.speed * part
        shape = len(q), -1, 2, len(self._places)
        C, C_t = C.real.reshape(shape), C_t.real.reshape(shape)
        turned = C.swapaxes(-1, -2)
        stiffness = (turned @ (G @ C + G_t @ C_t)).sum(axis=1)
        return stiffness, (turned @ G_t @ C).sum(axis=1)

    def multipliers(self) -> tuple[np.ndarray, float]:
        """Return the multipliers, and the time in which they multiply [s].

        At rest, and where balls pass so slowly that motions beside it do not feel them pass, of the
        bearings as they stand at the worst angle of the cage, over 1 s.
        """
        rest, (K, N) = self.balance.rest, self.balance.reach
        (system, _), P = self._rest, self._places
        M, D, Ks = system.matrices()
        pulled = np.linalg.solve(M, P.T)
        period, second = self._period()
        angles = 2.0 * np.pi * np.arange(_ANGLES) / _ANGLES
        first = angles if K or self.balance.laws.passes else angles[:1]
        phi, theta = (each.ravel() for each in np.meshgrid(first, angles * rest.revolutions))
        stiffness, damping = self._changes(phi, theta)
        reach = np.linalg.norm(P @ pulled, 2)
        fastest = np.sqrt(reach * np.abs(stiffness).sum(axis=2).max())
        slow = abs(rest.rates[0]) * _SLOW < fastest and not N and self.balance.laws.passes
        if slow or not period:
            found = [
                np.linalg.eigvals(_states(M, D + P.T @ D1 @ P, Ks + P.T @ K1 @ P))
                for K1, D1 in zip(stiffness, damping, strict=True)
            ]
            return np.exp(max(found, key=lambda each: each.real.max())), 1.0
        K0, D0 = stiffness.mean(axis=0), damping.mean(axis=0)
        waves = K * abs(second) + N * abs(rest.rates[1])
        rate = max(_PER_CYCLE * fastest, _PER_WAVE * waves)
        steps = int(np.clip(period * rate / (2.0 * np.pi), _FEWEST, _MOST))
        A = _states(M, D + P.T @ D0 @ P, Ks + P.T @ K0 @ P)
        values, V = np.linalg.eig(A)
        zero = np.zeros_like(P)
        seen = np.vstack([np.hstack([P, zero]), np.hstack([zero, P])]) @ V
        acts = np.linalg.solve(V, np.vstack([0.0 * pulled, pulled]).astype(complex))
        felt = np.linalg.norm(seen[: len(P)], axis=0) * np.linalg.norm(acts, axis=1)
        felt = felt > _FELT * felt.max()
        rest_of = np.exp(period * values[~felt])
        step = period / steps
        stages = step * (np.arange(steps)[:, None] + _A.sum(axis=1))
        stiffness, damping = self._changes(second * stages.ravel(), rest.speed * stages.ravel())
        G = -np.concatenate([stiffness - K0, damping - D0], axis=-1)
        state = _over_period(values[felt], seen[:, felt], acts[felt], G, step)
        found = np.linalg.eigvals(state)
        return np.r_[found, rest_of[np.abs(rest_of) > 1.0 + _NEUTRAL]], period

    def _period(self) -> tuple[float, float]:
        """Return a time in which the motion repeats, nearly, and the frequency of φ that does."""
        rest, (K, N) = self.balance.rest, self.balance.reach
        first, second = rest.rates
        turn = 2.0 * np.pi
        spins = bool(N) or [*self._rest[1]] != [0]
        if not K:
            return (turn / abs(second) if second else 0.0), first
        if not spins or not second:
            return (turn / abs(first) if first else 0.0), first
        turns = np.arange(1, _TURNS + 1)
        passes = np.maximum(np.round(turns * abs(first / second)), 1.0)
        off = np.maximum(np.abs(passes / (turns * abs(first / second)) - 1.0), _NEAR)
        best = np.argmin(off)  # the first of those that are near enough
        period = turns[best] * turn / abs(second)
        return period, np.sign(first) * passes[best] * turn / period

    def growth(self, is_free: bool = False) -> tuple[float, complex]:
        """Return the largest growth [1/s], and its multiplier; without the shift in time, if free.

        Growth that is rounding beside the frequency is taken off, so that motions that nothing
        damps do not count.
        """
        found, period = self.multipliers()
        if is_free:
            found = np.delete(found, np.argmin(np.abs(found - 1.0)))
        largest = found[np.argmax(np.abs(found))]
        growth = float(np.log(max(abs(largest), 1e-300)) / period)
        return growth - _NEUTRAL * 2.0 * np.pi / period, complex(largest)


def _over_period(
    values: np.ndarray, seen: np.ndarray, acts: np.ndarray, G: np.ndarray, step: float
) -> np.ndarray:
    """Return the matrix (m, m) of all steps of ``ż = λ z + B u``, ``u = G(t) S z``.

    With λ (m,), S (2p, m), B (m, p), and G (2s, p, 2p) at the two stages of s steps.
    """
    p, x = len(G[0]), step * values
    N = np.linalg.inv(np.eye(2) - x[:, None, None] * _A)  # of stages, (m, 2, 2)
    within = step * N @ _A
    after = 0.5 * step + x[:, None] * within.mean(axis=1)
    begun = N.sum(axis=2)
    P = np.vstack([seen * begun[:, i] for i in (0, 1)])
    Q = np.block([[seen @ (within[:, i, j, None] * acts) for j in (0, 1)] for i in (0, 1)])
    W = np.hstack([after[:, j, None] * acts for j in (0, 1)])
    both = np.zeros((len(G) // 2, 2 * p, 4 * p), dtype=complex)
    both[:, :p, : 2 * p], both[:, p:, 2 * p :] = G[::2], G[1::2]
    F = np.linalg.solve(np.eye(2 * p) - both @ Q, both)
    over, state = (1.0 + x * begun.mean(axis=1))[:, None], np.eye(len(values), dtype=complex)
    for each in F:
        state = over * state + W @ (each @ (P @ state))
    return state


def _states(M: np.ndarray, D: np.ndarray, K: np.ndarray) -> np.ndarray:
    """Return A of ``ż = A z``, z = (x, ẋ)."""
    none, one = np.zeros_like(M), np.eye(len(M))
    return np.vstack([np.hstack([none, one]), -np.linalg.solve(M, np.hstack([K, D]))])
