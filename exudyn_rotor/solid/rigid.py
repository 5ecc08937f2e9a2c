"""The rigid motions that a stiffness matrix leaves free, of the whole and of parts of a model."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import breadth_first_order, connected_components

from exudyn_rotor.solid.elements import SolidElements
from exudyn_rotor.theory.nodal import coupled, rotations, translations

# Limits of the relative residual ‖K r‖ / ‖ |K| |r| ‖ of a rigid motion r. Measured on meshes from
# 15 000 to 108 000 coordinates, the same in SI and in mm and tonnes: a free motion leaves 1e-16;
# rounding K to d digits gives 0.4·10⁻ᵈ in nearly all rows (4e-9 for 8 digits); springs of
# 1e4 N/m at one node or on one face give 1e-9 to 1e-8, bearings of 1e8 N/m 1e-6 to 1e-4, but in
# their own rows only. Where most rows cancel far better than the whole, the residual comes from
# such supports and not from lost digits.
FREE_BELOW = 1e-9
HELD_ABOVE = 1e-5
LOCALLY_HELD_ABOVE = 1e-12
LOCAL_RATIO = 1e-3
_LISTED = 6  # parts that a message describes
# springs of clamped nodes over the largest diagonal entry of the stiffness: they move by less than
# 1e-10 of the others, and dense eigenvalues, whose error is relative to the stiffest spring, keep
# four digits; above a share of it no spring to the ground means anything else
_SPRING, _STIFFER = 1e6, 1e4


def rigid_basis(nodes: np.ndarray) -> np.ndarray:
    """Return orthonormal columns (3n, r) spanning the rigid motions that displace any node.

    r is 6, but 5 for nodes on one line and 3 for a single node.
    """
    center = nodes.mean(axis=0)
    radius = np.sqrt(np.mean(np.sum((nodes - center) ** 2, axis=1))) or 1.0
    motions = np.hstack([translations(len(nodes)), rotations(nodes, center) / radius])
    basis, lengths, _ = np.linalg.svd(motions, full_matrices=False)
    return basis[:, : np.count_nonzero(lengths > 1e-9 * lengths[0])]


def rigid_residuals(nodes: np.ndarray, stiffness: sp.csr_array) -> tuple[np.ndarray, np.ndarray]:
    """Return how strongly `stiffness` resists the rigid motions, as a whole and in most rows.

    The motions are combined such that each is held or free by itself (singular vectors of K R).
    Returned are ‖K r‖ / ‖ |K| |r| ‖, and the median over the rows of |K r| / (|K| |r|), both (r,):
    forces relative to the terms that have to cancel, whatever the units and the mesh size.
    """
    basis = rigid_basis(nodes)
    _, _, combinations = np.linalg.svd(stiffness @ basis, full_matrices=False)
    motions = basis @ combinations.T
    forces = np.abs(stiffness @ motions)
    terms = abs(stiffness) @ np.abs(motions)
    residuals = _ratio(np.linalg.norm(forces, axis=0), np.linalg.norm(terms, axis=0))
    return residuals, np.median(_ratio(forces, terms), axis=0)


def _locally_held(residuals: np.ndarray, typical: np.ndarray) -> np.ndarray:
    return (typical < LOCAL_RATIO * residuals) & (residuals > LOCALLY_HELD_ABOVE)


def count_rigid_motions(
    nodes: np.ndarray, stiffness: sp.csr_array, grounded: bool | None = None
) -> int:
    """Return how many of the six rigid motions `stiffness` leaves free.

    A rotation that displaces no node (about a line that holds all nodes) counts as free. `grounded`
    is what the user knows: True if springs to the ground are inside the matrix, False if not;
    needed only if the matrix itself does not tell. ValueError if it contradicts the matrix.
    """
    residuals, typical = rigid_residuals(nodes, stiffness)
    held = (residuals > HELD_ABOVE) | _locally_held(residuals, typical)
    doubtful = (residuals >= FREE_BELOW) & ~held
    if grounded is None and np.any(doubtful):
        raise ValueError(
            f"stiffness matrix: {np.count_nonzero(doubtful)} rigid motions are neither free nor "
            f"held (relative residual {residuals[doubtful].max():.2g}, free is below "
            f"{FREE_BELOW:g}, held above {HELD_ABOVE:g}). Either the matrix lost digits in an "
            "export: write all 16 digits, or pass grounded=False to take it as free. Or very soft "
            "springs to the ground act on most nodes: pass grounded=True"
        )
    if grounded is False and np.any(held):
        raise ValueError(
            f"stiffness matrix: grounded=False, but {np.count_nonzero(held)} rigid motions are "
            f"held (relative residual {residuals[held].max():.2g}); remove the supports from the "
            "matrix or leave grounded out"
        )
    if grounded is True and not np.any(held | doubtful):
        raise ValueError(
            "stiffness matrix: grounded=True, but all six rigid motions are free; leave grounded "
            "out or add the supports"
        )
    return 6 - int(np.count_nonzero(held | doubtful if grounded else held))


def _ratio(values: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    return np.divide(values, sizes, out=np.zeros_like(values), where=sizes > 0.0)


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


def _is_free(nodes: np.ndarray, stiffness: sp.csr_array, part: np.ndarray) -> bool:
    """Return whether a rigid motion of a part is clearly free."""
    rows = (3 * part[:, None] + np.arange(3)).ravel()
    residuals, typical = rigid_residuals(nodes[part], stiffness[rows][:, rows])
    return bool(np.any((residuals < FREE_BELOW) & ~_locally_held(residuals, typical)))


def described_parts(
    parts: list[np.ndarray],
    nodes: np.ndarray,
    mass: sp.csr_array,
    elements: SolidElements | None,
) -> list[str]:
    """Return materials, number of nodes, mass, box and its middle of each part as text."""
    return [_described(part, nodes, mass, elements) for part in parts]


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
    told = "; ".join(described_parts(parts[:_LISTED], nodes, mass, elements))
    raise ValueError(
        f"the model falls into {len(parts)} parts that nothing connects: "
        f"{told}{', …' if len(parts) > _LISTED else ''}. Parts that touch are not connected by "
        f"that; {how}, or pass allow_parts=True if they are to move by themselves"
    )


def holding_spring(stiffness: sp.csr_array) -> float:
    """Return the spring [N/m] that holds clamped coordinates."""
    return float(_SPRING * stiffness.diagonal()[~clamped_coordinates(stiffness)].max())


def clamped_coordinates(stiffness: sp.csr_array) -> np.ndarray:
    """Return which coordinates are clamped (3n,): those on nothing but a stiff spring."""
    joined, diagonal = coupled(stiffness), stiffness.diagonal()
    return ~joined & joined.any() & (diagonal > _STIFFER * diagonal[joined].max(initial=0.0))
