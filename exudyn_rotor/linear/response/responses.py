"""Results of forced responses."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.linear.response.response import Response
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.rotor.start_state import StartState
from exudyn_rotor.results import numbers, storable
from exudyn_rotor.units import Units


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

    @property
    def abscissa(self) -> np.ndarray:
        """The spin speeds [rad/s]."""
        return self.speeds

    def rates(self, order: int) -> np.ndarray:
        """Return nΩ, shape (s,) [rad/s]."""
        return checks.whole_number(order, "order") * self.speeds

    def state(self, speed: float, body: RotorBody, *, angle: float | None = None) -> StartState:
        """Return the state of a scene in which a run begins in this steady motion.

        The scene's supports and unbalances must be those of the response; there is no transient
        then but for the integrator's error and what linear equations leave out. Loads such as
        gravity are not in a response: :func:`exudyn_rotor.steady_state` has them.

        Parameters
        ----------
        speed : float
            One of :attr:`speeds` [rad/s].
        body : RotorBody
            Of the reduced rotor that the response is of, or in the scene that it is of; the system
            is assembled. Foundation and controllers of magnetic bearings start with it; bodies that
            the response does not know stand still as they are.
        angle : float, optional
            Spin angle θ [rad]; the one with which the rotor starts by default.

        Returns
        -------
        StartState
            For :meth:`RotorBody.start_from`.

        Raises
        ------
        TypeError, ValueError
            For a response of a SolidRotor, of another rotor, or with another foundation or
            controllers, a speed at which it was not computed, or a system that is not assembled.
        """
        return self._start_at_speed(speed, body, angle)

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

    def state(self, frequency: float, body: RotorBody) -> StartState:
        """Return the state of a scene in which a run begins in this steady motion.

        It is that of t = 0 and θ = 0, where the loads have the real parts of their amplitudes; see
        :meth:`UnbalanceResponse.state`.

        Parameters
        ----------
        frequency : float
            One of :attr:`frequencies` [rad/s].
        body : RotorBody
            With the spin speed of the response.

        Raises
        ------
        TypeError, ValueError
            As :meth:`UnbalanceResponse.state`.
        """
        frequency = checks.number(frequency, "frequency", "rad/s")
        return self._start(frequency, body, 0.0, self.speed)

    @property
    def _what(self) -> str:
        return "frequency"

    def _shown(self, units: str) -> tuple[np.ndarray, str]:
        return Units.of(units).frequencies(self.abscissa), Units.of(units).frequency
