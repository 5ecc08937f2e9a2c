"""Following modes over spin speed by their shape and their signed frequency."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from exudyn_rotor.linear.periodic.eigenvalues import groups
from exudyn_rotor.linear.periodic.floquet_modes import FloquetModes
from exudyn_rotor.threads import one_thread

# how strongly a jump in frequency counts against a likeness of shapes
_JUMP_WEIGHT = 0.5
# a frequency in the rotor frame moves by nΩ at most; waves up to four nodal diameters are allowed
_STEEPEST = 4.0
# a match is another mode below this likeness, or beyond this many steepest changes of frequency
_LEAST_LIKENESS, _MOST_CHANGES = 0.25, 2.0
_NO_FREQUENCY = 1e-7  # of the highest: a free motion


@dataclass(frozen=True, eq=False)
class Tracks:
    """Modes followed over the speeds.

    Attributes
    ----------
    columns : ndarray of int, shape (s, k)
        Which column continues each mode of the first speed.
    continued : ndarray of bool, shape (s, k)
        Whether it is the same mode as at the speed before.
    """

    columns: np.ndarray
    continued: np.ndarray


@one_thread()
def track(
    modes: Sequence[FloquetModes],
    speeds: np.ndarray,
    weigh: Callable[[np.ndarray], np.ndarray],
) -> Tracks:
    """Return which column continues each mode of the first speed.

    Neighbouring speeds are matched as a whole (assignment problem) by the mass-weighted modal
    assurance criterion ``|φᴴMψ|² / (φᴴMφ ψᴴMψ)`` and the distance of the signed frequencies. A
    frequency that passes zero in the rotor frame goes on as the conjugate motion; copies
    ``λ + ipΩ`` of a Floquet exponent count as one motion.

    Parameters
    ----------
    modes : sequence of FloquetModes
        One for each speed.
    speeds : ndarray, shape (s,)
        [rad/s]
    weigh : callable
        Multiplies vectors (c, k) by the mass matrix.
    """
    count = modes[0].values.size
    columns = np.empty((len(modes), count), dtype=np.int64)
    columns[0] = np.arange(count)
    continued = np.ones((len(modes), count), dtype=bool)
    signed = modes[0].values.imag.copy()
    last = _stack(modes[0])
    for step in range(1, len(modes)):
        change = abs(speeds[step] - speeds[step - 1])
        cost = np.full((count, count), np.inf)
        choice = np.zeros((count, count), dtype=np.int64)
        same = np.zeros((count, count), dtype=bool)
        copies = list(_copies(modes[step], speeds[step]))
        together = _of_one_value(modes[step])
        at_rest = 0.0 in (speeds[step - 1], speeds[step])
        for number, (frequency, stack) in enumerate(copies):
            # at rest nothing turns, and all harmonics are one motion
            pair = (_together(last), _together(stack)) if at_rest else (last, stack)
            likeness = _mac(*pair, weigh)
            jump = np.abs(frequency[None, :] - signed[:, None])
            allowed = _STEEPEST * change + 1e-3 * np.abs(signed[:, None]) + modes[step].resolution
            entry = 1.0 - likeness + _JUMP_WEIGHT * np.minimum(jump / allowed, 4.0)
            better = entry < cost
            cost[better], choice[better] = entry[better], number
            alike = likeness @ together >= _LEAST_LIKENESS
            alike &= jump <= _MOST_CHANGES * allowed
            alike |= _both_at_rest(signed, frequency)
            same[better] = alike[better]
        rows, matched = linear_sum_assignment(cost)
        columns[step, rows] = matched
        continued[step, rows] = same[rows, matched]
        used = choice[rows, matched]
        signed = np.array([copies[c][0][j] for c, j in zip(used, matched, strict=True)])
        orders = sorted({m for c in used for m in copies[c][1]})
        last = {
            m: np.column_stack(
                [
                    copies[c][1][m][:, j] if m in copies[c][1] else 0.0 * modes[step].central[:, j]
                    for c, j in zip(used, matched, strict=True)
                ]
            )
            for m in orders
        }
    return Tracks(columns, continued)


def _both_at_rest(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Return True for pairs of free motions, whose shapes are arbitrary, shape (k, k)."""
    rest = [np.abs(values) <= _NO_FREQUENCY * np.abs(values).max() for values in (before, after)]
    return np.outer(*rest)


def _of_one_value(modes: FloquetModes) -> np.ndarray:
    """Return 1 where two modes have one eigenvalue, so that their shapes are arbitrary, (k, k)."""
    result = np.eye(modes.values.size)
    for group in groups(modes.values, modes.resolution):
        result[np.ix_(group, group)] = 1.0
    return result


Stack = dict[int, np.ndarray]


def _stack(modes: FloquetModes) -> Stack:
    return {int(m): X for m, X in zip(modes.orders, modes.vectors, strict=True)}


def _together(stack: Stack) -> Stack:
    return {0: sum(stack.values())}


def _copies(modes: FloquetModes, speed: float) -> Iterator[tuple[np.ndarray, Stack]]:
    """Yield signed frequencies and harmonics of the same motions in their other forms."""
    stack = _stack(modes)
    step = int(modes.orders[1] - modes.orders[0]) if len(modes.orders) > 1 else 0
    for shift in (-step, 0, step) if step else (0,):
        moved = {m - shift: X for m, X in stack.items()}
        frequency = modes.values.imag + shift * speed
        yield frequency, moved
        yield -frequency, {-m: X.conj() for m, X in moved.items()}


def _mac(first: Stack, second: Stack, weigh: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Return the modal assurance criterion of all pairs, shape (k, k)."""
    product = sum(X.conj().T @ weigh(second[m]) for m, X in first.items() if m in second)
    if np.ndim(product) == 0:
        return np.zeros((next(iter(first.values())).shape[1],) * 2)
    norms = [_norms(stack, weigh) for stack in (first, second)]
    return np.abs(product) ** 2 / np.maximum(np.outer(*norms), 1e-300)


def _norms(stack: Stack, weigh: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    return sum(np.einsum("ck,ck->k", X.conj(), weigh(X)).real for X in stack.values())
