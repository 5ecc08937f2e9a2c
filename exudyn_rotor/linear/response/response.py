"""Results of responses: motions of places of the rotor, and steady ones in harmonics."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import cycle
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.calls import user_level
from exudyn_rotor.linear.over import ModelResult, basis_column, table_lines
from exudyn_rotor.plotting import COLORS, LINES, axes_or_new, figure, legend_above, plot_orbits
from exudyn_rotor.results import Result, numbers, storable, words
from exudyn_rotor.theory.rotating_axes import FRAMES
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DIRECTIONS = ("n1", "n2", "e", "tilt n1", "tilt n2", "twist")
CIRCULAR = ("forward", "backward")
_IN_TABLES = (*DIRECTIONS[:3], "twist")
_TOGETHER = (*DIRECTIONS[:2], *CIRCULAR), ("e",), DIRECTIONS[3:5], ("twist",)  # of one harmonic
HALF_POWER = np.sqrt(0.5)  # of the size at a peak
STILL = 1e-6  # share of a peak below which a neighbour stands still, as at rest without a load
_CONSTANT = 1e-12  # share of the largest frequency that is none
_NO_MOTION = 1e-12  # of the largest amplitude
_LABELLED = 6  # points of a curve in its plane


@dataclass(frozen=True, eq=False)
class AtPlaces(Result):
    """What is seen at places: interfaces and nodes, 'node 12'.

    Attributes
    ----------
    places : tuple of str
    """

    places: tuple[str, ...] = words("places")

    def _at(self, place: str | None, name: str = "place") -> int:
        """Return the number of a place, of the first one by default."""
        return 0 if place is None else self.places.index(checks.choice(place, name, self.places))


@dataclass(frozen=True, eq=False)
class Response(AtPlaces, ModelResult):
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
        largest harmonic, under unbalance the largest across the axis; a motion counts as at least
        a tenth of the largest at that speed or frequency. They are estimated at all peaks and at
        the first, middle and last point, which the table names; NaN elsewhere. None where they are
        not known.
    radius : float
        The rotor's radius of gyration, at which a rotation counts as a displacement [m].
    stiffening, axes, unevenness
        See :class:`Stability`.
    """

    orders: np.ndarray = numbers("orders", dtype=int)
    motion: np.ndarray = numbers("abscissa", "places", "orders", 6, dtype=complex, finite=False)
    frame: str = checks.one_of(FRAMES)
    basis_errors: np.ndarray | None = numbers("abscissa", "places", finite=False, optional=True)
    radius: float = field(default=1.0, kw_only=True)

    _over: ClassVar[str] = "speeds"
    _what: ClassVar[str] = "spin speed"

    @property
    def abscissa(self) -> np.ndarray:
        """What the response was computed over, shape (s,) [rad/s]."""
        return getattr(self, self._over)

    @property
    def _rounding(self) -> np.ndarray:
        """Amplitudes up to which a displacement is rounding, (s,) [m]."""
        return _NO_MOTION * np.abs(self.motion[..., :3]).max(axis=(1, 2, 3), initial=0.0)

    @property
    def main_order(self) -> int:
        """The main harmonic: under unbalance the one with the largest displacement across the axis.

        Under harmonic loads that with the largest motion, of rotations at the :attr:`radius`.
        """
        return self._main(DIRECTIONS)

    @property
    def _sizes(self) -> np.ndarray:
        """Largest motion in each harmonic and direction, (h, 6) [m], rotations at the radius."""
        sizes = np.abs(np.nan_to_num(self.motion)).max(axis=(0, 1))
        return sizes * np.repeat([1.0, self.radius], 3)

    def _largest(self, directions: Sequence[str]) -> int:
        """Return the harmonic with the largest motion in directions."""
        columns = [DIRECTIONS.index(name) for name in directions]
        return int(self.orders[self._sizes[:, columns].max(axis=1).argmax()])

    def _main(self, directions: Sequence[str]) -> int:
        """Return the harmonic that is shown of directions: an unbalance acts across the axis."""
        return self._largest(DIRECTIONS[: 2 if np.any(self._sizes[:, :2]) else 3])

    def phasor(
        self, place: str | None = None, direction: str = "n1", order: int | None = None
    ) -> np.ndarray:
        """Return complex amplitudes, shape (s,): the peak value and, as ``np.angle``, the phase.

        Parameters
        ----------
        place : str, optional
            The first one by default.
        direction : {'n1', 'n2', 'e', 'tilt n1', 'tilt n2', 'twist', 'forward', 'backward'}
            The last two are the circular components of :meth:`whirl`.
        order : int, optional
            By default :attr:`main_order` under unbalance, and under harmonic loads the harmonic
            that is largest in the direction: across the axis, along it, of tilts, or of the twist.

        Raises
        ------
        ValueError
            For an unknown place or direction, or a harmonic that does not matter.
        """
        order = self._order(order, (direction,))
        if direction in CIRCULAR:
            return self.whirl(place, order)[CIRCULAR.index(direction)]
        return self._harmonic(place, order)[:, DIRECTIONS.index(direction)]

    def whirl(
        self, place: str | None = None, order: int | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the circular components (forward, backward), each (s,) complex [m].

        ``u_n1 + i u_n2 = forward exp(i|rate|t) + backward exp(−i|rate|t)``; forward is from n1 to
        n2, the sense of a positive spin.
        """
        order = self._order(order, CIRCULAR)
        motion, backward = self._harmonic(place, order), self.rates(order) < 0.0
        a, b = np.where(backward[:, None], motion.conj(), motion)[:, :2].T
        return 0.5 * (a + 1j * b), 0.5 * (a - 1j * b).conj()

    def semi_axes(
        self, place: str | None = None, order: int | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the semi-axes of the orbit across e, each (s,) [m]: half of peak to peak.

        The minor one is negative where the rotor whirls backward.
        """
        sizes = np.abs(self.whirl(place, order))
        forward, backward = np.where(sizes <= self._rounding, 0.0, sizes)
        return forward + backward, forward - backward

    def peak(self, place: str | None = None, order: int | None = None) -> tuple[float, float]:
        """Return the highest resonance: where the major semi-axis is largest [rad/s], its size [m].

        Between three points by a parabola of 1/size². A warning tells where they are too far
        apart to show a resonance, as of one that nothing damps; ``refine=True`` of the analysis
        adds points there.

        Raises
        ------
        ValueError
            If the motion has no maximum between the first and the last point.
        """
        major, _ = self.semi_axes(place, order)
        name, known = self.places[self._at(place)], np.isfinite(major)
        values, major = self.abscissa[known], major[known]
        inner = np.flatnonzero((major[1:-1] > major[:-2]) & (major[1:-1] >= major[2:])) + 1
        if inner.size == 0:
            raise ValueError(
                f"{name}: the motion has no peak between {values[0]:g} and {values[-1]:g} rad/s; "
                "extend the range, or compute with refine=True"
            )
        index = int(inner[major[inner].argmax()])
        at, size, is_near = resolved_peak(values, major, index)
        if not is_near:
            warn_of_coarse_peaks([(name, float(values[index]))])
        return at, size

    def orbit(self, value: float, place: str | None = None, order: int | None = None) -> np.ndarray:
        """Return one revolution of a harmonic across e, a point for each degree, (361, 2) [m].

        Parameters
        ----------
        value : float
            Speed or frequency [rad/s]; the nearest computed one is taken.
        place, order
            See :meth:`phasor`.
        """
        index, order = self._nearest(value), self._order(order, CIRCULAR)
        motion = self._harmonic(place, order)[index, :2]
        sense = -1.0 if self.rates(order)[index] < 0.0 else 1.0
        turn = np.exp(1j * sense * np.radians(np.arange(361)))
        return (motion * turn[:, None]).real

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return sizes and phases as columns: one row for each point, place and harmonic.

        `units` are those of :meth:`table`.
        """
        cases = [(place, int(order)) for place in self.places for order in self.orders]
        parts = [self._columns(place, order, units) for place, order in cases]
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    def _columns(self, place: str, order: int, units: str) -> dict[str, np.ndarray]:
        """Return the columns of one place and harmonic."""
        (values, unit), columns = self._shown(units), {}
        columns[f"{self._what} [{unit}]"] = values
        columns |= {"place": np.full(len(values), place), "order": np.full(len(values), order)}
        for name, quantity in zip(_IN_TABLES, ("m", "m", "m", "rad"), strict=True):
            phasor = self.phasor(place, name, order)
            phases = np.where(np.abs(phasor) <= self._rounding, 0.0, np.degrees(np.angle(phasor)))
            columns |= {f"{name} [{quantity}]": np.abs(phasor), f"{name} phase [deg]": phases}
        columns |= {f"{name} [m]": np.abs(self.phasor(place, name, order)) for name in CIRCULAR}
        errors = self.basis_errors
        errors = None if errors is None else errors[:, self._at(place)]
        return columns | basis_column(errors, len(values))

    def _shown(self, units: str) -> tuple[np.ndarray, str]:
        """Return what the response was computed over in its unit, and that unit."""
        return Units.of(units).speeds(self.abscissa), Units.of(units).speed

    def table(
        self, place: str | None = None, order: int | None = None, *, units: str = "rpm"
    ) -> str:
        """Return sizes and phases at one place as text; '-' for an error that is not estimated.

        Where motion along the axis or twist is larger than motion across it, it stands in place of
        circular components.

        Parameters
        ----------
        place
            See :meth:`phasor`.
        order : int, optional
            :attr:`main_order` by default.
        units : {'rpm', 'Hz', 'SI'}
            'rpm' is for spin speeds, frequencies are in Hz then; 'SI' is rad/s.
        """
        place, order = self._named(place), self._order(order, DIRECTIONS)
        n1, n2, along, *_, twist = self._sizes[list(self.orders).index(order)]
        sizes = {CIRCULAR: max(n1, n2), ("e",): along, ("twist",): twist}
        told, columns = max(sizes, key=sizes.get), self._columns(place, order, units)
        names = [name for group in sizes if group != told for name in group]
        left_out = [name for name in columns if name.split()[0] in names]
        lines = [self._title(place, order)]
        lines += table_lines(columns, "place", "order", *left_out)
        return "\n".join([*lines, *self._closing(self.basis_errors)])

    def plot(
        self,
        place: str | None = None,
        *,
        directions: Sequence[str] = ("n1", "n2"),
        order: int | None = None,
        ax: Sequence[Axes] | None = None,
        units: str = "rpm",
    ) -> np.ndarray:
        """Draw size and phase of the displacement over speed or frequency (Bode diagram).

        Parameters
        ----------
        place : str, optional
            The first one by default.
        directions : sequence of str
            See :meth:`phasor`.
        order : int, optional
            Harmonic; see :meth:`phasor`.
        ax : two matplotlib Axes, optional
            For size and phase; a new figure by default.
        units : {'rpm', 'Hz', 'SI'}
            See :meth:`table`.

        Returns
        -------
        ndarray of matplotlib.axes.Axes, shape (2,)
            Size and phase, as ``plt.subplots(2)`` returns them.
        """
        from matplotlib.axes import Axes
        from matplotlib.ticker import MultipleLocator

        names = checks.labels(directions, "directions", (*DIRECTIONS, *CIRCULAR))
        (values, unit), place = self._shown(units), self._named(place)
        order = self._order(order, names)
        if ax is None:
            ax = figure(2, 1, size=(7.0, 5.5), sharex=True)[1]
        pair = checks.instances(ax, "ax", Axes)
        if len(pair) != 2:
            raise ValueError(f"ax: needs two Axes, for size and phase, got {len(pair)}")
        size, phase = pair
        style = {"lw": 1.4, "marker": "." if len(values) == 1 else None}  # one point is no line
        curves = [self.phasor(place, name, order) for name in names]
        for name, curve, color, line in zip(names, curves, cycle(COLORS), cycle(LINES)):
            size.plot(values, 1e6 * np.abs(curve), label=name, color=color, ls=line, **style)
            phase.plot(values, _phase(curve), color=color, ls=line, **style)
        if np.any(np.nan_to_num(curves)):  # nothing is nowhere on a log scale
            size.set_yscale("log")
        size.set_ylabel(f"amplitude [{', '.join(dict.fromkeys(map(_micro, names)))}]")
        size.set_title(self._title(place, order), loc="right", fontsize=10)
        phase.set(xlabel=f"{self._what} [{unit}]", ylabel="phase [deg]")
        phase.yaxis.set_major_locator(MultipleLocator(90.0))
        for one in pair:
            one.grid(alpha=0.3, which="both")
        legend_above(size, 4)
        return np.array(pair)

    def plot_polar(
        self,
        place: str | None = None,
        *,
        direction: str = "n1",
        order: int | None = None,
        ax: Axes | None = None,
        units: str = "rpm",
    ) -> Axes:
        """Draw the complex amplitude [µm] or [µrad] as a curve in its plane (Nyquist diagram).

        A damped resonance is a loop; its place across from the start is the critical speed. Some
        points are labelled with their speed or frequency.

        Parameters
        ----------
        place, order, units
            See :meth:`plot`.
        direction : str
            See :meth:`phasor`.
        ax : matplotlib.axes.Axes, optional
            A new figure by default.
        """
        (values, unit), place = self._shown(units), self._named(place)
        order = self._order(order, (direction,))
        curve = 1e6 * self.phasor(place, direction, order)
        known = np.isfinite(curve)
        values, curve, ax = values[known], curve[known], axes_or_new(ax, (5.5, 5.5))
        ax.plot(curve.real, curve.imag, color=COLORS[0], lw=1.4)
        style = {"textcoords": "offset points", "xytext": (5, 4), "fontsize": 8}
        for index in range(0, len(curve), max(1, len(curve) // _LABELLED)):
            point = curve.real[index], curve.imag[index]
            ax.plot(*point, "o", color=COLORS[1], ms=4)
            ax.annotate(f"{values[index]:.5g} {unit}", point, **style)
        ax.axhline(0.0, color="0.6", lw=0.7)
        ax.axvline(0.0, color="0.6", lw=0.7)
        ax.set_aspect("equal", adjustable="datalim")
        kind = _micro(direction)
        ax.set(xlabel=f"in phase, {direction} [{kind}]", ylabel=f"a quarter turn ahead [{kind}]")
        ax.grid(alpha=0.3)
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
        shown, unit = self._shown(units)
        names = self.places if places is None else checks.labels(places, "places", self.places)
        orbits = {name: self.orbit(value, name, order) for name in names}
        ax = plot_orbits(axes_or_new(ax, (5.5, 5.5)), orbits)
        arrow = {"arrowstyle": "->", "lw": 1.4}
        for points, color in zip(orbits.values(), cycle(COLORS)):
            x, y = 1e6 * points.T
            ax.plot(x[0], y[0], "o", color=color, ms=5)
            ax.annotate("", (x[48], y[48]), (x[40], y[40]), arrowprops=arrow | {"color": color})
        ax.set(xlabel="n1 [µm]", ylabel="n2 [µm]")
        nearest = f"{self._what} {shown[self._nearest(value)]:.4g} {unit}"
        ax.set_title(nearest, loc="right", fontsize=10)
        return ax

    def _named(self, place: str | None) -> str:
        """Return a place, the first one by default."""
        return self.places[self._at(place)]

    def _nearest(self, value: float) -> int:
        """Return the number of the computed speed or frequency nearest to a value [rad/s]."""
        at = self.abscissa
        value = checks.number(value, "value", "rad/s", least=at[0], most=at[-1])
        return int(np.argmin(np.abs(at - value)))

    def _title(self, place: str, order: int) -> str:
        return f"{place}, order {order}, {self.frame} frame"

    def _harmonic(self, place: str | None, order: int) -> np.ndarray:
        """Return the amplitudes (s, 6) of one harmonic at one place."""
        motion = self.motion[:, self._at(place), list(self.orders).index(order)]
        rates = np.abs(self.rates(order))
        constant = rates <= _CONSTANT * np.abs(self.abscissa).max()
        return np.where(constant[:, None], motion.real, motion)

    def _order(self, order: int | None, directions: Sequence[str]) -> int:
        """Return a harmonic that matters, by default the main one of directions."""
        for direction in directions:
            checks.choice(direction, "direction", (*DIRECTIONS, *CIRCULAR))
        if order is None:
            return self._main(directions)
        order = checks.whole_number(order, "order")
        if order not in self.orders:
            known = ", ".join(str(n) for n in self.orders)
            raise ValueError(f"order: there is no harmonic {order}; there are {known}")
        return order


@storable
@dataclass(frozen=True, eq=False)
class UnbalanceResponse(Response):
    """Motion in harmonics nΩ, n ≥ 0; at t = 0 the rotor's n1 is the inertial n1.

    Attributes
    ----------
    places, orders, motion, frame
        See :class:`Response`.
    speeds : ndarray, shape (s,)
        Spin speeds Ω [rad/s].
    loads : tuple of str
        The unbalances in words: those given, and the rotor's own eccentricity with its amount.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import UnbalanceResponse
    >>> circle = np.array([1e-6, -1e-6j, 0, 0, 0, 0]).reshape(1, 1, 1, 6)
    >>> response = UnbalanceResponse(("disc",), [1], circle, "inertial", [100.0])
    >>> forward, backward = response.whirl("disc")
    >>> abs(forward), abs(backward)
    (array([1.e-06]), array([0.]))
    """

    speeds: np.ndarray = numbers("abscissa")
    loads: tuple[str, ...] = field(default=(), kw_only=True)

    def table(
        self, place: str | None = None, order: int | None = None, *, units: str = "rpm"
    ) -> str:
        """Return the table of :meth:`Response.table`, with the unbalances."""
        return "\n".join([super().table(place, order, units=units), *self.loads])

    def rates(self, order: int) -> np.ndarray:
        """Return nΩ, shape (s,) [rad/s]."""
        return checks.whole_number(order, "order") * self.speeds


@storable
@dataclass(frozen=True, eq=False)
class HarmonicResponse(Response):
    """Motion in harmonics ω + nΩ, at any whole n.

    Attributes
    ----------
    places, orders, motion, frame
        See :class:`Response`.
    frequencies : ndarray, shape (s,)
        Angular frequencies ω of the loads [rad/s].
    speed : float
        Spin speed Ω [rad/s].

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import HarmonicResponse
    >>> circle = np.array([1e-6, -1e-6j, 0, 0, 0, 0]).reshape(1, 1, 1, 6)
    >>> response = HarmonicResponse(("disc",), [0], circle, "inertial", [100.0], 0.0)
    >>> forward, backward = response.whirl("disc")
    >>> abs(forward), abs(backward)
    (array([1.e-06]), array([0.]))
    """

    frequencies: np.ndarray = numbers("abscissa")
    speed: float

    _over: ClassVar[str] = "frequencies"
    _what: ClassVar[str] = "frequency"

    def _main(self, directions: Sequence[str]) -> int:
        together = [group for group in _TOGETHER if not set(group).isdisjoint(directions)]
        return self._largest([name for group in together for name in group if name in DIRECTIONS])

    def rates(self, order: int) -> np.ndarray:
        """Return ω + nΩ, shape (s,) [rad/s]."""
        return self.frequencies + checks.whole_number(order, "order") * self.speed

    def _shown(self, units: str) -> tuple[np.ndarray, str]:
        return Units.of(units).frequencies(self.abscissa), Units.of(units).frequency


def _micro(direction: str) -> str:
    """Return the unit of a direction in pictures."""
    return "µrad" if direction in DIRECTIONS[3:] else "µm"


# ------------------------------------------------------------------ peaks


def resolved_peak(at: np.ndarray, size: np.ndarray, index: int) -> tuple[float, float, bool]:
    """Return place and size of the maximum at a point by its neighbours, and if they are near.

    Near a resonance 1/size² is a parabola, for one mode exactly. Neighbours are not near where one
    of them is below half of the power of the maximum.
    """
    at, size = at[index - 1 : index + 2], size[index - 1 : index + 2]
    is_near = bool(size.min() >= HALF_POWER * size[1])
    shift, seen = at - at[1], np.maximum(size, STILL * size[1])
    square, slope, middle = np.polyfit(shift, (size[1] / seen) ** 2, 2)
    if square <= 0.0:
        return float(at[1]), float(size[1]), is_near
    place = float(np.clip(-0.5 * slope / square, shift[0], shift[2]))
    least = square * place**2 + slope * place + middle
    # as close to a pole as the parabola may put it, no size follows from it
    return float(at[1] + place), float(size[1] / np.sqrt(max(least, 0.25))), is_near


def warn_of_coarse_peaks(coarse: Sequence[tuple[str, float]]) -> None:
    """Warn of peaks [rad/s] at places whose neighbours are too far apart, once for all."""
    if not coarse:
        return
    name, at = coarse[0]
    more = f" (and {len(coarse) - 1} more)" if len(coarse) > 1 else ""
    warnings.warn(
        f"{name}: the points around the peak at {at:g} rad/s{more} are too far apart to give its "
        "size and width; compute the response with refine=True, or give more points there; of a "
        "resonance that nothing damps both are infinite",
        UserWarning,
        stacklevel=user_level(),
    )


def _phase(values: np.ndarray) -> np.ndarray:
    """Return phases [deg] without jumps; none where there is no motion."""
    phase, sizes = np.full(len(values), np.nan), np.nan_to_num(np.abs(values))
    moving = sizes > _NO_MOTION * sizes.max(initial=0.0)
    phase[moving] = np.unwrap(np.angle(values[moving], deg=True), period=360.0)
    return phase
