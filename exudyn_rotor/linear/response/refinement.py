"""Resonances between the points of a response: where to add points, and the peak between three.

Through a resonance the phase turns by π, however narrow it is. Between two points with another
phase lies one, or a place without motion, and halving such intervals finds it.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from exudyn_rotor.calls import user_level

Solved = Mapping[int, np.ndarray]  # harmonics (s, k)
_MOST_TURN = 0.3  # phase [rad] between neighbours: 1 − cos(0.15) = 1 % of a peak lies between
_SMALL = 1e-3  # share of the largest motion below which a motion does not count
_NARROWEST = 1e-7  # of the range: without damping a resonance has no width
_MOST_ROUNDS = 30
_MOST_ADDED = 4000
HALF_POWER = np.sqrt(0.5)  # of the size at a peak
STILL = 1e-6  # share of a peak below which a neighbour stands still, as at rest without a load


def refined(
    solve: Callable[[np.ndarray], Solved],
    phasors: Callable[[Solved], np.ndarray],
    values: np.ndarray,
    solved: Solved,
) -> tuple[np.ndarray, Solved]:
    """Add points until the phase of every motion turns little between neighbours.

    No point is added where there is no steady motion, as at a resonance without damping, nor
    beside such a value.

    Parameters
    ----------
    solve : callable
        Gives the solutions at an array of speeds or frequencies.
    phasors : callable
        Gives the complex amplitudes (s, c) of solutions.
    values : ndarray, shape (s,)
        Ascending speeds or frequencies [rad/s].
    solved : mapping of int to ndarray, shape (s, k)
        The solutions there, by their harmonics.

    Returns
    -------
    ndarray, mapping
        All speeds or frequencies, and their solutions.
    """
    narrowest, most = _NARROWEST * np.ptp(values), len(values) + _MOST_ADDED
    given = values
    for _ in range(_MOST_ROUNDS):
        wide = (np.diff(values) > narrowest) & (_turns(phasors(solved)) > _MOST_TURN)
        between = np.flatnonzero(wide)[: most - len(values)]
        if between.size == 0:
            break
        added = 0.5 * (values[between] + values[between + 1])
        order = np.argsort(np.r_[values, added], kind="stable")
        solved = _merged(solved, solve(added), order)
        values = np.r_[values, added][order]
    known = np.all(np.isfinite(phasors(solved)), axis=1) | np.isin(values, given)
    return values[known], {n: X[known] for n, X in solved.items()}


def _merged(first: Solved, second: Solved, order: np.ndarray) -> Solved:
    """Return solutions of some values and of others, in order; a harmonic may be in one of them."""
    parts = [(each, np.zeros_like(next(iter(each.values())))) for each in (first, second)]
    return {
        n: np.concatenate([each.get(n, none) for each, none in parts])[order]
        for n in sorted({*first, *second})
    }


def _turns(phasors: np.ndarray) -> np.ndarray:
    """Return the largest change of phase between neighbours, shape (s − 1,) [rad]."""
    known = np.all(np.isfinite(phasors), axis=1)
    size = np.abs(np.where(known[:, None], phasors, 0.0))
    matters = np.maximum(size[1:], size[:-1]) > _SMALL * size.max(initial=0.0)
    matters &= np.minimum(size[1:], size[:-1]) > 0.0
    turned = np.abs(np.angle(np.where(matters, phasors[1:] * phasors[:-1].conj(), 1.0)))
    # at rest without a load there is no phase, and beside it may be a resonance
    sizes = size.max(axis=1, initial=0.0)
    beside_rest = (np.minimum(sizes[1:], sizes[:-1]) == 0.0) & (
        np.maximum(sizes[1:], sizes[:-1]) > _SMALL * sizes.max(initial=0.0)
    )
    turned = np.where(beside_rest, np.pi, turned.max(axis=1, initial=0.0))
    return np.where(known[1:] & known[:-1], turned, 0.0)


def resolved_peak(at: np.ndarray, size: np.ndarray, index: int) -> tuple[float, float, bool]:
    """Return place and size of the maximum at a point by its neighbours, and if they are near.

    They are not where one of them is below half of the power of the maximum.
    """
    near = slice(index - 1, index + 2)
    is_near = bool(size[near].min() >= HALF_POWER * size[index])
    return *peak_between(at[near], size[near]), is_near


def warn_of_coarse_peaks(coarse: Sequence[tuple[str, float]], was_refined: bool) -> None:
    """Warn of peaks [rad/s] at places whose neighbours are too far apart, once for all."""
    if not coarse:
        return
    advice = "compute the response with refine=True"
    if was_refined:
        advice = "refine=True adds no more: give more of them there, or add damping"
    name, at = coarse[0]
    more = f" (and {len(coarse) - 1} more)" if len(coarse) > 1 else ""
    warnings.warn(
        f"{name}: the points around the peak at {at:g} rad/s{more} are too far apart to give its "
        f"size and width; {advice}",
        UserWarning,
        stacklevel=user_level(),
    )


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
