"""Steady motions on rolling bearings, speed by speed: where they begin, and harmonics enough.

A motion begins with the one at the speed before, with linear equations about the mean place, or
with more damping that is taken away; harmonics are added until those left out are small.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from exudyn_rotor.bearings.rolling import RollingBearing
from exudyn_rotor.bearings.support import NoCoefficientsError
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.response.contact_balance import ContactBalance, unknowns
from exudyn_rotor.linear.response.contact_rest import Rest
from exudyn_rotor.linear.response.contact_stability import growth

_Balances = Callable[[tuple[int, int]], ContactBalance]

_FIRST, _WIDE = (4, 0), (4, 4)  # harmonics of the ball pass and of the spin
_MOST_UNKNOWNS = 1500
_MORE_UNBALANCE = 2.0 ** np.arange(6.0, -0.5, -0.5)
_STEP = 1e-3  # of the tolerance, by which the last step of Newton's method may change the motion
_UNLOADED = 1e-9  # share of the largest static load that counts as none


@dataclass(frozen=True, eq=False)
class SteadyMotion:
    """Harmonics q (h, d) of one speed, and what comes of them."""

    balance: ContactBalance
    q: np.ndarray
    error: float
    linear_error: float
    growth: tuple[float, float]  # and its error [1/s]

    def reach(self, tolerance: float) -> tuple[int, int]:
        """Return with how many harmonics to begin nearby."""
        K, N = self.balance.reach
        if self.balance.rest.speed == 0.0:  # without inertia far more harmonics count
            return _FIRST
        return (max(K // 2, _FIRST[0]) if self.error < 0.1 * tolerance else K), N


@dataclass(frozen=True, eq=False)
class RollingProblem:
    """Rotor, bearings with their springs k₀ (d,), and loads at any speed."""

    model: LinearModel
    bearings: Sequence[RollingBearing]
    springs: np.ndarray
    passes: float
    static: Callable[[float], dict[int, np.ndarray]]  # harmonics (k,) at a speed
    unbalance: Mapping[int, np.ndarray]  # per Ω²

    def swept(
        self, speeds: np.ndarray, tolerance: float
    ) -> tuple[list[SteadyMotion | None], Exception | None]:
        """Return the motions, each beginning with the one before, and why the first is lacking.

        None where no motion is found.
        """
        found: list[SteadyMotion | None] = []
        near, first = None, None
        for speed in speeds:
            try:
                near = self.solved(float(speed), near, tolerance)
                found.append(near)
            except (UnconvergedError, NoCoefficientsError) as error:
                found.append(None)
                if first is None:
                    first = type(error)(f"rolling bearings at {speed:g} rad/s: {error}")
                    first.__cause__ = error
        return found, first

    def solved(self, speed: float, near: SteadyMotion | None, tolerance: float) -> SteadyMotion:
        """Return the steady motion, beginning with one near it."""
        of = self._balances(speed)
        mean = self._mean_place(of((0, 0)), tolerance)
        try:
            balance, q, error = _found(_starts(of, near, mean, tolerance), of, tolerance)
        except UnconvergedError:
            if mean is not None:
                raise
            balance, q, error = self._from_more_unbalance(speed, tolerance)
        if not balance.holds(q):
            raise UnconvergedError(
                "in its clearance no element touches, and the rotor may stand anywhere there"
            )
        linear_error = np.nan
        if mean is not None:
            linear = balance.linear(balance.padded(mean, (0, 0)))
            linear_error = balance.distance(linear, q)
        try:
            grown = growth(balance, q, self.model)
        except NoCoefficientsError:  # at a speed nearby
            grown = np.nan, np.inf
        return SteadyMotion(balance, q, error, linear_error, grown)

    def _balances(self, speed: float, more: float = 1.0) -> _Balances:
        """Return the equations by the harmonics that they have, with so much more unbalance."""
        loads = self.static(speed)
        for n, load in self.unbalance.items():
            loads[n] = loads.get(n, 0.0) + more * speed**2 * load
        names = [one.interface for one in self.bearings]
        rest = Rest(self.model, names, speed, self.passes * speed, loads)
        if not rest.presses():
            raise ValueError(
                f"loads, unbalances: press no element at {speed:g} rad/s: all loads are along the "
                "axis; give one across it, or an unbalance and speeds above zero"
            )
        return partial(ContactBalance.of, self.bearings, rest, self.springs, rest.moved())

    def _from_more_unbalance(
        self, speed: float, tolerance: float
    ) -> tuple[ContactBalance, np.ndarray, float]:
        """Return the whirl that a larger one becomes: of rotors that unbalance alone presses."""
        balance = q = None
        for more in _MORE_UNBALANCE:
            of = self._balances(speed, more)
            starts = _starts(of, None, None, tolerance)
            if q is not None:
                nearby = of(balance.reach)
                starts = iter([(nearby, nearby.padded(q, balance.reach))])
            balance, q, error = _found(starts, of, tolerance)
        return balance, q, error

    def _mean_place(self, balance: ContactBalance, tolerance: float) -> np.ndarray | None:
        """Return where the bearings rest on average (1, d); None where one has no load."""
        loads = np.linalg.norm((self.springs * balance.start[0].real).reshape(-1, 2), axis=1)
        loads += self.springs[::2] * [max(-one.clearance, 0.0) for one in self.bearings]
        if loads.min() <= _UNLOADED * loads.max():
            return None
        return balance.solved(balance.quasi_static(), _STEP * tolerance)


def _found(
    starts: Iterator[tuple[ContactBalance, np.ndarray]], of: _Balances, tolerance: float
) -> tuple[ContactBalance, np.ndarray, float]:
    """Return the motion from the first start that leads to one, and what is left out."""
    for start in starts:
        try:
            return _refined(of, *start, tolerance)
        except UnconvergedError as failed:
            lost = failed
    raise lost


def _starts(
    of: _Balances, near: SteadyMotion | None, mean: np.ndarray | None, tolerance: float
) -> Iterator[tuple[ContactBalance, np.ndarray]]:
    """Yield equations and harmonics near which the steady motion may be."""
    if near is not None:
        balance = of(near.reach(tolerance))
        yield balance, balance.padded(near.q, near.balance.reach)
    balance = of(_FIRST)
    if mean is not None:
        yield balance, balance.linear(balance.padded(mean, (0, 0)))
    balance = of(_WIDE)
    yield balance, balance.damped()


def _refined(
    of: _Balances,
    balance: ContactBalance,
    q: np.ndarray,
    tolerance: float,
) -> tuple[ContactBalance, np.ndarray, float]:
    """Return the motion in as many harmonics as needed or possible, and what is left out."""
    while True:
        q = balance.solved(q, _STEP * tolerance)
        by_pass, by_spin = balance.left_out(q, tolerance)
        error, (K, N) = float(np.hypot(by_pass, by_spin)), balance.reach
        more = (
            K + max(K // 2, 2) if by_pass > 0.5 * tolerance else K,
            N + max(N // 2, 2) if by_spin > 0.5 * tolerance else N,
        )
        if error <= tolerance or unknowns(more, len(balance.bearings)) > _MOST_UNKNOWNS:
            return balance, q, error
        balance = of(more)
        q = balance.padded(q, (K, N))
