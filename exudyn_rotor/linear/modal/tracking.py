"""Following modes over spin speed by their shape and their frequency."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

import numpy as np
from scipy.optimize import linear_sum_assignment

from exudyn_rotor.linear.modal.whirl import BACKWARD, FORWARD, Named
from exudyn_rotor.linear.solve.motions import Motions

# how strongly jumps of the frequency seen from outside and of the growth, and another sense of
# whirl, count against a likeness of shapes
_JUMP_WEIGHT, _GROWTH_WEIGHT, _SENSE_WEIGHT = 0.5, 0.25, 0.25
_STEEPEST = 2.0  # change of a frequency over that of the speed: a thin disc's forward mode
_SPREAD = 1e-2  # share of a frequency by which it may change in any step
# a match is another mode below this likeness, or beyond this many steepest changes
_LEAST_LIKENESS, _MOST_CHANGES = 0.25, 3.0
_SAME = 1e-6  # relative distance of λ of motions whose shapes are arbitrary


def track(
    named: Sequence[Named | None], speeds: np.ndarray, M: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return which column continues each mode of the first speed, and whether it is the same mode.

    Neighbouring speeds are matched as a whole (assignment problem) by the mass-weighted modal
    assurance criterion ``|φᴴMψ|² / (φᴴMφ ψᴴMψ)``, the frequency seen from outside, and the growth.
    A motion and its conjugate are one. Speeds without values are passed over.

    Parameters
    ----------
    named : sequence of Named or None
        One for each speed.
    speeds : ndarray, shape (s,)
        [rad/s]
    M : ndarray, shape (k, k)
        Mass matrix.

    Returns
    -------
    columns : ndarray of int, shape (s, k)
    continued : ndarray of bool, shape (s, k)
    """
    known = [i for i, each in enumerate(named) if each is not None]
    count = len(named[known[0]].inertial)
    columns = np.tile(np.arange(count), (len(named), 1))
    continued = np.ones(columns.shape, dtype=bool)
    for before, after in itertools.pairwise(known):
        matched, same = _step(named[before], named[after], speeds[after] - speeds[before], M)
        last = columns[before]
        columns[after], continued[after] = matched[last], same[last]
        columns[before + 1 : after] = last
    return columns, continued


def _step(
    before: Named, after: Named, change: float, M: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return which motion continues each, (k,), and whether as the same mode."""
    likeness = _likeness(before.motions, after.motions, M)
    jump = np.abs(after.inertial[None, :] - before.inertial[:, None])
    larger = np.maximum(after.inertial[None, :], before.inertial[:, None])
    allowed = _STEEPEST * abs(change) + _SPREAD * larger + before.motions.bound
    growth = [each.motions.values.real for each in (before, after)]
    apart = np.abs(growth[1][None, :] - growth[0][:, None])
    size = np.abs(growth[1])[None, :] + np.abs(growth[0])[:, None] + before.motions.bound
    cost = 1.0 - likeness + _JUMP_WEIGHT * np.minimum(jump / allowed, 4.0)
    cost += _GROWTH_WEIGHT * np.minimum(apart / np.maximum(size, 1e-300), 1.0)
    senses = [(each.codes == FORWARD) * 1 - (each.codes == BACKWARD) for each in (before, after)]
    cost += _SENSE_WEIGHT * (senses[0][:, None] * senses[1] < 0)
    _, matched = linear_sum_assignment(np.nan_to_num(cost, nan=10.0))
    rows = np.arange(len(matched))
    values = after.motions.values
    alike = np.abs(values[:, None] - values) <= _SAME * np.abs(values) + after.motions.bound
    together = np.sum(likeness[:, None, :] * alike[None], axis=2)[rows, matched]
    same = (together >= _LEAST_LIKENESS) & (
        jump[rows, matched] <= _MOST_CHANGES * allowed[rows, matched]
    )
    resting = (np.abs(before.motions.values) == 0.0) & (np.abs(values[matched]) == 0.0)
    return matched, same | resting


def _likeness(before: Motions, after: Motions, M: np.ndarray) -> np.ndarray:
    """Return the modal assurance criterion of all pairs, the largest of all forms, (k, k)."""
    if 0.0 in (before.speed, after.speed):  # at rest all harmonics are one motion
        before, after = _together(before), _together(after)
    first = dict(zip(before.orders.tolist(), before.vectors, strict=True))
    norms = [_norms(each, M) for each in (before, after)]
    best = np.zeros((len(before.values), len(after.values)))
    for second in _forms(after):
        product = sum(first[m].conj().T @ M @ X for m, X in second.items() if m in first)
        if np.ndim(product):
            sizes = np.maximum(np.outer(*norms), 1e-300)
            best = np.maximum(best, np.abs(np.nan_to_num(product)) ** 2 / sizes)
    return best


def _together(motions: Motions) -> Motions:
    total = motions.vectors.sum(axis=0, keepdims=True)
    return Motions(motions.speed, motions.values, total, np.array([0]), motions.bound)


def _norms(motions: Motions, M: np.ndarray) -> np.ndarray:
    x = np.nan_to_num(motions.vectors)
    return np.einsum("hck,cd,hdk->k", x.conj(), M, x, optimize=True).real


def _forms(motions: Motions) -> Iterator[dict[int, np.ndarray]]:
    """Yield the harmonics of motions in their other forms: copies λ + ipΩ, and conjugates."""
    orders, vectors = motions.orders, np.nan_to_num(motions.vectors)
    step = int(orders[1] - orders[0]) if len(orders) > 1 else 0
    for shift in (-step, 0, step) if step else (0,):
        yield {int(m) + shift: X for m, X in zip(orders, vectors, strict=True)}
        yield {-int(m) - shift: X.conj() for m, X in zip(orders, vectors, strict=True)}
