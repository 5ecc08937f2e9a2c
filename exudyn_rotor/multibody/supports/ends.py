"""Where a support is in a scene: its place, its axes, and the markers on both sides."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import cos, sin

import exudyn
import numpy as np
from exudyn.itemInterface import MarkerBodyRigid, ObjectGround
from exudyn.utilities import (
    EulerParameters2G,
    EulerParameters2RotationMatrix,
    RotationVector2G,
    RotationVector2RotationMatrix,
    RotXYZ2G,
    RotXYZ2RotationMatrix,
)

from exudyn_rotor import checks
from exudyn_rotor.multibody.rotor.rotor_items import (
    RotorItems,
    carrying_rotor,
    marker_carrier,
)
from exudyn_rotor.multibody.supports.foundation_body import SceneFoundation
from exudyn_rotor.solid.places import SAME_PLACE, leeway, off_place
from exudyn_rotor.theory.axis import skew
from exudyn_rotor.theory.rotating_axes import axes_of, axial_rotation, axial_skew

_FRAME = exudyn.OutputVariableType.Position, exudyn.OutputVariableType.RotationMatrix
_REFERENCE = exudyn.ConfigurationType.Reference
_ROUNDING = 1e-12  # of the coordinates of a place
Base = exudyn.MarkerIndex | exudyn.ObjectIndex | SceneFoundation


@dataclass(frozen=True, eq=False)
class Seat:
    """Where a support is, checked, before anything is added; all in inertial axes.

    `leeway` is by how much the mesh may put the interface elsewhere along e [m]; `base` is what
    carries it, with its `end` there, its reference position `origin` and orientation, and the rotor
    that it belongs to, if any.
    """

    name: str
    place: np.ndarray
    axes: np.ndarray
    leeway: np.ndarray
    base: Base | None
    end: BaseEnd
    origin: np.ndarray = field(default_factory=lambda: np.zeros(3))
    orientation: np.ndarray = field(default_factory=lambda: np.eye(3))
    rotor: RotorItems | None = None

    @classmethod
    def of(cls, body: RotorItems, name: str, base: Base | None) -> Seat:
        """Return the place of an interface on its base."""
        setup, mbs = body.placement, body.mbs
        interface = body.selection.source.interfaces[name]
        place = setup.position + setup.rotation @ body.axis.project(interface.reference)
        axes = body.standing_axes
        where = name, place, axes, leeway(interface.radius, axes[:, 2]), base
        if base is None:
            return cls(*where, GroundEnd())
        if isinstance(base, SceneFoundation):
            if base.mbs is not mbs:
                raise ValueError("base: this foundation is in another mbs")
            motion = base.foundation.motion(name, place, where[3])
            return cls(*where, FoundationEnd(base.node, motion, axes))
        checks.instance(base, "base", (exudyn.MarkerIndex, exudyn.ObjectIndex, SceneFoundation))
        item, origin, orientation = _reference(mbs, base)
        _refuse_own(body, name, item)
        apart = np.linalg.norm(off_place(origin - place, where[3]))
        if isinstance(base, exudyn.MarkerIndex) and apart > SAME_PLACE:
            raise ValueError(
                f"base: the marker {int(base)} is {apart:.3g} m off the interface {name!r}, which "
                f"is at {place.tolist()}; put it there, or give the rigid body itself"
            )
        rotor = carrying_rotor(mbs, base)
        stands = (
            "bodyNumber" in item and mbs.GetObject(item["bodyNumber"])["objectType"] == "Ground"
        )
        end = GroundEnd() if stands else MarkerEnd(mbs, item, place, axes, rotor)
        return cls(*where, end, origin, orientation, rotor)

    def marker(self, mbs: exudyn.MainSystem) -> exudyn.MarkerIndex:
        """Add a marker of the base at the place, with the axes (n1, n2, e)."""
        if isinstance(self.base, SceneFoundation):
            point = self.base._carrier(self.name, self.place)
            return point.add_marker(mbs, "rigid", self.axes)
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


def _reference(mbs: exudyn.MainSystem, base: Base) -> tuple[dict, np.ndarray, np.ndarray]:
    """Return a marker, or what one of a body says of it, its reference place and orientation."""
    is_marker = isinstance(base, exudyn.MarkerIndex)
    count = mbs.systemData.NumberOfMarkers() if is_marker else mbs.systemData.NumberOfObjects()
    named = f"{'marker' if is_marker else 'object'} {int(base)}"
    if not 0 <= int(base) < count:
        raise ValueError(f"base: this system has no {named}")
    item = mbs.GetMarker(base) if is_marker else {"bodyNumber": base}
    if is_marker and "localHT" not in item:
        raise ValueError(f"base: needs a rigid marker with a frame of its own, got {named}")
    read, at = (mbs.GetMarkerOutput, ()) if is_marker else (mbs.GetObjectOutputBody, (np.zeros(3),))
    try:
        place, turn = (read(base, kind, *at, _REFERENCE) for kind in _FRAME)
    except Exception as error:  # Exudyn's own, of several kinds
        raise ValueError(
            f"base: the {named} has no place and orientation; give a rigid marker or body"
        ) from error
    return item, np.asarray(place), np.reshape(turn, (3, 3))


def _refuse_own(body: RotorItems, name: str, item: dict) -> None:
    """Refuse what moves with the rotor itself: between the two nothing would ever act."""
    own = {"bodyNumber": body.objects, "nodeNumber": body.nodes}
    if any(int(item[kind]) in map(int, own[kind].values()) for kind in own.keys() & item.keys()):
        raise ValueError(
            f"base: it belongs to rotor {body.name!r} itself, which cannot carry its own bearing "
            f"at {name!r}; give what stands beside it, or leave base out for the ground"
        )


def marker_on_axis(body: RotorItems, interface: str, kind: str) -> exudyn.MarkerIndex:
    """Add a marker of an interface's mean motion, on the axis; a rigid one has axes (n1, n2, e)."""
    place = body.axis.project(body.selection.source.interfaces[interface].reference)
    point = replace(body.interface_carrier(interface), point=body.frame.points(place))
    return point.add_marker(body.mbs, kind, body.frame.B @ axes_of(body.axis))


QUARTER = axial_skew(3)
_RIGID = 6  # coordinates of the node of a rotor's frame
_WRENCHES = np.eye(6).tolist()
_TURNED = {
    "RigidBodyRxyz": (RotXYZ2RotationMatrix, RotXYZ2G, 6),
    "RigidBodyEP": (EulerParameters2RotationMatrix, EulerParameters2G, 7),
    "RigidBodyRotVecLG": (RotationVector2RotationMatrix, RotationVector2G, 6),
}


class RotorEnd:
    """An interface of a rotor, by the coordinates of two nodes, the frame's first.

    Where it has been read, its displacement and velocity are `place` and `rate`, along (n1, n2, e),
    its rotation but for the spin is `tilt`, with `tilt_rate`; the spin angle is `angle`, from where
    the node has it at zero, and the spin `speed`.
    """

    def __init__(self, body: RotorItems, name: str) -> None:
        own = axes_of(body.axis)
        interface = body.selection.source.interfaces[name]
        carrier = body.interface_carrier(name)
        nodes = body.mbs.GetObjectParameter(carrier.body, "nodeNumbers")
        self.nodes = tuple(map(exudyn.NodeIndex, nodes))
        modes = np.kron(np.eye(2), own.T @ body.frame.B.T) @ carrier.motion
        self.axes = body.standing_axes
        point = own.T @ (body.axis.project(interface.reference) - body.frame.origin)
        self.size, self._point = _RIGID + modes.shape[1], point.tolist()
        self._rows = rows = np.zeros((9, self.size))
        rows[:3, :3] = self.axes.T
        rows[3:, _RIGID:] = modes
        self._spin = spin = body.locks.spin
        held = body.frame.axes_of_angles() @ self.axes
        # the node's angles follow each other
        self._held = [(tilt, held[tilt - 3].tolist(), tilt > spin) for tilt in body.locks.tilts]
        # one product gives motion, rate, angle and speed, and one the forces: a call costs more
        unit = np.eye(self.size)
        self._read = np.kron(np.eye(2), np.vstack([unit[spin], rows]))
        self._pull = np.vstack([unit[[spin, *body.locks.tilts]], rows]).T
        self._start = body.placement.angle

    def read(self, q: list[float], q_t: list[float]) -> None:
        """Take the motion from coordinates and their rates."""
        found = self._read.dot(q + q_t).tolist()
        angle, tx, ty, tz, a, b, c, *tilt = found[:10]
        speed, vx, vy, vz, a_t, b_t, c_t, *tilt_rate = found[10:]
        self.angle, self.speed = angle, speed
        self._c, self._s = C, S = cos(angle), sin(angle)
        x0, y0, z0 = self._point
        a, b = a + x0, b + y0
        ax, ay = C * a - S * b, S * a + C * b
        self._arm = ax, ay, c + z0
        self.place = tx + ax - x0, ty + ay - y0, tz + c
        self._within = wx, wy = C * a_t - S * b_t, S * a_t + C * b_t
        self.rate = vx + wx - speed * ay, vy + wy + speed * ax, vz + c_t
        a, b, c = tilt
        a_t, b_t, c_t = tilt_rate
        a, b, a_t, b_t = C * a - S * b, S * a + C * b, C * a_t - S * b_t, S * a_t + C * b_t
        self.tilt = a, b, c
        self.tilt_rate = a_t - speed * b, b_t + speed * a, c_t

    @property
    def motion(self) -> tuple[np.ndarray, np.ndarray]:
        """Motion (6,), the spin angle from where the rotor starts, and rate (6,)."""
        x = np.array([*self.place, *self.tilt])
        x_t = np.array([*self.rate, *self.tilt_rate])
        x[5] += self.angle - self._start
        x_t[5] += self.speed
        return x, x_t

    def pull(
        self, fx: float, fy: float, fz: float, moment: Sequence[float] = (0.0, 0.0, 0.0)
    ) -> np.ndarray:
        """Return the forces on the coordinates by a force and a moment where it has been read."""
        return self._pull.dot(self._loads(fx, fy, fz, moment))

    def _loads(self, fx: float, fy: float, fz: float, moment: Sequence[float]) -> list[float]:
        """Return moments about the angles of the node, the force, and both in the rotor's axes."""
        C, S, (ax, ay, az) = self._c, self._s, self._arm
        mx, my, mz = moment
        px, py, pz = mx + ay * fz - az * fy, my + az * fx - ax * fz, mz + ax * fy - ay * fx
        about = pz + self.tilt[0] * my - self.tilt[1] * mx
        (_, (p, r, e), turns), (_, (k, m, n), turning) = self._held
        if turns:
            p, r = C * p - S * r, S * p + C * r
        if turning:
            k, m = C * k - S * m, S * k + C * m
        loads = [about, p * px + r * py + e * pz, k * px + m * py + n * pz, fx, fy, fz]
        loads += [C * fx + S * fy, C * fy - S * fx, fz, C * mx + S * my, C * my - S * mx, mz]
        return loads

    @property
    def turning(self) -> tuple[float, float]:
        """Acceleration across the axis by the rates alone, at a constant spin speed [m/s²]."""
        (x, y, _), (vx, vy), speed = self._arm, self._within, self.speed
        return -speed * (2.0 * vy + speed * x), speed * (2.0 * vx - speed * y)

    def rows(self, count: int = 6) -> np.ndarray:
        """Return the rows J of displacement and rotation, the first of six: (count, size)."""
        wrenches = _WRENCHES[:count]  # what they pull at the coordinates are the rows
        return np.array([self._loads(*one[:3], one[3:]) for one in wrenches]) @ self._pull.T

    def rate_rows(self) -> np.ndarray:
        """Return the derivative (6, size) of the rate by the coordinates: J turns with the spin."""
        L, turning = np.zeros((6, self.size)), self.speed * QUARTER @ axial_rotation(self.angle)
        L[:3, _RIGID:] = turning @ self._rows[3:6, _RIGID:]
        L[3:, _RIGID:] = turning @ self._rows[6:, _RIGID:]
        (x, y, _), (vx, vy) = self._arm, self._within
        a, b, _ = self.tilt_rate
        L[:, self._spin] = -vy - self.speed * x, vx - self.speed * y, 0.0, -b, a, 0.0
        return L


class GroundEnd:
    """The ground, which does not move; as :class:`MarkerEnd`."""

    nodes, size = (), 0
    place = rate = tilt = tilt_rate = (0.0, 0.0, 0.0)
    turn = speed = 0.0

    def read(self, q: list[float], q_t: list[float]) -> None:
        """Take nothing."""

    def rows(self) -> np.ndarray:
        """Return no columns of displacement and rotation, (6, 0)."""
        return np.zeros((6, 0))


class FoundationEnd:
    """A point of a foundation, by the coordinates of its node; as :class:`MarkerEnd`."""

    turn = 0.0

    def __init__(self, node: exudyn.NodeIndex, motion: np.ndarray, axes: np.ndarray) -> None:
        self.nodes, self._rows = (node,), np.kron(np.eye(2), axes.T) @ motion
        self.size = motion.shape[1]

    def read(self, q: list[float], q_t: list[float]) -> None:
        """Take the motion from coordinates and their rates."""
        self.place, self.tilt = self._rows.dot(q).reshape(2, 3)
        self.rate, self.tilt_rate = self._rows.dot(q_t).reshape(2, 3)
        self.speed = float(self.tilt_rate[2])

    def rows(self) -> np.ndarray:
        """Return the rows J (6, size) of displacement and rotation."""
        return self._rows


class MarkerEnd:
    """A place on a body of Exudyn with a frame, rigid or with modes; another rotor is one.

    Read as a :class:`RotorEnd`; its tilt is that of the axis, without a rotation about it. Another
    rotor has turned about e by `turn`, what is no rotor by zero; the body turns at `speed`.
    """

    def __init__(
        self,
        mbs: exudyn.MainSystem,
        item: dict,
        place: np.ndarray,
        axes: np.ndarray,
        rotor: RotorItems | None,
    ) -> None:
        body = mbs.GetObject(item["bodyNumber"]) if "bodyNumber" in item else item
        nodes = body["nodeNumbers"] if "nodeNumbers" in body else [body["nodeNumber"]]
        node = mbs.GetNode(nodes[0])
        if node["nodeType"] not in _TURNED:
            raise ValueError(
                f"base: needs a rigid body with a node of {', '.join(_TURNED)}, or a flexible one "
                f"in reduced coordinates, got a node {node['nodeType']}"
            )
        self._matrix, self._G, count = _TURNED[node["nodeType"]]
        self._start = np.asarray(node["referenceCoordinates"], dtype=float)
        A = self._matrix(self._start[3:])
        self._axes, self._zero = axes, np.asarray(place)
        self._point = A.T @ (place - self._start[:3])
        self._axis, modes = A.T @ axes[:, 2], np.zeros((6, 0))
        if "modeBasis" in body:
            carrier = marker_carrier(mbs, item)
            modes = carrier.shifted(self._point - carrier.point).motion
        self._modes, self._count = modes, count
        self.size = count + modes.shape[1]
        self.nodes = tuple(map(exudyn.NodeIndex, nodes[: 1 + bool(modes.shape[1])]))
        self._spin = None
        if rotor is not None:
            sense = float(np.sign(rotor.standing_axes[:, 2] @ axes[:, 2]))
            self._spin = rotor.locks.spin, sense

    def read(self, q: list[float], q_t: list[float]) -> None:
        """Take the motion from coordinates and their rates."""
        q, q_t, k, P = np.array(q), np.array(q_t), self._count, self._axes
        own, zeta = self._start + q[:k], q[k:]
        A, PG = self._matrix(own[3:]), P.T @ self._G(own[3:])
        arm, axis = A @ self._point, A @ self._axis
        self._J = J = np.zeros((6, self.size))
        if len(zeta):
            PA, modes = P.T @ A, self._modes
            arm += A @ (modes[:3] @ zeta)
            axis += skew(A @ (modes[3:] @ zeta)) @ axis
            J[:3, k:], J[3:, k:] = PA @ modes[:3], PA @ modes[3:]
        lever = P.T @ arm
        # (Pᵀ arm)~ Pᵀ is Pᵀ arm~, for P turns and does not mirror
        J[:3, :3], J[:3, 3:k], J[3:, 3:k] = P.T, -skew(lever) @ PG, PG
        self.place, self.rate = P.T @ (own[:3] - self._zero) + lever, J[:3] @ q_t
        (a, b, c), (x, y, z) = (J[3:] @ q_t).tolist(), (P.T @ axis).tolist()
        self.tilt = np.array([-y, x, 0.0])
        self.tilt_rate = np.array([a * z - c * x, b * z - c * y, 0.0])  # of (−y, x), by ω × axis
        self.turn, self.speed = 0.0, c
        if self._spin is not None:
            place, sign = self._spin
            self.turn, self.speed = sign * float(q[place]), sign * float(q_t[place])

    def rows(self) -> np.ndarray:
        """Return the rows J (6, size) of displacement and rotation where it has been read."""
        return self._J


BaseEnd = GroundEnd | FoundationEnd | MarkerEnd
