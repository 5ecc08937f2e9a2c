"""Plain journal bearing that is short: Ocvirk's film of 180°, equilibrium and coefficients.

The film is that of :mod:`exudyn_rotor.bearings.short_film`. The journal is braked by the shear
of a film all around it, and by the moment of the pressure about its centre, which is e from the
centre of the bearing:

    T = −2π μ Ω R³ L/(c √(1 − ε²)) − ½ e × F.                                              (1)

F. W. Ocvirk, NACA TN 2808 (1952); M. I. Friswell et al., *Dynamics of Rotating Machines* (2010),
Sect. 5.5. Error of the short bearing: below 5 % of the force for L/D ≤ 0.25, and about 20 to 30 %
at L/D = 0.5; the oil's heating and inertia are left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import Pair
from exudyn_rotor.bearings.short_film import THINNEST, ShortFilmBearing, film_force, film_tangent

_MOST = 1.0 - 1e-9  # eccentricity ratio of an equilibrium


@dataclass(frozen=True, eq=False, kw_only=True)
class ShortJournalBearing(ShortFilmBearing):
    """Plain cylindrical journal bearing by the theory of the short bearing.

    Parameters
    ----------
    interface : str
        Interface of the rotor that is the journal.
    radius, length : float
        Of the journal in the bearing [m].
    clearance : float
        Radial clearance [m].
    viscosity : float
        Dynamic viscosity of the oil [Pa s].
    load : array_like, shape (2,), optional
        Static load on the journal along (n1, n2) [N], which linear analyses need.

    Raises
    ------
    TypeError, ValueError
        For numbers that are not above zero, or a clearance as large as the radius.

    Examples
    --------
    A journal of 100 mm that carries 525 N at 1500 rpm [Friswell et al., Example 5.5.1]:

    >>> import numpy as np
    >>> from exudyn_rotor import ShortJournalBearing
    >>> bearing = ShortJournalBearing(
    ...     interface="left", radius=0.05, length=0.03, clearance=1e-4, viscosity=0.1,
    ...     load=[0.0, -525.0],
    ... )
    >>> speed = 1500.0 * np.pi / 30.0
    >>> round(bearing.eccentricity_ratio(speed), 4)
    0.2663
    >>> print(np.round(bearing.coefficients(speed)[0] / 1e6, 2))
    [[ 12.81  16.39]
     [-25.06   8.82]]
    """

    @property
    def _shear(self) -> float:
        """Torque of a film all around, for each rad/s [N m s]."""
        return 2.0 * pi * self.viscosity * self.radius**3 * self.length / self.clearance

    def law_with_torque(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, float, float]:
        """As :meth:`law`, with the torque (1) on the journal [N m]."""
        fx, fy = self.law(x, y, vx, vy, angle, speed)
        ratio = min(hypot(x, y) / self.clearance, THINNEST)
        return fx, fy, -self._shear * speed / sqrt(1.0 - ratio**2) - 0.5 * (x * fy - y * fx)

    def eccentricity_ratio(self, speed: float, load: ArrayLike | None = None) -> float:
        """Return the eccentricity over the clearance under a static load [N] at a speed [rad/s].

        Raises
        ------
        TypeError, ValueError
            For bad input, a missing load, and at rest, where no film carries.
        """
        load = self._static_load(load)
        checks.number(speed, "speed", "rad/s")
        weight = hypot(*load)
        if weight == 0.0:
            return 0.0
        if speed == 0.0:
            raise ValueError(
                f"speed: bearing at {self.interface!r}: needs one other than 0; without rotation "
                f"the film does not carry the load of {weight:g} N"
            )

        def carried(ratio: float) -> float:
            return self._size * hypot(*film_force(ratio, 0.0, 0.0, 0.0, speed)) - weight

        if carried(_MOST) < 0.0:
            raise ValueError(
                f"load: bearing at {self.interface!r}: {weight:g} N at {speed:g} rad/s leaves no "
                "film"
            )
        return float(brentq(carried, 0.0, _MOST, xtol=1e-15, rtol=1e-14))

    def _rest(self, speed: float, load: np.ndarray) -> np.ndarray:
        """Return where the film carries the load [m]."""
        ratio = self.eccentricity_ratio(speed, load)
        if ratio == 0.0:
            return np.zeros(2)
        # the journal on n1, turned until the force is minus the load
        turn = -complex(*load) / complex(*film_force(ratio, 0.0, 0.0, 0.0, speed))
        place = self.clearance * ratio * turn / abs(turn)
        return np.array([place.real, place.imag])

    def _matrices(self, speed: float, load: np.ndarray) -> Pair:
        """Return the derivatives of the film's force at rest."""
        place = (self._rest(speed, load) / self.clearance).tolist()
        found = self._size / self.clearance * film_tangent(*place, 0.0, 0.0, speed)[1]
        return found[:, :2], found[:, 2:]
