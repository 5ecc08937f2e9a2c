"""Placing a rotor in its marker body, whose node spins about local z, whatever the mesh does.

``NodeRigidBodyRxyz`` has the orientation ``Rx(a) Ry(b) Rz(c)``. With a and b locked, the third
angle turns the body about the fixed axis ``Rx(a) Ry(b) e_z``, for every a and b. So the axes of the
marker body are the mesh axes turned by B, with ``B e = e_z``.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation


@dataclass(frozen=True, eq=False)
class BodyFrame:
    """Mesh and scene as the marker body sees them.

    Attributes
    ----------
    origin : ndarray, shape (3,)
        Frame origin, mesh coordinates [m].
    B : ndarray, shape (3, 3)
        Mesh axes → axes of the marker body.
    orientation : ndarray, shape (3, 3)
        Mesh axes → inertial axes at θ = 0.
    position : ndarray, shape (3,)
        Frame origin in inertial coordinates at rest [m].
    """

    origin: np.ndarray
    B: np.ndarray
    orientation: np.ndarray
    position: np.ndarray

    @classmethod
    def of(
        cls,
        direction: np.ndarray,
        origin: np.ndarray,
        mesh_position: np.ndarray,
        orientation: np.ndarray,
    ) -> BodyFrame:
        """Place a rotor whose mesh origin lies at `mesh_position` with `orientation`."""
        return cls(
            origin=origin,
            B=_turn_to_z(direction),
            orientation=orientation,
            position=mesh_position + orientation @ origin,
        )

    @property
    def angles(self) -> np.ndarray:
        """Reference Tait–Bryan angles (a, b, c) of the marker body's node [rad]."""
        with warnings.catch_warnings():
            # at b = ±90° the split of a and c is free, and any serves: a and b stay locked
            warnings.simplefilter("ignore", UserWarning)
            return Rotation.from_matrix(self.orientation @ self.B.T).as_euler("XYZ")

    def points(self, mesh_points: np.ndarray) -> np.ndarray:
        """Return mesh points (…, 3) in coordinates of the marker body."""
        return (np.asarray(mesh_points) - self.origin) @ self.B.T

    def columns(self, displacements: np.ndarray) -> np.ndarray:
        """Return nodal displacement columns (3n, k), given in mesh axes, in those of the body."""
        nodal = displacements.reshape(-1, 3, displacements.shape[1])
        return np.einsum("ab,nbk->nak", self.B, nodal).reshape(displacements.shape)


def _turn_to_z(direction: np.ndarray) -> np.ndarray:
    """Return the smallest rotation that takes `direction` to e_z."""
    z = np.array([0.0, 0.0, 1.0])
    across = np.cross(direction, z)
    if not np.any(across):
        return np.eye(3) if direction[2] > 0 else np.diag([1.0, -1.0, -1.0])
    angle = np.arctan2(np.linalg.norm(across), direction[2])
    return Rotation.from_rotvec(angle * across / np.linalg.norm(across)).as_matrix()
