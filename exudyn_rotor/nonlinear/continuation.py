"""Branches of solutions over a parameter: pseudo-arclength continuation, folds, changes.

Unknowns are the harmonics c of :mod:`.balance` and real parameters p: the one that a branch goes
along, last, and before it the frequency of a limit cycle, which a phase condition makes definite.
A step goes along the tangent t of the branch by the length s, and returns to it at right angles,

    R(c, p) = 0,   Re⟨φ, c⟩ = 0,   Re⟨t_c, c − c*⟩/c₀² + t_p (p − p*)/p₀² = 0,              (1)

by Newton's method, so that a branch may turn back: there the last component of t is zero (E. L.
Allgower, K. Georg, *Numerical Continuation Methods* (1990)). Steps grow where the method converges
fast and the tangent turns little.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.nonlinear.balance import Balance, orders_of, padded, real_part_of

_MOST_ITERATIONS = 9
_CONVERGED = 1e-6  # scaled last step, whose square is the error
_DIFFERENCE = 1e-6  # of the range of a parameter, for derivatives by it
_FIRST, _LONGEST, _SHORTEST = 0.02, 0.25, 1e-5  # steps in scaled unknowns
_WANTED = 3  # iterations
_TURN = 0.92  # cosine between tangents, below which a step is repeated with half its length
_SMOOTH = 1e-3  # step below which a tangent may turn as it likes, where contacts begin
_LEAST = 0.1  # of the wanted size, as which a motion counts at least
_MOST_POINTS = 2000
_MOST_UNKNOWNS = 1500
_IN_PARAMETER = 1e-7  # of a step, to which a change on a branch is found


@dataclass(frozen=True, eq=False)
class Point:
    """A solution.

    Attributes
    ----------
    c : ndarray, shape (h, d)
    p : ndarray, shape (e,)
    balance : Balance
    tangent : tuple of ndarray, or None
        Components along c and p, scaled length 1.
    kind : str
        'computed', 'value' (a wanted one), 'fold', 'doubling', 'torus' or 'branching'.
    growth, multiplier : float, complex
        Of the motions beside it, see :mod:`.beside`.
    error : float
        Share of the motion in harmonics that are left out.
    """

    c: np.ndarray
    p: np.ndarray
    balance: Balance
    tangent: tuple[np.ndarray, np.ndarray] | None = None
    kind: str = "computed"
    growth: float = np.nan
    multiplier: complex = np.nan
    error: float = np.nan

    @property
    def value(self) -> float:
        """Of the parameter that the branch goes along."""
        return float(self.p[-1])


@dataclass(eq=False)
class Family:
    """Solutions over a range of a parameter.

    Attributes
    ----------
    balance : callable
        Takes parameters (e,) and K and N, gives the equations.
    spans : ndarray, shape (e,)
        p₀: what counts as one of each parameter.
    size : float
        Of a motion that matters [m].
    measure : callable
        Takes a point, gives one with growth and multiplier.
    tolerance : float
        Largest share of the motion in harmonics that are left out.
    phase : ndarray, shape (h, d), optional
        φ of (1), with its reach.
    most : tuple of int
        Harmonics up to which more are added.
    """

    balance: Callable[[np.ndarray, tuple[int, int]], Balance]
    spans: np.ndarray
    size: float
    measure: Callable[[Point], Point]
    tolerance: float
    most: tuple[int, int]
    phase: tuple[np.ndarray, tuple[int, int]] | None = None
    lost: list[str] = field(default_factory=list)

    # ------------------------------------------------------------ Newton's method

    def _scale(self, c: np.ndarray) -> float:
        return max(float(np.linalg.norm(c)), _LEAST * self.size)

    def _system(self, point: Point) -> tuple[np.ndarray, np.ndarray]:
        """Return what is left (n,), and its derivative (n, n + 1), without the last row of (1)."""
        left, J = point.balance.linearised(point.c)
        by_parameters = []
        for place, span in enumerate(self.spans):
            p = point.p.copy()
            p[place] += _DIFFERENCE * span
            beside = self.balance(p, point.balance.reach).residual(point.c)
            by_parameters.append((beside - left).ravel() / (_DIFFERENCE * span))
        left, J = left.ravel(), np.column_stack([J, *by_parameters])
        if self.phase is not None:
            phi = padded(*self.phase, point.balance.reach).ravel().conj()
            J = np.vstack([J, np.r_[phi, np.zeros(len(self.spans))]])
            left = np.r_[left, phi @ point.c.ravel()]
        return left, J

    def corrected(self, start: Point, row: tuple[np.ndarray, np.ndarray]) -> tuple[Point, int]:
        """Return the solution near a start at right angles to a row, and after how many steps.

        Raises
        ------
        UnconvergedError
        """
        point, last = start, np.inf
        flat = np.r_[row[0].conj().ravel(), row[1]]
        for count in range(1, _MOST_ITERATIONS + 1):
            left, J = self._system(point)
            try:
                step = np.linalg.solve(np.vstack([J, flat]), np.r_[left, 0.0])
            except np.linalg.LinAlgError:
                break
            moved = real_part_of(step[: point.c.size].reshape(point.c.shape))
            parameters = step[point.c.size :].real
            length = np.hypot(
                np.linalg.norm(moved) / self._scale(point.c),
                np.linalg.norm(parameters / self.spans),
            )
            if not np.isfinite(length) or (length > 2.0 * last and count > 2) or length > 10.0:
                break
            last = length
            p = point.p - parameters
            point = replace(
                point, c=point.c - moved, p=p, balance=self.balance(p, point.balance.reach)
            )
            if length < _CONVERGED:
                return point, count
        raise UnconvergedError("no solution beside another one")

    def at_value(self, start: Point, value: float) -> Point:
        """Return the solution near a start at a value of the parameter."""
        p = start.p.copy()
        p[-1] = value
        start = replace(start, p=p, balance=self.balance(p, start.balance.reach))
        row = np.zeros_like(start.c), np.eye(len(p))[-1]
        return self.corrected(start, row)[0]

    def with_tangent(self, point: Point, like: tuple[np.ndarray, np.ndarray]) -> Point:
        """Return a point with its tangent, in the sense of another one."""
        _, J = self._system(point)
        c0, flat = self._scale(point.c), np.r_[like[0].conj().ravel(), like[1]]
        last = np.zeros(len(J) + 1)
        last[-1] = 1.0
        t = np.linalg.solve(np.vstack([J, flat]), last)
        tc, tp = real_part_of(t[: point.c.size].reshape(point.c.shape)), t[point.c.size :].real
        length = np.hypot(np.linalg.norm(tc) / c0, np.linalg.norm(tp / self.spans))
        return replace(point, tangent=(tc / length, tp / length))

    def _row(self, tangent: tuple[np.ndarray, np.ndarray], c: np.ndarray) -> tuple:
        """Return the row of (1) of a tangent."""
        return tangent[0] / self._scale(c) ** 2, tangent[1] / self.spans**2

    # ------------------------------------------------------------ harmonics

    def refined(self, point: Point) -> Point:
        """Return the solution at the same value with as many harmonics as the tolerance needs."""
        while True:
            by_pass, by_spin = point.balance.left_out(point.c)
            point = replace(point, error=float(np.hypot(by_pass, by_spin)))
            (K, N), (most_k, most_n) = point.balance.reach, self.most
            more = (
                min(K + max(K // 2, 2), most_k) if by_pass > 0.7 * self.tolerance else K,
                min(N + max(N // 2, 2), most_n) if by_spin > 0.7 * self.tolerance else N,
            )
            unknowns = len(orders_of(more)) * point.c.shape[1]
            if point.error <= self.tolerance or more == (K, N) or unknowns > _MOST_UNKNOWNS:
                return point
            try:
                point = self.at_value(self.widened(point, more), point.value)
            except UnconvergedError:
                return point

    def widened(self, point: Point, reach: tuple[int, int]) -> Point:
        """Return a point, no solution yet, with other harmonics."""
        before = point.balance.reach
        tangent = point.tangent
        if tangent is not None:
            tangent = padded(tangent[0], before, reach), tangent[1]
        return replace(
            point,
            c=padded(point.c, before, reach),
            balance=self.balance(point.p, reach),
            tangent=tangent,
        )

    # ------------------------------------------------------------ a branch

    def followed(
        self,
        start: Point,
        values: np.ndarray,
        sense: float = 1.0,
        limits: tuple[float, float] | None = None,
    ) -> Iterator[Point]:
        """Yield the points of a branch from a solution on, until it leaves its limits.

        These are the first and the last value by default.
        """
        c = start.c
        if start.tangent is None:
            up = np.zeros_like(c), np.eye(len(start.p))[-1] * sense / self.spans
            start = self.with_tangent(start, up)
        point, step = self.measure(start), _FIRST
        yield point
        low, high = limits or (values[0], values[-1])
        for _ in range(_MOST_POINTS):
            try:
                after, step = self._next(point, step)
            except UnconvergedError:
                self.lost.append(f"{point.value:.6g}")
                return
            section = [point, *self._changes(point, after), after]
            for first, second in pairwise(section):
                yield from self._landed(first, second, values)
                if second is not after or low <= after.value <= high:
                    yield second
            if not low <= after.value <= high:
                return
            point = after
        self.lost.append(f"{point.value:.6g}")

    def _next(self, point: Point, step: float) -> tuple[Point, float]:
        """Return the next point, measured, and the step after it."""
        while step > _SHORTEST:
            try:
                after, count = self._stepped(point, step)
            except (UnconvergedError, np.linalg.LinAlgError, ArithmeticError, ValueError):
                step *= 0.5
                continue
            like = self.widened(point, after.balance.reach).tangent
            row = self._row(like, point.c)
            turn = np.vdot(row[0], after.tangent[0]).real + row[1] @ after.tangent[1]
            if turn < _TURN and step > _SMOOTH:
                step *= 0.5
                continue
            factor = np.clip(_WANTED / count, 0.5, 2.0) * (0.7 if turn < 0.97 else 1.0)
            return self.measure(after), min(factor * step, _LONGEST)
        raise UnconvergedError("a branch ends")

    def _stepped(self, point: Point, step: float) -> tuple[Point, int]:
        t = point.tangent
        p = point.p + step * t[1]
        start = replace(
            point, c=point.c + step * t[0], p=p, kind="computed",
            balance=self.balance(p, point.balance.reach),
        )  # fmt: skip
        after, count = self.corrected(start, self._row(t, point.c))
        refined = self.refined(after)
        like = self.widened(replace(point, tangent=t), refined.balance.reach).tangent
        return self.with_tangent(refined, self._row(like, refined.c)), count

    # ------------------------------------------------------------ between two points

    def _chord(self, first: Point, second: Point, share: float) -> tuple[Point, tuple]:
        """Return the point at a share of the way between two, no solution yet, and that way."""
        reach = tuple(map(max, zip(first.balance.reach, second.balance.reach, strict=True)))
        a, b = self.widened(first, reach), self.widened(second, reach)
        chord = b.c - a.c, b.p - a.p
        p = a.p + share * chord[1]
        start = replace(b, c=a.c + share * chord[0], p=p, balance=self.balance(p, reach))
        return start, self._row(chord, a.c)

    def _between(self, first: Point, second: Point, share: float) -> Point:
        """Return the solution at a share of the way between two."""
        start, row = self._chord(first, second, share)
        return self.with_tangent(self.corrected(start, row)[0], row)

    def _changes(self, first: Point, second: Point) -> list[Point]:
        """Return folds, or else changes of stability, between two points of a branch."""
        if first.tangent[1][-1] * second.tangent[1][-1] < 0.0:
            return self._change(first, second, lambda one: float(one.tangent[1][-1]), "fold")
        if (first.growth > 0.0) != (second.growth > 0.0):
            found = self._change(first, second, lambda one: self.measure(one).growth, "")
            return [replace(one, kind=_kind(one.multiplier)) for one in found]
        return []

    def _change(
        self, first: Point, second: Point, of: Callable[[Point], float], kind: str
    ) -> list[Point]:
        ends = {0.0: of(first), 1.0: of(second)}

        def at(share: float) -> float:
            return ends[share] if share in ends else of(self._between(first, second, share))

        try:
            share = brentq(at, 0.0, 1.0, xtol=_IN_PARAMETER)
            found = self.measure(self._between(first, second, share))
        except (UnconvergedError, ValueError, ArithmeticError, np.linalg.LinAlgError):
            return []
        return [replace(found, kind=kind, error=second.error)]

    def _landed(self, first: Point, second: Point, values: np.ndarray) -> Iterator[Point]:
        """Yield the solutions at wanted values between two points, in their order."""
        a, b = first.value, second.value
        up = values[(values > a) & (values <= b)]
        for value in up if a < b else values[(values < a) & (values >= b)][::-1]:
            try:
                near = self._chord(first, second, (value - a) / (b - a))[0]
                found = self.refined(self.at_value(near, value))
                found = self.measure(replace(found, kind="value"))
            except (UnconvergedError, ValueError, ArithmeticError, np.linalg.LinAlgError):
                continue
            yield found


def _kind(multiplier: complex) -> str:
    """Return what a multiplier that crosses the unit circle makes of a motion."""
    if abs(multiplier.imag) > 1e-6 * abs(multiplier):
        return "torus"
    return "doubling" if multiplier.real < 0.0 else "branching"


def same(one: Point, others: Sequence[Point], size: float) -> bool:
    """Return whether a point is one of others, at the same value."""
    for other in others:
        reach = tuple(map(max, zip(one.balance.reach, other.balance.reach, strict=True)))
        a, b = (padded(each.c, each.balance.reach, reach) for each in (one, other))
        near = abs(one.value - other.value) <= 1e-9 * max(abs(one.value), 1e-300)
        if near and np.linalg.norm(a - b) <= 1e-3 * max(np.linalg.norm(b), _LEAST * size):
            return True
    return False
