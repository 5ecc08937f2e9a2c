"""What connects the interfaces of two rotors: forces by their motion, without a scene."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np


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
    def forces(self, x: np.ndarray, x_t: np.ndarray) -> np.ndarray:
        """Return forces and moments on both interfaces, shape (12,)."""

    @abstractmethod
    def tangent(self, x: np.ndarray, x_t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return −∂f/∂x and −∂f/∂ẋ for Newton's method, each (12, 12)."""

    @abstractmethod
    def transmitted(self, x: np.ndarray, x_t: np.ndarray) -> float:
        """Return what is transmitted: force of a mesh [N], torque on the second rotor [N m]."""

    @abstractmethod
    def energy(self, x: np.ndarray) -> float:
        """Return the elastic energy [J]."""

    @abstractmethod
    def loss(self, x: np.ndarray, x_t: np.ndarray) -> float:
        """Return the power lost by damping [W]."""

    @abstractmethod
    def check_places(self, apart: np.ndarray, axis: np.ndarray) -> None:
        """Refuse a second rotor that is mounted otherwise than needed.

        By its place from the first one [m] and its axis, each (3,), in axes of the first rotor.
        """
