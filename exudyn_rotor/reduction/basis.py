"""From component modes to one mass-orthonormal basis: rigid motions first, then flexible modes.

Removing the rigid motions from the component modes by mass-orthogonality puts the frame into the
mean motion of the rotor (Tisserand frame), so that ``S = 0`` and ``g = 0`` for flexible modes.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import scipy.linalg
import scipy.sparse as sp

from exudyn_rotor.reduction.component import ModeBasis
from exudyn_rotor.reduction.fields import ModeKind, rigid_names
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.nodal import rotations, translations

# length of a column, of the largest, that is rounding
_NOTHING = 1e-12


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
        Share of every component mode in every column.
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
    def of_rigid(
        cls,
        rigid: np.ndarray,
        kinds: tuple[ModeKind, ...],
        mass: sp.csr_array,
        rank_tolerance: float,
    ) -> OrthonormalBasis:
        """Orthonormalise rigid motions (3n, r); parameters as of :meth:`extended`."""
        none = np.zeros((len(rigid), 0))
        found = gram_schmidt((none, none), rigid, mass, rank_tolerance)
        return cls(
            matrix=found.matrix,
            momenta=found.momenta,
            stiffness=np.zeros(len(found.used)),
            rigid_kinds=tuple(kinds[i] for i in found.used),
            from_modes=np.zeros((0, len(found.used))),
            dropped=_unused(rigid_names(kinds), found.used),
        )

    def extended(
        self, modes: ModeBasis, mass: sp.csr_array, stiffness: sp.csr_array, rank_tolerance: float
    ) -> OrthonormalBasis:
        """Return the basis with more component modes.

        A column is dropped when what is left of it, once the columns before it are taken out, is
        smaller than `rank_tolerance` times its own norm. The flexible columns are then turned so
        that M and K become diagonal on them, ascending in frequency.
        """
        found = gram_schmidt((self.matrix, self.momenta), modes.matrix, mass, rank_tolerance)
        rigid, known = len(self.rigid_kinds), self.matrix.shape[1]
        forces = stiffness @ found.matrix
        mixed = self.matrix[:, rigid:].T @ forces
        own = np.diag(self.stiffness[rigid:])
        values, turn = scipy.linalg.eigh(
            np.block([[own, mixed], [mixed.T, found.matrix.T @ forces]])
        )
        shares = np.zeros((modes.matrix.shape[1], len(found.used)))
        shares[found.used] = scipy.linalg.solve_triangular(found.triangle, np.eye(len(found.used)))
        earlier = -self.from_modes @ (found.first @ shares[found.used])
        from_modes = np.block(
            [[self.from_modes, earlier], [np.zeros((len(shares), known)), shares]]
        )

        def turned(columns: np.ndarray, added: np.ndarray) -> np.ndarray:
            return np.hstack([columns[:, :rigid], np.hstack([columns[:, rigid:], added]) @ turn])

        return replace(
            self,
            matrix=turned(self.matrix, found.matrix),
            momenta=turned(self.momenta, found.momenta),
            stiffness=np.concatenate([self.stiffness[:rigid], values]),
            from_modes=turned(from_modes[:, :known], from_modes[:, known:]),
            dropped=self.dropped + _unused(modes.labels, found.used),
        )


class Orthonormal(NamedTuple):
    """What :func:`gram_schmidt` returns.

    Attributes
    ----------
    matrix, momenta : ndarray, shape (3n, k)
        The new columns Q, and ``MQ``.
    used : list of int
        Which of the given columns C they come from.
    triangle, first : ndarray, shape (k, k) and (m, k)
        T and S of ``C = QT + FS``, F the columns that were there before.
    """

    matrix: np.ndarray
    momenta: np.ndarray
    used: list[int]
    triangle: np.ndarray
    first: np.ndarray


def rigid_columns(nodes: np.ndarray, axis: SpinAxis, center: np.ndarray) -> np.ndarray:
    """Return the six rigid motions (3n × 6) in the order of ``RIGID_KINDS``.

    Translations along n1, n2, e, then rotations about e, n1, n2 through `center`.
    """
    first, second = axis.plane.T
    e = axis.direction
    shifts = translations(len(nodes)) @ np.column_stack([first, second, e])
    turns = rotations(nodes, center) @ np.column_stack([e, first, second])
    return np.hstack([shifts, turns])


def _unused(names: tuple[str, ...], used: list[int]) -> tuple[str, ...]:
    return tuple(name for i, name in enumerate(names) if i not in used)


def gram_schmidt(
    first: tuple[np.ndarray, np.ndarray],
    columns: np.ndarray,
    mass: sp.csr_array,
    tolerance: float,
) -> Orthonormal:
    """Orthonormalise `columns` against those of `first` and each other.

    Parameters
    ----------
    first : tuple of ndarray, shape (3n, m)
        Mass-orthonormal columns F, and ``MF``.
    columns : ndarray, shape (3n, k)
    mass : scipy.sparse.csr_array, shape (3n, 3n)
    tolerance : float
        Of a column that is used more than this share of it is new.
    """
    size, start = first[0].shape
    basis, momenta = (np.empty((size, start + columns.shape[1]), order="F") for _ in range(2))
    basis[:, :start], momenta[:, :start] = first
    shares = np.zeros((start + columns.shape[1], columns.shape[1]))
    lengths = np.sqrt(np.maximum(np.einsum("ik,ik->k", columns, mass @ columns), 0.0))
    count, used = start, []
    for index, length in enumerate(lengths):
        column = np.array(columns[:, index], dtype=float)
        for _ in range(2):  # one pass loses orthogonality
            share = momenta[:, :count].T @ column
            column -= basis[:, :count] @ share
            shares[:count, index] += share
        momentum = mass @ column
        norm = np.sqrt(max(column @ momentum, 0.0))
        if norm <= tolerance * length or length <= _NOTHING * lengths.max():
            continue
        basis[:, count], momenta[:, count] = column / norm, momentum / norm
        shares[count, index] = norm
        used.append(index)
        count += 1
    new, shares = slice(start, count), shares[:count, used]
    return Orthonormal(basis[:, new], momenta[:, new], used, shares[start:], shares[:start])
