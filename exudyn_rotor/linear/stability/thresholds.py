"""Limits of stability over the spin speed or any other parameter."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import combinations, pairwise

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike
from scipy.optimize import brentq, linear_sum_assignment, minimize_scalar

from exudyn_rotor import checks, plotting
from exudyn_rotor.linear.modal.whirl import WHIRLS, WhirlContent, families
from exudyn_rotor.linear.models.linear_model import Target, linear_model
from exudyn_rotor.linear.models.supports import Support
from exudyn_rotor.linear.periodic.periodic_system import fold
from exudyn_rotor.linear.stability.growth import Growth, GrowthAt, check_options, held_space
from exudyn_rotor.results import Result, numbers, storable
from exudyn_rotor.sweep import ascending_from_zero
from exudyn_rotor.units import Units

_ROOT = 1e-8  # of the largest parameter
_ASIDE = 1e-6  # of the range: where the mode of a threshold is looked at
# motions that decay faster than this share of |λ| or Ω are not led into instability by another
_DAMPED = 0.05
_CROSSING_STEPS, _PEAK_STEPS = 5, 16
# of the range: by which rates of change are told; changes below a share of |λ| are not
_STEP, _NOISE = 1e-5, 1e-5
Supports = Sequence[Support] | Support


@storable
@dataclass(frozen=True, eq=False)
class StabilityThresholds(Result):
    """Where a rotor turns unstable, or stable again, over one parameter.

    Attributes
    ----------
    values : ndarray, shape (t,)
        The parameter at each change, ascending.
    onset : ndarray of bool, shape (t,)
        True where the rotor is unstable above.
    frequencies_inertial : ndarray, shape (t,)
        Of the mode that grows there, seen from outside [rad/s].
    whirl_codes, nodal_diameters : ndarray of int, shape (t,)
        Of that mode, as those of :class:`Campbell`.
    low, high : float
        Range of the parameter.
    unstable_at_low : bool
    label : str
        Name of the parameter with its unit.

    Examples
    --------
    >>> from exudyn_rotor import StabilityThresholds
    >>> result = StabilityThresholds([300.0], [True], [100.0], [0], [1], 0.0, 400.0, False)
    >>> print(result.table())
    speed [rad/s]   above      frequency [rad/s]  n  whirl    kind
              300   unstable                 100  1  forward  lateral
    """

    values: np.ndarray = numbers("thresholds")
    onset: np.ndarray = numbers("thresholds", dtype=bool)
    frequencies_inertial: np.ndarray = numbers("thresholds")
    whirl_codes: np.ndarray = numbers("thresholds", dtype=int, least=0, most=len(WHIRLS) - 1)
    nodal_diameters: np.ndarray = numbers("thresholds", dtype=int, least=-1)
    low: float
    high: float
    unstable_at_low: bool
    label: str = "speed [rad/s]"

    @property
    def ranges(self) -> np.ndarray:
        """Unstable ranges of the parameter, shape (r, 2); open ones end where the search did."""
        edges = [self.low] if self.unstable_at_low else []
        edges += self.values.tolist()
        edges += [self.high] if len(edges) % 2 else []
        return np.array(edges).reshape(-1, 2)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns; `units` are those of the frequencies."""
        shown = Units.of(units)
        frequencies = shown.frequencies(self.frequencies_inertial)
        return {
            self.label: self.values,
            "onset": self.onset,
            f"inertial [{shown.frequency}]": frequencies,
            "nodal diameters": self.nodal_diameters,
            "whirl": np.array(WHIRLS)[self.whirl_codes],
            "kind": families(self.whirl_codes, self.nodal_diameters),
        }

    def table(self) -> str:
        """Return the thresholds with the modes that grow there as lines of text."""
        lines = [f"{self.label:>13}   above      frequency [rad/s]  n  whirl    kind"]
        kinds = families(self.whirl_codes, self.nodal_diameters)
        for row, (value, onset) in enumerate(zip(self.values, self.onset, strict=True)):
            n, word = self.nodal_diameters[row], WHIRLS[self.whirl_codes[row]]
            lines.append(
                f"{value:13.7g}   {'unstable' if onset else 'stable':8}"
                f"{self.frequencies_inertial[row]:20.5g}  {n if n >= 0 else '-'}  {word:8} "
                f"{kinds[row]}"
            )
        if not self.values.size:
            lines.append(f"{'unstable' if self.unstable_at_low else 'stable'} in the whole range")
        return "\n".join(lines)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the frequencies of the modes at their thresholds; unstable ranges are shaded."""
        ax = plotting.axes_or_new(ax)
        for low, high in self.ranges:
            ax.axvspan(low, high, color=plotting.COLORS[1], alpha=0.2, lw=0.0)
        ax.plot(self.values, self.frequencies_inertial, "o", color=plotting.COLORS[0])
        ax.set_xlim(self.low, self.high)
        ax.set_xlabel(self.label)
        ax.set_ylabel("inertial frequency of the mode [rad/s]")
        ax.grid(alpha=0.3)
        return ax


def stability_threshold(
    target: Target | Callable[[float], Target],
    low: float,
    high: float,
    *,
    supports: Supports | Callable[[float], Supports] = (),
    speed: float | None = None,
    samples: int = 24,
    label: str | None = None,
    **given,
) -> StabilityThresholds:
    """Find all thresholds of stability over the spin speed or another parameter.

    Each to 1e-8 of the largest parameter, with the mode that grows there. Ranges between two
    samples are found where the real part of a mode, followed by its rate of change, has a peak, or
    where two lightly damped modes meet in frequency, as in a parametric resonance.
    The growth counts from its bound on, see :attr:`Stability.bounds`, so a threshold that is
    crossed slowly is found late by that over the slope.

    Parameters
    ----------
    target : as in :func:`stability`, or callable
        A callable takes the parameter and returns such a target.
    low, high : float
        Range of the parameter; spin speeds [rad/s] unless `target` or `supports` are callable.
    supports : sequence of Support, or callable, optional
        Of a rotor; a callable takes the parameter and returns them.
    speed : float, optional
        Spin speed [rad/s], where it is not the parameter.
    samples : int, optional
        Number of steps in which the range is sampled.
    label : str, optional
        Name of the parameter with its unit.
    **given
        Further arguments of :func:`stability`: `body`, `stiffening`, `method`, `tolerance`,
        `modes`, `residual`.

    Raises
    ------
    TypeError, ValueError
        For bad input, and a `speed` that is missing or given where it is the parameter.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, stability_threshold
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> def damped(inner: float) -> list:
    ...     outer = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    ...     return outer + [Support(s.interface, damping=inner, frame="rotor") for s in outer]
    >>> limit = stability_threshold(rotor, 100.0, 400.0, supports=damped(5.0))
    >>> limit.values.round(3)  # √(k/m) (1 + c_outer/c_inner)
    array([300.])
    >>> given = {"supports": damped, "speed": 300.0, "samples": 4}
    >>> print(stability_threshold(rotor, 2.0, 20.0, label="inner damping", **given).table())
    inner damping   above      frequency [rad/s]  n  whirl    kind
         5.000001   unstable                 100  1  forward  lateral
    """
    low = checks.number(low, "low")
    high = checks.number(high, "high", above=low)
    samples = checks.count(samples, "samples", least=2)
    is_speed = not callable(target) and not callable(supports)
    if is_speed:
        checks.number(low, "low", "rad/s", least=0.0)
        if speed is not None:
            raise ValueError("speed: is the parameter, from low to high; leave it out")
        label = "speed [rad/s]" if label is None else label
        made: _Made = _OverSpeed.of(target, high, given | {"supports": supports})
    else:
        if speed is None:
            raise ValueError("speed: needs the spin speed [rad/s], since it is not the parameter")
        speed = checks.number(speed, "speed", "rad/s", least=0.0)
        label = "parameter" if label is None else label
        made = _OverParameter(target, supports, speed, _Options.of(given))
    checks.label(label, "label")
    search = _Search(made, high - low)
    for point in np.linspace(low, high, samples + 1):
        search.at(float(point))
    search.refine()
    found = search.changes(_ROOT * max(abs(low), abs(high)))
    names = [made.mode(value, _ASIDE * (high - low) * (1 if on else -1)) for value, on in found]
    columns = list(zip(*names, strict=True)) if names else [(), (), ()]
    return StabilityThresholds(
        np.array([value for value, _ in found]),
        np.array([on for _, on in found], dtype=bool),
        np.array(columns[0], dtype=float),
        *(np.array(column, dtype=np.int64) for column in columns[1:]),
        low,
        high,
        bool(search.at(low).excess > 0.0),
        label,
    )


def unstable_ranges(target: Target, speeds: ArrayLike, **given) -> np.ndarray:
    """Return the unstable speed ranges, shape (r, 2) [rad/s].

    Every change between two neighbours of `speeds` is found to 1e-8 of the highest speed; a range
    narrower than their spacing can be missed: :func:`stability_threshold` looks for those, too. A
    range that is open at the first or last speed ends there. `given` are further arguments of
    :func:`stability`.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, unstable_ranges
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> inner = [Support(name, damping=5.0, frame="rotor") for name in ("left", "right")]
    >>> unstable_ranges(rotor, [100.0, 250.0, 400.0], supports=supports + inner).round(3)
    array([[300., 400.]])
    """
    values = ascending_from_zero(speeds, "speeds")
    search = _Search(_OverSpeed.of(target, values[-1], given), values[-1])
    unstable = [search.unstable(float(speed)) for speed in values]
    edges = [values[0]] if unstable[0] else []
    edges += [value for value, _ in search.changes(_ROOT * values[-1])]
    edges += [values[-1]] if unstable[-1] else []
    return np.array(edges).reshape(-1, 2)


@dataclass(frozen=True, eq=False)
class _Options:
    """Options of :func:`exudyn_rotor.stability`."""

    model: dict
    modes: int | None
    residual: float
    method: str
    tolerance: float

    @classmethod
    def of(cls, given: dict) -> _Options:
        given = dict(given)
        method, tolerance = given.pop("method", "auto"), given.pop("tolerance", 1e-9)
        modes, residual = given.pop("modes", None), given.pop("residual", 1e-7)
        check_options(method, tolerance, modes, residual)
        unknown = set(given) - {"supports", "body", "stiffening"}
        if unknown:
            raise TypeError(f"stability: unknown option {', '.join(sorted(unknown))}")
        return cls(given, modes, residual, method, tolerance)


class _Made:
    """Growth over a parameter."""

    def growth(self, value: float, named: bool = False) -> Growth:
        """Return the growth, with the names of the motions if asked for."""
        raise NotImplementedError

    def mode(self, value: float, aside: float) -> tuple[float, int, int]:
        """Return inertial frequency, whirl code and n of what grows beside a threshold."""
        growth = self.growth(value + aside, named=True)
        return tuple(name[growth.least_stable] for name in growth.names)


@dataclass(frozen=True, eq=False)
class _OverSpeed(_Made):
    """The parameter is the spin speed."""

    task: GrowthAt
    named: GrowthAt

    @classmethod
    def of(cls, target: Target, highest: float, given: dict) -> _OverSpeed:
        chosen = _Options.of(given)
        model = linear_model(target, **chosen.model)
        space = held_space(model, highest, chosen.modes, chosen.residual)
        parts = space, chosen.method, chosen.tolerance
        return cls(GrowthAt(*parts), GrowthAt(*parts, WhirlContent.of(model)))

    def growth(self, value: float, named: bool = False) -> Growth:
        return (self.named if named else self.task)(value)


@dataclass(frozen=True, eq=False)
class _OverParameter(_Made):
    """The parameter changes the model at one spin speed."""

    target: Target | Callable[[float], Target]
    supports: Supports | Callable[[float], Supports]
    speed: float
    options: _Options

    def growth(self, value: float, named: bool = False) -> Growth:
        target = self.target(value) if callable(self.target) else self.target
        supports = self.supports(value) if callable(self.supports) else self.supports
        chosen = self.options
        model = linear_model(target, supports=supports, **chosen.model)
        space = held_space(model, self.speed, chosen.modes, chosen.residual)
        content = WhirlContent.of(model) if named else None
        return GrowthAt(space, chosen.method, chosen.tolerance, content)(self.speed)


@dataclass(eq=False)
class _Search:
    """Growth at known values of the parameter, and where its sign changes.

    Where motions pass each other between two samples, only their rates of change over the parameter
    tell which is which.
    """

    made: _Made
    span: float
    known: dict[float, Growth] = field(default_factory=dict)
    rates: dict[float, tuple[np.ndarray, float]] = field(default_factory=dict)

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
                root = brentq(lambda value: self.at(value).excess, low, high, xtol=accuracy)
                found.append((float(root), self.unstable(high)))
        return found

    def rate(self, value: float, step: float) -> tuple[np.ndarray, float]:
        """Return the change of all exponents, and of the excess, per unit of the parameter."""
        if value not in self.rates:
            here, beside = self.at(value), self.made.growth(value + step)
            near = _nearest(beside.values, here.values, here.base)
            change = fold(near - here.values, here.base) / step
            self.rates[value] = change, (beside.excess - here.excess) / step
        return self.rates[value]

    def refine(self) -> None:
        """Look between the samples for ranges of the other verdict."""
        for low, high in pairwise(sorted(self.known)):
            if self.unstable(low) != self.unstable(high):
                continue
            piece = _Piece.between(self, low, high)
            if self.unstable(low):
                falls = self.rate(low, self._step)[1] < 0.0 < self.rate(high, -self._step)[1]
                if falls or piece.is_led_by_another():
                    self._search(low, high, lambda growth, _: growth.excess)
                continue
            for start, pair in piece.crossings():
                self._meet(start, pair, low, high)
            for branch in piece.peaks():
                self._search(low, high, piece.real_part(branch))

    @property
    def _step(self) -> float:
        return _STEP * self.span

    def _meet(self, value: float, pair: np.ndarray, low: float, high: float) -> None:
        """Follow two motions to where their frequencies meet, until something is unstable.

        By Newton's method on the difference, which does not ask which of the two is which.
        """
        for _ in range(_CROSSING_STEPS):
            growth = self.at(float(value))
            if growth.excess > 0.0:
                return
            columns = _nearest_columns(growth.values, pair, growth.base)
            rates, pair = self.rate(float(value), self._step)[0][columns], growth.values[columns]
            change = (rates[0] - rates[1]).imag
            move = -_apart(pair, growth.base) / change if change else np.inf
            if abs(move) < _ASIDE * self.span or not low < value + move < high:
                return
            pair, value = pair + move * rates, value + move

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
    def between(cls, search: _Search, low: float, high: float) -> _Piece:
        growths, step = [search.at(value) for value in (low, high)], _STEP * search.span
        rates = [search.rate(value, s)[0] for value, s in ((low, step), (high, -step))]
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
        limit = -_DAMPED * np.maximum(np.abs(self.ends[0]), 1e-3 * size)
        light = np.flatnonzero((self.ends[0].real > limit) & (self.ends[1].real > limit))
        for pair in combinations(light, 2):
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

    def is_led_by_another(self) -> bool:
        """Return whether the least stable motion at one end is not that at the other."""
        leader, values = int(np.argmax(self.ends[0].real)), self.ends[1].real
        return bool(values[leader] < values.max() - _NOISE * np.abs(self.ends).max())

    def peaks(self) -> np.ndarray:
        """Return motions whose real part may have a peak between."""
        rise, fall = self.rates.real * (self.high - self.low)
        noise = _NOISE * np.maximum(np.abs(self.ends[0]), np.abs(self.ends[1]))
        return np.flatnonzero((rise > noise) & (fall < -noise))

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
