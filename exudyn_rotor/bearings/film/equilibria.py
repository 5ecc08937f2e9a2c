"""Equilibria of a bearing, kept because several ask for them in turn."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

import numpy as np

from exudyn_rotor import checks

State = TypeVar("State")
_REFUSED = ValueError, ArithmeticError


class Equilibria(Generic[State]):
    """The last equilibria, or what follows from them, by speed and load; or why there is none."""

    def __init__(self, most: int = 64) -> None:
        self._known: dict[tuple[float, ...], State | Exception] = {}
        self._most = most

    def at(
        self, speed: float, load: np.ndarray, solve: Callable[[float, np.ndarray], State]
    ) -> State:
        """Return ``solve(speed, load)``; its errors are kept, too."""
        key = checks.number(speed, "speed", "rad/s"), *load.tolist()
        found = self._known.get(key)
        if found is None:
            try:
                found = solve(speed, load)
            except _REFUSED as error:
                found = error.with_traceback(None)
            while len(self._known) >= self._most:
                self._known.pop(next(iter(self._known)), None)
            self._known[key] = found
        if isinstance(found, _REFUSED):
            raise type(found)(*found.args)
        return found

    def beside(self, speed: float, load: np.ndarray) -> State | None:
        """Return what is known at the nearest speed of the same sense, if any."""
        known = [
            (abs(key[0] - speed), found)
            for key, found in list(self._known.items())
            if key[0] * speed > 0.0 and key[1:] == (*load.tolist(),)
            if not isinstance(found, _REFUSED)
        ]
        return min(known, key=lambda each: each[0])[1] if known else None
