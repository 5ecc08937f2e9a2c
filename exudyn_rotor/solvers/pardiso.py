"""Factors by Pardiso of Intel's MKL, where pypardiso is installed: the extra 'mkl'."""

from __future__ import annotations

import ctypes
import os
import platform
import sys
import threading
import warnings
import weakref
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from importlib.util import find_spec

import numpy as np
import scipy.sparse as sp
from threadpoolctl import ThreadpoolController

from exudyn_rotor.calls import user_level
from exudyn_rotor.solvers.memory import TooLittleMemoryError, available_memory

# above this size it is quicker than handing the matrix to NGSolve
SMALLEST = 10_000
# above this size NGSolve's factor is so slow that models are iterated instead, and both take twice
# as long as Pardiso
_LARGE = 100_000
_POSITIVE_DEFINITE = 2
# numbers of Pardiso's parameters, counted from one, and values: own parameters, METIS on all
# threads, no pivoting, operations of the factorisation reported
_PARAMETERS = {1: 1, 2: 3, 10: 0, 19: -1}
# what it reports: kilobytes of the ordering, at its peak and after it, and of the factor; millions
# of operations
_PEAK, _KEPT, _FACTOR, _OPERATIONS = 15, 16, 17, 19
_ORDER, _FACTORISE, _SOLVE = 11, 22, 33
_IDLE = 1  # milliseconds that a thread waits for more work without sleep
_NO_MEMORY = (-2, -9)  # numbers of errors
_ORDERING = 25.0  # bytes of the ordering and the triangle for every entry of the matrix


class PivotError(ValueError):
    """A pivot is zero or negative."""


def is_used(size: int) -> bool:
    """Return whether pypardiso is installed, and the quickest for matrices of this size."""
    return size > SMALLEST and find_spec("pypardiso") is not None


def would_help(size: int) -> bool:
    """Return whether pypardiso, which is not installed, would halve the time of a set-up."""
    there_is_one = platform.machine() in ("x86_64", "AMD64") and sys.platform != "darwin"
    return size > _LARGE and there_is_one and find_spec("pypardiso") is None


@cache
def tell_of_mkl() -> None:
    """Warn, once, that a model is large enough for MKL."""
    warnings.warn(
        "a model of this size is set up in half the time by Pardiso of Intel's MKL (1 GB on disk): "
        'pip install "exudyn-rotor[mkl]"',
        stacklevel=user_level(),
    )


class Ordered:
    """A symmetric positive definite matrix that is ordered and has no factor yet.

    Parameters
    ----------
    matrix : scipy.sparse.csr_array, shape (n, n)

    Attributes
    ----------
    needed : float
        Bytes that the factor and solutions will take.
    operations : float
        Operations of the factorisation.

    Raises
    ------
    TooLittleMemoryError
        If there is too little for the ordering, which takes a quarter of what iteration does.
    """

    def __init__(self, matrix: sp.csr_array) -> None:
        from pypardiso import PyPardisoSolver, ps

        needed, available = _ORDERING * matrix.nnz, available_memory()
        if needed > available:
            raise TooLittleMemoryError(
                f"to order the factor of {matrix.shape[0]} coordinates needs {needed / 1e9:.1f} "
                f"GB, and {available / 1e9:.1f} GB of memory are available; use a coarser mesh"
            )
        # else every solver looks for the library in all folders of the environment
        os.environ.setdefault("PYPARDISO_MKL_RT", ps.libmkl._name)
        self._solver = PyPardisoSolver(mtype=_POSITIVE_DEFINITE)
        for number, value in _PARAMETERS.items():
            self._solver.set_iparm(number, value)
        self._upper = _upper(matrix)
        self._call(_ORDER, np.zeros((matrix.shape[0], 1)))
        weakref.finalize(self, self._solver.free_memory, everything=True)
        peak, kept, factor, million = (
            float(self._solver.get_iparm(number)) for number in (_PEAK, _KEPT, _FACTOR, _OPERATIONS)
        )
        self.needed = 1024.0 * max(peak, kept + factor)
        self.operations = 1e6 * million

    def factor(self) -> Callable[[np.ndarray], np.ndarray]:
        """Factorise the matrix and return its inverse for right-hand sides (n,) or (n, k).

        Raises
        ------
        PivotError
            If the matrix is not positive definite.
        """
        self._call(_FACTORISE, np.zeros((self._upper.shape[0], 1)))
        one_at_a_time = threading.Lock()

        def solve(right: np.ndarray) -> np.ndarray:
            if right.size == 0:
                return np.zeros_like(right)
            with one_at_a_time:
                return self._call(_SOLVE, np.asfortranarray(right))

        return solve

    def _call(self, phase: int, right: np.ndarray) -> np.ndarray:
        from pypardiso.pardiso_wrapper import PyPardisoError

        self._solver.set_phase(phase)
        try:
            with _idle_threads_sleep():
                return self._solver._call_pardiso(self._upper, right)
        except PyPardisoError as error:
            if error.value in _NO_MEMORY:
                raise TooLittleMemoryError(
                    f"Pardiso has too little memory for {right.shape[0]} coordinates; use a "
                    "coarser mesh"
                ) from error
            raise PivotError(str(error)) from error


@cache
def _openmp() -> list[ctypes.CDLL]:
    """Return Intel's OpenMP library, whose threads MKL uses; none where MKL has other threads."""
    from pypardiso import ps

    ps.libmkl.mkl_get_max_threads()  # loads it
    loaded = ThreadpoolController().lib_controllers
    return [each.dynlib for each in loaded if hasattr(each.dynlib, "kmp_set_blocktime")]


@contextmanager
def _idle_threads_sleep() -> Iterator[None]:
    """Let threads of MKL sleep soon after their work.

    Else each keeps a core busy for 200 ms, where it waits for more, and what comes next does not
    have this core. Source: Intel oneAPI compiler reference, ``KMP_BLOCKTIME``.
    """
    before = [(each, each.kmp_get_blocktime()) for each in _openmp()]
    for library, _ in before:
        library.kmp_set_blocktime(_IDLE)
    try:
        yield
    finally:
        for library, time in before:
            library.kmp_set_blocktime(time)


def _upper(matrix: sp.csr_array) -> sp.csr_matrix:
    """Return the upper triangle with sorted columns, in less time than scipy's takes."""
    matrix.sort_indices()
    rows = np.repeat(np.arange(matrix.shape[0], dtype=np.int32), np.diff(matrix.indptr))
    upper = matrix.indices >= rows
    ends = np.cumsum(np.bincount(rows[upper], minlength=matrix.shape[0]))
    arrays = matrix.data[upper], matrix.indices[upper], np.append(0, ends)
    return sp.csr_matrix(arrays, shape=matrix.shape)
