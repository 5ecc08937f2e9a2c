"""Where a support is in a scene: its place, its axes, and the markers on both sides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import exudyn
import numpy as np
from exudyn.itemInterface import (
    MarkerBodyRigid,
    MarkerSuperElementPosition,
    MarkerSuperElementRigid,
    ObjectGround,
)

from exudyn_rotor import checks
from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.full.full_markers import interface_carrier
from exudyn_rotor.multibody.rotor.known_rotor import carrying_rotor
from exudyn_rotor.multibody.rotor.marker_body import append_nodes, virtual_nodes
from exudyn_rotor.multibody.rotor.more_markers import interface_motion
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.multibody.supports.ends import BaseEnd, FoundationEnd, MarkerEnd
from exudyn_rotor.multibody.supports.foundation_body import SceneFoundation, foundation_marker
from exudyn_rotor.solid.places import SAME_PLACE, leeway, off_place
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.rotating_axes import axes_of

_KINDS = exudyn.OutputVariableType
_REFERENCE = exudyn.ConfigurationType.Reference
_ROUNDING = 1e-12  # of the coordinates of a place
# bodies for which Exudyn has a rotation matrix, but no rigid marker
_POINTS = ("MassPoint", "MassPoint2D", "Mass1D")
_HIDDEN = {"show": False, "showMarkerNodes": False}
Base = exudyn.MarkerIndex | exudyn.ObjectIndex | SceneFoundation


@dataclass(frozen=True, eq=False)
class Seat:
    """Where a support is, checked, before anything is added.

    `name` is that of the interface, `place` is inertial [m], `axes` (n1, n2, e) in inertial axes,
    `leeway` by how much the mesh may put it elsewhere along e [m]; `base` is what carries it, with
    its reference position and orientation.
    """

    name: str
    place: np.ndarray
    axes: np.ndarray
    leeway: np.ndarray
    base: Base | None
    origin: np.ndarray
    orientation: np.ndarray

    @classmethod
    def of(cls, body: RotorItems, name: str, base: Base | Mapping[str, Base] | None) -> Seat:
        """Return the place of an interface on its base."""
        setup = body.plan.setup.placement
        interface = body.selection.source.interfaces[name]
        on_axis = body.axis.project(interface.reference)
        place = setup.position + setup.rotation @ on_axis
        axes = body.standing_axes
        free = leeway(interface.radius, axes[:, 2])
        at_rest = np.zeros(3), np.eye(3)
        if isinstance(base, Mapping):
            if name not in base:
                raise ValueError(
                    f"base: has nothing for the interface {name!r}, only for: "
                    f"{', '.join(map(str, base)) or 'none'}"
                )
            base = base[name]
        if base is None:
            return cls(name, place, axes, free, None, *at_rest)
        if isinstance(base, SceneFoundation):
            if base.mbs is not body.mbs:
                raise ValueError("base: this foundation is in another mbs")
            base.foundation.motion(name, place, free)
            return cls(name, place, axes, free, base, *at_rest)
        checks.instance(base, "base", (exudyn.MarkerIndex, exudyn.ObjectIndex, SceneFoundation))
        _refuse_missing(body.mbs, base)
        _refuse_own(body, name, base)
        origin, orientation = _reference(body.mbs, base)
        apart = np.linalg.norm(off_place(origin - place, free))
        if isinstance(base, exudyn.MarkerIndex) and apart > SAME_PLACE:
            raise ValueError(
                f"base: the marker {int(base)} is {apart:.3g} m off the interface {name!r}, which "
                f"is at {place.tolist()}; put it there, or give the rigid body itself"
            )
        return cls(name, place, axes, free, base, origin, orientation)

    def end(self, mbs: exudyn.MainSystem) -> BaseEnd | None:
        """Return the end of the base at the place; None of the ground.

        Raises
        ------
        ValueError
            For a base without the coordinates of a frame.
        """
        if isinstance(self.base, SceneFoundation):
            motion = self.base.foundation.points[self.name]
            return FoundationEnd(self.base.node, motion, self.axes)
        if self.base is None:
            return None
        item = {"bodyNumber": self.base}
        if isinstance(self.base, exudyn.MarkerIndex):
            item = mbs.GetMarker(self.base)
        if "bodyNumber" in item and mbs.GetObject(item["bodyNumber"])["objectType"] == "Ground":
            return None
        return MarkerEnd(mbs, item, self.place, self.axes, carrying_rotor(mbs, self.base))

    def marker(self, mbs: exudyn.MainSystem) -> exudyn.MarkerIndex:
        """Add a marker of the base at the place, with the axes (n1, n2, e)."""
        if isinstance(self.base, SceneFoundation):
            return foundation_marker(self.base, self.name, self.place, self.axes)
        turn = self.orientation.T @ self.axes
        shift = self.orientation.T @ (self.place - self.origin)
        shift[np.abs(shift) <= _ROUNDING * np.abs([self.place, self.origin]).max()] = 0.0
        if isinstance(self.base, exudyn.MarkerIndex):
            item = dict(mbs.GetMarker(self.base))
            item["localHT"] = item["localHT"] @ _frame(turn, shift)
            for given in ("name", "localPosition", "offset"):  # the place is in localHT
                item.pop(given, None)
            return mbs.AddMarker(item)
        number = mbs.AddObject(ObjectGround()) if self.base is None else self.base
        return mbs.AddMarker(MarkerBodyRigid(bodyNumber=number, localHT=_frame(turn, shift)))


def _frame(turn: np.ndarray, shift: np.ndarray = (0.0, 0.0, 0.0)) -> np.ndarray:
    frame = np.eye(4)
    frame[:3, :3], frame[:3, 3] = turn, shift
    return frame


def _reference(mbs: exudyn.MainSystem, base: Base) -> tuple[np.ndarray, np.ndarray]:
    """Return the reference position and orientation of a marker or a rigid body."""
    is_marker = isinstance(base, exudyn.MarkerIndex)
    if not is_marker and mbs.GetObject(base)["objectType"] in _POINTS:
        raise ValueError(f"base: {base} is a point without orientation; give a rigid body")
    try:
        kinds = _KINDS.Position, _KINDS.RotationMatrix
        if is_marker:
            values = [mbs.GetMarkerOutput(base, kind, _REFERENCE) for kind in kinds]
        else:
            values = [
                mbs.GetObjectOutputBody(base, kind, np.zeros(3), _REFERENCE) for kind in kinds
            ]
    except Exception as error:  # Exudyn's own, of several kinds
        raise ValueError(
            f"base: {base} has no place and orientation; give a rigid marker or a rigid body"
        ) from error
    if is_marker and "localHT" not in mbs.GetMarker(base):
        raise ValueError(f"base: {base} is no rigid marker with a frame of its own (localHT)")
    return np.asarray(values[0]), np.reshape(values[1], (3, 3))


def _refuse_missing(mbs: exudyn.MainSystem, base: exudyn.MarkerIndex | exudyn.ObjectIndex) -> None:
    is_marker = isinstance(base, exudyn.MarkerIndex)
    count = mbs.systemData.NumberOfMarkers() if is_marker else mbs.systemData.NumberOfObjects()
    if not 0 <= int(base) < count:
        raise ValueError(f"base: this system has no {base}")


def _refuse_own(body: RotorItems, name: str, base: exudyn.MarkerIndex | exudyn.ObjectIndex) -> None:
    """Refuse what moves with the rotor itself: between the two nothing would ever act."""
    item = {"bodyNumber": base}
    if isinstance(base, exudyn.MarkerIndex):
        item = body.mbs.GetMarker(base)
    own = {"bodyNumber": body.objects, "nodeNumber": body.nodes}
    if any(int(item[kind]) in map(int, own[kind].values()) for kind in own.keys() & item.keys()):
        raise ValueError(
            f"base: {base} belongs to rotor {body.name!r} itself, which cannot carry its own "
            f"bearing at {name!r}; give what stands beside it, or leave base out for the ground"
        )


def _carrier(
    body: RotorItems, interface: str
) -> tuple[exudyn.ObjectIndex, np.ndarray, np.ndarray, float]:
    """Return a flexible body, and place on the axis, motion (6, m) and radius of an interface."""
    if isinstance(body, FullRotorBody):
        return interface_carrier(body, interface)
    return body.objects["marker_body"], *interface_motion(body, interface)


def point_marker(body: RotorItems, interface: str) -> exudyn.MarkerIndex:
    """Add a marker with the interface's mean displacement, its place on the axis."""
    number, place, motion, _ = _carrier(body, interface)
    nodes = append_nodes(body.mbs, number, place[None, :], motion[:3])
    return body.mbs.AddMarker(
        MarkerSuperElementPosition(
            bodyNumber=number, meshNodeNumbers=nodes, weightingFactors=[1.0], visualization=_HIDDEN
        )
    )


def rigid_marker(body: RotorItems, interface: str) -> exudyn.MarkerIndex:
    """Add a marker with the mean displacement and rotation, on the axis, axes (n1, n2, e)."""
    number, place, motion, radius = _carrier(body, interface)
    axis = SpinAxis(body.frame.B @ body.axis.direction)
    nodes = append_nodes(body.mbs, number, *virtual_nodes(place, radius, motion, axis))
    return body.mbs.AddMarker(
        MarkerSuperElementRigid(
            bodyNumber=number,
            meshNodeNumbers=nodes,
            weightingFactors=[1.0 / 3.0] * 3,
            localHT=_frame(body.frame.B @ axes_of(body.axis)),
            visualization=_HIDDEN,
        )
    )
