"""More markers of a rotor in a scene, at interfaces or mesh nodes, with the axes of the mesh."""

from __future__ import annotations

from collections.abc import Sequence

import exudyn
import numpy as np
from exudyn.itemInterface import MarkerSuperElementPosition, MarkerSuperElementRigid
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.rotor.marker_body import append_nodes, virtual_nodes
from exudyn_rotor.multibody.rotor.plan import MARKER_KINDS
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.solid.interface import rotation_moments
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.nodal import skew

_FLAT = 1e-6  # smallest second moment of nodes over the largest for which they show a rotation


def add_marker(
    body: RotorItems,
    where: str | Sequence[int],
    offset: ArrayLike = (0.0, 0.0, 0.0),
    *,
    weights: ArrayLike | None = None,
    kind: str = "rigid",
    name: str | None = None,
    show: bool = True,
) -> exudyn.MarkerIndex:
    """Add a marker that moves with the mean rigid motion of an interface or of mesh nodes."""
    body.check_present()
    if "marker_body" not in body.objects:
        raise ValueError(
            f"rotor {body.name!r} was added with marker_body=False; markers need the marker body"
        )
    shift = body.frame.B @ checks.vector(offset, "offset", "m")
    checks.choice(kind, "kind", MARKER_KINDS)
    common = {
        "bodyNumber": body.objects["marker_body"],
        "visualization": {"show": checks.flag(show, "show"), "showMarkerNodes": False},
    }
    if name is not None:
        common["name"] = checks.label(name, "name")
        if int(body.mbs.GetMarkerNumber(name)) != -1:
            raise ValueError(f"name: this system already has a marker {name!r}; choose another")
    if isinstance(where, str):
        point, motion, radius = _of_interface(body, where)
        if weights is not None:
            raise ValueError("weights: are for mesh nodes; an interface has its own")
        place = None
    else:
        point, motion, radius, place = _of_nodes(body, where, weights, kind)
    motion = np.vstack([motion[:3] - skew(shift) @ motion[3:], motion[3:]])
    marker_body = body.objects["marker_body"]
    if kind == "position":
        nodes = append_nodes(body.mbs, marker_body, (point + shift)[None, :], motion[:3])
        item = MarkerSuperElementPosition(meshNodeNumbers=nodes, weightingFactors=[1.0], **common)
    else:
        axis = SpinAxis(body.frame.B @ body.axis.direction)
        nodes = append_nodes(
            body.mbs, marker_body, *virtual_nodes(point + shift, radius, motion, axis)
        )
        turn = np.eye(4)
        turn[:3, :3] = body.frame.B
        item = MarkerSuperElementRigid(
            meshNodeNumbers=nodes, weightingFactors=[1.0 / 3.0] * 3, localHT=turn, **common
        )
    number = body.mbs.AddMarker(item)
    if place is not None:
        body.node_places[int(number)] = place
    return number


def interface_motion(body: RotorItems, name: str) -> tuple[np.ndarray, np.ndarray, float]:
    """Return point on the axis, mean motion (6, m) and radius of an interface, axes of the body."""
    _, motion, radius = _of_interface(body, name)
    on_axis = body.axis.project(body.selection.source.interfaces[name].reference)
    return body.frame.points(on_axis), motion, radius


def _of_interface(body: RotorItems, name: str) -> tuple[np.ndarray, np.ndarray, float]:
    """Return reference point, motion (6, m) and radius of an interface, axes of the body."""
    known = body.selection.source.interfaces
    interface = known[checks.choice(name, "where: interface", tuple(known))]
    motion = np.kron(np.eye(2), body.frame.B) @ interface.motion @ body.selection.T
    return body.frame.points(interface.reference), motion, interface.radius


def _of_nodes(
    body: RotorItems, where: Sequence[int], weights: ArrayLike | None, kind: str
) -> tuple[np.ndarray, np.ndarray, float, tuple[np.ndarray, np.ndarray]]:
    """Return the same for mesh nodes, weighted means as Exudyn's marker takes them; and these."""
    described = "where: an interface, or mesh nodes"
    if not body.mesh_node_count:
        raise ValueError(
            f"{described}: rotor {body.name!r} was reduced without shapes (keep_shapes=False) and "
            f"has no mesh nodes here; name an interface, got {checks.shown(where)}"
        )
    nodes = checks.whole_numbers(where, described, most=body.mesh_node_count - 1)
    if len(nodes) == 0 or len(set(nodes.tolist())) != len(nodes):
        raise ValueError(f"{described}: needs different nodes, got {checks.shown(where)}")
    share = np.ones(len(nodes))
    if weights is not None:
        share = checks.vector(weights, "weights", size=len(nodes))
        if np.any(share < 0.0) or not np.any(share):
            raise ValueError(f"weights: needs numbers above zero, got {checks.shown(weights)}")
    share = share / share.sum()
    item = body.mbs.GetObject(body.objects["marker_body"])
    places = np.reshape(item["referencePositions"], (-1, 3))[nodes]
    columns = np.asarray(item["modeBasis"])
    columns = columns.reshape(len(columns) // 3, 3, -1)[nodes]
    point, mean = share @ places, np.tensordot(share, columns, 1)
    moments, levers = rotation_moments(places - point, share)
    sizes = np.linalg.eigvalsh(moments)
    motion = np.vstack([mean, np.zeros_like(mean)])
    if sizes[0] > _FLAT * sizes[-1]:
        motion[3:] = np.linalg.solve(moments, np.einsum("nab,nbm->am", levers, columns))
    elif kind == "rigid":
        raise ValueError(
            f"where: the nodes {checks.shown(nodes.tolist())} lie on a line or in a point and show "
            "no rotation; give more nodes, an interface, or kind='position'"
        )
    return point, motion, float(np.sqrt(0.5 * np.trace(moments))), (nodes, share)
