"""Mean motion of an interface by the coordinates of a rotor's nodes, and its derivative.

With the translation τ and the spin θ of the frame, and P = (n1, n2, e),

    u = Pᵀτ + R(θ)(x₀ + U ζ) − x₀,    φ = θ e + R(θ) Φ ζ

are displacement and rotation in the axes (n1, n2, e) that stand still, x₀ the interface's point on
the axis from the frame's origin, U and Φ its mean motion by the modal coordinates ζ (the
coordinates of the interface itself, for a full body). The frame does not tilt, but what holds its
tilts has the reaction, as of any load on the rotor: they have columns in the derivative.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import exudyn
import numpy as np

from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.full.full_markers import interface_carrier
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.supports.seats import Seat
from exudyn_rotor.theory.nodal import skew as skew_matrix
from exudyn_rotor.theory.rotating_axes import axes_of, axial_rotation, axial_skew

_RIGID = 6  # coordinates of the node of the frame


@dataclass(frozen=True, eq=False)
class InterfaceCoordinates:
    """Motion of an interface by the coordinates of two nodes, the frame's first.

    The spin counts from where it starts. `tilts` are the coordinates of the frame's tilts,
    `tilt_axes` their axes at θ = 0 as columns, and `turning` says which of them turn with θ.
    """

    nodes: tuple[exudyn.NodeIndex, ...]
    axes: np.ndarray
    point: np.ndarray
    modes: np.ndarray
    spin: int
    start: float
    tilts: list[int]
    tilt_axes: np.ndarray
    turning: np.ndarray

    @classmethod
    def of(cls, body: RotorBody | FullRotorBody, name: str, seat: Seat) -> InterfaceCoordinates:
        """Return them; a full body gets coordinates of the interface."""
        own = axes_of(body.axis)
        interface = body.selection.source.interfaces[name]
        if isinstance(body, FullRotorBody):
            carrier = interface_carrier(body, name)[0]
            nodes = tuple(map(exudyn.NodeIndex, body.mbs.GetObject(carrier)["nodeNumbers"]))
            motion = np.eye(6)
        else:
            nodes = body.nodes["rigid"], body.nodes["modes"]
            motion = interface.motion @ body.selection.T
        point = own.T @ (body.axis.project(interface.reference) - body.frame.origin)
        modes = np.kron(np.eye(2), own.T) @ motion
        start = body.plan.setup.placement.angle
        spin, tilts = body.locks.spin, list(body.locks.tilts)
        tilt_axes = seat.axes.T @ body.frame.axes_of_angles().T[:, [tilt - 3 for tilt in tilts]]
        turning = np.array(tilts) > spin  # the node's angles follow each other
        held = tilts, tilt_axes, turning
        return cls(nodes, seat.axes, point, modes, spin, start, *held)

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return _RIGID + self.modes.shape[1]

    def motion(
        self, q: Sequence[float], q_t: Sequence[float]
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return motion (6,), rate (6,) and the derivative of the motion (6, size)."""
        q, q_t = np.asarray(q), np.asarray(q_t)
        theta = q[self.spin]
        R, skew = axial_rotation(theta), axial_skew(3)
        own = self.modes @ q[_RIGID:]
        arm, turned = R @ (self.point + own[:3]), R @ own[3:]
        x = np.concatenate([self.axes.T @ q[:3] + arm - self.point, turned])
        x[5] += theta - self.start
        J = np.zeros((6, self.size))
        J[:3, :3] = self.axes.T
        J[:3, self.spin] = skew @ arm
        J[3:, self.spin] = skew @ turned
        J[5, self.spin] += 1.0
        tilting = np.where(self.turning, R @ self.tilt_axes, self.tilt_axes)
        J[:3, self.tilts], J[3:, self.tilts] = -skew_matrix(arm) @ tilting, tilting
        J[:3, _RIGID:], J[3:, _RIGID:] = R @ self.modes[:3], R @ self.modes[3:]
        return x, J @ q_t, J
