"""The surface of a rotor: areas of its nodes, and seats of bearings, discs and seals on it."""

from __future__ import annotations

import numpy as np

from exudyn_rotor.theory.axis import SpinAxis

# Corners 0 1 2, mid nodes 3 4 5 of the edges 0-1, 1-2, 2-0.
_SUB_TRIANGLES = np.array([[0, 3, 5], [3, 1, 4], [3, 4, 5], [5, 4, 2]])
# |n·e| of a triangle that faces away from the axis rather than along it
_RADIAL = 0.7
# share of its radius that something must lie beyond a triangle to cover it
_BEYOND = 1e-3
_CHUNK = 200  # triangles that are looked at together


def flat_triangles(triangles: np.ndarray) -> np.ndarray:
    """Return 3-node triangles (t, 3); each 6-node triangle is split into four."""
    if triangles.shape[1] == 3:
        return triangles
    return triangles[:, _SUB_TRIANGLES].reshape(-1, 3)


def area_weights(nodes: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the sorted node numbers of a face and their shares of its area (sum one).

    Triangles (t, 3) or (t, 6) of the face, among nodes (n, 3). Every flat triangle gives a third of
    its area to each of its corners; 6-node triangles are split into four first. Exact integrals of
    quadratic shape functions would be zero at the corners. The shares here have the same centre for
    straight triangles, and equal ``NodeWeights`` of Exudyn's FEMinterface.
    """
    flat = flat_triangles(triangles)
    a, b, c = (nodes[flat[:, i]] for i in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    numbers, where = np.unique(flat, return_inverse=True)
    shares = np.bincount(where.ravel(), weights=np.repeat(areas / 3, 3))
    return numbers, shares / shares.sum()


def outer_section(
    nodes: np.ndarray, triangles: np.ndarray, axis: SpinAxis, position: float, width: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the nodes of the outer surface in a band, and their shares of its area.

    Outer are triangles that face away from the axis or towards it, with nothing beyond them on the
    ray from the axis: bores, and faces between parts, are left out.
    `position` is the middle of the band along the axis from ``axis.point``, `width` its width [m].
    """
    if len(triangles) == 0:
        raise ValueError(
            "the rotor has no surface to look for nodes on; models from NGSolve have one, others "
            "need triangles=…, or with_interface(name, nodes)"
        )
    along = (nodes - axis.point) @ axis.direction
    low, high = position - 0.5 * width, position + 0.5 * width
    # a node on the edge of the band belongs to it
    slack = 1e-9 * np.ptp(nodes, axis=0).max()
    inside = (along >= low - slack) & (along <= high + slack)
    near = triangles[inside[triangles].any(axis=1)]
    outer = near[_is_outer(nodes, triangles, near, axis)] if len(near) else near
    numbers = np.zeros(0, dtype=np.int64)
    if len(outer):
        numbers, weights = area_weights(nodes, outer)
        numbers, weights = numbers[inside[numbers]], weights[inside[numbers]]
    if numbers.size == 0:
        places = along[np.unique(triangles)]
        nearest = places[np.argmin(np.abs(places - position))]
        raise ValueError(
            f"position, width: no node of the outer surface lies between {low:.6g} and "
            f"{high:.6g} m along the axis, where the rotor reaches from {places.min():.6g} to "
            f"{places.max():.6g} m and the next node is at {nearest:.6g} m; use another place, a "
            "wider band or a finer mesh"
        )
    return numbers, weights


def _is_outer(
    nodes: np.ndarray, triangles: np.ndarray, chosen: np.ndarray, axis: SpinAxis
) -> np.ndarray:
    """Return which of the `chosen` triangles are outer ones."""
    a, b, c = (nodes[chosen[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    sizes = np.linalg.norm(normals, axis=1)
    result = np.abs(normals @ axis.direction) < _RADIAL * sizes
    centers = (a + b + c) / 3.0
    arms = axis.radial(centers)
    radii = np.linalg.norm(arms, axis=1)
    result &= radii > 0.0
    corners = nodes[flat_triangles(triangles[:, :3])]
    places = (corners - axis.point) @ axis.direction
    heights = (centers - axis.point) @ axis.direction
    near = (places.min(axis=1) <= heights.max()) & (places.max(axis=1) >= heights.min())
    candidates = np.flatnonzero(result)
    for part in np.split(candidates, np.arange(_CHUNK, candidates.size, _CHUNK)):
        directions = arms[part] / radii[part, None]
        distance = _farthest_hit(centers[part], directions, corners[near])
        result[part] = distance <= _BEYOND * radii[part]
    return result


def _farthest_hit(points: np.ndarray, directions: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Return how far from each point (p, 3) its ray meets the last triangle (t, 3, 3), at least 0.

    Möller, Trumbore, J. Graphics Tools 2 (1997) 21–28.
    """
    first = corners[:, 0]
    e1, e2 = corners[:, 1] - first, corners[:, 2] - first
    across = np.cross(directions[:, None], e2[None])
    det = np.einsum("tk,ptk->pt", e1, across)
    with np.errstate(divide="ignore", invalid="ignore"):
        offset = points[:, None] - first[None]
        u = np.einsum("ptk,ptk->pt", offset, across) / det
        turned = np.cross(offset, e1[None])
        v = np.einsum("pk,ptk->pt", directions, turned) / det
        distance = np.einsum("tk,ptk->pt", e2, turned) / det
        hit = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & np.isfinite(distance)
    return np.max(np.where(hit, distance, 0.0), axis=1, initial=0.0)
