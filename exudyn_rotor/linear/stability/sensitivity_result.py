"""Sensitivity functions of magnetic bearings: what their analysis returns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from exudyn_rotor import checks, plotting
from exudyn_rotor.results import Result, numbers, storable, words
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ZONES = {"A": 3.0, "B": 4.0, "C": 5.0, "D": np.inf}  # largest |S|, ISO 14839-3:2006


@storable
@dataclass(frozen=True, eq=False)
class Sensitivity(Result):
    """Sensitivity functions, one for each control axis.

    Attributes
    ----------
    axes : tuple of str
        Interface and number of the control axis.
    frequencies : ndarray, shape (f,)
        [rad/s]
    values : ndarray of complex, shape (axes, f)
        S.
    speed : float
        Spin speed [rad/s].

    Examples
    --------
    >>> from exudyn_rotor import Sensitivity
    >>> result = Sensitivity(("left, 1",), [100.0, 200.0], [[1.0 + 0j, -3.5 + 0j]], speed=0.0)
    >>> result.zones
    ('B',)
    >>> print(result.table())
    axis      peak |S|  peak [dB]  at [Hz]  zone
    left, 1        3.5       10.9    31.83  B
    """

    axes: tuple[str, ...] = words("axes")
    frequencies: np.ndarray = numbers("frequencies")
    values: np.ndarray = numbers("axes", "frequencies", dtype=complex, finite=False)
    speed: float

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.ascending(self.frequencies, "frequencies", "rad/s")

    @property
    def peaks(self) -> np.ndarray:
        """Largest ``|S|`` of each axis, shape (axes,)."""
        return np.nanmax(np.abs(self.values), axis=1)

    @property
    def peak_frequencies(self) -> np.ndarray:
        """Where that is [rad/s], shape (axes,)."""
        return self.frequencies[np.nanargmax(np.abs(self.values), axis=1)]

    @property
    def zones(self) -> tuple[str, ...]:
        """Zone of each axis by ISO 14839-3: 'A', 'B', 'C' or 'D'."""
        return tuple(next(z for z, most in ZONES.items() if peak <= most) for peak in self.peaks)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns, one row for each axis; see :meth:`Result.columns`."""
        shown = Units.of(units)
        return {
            "axis": np.array(self.axes),
            "peak |S|": self.peaks,
            "peak [dB]": 20.0 * np.log10(self.peaks),
            f"at [{shown.frequency}]": shown.frequencies(self.peak_frequencies),
            "zone": np.array(self.zones),
        }

    def table(self, *, units: str = "rpm") -> str:
        """Return peaks and zones as text; `units` are 'rpm', 'Hz' or 'SI'."""
        columns = self.columns(units)
        names, rows = list(columns), list(zip(*columns.values(), strict=True))
        width = max(map(len, (*self.axes, "axis"))) + 2
        at = len(names[3]) + 2
        lines = [f"{names[0]:<{width}}{names[1]:>8}{names[2]:>11}{names[3]:>{at}}  {names[4]}"]
        for name, peak, decibel, where, zone in rows:
            lines.append(f"{name:<{width}}{peak:>8.4g}{decibel:>11.1f}{where:>{at}.4g}  {zone}")
        return "\n".join(lines)

    def plot(self, ax: Axes | None = None, *, units: str = "rpm") -> Axes:
        """Draw ``|S|`` of each axis over the frequency, with the limits of the zones."""
        shown = Units.of(units)
        ax = plotting.axes_or_new(ax)
        places = shown.frequencies(self.frequencies)
        for name, S in zip(self.axes, self.values, strict=True):
            ax.semilogx(places, 20.0 * np.log10(np.abs(S)), lw=1.3, label=name)
        for zone, most in ZONES.items():
            if np.isfinite(most):
                limit = 20.0 * np.log10(most)
                ax.axhline(limit, color="0.5", lw=0.8, ls="--")
                ax.annotate(zone, (places[0], limit), va="top", color="0.4")
        ax.set_xlabel(f"frequency [{shown.frequency}]")
        ax.set_ylabel("sensitivity |S| [dB]")
        ax.grid(alpha=0.3)
        plotting.legend_above(ax, 4)
        return ax
