"""Eigenvalues of the linear equations at one spin speed: constant, or periodic by Hill's method.

``(λ²M + λD + K) x = 0`` with real matrices of size k has 2k eigenvalues: conjugate pairs and an
even number of real ones. One of every conjugate pair is returned (Im λ > 0), and of the real ones
the less damped half, so that k values stand for all.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from exudyn_rotor.linear.equations.hill import harmonic_step, harmonics, hill_matrices
from exudyn_rotor.linear.equations.system import PeriodicSystem

# a double root of a defective eigenvalue splits by the root of the rounding error
_SPLIT = 4.0 * np.sqrt(np.finfo(float).eps)
# relative distance from an eigenvalue that keeps its matrix invertible
_OFF_ROOT = 1e-9
# 1 − MAC of the state vectors of two copies of a defective eigenvalue
_PARALLEL = 1e-4
# distance of the exponents of two members of a Floquet family, as a share of their step
_SAME_FAMILY = 1e-3
# of Hill's problem in first-order form
_MOST_UNKNOWNS = 1600


@dataclass(frozen=True, eq=False)
class FloquetModes:
    """Motions ``exp(λt) Σ_m X_m exp(i m Ω t)`` of one system, one for every pair of eigenvalues.

    Attributes
    ----------
    values : ndarray, shape (k,)
        λ [1/s], ascending in |Im λ|.
    vectors : ndarray, shape (h, c, k)
        Harmonics X_m of the coordinates, rotor frame; columns of unit Euclidean length.
    orders : ndarray of int, shape (h,)
        The harmonics m; only 0 for a constant system.
    resolution : float
        Eigenvalues closer than this cannot be told apart [1/s].
    """

    values: np.ndarray
    vectors: np.ndarray
    orders: np.ndarray
    resolution: float

    @property
    def central(self) -> np.ndarray:
        """The harmonic 0 of every mode, shape (c, k)."""
        return self.vectors[np.flatnonzero(self.orders == 0)[0]]


def quadratic_modes(
    M: np.ndarray, D: np.ndarray, K: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """Return one eigenvalue of each pair of ``λ²M + λD + K``, with its vector.

    Parameters
    ----------
    M, D, K : ndarray, shape (k, k)
        Real; M symmetric positive definite.

    Returns
    -------
    values : ndarray, shape (k,)
        Ascending in |Im λ|.
    vectors : ndarray, shape (k, k)
        Displacements, columns of unit length.
    resolution : float
        Size below which eigenvalues and their differences are round-off [1/s].

    Raises
    ------
    ValueError
        If the mass matrix is not positive definite, or the eigenvalues are not finite.

    Notes
    -----
    Copies of a defective double eigenvalue (a free rigid motion) come out split by the root of
    the rounding error; their mean is exact, so it replaces them.
    """
    values, states = _all_modes(M, D, K)
    size = len(M)
    resolution = _SPLIT * np.abs(values).max(initial=0.0)
    values = _merged(values, states, resolution)
    chosen = _one_of_each_pair(values, size)
    vectors = _refined(values[chosen], states[:size, chosen], M, D, K)
    return values[chosen], vectors, resolution


def _refined(
    values: np.ndarray, vectors: np.ndarray, M: np.ndarray, D: np.ndarray, K: np.ndarray
) -> np.ndarray:
    """Return unit vectors after two inverse iterations.

    Next to stiff static modes, a free motion (a Jordan block at zero) mixes into the vectors of all
    slow modes by rounding; the eigenvalues do not suffer. It can leave so little of a mode that one
    iteration is not enough.
    """
    refined = np.array(vectors, dtype=complex)
    for column, value in enumerate(values):
        if value != 0.0:
            shifted = value * (1.0 + _OFF_ROOT)
            factors = la.lu_factor(shifted**2 * M + shifted * D + K)
            for _ in range(2):
                vector = la.lu_solve(factors, M @ refined[:, column])
                refined[:, column] = vector / np.maximum(np.linalg.norm(vector), 1e-300)
    return refined / np.maximum(np.linalg.norm(refined, axis=0), 1e-300)


def _all_modes(M: np.ndarray, D: np.ndarray, K: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return all 2k eigenvalues and state vectors (x, λx / scale) of unit length."""
    size = len(M)
    try:
        lower = la.cholesky(M, lower=True)
    except la.LinAlgError as error:
        raise ValueError(f"the mass matrix is not positive definite ({error})") from error
    own = la.solve_triangular(lower, la.solve_triangular(lower, K, lower=True).T, lower=True).T
    damping = la.solve_triangular(lower, la.solve_triangular(lower, D, lower=True).T, lower=True).T
    scale = max(np.sqrt(np.abs(own).max(initial=0.0)), np.abs(damping).max(initial=0.0)) or 1.0
    state = np.block([[np.zeros((size, size)), scale * np.eye(size)], [-own / scale, -damping]])
    if not np.all(np.isfinite(state)):
        raise ValueError("the system matrices have entries that are not finite")
    values, states = np.linalg.eig(state)
    displacement = la.solve_triangular(lower.T, states[:size], lower=False)
    states = np.vstack([displacement, displacement * (values / scale)])
    return values, states / np.linalg.norm(states, axis=0)


def _merged(values: np.ndarray, states: np.ndarray, resolution: float) -> np.ndarray:
    """Replace copies of a defective eigenvalue by their mean, and unresolved ones by zero."""
    merged = values.copy()
    merged[np.abs(values) <= resolution] = 0.0
    for group in groups(values, resolution):
        if len(group) < 2 or not np.any(merged[group]):
            continue
        overlap = np.abs(states[:, group].conj().T @ states[:, group]) ** 2
        copies = overlap[0] > 1.0 - _PARALLEL
        if np.count_nonzero(copies) > 1:
            merged[group[copies]] = values[group[copies]].mean()
    return merged


def groups(values: np.ndarray, resolution: float) -> list[np.ndarray]:
    """Return the indices of values that `resolution` does not tell apart, group by group."""
    left = np.argsort(values.imag, kind="stable")
    found = []
    while left.size:
        near = np.abs(values[left] - values[left[0]]) <= resolution
        found.append(left[near])
        left = left[~near]
    return found


def _one_of_each_pair(values: np.ndarray, count: int) -> np.ndarray:
    """Return the indices of `count` values that stand for all, ascending in |Im λ|.

    Raises
    ------
    ValueError
        If the values are not conjugate pairs and an even number of real ones.
    """
    upper = np.flatnonzero(values.imag > 0.0)
    real = np.flatnonzero(values.imag == 0.0)
    real = real[np.argsort(-values[real].real, kind="stable")][: len(real) // 2]
    chosen = np.concatenate([real, upper])
    if len(chosen) != count or not np.all(np.isfinite(values)):
        raise ValueError(
            f"{len(chosen)} pairs of eigenvalues were found where there are {count}; "
            "the matrices may be badly scaled: check the units"
        )
    return chosen[np.lexsort((values[chosen].real, values[chosen].imag))]


def floquet_modes(system: PeriodicSystem, *, tolerance: float = 1e-8) -> FloquetModes:
    """Return one motion for every pair of eigenvalues of a constant or periodic system.

    A periodic system is solved by Hill's method. Of each Floquet family ``λ + i p Ω`` the member
    with the largest central harmonic is taken. Harmonics are added until the share w of the
    outermost ones in the energy of a mode moves its λ by less than `tolerance`, relative to the
    larger of |λ| and pΩ: about ``w pΩ``, p the step of the harmonics.

    Parameters
    ----------
    system : PeriodicSystem
    tolerance : float, optional
        Largest accepted truncation error.

    Raises
    ------
    ValueError
        If modes are lost, or the harmonics do not die away.
    """
    if system.is_constant or system.speed == 0.0:
        matrices = system.matrices(0.0)
        values, vectors, resolution = quadratic_modes(*matrices)
        return FloquetModes(values, vectors[None], np.array([0]), resolution)
    step = harmonic_step(system)
    order = 2 * step
    while True:
        modes = _hill_modes(system, harmonics(system, order))
        error = _truncation(modes, step * abs(system.speed))
        if error <= tolerance:
            return modes
        order += step * max(1, order // (2 * step))
        if 2 * system.size * (2 * order // step + 1) > _MOST_UNKNOWNS:
            raise ValueError(
                f"at {system.speed:.6g} rad/s harmonics up to the {modes.orders.max()}th leave "
                f"the truncation error {error:.1e}: the speed is small against the frequencies "
                "that the supports split; use a larger speed (or 0), or fewer high modes"
            )


def _truncation(modes: FloquetModes, base: float) -> float:
    """Estimate the largest relative change of λ by the harmonics that were cut off."""
    outer = np.abs(modes.orders) == np.abs(modes.orders).max()
    share = np.sum(np.abs(modes.vectors[outer]) ** 2, axis=(0, 1))
    return float(np.max(share * base / np.maximum(np.abs(modes.values), base)))


def _hill_modes(system: PeriodicSystem, orders: np.ndarray) -> FloquetModes:
    """Solve Hill's problem for the harmonics `orders` and take one motion of each family."""
    size, count = system.size, len(orders)
    turn = np.kron(_real_basis(orders), np.eye(size))
    real = [(turn.conj().T @ X @ turn).real for X in hill_matrices(system, orders)]
    values, states = _all_modes(*real)
    resolution = _SPLIT * np.abs(values).max()
    values = _merged(values, states, resolution)
    vectors = turn @ states[: count * size]
    vectors = vectors / np.linalg.norm(vectors, axis=0)
    vectors = vectors.reshape(count, size, -1)
    for group in groups(values, resolution):
        if len(group) > 1:
            vectors[:, :, group] = _unmixed(vectors[:, :, group], orders)
    chosen = _one_of_each_family(values, vectors, orders, system.speed)
    return FloquetModes(values[chosen], vectors[:, :, chosen], orders, resolution)


def _unmixed(vectors: np.ndarray, orders: np.ndarray) -> np.ndarray:
    """Part the copies of different families that share an eigenvalue by their mean harmonic."""
    flat = vectors.reshape(-1, vectors.shape[2])
    span, lengths, _ = np.linalg.svd(flat, full_matrices=False)
    if lengths[-1] < 1e-3 * lengths[0]:  # copies of a defective eigenvalue: one vector only
        return vectors
    shaped = span.reshape(vectors.shape)
    _, turn = np.linalg.eigh(np.einsum("h,hci,hcj->ij", orders, shaped.conj(), shaped))
    return (span @ turn).reshape(vectors.shape)


def _real_basis(orders: np.ndarray) -> np.ndarray:
    """Return the unitary matrix from 1, √2 cos mΩt, √2 sin mΩt to exp(i m Ω t)."""
    count = len(orders)
    basis = np.zeros((count, count), dtype=complex)
    for column, m in enumerate(orders):
        plus, minus = column, count - 1 - column
        if m == 0:
            basis[column, column] = 1.0
        elif m > 0:
            basis[[plus, minus], column] = np.sqrt(0.5)
        else:  # sine of order −m
            basis[[minus, plus], column] = np.array([-1j, 1j]) * np.sqrt(0.5)
    return basis


def _one_of_each_family(
    values: np.ndarray, vectors: np.ndarray, orders: np.ndarray, speed: float
) -> np.ndarray:
    """Return the indices of one motion for each pair of Floquet families."""
    size = vectors.shape[1]
    center = np.flatnonzero(orders == 0)[0]
    share = np.sum(np.abs(vectors[center]) ** 2, axis=0)
    spread = np.einsum("h,hcj->j", np.abs(orders), np.abs(vectors) ** 2)
    step = int(orders[1] - orders[0]) * abs(speed)
    upper = np.flatnonzero(values.imag >= 0.0)
    accepted: list[int] = []
    own_pair: list[bool] = []
    weight = 0
    for index in upper[np.lexsort((spread[upper], -np.round(share[upper], 6)))]:
        if weight == 2 * size:
            break
        mode = (values[index], vectors[:, :, index])
        known = [(values[i], vectors[:, :, i]) for i in accepted]
        known = known + [_conjugate(entry) for entry in known]
        if _is_known(mode, known, step):
            continue
        alone = mode[0].imag == 0.0 or _is_known(_conjugate(mode), [mode], step)
        accepted.append(int(index))
        own_pair.append(alone)
        weight += 1 if alone else 2
    if weight != 2 * size:
        raise ValueError(
            f"Hill's method found {weight} of {2 * size} Floquet families; modes would be lost"
        )
    found, alone = np.array(accepted), np.array(own_pair)
    real = found[alone]
    real = real[np.argsort(-values[real].real, kind="stable")][: len(real) // 2]
    chosen = np.concatenate([found[~alone], real])
    return chosen[np.lexsort((values[chosen].real, values[chosen].imag))]


Mode = tuple[complex, np.ndarray]


def _conjugate(mode: Mode) -> Mode:
    """Return the conjugate motion: λ̄ with the harmonics conj(X_−m)."""
    return np.conj(mode[0]), mode[1][::-1].conj()


def _is_known(mode: Mode, known: list[Mode], step: float) -> bool:
    """Return whether a motion is in the span of known ones with shifted harmonics.

    At the same eigenvalue, without a shift, it is another motion: a repeated eigenvalue.
    """
    value, vector = mode
    basis = []
    for other_value, other in known:
        shift = round((value - other_value).imag / step)
        if shift and abs(value - other_value - 1j * shift * step) <= _SAME_FAMILY * step:
            moved = _shifted(other, shift).ravel()
            if np.linalg.norm(moved) > 0.5:
                basis.append(moved)
    if not basis:
        return False
    span, lengths, _ = np.linalg.svd(np.array(basis).T, full_matrices=False)
    span = span[:, lengths > 0.1]
    return np.linalg.norm(span.conj().T @ vector.ravel()) ** 2 > 0.5


def _shifted(vector: np.ndarray, shift: int) -> np.ndarray:
    """Return harmonics for the member of the family that is `shift` steps higher in λ.

    ``exp((λ + ipsΩ)t) Σ Y_m exp(imΩt)`` is the same motion for ``Y_m = X_{m + ps}``.
    """
    moved = np.zeros_like(vector)
    count = len(vector)
    for row in range(count):
        if 0 <= row + shift < count:
            moved[row] = vector[row + shift]
    return moved
