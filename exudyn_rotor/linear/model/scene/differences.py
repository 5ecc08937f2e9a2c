"""Slopes of forces by differences, with steps as large as the forces are straight."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

CURVATURE = 3e-6  # relative second-order error of a step; extrapolated, its square is left
_SHARES = (1.0, 0.1, 0.01)  # of a step, where a contact or a film begins or ends within it
_GOLDEN = (5.0**0.5 - 1.0) / 2.0
_STRAIGHT = 1e-12  # relative error of slopes, as rounding leaves it: 1e-16 m in a step of 1e-4 m
_KINK = 1e-4  # relative second-order error of a step that tells so


def differences(function: Callable, moves: np.ndarray) -> tuple[np.ndarray, float]:
    """Return central differences along the columns of `moves`, and their curvature error.

    The steps h and 2h are extrapolated; the error is that of h alone. Where one step h along all
    columns at once agrees with those of 2h, as it does with held laws, these are returned: then
    the forces are straight, and neither curved nor is there a kink within 2h.
    """

    def along(move: np.ndarray, n: int) -> np.ndarray:
        return (function(n * move) - function(-n * move)) / (2 * n)

    far = np.array([along(move, 2) for move in moves.T]).T
    # none like another: motions of one place by several columns do not cancel
    shares = 1.0 + np.arange(moves.shape[1]) * _GOLDEN % 1.0
    shares /= np.linalg.norm(shares)
    error = np.abs(far @ shares - along(moves @ shares, 1)).max()
    error /= max(np.abs(far).max(), 1e-300)
    if error > _STRAIGHT:
        near = np.array([along(move, 1) for move in moves.T]).T
        error = np.abs(near - far).max() / 3.0 / max(np.abs(near).max(), 1e-300)
        far = near + (near - far) / 3.0
    return far, float(error)


def slopes(function: Callable, moves: np.ndarray) -> np.ndarray:
    """Return differences along `moves`, of smaller ones where the forces have a kink within."""
    for share in _SHARES:
        found, error = differences(function, share * moves)
        if error < _KINK:
            break
    return found / share


def chosen_step(function: Callable, moves: np.ndarray, steps: tuple[float, ...]) -> float:
    """Return the largest step [m] or [m/s] at which the forces are straight enough."""
    for step in steps:
        if differences(function, step * moves)[1] < CURVATURE:
            return step
    return steps[-1]
