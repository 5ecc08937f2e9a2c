"""The spin of a full rotor as a coordinate of its own, as a reduced rotor has it.

A displacement x holds the spin ``a = sᵀMx``, with s the unit rotation about the axis through the
centre of mass, ``sᵀMs = 1``. Two terms that unbalance couples with it are cancelled by the
deflection of the steady state and left out, see :class:`LinearRotor`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from exudyn_rotor.axis import SpinAxis
from exudyn_rotor.linear.equations.supports import axes_of
from exudyn_rotor.modes.basis import RIGID, rigid_columns
from exudyn_rotor.solid.rotor import SolidRotor

# of the largest rigid motion: nodes on one line are not displaced by a rotation about it
_NO_MOTION = 1e-9


def seeds(rotor: SolidRotor) -> tuple[np.ndarray, np.ndarray]:
    """Return the spin (3n, 0 or 1), and the other rigid motions (3n, r) about the centre of mass.

    A rotor with springs to the ground in its stiffness has none.
    """
    if rotor.grounded:
        return np.zeros((3 * rotor.node_count, 0)), np.zeros((3 * rotor.node_count, 0))
    rigid = rigid_columns(rotor.nodes, rotor.axis, rotor.center_of_mass)
    lengths = np.sqrt(np.einsum("ck,ck->k", rigid, rotor.mass @ rigid))
    rigid = rigid / np.maximum(lengths, 1e-300)
    turning = np.array([name == "spin" or name.startswith("tilt") for name in RIGID])
    moves = lengths > _NO_MOTION * np.where(turning, lengths[turning].max(), lengths.max())
    spin = np.array([name == "spin" for name in RIGID])
    return rigid[:, spin & moves], rigid[:, ~spin & moves]


@dataclass(frozen=True, eq=False)
class FullSpin:
    """The spin of a full rotor on its supports.

    Attributes
    ----------
    motion : ndarray, shape (3n,)
        s, of unit mass norm [1/√kg].
    momentum : ndarray, shape (3n,)
        Ms.
    shifts : tuple of ndarray, each (6,)
        What turns the spin at each support into one about the axis, along (n1, n2, e).
    """

    motion: np.ndarray
    momentum: np.ndarray
    shifts: tuple[np.ndarray, ...]

    @classmethod
    def of(
        cls, rotor: SolidRotor, motions: Sequence[sp.csr_array], center: np.ndarray, axis: SpinAxis
    ) -> FullSpin | None:
        """Return the spin; None where the rotor has none. `center` is from the axis [m]."""
        spin, _ = seeds(rotor)
        if spin.shape[1] == 0:
            return None
        offset = axes_of(axis).T @ center
        shifts = []
        for U in motions:
            turn = (U @ spin[:, 0])[3:]
            shifts.append(np.concatenate([np.cross(turn, offset), np.zeros(3)]))
        return cls(spin[:, 0], rotor.mass @ spin[:, 0], tuple(shifts))

    def amount(self, X: np.ndarray) -> np.ndarray:
        """Return the spin a of the columns of X, shape (k,)."""
        return self.momentum @ X

    def uncoupled(self, apply: Callable[[np.ndarray], np.ndarray], X: np.ndarray) -> np.ndarray:
        """Return a symmetric matrix times X without its coupling of the spin with the rest."""
        amount = self.amount(X)
        rest = self.without_torque(apply(X - np.outer(self.motion, amount)))
        own = self.motion @ apply(self.motion[:, None])
        return rest + np.outer(self.momentum, own * amount)

    def without_torque(self, force: np.ndarray) -> np.ndarray:
        """Return forces (3n, k) less the torque on the spin that a drive takes up."""
        return force - np.outer(self.momentum, self.motion @ force)
