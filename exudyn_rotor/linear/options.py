"""Checks of the options that all linear analyses share."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exudyn_rotor import checks

Place = str | int | Sequence[float]

# below is rounding, above nothing is computed
_LEAST, _MOST = 1e-13, 0.1


def accuracy(value: float, name: str) -> float:
    """Return a tolerance or residual from 1e-13 to 0.1."""
    return checks.number(value, name, least=_LEAST, most=_MOST)


def check_basis_accuracy(value: float | None) -> None:
    """Check the largest error by the basis of a reduced rotor, or None: `accuracy`."""
    if value is not None:
        checks.tolerance(value, "accuracy")


def place(value: Place, name: str) -> str | int | tuple[float, float, float]:
    """Return a place of the rotor: an interface's name, a node's number or a position [m].

    Raises
    ------
    TypeError, ValueError
        For anything else.
    """
    if isinstance(value, str):
        return checks.label(value, name)
    if isinstance(value, int | np.integer):
        return checks.count(value, name)
    try:
        return tuple(checks.vector(value, name, "m").tolist())
    except (TypeError, ValueError) as error:
        raise type(error)(
            f"{name}: needs the name of an interface, a node number or a position of three finite "
            f"numbers [m], got {checks.shown(value)}"
        ) from error
