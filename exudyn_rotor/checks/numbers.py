"""Checks of single numbers and flags."""

from __future__ import annotations

import operator
from collections.abc import Mapping

import numpy as np

from exudyn_rotor.checks.messages import of_unit, shown, told

LARGEST = 1e150  # squares of numbers stay finite
MOST = 2**31 - 1  # nodes, modes or points: more than any machine holds
_SIGNS = {">": operator.gt, "≥": operator.ge, "<": operator.lt, "≤": operator.le}


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
    if type(value) is float and above is least is below is most is None and abs(value) < LARGEST:
        return value  # functions of time call this in every step
    given = zip(_SIGNS.items(), (above, least, below, most), strict=True)
    limits = [(sign, holds, n) for (sign, holds), n in given if n is not None]
    words = " and ".join(f"{sign} {n:g}" for sign, _, n in limits)
    needed = f"a finite number{of_unit(unit)}{' ' if words else ''}{words}"
    result = _scalar(value, name, needed)
    if not np.isfinite(result) or not all(holds(result, n) for _, holds, n in limits):
        raise ValueError(told(name, needed, value))
    if abs(result) > LARGEST:
        raise ValueError(f"{name}: needs a number below {LARGEST:g} in size, got {shown(value)}")
    return result


def _scalar(value: object, name: str, needed: str) -> float:
    if value is np.ma.masked:
        raise ValueError(f"{name}: needs {needed}, got a masked value")
    if isinstance(value, np.ndarray | np.generic):
        if value.ndim or value.dtype.kind not in "uif":
            raise TypeError(told(name, needed, value))
    elif isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError(told(name, needed, value))
    try:
        return float(value)
    except OverflowError as error:
        raise ValueError(told(name, needed, value)) from error


def keep_numbers(item: object, units: Mapping[str, str], **bounds: float) -> None:
    """Check attributes of a frozen object, given with their units, and keep them as floats."""
    for name, unit in units.items():
        object.__setattr__(item, name, number(getattr(item, name), name, unit, **bounds))


def tolerance(value: float, name: str = "tolerance") -> float:
    """Return a relative tolerance: a number above 0 and below 1."""
    return number(value, name, above=0.0, below=1.0)


def count(value: int, name: str, *, least: int = 0, most: int = MOST) -> int:
    """Return a whole number within limits, both included."""
    limits = f" ≥ {least}" + (f" and ≤ {most}" if most < MOST else "")
    return _whole(value, name, f"a whole number{limits}", least, most)


def whole_number(value: int, name: str) -> int:
    """Return a whole number of either sign."""
    return _whole(value, name, "a whole number", -MOST, MOST)


def _whole(value: object, name: str, needed: str, least: int, most: int) -> int:
    if isinstance(value, np.ndarray | np.generic):
        is_whole = value.ndim == 0 and value.dtype.kind in "ui" and not np.ma.is_masked(value)
    else:
        is_whole = isinstance(value, int) and not isinstance(value, bool)
    if not is_whole:
        raise TypeError(told(name, needed, value))
    if not least <= value <= most:
        raise ValueError(told(name, needed, value))
    return int(value)


def flag(value: bool, name: str) -> bool:
    """Return True or False; words and numbers are refused."""
    if not isinstance(value, bool | np.bool_):
        raise TypeError(told(name, "True or False", value))
    return bool(value)
