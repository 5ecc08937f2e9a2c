"""Planning a new rotor body: what a user asks, checked and laid out before it is added."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import exudyn
import numpy as np
from exudyn.itemInterface import NodeGenericODE2, NodeRigidBodyRxyz, VNodeRigidBodyRxyz
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.rotor.frame import MODES, BodyFrame, Layout, LockedForce, Locks
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.reduction.selection import Selection, select_modes
from exudyn_rotor.theory.formulation import Formulation, start_values
from exudyn_rotor.theory.motion import Motion
from exudyn_rotor.theory.stiffening import Stiffening
from exudyn_rotor.theory.stiffening import stiffening as second_order

MARKER_KINDS = ("rigid", "position")


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
    """A rotor body as it was asked for; the attributes are arguments of ``add_rotor``, checked.

    The start values of modal coordinates are checked by the plan, which knows the modes.
    """

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
    direction: np.ndarray,
    position: ArrayLike,
    rotation: ArrayLike | None,
    initial_velocity: ArrayLike,
    initial_angle: float | None,
    initial_speed: float | None,
) -> Placement:
    """Check and complete the placement; a prescribed motion brings its own initial values.

    `direction` is the spin axis in mesh axes.
    """
    place = checks.vector(position, "position", "m")
    turn = np.eye(3) if rotation is None else checks.rotation(rotation)
    velocity = checks.vector(initial_velocity, "initial_velocity", "m/s")
    start = np.zeros(3)
    if formulation.moves_origin:
        if np.any(velocity):
            raise ValueError(
                "velocity given twice: by initial_velocity and by the translation τ(t)"
            )
        start, velocity, _ = start_values(formulation.translation, "translation")
    else:
        _check_direction(formulation, velocity, turn @ direction)
    if formulation.has_spin:
        angle = 0.0 if initial_angle is None else initial_angle
        speed = 0.0 if initial_speed is None else initial_speed
        angle = checks.number(angle, "initial_angle", "rad")
        speed = checks.number(speed, "initial_speed", "rad/s")
        return Placement(place, turn, start, velocity, angle, speed)
    if initial_angle is not None or initial_speed is not None:
        raise ValueError(
            "spin given twice: by a prescribed spin, and by initial_angle or initial_speed; leave "
            "these out"
        )
    angle, speed, _ = start_values(formulation.spin, "spin")
    return Placement(place, turn, start, velocity, angle, speed)


def _check_direction(formulation: Formulation, velocity: np.ndarray, axis: np.ndarray) -> None:
    """Refuse a velocity that the formulation cannot have; `axis` in inertial axes."""
    lost = {3: 0.0 * velocity, 2: axis * (axis @ velocity), 0: velocity}
    missing = np.linalg.norm(lost[formulation.translation_count])
    if missing > 1e-9 * np.linalg.norm(velocity):
        raise ValueError(
            f"initial_velocity: translation={formulation.translation!r} has no such motion, "
            f"{missing:.3g} m/s of {velocity.tolist()} m/s; use translation='free', or velocities "
            "of translation modes in modal_velocities"
        )


def _modal_values(values: ArrayLike | None, name: str, labels: tuple[str, ...]) -> np.ndarray:
    """Return one value per mode, zeros for None."""
    if values is None:
        return np.zeros(len(labels))
    described = f"{name} (one per mode: {', '.join(labels)})"
    return checks.vector(values, described, "√kg m", size=len(labels))


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


def item_name(prefix: str, name: str | None) -> str:
    """Return the name of an item, empty for a rotor without a name."""
    return "" if name is None else f"{prefix}{name}"


def marker_name(name: str | None, interface: str) -> str:
    """Return the name of an interface's marker."""
    return interface if name is None else f"{name}:{interface}"


def check_free_names(mbs: exudyn.MainSystem, setup: Setup) -> None:
    """Refuse a name that an item of `mbs` already has."""
    name = setup.name
    taken = [(mbs.GetMarkerNumber, marker_name(name, one)) for one in setup.marker_kinds]
    if name is not None:
        taken.append((mbs.GetObjectNumber, name))
    for find, item in taken:
        if int(find(item)) != -1:
            raise ValueError(
                f"name {name!r}: this system already has an item {item!r}; "
                "give the second rotor another name"
            )


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
    def guide(self) -> LockedForce | None:
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
    rigid = NodeRigidBodyRxyz(
        name=item_name("NodeRigidBody:", plan.name),
        referenceCoordinates=[*plan.frame.position, *plan.frame.angles],
        initialCoordinates=values,
        initialVelocities=rates,
        visualization=VNodeRigidBodyRxyz(show=False),
    )
    name = item_name("NodeGeneric:", plan.name)
    modes = generic_node(plan.modal_coordinates, plan.modal_velocities, name)
    return mbs.AddNode(rigid), mbs.AddNode(modes)


def make_plan(reduced: ReducedRotor, setup: Setup) -> Plan:
    """Check what needs the modes, and lay out the equations."""
    damped = reduced.with_damping(mass=setup.mass_damping, stiffness=setup.stiffness_damping)
    selection = select_modes(damped, setup.formulation)
    invariants = selection.invariants
    if setup.stiffening != "none":
        invariants = invariants.loaded
    second = second_order(invariants, setup.stiffening)
    start = partial(_modal_values, labels=selection.labels)
    return laid_out(setup, selection, partial(Motion, invariants), second, start)


def laid_out(
    setup: Setup,
    selection: Selection,
    motions: Callable[..., Motion],
    second: Stiffening,
    start: Callable[[ArrayLike | None, str], np.ndarray],
) -> Plan:
    """Return a plan with frame, locks, layout and motion.

    `motions` knows the invariants, and `start` makes initial coordinates of what was given.
    """
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
    if locks.normal is not None:
        if setup.locking == "mass":
            raise ValueError(
                "locking='mass' cannot hold the rotor in a plane that is skew to the inertial "
                "axes; use locking='constraints' or translation='free'"
            )
        # a skew plane of rotation keeps all three translations and adds a linear constraint
        formulation = replace(formulation, translation="free")
    # gravity as a load exerts no moment about e by the deflection Sζ; a free spin needs it
    in_equations = formulation.has_spin and formulation.translation_count == 0
    gravity = setup.gravity if in_equations else None
    motion = motions(formulation, second, place.rotation, locks.plane, gravity)
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
        ratio = _ELIMINATED_RATIO if locks.stand_still else 1.0
        if setup.locking == "mass":
            ratio = _DRIVEN_RATIO if index in locks.varying else _LOCK_RATIO
        masses[index] = inertia[index] * ratio
    return Layout(size, np.array([*locks.unknown, *range(MODES, size)]), masses)


def turned_origin(selection: Selection, rotation: np.ndarray, angle: float) -> np.ndarray:
    """Return by how much the frame origin moves where the rotor turns about its axis [m].

    The origin is the centre of mass, which may be off the axis, where the translation is free. The
    `rotation` takes mesh axes to axes of the result at θ = 0.
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
