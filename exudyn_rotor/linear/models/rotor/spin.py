"""The spin of a rotor as a coordinate, free or held by its supports.

A displacement x holds the spin ``a = sᵀMx``, with s the unit rotation about the axis through the
centre of mass, ``sᵀMs = 1``. The centrifugal field does not resist it, at any level of stiffening:
a rotation of the whole keeps its potential, so ``K2 − C`` acts on the rest of x only.

*Free*: nothing else resists the spin either when the whole steady state turns about the axis.
Linear terms of supports have a spurious stiffness of first order in the eccentricity, which the
forces of the steady state cancel. Supports then act on the rest of x only: lateral motion is that
of a rotor driven at constant speed, and the spin is neutral. What is constant is the mean rotation
about the axis (Tisserand), as in a scene with a prescribed spin: the rest has ``e·I⁻¹L = 0``, with
the tensor of inertia I and the angular momentum L of displacements. It is orthogonal to the
rotation about ``I⁻¹e``, which is s here and has a tilt where there are products of inertia. In a
rest orthogonal to the rotation about the axis, ``e·L = 0``, tilts would turn about it.

*Twisted*: a torsion spring that stands still holds the spin, a motion of its own about the axis. It
is coupled with the rest by products of inertia, but not by an eccentric centre of mass.

*Coupled*: springs at an arm off the axis, or a torsion spring that turns with the rotor, hold the
spin. All of their forces act on it, and so does their steady force F under the rotor's own
unbalance: by the displacement of second order ``−½φ²ρ`` at the arm ρ from the centre of mass it has
the stiffness ``F·ρ``. This is complete for a rigid rotor without products of inertia on supports
that look alike from the rotor.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from exudyn_rotor.bearings.support import Support
from exudyn_rotor.cached import kept
from exudyn_rotor.reduction.basis import rigid_columns
from exudyn_rotor.reduction.mode_kind import RIGID_KINDS, ModeKind
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.reduction.selection import mean_rotation
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.nodal import skew
from exudyn_rotor.theory.rotating_axes import axes_of

# of the largest rigid motion: nodes on one line are not displaced by a rotation about it
_NO_MOTION = 1e-6
_NO_INERTIA = 1e-12  # of the largest moment of inertia, as of nodes on one line
_ROUNDING = 1e-12  # of nodes, relative to their distance from the origin
# arm off the axis, squared and in radii of gyration, from which springs that turn hold the spin
_ARM = 1e-4
# the same of springs that stand still, from their centre: bearings are off it by the mesh alone
_OFF_CENTER = 1e-2
_PROBED = (0.0, 1.0, 10.0, 100.0, 1e3, 1e4)  # rad/s, for supports that depend on the speed


class Rotations(NamedTuple):
    """Motions of the whole rotor that count as its spin.

    Attributes
    ----------
    about_axis : tuple of ndarray, each (k,)
        The rotation about the axis of unit mass norm s, and Ms.
    mean : tuple of ndarray, each (k,)
        That to which motions without a mean rotation about the axis are orthogonal, likewise.
    rigid : tuple of ndarray, each (k, r)
        All rigid motions R, of unit mass norm, and MR.
    """

    about_axis: tuple[np.ndarray, np.ndarray]
    mean: tuple[np.ndarray, np.ndarray]
    rigid: tuple[np.ndarray, np.ndarray]


def seeds(rotor: SolidRotor) -> tuple[np.ndarray, np.ndarray]:
    """Return the spin (3n, 0 or 1), and the other rigid motions (3n, r) about the centre of mass.

    A rotor with springs to the ground in its stiffness has none.
    """
    if rotor.grounded:
        return np.zeros((3 * rotor.node_count, 0)), np.zeros((3 * rotor.node_count, 0))
    rigid = rigid_columns(rotor.nodes, rotor.axis, rotor.center_of_mass)
    lengths = np.sqrt(np.einsum("ck,ck->k", rigid, rotor.mass @ rigid))
    rigid = rigid / np.maximum(lengths, 1e-300)
    spin = np.array([kind is ModeKind.SPIN for kind in RIGID_KINDS])
    turning = spin | np.array([kind.is_tilt for kind in RIGID_KINDS])
    moves = lengths > _NO_MOTION * np.where(turning, lengths[turning].max(), lengths.max())
    # nodes that are all in one point are displaced by no rotation, but for rounding
    moves &= lengths > _ROUNDING * np.abs(rotor.nodes).max() * np.sqrt(rotor.total_mass)
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
        What takes the motion by the spin away at each support, along (n1, n2, e), but for the
        rotation about the axis.
    bends : tuple of ndarray, each (3,)
        Displacement of second order at each support, per a²/2.
    coupled : bool
        Whether supports hold it so that it is coupled with the rest.
    free : bool
        Whether nothing holds it.
    whirling : ndarray, shape (k,)
        ``w = −MR (RᵀMR)⁻¹ RᵀGs``, the Coriolis torque on a free spin by rigid motions R per 2Ω.
    """

    motion: np.ndarray
    momentum: np.ndarray
    shifts: tuple[np.ndarray, ...]
    bends: tuple[np.ndarray, ...]
    coupled: bool
    free: bool
    whirling: np.ndarray

    @classmethod
    def of(
        cls,
        rotations: Rotations,
        supports: Sequence[Support],
        motions: Sequence[np.ndarray | sp.csr_array],
        invariants: Invariants,
        axis: SpinAxis,
        twisted: bool = False,
    ) -> Spin:
        """Return the spin on its supports, `twisted` where others may hold its torsion."""
        turned = [U @ rotations.about_axis[0] for U in motions]
        offset = axes_of(axis).T @ invariants.center
        # by rotation about the axis
        at_arm = [u[:3] - skew(offset) @ u[3:] for u in turned]
        known = list(zip(supports, turned, at_arm, strict=True))
        standing = [(one, u[:2]) for one, u, _ in known if one.frame != "rotor"]
        turning = [(one, u) for one, _, u in known if one.frame == "rotor"]
        coupled = _held_off_center(standing, invariants.mass) or any(
            _couples(_stiffnesses(one), u, invariants.mass) for one, u in turning
        )
        tilts = [one for one in supports if np.any(one.tilt_stiffness != 0.0)]
        held = coupled or any(np.any(np.array(_stiffnesses(one))[:, 5]) for one in tilts)
        bends = tuple(u[5] * np.array([-u[1], u[0], 0.0]) for u in turned)
        if held or twisted:
            motion, momentum = rotations.about_axis
            whirling = np.zeros(len(motion))
        else:
            motion, momentum = rotations.mean
            R, MR = rotations.rigid
            whirling = -MR @ np.linalg.lstsq(R.T @ MR, R.T @ (invariants.G @ motion))[0]
        shifts = tuple((not coupled) * without_motion(U @ motion) for U in motions)
        return cls(motion, momentum, shifts, bends, coupled, not held, whirling)

    def wider(self, more: int) -> Spin:
        """Return the spin beside further coordinates that do not move it."""
        names = "motion", "momentum", "whirling"
        return replace(self, **{name: np.pad(getattr(self, name), (0, more)) for name in names})

    def amount(self, X: np.ndarray) -> np.ndarray:
        """Return the spin a of the columns of X, shape (k,)."""
        return self.momentum @ X

    def uncoupled(self, apply: Callable[[np.ndarray], np.ndarray], X: np.ndarray) -> np.ndarray:
        """Return a matrix times X, with neither the spin's own entry nor its coupling."""
        return self.without_torque(apply(X - np.outer(self.motion, self.amount(X))))

    def without_torque(self, force: np.ndarray) -> np.ndarray:
        """Return forces (k, c) less the torque on the spin."""
        return force - np.outer(self.momentum, self.motion @ force)

    def unturned(self, X: np.ndarray) -> np.ndarray:
        """Return what G X has too much: the coupling of a free spin with rigid motions."""
        return np.outer(self.momentum, self.whirling @ X) - np.outer(self.whirling, self.amount(X))

    def rest(self) -> np.ndarray:
        """Return orthonormal displacements without spin as columns, shape (k, k − 1)."""
        unit = self.momentum / np.linalg.norm(self.momentum)
        largest = np.argmax(np.abs(unit))
        mirror = unit.copy()
        mirror[largest] += np.copysign(1.0, unit[largest])
        reflected = np.eye(len(unit)) - 2.0 * np.outer(mirror, mirror) / (mirror @ mirror)
        return np.delete(reflected, largest, axis=1)


def rotations_of(rotor: SolidRotor) -> Rotations | None:
    """Return what may be the spin of a solid rotor in its 3n displacements; None without one."""
    spin, others = seeds(rotor)
    if not spin.shape[1]:
        return None
    rigid = np.hstack([spin, others])
    momenta = rotor.mass @ rigid
    turns = rigid_columns(rotor.nodes, rotor.axis, rotor.center_of_mass)[:, 3:]
    inertia = turns.T @ (rotor.mass @ turns)
    mean = turns @ np.linalg.pinv(inertia, rcond=_NO_INERTIA, hermitian=True)[:, 0]
    mean /= np.sqrt(mean @ (rotor.mass @ mean))
    about_axis = spin[:, 0], momenta[:, 0]
    return Rotations(about_axis, (mean, rotor.mass @ mean), (rigid, momenta))


def rotations_of_reduced(rotor: ReducedRotor) -> Rotations | None:
    """Return what may be the spin of a reduced rotor by its columns; None without one.

    They are mass-orthonormal.
    """
    if ModeKind.SPIN not in rotor.kinds:
        return None
    columns = np.eye(rotor.size)
    about_axis, mean = columns[rotor.kinds.index(ModeKind.SPIN)], mean_rotation(rotor)
    rigid = columns[:, [kind in RIGID_KINDS for kind in rotor.kinds]]
    return Rotations((about_axis, about_axis), (mean, mean), (rigid, rigid))


def without_motion(u: np.ndarray) -> np.ndarray:
    """Return what takes a motion (6,) away but for its rotation about the axis."""
    return np.r_[-u[:5], 0.0]


def _couples(stiffnesses: Sequence[np.ndarray], about_axis: np.ndarray, mass: float) -> bool:
    """Return True if springs that turn with the rotor act on the spin about the axis."""
    arm = np.abs(about_axis[:2]).max() ** 2 * mass > _ARM
    return any(
        np.any(K[5]) or (arm and about_axis @ K[:3, :3] @ about_axis != 0.0) for K in stiffnesses
    )


def _held_off_center(standing: Sequence[tuple[Support, np.ndarray]], mass: float) -> bool:
    """Return True if springs that stand still hold the spin by their distance from each other.

    `standing` has them with their displacement by the spin, (2,).
    """
    moved = np.array([u for _, u in standing]).reshape(-1, 2)
    distances = np.linalg.norm(moved[:, None] - moved, axis=2)
    # whatever the shares of springs, their square distance from the centre is no more than half of
    # that: films then need not be solved, which takes long
    if 0.5 * distances.max(initial=0.0) ** 2 <= _OFF_CENTER / mass:
        return False
    stiffnesses = [_stiffnesses(one) for one, _ in standing]
    varies = any(each[0] is not each[-1] for each in stiffnesses)
    for index in range(len(_PROBED) if varies else 1):
        # what repels, as a seal at high speed, holds nothing
        k = np.array([max(0.5 * np.trace(each[index][:2, :2]), 0.0) for each in stiffnesses])
        if np.any(k > 0.0):
            off_center = moved - k @ moved / k.sum()
            if k @ (off_center**2).sum(axis=1) > _OFF_CENTER * k.sum() / mass:
                return True
    return False


@kept
def _stiffnesses(support: Support) -> list[np.ndarray]:
    """Return the stiffness (6, 6) at some speeds."""
    if not support.stiffness_varies:
        return [support.matrices(0.0)[0]] * len(_PROBED)
    speeds = list(_PROBED)
    for value in (support.stiffness, support.tilt_stiffness):
        speeds += list(np.ravel(value[0])) if isinstance(value, tuple) else []
    return [support.matrices(float(speed))[0] for speed in speeds]
