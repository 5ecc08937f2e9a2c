"""Motions of periodic equations by Hill's method: a truncated sum of harmonics of the speed.

    z(t) = exp(λt) Σ_m Z_m exp(imΩt),    λ Z_m = Σ_n A_{m−n} Z_n − imΩ Z_m

With the harmonics in cosines and sines the matrix is real. Every motion stands in it once for each
harmonic, as λ + inΩ: of these copies the one whose harmonics lie around zero is taken.
"""

from __future__ import annotations

import numpy as np

from exudyn_rotor.linear.equations import PeriodicSystem
from exudyn_rotor.linear.solve.state import States

_SIZES = (2, 3, 4, 6)  # harmonics on either side, in steps of the coefficients
_LARGEST = 420  # unknowns, beyond which harmonics are not added
_FAST = 30.0  # decay over Ω above which a motion is over before the coefficients change


def hill_motions(
    system: PeriodicSystem, made: States, tolerance: float, begin: int = 0
) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    """Return 2k exponents, their states (h, 2k, 2k), the harmonics, and what to begin with next.

    Harmonics are added until those at the edge of the sum hold no more than the `tolerance` of the
    energy of each motion: the error of λ is of that size. Fast decays are not waited for. Exponents
    that do not get there are NaN.
    """
    count = 2 * system.size
    place = max(begin - 1, 0)  # faster rotors need fewer
    while True:
        orders = system.step * np.arange(-_SIZES[place], _SIZES[place] + 1)
        values, states = _solved(made, orders, system.speed)
        values, states, edges = _centered(values, states, orders, system.step, count)
        fast = -values.real > _FAST * abs(system.speed)
        done = fast | (edges <= tolerance)
        larger = count * (2 * _SIZES[min(place + 1, len(_SIZES) - 1)] + 1)
        if np.all(done) or place + 1 == len(_SIZES) or larger > _LARGEST:
            break
        place += 1
    found = fast | (edges <= 1e3 * tolerance)
    # what has failed is not tried again with fewer
    return np.where(found, values, np.nan), states, orders, place + (not np.all(found))


def _solved(made: States, orders: np.ndarray, speed: float) -> tuple[np.ndarray, np.ndarray]:
    """Return all exponents of a truncation and their states (h, 2k, n)."""
    h, size = len(orders), len(made.A[0])
    matrix = np.zeros((h, size, h, size), dtype=complex)
    for a, m in enumerate(orders):
        for b, n in enumerate(orders):
            if m - n in made.A:
                matrix[a, :, b] = made.A[m - n]
        matrix[a, np.arange(size), a, np.arange(size)] -= 1j * m * speed
    turn = _real_waves(h)  # exp(imΩt) from 1, cosines and sines
    real = np.einsum("ap,aibj,bq->piqj", turn.conj(), matrix, turn, optimize=True).real
    values, vectors = np.linalg.eig(real.reshape(h * size, h * size))
    states = np.tensordot(turn, vectors.reshape(h, size, -1), (1, 0))
    return values, states


def _real_waves(h: int) -> np.ndarray:
    """Return the unitary matrix (h, h) from 1, √2 cos and √2 sin to exponentials."""
    top = h // 2
    turn = np.zeros((h, h), dtype=complex)
    turn[top, 0] = 1.0
    for n in range(1, top + 1):
        turn[top + n, 2 * n - 1], turn[top - n, 2 * n - 1] = np.sqrt(0.5), np.sqrt(0.5)
        turn[top + n, 2 * n], turn[top - n, 2 * n] = -1j * np.sqrt(0.5), 1j * np.sqrt(0.5)
    return turn


def _centered(
    values: np.ndarray, states: np.ndarray, orders: np.ndarray, step: int, count: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the motions whose harmonics lie around zero, and the energy share of their edges."""
    energy = np.sum(np.abs(states) ** 2, axis=1)
    energy = energy / energy.sum(axis=0)
    mean = orders @ energy
    edges = energy[0] + energy[-1]
    # copies of a motion are whole steps apart: one of each lies within half a step of zero
    distance = np.abs(mean / step - 1e-3)
    best = np.argsort(distance + 1e3 * (edges > 0.1), kind="stable")[:count]
    return values[best], states[:, :, best], edges[best]
