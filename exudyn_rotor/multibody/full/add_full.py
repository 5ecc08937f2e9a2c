"""Adding a full body to an Exudyn ``mbs``: laid out and checked, then nodes, equations and ties.

The matrices are sparse, with user functions for what varies. Of a mass matrix that varies, one row
and column do, that of the spin; they stand in an object of their own, so that the rotor's matrices
are handed over once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import exudyn
import numpy as np
import scipy.sparse as sp
from exudyn.graphics import FromPointsAndTrigs
from exudyn.itemInterface import ObjectGenericODE2, VObjectGenericODE2
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.full.ties import add_ties, container, no_jacobian
from exudyn_rotor.multibody.rotor.plan import Layout, Plan, Setup, add_nodes, laid_out
from exudyn_rotor.multibody.rotor.rotor_items import finished, flexible_body
from exudyn_rotor.prestress.static_solution import relief_rotation
from exudyn_rotor.reduction.selection import NEGLIGIBLE, check_possible
from exudyn_rotor.solid.model import clamped_coordinates
from exudyn_rotor.solid.surface import flat_triangles
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.solvers.factor import TooLittleMemoryError, available_memory, factor_entries
from exudyn_rotor.theory.full_motion import (
    Conditions,
    FullMotion,
    conditions,
    full_stiffening,
    principal,
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
    if rotor.mass_damping:  # not sparse for a rotor that moves freely
        raise ValueError(
            "mass_damping: a full body that rigid motions are free in does not take damping in "
            "proportion to its mass; reduce the rotor, rotor.reduce(…), or give stiffness damping"
        )
    across = rotor.axis.radial(rotor.nodes)
    turns = bool(np.any(rotor.mass[::3, ::3] @ across))
    check_possible(setup.formulation, rotor.grounded, turns)
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
    start = partial(_start, held=held)
    return laid_out(setup, fields, partial(FullMotion, inv, setup.formulation, second), start)


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


def add_full(mbs: exudyn.MainSystem, plan: Plan) -> FullRotorBody:
    """Add the frame's node, that of the displacements, the equations, ties and markers."""
    rigid, fields = add_nodes(mbs, plan)
    motion = plan.motion
    rows, stiffness, weight = _frame_rows(plan)
    # the flexible body needs a coordinate
    local = sp.csr_array((0 if len(rows) else 1, motion.invariants.size))
    held = plan.selection.conditions.rows
    tied, ties = add_ties(mbs, fields, plan, local, rows, held, stiffness if len(rows) else None)
    marker_body = mbs.AddObject(flexible_body(plan, [rigid, tied], weight, name=plan.name or ""))
    objects = {
        "physics": mbs.AddObject(_equations(plan, [rigid, fields])),
        "marker_body": marker_body,
    }
    if motion.has_varying_inertia:
        coupling = spin_coupling_object(motion, plan.layout, [rigid, fields])
        objects["spin coupling"] = mbs.AddObject(coupling)
    nodes = {"rigid": rigid, "fields": fields}
    return finished(FullRotorBody, mbs, plan, nodes=nodes, objects=objects, ties=ties)


def _frame_rows(plan: Plan) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return rows (z, 3n) of mean motions, their stiffness (z,) and ``ΦᵀMΨ`` (3, z).

    These are the free mean translations, for gravity, and the low-rank stiffening.
    """
    motion, held = plan.motion, plan.selection.conditions.held
    inv = motion.invariants
    free = np.zeros((3, 0))
    if np.any(plan.gravity - motion.gravity):
        free = np.linalg.svd(np.eye(3) - held @ held.T)[0][:, : 3 - held.shape[1]]
    rows, stiffness = free.T @ inv.S / inv.mass, np.zeros(free.shape[1])
    if motion.formulation.is_constant_speed and motion.formulation.spin.speed:
        stiffening, values = principal(*motion.second_order.tilt)
        rows = np.vstack([rows, stiffening])
        stiffness = np.append(stiffness, motion.formulation.spin.speed**2 * values)
    weight = np.zeros((3, max(len(rows), 1)))
    weight[:, : free.shape[1]] = inv.mass * free
    return rows, stiffness, weight


_KINDS = exudyn.OutputVariableType
_STATE = exudyn.ConfigurationType.Visualization


def surface_drawing(
    plan: Plan, rigid: exudyn.NodeIndex, fields: exudyn.NodeIndex
) -> Callable | None:
    """Return Exudyn's graphics function of the rotor's surface; None for a rotor without one.

    Displacements are drawn with the factor ``visualizationSettings.bodies.deformationScaleFactor``.
    """
    rotor, color = plan.selection.source, list(plan.color)
    if not len(rotor.triangles):
        return None
    triangles = flat_triangles(rotor.triangles)

    def drawn(mbs, item):
        factor = mbs.GetSystemContainer().visualizationSettings.bodies.deformationScaleFactor
        c = mbs.GetNodeOutput(fields, _KINDS.Coordinates, _STATE).reshape(-1, 3)
        place = mbs.GetNodeOutput(rigid, _KINDS.Position, _STATE)
        turn = mbs.GetNodeOutput(rigid, _KINDS.RotationMatrix, _STATE).reshape(3, 3)
        points = place + plan.frame.points(rotor.nodes + factor * c) @ turn.T
        return [FromPointsAndTrigs(points, triangles, color)]

    return drawn


def _equations(plan: Plan, nodes: list) -> ObjectGenericODE2:
    """Return the object with the constant matrices, the forces that vary, and the drawing."""
    motion, layout = plan.motion, plan.layout
    none = np.zeros(layout.size)
    locks = (layout.lock_mass, none, none)
    mass, damping, stiffness = (
        container(_spread(matrix, layout, diagonal))
        for matrix, diagonal in zip(motion.constant_matrices(), locks, strict=True)
    )
    force = np.zeros(layout.size)
    force[layout.unknowns] = motion.constant_force()
    functions = {"jacobianUserFunction": no_jacobian(layout.size)}
    if motion.has_varying_forces or plan.guide is not None:
        functions["forceUserFunction"] = _forces(motion, layout, plan.guide)
    if motion.has_varying_forces and not motion.formulation.is_constant_speed:
        functions["jacobianUserFunction"] = _jacobian(motion, layout)
    graphics = surface_drawing(plan, *nodes)
    drawing = {} if graphics is None else {"graphicsDataUserFunction": graphics}
    return ObjectGenericODE2(
        nodeNumbers=nodes,
        massMatrix=mass,
        dampingMatrix=damping,
        stiffnessMatrix=stiffness,
        forceVector=force,
        **functions,
        visualization=VObjectGenericODE2(show=graphics is not None, **drawing),
    )


def spin_coupling_object(motion: FullMotion, layout: Layout, nodes: list) -> ObjectGenericODE2:
    """Return the object of the inertia that varies with the displacements, (84) and (85)."""
    spin = int(layout.unknowns[motion.modes.start - 1])
    places = layout.unknowns[motion.modes]
    count, size = len(places), layout.size
    table = np.zeros((2 * count + 1, 3))
    table[0, :2] = spin
    table[1 : count + 1, 0] = table[count + 1 :, 1] = spin
    table[1 : count + 1, 1] = table[count + 1 :, 0] = places
    matrix = exudyn.MatrixContainer()

    def mass(mbs, t, item, q, q_t):
        moment, row = motion.varying_inertia(np.asarray(q)[places])
        table[0, 2] = moment
        table[1 : count + 1, 2] = table[count + 1 :, 2] = row
        matrix.SetWithSparseMatrixCSR(size, size, table, False)
        return matrix

    empty = container(sp.csr_array((size, size)))
    return ObjectGenericODE2(
        nodeNumbers=nodes,
        massMatrix=empty,
        stiffnessMatrix=empty,
        dampingMatrix=empty,
        massMatrixUserFunction=mass,
        jacobianUserFunction=no_jacobian(size),
        visualization=VObjectGenericODE2(show=False),
    )


def _spread(matrix: sp.csr_array, layout: Layout, diagonal: np.ndarray) -> sp.csr_array:
    """Return a matrix of the unknowns on all coordinates of the nodes, `diagonal` added."""
    entries = sp.coo_array(matrix)
    rows, columns = (layout.unknowns[part] for part in entries.coords)
    shape = (layout.size, layout.size)
    return sp.csr_array((entries.data, (rows, columns)), shape=shape) + sp.diags_array(diagonal)


def _forces(motion: FullMotion, layout: Layout, guide: Callable | None) -> Callable:
    def forces(mbs, t, item, q, q_t):
        total = np.zeros(layout.size) if guide is None else np.array(guide(t))
        if motion.has_varying_forces:
            q, q_t = (np.asarray(values)[layout.unknowns] for values in (q, q_t))
            total[layout.unknowns] += motion.varying_forces(t, q, q_t)
        return total.tolist()

    return forces


def _jacobian(motion: FullMotion, layout: Layout) -> Callable:
    none = np.zeros(layout.size)

    def jacobian(mbs, t, item, q, q_t, factor_q, factor_v):
        q, q_t = (np.asarray(values)[layout.unknowns] for values in (q, q_t))
        matrix = motion.varying_jacobian(t, q, q_t, factor_q, factor_v)
        return container(_spread(matrix, layout, none))

    return jacobian
