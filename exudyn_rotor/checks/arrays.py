"""Checks of arrays and matrices. What is kept is a copy and read-only."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor.checks.messages import of_unit, shown, told
from exudyn_rotor.checks.numbers import LARGEST, MOST

Shape = tuple[int | None, ...]
_SYMMETRY = 1e-8  # of the largest entry: above the rounding of sums, far below a wrong matrix


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

    def needed() -> str:
        return f"{_kind_of(dtype, finite)}{of_unit(unit)}{_of_shape(shape)}"

    exact = type(values) is np.ndarray and values.dtype == dtype
    result = read_only(values if exact else _numbers(values, name, needed(), dtype), dtype)
    if shape is not None and not _has_shape(result.shape, shape):
        raise ValueError(told(name, needed(), values) + f" with the shape {result.shape}")
    largest = MOST if dtype is int else LARGEST
    if finite and not np.abs(result).max(initial=0) <= largest:  # NaN is not
        if not np.all(np.isfinite(result)):
            raise ValueError(told(name, needed(), values))
        raise ValueError(f"{name}: needs numbers below {largest:g} in size, got {shown(values)}")
    return result


def vector(values: ArrayLike, name: str, unit: str = "", size: int | None = 3) -> np.ndarray:
    """Return a read-only array of `size` finite numbers, of any length for None."""
    return array(values, name, unit, shape=(size,))


def whole_numbers(values: ArrayLike, name: str, *, least: int = 0, most: int = MOST) -> np.ndarray:
    """Return a read-only array (k,) of whole numbers within limits, both included."""
    result = array(values, name, shape=(None,), dtype=int)
    outside = result[(result < least) | (result > most)]
    if outside.size:
        upper = f" and ≤ {most}" if most < MOST else ""
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


def ascending(
    values: Sequence[float], name: str, unit: str = "", of_table: bool = False
) -> np.ndarray:
    """Return one or more finite numbers in ascending order, each once, read-only.

    Those `of_table` have values beside them, which must not be left behind when they are sorted.
    """
    if isinstance(values, int | float | np.number):
        values = [values]
    result = vector(values, name, unit, size=None)
    if result.size == 0 or np.any(np.diff(result) <= 0.0):
        needed = f"at least one number{of_unit(unit)}, in ascending order without repetition"
        remedy = "np.unique makes them so"
        if of_table:
            remedy = "np.unique(…, return_index=True) gives the places of the values to take along"
        raise ValueError(told(name, f"{needed} ({remedy})", values))
    return result


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
    foreign = str | bytes | Mapping | set | frozenset | None
    if isinstance(values, foreign) or sp.issparse(values):
        raise TypeError(told(name, needed, values))
    if np.ma.isMaskedArray(values) and np.ma.is_masked(values):
        raise ValueError(f"{name}: needs {needed}, got an array with masked entries; fill them")
    try:
        result = np.asarray(values)
    # ragged lists, foreign objects with broken array protocols
    except Exception as error:
        raise TypeError(told(name, needed, values)) from error
    if result.size == 0 and result.dtype.kind in "buif":
        # an empty list has no type, an empty array of numbers holds no flags
        if dtype is bool and isinstance(values, np.ndarray) and result.dtype.kind != "b":
            raise TypeError(told(name, needed, values))
        return result
    if result.dtype.kind == "c" and dtype is not complex:
        if np.any(result.imag):
            raise ValueError(f"{name}: needs real numbers, got imaginary parts: {shown(values)}")
        return result.real
    # flags are no numbers: True for a stiffness is a slip
    if result.dtype.kind not in {complex: "uifc", bool: "b"}.get(dtype, "uif"):
        raise TypeError(told(name, needed, values))
    if dtype is int and result.dtype.kind == "f":
        if not np.all(np.isfinite(result)) or np.any(result != np.round(result)):
            raise ValueError(told(name, needed, values))
        raise TypeError(f"{name}: needs {needed} of an integer type, got {shown(values)}")
    return result


def _kind_of(dtype: type, finite: bool) -> str:
    if dtype in (int, bool):
        return {int: "whole numbers", bool: "flags (True, False)"}[dtype]
    kind = {float: "numbers", complex: "complex numbers"}[dtype]
    return f"finite {kind}" if finite else kind


def _of_shape(shape: Shape | None) -> str:
    return "" if shape is None else f" of shape {shape}".replace("None", "any")


def _has_shape(found: tuple[int, ...], wanted: Shape) -> bool:
    return len(found) == len(wanted) and all(
        size is None or size == there for there, size in zip(found, wanted, strict=True)
    )
