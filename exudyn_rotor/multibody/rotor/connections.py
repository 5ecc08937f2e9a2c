"""What a scene attaches to a rotor and the rotor cannot carry, found by a walk through the ``mbs``.

Rigid and position markers at the node of the frame are pointed at others that move with the rotor
(:mod:`exudyn_rotor.multibody.rotor.assembly`). Markers of its coordinates see the frame alone:
it turns about the spin axis and translates as the formulation says, and its translation is that of
the centre of mass. Tilts are modal coordinates.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import exudyn
import numpy as np

from exudyn_rotor.multibody.rotor.frame import MODES
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems

_ALONG = 1e-6  # sine of the angle up to which a direction counts as that of the spin axis
NODE_MARKERS = ("NodeRigid", "NodePosition")
_COORDINATES = ("NodeCoordinate", "NodeCoordinates", "NodeRotationCoordinate")
_KINDS = exudyn.OutputVariableType
# what a sensor of the node shows without the rotor's tilts
_WITHOUT_TILTS = (
    *(_KINDS.Position, _KINDS.Displacement, _KINDS.Velocity, _KINDS.Acceleration),
    *(_KINDS.AngularVelocityLocal, _KINDS.AngularAcceleration),
)
_APART = 1e-3  # of the radius of gyration, by which the node is off the centre of mass
_INSTEAD = "; use body.marker(interface) or body.add_marker(nodes)"
_OFFSET = f"a force at a marker's own offset has no lever for tilts, which are modes{_INSTEAD}"


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
    mbs, found = body.mbs, []
    for is_load, number, reason in _lost(body):
        item = mbs.GetLoad(number) if is_load else mbs.GetObject(number)
        kind = "load" if is_load else item["objectType"]
        found.append(f"{kind} {item['name']!r}: {reason}")
    return (*found, *_sensors(body))


def lost_items(body: RotorItems) -> list[tuple[bool, int]]:
    """Return which items a rotor cannot carry: whether each is a load, and its number.

    Sensors change no motion and do not count.
    """
    return [(is_load, number) for is_load, number, _ in _lost(body)]


def _lost(body: RotorItems) -> Iterator[tuple[bool, int, str]]:
    """Yield whether an item is a load, its number, and why the rotor cannot carry it."""
    mbs, markers = body.mbs, _Markers(body)
    for number in range(mbs.systemData.NumberOfLoads()):
        load = mbs.GetLoad(number)
        reason = markers.why_lost(int(load["markerNumber"]), "a load")
        if reason and not (reason is _OFFSET and load["loadType"] != "ForceVector"):
            yield True, number, reason
    own = set(map(int, body.constraints.values()))
    own |= {int(number) for drive in body.drives for number in drive.objects}
    for number in range(mbs.systemData.NumberOfObjects()):
        item = mbs.GetObject(number)
        if number in own or "markerNumbers" not in item or not item.get("activeConnector", 1):
            continue
        for place, marker in enumerate(map(int, item["markerNumbers"])):
            used = np.atleast_2d(item.get(f"scalingMarker{place}", np.zeros((0, 0))))
            columns = np.flatnonzero(np.any(used != 0.0, axis=0)) if used.size else ()
            reason = markers.why_lost(marker, "a connector", columns)
            if marker in body.script.carriers.values():
                reason = _false_damping(body, item)
            if reason:
                yield False, number, reason


class _Markers:
    """The markers of an ``mbs`` at which one rotor may not carry what acts."""

    def __init__(self, body: RotorItems) -> None:
        mbs, self.body = body.mbs, body
        every = {n: mbs.GetMarker(n) for n in range(mbs.systemData.NumberOfMarkers())}
        node = int(body.nodes["rigid"])
        at_node = {n: m for n, m in every.items() if int(m.get("nodeNumber", -1)) == node}
        self.coordinates = {n: m for n, m in at_node.items() if m["markerType"] in _COORDINATES}
        self.rigid = {n for n, m in at_node.items() if m["markerType"] in NODE_MARKERS}
        marker_body = int(body.objects["marker_body"])
        self.offset = {
            number
            for number, marker in every.items()
            if marker["markerType"] == "SuperElementRigid"
            and int(marker["bodyNumber"]) == marker_body
            and np.any(marker["offset"])
        }

    def why_lost(self, number: int, what: str, columns: Sequence[int] = ()) -> str | None:
        """Return why what acts at a marker is lost; of several coordinates on `columns`."""
        if number in self.offset:
            return _OFFSET
        if number in self.rigid:  # mbs.Assemble() has pointed the others elsewhere
            return f"the node of a full body does not tilt: what acts there is lost{_INSTEAD}"
        if number not in self.coordinates:
            return None
        marker, frame, locks = self.coordinates[number], self.body.frame, self.body.locks
        if marker["markerType"] == "NodeCoordinate":
            columns = [int(marker["coordinate"])]
        elif marker["markerType"] == "NodeRotationCoordinate":
            axis = np.eye(3)[int(marker["rotationCoordinate"])]
            along = abs(axis @ self.body.standing_axes[:, 2]) > 1.0 - _ALONG
            columns = [locks.spin if along and frame.has_mesh_axes else locks.tilts[0]]
        reasons = (self._of_coordinate(int(column), what) for column in columns)
        return next(filter(None, reasons), None)

    def _of_coordinate(self, index: int, what: str) -> str | None:
        body = self.body
        if index in body.locks.unknown or index == body.locks.spin:
            inv = body.motion.invariants
            apart = float(np.linalg.norm(body.selection.origin + inv.center))
            if index >= MODES // 2 or apart < _APART * np.sqrt(np.trace(inv.J) / inv.mass):
                return None
            return (
                f"the coordinates of the frame's node move the centre of mass, {apart:.3g} m off "
                f"the node's place: {what} on its coordinate {index} acts there; use a "
                "MarkerNodeRigid or MarkerNodePosition"
            )
        return (
            f"the frame's node does not tilt (tilts are modes), nor move where the formulation has "
            f"no translation: {what} on its coordinate {index} has no effect{_INSTEAD}"
        )


def _false_damping(body: RotorItems, item: dict[str, Any]) -> str | None:
    """Return what is wrong with a damper of tilts: Exudyn takes their rate in other axes."""
    if item["objectType"] != "ConnectorRigidBodySpringDamper":
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
