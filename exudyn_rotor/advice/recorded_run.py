"""What is read of a recorded run: motion and energy of a rotor, and the loads on it.

The loads are what its equations leave over, ``f = M q̈ − Q(q, q̇)``. Forces and moments F at the
places where something acts (`load_places`) follow from them by ``Uᵀ F = f`` with the motion U of
these places, in the sense of least squares.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.rotor.connections import load_places
from exudyn_rotor.multibody.rotor.rotor_body import Record, RotorBody
from exudyn_rotor.reduction.reduced_rotor import ModeKind, ReducedRotor
from exudyn_rotor.theory.axis import skew
from exudyn_rotor.theory.invariants import Invariants

_MOST = 400  # instants of a run whose loads are looked at
_SEEN = 1e-3  # singular values below this share of the largest tell nothing about loads


@dataclass(frozen=True, eq=False)
class RecordedRun:
    """What the rows of a check read of a run."""

    body: RotorBody | FullRotorBody
    record: Record
    reduced: ReducedRotor | None = None  # knows the yield stress
    proposed: float | None = None  # highest speed of a proposal [rad/s]

    @property
    def invariants(self) -> Invariants:
        """Invariants in the basis of the run."""
        return self.body.motion.invariants

    @property
    def step(self) -> float | None:
        """Step [s] of the last dynamic solution; None before one, or of an explicit one."""
        settings = self.body.mbs.sys.get("simulationSettings")
        solver = self.body.mbs.sys.get("dynamicSolver")
        if settings is None or solver is None or "Explicit" in type(solver).__name__:
            return None
        integration = settings.timeIntegration
        return (integration.endTime - integration.startTime) / integration.numberOfSteps

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

    @cached_property
    def instants(self) -> np.ndarray:
        """Instants whose loads are looked at, evenly; the first of a run has no accelerations."""
        return np.unique(np.linspace(1, len(self.record.time) - 1, _MOST).astype(int))

    @cached_property
    def loads(self) -> np.ndarray | None:
        """Forces and moments about the interfaces' references at `instants`, mesh axes, (p, 6, s).

        Without the weight. Loads elsewhere do not count. None where the scene knows no interfaces,
        or nothing was recorded.
        """
        body, interfaces = self.body, self.body.selection.source.interfaces
        if not interfaces or len(self.record.time) < 2:
            return None
        names, total = list(interfaces), np.zeros((len(interfaces), 6, len(self.instants)))
        places = load_places(body)
        if not places:
            return total
        inv, e = self.invariants, self.invariants.direction
        # the size makes forces and moments comparable
        units = np.tile(np.repeat([1.0, self.size], 3), len(places))
        free = {0: np.zeros((3, 3)), 2: np.eye(3) - np.outer(e, e), 3: np.eye(3)}
        frame = free[body.formulation.translation_count] @ np.tile(np.eye(3, 6), len(places))
        motions = np.vstack([place.motion for place in places])
        equations = np.vstack([motions.T, frame / np.sqrt(inv.mass)])
        acting = np.column_stack([self._without_weight(index) for index in self.instants])
        found = units[:, None] * (np.linalg.pinv(equations * units, rcond=_SEEN) @ acting)
        for place, values in zip(places, np.split(found, len(places)), strict=True):
            if place.interface is not None:
                row = total[names.index(place.interface)]
                row += values
                row[3:] += skew(place.point - interfaces[place.interface].reference) @ values[:3]
        return total

    def _without_weight(self, index: int) -> np.ndarray:
        """Return loads on the modes and, over √m and in rotor axes, on the frame (m + 3,)."""
        body, record, inv = self.body, self.record, self.invariants
        motion, t, weight = body.motion, float(record.time[index]), np.zeros(3)
        q, q_t, q_tt = (
            rows[index][body.layout.unknowns] for rows in (record.q, record.q_t, record.q_tt)
        )
        external = motion.mass_matrix(t, q) @ q_tt - motion.forces(t, q, q_t)
        if body.gravity_load is not None:
            gravity = body.mbs.GetLoadParameter(body.gravity_load, "loadVector")
            weight = inv.mass * np.asarray(gravity)
        turn, N = motion.at(t, q, q_t).A, motion.free_directions
        on_modes = external[motion.modes] - inv.S.T @ turn.T @ weight / inv.mass
        on_frame = turn.T @ N @ (external[motion.translations] - N.T @ weight)
        return np.concatenate([on_modes, on_frame / np.sqrt(inv.mass)])


def squares(matrix, rows: np.ndarray) -> np.ndarray:
    """Return ``uᵀ X u`` of rows (s, n), shape (s,)."""
    return np.einsum("si,is->s", rows, matrix @ rows.T)
