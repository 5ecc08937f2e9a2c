"""Exponents of a linear system with constant or periodic coefficients.

A solution of ``M(θ)ẍ + D(θ)ẋ + K(θ)x = 0`` with θ = Ωt is ``x(t) = exp(λt) p(t)`` with p of the
coefficients' period T. The 2k exponents λ are determined but for multiples of ``i 2π/T``. Sources:
Floquet, Ann. sci. É.N.S. 12 (1883); Hill, Acta Math. 8 (1886); for rotors Friswell, Penny, Garvey,
Lees, Dynamics of Rotating Machines (2010), Sect. 7.

Two independent ways for periodic systems: Hill's method (:mod:`.hill`), of whose copies
``λ + i n 2π/T`` the most central one is kept, and the fundamental matrix (:mod:`.fundamental`).
"""

from __future__ import annotations

import numpy as np

from exudyn_rotor.linear.periodic.eigenvalues import Companion
from exudyn_rotor.linear.periodic.fundamental import floquet_exponents
from exudyn_rotor.linear.periodic.hill import Chosen, HillSolution, solve_hill
from exudyn_rotor.linear.periodic.periodic_system import (
    PeriodicSystem,
    UnconvergedError,
    fold,
)

METHODS = ("auto", "floquet", "hill", "eigen")
_NEUTRAL = 1e-7  # |λ|/Ω of a free rigid motion: a double zero keeps half the digits


def exponents(system: PeriodicSystem, method: str = "auto", tolerance: float = 1e-9) -> np.ndarray:
    """Return the 2k exponents of one system [1/s], descending in their real parts.

    Free rigid motions (``|λ| < 1e-7 Ω``) are returned as zeros.

    Parameters
    ----------
    system : PeriodicSystem
    method : {'auto', 'floquet', 'hill', 'eigen'}
        See :func:`exudyn_rotor.stability`.
    tolerance : float, optional
        Error of periodic exponents relative to Ω.

    Raises
    ------
    ValueError
        For 'eigen' where the system is periodic, and where `tolerance` is not reached.
    """
    constant = system.is_constant or system.speed == 0.0
    if method == "eigen" and not constant:
        raise ValueError(
            f"method='eigen': at {system.speed:g} rad/s the system is periodic (anisotropic "
            "supports or a foundation); use 'auto', 'hill' or 'floquet'"
        )
    if constant and method != "floquet":
        values = constant_exponents(system).astype(complex)
    elif method == "floquet":
        values = floquet_exponents(system, tolerance)
    else:
        values = _by_hill(system, tolerance, fall_back=method == "auto")
    return in_order(values, system.speed)


def in_order(values: np.ndarray, speed: float) -> np.ndarray:
    """Return exponents with neutral ones set to zero, descending in their real parts."""
    values = np.where(np.abs(values) < _NEUTRAL * speed, 0.0, values)
    return values[np.lexsort((-values.imag, -values.real))]


def constant_exponents(system: PeriodicSystem) -> np.ndarray:
    """Return the 2k eigenvalues of ``λ²M + λD + K`` with the matrices at θ = 0 [1/s]."""
    return Companion.of(*system.matrices(0.0)).values()


def _by_hill(system: PeriodicSystem, tolerance: float, fall_back: bool) -> np.ndarray:
    try:
        return hill_exponents(system, tolerance)[0]
    except UnconvergedError:
        if not fall_back:
            raise
        return floquet_exponents(system, tolerance)


def hill_exponents(system: PeriodicSystem, tolerance: float = 1e-9) -> tuple[np.ndarray, float]:
    """Return the 2k exponents by Hill's method [1/s], and their error relative to Ω.

    Raises
    ------
    UnconvergedError
        If the error does not fall below `tolerance`.
    """

    def choose(solution: HillSolution) -> Chosen | None:
        columns = _central(solution, system.step, 2 * system.size)
        if columns is None:
            return None
        sizes = np.full(len(columns), abs(system.speed))
        return Chosen(columns, solution.values[columns], solution.shapes[:, :, columns], sizes)

    chosen, _, error = solve_hill(system, choose, tolerance)
    return fold(chosen.values, system.base), error


def _central(solution: HillSolution, step: int, count: int) -> np.ndarray | None:
    """Return which solutions are the most central copies, one of each; None where unclear.

    The mean harmonic of a copy shifts by the step p from copy to copy, so every interval of that
    length holds each exponent once; it begins in the widest gap near −p/2.
    """
    weights = np.sum(np.abs(solution.shapes) ** 2, axis=1)
    means = solution.orders @ weights / np.sum(weights, axis=0)
    inner = np.sort(np.mod(means[np.abs(means) < step], step))
    if inner.size == 0:
        return None
    gaps = np.diff(inner, append=inner[0] + step)
    middles = inner + 0.5 * gaps
    distance = np.abs(np.mod(middles, step) - 0.5 * step)
    end = np.mod(middles[np.argmax(gaps - 0.5 * distance)], step)
    chosen = np.flatnonzero((means > end - step) & (means <= end))
    return chosen if len(chosen) == count else None
