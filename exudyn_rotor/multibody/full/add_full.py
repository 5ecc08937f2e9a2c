"""Adding a full body to an Exudyn ``mbs``: nodes, equations, ties, and a body for markers."""

from __future__ import annotations

from collections.abc import Callable

import exudyn
import numpy as np
import scipy.sparse as sp
from exudyn.graphics import FromPointsAndTrigs

from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.full.full_equations import sparse_object, spin_coupling_object
from exudyn_rotor.multibody.full.ties import Ties, add_ties
from exudyn_rotor.multibody.rotor.frame import add_constraints, driving_force
from exudyn_rotor.multibody.rotor.plan import Plan
from exudyn_rotor.multibody.rotor.rotor_items import (
    add_interface_markers,
    add_weight,
    flexible_body,
)
from exudyn_rotor.solid.surface import flat_triangles
from exudyn_rotor.theory.full_motion import principal


def add_full(mbs: exudyn.MainSystem, plan: Plan) -> FullRotorBody:
    """Add the frame's node, that of the displacements, the equations, ties and markers."""
    rigid, fields = plan.add_nodes(mbs)
    motion = plan.motion
    ties, weight = _frame_ties(plan)
    tied, ties_object = add_ties(mbs, fields, ties, motion.invariants, plan.start)
    item = flexible_body(plan, [rigid, tied], weight, name=plan.setup.name or "")
    marker_body = mbs.AddObject(item)
    by_mass = plan.setup.locking == "mass"
    guide = driving_force(plan.locks, plan.layout.lock_mass) if by_mass else None
    item = sparse_object(
        motion, plan.layout, [rigid, fields], guide, surface_drawing(plan, rigid, fields)
    )
    objects = {"physics": mbs.AddObject(item), "marker_body": marker_body}
    if motion.has_varying_inertia:
        coupling = spin_coupling_object(motion, plan.layout, [rigid, fields])
        objects["spin coupling"] = mbs.AddObject(coupling)
    body = FullRotorBody(
        mbs,
        plan,
        nodes={"rigid": rigid, "fields": fields},
        objects=objects,
        constraints={} if by_mass else add_constraints(mbs, plan.locks, rigid),
        gravity_load=add_weight(mbs, marker_body, plan.marker_body_gravity),
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
    if np.any(plan.marker_body_gravity):
        count = 3 - held.held.shape[1]
        free = np.linalg.svd(np.eye(3) - held.held @ held.held.T)[0][:, :count]
    rows, stiffness = free.T @ inv.S / inv.mass, np.zeros(free.shape[1])
    if motion.formulation.is_constant_speed and motion.formulation.spin.speed:
        stiffening, values = principal(*motion.second_order.tilt)
        rows = np.vstack([rows, stiffening])
        stiffness = np.append(stiffness, motion.formulation.spin.speed**2 * values)
    local = sp.csr_array((0 if len(rows) else 1, inv.size))  # the flexible body needs a coordinate
    ties = Ties(local, rows, held.rows, np.diag(stiffness) if len(rows) else None)
    weight = np.zeros((3, ties.count))
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
    rotor, color = plan.selection.source, list(plan.setup.color)
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
