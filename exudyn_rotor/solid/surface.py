"""Surface triangles: splitting 6-node triangles and sharing areas among nodes."""

from __future__ import annotations

import numpy as np

# Corners 0 1 2, mid nodes 3 4 5 of the edges 0-1, 1-2, 2-0.
_SUB_TRIANGLES = np.array([[0, 3, 5], [3, 1, 4], [3, 4, 5], [5, 4, 2]])


def flat_triangles(triangles: np.ndarray) -> np.ndarray:
    """Return 3-node triangles (t, 3); each 6-node triangle is split into four."""
    if triangles.shape[1] == 3:
        return triangles
    return triangles[:, _SUB_TRIANGLES].reshape(-1, 3)


def area_weights(nodes: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the sorted node numbers of a face and their shares of its area (sum one).

    Every flat triangle gives a third of its area to each of its corners; 6-node triangles are
    split into four first. The exact integrals of quadratic shape functions would be zero at the
    corners, which takes the corner nodes out of the interface's mean; the shares used here are
    positive everywhere, have the same centre for straight triangles, and equal ``NodeWeights``
    of Exudyn's FEMinterface, so that both bodies carry the same markers.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Positions [m].
    triangles : ndarray of int, shape (t, 3) or (t, 6)
        Triangles of the face.
    """
    flat = flat_triangles(triangles)
    a, b, c = (nodes[flat[:, i]] for i in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    numbers, where = np.unique(flat, return_inverse=True)
    shares = np.bincount(where.ravel(), weights=np.repeat(areas / 3, 3))
    return numbers, shares / shares.sum()
