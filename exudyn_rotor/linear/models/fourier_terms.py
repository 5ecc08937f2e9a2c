"""Sums and products of matrices that repeat with the spin angle θ, by their Fourier terms."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exudyn_rotor.linear.periodic.periodic_system import Terms
from exudyn_rotor.theory.rotating_axes import turned_harmonics

_WHOLE = 1e-9  # distance of a multiple of the speed from a whole number


def turned_terms(X: np.ndarray, drift: float, what: str) -> dict[int, np.ndarray]:
    """Return the Fourier terms of ``Rᵀ(wθ) X R(wθ)`` for triples of rows, by multiples of θ.

    Raises
    ------
    ValueError
        As :func:`whole`, for the drift w.
    """
    terms: dict[int, np.ndarray] = {}
    for n, part in turned_harmonics(X).items():
        add(terms, whole(n * drift, what), part)
    return terms


def whole(multiple: float, what: str) -> int:
    """Return a multiple of the speed as a whole number.

    Raises
    ------
    ValueError
        Where it is none: the equations do not repeat with θ then.
    """
    nearest = round(multiple)
    if abs(multiple - nearest) > _WHOLE * max(1.0, abs(multiple)):
        raise ValueError(
            f"ratios: {what} is not the same in all directions, so that the equations repeat with "
            f"{abs(multiple):.6g} times the angle of the speed, which is no whole number; give "
            "what is uneven the ratio 1, or ratios that are whole numbers, 2 and 3 for 1 and 1.5"
        )
    return nearest


def turning_congruence(U: Terms, X: Terms, V: Terms) -> dict[int, np.ndarray]:
    """Return the Fourier terms of ``Uᵀ(θ) X(θ) V(θ)``.

    Where V is U, with exactly symmetric and skew parts: the rounding of a stiff support would else
    be a circulatory force.
    """
    if U is not V:
        return _products(U, X, V)
    terms: dict[int, np.ndarray] = {}
    for sign in (1.0, -1.0):
        halves = {n: 0.5 * (part + sign * part.T) for n, part in X.items()}
        for n, Y in _products(U, halves, U).items():
            add(terms, n, 0.5 * (Y + sign * Y.T))
    return terms


def _products(U: Terms, X: Terms, V: Terms) -> dict[int, np.ndarray]:
    terms: dict[int, np.ndarray] = {}
    for n, part in X.items():
        for a, left in U.items():
            pulled = left.T @ part
            for b, right in V.items():
                add(terms, n + a + b, pulled @ right)
    return terms


def join_turning(
    sums: tuple[dict, dict, dict], parts: tuple[Terms, Terms, Terms], U: Terms
) -> None:
    """Add damping, stiffness and stiffness per Ω of what acts on ``x = U(θ) y``.

    ``ẋ = U ẏ + Ω U′ y``: the damping is a stiffness where U changes.
    """
    for terms, part in zip(sums, parts, strict=True):
        join(terms, turning_congruence(U, part, U))
    join(sums[2], turning_congruence(U, parts[0], rate_of(U)))


def join(terms: dict[int, np.ndarray], more: Terms) -> None:
    """Add Fourier terms."""
    for n, X in more.items():
        add(terms, n, X)


def rate_of(U: Terms) -> dict[int, np.ndarray]:
    """Return the Fourier terms of ``dU/dθ``."""
    return {n: 1j * n * X for n, X in U.items() if n}


def add(terms: dict[int, np.ndarray], n: int, X: np.ndarray) -> None:
    """Add a Fourier term; that of n = 0 is real."""
    terms[n] = terms.get(n, 0.0) + (X.real if n == 0 else X)


def stacked(motions: Sequence[Terms]) -> dict[int, np.ndarray]:
    """Return motions (6, k), or others over k coordinates, one below the other."""
    keys = sorted({n for motion in motions for n in motion})
    still = [np.zeros(next(iter(motion.values())).shape) for motion in motions]
    return {
        n: np.vstack([U.get(n, none) for U, none in zip(motions, still, strict=True)]) for n in keys
    }
