"""Exponents of one system by one method each, with the error that the method states."""

import numpy as np

from exudyn_rotor.linear.periodic.companion import Companion
from exudyn_rotor.linear.periodic.exponents import _solve_by_hill
from exudyn_rotor.linear.periodic.fundamental import floquet_motions
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, fold


def constant_exponents(system: PeriodicSystem) -> np.ndarray:
    """Return the 2k eigenvalues of ``λ²M + λD + K`` with the matrices at θ = 0 [1/s]."""
    return Companion.of(*system.matrices(0.0)).values()


def floquet_exponents(system: PeriodicSystem, tolerance: float = 1e-9) -> np.ndarray:
    """Return the 2k exponents from the fundamental matrix [1/s]."""
    return floquet_motions(system, tolerance)[0]


def hill_exponents(system: PeriodicSystem, tolerance: float = 1e-9) -> tuple[np.ndarray, float]:
    """Return the 2k exponents by Hill's method [1/s], and their error relative to Ω."""
    found = _solve_by_hill(system, tolerance)
    return fold(found.values, system.base), found.error
