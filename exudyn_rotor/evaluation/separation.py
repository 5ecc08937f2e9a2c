"""Amplification factors and separation margins of an unbalance response.

Source: API RP 684, 2nd ed. (2005), standard paragraphs SP6.8.2.1 (amplification factor) and
SP6.8.2.10 (separation margins); API 617 asks for the same.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks, plotting
from exudyn_rotor.calls import user_level
from exudyn_rotor.linear.response.response import (
    HALF_POWER,
    STILL,
    UnbalanceResponse,
    resolved_peak,
    warn_of_coarse_peaks,
)
from exudyn_rotor.results import Result, numbers, storable, text_table, words
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes


_CRITICALLY_DAMPED = 2.5  # amplification factor below which no margin is asked for
_ONE_LABEL = 0.01  # of the range of speeds: peaks so near each other have one label
_LARGEST = np.array([0.16, 0.26])  # margins that SP6.8.2.10 can ask for, below and above
_RIPPLE = 1e-3  # share of its size by which a peak stands above the valleys beside it


@storable
@dataclass(frozen=True, eq=False)
class SeparationMargins(Result):
    """Peaks of an unbalance response, how sharp they are, and how far from the operating speeds.

    Attributes
    ----------
    places : tuple of str, length p
        Where each peak was seen.
    peaks, sizes : ndarray, shape (p,)
        Critical speed N_c [rad/s] and major semi-axis of the orbit there [m].
    half_power : ndarray, shape (p, 2)
        Speeds N₁ and N₂ beside the peak where the size is 0.707 of it [rad/s], on the peak's own
        flanks: NaN where the response does not fall so far before the valley to the next peak, or
        before it ends. The table remarks these peaks.
    amplification : ndarray, shape (p,)
        ``AF = N_c / (N₂ − N₁)``; by one side alone, twice its distance, where the other is NaN;
        NaN where both are.
    required, actual : ndarray, shape (p,)
        Separation margins, as shares of the lowest operating speed for peaks below it, of the
        highest for peaks above. Within the operating speeds the actual margin is 0.
    operating_range : ndarray, shape (2,)
        Lowest and highest operating speed [rad/s].
    observed : tuple of str, length o
        Places of the curves.
    speeds : ndarray, shape (s,)
        Speeds of the curves [rad/s].
    curves : ndarray, shape (o, s)
        Major semi-axes [m]; NaN where there is no steady motion.

    Examples
    --------
    >>> from exudyn_rotor import SeparationMargins
    >>> result = SeparationMargins(
    ...     ("left",), [300.0], [1e-5], [[290.0, 310.0]], [15.0], [0.157], [0.25], [400.0, 500.0],
    ...     ("left",), [200.0, 300.0, 500.0], [[1e-6, 1e-5, 2e-6]])
    >>> print(result.table(units="SI"))
    operating range 400 to 500 rad/s
    place  peak [rad/s]  size [m]  N1 [rad/s]  N2 [rad/s]    AF  margin  required  accepted
    left            300     1e-05         290         310    15    0.25     0.157       yes
    """

    places: tuple[str, ...] = words("peaks")
    peaks: np.ndarray = numbers("peaks")
    sizes: np.ndarray = numbers("peaks", least=0.0)
    half_power: np.ndarray = numbers("peaks", 2, finite=False)
    amplification: np.ndarray = numbers("peaks", finite=False)
    required: np.ndarray = numbers("peaks", least=0.0)
    actual: np.ndarray = numbers("peaks", least=0.0)
    operating_range: np.ndarray = numbers(2, least=0.0)
    observed: tuple[str, ...] = words("observed")
    speeds: np.ndarray = numbers("speeds")
    curves: np.ndarray = numbers("observed", "speeds", finite=False, least=0.0)

    @property
    def within(self) -> np.ndarray:
        """Which peaks lie within the operating speeds, shape (p,)."""
        low, high = self.operating_range
        return (self.peaks >= low) & (self.peaks <= high)

    @property
    def accepted(self) -> np.ndarray:
        """Which peaks are critically damped, AF < 2.5, or far enough away, shape (p,)."""
        damped = self.amplification < _CRITICALLY_DAMPED
        apart = ~self.within & (self.actual >= self.required) & ~np.isnan(self.amplification)
        return damped | apart

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns, one row for each peak."""
        shown = Units.of(units)
        return {
            "place": np.array(self.places, dtype=str),
            f"peak [{shown.speed}]": shown.speeds(self.peaks),
            "size [m]": self.sizes,
            f"N1 [{shown.speed}]": shown.speeds(self.half_power[:, 0]),
            f"N2 [{shown.speed}]": shown.speeds(self.half_power[:, 1]),
            "AF": self.amplification,
            "margin": self.actual,
            "required": self.required,
            "accepted": self.accepted,
        }

    def table(self, *, units: str = "rpm") -> str:
        """Return the peaks as lines of text; `units` are 'rpm', 'Hz' or 'SI', rad/s."""
        shown = Units.of(units)
        low, high = shown.speeds(self.operating_range)
        lines = [f"operating range {low:.6g} to {high:.6g} {shown.speed}"]
        lines += text_table(self.columns(units)) if self.places else ["no peak"]
        if np.any(np.isnan(self.half_power)):
            lines.append(
                "-: no fall to 0.707 of the peak before the valley to the next peak or the end; "
                "the factor is by the other side"
            )
        return "\n".join(lines)

    def plot(self, ax: Axes | None = None, *, units: str = "rpm") -> Axes:
        """Draw the response with its peaks, the operating range and the margins asked for."""
        shown = Units.of(units)
        ax = plotting.axes_or_new(ax)
        for i, (place, curve) in enumerate(zip(self.observed, self.curves, strict=True)):
            style = {"color": plotting.COLORS[i % 5], "ls": plotting.LINES[i % 5], "lw": 1.4}
            style["marker"] = "." if len(self.speeds) == 1 else None
            ax.semilogy(shown.speeds(self.speeds), 1e6 * curve, label=place, **style)
        for size, sides in zip(self.sizes, self.half_power, strict=True):
            ax.plot(shown.speeds(sides), [1e6 * HALF_POWER * size] * 2, "k|-", lw=0.8, ms=6)
        low, high = self.operating_range
        below = self.required[self.peaks < low].max(initial=0.0)
        above = self.required[self.peaks > high].max(initial=0.0)
        low, high = shown.speeds(self.operating_range)
        grey = {"color": "0.75", "alpha": 0.5, "lw": 0.0}
        ax.axvspan(low, high, color=plotting.COLORS[2], alpha=0.15, lw=0.0, label="operating range")
        ax.axvspan((1.0 - below) * low, low, **grey, label="separation margin")
        ax.axvspan(high, (1.0 + above) * high, **grey)
        ax.set_xlabel(f"spin speed [{shown.speed}]")
        ax.set_ylabel("major semi-axis [µm]")
        ax.grid(alpha=0.3, which="both")
        plotting.legend_above(ax, 4)
        self._annotate(ax, shown)
        return ax

    def _annotate(self, ax: Axes, shown: Units) -> None:
        """Write amplification factors; of peaks at nearly one speed at the largest alone."""
        labels, labelled = [], []
        for i in np.argsort(self.sizes)[::-1]:
            near = np.abs(self.peaks[labelled] - self.peaks[i]) < _ONE_LABEL * np.ptp(self.speeds)
            if np.isnan(self.amplification[i]) or np.any(near):
                continue
            labelled.append(i)
            place = shown.speeds(self.peaks[i]), 1e6 * self.sizes[i]
            given = {"textcoords": "offset points", "xytext": (4, 3), "fontsize": 8}
            labels.append(ax.annotate(f"AF {self.amplification[i]:.1f}", place, **given))
        plotting.keep_apart(labels)


def separation_margins(
    response: UnbalanceResponse,
    operating_range: ArrayLike,
    *,
    places: Sequence[str] | str | None = None,
) -> SeparationMargins:
    """Evaluate the peaks of an unbalance response by API RP 684.

    ======================  =========================================  ===================
    peak                    margin that is required                    as a share of
    ======================  =========================================  ===================
    AF < 2.5                none
    below the operation     17 % (1 − 1/(AF − 1.5)), at most 16 %      the lowest speed
    above the operation     10 % + 17 % (1 − 1/(AF − 1.5)), ≤ 26 %     the highest speed
    within it               AF < 2.5
    ======================  =========================================  ===================

    Parameters
    ----------
    response : UnbalanceResponse
        Over speeds that reach beyond the operating range, with ``refine=True``.
    operating_range : two floats
        Lowest operating speed and maximum continuous speed [rad/s].
    places : sequence of str, optional
        Where to look, as at vibration probes; all places of the response by default.

    Raises
    ------
    TypeError, ValueError
        If an argument is of another kind, or a place is unknown or given twice.

    Warns
    -----
    UserWarning
        If the speeds are too far apart to show a peak, as of a resonance that nothing damps, or do
        not reach over the operating range and the largest margins beside it, where a peak counts.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import Support, Unbalance, rotor_example, separation_margins
    >>> from exudyn_rotor import unbalance_response
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> supports = [Support(name, 2e4, damping=20.0) for name in ("left", "right")]  # ζ = 0.05
    >>> response = unbalance_response(rotor, np.linspace(0, 200, 21), [Unbalance("left", 1e-4)],
    ...                               supports=supports, refine=True)
    >>> separation_margins(response, (130.0, 150.0), places="left").amplification.round(1)
    array([9.9])
    """
    # not above: this module takes a fifth of the time that importing the package takes
    from scipy.signal import find_peaks

    how = "unbalance_response makes one"
    checks.instance(response, "response", UnbalanceResponse, how)
    limits = checks.vector(operating_range, "operating_range", "rad/s", size=2)
    if not 0.0 <= limits[0] < limits[1]:
        raise ValueError(
            "operating_range: needs the lowest and the highest speed [rad/s], got "
            + checks.shown(operating_range)
        )
    names = response.places
    if places is not None:
        names = checks.different(checks.labels(places, "places", response.places), "places")
    speeds, peaks, coarse = response.speeds, [], []
    _warn_of_speeds_left_out(speeds, limits)
    curves = np.array([response.semi_axes(name)[0] for name in names]).reshape(-1, len(speeds))
    for name, curve in zip(names, curves, strict=True):
        known = np.isfinite(curve)
        speeds, curve = response.speeds[known], curve[known]
        rows, _ = find_peaks(curve, prominence=_RIPPLE * curve.max(initial=0.0))
        valleys = [first + int(np.argmin(curve[first:last])) for first, last in pairwise(rows)]
        ends = zip(rows, [0, *valleys], [*valleys, len(curve) - 1], strict=False)
        for row, start, end in ends:
            place, size, is_near = resolved_peak(speeds, curve, row)
            below, above = slice(start, row + 2), slice(row - 1, end + 1)
            sides = (
                _half_power(speeds[below][::-1], curve[below][::-1], size),
                _half_power(speeds[above], curve[above], size),
            )
            peaks.append((name, place, size, sides))
            coarse += [] if is_near else [(name, float(speeds[row]))]
    warn_of_coarse_peaks(coarse)
    peaks.sort(key=lambda peak: peak[1])
    at, half_power = np.array([peak[1] for peak in peaks]), [peak[3] for peak in peaks]
    factors = np.array([_amplification(peak[1], peak[3]) for peak in peaks])
    low, high = limits
    above = at > high
    actual = np.maximum(np.where(above, at / high - 1.0, 1.0 - at / max(low, 1e-300)), 0.0)
    return SeparationMargins(
        places=tuple(peak[0] for peak in peaks),
        peaks=at,
        sizes=np.array([peak[2] for peak in peaks]),
        half_power=np.reshape(half_power, (-1, 2)),
        amplification=factors,
        required=required_margin(factors, above),
        actual=actual,
        operating_range=limits,
        observed=tuple(names),
        speeds=response.speeds,
        curves=curves,
    )


def _warn_of_speeds_left_out(speeds: np.ndarray, limits: np.ndarray) -> None:
    low, high = limits * (1.0 + _LARGEST * [-1.0, 1.0])
    if speeds[0] > low or speeds[-1] < high:
        warnings.warn(
            f"separation margins: peaks from {low:.6g} to {high:.6g} rad/s count, and the response "
            f"is known from {speeds[0]:.6g} to {speeds[-1]:.6g} rad/s only; compute it at all "
            "these speeds",
            UserWarning,
            stacklevel=user_level(),
        )


def required_margin(amplification: ArrayLike, above: bool | np.ndarray) -> np.ndarray:
    """Return the separation margins of SP6.8.2.10, as shares; 0 for an unknown factor."""
    factors = np.asarray(amplification, dtype=float)
    sharp = factors >= _CRITICALLY_DAMPED
    with np.errstate(divide="ignore", invalid="ignore"):
        margin = 0.17 * (1.0 - 1.0 / (factors - 1.5))
    margin = np.where(
        above, np.minimum(0.10 + margin, _LARGEST[1]), np.minimum(margin, _LARGEST[0])
    )
    return np.where(sharp, margin, 0.0)


def _half_power(speeds: np.ndarray, curve: np.ndarray, size: float) -> float:
    """Return where a curve falls below 0.707 of a peak; NaN where it does not.

    The second point is the peak, from which speeds go away to one side. 1/size² is taken for a
    parabola, as it is near a resonance; beside rest the size for a line.
    """
    below = np.flatnonzero(curve[2:] < HALF_POWER * size) + 2
    if not below.size:
        return np.nan
    at, seen = (each[below[0] - 2 : below[0] + 1] for each in (speeds, curve))
    if seen.min() < STILL * size:  # at rest, without a load
        return float(np.interp(HALF_POWER * size, seen[:0:-1], at[:0:-1]))
    levels = (size / seen) ** 2
    roots = np.roots(np.polyfit(at - at[1], levels - 2.0, 2)).real + at[1]
    return float(min(roots, key=lambda x: abs(x - np.interp(2.0, levels[1:], at[1:]))))


def _amplification(peak: float, sides: tuple[float, float]) -> float:
    distances = np.abs(np.array(sides) - peak)
    known = distances[~np.isnan(distances)]
    return float(peak / (2.0 * known.mean())) if known.size else np.nan
