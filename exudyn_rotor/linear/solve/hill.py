"""Motions of periodic equations by Hill's method: a truncated sum of harmonics of the speed.

    z(t) = exp(λt) Σ_m Z_m exp(imΩt),    λ Z_m = Σ_n A_{m−n} Z_n − imΩ Z_m

With the harmonics in cosines and sines the matrix is real. Every motion stands in it once for each
harmonic, as λ + inΩ: of these copies the one whose harmonics lie around zero is taken.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from exudyn_rotor.linear.equations import PeriodicSystem, States, Terms, stacked
from exudyn_rotor.linear.solve.harmonics import (
    Chain,
    chain_of,
    edge_energy,
    shares,
    with_all_harmonics,
)

_AROUND = 2  # harmonics on either side in the smallest guess
# unknowns of the largest guess; with more steps of harmonics on either side than so many, fewer
_LARGEST, _HIGHEST, _SMALL = 600, 5, 150
SLOW = 20.0  # |λ| over Ω up to which motions are waited for
_FAST = 30.0  # decay over Ω above which a motion may be over before the coefficients change
_APART = 2.0  # ratio of decays that are far apart
_OVER = 3.0  # decay over Ω, and over the own frequency, beyond which nobody looks at a motion
# energy at the edge of the sum that counts as none, over the tolerance of λ, which errs by less
# than a tenth of it; and energy that is too much
_EDGE, _LOST = 10.0, 3e-4
_COPY, _ALIKE = 1e-6, 0.7  # of pΩ, and of a shape: how near a copy of a motion is
_AWAY, _MOST_AWAY = 100.0, 1e-3  # of pΩ: how far copies are by the energy at the edge, at most


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


class Beside(NamedTuple):
    """All motions at another speed but decays over at once, with the states that they are in."""

    values: np.ndarray
    states: np.ndarray
    orders: np.ndarray
    made: States


def hill_motions(
    system: PeriodicSystem, made: States, tolerance: float, beside: Beside | None = None
) -> tuple[Exponents, Beside | None]:
    """Return the motions of a system; where all are known, also for a search at a speed beside.

    Guesses are the motions `beside`, as those at a speed before, then the eigenvalues of a sum of
    few harmonics, and of more where motions are missing. Each motion then gets as many harmonics as
    it has. As many different motions as there are coordinates are all of them. Decays that are over
    at once count by the mean equations, and are left out. Exponents that do not get there are NaN.
    """
    k, speed, least = system.size, abs(system.speed), _EDGE * tolerance
    chain = chain_of(system, made)
    at_once, wanted = _over_at_once(-chain.rates.real, speed)
    for values, states, orders in _guesses(system, made, beside, at_once):
        is_sum = orders is not None
        edges = edge_energy(states) if is_sum else np.full(len(values), np.inf)
        better, states, orders, edges = with_all_harmonics(chain, values, states, edges, least)
        slow = (np.abs(better) <= SLOW * speed) & _looked_at(better, system)
        chosen, counts = one_of_each_family(better, states, orders, system, made)
        enough = edges <= np.where(slow, least, _LOST)
        missing = max(0, wanted - int(np.sum(counts[enough[chosen]])))
        if not missing:
            break
    found = np.isin(np.arange(len(values)), chosen) & (edges <= _LOST)
    lost, whole = lost_of(values[~found], system), None
    chosen = chosen[found[chosen]]
    values, states = better[chosen], states[:, :, chosen]
    if not missing:
        lost, whole = lost[:0], Beside(values, states, orders, made)
    exponents = Exponents(values[:k], states[:, :, :k], orders, lost)
    if len(chosen) < k:
        room = max(0, k - len(chosen) - (missing + 1) // 2)
        exponents = _with_decays(exponents, chain, system, made, at_once, room)
    return exponents, whole


def _with_decays(
    known: Exponents, chain: Chain, system: PeriodicSystem, made: States, at_once: float, room: int
) -> Exponents:
    """Return k exponents: those known, and the least damped decays that are over at once.

    Guesses are decays of the mean equations, as many as there is room for. The rest is NaN.
    """
    fast = np.flatnonzero((-chain.rates.real > at_once) & (chain.rates.imag >= 0.0))
    fast = fast[np.argsort(-chain.rates[fast].real)][:room]
    guess = chain.rates[fast].astype(complex), chain.shapes[None, :, fast]
    given = chain, *guess, np.full(len(fast), np.inf), _LOST
    values, states, orders, edges = with_all_harmonics(*given)
    kept = np.flatnonzero((edges <= _LOST) & (-values.real > at_once))
    values, states = values[kept], states[:, :, kept]
    chosen, _ = one_of_each_family(values, states, orders, system, made)
    chosen = chosen[np.argsort(-values[chosen].real)]
    values = np.r_[known.values, values[chosen]]
    missing = system.size - len(values)
    values = np.pad(values, (0, missing), constant_values=np.nan)

    def by_order(orders: np.ndarray, states: np.ndarray) -> Terms:
        """Return the harmonics of motions, one motion in each row, by their orders."""
        return dict(zip(orders.tolist(), np.swapaxes(states, 1, 2), strict=True))

    parts = by_order(known.orders, known.states), by_order(orders, states[:, :, chosen])
    joined = stacked(parts)
    states = np.swapaxes(list(joined.values()), 1, 2)
    states = np.pad(states, [(0, 0), (0, 0), (0, missing)], constant_values=np.nan)
    return Exponents(values, states, np.array(list(joined)), known.lost)


def _over_at_once(decays: np.ndarray, speed: float) -> tuple[float, int]:
    """Return the decay above which motions are over at once, and how many exponents do not.

    Where decays of the mean equations (2k,) beyond many Ω first lie far apart.
    """
    ascending = np.sort(np.maximum(decays, _FAST * speed))
    if ascending[-1] == _FAST * speed:
        return np.inf, len(decays)
    apart = ascending[1:] / ascending[:-1]
    last = int(np.argmax(np.minimum(apart, _APART)))
    return float(np.sqrt(ascending[last] * ascending[last + 1])), last + 1


def _guesses(
    system: PeriodicSystem, made: States, beside: Beside | None, at_once: float
) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray | None]]:
    """Yield exponents, states and orders of guesses; those of motions beside have no orders."""
    k = system.size
    if beside is not None and beside.states.shape[1] == 2 * k:
        yield *_carried(beside, system, made), None
    fewest = -(-_AROUND // system.step)
    sizes = [fewest]
    for size in range(fewest + 1, _SMALL):
        if 2 * k * (2 * size + 1) <= (_LARGEST if size <= _HIGHEST else _SMALL):
            sizes.append(size)
    # where the speed before has left motions open the fewest harmonics do not suffice
    for size in sizes if beside is not None or len(sizes) == 1 else sizes[1:]:
        orders = system.step * np.arange(-size, size + 1)
        values, states = _solved(made, orders, system.speed)
        stays = values.real >= -at_once
        values, states = values[stays], states[:, :, stays]
        chosen, _ = one_of_each_family(values, states, orders, system, made)
        yield values[chosen], states[:, :, chosen], orders


def _carried(beside: Beside, system: PeriodicSystem, made: States) -> tuple[np.ndarray, np.ndarray]:
    """Return exponents and states of the motions beside, in the states of a system."""
    (values, states, orders, _), k = beside, system.size
    moved = np.linalg.solve(made.shape[:, :k], beside.made.shape @ states)
    rates = values + 1j * system.speed * orders[:, None, None]
    return values, np.hstack([moved, rates * moved / made.A[0][:k, k:].diagonal()[:, None]])


def lost_of(values: np.ndarray, system: PeriodicSystem) -> np.ndarray:
    """Return those exponents that an engineer looks at."""
    return values[_looked_at(values, system)]


def _looked_at(values: np.ndarray, system: PeriodicSystem) -> np.ndarray:
    return -values.real <= np.maximum(_OVER * abs(system.speed), np.abs(values.imag))


def one_of_each_family(
    values: np.ndarray,
    states: np.ndarray,
    orders: np.ndarray,
    system: PeriodicSystem,
    made: States,
) -> tuple[np.ndarray, np.ndarray]:
    """Return which of many exponents stand for all, and for how many each of them does.

    Of each motion, its copies and their conjugates one, whose harmonics lie around zero. Those that
    are their own conjugates come last, the least damped first.
    """
    step, base = system.step, system.step * system.speed
    energy = shares(states)
    shapes = made.shape @ states
    shapes = shapes / np.linalg.norm(shapes, axis=(0, 1))
    mean, edges = orders @ energy / step, energy[0] + energy[-1]
    # the small number decides between two copies half a step from zero; copies of what is not
    # resolved do not tell that they are copies, and come last
    waiting = np.argsort(np.abs(mean - 1e-2) + 10.0 * (edges > _LOST), kind="stable")
    waits, pairs, single = np.ones(len(values), dtype=bool), [], []
    for i in waiting:
        if 2 * len(pairs) + len(single) >= 2 * system.size:
            break
        if not waits[i]:
            continue
        left = edges + edges[i]
        left = np.maximum(left, np.minimum(_AWAY * left, _MOST_AWAY))
        near = (_COPY + left) * abs(base) + 1e-6 * abs(values[i])
        own = _copies(values, shapes, values[i], shapes[:, :, i], base, near)
        mirrored = shapes[::-1, :, i].conj()
        mirrored = _copies(values, shapes, values[i].conj(), mirrored, base, near)
        waits[own] = waits[mirrored] = waits[i] = False
        if i in mirrored:
            single.append(i)
        else:
            pairs.append(i)
    single.sort(key=lambda i: -values[i].real)
    return np.array([*pairs, *single], dtype=int), np.repeat([2, 1], [len(pairs), len(single)])


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
