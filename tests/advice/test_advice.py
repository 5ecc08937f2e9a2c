"""Advice before and after a run, against responses, frequencies and runs computed otherwise."""

import re
import warnings

import exudyn as exu
import numpy as np
import pytest
from exudyn.rigidBodyUtilities import InertiaCuboid
from models import centered_disc
from point_rotors import ring_rotor
from run_scenes import scene, solve

from exudyn_rotor import (
    AssumptionWarning,
    BaseAcceleration,
    HarmonicForce,
    PrescribedMotion,
    Support,
    add_rotor,
    campbell,
    check_run,
    harmonic_response,
    keep_modes,
    propose,
    recommended_settings,
    unbalance_response,
)

STIFFNESS, DAMPING = 2e7, 3e4
SUPPORTS = [Support(name, STIFFNESS, damping=DAMPING) for name in ("left", "right")]


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
        warnings.simplefilter("ignore", AssumptionWarning)
        yield


# ------------------------------------------------------------------ fewer modes


def test_kept_modes_are_those_of_a_smaller_reduction(solid, reduced):
    small, kept = solid.reduce(4), keep_modes(reduced, range(4))
    assert kept.labels == small.labels
    assert kept.frequencies == pytest.approx(small.frequencies, rel=1e-8)
    speeds = [0.0, 500.0]
    ours, theirs = (
        np.sort(campbell(r, speeds, supports=SUPPORTS).frequencies_rotor) for r in (kept, small)
    )
    assert ours == pytest.approx(theirs, rel=1e-7, abs=1e-3)
    assert kept.shapes.matrix.shape[1] == kept.size == kept.mode_mass.shape[0]


def test_kept_modes_leave_static_fields_whole(reduced):
    rigid = keep_modes(reduced, [])
    assert rigid.labels == reduced.rigid
    assert np.array_equal(rigid.static_stress(100.0), reduced.static_stress(100.0))
    assert keep_modes(reduced, [5, 2]).labels[-1].endswith(reduced.labels[6 + 5].split(" ", 2)[2])


@pytest.mark.parametrize("indices", [[20], [-1], [1, 1], [0.5], [[1]], [True], "ab"])
def test_bad_indices_are_refused(reduced, indices):
    with pytest.raises((TypeError, ValueError), match="indices: "):
        keep_modes(reduced, indices)


# ------------------------------------------------------------------ modes


def _difference(ours, theirs, rows=2):
    """Return the largest relative difference of displacements at any speed or frequency."""
    a, b = (one.motion[..., :rows].reshape(len(one.motion), -1) for one in (ours, theirs))
    return (np.linalg.norm(a - b, axis=1) / np.linalg.norm(b, axis=1)).max()


@pytest.mark.parametrize(("high", "axial"), [(300.0, 0.0), (1500.0, 0.0), (300.0, 1.0)])
def test_proposed_modes_meet_the_accuracy(reduced, high, axial):
    """Unbalance and harmonic responses over the whole range, at points of their own."""
    along = np.diag([1.0, 1.0, axial])
    supports = [Support(n, STIFFNESS * along, DAMPING * along) for n in ("left", "right")]
    rows = 3 if axial else 2
    speeds, frequencies = np.linspace(20.0, high, 30), np.linspace(0.0, 2000.0, 41)
    given = {"supports": supports, "accuracy": None}

    def responses(rotor):
        found = [unbalance_response(rotor, speeds, **given)]
        for place, force in (("left", [1, 0]), ("right", [0, 1]), ("left", [1, -1j])):
            load = [HarmonicForce(place, force)]
            found.append(harmonic_response(rotor, frequencies, load, speed=high, **given))
        return found

    whole = responses(reduced)
    for accuracy in (1e-2, 1e-3):
        options = {"load_frequencies": [2000.0], "supports": supports, "accuracy": accuracy}
        proposal = propose(reduced, speeds=(0.0, high), **options)
        assert proposal.count < proposal.total
        few = responses(proposal.truncated(reduced))
        errors = [_difference(*pair, rows) for pair in zip(few, whole, strict=True)]
        assert max(errors) < 0.5 * accuracy


def test_one_mode_less_misses_the_accuracy(reduced):
    """Leaving out any more of the modes, with its twin in the other plane, is too much."""
    accuracy = 1e-3
    proposal = propose(reduced, speeds=300.0, supports=SUPPORTS, accuracy=accuracy)
    hertz = reduced.frequencies[6:]
    whole = _all_responses(reduced)
    for mode in proposal.modes:
        twins = np.abs(hertz / hertz[mode] - 1.0) < 0.01
        part = _all_responses(keep_modes(reduced, [m for m in proposal.modes if not twins[m]]))
        errors = [_difference(*pair) for pair in zip(part, whole, strict=True)]
        assert max(errors) > 0.3 * 0.5 * accuracy, mode


def _all_responses(rotor):
    options = {"supports": SUPPORTS}
    frequencies = np.linspace(0.0, 600.0, 5)
    loads = [HarmonicForce(n, [1, 0]) for n in ("left", "right")]
    loads.append(BaseAcceleration([1, 0]))
    made = [harmonic_response(rotor, frequencies, [f], speed=300.0, **options) for f in loads]
    return [*made, unbalance_response(rotor, [300.0], **options)]


def test_modes_in_the_band_stay(reduced):
    """The fifth mode bends the disc alone: no interface feels it, but a load may meet it."""
    fifth = reduced.frequencies[6 + 4]
    options = {"speeds": 100.0, "supports": SUPPORTS, "accuracy": 1e-2}
    assert 4 not in propose(reduced, load_frequencies=0.9 * fifth - 100.0, **options).modes
    assert 4 in propose(reduced, load_frequencies=fifth - 99.0, **options).modes


def test_stiffer_supports_need_more_modes(reduced):
    soft, stiff = (
        propose(reduced, speeds=100.0, supports=[Support(n, k) for n in ("left", "right")])
        for k in (1e4, 1e9)
    )
    assert soft.count < stiff.count


def test_share_of_flexibility_is_that_of_the_modes(reduced):
    """Without supports and spin the error is that of ``Σ φ φᵀ/ω²``."""
    proposal = propose(reduced, speeds=0.0, load_frequencies=1e-3, axial=False, accuracy=2e-2)
    rows = np.vstack([reduced.interfaces[n].motion[:2, 6:] for n in ("left", "right")])
    squares = reduced.frequencies[6:] ** 2
    left_out = np.setdiff1d(np.arange(20), proposal.modes)
    whole = rows / squares @ rows.T
    missing = (rows[:, left_out] / squares[left_out]) @ rows[:, left_out].T
    share = np.linalg.norm(missing, axis=0) / np.linalg.norm(whole, axis=0)
    assert proposal.error == pytest.approx(share.max(), rel=1e-6)


def test_scene_gives_the_proposal_of_its_supports(plain):
    mbs, body = scene(plain, "none", spin=300.0)
    mbs.Assemble()
    from_scene = propose(mbs, body=body, speeds=300.0, accuracy=1e-2)
    supports = [Support(n, 2e6 * np.eye(3), 500.0 * np.eye(3)) for n in ("left", "right")]
    alone = propose(plain, speeds=300.0, supports=supports, accuracy=1e-2)
    assert from_scene.modes == alone.modes
    assert from_scene.error == pytest.approx(alone.error, rel=1e-3)
    assert from_scene.options() == alone.options()
    assert from_scene.truncated(plain).size == 6 + alone.count


def test_modes_of_a_scene_with_a_foundation_meet_the_accuracy(solid):
    """A foundation stands still in space, so it couples harmonics of the speed."""
    model = solid.reduce(10).without_shapes()
    mbs, body = _on_foundation(model)
    proposal = propose(mbs, body=body, speeds=300.0, accuracy=1e-2, axial=False)
    assert proposal.count < proposal.total
    responses = []
    for rotor in (proposal.truncated(model), model):
        mbs, body = _on_foundation(rotor)
        load = HarmonicForce("left", [1, 0])
        responses.append(harmonic_response(mbs, [50.0, 250.0], load, speed=300.0, body=body))
    assert _difference(*responses) < 0.5e-2


def _on_foundation(rotor):
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor, translation="none", spin=300.0)
    block = InertiaCuboid(density=2500.0, sideLengths=[0.4, 0.3, 0.4])
    base = mbs.CreateRigidBody(inertia=block, referencePosition=[0, -0.2, 0.25])
    ground = mbs.CreateGround()
    options = {"stiffness": [1e7, 2e7, 1e7], "damping": [3e3] * 3}
    for x, z in ((-0.1, 0.0), (0.1, 0.0), (-0.1, 0.5), (0.1, 0.5)):
        places = {"localPosition0": [x, -0.25, z], "localPosition1": [x, -0.05, z - 0.25]}
        mbs.CreateCartesianSpringDamper(itemNumbers=[ground, base], **places, **options)
    for name, z in (("left", 0.0), ("right", 0.5)):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[base, body.marker(name)],
            localPosition0=[0, 0.2, z - 0.25],
            stiffness=[2e7] * 3,
            damping=[2e4] * 3,
        )
    mbs.Assemble()
    return mbs, body


# ------------------------------------------------------------------ step


def test_proposed_step_has_the_allowed_period_error(plain):
    """A free mode at the end of the band: its phase after 20 periods, against cos ωt."""
    omega = plain.frequencies[6]
    proposal = propose(plain, speeds=0.0, load_frequencies=omega, accuracy=2e-3)
    mbs = exu.SystemContainer().AddSystem()
    start = np.zeros(plain.size - 1)  # without the spin, which is prescribed
    start[5] = 1e-3
    options = {"modal_coordinates": start, "marker_body": False, "stiffening": "none"}
    body = add_rotor(mbs, plain, translation="none", spin=0.0, **options)
    body.start_recording()
    mbs.Assemble()
    steps = round(20.25 * 2 * np.pi / omega / proposal.step)
    solve(mbs, steps, steps * proposal.step)
    zeta, rate = (part[0][5] for part in (body.recorded().q[-1:], body.recorded().q_t[-1:]))
    turned = omega * steps * proposal.step
    phase = np.arctan2(-rate / omega, zeta)
    slip = (turned - phase + np.pi) % (2 * np.pi) - np.pi
    assert slip / turned == pytest.approx(0.5 * 2e-3, rel=0.02)
    assert check_run(body, accuracy=2e-3)["step"].value == pytest.approx(slip / turned, rel=0.02)


def test_step_follows_the_highest_frequency_in_the_rotor_frame(plain):
    one, two = (
        propose(plain, speeds=s, load_frequencies=f).step
        for s, f in ((100.0, 500.0), (400.0, 800.0))
    )
    assert one / two == pytest.approx(2.0)


def _steady_orbit(rotor, proposal, stiffness, finer=1, translation=None):
    """Return the last revolutions of the right journal (s, 3) [m], with weight and unbalance."""
    options = proposal.options() | ({"translation": translation} if translation else {})
    mbs, body = scene(
        rotor, stiffness=stiffness, markers="position", gravity=[0, -9.81, 0], **options
    )
    sensor = body.add_interface_sensor("right", exu.OutputVariableType.Displacement)
    mbs.Assemble()
    turn = 2 * np.pi / proposal.speeds[1]
    steps = int(np.ceil(turn / proposal.step))
    turns = int(np.ceil(1.0 / turn))
    settings = recommended_settings(turns * turn, turn / (steps * finer), accuracy=1e-9)
    settings.timeIntegration.verboseMode, settings.solution.file.write = 0, False
    settings.solution.sensors.writePeriod = turn / steps
    mbs.SolveDynamic(settings)
    return mbs.GetSensorStoredData(sensor)[-2 * steps :, 1:]


@pytest.mark.parametrize(
    ("speed", "translation", "accuracy"),
    [(150.0, "none", 1e-2), (150.0, "none", 1e-3), (400.0, "free", 1e-2)],
)
def test_steady_orbit_at_the_proposed_step_meets_the_accuracy(plain, speed, translation, accuracy):
    """Against steps a quarter as long, which err by a 16th; 400 rad/s is near a critical speed."""
    stiffness = [2e6, 4e6, 2e6]
    supports = [Support(n, np.diag(stiffness), 500.0 * np.eye(3)) for n in ("left", "right")]
    proposal = propose(plain, speeds=speed, supports=supports, accuracy=accuracy)
    assert proposal.translation == translation
    exact = _steady_orbit(plain, proposal, stiffness, finer=4)
    size = np.linalg.norm(exact, axis=1).max()
    error = np.linalg.norm(_steady_orbit(plain, proposal, stiffness) - exact, axis=1).max() / size
    assert 0.02 * accuracy < error < 0.75 * accuracy
    if translation == "free":
        worse = _steady_orbit(plain, proposal, stiffness, translation="none") - exact
        assert np.linalg.norm(worse, axis=1).max() > 1.3 * error * size


def test_reasons_name_what_asks_for_a_small_step(plain):
    supports = [Support(n, 2e4 * np.eye(3), 500.0 * np.eye(3)) for n in ("left", "right")]
    options = {"supports": supports, "accuracy": 1e-2}
    slow = propose(plain, speeds=1000.0, load_frequencies=30.0, **options)
    assert slow.translation == "free"
    assert "slow motion in space is fast in the rotor frame" in str(slow)
    assert "step: ωh" in str(propose(plain, speeds=150.0, **options))


# ------------------------------------------------------------------ formulation


@pytest.mark.parametrize(
    ("supports", "options", "expected"),
    [
        (SUPPORTS, {"speeds": 100.0}, ("none", 100.0)),
        (SUPPORTS, {"speeds": (50.0, 100.0)}, ("in-plane", "free")),
        (SUPPORTS, {"speeds": (50.0, 100.0), "axial": True}, ("free", "free")),
        ([Support("left", 1e7 * np.eye(3))], {"speeds": (0.0, 100.0)}, ("free", "free")),
        ([Support("left", 1e7 * np.ones((3, 3)))], {"speeds": (0.0, 9.0)}, ("free", "free")),
        (None, {"speeds": (0.0, 100.0)}, ("free", "free")),
    ],
)
def test_formulation_follows_from_what_is_known(plain, supports, options, expected):
    proposal = propose(plain, supports=supports, **options)
    assert (proposal.translation, proposal.spin) == expected


def test_known_angle_is_prescribed(plain):
    run_up = PrescribedMotion.run_up(0.0, 100.0, 1.0)
    assert propose(plain, speeds=(0.0, 100.0), spin=run_up).spin is run_up


@pytest.mark.parametrize("high", [30.0, 300.0, 1000.0])
def test_change_by_the_full_level_is_that_of_the_frequencies(reduced, high):
    """The lateral frequencies of the rotor on its supports, from the Campbell diagram."""
    supports = [Support(name, STIFFNESS) for name in ("left", "right")]
    options = {"supports": supports}
    tilt, full = (
        np.sort(np.abs(campbell(reduced, [high], stiffening=s, **options).frequencies_rotor))[0]
        for s in ("tilt", "full")
    )
    band = (tilt > 1.0) & (tilt < 2 * high)
    shift = np.max(np.abs(full - tilt)[band] / np.maximum(tilt, high)[band], initial=0.0)
    proposal = propose(reduced, speeds=high, **options)
    said = float(re.search(r"beyond 'tilt' frequencies change by (\S+),", str(proposal))[1])
    assert (said > 1e-3) == (shift > 1e-3)
    assert proposal.stiffening == "full"


def test_missing_prestress_is_warned_of(solid):
    plain = solid.reduce(6, prestress=False)
    with pytest.warns(AssumptionWarning, match="prestress=True"):
        proposal = propose(plain, speeds=1000.0, supports=SUPPORTS)
    assert proposal.stiffening == "tilt"


def test_proposal_prints_what_add_rotor_takes(reduced):
    proposal = propose(reduced, speeds=300.0, supports=SUPPORTS)
    assert set(proposal.options()) == {"translation", "spin", "stiffening"}
    text = str(proposal)
    assert f"{proposal.count} of 20" in text
    assert all(reason in text for reason in proposal.reasons)
    with pytest.raises(ValueError, match="chose from 20"):
        proposal.truncated(proposal.truncated(reduced))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"speeds": []}, "speeds: "),
        ({"speeds": -1.0}, "speeds: "),
        ({"speeds": np.nan}, "speeds: "),
        ({"speeds": (2.0, 1.0)}, "speeds: "),
        ({"speeds": 0.0}, "nothing moves"),
        ({"speeds": 1.0, "load_frequencies": [np.inf]}, "load_frequencies: "),
        ({"speeds": 1.0, "load_frequencies": []}, "load_frequencies: "),
        ({"speeds": 1.0, "accuracy": 0.0}, "accuracy: "),
        ({"speeds": 1.0, "tilt": -0.1}, "tilt: "),
        ({"speeds": 1.0, "interfaces": ["middle"]}, "'left', 'right'"),
        ({"speeds": 1.0, "interfaces": []}, "left, right"),
        ({"speeds": 1.0, "supports": [Support("middle")]}, "no such interface"),
        ({"speeds": 1.0, "spin": PrescribedMotion.run_up(0.0, 1.0, 1.0)}, "leave spin out"),
    ],
)
def test_bad_requests_are_refused(plain, options, message):
    with pytest.raises(ValueError, match=message):
        propose(plain, **options)


def test_grounded_rotor_has_no_moving_frame(solid):
    held = solid.clamped(["left"]).reduce(5)
    assert propose(held, speeds=100.0).translation == "none"
    with pytest.raises(ValueError, match="cannot be free"):
        propose(held, speeds=(0.0, 100.0))


def test_other_targets_are_refused(plain, solid):
    with pytest.raises(TypeError, match=r"speeds: .* got 'fast'"):
        propose(plain, speeds="fast")
    with pytest.raises(TypeError, match="target: needs ReducedRotor"):
        propose(solid, speeds=1.0)
    with pytest.raises(TypeError, match="body: needs RotorBody, got None"):
        propose(exu.SystemContainer().AddSystem(), speeds=1.0)
    with pytest.raises(ValueError, match="no interfaces"):
        propose(ring_rotor(0.1, 0.1, 2.0).reduce(0), speeds=1.0)
