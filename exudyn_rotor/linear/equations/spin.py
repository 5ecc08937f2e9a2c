"""The spin of a rotor as a coordinate of its own, which unbalance does not couple with the rest.

A displacement x holds the spin ``a = sᵀMx``, with s the unit rotation about the axis through the
centre of mass, ``sᵀMs = 1``. When the whole steady state turns about the axis, the potentials of
the centrifugal field and of isotropic supports stay as they are, so the spin has no stiffness.
Linear terms feign one by first order in the eccentricity; the static forces of the steady state,
which are not part of these equations, cancel it. Its Coriolis forces change by as much with the
steady deflection. So G, ``K2 − C`` and the supports' translations act on the rest of x only, at all
levels of stiffening: lateral motion is that of a rotor driven at constant speed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from exudyn_rotor.axis import SpinAxis
from exudyn_rotor.invariants import Invariants
from exudyn_rotor.linear.equations.supports import Support, axes_of
from exudyn_rotor.modes.basis import RIGID, rigid_columns
from exudyn_rotor.solid.rotor import SolidRotor

# of the largest rigid motion: nodes on one line are not displaced by a rotation about it
_NO_MOTION = 1e-9
# arm of a spring that turns with the rotor, squared and in radii of gyration, that holds the spin
_ARM = 1e-4


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
class Spin:
    """The spin of a rotor on its supports.

    Attributes
    ----------
    motion : ndarray, shape (k,)
        s, of unit mass norm [1/√kg].
    momentum : ndarray, shape (k,)
        Ms.
    shifts : tuple of ndarray, each (6,)
        What takes the displacement by the spin away at each support, along (n1, n2, e).
    """

    motion: np.ndarray
    momentum: np.ndarray
    shifts: tuple[np.ndarray, ...]

    @classmethod
    def of(
        cls,
        motion: np.ndarray,
        momentum: np.ndarray,
        supports: Sequence[Support],
        motions: Sequence[np.ndarray | sp.csr_array],
        invariants: Invariants,
        axis: SpinAxis,
    ) -> Spin | None:
        """Return the spin; None where a spring that turns with the rotor holds it off the axis.

        Such a spin is an elastic motion like others, and its equations are complete.
        """
        turned = [U @ motion for U in motions]
        offset = axes_of(axis).T @ invariants.center
        for support, u in zip(supports, turned, strict=True):
            about_axis = u[:3] + np.cross(u[3:], offset)
            stiffness = support.matrices(0.0)[0][:3, :3]
            held = about_axis @ stiffness @ about_axis
            limit = _ARM * np.abs(stiffness).max() / invariants.mass
            if support.frame == "rotor" and held > limit:
                return None
        shifts = tuple(np.concatenate([-u[:3], np.zeros(3)]) for u in turned)
        return cls(motion, momentum, shifts)

    def amount(self, X: np.ndarray) -> np.ndarray:
        """Return the spin a of the columns of X, shape (k,)."""
        return self.momentum @ X

    def uncoupled(self, apply: Callable[[np.ndarray], np.ndarray], X: np.ndarray) -> np.ndarray:
        """Return a matrix times X, with neither the spin's own entry nor its coupling."""
        return self.without_torque(apply(X - np.outer(self.motion, self.amount(X))))

    def without_torque(self, force: np.ndarray) -> np.ndarray:
        """Return forces (k, c) less the torque on the spin."""
        return force - np.outer(self.momentum, self.motion @ force)

    def rest(self) -> np.ndarray:
        """Return orthonormal displacements without spin as columns, shape (k, k − 1)."""
        unit = self.momentum / np.linalg.norm(self.momentum)
        largest = np.argmax(np.abs(unit))
        mirror = unit.copy()
        mirror[largest] += np.copysign(1.0, unit[largest])
        reflected = np.eye(len(unit)) - 2.0 * np.outer(mirror, mirror) / (mirror @ mirror)
        return np.delete(reflected, largest, axis=1)


def spin_of(rotor: SolidRotor) -> tuple[np.ndarray, np.ndarray] | None:
    """Return s and Ms of a solid rotor, each (3n,); None where it has no spin."""
    spin, _ = seeds(rotor)
    return (spin[:, 0], rotor.mass @ spin[:, 0]) if spin.shape[1] else None
