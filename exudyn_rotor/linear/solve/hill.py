"""Motions of periodic equations by Hill's method: a truncated sum of harmonics of the speed.

    z(t) = exp(λt) Σ_m Z_m exp(imΩt),    λ Z_m = Σ_n A_{m−n} Z_n − imΩ Z_m

With the harmonics in cosines and sines the matrix is real. Every motion stands in it once for each
harmonic, as λ + inΩ: of these copies the one whose harmonics lie around zero is taken.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exudyn_rotor.linear.equations import PeriodicSystem, States

_SIZES = (2, 3, 4, 5, 6)  # harmonics on either side, in steps of the coefficients
_LARGEST, _MOST = 250, 1000  # unknowns beyond which fast motions are not waited for, and none
SLOW = 20.0  # |λ| over Ω up to which motions are waited for
_NEAR = 1e-2  # of |λ|: by how much more one that is known about may grow
_FAST = 30.0  # decay over Ω above which a motion is over before the coefficients change
_OVER = 3.0  # decay over Ω, and over the own frequency, beyond which nobody looks at a motion
# energy at the edge of the sum that counts as none, over the tolerance of λ, which errs by less
# than a tenth of it; and energy that is too much
_EDGE, _LOST = 10.0, 3e-3
_COPY, _ALIKE = 1e-6, 0.7  # of pΩ, and of a shape: how near a copy of a motion is


class Exponents(NamedTuple):
    """Motions of periodic equations, k for all of k coordinates.

    Attributes
    ----------
    values : ndarray, shape (k,)
        λ; NaN where it did not converge.
    states : ndarray, shape (h, 2k, k)
        Harmonics of the state.
    orders : ndarray of int, shape (h,)
    lost : ndarray, shape (l,)
        Exponents of motions that did not converge, about; of decays that are over at once none.
    """

    values: np.ndarray
    states: np.ndarray
    orders: np.ndarray
    lost: np.ndarray


def hill_motions(
    system: PeriodicSystem,
    made: States,
    tolerance: float,
    begin: int = 0,
    neutral: float | None = None,
) -> tuple[Exponents, int]:
    """Return the motions of a system, and with how many harmonics to begin at the next speed.

    Harmonics are added until those at the edge of the sum hold next to nothing of each motion. Fast
    decays are not waited for, and of many coordinates only what slow motions need to be known at
    all. Where only the growth of the least stable motion is asked for, slow motions that decay
    faster than it need no more, either. Growth up to `neutral` [1/s] then counts as none. Exponents
    that do not get there are NaN.
    """
    k, speed = system.size, abs(system.speed)
    unknowns = [2 * k * (2 * size + 1) for size in (*_SIZES, np.inf)]
    for place in range(begin, len(_SIZES)):
        orders = system.step * np.arange(-_SIZES[place], _SIZES[place] + 1)
        values, states = _solved(made, orders, system.speed)
        chosen = one_of_each_family(values, states, orders, system, made)
        values, states = values[chosen], states[:, :, chosen]
        energy, growth = shares(states), values.real
        fast, slow = -growth > _FAST * speed, np.abs(values) <= SLOW * speed
        allowed = np.where(fast, np.inf, _EDGE * tolerance)
        if neutral is not None:
            least = growth[np.abs(growth) > neutral].max(initial=-np.inf)
            near = slow & (growth >= least - _NEAR * np.abs(values))
            allowed[growth < least] = np.inf
            allowed[near & (growth < least)] = _LOST
        few = np.where(slow, allowed if neutral is not None else _LOST, np.inf)
        edges = energy[0] + energy[-1]
        wanted = few if unknowns[place + 1] > _LARGEST else allowed
        if np.all(edges <= wanted) or unknowns[place + 1] > _MOST:
            break
    wanted = few if unknowns[place] > _LARGEST else allowed
    fewer = np.all(energy[1] + energy[-2] <= wanted)
    found = fast | (edges <= _LOST)
    kept = np.where(found, values, np.nan)
    return Exponents(kept, states, orders, lost_of(values[~found], system)), max(place - fewer, 0)


def lost_of(values: np.ndarray, system: PeriodicSystem) -> np.ndarray:
    """Return those exponents that an engineer looks at."""
    looked_at = -values.real <= np.maximum(_OVER * abs(system.speed), np.abs(values.imag))
    return values[looked_at]


def shares(states: np.ndarray) -> np.ndarray:
    """Return the share of each harmonic in the energy of motions with states (h, 2k, n), (h, n)."""
    energy = np.sum(np.abs(states) ** 2, axis=1)
    return energy / energy.sum(axis=0)


def one_of_each_family(
    values: np.ndarray,
    states: np.ndarray,
    orders: np.ndarray,
    system: PeriodicSystem,
    made: States,
) -> np.ndarray:
    """Return which of many exponents stand for all, k.

    Of each motion, its copies and their conjugates one, whose harmonics lie around zero; of motions
    that are their own conjugates the less damped half.
    """
    step, base = system.step, system.step * system.speed
    energy = shares(states)
    shapes = made.shape @ states
    shapes = shapes / np.linalg.norm(shapes, axis=(0, 1))
    mean, edges = orders @ energy / step, energy[0] + energy[-1]
    # the small number decides between two copies half a step from zero; copies of what is not
    # resolved do not tell that they are copies, and come last
    waiting = np.argsort(np.abs(mean - 1e-2) + 10.0 * (edges > _LOST), kind="stable")
    left, pairs, single = np.ones(len(values), dtype=bool), [], []
    for i in waiting:
        if 2 * len(pairs) + len(single) >= 2 * system.size:
            break
        if not left[i]:
            continue
        near = (_COPY + edges + edges[i]) * abs(base) + 1e-6 * abs(values[i])
        own = _copies(values, shapes, values[i], shapes[:, :, i], base, near)
        mirrored = shapes[::-1, :, i].conj()
        mirrored = _copies(values, shapes, values[i].conj(), mirrored, base, near)
        left[own] = left[mirrored] = left[i] = False
        if i in mirrored:
            single.append(i)
        else:
            pairs.append(i)
    single.sort(key=lambda i: -values[i].real)
    return np.array([*pairs, *single][: system.size], dtype=int)


def _copies(
    values: np.ndarray,
    shapes: np.ndarray,
    value: complex,
    shape: np.ndarray,
    base: float,
    allowed: np.ndarray,
) -> np.ndarray:
    """Return which motions are one, λ + ipΩn with its harmonics n steps lower.

    Their exponents may be off by what is `allowed` (n,).
    """
    apart = values - value
    steps = np.round(apart.imag / base).astype(int)
    near = np.abs(apart - 1j * steps * base) <= allowed
    h = len(shape)
    found = np.flatnonzero(near & (np.abs(steps) < h))
    around = np.zeros((3 * h, shape.shape[1]), dtype=complex)
    around[h : 2 * h] = shape
    lowered = np.array([around[h + n : 2 * h + n] for n in steps[found]])
    likeness = np.einsum("jhk,hkj->j", lowered.reshape(-1, *shape.shape).conj(), shapes[..., found])
    return found[np.abs(likeness) > _ALIKE]


def _solved(made: States, orders: np.ndarray, speed: float) -> tuple[np.ndarray, np.ndarray]:
    """Return all exponents of a truncation and their states (h, 2k, n)."""
    h, size = len(orders), len(made.A[0])
    matrix = np.zeros((h, size, h, size), dtype=complex)
    for a, m in enumerate(orders):
        for b, n in enumerate(orders):
            if m - n in made.A:
                matrix[a, :, b] = made.A[m - n]
        matrix[a, np.arange(size), a, np.arange(size)] -= 1j * m * speed
    [real] = in_real_waves(matrix.reshape(1, h * size, h * size), h)
    values, vectors = np.linalg.eig(real)
    states = np.tensordot(real_waves(h), vectors.reshape(h, size, -1), (1, 0))
    return values, states


def real_waves(h: int) -> np.ndarray:
    """Return the unitary matrix (h, h) from 1, √2 cos and √2 sin to exponentials."""
    top = h // 2
    turn = np.zeros((h, h), dtype=complex)
    turn[top, 0] = 1.0
    for n in range(1, top + 1):
        turn[top + n, 2 * n - 1], turn[top - n, 2 * n - 1] = np.sqrt(0.5), np.sqrt(0.5)
        turn[top + n, 2 * n], turn[top - n, 2 * n] = -1j * np.sqrt(0.5), 1j * np.sqrt(0.5)
    return turn


def in_real_waves(stack: np.ndarray, h: int) -> np.ndarray:
    """Return what is between exponentials, (s, h·k, h·k), between 1, √2 cos and √2 sin: real."""
    waves, shape = real_waves(h), stack.shape
    rows = waves.conj().T @ stack.reshape(shape[0], h, -1)
    columns = np.swapaxes(rows.reshape(shape), 1, 2).reshape(shape[0], h, -1)
    return np.swapaxes((waves.T @ columns).reshape(shape), 1, 2).real
