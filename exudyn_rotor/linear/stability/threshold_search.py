"""Where the verdict on stability changes over one parameter, also between samples."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import combinations, pairwise

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import linear_sum_assignment, minimize_scalar

from exudyn_rotor.callers import user_level
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, UnconvergedError, fold
from exudyn_rotor.linear.stability.between_samples import to_look_at
from exudyn_rotor.linear.stability.growth import Growth
from exudyn_rotor.linear.stability.growth_over import GrowthOver
from exudyn_rotor.linear.stability.growth_scan import GrowthScan

ASIDE = 1e-6  # of the range: where the mode of a threshold is looked at
# motions that decay faster than this share of |λ| or Ω are not led into instability by another
_DAMPED = 0.05
# times which a damped motion may rise between two samples as its tangents tell
_STEEPER = 10.0
_CROSSING_STEPS, _PEAK_STEPS = 5, 8
# parts of a gap whose ends differ in their verdict
_INSIDE = 8
# motions whose limits are tried, and shares of the accuracy: how well they are known, and where
# growths on both sides of them are made
_LIMITS, _CLOSE, _BESIDE = 3, 0.05, 0.4
# share of its distance from zero that a real part may differ from the cubic between its tangents
_SURPRISE = 0.1
_PLACES = 65  # where the cubic is looked at
# share of the decay of two motions that the gap of their frequencies may be where they have met
_MET = 0.1
# share of the last change of a root that the next one is where secants meet
_MEETS = 0.2
# values between two samples at which equations are made, the ends too
_EQUATIONS = 3
# of a gap that begins at rest: below, the turn of equations is too slow for their exponents
_SLOWEST = 0.125
# of the range: by which rates of change are told; changes below a share of |λ| are not
STEP, _NOISE = 1e-5, 1e-5


@dataclass(eq=False)
class Search:
    """Growth at known values of the parameter, and where its sign changes.

    Where motions pass each other between two samples, only their rates of change over the parameter
    tell which is which.
    """

    made: GrowthOver
    span: float
    known: dict[float, Growth] = field(default_factory=dict)
    rates: dict[float, np.ndarray] = field(default_factory=dict)
    systems: dict[float, PeriodicSystem | None] = field(default_factory=dict)  # of one gap
    most: float = np.inf  # values at which motions that meet are followed

    def at(self, value: float) -> Growth:
        if value not in self.known:
            self.known[value] = self.made.growth(value)
        return self.known[value]

    def unstable(self, value: float) -> bool:
        return self.at(value).excess > 0.0

    def changes(self, accuracy: float) -> list[tuple[float, bool]]:
        """Return where the verdict changes, and whether to unstable."""
        found = []
        for low, high in pairwise(sorted(self.known)):
            if self.unstable(low) != self.unstable(high):
                ends = (low, high) if self.unstable(high) else (high, low)
                try:
                    found.append((self._change(*ends, accuracy), self.unstable(high)))
                except UnconvergedError:
                    if not self._leaves_rest(low, high):
                        raise
                    found.append((self._lowest_above_rest(low, high), self.unstable(high)))
        return found

    def _lowest_above_rest(self, rest: float, high: float) -> float:
        """Return the lowest speed at which a search downwards knew the verdict, with a warning."""
        verdict, known = self.unstable(high), sorted(self.known)
        lowest = min(at for at in known if at > rest and self.unstable(at) == verdict)
        words = ("stable", "unstable")
        warnings.warn(
            f"the rotor is {words[not verdict]} at rest and {words[verdict]} from {lowest:.4g} "
            "rad/s on; the limit is told there, as exponents at lower speeds do not converge",
            UserWarning,
            stacklevel=user_level(),
        )
        return lowest

    def _change(self, stable: float, unstable: float, accuracy: float) -> float:
        """Return where the verdict changes between two values.

        Where the motion that grows can be followed alone, growths on both sides of its limit tell
        whether that is it. Else by secants through the growth on the unstable side, which is that
        of one motion; on the stable side the largest real part is soon that of another. Every
        fourth step halves where the secants do not meet.
        """
        stable, unstable, root = self._beside_limit(stable, unstable, accuracy)
        last, error, steps = None, np.inf, 0
        while abs(unstable - stable) > accuracy:
            steps += 1
            guess, before, former = np.nan, root, error
            if last is not None:
                root = self._secant(last, unstable)
                error = abs(root - before)
                if steps % 4 or error < _MEETS * former:
                    guess = self._beside(root, before, stable, unstable, accuracy)
            if not min(stable, unstable) < guess < max(stable, unstable):
                guess = 0.5 * (stable + unstable)
            if self.unstable(guess):
                last, unstable = unstable, guess
            else:
                stable = guess
        if np.isnan(root):
            return 0.5 * (stable + unstable)
        return float(np.clip(root, min(stable, unstable), max(stable, unstable)))

    def _beside_limit(
        self, stable: float, unstable: float, accuracy: float
    ) -> tuple[float, float, float]:
        """Return two values nearer to a change of the verdict, and where it is; NaN: not told."""
        for _ in range(_LIMITS):
            if abs(unstable - stable) <= accuracy:
                break
            limit = self.made.limit(self.at(unstable), (stable, unstable), _CLOSE * accuracy)
            if limit is None:
                break
            if np.isnan(limit):
                middle = 0.5 * (stable + unstable)
                if self.unstable(middle):
                    unstable = middle
                else:
                    stable = middle
                continue
            away = _BESIDE * accuracy * np.sign(stable - unstable)
            ends = min(stable, unstable), max(stable, unstable)
            beyond, before = np.clip([limit + away, limit - away], *ends).tolist()
            if self.unstable(beyond):  # by another motion
                unstable = beyond
                continue
            if self.unstable(before):
                return beyond, before, limit
            return before, unstable, np.nan
        return stable, unstable, np.nan

    def _secant(self, far: float, near: float) -> float:
        """Return where the growth at two unstable values points to; NaN where it does not fall."""
        rise, height = self.at(far).excess - self.at(near).excess, self.at(near).excess
        return near - height * (far - near) / rise if rise > 0.0 else np.nan

    @staticmethod
    def _beside(
        root: float, before: float, stable: float, unstable: float, accuracy: float
    ) -> float:
        """Return a value a little to the unstable side of a root, or beyond it for the last."""
        away = np.sign(stable - unstable)
        distance = abs(unstable - root)
        error = 0.5 * distance if np.isnan(before) else abs(root - before)
        if distance <= accuracy:
            return root + away * max(0.4 * accuracy, error)
        return root - away * min(max(0.4 * accuracy, 0.5 * error), 0.5 * distance)

    def rate(self, value: float, step: float) -> np.ndarray:
        """Return the change of all exponents per unit of the parameter."""
        if value not in self.rates:
            here = self.at(value)
            known = self.made.rates(here, value, step)
            self.rates[value] = self._differences(here, value, step) if known is None else known
        return self.rates[value]

    def _differences(self, here: Growth, value: float, step: float) -> np.ndarray:
        """Return the changes to a second growth; none of exponents that are rounding."""
        told = here.bounds <= _NOISE * np.maximum(np.abs(here.values), here.base)
        told |= here.base == 0.0
        near = _nearest(self.made.growth(value + step).values, here.values[told], here.base)
        rates = np.zeros_like(here.values)
        rates[told] = fold(near - here.values[told], here.base) / step
        return rates

    def refine(self) -> None:
        """Look between the samples for ranges of the other verdict."""
        gaps = list(pairwise(sorted(self.known)))
        self._by_tangents(gaps)
        for low, high in gaps:
            self._scan(low, high)

    def _scan(self, low: float, high: float) -> None:
        """Look where growths at many values, if equations turn, say that another verdict is."""
        if self._leaves_rest(low, high):
            low += _SLOWEST * (high - low)
        elif not (self.at(low).base > 0.0 and self.at(high).base > 0.0):
            return
        values = np.linspace(low, high, _EQUATIONS).tolist()
        self.systems = {at: self.systems.get(at) or self.made.system(at) for at in values}
        systems = list(self.systems.values())
        if GrowthScan.can(systems):
            known = {at: self.unstable(at) for at in list(self.known) if low <= at <= high}
            for value in to_look_at(GrowthScan(values, systems), (low, high), known):
                self.at(value)

    def _by_tangents(self, gaps: Sequence[tuple[float, float]]) -> None:
        """Look between samples of one verdict where exponents and their rates say so."""
        for low, high in gaps:
            if self._leaves_rest(low, high):
                continue
            if self.unstable(low) != self.unstable(high):
                self._look_inside(low, high)
                continue
            if self.unstable(low):
                self._search(low, high, lambda growth, _: growth.excess)
                continue
            piece = _Piece.between(self, low, high)
            for start, pair in piece.crossings():
                if len(self.known) < self.most:
                    self._meet(start, pair, low, high)
            for branch in piece.peaks():
                self._climb(piece, branch)
            self._part(low, high)

    def _leaves_rest(self, low: float, high: float) -> bool:
        """Return whether equations turn above rest, where no rates tell of exponents above."""
        return self.made.is_at_rest(low) and self.at(high).base > 0.0

    def _look_inside(self, low: float, high: float) -> None:
        """Look between samples of different verdict, which may change more than once.

        At values between, and where growth has its low among them. Of equations that do not turn;
        others are scanned.
        """
        if self.at(low).base > 0.0 or self.at(high).base > 0.0 or len(self.known) >= self.most:
            return
        values = np.linspace(low, high, _INSIDE + 1).tolist()
        growth = [self.at(value).excess for value in values]
        for place in range(1, _INSIDE):
            beside = growth[place - 1], growth[place + 1]
            if 0.0 < growth[place] < min(beside):
                ends = values[place - 1], values[place + 1]
                self._search(*ends, lambda found, _: found.excess)

    def _part(self, low: float, high: float) -> None:
        """Look between unstable values of a gap, which may be of ranges far narrower than it."""
        inside = [value for value in sorted(self.known) if low < value < high]
        for first, second in pairwise(inside):
            if self.unstable(first) and self.unstable(second):
                self.at(0.5 * (first + second))

    @property
    def _step(self) -> float:
        return STEP * self.span

    def _meet(self, value: float, pair: np.ndarray, low: float, high: float) -> None:
        """Follow two motions to where their frequencies meet, until something is unstable.

        By Newton's method on the difference, which does not ask which of the two is which. Of two
        that decay with a and b and couple with c, ``c² > ab (1 + (gap/(a + b))²)`` lets one grow.
        """
        for _ in range(_CROSSING_STEPS):
            growth = self.at(float(value))
            if growth.excess > 0.0 or len(self.known) >= self.most:
                return
            columns = _nearest_columns(growth.values, pair, growth.base)
            rates, pair = self.rate(float(value), self._step)[columns], growth.values[columns]
            gap, change = _apart(pair, growth.base), (rates[0] - rates[1]).imag
            if abs(gap) < _MET * abs(pair.real.sum()):
                return
            move = -gap / change if change else np.inf
            if abs(move) < ASIDE * self.span or not low < value + move < high:
                return
            pair, value = pair + move * rates, value + move

    def _climb(self, piece: _Piece, branch: int) -> None:
        """Look for the peak of a motion's real part, with a search where no cubic tells it."""
        peak, expected = piece.peak(branch)
        falling = piece.real_part(branch)
        if self.unstable(peak):
            return
        found = -falling(self.at(peak), peak)
        if abs(found - expected) > _SURPRISE * abs(found):
            self._search(piece.low, piece.high, falling)

    def _search(self, low: float, high: float, falling: Callable[[Growth, float], float]) -> None:
        minimize_scalar(
            lambda value: falling(self.at(float(value)), value),
            bounds=(low, high),
            method="bounded",
            options={"maxiter": _PEAK_STEPS},
        )


@dataclass(frozen=True, eq=False)
class _Piece:
    """Motions between two samples, the same at both by their rates of change.

    Attributes
    ----------
    low, high : float
    ends, rates : ndarray, shape (2, n)
        The same motions at both, and their rates of change.
    base : float
    """

    low: float
    high: float
    ends: np.ndarray
    rates: np.ndarray
    base: float

    @classmethod
    def between(cls, search: Search, low: float, high: float) -> _Piece:
        growths, step = [search.at(value) for value in (low, high)], STEP * search.span
        rates = [search.rate(value, s) for value, s in ((low, step), (high, -step))]
        base, half = growths[1].base, 0.5 * (high - low)
        halfway = [growths[0].values + half * rates[0], growths[1].values - half * rates[1]]
        columns = _nearest_columns(halfway[1], halfway[0], base)
        return cls(
            low,
            high,
            np.array([growths[0].values, growths[1].values[columns]]),
            np.array([rates[0], rates[1][columns]]),
            base,
        )

    def crossings(self) -> Iterator[tuple[float, np.ndarray]]:
        """Yield where frequencies of lightly damped motions meet, and both exponents there."""
        size = np.abs(self.ends).max(initial=0.0)
        for pair in combinations(np.flatnonzero(self._light), 2):
            columns = list(pair)
            if self.ends[0, columns].imag.sum() < -1e-6 * size:  # the conjugates of another pair
                continue
            gaps = [_apart(values, self.base) for values in self.ends[:, columns]]
            near = self.base == 0.0 or max(map(abs, gaps)) < 0.25 * self.base
            if gaps[0] * gaps[1] < 0.0 and near:
                share = gaps[0] / (gaps[0] - gaps[1])
                change = fold(self.ends[1, columns] - self.ends[0, columns], self.base)
                here = self.ends[0, columns] + share * change
                yield self.low + share * (self.high - self.low), here

    @property
    def _light(self) -> np.ndarray:
        """Which motions are lightly damped at both ends."""
        size = np.abs(self.ends).max(initial=0.0)
        limit = -_DAMPED * np.maximum(np.abs(self.ends[0]), 1e-3 * size)
        return np.all(self.ends.real > limit, axis=0)

    def peaks(self) -> np.ndarray:
        """Return motions whose real part may have a peak between, up to zero, one of each pair.

        What lifts a damped motion acts over a width of the order of its decay, so that tangents
        tell it; a light one may meet another anywhere between.
        """
        rise, fall = self.rates.real * (self.high - self.low)
        noise = _NOISE * np.maximum(np.abs(self.ends[0]), np.abs(self.ends[1]))
        reaches = self.ends.real.max(axis=0) + _STEEPER * np.maximum(rise, -fall) > 0.0
        wanted = (rise > noise) & (fall < -noise) & (self._light | reaches)
        return np.flatnonzero(wanted & (self.ends[0].imag >= 0.0))

    def peak(self, branch: int) -> tuple[float, float]:
        """Return where a real part is largest by values and tangents at both ends, and that."""
        width = self.high - self.low
        cubic = CubicHermiteSpline(
            [0.0, 1.0], self.ends[:, branch].real, width * self.rates[:, branch].real
        )
        shares = np.linspace(0.0, 1.0, _PLACES)[1:-1]
        values = cubic(shares)
        best = int(np.argmax(values))
        return float(self.low + shares[best] * width), float(values[best])

    def real_part(self, branch: int) -> Callable[[Growth, float], float]:
        """Return minus the real part of a motion between as a function, for a search."""
        start, end = self.ends[:, branch]

        def falling(growth: Growth, value: float) -> float:
            share = (value - self.low) / (self.high - self.low)
            guess = start + share * fold(np.array([end - start]), growth.base)
            return -float(_nearest(growth.values, guess, growth.base)[0].real)

        return falling


def _apart(pair: np.ndarray, base: float) -> float:
    return float(fold(np.array([pair[0] - pair[1]]), base)[0].imag)


def _nearest_columns(values: np.ndarray, guesses: np.ndarray, base: float) -> np.ndarray:
    """Return which values are next to guesses, each once."""
    return linear_sum_assignment(np.abs(fold(values[None, :] - guesses[:, None], base)))[1]


def _nearest(values: np.ndarray, guesses: np.ndarray, base: float) -> np.ndarray:
    """Return the values next to guesses, each once."""
    return values[_nearest_columns(values, guesses, base)]
