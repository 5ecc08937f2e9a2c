"""Good values of another kind than usual: what checks must not refuse."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp

Made = Iterator[tuple[str, Callable[[], Any]]]


def unusual(good: Any) -> Made:
    """Yield labels and makers of values that mean the same as a good one."""
    if isinstance(good, bool):
        yield "numpy flag", lambda: np.bool_(good)
    elif isinstance(good, int | float):
        yield from _numbers(good)
    elif isinstance(good, str):
        yield "numpy text", lambda: np.str_(good)
    elif isinstance(good, Path):
        yield "text", lambda: str(good)
    elif sp.issparse(good):
        for form in ("csc", "coo", "lil"):
            yield f"sparse {form}", lambda form=form: good.asformat(form)
        yield "dense", good.toarray
    elif isinstance(good, list | tuple | np.ndarray):
        yield from _sequences(good)


def _numbers(good: float) -> Made:
    yield "no dimension", lambda: np.array(good)
    if isinstance(good, int):
        yield "numpy whole number", lambda: np.int32(good)
        return
    yield "numpy number", lambda: np.float64(good)
    if np.float32(good) == good:
        yield "short number", lambda: np.float32(good)
    if good == int(good):
        yield "whole number", lambda: int(good)
        yield "numpy whole number", lambda: np.int64(good)


def _sequences(good: Any) -> Made:
    kind = np.asarray(good, dtype=object if _is_mixed(good) else None).dtype.kind
    if not isinstance(good, np.ndarray):
        yield "list", lambda: list(good)
        yield "tuple", lambda: tuple(good)
    if kind == "U":
        yield "array of texts", lambda: np.array(good)
    if kind not in "iufc" or np.size(good) == 0:
        return
    array = np.array(good)
    yield "nested lists", array.tolist
    yield "Fortran order", lambda: np.asfortranarray(array)
    yield "every second", lambda: np.repeat(array, 2, axis=-1)[..., ::2]
    yield "other byte order", lambda: array.astype(array.dtype.newbyteorder())
    yield "read-only", lambda: _locked(array)
    yield "masked array without mask", lambda: np.ma.array(array)
    if kind == "i":
        yield "short whole numbers", lambda: array.astype(np.int32)
    if kind == "f" and array.size < 100 and np.all(array.astype(np.float32) == array):
        yield "short numbers", lambda: array.astype(np.float32)
    if kind == "f" and np.all(array == np.round(array)):
        yield "whole numbers", lambda: array.astype(np.int64)


def _is_mixed(good: Any) -> bool:
    return any(
        not isinstance(value, int | float | complex | str | np.number) for value in good
    ) and (not _is_nested(good))


def _is_nested(good: Any) -> bool:
    return all(isinstance(value, list | tuple | np.ndarray) for value in good)


def _locked(array: np.ndarray) -> np.ndarray:
    copy = array.copy()
    copy.flags.writeable = False
    return copy
