"""The law of an oil film, answered by its tangent where Exudyn would find that by differences.

A connector with a Python function has no Jacobian function: with a rotor of 7 modes Exudyn asks it
for its force 26 times in a Jacobian, and each time Reynolds' equation is solved. Its linear
equations, once solved, know the tangent, which is the derivative that differences are to give.
"""

from __future__ import annotations

from math import hypot

import numpy as np

from exudyn_rotor.bearings.journal_bearing import FilmLaw
from exudyn_rotor.multibody.supports.differences import Differences

_NEAR = 1e-3  # of the clearance, and of the velocity: steps of differences are smaller


class DifferencedLaw:
    """Law of a film that answers by its tangent where differences are formed.

    The first place of a Jacobian is that about which it forms them. A torque stays what it is
    there; what changes with the speed, or lies further away, is the law's.
    """

    def __init__(self, law: FilmLaw, clearance: float, differences: Differences) -> None:
        self._law, self._clearance, self._differences = law, clearance, differences
        self._formed = 0

    def __call__(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, ...]:
        formed = self._differences.formed
        if not formed:
            return self._law(x, y, vx, vy, angle, speed)
        if formed != self._formed:
            self._begin(x, y, vx, vy, angle, speed)
            self._formed = formed
        x0, y0, vx0, vy0, speed0 = self._motion
        dx, dy, dvx, dvy = x - x0, y - y0, vx - vx0, vy - vy0
        near = abs(dx) + abs(dy) < self._near and abs(dvx) + abs(dvy) < self._slow
        if self._slopes is None or speed != speed0 or not near:
            return self._law(x, y, vx, vy, angle, speed)
        (a, b, c, d), (e, f, g, h) = self._slopes
        fx, fy, *torque = self._values
        fx -= a * dx + b * dy + c * dvx + d * dvy
        fy -= e * dx + f * dy + g * dvx + h * dvy
        return fx, fy, *torque

    def _begin(self, x: float, y: float, vx: float, vy: float, angle: float, speed: float) -> None:
        """Take the tangent at the place about which differences are formed."""
        self._motion = x, y, vx, vy, speed
        self._near = _NEAR * self._clearance
        self._slow = _NEAR * max(self._clearance * abs(speed), hypot(vx, vy))
        self._values = self._law(x, y, vx, vy, angle, speed)
        found = self._law.tangent(x, y)
        self._slopes = None if found is None else np.hstack(found).tolist()
