"""The outer surface of solid elements as triangles."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exudyn_rotor.solid.elements import Block
from exudyn_rotor.solid.shapes import ElementKind
from exudyn_rotor.solid.surface import flat_triangles

# Corners, then the mid nodes of the edges 0-1, 1-2, …
_OF_QUADRANGLE = {
    4: [[0, 1, 2], [0, 2, 3]],
    8: [[0, 4, 7], [1, 5, 4], [2, 6, 5], [3, 7, 6], [4, 5, 6], [4, 6, 7]],
}


def face_nodes(kind: ElementKind, face: int) -> list[int]:
    """Return the nodes of a face within an element: corners, then mid nodes of the edges."""
    corners = kind.faces[face]
    mids = {frozenset(edge): len(kind.corners) + i for i, edge in enumerate(kind.edges)}
    around = zip(corners, (*corners[1:], corners[0]), strict=True)
    return [*corners, *(mids[frozenset(edge)] for edge in around if mids)]


def skin(blocks: Sequence[Block]) -> np.ndarray:
    """Return the triangles of faces that one element alone has, outward.

    Shape (t, 6) where all elements are 10-node tetrahedra, else (t, 3): faces of second order
    are cut along their mid nodes.
    """
    pieces = []
    for block in blocks:
        for face, corners in enumerate(block.shape.faces):
            pieces.append((len(corners), block.nodes[:, face_nodes(block.shape, face)]))
    keys = np.concatenate([_key(nodes[:, :corners]) for corners, nodes in pieces])
    _, where, counts = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
    is_outer = np.split(counts[where.ravel()] == 1, np.cumsum([len(x) for _, x in pieces])[:-1])
    whole = all(block.kind == "tetra10" for block in blocks)
    triangles = []
    for (corners, nodes), chosen in zip(pieces, is_outer, strict=True):
        if corners == 4:
            triangles.append(nodes[chosen][:, _OF_QUADRANGLE[nodes.shape[1]]].reshape(-1, 3))
        else:
            triangles.append(nodes[chosen] if whole else flat_triangles(nodes[chosen]))
    return np.concatenate(triangles)


def _key(corners: np.ndarray) -> np.ndarray:
    """Return the sorted corners of faces, shape (f, 4); triangles are filled up by −1."""
    key = np.full((len(corners), 4), -1)
    key[:, : corners.shape[1]] = np.sort(corners, axis=1)
    return key
