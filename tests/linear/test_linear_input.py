"""Bad input of linear analyses: refused before anything is computed, by the argument's name."""

import re

import exudyn as exu
import numpy as np
import pytest
from point_rotors import ring_rotor

from exudyn_rotor import (
    BaseAcceleration,
    HarmonicForce,
    Support,
    Unbalance,
    campbell,
    permissible_unbalance,
    stability_map,
)

ROTOR = (
    ring_rotor(0.1, 0.2, 3.0).with_interface("left", range(5)).with_interface("right", range(5, 10))
)
MASKED = np.ma.array([1.0, 2.0], mask=[False, True])

FORCE = HarmonicForce("left", (1.0, 0.0))
UNBALANCE = Unbalance("left", 1e-5)


NUMBERS = (np.nan, -1.0, "x", None, [0.1], 1j, True, lambda: 1.0)
WORDS = ("no", 1, None, ["inertial"], {}, np.ones(3))
SERIES = (np.nan, [1.0, np.inf], [2.0, 1.0], "x", [[1.0, 2.0]], MASKED, [1j], {}, None, [])

BAD = {
    "speeds": SERIES,
    "frequencies": SERIES,
    "stiffnesses": (np.nan, [0.0], [-1.0], "x", MASKED, [1j], {}, None, []),
    "supports": ("", "left", 3, ["left"], {"left": 1e6}, None, [None], np.array(3.0), Support),
    "tolerance": (*NUMBERS, 0.0, 0.2, 1e-20),
    "stiffening": WORDS,
    "axes": WORDS,
    "frame": WORDS,
    "method": WORDS,
    "modes": (0, -1, 2.5, "x", True, [1]),
    "order": (np.nan, -1.0, "x", None, [1.0], True),
    "max_speed": (np.nan, -1.0, 0.0, "x", [1.0], True),
    "nodal_diameters": ([5], [-1], [1.0], "x", 1, [], None, {}),
    "own": ("no", 1, None, []),
    "refine": ("no", 1, None, []),
    "allow_negative": ("no", 1, None, []),
    "progress": ("no", 1, None, []),
    "unbalances": (3, "left", None, [3], {"left": 1.0}, FORCE),
    "loads": (3, "left", None, [3], {"left": 1.0}, UNBALANCE),
    "at": (3.5, ["left", 2.5], {}, [(0.0, np.nan, 0.0)], [None], "", [-1]),
    "interfaces": (3, None, [], ["top"], [3], {"left": 1}, ""),
    "speed": (np.nan, "x", None, [1.0], True),
    "low": (np.nan, -1.0, "x", None),
    "high": (np.nan, 0.0, "x", None),
    "samples": (0, 1, 2.5, "x", None, True),
    "label": ("", 3, ["a"], b"a"),
    "accuracy": (np.nan, -1.0, 0.0, 2.0, "x", [0.1], True),
    "body": (3, ROTOR),
    "foundation": (3, "block", ROTOR, np.eye(3)),
    "target": (3, None, "rotor", np.eye(3), UNBALANCE, Support),
}  # fmt: skip

# a function of the parameter may stand for these, and no speed where it is the parameter itself
BAD_FOR_THRESHOLD = {"target": BAD["target"][:-1], "supports": BAD["supports"][:-1]}
BAD_FOR_THRESHOLD["speed"] = tuple(value for value in BAD["speed"] if value is not None)


def _refused(call, given: dict, name: str, values: tuple) -> list[str]:
    """Return what is said, or not said, of values that are not refused by the argument's name."""
    wrong = []
    for value in values:
        try:
            call(**(given | {name: value}))
            wrong.append(f"{value!r}: accepted")
        except (TypeError, ValueError) as error:
            if not re.search(rf"\b{name}\b.* (needs?|is|may be) ", str(error)):
                wrong.append(f"{value!r}: {error}")
        except Exception as error:
            wrong.append(f"{value!r}: {error!r}")
    return wrong


MAKERS = [
    (Support, {"interface": "left", "stiffness": 1.0}, {
        "interface": ("", None, 3, ["left"], {}),
        "stiffness": ("x", np.nan, [1.0, 2.0], 1j, MASKED, None, {}, np.eye(4),
                      ((0.0, 1e5), (-1e5, 0.0)), ([1.0, 0.0], [1.0, 2.0]), ([0.0, 1.0], [1.0]),
                      (1.0, 2.0), ([0.0, 1.0], "ab"), True),
        "tilt_damping": ("x", np.inf, [1.0], None),
        "frame": WORDS,
    }),
    (Unbalance, {"at": "left", "amount": 1.0}, {
        "at": (None, "", -1, 2.5, (0.0, 1.0), {}, MASKED),
        "amount": (*NUMBERS, 0.0),
        "angle": (np.nan, "x", None, [1.0]),
    }),
    (Unbalance.from_grade, {"at": "left", "grade": 2.5, "mass": 1.0, "speed": 10.0}, {
        "grade": (*NUMBERS, 0.0), "mass": (*NUMBERS, 0.0), "speed": (*NUMBERS, 0.0),
        "share": (*NUMBERS, 0.0, 1.5), "angle": (np.nan, "x"), "at": (None, ""),
    }),
    (permissible_unbalance, {"grade": 2.5, "mass": 1.0, "speed": 10.0}, {
        "grade": (*NUMBERS, 0.0), "mass": (*NUMBERS, 0.0), "speed": (*NUMBERS, 0.0),
    }),
    (HarmonicForce, {"at": "left"}, {
        "at": (None, "", -1, 2.5, (0.0, 1.0)),
        "force": ("x", (1.0,), np.nan, (np.nan, 0.0), None, {}, np.eye(3)),
        "moment": ("x", (1.0,), np.nan, (np.nan, 0.0), None),
        "frame": WORDS,
    }),
    (BaseAcceleration, {"acceleration": (1.0, 0.0)}, {
        "acceleration": ("x", (1.0,), np.nan, (np.nan, 0.0), None, {}),
    }),
    (stability_map, {"build": max, "x": [1.0], "y": [1.0]}, {
        "build": (3, None, "x"), "x": SERIES, "y": SERIES, "labels": ("x", (1, 2), None, ["x"]),
        "method": WORDS, "tolerance": (*NUMBERS, 0.0), "progress": ("no",),
    }),
]  # fmt: skip


@pytest.mark.parametrize(
    ("make", "given", "bad"), MAKERS, ids=lambda value: getattr(value, "__name__", "")
)
def test_constructor_refuses(make, given, bad):
    assert [_refused(make, given, name, values) for name, values in bad.items()] == [[]] * len(bad)


def test_tables_and_matrices_are_told_apart():
    """Lists in a tuple are a table, nested lists a matrix, three tuples of three a matrix."""
    table = Support("left", ([0.0, 10.0], [1.0, 3.0]))
    assert table.matrices(5.0)[0][0, 0] == 2.0
    cross = Support("left", [[0.0, 1e5], [-1e5, 0.0]])
    np.testing.assert_array_equal(cross.matrices(5.0)[0][:2, :2], [[0.0, 1e5], [-1e5, 0.0]])
    whole = Support("left", ((1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (7.0, 8.0, 9.0)))
    assert whole.matrices(5.0)[0][1, 2] == 6.0
    with pytest.raises(TypeError, match=r"stiffness at 5 rad/s: needs finite"):
        Support("left", lambda speed: "x").matrices(5.0)


def test_scenes_need_their_body():
    mbs = exu.SystemContainer().AddSystem()
    with pytest.raises(TypeError, match=r"^body: needs RotorBody, got None"):
        campbell(mbs, [1.0])
