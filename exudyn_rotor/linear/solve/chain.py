"""Harmonics that are coupled with their neighbours only: a chain, solved from its ends inwards.

Coefficients with the terms −p, 0, p couple the harmonic m with m − p and m + p. Every harmonic is
eliminated towards one in the middle, which costs a small matrix for each instead of one of all.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from exudyn_rotor.linear.equations import PeriodicSystem


def is_chain(system: PeriodicSystem) -> bool:
    """Return whether harmonics are coupled with their neighbours only."""
    return all(abs(n) <= system.step for terms in (system.D, system.K) for n in terms)


def chained(
    systems: Sequence[PeriodicSystem],
    loads: Sequence[Mapping[int, np.ndarray]],
    orders: Sequence[int],
    nu: np.ndarray,
    stiffness: Callable[[int, int], np.ndarray],
    solve: Callable[[np.ndarray, np.ndarray], np.ndarray],
) -> np.ndarray:
    """Return the harmonics (s, h, k) of the motions of several systems of one step.

    Parameters
    ----------
    systems, loads
        See :func:`forced_motions`.
    orders : sequence of int
        The chain (h,).
    nu : ndarray, shape (s, h)
        Frequencies [rad/s].
    stiffness : callable
        Takes a system's and a harmonic's number; gives the dynamic stiffness of this harmonic.
    solve : callable
        Solves the equations of the middle harmonic, (s, k, k) with (s, k).
    """
    count, k, h = len(systems), systems[0].size, len(orders)
    still = np.flatnonzero(np.any(nu == 0.0, axis=0))  # free motions stay in the middle
    middle = int(still[0]) if still.size else h // 2
    Z = [np.stack([stiffness(i, a) for i in range(count)]) for a in range(h)]
    scale = 1.0 / np.sqrt(np.maximum(np.abs(np.mean(Z, axis=0)).max(axis=2), 1e-300))

    def scaled(X: np.ndarray) -> np.ndarray:
        return scale[:, :, None] * X * scale[:, None, :]

    def between(a: int, b: int) -> np.ndarray:
        step, none = orders[a] - orders[b], np.zeros((k, k))
        return scaled(np.stack([s.K.get(step, none) + 1j * nu[i, b] * s.D.get(step, none)
                                for i, s in enumerate(systems)]))  # fmt: skip

    Z = [scaled(X) for X in Z]
    g = [scale * np.stack([load.get(n, np.zeros(k)) for load in loads]) + 0j for n in orders]
    towards = {}
    for chain, step in ((range(middle), 1), (range(h - 1, middle, -1), -1)):
        for a in chain:
            right = np.concatenate([between(a, a + step), g[a][:, :, None]], axis=2)
            solved = _solved_all(Z[a], right)
            towards[a], own = solved[:, :, :k], solved[:, :, k]
            back = between(a + step, a)
            Z[a + step] = Z[a + step] - back @ towards[a]
            g[a + step] = g[a + step] - np.einsum("sij,sj->si", back, own)
            g[a] = own
    X = np.zeros((count, h, k), dtype=complex)
    X[:, middle] = solve(Z[middle], g[middle])
    for chain, step in ((range(middle - 1, -1, -1), 1), (range(middle + 1, h), -1)):
        for a in chain:
            X[:, a] = g[a] - np.einsum("sij,sj->si", towards[a], X[:, a + step])
    return X * scale[:, None, :]


def _solved_all(A: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return solutions, NaN of singular matrices."""
    try:
        return np.linalg.solve(A, b)
    except np.linalg.LinAlgError:
        X = np.full(b.shape, np.nan, dtype=complex)
        for i in range(len(A)):
            try:
                X[i] = np.linalg.solve(A[i], b[i])
            except np.linalg.LinAlgError:
                continue
        return X
