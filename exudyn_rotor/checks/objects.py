"""Checks of objects, sequences of them, functions and paths."""

from __future__ import annotations

import copyreg
import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeVar

from exudyn_rotor.checks.messages import told

Kind = TypeVar("Kind")


def instance(value: object, name: str, kinds: type[Kind] | tuple[type, ...], how: str = "") -> Kind:
    """Return an object of one of the `kinds`; `how` says how to make one."""
    if not isinstance(value, kinds):
        raise TypeError(told(name, _named(kinds), value) + (f"; {how}" if how else ""))
    return value


def instances(
    values: Iterable[Kind] | Kind, name: str, kinds: type[Kind] | tuple[type, ...], how: str = ""
) -> tuple[Kind, ...]:
    """Return objects of some kinds, given as one or as a sequence."""
    if isinstance(values, kinds):
        return (values,)
    needed = f"a {_named(kinds)} or a sequence of them" + (f" ({how})" if how else "")
    return tuple(
        instance(value, f"{name}[{index}]", kinds, how)
        for index, value in enumerate(items(values, name, needed))
    )


def items(values: Iterable[Any], name: str, needed: str) -> tuple:
    """Return what a sequence holds; text and mappings are none. `needed` is for the message."""
    try:
        if not isinstance(values, str | bytes | Mapping) and isinstance(values, Iterable):
            return tuple(values)
    # an array without dimensions, an iterator that breaks off
    except Exception as error:
        raise TypeError(told(name, needed, values)) from error
    raise TypeError(told(name, needed, values))


def _named(kinds: type | tuple[type, ...]) -> str:
    several = kinds if isinstance(kinds, tuple) else (kinds,)
    return " or ".join(kind.__name__ for kind in several)


def function(value: Callable, name: str) -> Callable:
    """Return something that can be called."""
    if not callable(value):
        raise TypeError(told(name, "a function", value))
    return value


def executor(value: Any) -> Any:
    """Return an executor with a ``submit`` method, or None."""
    if value is None or (callable(getattr(value, "submit", None)) and not isinstance(value, type)):
        return value
    raise TypeError(told("executor", "an executor of concurrent.futures or alike, or None", value))


def path(value: str | os.PathLike, name: str = "path") -> Path:
    """Return the path of a file."""
    needed = "the path of a file (text or Path)"
    text = os.fspath(value) if isinstance(value, str | os.PathLike) else None
    if not isinstance(text, str):
        raise TypeError(told(name, needed, value))
    if not text or "\0" in text:
        raise ValueError(told(name, needed, value))
    return Path(text)


def read_only_mapping(values: Mapping[str, Kind]) -> Mapping[str, Kind]:
    """Return a copy that cannot be written to; it can be pickled and copied."""
    return MappingProxyType(dict(values))


# results and rotors go to other processes; Python itself does not pickle a read-only mapping
copyreg.pickle(MappingProxyType, lambda view: (read_only_mapping, (dict(view),)))
