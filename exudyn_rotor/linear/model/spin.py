"""The spin of a rotor as a coordinate: what turns it, and what holds it.

The deviation φ of the spin angle from Ωt is a rigid rotation. One law holds in all analyses:

- A *free* spin turns about the axis of the rotor. Supports are centred there: they neither turn it
  nor hold it. Loads turn it by their moment about the axis, which is the moment of an acceleration
  of the ground, too, where the centre of mass is off the axis.
- The centrifugal field does not resist the spin, at any level of stiffening: a rotation of the
  whole rotor keeps its potential, so that ``K2 − C`` acts on all other motions alone.
- At rest the equations are complete, ``K − ω²M`` with the spin as a coordinate. At a speed the
  coupling of spin and lateral motion by an eccentric centre of mass, and by products of inertia,
  is left out: frequencies err by ``m e²/Θ`` and ``J²/(I_t Θ)`` at most, and lateral motion is that
  of a rotor at constant speed.
- What holds the spin, a torsion spring that stands still or turns, a gear, or springs on an arm off
  the axis, acts on it as on any motion.
- Where an analysis holds a free spin at θ = Ωt, as stability and unbalance response do, other
  motions have no mean rotation about the axis.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_rotor.reduction.reduced_rotor import RIGID_KINDS, ModeKind, ReducedRotor
from exudyn_rotor.reduction.selection import mean_rotation
from exudyn_rotor.theory.invariants import Invariants

ARM = 1e-4  # arm off the axis, squared and in radii of gyration, at which springs hold the spin


@dataclass(frozen=True, eq=False)
class Spin:
    """The spin of a rotor in mass-orthonormal coordinates.

    Attributes
    ----------
    momentum : ndarray, shape (k,)
        The spin a of a motion x is ``momentumᵀx``; all other motions have no mean rotation about
        the axis. Of unit length.
    turn : ndarray, shape (k,)
        The rotation about the axis of the rotor, with a = 1.
    rigid : ndarray, shape (k, r)
        All rigid motions, orthonormal.
    """

    momentum: np.ndarray
    turn: np.ndarray
    rigid: np.ndarray

    def about_axis(self, U: np.ndarray) -> np.ndarray:
        """Return what rows (…, k) show where the spin is the rotation about the axis."""
        return U + np.multiply.outer(U @ (self.turn - self.momentum), self.momentum)

    def centred(self, U: np.ndarray, mass: float, is_apart: bool) -> np.ndarray:
        """Return the motion (6, k) of a place that lies on the axis but for the mesh, as if on it.

        By an arm of micrometres springs would hold the spin next to nothing. `is_apart` tells
        whether U is that of :meth:`about_axis`.
        """
        arm = U[:2] @ (self.momentum if is_apart else self.turn)
        if mass * (arm @ arm) > ARM:
            return U
        U = U.copy()
        U[:2] -= np.multiply.outer(arm, self.momentum)
        return U

    def averaged(self, wave_free: np.ndarray) -> Spin:
        """Return the spin of a rotor whose matrices are means over a turn.

        `wave_free` (k, k) projects on motions that are no lateral waves.
        """
        momentum = wave_free @ self.momentum
        momentum = momentum / np.linalg.norm(momentum)
        return Spin(momentum, self.turn / (momentum @ self.turn), self.rigid)

    def apart(self, X: np.ndarray) -> np.ndarray:
        """Return a matrix (k, k) without what couples the spin with other motions, and itself."""
        others = np.eye(len(X)) - np.outer(self.momentum, self.momentum)
        return others @ X @ others

    def unturned(self, G: np.ndarray) -> np.ndarray:
        """Return a gyroscopic matrix without what couples the spin with rigid motions."""
        coupling = self.rigid @ (self.rigid.T @ (G @ self.momentum))
        return G - np.outer(coupling, self.momentum) + np.outer(self.momentum, coupling)


def spin_of(rotor: ReducedRotor, invariants: Invariants, Q: np.ndarray) -> Spin | None:
    """Return the spin of a rotor in the basis Q (n, k) of its columns; None where it has none.

    The origin of the invariants is on the axis.
    """
    if ModeKind.SPIN not in rotor.kinds:
        return None
    momentum = Q.T @ mean_rotation(rotor)
    if np.linalg.norm(momentum) < 0.5:  # a scene may prescribe it
        return None
    about_axis = invariants.g  # the coordinates of a rotation by one rad, as columns have unit mass
    rigid = Q.T[:, [kind in RIGID_KINDS for kind in rotor.kinds]]
    return Spin(momentum, about_axis / (momentum @ about_axis), rigid)
