"""Motions of exponents that are nearly one, as what they span together.

Where exponents are one but for multiples of the base, an eigenvalue problem may give one motion
twice, and ``t exp(λt) p`` beside ``exp(λt) p`` not at all. What it cannot part it still tells
together: with columns Z of states that span all of these motions, ``Ż = A Z − Z T``, T upper
triangular with the exponents on its diagonal. In harmonics that is an invariant subspace of Hill's
equations, by inverse iteration of all its columns at once. Source: Golub, Van Loan, Matrix
Computations (2013), Sect. 7.3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
from scipy.optimize import linear_sum_assignment

from exudyn_rotor.linear.periodic.harmonics import hill_matrices, in_basis, real_basis, shifted
from exudyn_rotor.linear.periodic.hill_motions import HillMotions
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem

# relative distance of exponents that may share their motion
_SAME = 1e-6
# length of what is left of a motion, over the largest, below which it is none of its own
_DEPENDENT = 1e-3
_MOST = 0.9  # of a motion: what a copy has to have of it to be compared
_WIDER = 10.0  # times the distance of exponents from each other: that of the shift from them
# steps of inverse iteration, which end where columns turn by less, and not less from step to step
_STEPS, _STILL, _SLOWER = 30, 1e-10, 0.7


@dataclass(frozen=True, eq=False)
class SharedMotions:
    """What some motions span together.

    Attributes
    ----------
    columns : ndarray of int, shape (m,)
        Which motions.
    shapes, speeds : ndarray, shape (h, k, m)
        Harmonics of x and ẋ.
    T : ndarray, shape (m, m)
        Upper triangular; of real exponents real, and but for blocks of two.
    moved : ndarray, shape (m,)
        Its diagonal less the exponents, modulo ipΩ.
    """

    columns: np.ndarray
    shapes: np.ndarray
    speeds: np.ndarray
    T: np.ndarray
    moved: np.ndarray


def shared_motions(system: PeriodicSystem, found: HillMotions) -> list[SharedMotions]:
    """Return those of motions that are nearly dependent."""
    shapes = found.shapes / np.linalg.norm(found.shapes, axis=(0, 1))
    near = max(found.resolution, _SAME * abs(system.speed))
    apart = found.values[:, None] - found.values
    apart = apart - 1j * system.base * np.rint(apart.imag / system.base)
    result, left = [], np.flatnonzero(np.count_nonzero(np.abs(apart) <= near, axis=1) > 1)
    while left.size:
        first = left[0]
        apart = found.values[left] - found.values[first]
        steps = np.rint(apart.imag / system.base).astype(int)
        alike = np.flatnonzero(np.abs(apart - 1j * steps * system.base) <= near)
        if alike.size < 2:
            left = left[1:]
            continue
        copies = np.stack([shifted(shapes[:, :, left[i]], -steps[i]) for i in alike], axis=-1)
        # an exponent may be a copy by chance, many harmonics away: that is another motion
        kept = np.linalg.norm(copies, axis=(0, 1)) > _MOST
        group, copies = left[alike[kept]], copies[..., kept]
        values = found.values[group] - 1j * steps[alike[kept]] * system.base
        left = np.delete(left, alike[kept])
        least = min(_WIDER * near, 0.5 * abs(system.speed))
        inside = _dependent(values, copies, least)
        if inside.size:
            given = values[inside], copies[..., inside], found.bounds[group[inside]]
            result.append(_together(system, found.orders, group[inside], *given, least))
    return [each for each in result if each is not None]


def _dependent(values: np.ndarray, copies: np.ndarray, least: float) -> np.ndarray:
    """Return which motions (h, k, j) depend on each other, with all that are near these."""
    flat = copies.reshape(-1, len(values))
    _, sizes, shares = np.linalg.svd(flat, full_matrices=False)
    small = sizes <= _DEPENDENT * sizes[0]
    mixed = np.any(np.abs(shares[small]) > _DEPENDENT, axis=0)
    if np.count_nonzero(mixed) < 2:
        return np.zeros(0, dtype=int)
    center = values[mixed].mean()
    reach = _away(values[mixed], least)
    return np.flatnonzero(mixed | (np.abs(values - center) <= reach))


def _away(values: np.ndarray, least: float) -> float:
    return max(least, _WIDER * np.abs(values - values.mean()).max())


def _together(
    system: PeriodicSystem,
    orders: np.ndarray,
    columns: np.ndarray,
    values: np.ndarray,
    copies: np.ndarray,
    bounds: np.ndarray,
    least: float,
) -> SharedMotions | None:
    """Return what motions with λ (m,) and harmonics (h, k, m) span; None where that fails."""
    count, speed = len(columns), abs(system.speed)
    shift = values.mean() + _away(values, least)
    real = not np.any(values.imag)
    if real:  # then motions are, but for a factor, and so are Hill's equations in a real basis
        few = _not_zero(orders, copies, system.order)
        cut = np.flatnonzero(few)[0]
        orders, basis = orders[few], real_basis(np.count_nonzero(few))
        M, D, K = in_basis(np.stack(hill_matrices(system, orders)), basis)
        values, shift = values.real, shift.real
        copies = np.tensordot(basis, copies[few], 1)
        twice = np.sum(copies**2, axis=(0, 1))
        copies = (copies * np.exp(-0.5j * np.angle(twice))).real
    else:
        M, D, K = hill_matrices(system, orders)
    scale = max(abs(shift), speed)
    x = copies.reshape(-1, count)
    rng = np.random.default_rng(0)  # what is missing has a share of it
    Z = np.concatenate([x, x * values / scale]) + 1e-3 * rng.normal(size=(2 * len(x), count))
    Q, turned = np.linalg.qr(Z)[0], np.inf
    # LAPACK itself: scipy's checks take longer
    factorise, solve = la.get_lapack_funcs(("getrf", "getrs"), (Z,))
    try:
        lu, pivots, singular = factorise(shift**2 * M + shift * D + K)
        if singular:
            return None
        for _ in range(_STEPS):
            x, w = Q[: len(x)], scale * Q[len(x) :]
            larger, _ = solve(lu, pivots, M @ (w + shift * x) + D @ x)
            last, (Q, R) = Q, np.linalg.qr(np.concatenate([larger, (shift * larger - x) / scale]))
            before, turned = turned, np.linalg.norm(Q - last @ (last.conj().T @ Q))
            if _SLOWER * before < turned <= _STILL:  # rounding is left
                break
        T = shift * np.eye(count) - Q.conj().T @ last @ np.linalg.inv(R)
        T, turn = la.schur(T, output="real" if real else "complex")
    except (np.linalg.LinAlgError, ValueError):
        return None
    Q = Q @ turn
    order = _owners(np.diagonal(T), values, bounds + _SAME * speed)
    x, w = (X.reshape(len(orders), system.size, count) for X in np.split(Q, 2))
    if real:
        x, w = (np.tensordot(basis.conj().T, X, 1) for X in (x, w))
    speeds = scale * w + 1j * system.speed * orders[:, None, None] * x
    if real:
        x, speeds = (np.pad(X, ((cut, cut), (0, 0), (0, 0))) for X in (x, speeds))
    return SharedMotions(columns[order], x, speeds, T, np.diagonal(T) - values[order])


def _not_zero(orders: np.ndarray, shapes: np.ndarray, more: int) -> np.ndarray:
    """Return which harmonics motions (h, k, m) have, and `more` on both sides."""
    sizes = np.linalg.norm(shapes, axis=(1, 2))
    return np.abs(orders) <= np.abs(orders[sizes > _STILL * sizes.max()]).max() + more


def _owners(exponents: np.ndarray, values: np.ndarray, told: np.ndarray) -> np.ndarray:
    """Return which of λ in `values`, each `told` to so much, each of `exponents` is."""
    apart = np.abs(exponents - values[:, None])
    return np.argsort(linear_sum_assignment(apart / told[:, None])[1])
