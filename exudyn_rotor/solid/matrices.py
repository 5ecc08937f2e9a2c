"""Checks of finite-element matrices and node sets: every error says what, where and what to do."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks

# Relative to the largest entry: well above the rounding of any assembly, far below a wrong matrix.
SYMMETRY_TOLERANCE = 1e-8
BLOCK_TOLERANCE = 1e-8
# node positions agree if they differ by less than this share of the mesh's size
_POSITION_TOLERANCE = 1e-9


def as_nodes(nodes: Any) -> np.ndarray:
    """Return the node positions as a read-only array, shape (n, 3)."""
    return checks.array(nodes, "nodes", "m", shape=(None, 3))


def as_mass(matrix: Any, node_count: int) -> sp.csr_array:
    """Return a mass matrix as :func:`as_matrix` does; it must have I₃ blocks (24) and no holes."""
    result = as_matrix("mass matrix", matrix, node_count)
    if result is not matrix:  # which is that of a rotor, and was checked
        _check_mass(result)
    return result


def as_matrix(label: str, matrix: Any, node_count: int) -> sp.csr_array:
    """Return a checked (3n, 3n) matrix: finite, exactly symmetric, read-only csr_array.

    `label` names it in messages.
    """
    size = 3 * node_count
    is_known = isinstance(matrix, sp.csr_array) and not matrix.data.flags.writeable
    if is_known and matrix.shape == (size, size):
        return matrix  # of a rotor, whose matrices were checked
    converted = sp.csr_array(checks.matrix(matrix, label))
    if converted.shape != (size, size):
        raise ValueError(
            f"{label}: the shape must be ({size}, {size}), three displacements for each of "
            f"{node_count} nodes, got {converted.shape}; a solid rotor has no nodes with rotations "
            "(shells, beams)"
        )
    if converted.nnz <= np.iinfo(np.int32).max:
        indices = (x.astype(np.int32, copy=False) for x in (converted.indices, converted.indptr))
        converted = sp.csr_array((converted.data, *indices), shape=converted.shape)
    return frozen(_symmetrised(label, converted))


def check_same_mesh(nodes: np.ndarray, others: np.ndarray, label: str = "modal basis") -> None:
    """Refuse what belongs to other nodes (n, 3) than those of the rotor; `label` names it."""
    same = others.shape == nodes.shape
    distance = np.linalg.norm(nodes - others, axis=1).max() if same else np.inf
    if distance > _POSITION_TOLERANCE * np.ptp(nodes, axis=0).max():
        raise ValueError(
            f"{label} from another mesh: the rotor has other nodes ({len(others)} nodes in the "
            f"{label.split()[-1]}, {len(nodes)} in the rotor, up to {distance:.3g} m apart); "
            f"compute the {label} with this rotor"
        )


def in_all_directions(matrix: sp.sparray) -> sp.csr_array:
    """Return ``A ⊗ I₃`` of a matrix (n, m)."""
    return sp.csr_array(sp.kron(matrix, sp.eye_array(3), format="csr"))


def frozen(matrix: sp.csr_array) -> sp.csr_array:
    """Return `matrix` in canonical form with its arrays made read-only."""
    matrix.sum_duplicates()
    matrix.eliminate_zeros()
    for array in (matrix.data, matrix.indices, matrix.indptr):
        array.flags.writeable = False
    return matrix


def _check_mass(mass: sp.csr_array) -> None:
    """Raise ValueError unless `mass` is a solid's mass matrix: I₃ blocks (24), no empty node."""
    difference = in_all_directions(sp.csr_array(mass[::3, ::3])) - mass
    if _largest(difference) > BLOCK_TOLERANCE * _largest(mass):
        raise ValueError(
            "mass matrix: it does not consist of multiples of the 3×3 identity, one for each pair "
            "of nodes, as displacement-based solid elements give; check that the coordinates are "
            "ordered x0 y0 z0 x1 …, all elements are solids with three displacements per node, "
            "every lumped mass is the same in x, y and z, and no directions were condensed or fixed"
        )
    empty = np.flatnonzero(mass.diagonal()[::3] <= 0.0)
    if empty.size:
        raise ValueError(
            f"mass matrix: {empty.size} nodes have no mass or a negative one, nodes "
            f"{_numbers(empty)}; remove nodes that belong to no element (a mesh made second order "
            "twice has some), or condense them"
        )


def as_node_numbers(name: str, nodes: Any, node_count: int | None = None) -> np.ndarray:
    """Return the node numbers of interface `name`, shape (k,), below `node_count` if given."""
    most = np.inf if node_count is None else node_count - 1
    numbers = checks.whole_numbers(nodes, f"interface {name!r}: nodes", most=most)
    if numbers.size == 0:
        raise ValueError(f"interface {name!r} has no nodes; check the face name or the node list")
    unique, counts = np.unique(numbers, return_counts=True)
    if np.any(counts > 1):
        raise ValueError(
            f"interface {name!r}: repeated node numbers {_numbers(unique[counts > 1])}; "
            "list every node once and use weights instead"
        )
    return numbers


def as_weights(name: str, weights: Sequence[float] | None, count: int) -> np.ndarray:
    """Return the node weights of interface `name`, equal ones for None; never negative."""
    if weights is None:
        return np.full(count, 1.0 / count)
    values = checks.vector(weights, f"interface {name!r}: weights", size=count)
    if values.min() < 0.0 or not 0.0 < values.sum() < np.inf:
        raise ValueError(
            f"interface {name!r}: weights: needs shares of an area, none negative and not "
            f"all zero, got {checks.shown(weights)}"
        )
    return values


def as_triangles(triangles: Any, node_count: int) -> np.ndarray:
    """Return the surface triangles as a read-only integer array, shape (t, 3) or (t, 6)."""
    array = checks.array(triangles, "triangles", dtype=int)
    if array.size == 0:
        array = checks.array(np.zeros((0, 3), dtype=int), "triangles", dtype=int)
    if array.ndim != 2 or array.shape[1] not in (3, 6):
        raise ValueError(f"triangles: the shape must be (t, 3) or (t, 6), got {array.shape}")
    if array.size and (array.min() < 0 or array.max() >= node_count):
        raise ValueError(
            f"triangles: node numbers {array.min()} to {array.max()} are outside the model's "
            f"0 to {node_count - 1}"
        )
    return array


def _symmetrised(label: str, matrix: sp.csr_array) -> sp.csr_array:
    transposed = sp.csr_array(matrix.T)
    largest, difference = _largest(matrix), _largest(matrix - transposed)
    if difference > SYMMETRY_TOLERANCE * largest:
        raise ValueError(
            f"{label}: is not symmetric, entries differ by {difference:.3g} with a largest entry "
            f"of {largest:.3g}; many exports write one triangle only: then pass "
            "A + A.T - diag(A)"
        )
    return sp.csr_array(0.5 * (matrix + transposed)) if difference else matrix.copy()


def _largest(matrix: sp.csr_array) -> float:
    return float(max(matrix.data.max(initial=0.0), -matrix.data.min(initial=0.0)))


def _numbers(values: np.ndarray) -> str:
    listed = ", ".join(str(value) for value in values[:5])
    return listed if values.size <= 5 else f"{listed}, …"
