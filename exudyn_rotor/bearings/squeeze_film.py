"""Squeeze-film damper: a short film around a journal that does not rotate, and a centring spring.

The film is that of :mod:`exudyn_rotor.bearings.short_film` at Ω = 0: open ends, carrying where its
pressure is above the ambient. On a circular centred orbit of the radius ε c with the whirl speed ω
its force is, along the line of centres and against the motion,

    F_r = −(μ R L³/c²) 2 ω ε²/(1 − ε²)²,   F_t = −(μ R L³/c²) ω π ε/(2 (1 − ε²)^{3/2}),    (1)

which in linear analyses, about an orbit that is given, is a spring and a damper. Without an orbit
they take the film about rest, at the eccentricity ε at which the spring carries the static load.
There the film has no stiffness, and damps small harmonic motions by (3) of
:mod:`exudyn_rotor.bearings.short_film`.

L. San Andrés, *Modern Lubrication Theory*, Notes 13 (Texas A&M, 2010); J. Vance, *Rotordynamics of
Turbomachinery* (1988), Sect. 6. Inertia of the oil and air in it are left out: for squeeze
Reynolds numbers ``ρ ω c²/μ`` well below 10.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, pi, sqrt
from typing import ClassVar

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import Pair
from exudyn_rotor.bearings.short_film import ShortFilmBearing, damping_at_rest


@dataclass(frozen=True, eq=False, kw_only=True)
class SqueezeFilmDamper(ShortFilmBearing):
    """Squeeze-film damper with open ends, with or without a centring spring.

    Parameters
    ----------
    interface : str
        Interface that moves in the damper: that of the bearing's outer ring, or of the shaft where
        the bearing is taken for rigid.
    radius, length : float
        Of the film [m].
    clearance : float
        Radial clearance [m].
    viscosity : float
        Dynamic viscosity of the oil [Pa s].
    centring_stiffness : float, optional
        Of the spring [N/m], relaxed in the centre; 0 for a damper without one.
    orbit : float, optional
        Radius over the clearance of the circular centred orbit about which linear analyses take the
        film (1), at the spin speed; by default 0, rest under the load.
    load : array_like, shape (2,), optional
        Static load on the journal along (n1, n2) [N], which the spring carries; none by default.
        An orbit is about the centre whatever the load.

    Raises
    ------
    TypeError, ValueError
        For sizes that are not above zero, a clearance as large as the radius, an orbit that is not
        inside the clearance.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SqueezeFilmDamper
    >>> damper = SqueezeFilmDamper(
    ...     interface="left", radius=0.06, length=0.02, clearance=1.5e-4, viscosity=0.01,
    ...     centring_stiffness=5e6, orbit=0.4,
    ... )
    >>> stiffness, damping = damper.coefficients(speed=500.0)
    >>> print(stiffness[0, 0].round(), damping[0, 0].round(1))
    5806248.0 2901.8
    """

    _unloaded: ClassVar[bool] = True
    _turns: ClassVar[bool] = False

    centring_stiffness: float = 0.0
    orbit: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.keep_numbers(self, {"centring_stiffness": "N/m"}, least=0.0)
        checks.keep_numbers(self, {"orbit": ""}, least=0.0, below=1.0)

    @property
    def carries(self) -> bool:
        """Whether it takes a share of the rotor's weight: by its spring alone."""
        return self.centring_stiffness > 0.0

    def _rest(self, speed: float, load: np.ndarray) -> np.ndarray:
        """Return where the spring holds the journal [m]."""
        if not np.any(load):
            return np.zeros(2)
        if hypot(*load) >= self.centring_stiffness * self.clearance:
            raise ValueError(
                f"load: damper at {self.interface!r}: {hypot(*load):g} N presses the journal "
                f"through the clearance of {self.clearance:g} m; a film carries no static load, "
                "give a larger centring_stiffness"
            )
        return load / self.centring_stiffness

    def _matrices(self, speed: float, load: np.ndarray) -> Pair:
        """Return stiffness and damping on the orbit (1), at the spin speed, or at rest."""
        return self.coefficients_at(self._rest(speed, load), speed)

    def coefficients_at(self, place: np.ndarray, speed: float) -> tuple[np.ndarray, np.ndarray]:
        """Return :meth:`coefficients` where the journal rests at a place (2,) [m]."""
        place = checks.vector(place, "place", "m", 2)
        if hypot(*place) >= self.clearance:
            raise ValueError(
                f"place: damper at {self.interface!r}: the journal is {hypot(*place):g} m off its "
                f"centre, outside the clearance of {self.clearance:g} m"
            )
        size, stiffness = self._size / self.clearance, self.centring_stiffness * np.eye(2)
        if self.orbit == 0.0:
            damping = damping_at_rest(*(place / self.clearance))
            return stiffness, size * np.reshape(damping, (2, 2))
        s2 = 1.0 - self.orbit**2
        film = 2.0 * size * abs(speed) * self.orbit / s2**2
        damping = 0.5 * pi * size / (s2 * sqrt(s2))
        return stiffness + film * np.eye(2), damping * np.eye(2)
