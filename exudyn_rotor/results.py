"""Results of linear analyses: small objects, stored without pickle.

A result is a frozen dataclass of arrays, numbers, words and tuples of words. Its class is made
storable by a decorator; a file names its class, and only registered classes are made from it, so
loading never executes code from the file.
"""

from __future__ import annotations

from dataclasses import MISSING, fields, is_dataclass
from os import PathLike
from typing import TypeVar

import numpy as np

from exudyn_rotor.checks import read_only
from exudyn_rotor.storage import read_arrays, write_arrays

_LONGEST = 60  # characters of one value in a repr
_FORMAT = "exudyn_rotor result 1"
_REGISTERED: dict[str, type] = {}

Class = TypeVar("Class", bound=type)


def storable(cls: Class) -> Class:
    """Register a result class under its name for :func:`save_result` and :func:`load_result`.

    To be put above ``@dataclass(frozen=True, eq=False)``. Fields may be arrays of numbers, numbers,
    words, tuples of words, and None.

    Raises
    ------
    TypeError
        If the class is no dataclass, or another of that name is registered.
    """
    if not is_dataclass(cls):
        raise TypeError(f"{cls.__name__}: only a dataclass can be stored")
    known = _REGISTERED.setdefault(cls.__name__, cls)
    if known.__module__ != cls.__module__:
        raise TypeError(f"a result class of the name {cls.__name__} is registered already")
    _REGISTERED[cls.__name__] = cls
    return cls


class Result:
    """Base of result classes: read-only arrays, and saving and loading as methods."""

    def __init_subclass__(cls, **options) -> None:
        """Keep the dataclass decorator from making a repr that prints whole arrays."""
        super().__init_subclass__(**options)
        if "__repr__" not in cls.__dict__:
            cls.__repr__ = Result.__repr__

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, np.ndarray):
                object.__setattr__(self, field.name, read_only(value, value.dtype))

    def __repr__(self) -> str:
        """Return the fields in one line: arrays by their shape, long words and tuples cut."""
        parts = [f"{f.name}={_short(getattr(self, f.name))}" for f in fields(self)]
        return f"{type(self).__name__}({', '.join(parts)})"

    def save(self, path: str | PathLike) -> None:
        """Write the result to an ``.npz`` file; see :func:`save_result`."""
        save_result(self, path)

    @classmethod
    def load(cls, path: str | PathLike) -> Result:
        """Read a result of this class; see :func:`load_result`.

        Raises
        ------
        ValueError
            If the file holds a result of another class.
        """
        result = load_result(path)
        if not isinstance(result, cls):
            raise ValueError(f"{path}: holds a {type(result).__name__}, not a {cls.__name__}")
        return result


def _short(value: object) -> str:
    """Return an array's shape, or what `repr` says of a small value."""
    if isinstance(value, np.ndarray):
        return f"array{value.shape}"
    text = repr(value)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"


def save_result(result: object, path: str | PathLike) -> None:
    """Write a result to an ``.npz`` file, lossless and without pickle.

    A file of that name is replaced only by a complete one.

    Raises
    ------
    TypeError
        If the class is not registered, or a field cannot be stored.
    """
    name = type(result).__name__
    if _REGISTERED.get(name) is not type(result):
        raise TypeError(f"a {name} cannot be stored; results that can: {_known()}")
    data = {"format": np.array(_FORMAT), "class": np.array(name)}
    for field in fields(result):
        value = getattr(result, field.name)
        if value is not None:
            data[f"field.{field.name}"] = _encoded(value, f"{name}.{field.name}")
    absent = [field.name for field in fields(result) if getattr(result, field.name) is None]
    data["none"] = np.array(absent, dtype=str)
    write_arrays(path, data)


def load_result(path: str | PathLike) -> object:
    """Read a result written by :func:`save_result`; never executes code from the file.

    Raises
    ------
    ValueError
        When the file holds no result of a registered class, or is damaged.
    """
    data = read_arrays(path)
    if str(data.get("format")) != _FORMAT:
        raise ValueError(f"{path}: holds no result; write one with save_result")
    cls = _REGISTERED.get(str(data.get("class")))
    if cls is None:
        raise ValueError(f"{path}: holds a {data.get('class')}; results that can be: {_known()}")
    return cls(**_arguments(cls, data, path))


def _arguments(cls: type, data: dict[str, np.ndarray], path: str | PathLike) -> dict[str, object]:
    """Return the constructor's arguments; only a field with a default may be missing."""
    absent = {str(name) for name in data.get("none", ())}
    arguments: dict[str, object] = {}
    for field in fields(cls):
        key = f"field.{field.name}"
        if field.name in absent:
            arguments[field.name] = None
        elif key in data:
            arguments[field.name] = _decoded(data[key])
        elif field.default is MISSING and field.default_factory is MISSING:
            raise ValueError(f"{path}: the entry {field.name!r} is missing; the file is damaged")
    return arguments


def _encoded(value: object, name: str) -> np.ndarray:
    """Return a field's value as an array that its kind can be read from again."""
    if isinstance(value, tuple) and all(isinstance(item, str) for item in value):
        return np.array(value, dtype=str)
    if isinstance(value, str | bool | int | float | complex | np.number | np.bool_):
        return np.array(value)
    if isinstance(value, np.ndarray) and value.ndim > 0 and value.dtype.kind in "biufc":
        return value
    raise TypeError(
        f"{name}: a {type(value).__name__} cannot be stored; use an array of numbers, a number, "
        "a word or a tuple of words"
    )


def _decoded(array: np.ndarray) -> object:
    if array.dtype.kind == "U":
        return str(array) if array.ndim == 0 else tuple(str(item) for item in array)
    return array.item() if array.ndim == 0 else array


def _known() -> str:
    return ", ".join(sorted(_REGISTERED)) or "none"
