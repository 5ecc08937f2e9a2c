"""Adding a reduced rotor to an Exudyn ``mbs``: nodes, equations, marker body, gravity, markers."""

from __future__ import annotations

import exudyn
from exudyn.itemInterface import ObjectGenericODE2

from exudyn_rotor.multibody.rotor import condensed_markers, inputs
from exudyn_rotor.multibody.rotor.equations import (
    LockedForce,
    constant_object,
    user_function_object,
)
from exudyn_rotor.multibody.rotor.locking import add_spin_guide, hold
from exudyn_rotor.multibody.rotor.marker_body import (
    MarkerBodyMesh,
    add_weight,
    interface_markers,
    marker_body_object,
)
from exudyn_rotor.multibody.rotor.plan import Plan
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.rotor.rotor_nodes import generic_node, rigid_node


def add_bare(mbs: exudyn.MainSystem, plan: Plan) -> RotorBody:
    """Add only the unknowns of the formulation, on one generic node."""
    motion, start = plan.motion, plan.setup.placement
    formulation = plan.setup.formulation
    spin = int(formulation.has_spin)
    values = [
        *(motion.free_directions.T @ start.translation),
        *([start.angle] * spin),
        *plan.modal_start,
    ]
    rates = [
        *(motion.free_directions.T @ start.velocity),
        *([start.speed] * spin),
        *plan.modal_start_rate,
    ]
    node = mbs.AddNode(
        generic_node(values, rates, inputs.item_name("NodeGeneric:", plan.setup.name))
    )
    physics = mbs.AddObject(_physics(plan, [node], None))
    return RotorBody(mbs, plan, {"coordinates": node}, {"physics": physics})


def add_with_marker_body(mbs: exudyn.MainSystem, plan: Plan, mesh: MarkerBodyMesh) -> RotorBody:
    """Add nodes, the marker body, locks, equations, gravity and markers."""
    rigid = mbs.AddNode(rigid_node(plan))
    name = inputs.item_name("NodeGeneric:", plan.setup.name)
    modes = mbs.AddNode(generic_node(plan.modal_start, plan.modal_start_rate, name))
    # first of all objects, as in scripts that know it by its number
    marker_body = mbs.AddObject(
        marker_body_object(
            plan.setup.name or "",
            [rigid, modes],
            mesh,
            plan.motion.invariants.mass,
            plan.selection.origin + plan.motion.invariants.center,
            plan.motion.invariants.S,
            plan.frame,
            plan.setup.color,
        )
    )
    tilts = plan.frame.B @ plan.motion.invariants.mean_rotation
    condensed_markers.at_assembly(mbs, marker_body, plan.setup.condense_markers, tilts)
    guide, constraints = hold(mbs, plan.locks, plan.layout, plan.by_mass, rigid)
    physics = mbs.AddObject(_physics(plan, [rigid, modes], guide))
    if plan.motion.is_constant:
        add_spin_guide(mbs, plan.locks, plan.layout, rigid)
    load = add_weight(mbs, marker_body, plan.marker_body_gravity)
    return RotorBody(
        mbs,
        plan,
        nodes={"rigid": rigid, "modes": modes},
        objects={"physics": physics, "marker_body": marker_body},
        markers=interface_markers(mbs, plan.setup, marker_body, mesh, plan.frame),
        constraints=constraints,
        gravity_load=load,
        mesh_node_count=mesh.mesh_node_count,
        mesh_stress=bool(mesh.stress.size),
    )


def _physics(plan: Plan, nodes: list, guide: LockedForce | None) -> ObjectGenericODE2:
    if plan.node_motion.is_constant:
        return constant_object(plan.node_motion, plan.layout, nodes)
    return user_function_object(plan.node_motion, plan.layout, nodes, guide)
