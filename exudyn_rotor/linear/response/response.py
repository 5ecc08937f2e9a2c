"""What responses have in common: harmonics of a steady motion at places of the rotor."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.linear.over import NOT_KNOWN, in_table
from exudyn_rotor.linear.response import bode
from exudyn_rotor.linear.response.refinement import resolved_peak, warn_of_coarse_peaks
from exudyn_rotor.linear.response.run_start import RunStart
from exudyn_rotor.plotting import axes_or_new, figure
from exudyn_rotor.results import numbers, words
from exudyn_rotor.theory.rotating_axes import FRAMES
from exudyn_rotor.theory.stiffening import LEVELS
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DIRECTIONS = ("n1", "n2", "e", "tilt n1", "tilt n2", "twist")
CIRCULAR = ("forward", "backward")
_STILL = 1e-12  # share of the largest frequency that is none
_DRAWN = (*DIRECTIONS, *CIRCULAR)


@dataclass(frozen=True, eq=False)
class Response(RunStart, ABC):
    """Steady motion ``u(t) = Re Σ_n a_n exp(i rate_n t)`` at places of the rotor.

    Attributes
    ----------
    places : tuple of str
        Interfaces and nodes (p), 'node 12'.
    orders : ndarray of int, shape (h,)
        The harmonics n that matter.
    motion : ndarray of complex, shape (s, p, h, 6)
        Amplitudes a_n of the displacement along (n1, n2, e) [m] and the rotation about them [rad]:
        peak values, half of peak to peak. Rotations of a node are NaN, and all where there is no
        steady motion. No two harmonics have one frequency: their sum is one of them. Of a harmonic
        whose rate is zero the real part moves, which all methods give.
    frame : {'inertial', 'rotor'}
        Whether (n1, n2, e) of :attr:`SpinAxis.plane` stand still or turn with the rotor.
    basis_errors : ndarray, shape (s, p), or None
        Estimated relative errors by the basis of a reduced rotor, of the displacement in the
        harmonic that is largest across the axis; a motion counts as at least a tenth of the largest
        at that speed or frequency. They are estimated at all peaks and at the first, middle and
        last point, which the table names; NaN elsewhere. None where they are not known.
    stiffening : str or None
        Level of centrifugal stiffening, 'none', 'tilt' or 'full'; None where it is not known.
    refined : bool
        Whether points were added around resonances.
    """

    places: tuple[str, ...] = words("places")
    orders: np.ndarray = numbers("orders", dtype=int)
    motion: np.ndarray = numbers("abscissa", "places", "orders", 6, dtype=complex, finite=False)
    frame: str
    basis_errors: np.ndarray | None = numbers("abscissa", "places", finite=False, optional=True)
    stiffening: str | None = field(default=None, kw_only=True)
    refined: bool = field(default=False, kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.choice(self.frame, "frame", FRAMES)
        if self.stiffening is not None:
            checks.choice(self.stiffening, "stiffening", LEVELS)

    @property
    @abstractmethod
    def abscissa(self) -> np.ndarray:
        """What the response was computed over, shape (s,) [rad/s]."""

    @abstractmethod
    def rates(self, order: int) -> np.ndarray:
        """Return the angular frequencies of a harmonic, shape (s,) [rad/s]."""

    @property
    def main_order(self) -> int:
        """The harmonic with the largest displacement across the axis, or along it if none is."""
        sizes = np.abs(np.nan_to_num(self.motion)).max(axis=(0, 1))
        across = sizes[:, :2] if np.any(sizes[:, :2]) else sizes[:, :3]
        return int(self.orders[across.max(axis=1).argmax()])

    def phasor(
        self, place: str | None = None, direction: str = "n1", order: int | None = None
    ) -> np.ndarray:
        """Return complex amplitudes, shape (s,): the peak value and, as ``np.angle``, the phase.

        Parameters
        ----------
        place : str, optional
            The first one by default.
        direction : {'n1', 'n2', 'e', 'tilt n1', 'tilt n2', 'twist'}
        order : int, optional
            :attr:`main_order` by default.

        Raises
        ------
        ValueError
            For an unknown place or direction, or a harmonic that does not matter.
        """
        checks.choice(direction, "direction", DIRECTIONS)
        return self._harmonic(place, order)[:, DIRECTIONS.index(direction)]

    def whirl(
        self, place: str | None = None, order: int | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the circular components (forward, backward), each (s,) complex [m].

        ``u_n1 + i u_n2 = forward exp(i|rate|t) + backward exp(−i|rate|t)``; forward is from n1 to
        n2, the sense of a positive spin.
        """
        order = self._order(order)
        motion = self._harmonic(place, order)
        turned = (self.rates(order) < 0.0)[:, None]
        a, b = np.where(turned, motion.conj(), motion)[:, :2].T
        return 0.5 * (a + 1j * b), 0.5 * (a - 1j * b).conj()

    def semi_axes(
        self, place: str | None = None, order: int | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the semi-axes of the orbit across e, each (s,) [m]: half of peak to peak.

        The minor one is negative where the rotor whirls backward.
        """
        forward, backward = bode.sizes(self.whirl(place, order), bode.least(self.motion))
        return forward + backward, forward - backward

    def peak(self, place: str | None = None, order: int | None = None) -> tuple[float, float]:
        """Return the highest resonance: where the major semi-axis is largest [rad/s], its size [m].

        Between three points by a parabola of 1/size². A warning tells where they are too far
        apart to show a resonance; ``refine=True`` of the analysis adds points there.

        Raises
        ------
        ValueError
            If the motion has no maximum between the first and the last point.
        """
        major, _ = self.semi_axes(place, order)
        inner = np.flatnonzero((major[1:-1] > major[:-2]) & (major[1:-1] >= major[2:])) + 1
        if inner.size == 0:
            more = "" if self.refined else ", or compute with refine=True"
            raise ValueError(
                f"{self._place(place)}: the motion has no peak between {self.abscissa[0]:g} and "
                f"{self.abscissa[-1]:g} rad/s; extend the range{more}"
            )
        index = int(inner[major[inner].argmax()])
        at, size, is_near = resolved_peak(self.abscissa, major, index)
        if not is_near:
            coarse = [(self._place(place), float(self.abscissa[index]))]
            warn_of_coarse_peaks(coarse, self.refined)
        return at, size

    def orbit(
        self, value: float, place: str | None = None, order: int | None = None, points: int = 181
    ) -> np.ndarray:
        """Return one revolution of a harmonic across e, shape (points, 2) [m].

        Parameters
        ----------
        value : float
            Speed or frequency [rad/s]; the nearest computed one is taken.
        place, order
            See :meth:`phasor`.
        points : int, optional
        """
        value = checks.number(value, "value", "rad/s")
        points = checks.count(points, "points", least=2)
        index = int(np.argmin(np.abs(self.abscissa - value)))
        order = self._order(order)
        motion = self._harmonic(place, order)[index, :2]
        sense = -1.0 if self.rates(order)[index] < 0.0 else 1.0
        angle = sense * np.linspace(0.0, 2.0 * np.pi, points)
        return (motion * np.exp(1j * angle)[:, None]).real

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return sizes and phases as columns: one row for each point, place and harmonic.

        `units` are those of :meth:`table`.
        """
        shown = self._shown(units)
        cases = [(place, int(order)) for place in self.places for order in self.orders]
        parts = [self._columns(place, order, *shown) for place, order in cases]
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    def _columns(
        self, place: str, order: int, values: np.ndarray, unit: str
    ) -> dict[str, np.ndarray]:
        """Return the columns of one place and harmonic."""
        count, least = len(values), bode.least(self.motion)
        columns = {
            f"{self._what} [{unit}]": values,
            "place": np.full(count, place),
            "order": np.full(count, order),
        }
        for name in ("n1", "n2", "e"):
            phasor = self.phasor(place, name, order)
            columns |= {
                f"{name} [m]": np.abs(phasor),
                f"{name} phase [deg]": bode.degrees(phasor, least),
            }
        forward, backward = np.abs(self.whirl(place, order))
        errors = np.full(count, np.nan)
        if self.basis_errors is not None:
            errors = self.basis_errors[:, self.places.index(place)]
        ends = {"forward [m]": forward, "backward [m]": backward, "basis error": errors}
        return columns | ends

    def _shown(self, units: str) -> tuple[np.ndarray, str]:
        """Return what the response was computed over in its unit, and that unit."""
        return Units.of(units).speeds(self.abscissa), Units.of(units).speed

    def table(
        self, place: str | None = None, order: int | None = None, *, units: str = "rpm"
    ) -> str:
        """Return sizes and phases at one place as text; '-' for an error that is not estimated.

        Parameters
        ----------
        place, order
            See :meth:`phasor`.
        units : {'rpm', 'Hz', 'SI'}
            'rpm' is for spin speeds, frequencies are in Hz then; 'SI' is rad/s.
        """
        place, order = self._place(place), self._order(order)
        values, unit = self._shown(units)
        a, b = (self.phasor(place, name, order) for name in ("n1", "n2"))
        phases = (bode.degrees(phasor, bode.least(self.motion)) for phasor in (a, b))
        forward, backward = self.whirl(place, order)
        errors = self.basis_errors
        reduced = errors is not None and np.any(errors > 0.0)
        labels = ("  basis", "  error") if reduced else ("", "")
        lines = [
            f"{place}, order {order}, {self.frame} frame",
            f"{self._what:>16}  {'n1':>11} {'phase':>7}  {'n2':>11} {'phase':>7}  "
            f"{'forward':>11} {'backward':>11}{labels[0]}",
            f"{'[' + unit + ']':>16}  {'[m]':>11} {'[deg]':>7}  {'[m]':>11} {'[deg]':>7}  "
            f"{'[m]':>11} {'[m]':>11}{labels[1]}",
        ]
        column = np.zeros(len(values)) if errors is None else errors[:, self.places.index(place)]
        for row in zip(values, a, b, *phases, forward, backward, column, strict=True):
            at, x, y, p, q, f, g, error = row
            shown = f"  {in_table(error, 0):>5}" if reduced else ""
            lines.append(
                f"{at:16.6g}  {abs(x):11.4e} {p:7.1f}  {abs(y):11.4e} {q:7.1f}"
                f"  {abs(f):11.4e} {abs(g):11.4e}{shown}"
            )
        if self.stiffening:
            lines.append(f"stiffening: {self.stiffening}")
        if reduced and np.any(np.isnan(column)):
            looked = ", ".join(f"{at:.5g}" for at in values[np.isfinite(column)])
            lines.append(f"basis error estimated at [{unit}]: {looked}")
        return "\n".join(lines if errors is not None else [*lines, NOT_KNOWN])

    def plot(
        self,
        place: str | None = None,
        *,
        directions: Sequence[str] = ("n1", "n2"),
        order: int | None = None,
        ax: Sequence[Axes] | None = None,
        log: bool = True,
        units: str = "rpm",
    ) -> np.ndarray:
        """Draw size and phase of the displacement over speed or frequency (Bode diagram).

        Parameters
        ----------
        place : str, optional
            The first one by default.
        directions : sequence of {'n1', 'n2', 'e', 'forward', 'backward'}
        order : int, optional
            Harmonic; the main one by default.
        ax : two matplotlib Axes, optional
            For size and phase; a new figure by default.
        log : bool, optional
            Logarithmic sizes.
        units : {'rpm', 'Hz', 'SI'}
            See :meth:`table`.

        Returns
        -------
        ndarray of matplotlib.axes.Axes, shape (2,)
            Size and phase, as ``plt.subplots(2)`` returns them.
        """
        names = checks.labels(directions, "directions", _DRAWN)
        checks.flag(log, "log")
        values, unit = self._shown(units)
        place, order = self._place(place), self._order(order)
        if ax is None:
            ax = figure(2, 1, size=(7.0, 5.5), sharex=True)[1]
        from matplotlib.axes import Axes

        pair = checks.instances(ax, "ax", Axes)
        if len(pair) != 2:
            raise ValueError(f"ax: needs two Axes, for size and phase, got {len(pair)}")
        curves = {name: self._drawn(name, place, order) for name in names}
        bode.draw_bode(*pair, values, curves, log)
        pair[0].set_title(self._title(place, order), loc="right", fontsize=10)
        pair[1].set_xlabel(f"{self._what} [{unit}]")
        return np.array(pair)

    def plot_polar(
        self,
        place: str | None = None,
        *,
        direction: str = "n1",
        order: int | None = None,
        ax: Axes | None = None,
        marks: int = 5,
        units: str = "rpm",
    ) -> Axes:
        """Draw the complex amplitude [µm] as a curve in its plane (Nyquist diagram).

        A damped resonance is a loop; its place across from the start is the critical speed.

        Parameters
        ----------
        place, order, units
            See :meth:`plot`.
        direction : {'n1', 'n2', 'e', 'forward', 'backward'}
        ax : matplotlib.axes.Axes, optional
            A new figure by default.
        marks : int, optional
            How many points are labelled with their speed or frequency.
        """
        checks.choice(direction, "direction", _DRAWN)
        marks, shown = checks.count(marks, "marks"), self._shown(units)
        place, order = self._place(place), self._order(order)
        ax = axes_or_new(ax, (5.5, 5.5))
        bode.draw_polar(ax, *shown, self._drawn(direction, place, order), marks)
        ax.set_xlabel(f"in phase, {direction} [µm]")
        ax.set_title(self._title(place, order), loc="right", fontsize=10)
        return ax

    def plot_orbit(
        self,
        value: float,
        *,
        places: Sequence[str] | None = None,
        order: int | None = None,
        ax: Axes | None = None,
        units: str = "rpm",
    ) -> Axes:
        """Draw one revolution of the orbits [µm] at a speed or frequency [rad/s].

        A dot marks t = 0 and an arrow the sense of the motion.

        Parameters
        ----------
        value : float
            The nearest computed speed or frequency is taken.
        places : sequence of str, optional
            All by default.
        order : int, optional
            Harmonic; the main one by default.
        ax : matplotlib.axes.Axes, optional
            A new figure by default.
        units : {'rpm', 'Hz', 'SI'}
            Of the title.
        """
        value, (shown, unit) = checks.number(value, "value", "rad/s"), self._shown(units)
        names = self.places
        if places is not None:
            names = checks.labels(places, "places", self.places)
        order = self._order(order)
        ax = axes_or_new(ax, (5.5, 5.5))
        bode.draw_orbits(ax, {name: self.orbit(value, name, order) for name in names})
        nearest = shown[np.argmin(np.abs(self.abscissa - value))]
        ax.set_title(f"{self._what} {nearest:.4g} {unit}", loc="right", fontsize=10)
        return ax

    def _drawn(self, name: str, place: str, order: int) -> np.ndarray:
        """Return the amplitudes along a direction, or of a circular component, shape (s,)."""
        if name in CIRCULAR:
            return self.whirl(place, order)[CIRCULAR.index(name)]
        return self.phasor(place, name, order)

    def _title(self, place: str, order: int) -> str:
        return f"{place}, order {order}, {self.frame} frame"

    @property
    @abstractmethod
    def _what(self) -> str:
        """What the response was computed over, as a picture names it."""

    def _harmonic(self, place: str | None, order: int | None) -> np.ndarray:
        """Return the amplitudes (s, 6) of one harmonic at one place."""
        order = self._order(order)
        motion = self.motion[
            :, self.places.index(self._place(place)), list(self.orders).index(order)
        ]
        rates = np.abs(self.rates(order))
        constant = rates <= _STILL * np.abs(self.abscissa).max()
        return np.where(constant[:, None], motion.real, motion)

    def _place(self, place: str | None) -> str:
        """Return the name of a place, the first one by default."""
        return self.places[0] if place is None else checks.choice(place, "place", self.places)

    def _order(self, order: int | None) -> int:
        """Return a harmonic that matters, the main one by default."""
        if order is None:
            return self.main_order
        order = checks.whole_number(order, "order")
        if order not in self.orders:
            known = ", ".join(str(n) for n in self.orders)
            raise ValueError(f"order: there is no harmonic {order}; there are {known}")
        return order
