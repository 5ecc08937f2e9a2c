"""Results of forced responses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.linear.response.response import Response
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

    def _shown(self, units: str) -> tuple[np.ndarray, str]:
        return Units.of(units).frequencies(self.abscissa), Units.of(units).frequency
