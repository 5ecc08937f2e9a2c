"""What a scene attaches to the node of a rotor's frame, and that node cannot carry.

The node turns about the spin axis and translates as the formulation says. Tilts of the rotor are
modal coordinates, so that torques across the axis, springs and joints against tilts, and forces
along a translation that the node does not have act on nothing there. All of them are found by a
walk through the ``mbs``; markers at interfaces and mesh nodes carry them.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import exudyn
import numpy as np

from exudyn_rotor.multibody.rotor_items import RotorItems

_KINDS = exudyn.OutputVariableType
_ALONG = 1e-6  # sine of the angle up to which a direction counts as that of the spin axis
_NOTHING = 1e-9  # share of a load or stiffness that is rounding
_AT_NODE = (
    "NodeRigid",
    "NodePosition",
    "NodeCoordinate",
    "NodeCoordinates",
    "NodeRotationCoordinate",
)
_FORCES_ONLY = (
    "ConnectorSpringDamper",
    "ConnectorCartesianSpringDamper",
    "ConnectorDistance",
    "ConnectorLinearSpringDamper",
    "ConnectorGravity",
    "JointSpherical",
)
_SWAPPED = "exudyn_rotor: bodies in place of Exudyn's"  # key in mbs.sys
_APART = (
    1e-3  # of the radius of gyration, by which the node is elsewhere than that of Exudyn's body
)
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


def stands_for_exudyns(body: RotorItems) -> None:
    """Note that a script expects the node where Exudyn's body has it, in the mesh origin."""
    body.mbs.sys.setdefault(_SWAPPED, set()).add(int(body.objects["marker_body"]))


def lost_connections(body: RotorItems) -> tuple[str, ...]:
    """Return what the frame's node cannot carry, one sentence each, for an assembled system."""
    if "marker_body" not in body.objects:
        return ()
    found = [*_Walk(body).loads(), *_Walk(body).objects()]
    return tuple(f"{item}: {reason}{_INSTEAD}" for item, reason in found)


class _Walk:
    """The items of an ``mbs`` that act on the frame's node of one rotor."""

    def __init__(self, body: RotorItems) -> None:
        self.body, self.mbs = body, body.mbs
        motion, locks = body.motion, body.locks
        self.n = motion.orientation @ motion.invariants.direction
        held = np.eye(3) - motion.free_directions @ motion.free_directions.T
        self.held = held if locks.normal is None else np.outer(locks.normal, locks.normal)
        self.locked = {*locks.tilts, *(i for i in (*locks.fixed, *locks.prescribed) if i < 3)}
        self.apart = self._distance_to_exudyns_node()
        count = self.mbs.systemData.NumberOfMarkers()
        every = {number: self.mbs.GetMarker(number) for number in range(count)}
        node, flexible = int(body.nodes["rigid"]), int(body.objects["marker_body"])
        self.at_node = {
            number: marker
            for number, marker in every.items()
            if marker["markerType"] in _AT_NODE and int(marker["nodeNumber"]) == node
        }
        self.offset = {
            number
            for number, marker in every.items()
            if marker["markerType"] == "SuperElementRigid"
            and int(marker["bodyNumber"]) == flexible
            and np.any(marker["offset"])
        }

    def _distance_to_exudyns_node(self) -> float:
        """Return how far the node is off the mesh origin; 0 where no script expects it there."""
        body, inv = self.body, self.body.motion.invariants
        if int(body.objects["marker_body"]) not in self.mbs.sys.get(_SWAPPED, ()):
            return 0.0
        apart = float(np.linalg.norm(body.frame.origin))
        return apart if apart > _APART * np.sqrt(np.trace(inv.J) / inv.mass) else 0.0

    def loads(self) -> Iterator[tuple[str, str]]:
        """Yield loads, and why they are lost."""
        for number in range(self.mbs.systemData.NumberOfLoads()):
            load = self.mbs.GetLoad(number)
            marker = int(load["markerNumber"])
            reason = None
            if marker in self.at_node:
                reason = self._load(load, marker)
            elif marker in self.offset and load["loadType"] == "ForceVector":
                reason = _offset("a force")
            if reason:
                yield f"load {load['name']!r}", reason

    def objects(self) -> Iterator[tuple[str, str]]:
        """Yield connectors and joints, and why they hold nothing."""
        own = {int(number) for number in self.body.constraints.values()}
        for number in range(self.mbs.systemData.NumberOfObjects()):
            item = self.mbs.GetObject(number)
            if number in own or "markerNumbers" not in item or not item.get("activeConnector", 1):
                continue
            for place, marker in enumerate(map(int, item["markerNumbers"])):
                reason = None
                if marker in self.at_node:
                    reason = self._connector(item, place, marker)
                elif marker in self.offset:
                    reason = _offset("its force")
                if reason:
                    yield f"{item['objectType']} {item['name']!r}", reason

    def _load(self, load: dict[str, Any], number: int) -> str | None:
        marker = self.at_node[number]
        if load["loadType"] == "Coordinate":
            return self._coordinate(int(marker["coordinate"]), "a load")
        if load["loadType"] not in ("ForceVector", "TorqueVector"):
            return None
        turn = self._axes(number) if load["bodyFixed"] else np.eye(3)
        torque = load["loadType"] == "TorqueVector"
        lost = self._across() if torque else self.held
        for vector in self._vectors(load):
            missing = np.linalg.norm(lost @ turn @ vector)
            if missing > max(_ALONG * np.linalg.norm(vector), _NOTHING):
                return self._tilts(f"{missing:.4g} N m") if torque else self._held("a force")
            if self.apart and not torque and np.any(vector):
                return self._elsewhere("a force")
        return None

    def _vectors(self, load: dict[str, Any]) -> Iterator[np.ndarray]:
        """Yield the vectors of a load: that of a user function now and at the start."""
        function = load["loadVectorUserFunction"]
        if not function:
            yield np.asarray(load["loadVector"])
            return
        for t in (0.0, self.mbs.systemData.GetTime()):
            try:
                yield np.asarray(function["function"](self.mbs, t, load["loadVector"]), dtype=float)
            except Exception:  # whatever a user's function needs that is not there now
                return

    def _connector(self, item: dict[str, Any], place: int, number: int) -> str | None:
        marker, kind = self.at_node[number], item["objectType"]
        if marker["markerType"] == "NodeCoordinate":
            return self._coordinate(int(marker["coordinate"]), "a connector")
        if marker["markerType"] == "NodeCoordinates":
            used = np.atleast_2d(item.get(f"scalingMarker{place}", np.zeros((0, 0))))
            columns = np.flatnonzero(np.any(used != 0.0, axis=0)) if used.size else ()
            reasons = (self._coordinate(int(column), "a connector") for column in columns)
            return next(filter(None, reasons), None)
        if marker["markerType"] == "NodeRotationCoordinate":
            axis = np.eye(3)[int(marker["rotationCoordinate"])]
            return self._tilts("a connector") if self._tilts_about(axis) else None
        if marker["markerType"] == "NodeRigid" and kind not in _FORCES_ONLY:
            reason = self._rotations(item)
            if reason:
                return reason
        if np.linalg.matrix_rank(self.held, tol=0.5) == 3:
            return self._held("a connector")
        if self.apart and (marker["markerType"] == "NodePosition" or self._holds_places(item)):
            return self._elsewhere("a connector")
        return None

    def _holds_places(self, item: dict[str, Any]) -> bool:
        """Return whether a connector of rigid markers exerts forces beside torques."""
        if item["objectType"] == "ConnectorRigidBodySpringDamper":
            return bool(np.any(item["stiffness"][:3, :3]) or np.any(item["damping"][:3, :3]))
        if item["objectType"] == "JointGeneric":
            return bool(np.any(item["constrainedAxes"][:3]))
        return item["objectType"] != "ConnectorTorsionalSpringDamper"

    def _rotations(self, item: dict[str, Any]) -> str | None:
        """Return why a connector of rigid markers is lost by what it holds of rotations."""
        kind = item["objectType"]
        axes = self._axes(int(item["markerNumbers"][0])) @ item.get("rotationMarker0", np.eye(3))
        if kind == "ConnectorRigidBodySpringDamper":
            turning = np.abs(item["stiffness"][3:, 3:]) + np.abs(item["damping"][3:, 3:])
            lost = np.linalg.norm(self._across() @ axes @ turning)
            if lost <= _ALONG * np.linalg.norm(turning):
                return None
            return self._tilts("a rotational spring or damper across the spin axis")
        if kind == "ConnectorTorsionalSpringDamper":
            held = axes[:, 2:]
        elif kind == "JointGeneric":
            held = axes[:, np.flatnonzero(item["constrainedAxes"][3:])]
        else:
            held = axes
        if not any(self._tilts_about(axis) for axis in held.T):
            return None
        return self._tilts("a joint" if kind.startswith("Joint") else "a rotational connector")

    def _coordinate(self, index: int, what: str) -> str | None:
        if index not in self.locked:
            return None
        if index in self.body.locks.tilts:
            return self._tilts(f"{what} on its coordinate {index}")
        return self._held(f"{what} on its coordinate {index}")

    def _across(self) -> np.ndarray:
        return np.eye(3) - np.outer(self.n, self.n)

    def _tilts_about(self, axis: np.ndarray) -> bool:
        return bool(np.linalg.norm(np.cross(axis, self.n)) > _ALONG)

    def _axes(self, marker: int) -> np.ndarray:
        """Return the axes of a marker in space; those of space for one without axes."""
        try:
            turn = self.mbs.GetMarkerOutput(marker, _KINDS.RotationMatrix)
        except Exception:  # of a marker without rotation
            return np.eye(3)
        return np.reshape(turn, (3, 3))

    def _tilts(self, what: str) -> str:
        return f"the frame's node does not tilt (tilts are modes): {what} there has no effect"

    def _elsewhere(self, what: str) -> str:
        return (
            f"the frame's node is {self.apart:.3g} m off the mesh origin, where Exudyn's body has "
            f"its own: {what} there acts at another place"
        )

    def _held(self, what: str) -> str:
        rank = np.linalg.matrix_rank(self.held, tol=0.5)
        where = "" if rank == 3 else " along the spin axis" if rank == 1 else " so"
        return f"the frame's node does not move{where}: {what} there has no effect"


def _offset(what: str) -> str:
    return f"{what} at a marker's own offset has no lever for tilts, which are modes"
