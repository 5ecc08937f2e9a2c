"""Linear supports with coordinates of their own: active bearings and pads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from exudyn_rotor.bearings.support import Coefficient


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
    def masses(self) -> np.ndarray:
        """Inertia of every own coordinate, shape (2b,) [kg]."""
        return np.repeat(self.inertia, 2)


@dataclass(frozen=True, eq=False)
class PadSupport:
    """Films of pads that tilt about pivots, with the pads' tilts as own coordinates, which stand.

    A pad's coordinate s is the motion of its bore along the tangent at the pivot; its film acts on
    ``x − s t``, as a support between the journal and what moves by ``s t``.

    Attributes
    ----------
    interface : str
        The journal.
    masses : ndarray, shape (p,)
        Of every pad, its inertia about the pivot over the square of the radius [kg].
    matrices : callable
        Stiffness and damping (3 + p, 3 + p) between the journal, along (n1, n2, e), and the pads,
        by the spin speed [rad/s]; a ValueError where the journal has no equilibrium.
    static_stiffness : Coefficient
        Of all in the whirl, the tilts eliminated, with which critical speeds are found [N/m].
    """

    interface: str
    masses: np.ndarray
    matrices: Callable[[float], tuple[np.ndarray, np.ndarray]]
    static_stiffness: Coefficient

    @property
    def size(self) -> int:
        """Number of own coordinates."""
        return len(self.masses)


Controlled = ControlledSupport | PadSupport  # and SeriesSupport
