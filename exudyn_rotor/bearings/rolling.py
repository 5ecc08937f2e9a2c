"""Rolling bearing: Hertzian balls or rollers, clearance, and a cage that carries them around.

Element j stands at ``φ_j = 2π j/Z + κ θ``; the outer ring stands still, the inner one turns by θ
with the rotor, and without slip the cage turns by the share

    κ = ½ (1 − r/R cos α)                                                                  (1)

of it (r radius of the elements, R of the pitch circle, α contact angle). The contacts of one
element with both rings together carry

    Q_j = k max(0, x cos φ_j + y sin φ_j − c)^n,                                           (2)

n = 3/2 for balls, 10/9 for rollers. A clearance below zero is an interference, which presses all
elements without a load (preload). The sum varies with every element that passes the load: at the
frequency Z κ Ω (varying compliance). Elements that roll without loss take from the spin, by the
torque

    T = −κ Σ Q_j (y cos φ_j − x sin φ_j),                                                  (3)

what the contacts store and the inner ring does not bring. T. A. Harris, *Rolling Bearing Analysis*
(2001), Ch. 7, 8; C. S. Sunnersjö, J. Sound Vib. 58 (1978). Centrifugal and gyroscopic loads of the
elements, slip, waviness and the oil film are left out; α counts in (1) alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, hypot, pi, sin

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import Bearing, Pair
from exudyn_rotor.calls import kept

_EXPONENTS = {"balls": 1.5, "rollers": 10.0 / 9.0}
_MOST_ITERATIONS, _MOST_CUTS = 100, 40
_CONVERGED = 1e-14  # last step over the depth of the contact
_SOFT = 1e-6  # share of the bearing's stiffness
_CAGE_ANGLES = 16  # over the passage of one element, for mean coefficients


@dataclass(frozen=True, eq=False, kw_only=True)
class RollingBearing(Bearing):
    """Radial bearing with balls or rollers.

    Linear analyses take the mean of its stiffness, in the equilibria under the load, over the
    passage of one element; :func:`periodic_response` takes the contacts as they are. A scene with
    it does not repeat with every revolution: :func:`steady_state` holds the cage where it starts.

    Parameters
    ----------
    interface : str
        Interface of the rotor that is the seat of the inner ring.
    count : int
        Number of elements Z, 3 or more.
    pitch_radius, element_radius : float
        [m].
    stiffness : float
        k of both contacts of an element together, which carry ``k p^n`` (2) at the depth p of the
        contact, n = 3/2 for balls and 10/9 for rollers [N/m^n].
    clearance : float, optional
        Radial clearance c [m]; below zero an interference, by which all elements are preloaded.
    elements : {'balls', 'rollers'}, optional
    contact_angle : float, optional
        Of influence on the speed of the cage alone [rad].
    damping : float, optional
        Of the inner ring in all directions across the axis [N s/m].
    load : array_like, shape (2,), optional
        Static load on the inner ring along (n1, n2) [N], which linear analyses need; none by
        default where the elements are preloaded.

    Raises
    ------
    TypeError, ValueError
        For sizes that are not above zero, negative damping, an interference as large as the
        elements, elements as large as the pitch circle, or more than fit on it.

    Examples
    --------
    >>> from exudyn_rotor import RollingBearing
    >>> bearing = RollingBearing(
    ...     interface="left", count=8, pitch_radius=0.0326, element_radius=0.006, stiffness=7e9,
    ...     clearance=5e-6, load=[0.0, -500.0],
    ... )
    >>> round(bearing.passing_frequency(speed=100.0), 3)
    326.38
    >>> print(bearing.equilibrium(100.0).round(7) + 0.0)
    [ 0.00e+00 -1.74e-05]
    """

    count: int
    pitch_radius: float
    element_radius: float
    stiffness: float
    clearance: float = 0.0
    elements: str = "balls"
    contact_angle: float = 0.0
    damping: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.count(self.count, "count", least=3)
        sizes = {"pitch_radius": "m", "element_radius": "m", "stiffness": "N/m^n"}
        checks.keep_numbers(self, sizes, above=0.0)
        checks.keep_numbers(self, {"clearance": "m"}, above=-self.element_radius)
        checks.keep_numbers(self, {"damping": "N s/m"}, least=0.0)
        checks.choice(self.elements, "elements", _EXPONENTS)
        checks.keep_numbers(self, {"contact_angle": "rad"}, least=0.0, below=pi / 2)
        if self.element_radius >= self.pitch_radius * sin(pi / self.count):
            raise ValueError(
                f"element_radius: {self.count} elements of {self.element_radius:g} m do not fit "
                f"on a pitch circle of {self.pitch_radius:g} m"
            )

    @property
    def _unloaded(self) -> bool:
        return self.clearance < 0.0

    @property
    def cage_ratio(self) -> float:
        """Turn of the cage over that of the rotor, κ of (1)."""
        return 0.5 * (1.0 - self.element_radius / self.pitch_radius * cos(self.contact_angle))

    def passing_frequency(self, speed: float) -> float:
        """Return Z κ Ω, at which elements pass the load [rad/s].

        Parameters
        ----------
        speed : float
            Spin speed [rad/s].
        """
        return self.count * self.cage_ratio * checks.number(speed, "speed", "rad/s")

    def law_with_torque(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, float, float]:
        """Return the force on the inner ring [N], and the torque (3) [N m]."""
        angles = 2.0 * pi / self.count * np.arange(self.count) + self.cage_ratio * angle
        c, s = np.cos(angles), np.sin(angles)
        depth = np.maximum(x * c + y * s - self.clearance, 0.0)
        loads, d = self.stiffness * depth ** _EXPONENTS[self.elements], self.damping
        px, py = float(loads @ c), float(loads @ s)
        return -px - d * vx, -py - d * vy, self.cage_ratio * (x * py - y * px)

    def slopes(self, x: float, y: float, vx: float, vy: float, angle: float, speed: float) -> Pair:
        """Return less the derivatives (2, 2) of :meth:`law` by place and by velocity."""
        return contacts(self, np.array([x, y]), angle)[2], self.damping * np.eye(2)

    def law_along(self, motion: np.ndarray, angles: np.ndarray, speed: float) -> Pair:
        """Return forces (t, 2) and less their derivatives (t, 2, 4); see :class:`Bearing`."""
        _, force, stiffness = contacts(self, motion[:, :2], angles)
        damping = np.broadcast_to(self.damping * np.eye(2), stiffness.shape)
        return force - self.damping * motion[:, 2:], np.concatenate([stiffness, damping], axis=-1)

    def equilibrium(
        self, speed: float, load: ArrayLike | None = None, angle: float = 0.0
    ) -> np.ndarray:
        """Return where the inner ring rests under a static load [m], shape (2,).

        Parameters
        ----------
        speed : float
            Spin speed [rad/s], which plays no part.
        load : array_like, shape (2,), optional
            On the inner ring [N]; that of the bearing by default.
        angle : float, optional
            Spin angle θ [rad]; at 0 the first element is on n1.

        Raises
        ------
        TypeError, ValueError
            For bad input, a missing load, and no load, for which a ring has an equilibrium in
            preloaded elements alone.
        """
        checks.number(speed, "speed", "rad/s")
        checks.number(angle, "angle", "rad")
        load = self._static_load(load)
        weight = hypot(*load)
        if weight == 0.0 and self.clearance < 0.0:
            return np.zeros(2)
        if weight == 0.0:
            raise ValueError("load: needs a force other than 0: without one no element carries")
        depth = float(depth_under(self, weight))
        # there one element carries, wherever they stand
        far = max(self.clearance, 0.0) / cos(pi / self.count) + 1.5 * depth
        place = far * load / weight
        soft = _SOFT * weight / depth * np.eye(2)  # against a single element's free direction

        def lacking(place: np.ndarray) -> np.ndarray:
            return load + np.array(self.law(*place, 0.0, 0.0, angle, 0.0))

        for _ in range(_MOST_ITERATIONS):
            tangent = contacts(self, place, angle)[2]
            step = np.linalg.solve(tangent + soft, lacking(place))
            low, share, high, work = 0.0, 1.0, 1.0, step @ lacking(place)
            for _ in range(_MOST_CUTS):  # by bisection to where forces do little work on the step
                left = step @ lacking(place + share * step)
                if abs(left) <= 0.5 * work or (share == 1.0 and left > 0.0):
                    break
                low, high = (share, high) if left > 0.0 else (low, share)
                share = 0.5 * (low + high)
            place = place + share * step
            if np.abs(step).max() < _CONVERGED * depth:
                break
        # of the depth of contact, with a small load and a wide clearance or a large preload
        size = np.abs(place).max() + abs(self.clearance)
        rounding = 10.0 * np.finfo(float).eps * size * np.abs(tangent).max()
        if np.abs(lacking(place)).max() > 1e-9 * weight + rounding:
            raise ValueError(
                f"load: bearing at {self.interface!r}: no equilibrium found under {weight:g} N"
            )
        return place

    def _matrices(self, speed: float, load: np.ndarray) -> Pair:
        """Return the mean stiffness over an element's passage, and the damping."""
        return _mean_stiffness(self, *load.tolist()).copy(), self.damping * np.eye(2)


@kept
def _mean_stiffness(bearing: RollingBearing, *load: float) -> np.ndarray:
    """Return the stiffness (2, 2) under a load (2,) [N], its mean over an element's passage."""
    passage = 2.0 * pi / (bearing.count * bearing.cage_ratio)
    angles = passage * np.arange(_CAGE_ANGLES) / _CAGE_ANGLES
    places = [bearing.equilibrium(0.0, load, angle) for angle in angles]
    return contacts(bearing, np.array(places), angles)[2].mean(axis=0)


def contacts(
    bearing: RollingBearing, places: np.ndarray, angles: ArrayLike
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return loads (…, Z) of the elements, force (…, 2) and stiffness (…, 2, 2) without damping.

    Of the inner ring at places (…, 2) and spin angles (…); stiffness is less the force's
    derivative.
    """
    turn = bearing.cage_ratio * np.asarray(angles)[..., None]
    turned = 2.0 * pi / bearing.count * np.arange(bearing.count) + turn
    n, exponent = np.stack([np.cos(turned), np.sin(turned)], -1), _EXPONENTS[bearing.elements]
    depth = np.maximum((n @ places[..., None])[..., 0] - bearing.clearance, 0.0)
    loads = bearing.stiffness * depth**exponent
    slopes = exponent * bearing.stiffness * depth ** (exponent - 1.0)
    across = np.swapaxes(n, -1, -2)
    force = -(across @ loads[..., None])[..., 0]
    return loads, force, across @ (slopes[..., None] * n)


def depth_under(bearing: RollingBearing, load: ArrayLike) -> np.ndarray:
    """Return about how deep a load [N], of any shape, presses the most loaded contact [m].

    ``Q = 4W/Z``, R. Stribeck (1901) without clearance.
    """
    most = 4.0 / bearing.count * np.asarray(load)
    return (most / bearing.stiffness) ** (1.0 / _EXPONENTS[bearing.elements])
