"""Nodal stress of meshes of straight or curved tetrahedra."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

# Mid nodes of a 10-node tetrahedron: between which corners they lie (Netgen's order).
EDGES = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))
# Derivatives of the barycentric coordinates by the three reference coordinates.
_CORNER_SLOPES = np.vstack([np.eye(3), -np.ones(3)])


def _nodal_slopes(nodes_per_element: int) -> np.ndarray:
    """Return ∂N_j/∂ξ_c at node a of the reference element, shape (a, j, c)."""
    if nodes_per_element == 4:
        return np.broadcast_to(_CORNER_SLOPES, (4, 4, 3))
    corners = np.eye(4)
    mids = np.array([(corners[a] + corners[b]) / 2 for a, b in EDGES])
    slopes = []
    for point in np.vstack([corners, mids]):
        at_corners = (4 * point - 1)[:, None] * _CORNER_SLOPES
        at_mids = [
            4 * (point[a] * _CORNER_SLOPES[b] + point[b] * _CORNER_SLOPES[a]) for a, b in EDGES
        ]
        slopes.append(np.vstack([at_corners, at_mids]))
    return np.array(slopes)


@dataclass(frozen=True, eq=False)
class TetrahedronStress:
    """Maps displacement columns to nodal stress, ``recovery(displacements)``.

    Each element's stress is evaluated at its own nodes; a node gets the mean of its elements. At
    a node shared by two materials this is the mean over both.

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
        stress = [mean @ self._element_stress(slopes, column) for column in columns.T]
        return np.stack(stress, axis=2) if stress else np.zeros((len(self.nodes), 6, 0))

    def _slopes(self) -> np.ndarray:
        """Return ∂N_j/∂x_c at node a of element t, shape (t, a, j, c)."""
        reference = _nodal_slopes(self.tetrahedra.shape[1])
        jacobians = np.einsum("tjx,ajc->taxc", self.nodes[self.tetrahedra], reference)
        return np.einsum("ajc,tacx->tajx", reference, np.linalg.inv(jacobians))

    def _mean(self) -> sp.csr_array:
        """Return the operator (n, t·a) that averages element values at the nodes."""
        where = self.tetrahedra.ravel()
        counts = np.bincount(where, minlength=len(self.nodes))
        entries = (1.0 / counts[where], (where, np.arange(where.size)))
        return sp.csr_array(entries, shape=(len(self.nodes), where.size))

    def _element_stress(self, slopes: np.ndarray, column: np.ndarray) -> np.ndarray:
        """Return Hooke's stress at the nodes of all elements, shape (t·a, 6)."""
        moved = column.reshape(-1, 3)[self.tetrahedra]
        gradient = np.matmul(moved.transpose(0, 2, 1)[:, None], slopes)
        first, second = self.lame.T[:, :, None]
        normal = 2 * second[..., None] * np.diagonal(gradient, axis1=2, axis2=3)
        normal = normal + (first * np.trace(gradient, axis1=2, axis2=3))[..., None]
        pairs = ((1, 2), (0, 2), (0, 1))
        shear = [second * (gradient[..., i, j] + gradient[..., j, i]) for i, j in pairs]
        return np.concatenate([normal, np.stack(shear, axis=2)], axis=2).reshape(-1, 6)
