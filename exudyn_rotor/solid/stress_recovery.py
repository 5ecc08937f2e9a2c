"""Nodal stress of meshes of straight or curved tetrahedra."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

# Mid nodes of a 10-node tetrahedron: between which corners they lie (Netgen's order).
EDGES = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))
# Derivatives of the barycentric coordinates by the three reference coordinates.
_CORNER_SLOPES = np.vstack([np.eye(3), -np.ones(3)])


# Barycentric coordinates of the four integration points, which are exact for quadratic functions.
_POINTS = np.full((4, 4), (5.0 - np.sqrt(5.0)) / 20.0) + np.eye(4) / np.sqrt(5.0)


def _slopes_at_points(nodes_per_element: int) -> np.ndarray:
    """Return ∂N_j/∂ξ_c at the integration points, shape (p, j, c); one for constant slopes."""
    if nodes_per_element == 4:
        return _CORNER_SLOPES[None]
    slopes = []
    for point in _POINTS:
        at_corners = (4 * point - 1)[:, None] * _CORNER_SLOPES
        at_mids = [
            4 * (point[a] * _CORNER_SLOPES[b] + point[b] * _CORNER_SLOPES[a]) for a, b in EDGES
        ]
        slopes.append(np.vstack([at_corners, at_mids]))
    return np.array(slopes)


def _at_nodes(nodes_per_element: int) -> np.ndarray:
    """Return what makes values at the integration points linear ones at the nodes, (a, p)."""
    if nodes_per_element == 4:
        return np.ones((4, 1))
    corners = np.linalg.inv(_POINTS)
    mids = [(corners[a] + corners[b]) / 2 for a, b in EDGES]
    return np.vstack([corners, mids])


@dataclass(frozen=True, eq=False)
class TetrahedronStress:
    """Maps displacement columns to nodal stress, ``recovery(displacements)``.

    Each element's stress is that at its integration points, linear between them; a node gets the
    mean of its elements. A straight element's stress is linear. In a curved one that has two faces
    on a smooth surface, which is flat where they meet, it grows without bound there. At a node
    shared by two materials this is the mean over both.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Reference positions [m].
    tetrahedra : ndarray of int, shape (t, 4) or (t, 10)
        Node numbers, Netgen's order.
    lame : ndarray, shape (t, 2)
        Lamé parameters λ, μ of every element [Pa].
    """

    nodes: np.ndarray
    tetrahedra: np.ndarray
    lame: np.ndarray

    def __call__(self, displacements: np.ndarray) -> np.ndarray:
        """Return the stress (n, 6, k) of displacement columns (3n, k).

        Components xx, yy, zz, yz, xz, xy in mesh axes [Pa].

        Raises
        ------
        ValueError
            If the columns do not have three entries for every node.
        """
        columns = np.asarray(displacements, dtype=float)
        if columns.ndim != 2 or len(columns) != self.nodes.size:
            raise ValueError(
                f"stress: needs columns of shape ({self.nodes.size}, k), got {columns.shape}"
            )
        slopes = self._slopes()
        mean = self._mean()
        at_nodes = _at_nodes(self.tetrahedra.shape[1])
        stress = [
            mean @ np.matmul(at_nodes, self._element_stress(slopes, column)).reshape(-1, 6)
            for column in columns.T
        ]
        return np.stack(stress, axis=2) if stress else np.zeros((len(self.nodes), 6, 0))

    def _slopes(self) -> np.ndarray:
        """Return ∂N_j/∂x_c at point p of element t, shape (t, p, j, c)."""
        reference = _slopes_at_points(self.tetrahedra.shape[1])
        jacobians = np.einsum("tjx,pjc->tpxc", self.nodes[self.tetrahedra], reference)
        return np.einsum("pjc,tpcx->tpjx", reference, np.linalg.inv(jacobians))

    def _mean(self) -> sp.csr_array:
        """Return the operator (n, t·a) that averages element values at the nodes."""
        where = self.tetrahedra.ravel()
        counts = np.bincount(where, minlength=len(self.nodes))
        entries = (1.0 / counts[where], (where, np.arange(where.size)))
        return sp.csr_array(entries, shape=(len(self.nodes), where.size))

    def _element_stress(self, slopes: np.ndarray, column: np.ndarray) -> np.ndarray:
        """Return Hooke's stress at the points of all elements, shape (t, p, 6)."""
        moved = column.reshape(-1, 3)[self.tetrahedra]
        gradient = np.matmul(moved.transpose(0, 2, 1)[:, None], slopes)
        first, second = self.lame.T[:, :, None]
        normal = 2 * second[..., None] * np.diagonal(gradient, axis1=2, axis2=3)
        normal = normal + (first * np.trace(gradient, axis1=2, axis2=3))[..., None]
        pairs = ((1, 2), (0, 2), (0, 1))
        shear = [second * (gradient[..., i, j] + gradient[..., j, i]) for i, j in pairs]
        return np.concatenate([normal, np.stack(shear, axis=2)], axis=2)
