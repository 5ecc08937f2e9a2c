"""First bound of what :mod:`.remainder` tells, for a small part of its time.

With a motion ``p`` and its conjugate, half of the columns of F tell all, and P is real in ``Re p``
and ``Im p``. The rest F₂ that the change of coordinates I + G leaves is not computed but bounded,
entry by entry: with ``f ≥ |F|`` and ``g ≥ |G|`` over a period, the change μ of the exponents and
what is left to the rest ``l``,

    F₂ = (I + G)⁻¹ (F G − G diag μ + L),    |F₂| ≤ (I − g)⁻¹ (f g + g diag |μ| + l)

where the spectral radius of g is below 1, so that I − g is an M-matrix; source: Horn, Johnson,
Topics in Matrix Analysis (1991), Sect. 2.5. A bound that is not small says nothing.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.linalg as la

from exudyn_rotor.linear.periodic.fundamental import accelerations, sampled
from exudyn_rotor.linear.periodic.hill_motions import HillMotions
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem
from exudyn_rotor.linear.periodic.shared_motions import SharedMotions

# share of the radii allowed that is enough
ENOUGH = 0.05
# share of a divisor from which on a harmonic of F is left to the rest
_NEAR = 0.3
_FINER = 2  # angles for each that the harmonics need
# shares of the largest entry that keep weights from zero, and factors of balancing within 1e12
_LEAST, _LEAST_BALANCED = 1e-16, 1e-24


def angles_of(system: PeriodicSystem, orders: np.ndarray) -> np.ndarray:
    """Return the angles of one period at which motions with the harmonics `orders` are seen."""
    reach = (int(orders[-1]) + system.order) // system.step
    count = _FINER * (2 * reach + 1) + 1
    return 2.0 * np.pi / (system.step * count) * np.arange(count)


def largest_share(f: np.ndarray, radii: np.ndarray) -> tuple[float, np.ndarray]:
    """Return the largest eigenvalue of ``f_ij/r_i`` with f ≥ 0, and its vector."""
    relative = f / radii[:, None]
    relative, scales = la.matrix_balance(
        relative + _LEAST_BALANCED * relative.max(), permute=False, separate=True
    )
    roots, vectors = np.linalg.eig(relative + _LEAST * relative.max(initial=_LEAST))
    largest = np.argmax(roots.real)
    # rounding leaves nothing of motions that are not coupled to those of this root
    sizes = np.maximum(np.abs(vectors[:, largest]), _LEAST)
    return float(roots[largest].real), scales[0] * sizes


def left_to_rest(harmonics: np.ndarray, divisors: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """Return which harmonics no change of coordinates takes away.

    Those that are not small beside their divisor, or whose exponents are one within what is enough.

    Parameters
    ----------
    harmonics, divisors : ndarray, shape (n, i, j)
    radii : ndarray, shape (i, j)
        The smaller ones of those allowed.
    """
    sizes = np.abs(divisors)
    return (np.abs(harmonics) >= _NEAR * sizes) | (sizes <= ENOUGH * radii)


def first_bound(
    system: PeriodicSystem,
    found: HillMotions,
    pairs: tuple[np.ndarray, np.ndarray],
    groups: Sequence[SharedMotions],
    allowed: np.ndarray,
) -> float:
    """Return which share of the radii allowed is enough; infinite where that is not told.

    That is where not all motions are real or in conjugate pairs.

    Parameters
    ----------
    system : PeriodicSystem
    found : HillMotions
        All 2k motions.
    pairs : tuple of ndarray of int
        Where motions are, and their conjugates.
    groups : sequence of SharedMotions
        Motions that are given by what they span together.
    allowed : ndarray, shape (2k,)
        Radii [1/s].
    """
    first, second = pairs
    together = np.zeros(len(found.values), dtype=bool)
    for group in groups:
        together[group.columns] = True
    if not all(np.isrealobj(group.T) for group in groups):
        return np.inf
    apart = ~together[first]
    if np.any(together[second] == apart):  # one of a pair without the other
        return np.inf
    own = np.ones(len(found.values), dtype=bool)
    own[first[apart]] = own[second[apart]] = False
    if np.any(np.abs(found.values[own].imag) > ENOUGH * allowed[own]):
        return np.inf
    own, first, second = np.flatnonzero(own), first[apart], second[apart]
    values, F, moved = _remainder(system, found, np.append(own, first), len(own), groups)
    if not np.all(np.isfinite(F)):
        return np.inf
    order = np.concatenate([own, first, second])
    return _share(values, F, moved, allowed[order], system.base)


def _remainder(
    system: PeriodicSystem,
    found: HillMotions,
    columns: np.ndarray,
    count: int,
    groups: Sequence[SharedMotions],
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return all λ, columns of F without those of conjugates, and by how much λ differ already.

    Of `columns` the first `count` are real. Rows: all motions, the conjugates last.
    """
    rates = 1j * system.speed * found.orders[:, None, None]
    shapes = found.shapes[..., columns]
    shapes[..., :count] = _real(shapes[..., :count])
    values, moved = found.values[columns], np.zeros(len(columns), dtype=complex)
    moved[:count].imag = -values[:count].imag
    values[:count] = values[:count].real
    speeds = (values + rates) * shapes
    turns = (values + rates) * speeds
    T = np.diag(values)
    slips = np.zeros((*shapes.shape[:-1], count), dtype=complex)  # others have ẋ as speed
    for group in groups:
        # where they are among the real ones
        at = np.searchsorted(columns[:count], group.columns)
        shapes[..., at], speeds[..., at], moved[at] = group.shapes, group.speeds, group.moved
        T[np.ix_(at, at)] = group.T
        slips[..., at] = rates * group.shapes + group.shapes @ group.T - group.speeds
        turns[..., at] = rates * group.speeds + group.speeds @ group.T
    angles = angles_of(system, found.orders)
    waves = np.exp(1j * angles[:, None] * found.orders)

    def seen(X: np.ndarray) -> np.ndarray:
        """Return real motions (n, k, j) of harmonics X."""
        at = (waves @ X.reshape(len(X), -1)).reshape(len(angles), *X.shape[1:])
        return np.concatenate([at.real, at[..., count:].imag], axis=-1)

    x, v, forced = (seen(X) for X in (shapes, speeds, turns))
    slip = np.zeros_like(x)
    slip[..., :count] = seen(slips)
    M, D, K = sampled(system, angles)
    forced += accelerations(system, M, D @ v + K @ x)
    scale = max(np.abs(found.values).max(), abs(system.speed))
    P = np.concatenate([x, v / scale], axis=1)
    try:
        rest = np.linalg.solve(P, -np.concatenate([slip, forced / scale], axis=1))
    except np.linalg.LinAlgError:
        rest = np.full_like(P, np.nan)  # no shares of motions: told by the caller
    half = slice(count, len(columns))
    F = rest[..., : len(columns)].astype(complex)
    F[..., half] += 1j * rest[..., len(columns) :]
    real, imaginary = F[:, half].copy(), F[:, len(columns) :].copy()
    F[:, half] = 0.5 * (real - 1j * imaginary)
    F[:, len(columns) :] = 0.5 * (real + 1j * imaginary)
    diagonal = np.diagonal(T)
    F[:, : len(columns)] += T - np.diag(diagonal)
    return np.append(diagonal, diagonal[half].conj()), F, moved


def _real(shapes: np.ndarray) -> np.ndarray:
    """Return harmonics (h, k, j) of motions that are real but for a factor without that."""
    twice = np.sum(shapes * shapes[::-1], axis=(0, 1))
    shapes = shapes * np.exp(-0.5j * np.angle(twice))
    return 0.5 * (shapes + shapes[::-1].conj())


def _share(
    values: np.ndarray, F: np.ndarray, moved: np.ndarray, allowed: np.ndarray, base: float
) -> float:
    """Return what :func:`first_bound` does, of columns of F (n, 2k, j)."""
    n, size, some = F.shape
    count = 2 * some - size
    radii = allowed[:some]

    def with_conjugates(X: np.ndarray) -> np.ndarray:
        """Rows and columns of both, as what is the same of a motion and of its conjugate."""
        swapped = np.concatenate([X[:count], X[some:]])
        swapped[:, :count] = 0.0
        return X[:some] + swapped

    f = with_conjugates(np.abs(F).max(axis=0))
    weights = largest_share(f, radii)[1]
    harmonics = np.fft.fft(F, axis=0) / n
    places = np.arange(some)
    mean = harmonics[0, places, places]
    harmonics[0, places, places] = 0.0
    rates = 1j * base * np.fft.fftfreq(n, 1.0 / n)[:, None, None]
    divisors = np.abs(rates + (values[:some] - values[:, None]))
    every = np.append(weights, weights[count:])
    sizes = np.abs(harmonics)
    both = np.minimum(radii, np.append(radii, radii[count:])[:, None])
    kept = left_to_rest(sizes * (weights / every[:, None]), divisors, both)
    divisors[kept] = np.inf
    g = with_conjugates(np.sum(sizes / divisors, axis=0))
    left = with_conjugates(np.sum(np.where(kept, sizes, 0.0), axis=0))
    rest = f @ g + g * np.abs(mean) + left
    changed = np.abs(moved + mean) / radii
    try:
        solved = np.linalg.solve(np.eye(some) - g, np.column_stack([np.ones(some), rest]))
    except np.linalg.LinAlgError:
        return np.inf
    if not np.all(solved[:, 0] > 0.0):  # the spectral radius of g is not below 1
        return np.inf
    share, _ = largest_share(np.maximum(solved[:, 1:], 0.0), radii)
    return share + float(changed.max())
