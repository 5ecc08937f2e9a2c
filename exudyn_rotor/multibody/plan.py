"""Planning a new rotor body: everything about it, checked, before the system is touched."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor.multibody import inputs
from exudyn_rotor.multibody.equations import Layout
from exudyn_rotor.multibody.frame import ShellFrame
from exudyn_rotor.multibody.locking import LOCKINGS, Locks, layout
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.reduction.selection import Selection, select_modes
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.formulation import Formulation
from exudyn_rotor.theory.motion import Motion
from exudyn_rotor.theory.stiffening import stiffening as second_order


@dataclass(frozen=True, eq=False)
class Plan:
    """A new rotor body; `shell_gravity` is what the native shell brings by itself [m/s²]."""

    name: str | None
    axis: SpinAxis
    formulation: Formulation
    stiffening: str
    selection: Selection
    placement: inputs.Placement
    frame: ShellFrame
    locks: Locks
    layout: Layout
    motion: Motion
    by_mass: bool
    shell_gravity: np.ndarray
    modal: tuple[np.ndarray, np.ndarray]


def make_plan(
    reduced: ReducedRotor,
    name: str | None,
    formulation: Formulation,
    stiffening: str,
    place: inputs.Placement,
    gravity: np.ndarray,
    rayleigh: tuple[float, float],
    modal: tuple[ArrayLike | None, ArrayLike | None],
    locking: str,
    native_shell: bool,
    negligible: float,
) -> Plan:
    """Check what is left to check, and lay out the equations.

    `rayleigh` and `modal` are pairs: mass and stiffness damping, modal coordinates and velocities.
    """
    if locking not in LOCKINGS:
        raise ValueError(f"locking {locking!r} is unknown; use one of {', '.join(LOCKINGS)}")
    selection = select_modes(reduced, formulation, negligible)
    invariants = selection.invariants
    mode_mass = selection.T.T @ reduced.mode_mass @ selection.T
    damping = invariants.D + rayleigh[0] * mode_mass + rayleigh[1] * invariants.K
    invariants = replace(invariants, D=damping)
    direction = reduced.axis.direction
    frame = ShellFrame.of(direction, selection.origin, place.position, place.rotation)
    locks = Locks.of(formulation, place.rotation @ direction)
    skew = native_shell and locks.normal is not None
    if locking == "mass" and skew:
        raise ValueError(
            "locking='mass' cannot hold the rotor in a plane that is skew to the inertial axes; "
            "use locking='constraints', translation='free', or native_shell=False"
        )
    # gravity on the shell exerts no moment about e by the deflection Sζ, which a free spin needs
    own_gravity = not native_shell or (formulation.has_spin and formulation.translation_count == 0)
    by_mass = locking == "mass" or (locking == "auto" and not locks.varying and not skew)
    # a rotor all on its axis has no inertia about it, and its locked spin still needs one
    spin_inertia = invariants.Theta or np.trace(invariants.J) or invariants.mass
    own = np.repeat([invariants.mass, spin_inertia], 3)
    return Plan(
        name=name,
        axis=reduced.axis,
        formulation=formulation,
        stiffening=stiffening,
        selection=selection,
        placement=place,
        frame=frame,
        locks=locks,
        layout=layout(locks, invariants.size, own, by_mass),
        motion=Motion(
            invariants,
            # a skew plane of rotation keeps all three translations and adds a linear constraint
            replace(formulation, translation="free") if skew else formulation,
            second_order(invariants, stiffening),
            orientation=place.rotation,
            plane=locks.plane,
            gravity=gravity if own_gravity else None,
        ),
        by_mass=by_mass,
        shell_gravity=np.zeros(3) if own_gravity else gravity,
        modal=(
            inputs.modal_values(modal[0], "modal_coordinates", selection.labels),
            inputs.modal_values(modal[1], "modal_velocities", selection.labels),
        ),
    )
