"""Bad values: a pool for every parameter, and what each kind of parameter takes out of it.

A kind says which values of the pool are good for it; all others are bad. To them come the values
that the kind adds, and spoiled copies of the good value that the valid call has.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import exudyn
import numpy as np
import scipy.sparse as sp

HUGE = 10**400  # beyond the range of floats
LARGE = 1e308  # its square is beyond it


class _Broken:
    """Raises an error of its own when it is shown, compared, or turned into an array."""

    def __repr__(self) -> str:
        raise RuntimeError("no repr")

    def __eq__(self, other: object) -> bool:
        raise RuntimeError("no comparison")

    __hash__ = None

    def __array__(self, *args: object, **options: object) -> np.ndarray:
        raise RuntimeError("no array")


POOL: dict[str, Callable[[], Any]] = {
    "None": lambda: None,
    "text": lambda: "nonsense",
    "empty text": lambda: "",
    "digits": lambda: "1.0",
    "numpy text": lambda: np.str_("nonsense"),
    "bytes": lambda: b"1",
    "True": lambda: True,
    "numpy True": lambda: np.True_,
    "two": lambda: 2,
    "fraction": lambda: 1.5,
    "zero": lambda: 0.0,
    "minus one": lambda: -1.0,
    "nan": lambda: math.nan,
    "inf": lambda: math.inf,
    "minus inf": lambda: np.float64(-math.inf),
    "nan of no dimension": lambda: np.array(math.nan),
    "huge": lambda: HUGE,
    "large": lambda: LARGE,
    "complex": lambda: 1.0 + 1.0j,
    "numpy complex": lambda: np.complex128(1.0 + 1.0j),
    "masked": lambda: np.ma.masked,
    "date": lambda: np.datetime64("2020-01-01"),
    "duration": lambda: np.timedelta64(2, "s"),
    "void": lambda: np.void(b"abc"),
    "rational": lambda: Fraction(1, 2),
    "decimal": lambda: Decimal("1.5"),
    "empty list": lambda: [],
    "empty tuple": lambda: (),
    "empty array": lambda: np.zeros(0),
    "empty dict": lambda: {},
    "empty set": lambda: set(),
    "three numbers": lambda: [0.5, 1.5, 2.5],
    "range": lambda: range(3),
    "table": lambda: [[1.0, 2.0], [3.0, 4.0]],
    "block": lambda: np.zeros((2, 3, 4)),
    "ragged": lambda: [[1.0, 2.0], [3.0], 4.0],
    "texts": lambda: ["a", "b", "c"],
    "array of texts": lambda: np.array(["1", "2", "3"]),
    "flags": lambda: [True, False, True],
    "nones": lambda: [None, None, None],
    "nans": lambda: [math.nan] * 3,
    "infs": lambda: np.array([math.inf, 0.0, 0.0]),
    "huges": lambda: [HUGE] * 3,
    "larges": lambda: [LARGE] * 3,
    "imaginary": lambda: np.array([1.0j, 1.0, 2.0]),
    "masked array": lambda: np.ma.masked_equal([1.0, 2.0, 3.0], 2.0),
    "array of objects": lambda: np.array([object(), None, "a"]),
    "dates": lambda: np.array(["2020-01-01"] * 3, dtype="datetime64[D]"),
    "records": lambda: np.zeros(3, dtype=[("a", float), ("b", int)]),
    "sparse": lambda: sp.eye_array(3, format="csr"),
    "dict": lambda: {"a": 1.0},
    "dict of numbers": lambda: {1: 2.0},
    "set": lambda: {1.0, 2.0, 3.0},
    "generator": lambda: (value for value in (0.0, "a", None)),
    "function": lambda: _nothing,
    "class": lambda: dict,
    "module": lambda: math,
    "object": object,
    "broken object": _Broken,
    "path": lambda: Path("nonsense"),
    "slice": lambda: slice(None),
    "ellipsis": lambda: ...,
    "exception": lambda: ValueError("nonsense"),
    "settings": exudyn.SimulationSettings,
}


def _nothing(*args: object) -> None:
    return None


@dataclass(frozen=True)
class Kind:
    """What a parameter takes.

    Attributes
    ----------
    good : frozenset of str
        Values of the pool that it takes.
    more : tuple of (str, callable)
        Further bad values with their labels; each function makes one from the good value.
    spoiled : bool
        Whether spoiled copies of the good value are bad, too: arrays, sequences, mappings.
    finite : bool
        Whether NaN and infinite entries are bad.
    """

    good: frozenset[str] = frozenset()
    more: tuple[tuple[str, Callable[[Any], Any]], ...] = ()
    spoiled: bool = False
    finite: bool = True

    def but(self, *labels: str, **values: Any) -> Kind:
        """Return the kind that also takes some of the pool, and refuses some more `values`."""
        more = tuple((label.replace("_", " "), _constant(value)) for label, value in values.items())
        return Kind(self.good | set(labels), self.more + more, self.spoiled, self.finite)

    def bad(self, good: Any, optional: bool) -> Iterator[tuple[str, Callable[[], Any]]]:
        """Yield labels and makers of bad values; `good` is that of the valid call."""
        for label, make in POOL.items():
            if label not in self.good and not (optional and label == "None"):
                yield label, make
        for label, spoil in self.more:
            yield label, lambda spoil=spoil: spoil(good)
        if self.spoiled:
            for label, spoil in spoils(good, self.finite):
                yield label, lambda spoil=spoil: spoil(good)


def _constant(value: Any) -> Callable[[Any], Any]:
    return lambda good: value


def either(*kinds: Kind) -> Kind:
    """Return the kind of a parameter that takes one of several kinds."""
    good = frozenset().union(*(kind.good for kind in kinds))
    return Kind(good, (), any(kind.spoiled for kind in kinds))


# ------------------------------------------------------------------ spoiled copies


def spoils(good: Any, finite: bool) -> list[tuple[str, Callable[[Any], Any]]]:
    """Return labels and makers of spoiled copies of a good array, sequence or mapping."""
    if sp.issparse(good):
        return [
            ("a sparse row less", lambda value: sp.csr_array(value)[1:]),
            ("a sparse nan", lambda value: _with_entry(sp.csr_array(value), math.nan)),
            ("a sparse inf", lambda value: _with_entry(sp.csr_array(value), math.inf)),
            ("a dense imaginary entry", lambda value: value.toarray() + 1j),
            ("dense text", lambda value: value.toarray().astype(str)),
        ]
    if isinstance(good, dict) or hasattr(good, "keys"):
        return [
            ("a key None", lambda value: {**value, None: next(iter(value.values()), 1.0)}),
            ("a number as key", lambda value: {**value, 3: next(iter(value.values()), 1.0)}),
            ("a value None", lambda value: {**value, **dict.fromkeys([*value, "left"][:1])}),
            ("a foreign value", lambda value: {**value, [*value, "left"][0]: object()}),
            ("its keys", lambda value: list(value)),
        ]
    array = _as_array(good)
    if array is None and not isinstance(good, list | tuple):
        return []
    if array is None:
        return [
            ("a foreign entry", lambda value: [*value, object()]),
            ("an entry None", lambda value: [*value, None]),
            ("a number as entry", lambda value: [*value, 3.25]),
        ]
    return _spoiled_arrays(array, finite)


def _as_array(good: Any) -> np.ndarray | None:
    if isinstance(good, list | tuple) and not good:
        return None
    try:
        array = np.asarray(good)
    except ValueError:
        return None
    return array if array.ndim and array.dtype.kind in "buifc" else None


def _spoiled_arrays(good: np.ndarray, finite: bool) -> list[tuple[str, Callable[[Any], Any]]]:
    found = [
        ("one dimension more", lambda value: np.asarray(value)[..., None]),
        ("as text", lambda value: np.asarray(value).astype(str)),
        ("as objects", lambda value: np.full(np.shape(value), None)),
        ("one entry None", lambda value: _spoiled(value, None, object)),
    ]
    if good.dtype.kind != "c":
        found.append(("one imaginary entry", lambda value: _spoiled(value, 1j, complex)))
    if good.size:
        found.append(("one entry masked", _masked))
    if good.dtype.kind in "iu":
        found.append(("one fraction", lambda value: _spoiled(value, 0.5, float)))
        found.append(("one beyond", lambda value: _spoiled(value, 2**62, np.int64)))
        found.append(("one below", lambda value: _spoiled(value, -(2**62), np.int64)))
    if good.dtype.kind == "b":
        found.append(("numbers", lambda value: np.asarray(value) * 2.0))
    if good.dtype.kind in "fc" and finite and good.size:
        dtype = good.dtype.type
        found.append(("one nan", lambda value: _spoiled(value, math.nan, dtype)))
        found.append(("one inf", lambda value: _spoiled(value, math.inf, dtype)))
        found.append(("one large", lambda value: _spoiled(value, LARGE, dtype)))
    return found


def _spoiled(value: Any, entry: Any, dtype: type) -> np.ndarray:
    array = np.array(value, dtype=dtype)
    if array.size:
        array.flat[-1] = entry
        return array
    return np.array([entry], dtype=dtype)


def _masked(value: Any) -> np.ma.MaskedArray:
    array = np.ma.array(value)
    array[(-1,) * array.ndim] = np.ma.masked
    return array


def _with_entry(matrix: sp.csr_array, entry: float) -> sp.csr_array:
    result = matrix.astype(float).copy()
    result.data[0] = entry
    return result


# ------------------------------------------------------------------ kinds

SIGNED = Kind(frozenset({"two", "fraction", "zero", "minus one"}))
NOT_NEGATIVE = Kind(SIGNED.good - {"minus one"})
POSITIVE = Kind(SIGNED.good - {"minus one", "zero"})
SHARE = Kind().but(one=1.0)
COUNT = Kind(frozenset({"two"})).but(minus_two=-2, integral_float=3.0, many=2**70)
COUNT_FROM_ONE = COUNT.but(no=0)
WHOLE = Kind(frozenset({"two"})).but(integral_float=3.0)
FLAG = Kind(frozenset({"True", "numpy True"})).but(no=0, yes=1, word_no="no")
WORD = Kind().but(list_of_words=["free"], tuple_of_words=("tilt",), bytes_free=b"free")
NAME = Kind(frozenset({"text", "digits", "numpy text"})).but(blank="  ")
KNOWN = Kind().but(list_of_names=["left"], other="Left ")
EMPTY = frozenset({"empty list", "empty tuple", "empty set", "empty array"})
NAMES = Kind(EMPTY, spoiled=True)
WORDS = Kind(EMPTY | NAME.good | {"texts", "array of texts"}, spoiled=True)
ARRAY = Kind(spoiled=True)
ANY_VALUES = Kind(spoiled=True, finite=False)
VECTOR = Kind(frozenset({"three numbers", "range"}), spoiled=True)
COMPLEX = Kind(VECTOR.good | {"imaginary"}, spoiled=True)
UNORDERED = Kind(NOT_NEGATIVE.good | VECTOR.good, spoiled=True)
SERIES = UNORDERED.but(
    falling=[3.0, 2.0, 1.0], repeated=[1.0, 1.0, 2.0], negative=[-3.0, -2.0, -1.0]
)
OBJECT = Kind()
OBJECTS = Kind(EMPTY, spoiled=True)
MAPPING = Kind(frozenset({"empty dict"}), spoiled=True)
FUNCTION = Kind(frozenset({"function", "class"}))
COEFFICIENT = Kind(SIGNED.good | FUNCTION.good | {"table"}).but(
    other_shape=[[1.0, 2.0, 3.0]], nan=[[math.nan]]
)
FILE = Kind(frozenset({"text", "digits", "numpy text", "path"})).but(null_in_path="a\0b")
INTERFACES = NAMES.but(unknown=["nowhere"], number_among=["left", 3])
POSITIVES = Kind(SERIES.good - {"zero", "range"}, spoiled=True).but(negative=[-2.0, -1.0])
