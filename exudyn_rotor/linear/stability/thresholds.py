"""Limits of stability over the spin speed or any other parameter.

The margin is the largest growth of a motion that is not neutral, positive where the rotor is
unstable. It is computed at samples, and each change of its sign is found by Brent's method.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq, minimize_scalar

from exudyn_rotor import checks, plotting
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.linear.modal import basis_error
from exudyn_rotor.linear.modal.whirl import WHIRLS, Content, OfMotions
from exudyn_rotor.linear.model.assembly import NO_EQUATIONS
from exudyn_rotor.linear.model.build import Target, linear_model, warn_of_omissions
from exudyn_rotor.linear.model.linear_model import LinearModel, warn_of_refused
from exudyn_rotor.linear.over import NOT_KNOWN, basis_column, motions_in, table_lines
from exudyn_rotor.linear.solve.hill import Beside
from exudyn_rotor.linear.solve.motions import Motions
from exudyn_rotor.linear.stability.stability import (
    WHAT,
    check_options,
    least_stable,
    of_motions,
)
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.results import Result, numbers, storable
from exudyn_rotor.solvers.factor import one_thread
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SMALL = 0.1  # share of the range that a limit counts as at least
_SPEED = "speed [rad/s]"  # how the names of parameters end that are shown in other units
Supports = Sequence[Given] | Given
_ROOT = 1e-8  # of the largest parameter: where the search for a limit stops
_PEAKS, _STEPS = 6, 6  # peaks that are looked at, each with so many values
_ASIDE = 1e-4  # of the range, or half of an unstable one: where the growing motion is named


@storable
@dataclass(frozen=True, eq=False)
class StabilityThresholds(OfMotions, Result):
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
    basis_errors : ndarray, shape (t,), or None
        Estimated relative errors of the thresholds by the basis, of a threshold or, where that is
        more, of a tenth of the range: the growth at the limit with the shapes that the basis leaves
        out, over its slope. None where nothing is known.

    Examples
    --------
    >>> from exudyn_rotor import StabilityThresholds
    >>> result = StabilityThresholds([300.0], [True], [100.0], [0], [1], 0.0, 400.0, False)
    >>> print(result.table())
    speed [rpm]  above     inertial [Hz]  n  whirl    kind
        2864.79  unstable        15.9155  1  forward  lateral
    error of the basis: not known
    """

    values: np.ndarray = numbers("thresholds")
    onset: np.ndarray = numbers("thresholds", dtype=bool)
    frequencies_inertial: np.ndarray = numbers("thresholds")
    whirl_codes: np.ndarray = numbers("thresholds", dtype=int, least=0, most=len(WHIRLS) - 1)
    nodal_diameters: np.ndarray = numbers("thresholds", dtype=int, least=-1)
    low: float
    high: float
    unstable_at_low: bool
    label: str = _SPEED
    basis_errors: np.ndarray | None = numbers("thresholds", finite=False, optional=True)

    @property
    def ranges(self) -> np.ndarray:
        """Unstable ranges of the parameter, shape (r, 2); open ones end where the search did."""
        edges = [self.low] if self.unstable_at_low else []
        edges += self.values.tolist()
        edges += [self.high] if len(edges) % 2 else []
        return np.array(edges).reshape(-1, 2)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns; `units` are those of :meth:`table`."""
        shown = Units.of(units)
        label, factor = self._parameter(shown)
        frequencies = shown.frequencies(self.frequencies_inertial)
        return {
            label: factor * self.values,
            "above": np.where(self.onset, "unstable", "stable"),
            f"inertial [{shown.frequency}]": frequencies,
            "nodal diameters": self.nodal_diameters,
            "whirl": self.whirl,
            "kind": self.families,
            **basis_column(self.basis_errors, len(self.values)),
        }

    def table(self, *, units: str = "rpm") -> str:
        """Return the thresholds with the modes that grow there as lines of text.

        Parameters
        ----------
        units : {'rpm', 'Hz', 'SI'}
            Of frequencies, and of the parameter where it is called a speed in rad/s: 'rpm' has
            speeds in rpm and frequencies in Hz, 'SI' both in rad/s.
        """
        lines = table_lines(self.columns(units))
        if not self.values.size:
            state = "unstable" if self.unstable_at_low else "stable"
            lines.append(f"{state} in the whole range")
        return "\n".join(lines if self.basis_errors is not None else [*lines, NOT_KNOWN])

    def _parameter(self, shown: Units) -> tuple[str, float]:
        """Return the parameter's name as shown, and its unit there over that of the values."""
        if not self.label.endswith(_SPEED):
            return self.label, 1.0
        return f"{self.label.removesuffix(_SPEED)}speed [{shown.speed}]", shown.speeds(1.0)

    def plot(self, ax: Axes | None = None, *, units: str = "rpm") -> Axes:
        """Draw the frequencies of the modes at their thresholds; unstable ranges are shaded.

        `units` are those of :meth:`table`.
        """
        shown = Units.of(units)
        label, factor = self._parameter(shown)
        ax = plotting.axes_or_new(ax)
        for low, high in factor * self.ranges:
            ax.axvspan(low, high, color=plotting.COLORS[1], alpha=0.2, lw=0.0)
        frequencies = shown.frequencies(self.frequencies_inertial)
        ax.plot(factor * self.values, frequencies, "o", color=plotting.COLORS[0])
        ax.set_xlim(factor * self.low, factor * self.high)
        ax.set_xlabel(label)
        ax.set_ylabel(f"inertial frequency of the mode [{shown.frequency}]")
        ax.grid(alpha=0.3)
        return ax


@dataclass(eq=False)
class _Margin:
    """Growth of the least stable motion that is not neutral [1/s], over a parameter.

    Below zero where all are neutral, NaN where there are no coefficients; each value is computed
    once. Where the parameter is the speed, one `model` has all of them.
    """

    model_at: Callable[[float], tuple[LinearModel, float]]
    tolerance: float
    model: LinearModel | None = None
    known: dict[float, float] = field(default_factory=dict)
    beside: Beside | None = None

    def look_at(self, points: Sequence[float]) -> None:
        """Compute the margin at points; warn once where there are no coefficients."""
        self.known |= dict.fromkeys(points, np.nan)
        refused, together = [], [points] if self.model else [[point] for point in points]
        for group in together:
            try:
                found = self.motions(group)
            except NO_EQUATIONS as error:
                refused.append((f"{group[0]:.5g}", error))
            else:
                growth, bounds = found.values.real, found.bounds[:, None]
                moving = np.where(np.abs(growth) > bounds, growth, np.nan)
                margins = np.fmax.reduce(moving, axis=1)
                margins = np.where(np.isnan(margins), -found.bounds, margins)
                self.known |= dict(zip(group, margins.tolist(), strict=True))
        warn_of_refused(refused, len(together))

    def look_at_peaks(self) -> None:
        """Compute the margin near peaks below zero and gaps above, which may cross it."""
        known = sorted((p, margin) for p, margin in self.known.items() if not np.isnan(margin))
        near = []
        for (a, before), (_, margin), (b, after) in zip(known, known[1:], known[2:], strict=False):
            sign = 1.0 if margin > 0.0 else -1.0
            if 0.0 < sign * margin < max(sign * before, sign * after) and sign * margin <= min(
                sign * before, sign * after
            ):
                near.append((sign * margin, sign, (a, b)))
        for _, sign, ends in sorted(near)[:_PEAKS]:
            minimize_scalar(
                lambda point, sign=sign: sign * self(float(point)),
                bounds=ends,
                method="bounded",
                options={"maxiter": _STEPS},
            )

    def motions(self, points: Sequence[float], richer: bool = False) -> Motions:
        """Return the motions at points of one model, or of a richer one."""
        built = [self.model_at(point) for point in points]
        model, speeds = built[0][0], [speed for _, speed in built]
        model = model.richer if richer else model
        how = {"held": True, "warns": False, "beside": None if richer else self.beside}
        method = "hill" if richer else "auto"
        found = motions_in(model, model.at_all(speeds), method, self.tolerance, **how)
        self.beside = self.beside if richer else found.beside
        return found

    def least_stable(self, point: float, richer: bool = False) -> dict[str, np.ndarray]:
        """Return the least stable motion at a point, that of the richer model if asked for."""
        model = self.model_at(point)[0]
        model = model.richer if richer else model
        state = of_motions(model, Content.of(model), self.motions([point], richer), None)
        return least_stable(state)

    def __call__(self, point: float) -> float:
        """Return the margin at a point between two that have one; negative where it has none."""
        if point not in self.known:
            with suppress(*NO_EQUATIONS):
                self.look_at([point])
        margin = self.known[point]
        return -1.0 if np.isnan(margin) else margin


def stability_threshold(
    target: Target,
    low: float,
    high: float,
    *,
    supports: Supports | Callable[[float], Supports] = (),
    speed: float | None = None,
    samples: int = 60,
    label: str | None = None,
    body: RotorBody | Sequence[RotorBody] | None = None,
    stiffening: str = "auto",
    axes: str = "auto",
    tolerance: float = 1e-6,
    accuracy: float | None = 1e-2,
) -> StabilityThresholds:
    """Find the limits of stability over the spin speed or another parameter.

    Each is found to 1e-7 of the largest parameter, with the motion that grows there. The range is
    looked at in `samples` intervals, and closer where the growth has a peak near zero. A range that
    is narrower than an interval can be missed, as one of a parametric resonance with little
    damping: take more where that matters.

    Parameters
    ----------
    target : as in :func:`stability`
    low, high : float
        Range of the parameter; spin speeds [rad/s] unless `supports` is callable.
    supports : sequence of Support or bearings, or callable, optional
        Of a rotor; a callable takes the parameter and returns them.
    speed : float, optional
        Spin speed [rad/s], where it is not the parameter.
    samples : int, optional
        Number of intervals in which the range is sampled. The speeds of supports' tables, at which
        coefficients have kinks, are samples, too.
    label : str, optional
        Name of the parameter with its unit.
    body, stiffening, axes, tolerance
        See :func:`stability`.
    accuracy : float, optional
        Relative error of a limit by the basis of a reduced rotor, estimated, above which a warning
        is given: see :attr:`StabilityThresholds.basis_errors`. None for no estimate.

    Raises
    ------
    TypeError, ValueError
        For bad input, and a `speed` that is missing or given where it is the parameter. Values at
        which supports have no coefficients are left out with a warning.

    Examples
    --------
    >>> from exudyn_rotor import Support, rotor_example, stability_threshold
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> def damped(inner: float) -> list:
    ...     outer = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    ...     return outer + [Support(s.interface, damping=inner, frame="rotor") for s in outer]
    >>> limit = stability_threshold(rotor, 100.0, 400.0, supports=damped(5.0))
    >>> limit.values.round(3)  # √(k/m) (1 + c_outer/c_inner)
    array([300.])
    >>> given = {"supports": damped, "speed": 300.0, "samples": 4}
    >>> print(stability_threshold(rotor, 2.0, 20.0, label="inner damping", **given).table())
    inner damping  above     inertial [Hz]  n  whirl    kind
                5  unstable        15.9155  1  forward  lateral
    """
    low = checks.number(low, "low")
    high = checks.number(high, "high", above=low)
    samples = checks.count(samples, "samples", least=2)
    check_options(tolerance, accuracy)
    if label is None:
        label = "parameter" if callable(supports) else _SPEED
    checks.label(label, "label")
    made = {"body": body, "stiffening": stiffening, "axes": axes}
    if callable(supports):
        if speed is None:
            raise ValueError(
                "speed: needs the spin speed [rad/s], since supports, a function, says that it is "
                "not the parameter"
            )
        speed = checks.number(speed, "speed", "rad/s", least=0.0)

        def model_at(point: float) -> tuple[LinearModel, float]:
            return linear_model(target, supports=supports(point), **made), speed

        margin, kinks = _Margin(model_at, tolerance), np.zeros(0)
    else:
        checks.number(low, "low", "rad/s", least=0.0)
        if speed is not None:
            raise ValueError("speed: is the parameter, from low to high; leave it out")
        model = linear_model(target, supports=supports, **made)
        margin, kinks = _over_speed(model, high, tolerance), model.table_speeds
    points = np.linspace(low, high, samples + 1)
    points = np.union1d(points, kinks[(kinks > low) & (kinks < high)])
    return _found(margin, points.tolist(), label, accuracy)


def _over_speed(model: LinearModel, fastest: float, tolerance: float) -> _Margin:
    """Return the margin of a model over the speed; warn of what it leaves out."""
    warn_of_omissions(model, fastest, WHAT)
    return _Margin(lambda speed: (model, speed), tolerance, model)


@one_thread()
def _found(
    margin: _Margin, points: list[float], label: str, accuracy: float | None
) -> StabilityThresholds:
    """Return the limits between points."""
    margin.look_at(points)
    margin.look_at_peaks()
    points = [point for point in sorted(margin.known) if not np.isnan(margin.known[point])]
    low, high = points[0], points[-1]
    changes = [(a, b) for a, b in pairwise(points) if (margin(a) > 0.0) != (margin(b) > 0.0)]
    root = _ROOT * max(abs(low), abs(high))
    values = [brentq(margin, *change, xtol=root, rtol=1e-15) for change in changes]
    onset = [margin(above) > 0.0 for _, above in changes]
    ends, growing, shifts = [-np.inf, *values, np.inf], [], []
    for place, value in enumerate(values):
        # what grows within the unstable range beside the limit
        width = ends[place + 2 if onset[place] else place] - value
        aside = np.sign(width) * min(_ASIDE * (high - low), 0.5 * abs(width))
        growing.append(margin.least_stable(value + aside))
        slope = growing[-1]["least_stable_growth"][0] / aside
        model = margin.model_at(value)[0]
        if basis_error.is_known(model, accuracy):
            richer = None if model.is_full else margin.least_stable(value, richer=True)
            shifts.append(richer["least_stable_growth"][0] / slope if richer else 0.0)
    errors = None
    if accuracy is not None and len(shifts) == len(values):
        errors = np.abs(shifts) / np.maximum(np.abs(values), _SMALL * (high - low))
    basis_error.warn(
        errors, lambda i: f"the limit of stability at {values[i]:.5g}, {label},",
        margin.model_at(points[0])[0], accuracy,
    )  # fmt: skip
    names = ("frequencies_inertial", "whirl_codes", "nodal_diameters")
    named = ([motion[name][0] for motion in growing] for name in names)
    return StabilityThresholds(
        values, onset, *named, low, high, margin(low) > 0.0, label, basis_errors=errors
    )


def unstable_ranges(
    target: Target,
    speeds: ArrayLike,
    *,
    supports: Supports = (),
    body: RotorBody | Sequence[RotorBody] | None = None,
    stiffening: str = "auto",
    axes: str = "auto",
    tolerance: float = 1e-6,
    accuracy: float | None = 1e-2,
) -> np.ndarray:
    """Return the unstable speed ranges, shape (r, 2) [rad/s].

    The search is that of :func:`stability_threshold` between neighbouring `speeds`; limits have an
    error of 1e-7 of the highest speed, and a range narrower than the spacing can be missed. A range
    that is open at the first or last speed ends there. For the other arguments see
    :func:`stability_threshold`.

    Examples
    --------
    >>> from exudyn_rotor import Support, rotor_example, unstable_ranges
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> inner = [Support(name, damping=5.0, frame="rotor") for name in ("left", "right")]
    >>> unstable_ranges(rotor, [100.0, 250.0, 400.0], supports=supports + inner).round(3)
    array([[300., 400.]])
    """
    values = checks.ascending_from_zero(speeds, "speeds")
    check_options(tolerance, accuracy)
    model = linear_model(target, supports=supports, body=body, stiffening=stiffening, axes=axes)
    margin = _over_speed(model, values[-1], tolerance)
    return _found(margin, values.tolist(), _SPEED, accuracy).ranges
