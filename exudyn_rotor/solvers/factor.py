"""Factors of symmetric positive definite matrices: memory, solves, rounding; threads of LAPACK."""

from __future__ import annotations

import os
import platform
import sys
import warnings
import weakref
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import ngsolve
import numpy as np
import psutil
import scipy.linalg as la
import scipy.sparse as sp
from ngsolve.la import SparseMatrixd
from threadpoolctl import ThreadpoolController

from exudyn_rotor.calls import user_level

Solve = Callable[[np.ndarray], np.ndarray]

# below this size LAPACK is faster than handing the matrix over
DENSE_SIZE = 600
# above this size Pardiso is quicker than handing the matrix to NGSolve
PARDISO_SIZE = 10_000
# above this size it would halve the time of a set-up
_LARGE = 100_000
# below this size starting the threads costs more than they gain in one solve
_THREADED_SIZE = 50_000
# measured: a held stiffness leaves 1e-12 to 1e-10 (condition up to 1e11), a singular one 0.1
_RESIDUAL_LIMIT = 1e-6
_PROBE_STEPS = 6
_SEED = 20
# bytes that a factor takes beside its entries, for every entry of the matrix
_PER_ENTRY = 30.0
# Pardiso: numbers of its parameters, counted from one, with their values (own parameters, METIS on
# all threads, no pivoting), a kind of matrix, phases, and numbers of errors
_PARAMETERS = {1: 1, 2: 3, 10: 0}
_POSITIVE_DEFINITE, _FACTORISE, _SOLVE = 2, 12, 33
_NO_MEMORY = (-2, -9)
# multiple of eps ‖K‖∞ ‖u‖, which was 1 to 5 times that for 15 000 to 200 000 coordinates
_ROUNDING = 100.0
_EPS = np.finfo(float).eps
# limit and use of the control group of a container (Linux)
_GROUP = "/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"


def row_norm(matrix: sp.csr_array) -> float:
    """Return the largest row sum of absolute values, ``‖A‖∞``."""
    sizes = sp.csr_array((np.abs(matrix.data), matrix.indices, matrix.indptr), shape=matrix.shape)
    return float((sizes @ np.ones(matrix.shape[1])).max(initial=0.0))


def rounding_unit(stiffness: sp.csr_array, precision: float = _EPS) -> float:
    """Return the rounding error to allow in ``K u`` for a displacement of norm 1 [N]."""
    return _ROUNDING * precision * row_norm(stiffness)


class NotPositiveDefiniteError(ValueError):
    """The matrix has a zero or negative eigenvalue."""


class TooLittleMemoryError(MemoryError):
    """What is to be computed needs more memory than is available."""


def available_memory() -> float:
    """Return the bytes that can be allocated before the operating system swaps or kills."""
    available = float(psutil.virtual_memory().available)
    limit, used = (Path(name) for name in _GROUP)
    if limit.is_file() and limit.read_text().strip().isdigit():  # 'max' where there is no limit
        available = min(available, float(limit.read_text()) - float(used.read_text()))
    return max(available, 0.0)


def factor_entries(size: int) -> float:
    """Return about how many entries the factor of `size` coordinates of a solid rotor has.

    The power is that of nested dissection in three dimensions (George, SIAM J. Numer. Anal. 10
    (1973)), the number that of discs on shafts of 20,000 to 200,000 coordinates.
    """
    return 11.0 * size ** (4.0 / 3.0)


def factor_bytes(matrix: sp.csr_array) -> float:
    """Return about how much memory the factor of a stiffness matrix takes [bytes]."""
    return 8.0 * factor_entries(matrix.shape[0]) + _PER_ENTRY * matrix.nnz


def has_pardiso() -> bool:
    """Return whether pypardiso is installed: the extra 'mkl'."""
    return find_spec("pypardiso") is not None


@cache
def _tell_of_mkl() -> None:
    """Warn, once, that a model is large enough for MKL, where there is one for the machine."""
    if platform.machine() in ("x86_64", "AMD64") and sys.platform != "darwin":
        warnings.warn(
            "a model of this size is set up in half the time by Pardiso of Intel's MKL (1 GB on "
            'disk): pip install "exudyn-rotor[mkl]"',
            stacklevel=user_level(),
        )


class SparseCholesky:
    """Factorisation of a symmetric positive definite matrix.

    Large matrices go to Pardiso where it is installed, else to NGSolve's ``sparsecholesky``
    (fill-reducing, threaded), small ones to LAPACK. The residual of a random right-hand side shows
    a singular matrix, and inverse iteration a negative eigenvalue near zero; one that is far from
    zero can pass where NGSolve made the factor.
    Only one triangle is factorised.
    """

    def __init__(self, matrix: sp.sparray) -> None:
        self.shape = matrix.shape
        matrix = sp.csr_array(matrix)
        size = self.shape[0]
        if not np.all(matrix.diagonal() > 0.0):
            raise NotPositiveDefiniteError("the matrix has a diagonal entry that is not positive")
        if size <= DENSE_SIZE:
            self._solve = _dense(matrix)
        else:
            by_pardiso = size > PARDISO_SIZE and has_pardiso()
            if size > _LARGE and not by_pardiso:
                _tell_of_mkl()
            self._solve = _by_pardiso(matrix) if by_pardiso else _by_ngsolve(matrix)
        if size:
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
        for _ in range(_PROBE_STEPS):  # NGSolve's LDLᵀ accepts negative pivots in silence
            start = self._solve(start)
            start /= np.linalg.norm(start)
        if start @ self._solve(start) <= 0.0:
            raise NotPositiveDefiniteError("the matrix is indefinite")


def _dense(matrix: sp.csr_array) -> Solve:
    try:
        factor = la.cho_factor(matrix.toarray(), lower=True)
    except la.LinAlgError as error:
        raise NotPositiveDefiniteError(f"the matrix has a negative pivot ({error})") from error
    return lambda right: la.cho_solve(factor, right)


def _by_pardiso(matrix: sp.csr_array) -> Solve:
    # idle threads of MKL sleep after a millisecond; else each keeps a core busy for 200
    os.environ.setdefault("KMP_BLOCKTIME", "1")
    from pypardiso import PyPardisoSolver, ps
    from pypardiso.pardiso_wrapper import PyPardisoError

    # else every solver looks for the library in all folders of the environment
    os.environ.setdefault("PYPARDISO_MKL_RT", ps.libmkl._name)
    solver = PyPardisoSolver(mtype=_POSITIVE_DEFINITE)
    for number, value in _PARAMETERS.items():
        solver.set_iparm(number, value)
    upper = sp.csr_matrix(sp.triu(matrix, format="csr"))
    upper.sort_indices()
    solver.set_phase(_FACTORISE)
    try:
        solver._call_pardiso(upper, np.zeros((upper.shape[0], 1)))
    except PyPardisoError as error:
        if error.value in _NO_MEMORY:
            raise TooLittleMemoryError(
                f"Pardiso has too little memory for {upper.shape[0]} coordinates; use a coarser "
                "mesh"
            ) from error
        raise NotPositiveDefiniteError(
            f"the matrix has a pivot that is not positive ({error})"
        ) from error
    solver.set_phase(_SOLVE)

    def solve(right: np.ndarray) -> np.ndarray:
        if right.size == 0:
            return np.zeros_like(right)
        return solver._call_pardiso(upper, np.asfortranarray(right))

    weakref.finalize(solve, solver.free_memory, everything=True)
    return solve


def _by_ngsolve(matrix: sp.csr_array) -> Solve:
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
            return np.column_stack([solve(column) for column in vector.T] or [vector])
        # new ones each time: several threads may share a factor
        right, solution = ngsolve.BaseVector(len(vector)), ngsolve.BaseVector(len(vector))
        right.FV().NumPy()[:] = vector
        with threads():
            solution.data = inverse * right
        return solution.FV().NumPy().copy()

    return solve


@cache
def _libraries() -> ThreadpoolController:
    """Return what is loaded; the search takes as long as two eigenvalue problems.

    MKL beside another one is Pardiso's, not numpy's.
    """
    loaded = ThreadpoolController().select(user_api="blas")
    names = {each.internal_api for each in loaded.lib_controllers}
    return loaded.select(internal_api=sorted(names - {"mkl"} or names))


@contextmanager
def one_thread() -> Iterator[None]:
    """Let BLAS and LAPACK use one thread meanwhile; also a decorator.

    Dense problems of some hundred coordinates, many of them one after the other, take up to fifty
    times longer on several threads, which wait for one another.
    """
    with _libraries().limit(limits=1):
        yield
