"""Checks of words and names."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TypeVar

from exudyn_rotor.checks.messages import shown, told
from exudyn_rotor.checks.objects import items

Kind = TypeVar("Kind")


def choice(value: str, name: str, options: Iterable[str]) -> str:
    """Return one of a few words."""
    known = ", ".join(repr(option) for option in options)
    if not isinstance(value, str):
        raise TypeError(f"{name}: needs one of {known}, got {shown(value)}")
    if value not in options:
        raise ValueError(f"{name}: {shown(value)} is unknown; use one of {known}")
    return value


def label(value: str, name: str) -> str:
    """Return a name: text that is not empty."""
    if not isinstance(value, str):
        raise TypeError(told(name, "a name (text)", value))
    if not value.strip():
        raise ValueError(told(name, "a name that is not empty", value))
    if not value.isprintable():  # line breaks, half characters that no file or library takes
        raise ValueError(told(name, "printable characters", value))
    return str(value)


def labels(
    values: Iterable[str] | str, name: str, known: Iterable[str] | None = None
) -> tuple[str, ...]:
    """Return names, given as one or as a sequence; each one of `known`, if that is given."""
    listed = (values,) if isinstance(values, str) else items(values, name, "names (a sequence)")
    result = tuple(label(value, name) for value in listed)
    there = result if known is None else tuple(known)
    for value in (one for one in result if one not in there):
        names = ", ".join(repr(item) for item in there) or "none"
        raise ValueError(f"{name}: {shown(value)} is unknown; there are: {names}")
    return result


def different(names: tuple[str, ...], name: str) -> tuple[str, ...]:
    """Return names, of which none may be given twice."""
    for value in names:
        if names.count(value) > 1:
            raise ValueError(f"{name}: {value!r} is given twice")
    return names


def mapping(
    value: Mapping[str, Kind], name: str, what: str = "", known: Iterable[str] | None = None
) -> Mapping[str, Kind]:
    """Return a mapping whose keys are names, `known` ones if given, to what `what` says."""
    if not isinstance(value, Mapping):
        raise TypeError(told(name, f"a dictionary of name to {what or 'value'}", value))
    labels(tuple(value), name, known)
    return value
