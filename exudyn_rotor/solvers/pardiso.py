"""Factors by Pardiso of Intel's MKL, where the optional package pypardiso is installed."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable
from importlib.util import find_spec

import numpy as np
import scipy.sparse as sp

# above this size it is quicker than handing the matrix to NGSolve
SMALLEST = 10_000
_POSITIVE_DEFINITE = 2
# numbers of Pardiso's parameters, counted from one, and values: own parameters, METIS, no pivoting
_PARAMETERS = {1: 1, 2: 2, 10: 0}


class PivotError(ValueError):
    """A pivot is zero or negative."""


def is_installed() -> bool:
    """Return whether pypardiso is installed."""
    return find_spec("pypardiso") is not None


def factor(matrix: sp.csr_array) -> Callable[[np.ndarray], np.ndarray]:
    """Factorise a symmetric positive definite matrix and return its inverse for (n,) or (n, k).

    Raises
    ------
    PivotError
        If the matrix is not positive definite.
    """
    from pypardiso import PyPardisoSolver
    from pypardiso.pardiso_wrapper import PyPardisoError

    solver = PyPardisoSolver(mtype=_POSITIVE_DEFINITE)
    for number, value in _PARAMETERS.items():
        solver.set_iparm(number, value)
    upper = sp.csr_matrix(sp.triu(matrix, format="csr"))
    upper.sort_indices()
    try:
        solver.factorize(upper)
    except PyPardisoError as error:
        raise PivotError(str(error)) from error

    one_at_a_time = threading.Lock()

    def solve(right: np.ndarray) -> np.ndarray:
        if right.size == 0:
            return np.zeros_like(right)
        with one_at_a_time:
            return solver.solve(upper, np.asfortranarray(right))

    weakref.finalize(solve, solver.free_memory, everything=True)
    return solve
