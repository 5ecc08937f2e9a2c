"""Results of forced responses: harmonics of the motion at places of the rotor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.results import Result, numbers, storable, words

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DIRECTIONS = ("n1", "n2", "e", "tilt n1", "tilt n2", "twist")


@dataclass(frozen=True, eq=False)
class Response(Result):
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
        checks.choice(self.frame, "frame", ("inertial", "rotor"))

    @property
    def abscissa(self) -> np.ndarray:
        """What the response was computed over, shape (s,) [rad/s]."""
        raise NotImplementedError

    def rates(self, order: int) -> np.ndarray:
        """Return the angular frequencies of a harmonic, shape (s,) [rad/s]."""
        raise NotImplementedError

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
        """Return where the major semi-axis is largest [rad/s], and its size [m]."""
        major, _ = self.semi_axes(place, order)
        index = int(major.argmax())
        return float(self.abscissa[index]), float(major[index])

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

    def plot(self, place: str | None = None, **options) -> tuple[Axes, Axes]:
        """Draw a Bode diagram; see :func:`exudyn_rotor.linear.response_plots.plot_bode`."""
        from exudyn_rotor.linear.response.plots import plot_bode

        return plot_bode(self, place, **options)

    def plot_polar(self, place: str | None = None, **options) -> Axes:
        """Draw phasors in their plane; see :func:`...response_plots.plot_polar`."""
        from exudyn_rotor.linear.response.plots import plot_polar

        return plot_polar(self, place, **options)

    def plot_orbit(self, value: float, **options) -> Axes:
        """Draw orbits; see :func:`exudyn_rotor.linear.response_plots.plot_orbit`."""
        from exudyn_rotor.linear.response.plots import plot_orbit

        return plot_orbit(self, value, **options)

    @property
    def _what(self) -> str:
        raise NotImplementedError

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
    """

    speeds: np.ndarray = numbers("abscissa")

    @property
    def abscissa(self) -> np.ndarray:
        """The spin speeds [rad/s]."""
        return self.speeds

    def rates(self, order: int) -> np.ndarray:
        """Return nΩ, shape (s,) [rad/s]."""
        return order * self.speeds

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
    """

    frequencies: np.ndarray = numbers("abscissa")
    speed: float

    @property
    def abscissa(self) -> np.ndarray:
        """The frequencies of the loads [rad/s]."""
        return self.frequencies

    def rates(self, order: int) -> np.ndarray:
        """Return ω + nΩ, shape (s,) [rad/s]."""
        return self.frequencies + order * self.speed

    @property
    def _what(self) -> str:
        return "frequency"


def _degrees(value: complex) -> float:
    return float(np.degrees(np.angle(value)))
