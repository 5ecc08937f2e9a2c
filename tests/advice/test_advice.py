"""Advice before and after a run, against responses, frequencies and runs computed otherwise."""

import warnings
from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest
from models import centered_disc
from point_rotors import random_rotor
from run_scenes import scene

import exudyn_rotor as er

STIFFNESS, DAMPING = 2e7, 3e4
SUPPORTS = [er.Support(name, STIFFNESS, damping=DAMPING) for name in ("left", "right")]


@pytest.fixture(scope="module")
def solid():
    rotor = centered_disc()
    return rotor.add_point_mass([0.15, 0, 0.215], 0.005)


@pytest.fixture(scope="module")
def reduced(solid):
    return solid.reduce(20, prestress=True)


@pytest.fixture(scope="module")
def plain(solid):
    return solid.reduce(6).without_shapes()


@pytest.fixture(autouse=True)
def _quiet_where_not_asked():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", er.AssumptionWarning)
        yield


# ------------------------------------------------------------------ modes


def _difference(ours, theirs, rows=2):
    """Return the largest relative difference of displacements at any speed or frequency."""
    a, b = (one.motion[..., :rows].reshape(len(one.motion), -1) for one in (ours, theirs))
    return (np.linalg.norm(a - b, axis=1) / np.linalg.norm(b, axis=1)).max()


@pytest.mark.parametrize(("high", "axial"), [(300.0, 0.0), (1500.0, 0.0), (300.0, 1.0)])
def test_proposed_modes_meet_the_accuracy(reduced, high, axial):
    """Unbalance and harmonic responses over the whole range, at points of their own."""
    along = np.diag([1.0, 1.0, axial])
    supports = [er.Support(n, STIFFNESS * along, DAMPING * along) for n in ("left", "right")]
    rows = 3 if axial else 2
    speeds, frequencies = np.linspace(20.0, high, 30), np.linspace(0.0, 2000.0, 41)
    given = {"supports": supports, "accuracy": None}

    def responses(rotor):
        found = [er.unbalance_response(rotor, speeds, **given)]
        for place, force in (("left", [1, 0]), ("right", [0, 1]), ("left", [1, -1j])):
            load = [er.HarmonicForce(place, force)]
            found.append(er.harmonic_response(rotor, frequencies, load, speed=high, **given))
        return found

    whole = responses(reduced)
    for accuracy in (1e-2, 1e-3):
        options = {"load_frequencies": [2000.0], "supports": supports, "accuracy": accuracy}
        proposal = er.propose(reduced, speeds=(0.0, high), **options)
        assert proposal.count < proposal.total
        few = responses(proposal.truncated(reduced))
        errors = [_difference(*pair, rows) for pair in zip(few, whole, strict=True)]
        assert max(errors) < 0.5 * accuracy


# ------------------------------------------------------------------ step


def _steady_orbit(rotor, proposal, stiffness, finer=1):
    """Return the last revolutions of the right journal (s, 3) [m], with weight and unbalance."""
    options = {"markers": "position", "gravity": [0, -9.81, 0], **proposal.options()}
    mbs, body = scene(rotor, stiffness=stiffness, **options)
    sensor = body.add_interface_sensor("right", exu.OutputVariableType.Displacement)
    mbs.Assemble()
    turn = 2 * np.pi / proposal.speeds[1]
    steps = int(np.ceil(turn / proposal.step))
    turns = int(np.ceil(1.0 / turn))
    settings = er.recommended_settings(turns * turn, turn / (steps * finer), accuracy=1e-9)
    settings.timeIntegration.verboseMode, settings.solution.file.write = 0, False
    settings.solution.sensors.writePeriod = turn / steps
    mbs.SolveDynamic(settings)
    return mbs.GetSensorStoredData(sensor)[-2 * steps :, 1:]


@pytest.mark.parametrize(("speed", "accuracy"), [(150.0, 1e-2), (400.0, 1e-2)])
def test_steady_orbit_at_the_proposed_step_meets_the_accuracy(plain, speed, accuracy):
    """Against steps a quarter as long, which err by a 16th; 400 rad/s is near a critical speed."""
    stiffness = [2e6, 4e6, 2e6]
    supports = [er.Support(n, np.diag(stiffness), 500.0 * np.eye(3)) for n in ("left", "right")]
    proposal = er.propose(plain, speeds=speed, supports=supports, accuracy=accuracy)
    exact = _steady_orbit(plain, proposal, stiffness, finer=4)
    size = np.linalg.norm(exact, axis=1).max()
    error = np.linalg.norm(_steady_orbit(plain, proposal, stiffness) - exact, axis=1).max() / size
    assert 0.02 * accuracy < error < 0.75 * accuracy


# ------------------------------------------------------------------ formulation


@pytest.mark.parametrize(
    ("supports", "options", "expected"),
    [
        (SUPPORTS, {"speeds": 100.0}, ("none", 100.0)),
        (SUPPORTS, {"speeds": (50.0, 100.0)}, ("in-plane", "free")),
        ([er.Support("left", 1e7 * np.eye(3))], {"speeds": (0.0, 100.0)}, ("free", "free")),
        ([er.Support("left", 1e7 * np.ones((3, 3)))], {"speeds": (0.0, 9.0)}, ("free", "free")),
        ([], {"speeds": (0.0, 100.0)}, ("in-plane", "free")),
    ],
)
def test_formulation_follows_from_what_is_known(plain, supports, options, expected):
    proposal = er.propose(plain, supports=supports, **options)
    assert (proposal.translation, proposal.spin) == expected


def test_proposal_prints_what_add_rotor_takes(reduced):
    proposal = er.propose(reduced, speeds=300.0, supports=SUPPORTS)
    assert set(proposal.options()) == {"translation", "spin", "stiffening"}
    text = str(proposal)
    assert f"{proposal.count} of 20" in text
    assert all(reason in text for reason in proposal.reasons)
    with pytest.raises(ValueError, match=r"needs 0 ≤ low ≤ high .* got 2.0, 1.0"):
        replace(proposal, speeds=(2.0, 1.0))
    with pytest.raises(ValueError, match="chose from 20"):
        proposal.truncated(proposal.truncated(reduced))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            {"speeds": 1.0, "reduced": random_rotor(1).reduce(0)},
            "reduced: has no interfaces, .* rotor.with_interface",
        ),
        ({"speeds": []}, "speeds: "),
        ({"speeds": -1.0}, "speeds: "),
        ({"speeds": np.nan}, "speeds: "),
        ({"speeds": (2.0, 1.0)}, "speeds: "),
        ({"speeds": 0.0}, "nothing moves"),
        ({"speeds": 1.0, "load_frequencies": [np.inf]}, "load_frequencies: "),
        ({"speeds": 1.0, "load_frequencies": []}, "load_frequencies: "),
        ({"speeds": 1.0, "accuracy": 0.0}, "accuracy: "),
        ({"speeds": 1.0, "supports": [er.Support("middle")]}, "no such interface"),
    ],
)
def test_bad_requests_are_refused(plain, options, message):
    with pytest.raises(ValueError, match=message):
        er.propose(**{"reduced": plain} | options)


@pytest.mark.parametrize("indices", [[20], [-1], [1, 1], [0.5], [[1]], [True], "ab"])
def test_bad_indices_are_refused(reduced, indices):
    with pytest.raises((TypeError, ValueError), match="indices: "):
        er.keep_modes(reduced, indices)


def test_grounded_rotor_has_no_moving_frame(solid):
    held = solid.clamped(["left"]).reduce(5)
    assert er.propose(held, speeds=100.0).translation == "none"
    with pytest.raises(ValueError, match="cannot be free"):
        er.propose(held, speeds=(0.0, 100.0))
