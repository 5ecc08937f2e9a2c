"""Planning a new rotor body: what a user asks, checked, placed and laid out before it is added.

Which angle of the flexible body's node is the spin angle follows from the placement.
``NodeRigidBodyRxyz`` has the orientation ``Rx(a) Ry(b) Rz(c)``, and any one of the three angles may
turn without bound while the other two stand still. With n the spin axis in inertial axes and e in
mesh axes, the body can have the axes of the mesh where e is mesh z (c turns), n is inertial x (a
turns), or n is across inertial x and e across mesh z (b turns). Elsewhere the axes of the marker
body are the mesh axes turned by B, with ``B e = e_z``, and c turns.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import exudyn
import numpy as np
from exudyn.itemInterface import (
    CoordinateConstraint,
    MarkerNodeCoordinate,
    MarkerNodeCoordinates,
    NodeGenericODE2,
    NodePointGround,
    NodeRigidBodyRxyz,
    ObjectConnectorCoordinateVector,
    VCoordinateConstraint,
    VNodeRigidBodyRxyz,
)
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from exudyn_rotor import checks
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.reduction.selection import Selection, select_modes
from exudyn_rotor.theory.formulation import (
    ConstantSpeed,
    Formulation,
    PrescribedMotion,
    start_values,
)
from exudyn_rotor.theory.motion import Motion
from exudyn_rotor.theory.stiffening import stiffening as second_order

FIRST, SECOND, THIRD = 3, 4, 5  # the angles among the coordinates of the node
_ALONG = 1e-8  # sine of the angle up to which an axis counts as a coordinate axis


@dataclass(frozen=True, eq=False)
class BodyFrame:
    """Mesh and scene as the marker body sees them."""

    origin: np.ndarray  # (3,) Of the frame, mesh coordinates [m]
    position: np.ndarray  # (3,) Of the frame origin at rest, inertial coordinates [m]
    B: np.ndarray  # (3, 3) Mesh axes → axes of the marker body, the identity where that can be
    angles: np.ndarray  # (3,) Reference Tait–Bryan angles (a, b, c) of the node [rad]
    spin: int  # 3, 4 or 5: the node's coordinate that is the spin angle

    @classmethod
    def of(
        cls, direction: np.ndarray, center: np.ndarray, position: np.ndarray, rotation: np.ndarray
    ) -> BodyFrame:
        """Place a rotor whose mesh origin lies at `position` with the orientation `rotation`.

        The origin is next to the mesh origin, where Exudyn's own body has its node. The frame does
        not tilt, so that its motion there is that of the `center`, the formulation's origin.
        """
        origin = center - direction * (direction @ center)
        return cls(origin, position + rotation @ origin, *_body_axes(direction, rotation))

    def axes_of_angles(self) -> np.ndarray:
        """Return the inertial axes (3, 3), in rows, that the node's angles turn about at rest."""
        a, b, _ = self.angles
        Rx, Ry = Rotation.from_euler("x", a).as_matrix(), Rotation.from_euler("y", b).as_matrix()
        return np.array([[1.0, 0.0, 0.0], Rx[:, 1], Rx @ Ry[:, 2]])

    def points(self, mesh_points: np.ndarray) -> np.ndarray:
        """Return mesh points (…, 3) in coordinates of the marker body."""
        return (np.asarray(mesh_points) - self.origin) @ self.B.T

    def columns(self, displacements: np.ndarray) -> np.ndarray:
        """Return nodal displacement columns (3n, k), given in mesh axes, in those of the body."""
        nodal = displacements.reshape(-1, 3, displacements.shape[1])
        return np.einsum("ab,nbk->nak", self.B, nodal).reshape(displacements.shape)


def _body_axes(e: np.ndarray, orientation: np.ndarray) -> tuple[np.ndarray, np.ndarray, int]:
    """Return mesh axes → axes of the body, its angles at rest, and the spin coordinate."""
    n, B = orientation @ e, np.eye(3)
    if np.hypot(e[0], e[1]) < _ALONG and e[2] > 0.0:
        return B, _tait_bryan(orientation), THIRD
    if np.hypot(n[1], n[2]) < _ALONG and n[0] > 0.0:
        return B, _tait_bryan(orientation), FIRST
    if abs(n[0]) < _ALONG and abs(e[2]) < _ALONG:  # Rx(a) e_y = n and Rz(−c) e_y = e
        a, c = np.arctan2(n[2], n[1]), np.arctan2(e[0], e[1])
        Ry = Rotation.from_euler("x", -a).as_matrix() @ orientation
        Ry = Ry @ Rotation.from_euler("z", -c).as_matrix()
        return B, np.array([a, np.arctan2(Ry[0, 2], Ry[0, 0]), c]), SECOND
    across = np.cross(e, [0.0, 0.0, 1.0])
    sine = np.linalg.norm(across)
    across = across / sine if sine else np.array([1.0, 0.0, 0.0])  # any serves for −e_z
    B = Rotation.from_rotvec(np.arctan2(sine, e[2]) * across).as_matrix()
    return B, _tait_bryan(orientation @ B.T), THIRD


def _tait_bryan(orientation: np.ndarray) -> np.ndarray:
    with warnings.catch_warnings():
        # at b = ±90° the split of a and c is free, and any serves: one of them turns by θ
        warnings.simplefilter("ignore", UserWarning)
        # a copy, as scipy takes no read-only matrix before 1.15.2
        return Rotation.from_matrix(np.array(orientation)).as_euler("XYZ")


LOCKINGS = ("auto", "mass", "constraints")
MARKER_KINDS = ("rigid", "position")
MODES = 6  # the first coordinate after those of the rigid-body node
LOCKS = "locks"  # name of the constraint of all that stands still or turns at constant speed


@dataclass(frozen=True, eq=False)
class Locks:
    """What happens to the six rigid coordinates of the marker body."""

    unknown: tuple[int, ...]  # coordinates that are unknowns of the formulation
    fixed: tuple[int, ...]  # the tilts at last
    prescribed: dict[int, PrescribedMotion | ConstantSpeed]  # by the coordinate, scalar
    spin: int  # the spin angle

    @classmethod
    def of(cls, formulation: Formulation, spin_direction: np.ndarray, spin: int) -> Locks:
        """Sort the coordinates for a spin axis along `spin_direction` in inertial axes."""
        along = int(np.argmax(np.abs(spin_direction)))
        rest = {0: [0, 1, 2], 2: [along], 3: []}[formulation.translation_count]
        unknown = [i for i in range(3) if i not in rest]
        prescribed: dict[int, PrescribedMotion | ConstantSpeed] = {}
        if formulation.moves_origin:
            prescribed = {i: _component(formulation.translation, i) for i in rest}
            rest = []
        if formulation.has_spin:
            unknown.append(spin)
        else:
            prescribed[spin] = formulation.spin
        tilts = [i for i in range(3, MODES) if i != spin]
        return cls(tuple(unknown), (*rest, *tilts), prescribed, spin)

    @property
    def tilts(self) -> tuple[int, int]:
        """The two coordinates that tilt the frame, always locked."""
        return self.fixed[-2:]

    @property
    def names(self) -> list[str]:
        """Names of the six coordinates."""
        names = ["x", "y", "z", "tilt a", "tilt b"]
        names.insert(self.spin, "spin")
        return names

    @property
    def varying(self) -> dict[int, PrescribedMotion]:
        """Coordinates with a time-varying prescribed motion."""
        return {i: m for i, m in self.prescribed.items() if isinstance(m, PrescribedMotion)}

    @property
    def locked_names(self) -> tuple[str, ...]:
        """Names of the coordinates that are no unknowns."""
        return tuple(self.names[i] for i in (*self.fixed, *self.prescribed))


def _component(motion: PrescribedMotion, index: int) -> PrescribedMotion:
    """Return one coordinate of a prescribed translation."""
    return PrescribedMotion(
        lambda t: float(motion.value(t)[index]),
        lambda t: float(motion.rate(t)[index]),
        lambda t: float(motion.acceleration(t)[index]),
    )


def in_space(formulation: Formulation, spin_direction: np.ndarray) -> Formulation:
    """Return a formulation whose translations are along inertial axes, with the same motion.

    Beside a plane that is skew to them that is the one with all three translations.
    """
    if formulation.translation_count == 2 and np.abs(spin_direction).max() <= 1.0 - 1e-14:
        return replace(formulation, translation="free")
    return formulation


@dataclass(frozen=True, eq=False)
class Layout:
    """Where the unknowns of a formulation stand among the coordinates of the nodes."""

    size: int  # of the nodes' coordinates
    unknowns: np.ndarray  # the coordinate of every unknown of the equations
    lock_mass: np.ndarray  # (size,) Masses of locked coordinates, zero for unknowns

    def spread(self, matrix: np.ndarray, diagonal: np.ndarray | float = 0.0) -> np.ndarray:
        """Return a (size, size) matrix with `matrix` on the unknowns and `diagonal` added."""
        full = np.diag(np.broadcast_to(diagonal, self.size).astype(float))
        full[np.ix_(self.unknowns, self.unknowns)] += matrix
        return full


def held(
    mbs: exudyn.MainSystem,
    ground: exudyn.NodeIndex,
    node: exudyn.NodeIndex,
    index: int,
    **motion: Any,
) -> exudyn.ObjectIndex:
    """Add a constraint of one coordinate of a node; explicit solvers eliminate it."""
    ends = [
        mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=number, coordinate=coordinate))
        for number, coordinate in ((ground, 0), (node, index))
    ]
    hidden = VCoordinateConstraint(show=False)
    return mbs.AddObject(CoordinateConstraint(markerNumbers=ends, visualization=hidden, **motion))


def add_constraints(
    mbs: exudyn.MainSystem, locks: Locks, node: exudyn.NodeIndex
) -> dict[str, exudyn.ObjectIndex]:
    """Hold the locked coordinates of the frame's node by constraints; return them by name."""
    ground = mbs.AddNode(NodePointGround())
    if not locks.prescribed:
        return {locks.names[index]: held(mbs, ground, node, index) for index in locks.fixed}
    ends = [mbs.AddMarker(MarkerNodeCoordinates(nodeNumber=number)) for number in (ground, node)]
    rates = dict.fromkeys(locks.fixed, 0.0)
    rates |= {i: m.speed for i, m in locks.prescribed.items() if isinstance(m, ConstantSpeed)}
    # at velocity level: drift is round-off, and a constant speed needs no function of time
    item = ObjectConnectorCoordinateVector(
        markerNumbers=ends,
        scalingMarker0=np.zeros((len(rates), 0)),
        scalingMarker1=np.eye(MODES)[list(rates)],
        offset=list(rates.values()),
        velocityLevel=True,
        visualization={"show": False},
    )
    constraints = {LOCKS: mbs.AddObject(item)}
    for index, motion in locks.varying.items():
        # index-2 solvers need the velocity beside the position
        constraints[locks.names[index]] = held(
            mbs,
            ground,
            node,
            index,
            offsetUserFunction=lambda mbs, t, item, offset, motion=motion: motion.value(t),
            offsetUserFunction_t=lambda mbs, t, item, offset, motion=motion: motion.rate(t),
        )
    return constraints


@dataclass(frozen=True, eq=False)
class Placement:
    """Where the rotor stands and how it starts."""

    position: np.ndarray  # (3,) Of the mesh origin, inertial axes [m]
    rotation: np.ndarray  # (3, 3) Mesh axes → inertial axes at θ = 0
    # (3,) Initial translation of the frame origin, inertial axes [m]; a plan adds by how much the
    # initial angle moves it
    translation: np.ndarray
    velocity: np.ndarray  # (3,) Initial one of the frame origin, inertial axes [m/s]
    angle: float  # of the spin at the start [rad]
    speed: float  # of the spin at the start [rad/s]


@dataclass(frozen=True, eq=False)
class Setup:
    """A rotor body as asked for: arguments of ``add_rotor``, checked but for start values."""

    name: str | None
    formulation: Formulation
    stiffening: str
    placement: Placement
    modal_coordinates: ArrayLike | None
    modal_velocities: ArrayLike | None
    gravity: np.ndarray
    mass_damping: float
    stiffness_damping: float
    marker_kinds: Mapping[str, str]
    locking: str
    color: tuple[float, ...]


def placement(
    formulation: Formulation,
    axis: np.ndarray,
    position: ArrayLike,
    rotation: np.ndarray,
    initial_velocity: ArrayLike,
    initial_angle: float | None,
    initial_speed: float | None,
) -> Placement:
    """Check and complete the placement of a rotor with a spin `axis` in inertial axes."""
    place = checks.vector(position, "position", "m")
    velocity, start = checks.vector(initial_velocity, "initial_velocity", "m/s"), np.zeros(3)
    lost = {3: 0.0 * velocity, 2: axis * (axis @ velocity), 0: velocity}
    missing = np.linalg.norm(lost[formulation.translation_count])
    if missing > 1e-9 * np.linalg.norm(velocity):
        raise ValueError(
            f"initial_velocity: the formulation has no such motion, {missing:.3g} m/s of "
            f"{velocity.tolist()} m/s; use translation='free', velocities of translation modes in "
            "modal_velocities, or the velocity of a prescribed translation"
        )
    if formulation.moves_origin:
        start, velocity, _ = start_values(formulation.translation, "translation")
    if formulation.has_spin:
        angle = 0.0 if initial_angle is None else initial_angle
        speed = 0.0 if initial_speed is None else initial_speed
        angle = checks.number(angle, "initial_angle", "rad")
        speed = checks.number(speed, "initial_speed", "rad/s")
    elif initial_angle is not None or initial_speed is not None:
        raise ValueError(
            "spin given twice: by a prescribed spin, and by initial_angle or initial_speed; leave "
            "these out"
        )
    else:
        angle, speed, _ = start_values(formulation.spin, "spin")
    return Placement(place, rotation, start, velocity, angle, speed)


def color_of(values: Sequence[float]) -> tuple[float, ...]:
    """Return red, green, blue and opacity, each from 0 to 1."""
    result = checks.vector(values, "color", "RGBA", size=4)
    if np.any((result < 0.0) | (result > 1.0)):
        raise ValueError(f"color: needs 4 numbers from 0 to 1 (RGBA), got {checks.shown(values)}")
    return tuple(result.tolist())


def marker_kinds(
    interfaces: Mapping[str, object], markers: Mapping[str, str] | str | None
) -> dict[str, str]:
    """Return the kind of the marker at every interface that gets one; None makes all rigid."""
    if markers is None:
        markers = "rigid"
    if isinstance(markers, str):
        return dict.fromkeys(interfaces, checks.choice(markers, "markers", MARKER_KINDS))
    checks.mapping(markers, "markers", "'rigid' or 'position'", interfaces)
    return {
        name: checks.choice(kind, f"markers: kind of {name!r}", MARKER_KINDS)
        for name, kind in markers.items()
    }


def main_system(mbs: exudyn.MainSystem) -> exudyn.MainSystem:
    """Return an Exudyn system."""
    return checks.instance(
        mbs, "mbs", exudyn.MainSystem, "exudyn.SystemContainer().AddSystem() makes one"
    )


def marker_name(name: str | None, interface: str) -> str:
    """Return the name of an interface's marker."""
    return interface if name is None else f"{name}:{interface}"


def check_free(name: str, what: str, find: Callable[[str], int]) -> None:
    """Refuse a name that an item of an ``mbs`` has already; `find` returns its number, or -1."""
    if int(find(checks.label(name, "name"))) != -1:
        raise ValueError(f"name: this system already has a {what} {name!r}; choose another")


@dataclass(frozen=True, eq=False)
class Plan(Setup):
    """A new rotor body, laid out: a reduced one, or a full one with nodal displacements for modes.

    The start values of :class:`Setup` are those of all modal coordinates here. Attributes are
    described at :class:`exudyn_rotor.RotorBody`.
    """

    selection: Selection
    frame: BodyFrame
    locks: Locks
    layout: Layout
    motion: Motion

    @property
    def guide(self) -> Callable[[float], np.ndarray] | None:
        """Forces (size,) over time that drive huge masses; None where none is driven."""
        varying, masses = self.locks.varying, self.layout.lock_mass

        def force(t: float) -> np.ndarray:
            total = np.zeros(len(masses))
            for index, motion in varying.items():
                total[index] = masses[index] * motion.acceleration(t)
            return total

        return force if self.locking == "mass" and varying else None


def add_nodes(mbs: exudyn.MainSystem, plan: Plan) -> tuple[exudyn.NodeIndex, exudyn.NodeIndex]:
    """Add the node of the frame, and that of modes or displacements, as they start."""
    values, rates = np.zeros(MODES), np.zeros(MODES)
    start, spin = plan.placement, plan.locks.spin
    values[:3], rates[:3] = start.translation, start.velocity
    values[spin], rates[spin] = start.angle, start.speed
    kinds = "NodeRigidBody:", "NodeGeneric:"
    names = ["" if plan.name is None else kind + plan.name for kind in kinds]
    rigid = NodeRigidBodyRxyz(
        name=names[0],
        referenceCoordinates=[*plan.frame.position, *plan.frame.angles],
        initialCoordinates=values,
        initialVelocities=rates,
        visualization=VNodeRigidBodyRxyz(show=False),
    )
    modes = generic_node(plan.modal_coordinates, plan.modal_velocities, names[1])
    return mbs.AddNode(rigid), mbs.AddNode(modes)


def make_plan(reduced: ReducedRotor, setup: Setup) -> Plan:
    """Check what needs the modes, and lay out the equations."""
    damped = reduced.with_damping(mass=setup.mass_damping, stiffness=setup.stiffness_damping)
    selection = select_modes(damped, setup.formulation)
    whole = selection.invariants
    invariants = whole if setup.stiffening == "none" else whole.loaded
    second = second_order(invariants, setup.stiffening)
    described = f"(one per mode: {', '.join(selection.labels)})"

    def start(values: ArrayLike | None, name: str) -> np.ndarray:
        size = len(selection.labels)
        values = np.zeros(size) if values is None else values
        return checks.vector(values, f"{name} {described}", "√kg m", size=size)

    return laid_out(setup, selection, partial(Motion, invariants, setup.formulation, second), start)


def laid_out(
    setup: Setup,
    selection: Selection,
    motions: Callable[..., Motion],
    start: Callable[[ArrayLike | None, str], np.ndarray],
) -> Plan:
    """Return a plan; `motions` lacks orientation, plane and gravity, `start` checks coordinates."""
    formulation, place = setup.formulation, setup.placement
    turned = turned_origin(selection, place.rotation, place.angle)
    setup = replace(
        setup,
        placement=replace(place, translation=place.translation + turned),
        modal_coordinates=start(setup.modal_coordinates, "modal_coordinates"),
        modal_velocities=start(setup.modal_velocities, "modal_velocities"),
    )
    direction = selection.invariants.direction
    frame = BodyFrame.of(direction, selection.origin, place.position, place.rotation)
    locks = Locks.of(formulation, place.rotation @ direction, frame.spin)
    plane = np.eye(3)[:, locks.unknown[:2]] if formulation.translation_count == 2 else None
    # gravity as a load exerts no moment about e by the deflection Sζ; a free spin needs it
    in_equations = formulation.has_spin and formulation.translation_count == 0
    motion = motions(place.rotation, plane, setup.gravity if in_equations else None)
    layout = _layout(setup, locks, motion)
    return Plan(
        **vars(setup), selection=selection, frame=frame, locks=locks, layout=layout, motion=motion
    )


_LOCK_RATIO = 1e18  # masses of locked coordinates over those of the rotor
# beside a constraint that explicit solvers eliminate: of what moves within one of their steps
_ELIMINATED_RATIO = 1e9
# of coordinates that are driven: rounding of the driving force is seen in the external one
_DRIVEN_RATIO = 1e9


def _layout(setup: Setup, locks: Locks, motion: Motion) -> Layout:
    """Return where the unknowns stand among the coordinates of the nodes, and what is locked."""
    inv = motion.invariants
    # a rotor all on its axis has no inertia about it, and its locked spin still needs one
    about_axis = inv.Theta or np.trace(inv.J) or inv.mass
    inertia, size = np.repeat([inv.mass, about_axis], 3), MODES + inv.size
    masses = np.zeros(size)
    for index in (*locks.fixed, *locks.prescribed):
        ratio = 1.0 if locks.prescribed else _ELIMINATED_RATIO
        if setup.locking == "mass":
            ratio = _DRIVEN_RATIO if index in locks.varying else _LOCK_RATIO
        masses[index] = inertia[index] * ratio
    return Layout(size, np.array([*locks.unknown, *range(MODES, size)]), masses)


def turned_origin(selection: Selection, rotation: np.ndarray, angle: float) -> np.ndarray:
    """Return by how much a frame origin off the axis moves where the rotor turns about it [m].

    The `rotation` takes mesh axes to axes of the result at θ = 0.
    """
    axis = selection.source.axis
    off = axis.radial(selection.origin)
    return rotation @ ((np.cos(angle) - 1.0) * off + np.sin(angle) * np.cross(axis.direction, off))


def generic_node(
    values: Sequence[float], rates: Sequence[float], name: str = ""
) -> NodeGenericODE2:
    """Return a node of coordinates with start values and rates."""
    return NodeGenericODE2(
        name=name,
        numberOfODE2Coordinates=len(values),
        referenceCoordinates=np.zeros(len(values)),
        initialCoordinates=values,
        initialCoordinates_t=rates,
    )
