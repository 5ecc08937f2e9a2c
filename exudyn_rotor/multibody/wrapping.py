"""The one way in which methods of Exudyn's ``MainSystem`` are given something more to do."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

import exudyn
from exudyn.misc.extensionRegistry import extends, install

_OWN = "_knows_fixed_axis_rotors"


def wraps_method(name: str) -> Callable[[Callable], Callable]:
    """Let a function of (Exudyn's method, mbs, arguments) answer ``mbs.<name>(arguments)``.

    Once, however often the package is imported.
    """

    def put_in_place(function: Callable) -> Callable:
        original = getattr(exudyn.MainSystem, name)
        if hasattr(original, _OWN):
            return function

        @wraps(original)
        def method(mbs: exudyn.MainSystem, *given: Any, **options: Any) -> Any:
            return function(original, mbs, *given, **options)

        setattr(method, _OWN, True)
        if hasattr(original, "_exudynExtension"):
            # registered, or Exudyn's own would be put back with the next extension
            extends(exudyn.MainSystem, name)(method)
            install()
        else:
            setattr(exudyn.MainSystem, name, method)
        return function

    return put_in_place
