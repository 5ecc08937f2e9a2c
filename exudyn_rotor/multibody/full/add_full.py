"""Adding a full body to an Exudyn ``mbs``: nodes, equations, ties, and a body for markers."""

from __future__ import annotations

from collections.abc import Callable

import exudyn
import numpy as np
import scipy.sparse as sp
from exudyn.graphics import FromPointsAndTrigs

from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.full.full_equations import sparse_object, spin_coupling_object
from exudyn_rotor.multibody.full.full_plan import FullPlan
from exudyn_rotor.multibody.full.ties import FieldNode, Ties, add_ties
from exudyn_rotor.multibody.rotor.frame import add_constraints, driving_force
from exudyn_rotor.multibody.rotor.marker_body import (
    MarkerBodyMesh,
    add_weight,
    interface_markers,
    marker_body_mesh,
    marker_body_object,
)
from exudyn_rotor.multibody.rotor.plan import generic_node, item_name
from exudyn_rotor.multibody.rotor.rotor_items import note_rotor
from exudyn_rotor.reduction.fields import ReducedInterface
from exudyn_rotor.solid.surface import flat_triangles
from exudyn_rotor.theory.full_motion import principal


def add_full(mbs: exudyn.MainSystem, plan: FullPlan) -> FullRotorBody:
    """Add the frame's node, that of the displacements, the equations, ties and markers."""
    if not plan.setup.marker_body:
        return _add_bare(mbs, plan)
    ties, mesh, weight = _ties_and_mesh(plan)
    rigid = mbs.AddNode(plan.rigid_node())
    start = plan.start
    name = item_name("NodeGeneric:", plan.setup.name)
    fields = mbs.AddNode(generic_node(*start, name))
    place = FieldNode(fields, len(plan.modal_start), 0)
    motion = plan.motion
    tied, ties_object = add_ties(mbs, place, ties, motion.invariants, start)
    marker_body = mbs.AddObject(
        marker_body_object(
            plan.setup.name or "",
            [rigid, tied],
            mesh,
            motion.invariants.mass,
            plan.selection.origin + motion.invariants.center,
            weight,
            plan.frame,
            plan.setup.color,
        )
    )
    by_mass = plan.setup.locking == "mass"
    guide = driving_force(plan.locks, plan.layout.lock_mass) if by_mass else None
    drawing = surface_drawing(plan, rigid, fields)
    objects = _add_equations(mbs, plan, [rigid, fields], guide, drawing)
    body = FullRotorBody(
        mbs,
        plan,
        nodes={"rigid": rigid, "fields": fields},
        objects=objects | {"marker_body": marker_body},
        markers=interface_markers(mbs, plan.setup, marker_body, mesh, plan.frame),
        constraints={} if by_mass else add_constraints(mbs, plan.locks, rigid),
        gravity_load=add_weight(mbs, marker_body, plan.marker_body_gravity),
        ties=ties_object,
    )
    note_rotor(body)
    return body


def _add_bare(mbs: exudyn.MainSystem, plan: FullPlan) -> FullRotorBody:
    """Add only the unknowns of the formulation, on one generic node."""
    motion = plan.motion
    node = mbs.AddNode(plan.bare_node())
    objects, ties = _add_equations(mbs, plan, [node], None, None), None
    every = _ties(plan, {})
    if every.count or len(every.held):
        fields = FieldNode(node, motion.size, motion.modes.start)
        ties = add_ties(mbs, fields, every, motion.invariants, plan.start)[1]
    return FullRotorBody(mbs, plan, {"coordinates": node}, objects, ties=ties)


def _add_equations(
    mbs: exudyn.MainSystem, plan: FullPlan, nodes: list, guide, graphics: Callable | None
) -> dict[str, exudyn.ObjectIndex]:
    motion = plan.motion
    item = sparse_object(motion, plan.layout, nodes, guide, graphics)
    objects = {"physics": mbs.AddObject(item)}
    if motion.has_varying_inertia:
        coupling = spin_coupling_object(motion, plan.layout, nodes)
        objects["spin coupling"] = mbs.AddObject(coupling)
    return objects


def _ties(plan: FullPlan, interfaces: dict[str, sp.csr_array]) -> Ties:
    """Return the ties: interfaces, free mean translations for gravity, low-rank stiffening."""
    motion, held = plan.motion, plan.selection.conditions
    inv, size = motion.invariants, motion.invariants.size
    local = sp.csr_array((0, size))
    if interfaces:
        local = sp.vstack(list(interfaces.values()), format="csr")
    whole = [_free_directions(plan).T @ inv.S / inv.mass]
    stiffness = None
    if motion.formulation.is_constant_speed and motion.formulation.spin.speed:
        rows, values = principal(*motion.second_order.tilt)
        count = local.shape[0] + len(whole[0])
        whole.append(rows)
        values = motion.formulation.spin.speed**2 * values
        stiffness = np.diag(np.r_[np.zeros(count), values])
    return Ties(local, np.vstack(whole), held.rows, stiffness)


def _free_directions(plan: FullPlan) -> np.ndarray:
    """Return the directions (3, 0…3) in which gravity acts on mean displacements."""
    if not np.any(plan.marker_body_gravity):
        return np.zeros((3, 0))
    held = plan.selection.conditions.held
    return np.linalg.svd(np.eye(3) - held @ held.T)[0][:, : 3 - held.shape[1]]


def _ties_and_mesh(plan: FullPlan) -> tuple[Ties, MarkerBodyMesh, np.ndarray]:
    """Return the ties, the body that shows their coordinates, and its ``ΦᵀMΨ`` (3, z)."""
    rotor = plan.selection.source
    chosen = {name: rotor.interfaces[name] for name in plan.setup.markers}
    rows = {name: interface.mean_motion(rotor.node_count) for name, interface in chosen.items()}
    ties = _ties(plan, rows)
    if not ties.count:  # the body for markers needs a coordinate
        ties = Ties(sp.csr_array((1, plan.motion.invariants.size)), ties.whole, ties.held)
    shown = {}
    for index, (name, interface) in enumerate(chosen.items()):
        motion = np.zeros((6, ties.count))
        motion[:, 6 * index : 6 * index + 6] = np.eye(6)
        shown[name] = ReducedInterface(
            interface.reference, interface.center, interface.radius, motion
        )
    if not shown:  # and a node
        still = np.zeros((6, ties.count))
        shown[""] = ReducedInterface(plan.selection.origin, plan.selection.origin, 0.0, still)
    offsets = {name: request.offset for name, request in plan.setup.markers.items()}
    mesh = marker_body_mesh(None, shown, np.eye(ties.count), rotor.axis, plan.frame, offsets)
    directions = _free_directions(plan)
    weight, first = np.zeros((3, ties.count)), 6 * len(rows)
    weight[:, first : first + directions.shape[1]] = plan.motion.invariants.mass * directions
    return ties, mesh, weight


_KINDS = exudyn.OutputVariableType
_STATE = exudyn.ConfigurationType.Visualization


def surface_drawing(
    plan: FullPlan, rigid: exudyn.NodeIndex, fields: exudyn.NodeIndex
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
