"""What a scene attaches to a rotor, by a walk through the ``mbs``: what is lost, where loads act.

Markers of coordinates of the frame's node see the frame alone: it turns about the spin axis, and
its translation, if the formulation has it, is that of the centre of mass. Tilts are modes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import exudyn
import numpy as np

from exudyn_rotor.bearings.support import Support
from exudyn_rotor.multibody.rotor.plan import MODES
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems, marker_carrier
from exudyn_rotor.theory.axis import skew

_ALONG = 1e-6  # sine of the angle up to which a direction counts as that of the spin axis
NODE_MARKERS = ("NodeRigid", "NodePosition")
_KINDS = exudyn.OutputVariableType
# what a sensor of the node shows without the rotor's tilts
_WITHOUT_TILTS = (
    *(_KINDS.Position, _KINDS.Displacement, _KINDS.Velocity, _KINDS.Acceleration),
    *(_KINDS.AngularVelocityLocal, _KINDS.AngularAcceleration),
)
_APART = 1e-3  # of the radius of gyration, by which the node is off the centre of mass
_INSTEAD = "; use body.marker(interface) or body.add_marker(nodes)"


class ConnectionWarning(UserWarning):
    """A rotor in a scene cannot carry what is attached to it.

    Examples
    --------
    Not for a script that knows:

    >>> import warnings
    >>> from exudyn_rotor import ConnectionWarning
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("ignore", ConnectionWarning)
    """


def lost_connections(body: RotorItems) -> tuple[str, ...]:
    """Return what the rotor cannot carry, one sentence each, for an assembled system."""
    items = [
        f"{item.get('objectType', 'load')} {item['name']!r}: {reason}"
        for _, item, reason in lost_items(body)
    ]
    return (*items, *_sensors(body))


def attached(mbs: exudyn.MainSystem) -> Iterator[tuple[int, dict[str, Any], list[int]]]:
    """Yield loads, connectors and joints: the number, the item and its markers."""
    data = mbs.systemData
    for number in range(data.NumberOfLoads()):
        load = mbs.GetLoad(number)
        yield number, load, [int(load["markerNumber"])]
    for number in range(data.NumberOfObjects()):
        item = mbs.GetObject(number)
        if "markerNumbers" in item:
            yield number, item, list(map(int, item["markerNumbers"]))


def lost_items(body: RotorItems) -> Iterator[tuple[int, dict[str, Any], str]]:
    """Yield the number of a load, connector or joint, the item, and why the rotor cannot carry it.

    Sensors change no motion and do not count.
    """
    own = set(map(int, body.constraints.values()))
    own |= {int(number) for drive in body.drives for number in drive.objects}
    for number, item, markers in attached(body.mbs):
        is_own = number in own and "loadType" not in item
        if is_own or not item.get("activeConnector", True):
            continue
        for place, marker in enumerate(markers):
            if marker in body.script.carriers.values():
                reason = _false_damping(body, item)
            else:
                reason = _why_lost(body, body.mbs.GetMarker(marker), item, place)
            if reason:
                yield number, item, reason


def _why_lost(
    body: RotorItems, marker: dict[str, Any], item: dict[str, Any], place: int
) -> str | None:
    """Return why what an item does at a marker, its number `place`, is lost; None if it is not."""
    kind = marker["markerType"]
    if int(marker.get("bodyNumber", -1)) == int(body.objects["marker_body"]):
        with_lever = item.get("loadType", "ForceVector") == "ForceVector"
        if with_lever and np.any(marker.get("offset", 0.0)):
            return f"a force at a marker's own offset has no lever for tilts (modes){_INSTEAD}"
    if int(marker.get("nodeNumber", -1)) != int(body.nodes["rigid"]):
        return None
    if kind in NODE_MARKERS:  # mbs.Assemble() has pointed the others elsewhere
        return f"the node of a full body does not tilt: what acts there is lost{_INSTEAD}"
    reasons = (_why_coordinate_lost(body, one) for one in _used(body, marker, item, place))
    return next(filter(None, reasons), None)


def _used(
    body: RotorItems, marker: dict[str, Any], item: dict[str, Any], place: int
) -> Sequence[int]:
    """Return the coordinates of the frame's node on which an item acts."""
    kind, locks = marker["markerType"], body.locks
    if kind == "NodeCoordinate":
        return [int(marker["coordinate"])]
    if kind == "NodeRotationCoordinate":
        axis = np.eye(3)[int(marker["rotationCoordinate"])]
        along = abs(axis @ body.standing_axes[:, 2]) > 1.0 - _ALONG
        with_mesh_axes = np.array_equal(body.frame.B, np.eye(3))
        return [locks.spin if along and with_mesh_axes else locks.tilts[0]]
    rows = np.atleast_2d(item.get(f"scalingMarker{place}", np.zeros((0, 0))))
    return np.flatnonzero(np.any(rows != 0.0, axis=0)).tolist() if rows.size else []


def _why_coordinate_lost(body: RotorItems, index: int) -> str | None:
    if index not in body.locks.unknown and index != body.locks.spin:
        return (
            "the frame's node does not tilt (tilts are modes), nor move where the formulation has "
            f"no translation: what acts on its coordinate {index} has no effect{_INSTEAD}"
        )
    inv = body.motion.invariants
    apart = float(np.linalg.norm(body.selection.origin + inv.center))
    if index >= MODES // 2 or apart < _APART * np.sqrt(np.trace(inv.J) / inv.mass):
        return None
    return (
        f"the coordinates of the frame's node move the centre of mass, {apart:.3g} m off the "
        f"node's place: what acts on its coordinate {index} acts there; use a MarkerNodeRigid or "
        "MarkerNodePosition"
    )


def _false_damping(body: RotorItems, item: dict[str, Any]) -> str | None:
    """Return what is wrong with a damper of tilts: Exudyn takes their rate in other axes."""
    if item.get("objectType") != "ConnectorRigidBodySpringDamper":
        return None
    damping, first = item["damping"][3:, 3:], int(item["markerNumbers"][0])
    axes = np.reshape(body.mbs.GetMarkerOutput(first, _KINDS.RotationMatrix), (3, 3))
    along = body.standing_axes[:, 2]
    across = np.eye(3) - np.outer(along, along)
    lost = np.linalg.norm(across @ axes @ item["rotationMarker0"] @ damping, 2)
    if lost <= _ALONG * np.linalg.norm(damping, 2):
        return None
    return (
        f"its damping of tilts, {lost:.3g} N m s/rad, comes with a false cross stiffness of as "
        "much times the spin speed, since Exudyn gives a marker's angular velocity in axes of the "
        "frame; damp tilts by translational dampers at two places"
    )


def _sensors(body: RotorItems) -> Iterator[str]:
    """Yield sensors of the frame's node that show less than on Exudyn's body."""
    for number in range(body.mbs.systemData.NumberOfSensors()):
        sensor = body.mbs.GetSensor(number)
        at_node = sensor["sensorType"] == "Node"
        if not at_node or int(sensor["nodeNumber"]) != int(body.nodes["rigid"]):
            continue
        kind = sensor["outputVariableType"]
        if kind in _WITHOUT_TILTS:
            yield (
                f"sensor {sensor['name']!r}: {kind.name} of the frame's node is that of spin and "
                "centre of mass alone, without tilts; take a sensor of a MarkerNodeRigid there"
            )


_MARKERS = ("SuperElementPosition", "SuperElementRigid")
# loads and connectors that exert no moment
_FORCES = ("ForceVector", "ConnectorCartesianSpringDamper", "ConnectorSpringDamper")
_SAME = 1e-6  # of the motion of an interface, by which a marker there may differ


@dataclass(frozen=True, eq=False)
class LoadPlace:
    """A place of a rotor where forces act, and perhaps moments."""

    point: np.ndarray  # (3,) Mesh coordinates [m]
    # (6, m) Displacement, and rotation where moments act, by modal coordinates, mesh axes
    motion: np.ndarray
    interface: str | None  # whose mean motion this is


def load_places(body: RotorItems) -> tuple[LoadPlace, ...]:
    """Return where loads and connectors act on a reduced rotor."""
    moments: dict[int, bool] = {}  # of markers, whether moments may act there
    for _, item, markers in attached(body.mbs):
        kind = item.get("loadType") or item["objectType"]
        for marker in markers if item.get("activeConnector", True) else ():
            moments[marker] = moments.get(marker, False) or kind not in _FORCES
    found = []
    for number, with_moments in moments.items():
        marker = body.mbs.GetMarker(number)
        own = int(marker.get("bodyNumber", -1)) == int(body.objects["marker_body"])
        if own and marker["markerType"] in _MARKERS:
            carrier, turn = marker_carrier(body.mbs, marker), body.frame.B
            motion = np.kron(np.eye(2), turn.T) @ carrier.motion
            if not with_moments or marker["markerType"] != "SuperElementRigid":
                motion[3:] = 0.0
            on_mesh = carrier.point @ turn + body.frame.origin
            found.append(LoadPlace(on_mesh, motion, _interface_at(body, on_mesh, motion)))
    # drives, connections of rotors and laws of supports act by coordinates
    acting = {
        one.at if one.body.script is body.script else one.other_at: True for one in body.drives
    }
    for one in body.supports:
        if one.uses_python:
            name, law = one.support.interface, one.support
            tilts = isinstance(law, Support) and law.tilts
            acting[name] = acting.get(name, False) or tilts
    for name, interface in body.selection.source.interfaces.items():
        if name in acting:
            motion = interface.motion @ body.selection.T
            motion[3:] *= acting[name]
            found.append(LoadPlace(interface.reference, motion, name))
    return tuple(found)


def _interface_at(body: RotorItems, point: np.ndarray, motion: np.ndarray) -> str | None:
    """Return the interface, the nearest, that moves a point (3,) of its own by `motion`."""
    found = {}
    for name, interface in body.selection.source.interfaces.items():
        mean, arm = interface.motion @ body.selection.T, point - interface.reference
        expected = mean[:3] - skew(arm) @ mean[3:]
        if np.abs(motion[:3] - expected).max() <= _SAME * np.abs(expected).max():
            found[name] = float(np.linalg.norm(arm))
    return min(found, key=found.__getitem__, default=None)
