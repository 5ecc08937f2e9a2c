"""The one way in which methods of Exudyn's ``MainSystem`` are given something more to do.

Importing this module wraps them; what they do more comes with the modules of rotors, which a scene
without rotors does not load.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

import exudyn
from exudyn.misc.extensionRegistry import extends, install

METHODS = (
    "AddMarker",
    "AddSensor",
    "Assemble",
    "GetDictionary",
    "SetObjectParameter",
    "SolveDynamic",
    "SolveStatic",
)
_OWN = "_knows_fixed_axis_rotors"  # attribute of a wrapped method: who answers it


def wraps_method(name: str) -> Callable[[Callable], Callable]:
    """Let a function of (Exudyn's method, mbs, arguments) answer ``mbs.<name>(arguments)``."""

    def put_in_place(function: Callable) -> Callable:
        getattr(getattr(exudyn.MainSystem, name), _OWN)["answer"] = function
        return function

    return put_in_place


def _wrap(name: str) -> None:
    """Let a method ask for its answer; once, however often the package is imported."""
    original = getattr(exudyn.MainSystem, name)
    if hasattr(original, _OWN):
        return
    own: dict[str, Callable] = {}

    @wraps(original)
    def method(mbs: exudyn.MainSystem, *given: Any, **options: Any) -> Any:
        if "answer" not in own:  # no rotor was ever made
            return original(mbs, *given, **options)
        return own["answer"](original, mbs, *given, **options)

    setattr(method, _OWN, own)
    if hasattr(original, "_exudynExtension"):
        # registered, or Exudyn's own would be put back with the next extension
        extends(exudyn.MainSystem, name)(method)
        install()
    else:
        setattr(exudyn.MainSystem, name, method)


for _name in METHODS:
    _wrap(_name)
