"""One factorisation of a symmetric positive definite matrix, for many solves."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import nullcontext

import ngsolve
import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from ngsolve.la import SparseMatrixd

from exudyn_rotor.solvers import pardiso

Solve = Callable[[np.ndarray], np.ndarray]

# below this size LAPACK is faster than handing the matrix over
DENSE_SIZE = 600
# below this size starting the threads costs more than they gain in one solve
_THREADED_SIZE = 50_000
# measured: a held stiffness leaves 1e-12 to 1e-10 (condition up to 1e11), a singular one 0.1
_RESIDUAL_LIMIT = 1e-6
_PROBE_STEPS = 6
_SEED = 20


class NotPositiveDefiniteError(ValueError):
    """The matrix has a zero or negative eigenvalue."""


class SparseCholesky:
    """Factorisation of a symmetric positive definite matrix.

    Large matrices go to Pardiso where it is installed, else to NGSolve's ``sparsecholesky``
    (fill-reducing, threaded), small ones to LAPACK. The residual of a random right-hand side shows
    a singular matrix. NGSolve's variant is an LDLᵀ that accepts negative pivots in silence: a
    negative Ritz value of ``A⁻¹`` in a small Krylov space proves an indefinite matrix (it lies
    inside the spectrum). A negative eigenvalue in the middle of the spectrum of ``A`` can pass.

    Parameters
    ----------
    matrix : scipy.sparse array, shape (n, n)
        Symmetric positive definite; only one triangle is factorised.
    ordered : pardiso.Ordered, optional
        The matrix as :func:`ordered` returns it.

    Attributes
    ----------
    uses_pardiso : bool
        Whether Pardiso made the factor.

    Raises
    ------
    NotPositiveDefiniteError
        If a diagonal entry is not positive or the probe fails.
    """

    def __init__(self, matrix: sp.sparray, ordered: pardiso.Ordered | None = None) -> None:
        self.shape = matrix.shape
        matrix = sp.csr_array(matrix)
        if not np.all(matrix.diagonal() > 0.0):
            raise NotPositiveDefiniteError("the matrix has a diagonal entry that is not positive")
        self.uses_pardiso = pardiso.is_used(self.shape[0])
        if self.uses_pardiso:
            self._solve = _by_pardiso(pardiso.Ordered(matrix) if ordered is None else ordered)
        else:
            self._solve = _dense(matrix) if self.shape[0] <= DENSE_SIZE else _sparse(matrix)
        if self.shape[0]:
            self._probe(matrix)

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Return ``A⁻¹ b`` for `right` of shape (n,) or (n, k)."""
        return self._solve(np.asarray(right, dtype=float))

    def _probe(self, matrix: sp.csr_array) -> None:
        start = np.random.default_rng(_SEED).standard_normal(self.shape[0])
        start /= np.linalg.norm(start)
        residual = np.linalg.norm(matrix @ self._solve(start) - start)
        # written so that a NaN fails too
        if not residual <= _RESIDUAL_LIMIT:
            raise NotPositiveDefiniteError(
                f"the matrix is singular: a solve leaves the relative residual {residual:.1e}"
            )
        if self.uses_pardiso:  # without negative pivots
            return
        lowest = _ritz_values(self._solve, start)[0]
        if lowest <= 0.0:
            raise NotPositiveDefiniteError(
                f"the matrix is indefinite: its inverse has the Ritz value {lowest:.1e}"
            )


def _dense(matrix: sp.csr_array) -> Solve:
    if matrix.shape[0] == 0:
        return np.copy
    try:
        factor = la.cho_factor(matrix.toarray(), lower=True)
    except la.LinAlgError as error:
        raise NotPositiveDefiniteError(f"the matrix has a negative pivot ({error})") from error
    return lambda right: la.cho_solve(factor, right)


def _by_pardiso(ordered: pardiso.Ordered) -> Solve:
    try:
        return ordered.factor()
    except pardiso.PivotError as error:
        raise NotPositiveDefiniteError(
            f"the matrix has a pivot that is not positive ({error})"
        ) from error


def _sparse(matrix: sp.csr_array) -> Solve:
    # sparsecholesky reads the lower triangle only
    lower = sp.coo_array(sp.tril(matrix))
    rows, columns = (index.astype(np.int32) for index in lower.coords)
    with ngsolve.TaskManager():
        assembled = SparseMatrixd.CreateFromCOO(rows, columns, lower.data, *lower.shape)
        inverse = assembled.Inverse(inverse="sparsecholesky")
    threaded = lower.shape[0] > _THREADED_SIZE
    threads = ngsolve.TaskManager if threaded else nullcontext

    def solve(vector: np.ndarray) -> np.ndarray:
        if vector.ndim == 2:
            columns = vector.T
            solved = [solve(column) for column in columns]
            return np.column_stack(solved or [vector])
        # new ones each time: several threads may share a factor
        right, solution = ngsolve.BaseVector(len(vector)), ngsolve.BaseVector(len(vector))
        right.FV().NumPy()[:] = vector
        with threads():
            solution.data = inverse * right
        return solution.FV().NumPy().copy()

    return solve


def _ritz_values(operator: Solve, start: np.ndarray) -> np.ndarray:
    """Return the Ritz values of a symmetric operator in the Krylov space of a unit vector."""
    basis, images = [], []
    vector = start
    for _ in range(min(_PROBE_STEPS, start.size)):
        basis.append(vector)
        images.append(operator(vector))
        vector = images[-1].copy()
        # twice, because one Gram–Schmidt pass loses orthogonality
        for previous in 2 * basis:
            vector -= previous * (previous @ vector)
        length = np.linalg.norm(vector)
        if length <= 1e-12 * np.linalg.norm(images[-1]):
            break
        vector /= length
    return np.linalg.eigvalsh(np.array(basis) @ np.array(images).T)
