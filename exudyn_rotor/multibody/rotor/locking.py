"""Holding the coordinates of the marker body that a formulation does not have.

Two ways:

``'mass'``
    A huge mass on the diagonal. No Lagrange multiplier, and explicit solvers work. A coordinate
    with a time-varying prescribed motion follows it by a stiff servo of finite mass, so it is
    accurate to the integrator's error and about ``1 / SERVO_RATIO``.
``'constraints'``
    ``CoordinateConstraint`` objects: exact for implicit and static solvers, one multiplier each.

A constant spin is held by mass in both: that is exact, in every solver.

Exudyn's own analyses of an ``mbs`` (``ComputeODE2Eigenvalues``, ``ComputeLinearizedSystem``,
``ComputeSystemDegreeOfFreedom``) see what holds these coordinates:

===============  ============================  ========================  =======================
locking          false eigenvalues             degrees of freedom more   condition of M
===============  ============================  ========================  =======================
``'mass'``       2, 3 or 5 at 1 rad/s for      as many                   1e16 to 1e20
                 translation free, in-plane,
                 none; constant spin: 1 more
                 at 0
``constraints``  none; constant spin: 1 at 0   none; constant spin: 1    that of the rotor with
                                                                         ``projectInto…``;
                                                                         constant spin: 1e16
===============  ============================  ========================  =======================

So take ``locking='constraints'`` for them, or ``marker_body=False``, which holds nothing.
``ComputeODE2Eigenvalues`` leaves the gyroscopic terms out; :func:`exudyn_rotor.campbell` has them.
"""

from __future__ import annotations

from dataclasses import dataclass

import exudyn
import numpy as np
from exudyn.advancedUtilities import CreateSymbolicUserFunction
from exudyn.itemInterface import (
    CoordinateConstraint,
    LoadCoordinate,
    MarkerNodeCoordinate,
    MarkerNodeCoordinates,
    NodePointGround,
    ObjectConnectorCoordinateVector,
)

from exudyn_rotor.multibody.rotor.equations import Layout, LockedForce
from exudyn_rotor.multibody.rotor.frame import THIRD
from exudyn_rotor.theory.formulation import ConstantSpeed, Formulation, PrescribedMotion

LOCKINGS = ("auto", "mass", "constraints")
_PATIENCE = 4  # times that forces may be evaluated at while no constraint is
MODES = 6  # the first coordinate after those of the rigid-body node

LOCK_RATIO = 1e18  # of the rotor's own inertia
SERVO_RATIO = 1e9
SERVO_RATE = 100.0  # rad/s, critically damped
LOCK_RATE = 1.0  # rad/s: stiffness of a locked coordinate for static solvers, per lock mass
# a spin angle grows without bound, so its stiffness must leave digits for the drive torque
SPIN_HOLD_RATE = 1e3  # rad/s, per own inertia


@dataclass(frozen=True, eq=False)
class Locks:
    """What happens to the six rigid coordinates of the marker body.

    Attributes
    ----------
    unknown : tuple of int
        Rigid coordinates that are unknowns of the formulation.
    fixed : tuple of int
    prescribed : dict of int to PrescribedMotion or ConstantSpeed
        Scalar motion of every prescribed coordinate; that of the spin is θ, whatever its sign.
    spin : {3, 4, 5}
        The coordinate that is the spin angle; the other two rotations are tilts.
    sign : {1, -1}
        −1 where that coordinate is −θ.
    plane : ndarray or None
        Inertial directions of in-plane unknowns, shape (3, 2).
    normal : ndarray or None
        Set when the plane of translation is skew in space: all three translations are unknowns,
        and one linear constraint along this direction holds them in the plane.
    """

    unknown: tuple[int, ...]
    fixed: tuple[int, ...]
    prescribed: dict[int, PrescribedMotion | ConstantSpeed]
    spin: int = THIRD
    sign: int = 1
    plane: np.ndarray | None = None
    normal: np.ndarray | None = None

    @classmethod
    def of(
        cls, formulation: Formulation, spin_direction: np.ndarray, spin: int, sign: int
    ) -> Locks:
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
        tilts = _tilts(spin)
        return cls(unknown, (*rest, *tilts), prescribed, spin, sign, plane, normal)

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


def layout(locks: Locks, mode_count: int, inertia: np.ndarray, by_mass: bool) -> Layout:
    """Return where the unknowns stand and the diagonals that lock the rest.

    `inertia` holds the rotor's mass (three times) and moment of inertia (three times).
    """
    size = MODES + mode_count
    mass, stiffness, damping = np.zeros(size), np.zeros(size), np.zeros(size)
    fixed, varying = list(locks.fixed), list(locks.varying)
    if by_mass:
        mass[fixed] = LOCK_RATIO * inertia[fixed]
        stiffness[fixed] = LOCK_RATE**2 * mass[fixed]
        mass[varying] = SERVO_RATIO * inertia[varying]
        stiffness[varying] = SERVO_RATE**2 * mass[varying]
        damping[varying] = 2.0 * SERVO_RATE * mass[varying]
    else:
        mass[fixed + varying] = inertia[fixed + varying]
    spin = locks.spin
    if isinstance(locks.prescribed.get(spin), ConstantSpeed):
        mass[spin] = LOCK_RATIO * inertia[spin]
        stiffness[spin] = SPIN_HOLD_RATE**2 * inertia[spin]
    unknowns = np.array([*locks.unknown, *range(MODES, size)])
    signs = np.ones(size)
    signs[spin] = locks.sign
    return Layout(size, unknowns, mass, stiffness, damping, signs)


def guiding_force(locks: Locks, place: Layout) -> LockedForce | None:
    """Return the forces, shape (size,), that belong to the prescribed motion of locked coordinates.

    They act on the node's coordinates, with the sign in which these count.

    None where constraints do all of this, or nothing is prescribed.
    """
    guided = [index for index in locks.prescribed if place.lock_stiffness[index]]
    if not guided:
        return None

    def force(t: float) -> np.ndarray:
        total = np.zeros(place.size)
        for index in guided:
            motion = locks.prescribed[index]
            total[index] = (
                place.lock_mass[index] * motion.acceleration(t)
                + place.lock_damping[index] * motion.rate(t)
                + place.lock_stiffness[index] * motion.value(t)
            )
        return place.signs * total

    return force


def add_spin_guide(
    mbs: exudyn.MainSystem, locks: Locks, place: Layout, node: exudyn.NodeIndex
) -> None:
    """Add the guiding force of a constant spin as a load without Python calls.

    A locked spin needs a stiffness for static solvers, and this load takes it along with the
    angle.
    """
    spin = locks.spin
    motion, stiffness = locks.prescribed[spin], locks.sign * place.lock_stiffness[spin]
    if not (motion.speed or motion.angle):
        return
    start, slope = stiffness * motion.angle, stiffness * motion.speed
    marker = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=spin))
    load = mbs.AddLoad(LoadCoordinate(markerNumber=marker, load=0.0))
    guide = CreateSymbolicUserFunction(
        mbs, lambda mbs, t, load: start + slope * t, "loadUserFunction", load
    )
    mbs.SetLoadParameter(load, "loadUserFunction", guide)


class ConstraintMonitor:
    """Stops explicit solvers, which set a constrained coordinate to zero without a word.

    They never evaluate the constraints' prescribed motion, implicit and static solvers do at every
    time. An object of this class stands in for the guiding force (see :func:`guiding_force`),
    which is evaluated in all solvers.
    """

    def __init__(self, force: LockedForce | None, size: int) -> None:
        self._force = force
        self._size = size
        self._last = 0.0
        self._unseen = 0

    def seen(self) -> None:
        """Take note that a constraint has been evaluated."""
        self._unseen = 0

    def __call__(self, t: float) -> np.ndarray:
        """Return the guiding force; raise RuntimeError in a solver that skips constraints."""
        self._unseen = 0 if t < self._last else self._unseen + (t > self._last)
        self._last = t
        if self._unseen > _PATIENCE:
            self._unseen = 0
            raise RuntimeError(
                "this solver ignores the constraints that prescribe the rotor's motion, as "
                "explicit solvers do: add the rotor with locking='mass', or use an implicit solver"
            )
        return np.zeros(self._size) if self._force is None else self._force(t)


def hold(
    mbs: exudyn.MainSystem, locks: Locks, place: Layout, by_mass: bool, node: exudyn.NodeIndex
) -> tuple[LockedForce | None, dict[str, exudyn.ObjectIndex]]:
    """Hold the locked coordinates by mass or constraints.

    Returns the force by which the equations guide them, and the constraints by name.
    """
    guide = guiding_force(locks, place)
    if by_mass:
        return guide, {}
    monitor = ConstraintMonitor(guide, place.size) if locks.varying else None
    return monitor or guide, add_constraints(mbs, locks, node, monitor)


def add_constraints(
    mbs: exudyn.MainSystem, locks: Locks, node: exudyn.NodeIndex, monitor: ConstraintMonitor | None
) -> dict[str, exudyn.ObjectIndex]:
    """Hold the locked coordinates of the marker body's node by constraints; return them by name.

    `monitor` notes evaluations; it is needed where some prescribed motion varies with time.
    """
    ground = mbs.AddNode(NodePointGround())
    origin = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    constraints = {}
    for index in (*locks.fixed, *locks.varying):
        marker = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=index))
        sign = locks.sign if index == locks.spin else 1
        offset = _offset(locks.varying[index], sign, monitor) if index in locks.varying else {}
        constraints[locks.names[index]] = mbs.AddObject(
            CoordinateConstraint(markerNumbers=[origin, marker], **offset)
        )
    if locks.normal is not None:
        constraints["plane"] = mbs.AddObject(_plane_constraint(mbs, ground, node, locks.normal))
    return constraints


def _offset(motion: PrescribedMotion, sign: int, monitor: ConstraintMonitor) -> dict:
    """Return the constraint's settings; index-2 solvers need the velocity beside the position."""

    def value(mbs, t, item, offset):
        monitor.seen()
        return sign * motion.value(t)

    def rate(mbs, t, item, offset):
        monitor.seen()
        return sign * motion.rate(t)

    return {"offsetUserFunction": value, "offsetUserFunction_t": rate}


def _plane_constraint(
    mbs: exudyn.MainSystem, ground: exudyn.NodeIndex, node: exudyn.NodeIndex, normal: np.ndarray
) -> ObjectConnectorCoordinateVector:
    """Return ``eᵀτ = 0`` for a plane that is skew to the inertial axes."""
    markers = [mbs.AddMarker(MarkerNodeCoordinates(nodeNumber=number)) for number in (ground, node)]
    row = np.zeros((1, 6))
    row[0, :3] = normal
    # this connector takes a node's coordinates with their reference values
    reference = np.asarray(mbs.GetNodeParameter(node, "referenceCoordinates"))
    return ObjectConnectorCoordinateVector(
        markerNumbers=markers,
        scalingMarker0=np.zeros((1, 0)),
        scalingMarker1=row,
        offset=row @ reference,
    )
