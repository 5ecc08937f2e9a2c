"""Adding a full body to an Exudyn ``mbs``: nodes, equations, ties, and a body for markers.

The matrices are sparse, with user functions for what varies. Of a mass matrix that varies, one row
and column do, that of the spin; they stand in an object of their own, so that the rotor's matrices
are handed over once.
"""

from __future__ import annotations

from collections.abc import Callable

import exudyn
import numpy as np
import scipy.sparse as sp
from exudyn.graphics import FromPointsAndTrigs
from exudyn.itemInterface import ObjectGenericODE2, VObjectGenericODE2

from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.full.ties import Ties, add_ties, container, no_jacobian
from exudyn_rotor.multibody.rotor.frame import Layout, LockedForce
from exudyn_rotor.multibody.rotor.plan import Plan, add_nodes
from exudyn_rotor.multibody.rotor.rotor_items import (
    add_interface_markers,
    add_locks_and_weight,
    flexible_body,
)
from exudyn_rotor.solid.surface import flat_triangles
from exudyn_rotor.theory.full_motion import FullMotion, principal


def add_full(mbs: exudyn.MainSystem, plan: Plan) -> FullRotorBody:
    """Add the frame's node, that of the displacements, the equations, ties and markers."""
    rigid, fields = add_nodes(mbs, plan)
    motion = plan.motion
    ties, weight = _frame_ties(plan)
    tied, ties_object = add_ties(mbs, fields, ties, plan)
    marker_body = mbs.AddObject(flexible_body(plan, [rigid, tied], weight, name=plan.name or ""))
    objects = {
        "physics": mbs.AddObject(_equations(plan, [rigid, fields])),
        "marker_body": marker_body,
    }
    if motion.has_varying_inertia:
        coupling = spin_coupling_object(motion, plan.layout, [rigid, fields])
        objects["spin coupling"] = mbs.AddObject(coupling)
    body = FullRotorBody(
        **vars(plan),
        **add_locks_and_weight(mbs, plan, rigid, marker_body),
        mbs=mbs,
        nodes={"rigid": rigid, "fields": fields},
        objects=objects,
        ties=ties_object,
    )
    add_interface_markers(body)
    return body


def _frame_ties(plan: Plan) -> tuple[Ties, np.ndarray]:
    """Return the ties of the frame, and ``ΦᵀMΨ`` (3, z) of their coordinates.

    These are the free mean translations, for gravity, and the low-rank stiffening.
    """
    motion, held = plan.motion, plan.selection.conditions
    inv = motion.invariants
    free = np.zeros((3, 0))
    if np.any(plan.gravity - motion.gravity):
        count = 3 - held.held.shape[1]
        free = np.linalg.svd(np.eye(3) - held.held @ held.held.T)[0][:, :count]
    rows, stiffness = free.T @ inv.S / inv.mass, np.zeros(free.shape[1])
    if motion.formulation.is_constant_speed and motion.formulation.spin.speed:
        stiffening, values = principal(*motion.second_order.tilt)
        rows = np.vstack([rows, stiffening])
        stiffness = np.append(stiffness, motion.formulation.spin.speed**2 * values)
    local = sp.csr_array((0 if len(rows) else 1, inv.size))  # the flexible body needs a coordinate
    ties = Ties(local, rows, held.rows, np.diag(stiffness) if len(rows) else None)
    weight = np.zeros((3, ties.rows.shape[0]))
    weight[:, : free.shape[1]] = inv.mass * free
    return ties, weight


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


def _forces(motion: FullMotion, layout: Layout, guide: LockedForce | None) -> Callable:
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
