"""Checks of input: every refusal names the argument, shows the value and says what is expected.

A wrong kind of value (text for a number, a list for a rotor) is a TypeError, a value out of its
range a ValueError. Arrays that are kept are copies and read-only.
"""

from __future__ import annotations

import copyreg
import operator
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import Field, field, fields
from functools import cache
from math import inf, isfinite
from numbers import Integral, Real
from pathlib import Path
from types import MappingProxyType, NoneType, UnionType
from typing import Any, TypeVar, get_args, get_type_hints

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

Kind = TypeVar("Kind")
Shape = tuple[int | None, ...]

_KINDS = {
    float: "numbers", complex: "complex numbers",
    int: "whole numbers", bool: "flags (True, False)",
}  # fmt: skip
_SIGNS = {">": operator.gt, "≥": operator.ge, "<": operator.lt, "≤": operator.le}
_SYMMETRY = 1e-8  # of the largest entry: above the rounding of sums, far below a wrong matrix
_LONGEST = 80  # characters of a value in a message
_LONGEST_FIELD = 60  # of one value in a repr


# ------------------------------------------------------------------ messages


def shown(value: object) -> str:
    """Return a value as a message shows it: arrays by shape and kind, long texts cut."""
    if isinstance(value, np.ndarray) and value.size > 6:
        return f"an array of shape {value.shape}, {value.dtype}"
    if sp.issparse(value):
        return f"a sparse matrix of shape {value.shape}"
    text = _cut(" ".join(repr(value).split()), _LONGEST)
    return text if isinstance(value, _PLAIN) else f"{text} ({type(value).__name__})"


_PLAIN = (str, bool, int, float, complex, type(None), list, tuple, np.ndarray, np.number)


def _cut(text: str, longest: int) -> str:
    return text if len(text) <= longest else f"{text[: longest - 1]}…"


def told(name: str, needed: str, value: object) -> str:
    """Return the message of a refusal: which argument, what it needs, and what it got."""
    return f"{name}: needs {needed}, got {shown(value)}"


def of_unit(unit: str) -> str:
    """Return a unit in brackets, after a blank; nothing for none."""
    return f" [{unit}]" if unit else ""


# ------------------------------------------------------------------ single numbers and flags


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
    if type(value) is float and above is least is below is most is None and isfinite(value):
        return value  # functions of time call this in every step
    given = zip(_SIGNS.items(), (above, least, below, most), strict=True)
    limits = [(sign, holds, n) for (sign, holds), n in given if n is not None]
    words = " and ".join(f"{sign} {n:g}" for sign, _, n in limits)
    needed = f"a finite number{of_unit(unit)}{' ' if words else ''}{words}"
    result = float(_scalar(value, Real, name, needed))
    if not isfinite(result) or not all(holds(result, n) for _, holds, n in limits):
        raise ValueError(told(name, needed, value))
    return result


def _scalar(value: object, kind: type[Real], name: str, needed: str) -> Any:
    """Return one number of a kind, also of an array without dimensions; flags are none."""
    found = value.item() if isinstance(value, np.ndarray) and value.ndim == 0 else value
    if isinstance(found, bool) or not isinstance(found, kind):
        raise TypeError(told(name, needed, value))
    return found


def keep(item: object, **values: object) -> None:
    """Keep checked fields in a frozen dataclass."""
    for name, value in values.items():
        object.__setattr__(item, name, value)


def keep_numbers(item: object, units: Mapping[str, str], **bounds: float) -> None:
    """Check attributes of a frozen object, given with their units, and keep them as floats."""
    for name, unit in units.items():
        object.__setattr__(item, name, number(getattr(item, name), name, unit, **bounds))


def tolerance(value: float, name: str = "tolerance") -> float:
    """Return a relative tolerance: a number above 0 and below 1."""
    return number(value, name, above=0.0, below=1.0)


def accuracy(value: float | None) -> None:
    """Check the largest error by the basis of a reduced rotor, `accuracy`; None for no estimate."""
    if value is not None:
        tolerance(value, "accuracy")


def count(value: int, name: str, *, least: float = 0, most: float = inf) -> int:
    """Return a whole number within limits, both included."""
    lower = f" ≥ {least}" if least > -inf else ""
    needed = f"a whole number{lower}" + (f" and ≤ {most}" if most < inf else "")
    found = int(_scalar(value, Integral, name, needed))
    if not least <= found <= most:
        raise ValueError(told(name, needed, value))
    return found


def whole_number(value: int, name: str) -> int:
    """Return a whole number of either sign."""
    return count(value, name, least=-inf)


def flag(value: bool, name: str) -> bool:
    """Return True or False; words and numbers are refused."""
    if not isinstance(value, bool | np.bool_):
        raise TypeError(told(name, "True or False", value))
    return bool(value)


# ------------------------------------------------------------------ objects, functions, paths


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
    if isinstance(values, str | bytes | Mapping) or not isinstance(values, Iterable):
        raise TypeError(told(name, needed, values))
    return tuple(values)


def _named(kinds: type | tuple[type, ...]) -> str:
    several = kinds if isinstance(kinds, tuple) else get_args(kinds) or (kinds,)
    return " or ".join(kind.__name__ for kind in several)


def function(value: Callable, name: str) -> Callable:
    """Return something that can be called."""
    if not callable(value):
        raise TypeError(told(name, "a function", value))
    return value


def path(value: str | os.PathLike, name: str = "path") -> Path:
    """Return the path of a file."""
    if not isinstance(value, str | os.PathLike):
        raise TypeError(told(name, "the path of a file (text or Path)", value))
    return Path(value)


def file(value: str | os.PathLike, name: str = "path") -> Path:
    """Return the path of a file that is there."""
    source = path(value, name)
    if source.is_dir():
        raise IsADirectoryError(f"{name}: needs the name of a file, {str(source)!r} is a folder")
    if not source.is_file():
        raise FileNotFoundError(
            f"{name}: there is no file {str(source)!r}; give its whole path, or that from the "
            f"folder {os.getcwd()!r} on"
        )
    return source


def read_only_mapping(values: Mapping[str, Kind]) -> Mapping[str, Kind]:
    """Return a copy that cannot be written to; it can be pickled and copied."""
    return MappingProxyType(dict(values))


# results and rotors go to other processes; Python itself does not pickle a read-only mapping
copyreg.pickle(MappingProxyType, lambda view: (read_only_mapping, (dict(view),)))


# ------------------------------------------------------------------ words and names


def choice(value: str, name: str, options: Iterable[str]) -> str:
    """Return one of a few words."""
    if not isinstance(value, str) or value not in options:
        known = ", ".join(repr(option) for option in options)
        kind = ValueError if isinstance(value, str) else TypeError
        raise kind(f"{name}: {shown(value)} is unknown; use one of {known}")
    return value


def label(value: str, name: str) -> str:
    """Return a name: text that is not empty."""
    if not isinstance(value, str):
        raise TypeError(told(name, "a name (text)", value))
    if not value.strip():
        raise ValueError(told(name, "a name that is not empty", value))
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


# ------------------------------------------------------------------ arrays and matrices


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
    real, and floats in place of whole numbers are refused. What can be written to is copied.
    """

    def needed() -> str:
        kind = "finite " * (finite and dtype in (float, complex)) + _KINDS[dtype]
        return f"{kind}{of_unit(unit)}{_of_shape(shape)}"

    exact = type(values) is np.ndarray and values.dtype == dtype
    result = read_only(values if exact else _numbers(values, name, needed(), dtype), dtype)
    if shape is not None and not _has_shape(result.shape, shape):
        raise ValueError(told(name, needed(), values) + f" with the shape {result.shape}")
    if finite and not np.all(np.isfinite(result)):
        raise ValueError(told(name, needed(), values))
    return result


def vector(values: ArrayLike, name: str, unit: str = "", size: int | None = 3) -> np.ndarray:
    """Return a read-only array of `size` finite numbers, of any length for None."""
    return array(values, name, unit, shape=(size,))


def one_or_each(values: ArrayLike, name: str, unit: str, size: int, **bounds: float) -> np.ndarray:
    """Return a vector (size,) of numbers within bounds, given as one for all or as many."""
    given = array(values, name, unit)
    found = np.full(size, given) if given.ndim == 0 else vector(values, name, unit, size)
    for each in found.tolist() if bounds else ():
        number(each, name, unit, **bounds)
    return read_only(found)


def whole_numbers(
    values: ArrayLike, name: str, *, least: float = 0, most: float = inf
) -> np.ndarray:
    """Return a read-only array (k,) of whole numbers within limits, both included."""
    result = array(values, name, shape=(None,), dtype=int)
    outside = result[(result < least) | (result > most)]
    if outside.size:
        upper = f" and ≤ {most}" if most < inf else ""
        raise ValueError(f"{name}: needs whole numbers ≥ {least}{upper}, got {outside[0]}")
    return result


def matrix(values: Any, name: str, unit: str = "", *, shape: Shape = (None, None)) -> Any:
    """Return a matrix of finite numbers: a read-only array, or a sparse one as ``csr_array``."""
    if not sp.issparse(values):
        return array(values, name, unit, shape=shape)
    if not _has_shape(values.shape, shape):
        raise ValueError(told(name, f"finite numbers{of_unit(unit)}{_of_shape(shape)}", values))
    result = sp.csr_array(values)
    if not result.has_canonical_format:  # later, in place, it could not be put into it
        result = result.copy()
        result.sum_duplicates()
    result.data = array(result.data, f"{name}: its entries", unit, shape=(None,))
    result.indices = read_only(result.indices, result.indices.dtype)
    result.indptr = read_only(result.indptr, result.indptr.dtype)
    return result


def symmetric(values: Any, name: str, unit: str = "", *, size: int, sign: int = 1) -> Any:
    """Return a symmetric matrix (sign −1: skew-symmetric); sparse ones are trusted to be so."""
    result = matrix(values, name, unit, shape=(size, size))
    if sp.issparse(result):
        return result
    wrong, largest = (np.abs(m).max(initial=0.0) for m in (result - sign * result.T, result))
    if wrong > _SYMMETRY * largest:
        kind = f"a {'symmetric' if sign > 0 else 'skew-symmetric'} matrix"
        raise ValueError(f"{name}: needs {kind}; {wrong:.3g} of {largest:.3g} is not")
    return result


def rotation(values: ArrayLike, name: str = "rotation") -> np.ndarray:
    """Return a proper rotation matrix, shape (3, 3), read-only."""
    result = array(values, name, shape=(3, 3))
    # a user's rounding to nine digits, 2 √3 · 5e-10 in R Rᵀ, is meant to be a rotation
    if np.abs(result @ result.T - np.eye(3)).max() > 2e-9 or np.linalg.det(result) < 0.0:
        raise ValueError(told(name, "a rotation matrix (R Rᵀ = 1, det R = 1)", result.tolist()))
    return result


def ascending(values: Sequence[float], name: str, unit: str = "") -> np.ndarray:
    """Return one or more finite numbers in ascending order, each once, read-only."""
    if isinstance(values, int | float | np.number):
        values = [values]
    result = vector(values, name, unit, size=None)
    if result.size == 0 or np.any(np.diff(result) <= 0.0):
        needed = f"at least one number{of_unit(unit)}, in ascending order without repetition"
        remedy = "np.unique makes them so; with return_index=True for a table's values, too"
        raise ValueError(told(name, f"{needed} ({remedy})", values))
    return result


def ascending_from_zero(
    values: ArrayLike, name: str, otherwise: str = "turn the spin axis round for the other sense"
) -> np.ndarray:
    """Return ascending values, none of them negative; `otherwise` says what else to do."""
    result = ascending(values, name)
    if result[0] < 0.0:
        raise ValueError(f"{name}: {result[0]:g} is negative; give values ≥ 0, or {otherwise}")
    return result


def spin_speeds(speeds: ArrayLike, allow_negative: bool) -> np.ndarray:
    """Return ascending spin speeds, none of them negative unless that is allowed."""
    if flag(allow_negative, "allow_negative"):
        return ascending(speeds, "speeds")
    turn = "pass allow_negative=True if the rotor is meant to spin the other way round"
    return ascending_from_zero(speeds, "speeds", turn)


def read_only(values: ArrayLike, dtype: type = float) -> np.ndarray:
    """Return an array that cannot be written to: as it is if so already, else a copy."""
    shared = type(values) is np.ndarray and values.dtype == dtype
    if shared and values.flags.owndata and not values.flags.writeable:
        return values
    copy = np.array(values, dtype=dtype)
    copy.flags.writeable = False
    return copy


def _numbers(values: object, name: str, needed: str, dtype: type) -> np.ndarray:
    """Return `values` as an array of numbers that `dtype` can hold without loss."""
    if np.ma.is_masked(values):
        raise ValueError(f"{name}: needs {needed}, got masked entries; fill them")
    try:
        result = np.asarray(values)
    except ValueError as error:  # rows of different lengths
        raise TypeError(told(name, needed, values)) from error
    if result.size == 0:  # an empty list has no type
        return result
    if result.dtype.kind == "c" and dtype is not complex:
        if np.any(result.imag):
            raise ValueError(f"{name}: needs real numbers, got imaginary parts: {shown(values)}")
        return result.real
    # flags are no numbers: True for a stiffness is a slip
    if result.dtype.kind not in {complex: "uifc", bool: "b", int: "ui"}.get(dtype, "uif"):
        raise TypeError(told(name, needed, values))
    return result


def _of_shape(shape: Shape | None) -> str:
    return "" if shape is None else f" of shape {shape}".replace("None", "any")


def _has_shape(found: tuple[int, ...], wanted: Shape) -> bool:
    return len(found) == len(wanted) and all(
        size is None or size == there for there, size in zip(found, wanted, strict=True)
    )


def place(value: str | int | Sequence[float], name: str) -> str | int | tuple[float, float, float]:
    """Return a place of the rotor: an interface's name, a node's number or a position [m]."""
    if isinstance(value, str):
        return label(value, name)
    if isinstance(value, int | np.integer):
        return count(value, name)
    try:
        return tuple(vector(value, name, "m").tolist())
    except (TypeError, ValueError) as error:
        raise type(error)(
            f"{name}: needs the name of an interface, a node number or a position of three finite "
            f"numbers [m], got {shown(value)}"
        ) from error


# ------------------------------------------------------------------ fields of dataclasses


def numbers(
    *shape: int | str,
    dtype: type = float,
    finite: bool = True,
    least: float | None = None,
    most: float | None = None,
    optional: bool = False,
) -> Any:
    """Describe an array of a result, for the body of its class.

    Parameters
    ----------
    *shape : int or str
        Sizes; the same word is the same size in all arrays and rows of words of a result.
    dtype : type, optional
        float, complex, int or bool.
    finite : bool, optional
        False where NaN or infinity mean something.
    least, most : float, optional
        Limits of every value.
    optional : bool, optional
        True for an array that may be None, and is by default.

    Examples
    --------
    >>> import numpy as np
    >>> from dataclasses import dataclass
    >>> from exudyn_rotor import Result
    >>> from exudyn_rotor.checks import numbers
    >>> @dataclass(frozen=True, eq=False)
    ... class Track(Result):
    ...     time: np.ndarray = numbers("steps")
    ...     place: np.ndarray = numbers("steps", 3)
    >>> Track([0.0, 1.0], np.zeros((2, 3)))
    Track(time=array(2,), place=array(2, 3))
    """
    told = {"shape": shape, "dtype": dtype, "finite": finite, "least": least, "most": most}
    return field(metadata=told, **({"default": None, "kw_only": True} if optional else {}))


def words(size: int | str, **given: Any) -> Any:
    """Describe a row of words of a result by its size; `given` as of :func:`one_of`."""
    return field(metadata={"shape": (size,)}, **given)


def one_of(options: Sequence[str], **given: Any) -> Any:
    """Describe a word by those that it may be; `given` goes to :func:`dataclasses.field`."""
    return field(metadata={"options": options}, **given)


class Checked:
    """Base of dataclasses whose fields are checked, by their types and :func:`numbers`."""

    def __init_subclass__(cls, **options) -> None:
        """Keep the dataclass decorator from making a repr that prints whole arrays."""
        super().__init_subclass__(**options)
        if "__repr__" not in cls.__dict__:
            cls.__repr__ = Checked.__repr__

    def __post_init__(self) -> None:
        sizes: dict[str, int] = {}
        types = field_types(type(self))
        for item in fields(self):
            value = getattr(self, item.name)
            if value is None and item.default is None:
                continue
            if types[item.name] is np.ndarray:
                value = _array(value, item)
            else:
                value = FIELD_CHECKS[types[item.name]](value, item.name)
            _check_shape(np.shape(value), item, sizes)
            if "options" in item.metadata:
                choice(value, item.name, item.metadata["options"])
            object.__setattr__(self, item.name, value)

    def __repr__(self) -> str:
        """Return the fields in one line: arrays by their shape, long words and tuples cut."""
        in_order = sorted(fields(self), key=lambda item: item.kw_only)  # as the constructor
        parts = [f"{f.name}={_short(getattr(self, f.name))}" for f in in_order]
        return f"{type(self).__name__}({', '.join(parts)})"


@cache
def field_types(cls: type) -> dict[str, Any]:
    """Return the types of a result's fields; ``X | None`` counts as X."""
    hints = get_type_hints(cls)
    return {item.name: _without_none(hints[item.name]) for item in fields(cls)}


def _without_none(hint: Any) -> Any:
    given = [kind for kind in get_args(hint) if kind is not NoneType]
    return given[0] if isinstance(hint, UnionType) and len(given) == 1 else hint


def _array(value: object, item: Field) -> np.ndarray:
    """Return a read-only array of the described type, its values within the limits."""
    told = {"finite": False, "dtype": float, **item.metadata}
    result = array(value, item.name, finite=told["finite"], dtype=told["dtype"])
    for sign, name in (("≥", "least"), ("≤", "most")):
        limit = told.get(name)
        if limit is not None and not np.all(_SIGNS[sign](result, limit) | np.isnan(result)):
            raise ValueError(f"{item.name}: needs values {sign} {limit}")
    return result


def _check_shape(shape: tuple[int, ...], item: Field, sizes: dict[str, int]) -> None:
    """Compare a shape with the described one; learn sizes from it."""
    told = item.metadata.get("shape")
    if told is None:
        return
    if len(shape) == len(told):
        for word, size in zip(told, shape, strict=True):
            if isinstance(word, str):
                sizes.setdefault(word, size)
    wanted = tuple(sizes.get(size, size) for size in told)
    if shape != wanted:
        raise ValueError(f"{item.name}: needs the shape {wanted}, got {shape}")


FIELD_CHECKS: dict[Any, Any] = {
    np.ndarray: _array,
    float: number,
    int: whole_number,
    bool: flag,
    str: label,
    tuple[str, ...]: labels,
}


def _short(value: object) -> str:
    """Return an array's shape, or what `repr` says of a small value."""
    if isinstance(value, np.ndarray):
        return f"array{value.shape}"
    return _cut(repr(value), _LONGEST_FIELD)
