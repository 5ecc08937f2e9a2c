"""Branches of solutions over a parameter: pseudo-arclength continuation, folds, changes.

Unknowns are the harmonics c of :mod:`.balance` and real parameters p: the one that a branch goes
along, last, and before it the frequency of a limit cycle, which a phase condition makes definite.
A step goes along the tangent t of the branch by the length s, and returns to it at right angles,

    R(c, p) = 0,   Re⟨φ, c⟩ = 0,   Re⟨t_c, c − c*⟩/c₀² + t_p (p − p*)/p₀² = 0,              (1)

by Newton's method, so that a branch may turn back: there the last component of t is zero (E. L.
Allgower, K. Georg, *Numerical Continuation Methods* (1990)). Steps grow where the method converges
fast and the tangent turns little; solutions at wanted values are found between them.

At a crossing of branches the derivative of (1) has a second null vector. Where a motion of a part
of its period begins to repeat after the whole period only, that vector has the new harmonics alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.nonlinear.balance import Balance, orders_of, padded, real_part_of
from exudyn_rotor.nonlinear.beside import Beside

_MOST_ITERATIONS = 9
_CONVERGED = 1e-6  # scaled last step, whose square is the error
_RATE = 1e-8  # or what steps that shrink as the last one did would leave
_FAR = 1e-2  # scaled step from which on derivatives by parameters are taken anew
_DIFFERENCE = 1e-6  # of the range of a parameter, for derivatives by it
_FIRST, _LONGEST, _SHORTEST = 0.02, 0.25, 1e-5  # steps in scaled unknowns
_WANTED = 4  # iterations
_BESIDE = 0.5  # of a step: solutions farther from where they are looked for may be of others
_TURN = 0.92  # cosine between tangents, below which a step is repeated with half its length
_ASIDE = (0.02, 0.05, 0.005)  # scaled steps from a crossing onto the other branch
_NEW = 1e-6  # share of a motion in harmonics that it does not have
_SMOOTH = 1e-3  # step below which a branch may have a corner, where contacts begin
_LEAST = 0.1  # of the wanted size, as which a motion counts at least
_MOST_POINTS = 1000
_MOST_UNKNOWNS = 1500
_SAME, _UNLIKE = 1e-3, 10.0  # share of a motion, and of what is left out, that two may differ by
_IN_PARAMETER = 1e-7  # of a step, to which a change on a branch is found
FAILS = (UnconvergedError, ValueError, ArithmeticError, np.linalg.LinAlgError)
Row = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True, eq=False)
class Point:
    """A solution."""

    c: np.ndarray  # (h, d)
    p: np.ndarray  # (e,)
    balance: Balance
    tangent: Row | None = None  # components along c and p, scaled length 1
    # 'computed', 'value' (a wanted one), 'fold', 'doubling', 'torus' or 'branching'
    kind: str = "computed"
    growth: float = np.nan  # of the motions beside it, see :mod:`.beside`
    multiplier: complex = np.nan
    error: float = np.nan  # share of the motion in harmonics that are left out

    @property
    def value(self) -> float:
        """Of the parameter that the branch goes along."""
        return float(self.p[-1])


@dataclass(eq=False)
class Family:
    """Solutions over a range of a parameter."""

    # takes parameters (e,) and K and N, gives the equations
    balance: Callable[[np.ndarray, tuple[int, int]], Balance]
    spans: np.ndarray  # (e,) p₀: what counts as one of each parameter
    size: float  # of a motion that matters [m]
    tolerance: float  # largest share of the motion in harmonics that are left out
    most: tuple[int, int]  # harmonics up to which more are added
    phase: tuple[np.ndarray, tuple[int, int]] | None = None  # (h, d) φ of (1), with its reach
    lost: list[str] = field(default_factory=list)

    def measure(self, point: Point) -> Point:
        """Return a point with what motions beside it do, less the shift in time of a cycle."""
        growth, multiplier = Beside(point.balance, point.c).growth(self.phase is not None)
        return replace(point, growth=growth, multiplier=multiplier)

    # ------------------------------------------------------------ Newton's method

    def _scale(self, c: np.ndarray) -> float:
        return max(float(np.linalg.norm(c)), _LEAST * self.size)

    def _system(self, point: Point) -> tuple[np.ndarray, np.ndarray]:
        """Return what is left (n,), and its derivative by c (n, n), without the last row of (1)."""
        left, J = point.balance.linearised(point.c)
        left = left.ravel()
        if self.phase is not None:
            phi = padded(*self.phase, point.balance.reach).ravel().conj()
            J, left = np.vstack([J, phi]), np.r_[left, phi @ point.c.ravel()]
        return left, J

    def _by_parameters(self, point: Point, left: np.ndarray) -> np.ndarray:
        """Return the derivative (n, e) of what is left by the parameters."""
        found = np.zeros((len(left), len(self.spans)), dtype=complex)
        for place, span in enumerate(self.spans):
            p = point.p.copy()
            p[place] += _DIFFERENCE * span
            beside = self.balance(p, point.balance.reach).residual(point.c).ravel()
            found[: beside.size, place] = (beside - left[: beside.size]) / (_DIFFERENCE * span)
        return found

    def corrected(self, start: Point, row: Row) -> tuple[Point, int]:
        """Return the solution near a start at right angles to a row, and after how many steps.

        With its tangent, in the sense of the row.
        """
        point, last, by = start, np.inf, None
        flat = np.r_[row[0].conj().ravel(), row[1]]
        for count in range(1, _MOST_ITERATIONS + 1):
            left, J = self._system(point)
            if by is None or last > _FAR:
                by = self._by_parameters(point, left)
            both = np.zeros((len(left) + 1, 2), dtype=complex)
            both[:-1, 0], both[-1, 1] = left, 1.0
            step, t = np.linalg.solve(np.vstack([np.hstack([J, by]), flat]), both).T
            moved, parameters = self._parts(step, point)
            length = self._length(moved, parameters, point.c)
            if not np.isfinite(length) or (length > 2.0 * last and count > 2) or length > 10.0:
                break
            converged = length < _CONVERGED or (count > 1 and length**2 < _RATE * last)
            last = length
            p = point.p - parameters
            point = replace(
                point, c=point.c - moved, p=p, balance=self.balance(p, point.balance.reach)
            )
            if converged:
                tc, tp = self._parts(t, point)
                length = self._length(tc, tp, point.c)
                return replace(point, tangent=(tc / length, tp / length)), count
        raise UnconvergedError("no solution beside another one")

    def _parts(self, step: np.ndarray, like: Point) -> Row:
        """Return the parts of a step (n + 1,) along harmonics and parameters."""
        size = like.c.size
        return real_part_of(step[:size].reshape(like.c.shape)), step[size:].real

    def _length(self, c: np.ndarray, p: np.ndarray, at: np.ndarray) -> float:
        """Return the scaled length of a step from harmonics."""
        return float(np.hypot(np.linalg.norm(c) / self._scale(at), np.linalg.norm(p / self.spans)))

    def at_value(self, start: Point, value: float, sense: float = 1.0) -> tuple[Point, int]:
        """Return the solution near a start at a value of the parameter, and after how many steps.

        With its tangent in the sense in which the parameter changes.
        """
        p = start.p.copy()
        p[-1] = value
        start = replace(start, p=p, balance=self.balance(p, start.balance.reach))
        return self.corrected(start, (np.zeros_like(start.c), sense * np.eye(len(p))[-1]))

    def _row(self, tangent: Row, c: np.ndarray) -> Row:
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
                sense = 1.0 if point.tangent is None else np.sign(point.tangent[1][-1])
                point = self.at_value(self.widened(point, more), point.value, sense or 1.0)[0]
            except FAILS:
                return point

    def widened(self, point: Point, reach: tuple[int, int]) -> Point:
        """Return a point, no solution yet, with other harmonics."""
        before = point.balance.reach
        if before == reach:
            return point
        t = point.tangent
        return replace(
            point,
            c=padded(point.c, before, reach),
            balance=self.balance(point.p, reach),
            tangent=t and (padded(t[0], before, reach), t[1]),
        )

    # ------------------------------------------------------------ a branch

    def followed(
        self,
        start: Point,
        values: np.ndarray,
        sense: float = 1.0,
        limits: tuple[float, float] | None = None,
        until: Callable[[Point, Point], bool] | None = None,
    ) -> Iterator[Point]:
        """Yield the points of a branch from a solution on, until it leaves its limits.

        These are the first and the last value by default; or until two points say so.
        """
        if start.tangent is None or start.tangent[1][-1] * sense < 0.0:
            start = replace(self.at_value(start, start.value, sense)[0], kind=start.kind)
        point, step = self.measure(start), _FIRST
        yield point
        low, high = limits or (values[0], values[-1])
        for _ in range(_MOST_POINTS):
            try:
                *changes, after, step = self._next(point, step)
            except UnconvergedError:
                self.lost.append(f"{point.value:.6g}")
                return
            if until is not None and until(point, after):
                return
            for first, second in pairwise([point, *changes, after]):
                yield from self._landed(first, second, values)
                if second is not after or low <= after.value <= high:
                    yield second
            if not low <= after.value <= high:
                return
            point = after
        self.lost.append(f"{point.value:.6g}")

    def _next(self, point: Point, step: float) -> tuple:
        """Return changes of the motion, the next point, measured, and the step after it."""
        while step > _SHORTEST:
            try:
                return self._stepped(point, step)
            except FAILS:
                step *= 0.5
        raise UnconvergedError("a branch ends")

    def _stepped(self, point: Point, step: float) -> tuple:
        """Return what :meth:`_next` does, by a step of a length.

        A step over a change that is not found between its ends has gone to another branch.
        """
        (tc, tp), row = point.tangent, self._row(point.tangent, point.c)
        c, p = point.c + step * tc, point.p + step * tp
        start = replace(point, c=c, p=p, balance=self.balance(p, point.balance.reach))
        after, count = self.corrected(replace(start, kind="computed"), row)
        is_far = self._length(after.c - c, after.p - p, point.c) > _BESIDE * step
        after = self.refined(after)
        row = self._row(self.widened(point, after.balance.reach).tangent, point.c)
        turn = np.vdot(row[0], after.tangent[0]).real + row[1] @ after.tangent[1]
        if step > _SMOOTH and (is_far or turn < _TURN):
            raise UnconvergedError("another branch")
        after = self.measure(after)
        changes = self._changes(point, after)
        if step > _SMOOTH and changes is None:
            raise UnconvergedError("another branch")
        factor = np.clip(_WANTED / count, 0.5, 2.0) * (0.7 if turn < 0.97 else 1.0)
        return *(changes or ()), after, min(factor * step, _LONGEST)

    def aside(self, point: Point) -> tuple[Point, int] | None:
        """Return a solution beside a crossing, on the branch of a longer period.

        With the number g, multiples of which are the orders n of the shorter period; None where no
        branch of a longer period begins.
        """
        n = point.balance.orders[:, 1]
        size = np.linalg.norm(point.c, axis=1)
        g = int(np.gcd.reduce(n[size > _NEW * size.max()]))
        left, J = self._system(point)
        t = np.r_[point.tangent[0].conj().ravel() / self._scale(point.c), point.tangent[1]]
        matrix = np.vstack([np.hstack([J, self._by_parameters(point, left)]), t])
        phi = np.linalg.svd(matrix)[2][-1].conj()
        pairs = [self._parts(turn * phi, point) for turn in (1.0, 1j)]
        phi = max(pairs, key=lambda one: np.linalg.norm(one[0]))[0]
        new = n % g != 0
        if np.linalg.norm(phi[~new]) > 0.1 * np.linalg.norm(phi):
            return None
        phi = phi * new[:, None] * self._scale(point.c) / np.linalg.norm(phi)
        row = self._row((phi, np.zeros(len(point.p))), point.c)
        for step in _ASIDE:
            start = replace(point, c=point.c + step * phi, kind="computed")
            try:
                return self.refined(self.corrected(start, row)[0]), g
            except FAILS:
                continue
        return None

    # ------------------------------------------------------------ between two points

    def _chord(self, first: Point, second: Point, share: float) -> tuple[Point, tuple]:
        """Return the point at a share of the way between two, no solution yet, and that way."""
        reach = tuple(map(max, zip(first.balance.reach, second.balance.reach, strict=True)))
        a, b = self.widened(first, reach), self.widened(second, reach)
        chord = b.c - a.c, b.p - a.p
        p = a.p + share * chord[1]
        start = replace(b, c=a.c + share * chord[0], p=p, balance=self.balance(p, reach))
        return start, self._row(chord, a.c)

    def _changes(self, first: Point, second: Point) -> list[Point] | None:
        """Return folds, or else changes of stability, between two points; None if not found."""
        if first.tangent[1][-1] * second.tangent[1][-1] < 0.0:
            return self._change(first, second, lambda one: float(one.tangent[1][-1]), "fold")
        if (first.growth > 0.0) != (second.growth > 0.0):
            found = self._change(first, second, lambda one: self.measure(one).growth, "")
            return found and [replace(one, kind=_kind(one.multiplier)) for one in found]
        return []

    def _change(
        self, first: Point, second: Point, of: Callable[[Point], float], kind: str
    ) -> list[Point] | None:
        ends = {0.0: first, 1.0: second}

        def between(share: float) -> Point:
            return ends.get(share) or self.corrected(*self._chord(first, second, share))[0]

        try:
            found = between(brentq(lambda share: of(between(share)), 0.0, 1.0, xtol=_IN_PARAMETER))
            return [replace(self.measure(found), kind=kind, error=second.error)]
        except FAILS:
            return None

    def _landed(self, first: Point, second: Point, values: np.ndarray) -> Iterator[Point]:
        """Yield the solutions at wanted values between two points, in their order."""
        a, b = first.value, second.value
        inside = values[(values - a) * (values - b) < 0.0]
        for value in inside if a < b else inside[::-1]:
            try:
                near = self._chord(first, second, (value - a) / (b - a))[0]
                found = self.refined(self.at_value(near, value, np.sign(b - a))[0])
                found = self.measure(replace(found, kind="value"))
            except FAILS:
                self.lost.append(f"{value:g}")
                continue
            yield found


def _kind(multiplier: complex) -> str:
    """Return what a multiplier that crosses the unit circle makes of a motion."""
    if abs(multiplier.imag) > 1e-6 * abs(multiplier):
        return "torus"
    return "doubling" if multiplier.real < 0.0 else "branching"


def same(one: Point, others: Sequence[Point], size: float) -> bool:
    """Return whether a point is one of others, at the same value, by what its harmonics tell."""
    for other in others:
        apart = max(_SAME, _UNLIKE * max(one.error, other.error))
        reach = tuple(map(max, zip(one.balance.reach, other.balance.reach, strict=True)))
        a, b = (padded(each.c, each.balance.reach, reach) for each in (one, other))
        near = abs(one.value - other.value) <= 1e-9 * max(abs(one.value), 1e-300)
        if near and np.linalg.norm(a - b) <= apart * max(np.linalg.norm(b), _LEAST * size):
            return True
    return False
