"""Eigenvalues of ``λ²M + λD + K`` with real matrices, by the companion form.

2k eigenvalues for matrices of size k: conjugate pairs and an even number of real ones. Copies of a
defective double eigenvalue (a free rigid motion) come out split by the root of the rounding error;
their mean is exact.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la

from exudyn_rotor.linear.periodic.companion import Companion
from exudyn_rotor.linear.periodic.periodic_system import EPSILON, ConstantSystems, times

# a double root of a defective eigenvalue splits by the root of the rounding error
_SPLIT = 4.0 * np.sqrt(EPSILON)
# estimated error of an eigenvector that needs no iteration
_CLEAR = 1e-10
# relative distance from an eigenvalue that keeps its matrix invertible
_OFF_ROOT = 1e-9
# 1 − MAC of the state vectors of two copies of a defective eigenvalue
_PARALLEL = 1e-4
_EQUAL = 1e-6  # relative difference of overdamped motions that are one in two directions
# share of the largest stiffness per mass that is none, and that rounding leaves
_NULL, _STILL_NULL = 1e-12, 1e-14

Solved = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def resolved(values: np.ndarray, errors: np.ndarray) -> np.ndarray:
    """Return eigenvalues with zero for those that rounding may have made of it."""
    return np.where(np.abs(values) <= errors, 0.0, values)


def resolution_of(values: np.ndarray) -> np.ndarray:
    """Return the size below which differences of eigenvalues (…, k) are round-off [1/s]."""
    return _SPLIT * np.abs(values).max(axis=-1, initial=0.0)


def quadratic_modes(
    M: np.ndarray,
    D: np.ndarray,
    K: np.ndarray,
    rounding: float = EPSILON,
    once: bool = False,
) -> Solved:
    """Return one eigenvalue of each pair of ``λ²M + λD + K``, with its vector, of each system.

    Parameters
    ----------
    M : ndarray, shape (k, k)
        Real, symmetric positive definite.
    D, K : ndarray, shape (s, k, k)
        Real, of each system.
    rounding : float, optional
        See :meth:`Companion.of`.
    once : bool, optional
        See :func:`less_damped`.

    Returns
    -------
    values : ndarray, shape (s, k)
        Ascending in |Im λ|: one of every conjugate pair (Im λ > 0), and half of the real ones, see
        :func:`less_damped`.
    vectors : ndarray, shape (s, k, k)
        Displacements, columns of unit length.
    resolutions : ndarray, shape (s,)
        Size below which differences of eigenvalues are round-off [1/s].
    bounds : ndarray, shape (s, k)
        By how much rounding can change the real parts [1/s].

    Raises
    ------
    ValueError
        If the mass matrix is not positive definite, or the eigenvalues are not finite.
    """
    if not len(M):
        return _no_modes(len(D))
    companion, size = Companion.of(M, D, K, rounding), len(M)
    found, states = companion.modes()
    errors, bounds = companion.errors
    resolutions = resolution_of(found)
    values = resolved(found, errors).astype(complex)
    for i in _with_copies(values, resolutions):
        values[i] = merged(values[i], states[i], resolutions[i])
    # those of a repeated real one part by rounding
    values = np.where(np.abs(values.imag) <= errors, values.real, values)
    chosen = _one_of_each_pair(less_damped(values, M, K, once), values, size)
    values, bounds = (np.take_along_axis(X, chosen, axis=1) for X in (values, bounds))
    vectors = np.take_along_axis(states[:, :size], chosen[:, None], axis=2)
    vectors /= np.linalg.norm(vectors, axis=1, keepdims=True)
    _iterate_doubtful(found, chosen, values, vectors, M, D, K)
    _set_free_motions(values == 0.0, vectors, M, D, K)
    return values, vectors, resolutions, bounds


def all_quadratic_modes(systems: ConstantSystems, shapes: bool = True) -> Solved:
    """Return what :func:`quadratic_modes` does, of all 2k eigenvalues, as they come.

    The systems share their mass matrix. Without `shapes` vectors may err by rounding.
    """
    M, D, K = systems.M[0], systems.D, systems.K
    if not len(M):
        return _no_modes(len(D))
    companion, size = Companion.of(M, D, K, systems.rounding), len(M)
    found, states = companion.modes()
    errors, bounds = companion.errors
    values = resolved(found, errors).astype(complex)
    vectors = states[:, :size] / np.linalg.norm(states[:, :size], axis=1, keepdims=True)
    if shapes:
        everyone = np.broadcast_to(np.arange(2 * size), values.shape)
        _iterate_doubtful(found, everyone, values, vectors, M, D, K)
    return values, vectors, resolution_of(found), bounds


def _no_modes(count: int) -> Solved:
    """Return what :func:`quadratic_modes` does of no coordinates."""
    none = np.zeros((count, 0))
    return none, np.zeros((count, 0, 0)), np.zeros(count), none


def _iterate_doubtful(
    found: np.ndarray,
    chosen: np.ndarray,
    values: np.ndarray,
    vectors: np.ndarray,
    M: np.ndarray,
    D: np.ndarray,
    K: np.ndarray,
) -> None:
    """Replace vectors (s, k, j) that may be wrong; see :func:`_errors_of_vectors`."""
    doubtful = _errors_of_vectors(found, chosen, vectors, M, D, K) > _CLEAR
    doubtful[values == 0.0] = False
    for i in np.flatnonzero(np.any(doubtful, axis=1)):
        rest = doubtful[i]
        given = values[i, rest], vectors[i][:, rest]
        vectors[i][:, rest] = inverse_iterated(*given, M, D[i], K[i])


def _set_free_motions(
    free: np.ndarray, vectors: np.ndarray, M: np.ndarray, D: np.ndarray, K: np.ndarray
) -> None:
    """Put :func:`free_motions` in the place of `vectors` (s, k, j) that are `free` (s, j).

    Those of one system are taken where as many are free in another, too.
    """
    left = np.count_nonzero(free, axis=1)
    while np.any(left > 1):
        i = np.argmax(left > 1)
        found = free_motions(M, K[i], vectors[i][:, free[i]], D[i])
        forces = np.linalg.norm(K @ found, axis=(1, 2))
        alike = forces <= _STILL_NULL * np.linalg.norm(K, axis=(1, 2))
        alike = (alike | (np.arange(len(K)) == i)) & (left == left[i])
        for place in np.flatnonzero(alike):
            vectors[place][:, free[place]] = found
        left[alike] = 0


def _errors_of_vectors(
    found: np.ndarray,
    chosen: np.ndarray,
    vectors: np.ndarray,
    M: np.ndarray,
    D: np.ndarray,
    K: np.ndarray,
) -> np.ndarray:
    """Return estimated relative errors of vectors (s, k, j), which are the `chosen` (s, j).

    The residual ``(λ²M + λD + K) x`` over that of a change of λ to the nearest other one that was
    `found` (s, 2k), or zero.
    """
    values = np.take_along_axis(found, chosen, axis=1)
    rates, inertia = values[:, None, :], times(M, vectors)
    residual = rates * (rates * inertia + times(D, vectors)) + times(K, vectors)
    apart = np.abs(values[:, :, None] - found[:, None, :])
    np.put_along_axis(apart, chosen[:, :, None], np.inf, axis=2)
    sizes = np.abs(values)
    moved = 2.0 * sizes * np.minimum(apart.min(axis=2), sizes) * np.linalg.norm(inertia, axis=1)
    return np.linalg.norm(residual, axis=1) / np.maximum(moved, 1e-300)


def free_motions(
    M: np.ndarray, K: np.ndarray, otherwise: np.ndarray, D: np.ndarray | None = None
) -> np.ndarray:
    """Return unit vectors of free motions, ``Kx = 0``; as many as, and else, those given.

    Copies of one free motion (a Jordan block at zero) would hide another. K is a matrix, or several
    that all have to vanish, shape (n, k, k). The damping D parts them, see :func:`_one_of_each`.
    """
    count = otherwise.shape[1]
    if count < 2:
        return otherwise
    _, lengths, rows = la.svd(_per_mass(M, K), full_matrices=False)
    if lengths[-count] > _NULL * lengths[0]:
        return otherwise
    root = _inverse_root(M)
    null = rows[np.count_nonzero(lengths > _NULL * lengths[0]) :].conj().T
    chosen = None if D is None else _one_of_each(null, root @ D @ root.T, count)
    vectors = root.T @ (null[:, -count:] if chosen is None else chosen)
    return vectors / np.linalg.norm(vectors, axis=0)


def _one_of_each(null: np.ndarray, D: np.ndarray, count: int) -> np.ndarray | None:
    """Return one of each pair of motions (k, count) that stand for all; None where that is unclear.

    A displacement that nothing resists has two zeros, but only one where Coriolis forces turn it,
    as at a critical speed, where two displacements are a wave and its conjugate.

    Parameters
    ----------
    null : ndarray, shape (k, n)
        Orthonormal displacements without force, per root of mass.
    D : ndarray, shape (k, k)
        Damping, likewise.
    count : int
    """
    coupling = null.T @ D @ null
    turning, waves = la.eigh(0.5j * (coupling - coupling.T))
    least = _NULL * np.abs(D).max(initial=0.0)
    if null.shape[1] - np.count_nonzero(turning > least) != count:
        return None
    return null @ waves[:, turning <= least]


def inverse_iterated(
    values: np.ndarray, vectors: np.ndarray, M: np.ndarray, D: np.ndarray, K: np.ndarray
) -> np.ndarray:
    """Return unit vectors after two inverse iterations.

    Next to stiff static modes, a free motion (a Jordan block at zero) mixes into the vectors of all
    slow modes by rounding; the eigenvalues do not suffer. It can leave so little of a mode that one
    iteration is not enough.
    """
    refined = np.array(vectors, dtype=complex)
    mass, size = M.astype(complex), len(M)
    terms = np.stack([M.T, D.T, K.T]).astype(complex).reshape(3, -1)
    # LAPACK itself: with so many small matrices scipy's checks would take longer than the solutions
    factorise, solve = la.get_lapack_funcs(("getrf", "getrs"), (refined,))
    for column, value in enumerate(values):
        if value != 0.0:
            shifted = value * (1.0 + _OFF_ROOT)
            dynamic = np.array([shifted**2, shifted, 1.0]) @ terms
            lu, pivots, zero_pivot = factorise(dynamic.reshape(size, size).T, overwrite_a=True)
            vector = refined[:, column]
            for _ in range(0 if zero_pivot else 2):
                vector, _ = solve(lu, pivots, mass @ vector)
                vector = vector / max(np.sqrt(np.vdot(vector, vector).real), 1e-300)
            refined[:, column] = vector
    return refined / np.maximum(np.linalg.norm(refined, axis=0), 1e-300)


def merged(values: np.ndarray, states: np.ndarray, resolution: float) -> np.ndarray:
    """Replace copies of a defective eigenvalue by their mean."""
    result = values.copy()
    for group in repeated(values, resolution):
        if not np.any(result[group]):
            continue
        overlap = np.abs(states[:, group].conj().T @ states[:, group]) ** 2
        copies = overlap[0] > 1.0 - _PARALLEL
        if np.count_nonzero(copies) > 1:
            result[group[copies]] = values[group[copies]].mean()
    return result


def _with_copies(values: np.ndarray, resolutions: np.ndarray) -> np.ndarray:
    """Return which rows of values (s, j) may have copies of one that is not zero."""
    order = np.argsort(values.imag, axis=1)
    ascending = np.take_along_axis(values, order, axis=1)
    near = np.diff(ascending.imag, axis=1) <= resolutions[:, None]
    moving = ascending != 0.0
    return np.flatnonzero(np.any(near & (moving[:, 1:] | moving[:, :-1]), axis=1))


def repeated(values: np.ndarray, resolution: float) -> list[np.ndarray]:
    """Return the indices of values that `resolution` does not tell apart, group by group."""
    order = np.argsort(values.imag, kind="stable")
    ascending = values.imag[order]
    near = np.zeros(len(order) + 1, dtype=bool)
    near[1:-1] = ascending[1:] - ascending[:-1] <= resolution
    edges = np.flatnonzero(near[1:] != near[:-1])
    result = []
    for first, last in edges.reshape(-1, 2):
        left = order[first : last + 1]
        while left.size > 1:
            alike = np.abs(values[left] - values[left[0]]) <= resolution
            if np.count_nonzero(alike) > 1:
                result.append(left[alike])
            left = left[~alike]
    return result


def less_damped(values: np.ndarray, M: np.ndarray, K: np.ndarray, once: bool = False) -> np.ndarray:
    """Return by what real eigenvalues are ranked, (s, 2k), of which the upper half is kept.

    By their real part; but a free motion, which has two zeros where nothing damps it, counts once,
    and so does, if `once`, an overdamped one that is the same in two directions, as it does in axes
    that turn: the second of each is −∞ where it would take the place of others. K is (s, k, k), or
    of each system several (n, k, k) that all have to vanish.
    """
    ranks = values.real.copy()
    overdamped = (values.imag == 0.0) & (ranks < 0.0)
    for i in np.flatnonzero(np.any(overdamped, axis=1)):
        zeros = np.flatnonzero(values[i] == 0.0)
        if zeros.size:
            kept = max(_free_count(M, K[i], len(zeros)), (len(zeros) + 1) // 2)
            ranks[i, zeros[kept:]] = -np.inf
            zeros = zeros[:kept]
        if not once:
            continue
        left = np.flatnonzero(overdamped[i])
        left = left[np.argsort(-ranks[i, left], kind="stable")]
        count = np.count_nonzero(values[i].imag == 0.0) // 2
        count -= len(zeros) + np.count_nonzero((values[i].imag == 0.0) & (ranks[i] > 0.0))
        ranks[i, np.setdiff1d(left, left[_once(ranks[i, left])][: max(count, 0)])] = -np.inf
    return ranks


def _once(values: np.ndarray) -> np.ndarray:
    """Return the order of descending values in which one of two equal ones comes first."""
    first, single, second, at = [], [], [], 0
    while at < len(values):
        pair = at + 1 < len(values) and values[at] - values[at + 1] <= -_EQUAL * values[at]
        (first if pair else single).append(at)
        if pair:
            second.append(at + 1)
        at += 1 + pair
    return np.array([*first, *single, *second], dtype=int)


def _free_count(M: np.ndarray, K: np.ndarray, most: int) -> int:
    """Return the number of free motions, ``Kx = 0``, up to `most`."""
    lengths = la.svd(_per_mass(M, K), compute_uv=False)
    return int(np.count_nonzero(lengths[-most:] <= _NULL * lengths[0]))


def _per_mass(M: np.ndarray, K: np.ndarray) -> np.ndarray:
    """Return ``L⁻¹KL⁻ᵀ`` of matrices K (n, k, k) or one, below each other, with ``M = LLᵀ``."""
    inverse = _inverse_root(M)
    return (inverse @ np.reshape(K, (-1, *M.shape)) @ inverse.T).reshape(-1, len(M))


def _inverse_root(M: np.ndarray) -> np.ndarray:
    return la.solve_triangular(la.cholesky(M, lower=True), np.eye(len(M)), lower=True)


def _one_of_each_pair(ranks: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    """Return the indices (s, count) of values (s, 2k) that stand for all, ascending in |Im λ|.

    Raises
    ------
    ValueError
        If the values are not conjugate pairs and an even number of real ones.
    """
    real = values.imag == 0.0
    places = np.argsort(np.lexsort((-ranks, ~real)), axis=1)  # real ones first, descending
    chosen = (values.imag > 0.0) | (places < real.sum(axis=1, keepdims=True) // 2)
    counts = np.where(np.isfinite(values).all(axis=1), chosen.sum(axis=1), 0)
    wrong = counts[counts != count]
    if wrong.size:
        raise ValueError(
            f"{wrong[0]} pairs of eigenvalues were found where there are {count}; the matrices may "
            "be badly scaled: check the units"
        )
    order = np.lexsort((values.real, values.imag))
    return order[np.take_along_axis(chosen, order, axis=1)].reshape(len(values), count)
