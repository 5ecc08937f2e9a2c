"""Whose line a warning points at."""

from __future__ import annotations

import sys

# what stands between functions of the package: decorators, cached properties
_WITHIN = "exudyn_rotor.", "contextlib", "functools"


def user_level() -> int:
    """Return the stack level of the first caller outside the package."""
    frame, level = sys._getframe(1), 1
    while frame.f_back and frame.f_globals.get("__name__", "").startswith(_WITHIN):
        frame, level = frame.f_back, level + 1
    return level
