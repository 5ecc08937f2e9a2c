"""Planning a new rotor body: everything about it, checked, before the system is touched."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np
from exudyn.itemInterface import NodeGenericODE2, NodeRigidBodyRxyz, VNodeRigidBodyRxyz

from exudyn_rotor.multibody.rotor import inputs
from exudyn_rotor.multibody.rotor.equations import Layout
from exudyn_rotor.multibody.rotor.frame import BodyFrame
from exudyn_rotor.multibody.rotor.locking import MODES, Locks, lock_masses
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.reduction.selection import Selection, select_modes
from exudyn_rotor.theory.formulation import Formulation
from exudyn_rotor.theory.motion import Motion
from exudyn_rotor.theory.stiffening import stiffening as second_order


@dataclass(frozen=True, eq=False)
class Plan:
    """A new rotor body, laid out.

    Attributes
    ----------
    setup : Setup
        What was asked for.
    selection : Selection
    frame : BodyFrame
    locks : Locks
    layout : Layout
        Where the unknowns stand among the coordinates of the nodes.
    motion : Motion
    marker_body_gravity : ndarray, shape (3,)
        Gravity that Exudyn applies to the marker body, not the equations [m/s²].
    modal_start, modal_start_rate : ndarray, shape (m,)
        Initial modal coordinates [√kg m] and velocities [√kg m/s].
    """

    setup: inputs.Setup
    selection: Selection
    frame: BodyFrame
    locks: Locks
    layout: Layout
    motion: Motion
    marker_body_gravity: np.ndarray
    modal_start: np.ndarray
    modal_start_rate: np.ndarray

    @property
    def start(self) -> tuple[np.ndarray, np.ndarray]:
        """Modal coordinates and velocities at the start."""
        return self.modal_start, self.modal_start_rate

    def rigid_node(self) -> NodeRigidBodyRxyz:
        """Return the node of the frame, at its place and with its velocity at the start."""
        values, rates = np.zeros(MODES), np.zeros(MODES)
        start, spin = self.setup.placement, self.locks.spin
        values[:3], rates[:3] = start.translation, start.velocity
        values[spin], rates[spin] = start.angle, start.speed
        return NodeRigidBodyRxyz(
            name=inputs.item_name("NodeRigidBody:", self.setup.name),
            referenceCoordinates=[*self.frame.position, *self.frame.angles],
            initialCoordinates=values,
            initialVelocities=rates,
            visualization=VNodeRigidBodyRxyz(show=False),
        )

    def bare_node(self) -> NodeGenericODE2:
        """Return the one node of a rotor without a marker body, with all its unknowns."""
        place, free = self.setup.placement, self.motion.free_directions.T
        spin = int(self.setup.formulation.has_spin)
        values = [*(free @ place.translation), *[place.angle] * spin, *self.modal_start]
        rates = [*(free @ place.velocity), *[place.speed] * spin, *self.modal_start_rate]
        return generic_node(values, rates, inputs.item_name("NodeGeneric:", self.setup.name))


PlanKind = TypeVar("PlanKind", bound=Plan)
# of a formulation, the plane of its translations, and gravity in the equations
Motions = Callable[[Formulation, np.ndarray | None, np.ndarray | None], Motion]


def make_plan(reduced: ReducedRotor, setup: inputs.Setup) -> Plan:
    """Check what needs the modes, and lay out the equations."""
    damped = reduced.with_damping(mass=setup.mass_damping, stiffness=setup.stiffness_damping)
    selection = select_modes(damped, setup.formulation, setup.negligible)
    invariants = selection.invariants
    if setup.stiffening != "none":
        invariants = invariants.loaded
    second = second_order(invariants, setup.stiffening)
    orientation = setup.placement.rotation

    def motion(
        formulation: Formulation, plane: np.ndarray | None, gravity: np.ndarray | None
    ) -> Motion:
        return Motion(invariants, formulation, second, orientation, plane, gravity)

    labels = selection.labels
    return laid_out(
        Plan,
        setup,
        selection,
        motion,
        modal_start=inputs.modal_values(setup.modal_coordinates, "modal_coordinates", labels),
        modal_start_rate=inputs.modal_values(setup.modal_velocities, "modal_velocities", labels),
    )


def laid_out(
    kind: type[PlanKind],
    setup: inputs.Setup,
    selection: Selection,
    motions: Motions,
    **more: Any,
) -> PlanKind:
    """Return a plan of the given kind, with frame, locks, layout and motion.

    `more` is what else the kind holds.
    """
    formulation, invariants = setup.formulation, selection.invariants
    place = setup.placement
    turned = turned_origin(selection, place.rotation, place.angle)
    place = replace(place, translation=place.translation + turned)
    setup = replace(setup, placement=place)
    direction = invariants.direction
    frame = BodyFrame.of(
        direction, selection.origin, place.position, place.rotation, setup.frame_node
    )
    locks = Locks.of(formulation, place.rotation @ direction, frame.spin)
    skew = setup.marker_body and locks.normal is not None
    if skew and setup.locking == "mass":
        raise ValueError(
            "locking='mass' cannot hold the rotor in a plane that is skew to the inertial axes; "
            "use locking='constraints', translation='free', or marker_body=False"
        )
    # gravity on the marker body exerts no moment about e by the deflection Sζ; a free spin needs it
    in_equations = not setup.marker_body or (
        formulation.has_spin and formulation.translation_count == 0
    )
    # a skew plane of rotation keeps all three translations and adds a linear constraint
    form = replace(formulation, translation="free") if skew else formulation
    motion = motions(form, locks.plane, setup.gravity if in_equations else None)
    return kind(
        setup=setup,
        selection=selection,
        frame=frame,
        locks=locks,
        layout=_layout(setup, locks, motion),
        motion=motion,
        marker_body_gravity=np.zeros(3) if in_equations else setup.gravity,
        **more,
    )


def _layout(setup: inputs.Setup, locks: Locks, motion: Motion) -> Layout:
    """Return where the unknowns stand among the coordinates of the nodes, and what is locked."""
    if not setup.marker_body:
        return Layout.unlocked(motion.size)
    inv = motion.invariants
    size = MODES + inv.size
    # a rotor all on its axis has no inertia about it, and its locked spin still needs one
    about_axis = inv.Theta or np.trace(inv.J) or inv.mass
    inertia = np.repeat([inv.mass, about_axis], 3)
    unknowns = np.array([*locks.unknown, *range(MODES, size)])
    return Layout(size, unknowns, lock_masses(locks, size, inertia, setup.locking == "mass"))


def turned_origin(selection: Selection, rotation: np.ndarray, angle: float) -> np.ndarray:
    """Return by how much the frame origin moves where the rotor turns about its axis [m].

    The origin is the centre of mass, which may be off the axis, where the translation is free.

    Parameters
    ----------
    selection : Selection
    rotation : ndarray, shape (3, 3)
        Mesh axes → axes of the result, at θ = 0.
    angle : float
        θ [rad].
    """
    axis = selection.source.axis
    off = axis.radial(selection.origin)
    return rotation @ ((np.cos(angle) - 1.0) * off + np.sin(angle) * axis.skew @ off)


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
