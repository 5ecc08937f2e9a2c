"""The rotor that a proposal starts from, on its supports, as linear equations in its own axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from exudyn_rotor.bearings.support import Support
from exudyn_rotor.calls import kept
from exudyn_rotor.linear.model.build import linear_model
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.reduction.reduced_rotor import ModeKind, ReducedRotor
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.rotating_axes import axes_of

_BALANCED = 1e-5  # share of the rotor's size by which a mesh may be off the axis
_ORDER = 2  # harmonics of the speed by which supports couple the motions of a rotor


class Hill(NamedTuple):
    """Equations at a speed for h harmonics of it: ``(s²M + sD + K) X = F``, each (h k, h k)."""

    M: np.ndarray
    D: np.ndarray
    K: np.ndarray
    rates: np.ndarray  # (h k,), what a harmonic adds to s of a coordinate, imΩ
    orders: int  # h

    def stiffness(self, s: complex) -> np.ndarray:
        """Return the dynamic stiffness for motions ``exp(st)``."""
        return s**2 * self.M + s * self.D + self.K


@dataclass(frozen=True, eq=False)
class Candidate:
    """All modes that can be chosen from, and what holds the rotor."""

    reduced: ReducedRotor
    source: LinearModel  # in axes of the rotor
    axial: bool  # whether something acts along the axis

    @classmethod
    def of(cls, reduced: ReducedRotor, supports: Sequence[Support] | Support) -> Candidate:
        """Take a reduced rotor with its supports."""
        source = linear_model(reduced, supports=supports, axes="rotor")
        # bearings act across the axis
        linear = [one for one in source.supports[""] if isinstance(one, Support)]
        matrices = [matrix for one in linear for matrix in one.matrices(1.0)]
        return cls(reduced, source, any(np.any(X[2]) or np.any(X[:, 2]) for X in matrices))

    @property
    def invariants(self) -> Invariants:
        """Invariants in the basis of the coordinates of the rotor, about a point of the axis."""
        return self.source.bodies[0].alone.invariants

    @property
    def flexible(self) -> np.ndarray:
        """Which coordinates of the rotor are flexible modes."""
        return np.arange(len(self.reduced.rigid_kinds), self.reduced.size)

    @property
    def frequencies(self) -> np.ndarray:
        """Frequencies of the flexible modes [rad/s]."""
        return np.sqrt(np.maximum(np.diag(self.invariants.K)[self.flexible], 0.0))

    @property
    def held(self) -> tuple[int, ...]:
        """Coordinates without a steady motion: the spin, where nothing holds it.

        Loads that grow slowly would turn an eccentric rotor by far more than they move it.
        """
        kinds = self.reduced.rigid_kinds
        free = self.source.free_spins.shape[1] and ModeKind.SPIN in kinds
        return (kinds.index(ModeKind.SPIN),) if free else ()

    @kept
    def hill(self, speed: float) -> Hill:
        """Return the equations in the rotor frame at a speed [rad/s]."""
        system, k = self.source.at(speed), self.source.size
        step = system.step or _ORDER + 1
        orders = step * np.arange(-(_ORDER // step), _ORDER // step + 1)
        M = np.kron(np.eye(len(orders)), system.M)
        D, K = (
            np.block([[terms.get(m - n, np.zeros((k, k))) for n in orders] for m in orders])
            for terms in (system.D, system.K)
        )
        rates = np.repeat(1j * orders * speed, k)
        K = K + D * rates + M * rates**2
        return Hill(M, D + 2.0 * M * rates, K, rates, len(orders))

    @kept
    def motions(self, speed: float) -> tuple[np.ndarray, np.ndarray]:
        """Return exponents (2hk,) of the free motions [1/s] and their states (2hk, 2hk)."""
        made = self.hill(speed)
        rates = np.linalg.solve(made.M, np.hstack([-made.K, -made.D]))
        unit = np.eye(len(rates), 2 * len(rates), k=len(rates))
        return np.linalg.eig(np.vstack([unit, rates]))

    @cached_property
    def ends(self) -> tuple[np.ndarray, np.ndarray]:
        """Displacements that count (p, k), and loads (l, k).

        Forces at the interfaces come first, then acceleration and the rotor's own unbalance.
        """
        rows, source = 3 if self.axial else 2, self.source
        body = source.bodies[0]

        def wide(part: np.ndarray) -> np.ndarray:
            return np.pad(part, [(0, 0), (0, source.size - part.shape[1])])

        motion = np.vstack([wide(body.motion(name)[:rows]) for name in self.reduced.interfaces])
        inv = self.invariants
        translations = wide(axes_of(body.alone.rotor.axis).T @ inv.S)
        loads = [motion, translations[:rows]]
        across = np.eye(3) - np.outer(inv.direction, inv.direction)
        second = np.trace(inv.J)
        unbalance = source.unbalance()[0].real
        couple = np.linalg.norm(across @ inv.J @ inv.direction) / second
        # flexible modes of a balanced rotor stretch under the rotation; that is no unbalance
        static = np.linalg.norm(translations @ unbalance) / np.sqrt(inv.mass**3 * second)
        if max(couple, static) >= _BALANCED:
            loads.append(unbalance[None, :])
        return motion, np.vstack(loads)

    def ends_of_harmonics(self, orders: int) -> tuple[np.ndarray, np.ndarray]:
        """Return displacements (h p, h k) of all harmonics, and load columns (h k, l) of one."""
        motion, loads = self.ends
        unit = np.eye(orders)
        return np.kron(unit, motion), np.kron(unit[:, [orders // 2]], loads.T)
