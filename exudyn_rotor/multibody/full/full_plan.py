"""Planning a full body, a solid rotor with all its nodal displacements, checked before adding.

Exudyn factorises the Jacobian of an implicit step by Eigen's ``SparseLU``, ordered by columns
(COLAMD), which fills it several times as much as nested dissection and takes no notice of symmetry.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.rotor.plan import Plan, Setup, laid_out
from exudyn_rotor.prestress.static_solution import relief_rotation
from exudyn_rotor.reduction.selection import NEGLIGIBLE
from exudyn_rotor.solid.model import clamped_coordinates
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.solvers.factor import TooLittleMemoryError, available_memory, factor_entries
from exudyn_rotor.theory.formulation import Formulation
from exudyn_rotor.theory.full_motion import (
    Conditions,
    FullMotion,
    conditions,
    full_stiffening,
)
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.stiffening import NO_PRESTRESS

# bytes for every entry of the stiffness matrix, which Exudyn holds many times, and for every
# estimated entry of a factor; peaks of runs of a disc on a shaft with 10,000 to 70,000 coordinates
_PER_ENTRY, _PER_FACTOR_ENTRY = 300.0, 22.0


def check_memory(rotor: SolidRotor) -> None:
    """Raise TooLittleMemoryError where an implicit run with a full body would not fit."""
    size, available = 3 * rotor.node_count, available_memory()
    needed = _PER_ENTRY * rotor.stiffness.nnz + _PER_FACTOR_ENTRY * factor_entries(size)
    if needed > available:
        raise TooLittleMemoryError(
            f"rotor: a full body with {size} displacements needs about {needed / 1e9:.2g} GB in a "
            f"step of Exudyn's sparse solver, and {available / 1e9:.2g} GB of memory are "
            "available; add the reduced rotor, rotor.reduce(…), or use a coarser mesh"
        )


_ROUNDING = 1e-12  # of the accelerations that balance a load, for one of 1 rad/s²
_BROKEN = 1e-9  # share of a displacement that a condition may find in it


@dataclass(frozen=True, eq=False)
class NodalFields:
    """What stands for the modes in a full body: the displacements of all nodes."""

    origin: np.ndarray  # (3,) Of the frame, mesh coordinates [m]
    invariants: Invariants  # sparse, about the origin, without what the conditions take up
    source: SolidRotor
    conditions: Conditions


def make_full_plan(rotor: SolidRotor, setup: Setup) -> Plan:
    """Check what needs the model, and lay out the equations.

    `rotor` carries its prestress where ``setup.stiffening`` is 'full'.
    """
    if setup.mass_damping or setup.stiffness_damping:
        rotor = rotor.with_damping(mass=setup.mass_damping, stiffness=setup.stiffness_damping)
    _check_possible(rotor, setup.formulation)
    origin = rotor.center_of_mass
    if not setup.formulation.translation_count:
        origin = rotor.axis.project(origin)
    carried, turn = rotor.carried_prestress, None
    whole = _invariants(rotor, origin)
    if setup.stiffening != "none" and getattr(carried, "by_loads", None) is not None:
        whole = replace(whole, K0=carried.by_loads).loaded
    if setup.stiffening == "full":
        if carried is None:
            raise ValueError(NO_PRESTRESS)
        turn = relief_rotation(rotor)
        turn = np.where(np.abs(turn) > _ROUNDING, turn, 0.0)
        whole = replace(whole, K2=carried.per_square, K4=carried.per_fourth_power)
    second = full_stiffening(whole, setup.stiffening, turn)
    held = conditions(whole, setup.formulation, rotor.grounded, NEGLIGIBLE)
    inv = replace(held.invariants, K2=None, K4=None)
    fields = NodalFields(checks.read_only(origin), inv, rotor, held)
    start = {
        name: _start(getattr(setup, name), name, held)
        for name in ("modal_coordinates", "modal_velocities")
    }
    return laid_out(replace(setup, **start), fields, partial(FullMotion, inv), second)


def _invariants(rotor: SolidRotor, origin: np.ndarray) -> Invariants:
    """Return the invariants of nodal displacements, of which clamped ones take no part.

    They keep their springs and masses, without load or coupling: else sudden loads would throw the
    springs, and Newton's tolerance be a share of their forces.
    """
    clamped = clamped_coordinates(rotor.stiffness).astype(float)
    basis = sp.csr_array(sp.diags_array(1.0 - clamped))
    matrices = (rotor.mass, rotor.stiffness, rotor.damping)
    moving = Invariants.of(rotor.nodes - origin, *matrices, basis, rotor.axis.direction)
    M, K = (
        sp.csr_array(one + sp.diags_array(clamped * whole.diagonal()))
        for one, whole in ((moving.M, rotor.mass), (moving.K, rotor.stiffness))
    )
    return replace(moving, M=M, K=K)


def _check_possible(rotor: SolidRotor, formulation: Formulation) -> None:
    if rotor.mass_damping:  # not sparse for a rotor that moves freely
        raise ValueError(
            "mass_damping: a full body that rigid motions are free in does not take damping in "
            "proportion to its mass; reduce the rotor, rotor.reduce(…), or give stiffness damping"
        )
    if rotor.grounded and (formulation.translation_count or formulation.has_spin):
        raise ValueError(
            "the stiffness matrix holds this rotor in its own frame (grounded), and a frame "
            "without mass cannot move freely: use translation='none' and a prescribed spin"
        )
    across = rotor.nodes - rotor.axis.project(rotor.nodes)
    if formulation.has_spin and not np.any(rotor.mass[::3, ::3] @ across):
        raise ValueError(
            "the rotor has no moment of inertia about its axis, so its spin cannot be free: "
            "prescribe the spin, or give the rotor mass off the axis"
        )


def _start(values: ArrayLike | None, name: str, held: Conditions) -> np.ndarray:
    """Return the nodal start values (3n,), which keep the conditions."""
    size = held.invariants.size
    if values is None:
        return np.zeros(size)
    described = f"{name} (of a full body: the displacements of all nodes, or their rates)"
    shape = (size // 3, 3) if np.ndim(values) == 2 else (size,)
    start = checks.array(values, described, shape=shape).ravel()
    moved = np.abs(held.rows @ start)
    allowed = _BROKEN * np.abs(held.rows) @ np.abs(start)
    if np.any(moved > allowed):
        raise ValueError(
            f"{name}: the displacements hold a mean motion of {moved.max():.3g} that the frame "
            "describes already (mean translation, or mean rotation about the axis); subtract it, "
            "and give it by position, initial_velocity, initial_angle or initial_speed"
        )
    return start
