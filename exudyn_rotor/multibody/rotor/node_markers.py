"""Markers and sensors that a script puts on the node of a rotor's frame, and that see its tilts.

The frame of Exudyn's flexible body tilts, and moves, with the rotor. That of a fixed axis turns
only; tilts are modes, and so are translations that the formulation does not have. A force on its
node would act in the centre of mass, whatever the node's place, and a torque across the axis on
nothing. What moves as the node of Exudyn's body is the mean rigid motion of the rotor at a point x,

    u = A (Sζ/m + φ × (x − χ)),    φ = I⁻¹ Σ M y × ψ ζ,

in which rigid modes have a share alone, and Craig–Bampton modes, which hold Exudyn's frame at a
boundary (:mod:`exudyn_rotor.reduction.mean_axis`). Rigid and position markers at the node, and
sensors of place, velocity and rotation, therefore go to virtual nodes of the flexible body that
have this motion: ``mbs.AddMarker`` and ``mbs.AddSensor`` see to it. Where a script puts nothing on
the node, nothing is added.

Tilts about the node's place in the basis, ``S ≠ 0``, would move the node itself, but not tilt it;
they couple translations and tilts by ``A S``, so that no matrix is constant, and a step takes five
times as long with a free spin and twelve times at constant speed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import exudyn
import numpy as np
from exudyn.itemInterface import MarkerSuperElementPosition, MarkerSuperElementRigid

from exudyn_rotor.multibody.mark import Mark, mark_of
from exudyn_rotor.multibody.rotor.marker_body import append_nodes, virtual_nodes
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.multibody.wrapping import wraps_method
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.nodal import skew

_MARKERS = ("NodeRigid", "NodePosition")
_SUPER_ELEMENT = ("SuperElementPosition", "SuperElementRigid", "SuperElement")
_KINDS = exudyn.OutputVariableType
_OF_PLACE = (_KINDS.Position, _KINDS.Displacement, _KINDS.Velocity)
_OF_ROTATION = (_KINDS.Rotation, _KINDS.RotationMatrix, _KINDS.AngularVelocity)
_PLACES = "exudyn_rotor: what moves as the nodes of rotors"  # key in mbs.sys, by their marks
_Z = SpinAxis([0.0, 0.0, 1.0])  # of the plane of the three nodes; any serves


@dataclass(frozen=True, eq=False)
class NodePlace:
    """What moves as the node of Exudyn's body: a point of a rotor with its mean rigid motion.

    Attributes
    ----------
    physics, node, marker_body : int
        Numbers of the equations, of the frame's node and of the flexible body.
    mark : tuple or None
        By which the rotor is known again.
    point : ndarray, shape (3,)
        Axes of the flexible body, from the origin of its frame [m].
    motion : ndarray, shape (6, m)
        Mean displacement and rotation there, the same axes.
    axes : ndarray, shape (3, 3)
        Mesh axes → axes of the flexible body.
    arm : float
        Distance of the virtual nodes of a rigid marker from the point [m].
    held : bool
        Whether elastic modes move the frame of Exudyn's body, which they hold at a boundary.
    refusal : str, optional
        Why no marker can be put there.
    """

    physics: int
    node: int
    marker_body: int
    mark: Mark | None
    point: np.ndarray
    motion: np.ndarray
    axes: np.ndarray
    arm: float
    held: bool
    refusal: str | None = None
    virtual: dict[tuple, list[int]] = field(default_factory=dict)

    @property
    def rigid_nodes(self) -> list[list[int]]:
        """The nodes of all rigid markers that have been put there."""
        return [nodes for key, nodes in self.virtual.items() if key[0]]

    def nodes(self, mbs: exudyn.MainSystem, rigid: bool, shift: np.ndarray) -> list[int]:
        """Return one or three virtual nodes at the point, shifted by (3,); add them once.

        Raises
        ------
        ValueError
            Where no marker can be put there.
        """
        if self.refusal:
            raise ValueError(self.refusal)
        key = (rigid, *shift)
        if key not in self.virtual:
            u = self.motion[:3] - skew(shift) @ self.motion[3:]
            place, columns = (self.point + shift)[None, :], u
            if rigid:
                moved = np.vstack([u, self.motion[3:]])
                place, columns = virtual_nodes(place[0], self.arm, moved, _Z)
            self.virtual[key] = append_nodes(mbs, self.marker_body, place, columns)
        return self.virtual[key]


def carry_markers(body: RotorItems, held: np.ndarray | None = None) -> None:
    """Let markers and sensors that are added at the node of a rotor's frame move with the rotor.

    `held` (r, k − r) is the motion of Exudyn's frame by the elastic columns of the reduced rotor,
    in shares of its r rigid ones (:func:`exudyn_rotor.reduction.mean_axis.frame_shares`); none by
    default.
    """
    reduced, frame, selection = body.selection.source, body.frame, body.selection
    inv, rigid = reduced.invariants, len(reduced.rigid_kinds)
    columns = selection.T[:rigid]
    if held is not None:
        columns = columns + held @ selection.T[rigid:]
    turn = inv.mean_rotation[:, :rigid]
    arm = frame.node - reduced.center_of_mass
    shift = inv.S[:, :rigid] / inv.mass - skew(arm) @ turn
    body.mbs.sys.setdefault(_PLACES, {})[body.mark] = NodePlace(
        physics=int(body.objects["physics"]),
        node=int(body.nodes["rigid"]),
        marker_body=int(body.objects["marker_body"]),
        mark=body.mark,
        point=frame.points(frame.node),
        motion=np.vstack([frame.B @ shift, frame.B @ turn]) @ columns,
        axes=frame.B,
        arm=float(np.sqrt(np.trace(inv.J) / inv.mass)),
        held=held is not None,
    )


def refuse_markers(body: RotorItems) -> None:
    """Refuse markers and sensors at the node of a full body's frame, which would see no tilts."""
    body.mbs.sys.setdefault(_PLACES, {})[body.mark] = NodePlace(
        physics=int(body.objects["physics"]),
        node=int(body.nodes["rigid"]),
        marker_body=int(body.objects["marker_body"]),
        mark=body.mark,
        point=body.frame.points(body.frame.node),
        motion=np.zeros((6, 0)),
        axes=body.frame.B,
        arm=0.0,
        held=False,
        refusal=(
            f"nodeNumber: is that of the frame of rotor {body.name!r}, a full body; its tilts are "
            "displacements, which no marker or sensor there would see. Use body.marker(interface), "
            "body.add_marker(nodes) and their sensors, or a reduced rotor, rotor.reduce(…)"
        ),
    )


def place_of(body: RotorItems) -> NodePlace:
    """Return what moves as the node of a rotor with a flexible body."""
    return body.mbs.sys[_PLACES][body.mark]


def _place_of(mbs: exudyn.MainSystem, entries: dict) -> NodePlace | None:
    """Return the place that a marker or sensor is at; None where it is at no rotor's node."""
    number = _number(entries, "nodeNumber")
    for place in mbs.sys[_PLACES].values():
        if place.node == number and mark_of(mbs, place.physics) == place.mark:
            return place
    return None


def _number(entries: dict, name: str) -> int | None:
    """Return the number of an item that an entry names; None where it names none."""
    try:
        return int(entries[name])
    except (KeyError, TypeError, ValueError):
        return None


def _entries(item: object) -> dict:
    """Return the entries of an item of Exudyn; none where it is nothing that Exudyn knows."""
    try:
        return dict(item)
    except (TypeError, ValueError):
        return {}


def _refuse_mesh_nodes(mbs: exudyn.MainSystem, entries: dict) -> None:
    """Refuse what asks for mesh nodes of a full body's flexible body, which has virtual ones."""
    kind = entries.get("markerType", entries.get("sensorType", ""))
    if kind not in _SUPER_ELEMENT:
        return
    number = _number(entries, "bodyNumber")
    for place in mbs.sys[_PLACES].values():
        if (
            place.refusal
            and place.marker_body == number
            and mark_of(mbs, place.physics) == place.mark
        ):
            raise ValueError(
                f"bodyNumber: {number} is the marker body of a full rotor body, whose "
                "nodes are not those of the mesh; use body.add_marker(nodes) and "
                "body.add_node_sensor(node, output)"
            )


class CopiedMarker(dict):
    """Entries of a marker that a system has, for another one: its nodes are what they are."""


def _moved_marker(mbs: exudyn.MainSystem, item: object) -> object:
    """Return a marker of the flexible body in place of one of its frame's node."""
    if isinstance(item, CopiedMarker):
        return item
    entries = _entries(item)
    _refuse_mesh_nodes(mbs, entries)
    kind = entries.get("markerType")
    place = _place_of(mbs, entries) if kind in _MARKERS else None
    if place is None:
        return item
    rigid = kind == "NodeRigid"
    given = entries.get("localHT")
    local = np.eye(4) if given is None or np.size(given) == 0 else np.asarray(given, dtype=float)
    nodes = place.nodes(mbs, rigid, place.axes @ local[:3, 3])
    common = {
        "name": entries.get("name", ""),
        "bodyNumber": place.marker_body,
        "meshNodeNumbers": nodes,
        "weightingFactors": [1.0 / len(nodes)] * len(nodes),
        "visualization": {"show": entries.get("Vshow", True), "showMarkerNodes": False},
    }
    if not rigid:
        return MarkerSuperElementPosition(**common)
    turn = np.eye(4)
    turn[:3, :3] = place.axes @ local[:3, :3]
    return MarkerSuperElementRigid(localHT=turn, **common)


def _moved_sensor(mbs: exudyn.MainSystem, item: object) -> object:
    """Return a sensor of a marker in place of one of the frame's node, where there is such one."""
    entries = _entries(item)
    _refuse_mesh_nodes(mbs, entries)
    of_node = entries.get("sensorType") == "Node"
    kind = entries.get("outputVariableType")
    if not of_node or kind not in (*_OF_PLACE, *_OF_ROTATION):
        return item
    if _place_of(mbs, entries) is None:
        return item
    marker_type = "NodePosition" if kind in _OF_PLACE else "NodeRigid"
    marker = {"markerType": marker_type, "nodeNumber": entries.pop("nodeNumber"), "Vshow": False}
    number = mbs.AddMarker(marker)
    return entries | {"sensorType": "Marker", "markerNumber": number}


@wraps_method("AddMarker")
def _add_marker(add: Callable, mbs: exudyn.MainSystem, pyObject: object) -> exudyn.MarkerIndex:
    """Add a marker as Exudyn does, one of a rotor's frame to the flexible body."""
    return add(mbs, _moved_marker(mbs, pyObject) if _PLACES in mbs.sys else pyObject)


@wraps_method("AddSensor")
def _add_sensor(add: Callable, mbs: exudyn.MainSystem, pyObject: object) -> exudyn.SensorIndex:
    """Add a sensor as Exudyn does, one of a rotor's frame to a marker there."""
    return add(mbs, _moved_sensor(mbs, pyObject) if _PLACES in mbs.sys else pyObject)
