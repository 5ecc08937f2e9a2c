"""Around calls of functions: what is kept of an object, and whose line a warning points at."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable
from typing import TypeVar

Value = TypeVar("Value")
# what stands between functions of the package: decorators, cached properties
_WITHIN = "exudyn_rotor.", "contextlib", "functools"


def kept(function: Callable[..., Value]) -> Callable[..., Value]:
    """Keep what a function finds of an object as long as the object lives, within the object.

    Its other arguments have to be hashable.
    """
    name = f"{function.__module__}.{function.__qualname__}"

    @functools.wraps(function)
    def known(each: object, *rest: object) -> Value:
        found = vars(each).setdefault("_kept", {})
        key = name, *rest
        return found[key] if key in found else found.setdefault(key, function(each, *rest))

    return known


def user_level() -> int:
    """Return the stack level of the first caller outside the package."""
    frame, level = sys._getframe(1), 1
    while frame.f_back and frame.f_globals.get("__name__", "").startswith(_WITHIN):
        frame, level = frame.f_back, level + 1
    return level
