"""Check of exponents: motions as coordinates, in which the equations are constant but for a rest.

With the states ``(x, ẋ)`` of all 2k motions as columns of P(θ), ``z = P y`` turns ``ż = A z`` into

    ẏ = (Λ + F) y,    Λ = diag λ,    F = −P⁻¹ (Ṗ + PΛ − AP)

where F vanishes for exact motions. ``exp(λt) y(t)`` with y periodic has ``(λ − λ_i + d/dt) y_i =
Σ_j F_ij y_j``, and d/dt shifts by multiples of ipΩ alone: modulo these, every exact λ is in a disc
about a λ_i with the radius ``Σ_j f_ij w_j/w_i``, ``f_ij = max |F_ij|`` over a period, for any
positive w. Discs that overlap hold as many as they are, as F may grow from zero. Radii r that are
allowed suffice for some w where no eigenvalue of ``f_ij/r_i`` exceeds 1 (Perron). It does not
matter how motions were found, nor why they err: harmonics left out, rounding, one missing or given
twice, which leaves P singular. Sources: Horn, Johnson, Matrix Analysis (2013), Sects. 6.1 and 8.3.

F is of first order in what is wrong with motions, their exponents of second. Coordinates
``y = (I + G) u`` with ``Ġ + GΛ − ΛG`` equal to F without its mean diagonal leave a rest of second
order. Source: Bogoliubov, Mitropolsky, Samoilenko, Methods of Accelerated Convergence in Nonlinear
Mechanics (1976), Ch. 4.

Motions that are gone within a turn may have any harmonics: Hill's ones have to prove that they
decay. Else, the directions that decay so fast with coefficients frozen at θ take their place, with
Λ(θ) not diagonal: all such motions decay with α where ``Λ + Λᴴ + 2α`` has no positive eigenvalue at
any angle.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg as la

from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.periodic.first_bound import (
    ENOUGH,
    angles_of,
    first_bound,
    largest_share,
    left_to_rest,
)
from exudyn_rotor.linear.periodic.fundamental import accelerations, sampled, state_matrix
from exudyn_rotor.linear.periodic.hill_motions import HillMotions
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, UnconvergedError
from exudyn_rotor.linear.periodic.shared_motions import SharedMotions, shared_motions

_STEPS = 8
_HELPS = 0.9  # of the share: more is left by a step that does not help
_MORE = 10.0  # times what is told that an error may be


def checked(
    system: PeriodicSystem, found: HillMotions, gone: np.ndarray, tolerance: float
) -> HillMotions:
    """Return motions with larger bounds where they err by more than is told.

    Parameters
    ----------
    system : PeriodicSystem
    found : HillMotions
        With their conjugates, all 2k motions.
    gone : ndarray of bool, shape (j,)
        Which are gone within a turn: these have to decay, with any rate.
    tolerance : float
        Error of λ that is allowed beside the bounds, relative to the sizes.

    Raises
    ------
    UnconvergedError
        If some may err by more than ten times what is told.
    """
    few, paired = found, np.flatnonzero(found.paired)
    found, gone = few.with_conjugates(), np.append(gone, gone[paired])
    told = tolerance * np.where(np.isfinite(found.sizes), found.sizes, abs(system.base))
    told = told + found.bounds
    allowed = np.where(gone, -0.5 * found.values.real, _MORE * told)
    groups = shared_motions(system, found)
    pairs = paired, len(few.values) + np.arange(len(paired))
    if first_bound(system, found, pairs, groups, allowed) <= ENOUGH:
        return few
    motions = _States.of(system, found, groups)
    rest, kept = motions.remainder(allowed).smallest(), np.ones(len(gone), dtype=bool)
    if np.any(gone) and rest.share > 1.0:
        frozen = motions.with_frozen(gone, allowed).smallest()
        if frozen.share < rest.share:
            rest, kept = frozen, ~gone
    if not rest.share <= 1.0:
        raise UnconvergedError(
            f"Hill's method at {system.speed:g} rad/s: exponents may be off by "
            f"{_MORE * rest.share:.1e} times what is told: motions change by too many powers of "
            "ten within a turn; use a larger speed (or 0)"
        )
    errors = np.zeros(len(gone))
    errors[kept] = rest.errors
    rounding = np.where(~gone & (errors > told), found.rounding + errors, found.rounding)
    return replace(few, rounding=rounding[: len(few.values)])


def first_or_again(
    choose: Callable[[bool], HillMotions], check: Callable[[HillMotions], HillMotions]
) -> HillMotions:
    """Return motions that pass a check; if those chosen first fail it, others, chosen again.

    Parameters
    ----------
    choose : callable
        Returns motions; at first it is called with True, and again with False.
    check : callable
        Returns motions with their bounds, or raises what :func:`checked` does.

    Raises
    ------
    UnconvergedError
        That of `choose` at first, or of the first check where the second choice fails, too.
    """
    found = choose(True)
    try:
        return check(found)
    except UnconvergedError as unconverged:
        try:
            return check(choose(False))
        except (UnconvergedError, np.linalg.LinAlgError):
            raise unconverged from None


@dataclass(frozen=True, eq=False)
class _Remainder:
    """What is not constant in the equations ``ẏ = (Λ + F) y``.

    Attributes
    ----------
    F : ndarray, shape (n, 2k, 2k)
        At angles of one period; that of the last columns with Λ(θ) of the frozen directions.
    values : ndarray, shape (2k,)
        λ, of frozen directions a mean one.
    allowed : ndarray, shape (s,)
        Radii of the motions that are not frozen, which stand first.
    base : float
    shifts : ndarray, shape (s,)
        Change of λ by the mean diagonal so far.
    """

    F: np.ndarray
    values: np.ndarray
    allowed: np.ndarray
    base: float
    shifts: np.ndarray

    @cached_property
    def _needed(self) -> tuple[float, np.ndarray]:
        """The share of the radii that is needed, and weights w (2k,) for which it is enough."""
        if not np.all(np.isfinite(self.F)):
            return np.inf, np.ones(len(self.values))
        count = len(self.allowed)
        fast, decay = self.F[:, count:, count:], np.inf
        f = np.abs(self.F).max(axis=0)[:count, :count]
        limits = self.allowed
        if fast.size:
            changing = fast + np.diag(self.values[count:])
            decay = -np.linalg.eigvalsh(0.5 * (changing + _adjoint(changing))).max()
            into = np.linalg.norm(self.F[:, :count, count:], axis=2).max(axis=0)
            out_of = np.linalg.norm(self.F[:, count:, :count], axis=1).max(axis=0)
            f = np.block([[f, into[:, None]], [out_of, np.zeros(1)]])
            limits = np.append(limits, 0.5 * decay)
        if not decay > 0.0:
            return np.inf, np.ones(len(self.values))
        needed, weights = largest_share(f, limits)
        repeated = np.repeat(weights, [1] * count + [len(self.values) - count] * bool(fast.size))
        return needed, repeated

    @property
    def share(self) -> float:
        """Of the radii allowed that exponents need."""
        return float(np.max(self.errors / self.allowed, initial=self._needed[0]))

    @property
    def errors(self) -> np.ndarray:
        """By how much the exponents can err, shape (s,) [1/s]."""
        return np.abs(self.shifts) + self._needed[0] * self.allowed

    def smallest(self) -> _Remainder:
        """Return the rest after as many changes of coordinates as it takes, or as help."""
        best = self
        for _ in range(_STEPS):
            if best.share <= ENOUGH or not np.isfinite(best.share):
                break
            try:
                now = best._smaller()
            except np.linalg.LinAlgError:
                break
            if not now.share <= _HELPS * best.share:
                break
            best = now
        return best

    def _smaller(self) -> _Remainder:
        """Return the rest in coordinates (I + G) u."""
        count, fixed, n = len(self.allowed), len(self.values), len(self.F)
        weights = self._needed[1]
        F = self.F * weights / weights[:, None]
        harmonics = np.fft.fft(F, axis=0) / n
        rates = 1j * self.base * np.fft.fftfreq(n, 1.0 / n)[:, None, None]
        divisors = rates + self.values - self.values[:, None]
        radii = np.zeros((fixed, fixed))  # frozen directions have none
        radii[:count, :count] = np.minimum(self.allowed, self.allowed[:, None])
        kept = left_to_rest(harmonics, divisors, radii)
        kept[:, count:, count:] = True
        kept[0, range(fixed), range(fixed)] = True
        change = np.where(kept, 0.0, harmonics / np.where(kept, 1.0, divisors))
        G, left = (n * np.fft.ifft(X, axis=0) for X in (change, np.where(kept, harmonics, 0.0)))
        mean = np.where(np.arange(fixed) < count, np.diagonal(harmonics[0]), 0.0)
        rest = F @ G - G * mean + left - np.diag(mean)
        return replace(
            self,
            F=np.linalg.solve(np.eye(fixed) + G, rest),
            values=self.values + mean,
            shifts=self.shifts + mean[:count],
        )


@dataclass(frozen=True, eq=False)
class _States:
    """States of motions at angles of one period.

    Attributes
    ----------
    system : PeriodicSystem
    angles : ndarray, shape (n,)
    T : ndarray, shape (2k, 2k)
        With λ on its diagonal, and beside it where motions are given by what they span together.
    P, E : ndarray, shape (n, 2k, 2k)
        States ``(x, ẋ/s)`` and ``Ṗ + PT − AP``.
    scale : float
        s [1/s].
    moved : ndarray, shape (2k,)
        The diagonal of T less the exponents that are checked.
    """

    system: PeriodicSystem
    angles: np.ndarray
    T: np.ndarray
    P: np.ndarray
    E: np.ndarray
    scale: float
    moved: np.ndarray

    @classmethod
    def of(
        cls, system: PeriodicSystem, found: HillMotions, groups: Sequence[SharedMotions]
    ) -> _States:
        """Return the states of motions, those of exponents that are one by what they span."""
        shapes = found.shapes / np.linalg.norm(found.shapes, axis=(0, 1))
        rates = found.values + 1j * system.speed * found.orders[:, None, None]
        speeds, T = rates * shapes, np.diag(found.values.astype(complex))
        moved = np.zeros(len(T), dtype=complex)
        for group in groups:
            columns = group.columns
            shapes[..., columns], speeds[..., columns] = group.shapes, group.speeds
            T[np.ix_(columns, columns)], moved[columns] = group.T, group.moved
        angles = angles_of(system, found.orders)
        count = len(angles)
        waves = np.exp(1j * angles[:, None] * found.orders)

        def at_angles(X: np.ndarray) -> np.ndarray:
            flat = waves @ X.reshape(len(X), -1)
            return flat.reshape(count, *X.shape[1:])

        turning = 1j * system.speed * found.orders[:, None, None]
        scale = max(np.abs(found.values).max(), abs(system.speed))
        x, v = at_angles(shapes), at_angles(speeds)
        M, D, K = sampled(system, angles)
        drift = at_angles(turning * shapes + shapes @ T - speeds)
        forced = at_angles(turning * speeds + speeds @ T) + accelerations(system, M, D @ v + K @ x)
        P = np.concatenate([x, v / scale], axis=1)
        E = np.concatenate([drift, forced / scale], axis=1)
        lengths = np.sqrt(np.mean(np.linalg.norm(P, axis=1) ** 2, axis=0))
        lengths = np.where(lengths > 0.0, lengths, 1.0)
        T = T * lengths[:, None] / lengths
        return cls(system, angles, T, P / lengths, E / lengths, scale, moved)

    def remainder(self, allowed: np.ndarray) -> _Remainder:
        """Return what is left with these motions as coordinates."""
        values = np.diagonal(self.T)
        F = _solved(self.P, -self.E) + self.T - np.diag(values)
        return _Remainder(F, values, allowed, self.system.base, self.moved)

    def with_frozen(self, gone: np.ndarray, allowed: np.ndarray) -> _Remainder:
        """Return what is left with frozen directions in the place of motions."""
        base, size = self.system.base, self.system.size
        scales = np.repeat([1.0, self.scale], size)
        A = state_matrix(*sampled(self.system, self.angles)) / scales[:, None] * scales
        Q = _fastest(A, int(gone.sum()))
        count = len(self.angles)
        rates = 1j * base * np.fft.fftfreq(count, 1.0 / count)[:, None, None]
        E = np.fft.ifft(rates * np.fft.fft(Q, axis=0), axis=0) - A @ Q
        P = np.concatenate([self.P[:, :, ~gone], Q], axis=2)
        slow = self.E[:, :, ~gone] - self.P[:, :, gone] @ self.T[np.ix_(gone, ~gone)]
        F = _solved(P, -np.concatenate([slow, E], axis=2))
        own, moved = self.T[np.ix_(~gone, ~gone)], self.moved[~gone]
        fast = slice(len(own), None)
        if not np.all(np.isfinite(F)):
            return _Remainder(F, np.diagonal(self.T), allowed[~gone], base, moved)
        F[:, : len(own), : len(own)] += own - np.diag(np.diagonal(own))
        means, turn = np.linalg.eig(F[:, fast, fast].mean(axis=0))
        F[:, :, fast] = F[:, :, fast] @ turn
        F[:, fast] = _solved(np.broadcast_to(turn, (count, *turn.shape)), F[:, fast])
        F[:, fast, fast] -= np.diag(means)
        values = np.append(np.diagonal(own), means)
        return _Remainder(F, values, allowed[~gone], base, moved)


def _fastest(A: np.ndarray, count: int) -> np.ndarray:
    """Return directions (n, 2k, f) of the fastest decay of matrices A (n, 2k, 2k), periodic.

    They turn as little as can be from angle to angle, and evenly what is missing after a period.
    """
    if count == A.shape[-1]:
        return np.broadcast_to(np.eye(count), A.shape)
    found = []
    for X in A:
        real = np.sort(np.linalg.eigvals(X).real)
        limit = 0.5 * (real[count - 1] + real[count])
        Q = la.schur(X, sort=lambda re, _=0.0, limit=limit: np.real(re) < limit)[1][:, :count]
        found.append(Q @ _nearest_turn(Q.T @ found[-1]) if found else Q)
    angles, axes = np.linalg.eig(_nearest_turn(found[0].T @ found[-1]).astype(complex))
    shares = np.arange(len(A)) / len(A)
    back = (axes * angles ** -shares[:, None, None]) @ np.linalg.inv(axes)
    return np.array(found) @ back


def _nearest_turn(X: np.ndarray) -> np.ndarray:
    """Return the orthogonal matrix next to another."""
    u, _, v = np.linalg.svd(X)
    return u @ v


def _solved(P: np.ndarray, E: np.ndarray) -> np.ndarray:
    """Return ``P⁻¹E``; infinite where P is singular."""
    try:
        return np.linalg.solve(P, E)
    except np.linalg.LinAlgError:
        return np.full(np.broadcast_shapes(P.shape[:-2], E.shape[:-2]) + E.shape[-2:], np.inf)


def _adjoint(X: np.ndarray) -> np.ndarray:
    return X.conj().swapaxes(-1, -2)
