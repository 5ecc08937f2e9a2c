"""What a file of another program holds of a solid, by its numbers, and the skin of elements."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np

from exudyn_rotor.calls import user_level
from exudyn_rotor.solid.elements import Block
from exudyn_rotor.solid.shapes import ElementKind
from exudyn_rotor.solid.surface import flat_triangles


@dataclass(eq=False)
class ElementGroup:
    """Elements of one of ``KINDS``: numbers (e,) of theirs and of their nodes, in meshio's order.

    Their material goes by the name of the region.
    """

    kind: str
    numbers: np.ndarray
    nodes: np.ndarray
    region: str


@dataclass(eq=False)
class MeshData:
    """Nodes, solid elements, sets and materials of a file.

    Attributes
    ----------
    numbers, nodes : list
        Numbers of nodes, and their positions (3,), lengths of the file.
    groups : list of ElementGroup
    node_sets, element_sets : dict of str to list of int
    regions : dict of int to str
        Region of elements, where it is another than that of their group.
    surfaces : dict of str to list of (element, face)
        Faces are counted from zero, in the order of ``ElementKind.faces``.
    materials : dict
        Region name → 'youngsModulus', 'poissonsRatio', 'density', in units of the file.
    """

    numbers: list[int] = field(default_factory=list)
    nodes: list[Sequence[float]] = field(default_factory=list)
    groups: list[ElementGroup] = field(default_factory=list)
    node_sets: dict[str, list[int]] = field(default_factory=dict)
    element_sets: dict[str, list[int]] = field(default_factory=dict)
    regions: dict[int, str] = field(default_factory=dict)
    surfaces: dict[str, list[tuple[int, int]]] = field(default_factory=dict)
    materials: dict[str, dict[str, float]] = field(default_factory=dict)


class CannotBeReadError(ValueError):
    """What is wrong with a file, and where."""


class Refusals:
    """What a file holds that a solid rotor does not, unless it is to be left out.

    `leave_out` are keywords and types of elements that the user does without.
    """

    def __init__(self, leave_out: Iterable[str]) -> None:
        self._left_out = {name.upper().lstrip("*") for name in leave_out}
        self._replaced: dict[str, str] = {}

    def leaves_out(self, name: str, what: str) -> None:
        """Refuse what a file holds by the name `name`, unless it is to be left out."""
        if name.upper().lstrip("*") not in self._left_out:
            raise CannotBeReadError(
                f"mesh: holds {name} ({what}), which a rotor of solid elements does not have; pass "
                f"leave_out=[{name!r}] to do without, and join what it joined by interfaces, "
                "supports, add_disc or add_point_mass"
            )

    def replaces(self, name: str, how: str) -> None:
        """Note that elements `name` are taken as others."""
        self._replaced[name] = how

    def warn(self) -> None:
        """Warn once of what was replaced."""
        if self._replaced:
            told = "; ".join(f"{name}: {how}" for name, how in sorted(self._replaced.items()))
            warnings.warn(f"mesh: {told}", UserWarning, stacklevel=user_level())


@contextmanager
def reading(place: str) -> Iterator[None]:
    """Say of what is wrong within where in the file it stands."""
    try:
        yield
    except CannotBeReadError:
        raise
    except (ValueError, IndexError, KeyError, StopIteration) as error:
        told = f"{error} is missing" if isinstance(error, KeyError) else error
        raise CannotBeReadError(f"mesh: {place} cannot be read: {told}") from error


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
