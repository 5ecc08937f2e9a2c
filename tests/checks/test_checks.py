"""Checks of input: what is good passes unchanged, what is bad is told with name and value."""

import math
from decimal import Decimal

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given
from hypothesis import strategies as st

from exudyn_rotor import checks

SKEW = np.array([[0.0, 1.0], [-1.0, 0.0]])
MASKED = np.ma.masked_equal([1.0, 2.0, 3.0], 2.0)
NO_NUMBERS = [
    *("1", "", b"1", None, True, np.True_, 1j, np.complex128(1), [], [1.0], {}, {1.0}, object()),
    *(int, math, Decimal(1), np.datetime64("2020")),
    *(np.array([1.0]), np.array(True), np.array("1"), np.void(b"a"), sp.eye_array(1), (1.0,)),
]


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_numbers_pass_unchanged(value):
    for given_value in (value, np.float64(value), np.array(value)):
        found = checks.number(given_value, "x")
        assert type(found) is float
        assert found == value


@pytest.mark.parametrize("value", NO_NUMBERS, ids=lambda value: type(value).__name__)
def test_no_number(value):
    with pytest.raises(TypeError, match=r"^speed: needs a finite number \[rad/s\], got "):
        checks.number(value, "speed", "rad/s")


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


@pytest.mark.parametrize(
    "values",
    [
        *("123", b"123", None, {1: 2}, {1.0, 2.0, 3.0}, object(), int, math),
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


def test_matrices():
    dense = checks.matrix(np.eye(3, dtype=int), "mass", shape=(3, 3))
    assert not dense.flags.writeable
    for form in ("coo", "csc", "dia", "lil"):
        given_matrix = sp.eye_array(3, format=form)
        found = checks.matrix(given_matrix, "mass", shape=(3, 3))
        assert found.format == "csr"
        assert not found.data.flags.writeable
    assert checks.symmetric(np.eye(2), "K", size=2).shape == (2, 2)
    assert checks.symmetric(SKEW, "G", size=2, sign=-1).shape == (2, 2)


def test_rotations():
    assert checks.rotation(np.eye(3)).shape == (3, 3)
    for wrong in (-np.eye(3), (1 + 1e-6) * np.eye(3), np.ones((3, 3))):
        with pytest.raises(ValueError, match=r"^rotation: needs a rotation matrix"):
            checks.rotation(wrong)


def test_ascending():
    assert checks.ascending(3, "speeds").tolist() == [3.0]
    assert checks.ascending((1, 2.5), "speeds").tolist() == [1.0, 2.5]
    assert checks.ascending(np.array([1.0 + 0.0j, 2.5]), "speeds").tolist() == [1.0, 2.5]


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: checks.ascending([], "x"), "x: needs at least one number, in ascending order"),
        (lambda: checks.ascending([2.0, 1.0], "x"), "x: needs at least one number, in ascending"),
        (lambda: checks.ascending([1.0, 1.0], "x"), "x: needs at least one number, in ascending"),
        (lambda: checks.ascending("12", "x"), "x: needs "),
        (
            lambda: checks.matrix(sp.eye_array(3), "x", shape=(2, 2)),
            r"a sparse matrix of shape \(3",
        ),
        (
            lambda: checks.matrix(sp.csr_array([[math.nan]]), "x"),
            "x: its entries: needs finite num",
        ),
        (lambda: checks.matrix(sp.csr_array([[1j]]), "x"), "x: its entries: needs real numbers"),
        (lambda: checks.symmetric(SKEW, "x", size=2), "x: needs a symmetric matrix; 2 of 1 is not"),
        (lambda: checks.symmetric(np.eye(2), "x", size=2, sign=-1), "x: needs a skew-symmetric"),
        (lambda: checks.function(3, "x"), "x: needs a function, got 3"),
    ],
)
def test_what_is_refused_is_told(call, words):
    with pytest.raises((TypeError, ValueError, OSError), match=words):
        call()


def test_messages_show_eighty_characters_of_a_value():
    with pytest.raises(TypeError) as refused:
        checks.number("x" * 100, "speed")
    assert str(refused.value).endswith("'" + "x" * 78 + "…")
