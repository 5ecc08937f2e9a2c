"""What a scene attaches to a rotor and the rotor cannot carry, found by a walk through the ``mbs``.

Rigid and position markers at the node of the frame move with the rotor
(:mod:`exudyn_rotor.multibody.rotor.node_motion`). Markers of its coordinates see the frame alone:
it turns about the spin axis and translates as the formulation says, and its translation is that of
the centre of mass. Tilts are modal coordinates.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import exudyn
import numpy as np

from exudyn_rotor.multibody.rotor.node_motion import NODE_MARKERS
from exudyn_rotor.multibody.rotor.rotor_items import KnownRotor, RotorItems, known_rotor

_ALONG = 1e-6  # sine of the angle up to which a direction counts as that of the spin axis
_COORDINATES = ("NodeCoordinate", "NodeCoordinates", "NodeRotationCoordinate")
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


def lost_connections(mbs: exudyn.MainSystem, rotor: KnownRotor) -> tuple[str, ...]:
    """Return what the rotor cannot carry, one sentence each, for an assembled system."""
    walk = _Walk(mbs, rotor)
    loads = [(f"load {mbs.GetLoad(n)['name']!r}", reason) for n, reason in walk.loads()]
    objects = [
        (f"{(item := mbs.GetObject(n))['objectType']} {item['name']!r}", reason)
        for n, reason in walk.objects()
    ]
    return tuple(f"{item}: {reason}" for item, reason in (*loads, *objects, *walk.sensors()))


def lost_items(body: RotorItems) -> list[tuple[bool, int]]:
    """Return which items a rotor cannot carry: whether each is a load, and its number.

    Sensors change no motion and do not count.
    """
    if "marker_body" not in body.objects:
        return []
    walk = _Walk(body.mbs, known_rotor(body))
    loads = [(True, number) for number, _ in walk.loads()]
    return loads + [(False, number) for number, _ in walk.objects()]


class _Walk:
    """The items of an ``mbs`` that act on one rotor where it may not carry them."""

    def __init__(self, mbs: exudyn.MainSystem, rotor: KnownRotor) -> None:
        self.mbs, self.rotor = mbs, rotor
        self.n, locks = rotor.axis, rotor.plan.locks
        self.locked = {*locks.tilts, *(i for i in (*locks.fixed, *locks.prescribed) if i < 3)}
        self.apart = self._distance_to_centre_of_mass()
        numbers = range(mbs.systemData.NumberOfMarkers())
        every = {number: mbs.GetMarker(number) for number in numbers}
        at_node = {n: m for n, m in every.items() if int(m.get("nodeNumber", -1)) == rotor.node}
        self.coordinates = {n: m for n, m in at_node.items() if m["markerType"] in _COORDINATES}
        self.rigid = {n for n, m in at_node.items() if m["markerType"] in NODE_MARKERS}
        self.offset = {
            number
            for number, marker in every.items()
            if marker["markerType"] == "SuperElementRigid"
            and int(marker["bodyNumber"]) == rotor.marker_body
            and np.any(marker["offset"])
        }
        self.carriers = set(rotor.carriers.values())

    def _distance_to_centre_of_mass(self) -> float:
        """Return how far the node's place is off the centre of mass that its coordinates move."""
        plan, inv = self.rotor.plan, self.rotor.plan.motion.invariants
        apart = float(np.linalg.norm(plan.frame.node - plan.selection.origin - inv.center))
        return apart if apart > _APART * np.sqrt(np.trace(inv.J) / inv.mass) else 0.0

    def loads(self) -> Iterator[tuple[int, str]]:
        """Yield numbers of loads, and why they are lost."""
        for number in range(self.mbs.systemData.NumberOfLoads()):
            load = self.mbs.GetLoad(number)
            marker, reason = int(load["markerNumber"]), None
            if marker in self.coordinates:
                reason = self._coordinate(int(self.coordinates[marker]["coordinate"]), "a load")
            elif marker in self.rigid:
                reason = self._of_full()
            elif marker in self.offset and load["loadType"] == "ForceVector":
                reason = _offset("a force")
            if reason:
                yield number, reason

    def objects(self) -> Iterator[tuple[int, str]]:
        """Yield numbers of connectors and joints, and what of them is lost or wrong."""
        own = self.rotor.own | {int(one) for drive in self.rotor.drives for one in drive.objects}
        for number in range(self.mbs.systemData.NumberOfObjects()):
            item = self.mbs.GetObject(number)
            if number in own or "markerNumbers" not in item or not item.get("activeConnector", 1):
                continue
            for place, marker in enumerate(map(int, item["markerNumbers"])):
                reason = None
                if marker in self.coordinates:
                    reason = self._connector(item, place, marker)
                elif marker in self.rigid:
                    reason = self._of_full()
                elif marker in self.offset:
                    reason = _offset("its force")
                elif marker in self.carriers:
                    reason = self._damping(item)
                if reason:
                    yield number, reason

    def sensors(self) -> Iterator[tuple[str, str]]:
        """Yield sensors of the frame's node that show less than on Exudyn's body."""
        for number in range(self.mbs.systemData.NumberOfSensors()):
            sensor = self.mbs.GetSensor(number)
            if sensor["sensorType"] != "Node" or int(sensor["nodeNumber"]) != self.rotor.node:
                continue
            kind = sensor["outputVariableType"]
            if kind in _WITHOUT_TILTS:
                yield (
                    f"sensor {sensor['name']!r}",
                    f"{kind.name} of the frame's node is that of spin and centre of mass alone, "
                    "without tilts; take a sensor of a MarkerNodeRigid there",
                )

    def _of_full(self) -> str:
        """Return why a rigid or position marker at the node is lost: only full bodies have none."""
        return f"the node of a full body does not tilt: what acts there is lost{_INSTEAD}"

    def _connector(self, item: dict[str, Any], place: int, number: int) -> str | None:
        marker, spin = self.coordinates[number], self.rotor.plan.locks.spin
        if marker["markerType"] == "NodeCoordinate":
            return self._coordinate(int(marker["coordinate"]), "a connector")
        if marker["markerType"] == "NodeRotationCoordinate":
            axis = np.eye(3)[int(marker["rotationCoordinate"])]
            if not self.rotor.plan.frame.has_mesh_axes:
                return "the node's axes are those of the mesh turned by body.frame.B"
            across = np.linalg.norm(np.cross(axis, self.n)) > _ALONG
            return _tilts("a connector") if across else self._coordinate(spin, "a connector")
        used = np.atleast_2d(item.get(f"scalingMarker{place}", np.zeros((0, 0))))
        columns = np.flatnonzero(np.any(used != 0.0, axis=0)) if used.size else ()
        reasons = (self._coordinate(int(column), "a connector") for column in columns)
        return next(filter(None, reasons), None)

    def _coordinate(self, index: int, what: str) -> str | None:
        if index in self.rotor.plan.locks.tilts:
            return _tilts(f"{what} on its coordinate {index}")
        if index in self.locked:
            return (
                f"the frame's node does not move so: {what} on its coordinate {index} has no "
                f"effect{_INSTEAD}"
            )
        if index == self.rotor.plan.locks.spin and self.rotor.frame_shares is not None:
            return (
                "the angle of the frame's node is the rotor's mean rotation, on Exudyn's body with "
                f"these Craig–Bampton modes that of the first boundary: {what} on it acts there; "
                "use a MarkerNodeRigid"
            )
        if index < 3 and self.apart:
            return (
                f"the coordinates of the frame's node move the centre of mass, {self.apart:.3g} m "
                f"off the node's place: {what} on its coordinate {index} acts there; use a "
                "MarkerNodeRigid or MarkerNodePosition"
            )
        return None

    def _damping(self, item: dict[str, Any]) -> str | None:
        """Return what is wrong with a damper of tilts: Exudyn takes their rate in other axes."""
        if item["objectType"] != "ConnectorRigidBodySpringDamper":
            return None
        damping = item["damping"][3:, 3:]
        first = self._axes(int(item["markerNumbers"][0])) @ item["rotationMarker0"]
        across = np.eye(3) - np.outer(self.n, self.n)
        lost = np.linalg.norm(across @ first @ damping, 2)
        if lost <= _ALONG * np.linalg.norm(damping, 2):
            return None
        return (
            f"its damping of tilts, {lost:.3g} N m s/rad, comes with a false cross stiffness of as "
            "much times the spin speed, since Exudyn gives a marker's angular velocity in axes of "
            "the frame; damp tilts by translational dampers at two places"
        )

    def _axes(self, marker: int) -> np.ndarray:
        """Return the axes of a rigid marker in space."""
        return np.reshape(self.mbs.GetMarkerOutput(marker, _KINDS.RotationMatrix), (3, 3))


def _tilts(what: str) -> str:
    return f"the frame's node does not tilt (tilts are modes): {what} has no effect{_INSTEAD}"


def _offset(what: str) -> str:
    return f"{what} at a marker's own offset has no lever for tilts, which are modes{_INSTEAD}"
