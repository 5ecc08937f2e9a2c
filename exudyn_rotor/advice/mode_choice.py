"""Which flexible modes a scene needs: leave one out, look at the response, keep what matters.

The response of the interfaces to forces at them, to uniform acceleration and to the rotor's own
unbalance is that over the speeds and over the frequencies of the rotor frame. Loads grow by
``exp(0.05 ν t)``: at an undamped resonance no finite number of modes has an accuracy.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from exudyn_rotor.advice.candidate import Candidate
from exudyn_rotor.advice.request import Request

GROWTH = 0.05  # per radian
_FREQUENCIES = 9
_ALIKE = 0.01  # relative distance of frequencies of a pair: both planes of bending go together


def _change_without(
    given: Candidate, speed: float, s: complex
) -> Callable[[list[np.ndarray]], float]:
    """Return the largest relative change of the response to any load, by the modes left out.

    The response is that at one speed and one exponent of the loads. Holding coordinates d still
    changes the compliance H by ``−H_d (H_dd)⁻¹ H_dᵀ``.
    """
    made, count = given.hill(speed), given.source.size
    used = np.flatnonzero(~np.isin(np.arange(len(made.M)) % count, given.held))
    rows, loads = given.ends_of_harmonics(made.orders)
    rows, loads = rows[:, used], loads[used]
    H = np.linalg.inv(made.stiffness(s)[np.ix_(used, used)])
    harmonics = np.arange(0, len(made.M), count)
    places = np.searchsorted(used, given.flexible[:, None] + harmonics)
    sizes = np.linalg.norm(rows @ (H @ loads), axis=0)

    def change(left_out: list[np.ndarray]) -> float:
        d = places[np.concatenate(left_out)].ravel()
        inner = np.linalg.solve(H[np.ix_(d, d)], H[d] @ loads)
        return largest_share(rows @ (H[:, d] @ inner), sizes)

    return change


def choose_modes(given: Candidate, request: Request) -> tuple[np.ndarray, float]:
    """Return the fewest modes whose response is within half the accuracy of that with all.

    Counted from 0, and the largest relative change of the response by the others. Modes with a
    frequency in the band stay in any case. The others are left out one pair after the other, those
    first that change the response least.
    """
    frequencies = given.frequencies
    changes = [_change_without(given, *each) for each in exponents(given, request)]
    gaps = np.diff(frequencies) > _ALIKE * frequencies[1:]
    pairs = np.split(np.arange(frequencies.size), np.flatnonzero(gaps) + 1)
    pairs = [pair for pair in pairs if pair.size and frequencies[pair].min() > request.highest]

    def error_without(left_out: list[np.ndarray]) -> float:
        return max(change(left_out) for change in changes)

    ranked, dropped, error = sorted(pairs, key=lambda pair: error_without([pair])), 0, 0.0
    for count in range(1, len(ranked) + 1):  # the error grows with the number left out
        change = error_without(ranked[:count])
        if change > request.allowed:
            break
        dropped, error = count, change
    left_out = np.concatenate([np.zeros(0, dtype=int), *ranked[:dropped]])
    return np.setdiff1d(np.arange(frequencies.size), left_out), error


def exponents(
    given: Candidate, request: Request, steady: float | None = None
) -> Iterator[tuple[float, complex]]:
    """Yield speeds and exponents s of loads in the rotor frame to look at.

    Over the band evenly and at the resonances in it. With `steady`, a growth per radian, weight and
    unbalance alone.
    """
    for speed in request.speeds:
        highest = request.loads + speed
        if steady is None:
            frequencies, growth = np.linspace(0.0, highest, _FREQUENCIES), GROWTH
            own = np.unique(np.round(given.motions(speed)[0].imag, 6))
            frequencies = [*frequencies, *own[(own > 0.0) & (own <= highest)]]
        else:
            frequencies, growth = [0.0, speed] if speed else [], steady
        for nu in frequencies:
            yield float(speed), 1j * nu + growth * max(nu, speed, 0.1 * request.highest)


def largest_share(change: np.ndarray, sizes: np.ndarray, least: float = 0.0) -> float:
    """Return the largest change of a column over its size; not where that is next to nothing.

    Columns smaller than the share `least` of the largest do not count.
    """
    moved = sizes > least * sizes.max(initial=0.0)
    shares = np.linalg.norm(change, axis=0)[moved] / sizes[moved]
    return float(shares.max(initial=0.0))
