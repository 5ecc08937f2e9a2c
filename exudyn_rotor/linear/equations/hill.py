"""Hill's method: a periodic system as a constant one for the harmonics of its solution.

With ``x(t) = exp(λt) Σ_m X_m exp(i m Ω t)`` the equations of :class:`PeriodicSystem` become, for
every harmonic n,

    Σ_m [(λ + imΩ)² M_{n−m} + (λ + imΩ) D_{n−m} + K_{n−m}] X_m = F_n

which is a constant quadratic problem in λ, cut off at |m| ≤ N. Source: Hill, "On the part of the
motion of the lunar perigee …", Acta Math. 8 (1886).
"""

from __future__ import annotations

from math import gcd

import numpy as np

from exudyn_rotor.linear.equations.system import PeriodicSystem, Terms


def harmonic_step(system: PeriodicSystem) -> int:
    """Return the common step p of the coefficients' harmonics: 2 for anisotropic supports.

    The coefficients repeat p times a revolution; 0 for a constant system.
    """
    return gcd(*(n for terms in (system.M, system.D, system.K) for n in terms))


def harmonics(system: PeriodicSystem, order: int) -> np.ndarray:
    """Return the harmonics −N … N that are coupled with 0, shape (2N/p + 1,).

    p is :func:`harmonic_step`.
    """
    step = harmonic_step(system)
    if step == 0:
        return np.array([0])
    highest = step * (order // step)
    return np.arange(-highest, highest + 1, step)


def hill_matrices(
    system: PeriodicSystem, orders: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return (M, D, K) of ``(λ²M + λD + K) X = F`` for the harmonics `orders`.

    Shape (h k, h k), complex, harmonic by harmonic in the order given.
    """
    M, D, K = (_blocks(terms, orders, system.size) for terms in (system.M, system.D, system.K))
    rate = np.repeat(1j * orders * system.speed, system.size)
    return M, D + 2.0 * M * rate, K + D * rate + M * rate**2


def _blocks(terms: Terms, orders: np.ndarray, size: int) -> np.ndarray:
    """Return the block matrix with ``terms[n − m]`` at row n, column m."""
    blocks = np.zeros((len(orders), size, len(orders), size), dtype=complex)
    for i, n in enumerate(orders):
        for j, m in enumerate(orders):
            term = terms.get(int(n - m))
            if term is not None:
                blocks[i, :, j, :] = term
    return blocks.reshape(len(orders) * size, -1)
