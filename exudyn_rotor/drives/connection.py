"""What connects the interfaces of two rotors: forces by their motion, without a scene."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import NamedTuple

import numpy as np

ABOUT_AXIS = 5  # row of the first interface's rotation about e


class Springs(NamedTuple):
    """Springs and dampers of a connection at a motion.

    Deformations ξ (m,), their derivatives B (m, 12) by the motion, stiffnesses k and damping
    coefficients d, (m,) or one for all, and the derivative k′ of each stiffness by row
    `ABOUT_AXIS`.
    """

    xi: np.ndarray
    B: np.ndarray
    k: np.ndarray | float
    d: np.ndarray | float
    slope: float = 0.0


class Connection(ABC):
    """Forces between two interfaces by their mean motion.

    A motion x has twelve rows: of the first interface the displacement along (n1, n2, e) [m] and
    the rotation about them [rad], then the same of the second, all in the axes
    :attr:`SpinAxis.plane` of the first rotor, which stand still. The rotations about e are spin and
    twist together, without bound. Forces [N] and moments [N m] have the same rows. Scenes ask in
    every step: arrays x and ẋ (12,) are not checked.
    """

    @property
    def mean_speed_ratio(self) -> float:
        """Speed of the second rotor over that of the first, about the axis of the first."""
        return 1.0

    @abstractmethod
    def springs(self, x: np.ndarray, x_t: np.ndarray) -> Springs:
        """Return the springs and dampers at a motion."""

    @abstractmethod
    def transmitted(self, x: np.ndarray, x_t: np.ndarray) -> float:
        """Return what is transmitted: force of a mesh [N], torque on the second rotor [N m]."""

    @abstractmethod
    def check_places(self, apart: np.ndarray, axis: np.ndarray) -> None:
        """Refuse a second rotor that is mounted otherwise than needed.

        By its place from the first one [m] and its axis, each (3,), in axes of the first rotor.
        """

    def forces(self, x: np.ndarray, x_t: np.ndarray) -> np.ndarray:
        """Return forces and moments on both interfaces, shape (12,)."""
        xi, B, k, d, slope = self.springs(x, x_t)
        total = -B.T @ (k * xi + d * (B @ x_t))
        total[ABOUT_AXIS] -= 0.5 * slope * (xi @ xi)  # by which energy is conserved
        return total

    def tangent(self, x: np.ndarray, x_t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return −∂f/∂x and −∂f/∂ẋ for Newton's method but for how B and k vary, each (12, 12)."""
        _, B, k, d, _ = self.springs(x, x_t)
        return B.T * k @ B, B.T * d @ B

    def energy(self, x: np.ndarray) -> float:
        """Return the elastic energy [J]."""
        xi, _, k, *_ = self.springs(x, 0.0 * x)
        return float(0.5 * (k * xi) @ xi)

    def loss(self, x: np.ndarray, x_t: np.ndarray) -> float:
        """Return the power lost by damping [W]."""
        _, B, _, d, _ = self.springs(x, x_t)
        rate = B @ x_t
        return float((d * rate) @ rate)
