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
# share of the largest stiffness per mass that is none, and that rounding leaves
_NULL, _STILL_NULL = 1e-12, 1e-14


def resolved(values: np.ndarray, errors: np.ndarray) -> np.ndarray:
    """Return eigenvalues with zero for those that rounding may have made of it."""
    return np.where(np.abs(values) <= errors, 0.0, values)


def resolution_of(values: np.ndarray) -> np.ndarray:
    """Return the size below which differences of eigenvalues (…, k) are round-off [1/s]."""
    return _SPLIT * np.abs(values).max(axis=-1, initial=0.0)


def quadratic_modes(
    M: np.ndarray, D: np.ndarray, K: np.ndarray, rounding: float = EPSILON
) -> list[tuple[np.ndarray, np.ndarray, float, np.ndarray]]:
    """Return one eigenvalue of each pair of ``λ²M + λD + K``, with its vector, system by system.

    Parameters
    ----------
    M : ndarray, shape (k, k)
        Real, symmetric positive definite.
    D, K : ndarray, shape (s, k, k)
        Real, of each system.
    rounding : float, optional
        See :meth:`Companion.of`.

    Returns
    -------
    list of tuples
        values (k,), ascending in |Im λ|: one of every conjugate pair (Im λ > 0), and of the real
        ones the less damped half; vectors (k, k), displacements, columns of unit length; the size
        below which differences of eigenvalues are round-off [1/s]; and bounds (k,), by how much
        rounding can change the real parts [1/s].

    Raises
    ------
    ValueError
        If the mass matrix is not positive definite, or the eigenvalues are not finite.
    """
    companion, size = Companion.of(M, D, K, rounding), len(M)
    found, states = companion.modes()
    errors, bounds = companion.errors
    resolutions = resolution_of(found)
    parts = zip(resolved(found, errors), states, resolutions, strict=True)
    values = np.array([merged(*each) for each in parts])
    chosen = _one_of_each_pair(values, size)
    values, bounds = (np.take_along_axis(X, chosen, axis=1) for X in (values, bounds))
    vectors = np.take_along_axis(states[:, :size], chosen[:, None], axis=2)
    vectors /= np.linalg.norm(vectors, axis=1, keepdims=True)
    _iterate_doubtful(found, chosen, values, vectors, M, D, K)
    _set_free_motions(values == 0.0, vectors, M, K)
    return list(zip(values, vectors, resolutions, bounds, strict=True))


def all_quadratic_modes(
    systems: ConstantSystems, shapes: bool = True
) -> list[tuple[np.ndarray, np.ndarray, float, np.ndarray]]:
    """Return what :func:`quadratic_modes` does, of all 2k eigenvalues, as they come.

    The systems share their mass matrix. Without `shapes` vectors may err by rounding.
    """
    M, D, K = systems.M[0], systems.D, systems.K
    companion, size = Companion.of(M, D, K, systems.rounding), len(M)
    found, states = companion.modes()
    errors, bounds = companion.errors
    values = resolved(found, errors).astype(complex)
    vectors = states[:, :size] / np.linalg.norm(states[:, :size], axis=1, keepdims=True)
    if shapes:
        everyone = np.broadcast_to(np.arange(2 * size), values.shape)
        _iterate_doubtful(found, everyone, values, vectors, M, D, K)
    return list(zip(values, vectors, resolution_of(found), bounds, strict=True))


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


def _set_free_motions(free: np.ndarray, vectors: np.ndarray, M: np.ndarray, K: np.ndarray) -> None:
    """Put :func:`free_motions` in the place of `vectors` (s, k, j) that are `free` (s, j).

    Those of one system are taken where as many are free in another, too.
    """
    left = np.count_nonzero(free, axis=1)
    while np.any(left > 1):
        i = np.argmax(left > 1)
        found = free_motions(M, K[i], vectors[i][:, free[i]])
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


def free_motions(M: np.ndarray, K: np.ndarray, otherwise: np.ndarray) -> np.ndarray:
    """Return unit vectors of free motions, ``Kx = 0``; as many as, and else, those given.

    Copies of one free motion (a Jordan block at zero) would hide another. K is a matrix, or several
    that all have to vanish, shape (n, k, k).
    """
    count = otherwise.shape[1]
    if count < 2:
        return otherwise
    inverse = la.solve_triangular(la.cholesky(M, lower=True), np.eye(len(M)), lower=True)
    per_mass = inverse @ np.reshape(K, (-1, *M.shape)) @ inverse.T
    _, lengths, rows = la.svd(per_mass.reshape(-1, len(M)), full_matrices=False)
    if lengths[-count] > _NULL * lengths[0]:
        return otherwise
    vectors = inverse.T @ rows[-count:].conj().T
    return vectors / np.linalg.norm(vectors, axis=0)


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


def _one_of_each_pair(values: np.ndarray, count: int) -> np.ndarray:
    """Return the indices (s, count) of values (s, 2k) that stand for all, ascending in |Im λ|.

    Raises
    ------
    ValueError
        If the values are not conjugate pairs and an even number of real ones.
    """
    real = values.imag == 0.0
    places = np.argsort(np.lexsort((-values.real, ~real)), axis=1)  # real ones first, descending
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
