"""Resonances between the points of a response: where to add points, and the peak between three.

Through a resonance the phase turns by π, however narrow it is. Between two points with another
phase lies one, or a place without motion, and halving such intervals finds it.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from typing import Protocol

import numpy as np

from exudyn_rotor.callers import user_level

Motion = Mapping[int, np.ndarray]


class Seen(Protocol):
    """A solution, its motion harmonics (p, 6) of what is looked at."""

    motion: Motion


# phase between neighbours [rad]; at the peak of one mode 0.3 rad leave 1 − cos(0.15), 1 %, between
_MOST_TURN = 0.3
# a motion that is smaller than this share of the largest does not count
_SMALL = 1e-3
# of the range: without damping a resonance has no width
_NARROWEST = 1e-7
_MOST_ROUNDS = 30
_MOST_ADDED = 4000
HALF_POWER = np.sqrt(0.5)  # of the size at a peak
STILL = 1e-6  # share of a peak below which a neighbour stands still, as at rest without a load


def refined(
    solve: Callable[[np.ndarray], list[Seen]], values: np.ndarray, solutions: list[Seen]
) -> tuple[np.ndarray, list[Seen]]:
    """Add points until the phase of every motion turns little between neighbours.

    No point is added where there is no steady motion, as at a resonance without damping.

    Parameters
    ----------
    solve : callable
        Gives the solutions at an array of speeds or frequencies.
    values : ndarray, shape (s,)
        Ascending speeds or frequencies [rad/s].
    solutions : list of s solutions
        Those there.

    Returns
    -------
    ndarray, list
        All speeds or frequencies, and their solutions.
    """
    narrowest, start, without = _NARROWEST * np.ptp(values), len(values), []
    for _ in range(_MOST_ROUNDS):
        wide = np.diff(values) > narrowest
        wide &= ~np.isin(_middles(values), without)
        between = np.flatnonzero(wide & (_turns([one.motion for one in solutions]) > _MOST_TURN))
        if between.size == 0 or len(values) - start > _MOST_ADDED:
            break
        added = _middles(values)[between]
        solved = _solved(solve, added)
        missing = np.array([one is None for one in solved])
        without += added[missing].tolist()
        between, added = between[~missing], added[~missing]
        solved = [one for one in solved if one is not None]
        values = np.insert(values, between + 1, added)
        for count, (place, one) in enumerate(zip(between, solved, strict=True)):
            solutions.insert(place + 1 + count, one)
    return values, solutions


def _middles(values: np.ndarray) -> np.ndarray:
    return 0.5 * (values[:-1] + values[1:])


def _solved(solve: Callable[[np.ndarray], list[Seen]], values: np.ndarray) -> list[Seen | None]:
    """Return the solutions, None where there is none; one by one if not all can be solved."""
    try:
        return solve(values)
    except ValueError:
        if len(values) == 1:
            return [None]
        return [one for value in values for one in _solved(solve, np.array([value]))]


def _turns(motions: list[Motion]) -> np.ndarray:
    """Return the largest change of phase between neighbours, shape (s − 1,) [rad]."""
    orders = sorted({n for motion in motions for n in motion})
    still = np.zeros_like(next(iter(motions[0].values())))
    table = np.array([[motion.get(n, still) for n in orders] for motion in motions])
    phasors = table[..., :3].reshape(len(motions), -1)
    size = np.abs(phasors)
    matters = np.maximum(size[1:], size[:-1]) > _SMALL * size.max()
    matters &= np.minimum(size[1:], size[:-1]) > 0.0
    turned = np.abs(np.angle(phasors[1:] * phasors[:-1].conj()))
    # at rest without a load there is no phase, and beside it may be a resonance
    sizes = size.max(axis=1, initial=0.0)
    beside_rest = (np.minimum(sizes[1:], sizes[:-1]) == 0.0) & (
        np.maximum(sizes[1:], sizes[:-1]) > _SMALL * sizes.max(initial=0.0)
    )
    return np.where(beside_rest, np.pi, np.where(matters, turned, 0.0).max(axis=1, initial=0.0))


def resolved_peak(
    at: np.ndarray, size: np.ndarray, index: int, name: str, was_refined: bool
) -> tuple[float, float]:
    """Return place and size of the maximum at a point, by its neighbours.

    A warning with the `name` tells where these are beyond half of the power of the maximum, and
    what to do where points were added already.
    """
    near = slice(index - 1, index + 2)
    if size[near].min() < HALF_POWER * size[index]:
        advice = "compute the response with refine=True"
        if was_refined:
            advice = "refine=True adds no more: give more of them there, or add damping"
        warnings.warn(
            f"{name}: the points around the peak at {at[index]:g} rad/s are too far apart to give "
            f"its size and width; {advice}",
            UserWarning,
            stacklevel=user_level(),
        )
    return peak_between(at[near], size[near])


def peak_between(at: np.ndarray, size: np.ndarray) -> tuple[float, float]:
    """Return place and size of a maximum by the point with the largest size and its neighbours.

    Near a resonance 1/size² is a parabola, for one mode exactly. Three points, the middle one the
    largest.
    """
    shift, seen = at - at[1], np.maximum(size, STILL * size[1])
    square, slope, middle = np.polyfit(shift, (size[1] / seen) ** 2, 2)
    if square <= 0.0:
        return float(at[1]), float(size[1])
    place = float(np.clip(-0.5 * slope / square, shift[0], shift[2]))
    least = square * place**2 + slope * place + middle
    # as close to a pole as the parabola may put it, no size follows from it
    return float(at[1] + place), float(size[1] / np.sqrt(max(least, 0.25)))
