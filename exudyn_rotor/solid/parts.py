"""Parts of a model that nothing connects, and that nothing holds."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import breadth_first_order, connected_components

from exudyn_rotor.solid.elements import SolidElements
from exudyn_rotor.solid.rigid import leaves_free

# how many parts a message describes
_LISTED = 6


def loose_parts(nodes: np.ndarray, stiffness: sp.csr_array) -> list[np.ndarray]:
    """Return node numbers of the parts that the stiffness does not connect, largest first.

    None are returned if all nodes are connected, or if springs to the ground hold every part.
    """
    # a node has three rows: every third row pointer starts a node
    pointers, columns = stiffness.indptr[::3].copy(), stiffness.indices // 3
    graph = sp.csr_array((np.ones(columns.size), columns, pointers), shape=2 * (len(nodes),))
    # the pattern is symmetric; one search is a tenth of the cost of all components
    if len(breadth_first_order(graph, 0, return_predecessors=False)) == len(nodes):
        return []
    _, numbers = connected_components(graph, directed=False)
    order = np.argsort(numbers, kind="stable")
    parts = np.split(order, np.cumsum(np.bincount(numbers))[:-1])
    parts.sort(key=len, reverse=True)
    return parts if any(_is_free(nodes, stiffness, part) for part in parts) else []


def describe_parts(
    parts: list[np.ndarray],
    nodes: np.ndarray,
    mass: sp.csr_array,
    elements: SolidElements | None,
) -> str:
    """Return what :func:`described_parts` does of the largest parts, as one text."""
    more = len(parts) - _LISTED
    texts = described_parts(parts[:_LISTED], nodes, mass, elements)
    return "; ".join(texts) + (f"; and {more} more" if more > 0 else "")


def described_parts(
    parts: list[np.ndarray],
    nodes: np.ndarray,
    mass: sp.csr_array,
    elements: SolidElements | None,
) -> list[str]:
    """Return materials, number of nodes, mass, box and its middle of each part as text."""
    return [_described(part, nodes, mass, elements) for part in parts]


def check_connected(
    nodes: np.ndarray,
    mass: sp.csr_array,
    stiffness: sp.csr_array,
    elements: SolidElements | None,
) -> None:
    """Raise ValueError if the model falls into parts that move by themselves."""
    parts = loose_parts(nodes, stiffness)
    if not parts:
        return
    how = "couple them by springs inside the stiffness matrix"
    if elements is not None:
        how = "make one solid of them before meshing, OCCGeometry(netgen.occ.Glue([a, b]))"
    raise ValueError(
        f"the model falls into {len(parts)} parts that nothing connects: "
        f"{describe_parts(parts, nodes, mass, elements)}. Parts that touch are not connected by "
        f"that; {how}, or pass allow_parts=True if they are to move by themselves"
    )


def _is_free(nodes: np.ndarray, stiffness: sp.csr_array, part: np.ndarray) -> bool:
    rows = (3 * part[:, None] + np.arange(3)).ravel()
    return leaves_free(nodes[part], stiffness[rows][:, rows])


def _described(
    part: np.ndarray, nodes: np.ndarray, mass: sp.csr_array, elements: SolidElements | None
) -> str:
    names = () if elements is None else elements.materials_at(part)
    weight = mass[3 * part].sum()
    lowest, highest = nodes[part].min(axis=0), nodes[part].max(axis=0)
    sides = " × ".join(f"{side:.3g}" for side in highest - lowest)
    # a micrometre per metre is precise enough to find a part
    size = np.ptp(nodes) or 1.0
    center = np.round(0.5 * (lowest + highest) / size, 6) * size
    place = ", ".join(f"{x:.3g}" for x in center)
    return (
        " and ".join(repr(name) for name in names)
        + (": " if names else "")
        + f"{part.size} nodes, {weight:.3g} kg, {sides} m about ({place}) m"
    )
