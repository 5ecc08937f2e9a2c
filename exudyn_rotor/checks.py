"""Checks of input: every refusal names the argument, shows the value and says what is expected.

A wrong kind of value (text for a number, a list for a rotor) is a TypeError, a value out of its
range a ValueError. Arrays that are kept are copies and read-only.
"""

from __future__ import annotations

import copyreg
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeVar

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

Kind = TypeVar("Kind")
Shape = tuple[int | None, ...]

_LONGEST = 80  # characters of a value in a message
_SYMMETRY = 1e-8  # of the largest entry: above the rounding of sums, far below a wrong matrix
_NUMBERS = "buif"


def shown(value: object) -> str:
    """Return a value as a message shows it: arrays by shape and kind, long texts cut."""
    if isinstance(value, np.ndarray) and value.size > 6:
        return f"an array of shape {value.shape}, {value.dtype}"
    if sp.issparse(value):
        return f"a sparse matrix of shape {value.shape}"
    try:
        text = repr(value)
    # repr of a foreign object, or of an integer beyond Python's limit of digits
    except Exception:
        return f"a value of type {type(value).__name__}"
    text = " ".join(text.split())
    text = text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"
    return text if isinstance(value, _PLAIN) else f"{text} ({type(value).__name__})"


_PLAIN = (str, bool, int, float, complex, type(None), list, tuple, np.ndarray, np.number)


def _unit(unit: str) -> str:
    return f" [{unit}]" if unit else ""


# ------------------------------------------------------------------ numbers


def number(
    value: float,
    name: str,
    unit: str = "",
    *,
    above: float | None = None,
    least: float | None = None,
    below: float | None = None,
    most: float | None = None,
) -> float:
    """Return a finite real number; `above` and `below` are excluded, `least` and `most` not."""
    limits = [
        f"{sign} {limit:g}"
        for sign, limit in ((">", above), ("≥", least), ("<", below), ("≤", most))
        if limit is not None
    ]
    needed = f"a finite number{_unit(unit)}" + (f" {' and '.join(limits)}" if limits else "")
    result = _scalar(value, name, needed)
    outside = (
        (above is not None and not result > above)
        or (least is not None and not result >= least)
        or (below is not None and not result < below)
        or (most is not None and not result <= most)
    )
    if outside or not np.isfinite(result):
        raise ValueError(f"{name}: needs {needed}, got {shown(value)}")
    return result


def _scalar(value: object, name: str, needed: str) -> float:
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | float | np.ndarray):
        if not isinstance(value, np.integer | np.floating):
            raise TypeError(f"{name}: needs {needed}, got {shown(value)}")
    elif isinstance(value, np.ndarray) and (value.ndim or value.dtype.kind not in "uif"):
        raise TypeError(f"{name}: needs {needed}, got {shown(value)}")
    if np.ma.is_masked(value):
        raise ValueError(f"{name}: needs {needed}, got a masked value")
    try:
        return float(value)
    except OverflowError as error:
        raise ValueError(f"{name}: needs {needed}, got {shown(value)}") from error


def tolerance(value: float, name: str = "tolerance") -> float:
    """Return a relative tolerance: a number above 0 and below 1."""
    return number(value, name, above=0.0, below=1.0)


def count(value: int, name: str, *, least: int = 0, most: int | None = None) -> int:
    """Return a whole number within limits, both included."""
    upper = "" if most is None else f" and ≤ {most}"
    needed = f"a whole number ≥ {least}{upper}"
    value = _whole(value, name, needed)
    if value < least or (most is not None and value > most):
        raise ValueError(f"{name}: needs {needed}, got {shown(value)}")
    return value


def whole_number(value: int, name: str) -> int:
    """Return a whole number of either sign."""
    return _whole(value, name, "a whole number")


def _whole(value: object, name: str, needed: str) -> int:
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | np.integer):
        raise TypeError(f"{name}: needs {needed}, got {shown(value)}")
    return int(value)


def flag(value: bool, name: str) -> bool:
    """Return True or False; words and numbers are refused."""
    if not isinstance(value, bool | np.bool_):
        raise TypeError(f"{name}: needs True or False, got {shown(value)}")
    return bool(value)


# ------------------------------------------------------------------ words


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
        raise TypeError(f"{name}: needs a name (text), got {shown(value)}")
    if not value.strip():
        raise ValueError(f"{name}: needs a name that is not empty, got {shown(value)}")
    return str(value)


def labels(
    values: Iterable[str] | str, name: str, known: Iterable[str] | None = None
) -> tuple[str, ...]:
    """Return names, given as one or as a sequence; each one of `known`, if that is given."""
    if isinstance(values, str):
        values = (values,)
    if isinstance(values, Mapping | bytes) or not isinstance(values, Iterable):
        raise TypeError(f"{name}: needs names (a sequence of text), got {shown(values)}")
    result = tuple(label(value, name) for value in values)
    if known is None:
        return result
    there = tuple(known)
    for value in result:
        if value not in there:
            listed = ", ".join(repr(item) for item in there) or "none"
            raise ValueError(f"{name}: {shown(value)} is unknown; there are: {listed}")
    return result


# ------------------------------------------------------------------ arrays


def array(
    values: ArrayLike,
    name: str,
    unit: str = "",
    *,
    shape: Shape | None = None,
    finite: bool = True,
    dtype: type = float,
) -> np.ndarray:
    """Return numbers as a read-only array of the wanted shape; None in `shape` is any length.

    `dtype` is float, complex, int or bool. Text, masks, imaginary parts of numbers that must be
    real, and fractions of numbers that must be whole are refused. What can be written to is copied.
    """
    needed = f"{_kind_of(dtype, finite)}{_unit(unit)}{_of_shape(shape)}"
    result = read_only(_numbers(values, name, needed, dtype), dtype)
    if shape is not None and not _has_shape(result.shape, shape):
        raise ValueError(f"{name}: needs {needed}, got {shown(values)}{_its_shape(result)}")
    if finite and not np.all(np.isfinite(result)):
        raise ValueError(f"{name}: needs {needed}, got {shown(values)}")
    return result


def vector(values: ArrayLike, name: str, unit: str = "", size: int | None = 3) -> np.ndarray:
    """Return a read-only array of `size` finite numbers, of any length for None."""
    return array(values, name, unit, shape=(size,))


def whole_numbers(
    values: ArrayLike, name: str, *, least: int = 0, most: int | None = None
) -> np.ndarray:
    """Return a read-only array (k,) of whole numbers within limits, both included."""
    result = array(values, name, shape=(None,), dtype=int)
    outside = (result < least) | (result > (np.iinfo(int).max if most is None else most))
    if np.any(outside):
        upper = "" if most is None else f" and ≤ {most}"
        raise ValueError(
            f"{name}: needs whole numbers ≥ {least}{upper}, got {result[np.argmax(outside)]}"
        )
    return result


def matrix(values: Any, name: str, unit: str = "", *, shape: Shape = (None, None)) -> Any:
    """Return a matrix of finite numbers: a read-only array, or a sparse one as ``csr_array``."""
    if not sp.issparse(values):
        return array(values, name, unit, shape=shape)
    needed = f"finite numbers{_unit(unit)}{_of_shape(shape)}"
    if not _has_shape(values.shape, shape):
        raise ValueError(f"{name}: needs {needed}, got a sparse matrix of shape {values.shape}")
    rows = values.tocsr()
    result = sp.csr_array(rows)
    result.data = array(rows.data, f"{name}: its entries", unit, shape=(None,))
    result.indices = read_only(rows.indices, rows.indices.dtype)
    result.indptr = read_only(rows.indptr, rows.indptr.dtype)
    return result


def symmetric(values: Any, name: str, unit: str = "", *, size: int, sign: int = 1) -> Any:
    """Return a symmetric matrix (size, size), for the sign −1 a skew-symmetric one.

    Of a sparse one, entries and shape are looked at only.
    """
    result = matrix(values, name, unit, shape=(size, size))
    if sp.issparse(result):
        return result
    difference = np.abs(result - sign * result.T).max(initial=0.0)
    largest = np.abs(result).max(initial=0.0)
    if difference > _SYMMETRY * largest:
        kind = "symmetric" if sign > 0 else "skew-symmetric"
        raise ValueError(
            f"{name}: needs a {kind} matrix; entries differ by {difference:.3g}, the largest is "
            f"{largest:.3g}"
        )
    return result


def rotation(values: ArrayLike, name: str = "rotation") -> np.ndarray:
    """Return a proper rotation matrix, shape (3, 3), read-only."""
    result = array(values, name, shape=(3, 3))
    # a user's rounding to nine digits is meant to be a rotation, a scaling by 1 + 1e-6 is not
    if not np.allclose(result @ result.T, np.eye(3), atol=1e-9) or np.linalg.det(result) < 0.0:
        raise ValueError(
            f"{name}: needs a rotation matrix, orthonormal with determinant +1, got "
            f"{shown(result.tolist())}"
        )
    return result


def _numbers(values: object, name: str, needed: str, dtype: type) -> np.ndarray:
    """Return `values` as an array of numbers that `dtype` can hold without loss."""
    if isinstance(values, str | bytes | Mapping | set | frozenset) or values is None:
        raise TypeError(f"{name}: needs {needed}, got {shown(values)}")
    if sp.issparse(values):
        raise TypeError(f"{name}: needs {needed}, got a sparse matrix; give a dense array")
    if np.ma.isMaskedArray(values) and np.ma.is_masked(values):
        raise ValueError(f"{name}: needs {needed}, got an array with masked entries; fill them")
    try:
        result = np.asarray(values)
    # ragged lists, foreign objects with broken array protocols
    except Exception as error:
        raise TypeError(f"{name}: needs {needed}, got {shown(values)}") from error
    if result.size == 0 and result.dtype.kind in _NUMBERS:
        return result
    if result.dtype.kind == "c" and dtype is not complex:
        if np.any(result.imag):
            raise ValueError(f"{name}: needs real numbers, got imaginary parts: {shown(values)}")
        return result.real
    # flags are no numbers: True for a stiffness is a slip
    if result.dtype.kind not in {complex: "uifc", bool: "b"}.get(dtype, "uif"):
        raise TypeError(f"{name}: needs {needed}, got {shown(values)}")
    if dtype is int and result.dtype.kind == "f":
        if not np.all(np.isfinite(result)) or np.any(result != np.round(result)):
            raise ValueError(f"{name}: needs {needed}, got {shown(values)}")
        raise TypeError(f"{name}: needs {needed} of an integer type, got {shown(values)}")
    return result


def _kind_of(dtype: type, finite: bool) -> str:
    if dtype in (int, bool):
        return {int: "whole numbers", bool: "flags (True, False)"}[dtype]
    kind = {float: "numbers", complex: "complex numbers"}[dtype]
    return f"finite {kind}" if finite else kind


def _of_shape(shape: Shape | None) -> str:
    if shape is None:
        return ""
    sizes = ["any" if size is None else str(size) for size in shape]
    return f" of shape ({', '.join(sizes)}{',' if len(sizes) == 1 else ''})"


def _its_shape(result: np.ndarray) -> str:
    return "" if result.size > 6 else f" of shape {result.shape}"


def _has_shape(found: tuple[int, ...], wanted: Shape) -> bool:
    return len(found) == len(wanted) and all(
        size is None or size == there for there, size in zip(found, wanted, strict=True)
    )


# ------------------------------------------------------------------ objects


def instance(value: object, name: str, kinds: type[Kind] | tuple[type, ...], how: str = "") -> Kind:
    """Return an object of one of the `kinds`; `how` says how to make one."""
    if not isinstance(value, kinds):
        raise TypeError(
            f"{name}: needs {_named(kinds)}, got {shown(value)}" + (f"; {how}" if how else "")
        )
    return value


def instances(
    values: Iterable[Kind] | Kind, name: str, kinds: type[Kind] | tuple[type, ...], how: str = ""
) -> tuple[Kind, ...]:
    """Return objects of some kinds, given as one or as a sequence."""
    if isinstance(values, kinds):
        return (values,)
    needed = f"a {_named(kinds)} or a sequence of them"
    listed = items(values, name, f"{needed} ({how})" if how else needed)
    return tuple(
        instance(value, f"{name}[{index}]", kinds, how) for index, value in enumerate(listed)
    )


def items(values: Iterable[Any], name: str, needed: str) -> tuple:
    """Return what a sequence holds; text and mappings are none. `needed` is for the message."""
    if not isinstance(values, str | bytes | Mapping) and isinstance(values, Iterable):
        try:
            return tuple(values)
        # an array without dimensions, an iterator that breaks off
        except Exception as error:
            raise TypeError(f"{name}: needs {needed}, got {shown(values)}") from error
    raise TypeError(f"{name}: needs {needed}, got {shown(values)}")


def _named(kinds: type | tuple[type, ...]) -> str:
    several = kinds if isinstance(kinds, tuple) else (kinds,)
    return " or ".join(kind.__name__ for kind in several)


def mapping(value: Mapping[str, Kind], name: str, what: str = "") -> Mapping[str, Kind]:
    """Return a mapping whose keys are names; `what` says what it maps names to."""
    if not isinstance(value, Mapping):
        raise TypeError(
            f"{name}: needs a dictionary of name to {what or 'value'}, got {shown(value)}"
        )
    for key in value:
        label(key, f"{name}: its key")
    return value


def function(value: Callable, name: str) -> Callable:
    """Return something that can be called."""
    if not callable(value):
        raise TypeError(f"{name}: needs a function, got {shown(value)}")
    return value


def executor(value: Any, name: str = "executor") -> Any:
    """Return an executor with a ``map`` method, or None."""
    if value is None or (callable(getattr(value, "map", None)) and not isinstance(value, type)):
        return value
    raise TypeError(
        f"{name}: needs an executor with a map method, e.g. of concurrent.futures, or None, got "
        f"{shown(value)}"
    )


def path(value: str | os.PathLike, name: str = "path") -> Path:
    """Return the path of a file."""
    if isinstance(value, bytes) or not isinstance(value, str | os.PathLike):
        raise TypeError(f"{name}: needs the path of a file (text or Path), got {shown(value)}")
    text = os.fspath(value)
    if isinstance(text, bytes) or not text or "\0" in text:
        raise ValueError(f"{name}: needs the path of a file, got {shown(value)}")
    return Path(text)


def read_only(values: ArrayLike, dtype: type = float) -> np.ndarray:
    """Return an array that cannot be written to: as it is if so already, else a copy."""
    shared = type(values) is np.ndarray and values.dtype == dtype
    if shared and values.flags.owndata and not values.flags.writeable:
        return values
    copy = np.array(values, dtype=dtype)
    copy.flags.writeable = False
    return copy


def read_only_mapping(values: Mapping[str, Kind]) -> Mapping[str, Kind]:
    """Return a copy that cannot be written to; it can be pickled and copied."""
    return MappingProxyType(dict(values))


# results and rotors go to other processes; Python itself does not pickle a read-only mapping
copyreg.pickle(MappingProxyType, lambda view: (read_only_mapping, (dict(view),)))


def ascending(values: Sequence[float], name: str, unit: str = "") -> np.ndarray:
    """Return one or more finite numbers in ascending order, each once, read-only."""
    if isinstance(values, int | float | np.number):
        values = [values]
    result = vector(values, name, unit, size=None)
    if result.size == 0 or np.any(np.diff(result) <= 0.0):
        raise ValueError(
            f"{name}: needs at least one number{_unit(unit)}, in ascending order without "
            f"repetition (np.unique makes them so), got {shown(values)}"
        )
    return result
