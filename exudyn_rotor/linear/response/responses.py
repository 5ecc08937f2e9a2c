"""Results of forced responses: harmonics of the motion at places of the rotor."""

from __future__ import annotations

import warnings
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from exudyn_rotor import checks
from exudyn_rotor.linear.periodic.rotating_axes import FRAMES
from exudyn_rotor.linear.response.bode import draw_bode, draw_orbits, draw_polar
from exudyn_rotor.linear.response.refinement import peak_between
from exudyn_rotor.plotting import axes_or_new, figure
from exudyn_rotor.results import Result, numbers, storable, words

DIRECTIONS = ("n1", "n2", "e", "tilt n1", "tilt n2", "twist")
CIRCULAR = ("forward", "backward")
# neighbours of a peak below this share of it: it may be higher between them
_RESOLVED = 0.7
_DRAWN = (*DIRECTIONS, *CIRCULAR)
HERTZ = 1.0 / (2.0 * np.pi)


@dataclass(frozen=True, eq=False)
class Response(Result, ABC):
    """Steady motion ``u(t) = Re Σ_n a_n exp(i rate_n t)`` at places of the rotor.

    Attributes
    ----------
    places : tuple of str
        Interfaces and nodes (p), 'node 12'.
    orders : ndarray of int, shape (h,)
        The harmonics n that matter.
    motion : ndarray of complex, shape (s, p, h, 6)
        Amplitudes a_n of the displacement along (n1, n2, e) [m] and the rotation about them [rad];
        rotations of a node are NaN.
    frame : {'inertial', 'rotor'}
        Whether (n1, n2, e) of :attr:`SpinAxis.plane` stand still or turn with the rotor.
    """

    places: tuple[str, ...] = words("places")
    orders: np.ndarray = numbers("orders", dtype=int)
    motion: np.ndarray = numbers("abscissa", "places", "orders", 6, dtype=complex, finite=False)
    frame: str

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.choice(self.frame, "frame", FRAMES)

    @property
    @abstractmethod
    def abscissa(self) -> np.ndarray:
        """What the response was computed over, shape (s,) [rad/s]."""

    @abstractmethod
    def rates(self, order: int) -> np.ndarray:
        """Return the angular frequencies of a harmonic, shape (s,) [rad/s]."""

    @property
    def main_order(self) -> int:
        """The harmonic with the largest displacement anywhere."""
        return int(self.orders[np.abs(self.motion[..., :3]).max(axis=(0, 1, 3)).argmax()])

    def phasor(
        self, place: str | None = None, direction: str = "n1", order: int | None = None
    ) -> np.ndarray:
        """Return complex amplitudes, shape (s,): the size and, as ``np.angle``, the phase.

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
        """Return the semi-axes of the orbit across e, each (s,) [m].

        The minor one is negative where the rotor whirls backward.
        """
        forward, backward = np.abs(self.whirl(place, order))
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
            raise ValueError(
                f"{self._place(place)}: the motion has no peak between {self.abscissa[0]:g} and "
                f"{self.abscissa[-1]:g} rad/s; extend the range, or compute with refine=True"
            )
        index = int(inner[major[inner].argmax()])
        near = slice(index - 1, index + 2)
        if major[near].min() < _RESOLVED * major[index]:
            warnings.warn(
                f"{self._place(place)}: the points around the peak at {self.abscissa[index]:g} "
                "rad/s are too far apart to give its size; compute with refine=True",
                UserWarning,
                stacklevel=2,
            )
        return peak_between(self.abscissa[near], major[near])

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

    def table(self, place: str | None = None, order: int | None = None) -> str:
        """Return sizes and phases at one place as text."""
        place, order = self._place(place), self._order(order)
        a, b = (self.phasor(place, name, order) for name in ("n1", "n2"))
        forward, backward = self.whirl(place, order)
        lines = [
            f"{place}, order {order}, {self.frame} frame",
            f"{self._what:>16}  {'n1':>11} {'phase':>7}  {'n2':>11} {'phase':>7}  "
            f"{'forward':>11} {'backward':>11}",
            f"{'[rad/s]':>16}  {'[m]':>11} {'[deg]':>7}  {'[m]':>11} {'[deg]':>7}  "
            f"{'[m]':>11} {'[m]':>11}",
        ]
        for row in zip(self.abscissa, a, b, forward, backward, strict=True):
            at, x, y, f, g = row
            lines.append(
                f"{at:16.6g}  {abs(x):11.4e} {_degrees(x):7.1f}  {abs(y):11.4e} {_degrees(y):7.1f}"
                f"  {abs(f):11.4e} {abs(g):11.4e}"
            )
        return "\n".join(lines)

    def plot(
        self,
        place: str | None = None,
        *,
        directions: Sequence[str] = ("n1", "n2"),
        order: int | None = None,
        ax: Sequence[Axes] | None = None,
        log: bool = True,
    ) -> np.ndarray:
        """Draw size and phase of the displacement over speed or frequency [Hz] (Bode diagram).

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

        Returns
        -------
        ndarray of matplotlib.axes.Axes, shape (2,)
            Size and phase, as ``plt.subplots(2)`` returns them.
        """
        names = checks.labels(directions, "directions", _DRAWN)
        checks.flag(log, "log")
        place, order = self._place(place), self._order(order)
        if ax is None:
            ax = figure(2, 1, size=(7.0, 5.5), sharex=True)[1]
        pair = checks.instances(ax, "ax", Axes)
        if len(pair) != 2:
            raise ValueError(f"ax: needs two Axes, for size and phase, got {len(pair)}")
        curves = {name: self._drawn(name, place, order) for name in names}
        draw_bode(*pair, HERTZ * self.abscissa, curves, log)
        pair[0].set_title(self._title(place, order), loc="right", fontsize=10)
        pair[1].set_xlabel(f"{self._what} [Hz]")
        return np.array(pair)

    def plot_polar(
        self,
        place: str | None = None,
        *,
        direction: str = "n1",
        order: int | None = None,
        ax: Axes | None = None,
        marks: int = 5,
    ) -> Axes:
        """Draw the complex amplitude [µm] as a curve in its plane (Nyquist diagram).

        A damped resonance is a loop; its place across from the start is the critical speed.

        Parameters
        ----------
        place, order
            See :meth:`plot`.
        direction : {'n1', 'n2', 'e', 'forward', 'backward'}
        ax : matplotlib.axes.Axes, optional
            A new figure by default.
        marks : int, optional
            How many points are labelled with their speed or frequency [Hz].
        """
        checks.choice(direction, "direction", _DRAWN)
        marks = checks.count(marks, "marks")
        place, order = self._place(place), self._order(order)
        ax = axes_or_new(ax, (5.5, 5.5))
        draw_polar(ax, HERTZ * self.abscissa, self._drawn(direction, place, order), marks)
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
        """
        value = checks.number(value, "value", "rad/s")
        names = self.places
        if places is not None:
            names = checks.labels(places, "places", self.places)
        order = self._order(order)
        ax = axes_or_new(ax, (5.5, 5.5))
        draw_orbits(ax, {name: self.orbit(value, name, order) for name in names})
        nearest = self.abscissa[np.argmin(np.abs(self.abscissa - value))]
        ax.set_title(f"{self._what} {HERTZ * nearest:.4g} Hz", loc="right", fontsize=10)
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
        index = list(self.orders).index(self._order(order))
        return self.motion[:, self.places.index(self._place(place)), index]

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

    @property
    def abscissa(self) -> np.ndarray:
        """The spin speeds [rad/s]."""
        return self.speeds

    def rates(self, order: int) -> np.ndarray:
        """Return nΩ, shape (s,) [rad/s]."""
        return checks.whole_number(order, "order") * self.speeds

    @property
    def _what(self) -> str:
        return "spin speed"


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

    @property
    def abscissa(self) -> np.ndarray:
        """The frequencies of the loads [rad/s]."""
        return self.frequencies

    def rates(self, order: int) -> np.ndarray:
        """Return ω + nΩ, shape (s,) [rad/s]."""
        return self.frequencies + checks.whole_number(order, "order") * self.speed

    @property
    def _what(self) -> str:
        return "frequency"


def _degrees(value: complex) -> float:
    return float(np.degrees(np.angle(value)))
