"""A linear support in a scene, where Exudyn has no connector of its own for it."""

from __future__ import annotations

import numpy as np

from exudyn_rotor.bearings.support import Support, acts
from exudyn_rotor.multibody.supports.connector import Connector, Force
from exudyn_rotor.multibody.supports.ends import BaseEnd, RotorEnd
from exudyn_rotor.theory.rotating_axes import axial_rotation, axial_skew


class SupportConnector(Connector):
    """A linear support: stiffness and damping in axes that stand still or turn with the rotor.

    About the axis a spring acts on the twist, a damper that stands still on the whole spin. What
    turns with the rotor is driven there: the reaction of its moments does not act on the spin.
    """

    def __init__(
        self, support: Support, end: RotorEnd, base: BaseEnd | None, on_rotor: bool
    ) -> None:
        super().__init__(end, base)
        self.support, self._turns = support, support.frame == "rotor"
        self.whole = support.tilts
        self._between = on_rotor  # tables are over the difference of both speeds

    @property
    def _motion(self) -> tuple[np.ndarray, np.ndarray]:
        """Motion (6,) and rate (6,) against the base, the spin in the last rate alone."""
        end, base = self.end, self.base
        none = (0.0, 0.0, 0.0)
        x = np.array([*end.place, *(end.tilt or none)])
        x_t = np.array([*end.rate, *(end.tilt_rate or none)])
        if base is not None:
            x -= [*base.place, *base.tilt]
            x_t -= [*base.rate, *base.tilt_rate]
        x_t[5] += end.speed
        return x, x_t

    def _matrices(self) -> tuple[np.ndarray, np.ndarray]:
        end, base = self.end, self.base
        speed = end.speed - base.speed if self._between else end.speed
        self.support.check_range(speed)
        K, D = self.support.matrices(speed)
        if self._turns:
            R = np.kron(np.eye(2), axial_rotation(end.angle))
            K, D = R @ K @ R.T, R @ D @ R.T
        return K, D

    @property
    def has_mass(self) -> bool:
        """Whether a mass goes with the rotor."""
        return acts(self.support.mass)

    def added_mass(self) -> float:
        """Return the mass that goes with the rotor at its speed [kg]."""
        between = self.base.speed if self._between else 0.0
        return float(self.support.mass_matrix(self.end.speed - between)[0, 0])

    def wrench(self, t: float) -> tuple:
        """Return force and moment on the rotor."""
        (K, D), (x, x_t), speed = self._matrices(), self._motion, self.end.speed
        if self._turns:
            x_t = x_t - speed * (axial_skew(6) @ x)
            x_t[5] -= speed
        fx, fy, fz, *moment = (-K @ x - D @ x_t).tolist()
        if not self.whole:
            return fx, fy, fz
        if self._turns and self.end.tilt:
            a, b, _ = self.end.tilt
            moment[2] += b * moment[0] - a * moment[1]
        return fx, fy, fz, moment

    def tangent(self, t: float) -> Force:
        """Return the force, its tangent, and rows (6, size)."""
        K, D = self._matrices()
        if self._turns:
            K = K - self.end.speed * D @ axial_skew(6)
        force = np.zeros(6)
        fx, fy, fz, *moment = self.wrench(t)
        force[:3] = fx, fy, fz
        force[3:] = moment[0] if moment else 0.0
        return Force(force, self.rows(), self.rate_rows(), K, D)
