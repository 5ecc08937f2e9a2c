"""Equilibria of a bearing, kept because several ask for them in turn."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

import numpy as np

from exudyn_rotor import checks

State = TypeVar("State")
_KEPT = 16  # equilibria of a bearing


class Equilibria(Generic[State]):
    """Some equilibria by speed and load, and where there is none, the reason."""

    def __init__(self) -> None:
        self._known: dict[tuple[float, ...], State | str] = {}

    def at(
        self, speed: float, load: np.ndarray, solve: Callable[[float, np.ndarray], State]
    ) -> State:
        """Return ``solve(speed, load)``; its ValueError is kept, too."""
        key = checks.number(speed, "speed", "rad/s"), *load.tolist()
        if key not in self._known:
            try:
                found = solve(speed, load)
            except ValueError as error:
                found = str(error)
            if len(self._known) >= _KEPT:
                self._known.clear()
            self._known[key] = found
        if isinstance(self._known[key], str):
            raise ValueError(self._known[key])
        return self._known[key]
