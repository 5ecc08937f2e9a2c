"""Checks of finite-element matrices and node sets: every error says what, where and what to do."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any
from weakref import WeakValueDictionary

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks

# Relative to the largest entry: well above the rounding of any assembly, far below a wrong matrix.
SYMMETRY_TOLERANCE = 1e-8
BLOCK_TOLERANCE = 1e-8
# of a node [m]: nothing that spins is near that, and squares stay far from overflow
_FARTHEST = 1e9
# node positions agree if they differ by less than this share of the mesh's size
_POSITION_TOLERANCE = 1e-9


def as_nodes(nodes: Any) -> np.ndarray:
    """Return the node positions as a read-only array, shape (n, 3).

    Raises
    ------
    TypeError
        If `nodes` does not hold numbers.
    ValueError
        If the shape is not (n, 3) with n ≥ 1, or an entry is not finite.
    """
    positions = checks.array(nodes, "nodes", "m", finite=False)
    if positions.ndim == 2 and positions.shape[1] in (6, 7):
        raise ValueError(
            f"nodes: {positions.shape[1]} coordinates per node mean rotation-carrying nodes "
            "(shells, beams); a solid rotor needs solid elements with x, y, z per node"
        )
    if positions.ndim != 2 or positions.shape[1] != 3 or len(positions) == 0:
        raise ValueError(f"nodes: the shape must be (n, 3), got {positions.shape}")
    bad = np.flatnonzero(~np.isfinite(positions).all(axis=1))
    if bad.size:
        raise ValueError(
            f"nodes: {bad.size} of {len(positions)} positions are not finite, {_some(bad)}"
        )
    if np.abs(positions).max() > _FARTHEST:
        raise ValueError(
            f"nodes: positions need coordinates below {_FARTHEST:g} m, got "
            f"{np.abs(positions).max():.3g} m"
        )
    return positions


# what these functions made: rotors made from rotors do not check the same matrix again
_checked: WeakValueDictionary[tuple[str, int], sp.csr_array] = WeakValueDictionary()


def as_mass(matrix: Any, node_count: int) -> sp.csr_array:
    """Return a mass matrix as :func:`as_matrix` does; it must have I₃ blocks (24) and no holes."""
    return as_matrix("mass matrix", matrix, node_count, _check_mass)


def as_stiffness(matrix: Any, node_count: int) -> sp.csr_array:
    """Return a stiffness matrix as :func:`as_matrix` does; no diagonal entry may be negative."""
    return as_matrix("stiffness matrix", matrix, node_count, _check_stiffness)


def as_matrix(
    label: str,
    matrix: Any,
    node_count: int,
    check: Callable[[sp.csr_array], None] | None = None,
) -> sp.csr_array:
    """Return a checked (3n, 3n) matrix: finite, exactly symmetric, read-only csr_array.

    Parameters
    ----------
    label : str
        Name of the matrix in messages, e.g. ``"mass matrix"``.
    matrix : array_like or sparse
    node_count : int
        The number of nodes n.
    check : callable, optional
        Raises if the matrix is wrong otherwise.

    Raises
    ------
    TypeError
        If `matrix` does not hold real numbers.
    ValueError
        If the size does not fit the nodes, an entry is not finite, or it is not symmetric.
    """
    size = 3 * node_count
    known = _checked.get((label, id(matrix)))
    if known is not None and known.shape == (size, size):
        return known
    converted = _to_csr(label, matrix)
    _check_size(label, converted.shape, node_count)
    bad = int(np.count_nonzero(~np.isfinite(converted.data)))
    if bad:
        raise ValueError(
            f"{label}: {bad} entries are not finite (NaN or infinity); check the export"
        )
    result = frozen(_symmetrised(label, converted))
    if check is not None:
        check(result)
    _checked[label, id(result)] = result
    return result


def check_same_mesh(nodes: np.ndarray, others: np.ndarray, label: str = "modal basis") -> None:
    """Refuse what belongs to other nodes (n, 3) than those of the rotor; `label` names it.

    Raises
    ------
    ValueError
        If the numbers of nodes or their positions differ.
    """
    if others.shape != nodes.shape:
        raise ValueError(
            f"{label} from another mesh: the rotor has other nodes ({len(others)} nodes in the "
            f"{label.split()[-1]}, {len(nodes)} in the rotor); compute the {label} with this rotor"
        )
    distance = np.linalg.norm(nodes - others, axis=1).max()
    if distance > _POSITION_TOLERANCE * np.ptp(nodes, axis=0).max():
        raise ValueError(
            f"{label} from another mesh: node positions differ by up to {distance:.3g} m; compute "
            f"the {label} with this rotor"
        )


def without_nodes(matrix: sp.csr_array, nodes: np.ndarray) -> sp.csr_array:
    """Return a matrix (3n, 3n) with the rows and columns of `nodes` set to zero."""
    factors = np.ones((matrix.shape[0] // 3, 3))
    factors[nodes] = 0.0
    mask = sp.diags_array(factors.ravel())
    return sp.csr_array(mask @ matrix @ mask)


def in_all_directions(matrix: sp.csr_array) -> sp.csr_array:
    """Return ``A ⊗ I₃`` of a matrix (n, n) in canonical form, faster than scipy does."""
    lengths, nnz = np.diff(matrix.indptr), matrix.nnz
    first = 2 * np.repeat(matrix.indptr[:-1], lengths) + np.arange(nnz, dtype=np.int32)
    step = np.repeat(lengths, lengths)
    data, indices = np.empty(3 * nnz), np.empty(3 * nnz, dtype=matrix.indices.dtype)
    for direction in range(3):
        place = first + direction * step
        data[place], indices[place] = matrix.data, 3 * matrix.indices + direction
    ends = np.append(0, np.cumsum(np.repeat(lengths, 3)))
    return sp.csr_array(
        (data, indices, ends.astype(indices.dtype)), shape=3 * np.array(matrix.shape)
    )


def frozen(matrix: sp.csr_array) -> sp.csr_array:
    """Return `matrix` in canonical form with its arrays made read-only."""
    matrix.sum_duplicates()
    matrix.eliminate_zeros()
    for array in (matrix.data, matrix.indices, matrix.indptr):
        array.flags.writeable = False
    return matrix


def _check_mass(mass: sp.csr_array) -> None:
    """Raise ValueError unless `mass` is a solid's mass matrix: I₃ blocks (24), no empty node."""
    if not _has_identity_blocks(mass):
        raise ValueError(_explain_blocks(mass))
    diagonal = mass.diagonal()[::3]
    negative = np.flatnonzero(diagonal < 0.0)
    if negative.size:
        raise ValueError(
            f"mass matrix: {negative.size} nodes have a negative mass, {_some(negative)}; "
            "it must be positive definite"
        )
    empty = np.flatnonzero(diagonal == 0.0)
    if empty.size:
        raise ValueError(
            f"mass matrix: {empty.size} nodes have no mass, {_some(empty)}; remove nodes that "
            "belong to no element (a mesh made second order twice has some), or condense them"
        )
    total = mass[::3, ::3].sum()
    if total <= 0.0:
        raise ValueError(f"mass matrix: the total mass must be positive, got {total:.6g} kg")


def _check_stiffness(stiffness: sp.csr_array) -> None:
    """Raise ValueError where a negative diagonal entry shows that `stiffness` is indefinite."""
    negative = np.flatnonzero(stiffness.diagonal() < 0.0)
    if negative.size:
        raise ValueError(
            f"stiffness matrix: {negative.size} diagonal entries are negative, at nodes "
            f"{_numbers(np.unique(negative // 3))}; it must not be indefinite (wrong sign, or "
            "mass and stiffness exchanged?)"
        )


def as_node_numbers(name: str, nodes: Any, node_count: int | None = None) -> np.ndarray:
    """Return the node numbers of interface `name`, shape (k,), below `node_count` if given.

    Raises
    ------
    TypeError
        If they are not integers.
    ValueError
        If there are none, one does not exist, or one is listed twice.
    """
    numbers = checks.array(nodes, f"interface {name!r}: nodes", dtype=int)
    if numbers.size == 0:
        raise ValueError(f"interface {name!r} has no nodes; check the face name or the node list")
    if numbers.ndim != 1:
        raise ValueError(
            f"interface {name!r}: nodes: needs a flat list of them, got the shape {numbers.shape}"
        )
    end = np.inf if node_count is None else node_count
    outside = numbers[(numbers < 0) | (numbers >= end)]
    if outside.size:
        raise ValueError(
            f"interface {name!r}: there is no node {_numbers(outside)}; the model has the nodes "
            f"0 to {end - 1:.0f} (counted from zero)"
        )
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
    if np.any(values < 0.0):
        raise ValueError(
            f"interface {name!r}: weights are shares of an area and cannot be negative, "
            f"got {values.min():.6g}"
        )
    if not 0.0 < values.sum() < np.inf:
        raise ValueError(
            f"interface {name!r}: weights need a positive finite sum, got {values.sum():.6g}"
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


def _to_csr(label: str, matrix: Any) -> sp.csr_array:
    """Return a matrix in canonical form, whose arrays may be those that were given."""
    if matrix is None:
        raise ValueError(f"{label}: is missing (None)")
    if not sp.issparse(matrix):
        matrix = checks.array(matrix, label, finite=False)
    if matrix.ndim != 2:
        raise ValueError(f"{label}: needs a square matrix, got the shape {matrix.shape}")
    rows = sp.csr_array(matrix)
    if not rows.has_canonical_format:
        rows = rows.copy()
        rows.sum_duplicates()  # now, for entries that are read-only cannot be put in order
    entries = rows.data
    if entries.dtype != float:
        entries = checks.array(entries, f"{label}: its entries", finite=False)
    indices = rows.indices, rows.indptr
    if rows.nnz <= np.iinfo(np.int32).max:
        indices = tuple(array.astype(np.int32, copy=False) for array in indices)
    return sp.csr_array((entries, *indices), shape=rows.shape)


def _check_size(label: str, shape: tuple[int, int], node_count: int) -> None:
    size = 3 * node_count
    if shape == (size, size):
        return
    if shape in ((2 * size, 2 * size), (7 * node_count, 7 * node_count)):
        raise ValueError(
            f"{label}: {shape[0] // node_count} coordinates for each of {node_count} nodes mean "
            "rotation-carrying nodes (shells, beams); a solid rotor needs solid elements with "
            "three displacements per node"
        )
    raise ValueError(
        f"{label}: the shape must be ({size}, {size}), three displacements for each of "
        f"{node_count} nodes, got {shape}"
    )


def _symmetrised(label: str, matrix: sp.csr_array) -> sp.csr_array:
    transposed = sp.csr_array(matrix.T)
    largest = _largest(matrix)
    alike = _alike(matrix, transposed)
    if alike:
        difference = _largest_of(matrix.data - transposed.data)
    else:
        difference = _largest(matrix - transposed)
    if difference > SYMMETRY_TOLERANCE * largest:
        raise ValueError(
            f"{label}: is not symmetric, entries differ by {difference:.3g} with a largest entry "
            f"of {largest:.3g}; many exports write one triangle only: then pass "
            "A + A.T - diag(A)"
        )
    if not alike:
        return sp.csr_array(0.5 * matrix + 0.5 * transposed)
    mean = transposed.data
    mean += matrix.data
    mean *= 0.5
    return transposed


def _has_identity_blocks(mass: sp.csr_array) -> bool:
    blocks = in_all_directions(sp.csr_array(mass[::3, ::3]))
    difference = blocks.data - mass.data if _alike(mass, blocks) else (mass - blocks).data
    return _largest_of(difference) <= BLOCK_TOLERANCE * _largest(mass)


def _explain_blocks(mass: sp.csr_array) -> str:
    node_count = mass.shape[0] // 3
    order = np.arange(3 * node_count).reshape(3, node_count).T.ravel()
    if _has_identity_blocks(mass[order][:, order]):
        return (
            "mass matrix: the coordinates are ordered x0 x1 … y0 y1 … z0 z1 …, but "
            "x0 y0 z0 x1 … is needed; with p = np.arange(3*n).reshape(3, n).T.ravel() pass "
            "M[p][:, p] and K[p][:, p] (and the damping likewise)"
        )
    if _largest(mass - sp.diags_array(mass.diagonal())) == 0.0:
        triples = mass.diagonal().reshape(-1, 3)
        differing = np.flatnonzero(np.ptp(triples, axis=1) > BLOCK_TOLERANCE * _largest(mass))
        return (
            f"mass matrix: a lumped matrix with direction-dependent masses at {differing.size} "
            f"nodes, {_some(differing)}, the first with {triples[differing[0]].tolist()} kg in "
            "x, y, z; a rotor turns these directions into each other, so give every node one mass"
        )
    return (
        "mass matrix: it does not consist of multiples of the 3×3 identity, one for each pair of "
        "nodes, as displacement-based solid elements give; check that all elements are solids "
        "with three displacements per node and that no directions were condensed or fixed"
    )


def _alike(first: sp.csr_array, second: sp.csr_array) -> bool:
    """Return whether two matrices have their entries at the same places."""
    same = np.array_equal(first.indptr, second.indptr)
    return same and np.array_equal(first.indices, second.indices)


def _largest(matrix: sp.csr_array) -> float:
    return _largest_of(matrix.data)


def _largest_of(values: np.ndarray) -> float:
    return float(max(values.max(initial=0.0), -values.min(initial=0.0)))


def _some(nodes: np.ndarray) -> str:
    return f"nodes {_numbers(nodes)}"


def _numbers(values: np.ndarray) -> str:
    listed = ", ".join(str(value) for value in values[:5])
    return listed if values.size <= 5 else f"{listed}, …"
