"""Which flexible modes a scene needs: leave one out, look at the response, keep what matters.

The response of the interfaces to forces at them, to uniform acceleration and to the rotor's own
unbalance is computed with all modes and without some, over the speeds and over the frequencies of
the rotor frame. Loads grow by ``exp(0.05 ν t)``: at an undamped resonance no finite number of modes
has an accuracy, and this compares every resonance as if its damping ratio were 5 % larger than it
is.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from exudyn_rotor.advice.candidate import Candidate, Hill
from exudyn_rotor.advice.request import Request

GROWTH = 0.05  # per radian
_FREQUENCIES = 9
_SPEEDS = 9  # within a range, at which unbalance may meet a resonance
_UNMOVED = 1e-6  # share of the largest response; the load is at a place that is held
_ALIKE = 0.01  # relative distance of frequencies of a pair: both planes of bending go together


@dataclass(frozen=True, eq=False)
class Truncation:
    """Flexible modes that stay.

    Attributes
    ----------
    kept : ndarray of int
        Flexible modes, counted from 0.
    error : float
        Largest relative change of the response by what was left out.
    in_band : int
        Number of modes kept because their frequency lies in the band.
    missing : float or None
        Relative change of the response by attachment modes beside all modes given; None where
        these are not known.
    """

    kept: np.ndarray
    error: float
    in_band: int
    missing: float | None


@dataclass(frozen=True, eq=False)
class Point:
    """Compliance at one speed and frequency, where modes can be left out.

    Attributes
    ----------
    H : ndarray, shape (n, n)
    rows : ndarray, shape (p, n)
        Displacements that count.
    loads : ndarray, shape (n, l)
    places : ndarray of int, shape (modes, h)
        Where each flexible mode stands, harmonic by harmonic.
    response : ndarray, shape (p, l)
        With all modes.
    """

    H: np.ndarray
    rows: np.ndarray
    loads: np.ndarray
    places: np.ndarray
    response: np.ndarray

    def error_without(self, dropped: np.ndarray) -> float:
        """Return the largest relative change of the response to any load without some modes.

        Holding coordinates d still changes the compliance H by ``−H_d (H_dd)⁻¹ H_dᵀ``.
        """
        d = self.places[dropped].ravel()
        inner = np.linalg.solve(self.H[np.ix_(d, d)], self.H[d] @ self.loads)
        change = self.rows @ (self.H[:, d] @ inner)
        return largest_share(change, np.linalg.norm(self.response, axis=0))


def choose_modes(given: Candidate, request: Request) -> Truncation:
    """Return the fewest modes whose response is within half the accuracy of that with all.

    Modes with a frequency in the band stay in any case. The others are left out one pair after
    the other, those first that change the response least.
    """
    frequencies = given.frequencies
    plan = list(exponents(given, request))
    points = [_point(given, *each) for each in plan]
    missing = None
    if given.attached is not None:
        attached = [_point(given.attached, *each).response for each in plan]
        missing = _missing([one.response for one in points], attached, given.supported)
    groups = [g for g in _alike(frequencies) if g.size and frequencies[g].min() > request.highest]

    def error_without(chosen: list[np.ndarray]) -> float:
        return max(one.error_without(np.concatenate(chosen)) for one in points) if chosen else 0.0

    scores = [error_without([group]) for group in groups]
    ranked = [groups[i] for i in np.argsort(scores, kind="stable")]
    low, high, error = 0, len(ranked), 0.0
    while low < high:  # the error grows with the number left out
        middle = (low + high + 1) // 2
        change = error_without(ranked[:middle])
        if change <= request.allowed:
            low, error = middle, change
        else:
            high = middle - 1
    dropped = np.concatenate(ranked[:low]) if low else np.zeros(0, dtype=int)
    return Truncation(
        kept=np.setdiff1d(np.arange(frequencies.size), dropped),
        error=error,
        in_band=int(np.sum(frequencies <= request.highest)),
        missing=missing,
    )


def exponents(
    given: Candidate, request: Request, steady: float | None = None
) -> Iterator[tuple[float, complex]]:
    """Yield speeds and exponents s of loads in the rotor frame to look at.

    Over the band evenly and at the resonances in it; unbalance at more speeds. With `steady`, a
    growth per radian, weight and unbalance alone at the speeds.
    """
    for speed in request.speeds:
        highest = request.loads + speed
        if steady is None:
            frequencies, growth = np.linspace(0.0, highest, _FREQUENCIES), GROWTH
            if given.supported:
                own = np.unique(np.round(given.motions(speed)[0].imag, 6))
                frequencies = [*frequencies, *own[(own > 0.0) & (own <= highest)]]
        else:
            frequencies, growth = [0.0, speed] if speed else [], steady
        for nu in frequencies:
            yield float(speed), 1j * nu + growth * max(nu, speed, 0.1 * request.highest)
    if given.supported and request.low < request.high:
        for speed in np.linspace(request.low, request.high, _SPEEDS)[1:-1]:
            yield float(speed), complex(GROWTH * speed)


def largest_share(change: np.ndarray, sizes: np.ndarray, least: float = 0.0) -> float:
    """Return the largest change of a column over its size; not where that is next to nothing.

    Columns smaller than the share `least` of the largest do not count.
    """
    moved = sizes > least * sizes.max(initial=0.0)
    shares = np.linalg.norm(change, axis=0)[moved] / sizes[moved]
    return float(shares.max(initial=0.0))


def ends(given: Candidate, made: Hill) -> tuple[np.ndarray, np.ndarray]:
    """Return displacements that count (p, n) and load columns (n, l) over all harmonics."""
    motion = given.motion()
    # flexible modes alone do not feel the acceleration of the whole
    columns = np.vstack([motion, given.inertia_loads()] if given.supported else [motion]).T
    loads = np.zeros((len(made.M), columns.shape[1]))
    start = made.count * (len(made.orders) // 2)
    loads[start : start + made.count] = columns
    return np.kron(np.eye(len(made.orders)), motion), loads


def _point(given: Candidate, speed: float, s: complex) -> Point:
    made = given.hill(speed)
    places = given.flexible[:, None] + made.count * np.arange(len(made.orders))
    # where it is not known what holds the rotor, its own flexibility alone counts
    used = np.arange(len(made.M)) if given.supported else np.sort(places.ravel())
    used = used[~np.isin(used % made.count, given.held)]
    rows, loads = ends(given, made)
    rows, loads = rows[:, used], loads[used]
    H = np.linalg.inv((s**2 * made.M + s * made.D + made.K)[np.ix_(used, used)])
    return Point(H, rows, loads, np.searchsorted(used, places), rows @ (H @ loads))


def _missing(given: list[np.ndarray], attached: list[np.ndarray], supported: bool) -> float:
    """Return the largest relative change of the response to any load by attachment modes.

    Where it is not known what holds the rotor, relative to the response to the load that moves its
    interfaces most: the flexible modes need not move them under every load.
    """
    worst = 0.0
    for response, with_attachments in zip(given, attached, strict=True):
        sizes = np.linalg.norm(with_attachments, axis=0)
        if not supported:
            sizes[:] = sizes.max(initial=0.0)
        worst = max(worst, largest_share(with_attachments - response, sizes, _UNMOVED))
    return worst


def _alike(frequencies: np.ndarray) -> list[np.ndarray]:
    """Split ascending frequencies into groups of nearly equal ones."""
    gaps = np.diff(frequencies) > _ALIKE * frequencies[1:]
    return np.split(np.arange(frequencies.size), np.flatnonzero(gaps) + 1)
