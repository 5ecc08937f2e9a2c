"""More markers and node sensors of a full body: each has coordinates that are tied to the nodes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import exudyn
import numpy as np
import scipy.sparse as sp
from exudyn.itemInterface import SensorSuperElement
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.full.ties import FieldNode, Ties, add_ties
from exudyn_rotor.multibody.rotor import sensors
from exudyn_rotor.multibody.rotor.inputs import MARKER_KINDS, MarkerRequest
from exudyn_rotor.multibody.rotor.marker_body import (
    MarkerBodyMesh,
    add_interface_marker,
    marker_body_mesh,
    marker_body_object,
)
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.reduction.fields import ReducedInterface
from exudyn_rotor.solid.interface import Interface, rotation_moments

_FLAT = 1e-6  # smallest second moment of nodes over the largest for which they show a rotation


def add_marker(
    body: RotorItems,
    where: str | Sequence[int],
    offset: ArrayLike,
    *,
    weights: ArrayLike | None,
    kind: str,
    name: str | None,
    show: bool,
) -> exudyn.MarkerIndex:
    """Add a marker with the mean rigid motion of an interface or of mesh nodes."""
    _check_marker_body(body)
    shift = checks.vector(offset, "offset", "m")
    checks.choice(kind, "kind", MARKER_KINDS)
    checks.flag(show, "show")
    if name is not None:
        checks.label(name, "name")
        if int(body.mbs.GetMarkerNumber(name)) != -1:
            raise ValueError(f"name: this system already has a marker {name!r}; choose another")
    interface = _interface(body, where, weights, kind)
    marker_body, mesh = _tied_body(body, interface, shift)
    request = MarkerRequest(kind, shift, show)
    return add_interface_marker(
        body.mbs, name or "", interface.name, request, marker_body, mesh, body.frame
    )


def add_node_sensor(
    body: RotorItems, node: int, output: exudyn.OutputVariableType, options: dict[str, Any]
) -> exudyn.SensorIndex:
    """Add a native sensor at mesh node `node`, stored internally by default."""
    _check_marker_body(body)
    rotor = body.selection.source
    checks.count(node, "node", most=rotor.node_count - 1)
    settings = sensors.settings_at_mesh_node(body, output, options)
    interface = Interface("node", [node], None, rotor.nodes[[node]])
    marker_body, mesh = _tied_body(body, interface, np.zeros(3))
    number = mesh.point_nodes[interface.name][0]
    return body.mbs.AddSensor(
        SensorSuperElement(
            bodyNumber=marker_body, meshNodeNumber=number, outputVariableType=output, **settings
        )
    )


def interface_carrier(
    body: RotorItems, name: str
) -> tuple[exudyn.ObjectIndex, np.ndarray, np.ndarray, float]:
    """Add a massless body with the mean motion of an interface, for connectors to it.

    Returns
    -------
    ObjectIndex
    ndarray, shape (3,)
        The interface's point on the axis, axes of the body [m].
    ndarray, shape (6, 6)
        Displacement and rotation by the body's coordinates, its axes.
    float
        Radius of the interface [m].
    """
    interface = body.selection.source.interfaces[name]
    carrier, _ = _tied_body(body, interface, np.zeros(3))
    place = body.frame.points(body.axis.project(interface.reference))
    return carrier, place, np.kron(np.eye(2), body.frame.B), interface.radius


def _check_marker_body(body: RotorItems) -> None:
    body.check_present()
    if "marker_body" not in body.objects:
        raise ValueError(
            f"rotor {body.name!r} was added with marker_body=False; markers need the marker body"
        )


def _interface(
    body: RotorItems, where: str | Sequence[int], weights: ArrayLike | None, kind: str
) -> Interface:
    rotor, described = body.selection.source, "where: an interface, or mesh nodes"
    if isinstance(where, str):
        if weights is not None:
            raise ValueError("weights: are for mesh nodes; an interface has its own")
        known = tuple(rotor.interfaces)
        return rotor.interfaces[checks.choice(where, "where: interface", known)]
    nodes = checks.whole_numbers(where, described, most=rotor.node_count - 1)
    if len(nodes) == 0 or len(set(nodes.tolist())) != len(nodes):
        raise ValueError(f"{described}: needs different nodes, got {checks.shown(where)}")
    interface = Interface("nodes", nodes, weights, rotor.nodes[nodes])
    moments = rotation_moments(interface.positions - interface.center, interface.weights)[0]
    sizes = np.linalg.eigvalsh(moments)
    if kind == "rigid" and sizes[0] <= _FLAT * sizes[-1]:
        raise ValueError(
            f"where: the nodes {checks.shown(nodes.tolist())} lie on a line or in a point and show "
            "no rotation; give more nodes, an interface, or kind='position'"
        )
    return interface


def _tied_body(
    body: RotorItems, interface: Interface, shift: np.ndarray
) -> tuple[exudyn.ObjectIndex, MarkerBodyMesh]:
    """Add a massless body with the mean motion of an interface; return it and its nodes."""
    rotor, plan, frame = body.selection.source, body.plan, body.frame
    size, inv = 3 * rotor.node_count, body.motion.invariants
    none = np.zeros((0, size))
    rows = sp.csr_array(interface.mean_motion(rotor.node_count))
    fields = FieldNode(body.nodes["fields"], size, 0)
    tied, _ = add_ties(body.mbs, fields, Ties(rows, none, none), inv, plan.start)
    shown = ReducedInterface(interface.reference, interface.center, interface.radius, np.eye(6))
    name = interface.name
    mesh = marker_body_mesh(None, {name: shown}, np.eye(6), rotor.axis, frame, {name: shift})
    nodes, center = [body.nodes["rigid"], tied], body.selection.origin + inv.center
    S = np.zeros((3, 6))
    item = marker_body_object("", nodes, mesh, inv.mass, center, S, frame, plan.setup.color)
    return body.mbs.AddObject(item), mesh
