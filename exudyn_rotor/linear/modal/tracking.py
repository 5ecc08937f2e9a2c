"""Following modes over spin speed by their shape and their frequency."""

from __future__ import annotations

import itertools

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
_DIGITS = 9  # of costs that are compared
_SAME = 1e-6  # relative distance of λ of motions whose shapes are arbitrary


def track(named: Named, M: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return which column continues each mode of the first speed, and whether it is the same mode.

    Neighbouring speeds are matched as a whole (assignment problem) by the mass-weighted modal
    assurance criterion ``|φᴴMψ|² / (φᴴMφ ψᴴMψ)``, the frequency seen from outside, and the growth.
    A motion and its conjugate are one. Speeds without values are passed over.

    Parameters
    ----------
    named : Named
        At s speeds.
    M : ndarray, shape (k, k)
        Mass matrix.

    Returns
    -------
    columns : ndarray of int, shape (s, k)
    continued : ndarray of bool, shape (s, k)
    """
    known, (s, k) = named.motions.known, named.inertial.shape
    columns, continued = np.tile(np.arange(k), (s, 1)), np.ones((s, k), dtype=bool)
    matched, same = _steps(named.rows(known), M)
    for step, (before, after) in enumerate(itertools.pairwise(known)):
        last = columns[before]
        columns[after], continued[after] = matched[step][last], same[step][last]
        columns[before + 1 : after] = last
    return columns, continued


def _steps(named: Named, M: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return which motion continues each at the next speed, (s − 1, k), and whether as one mode."""
    values, bounds = named.motions.values, named.motions.bounds[:-1, None, None]
    likeness = _likeness(named.motions, M)
    before, after = named.inertial[:-1, :, None], named.inertial[1:, None]
    jump, change = np.abs(after - before), np.abs(np.diff(named.motions.speeds))[:, None, None]
    allowed = _STEEPEST * change + _SPREAD * np.maximum(after, before) + bounds
    growth = values.real[:-1, :, None], values.real[1:, None]
    size = np.abs(growth[0]) + np.abs(growth[1]) + bounds
    cost = 1.0 - likeness + _JUMP_WEIGHT * np.minimum(jump / allowed, 4.0)
    apart = np.abs(growth[1] - growth[0]) / np.maximum(size, 1e-300)
    cost += _GROWTH_WEIGHT * np.minimum(apart, 1.0)
    senses = (named.codes == FORWARD) * 1 - (named.codes == BACKWARD)
    cost += _SENSE_WEIGHT * (senses[:-1, :, None] * senses[1:, None] < 0)
    cost = np.round(np.nan_to_num(cost, nan=10.0), _DIGITS)
    found = [linear_sum_assignment(each)[1] for each in cost]
    matched = np.array(found, dtype=int).reshape(-1, values.shape[1])

    def of_match(X: np.ndarray) -> np.ndarray:
        return np.take_along_axis(X, matched[:, :, None], 2)[:, :, 0]

    later, sizes = values[1:], np.abs(values[1:, None]) + 0.0
    alike = np.abs(later[:, :, None] - later[:, None]) <= _SAME * sizes + bounds
    together = of_match(likeness @ np.swapaxes(alike, 1, 2))
    same = (together >= _LEAST_LIKENESS) & (of_match(jump) <= _MOST_CHANGES * of_match(allowed))
    ends = np.take_along_axis(later, matched, 1)
    return matched, same | ((values[:-1] == 0.0) & (ends == 0.0))


def _likeness(motions: Motions, M: np.ndarray) -> np.ndarray:
    """Return the modal assurance criterion of all pairs at neighbouring speeds, (s − 1, k, k)."""
    vectors, speeds = motions.vectors, motions.speeds
    if np.any(np.isnan(motions.values)):
        vectors = np.nan_to_num(vectors)
    found = _of_pairs(vectors, M)
    rests = np.flatnonzero((speeds[1:] == 0.0) | (speeds[:-1] == 0.0))
    if vectors.shape[1] > 1 and rests.size:  # at rest all harmonics are one motion
        total = vectors.sum(axis=1, keepdims=True)
        for place in rests:
            found[place] = _of_pairs(total[place : place + 2], M)[0]
    return found


def _of_pairs(vectors: np.ndarray, M: np.ndarray) -> np.ndarray:
    """Return the criterion of motions (s, h, c, k), the largest of the forms of the later one.

    These are its copies λ + ipΩ, with harmonics by one more or less, and their conjugates.
    """
    weighted = M @ vectors
    norms = np.sum(vectors.conj() * weighted, axis=(1, 2)).real
    before, after = np.swapaxes(vectors[:-1].conj(), 2, 3), weighted[1:]
    h, best = vectors.shape[1], 0.0
    for later in (after, after[:, ::-1].conj()):
        for shift in (-1, 0, 1) if h > 1 else (0,):
            first, second = (
                slice(max(shift, 0), h + min(shift, 0)),
                slice(max(-shift, 0), h - max(shift, 0)),
            )
            product = np.sum(before[:, first] @ later[:, second], axis=1)
            best = np.maximum(best, product.real**2 + product.imag**2)
    return best / np.maximum(norms[:-1, :, None] * norms[1:, None], 1e-300)
