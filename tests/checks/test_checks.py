"""Checks of input: what is good passes unchanged, what is bad is told with name and value."""

import copy
import itertools
import math
import pickle
from concurrent.futures import ThreadPoolExecutor
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given
from hypothesis import strategies as st

from exudyn_rotor import checks


class Broken:
    """Raises an error of its own wherever it is looked at."""

    def __repr__(self):
        raise RuntimeError

    def __array__(self, *args, **options):
        raise RuntimeError

    def __iter__(self):
        raise RuntimeError


MASKED = np.ma.masked_equal([1.0, 2.0, 3.0], 2.0)
NO_NUMBERS = [
    *("1", "", b"1", None, True, np.True_, 1j, np.complex128(1), [], [1.0], {}, {1.0}, object()),
    *(int, math, Fraction(1, 2), Decimal(1), np.timedelta64(1), np.datetime64("2020"), Broken()),
    *(np.array([1.0]), np.array(True), np.array("1"), np.void(b"a"), sp.eye_array(1), (1.0,)),
]
NOT_FINITE = [math.nan, math.inf, -math.inf, np.float32("nan"), 10**400, np.longdouble("1e4000")]


@given(st.floats(-1e150, 1e150))
def test_numbers_pass_unchanged(value):
    for given_value in (value, np.float64(value), np.array(value)):
        found = checks.number(given_value, "x")
        assert type(found) is float
        assert found == value


@pytest.mark.parametrize("value", [3, np.int8(3), np.uint64(3), np.float32(3), np.array(3)])
def test_whole_and_short_numbers_pass(value):
    assert checks.number(value, "x") == 3.0


@pytest.mark.parametrize("value", NO_NUMBERS, ids=lambda value: type(value).__name__)
def test_no_number(value):
    with pytest.raises(TypeError, match=r"^speed: needs a finite number \[rad/s\], got "):
        checks.number(value, "speed", "rad/s")


@pytest.mark.parametrize("value", [*NOT_FINITE, np.ma.masked])
def test_not_finite(value):
    with pytest.raises(ValueError, match=r"^speed: needs a finite number, got "):
        checks.number(value, "speed")


def test_size_of_numbers():
    assert checks.number(1e150, "x") == 1e150
    with pytest.raises(ValueError, match=r"^x: needs a number below 1e\+150 in size, got 1e\+151"):
        checks.number(1e151, "x")
    with pytest.raises(ValueError, match=r"^x: needs numbers below 1e\+150 in size"):
        checks.vector([0.0, -1e308, 0.0], "x")


LIMITS = [
    ({"above": 0.0}, [1e-300, 1.0], [0.0, -1.0], "> 0"),
    ({"least": 0.0}, [0.0, 1.0], [-1e-300, -1.0], "≥ 0"),
    ({"below": 2.0}, [1.9, -5.0], [2.0, 3.0], "< 2"),
    ({"most": 2.0}, [2.0, -5.0], [2.1, 3.0], "≤ 2"),
    ({"above": 0.0, "most": 2.0}, [1.0, 2.0], [0.0, 2.5], "> 0 and ≤ 2"),
]


@pytest.mark.parametrize(("limits", "good", "bad", "words"), LIMITS)
def test_limits(limits, good, bad, words):
    for value in good:
        assert checks.number(value, "x", **limits) == value
    for value in bad:
        with pytest.raises(ValueError, match=f"^x: needs a finite number {words}, got "):
            checks.number(value, "x", **limits)


def test_tolerance():
    assert checks.tolerance(1e-9) == 1e-9
    for value in (0.0, 1.0, -1e-9, math.nan):
        with pytest.raises(ValueError, match=r"^tolerance: needs a finite number > 0 and < 1"):
            checks.tolerance(value)


@pytest.mark.parametrize("value", [2, np.int64(2), np.uint8(2), np.array(2)])
def test_counts_pass(value):
    found = checks.count(value, "count", least=1)
    assert type(found) is int
    assert found == 2


@pytest.mark.parametrize("value", [*NO_NUMBERS, 2.0, 1.5, np.float64(2.0), math.nan])
def test_no_count(value):
    with pytest.raises(TypeError, match=r"^modes: needs a whole number ≥ 1 and ≤ 9, got "):
        checks.count(value, "modes", least=1, most=9)


@pytest.mark.parametrize("value", [0, -1, 10, 10**400, 2**63])
def test_counts_outside(value):
    with pytest.raises(ValueError, match=r"^modes: needs a whole number ≥ 1 and ≤ 9, got "):
        checks.count(value, "modes", least=1, most=9)
    with pytest.raises(ValueError, match=r"^modes: needs a whole number ≥ 1"):
        checks.count(-value if value == 10 else value, "modes", least=1)


def test_flags():
    assert checks.flag(np.True_, "stress") is True
    assert checks.flag(False, "stress") is False
    for value in ("no", 0, 1, None, [], np.array([True, False]), Broken()):
        with pytest.raises(TypeError, match=r"^stress: needs True or False, got "):
            checks.flag(value, "stress")


def test_choices():
    assert checks.choice("tilt", "stiffening", ("none", "tilt")) == "tilt"
    with pytest.raises(ValueError, match=r"^level: 'half' is unknown; use one of 'none', 'tilt'"):
        checks.choice("half", "level", ("none", "tilt"))
    for value in (["tilt"], b"tilt", None, 3, Broken()):
        with pytest.raises(TypeError, match=r"^level: needs one of 'none', 'tilt', got "):
            checks.choice(value, "level", ("none", "tilt"))


def test_labels():
    assert checks.labels("left", "names") == ("left",)
    assert checks.labels(np.array(["left", "right"]), "names") == ("left", "right")
    assert checks.labels((name for name in ("a", "b")), "names", ["a", "b", "c"]) == ("a", "b")
    assert checks.labels([], "names", []) == ()
    with pytest.raises(ValueError, match=r"^names: 'b' is unknown; there are: 'a', 'c'"):
        checks.labels(["a", "b"], "names", ["a", "c"])
    with pytest.raises(ValueError, match=r"^names: 'a' is unknown; there are: none"):
        checks.labels("a", "names", ())
    with pytest.raises(ValueError, match=r"^names: needs a name that is not empty, got ' '"):
        checks.labels(["a", " "], "names")
    for value in (3, None, b"left", {"left": 1}, [3], [["left"]], np.array(3), Broken(), str):
        with pytest.raises(TypeError, match=r"^names: needs "):
            checks.labels(value, "names")


GOOD_VECTORS = [
    [1, 2, 3],
    (1.0, 2.0, 3.0),
    range(1, 4),
    np.array([1, 2, 3], dtype=np.int8),
    np.array([1, 2, 3], dtype=np.float32),
    np.array([1 + 0j, 2, 3]),
    np.ma.array([1.0, 2.0, 3.0]),
    np.arange(6.0).reshape(3, 2).T[1] / 2 + 0.5,
    [np.float64(1), np.array(2), 3],
]


@pytest.mark.parametrize("values", GOOD_VECTORS, ids=lambda value: type(value).__name__)
def test_vectors_are_read_only_copies(values):
    found = checks.vector(values, "x")
    assert type(found) is np.ndarray
    assert found.dtype == float
    assert found.tolist() == [1.0, 2.0, 3.0]
    assert not found.flags.writeable
    assert not (isinstance(values, np.ndarray) and np.shares_memory(found, values))
    assert checks.vector(found, "x") is found


@pytest.mark.parametrize(
    "values",
    [
        *("123", b"123", None, {1: 2}, {1.0, 2.0, 3.0}, object(), Broken(), int, math),
        *(["1", "2", "3"], [1, None, 3], [True, False, True], [[1, 2], [3], 4]),
        *(np.array(["1"] * 3), np.array([1, 2, 3], dtype=object), [10**400] * 3),
        *(np.array(["2020"] * 3, "M8[Y]"), np.zeros(3, [("a", float)]), sp.eye_array(3)),
        (value for value in (1.0, 2.0, 3.0)),
    ],
    ids=lambda value: type(value).__name__,
)
def test_no_vector(values):
    with pytest.raises(TypeError, match=r"^x: needs finite numbers \[m\] of shape \(3,\), got "):
        checks.vector(values, "x", "m")


@pytest.mark.parametrize(
    "values",
    [[1, 2], [1, 2, 3, 4], [[1, 2, 3]], [], 3.0, np.zeros((3, 1)), [1, 2, math.nan],
     [1, 2, math.inf], [1j, 2, 3], MASKED, np.array([1, 2, 3j])],
)  # fmt: skip
def test_wrong_vector(values):
    with pytest.raises(ValueError, match=r"^x: needs "):
        checks.vector(values, "x")


def test_arrays_of_other_kinds():
    assert checks.array([1j, 2], "x", dtype=complex).dtype == complex
    assert checks.array([1, 2], "x", dtype=int).dtype.kind == "i"
    assert np.isnan(checks.array([1.0, math.nan], "x", finite=False)[1])
    with pytest.raises(TypeError, match=r"^x: needs whole numbers of an integer type, got"):
        checks.array([1.0, 2.0], "x", dtype=int)
    with pytest.raises(ValueError, match=r"^x: needs whole numbers, got"):
        checks.array([1.5, 2.0], "x", dtype=int)
    with pytest.raises(ValueError, match=r"^nodes: needs whole numbers ≥ 0 and ≤ 9, got 10"):
        checks.whole_numbers([0, 10], "nodes", most=9)
    with pytest.raises(ValueError, match=r"^nodes: needs whole numbers ≥ 0, got -1"):
        checks.whole_numbers([0, -1], "nodes")


def test_matrices():
    dense = checks.matrix(np.eye(3, dtype=int), "mass", shape=(3, 3))
    assert not dense.flags.writeable
    for form in ("coo", "csc", "dia", "lil"):
        given_matrix = sp.eye_array(3, format=form)
        found = checks.matrix(given_matrix, "mass", shape=(3, 3))
        assert found.format == "csr"
        assert not found.data.flags.writeable
    with pytest.raises(ValueError, match=r"^mass: needs .* got a sparse matrix of shape \(3, 3\)"):
        checks.matrix(sp.eye_array(3), "mass", shape=(2, 2))
    with pytest.raises(ValueError, match=r"^mass: its entries: needs finite numbers"):
        checks.matrix(sp.csr_array([[math.nan]]), "mass")
    with pytest.raises(ValueError, match=r"^mass: its entries: needs real numbers"):
        checks.matrix(sp.csr_array([[1j]]), "mass")


def test_a_sparse_matrix_is_copied():
    given_matrix = sp.csr_array(np.eye(3))
    found = checks.matrix(given_matrix, "mass")
    given_matrix.data[:] = 7.0
    assert found.toarray().tolist() == np.eye(3).tolist()


def test_symmetric_matrices():
    skew = np.array([[0.0, 1.0], [-1.0, 0.0]])
    assert checks.symmetric(np.eye(2), "K", size=2).shape == (2, 2)
    assert checks.symmetric(skew, "G", size=2, sign=-1).shape == (2, 2)
    with pytest.raises(ValueError, match=r"^K: needs a symmetric matrix; 2 of 1 is not"):
        checks.symmetric(skew, "K", size=2)
    with pytest.raises(ValueError, match=r"^G: needs a skew-symmetric matrix"):
        checks.symmetric(np.eye(2), "G", size=2, sign=-1)


def test_rotations():
    assert checks.rotation(np.eye(3)).shape == (3, 3)
    for wrong in (-np.eye(3), (1 + 1e-6) * np.eye(3), np.ones((3, 3))):
        with pytest.raises(ValueError, match=r"^rotation: needs a rotation matrix"):
            checks.rotation(wrong)


def test_instances():
    assert checks.instance(3, "x", int) == 3
    assert checks.instances(3, "x", int) == (3,)
    assert checks.instances(iter([1, 2]), "x", int) == (1, 2)
    with pytest.raises(TypeError, match=r"^x: needs int or str, got None; make one$"):
        checks.instance(None, "x", (int, str), "make one")
    with pytest.raises(TypeError, match=r"^x\[1\]: needs int, got 'a'"):
        checks.instances([1, "a"], "x", int)
    for value in ("ab", {1: 2}, 3.0, None, np.array(3), Broken()):
        with pytest.raises(TypeError, match=r"^x: needs a int or a sequence of them, got "):
            checks.instances(value, "x", int)


def test_mappings():
    assert checks.mapping({"left": 1}, "limits") == {"left": 1}
    with pytest.raises(TypeError, match=r"^limits: needs a dictionary of name to number, got"):
        checks.mapping([("left", 1)], "limits", "number")
    for key in (None, 3, ("left",)):
        with pytest.raises(TypeError, match=r"^limits: needs a name \(text\), got "):
            checks.mapping({key: 1}, "limits")
    given_mapping = {"a": 1}
    kept = checks.read_only_mapping(given_mapping)
    given_mapping["a"] = 2
    assert kept["a"] == 1
    with pytest.raises(TypeError):
        kept["a"] = 3
    for again in (pickle.loads(pickle.dumps(kept)), copy.deepcopy(kept)):
        assert again == kept


def test_functions_and_executors():
    assert checks.function(len, "build") is len
    with pytest.raises(TypeError, match=r"^build: needs a function, got 3"):
        checks.function(3, "build")
    assert checks.executor(None) is None
    with ThreadPoolExecutor(1) as pool:
        assert checks.executor(pool) is pool
    for value in (3, ThreadPoolExecutor, map, "threads"):
        with pytest.raises(TypeError, match=r"^executor: needs an executor of concurrent.futures"):
            checks.executor(value)


def test_paths():
    assert checks.path("a.npz") == Path("a.npz")
    assert checks.path(Path("a.npz")) == Path("a.npz")
    for value in (3, None, b"a.npz", ["a"]):
        with pytest.raises(TypeError, match=r"^path: needs the path of a file"):
            checks.path(value)
    for value in ("", "a\0b"):
        with pytest.raises(ValueError, match=r"^path: needs the path of a file"):
            checks.path(value)


def test_ascending():
    assert checks.ascending(3, "speeds").tolist() == [3.0]
    assert checks.ascending((1, 2.5), "speeds").tolist() == [1.0, 2.5]
    for values in ([], [2.0, 1.0], [1.0, 1.0]):
        with pytest.raises(ValueError, match=r"^speeds: needs at least one number, in ascending"):
            checks.ascending(values, "speeds")
    with pytest.raises(TypeError, match=r"^speeds: needs"):
        checks.ascending("12", "speeds")


def test_shown_is_one_short_line():
    for value in ("a" * 1000, "a\nb", list(range(1000)), Broken(), np.zeros((9, 9)), 10**5000):
        text = checks.shown(value)
        assert "\n" not in text
        assert len(text) < 130


def test_values_that_never_end_are_not_listed():
    with pytest.raises(TypeError, match=r"^x: needs"):
        checks.vector(itertools.count(), "x")


def test_a_sparse_matrix_in_any_order_is_put_in_order():
    """A product of sparse matrices has its columns unordered; scipy orders them in place later."""
    square = sp.csr_array(np.triu(np.arange(1.0, 17.0).reshape(4, 4)))
    product = square @ square
    product.indices[:2] = product.indices[1::-1]
    product.data[:2] = product.data[1::-1]
    product.has_sorted_indices = False
    result = checks.matrix(product, "K")
    assert result.has_canonical_format
    np.testing.assert_array_equal(abs(result).toarray(), (square @ square).toarray())
    assert not product.has_sorted_indices  # the caller's is left as it was
