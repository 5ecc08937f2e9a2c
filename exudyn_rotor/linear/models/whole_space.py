"""Solutions of dense equations in all their coordinates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar, Protocol

import numpy as np

from exudyn_rotor.linear.periodic.exponents import constant_motions, motions
from exudyn_rotor.linear.periodic.floquet_modes import (
    FloquetModes,
    constant_modes,
    floquet_modes,
)
from exudyn_rotor.linear.periodic.harmonic_balance import forced_motions
from exudyn_rotor.linear.periodic.periodic_system import ConstantSystems, PeriodicSystem
from exudyn_rotor.threads import in_turns

_MOST_ENTRIES = 250_000  # of matrices of speeds that are solved at once


class Equations(Protocol):
    """Dense equations at any spin speed."""

    def at(self, speed: float) -> PeriodicSystem:
        """Return the equations at a spin speed [rad/s]."""

    def constant_at(self, speeds: Sequence[float]) -> ConstantSystems | None:
        """Return the equations at spin speeds [rad/s].

        None where they change in time, or have to be made one by one.
        """


@dataclass(frozen=True, eq=False)
class WholeSpace:
    """All coordinates of a model with dense equations; see :class:`Space`.

    Attributes
    ----------
    equations : Equations
    can_be_sent : bool
        Whether other processes can take the equations as they are; those of a scene they cannot.
    driven : tuple of int
        Coordinates whose constant part a drive keeps at zero: a spin that nothing holds. Those of
        `motions_beside_spin`, where given.
    motions_beside_spin : ndarray, shape (k, k), optional
        The free spin and all motions without it, as columns: coordinates for steady motions.
    others : ndarray, shape (k, k − 1), optional
        Motions without a spin that is no coordinate.
    """

    equations: Equations
    can_be_sent: bool
    driven: tuple[int, ...] = ()
    motions_beside_spin: np.ndarray | None = None
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
        systems = self._constant_at(speeds) or ConstantSystems.of(map(self.at, speeds))
        if systems is None or len(systems.M) > 1:
            return None
        return [mode for few in systems.parts(_MOST_ENTRIES) for mode in constant_modes(few)]

    def constant_motions(
        self, speeds: Sequence[float]
    ) -> list[tuple[FloquetModes, PeriodicSystem]] | None:
        """Return all exponents with their motions, and the equations, at all speeds at once.

        None where the equations are periodic, or have to be made one by one.
        """
        systems = self._constant_at(speeds)
        if systems is None or len(systems.M) > 1:
            return None
        found = [mode for few in systems.parts(_MOST_ENTRIES) for mode in constant_motions(few)]
        if self.others is not None:
            found = map(self._whole, found)
        return list(zip(found, map(self.at, speeds), strict=True))

    def _constant_at(self, speeds: Sequence[float]) -> ConstantSystems | None:
        systems = self.equations.constant_at(speeds)
        if systems is None or self.others is None:
            return systems
        return systems.projected(self.others)

    def _whole(self, modes: FloquetModes) -> FloquetModes:
        """Return motions in all coordinates."""
        return replace(modes, vectors=self.others @ modes.vectors)

    def modes_at(self, speeds: Sequence[float], tolerance: float) -> list[FloquetModes]:
        """Return all modes at all speeds at once; periodic ones are shared among threads."""
        modes = self.constant_modes(speeds)
        if modes is not None:
            return modes
        return in_turns(
            partial(floquet_modes, tolerance=tolerance), [self.at(speed) for speed in speeds]
        )

    def motions(
        self, speed: float, method: str, tolerance: float, shapes: bool = True
    ) -> tuple[FloquetModes, PeriodicSystem]:
        """Return all exponents with their motions, and the equations."""
        system = self.at(speed)
        modes = motions(system, method, tolerance, shapes)
        if self.others is not None:
            modes = self._whole(modes)
        return modes, system

    def steady_motion(
        self, speed: float, loads: Mapping[int, np.ndarray], rate: float, tolerance: float
    ) -> dict[int, np.ndarray]:
        """Return the harmonics of the steady motion under harmonics of a load."""
        return self.steady_motions(speed, [loads], rate, tolerance)[0]

    def steady_motions(
        self, speed: float, loads: Sequence[Mapping[int, np.ndarray]], rate: float, tolerance: float
    ) -> list[dict[int, np.ndarray]]:
        """Return the steady motion under each of several loads, with one factor for all."""
        system, driven = self.equations.at(speed), self.driven
        T = self.motions_beside_spin
        if self.others is not None:
            T, driven = self.others, ()
        if T is None:
            return forced_motions(system, loads, rate, tolerance, driven)
        loads = [{n: T.T @ load for n, load in each.items()} for each in loads]
        found = forced_motions(system.projected(T), loads, rate, tolerance, driven)
        return [{n: T @ X for n, X in each.items()} for each in found]

    def holds(self, motions: Sequence[tuple[float, FloquetModes]]) -> bool:
        """Return True: nothing is left out."""
        return True


class InAllCoordinates:
    """Base of models that are solved in all coordinates."""

    @property
    def voids(self) -> np.ndarray:
        """Coordinates of what films remember; none here."""
        return np.zeros(0, dtype=int)

    def constant_at(self, speeds: Sequence[float]) -> ConstantSystems | None:
        """Return None: the equations are made one by one."""
        return None

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

    def constant_at(self, speeds: Sequence[float]) -> None:
        return None
