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
from typing import ClassVar

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import Bearing, Force, Numbers, Pair, check_clearance, turned

_REST = 1e-6  # of Ω: the rate w of a journal at rest
THINNEST = 1.0 - 0.01  # of the clearance: beyond, a film goes on by its tangent


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
    x: Numbers, y: Numbers, vx: Numbers, vy: Numbers, speed: float, rest: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Return force (1), (…, 2), and minus its derivatives (2) by place and velocity, (…, 2, 4).

    By numbers, or by arrays of one shape. Up to the rate `rest` of w the derivatives are those of
    small motions, (3).
    """
    half = 0.5 * speed
    a, b = vx + half * y, vy - half * x
    if isinstance(a, float):  # a step of a scene asks for one state: numbers are faster
        w = hypot(a, b)
        moves = w > max(rest, 0.0)
        c, s = (a / w, b / w) if moves else (1.0, 0.0)
        u, v = x * c + y * s, y * c - x * s
        beta = 0.5 * pi + atan(u / sqrt(1.0 - u * u - v * v))
    else:
        w = np.hypot(a, b)
        moves = w > max(rest, 0.0)
        size = np.where(moves, w, 1.0)
        c, s = np.where(moves, a / size, 1.0), np.where(moves, b / size, 0.0)
        u, v = x * c + y * s, y * c - x * s
        beta = 0.5 * pi + np.arctan(u / np.sqrt(1.0 - u * u - v * v))
    along, across, p, q, m, n = _integrals(u, v, beta)
    force = _in_axes([-w * (along * c - across * s), -w * (along * s + across * c)])
    by_rate = turned(c, s, along, p * v - q * u - across, across, m * v - n * u + along)
    by_place = turned(c, s, w * p, w * q, w * m, w * n)
    if not np.all(moves):
        still = damping_at_rest(x, y)
        by_rate = [np.where(moves, one, other) for one, other in zip(by_rate, still, strict=True)]
        by_place = [np.where(moves, one, 0.0) for one in by_place]
    (a, b, c, d), (e, f, g, h) = by_rate, by_place
    found = _in_axes([e - half * b, f + half * a, a, b, g - half * d, h + half * c, c, d])
    return force, found.reshape(*found.shape[:-1], 2, 4)


def _in_axes(numbers: list[Numbers]) -> np.ndarray:
    return np.array(numbers) if isinstance(numbers[0], float) else np.stack(numbers, axis=-1)


def damping_at_rest(x: Numbers, y: Numbers) -> list[Numbers]:
    """Return the entries of (3) over ``μ R L³/c³``, for a place over the clearance, row by row."""
    s2 = 1.0 - x * x - y * y
    size = 0.5 * pi / s2**2.5
    beside = 3.0 * size * x * y
    return [size * (s2 + 3.0 * x * x), beside, beside, size * (s2 + 3.0 * y * y)]


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
    """A bearing that has a short film around its journal."""

    _turns: ClassVar[bool] = True  # whether the film turns with the journal
    centring_stiffness: ClassVar[float] = 0.0

    radius: float
    length: float
    clearance: float
    viscosity: float

    def __post_init__(self) -> None:
        super().__post_init__()
        units = {"radius": "m", "length": "m", "clearance": "m", "viscosity": "Pa s"}
        checks.keep_numbers(self, units, above=0.0)
        check_clearance(self.clearance, self.radius)

    @property
    def _size(self) -> float:
        """``μ R L³/c²`` [N s], before rates that are relative to the clearance."""
        return self.viscosity * self.radius * self.length**3 / self.clearance**2

    def film_edge(self, x: float, y: float) -> float:
        """Return where a film is as thin as c/100 [m]."""
        return THINNEST * self.clearance

    def clearance_along(self, direction: np.ndarray | None = None) -> float:
        """Return the clearance [m], which is the same in all directions."""
        return self.clearance

    def law(self, x: float, y: float, vx: float, vy: float, angle: float, speed: float) -> Force:
        """Return the force on the journal [N]; a film thinner than c/100 goes on by its tangent."""
        size, k, c = self._size, self.centring_stiffness, self.clearance
        if hypot(x, y) > THINNEST * c:
            return self._beyond(x, y, vx, vy, angle, speed)
        fx, fy = film_force(x / c, y / c, vx / c, vy / c, speed if self._turns else 0.0)
        return size * fx - k * x, size * fy - k * y

    def slopes(self, x: float, y: float, vx: float, vy: float, angle: float, speed: float) -> Pair:
        """Return less the derivatives (2, 2) of :meth:`law` by place and by velocity."""
        c, whirl = self.clearance, speed if self._turns else 0.0
        if hypot(x, y) > THINNEST * c:
            return super().slopes(x, y, vx, vy, angle, speed)
        found = film_tangent(x / c, y / c, vx / c, vy / c, whirl, _REST * abs(speed))[1]
        found *= self._size / c
        found[[0, 1], [0, 1]] += self.centring_stiffness
        return found[:, :2], found[:, 2:]

    def law_along(self, motion: np.ndarray, angles: np.ndarray, speed: float) -> Pair:
        """Return forces (t, 2) and less their derivatives (t, 2, 4); see :class:`Bearing`."""
        inside = np.hypot(*motion[:, :2].T) <= THINNEST * self.clearance
        if not inside.all():
            return super().law_along(motion, angles, speed)
        whirl = speed if self._turns else 0.0
        force, slopes = film_tangent(*(motion / self.clearance).T, whirl, _REST * abs(speed))
        slopes = self._size / self.clearance * slopes
        slopes[:, :, :2] += self.centring_stiffness * np.eye(2)
        return self._size * force - self.centring_stiffness * motion[:, :2], slopes
