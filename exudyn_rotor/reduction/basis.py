"""From component modes to one mass-orthonormal basis: rigid motions first, then flexible modes.

Removing the rigid motions from the component modes by mass-orthogonality puts the frame into the
mean motion of the rotor (Tisserand frame), so that ``S = 0`` and ``g = 0`` for flexible modes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.sparse as sp

from exudyn_rotor.reduction.component import ModeBasis
from exudyn_rotor.reduction.mode_kind import ModeKind, rigid_names
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.nodal import rotations, translations


@dataclass(frozen=True, eq=False)
class OrthonormalBasis:
    """Mass-orthonormal basis of a rotor.

    Attributes
    ----------
    matrix : ndarray, shape (3n, k)
        Displacement columns, mesh axes.
    rigid_kinds : tuple of ModeKind
        What the leading rigid columns are.
    from_modes : ndarray, shape (r, k)
        Share of every component mode in every column.
    dropped : tuple of str
        Component modes and rigid motions that added nothing to the basis.
    """

    matrix: np.ndarray
    rigid_kinds: tuple[ModeKind, ...]
    from_modes: np.ndarray
    dropped: tuple[str, ...]


def rigid_columns(nodes: np.ndarray, axis: SpinAxis, center: np.ndarray) -> np.ndarray:
    """Return the six rigid motions (3n × 6) in the order of ``RIGID_KINDS``.

    Translations along n1, n2, e, then rotations about e, n1, n2 through `center`.
    """
    first, second = axis.plane.T
    e = axis.direction
    shifts = translations(len(nodes)) @ np.column_stack([first, second, e])
    turns = rotations(nodes, center) @ np.column_stack([e, first, second])
    return np.hstack([shifts, turns])


def orthonormal_basis(
    rigid: np.ndarray,
    rigid_kinds: tuple[ModeKind, ...],
    modes: ModeBasis,
    mass: sp.csr_array,
    stiffness: sp.csr_array,
    rank_tolerance: float,
) -> OrthonormalBasis:
    """Orthonormalise rigid motions and component modes in the mass matrix.

    A column is dropped when what is left of it, once the columns before it are taken out, is
    smaller than `rank_tolerance` times its own norm. The flexible columns are then turned so that
    M and K become diagonal on them, ascending in frequency.
    """
    columns, rigid_used, _ = gram_schmidt(np.zeros((len(rigid), 0)), rigid, mass, rank_tolerance)
    flexible, modes_used, triangle = gram_schmidt(columns, modes.matrix, mass, rank_tolerance)
    _, turn = scipy.linalg.eigh(flexible.T @ (stiffness @ flexible))
    from_modes = np.zeros((modes.matrix.shape[1], columns.shape[1] + len(modes_used)))
    from_modes[modes_used, columns.shape[1] :] = scipy.linalg.solve_triangular(triangle, turn)
    return OrthonormalBasis(
        matrix=np.hstack([columns, flexible @ turn]),
        rigid_kinds=tuple(rigid_kinds[i] for i in rigid_used),
        from_modes=from_modes,
        dropped=_unused(rigid_names(rigid_kinds), rigid_used) + _unused(modes.labels, modes_used),
    )


def _unused(names: tuple[str, ...], used: list[int]) -> tuple[str, ...]:
    return tuple(name for i, name in enumerate(names) if i not in used)


def gram_schmidt(
    first: np.ndarray, columns: np.ndarray, mass: sp.csr_array, tolerance: float
) -> tuple[np.ndarray, list[int], np.ndarray]:
    """Orthonormalise `columns` against `first` and each other; two passes keep full precision.

    Returns the new columns, the indices of those used, and the triangle that maps the new columns
    back to the used ones (less their share in `first`).
    """
    size, limit = len(columns), first.shape[1] + columns.shape[1]
    basis, weighted = np.empty((size, limit)), np.empty((size, limit))
    count = first.shape[1]
    basis[:, :count], weighted[:, :count] = first, mass @ first
    start, used, shares = count, [], []
    largest = np.max(np.sqrt(np.maximum(_squared_norms(columns, mass), 0.0)), initial=0.0)
    for index in range(columns.shape[1]):
        column = np.array(columns[:, index], dtype=float)
        full_norm = np.sqrt(max(column @ (mass @ column), 0.0))
        share = np.zeros(count)
        for _ in range(2):
            projection = weighted[:, :count].T @ column
            column -= basis[:, :count] @ projection
            share += projection
        weight = mass @ column
        norm = np.sqrt(max(column @ weight, 0.0))
        if norm <= tolerance * full_norm or full_norm <= 1e-12 * largest:
            continue
        basis[:, count], weighted[:, count] = column / norm, weight / norm
        used.append(index)
        shares.append(np.append(share[start:], norm))
        count += 1
    triangle = np.zeros((len(used), len(used)))
    for j, share in enumerate(shares):
        triangle[: len(share), j] = share
    return basis[:, start:count], used, triangle


def _squared_norms(columns: np.ndarray, mass: sp.csr_array) -> np.ndarray:
    return np.einsum("ik,ik->k", columns, mass @ columns)
