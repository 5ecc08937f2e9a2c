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
from exudyn_rotor.reduction.fields import ModeKind, rigid_names
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.nodal import rotations, translations

# share of a column that is new, and length of a column, of the largest, that is rounding
NEW, _NOTHING = 1e-7, 1e-12


@dataclass(frozen=True, eq=False)
class OrthonormalBasis:
    """Mass-orthonormal basis of a rotor.

    Attributes
    ----------
    matrix, momenta : ndarray, shape (3n, k)
        Displacement columns Q, mesh axes, and ``MQ``.
    stiffness : ndarray, shape (k,)
        Diagonal of ``QᵀKQ``, which has no other entries [1/s²]; zero for the rigid motions.
    rigid_kinds : tuple of ModeKind
        What the leading rigid columns are.
    from_modes : ndarray, shape (r, k)
        Share of every component mode in every column, zero for the rigid motions.
    dropped : tuple of str
        Component modes and rigid motions that added nothing to the basis.
    """

    matrix: np.ndarray
    momenta: np.ndarray
    stiffness: np.ndarray
    rigid_kinds: tuple[ModeKind, ...]
    from_modes: np.ndarray
    dropped: tuple[str, ...]

    @classmethod
    def of(
        cls,
        rigid: tuple[np.ndarray, tuple[ModeKind, ...]],
        modes: ModeBasis,
        mass: sp.csr_array,
        stiffness: sp.csr_array,
    ) -> OrthonormalBasis:
        """Return the basis of rigid motions (3n, r), with their kinds, and component modes.

        A column is dropped when what is left of it, once the columns before it are taken out, is
        smaller than 1e-7 of its own norm. The flexible columns are turned so that M
        and K become diagonal on them, ascending in frequency.
        """
        motions, kinds = rigid
        names = rigid_names(kinds) + modes.labels
        matrix, momenta, used = gram_schmidt(np.hstack([motions, modes.matrix]), mass)
        kept = tuple(kinds[i] for i in used if i < len(kinds))
        held, flexible = np.split(matrix, [len(kept)], axis=1)
        values, turn = scipy.linalg.eigh(flexible.T @ (stiffness @ flexible))
        flexible, flexible_momenta = flexible @ turn, momenta[:, len(kept) :] @ turn
        # the flexible columns are G⁺ times what the modes have beside the rigid motions
        shares = np.linalg.pinv(flexible_momenta.T @ modes.matrix)
        return cls(
            matrix=np.hstack([held, flexible]),
            momenta=np.hstack([momenta[:, : len(kept)], flexible_momenta]),
            stiffness=np.r_[np.zeros(len(kept)), values],
            rigid_kinds=kept,
            from_modes=np.hstack([np.zeros((len(shares), len(kept))), shares]),
            dropped=tuple(name for i, name in enumerate(names) if i not in used),
        )


def rigid_columns(nodes: np.ndarray, axis: SpinAxis, center: np.ndarray) -> np.ndarray:
    """Return the six rigid motions (3n × 6) in the order of ``RIGID_KINDS``.

    Translations along n1, n2, e, then rotations about e, n1, n2 through `center`.
    """
    first, second = axis.plane.T
    e = axis.direction
    shifts = translations(len(nodes)) @ np.column_stack([first, second, e])
    turns = rotations(nodes, center) @ np.column_stack([e, first, second])
    return np.hstack([shifts, turns])


def gram_schmidt(
    columns: np.ndarray, mass: sp.csr_array
) -> tuple[np.ndarray, np.ndarray, list[int]]:
    """Return mass-orthonormal columns Q, ``MQ``, and which of the given columns they come from.

    Of a column that is used more than 1e-7 is new.
    """
    basis, momenta = (np.empty(columns.shape, order="F") for _ in range(2))
    lengths = np.sqrt(np.maximum(np.einsum("ik,ik->k", columns, mass @ columns), 0.0))
    used: list[int] = []
    for index, length in enumerate(lengths):
        column, count = np.array(columns[:, index], dtype=float), len(used)
        for _ in range(2):  # one pass loses orthogonality
            column -= basis[:, :count] @ (momenta[:, :count].T @ column)
        momentum = mass @ column
        norm = np.sqrt(max(column @ momentum, 0.0))
        if norm > NEW * length and length > _NOTHING * lengths.max():
            basis[:, count], momenta[:, count] = column / norm, momentum / norm
            used.append(index)
    return basis[:, : len(used)], momenta[:, : len(used)], used
