"""The film of a short bearing: Ocvirk's solution of Reynolds' equation on half of the bearing.

With the journal at c (x, y), the film ``h = c (1 − x cos φ − y sin φ)`` and a length L well below
the diameter, Reynolds' equation keeps its axial derivative alone:

    p = 6 μ/h³ (Ω/2 h' + ḣ) (z² − L²/4),

above zero where ``a cos φ + b sin φ > 0``, ``a = ẋ + Ω y/2``, ``b = ẏ − Ω x/2``: always on half
of the bearing, and there alone the film carries (half-Sommerfeld, by Gümbel). Over that half, with
``w² = a² + b²``, ``u = (x a + y b)/w``, ``v = (y a − x b)/w``, ``s² = 1 − x² − y²`` and
``β = π/2 + arctan(u/s)``, the force on the journal is in closed form

    F = −(μ R L³/c²) [ I_cc (a, b) + I_cs (−b, a) ]                                      (1)
    I_cc = 3 u/s⁴ + β (s² + 3 u²)/s⁵
    I_cs = 2 v/s⁴ + u² v/((1 − v²) s⁴) + 3 β u v/s⁵.

In the axes d along (a, b) and n across it, with ``w' = d · δ(a, b)`` and ``φ' = n · δ(a, b)/w``, a
small change has ``u' = d · δ(x, y) + v φ'`` and ``v' = n · δ(x, y) − u φ'``, so that

    δF = −(μ R L³/c²) [ (I_cc w' + w I_cc' − w I_cs φ') d                                  (2)
                      + (I_cs w' + w I_cs' + w I_cc φ') n ].

Where w = 0 the half that carries is that to which the journal begins to move, and (2) depends on
the direction. A small harmonic motion about such a place, e, has the mean of a direction and its
opposite, half of the damping of a film that carries all around,

    D = (μ R L³/c³) π/2 [s² + 3 e eᵀ]/s⁵.                                                  (3)

F. W. Ocvirk, NACA TN 2808 (1952); G. Capone, L'Energia Elettrica 68 (1991).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, hypot, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import Bearing, by_tangent

_REST = 1e-6  # of Ω: the rate w of a journal at rest
THINNEST = 1.0 - 0.01  # of the clearance: beyond, a film goes on by its tangent
_STEP = 1e-6  # of the clearance, of that tangent
Tangent = tuple[np.ndarray, np.ndarray]
Numbers = float | np.ndarray


def film_force(x: float, y: float, vx: float, vy: float, speed: float) -> tuple[float, float]:
    """Return the force (1) over ``μ R L³/c²``, for a place and velocity over the clearance."""
    a, b = vx + 0.5 * speed * y, vy - 0.5 * speed * x
    w = hypot(a, b)
    if w == 0.0:
        return 0.0, 0.0
    u, v = (x * a + y * b) / w, (y * a - x * b) / w
    s2 = 1.0 - x * x - y * y
    s = sqrt(s2)
    beta = 0.5 * pi + atan(u / s)
    s4, s5 = s2 * s2, s2 * s2 * s
    along = 3.0 * u / s4 + beta * (s2 + 3.0 * u * u) / s5
    across = 2.0 * v / s4 + u * u * v / ((1.0 - v * v) * s4) + 3.0 * beta * u * v / s5
    return across * b - along * a, -along * b - across * a


def film_tangent(
    x: float, y: float, vx: float, vy: float, speed: float, rest: float = 0.0
) -> np.ndarray:
    """Return minus the derivatives (2) of :func:`film_force` by place and velocity, shape (2, 4).

    Up to the rate `rest` of w those of small motions, (3).
    """
    # by numbers: a step of a scene asks for one state, for which arrays take ten times as long
    half = 0.5 * speed
    a, b = vx + half * y, vy - half * x
    w = hypot(a, b)
    if w <= rest or w == 0.0:
        by_rate, by_place = damping_at_rest(x, y), np.zeros((2, 2))
    else:
        c, s = a / w, b / w
        u, v = x * c + y * s, y * c - x * s
        beta = 0.5 * pi + atan(u / sqrt(1.0 - u * u - v * v))
        along, across, *slopes = _integrals(u, v, beta)
        (p, q), (m, n) = slopes[:2], slopes[2:]
        turn = np.array([[c, -s], [s, c]])
        middle = [[along, p * v - q * u - across], [across, m * v - n * u + along]]
        by_rate, by_place = turn @ np.array([middle, [[w * p, w * q], [w * m, w * n]]]) @ turn.T
    swirl = half * np.column_stack([-by_rate[:, 1], by_rate[:, 0]])
    return np.hstack([by_place + swirl, by_rate])


def film_along(
    motion: np.ndarray, speed: float, rest: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Return forces (1) (t, 2) and :func:`film_tangent` (t, 2, 4) along a motion (t, 4)."""
    x, y, vx, vy = motion.T
    half = 0.5 * speed
    a, b = vx + half * y, vy - half * x
    w = np.hypot(a, b)
    moves = w > rest
    size = np.where(moves, w, 1.0)
    turn = np.array([[a, -b], [b, a]]).transpose(2, 0, 1) / size[:, None, None]
    u, v = np.einsum("ti,tij->jt", motion[:, :2], turn)
    beta = 0.5 * pi + np.arctan(u / np.sqrt(1.0 - u * u - v * v))
    along, across, *slopes = _integrals(u, v, beta)
    values = np.stack([along, across], axis=-1)
    slopes = np.array(slopes).T.reshape(-1, 2, 2)
    by_angle = slopes @ np.stack([v, -u], -1)[..., None] + np.stack([-across, along], -1)[..., None]
    back = turn.transpose(0, 2, 1)
    by_rate = turn @ np.concatenate([values[..., None], by_angle], axis=-1) @ back
    by_place = w[:, None, None] * turn @ slopes @ back
    force = -w[:, None] * (turn @ values[..., None])[..., 0]
    for still in np.flatnonzero(~moves):
        by_rate[still], by_place[still] = damping_at_rest(x[still], y[still]), 0.0
    swirl = by_rate @ np.array([[0.0, half], [-half, 0.0]])
    return force, np.concatenate([by_place + swirl, by_rate], axis=-1)


def damping_at_rest(x: float, y: float) -> np.ndarray:
    """Return the damping (3) over ``μ R L³/c³``, for a place over the clearance, shape (2, 2)."""
    s2 = 1.0 - x * x - y * y
    place = np.array([x, y])
    return 0.5 * pi * (s2 * np.eye(2) + 3.0 * np.outer(place, place)) / s2**2.5


def _integrals(u: Numbers, v: Numbers, beta: Numbers) -> tuple[Numbers, ...]:
    """Return I_cc and I_cs of (1), and the derivatives by u and v of the first and the second.

    `beta` is the angle ``π/2 + arctan(u/√(1 − u² − v²))``.
    """
    s2, t2 = 1.0 - u * u - v * v, 1.0 - v * v
    s = s2**0.5
    s4, s5, s6, s7 = s2**2, s2**2 * s, s2**3, s2**3 * s
    by_v = u * v / (s * t2)  # of beta; by u it is 1/s
    along = 3.0 * u / s4 + beta * (s2 + 3.0 * u * u) / s5
    across = 2.0 / s4 + u * u / (t2 * s4) + 3.0 * beta * u / s5  # over v
    along_u = 4.0 / s4 + 15.0 * u * u / s6 + 3.0 * beta * u * (3.0 * s2 + 5.0 * u * u) / s7
    along_v = 12.0 * u * v / s6 + by_v * (s2 + 3.0 * u * u) / s5
    along_v += 3.0 * beta * v * (s2 + 5.0 * u * u) / s7
    across_u = 11.0 * u / s6 + 2.0 * u / (t2 * s4) + 4.0 * u**3 / (t2 * s6)
    across_u += 3.0 * beta * (s2 + 5.0 * u * u) / s7
    across_v = 8.0 * v / s6 + 4.0 * u * u * v / (t2 * s6) + 2.0 * u * u * v / (t2**2 * s4)
    across_v += 3.0 * u * by_v / s5 + 15.0 * beta * u * v / s7
    return along, v * across, along_u, along_v, v * across_u, across + v * across_v


@dataclass(frozen=True, eq=False, kw_only=True)
class ShortFilmBearing(Bearing):
    """A bearing that has a short film around its journal.

    Attributes
    ----------
    radius, length : float
        Of the film [m].
    clearance : float
        Radial clearance [m].
    viscosity : float
        Dynamic viscosity of the oil [Pa s].
    """

    radius: float
    length: float
    clearance: float
    viscosity: float

    def __post_init__(self) -> None:
        super().__post_init__()
        units = {"radius": "m", "length": "m", "clearance": "m", "viscosity": "Pa s"}
        checks.keep_numbers(self, units, above=0.0)
        if self.clearance >= self.radius:
            raise ValueError(
                "clearance: needs the radial clearance, far below the radius of "
                f"{self.radius:g} m, got {self.clearance:g} m"
            )

    @property
    def _size(self) -> float:
        """``μ R L³/c²`` [N s], before rates that are relative to the clearance."""
        return self.viscosity * self.radius * self.length**3 / self.clearance**2

    def _reach(self, direction: np.ndarray) -> float:
        return THINNEST * self.clearance

    def _gap(self, direction: np.ndarray | None = None) -> float:
        return self.clearance

    def _checked_film(
        self, displacement: ArrayLike, velocity: ArrayLike, speed: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return a displacement [m] and the force of the film there [N]; refuse bad input."""
        place = checks.vector(displacement, "displacement", "m", size=2)
        rate = checks.vector(velocity, "velocity", "m/s", size=2)
        checks.number(speed, "speed", "rad/s")
        c = self.clearance
        if hypot(*place) >= c:
            raise ValueError(
                f"displacement: needs less than the clearance of {c:g} m, got "
                f"{hypot(*place):g} m: the journal would touch"
            )
        return place, self._size * np.array(film_force(*(place / c), *(rate / c), speed))

    def _film(self, x: float, y: float, vx: float, vy: float, speed: float) -> tuple[float, float]:
        """Return the force of the film [N]; one thinner than c/100 goes on by its tangent."""
        c, size = self.clearance, self._size
        x, y, vx, vy = x / c, y / c, vx / c, vy / c
        if hypot(x, y) <= THINNEST:
            fx, fy = film_force(x, y, vx, vy, speed)
        else:
            fx, fy = by_tangent(lambda a, b: film_force(a, b, vx, vy, speed), x, y, THINNEST, _STEP)
        return size * fx, size * fy

    @property
    def _film_turns(self) -> bool:
        """Whether the film turns with the journal, as that of a damper does not."""
        return True

    def _along(
        self, motion: np.ndarray, angles: np.ndarray, speed: float
    ) -> tuple[np.ndarray, np.ndarray]:
        relative = motion / self.clearance
        e = np.hypot(*relative[:, :2].T)
        out = np.flatnonzero(e > THINNEST)
        whirl, rest = speed if self._film_turns else 0.0, _REST * abs(speed)
        if len(motion) == 1 and not out.size:
            state = relative[0].tolist()
            force = self._size * np.array([film_force(*state, whirl)])
            return force, self._size / self.clearance * film_tangent(*state, whirl, rest)[None]
        normal = relative[out, :2] / e[out, None]
        relative[out, :2] = THINNEST * normal
        force, slopes = film_along(relative, whirl, rest)
        if out.size:  # by the tangent of the last step inside, as :func:`by_tangent`
            inner = np.hstack([(THINNEST - _STEP) * normal, relative[out, 2:]])
            ends = film_along(inner, whirl, rest)
            rise, steeper = force[out] - ends[0], slopes[out] - ends[1]
            steps = ((e[out] - THINNEST) / _STEP)[:, None]
            force[out] += steps * rise
            n, t = normal[:, :, None], (normal[:, ::-1] * [-1.0, 1.0])[:, :, None]
            edge = THINNEST * slopes[out, :, :2]
            around = edge + steps[..., None] * (
                THINNEST * steeper[..., :2] + _STEP * ends[1][..., :2]
            )
            across = around @ t @ (t / e[out, None, None]).swapaxes(1, 2)
            slopes[out, :, :2] = across - rise[:, :, None] / _STEP @ n.swapaxes(1, 2)
            slopes[out, :, 2:] += steps[..., None] * steeper[..., 2:]
        return self._size * force, self._size / self.clearance * slopes
