"""Lowest modes of ``K φ = ω² M φ``: Lanczos iteration for large models, LAPACK for small ones."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from exudyn_rotor.solvers.factor import DENSE_SIZE
from exudyn_rotor.solvers.rounding import rounding
from exudyn_rotor.threads import one_thread

Modes = tuple[np.ndarray, np.ndarray]
_SEED = 4830498
# share of ω² M φ that iteration may leave
_RESIDUAL_LIMIT = 1e-6
# columns to solve for at once where that is much quicker than one by one; for 20 modes the best
WIDE = 12
# columns that are kept for each mode at most
_ROOM = 5
# columns that are thin, whose products with the mass are faster one by one
_THIN = 2
_MOST_STEPS = 1000
# steps of a look for motions that the basis has no part of, and columns of each
_LOOK_STEPS, _LOOK_WIDTH = 3, 2
# shares of an eigenvalue within which its copies are as good as one another
_COPIES = 1e-6
# share of the basis in a motion that is orthogonal to it
_ORTHOGONAL = 1e-6
# a block more is added between two looks at what has converged, for so many blocks
_BLOCKS_APART = 40
# length of what is new in columns, relative to them, that is rounding, and squares of one another
_DEPENDENT, _ALIKE = 1e-14, 1e-13
# squares of lengths above this share of the largest lose no more than three digits
_EVEN = 1e-3


def is_small(size: int, count: int) -> bool:
    """Return whether `count` of `size` modes are better computed with dense matrices."""
    # Lanczos loses its advantage where a large part of the spectrum is wanted
    return size <= DENSE_SIZE or 4 * count > size


def dense_modes(stiffness: np.ndarray, mass: np.ndarray, count: int, skip: int = 0) -> Modes:
    """Return eigenvalues (count,) and mass-normalised modes (n, count) after `skip` lowest ones.

    Raises
    ------
    ValueError
        If one of the wanted modes has no stiffness, or the mass matrix is not positive definite.
    """
    try:
        values, vectors = la.eigh(stiffness, mass)
    except la.LinAlgError as error:
        raise ValueError(
            f"the mass matrix is not positive definite ({error}); look for nodes without mass"
        ) from error
    wanted = slice(skip, skip + count)
    if count and values[skip] <= values.size * np.finfo(float).eps * values[-1]:
        raise ValueError(
            f"the model has more free motions than the {skip} that are left out; "
            "look for loose parts or nodes without stiffness"
        )
    return values[wanted], vectors[:, wanted]


def lanczos_modes(
    mass: sp.csr_array,
    inverse: Callable[[np.ndarray], np.ndarray],
    count: int,
    tolerance: float,
    width: int = 2,
) -> Modes:
    """Return the `count` lowest modes by block Lanczos iteration on ``K⁻¹ M``.

    Parameters
    ----------
    mass : scipy.sparse.csr_array, shape (n, n)
    inverse : callable
        The stiffness's inverse on the motions that are allowed, of loads (n, k): symmetric,
        positive semi-definite; motions in its null space are left out.
    count : int
    tolerance : float
        Residual of the eigenvalues of ``K⁻¹ M``, relative to them.
    width : int, optional
        Columns that are solved for at once.

    Returns
    -------
    eigenvalues : ndarray, shape (count,)
        ``ω²``, ascending [rad²/s²].
    modes : ndarray, shape (n, count)
        Mass-normalised.

    Raises
    ------
    ValueError
        If the iteration does not converge.

    Notes
    -----
    Blocks of two, as bending modes come in pairs, and two threads can solve for them. A block
    finds no more copies of an eigenvalue than it has columns; so some steps from other vectors look
    for modes to which the whole basis is orthogonal, and these widen the block. The start vectors
    are seeded, so that results repeat. With ``K⁻¹MQ = QT + R`` a Ritz vector ``φ = Qs`` of
    the value ``θ`` leaves ``Rs``; returned are ``K⁻¹Mφ/θ = φ + Rs/θ``, one inverse iteration
    further, which leave smooth forces ``MRs/θ²`` instead of ``KRs/θ``. Sources: of the
    transformation, Ericsson, Ruhe, "The spectral transformation Lanczos method", Math. Comp. 35
    (1980); of the restarts, Wu, Simon, "Thick-restart Lanczos method", SIAM J. Matrix Anal. Appl.
    22 (2000); of blocks, Grimes, Lewis, Simon, "A shifted block Lanczos algorithm for solving
    sparse symmetric generalized eigenproblems", SIAM J. Matrix Anal. Appl. 15 (1994).
    """
    size = mass.shape[0]
    start = np.random.default_rng(_SEED).standard_normal((size, min(width, size)))
    # threads of products of thin matrices would wait for those of the solutions
    with one_thread():
        space = _Krylov(mass, inverse, min(size, _ROOM * (count + width)), start)
        for _ in range(_MOST_STEPS):
            values, turn, errors = space.ritz_values()
            converged = errors[:count] <= tolerance * values[:count]
            if len(converged) == count and np.all(converged):
                missed = space.missed((1.0 + _COPIES) * values[count - 1])
                if missed.shape[1] == 0:
                    return 1.0 / values[:count], space.modes(values[:count], turn[:, :count])
                space.widen(missed)
            if not space.extend(values, turn, count):
                break
    raise ValueError(
        f"only {np.count_nonzero(converged)} of {count} modes converged to {tolerance:.0e}; "
        "ask for more modes (a cluster may be cut) or give a larger tolerance"
    )


class _Krylov:
    """Mass-orthonormal basis of a Krylov space of ``K⁻¹ M``, and what the next block adds."""

    def __init__(
        self,
        mass: sp.csr_array,
        inverse: Callable[[np.ndarray], np.ndarray],
        room: int,
        start: np.ndarray,
    ) -> None:
        self._mass, self._inverse = mass, inverse
        self._basis, self._momenta = (np.empty((len(start), room), order="F") for _ in range(2))
        self._projected = np.zeros((room, room))
        self._count = self._before = 0
        # each look needs vectors of its own: the basis has the motions of earlier ones by then
        self._others = np.random.default_rng(_SEED + 1)
        self._next(inverse(mass @ start))
        self._add()

    @property
    def basis(self) -> np.ndarray:
        """Shape (n, m)."""
        return self._basis[:, : self._count]

    def ritz_values(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the Ritz values, descending, their vectors in the basis and their residuals."""
        values, turn = _eigh(self._projected[: self._count, : self._count])
        values, turn = values[::-1], turn[:, ::-1]
        return values, turn, np.linalg.norm(self._left(turn), axis=0)

    def modes(self, values: np.ndarray, turn: np.ndarray) -> np.ndarray:
        """Return the Ritz vectors of some values after an inverse iteration."""
        return self.basis @ turn + self._block @ (self._left(turn) / values)

    def missed(self, least: float) -> np.ndarray:
        """Return motions orthogonal to the basis with Ritz values above `least`, shape (n, k)."""
        size = len(self._basis)
        if size - self._count < _LOOK_WIDTH:
            return np.empty((size, 0))

        def inverse(load: np.ndarray) -> np.ndarray:
            return self._without_basis(self._inverse(load))[0]

        start = self._others.standard_normal((size, _LOOK_WIDTH))
        left = _Krylov(self._mass, inverse, _LOOK_STEPS * _LOOK_WIDTH, start)
        while left._has_room and left._add():
            pass
        values, turn, _ = left.ritz_values()
        found = left.basis @ turn[:, values > least]
        # where nothing is left, rounding is taken for motions, which the basis has already
        new = np.linalg.norm(self._momenta[:, : self._count].T @ found, axis=0) < _ORTHOGONAL
        return found[:, new]

    def widen(self, columns: np.ndarray) -> None:
        """Add columns that are orthogonal to the basis to the next block."""
        block, momentum, rest = self._block, self._momentum, self._rest
        self._next(columns - block @ (momentum.T @ columns))
        none = np.zeros((self._block.shape[1], rest.shape[1]))
        self._block = np.hstack([block, self._block])
        self._momentum = np.hstack([momentum, self._momentum])
        self._rest = np.vstack([rest, none])

    def _without_basis(self, columns: np.ndarray, first: int = 0) -> tuple[np.ndarray, np.ndarray]:
        """Return what the basis has no part of, and the shares of the basis.

        Those of the columns before number `first` are no more than rounding.
        """
        shares = np.zeros((self._count, columns.shape[1]))
        for start in (first, 0):  # one Gram–Schmidt pass loses orthogonality
            some = slice(start, self._count)
            share = self._momenta[:, some].T @ columns
            columns = columns - self._basis[:, some] @ share
            shares[some] += share
        return columns, shares

    def _left(self, turn: np.ndarray) -> np.ndarray:
        """Return the residuals of Ritz vectors in the next block."""
        return self._rest @ turn[self._count - self._rest.shape[1] :]

    def extend(self, values: np.ndarray, turn: np.ndarray, count: int) -> bool:
        """Add some blocks, after a restart where there is no room left; False if there are none."""
        if not self._has_room:
            kept = (count + self._count) // 2
            for array in (self._basis, self._momenta):
                array[:, :kept] = array[:, : self._count] @ turn[:, :kept]
            self._projected[:kept, :kept] = np.diag(values[:kept])
            self._count, self._before = kept, 0
        width = self._block.shape[1]
        if not self._add():
            return False
        for _ in range(self._count // (_BLOCKS_APART * width)):
            if self._has_room:
                self._add()
        return True

    @property
    def _has_room(self) -> bool:
        return self._count + self._block.shape[1] <= self._basis.shape[1]

    def _add(self) -> bool:
        added = slice(self._count, self._count + self._block.shape[1])
        if added.start == added.stop:
            return False
        self._basis[:, added], self._momenta[:, added] = self._block, self._momentum
        self._count = added.stop
        # K⁻¹M is symmetric: it takes a block to itself, those beside it and nothing else
        shares = self._next(self._inverse(self._momentum), self._before)
        self._before = added.start
        self._projected[: added.stop, added] = shares
        self._projected[added, : added.stop] = shares.T
        return True

    def _next(self, columns: np.ndarray, first: int = 0) -> np.ndarray:
        """Take what is new in some columns as the next block; return their shares of the basis."""
        columns, shares = self._without_basis(columns, first)
        weighted = _product(self._mass, columns)
        self._rest = np.eye(columns.shape[1])
        for _ in range(2):  # columns that are nearly alike are not orthogonal after the first
            squares, turn = _eigh(columns.T @ weighted)
            new = squares > max(_DEPENDENT**2 * np.sum(shares**2), _ALIKE * squares[-1])
            lengths, turn = np.sqrt(squares[new]), turn[:, new]
            columns, weighted = (X @ (turn / lengths) for X in (columns, weighted))
            self._rest = lengths[:, None] * (turn.T @ self._rest)
            if squares[0] > _EVEN * squares[-1] or lengths.size == 0:
                break
        self._block, self._momentum = columns, weighted
        return shares


_eigh = one_thread()(np.linalg.eigh)


def _product(matrix: sp.csr_array, columns: np.ndarray) -> np.ndarray:
    if columns.shape[1] > _THIN:
        return matrix @ columns
    return np.stack([matrix @ column for column in columns.T], axis=1)


def check_modes(
    stiffness: sp.csr_array,
    mass: sp.csr_array,
    eigenvalues: np.ndarray,
    modes: np.ndarray,
    *,
    precision: float = np.finfo(float).eps,
    constraints: sp.csr_array | None = None,
) -> None:
    """Check ``K φ − ω² M φ + Cᵀ λ = 0`` for the best ``λ``.

    The residual may reach 1e-6 of ``ω² M φ`` plus what the relative `precision` of the stiffness
    leaves in ``K φ`` at best.

    Raises
    ------
    ValueError
        If a residual is larger.
    """
    inertia = mass @ (modes * eigenvalues)
    residual = stiffness @ modes - inertia
    if constraints is not None:
        residual = without_reactions(residual, constraints)
    size = _RESIDUAL_LIMIT * np.linalg.norm(inertia, axis=0)
    excess = np.linalg.norm(residual, axis=0) - size - rounding(stiffness, modes, precision)
    if np.any(excess > 0.0):
        raise ValueError(
            f"eigenmode {np.argmax(excess) + 1} does not satisfy K φ = ω² M φ; the matrices may "
            "not be symmetric, or a smaller tolerance is needed"
        )


def without_reactions(force: np.ndarray, constraints: sp.csr_array) -> np.ndarray:
    """Return the part of `force` that reactions ``Cᵀ λ`` cannot balance."""
    gram = (constraints @ constraints.T).toarray()
    return force - constraints.T @ la.solve(gram, constraints @ force, assume_a="pos")


def with_fixed_sign(modes: np.ndarray) -> np.ndarray:
    """Return the modes with the largest component of each positive."""
    largest = np.argmax(np.abs(modes), axis=0)
    signs = np.sign(modes[largest, np.arange(modes.shape[1])])
    return modes * signs
