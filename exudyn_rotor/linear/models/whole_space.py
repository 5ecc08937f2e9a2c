"""Solutions of dense equations in all their coordinates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Protocol

import numpy as np

from exudyn_rotor.linear.periodic.exponents import motions
from exudyn_rotor.linear.periodic.floquet_modes import (
    FloquetModes,
    constant_modes,
    floquet_modes,
)
from exudyn_rotor.linear.periodic.harmonic_balance import forced_motion
from exudyn_rotor.linear.periodic.periodic_system import ConstantSystems, PeriodicSystem


class Equations(Protocol):
    """Dense equations at any spin speed."""

    def at(self, speed: float) -> PeriodicSystem:
        """Return the equations at a spin speed [rad/s]."""

    def constant_at(self, speeds: Sequence[float]) -> ConstantSystems | None:
        """Return the equations at spin speeds [rad/s]; None where they change in time."""


@dataclass(frozen=True, eq=False)
class WholeSpace:
    """All coordinates of a model with dense equations; see :class:`Space`.

    Attributes
    ----------
    equations : Equations
    can_be_sent : bool
        Whether other processes can take the equations as they are; those of a scene they cannot.
    driven : tuple of int
        Coordinates whose constant part a drive keeps at zero: a spin that nothing holds.
    others : ndarray, shape (k, k − 1), optional
        Motions without a spin that is no coordinate.
    """

    equations: Equations
    can_be_sent: bool
    driven: tuple[int, ...] = ()
    others: np.ndarray | None = None
    basis: ClassVar[None] = None
    is_shared: ClassVar[bool] = False

    def at(self, speed: float) -> PeriodicSystem:
        """Return the equations at a spin speed [rad/s]."""
        system = self.equations.at(speed)
        return system if self.others is None else system.projected(self.others)

    def prepared(self, speeds: Sequence[float]) -> WholeSpace:
        """Return what can be sent to other processes; equations for one speed are made here."""
        if self.can_be_sent and len(speeds) > 1:
            return self
        systems = {float(speed): self.equations.at(float(speed)) for speed in speeds}
        return replace(self, equations=_Tabulated(systems), can_be_sent=True)

    def modes(self, speed: float, tolerance: float) -> FloquetModes:
        """Return all modes."""
        return floquet_modes(self.at(speed), tolerance=tolerance)

    def constant_modes(self, speeds: Sequence[float]) -> list[FloquetModes] | None:
        """Return all modes at all speeds at once, which is faster; None where they are periodic."""
        if self.others is None:
            systems = self.equations.constant_at(speeds)
        else:
            systems = ConstantSystems.of(map(self.at, speeds))
        return None if systems is None or len(systems.M) > 1 else constant_modes(systems)

    def motions(
        self, speed: float, method: str, tolerance: float, shapes: bool = True
    ) -> tuple[FloquetModes, PeriodicSystem]:
        """Return all exponents with their motions, and the equations."""
        system = self.at(speed)
        modes = motions(system, method, tolerance, shapes)
        if self.others is not None:
            modes = replace(modes, vectors=self.others @ modes.vectors)
        return modes, system

    def steady_motion(
        self, speed: float, loads: Mapping[int, np.ndarray], rate: float, tolerance: float
    ) -> dict[int, np.ndarray]:
        """Return the harmonics of the steady motion under harmonics of a load."""
        return forced_motion(self.at(speed), loads, rate, tolerance, self.driven)

    def holds(self, motions: Sequence[tuple[float, FloquetModes]]) -> bool:
        """Return True: nothing is left out."""
        return True


class InAllCoordinates:
    """Base of models that are solved in all coordinates."""

    def constant_at(self, speeds: Sequence[float]) -> ConstantSystems | None:
        """Return the equations at spin speeds [rad/s]; None where they change in time."""
        return ConstantSystems.of(map(self.at, speeds))

    def space(
        self,
        count: int,
        fastest: float,
        *,
        loads: Sequence[np.ndarray] = (),
        held: bool = False,
        residual: float = 1e-7,
    ) -> WholeSpace:
        """Return where to solve the equations: in all coordinates, whatever is asked for."""
        return self.whole_space(held)

    def whole_space(self, held: bool) -> WholeSpace:
        """Return all coordinates, `held` without a spin that nothing holds; for one process."""
        return WholeSpace(self, can_be_sent=False)


@dataclass(frozen=True, eq=False)
class _Tabulated:
    """Equations at the speeds needed."""

    systems: Mapping[float, PeriodicSystem]

    def at(self, speed: float) -> PeriodicSystem:
        return self.systems[float(speed)]

    def constant_at(self, speeds: Sequence[float]) -> ConstantSystems | None:
        return ConstantSystems.of(map(self.at, speeds))
