"""What connects the interfaces of two rotors: forces by their motion, without a scene."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks


class Law(NamedTuple):
    """The functions of a connection by motion x and rate ẋ, unchecked, for every time step.

    `forces` (12,), `tangent`: −∂f/∂x and −∂f/∂ẋ for Newton's method, `transmitted` load,
    `energy` that is stored (of x alone), `loss` of power by damping. `check_places` refuses rotors
    that are mounted otherwise than needed, by the second's place from the first and its axis;
    `second_axis` is the axis that it needs, where the second is a shaft.
    """

    forces: Callable[[np.ndarray, np.ndarray], np.ndarray]
    tangent: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]
    transmitted: Callable[[np.ndarray, np.ndarray], float]
    energy: Callable[[np.ndarray], float]
    loss: Callable[[np.ndarray, np.ndarray], float]
    check_places: Callable[[np.ndarray, np.ndarray], None]
    second_axis: np.ndarray


class Connection(ABC):
    """Forces between two interfaces by their mean motion.

    A motion x has twelve rows: of the first interface the displacement along (n1, n2, e) [m] and
    the rotation about them [rad], then the same of the second, all in the axes
    :attr:`SpinAxis.plane` of the first rotor, which stand still. The rotations about e are spin and
    twist together, without bound. Forces [N] and moments [N m] have the same rows.
    """

    @property
    def law(self) -> Law:
        """For scenes: forces, tangent, transmitted load, energy and loss, unchecked."""
        return Law(
            self._forces,
            self._tangent,
            self._transmitted,
            self._energy,
            self._loss,
            self._check_places,
            self.second_axis,
        )

    def forces(self, motion: ArrayLike, rate: ArrayLike) -> np.ndarray:
        """Return forces and moments on both interfaces, shape (12,).

        Parameters
        ----------
        motion, rate : array_like, shape (12,)
            Displacements [m] and rotations [rad] in the rows of this class, and their rates.

        Raises
        ------
        TypeError, ValueError
            For bad input.
        """
        return self._forces(*_checked(motion, rate))

    def transmitted(self, motion: ArrayLike, rate: ArrayLike) -> float:
        """Return what is transmitted: force of a mesh [N], torque on the second rotor [N m].

        Parameters
        ----------
        motion, rate : array_like, shape (12,)
            As for `forces`.

        Raises
        ------
        TypeError, ValueError
            For bad input.
        """
        return self._transmitted(*_checked(motion, rate))

    @property
    def second_axis(self) -> np.ndarray:
        """Axis of the second rotor, shape (3,), in the axes (n1, n2, e) of the first."""
        return np.array([0.0, 0.0, 1.0])

    @property
    def mean_speed_ratio(self) -> float:
        """Speed of the second rotor, about :attr:`second_axis`, over that of the first."""
        return 1.0

    @abstractmethod
    def _forces(self, x: np.ndarray, x_t: np.ndarray) -> np.ndarray: ...

    @abstractmethod
    def _tangent(self, x: np.ndarray, x_t: np.ndarray) -> tuple[np.ndarray, np.ndarray]: ...

    @abstractmethod
    def _transmitted(self, x: np.ndarray, x_t: np.ndarray) -> float: ...

    @abstractmethod
    def _energy(self, x: np.ndarray) -> float: ...

    @abstractmethod
    def _loss(self, x: np.ndarray, x_t: np.ndarray) -> float: ...

    @abstractmethod
    def _check_places(self, apart: np.ndarray, axis: np.ndarray) -> None: ...


def _checked(motion: ArrayLike, rate: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    return checks.vector(motion, "motion", size=12), checks.vector(rate, "rate", size=12)
