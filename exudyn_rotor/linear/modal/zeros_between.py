"""Zeros of the eigenvalues of a Hermitian matrix function between two speeds.

As many eigenvalues as change their sign between the speeds have one zero each there. The linear
function through both matrices, ``H(Ω) ≈ H₀ + (Ω − Ω₀) S``, tells vectors x of all zeros near the
middle Ω₀ as the largest of ``H₀⁻¹S``, by subspace iteration. From these each zero is found by
inverse iteration ``H(Ω)⁻¹S x`` and Rayleigh's quotient, ``xᴴH(Ω)x = 0``, whose error is of second
order in that of x. Source: Voss, "Nonlinear Eigenvalue Problems", in Hogben (ed.), Handbook of
Linear Algebra (2013), Chap. 60. Signs between the zeros tell that none is another's, or where some
are missing: there, between closer ends, they are looked for again. Where that fails, each is found
as the zero of the sorted eigenvalue, by Brent's method.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cache
from itertools import pairwise

import numpy as np
import scipy.linalg as la
from scipy.linalg.lapack import zhetrf, zhetrs
from scipy.optimize import brentq

Matrix = Callable[[float], np.ndarray]
Pair = tuple[float, np.ndarray]
Part = tuple[tuple[float, float], tuple[int, int], list[Pair]]

_BLOCK = 64  # of LAPACK's work, in columns
_MORE, _TURNS = 4, 3  # vectors beside those asked for, and steps, of subspace iteration
_REACH = 0.75  # of the distance of the ends, from the middle: zeros of the linear function
_STEPS = 8  # of inverse iteration
# shares of the largest speed: the last step, after which one of second order is left, what the
# residual of its vector is as a speed, and the distance of zeros with no signs between them
_LAST, _RESIDUAL, _APART = 1e-9, 1e-6, 1e-7


def factorised(H: np.ndarray) -> tuple[np.ndarray, np.ndarray, int]:
    """Return the ``LDLᴴ`` factor of a Hermitian matrix, its pivots, and whether it is singular."""
    return zhetrf(H, lower=1, lwork=_BLOCK * len(H))


def count_negative(H: np.ndarray) -> int:
    """Return how many eigenvalues of a Hermitian matrix are negative."""
    factor, pivots, _ = factorised(H)
    # blocks of two rows, which have a negative number, have one of either sign
    single = np.diagonal(factor).real[pivots > 0]
    return int(np.count_nonzero(single < 0.0) + np.count_nonzero(pivots < 0) // 2)


def zeros_between(
    at: Matrix, ends: tuple[float, float], negative: tuple[int, int], limit: float
) -> list[Pair]:
    """Return the zeros of the sorted eigenvalues that change their sign, with null vectors.

    Parameters
    ----------
    at : callable
        The matrix at a speed.
    ends : tuple of float
        Two ascending speeds.
    negative : tuple of int
        How many eigenvalues are negative there.
    limit : float
        Largest speed; zeros err by about 1e-12 of it.
    """
    count = abs(negative[1] - negative[0])
    slope = (at(ends[1]) - at(ends[0])) / (ends[1] - ends[0])
    found: list[Pair] = []
    for guess in _guessed(at, ends, slope, count):
        zero = _iterated(at, ends, slope, guess, found, limit)
        found += [] if zero is None else [zero]
        if len(found) == count:
            break
    parts = _parts(at, ends, negative, found, limit)
    if parts is None:
        branches = range(min(negative), max(negative))
        return [_bisected(at, ends, branch, limit) for branch in branches]
    zeros: list[Pair] = []
    for within, counts, known in parts:
        whole = len(known) == abs(counts[1] - counts[0])
        zeros += known if whole else zeros_between(at, within, counts, limit)
    return zeros


def _guessed(
    at: Matrix, ends: tuple[float, float], slope: np.ndarray, count: int
) -> Iterator[Pair]:
    """Yield zeros of the linear function, those next to the middle first; none if singular."""
    middle, reach = 0.5 * (ends[0] + ends[1]), _REACH * (ends[1] - ends[0])
    H = at(middle)
    factor, pivots, singular = factorised(H)
    if singular:
        return
    rng = np.random.default_rng(0)
    X = rng.normal(size=(len(H), min(count + _MORE, len(H)))).astype(complex)
    for _ in range(_TURNS):
        X, _ = zhetrs(factor, pivots, slope @ X, lower=1)
        if not np.all(np.isfinite(X)):
            return
        X = np.linalg.qr(X)[0]
    # largest of H₀⁻¹S in the subspace: −1/(Ω − Ω₀)
    inner = X.conj().T @ H @ X
    try:
        values, turn = np.linalg.eig(np.linalg.solve(inner, X.conj().T @ slope @ X))
    except np.linalg.LinAlgError:
        return
    for place in np.argsort(-np.abs(values)):
        if abs(values[place]) * reach < 1.0:
            return
        x = X @ turn[:, place]
        yield middle - float((1.0 / values[place]).real), x / np.linalg.norm(x)


def _iterated(
    at: Matrix,
    ends: tuple[float, float],
    slope: np.ndarray,
    guess: Pair,
    found: Sequence[Pair],
    limit: float,
) -> Pair | None:
    """Return a zero between the ends beside those that are `found`; None where that fails.

    The first slope is that of the chord, those of later steps are those of secants.
    """
    speed, x = min(max(guess[0], ends[0]), ends[1]), guess[1]
    last: tuple[float, np.ndarray] | None = None
    for _ in range(_STEPS):
        H = at(speed)
        factor, pivots, singular = factorised(H)
        if singular:
            return None
        x, _ = zhetrs(factor, pivots, slope @ x, lower=1)
        for other, vector in found:
            if abs(other - speed) <= _APART * limit:
                x = x - np.vdot(vector, x) * vector
        x = x / np.linalg.norm(x)
        left = H @ x
        if last is None:
            change = np.vdot(x, slope @ x).real
        elif last[0] != speed:
            change = np.vdot(x, left - last[1] @ x).real / (speed - last[0])
        step = np.vdot(x, left).real / change if change else np.inf
        last, speed = (speed, H), speed - step
        if not ends[0] <= speed <= ends[1]:
            return None
        residual = np.linalg.norm(left) / abs(change)
        if abs(step) <= _LAST * limit and residual <= _RESIDUAL * limit:
            return speed, x
    return None


def _parts(
    at: Matrix,
    ends: tuple[float, float],
    negative: tuple[int, int],
    found: Sequence[Pair],
    limit: float,
) -> list[Part] | None:
    """Return what the middles between zeros that are found cut the speeds into.

    Ends of each part, how many eigenvalues are negative there, and the zeros found within, which
    may be too few. None where some of them are no zeros that are looked for, or a part is no
    smaller.
    """
    groups: list[list[Pair]] = []
    for zero in sorted(found, key=lambda zero: zero[0]):
        if groups and zero[0] - groups[-1][-1][0] <= _APART * limit:
            groups[-1].append(zero)
        else:
            groups.append([zero])
    cuts = [0.5 * (low[-1][0] + high[0][0]) for low, high in pairwise(groups)]
    counts = [negative[0], *(count_negative(at(cut)) for cut in cuts), negative[1]]
    speeds = [ends[0], *cuts, ends[1]]
    sense = np.sign(negative[1] - negative[0])
    changes = sense * np.diff(counts)
    missing = changes[: len(groups)] - [len(zeros) for zeros in groups]
    if not groups or min(missing) < 0 or (len(groups) == 1 and missing[0]):
        return None
    return list(zip(pairwise(speeds), pairwise(counts), groups, strict=True))


def _bisected(at: Matrix, ends: tuple[float, float], branch: int, limit: float) -> Pair:
    """Return a zero of one of the sorted eigenvalues, by Brent's method, with its vector."""

    @cache
    def value(speed: float) -> float:
        return la.eigh(at(speed), eigvals_only=True, subset_by_index=[branch, branch])[0]

    at_ends = [value(speed) for speed in ends]
    if at_ends[0] * at_ends[1] < 0.0:
        speed = float(brentq(value, *ends, xtol=1e-12 * limit, rtol=1e-13))
    else:  # rounding of a zero there
        speed = ends[int(np.argmin(np.abs(at_ends)))]
    return speed, la.eigh(at(speed), subset_by_index=[branch, branch])[1][:, 0]
