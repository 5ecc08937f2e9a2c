"""Numbers that say how well the assumptions of a full body's run held."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from exudyn_rotor.advice.run_measures import Measures
from exudyn_rotor.prestress.carrying import with_chosen_prestress
from exudyn_rotor.prestress.estimate import estimated_stiffness
from exudyn_rotor.prestress.static_solution import relief_rotations
from exudyn_rotor.solid.tensor import von_mises
from exudyn_rotor.solvers.inertia_relief import inertia_relief
from exudyn_rotor.theory.invariants import Matrix
from exudyn_rotor.theory.nodal import rotations, translations
from exudyn_rotor.theory.stiffening import relief_factors, tilt_factors


class FullMeasures(Measures):
    """Numbers of one run of a full body, as :class:`Measures`, from displacements of all nodes."""

    @cached_property
    def _rigid(self) -> np.ndarray:
        """Six rigid motions about the centre of mass, (3n, 6)."""
        source = self.body.selection.source
        turns = rotations(source.nodes, source.center_of_mass)
        return np.hstack([translations(source.node_count), turns])

    def _mean(self, fields: np.ndarray) -> np.ndarray:
        """Return mean translation and rotation of fields (3n, s), by mass, (6, s)."""
        weighted = self.invariants.M @ self._rigid
        return np.linalg.solve(self._rigid.T @ weighted, weighted.T @ fields)

    def _bent(self, fields: np.ndarray) -> np.ndarray:
        return fields - self._rigid @ self._mean(fields)

    def tilt(self) -> float:
        """Return the largest rigid tilt out of the axis [rad]."""
        e, rotation = self.invariants.direction, self._mean(self.zeta.T)[3:]
        return float(np.linalg.norm(rotation - np.outer(e, e @ rotation), axis=0).max())

    def deflection(self) -> float:
        """Return the largest root mean square flexible displacement over the rotor's size."""
        squares = _squares(self.invariants.M, self._bent(self.zeta.T))
        return float(np.sqrt(squares.max() / self.invariants.mass) / self.size)

    def adrift(self) -> float:
        """Return how far the centre of mass leaves its place in the frame, over the size."""
        return float(np.linalg.norm(self._mean(self.zeta.T)[:3], axis=0).max() / self.size)

    @cached_property
    def _static(self) -> np.ndarray:
        """Static centrifugal displacement per ω², (3n,)."""
        return inertia_relief(self.body.selection.source).solve(self.body.motion.spin_terms.h)

    @cached_property
    def _stretch(self) -> np.ndarray:
        return np.outer(self.record.speed**2, self._static)

    def strain(self) -> float:
        """Return the mean centrifugal strain ``ω² hᵀK⁻¹h / Θ``."""
        inv = self.invariants
        if inv.Theta == 0.0:
            return 0.0
        return float(self.fastest**2 * (inv.h @ self._static) / inv.Theta)

    @cached_property
    def _energies(self) -> tuple[np.ndarray, float]:
        inv, omega = self.invariants, self.record.speed
        c, rate = self.zeta.T, self.zeta_t.T
        elastic = 0.5 * _squares(inv.K, c)
        kinetic = 0.5 * _squares(inv.M, rate) + 0.5 * omega**2 * _squares(inv.C, c)
        kinetic += omega * np.einsum("is,is->s", rate, inv.G @ c)
        return elastic[:, None], float(elastic.max() + (kinetic + self._drift).max())

    def missing_stiffness(self) -> float:
        """Return the share of the stiffening that is left out, as a relative change of frequency.

        By the geometric stiffness where there are elements, else estimated as for modes.
        """
        if self.body.stiffening == "full":
            return 0.0
        c = (self.zeta - self._stretch).T
        work = self._beyond_tilt(c)
        if self.body.stiffening == "none":
            work += self._by_factors(tilt_factors(self.invariants), c)
        energy = self._energies[1]
        return float(0.25 * np.abs(work * self.record.speed**2).max() / energy) if energy else 0.0

    def _beyond_tilt(self, c: np.ndarray) -> np.ndarray:
        """Return ``cᵀ(K2 − K2_tilt)c`` of fields (3n, s)."""
        source, inv = with_chosen_prestress(self.body.selection.source, None), self.invariants
        carried = source.carried_prestress
        if carried is not None:
            relief = relief_factors(inv, relief_rotations(source)[0])
            work = _squares(carried.per_square, c) + self._by_factors(relief, c)
            return work - self._by_factors(tilt_factors(inv), c)
        # K2_tilt does no work on fields without mean rotation
        network = estimated_stiffness(source)
        return _squares(inv.M if network is None else network, self._bent(c))

    def _by_factors(self, factors: tuple[np.ndarray, np.ndarray], c: np.ndarray) -> np.ndarray:
        """Return ``cᵀVᵀWVc``."""
        V, W = factors
        return _squares(W, V @ c)

    @cached_property
    def frequency(self) -> float:
        """Mean frequency of the coordinates, weighted with mass and amplitudes squared [rad/s]."""
        moved = self._spread(self._q)
        return float(np.sqrt(self._spread(self._q_t) / moved)) if moved else 0.0

    def _spread(self, rows: np.ndarray) -> float:
        """Return the squares of translations and displacements (s, n) about their mean, by mass."""
        about, motion = rows - rows.mean(axis=0), self.body.motion
        lateral = self.invariants.mass * (about[:, motion.translations] ** 2).sum()
        return float(lateral + _squares(self.invariants.M, about[:, motion.modes].T).sum())

    def yielding(self) -> float | None:
        """Return the largest von Mises stress over the yield stress; None where that is unknown."""
        source = self.body.selection.source
        carried, recover = source.carried_prestress, source.stress_recovery
        if carried is None or carried.yield_stress is None or recover is None:
            return None
        stress = np.moveaxis(recover(self.zeta.T), 2, 0)
        if carried.constant_stress is not None:
            stress = stress + carried.constant_stress
        return float(von_mises(stress).max() / carried.yield_stress)


def _squares(matrix: Matrix, fields: np.ndarray) -> np.ndarray:
    """Return ``uᵀ X u`` of fields (3n, s), shape (s,)."""
    return np.einsum("is,is->s", fields, matrix @ fields)
