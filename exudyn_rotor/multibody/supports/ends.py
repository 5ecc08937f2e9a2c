"""The ends of what is attached in a scene: motion of a point by coordinates of nodes, and its rows.

Displacement u and rotation φ are in the axes (n1, n2, e) that stand still, as the rotor with the
support is mounted. With the translation τ and the spin θ of a rotor's frame, and P = (n1, n2, e),

    u = Pᵀτ + R(θ)(x₀ + U ζ) − x₀,    φ = θ e + R(θ) Φ ζ,

x₀ the interface's point on the axis from the frame's origin, U and Φ its mean motion by the modal
coordinates ζ (coordinates of the interface itself, of a full body). The frame does not tilt, but
what holds its tilts has the reaction, as of any load on the rotor.

The virtual work of a force and a moment at an end gives the forces on its coordinates, ``Jᵀf`` with
the rows J of u and φ: action and reaction are exact.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sin

import exudyn
import numpy as np
from exudyn.utilities import (
    EulerParameters2G,
    EulerParameters2RotationMatrix,
    RotationVector2G,
    RotationVector2RotationMatrix,
    RotXYZ2G,
    RotXYZ2RotationMatrix,
)

from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.full.full_markers import interface_carrier
from exudyn_rotor.multibody.rotor.known_rotor import KnownRotor
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.theory.nodal import skew
from exudyn_rotor.theory.rotating_axes import axes_of, axial_rotation, axial_skew

QUARTER = axial_skew(3)
_RIGID = 6  # coordinates of the node of a rotor's frame
_TURNED = {
    "RigidBodyRxyz": (RotXYZ2RotationMatrix, RotXYZ2G, 6),
    "RigidBodyEP": (EulerParameters2RotationMatrix, EulerParameters2G, 7),
    "RigidBodyRotVecLG": (RotationVector2RotationMatrix, RotationVector2G, 6),
}


class RotorEnd:
    """An interface of a rotor, by the coordinates of two nodes, the frame's first.

    Attributes
    ----------
    nodes : tuple of NodeIndex
    size : int
        Number of coordinates.
    place, rate : tuple of float
        Displacement [m] and velocity [m/s] where it has been read, along (n1, n2, e).
    tilt, tilt_rate : tuple of float
        Rotation but for the spin angle [rad], and the rate of it, where it was read `whole`.
    angle, speed : float
        Spin angle, from where the node has it at zero [rad], and its rate [rad/s].
    """

    def __init__(self, body: RotorItems, name: str) -> None:
        own = axes_of(body.axis)
        interface = body.selection.source.interfaces[name]
        if isinstance(body, FullRotorBody):
            carrier = interface_carrier(body, name)[0]
            self.nodes = tuple(map(exudyn.NodeIndex, body.mbs.GetObject(carrier)["nodeNumbers"]))
            motion = np.eye(6)
        else:
            self.nodes = body.nodes["rigid"], body.nodes["modes"]
            motion = interface.motion @ body.selection.T
        modes = np.kron(np.eye(2), own.T) @ motion
        self.axes = body.standing_axes
        point = own.T @ (body.axis.project(interface.reference) - body.frame.origin)
        self.size, self._point = _RIGID + modes.shape[1], point.tolist()
        rows = np.zeros((9, self.size))
        rows[:3, :3] = self.axes.T
        rows[3:, _RIGID:] = modes
        self._spin = spin = body.locks.spin
        self._rows = rows
        turning = np.zeros((1, self.size))
        turning[0, spin] = 1.0
        # one product gives motion, rate, angle and speed, and one the forces: a call costs more
        both = [np.vstack([turning, part]) for part in (rows[:6], rows)]
        self._read_across, self._read_whole = (np.kron(np.eye(2), part) for part in both)
        axes_of_tilts = body.frame.axes_of_angles().T[:, [tilt - 3 for tilt in body.locks.tilts]]
        held = (self.axes.T @ axes_of_tilts).T.tolist()
        # the node's angles follow each other
        pairs = zip(body.locks.tilts, held, strict=True)
        self._held = [(tilt, axis, tilt > spin) for tilt, axis in pairs]
        by_tilts = np.eye(self.size)[list(body.locks.tilts)]
        self._pull_across = np.vstack([turning, by_tilts, rows[:6]])
        self._pull_whole = np.vstack([turning, by_tilts, rows])
        self._start = body.plan.setup.placement.angle

    def read(self, q: list[float], q_t: list[float], whole: bool = False) -> None:
        """Take the motion from coordinates and their rates."""
        found = (self._read_whole if whole else self._read_across).dot(q + q_t).tolist()
        half = len(found) // 2
        angle, tx, ty, tz, a, b, c = found[:7]
        speed, vx, vy, vz, a_t, b_t, c_t = found[half : half + 7]
        self.angle, self.speed = angle, speed
        self._c, self._s = C, S = cos(angle), sin(angle)
        x0, y0, z0 = self._point
        a, b = a + x0, b + y0
        ax, ay = C * a - S * b, S * a + C * b
        self._arm = ax, ay, c + z0
        self.place = tx + ax - x0, ty + ay - y0, tz + c
        self._within = wx, wy = C * a_t - S * b_t, S * a_t + C * b_t
        self.rate = vx + wx - speed * ay, vy + wy + speed * ax, vz + c_t
        self.tilt = self.tilt_rate = None
        if whole:
            a, b, c = found[7:half]
            a_t, b_t, c_t = found[half + 7 :]
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
        self, fx: float, fy: float, fz: float, moment: Sequence[float] | None = None
    ) -> np.ndarray:
        """Return the forces on the coordinates by a force and a moment where it has been read.

        A moment needs the whole motion to have been read where it acts on modes and tilts.
        """
        C, S, (ax, ay, az) = self._c, self._s, self._arm
        mx, my, mz = moment or (0.0, 0.0, 0.0)
        px, py, pz = mx + ay * fz - az * fy, my + az * fx - ax * fz, mz + ax * fy - ay * fx
        about = pz
        if self.tilt is not None:
            about += self.tilt[0] * my - self.tilt[1] * mx
        (_, (p, r, e), turns), (_, (k, m, n), turning) = self._held
        if turns:
            p, r = C * p - S * r, S * p + C * r
        if turning:
            k, m = C * k - S * m, S * k + C * m
        loads = [about, p * px + r * py + e * pz, k * px + m * py + n * pz]
        loads += [fx, fy, fz, C * fx + S * fy, C * fy - S * fx, fz]
        if moment is None:
            return self._pull_across.T.dot(loads)
        return self._pull_whole.T.dot([*loads, C * mx + S * my, C * my - S * mx, mz])

    def rows(self) -> np.ndarray:
        """Return the rows J (6, size) of displacement and rotation where it has been read."""
        J, R = np.zeros((6, self.size)), axial_rotation(self.angle)
        arm, spin = np.array(self._arm), self._spin
        J[:3] = self._rows[:3] + R @ self._rows[3:6]
        J[3:] = R @ self._rows[6:]
        J[:3, spin] = np.array([-arm[1], arm[0], 0.0])
        tilt = self.tilt or (0.0, 0.0, 0.0)
        J[3:, spin] = np.array([-tilt[1], tilt[0], 1.0])
        for place, axis, turns in self._held:
            axis = R @ axis if turns else np.array(axis)
            J[:3, place], J[3:, place] = np.cross(axis, arm), axis
        return J

    def turning(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the acceleration (2,) across the axis without those of coordinates, and slopes.

        By the coordinates and by their rates, each (2, size): ``2 Ω e × w − Ω² a``, the velocity w
        in the frame, and a the place of the point from its origin.
        """
        R, speed = axial_rotation(self.angle)[:2, :2], self.speed
        by_place, by_rate = np.zeros((2, 2, self.size))
        moved = R @ self._rows[3:5, _RIGID:]
        by_place[:, _RIGID:] = -(speed**2) * moved
        by_rate[:, _RIGID:] = 2.0 * speed * QUARTER[:2, :2] @ moved
        x, y, _ = self._arm
        within = self._within
        return (
            2.0 * speed * QUARTER[:2, :2] @ within - speed**2 * np.array([x, y]),
            by_place,
            by_rate,
        )

    def rate_rows(self) -> np.ndarray:
        """Return the derivative (6, size) of the rate by the coordinates: J turns with the spin."""
        L, turning = np.zeros((6, self.size)), self.speed * QUARTER @ axial_rotation(self.angle)
        L[:3, _RIGID:] = turning @ self._rows[3:6, _RIGID:]
        L[3:, _RIGID:] = turning @ self._rows[6:, _RIGID:]
        return L


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

    Attributes
    ----------
    nodes : tuple of NodeIndex
    size : int
        Number of coordinates.
    place, rate : ndarray, shape (3,)
        Displacement [m] and velocity [m/s] where it has been read, along (n1, n2, e).
    tilt, tilt_rate : ndarray, shape (3,)
        Of the axis, without a rotation about it [rad], [rad/s].
    turn, speed : float
        Angle about e by which another rotor has turned, zero of what is no rotor [rad], and the
        rate at which the body turns about e [rad/s].
    """

    def __init__(
        self,
        mbs: exudyn.MainSystem,
        item: dict,
        place: np.ndarray,
        axes: np.ndarray,
        rotor: KnownRotor | None,
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
            modes = _mean_motion(body, item)
            arm = self._point - modes[1]
            modes = np.vstack([modes[0][:3] - skew(arm) @ modes[0][3:], modes[0][3:]])
        self._modes, self._count = modes, count
        self.size = count + modes.shape[1]
        self.nodes = tuple(map(exudyn.NodeIndex, nodes[: 1 + bool(modes.shape[1])]))
        self._spin, self.is_rotor = None, rotor is not None
        if rotor is not None:
            sense = float(np.sign(np.dot(rotor.axis, axes[:, 2])))
            self._spin = rotor.plan.locks.spin, sense

    def read(self, q: list[float], q_t: list[float]) -> None:
        """Take the motion from coordinates and their rates."""
        q, q_t, k, P = np.array(q), np.array(q_t), self._count, self._axes
        own, zeta = self._start + q[:k], q[k:]
        A, G = self._matrix(own[3:]), self._G(own[3:])
        arm, axis = A @ (self._point + self._modes[:3] @ zeta), A @ self._axis
        axis = axis + np.cross(A @ (self._modes[3:] @ zeta), axis)
        self._J = J = np.zeros((6, self.size))
        J[:3, :3], J[:3, 3:k], J[3:, 3:k] = P.T, -P.T @ skew(arm) @ G, P.T @ G
        J[:3, k:], J[3:, k:] = P.T @ A @ self._modes[:3], P.T @ A @ self._modes[3:]
        self.place, self.rate = P.T @ (own[:3] + arm - self._zero), J[:3] @ q_t
        omega, axis = J[3:] @ q_t, P.T @ axis
        moved = np.cross(omega, axis)
        self.tilt = np.array([-axis[1], axis[0], 0.0])
        self.tilt_rate = np.array([-moved[1], moved[0], 0.0])
        self.turn, self.speed = 0.0, float(omega[2])
        if self._spin is not None:
            place, sign = self._spin
            self.turn, self.speed = sign * float(q[place]), sign * float(q_t[place])

    def rows(self) -> np.ndarray:
        """Return the rows J (6, size) of displacement and rotation where it has been read."""
        return self._J


BaseEnd = FoundationEnd | MarkerEnd


def _mean_motion(body: dict, marker: dict) -> tuple[np.ndarray, np.ndarray]:
    """Return motion (6, m) and place (3,) of a marker of a flexible body, in axes of the body."""
    columns = np.asarray(body["modeBasis"])
    columns = columns.reshape(len(columns) // 3, 3, -1)
    points = np.reshape(body["referencePositions"], (-1, 3))
    numbers = list(marker["meshNodeNumbers"])
    weights = np.asarray(marker["weightingFactors"])
    place, mean = weights @ points[numbers], np.tensordot(weights, columns[numbers], 1)
    shares = np.sqrt(weights)[:, None, None]
    turning = (shares * [-skew(arm) for arm in points[numbers] - place]).reshape(-1, 3)
    moved = (shares * (columns[numbers] - mean)).reshape(-1, mean.shape[1])
    return np.vstack([mean, np.linalg.lstsq(turning, moved, rcond=None)[0]]), place
