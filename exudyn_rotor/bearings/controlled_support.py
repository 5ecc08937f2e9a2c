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
    sensors are, if it has any, and its own coordinates, which alone have the inertia `masses`: of a
    controller pairs along (n1, n2); of pads the motion s of each bore along the tangent t at the
    pivot, whose film acts on ``x − s t``. `matrices` returns stiffness and damping of the ports by
    the spin speed; a ValueError says that the journal has no equilibrium. Critical speeds are found
    with the `static_stiffness` of all, the own coordinates eliminated, slowly and without an
    integral, of pads in the whirl. A controller measures at the interface `sensor`.
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
