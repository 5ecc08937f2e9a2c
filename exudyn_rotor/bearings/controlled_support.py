"""A linear support with coordinates of its own: what an active bearing is in linear analyses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class ControlledSupport:
    """Linear equations between a rotor and a controller, ``M p̈ + D ṗ + K p = 0``.

    The ports p are pairs along (n1, n2), which stand still: the displacement where the bearing
    acts, that where its sensors are, and the b pairs of its own coordinates, which alone have
    inertia.

    Attributes
    ----------
    interface, sensor : str
        Where it acts and where it measures.
    inertia : ndarray, shape (b,)
        Of each pair of own coordinates [kg].
    damping, stiffness : ndarray, shape (2p, 2p), p = 2 + b
        [N s/m], [N/m]
    static_stiffness : ndarray, shape (2, 2)
        Of the bearing without its integral, slowly, as if the sensors were where it acts [N/m].
    """

    interface: str
    sensor: str
    inertia: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    static_stiffness: np.ndarray

    @property
    def size(self) -> int:
        """Number of own coordinates."""
        return 2 * len(self.inertia)

    @property
    def direct_stiffness(self) -> np.ndarray:
        """Stiffness that acts without the controller, shape (2, 2) [N/m]."""
        return self.stiffness[:2, :2]
