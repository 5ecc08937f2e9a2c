"""Zeros of the eigenvalues of a Hermitian matrix that depends on the speed, by bracketing."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np
import scipy.linalg as la
from scipy.optimize import brentq

_BRACKETS = 200  # over the range of speeds
_SAME = 1e-7  # relative distance of speeds that count as one
Entry = TypeVar("Entry")


def zeros_of_eigenvalues(
    stiffness: Callable[[float], np.ndarray], limit: float
) -> list[tuple[float, np.ndarray]]:
    """Find the zeros of the sorted eigenvalues of a Hermitian matrix function on (0, limit].

    What is a free motion at every speed, like a spin or an axial motion that nothing holds, is
    left out first: the sign of its eigenvalue is rounding.
    """
    grid = np.linspace(limit / _BRACKETS, limit, _BRACKETS)
    rest = _never_free(stiffness, grid)

    def at(speed: float) -> np.ndarray:
        return rest.conj().T @ stiffness(speed) @ rest

    branches = np.array([la.eigvalsh(at(speed)) for speed in grid])
    found = []
    for branch in np.flatnonzero(np.any(branches[1:] * branches[:-1] <= 0.0, axis=0)):
        for low, high in _sign_changes(branches[:, branch]):
            speed = grid[low]
            if low != high:
                speed = brentq(
                    lambda s, b=branch: la.eigvalsh(at(s))[b],
                    grid[low],
                    grid[high],
                    xtol=1e-12 * limit,
                    rtol=1e-13,
                )
            found.append((float(speed), int(branch)))
    crossings = []
    for group in same_speed(sorted(found), lambda zero: zero[0]):
        # one decomposition for all: the vectors of a repeated zero are orthogonal only within it
        _, vectors = la.eigh(at(group[0][0]))
        crossings += [(speed, rest @ vectors[:, branch]) for speed, branch in group]
    return crossings


def same_speed(entries: Sequence[Entry], speed_of: Callable[[Entry], float]) -> list[list[Entry]]:
    """Return ascending entries in groups of one speed."""
    groups: list[list[Entry]] = []
    for entry in entries:
        speed = speed_of(entry)
        if groups and speed - speed_of(groups[-1][-1]) <= _SAME * speed:
            groups[-1].append(entry)
        else:
            groups.append([entry])
    return groups


def _sign_changes(values: np.ndarray) -> list[tuple[int, int]]:
    """Return the places (before, after) of every change of sign; both the same at a zero."""
    at_zero = [(int(i), int(i)) for i in np.flatnonzero(values == 0.0)]
    changes = np.flatnonzero(values[1:] * values[:-1] < 0.0)
    return at_zero + [(int(i), int(i) + 1) for i in changes]


def _never_free(stiffness: Callable[[float], np.ndarray], grid: np.ndarray) -> np.ndarray:
    """Return an orthonormal basis of the motions that are not free at every speed of the grid.

    An eigenvalue counts as zero below the rounding of its matrix, ``10 n ε ‖H‖``.
    """
    sizes = []
    for speed in grid:
        values = np.sort(np.abs(la.eigvalsh(stiffness(speed))))
        sizes.append(values / (10.0 * len(values) * np.finfo(float).eps * max(values[-1], 1e-300)))
    free = min(int(np.sum(entry <= 1.0)) for entry in sizes)
    apart = [entry[free] if np.sum(entry <= 1.0) == free else 0.0 for entry in sizes]
    values, vectors = la.eigh(stiffness(grid[int(np.argmax(apart))]))
    return vectors[:, np.argsort(np.abs(values))[free:]]
