"""Holding the coordinates of the frame's node that a formulation does not have.

Two ways, of which ``'auto'`` is the first:

``'constraints'``
    Coordinates that stand still have a ``CoordinateConstraint`` each, and a large mass: implicit
    and static solvers take these, explicit solvers eliminate them, which sets the coordinates to
    zero after each step, and Exudyn's own analyses of an ``mbs`` (``ComputeODE2Eigenvalues``,
    ``ComputeLinearizedSystem``) project them out. Explicit solvers would set a prescribed
    motion to zero as well, in silence. With one, therefore, an ``ObjectConnectorCoordinateVector``
    at velocity level holds all that stands still or moves at a constant speed, which explicit
    solvers refuse; a motion that varies with time has a ``CoordinateConstraint`` beside it.
``'mass'``
    A huge mass on the diagonal, for explicit solvers and a prescribed motion. A motion that
    varies with time is driven by its acceleration. Exudyn's analyses show a false zero for each of
    these coordinates, and static solvers do not take them.

``ComputeODE2Eigenvalues`` leaves the gyroscopic terms out; :func:`exudyn_rotor.campbell` has them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import exudyn
import numpy as np
from exudyn.itemInterface import (
    CoordinateConstraint,
    MarkerNodeCoordinate,
    MarkerNodeCoordinates,
    NodePointGround,
    ObjectConnectorCoordinateVector,
    VCoordinateConstraint,
)

from exudyn_rotor.multibody.rotor.frame import THIRD
from exudyn_rotor.theory.formulation import ConstantSpeed, Formulation, PrescribedMotion

LOCKINGS = ("auto", "mass", "constraints")
MODES = 6  # the first coordinate after those of the rigid-body node
LOCKS = "locks"  # name of the constraint of all that stand still or turn at constant speed

LOCK_RATIO = 1e18  # of the rotor's own inertia
# beside a constraint that explicit solvers eliminate: of what moves within one of their steps
ELIMINATED_RATIO = 1e9
# of coordinates that are driven: rounding of the driving force is seen in the external one
DRIVEN_RATIO = 1e9

LockedForce = Callable[[float], np.ndarray]


@dataclass(frozen=True, eq=False)
class Locks:
    """What happens to the six rigid coordinates of the marker body.

    Attributes
    ----------
    unknown : tuple of int
        Rigid coordinates that are unknowns of the formulation.
    fixed : tuple of int
    prescribed : dict of int to PrescribedMotion or ConstantSpeed
        Scalar motion of every prescribed coordinate.
    spin : {3, 4, 5}
        The coordinate that is the spin angle; the other two rotations are tilts.
    plane : ndarray or None
        Inertial directions of in-plane unknowns, shape (3, 2).
    normal : ndarray or None
        Set when the plane of translation is skew in space: all three translations are unknowns,
        and one row along this direction holds them in the plane.
    """

    unknown: tuple[int, ...]
    fixed: tuple[int, ...]
    prescribed: dict[int, PrescribedMotion | ConstantSpeed]
    spin: int = THIRD
    plane: np.ndarray | None = None
    normal: np.ndarray | None = None

    @classmethod
    def of(cls, formulation: Formulation, spin_direction: np.ndarray, spin: int) -> Locks:
        """Sort the coordinates for a spin axis along `spin_direction` in inertial axes."""
        translations, plane, normal = _unknown_translations(formulation, spin_direction)
        rest = [i for i in range(3) if i not in translations]
        prescribed: dict[int, PrescribedMotion | ConstantSpeed] = {}
        if formulation.moves_origin:
            prescribed = {i: _component(formulation.translation, i) for i in rest}
            rest = []
        unknown = tuple(translations)
        if formulation.has_spin:
            unknown = (*unknown, spin)
        else:
            prescribed[spin] = formulation.spin
        return cls(unknown, (*rest, *_tilts(spin)), prescribed, spin, plane, normal)

    @property
    def tilts(self) -> tuple[int, int]:
        """The two coordinates that tilt the frame, always locked."""
        return _tilts(self.spin)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the six coordinates."""
        names = dict(enumerate(("x", "y", "z"))) | {self.spin: "spin"}
        names |= dict(zip(self.tilts, ("tilt a", "tilt b"), strict=True))
        return tuple(names[i] for i in range(MODES))

    @property
    def varying(self) -> dict[int, PrescribedMotion]:
        """Coordinates with a time-varying prescribed motion."""
        return {i: m for i, m in self.prescribed.items() if isinstance(m, PrescribedMotion)}

    @property
    def locked_names(self) -> tuple[str, ...]:
        """Names of the coordinates that exist only for the marker body."""
        return tuple(self.names[i] for i in (*self.fixed, *self.prescribed))

    @property
    def stand_still(self) -> bool:
        """True where the locked coordinates stand still, one by one, so that explicit solvers run.

        Their constraints are eliminated there.
        """
        return not self.prescribed and self.normal is None

    @property
    def rows(self) -> tuple[np.ndarray, np.ndarray]:
        """Rows (c, 6) over the coordinates, and the rates (c,) at which one constraint holds them.

        What varies with time is not among them.
        """
        steady = [i for i, motion in self.prescribed.items() if i not in self.varying]
        rows = np.eye(MODES)[[*self.fixed, *steady]]
        rates = np.array([0.0] * len(self.fixed) + [self.prescribed[i].speed for i in steady])
        if self.normal is not None:
            rows = np.vstack([rows, np.append(self.normal, np.zeros(3))])
            rates = np.append(rates, 0.0)
        return rows, rates


def _tilts(spin: int) -> tuple[int, int]:
    return tuple(i for i in range(3, MODES) if i != spin)


def _unknown_translations(
    formulation: Formulation, direction: np.ndarray
) -> tuple[list[int], np.ndarray | None, np.ndarray | None]:
    if formulation.translation_count == 3:
        return [0, 1, 2], None, None
    if formulation.translation_count == 0:
        return [], None, None
    along = np.flatnonzero(np.abs(direction) > 1.0 - 1e-14)
    if along.size == 0:
        return [0, 1, 2], None, direction
    across = [i for i in range(3) if i != along[0]]
    return across, np.eye(3)[:, across], None


def _component(motion: PrescribedMotion, index: int) -> PrescribedMotion:
    """Return one coordinate of a prescribed translation."""
    return PrescribedMotion(
        lambda t: float(motion.value(t)[index]),
        lambda t: float(motion.rate(t)[index]),
        lambda t: float(motion.acceleration(t)[index]),
    )


def lock_masses(locks: Locks, size: int, inertia: np.ndarray, by_mass: bool) -> np.ndarray:
    """Return the masses (size,) of locked coordinates, zero for unknowns.

    `inertia` holds the rotor's mass (three times) and moment of inertia (three times).
    """
    mass = np.zeros(size)
    for index in (*locks.fixed, *locks.prescribed):
        if by_mass:
            ratio = DRIVEN_RATIO if index in locks.varying else LOCK_RATIO
        else:
            ratio = ELIMINATED_RATIO if locks.stand_still else 1.0
        mass[index] = inertia[index] * ratio
    return mass


def driving_force(locks: Locks, masses: np.ndarray) -> LockedForce | None:
    """Return the forces (size,) over time by which huge masses are driven; None where none is."""
    varying = locks.varying
    if not varying:
        return None

    def force(t: float) -> np.ndarray:
        total = np.zeros(len(masses))
        for index, motion in varying.items():
            total[index] = masses[index] * motion.acceleration(t)
        return total

    return force


def add_constraints(
    mbs: exudyn.MainSystem, locks: Locks, node: exudyn.NodeIndex
) -> dict[str, exudyn.ObjectIndex]:
    """Hold the locked coordinates of the frame's node by constraints; return them by name."""
    ground = mbs.AddNode(NodePointGround())

    def one(index: int, **motion: Any) -> exudyn.ObjectIndex:
        ends = [
            mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=number, coordinate=coordinate))
            for number, coordinate in ((ground, 0), (node, index))
        ]
        hidden = VCoordinateConstraint(show=False)
        item = CoordinateConstraint(markerNumbers=ends, visualization=hidden, **motion)
        return mbs.AddObject(item)

    if locks.stand_still:
        return {locks.names[index]: one(index) for index in locks.fixed}
    ends = [mbs.AddMarker(MarkerNodeCoordinates(nodeNumber=number)) for number in (ground, node)]
    rows, rates = locks.rows
    # at velocity level: drift is round-off, and a constant speed needs no function of time
    held = ObjectConnectorCoordinateVector(
        markerNumbers=ends,
        scalingMarker0=np.zeros((len(rates), 0)),
        scalingMarker1=rows,
        offset=rates,
        velocityLevel=True,
        visualization={"show": False},
    )
    constraints = {LOCKS: mbs.AddObject(held)}
    for index, motion in locks.varying.items():
        constraints[locks.names[index]] = one(index, **_offset(motion))
    return constraints


def _offset(motion: PrescribedMotion) -> dict:
    """Return the constraint's functions; index-2 solvers need the velocity beside the position."""
    return {
        "offsetUserFunction": lambda mbs, t, item, offset: motion.value(t),
        "offsetUserFunction_t": lambda mbs, t, item, offset: motion.rate(t),
    }
