"""What a file of another program holds of a solid, by its numbers, and the skin of elements."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np

from exudyn_rotor.solid.elements import Block
from exudyn_rotor.solid.shapes import ElementKind
from exudyn_rotor.solid.surface import flat_triangles


@dataclass(eq=False)
class MeshData:
    """Nodes, solid elements, sets and materials of a file.

    Attributes
    ----------
    nodes : dict of int to sequence of float
        Positions (3,) of nodes by their numbers, lengths of the file.
    elements : dict of (kind, region) to list of list of int
        Number of each element of one of ``KINDS``, then those of its nodes in meshio's order.
        Their material goes by the name of the region.
    node_sets, element_sets : dict of str to list of int
    regions : dict of int to str
        Region of elements, where it is another than that in `elements`.
    materials : dict
        Region name → 'youngsModulus', 'poissonsRatio', 'density', in units of the file.
    refused, replaced : dict of str to str
        What a rotor of solid elements does not have, and elements that are taken as others.
    """

    nodes: dict[int, Sequence[float]] = field(default_factory=dict)
    elements: dict[tuple[str, str], list[list[int]]] = field(default_factory=dict)
    node_sets: dict[str, list[int]] = field(default_factory=dict)
    element_sets: dict[str, list[int]] = field(default_factory=dict)
    regions: dict[int, str] = field(default_factory=dict)
    materials: dict[str, dict[str, float]] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)
    replaced: dict[str, str] = field(default_factory=dict)

    def add_element(self, kind: str, region: str, row: list[int]) -> None:
        """Add an element, its number before its nodes."""
        self.elements.setdefault((kind, region), []).append(row)


@contextmanager
def reading(place: str) -> Iterator[None]:
    """Say of what is wrong within where in the file it stands."""
    try:
        yield
    except (ValueError, IndexError, KeyError, StopIteration) as error:
        told = f"{error} is missing" if isinstance(error, KeyError) else error
        raise ValueError(f"mesh: {place} cannot be read: {told}") from error


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
    pieces, keys = [], []
    for block in blocks:
        for face, corners in enumerate(block.shape.faces):
            nodes = block.nodes[:, face_nodes(block.shape, face)]
            key = np.full((len(nodes), 4), -1)
            key[:, : len(corners)] = np.sort(nodes[:, : len(corners)], axis=1)
            pieces.append((len(corners), nodes))
            keys.append(key)
    _, where, counts = np.unique(
        np.concatenate(keys), axis=0, return_inverse=True, return_counts=True
    )
    is_outer = np.split(counts[where.ravel()] == 1, np.cumsum([len(key) for key in keys])[:-1])
    whole = all(block.kind == "tetra10" for block in blocks)
    triangles = []
    for (corners, nodes), chosen in zip(pieces, is_outer, strict=True):
        if corners == 4:
            triangles.append(nodes[chosen][:, _OF_QUADRANGLE[nodes.shape[1]]].reshape(-1, 3))
        else:
            triangles.append(nodes[chosen] if whole else flat_triangles(nodes[chosen]))
    return np.concatenate(triangles)
