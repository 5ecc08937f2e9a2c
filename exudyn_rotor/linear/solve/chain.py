"""Harmonics that are coupled with near ones only: a chain, solved from its ends inwards.

Coefficients with the terms −rp … rp couple the harmonic m with m ± p to m ± rp, so that r
harmonics make a link that is coupled with its neighbours only. Every link is eliminated towards one
in the middle, which costs a small matrix for each instead of one of all.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from exudyn_rotor.linear.equations import PeriodicSystem


def reach(system: PeriodicSystem) -> int:
    """Return r, to how many neighbours harmonics are coupled."""
    return max(abs(n) for terms in (system.D, system.K) for n in terms) // system.step


def chained(
    systems: Sequence[PeriodicSystem],
    loads: Sequence[Mapping[int, np.ndarray]],
    orders: Sequence[int],
    nu: np.ndarray,
    stiffness: Callable[[int, int], np.ndarray],
    solve: Callable[[np.ndarray, np.ndarray, slice], np.ndarray],
) -> np.ndarray:
    """Return the harmonics (s, h, k) of the motions of several systems of one step and reach.

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
        Solves the equations of the middle link, (s, l, l) with (s, l), given its harmonics.
    """
    count, k, h, r = len(systems), systems[0].size, len(orders), reach(systems[0])
    links = [slice(first, min(first + r, h)) for first in range(0, h, r)]
    still = np.flatnonzero(np.any(nu == 0.0, axis=0))  # free motions stay in the middle
    middle = int(still[0]) // r if still.size else len(links) // 2
    numbers, none = range(h), np.zeros((k, k))
    means = [np.stack([stiffness(i, a) for i in range(count)]) for a in numbers]
    scale = 1.0 / np.sqrt(np.maximum(np.abs(np.mean(means, axis=0)).max(axis=2), 1e-300))
    scaled = [scale[:, :, None] * X * scale[:, None, :] for X in means]
    kept: dict[tuple[int, int], np.ndarray] = {}

    def coupling(a: int, b: int) -> np.ndarray:
        """Return how the harmonic b acts on the harmonic a."""
        if a == b:
            return scaled[a]
        if (a, b) not in kept:
            n = orders[a] - orders[b]
            X = np.stack([s.K.get(n, none) + 1j * nu[i, b] * s.D.get(n, none)
                          for i, s in enumerate(systems)])  # fmt: skip
            kept[a, b] = scale[:, :, None] * X * scale[:, None, :]
        return kept[a, b]

    def between(a: int, b: int) -> np.ndarray:
        rows = [np.concatenate([coupling(i, j) for j in numbers[links[b]]], axis=2)
                for i in numbers[links[a]]]  # fmt: skip
        return np.concatenate(rows, axis=1)

    every = np.stack([[load.get(n, np.zeros(k)) for n in orders] for load in loads]) + 0j
    every = scale[:, None, :] * every
    Z = [between(a, a) for a in range(len(links))]
    g = [every[:, link].reshape(count, -1) for link in links]
    towards = {}
    for chain, step in ((range(middle), 1), (range(len(links) - 1, middle, -1), -1)):
        for a in chain:
            right = np.concatenate([between(a, a + step), g[a][:, :, None]], axis=2)
            solved = _solved_all(Z[a], right)
            towards[a], own = solved[:, :, :-1], solved[:, :, -1]
            back = between(a + step, a)
            Z[a + step] = Z[a + step] - back @ towards[a]
            g[a + step] = g[a + step] - np.einsum("sij,sj->si", back, own)
            g[a] = own
    X = {middle: solve(Z[middle], g[middle], links[middle])}
    for chain, step in ((range(middle - 1, -1, -1), 1), (range(middle + 1, len(links)), -1)):
        for a in chain:
            X[a] = g[a] - np.einsum("sij,sj->si", towards[a], X[a + step])
    found = np.concatenate([X[a] for a in range(len(links))], axis=1)
    return found.reshape(count, h, k) * scale[:, None, :]


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
