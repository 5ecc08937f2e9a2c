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
from functools import cached_property

import numpy as np
import scipy.linalg

from exudyn_rotor.advice.candidate import Candidate
from exudyn_rotor.advice.request import Request

GROWTH = 0.05  # per radian
_FREQUENCIES = 9
_CRITICAL = 6  # speeds
_UNMOVED = 1e-6  # share of the largest response; the load is at a place that is held
_Plan = list[tuple[float, list[float]]]  # speeds, each with frequencies of the rotor frame
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
    top : float
        Relative change of the response by the highest fifth of all modes given.
    missing : float or None
        Relative change of the response by attachment modes beside all modes given; None where
        these are not known.
    """

    kept: np.ndarray
    error: float
    in_band: int
    top: float
    missing: float | None


@dataclass(frozen=True, eq=False)
class Responses:
    """Responses at all points with any choice of flexible modes.

    Attributes
    ----------
    points : list of (Z, rows, loads, places)
        Dynamic stiffness, displacements that count, loads, and where each flexible mode stands in
        Z, (modes, harmonics), at one speed and frequency.
    frequencies : ndarray
        Flexible frequencies [rad/s].
    """

    points: list[tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]]
    frequencies: np.ndarray

    @cached_property
    def complete(self) -> list[np.ndarray]:
        """Responses with all modes."""
        return [rows @ np.linalg.solve(Z, loads) for Z, rows, loads, _ in self.points]

    @cached_property
    def _compliances(self) -> list[np.ndarray]:
        return [np.linalg.inv(Z) for Z, *_ in self.points]

    def error_without(self, dropped: np.ndarray) -> float:
        """Return the largest relative change of the response to any load without some modes.

        Holding coordinates d still changes the compliance H by ``−H_d (H_dd)⁻¹ H_dᵀ``.
        """
        if len(dropped) == 0:
            return 0.0
        worst = 0.0
        for (_, rows, loads, all_places), H, response in zip(
            self.points, self._compliances, self.complete, strict=True
        ):
            places = all_places[dropped].ravel()
            inner = np.linalg.solve(H[np.ix_(places, places)], H[places] @ loads)
            change = rows @ (H[:, places] @ inner)
            worst = max(worst, largest_share(change, np.linalg.norm(response, axis=0)))
        return worst


def choose_modes(given: Candidate, request: Request) -> Truncation:
    """Return the fewest modes whose response is within half the accuracy of that with all.

    Modes with a frequency in the band stay in any case. The others are left out one pair after
    the other, those first that change the response least.
    """
    frequencies = given.frequencies
    plan = _plan(given, request)
    responses = _responses(given, request, plan)
    missing = None
    if given.attached is not None:
        missing = _missing(responses, _responses(given.attached, request, plan), given.supported)
    if frequencies.size == 0:
        return Truncation(np.zeros(0, dtype=int), 0.0, 0, 0.0, missing)
    groups = [g for g in _alike(frequencies) if frequencies[g].min() > request.highest]
    scores = [responses.error_without(group) for group in groups]
    ranked = [groups[i] for i in np.argsort(scores, kind="stable")]
    low, high, error = 0, len(ranked), 0.0
    while low < high:  # the error grows with the number left out
        middle = (low + high + 1) // 2
        change = responses.error_without(np.concatenate(ranked[:middle]))
        if change <= request.allowed:
            low, error = middle, change
        else:
            high = middle - 1
    dropped = np.concatenate(ranked[:low]) if low else np.zeros(0, dtype=int)
    every = np.arange(frequencies.size)
    return Truncation(
        kept=np.setdiff1d(every, dropped),
        error=error,
        in_band=int(np.sum(frequencies <= request.highest)),
        top=responses.error_without(every[-max(1, round(0.2 * every.size)) :]),
        missing=missing,
    )


def largest_share(change: np.ndarray, sizes: np.ndarray, least: float = 0.0) -> float:
    """Return the largest change of a column over its size; not where that is next to nothing.

    Columns smaller than the share `least` of the largest do not count.
    """
    moved = sizes > least * sizes.max(initial=0.0)
    shares = np.linalg.norm(change, axis=0)[moved] / sizes[moved]
    return float(shares.max(initial=0.0))


def _missing(given: Responses, attached: Responses, supported: bool) -> float:
    """Return the largest relative change of the response to any load by attachment modes.

    Where it is not known what holds the rotor, relative to the response to the load that moves its
    interfaces most: the flexible modes need not move them under every load.
    """
    worst = 0.0
    for response, with_attachments in zip(given.complete, attached.complete, strict=True):
        sizes = np.linalg.norm(with_attachments, axis=0)
        if not supported:
            sizes[:] = sizes.max(initial=0.0)
        worst = max(worst, largest_share(with_attachments - response, sizes, _UNMOVED))
    return worst


def _alike(frequencies: np.ndarray) -> list[np.ndarray]:
    """Split ascending frequencies into groups of nearly equal ones."""
    gaps = np.diff(frequencies) > _ALIKE * frequencies[1:]
    return np.split(np.arange(frequencies.size), np.flatnonzero(gaps) + 1)


def _plan(given: Candidate, request: Request) -> _Plan:
    plan = [(speed, list(band(given, request, speed))) for speed in request.speeds]
    return plan + [(speed, [0.0]) for speed in critical(given, request)]


def _responses(given: Candidate, request: Request, plan: _Plan) -> Responses:
    points = []
    for speed, frequencies in plan:
        M, D, K, count = given.hill(speed)
        size = len(M) // count
        used, places = _coordinates(given, size, count)
        rows, loads = ends(given, size, count)
        for nu in frequencies:
            s = 1j * nu + GROWTH * max(nu, speed, 0.1 * request.highest)
            Z = s**2 * M + s * D + K
            points.append((Z[np.ix_(used, used)], rows[:, used], loads[used], places))
    return Responses(points, given.frequencies)


def _coordinates(given: Candidate, size: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the coordinates in use, and where the flexible modes stand among them.

    Where it is not known what holds the rotor, the flexibility of its flexible modes alone counts.
    """
    starts = size * np.arange(count)
    places = given.places[:, None] + starts
    used = np.arange(size * count) if given.supported else np.sort(places.ravel())
    used = used[~np.isin(used % size, given.held)]
    return used, np.searchsorted(used, places)


def ends(given: Candidate, size: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return displacements that count (p, n) and load columns (n, l) over all harmonics."""
    motion = given.motion()
    # flexible modes alone do not feel the acceleration of the whole
    columns = np.vstack([motion, given.inertia_loads()] if given.supported else [motion]).T
    loads = np.zeros((size * count, columns.shape[1]))
    start = size * (count // 2)
    loads[start : start + size] = columns
    return np.kron(np.eye(count), motion), loads


def band(given: Candidate, request: Request, speed: float) -> Iterator[float]:
    """Yield the frequencies to look at: evenly over the band, and the resonances in it."""
    yield from np.linspace(0.0, request.loads + speed, _FREQUENCIES)
    if given.supported:
        yield from np.unique(np.round(resonances(given, speed, request.loads + speed)[0], 6))


def critical(given: Candidate, request: Request) -> np.ndarray:
    """Return the lowest speeds in the range at which unbalance meets a resonance [rad/s].

    There ``K₀ + Ω² X`` is singular, as it is seen from the rotor; X is what one radian per second
    changes. Both come from the middle and the end of the range, as supports need not be known
    outside. Supports that change with the speed make this approximate.
    """
    if not given.supported or request.low == request.high:
        return np.zeros(0)
    middle = 0.5 * (request.low + request.high)
    _, _, K_middle, _ = given.conservative(middle)
    _, _, K_full, _ = given.conservative(request.high)
    if len(K_middle) != len(K_full):
        return np.linspace(request.low, request.high, _CRITICAL + 2)[1:-1]
    X = (K_full - K_middle) / (request.high**2 - middle**2)
    K = K_full - request.high**2 * X
    squares = scipy.linalg.eigvals(K, -X)
    squares = squares[np.isfinite(squares) & (np.abs(squares.imag) < 1e-6 * np.abs(squares))].real
    speeds = np.unique(np.round(np.sqrt(squares[squares > 0.0]), 6))
    return speeds[(speeds > request.low) & (speeds < request.high)][:_CRITICAL]


def resonances(
    given: Candidate, speed: float, highest: float
) -> tuple[np.ndarray, np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """Return the undamped eigenfrequencies 0 < ν ≤ `highest` in the rotor frame.

    Returns
    -------
    frequencies : ndarray, shape (r,)
        [rad/s]
    vectors : ndarray, shape (n, r)
    pencil : (M, G)
        Of ``−ν²M + νG + K``, for perturbations.
    """
    pencil = given.conservative(speed)[:3]
    size = len(pencil[0])
    scale = 1.0 / np.sqrt(np.maximum(np.abs(np.diag(pencil[0])), 1e-300))
    M, G, K = (scale[:, None] * X * scale for X in pencil)
    companion = np.block([[np.zeros_like(M), np.eye(size)], [K, G]])
    weight = np.block([[np.eye(size), np.zeros_like(M)], [np.zeros_like(M), M]])
    nu, vectors = scipy.linalg.eig(companion, weight)
    in_band = (np.abs(nu.imag) < 1e-6 * (np.abs(nu) + highest)) & (np.abs(nu) <= highest)
    in_band &= nu.real > 1e-6 * highest
    return nu[in_band].real, vectors[:size, in_band] * scale[:, None], pencil[:2]
