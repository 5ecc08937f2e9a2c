"""Plain journal bearing that is short: Ocvirk's film of 180°, equilibrium and coefficients.

The film is that of :mod:`exudyn_rotor.bearings.short_film`. At rest, along the line of centres and
across it, its force is

    F_r = −(μ Ω R L³/c²) ε²/(1 − ε²)²,   F_t = (μ Ω R L³/c²) π ε/(4 (1 − ε²)^{3/2}).     (2)

The journal is braked by the shear of a film all around it, and by the moment of the pressure about
its centre, which is e from that of the bearing:

    T = −2π μ Ω R³ L/(c √(1 − ε²)) − ½ e × F.                                              (3)

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
from exudyn_rotor.bearings.bearing import LawWithTorque
from exudyn_rotor.bearings.short_film import THINNEST, ShortFilmBearing

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

    def force(self, displacement: ArrayLike, velocity: ArrayLike, speed: float) -> np.ndarray:
        """Return the force of the film on the journal [N], shape (2,).

        Parameters
        ----------
        displacement, velocity : array_like, shape (2,)
            Of the journal's centre from that of the bearing [m], [m/s].
        speed : float
            Spin speed [rad/s].

        Raises
        ------
        TypeError, ValueError
            For bad input, and a displacement as large as the clearance.
        """
        return self._checked_film(displacement, velocity, speed)[1]

    def _law(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, float]:
        return self._film(x, y, vx, vy, speed)

    @property
    def law_with_torque(self) -> LawWithTorque:
        """As :attr:`law`, with the torque (3) on the journal [N m]."""
        return self._law_with_torque

    def _law_with_torque(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, float, float]:
        fx, fy = self._film(x, y, vx, vy, speed)
        ratio = min(hypot(x, y) / self.clearance, THINNEST)
        shear = 2.0 * pi * self.viscosity * self.radius**3 * self.length / self.clearance
        return fx, fy, -shear * speed / sqrt(1.0 - ratio**2) - 0.5 * (x * fy - y * fx)

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
        size = self._size * abs(speed)

        def carried(ratio: float) -> float:
            radial, tangential = _at_rest(ratio)
            return size * hypot(radial, tangential) - weight

        if carried(_MOST) < 0.0:
            raise ValueError(
                f"load: bearing at {self.interface!r}: {weight:g} N at {speed:g} rad/s leaves no "
                "film"
            )
        return float(brentq(carried, 0.0, _MOST, xtol=1e-15, rtol=1e-14))

    def equilibrium(self, speed: float, load: ArrayLike | None = None) -> np.ndarray:
        """Return where the journal rests under a static load, (2) [m], shape (2,).

        Parameters
        ----------
        speed : float
            Spin speed [rad/s].
        load : array_like, shape (2,), optional
            On the journal [N]; that of the bearing by default.

        Raises
        ------
        TypeError, ValueError
            As :meth:`eccentricity_ratio`.
        """
        ratio = self.eccentricity_ratio(speed, load)
        return self.clearance * ratio * self._direction(ratio, speed, self._static_load(load))

    def coefficients(
        self, speed: float, load: ArrayLike | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return stiffness [N/m] and damping [N s/m] about the equilibrium, each (2, 2).

        The derivatives of (2) along the line of centres and across it, turned into (n1, n2).

        Parameters and errors are those of :meth:`equilibrium`.
        """
        ratio = self.eccentricity_ratio(speed, load)
        sense = -1.0 if speed < 0.0 else 1.0
        s2 = 1.0 - ratio**2
        s = sqrt(s2)
        radial = 2.0 * ratio * (1.0 + ratio**2) / s2**3
        K = [
            [radial, 0.25 * pi / s**3],
            [-0.25 * pi * (1.0 + 2.0 * ratio**2) / s**5, ratio / s2**2],
        ]
        D = [[0.5 * pi * (1.0 + 2.0 * ratio**2) / s**5, -2.0 * ratio / s2**2],
             [-2.0 * ratio / s2**2, 0.5 * pi / s**3]]  # fmt: skip
        load = self._static_load(load)
        # in the middle, also under what rounding leaves of a load, all directions are alike
        r = self._direction(ratio, speed, load) if ratio > 0.0 else np.array([1.0, 0.0])
        turn = np.column_stack([r, sense * np.array([-r[1], r[0]])])
        size = self._size / self.clearance
        return size * abs(speed) * turn @ K @ turn.T, size * turn @ D @ turn.T

    def power_loss(self, speed: float, load: ArrayLike | None = None) -> float:
        """Return the friction (3) of the journal at rest under a static load, −T Ω [W].

        Parameters and errors are those of :meth:`equilibrium`.
        """
        place = self.equilibrium(speed, load).tolist()
        return -speed * self._law_with_torque(*place, 0.0, 0.0, 0.0, speed)[2]

    def _direction(self, ratio: float, speed: float, load: np.ndarray) -> np.ndarray:
        """Return the unit vector from the bearing's centre to the journal's."""
        radial, tangential = _at_rest(ratio)
        if speed < 0.0:
            tangential = -tangential
        # the load is minus the force: (radial, −tangential) in the axes along and across
        size = hypot(radial, tangential)
        if size == 0.0:
            return np.zeros(2)
        c, s = radial / size, -tangential / size
        return np.array([[c, s], [-s, c]]) @ load / hypot(*load)


def _at_rest(ratio: float) -> tuple[float, float]:
    """Return −F_r and F_t of (2) over ``μ Ω R L³/c²``."""
    s2 = 1.0 - ratio**2
    return ratio**2 / s2**2, 0.25 * pi * ratio / s2**1.5
