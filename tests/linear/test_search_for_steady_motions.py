"""The search for steady motions: steps that contacts make too long, and where it ends."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import ring_rotor

from exudyn_rotor import (
    ClearanceStop,
    JournalBearing,
    OilFilm,
    RollingBearing,
    Support,
    add_rotor,
    add_supports,
    grooved_pads,
    steady_state,
)
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene import steady_motion
from exudyn_rotor.linear.model.scene.differences import differences
from exudyn_rotor.linear.model.scene.probe import linearised, probing, unbalanced

MASS, RADIUS, ARM, SPEED, HEAVY = 10.0, 0.1, 0.15, 200.0, 1e-3
STIFFNESS, DAMPING, ENDS = 1e5, 200.0, ("left", "right")


def scene(supports, gravity, translation="none"):
    """Return a rotor with an unbalance of HEAVY at RADIUS beside either bearing."""
    rotor = ring_rotor(RADIUS, ARM, MASS)
    for z in (-ARM, ARM):
        rotor = rotor.add_point_mass([RADIUS, 0.0, z], HEAVY)
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10))
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor.reduce(0), spin=SPEED, translation=translation, gravity=gravity)
    add_supports(
        body, [*supports, Support("left", np.diag([0.0, 0.0, 1e7]), np.diag([0.0, 0.0, 1e3]))]
    )
    mbs.Assemble()
    return body


def stop(name):
    return ClearanceStop(interface=name, radius=0.03, clearance=2e-5, stiffness=1e7, friction=0.1)


def spring(name):
    return Support(name, STIFFNESS * np.diag([1.0, 1.0, 0.0]), DAMPING * np.diag([1.0, 1.0, 0.0]))


def upright():
    return scene([made(name) for name in ENDS for made in (stop, spring)], [0.0, 0.0, -9.81])


def test_rotor_whirls_along_its_stops_with_few_linearisations(monkeypatch):
    """Newton's law of half the rotor, seen from axes that turn with it.

    Above its critical speed it lets go of the stop, and Newton's steps throw it back and forth:
    where all that shortened them was linearised, they took the 40 iterations of the search.
    """
    angles = []

    def counted(probe, theta, *motion):
        angles.append(theta)
        return linearised(probe, theta, *motion)

    monkeypatch.setattr(steady_motion, "linearised", counted)
    steady = steady_state(upright())
    place = steady.interface_motion("left", 0.0)[:2]
    rate = SPEED * np.array([-place[1], place[0]])
    force = stop("left").force(place, rate, SPEED) - STIFFNESS * place - DAMPING * rate
    unbalance = HEAVY * RADIUS * SPEED**2
    left = force + (0.5 * MASS + HEAVY) * SPEED**2 * place + [unbalance, 0.0]
    # to 1e-4 of the motion against the stop's stiffness
    assert np.abs(left).max() < 1e-4 * 1e7 * 2e-5
    assert np.linalg.norm(place) > 2e-5
    assert len(angles) < 12 * 40


def test_search_ends_where_the_steps_that_are_left_lead_nowhere(monkeypatch):
    """After n steps in vain of 12 the others reach 2^-n/4 (2^(12-n) - 1): below 1 from n = 5 on.

    Of 5 steps with more angles they do from n = 2 on. Before them is the search from the start.
    """
    goals = []

    def fails(search, Y, wanted, most):
        goals.append(search.samples)
        raise UnconvergedError("in vain")

    monkeypatch.setattr(steady_motion._Search, "_newton", fails)
    with pytest.raises(UnconvergedError, match="no steady motion found"):
        steady_state(upright())
    assert goals == [12] * (1 + 5) + [48] * 2


def test_forces_alone_leave_what_linearised_ones_do():
    """With balls of clearance and weight, at a motion that is none of the steady ones."""
    balls = [
        RollingBearing(
            interface=name,
            count=8,
            pitch_radius=0.0326,
            element_radius=0.006,
            stiffness=7e9,
            clearance=5e-6,
            damping=10.0,
        )
        for name in ENDS
    ]
    body = scene(balls, [0.0, -9.81, -1.0])
    steady = steady_state(body)
    motion = [1.3 * steady.harmonics.sum(axis=0).real, *np.full((2, steady.scene.size), 1e-3)]
    with probing(steady.scene, SPEED) as probe:
        first = linearised(probe, 0.4, *motion).residual
        np.testing.assert_array_equal(unbalanced(probe, 0.4, *motion), first)
    assert np.abs(first).max() > 1.0


def test_journal_that_moves_in_a_film_with_voids_is_refused_in_plain_words():
    """Coordinates of the centre of mass are not at rest where the journal's are: so it moves."""

    def film(name):
        pads = grooved_pads(1e-4, [0.3, 3.4], 0.3)
        sizes = {"radius": 0.05, "length": 0.05, "viscosity": 0.005, "nodes": 24, "axial_nodes": 0}
        oil = OilFilm(pads=pads, cavitation="mass-conserving", **sizes)
        return JournalBearing(interface=name, film=oil)

    body = scene(map(film, ENDS), [0.0, -9.81, 0.0], translation="in-plane")
    with pytest.raises(ValueError, match=r"^bearing at 'left': a film with cavitation='mass-cons"):
        steady_state(body)


def test_bent_forces_are_extrapolated():
    """Central differences of a cubic err by h², those of h and 2h by four times as much."""
    slopes, error = differences(lambda x: (x + 0.5) ** 3, 0.1 * np.eye(1))
    assert slopes[0, 0] == pytest.approx(0.1 * 3.0 * 0.5**2, rel=1e-12)
    assert error == pytest.approx(0.1**2 / (3.0 * 0.5**2), rel=0.02)
