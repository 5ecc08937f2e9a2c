"""Limits of stability over one parameter: what a search for them returns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from exudyn_rotor import plotting
from exudyn_rotor.linear.modal.basis_error import NOT_KNOWN, in_table
from exudyn_rotor.linear.modal.whirl import WHIRLS, families
from exudyn_rotor.results import Result, numbers, storable
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SMALL = 0.1  # share of the range that a limit counts as at least
_SPEED = "speed [rad/s]"  # how the names of parameters end that are shown in other units


def limit_errors(shifts: np.ndarray, values: np.ndarray, span: float) -> np.ndarray:
    """Return relative errors of limits (t,) found in a range; NaN where they are not known."""
    return np.abs(shifts) / np.maximum(np.abs(values), _SMALL * span)


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
    basis_shifts : ndarray, shape (t,), or None
        Estimated ``p − p_reduced`` with the limit p of the full model, to first order: the growth
        that the motion gains by what the basis leaves out, over its slope. NaN where the motion is
        not found again, None where nothing is known.

    Examples
    --------
    >>> from exudyn_rotor import StabilityThresholds
    >>> result = StabilityThresholds([300.0], [True], [100.0], [0], [1], 0.0, 400.0, False)
    >>> print(result.table())
      speed [rpm]   above        frequency [Hz]  n  whirl      kind
         2864.789   unstable              15.915  1  forward    lateral
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
    basis_shifts: np.ndarray | None = numbers("thresholds", finite=False, optional=True)

    @property
    def ranges(self) -> np.ndarray:
        """Unstable ranges of the parameter, shape (r, 2); open ones end where the search did."""
        edges = [self.low] if self.unstable_at_low else []
        edges += self.values.tolist()
        edges += [self.high] if len(edges) % 2 else []
        return np.array(edges).reshape(-1, 2)

    @property
    def basis_errors(self) -> np.ndarray | None:
        """Estimated relative errors of the thresholds by the basis, shape (t,).

        Of a threshold or, where that is more, of a tenth of the range; None where not known.
        """
        if self.basis_shifts is None:
            return None
        return limit_errors(self.basis_shifts, self.values, self.high - self.low)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns; `units` are those of :meth:`table`."""
        shown = Units.of(units)
        label, factor = self._parameter(shown)
        frequencies = shown.frequencies(self.frequencies_inertial)
        errors = self.basis_errors
        return {
            label: factor * self.values,
            "onset": self.onset,
            f"inertial [{shown.frequency}]": frequencies,
            "nodal diameters": self.nodal_diameters,
            "whirl": np.array(WHIRLS)[self.whirl_codes],
            "kind": families(self.whirl_codes, self.nodal_diameters),
            "basis error": np.full(self.values.shape, np.nan) if errors is None else errors,
        }

    def table(self, *, units: str = "rpm") -> str:
        """Return the thresholds with the modes that grow there as lines of text.

        The error of the basis is '-' where it is not estimated, see :attr:`basis_shifts`.

        Parameters
        ----------
        units : {'rpm', 'Hz', 'SI'}
            Of frequencies, and of the parameter where it is called a speed in rad/s: 'rpm' has
            speeds in rpm and frequencies in Hz, 'SI' both in rad/s.
        """
        shown = Units.of(units)
        label, factor = self._parameter(shown)
        width, frequency = max(13, len(label)), f"frequency [{shown.frequency}]"
        lines = [f"{label:>{width}}   above   {frequency:>19}  n  whirl      kind"]
        errors = self.basis_errors
        reduced = errors is not None and np.any(errors != 0.0)
        if reduced:
            lines[0] += "       basis error"
        kinds = families(self.whirl_codes, self.nodal_diameters)
        for row, (value, onset) in enumerate(zip(factor * self.values, self.onset, strict=True)):
            n, word = self.nodal_diameters[row], WHIRLS[self.whirl_codes[row]]
            lines.append(
                f"{value:{width}.7g}   {'unstable' if onset else 'stable':8}"
                f"{shown.frequencies(self.frequencies_inertial[row]):19.5g}  {n if n >= 0 else '-'}"
                f"  {word:9}  {kinds[row]}"
            )
            if reduced:
                lines[-1] = f"{lines[-1].ljust(len(lines[0]) - 11)}{in_table(errors[row]):>11}"
        if not self.values.size:
            lines.append(self._without_limit)
        return "\n".join(lines if errors is not None else [*lines, NOT_KNOWN])

    def _parameter(self, shown: Units) -> tuple[str, float]:
        """Return the parameter's name as shown, and its unit there over that of the values."""
        if not self.label.endswith(_SPEED):
            return self.label, 1.0
        return f"{self.label.removesuffix(_SPEED)}speed [{shown.speed}]", shown.speeds(1.0)

    @property
    def _without_limit(self) -> str:
        return f"{'unstable' if self.unstable_at_low else 'stable'} in the whole range"

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
        if not len(self.values):
            ax.set_title(self._without_limit, fontsize="medium")
        return ax
