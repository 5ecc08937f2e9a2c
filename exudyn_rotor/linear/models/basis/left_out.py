"""What the basis of a reduced rotor leaves out: estimates of its error without a larger model.

Beside its own columns Q (coordinates b) a reduced rotor knows static responses to loads at its
interfaces and to the inertia forces of Q in a turning frame (:mod:`exudyn_rotor.reduction`). What
of them is not in Q, made mass-orthonormal, are further coordinates c. In both, the equations of a
motion ``e^{λt}`` are

    [Z_bb  Z_bc] [x]
    [Z_cb  Z_cc] [y]  =  0,        Z(λ) = λ²M + λ(D + 2ΩG) + K + Ω²(K2 − C) + supports,

while the reduced rotor solves ``Z_bb x = 0``: ``Z_cb x`` is the residual of its motion, seen from
the shapes that lack first. An inverse iteration from there, on both sides,

    z = Z(λ)⁻¹ Z'(λ) (x, 0),    w = Z(λ)⁻ᴴ M (x, 0),

and the quotient ``wᴴ[Z(λ) + δ Z'(λ) + δ²M]z = 0`` give λ + δ, the eigenvalue in both. (With
``y = −Z_cc⁻¹Z_cb x`` alone, at the x of the reduced rotor, δ comes out ten times too small on stiff
supports: the motion at the supports changes by as much as the flexibility that is added there.) A δ
that is not small against the distance of the modes is an order of magnitude only. Shapes that are
neither in Q nor among the static responses are not seen: of the error they are a hundredth part in
``python -m validation basis``. Periodic equations are taken in harmonics
(:mod:`exudyn_rotor.linear.periodic.hill`), y in those in which the mode moves.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.models.basis.finer_model import FinerModel, finer_model
from exudyn_rotor.linear.models.protocol import LinearModel
from exudyn_rotor.linear.periodic.floquet_modes import FloquetModes
from exudyn_rotor.linear.periodic.inverse_iteration import moved, moved_together
from exudyn_rotor.linear.periodic.periodic_system import ConstantSystems, PeriodicSystem

_SMALL = 1e-5  # harmonics of a mode of unit length
_FAR = 1e-3  # share of an eigenvalue by which it moves far
_MOST_ENTRIES = 1_000_000  # of the matrices of speeds that are looked at together


class _Start(NamedTuple):
    """A finer system with λ (k,) and harmonics (h, c, k), of `orders` (h,), of the reduced one."""

    system: PeriodicSystem
    orders: np.ndarray
    values: np.ndarray
    shapes: np.ndarray

    def moved(self, values: np.ndarray, shapes: np.ndarray, wanted: np.ndarray) -> np.ndarray:
        """Return eigenvalues after an inverse iteration of those `wanted`."""
        result = values.astype(complex)
        result[wanted] = moved(self.system, self.orders, values[wanted], shapes[..., wanted])[0]
        return result


@dataclass(frozen=True, eq=False)
class LeftOut:
    """A model of reduced rotors beside the shapes that their bases lack first.

    Attributes
    ----------
    finer : FinerModel
    others : ndarray, shape (k, r), or None
        Motions of the given model without a spin that nothing holds, where it follows θ = Ωt and
        is no coordinate.
    """

    finer: FinerModel
    others: np.ndarray | None = None

    @classmethod
    def of(cls, model: LinearModel, held: bool = False) -> LeftOut | None:
        """Return what the bases of a model leave out; None where that is not known."""
        finer = finer_model(model)
        if finer is None:
            return None
        return cls(finer, model.space(0, 0.0, held=True).others if held else None)

    @property
    def equations(self) -> LinearModel:
        """The finer model."""
        return self.finer.equations

    @cached_property
    def _lacking(self) -> np.ndarray:
        """Which coordinates of :meth:`at` are left out."""
        if self.others is None:
            return self.finer.lacking
        more = np.count_nonzero(self.finer.lacking)
        return np.arange(self.others.shape[1] + more) >= self.others.shape[1]

    @cached_property
    def _basis(self) -> np.ndarray:
        """Motions of the finer model without a spin that is no coordinate, as columns."""
        basis = np.zeros((len(self.finer.lacking), len(self._lacking)))
        basis[np.ix_(~self.finer.lacking, ~self._lacking)] = self.others
        basis[np.ix_(self.finer.lacking, self._lacking)] = np.eye(np.count_nonzero(self._lacking))
        return basis

    def at(self, speed: float) -> PeriodicSystem:
        """Return the finer equations at a speed [rad/s]."""
        system = self.equations.at(speed)
        if speed == 0.0:  # at rest nothing turns: coefficients are what they are at θ = 0
            M, D, K = ({0: X} for X in system.matrices(0.0))
            system = PeriodicSystem(0.0, M, D, K, system.H)
        return system if self.others is None else system.projected(self._basis)

    def _constant_at(self, speeds: Sequence[float]) -> ConstantSystems | None:
        """Return the finer equations at speeds where they do not have to be made one by one."""
        systems = self.equations.constant_at(speeds)
        if systems is None or self.others is None:
            return systems
        return systems.projected(self._basis)

    def shifts(self, speeds: Sequence[float], modes: Sequence[FloquetModes]) -> list[np.ndarray]:
        """Return the estimated ``λ − λ_reduced`` of the modes at each speed, (k,), complex [1/s].

        Free rigid motions, λ = 0, are in every basis; theirs is zero.
        """
        if not np.any(self.finer.lacking):
            return [0j * entry.values for entry in modes]
        result: list[np.ndarray] = []
        at_once = max(1, _MOST_ENTRIES // len(self.finer.lacking) ** 2)
        for first in range(0, len(speeds), at_once):
            few = slice(first, first + at_once)
            systems = self._constant_at(speeds[few])
            if systems is None:
                each = [self.at(speed) for speed in speeds[few]]
                systems = ConstantSystems.of(each)
            if systems is None:
                starts = map(self._start, each, modes[few])
                result += [_shifts(start.moved, start.values, start.shapes) for start in starts]
            else:
                result += self._shifts_together(systems, modes[few])
        return result

    def _shifts_together(
        self, systems: ConstantSystems, modes: Sequence[FloquetModes]
    ) -> list[np.ndarray]:
        """Return the shifts in systems that do not change in time, in arrays of equal width."""
        counts = [len(entry.values) for entry in modes]
        values = np.zeros((len(modes), max(counts)), dtype=complex)
        shapes = np.zeros((len(modes), len(self._lacking), max(counts)), dtype=complex)
        own = np.flatnonzero(~self._lacking)
        for i, (entry, count) in enumerate(zip(modes, counts, strict=True)):
            values[i, :count], shapes[i, own, :count] = entry.values, self._given(entry.central)
        shifts = _shifts(partial(moved_together, systems), values, shapes)
        return [row[:count] for row, count in zip(shifts, counts, strict=True)]

    def _given(self, vectors: np.ndarray) -> np.ndarray:
        """Return motions of the reduced model in those coordinates of :meth:`at` that it has."""
        return vectors if self.others is None else self.others.T @ vectors

    def _start(self, system: PeriodicSystem, modes: FloquetModes) -> _Start:
        """Return the motions of the reduced model in the coordinates of the finer one."""
        used = self._used(modes, system.step)
        shape = np.count_nonzero(used), len(self._lacking), len(modes.values)
        shapes = np.zeros(shape, dtype=complex)
        shapes[:, ~self._lacking] = self._given(modes.vectors[used])
        return _Start(system, modes.orders[used], modes.values, shapes)

    @staticmethod
    def _used(modes: FloquetModes, step: int) -> np.ndarray:
        """Return which harmonics count: the central ones and those up to where any mode moves."""
        sizes = np.linalg.norm(modes.vectors, axis=1).max(axis=1, initial=0.0)
        highest = np.abs(modes.orders[sizes > _SMALL]).max(initial=0)
        return np.abs(modes.orders) <= max(highest, step)


def _shifts(
    move: Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray],
    values: np.ndarray,
    shapes: np.ndarray,
) -> np.ndarray:
    """Return by how much eigenvalues move; one step takes λ, motions, and which are wanted."""
    found = move(values, shapes, values != 0.0)
    # from where a large one leads, for another eigenvalue may be nearer to λ, and the motion is
    # not quite without that one's
    far = np.abs(found - values) > _FAR * np.abs(values)
    return move(found, shapes, far) - values
