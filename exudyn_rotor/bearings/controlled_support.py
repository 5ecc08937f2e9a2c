"""Linear supports with coordinates of their own: active bearings and pads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from exudyn_rotor.bearings.support import Coefficient


@dataclass(frozen=True, eq=False)
class ControlledSupport:
    """Linear equations of a support and coordinates of its own, ``M p̈ + D ṗ + K p = 0``.

    The ports p are the displacement where it acts along (n1, n2), which stand still, that where its
    sensors are, if it has any, and its own coordinates, which alone have inertia: of a controller
    pairs along (n1, n2); of pads the motion s of each bore along the tangent t at the pivot, whose
    film acts on ``x − s t``.

    Attributes
    ----------
    interface : str
        Where it acts.
    masses : ndarray, shape (p,)
        Of own coordinates: of a pad its inertia about the pivot over the square of the radius [kg].
    matrices : callable
        Stiffness and damping of the ports by the spin speed [rad/s]; a ValueError where the journal
        has no equilibrium.
    static_stiffness : Coefficient
        Of all, the own coordinates eliminated, slowly and without an integral, of pads in the
        whirl: with it critical speeds are found [N/m].
    sensor : str or None
        Interface at which a controller measures; None of pads.
    """

    interface: str
    masses: np.ndarray
    matrices: Callable[[float], tuple[np.ndarray, np.ndarray]]
    static_stiffness: Coefficient
    sensor: str | None = None

    @property
    def size(self) -> int:
        """Number of own coordinates."""
        return len(self.masses)

    @property
    def word(self) -> str:
        """What it is, for labels."""
        return "pads" if self.sensor is None else "controller"
