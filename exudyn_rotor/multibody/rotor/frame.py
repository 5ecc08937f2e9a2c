"""Placing a rotor in its marker body: which angle of the body's node is the spin angle.

``NodeRigidBodyRxyz`` has the orientation ``Rx(a) Ry(b) Rz(c)``, and any one of the three angles may
turn without bound while the other two stand still. With n the spin axis in inertial axes and e in
mesh axes, the body can have the axes of the mesh where

- e is mesh z: c turns, however the rotor is mounted;
- n is inertial x: a turns, whatever e is;
- n is across inertial x and e across mesh z: b turns.

Elsewhere the axes of the marker body are the mesh axes turned by B, with ``B e = e_z``, and c
turns.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

CENTRE_OF_MASS, MESH_ORIGIN = FRAME_NODES = ("centre_of_mass", "mesh_origin")
FIRST, SECOND, THIRD = 3, 4, 5  # the angles among the coordinates of the node
_ALONG = 1e-8  # sine of the angle up to which an axis counts as a coordinate axis


@dataclass(frozen=True, eq=False)
class BodyFrame:
    """Mesh and scene as the marker body sees them.

    Attributes
    ----------
    origin : ndarray, shape (3,)
        Frame origin, mesh coordinates [m].
    node : ndarray, shape (3,)
        Where markers and sensors of the frame's node are, mesh coordinates [m].
    B : ndarray, shape (3, 3)
        Mesh axes → axes of the marker body; the identity where the body can have the mesh axes.
    orientation : ndarray, shape (3, 3)
        Mesh axes → inertial axes at θ = 0.
    position : ndarray, shape (3,)
        Frame origin in inertial coordinates at rest [m].
    angles : ndarray, shape (3,)
        Reference Tait–Bryan angles (a, b, c) of the marker body's node [rad].
    spin : {3, 4, 5}
        The node's coordinate that is the spin angle.
    """

    origin: np.ndarray
    node: np.ndarray
    B: np.ndarray
    orientation: np.ndarray
    position: np.ndarray
    angles: np.ndarray
    spin: int

    @classmethod
    def of(
        cls,
        direction: np.ndarray,
        origin: np.ndarray,
        mesh_position: np.ndarray,
        orientation: np.ndarray,
        node: str = CENTRE_OF_MASS,
    ) -> BodyFrame:
        """Place a rotor whose mesh origin lies at `mesh_position` with `orientation`.

        `origin` is that of the formulation. With the node at the mesh origin, it moves along the
        spin axis next to that: a frame that does not tilt has the same motion there.
        """
        place = origin
        if node == MESH_ORIGIN:
            origin, place = origin - direction * (direction @ origin), np.zeros(3)
        B = np.eye(3)
        orientation_of_node = _with_mesh_axes(direction, orientation)
        if orientation_of_node is None:
            B = _turn_to_z(direction)
            orientation_of_node = _tait_bryan(orientation @ B.T), THIRD
        position = mesh_position + orientation @ origin
        return cls(origin, place, B, orientation, position, *orientation_of_node)

    @property
    def has_mesh_axes(self) -> bool:
        """True where the axes of the marker body are those of the mesh."""
        return np.array_equal(self.B, np.eye(3))

    def axes_of_angles(self, moved: np.ndarray = (0.0, 0.0, 0.0)) -> np.ndarray:
        """Return the inertial axes (3, 3), in rows, that the node's angles turn about.

        `moved` are its coordinates: angles beyond those of the reference [rad].
        """
        a, b, _ = self.angles + np.asarray(moved)
        Rx, Ry = Rotation.from_euler("x", a).as_matrix(), Rotation.from_euler("y", b).as_matrix()
        return np.array([[1.0, 0.0, 0.0], Rx[:, 1], Rx @ Ry[:, 2]])

    def points(self, mesh_points: np.ndarray) -> np.ndarray:
        """Return mesh points (…, 3) in coordinates of the marker body."""
        return (np.asarray(mesh_points) - self.origin) @ self.B.T

    def columns(self, displacements: np.ndarray) -> np.ndarray:
        """Return nodal displacement columns (3n, k), given in mesh axes, in those of the body."""
        nodal = displacements.reshape(-1, 3, displacements.shape[1])
        return np.einsum("ab,nbk->nak", self.B, nodal).reshape(displacements.shape)


def _with_mesh_axes(
    direction: np.ndarray, orientation: np.ndarray
) -> tuple[np.ndarray, int] | None:
    """Return angles and spin coordinate of a body with mesh axes; None if there is none."""
    e, n = direction, orientation @ direction
    if np.hypot(e[0], e[1]) < _ALONG and e[2] > 0.0:
        return _tait_bryan(orientation), THIRD
    if np.hypot(n[1], n[2]) < _ALONG and n[0] > 0.0:
        return _tait_bryan(orientation), FIRST
    if abs(n[0]) < _ALONG and abs(e[2]) < _ALONG:  # Rx(a) e_y = n and Rz(−c) e_y = e
        a, c = np.arctan2(n[2], n[1]), np.arctan2(e[0], e[1])
        Ry = Rotation.from_euler("x", -a).as_matrix() @ orientation
        Ry = Ry @ Rotation.from_euler("z", -c).as_matrix()
        return np.array([a, np.arctan2(Ry[0, 2], Ry[0, 0]), c]), SECOND
    return None


def _tait_bryan(orientation: np.ndarray) -> np.ndarray:
    with warnings.catch_warnings():
        # at b = ±90° the split of a and c is free, and any serves: one of them turns by θ
        warnings.simplefilter("ignore", UserWarning)
        # a copy, as scipy takes no read-only matrix before 1.15.2
        return Rotation.from_matrix(np.array(orientation)).as_euler("XYZ")


def _turn_to_z(direction: np.ndarray) -> np.ndarray:
    """Return the smallest rotation that takes `direction` to e_z."""
    across = np.cross(direction, [0.0, 0.0, 1.0])
    size = np.linalg.norm(across)
    across = across / size if size else np.array([1.0, 0.0, 0.0])  # any serves for −e_z
    return Rotation.from_rotvec(np.arctan2(size, direction[2]) * across).as_matrix()
