"""Hill's method: a periodic system as a constant one for the harmonics of its solution.

With ``x(t) = exp(λt) Σ_m X_m exp(i m Ω t)`` the equations of :class:`PeriodicSystem` become, for
every harmonic n,

    Σ_m [(λ + imΩ)² M_{n−m} + (λ + imΩ) D_{n−m} + K_{n−m}] X_m = F_n

which is a constant quadratic problem in λ, cut off at |m| ≤ N. Each exponent λ returns in copies
``λ + i n pΩ`` with shifted harmonics, p the step of the coefficients' harmonics; who asks chooses
among them. Harmonics are added until those left out, excited by a chosen motion, would shift its λ
by less than a tolerance. Source: Hill, "On the part of the motion of the lunar perigee …", Acta
Math. 8 (1886).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from exudyn_rotor.linear.periodic.companion import Companion
from exudyn_rotor.linear.periodic.eigenvalues import resolution_of, resolved
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, Terms, UnconvergedError

MOST_UNKNOWNS = 1600  # in first-order form


def hill_matrices(
    system: PeriodicSystem, orders: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return (M, D, K) of ``(λ²M + λD + K) X = F`` for the harmonics `orders`.

    Shape (h k, h k), complex, harmonic by harmonic in the order given.
    """
    if len(orders) == 1 and orders[0] == 0:
        return tuple(terms[0].astype(complex) for terms in (system.M, system.D, system.K))
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


@dataclass(frozen=True, eq=False)
class HillSolution:
    """Motions ``exp(λt) Σ_m X_m exp(i m Ω t)`` of one truncation.

    Attributes
    ----------
    values : ndarray, shape (j,)
        λ [1/s].
    shapes : ndarray, shape (h, c, j)
        Harmonics X_m.
    states : ndarray, shape (2 h c, j)
        The same as vectors of the companion form in cosine and sine terms, of unit length.
    orders : ndarray of int, shape (h,)
    resolution : float
        Eigenvalues closer than this cannot be told apart [1/s].
    bounds : ndarray, shape (j,)
        By how much rounding can change the real parts [1/s].
    """

    values: np.ndarray
    shapes: np.ndarray
    states: np.ndarray
    orders: np.ndarray
    resolution: float
    bounds: np.ndarray


@dataclass(frozen=True, eq=False)
class Chosen:
    """Motions chosen from a :class:`HillSolution`.

    Attributes
    ----------
    columns : ndarray of int, shape (j,)
        Where they stand there.
    values, shapes : ndarray, shapes (j,), (h, c, j)
        λ and harmonics, which may be better than those of the solution where copies coincide.
    sizes : ndarray, shape (j,)
        What the error of each λ is relative to [1/s].
    bounds : ndarray, shape (j,), optional
        By how much rounding and the harmonics left out can change the real parts [1/s].
    """

    columns: np.ndarray
    values: np.ndarray
    shapes: np.ndarray
    sizes: np.ndarray
    bounds: np.ndarray | None = None


Choice = Callable[[HillSolution], Chosen | None]


def solve_hill(
    system: PeriodicSystem, choose: Choice, tolerance: float
) -> tuple[Chosen, HillSolution, float]:
    """Return motions of a truncation that is large enough for them, and their largest error.

    Parameters
    ----------
    system : PeriodicSystem
        With periodic coefficients, at a speed that is not zero.
    choose : callable
        Chooses from the motions of a truncation; None where it is too small to tell.
    tolerance : float
        Largest error of a λ, relative to :attr:`Chosen.sizes`.

    Raises
    ------
    UnconvergedError
        If that takes more than 1600 unknowns.
    """
    step = system.step
    order, error, last = 2 * step, np.inf, 0
    while True:
        orders = system.harmonics(order)
        if 2 * len(orders) * system.size > MOST_UNKNOWNS and order > 2 * step:
            raise UnconvergedError(
                f"Hill's method at {system.speed:g} rad/s: error {error:.1e} with harmonics up to "
                f"{last}, more than the tolerance {tolerance:.1e}: the speed is small against the "
                "frequencies that turning coefficients split; use a larger speed (or 0), or fewer "
                "high modes"
            )
        companion, solution = _solved(system, orders)
        chosen = choose(solution)
        if chosen is not None:
            shifts = _shifts(system, companion, solution, chosen.columns)
            error = float(np.max(np.abs(shifts) / chosen.sizes, initial=0.0))
            if error <= tolerance:
                bounds = solution.bounds[chosen.columns] + np.abs(shifts)
                return replace(chosen, bounds=bounds), solution, error
        last, order = order, order + step * max(1, order // (2 * step))


def _solved(system: PeriodicSystem, orders: np.ndarray) -> tuple[Companion, HillSolution]:
    """Return all motions of one truncation."""
    u = _real_basis(len(orders))
    matrices = (_turned(X, u) for X in hill_matrices(system, orders))
    companion = Companion.of(*matrices, system.rounding)
    values, states = companion.modes()
    errors, bounds = companion.errors
    half = len(states) // 2
    shapes = np.einsum("nh,nkj->hkj", u.conj(), states[:half].reshape(len(orders), -1, 2 * half))
    resolution, values = resolution_of(values), resolved(values, errors)
    return companion, HillSolution(values, shapes, states, orders, resolution, bounds)


def _real_basis(count: int) -> np.ndarray:
    """Return the unitary matrix from harmonics −N … N to cosine and sine terms.

    In these Hill's matrices are real, which is three times faster to solve.
    """
    middle = count // 2
    u = np.zeros((count, count), dtype=complex)
    u[middle, middle] = 1.0
    for n in range(1, middle + 1):
        u[middle + n, [middle + n, middle - n]] = np.sqrt(0.5)
        u[middle - n, [middle + n, middle - n]] = -1j * np.sqrt(0.5), 1j * np.sqrt(0.5)
    return u


def _turned(matrix: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Return a matrix of harmonics in cosine and sine terms."""
    count, size = len(u), len(matrix) // len(u)
    blocks = matrix.reshape(count, size, count, size)
    turned = np.tensordot(u, np.tensordot(blocks, u.conj(), (2, 1)), (1, 0))  # n, a, b, m
    return turned.transpose(0, 1, 3, 2).reshape(matrix.shape).real


def _shifts(
    system: PeriodicSystem, companion: Companion, solution: HillSolution, columns: np.ndarray
) -> np.ndarray:
    """Return by how much the first harmonics left out would shift some λ [1/s]."""
    feedback = _feedback(
        system, solution.values[columns], solution.shapes[:, :, columns], solution.orders
    )
    u = _real_basis(len(solution.orders))
    load = np.einsum("nh,hkj->nkj", u, feedback).reshape(-1, len(columns))
    return companion.shifts(load, columns)


def _feedback(
    system: PeriodicSystem, values: np.ndarray, shapes: np.ndarray, orders: np.ndarray
) -> np.ndarray:
    """Return what the first harmonics left out, once excited, do to those kept; as `shapes`."""
    highest, result = orders[-1], np.zeros_like(shapes)
    terms = (system.M, system.D, system.K)
    reach = range(highest + 1, highest + system.order + 1)
    for n in [*reach, *(-m for m in reach)]:
        links = {m: _links(terms, n - orders[m]) for m in range(len(orders))}
        excited = 0.0
        for m, (M, D, K) in ((m, link) for m, link in links.items() if link is not None):
            excited = excited + _applied(M, D, K, values + 1j * orders[m] * system.speed, shapes[m])
        if np.ndim(excited) == 0:
            continue
        rate = (values + 1j * n * system.speed)[:, None, None]
        dynamic = rate**2 * system.M[0] + rate * system.D[0] + system.K[0]
        answer = -np.linalg.solve(dynamic, excited.T[:, :, None])[:, :, 0].T
        for m in range(len(orders)):
            back = _links(terms, orders[m] - n)
            if back is not None:
                result[m] += _applied(*back, values + 1j * n * system.speed, answer)
    return result


def _links(terms: tuple, n: int) -> tuple | None:
    """Return the Fourier terms n of M, D, K; None where there is none."""
    entries = [X.get(int(n)) for X in terms]
    if all(X is None for X in entries):
        return None
    return tuple(0.0 if X is None else X for X in entries)


def _applied(
    M: np.ndarray, D: np.ndarray, K: np.ndarray, rate: np.ndarray, shape: np.ndarray
) -> np.ndarray:
    """Return ``(λ²M + λD + K) X`` column by column; absent matrices are 0.0."""
    parts = ((M, shape * rate**2), (D, shape * rate), (K, shape))
    return sum(X @ column for X, column in parts if np.ndim(X))
