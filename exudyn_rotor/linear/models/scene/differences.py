"""Slopes of forces by differences, with steps as large as the forces are straight."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

CURVATURE = 3e-6  # relative second-order error of a step; extrapolated, its square is left
_SHARES = (1.0, 0.1, 0.01)  # of a step, where a contact or a film begins or ends within it
_KINK = 1e-4  # relative second-order error of a step that tells so


def differences(function: Callable, moves: np.ndarray) -> tuple[np.ndarray, float]:
    """Return central differences along the columns of `moves`, and their curvature error.

    The steps h and 2h are extrapolated; the error is that of h alone.
    """
    near, far = (
        np.array([(function(n * move) - function(-n * move)) / (2 * n) for move in moves.T]).T
        for n in (1, 2)
    )
    error = np.abs(near - far).max() / 3.0 / max(np.abs(near).max(), 1e-300)
    return near + (near - far) / 3.0, float(error)


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
