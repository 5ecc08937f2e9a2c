"""Spurious growth by the mesh of one rotor of a train while the meshes of others are left out.

Rotors of ratio 1 keep what differs around their axis, others count as axisymmetric up to an
unevenness u. That leaves an error of exponents of the order of u². Growth within it that even
rotors do not have is no instability: over the speed of another rotor it would be another one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from scipy.optimize import linear_sum_assignment

from exudyn_rotor.linear.models.whole_space import Equations, WholeSpace
from exudyn_rotor.linear.periodic.exponents import motions
from exudyn_rotor.linear.periodic.floquet_modes import FloquetModes
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, fold


class Train(Protocol):
    """Equations of rotors, of which some are uneven."""

    @property
    def all_even(self) -> tuple[Equations, float]:
        """The equations with rotors of ratio 1 even, and what unevenness is left out of others."""


@dataclass(frozen=True, eq=False, kw_only=True)
class UnevenSpace(WholeSpace):
    """All coordinates of several rotors; growth counts above what is left out.

    Attributes
    ----------
    train : Train
    """

    train: Train

    def motions(
        self, speed: float, method: str, tolerance: float, shapes: bool = True
    ) -> tuple[FloquetModes, PeriodicSystem]:
        """Return all exponents with their motions, and the equations."""
        found, system = super().motions(speed, method, tolerance, shapes)
        growing = found.values.real > found.bounds
        if not np.any(growing):
            return found, system
        equations, left_out = self.train.all_even
        if left_out == 0.0:
            return found, system
        even = equations.at(speed)
        even = even if self.others is None else even.projected(self.others)
        values = motions(even, method, tolerance, False).values
        changes = fold(found.values[:, None] - values, abs(system.base))
        change = np.abs(changes[linear_sum_assignment(np.abs(changes))].real)
        error = left_out**2 * (np.abs(found.values) + abs(speed))
        spurious = np.where(growing, np.minimum(change, error), 0.0)
        return replace(found, bounds=found.bounds + spurious), system
