"""A recorded run in modal coordinates, with sizes and energies of its motion."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.rotor.record import Record
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.reduction.fields import ModeKind
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.theory.invariants import Invariants


@dataclass(frozen=True, eq=False)
class RecordedRun:
    """What the rows of a check read of a run.

    Attributes
    ----------
    body : RotorBody or FullRotorBody
    record : Record
    reduced : ReducedRotor, optional
        Knows the yield stress.
    """

    body: RotorBody | FullRotorBody
    record: Record
    reduced: ReducedRotor | None = None

    @property
    def invariants(self) -> Invariants:
        """Invariants in the basis of the run."""
        return self.body.motion.invariants

    @cached_property
    def flexible(self) -> np.ndarray:
        """Which modal coordinates are flexible modes, ascending in frequency."""
        stiff = np.diag(self.invariants.K) > 0.0
        elastic = [kind is ModeKind.ELASTIC for kind in self.body.selection.kinds]
        return np.flatnonzero(stiff & elastic)

    @cached_property
    def size(self) -> float:
        """Radius of gyration of the whole rotor [m]."""
        inv = self.invariants.moved(self.invariants.center)
        return float(np.sqrt(np.trace(inv.J) / inv.mass))

    def unknowns(self, rows: np.ndarray) -> np.ndarray:
        """Return the unknowns of the equations out of recorded coordinates (s, n)."""
        return rows[:, self.body.layout.unknowns]

    @cached_property
    def zeta(self) -> np.ndarray:
        """Modal coordinates (s, m); of a full body the displacements of all nodes."""
        return self.unknowns(self.record.q)[:, self.body.motion.modes]

    @cached_property
    def zeta_t(self) -> np.ndarray:
        """Modal velocities (s, m)."""
        return self.unknowns(self.record.q_t)[:, self.body.motion.modes]

    @cached_property
    def fastest(self) -> float:
        """Highest spin speed, either way round [rad/s]."""
        return float(np.abs(self.record.speed).max())

    @cached_property
    def mean_rotation(self) -> np.ndarray:
        """Rotation vector of the rotor in the mean (s, 3) [rad]."""
        return self.zeta @ self.invariants.mean_rotation.T

    @cached_property
    def mean_translation(self) -> np.ndarray:
        """Displacement of the centre of mass in the frame (s, 3) [m]."""
        return self.zeta @ self.invariants.S.T / self.invariants.mass

    @cached_property
    def energy(self) -> float:
        """Largest elastic and largest kinetic energy of the vibration, together [J]."""
        inv, omega = self.invariants, self.record.speed
        modes = self.flexible
        elastic = 0.5 * self.zeta[:, modes] ** 2 @ np.diag(inv.K)[modes]
        # inertial velocity of the deviation from rigid rotation: ζ̇ + ω ẽ ζ
        kinetic = 0.5 * squares(inv.M, self.zeta_t) + 0.5 * omega**2 * squares(inv.C, self.zeta)
        kinetic += omega * np.einsum("si,ij,sj->s", self.zeta_t, inv.G, self.zeta)
        frame = self.unknowns(self.record.q_t)[:, self.body.motion.translations]
        kinetic += 0.5 * inv.mass * ((frame - frame.mean(axis=0)) ** 2).sum(axis=1)
        return float(elastic.max(initial=0.0) + kinetic.max(initial=0.0))

    @cached_property
    def stretch(self) -> np.ndarray:
        """Static centrifugal deformation (s, m), about which the rotor vibrates."""
        inv, modes = self.invariants, self.flexible
        shape = np.zeros(inv.size)
        shape[modes] = inv.h[modes] / np.diag(inv.K)[modes]
        return self.record.speed[:, None] ** 2 * shape


def squares(matrix, rows: np.ndarray) -> np.ndarray:
    """Return ``uᵀ X u`` of rows (s, n), shape (s,)."""
    return np.einsum("si,is->s", rows, matrix @ rows.T)
