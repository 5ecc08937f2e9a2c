"""Adding a reduced rotor to an Exudyn ``mbs``: nodes, equations, marker body, gravity, markers."""

from __future__ import annotations

import exudyn
from exudyn.itemInterface import ObjectGenericODE2

from exudyn_rotor.multibody.rotor.equations import constant_object, user_function_object
from exudyn_rotor.multibody.rotor.inputs import item_name
from exudyn_rotor.multibody.rotor.known_rotor import note_rotor
from exudyn_rotor.multibody.rotor.locking import add_constraints, driving_force
from exudyn_rotor.multibody.rotor.marker_body import (
    add_weight,
    interface_markers,
    marker_body_mesh,
    marker_body_object,
)
from exudyn_rotor.multibody.rotor.plan import Plan, generic_node
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor


def add_bare(mbs: exudyn.MainSystem, plan: Plan) -> RotorBody:
    """Add only the unknowns of the formulation, on one generic node."""
    node = mbs.AddNode(plan.bare_node())
    physics = mbs.AddObject(_physics(plan, [node]))
    return RotorBody(mbs, plan, {"coordinates": node}, {"physics": physics})


def add_with_marker_body(mbs: exudyn.MainSystem, plan: Plan, reduced: ReducedRotor) -> RotorBody:
    """Add nodes, the marker body, locks, equations, gravity and markers."""
    setup, inv = plan.setup, plan.motion.invariants
    offsets = {interface: request.offset for interface, request in setup.markers.items()}
    mesh = marker_body_mesh(
        reduced.shapes, reduced.interfaces, plan.selection.T, reduced.axis, plan.frame, offsets
    )
    rigid = mbs.AddNode(plan.rigid_node())
    modes = mbs.AddNode(generic_node(*plan.start, item_name("NodeGeneric:", setup.name)))
    # first of all objects, as in scripts that know it by its number
    marker_body = mbs.AddObject(
        marker_body_object(
            setup.name or "",
            [rigid, modes],
            mesh,
            inv.mass,
            plan.selection.origin + inv.center,
            inv.S,
            plan.frame,
            setup.color,
        )
    )
    physics = mbs.AddObject(_physics(plan, [rigid, modes]))
    by_mass = setup.locking == "mass"
    body = RotorBody(
        mbs,
        plan,
        nodes={"rigid": rigid, "modes": modes},
        objects={"physics": physics, "marker_body": marker_body},
        markers=interface_markers(mbs, setup, marker_body, mesh, plan.frame),
        constraints={} if by_mass else add_constraints(mbs, plan.locks, rigid),
        gravity_load=add_weight(mbs, marker_body, plan.marker_body_gravity),
        mesh_node_count=mesh.mesh_node_count,
        mesh_stress=bool(mesh.stress.size),
    )
    note_rotor(body)
    return body


def _physics(plan: Plan, nodes: list) -> ObjectGenericODE2:
    drive = None
    if plan.setup.locking == "mass" and plan.setup.marker_body:
        drive = driving_force(plan.locks, plan.layout.lock_mass)
    if plan.motion.is_constant and drive is None:
        return constant_object(plan.motion, plan.layout, nodes)
    return user_function_object(plan.motion, plan.layout, nodes, drive)
