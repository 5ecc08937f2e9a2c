"""Speeds at which a Hermitian matrix function is singular: zeros of its eigenvalues.

Between two speeds with p and q negative eigenvalues, those from the smaller to the larger of these
numbers, in ascending order, change their sign. How many are negative is counted in an
``LDLᴴ`` factor (Sylvester's law of inertia), in a fifth of the time of the eigenvalues. Where
between the speeds their zeros are is found in :mod:`.zeros_between`.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import TypeVar

import numpy as np
import scipy.linalg as la

from exudyn_rotor.bearings.bearing import NoEquilibriumError
from exudyn_rotor.bearings.support import BelowTableError
from exudyn_rotor.callers import user_level
from exudyn_rotor.linear.modal.zeros_between import Matrix, Pair, count_negative, zeros_between
from exudyn_rotor.linear.periodic.periodic_system import UnconvergedError

# of a scene, of bearings, and of tables that begin higher
NO_EQUATIONS = UnconvergedError, NoEquilibriumError, BelowTableError
_HALVINGS = 30  # between two of the brackets
_BRACKETS = 200  # speeds at which signs of eigenvalues are looked at
_HALVES = 10  # of the first of these
_SAME = 1e-7  # relative distance of speeds that are one
_INDEPENDENT = 0.1  # least length of a vector less what others of the same speed have of it
Entry = TypeVar("Entry")


def zeros_of_eigenvalues(matrix: Matrix, limit: float) -> list[tuple[float, np.ndarray]]:
    """Return the speeds on (0, limit] where `matrix` is singular, each with its null vector.

    The zeros of the sorted eigenvalues are bracketed at 200 speeds, and below the first of these at
    halves of it. What is a free motion at every speed, like a spin or an axial motion that nothing
    holds, is left out first: the sign of its eigenvalue is rounding. Speeds end above the highest
    one at which there are no equations, as films are too thin there, or a table begins higher.
    """
    free, grid, negative = _free_and_negative(
        matrix, np.linspace(limit / _BRACKETS, limit, _BRACKETS)
    )

    def at(speed: float) -> np.ndarray:
        return _held(matrix(speed), free)

    found: list[Pair] = []
    ends = _below(at, grid[0]) if len(grid) == _BRACKETS else []
    ends += zip(grid.tolist(), negative, strict=True)
    for (low, before), (high, after) in pairwise(ends):
        if before != after:
            found += zeros_between(at, (low, high), (before, after), limit)
    found.sort(key=lambda zero: zero[0])
    return [zero for group in same_speed(found, _speed) for zero in _apart(at, group)]


def _speed(zero: Pair) -> float:
    return zero[0]


def _apart(at: Matrix, group: list[Pair]) -> list[Pair]:
    """Return zeros of one speed with orthogonal vectors."""
    if len(group) == 1:
        return group
    H = at(group[0][0])
    basis, lengths = np.linalg.qr(np.column_stack([vector for _, vector in group]))
    if np.abs(np.diagonal(lengths)).min() > _INDEPENDENT:
        vectors = basis @ np.linalg.eigh(basis.conj().T @ H @ basis)[1]
    else:
        values, vectors = la.eigh(H)
        vectors = vectors[:, np.argsort(np.abs(values))]
    return [(speed, vector) for (speed, _), vector in zip(group, vectors.T, strict=False)]


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


def _free_and_negative(
    matrix: Matrix, grid: np.ndarray
) -> tuple[np.ndarray, np.ndarray, list[int]]:
    """Return motions that are free at every speed, orthonormal, and negative eigenvalues of others.

    Between them the speeds at which there are equations. A motion counts as free below the rounding
    of its matrix, ``10 n ε ‖H‖``.
    """
    free = np.eye(len(matrix(grid[-1])), dtype=complex)
    negative: list[int] = []
    while len(negative) < len(grid):
        speed = grid[len(grid) - 1 - len(negative)]
        try:
            H = matrix(speed)
        except NO_EQUATIONS as error:
            if not negative:
                raise
            grid = grid[len(grid) - len(negative) :]
            reason = ""
            if isinstance(error, BelowTableError):
                grid = np.append(_first_speed(matrix, speed, grid[0]), grid)
                speed = grid[0]
            else:
                reason = ", as there is no equilibrium"
            warnings.warn(
                f"critical speeds: up to {speed:.4g} rad/s none are looked for{reason}: {error}",
                UserWarning,
                stacklevel=user_level(),
            )
            continue
        left = H @ free
        limit = 10.0 * len(H) * np.finfo(float).eps * np.linalg.norm(H)
        if np.linalg.norm(left) > limit:
            _, sizes, rows = np.linalg.svd(left)
            sizes = np.pad(sizes, (0, len(rows) - len(sizes)))
            if sizes.max(initial=0.0) > limit:
                # those that are free here, too; the others count from the first speed on
                free, negative = free @ rows[sizes <= limit].conj().T, []
                continue
        negative.append(count_negative(_held(H, free)))
    return free, grid, negative[::-1]


def _below(at: Matrix, first: float) -> list[tuple[float, int]]:
    """Return ascending speeds below the first one, and how many eigenvalues are negative there.

    As far down as there are equations, and all signs are beyond rounding.
    """
    ends: list[tuple[float, int]] = []
    for speed in first * 0.5 ** np.arange(1.0, _HALVES + 1.0):
        try:
            H = at(float(speed))
        except NO_EQUATIONS:
            break
        values = la.eigvalsh(H)
        if np.abs(values).min() <= 10.0 * len(H) * np.finfo(float).eps * np.linalg.norm(H):
            break
        ends.insert(0, (float(speed), int(np.count_nonzero(values < 0.0))))
    return ends


def _first_speed(matrix: Matrix, without: float, with_equations: float) -> float:
    """Return the lowest speed with equations, at which the tables of all supports have begun."""
    for _ in range(_HALVINGS):
        middle = 0.5 * (without + with_equations)
        try:
            matrix(middle)
        except BelowTableError:
            without = middle
        else:
            with_equations = middle
    return with_equations


def _held(H: np.ndarray, free: np.ndarray) -> np.ndarray:
    """Return a matrix with the free motions stiffer than all others."""
    return H if free.shape[1] == 0 else H + np.linalg.norm(H) * (free @ free.conj().T)
