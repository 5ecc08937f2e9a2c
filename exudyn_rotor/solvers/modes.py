"""Lowest modes of a large model, by the way its stiffness is inverted."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from exudyn_rotor.solvers.davidson import ApproximateInverse, davidson_modes
from exudyn_rotor.solvers.lanczos import Modes, lanczos_modes

_RESIDUAL = 1e-7  # below what lanczos.check_modes allows


class Inverse(ApproximateInverse, Protocol):
    """Inverse of a stiffness on the motions that are allowed, exact and approximate."""

    @property
    def iterative(self) -> bool: ...
    def solve(self, load: np.ndarray) -> np.ndarray: ...


def lowest_modes(
    stiffness: sp.csr_array,
    mass: sp.csr_array,
    inverse: Inverse,
    count: int,
    tolerance: float,
    balanced: Callable[[np.ndarray], np.ndarray] | None = None,
) -> Modes:
    """Return the `count` lowest modes; parameters as of :func:`davidson_modes`."""
    if inverse.iterative:
        return davidson_modes(stiffness, mass, inverse, count, tolerance, balanced)
    # the error of eigenvalues is of second order in the residual
    return lanczos_modes(mass, inverse.solve, count, min(_RESIDUAL, np.sqrt(tolerance)))
