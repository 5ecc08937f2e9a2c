"""Bad input of the calls that scripts use most: at once, with the name and what to give."""

import exudyn as exu
import numpy as np
import pytest
from models import STEEL, block_beam

from exudyn_rotor import (
    SolidRotor,
    Support,
    add_rotor,
    check_run,
    checks,
    propose,
    recommended_settings,
    report,
    stability_threshold,
)
from exudyn_rotor.linear.modal.excitation import checked_orders
from exudyn_rotor.theory.stiffening import Stiffening


@pytest.fixture(scope="module")
def solid():
    return SolidRotor.from_ngsolve(block_beam(0.1), STEEL, "z", order=1)


@pytest.fixture(scope="module")
def reduced(solid):
    return solid.reduce(2)


@pytest.fixture(scope="module")
def body(reduced):
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, spin=10.0, translation="none")
    mbs.Assemble()
    return body


PROPOSALS = [
    ({"accuracy": [1e-3, 1e-2]}, TypeError, "accuracy: needs a finite number > 0 and < 1"),
    ({"accuracy": -1}, ValueError, "accuracy: .* got -1"),
    ({"accuracy": "a"}, TypeError, "accuracy: .* got 'a'"),
    ({"interfaces": 3}, TypeError, "interfaces: needs names .*, got 3"),
    ({"interfaces": [3]}, TypeError, r"interfaces: needs a name \(text\), got 3"),
    ({"interfaces": ["top"]}, ValueError, "interfaces: 'top' .* 'left', 'right'"),
    (
        {"supports": {"left": 1e6}},
        TypeError,
        "supports: needs a Support or Bearing or MagneticBearing or a",
    ),
    (
        {"supports": 3},
        TypeError,
        "supports: needs a Support or Bearing or MagneticBearing or a sequence of them, got 3",
    ),
    (
        {"supports": [3]},
        TypeError,
        r"supports\[0\]: needs Support or Bearing or MagneticBearing, got 3",
    ),
    ({"axial": "no"}, TypeError, "axial: needs True or False, got 'no'"),
    ({"speeds": 1e20}, ValueError, r"speeds: .* below 1e\+15 \[rad/s\], got 1e\+20"),
    ({"speeds": True}, TypeError, "speeds: .* got True"),
    ({"speeds": np.nan}, ValueError, "speeds: .* got nan"),
    ({"tilt": [0.1, 0.2]}, TypeError, "tilt: needs a finite number > 0 and < 1"),
    ({"spin": 3, "speeds": (0.0, 9.0)}, TypeError, "spin: needs PrescribedMotion, got 3"),
]


@pytest.mark.parametrize(("options", "kind", "message"), PROPOSALS)
def test_propose_refuses(reduced, options, kind, message):
    given = {"speeds": 100.0, "supports": [Support("left", 1e6), Support("right", 1e6)]}
    with pytest.raises(kind, match=message):
        propose(reduced, **(given | options))


CHECKS = [
    ({"limits": [1.0]}, TypeError, "limits: needs a dictionary of name to limit"),
    ({"limits": {"tilt": "a"}}, TypeError, "limits: 'tilt': needs a finite number ≥ 0, got 'a'"),
    (
        {"limits": {"tilt": np.nan}},
        ValueError,
        "limits: 'tilt': needs a finite number ≥ 0, got nan",
    ),
    ({"limits": {"tilt": -1.0}}, ValueError, "limits: 'tilt': needs a finite number ≥ 0, got -1.0"),
    (
        {"limits": {"wobble": 1.0}},
        ValueError,
        "limits: 'wobble' is unknown; there are: 'finite', 'tilt'",
    ),
    ({"accuracy": 0.0}, ValueError, "accuracy: needs a finite number > 0 and < 1"),
    ({"accuracy": [0.1, 0.2]}, TypeError, "accuracy: needs a finite number > 0 and < 1"),
]


@pytest.mark.parametrize(("options", "kind", "message"), CHECKS)
def test_check_run_refuses(body, options, kind, message):
    with pytest.raises(kind, match=message):
        check_run(body, **options)


def test_check_run_refuses_other_objects(body, reduced):
    with pytest.raises(TypeError, match="body: needs RotorBody"):
        check_run(reduced)
    with pytest.raises(TypeError, match="reduced: needs ReducedRotor"):
        check_run(body, reduced=body)
    with pytest.raises(TypeError, match="proposal: needs Proposal"):
        check_run(body, proposal=reduced)
    with pytest.raises(KeyError, match="there are: tilt"):
        check_run(body)["wobble"]
    early = add_rotor(exu.SystemContainer().AddSystem(), reduced, spin=1.0)
    with pytest.raises(ValueError, match=r"call mbs\.Assemble\(\) first"):
        check_run(early)


def test_check_run_refuses_another_rotor(solid, body):
    check_run(body, reduced=solid.reduce(3), warn=False)
    other = solid.add_point_mass([0, 0, 0.1], 0.1).reduce(2)
    with pytest.raises(ValueError, match=r"reduced: .* is another rotor than the body's"):
        check_run(body, reduced=other)


SETTINGS = [
    (("1", 1e-3), {}, TypeError, "end_time: needs a finite number .* got '1'"),
    ((1.0, 0.0), {}, ValueError, r"step: needs a finite number \[s\] > 0"),
    ((1.0, 1e-3), {"settings": 3}, TypeError, "settings: needs SimulationSettings, got 3"),
]


@pytest.mark.parametrize(("given", "options", "kind", "message"), SETTINGS)
def test_recommended_settings_refuses(given, options, kind, message):
    with pytest.raises(kind, match=message):
        recommended_settings(*given, **options)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: checked_orders([]), "orders: needs positive numbers"),
        (lambda: Stiffening(np.zeros((2, 2)), None), "B: needs"),
        (lambda: report("a.html", ""), "contents: is empty text"),
        (lambda: checks.array(np.zeros(0), "onset", dtype=bool), "onset: needs"),
        (
            lambda: stability_threshold(lambda value: None, 0.0, 1.0),
            "speed: needs the spin speed .* since target: a function",
        ),
    ],
)
def test_nothing_where_something_belongs_is_refused_by_name(call, message):
    with pytest.raises((TypeError, ValueError), match=message):
        call()
