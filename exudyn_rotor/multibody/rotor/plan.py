"""Planning a new rotor body: everything about it, checked, before the system is touched."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np

from exudyn_rotor.multibody.rotor import inputs
from exudyn_rotor.multibody.rotor.equations import Layout
from exudyn_rotor.multibody.rotor.frame import BodyFrame
from exudyn_rotor.multibody.rotor.locking import Locks, layout
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
        Equations for θ about the spin axis.
    node_motion : Motion
        The same for the spin coordinate of the node, which may be −θ.
    by_mass : bool
        Whether locked coordinates are held by mass, not by constraints.
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
    node_motion: Motion
    by_mass: bool
    marker_body_gravity: np.ndarray
    modal_start: np.ndarray
    modal_start_rate: np.ndarray


PlanKind = TypeVar("PlanKind", bound=Plan)
# of a formulation, the plane of its translations, gravity in the equations, and the sense in which
# the node counts the spin
Motions = Callable[[Formulation, np.ndarray | None, np.ndarray | None, int], Motion]


def make_plan(reduced: ReducedRotor, setup: inputs.Setup) -> Plan:
    """Check what needs the modes, and lay out the equations."""
    damped = reduced.with_damping(mass=setup.mass_damping, stiffness=setup.stiffness_damping)
    selection = select_modes(damped, setup.formulation, setup.negligible)

    def motion(
        formulation: Formulation, plane: np.ndarray | None, gravity: np.ndarray | None, sign: int
    ) -> Motion:
        invariants = selection.invariants
        if setup.stiffening != "none":
            invariants = invariants.loaded
        invariants = invariants if sign > 0 else invariants.reversed()
        return Motion(
            invariants,
            formulation,
            second_order(invariants, setup.stiffening),
            orientation=setup.placement.rotation,
            plane=plane,
            gravity=gravity,
        )

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
    """Return a plan of the given kind, with frame, locks, layout and motions.

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
    sign = frame.sign if setup.marker_body else 1
    locks = Locks.of(formulation, place.rotation @ direction, frame.spin, sign)
    skew = setup.marker_body and locks.normal is not None
    by_mass = _is_held_by_mass(setup.locking, locks, skew)
    # gravity on the marker body exerts no moment about e by the deflection Sζ; a free spin needs it
    in_equations = not setup.marker_body or (
        formulation.has_spin and formulation.translation_count == 0
    )
    # a rotor all on its axis has no inertia about it, and its locked spin still needs one
    spin_inertia = invariants.Theta or np.trace(invariants.J) or invariants.mass
    inertia = np.repeat([invariants.mass, spin_inertia], 3)
    # a skew plane of rotation keeps all three translations and adds a linear constraint
    form = replace(formulation, translation="free") if skew else formulation
    gravity = setup.gravity if in_equations else None
    motion = motions(form, locks.plane, gravity, 1)
    node_motion = motion
    if sign < 0:
        node_motion = motions(form.reversed(), motion.free_directions, gravity, -1)
    return kind(
        setup=setup,
        selection=selection,
        frame=frame,
        locks=locks,
        layout=(
            layout(locks, invariants.size, inertia, by_mass)
            if setup.marker_body
            else Layout.unlocked(motion.size)
        ),
        motion=motion,
        node_motion=node_motion,
        by_mass=by_mass,
        marker_body_gravity=np.zeros(3) if in_equations else setup.gravity,
        **more,
    )


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


def _is_held_by_mass(locking: str, locks: Locks, skew: bool) -> bool:
    """Return whether masses hold locked coordinates, which they cannot in a skew plane."""
    if locking == "mass" and skew:
        raise ValueError(
            "locking='mass' cannot hold the rotor in a plane that is skew to the inertial axes; "
            "use locking='constraints', translation='free', or marker_body=False"
        )
    return locking == "mass" or (locking == "auto" and not locks.varying and not skew)
