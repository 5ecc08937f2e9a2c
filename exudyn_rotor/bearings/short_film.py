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

F. W. Ocvirk, NACA TN 2808 (1952); G. Capone, L'Energia Elettrica 68 (1991).
"""

from __future__ import annotations

from math import atan, hypot, pi, sqrt

_THINNEST = 0.01  # of the clearance: a thinner film goes on by its tangent
_STEP = 1e-6  # of the clearance, of that tangent


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


def force_anywhere(x: float, y: float, vx: float, vy: float, speed: float) -> tuple[float, float]:
    """Return the force (1); a film thinner than c/100 goes on by its tangent.

    So Newton's method comes back from beyond the clearance.
    """
    eccentricity, most = hypot(x, y), 1.0 - _THINNEST
    if eccentricity <= most:
        return film_force(x, y, vx, vy, speed)
    ex, ey = x / eccentricity, y / eccentricity
    fx, fy = film_force(most * ex, most * ey, vx, vy, speed)
    inside = most - _STEP
    gx, gy = film_force(inside * ex, inside * ey, vx, vy, speed)
    beyond = (eccentricity - most) / _STEP
    return fx + beyond * (fx - gx), fy + beyond * (fy - gy)
