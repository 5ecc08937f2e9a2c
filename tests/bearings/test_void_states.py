"""What voids remember, as a few states of linear analyses: against the film, and against runs."""

import numpy as np
import pytest
from apart import apart, exponents
from void_films import (
    BEHIND,
    GRAVITY,
    SKEW,
    SPEED,
    TO_X,
    bearings,
    exponent,
    oil,
    rotor,
    scene,
)

from exudyn_rotor import (
    BaseAcceleration,
    BaseRecord,
    Foundation,
    HarmonicForce,
    Mount,
    Support,
    Unbalance,
    base_response,
    harmonic_response,
    linear_model,
    stability,
    stability_threshold,
    unbalance_response,
    unstable_ranges,
)
from exudyn_rotor.bearings.film import void_states

LOAD = np.array([0.0, -525.0])
IN_PAD, TO_GROOVE = [1.2, 1.2 + np.pi], [0.0, np.pi]  # where voids end, of two grooves
CORNERS = [[x, -0.3, z] for x in (-0.2, 0.2) for z in (-0.4, 0.4)]
POINTS = {"left": [0.0, 0.0, -0.15], "right": [0.0, 0.0, 0.15]}


def impedance(states, s):
    """Return Z(s) of states, their coordinates eliminated."""
    inertia = np.diag([0.0, 0.0, *np.ones(len(states.damping) - 2)])
    X = states.stiffness + s * states.damping + s**2 * inertia
    return X[:2, :2] - X[:2, 2:] @ np.linalg.solve(X[2:, 2:], X[2:, :2])


def impedance_of_film(state, s):
    """Return Z(s) of all voids."""
    u = np.moveaxis(state.film.grid.u, 2, 0)
    return state._gradient(-u, -s * u[:, 0], s)


def off(found, expected):
    """Return the largest share by which matrices differ."""
    return np.linalg.norm(found - expected, 2) / np.linalg.norm(expected, 2)


# ------------------------------------------------------------------ the film alone


@pytest.mark.parametrize(
    ("options", "load", "speed"),
    [
        ({"nodes": 120}, 1.0, SPEED),
        ({"nodes": 120}, 0.02, -0.1 * SPEED),
        ({"nodes": 400}, 15.0, SPEED),
        ({"nodes": 48, "axial_nodes": 4}, 1.0, SPEED),
        ({"groove": IN_PAD}, 0.2, -SPEED),
        ({"groove": IN_PAD, "preload": 0.1}, 1.0, 10.0 * SPEED),
        ({"groove": TO_GROOVE, "preload": 0.5}, 10.0, SPEED),
        ({"supply_pressure": 6e5}, 0.2, SPEED),  # an odd number of states
    ],
)
def test_states_have_the_force_of_the_film(options, load, speed):
    """At whirls beside those that they are made from, to about `error`; and for fast motion."""
    state = oil(**options).equilibrium(speed, load * LOAD)
    states = state.void_states
    assert states.error < 2e-3
    for ratio in (0.03, 0.4, 0.55, 1.0, 1.9):
        stiffness, damping = state.coefficients(ratio)
        whirl = 1j * ratio * abs(speed)
        assert off(impedance(states, whirl), stiffness + whirl * damping) < 1.5 * states.error
    assert off(states.damping[:2, :2], state.coefficients(1e5)[1]) < 1e-4


def test_states_decay_and_those_that_are_not_needed_do_nothing():
    for groove in (BEHIND, TO_GROOVE):
        states = oil(groove).equilibrium(SPEED, LOAD).void_states
        own, rate = states.stiffness[2:, 2:], states.damping[2:, 2:]
        zero, one = np.zeros_like(own), np.eye(len(own))
        poles = np.linalg.eigvals(np.block([[zero, one], [-own, -rate]]))
        assert poles.real.max() < -0.2 * SPEED
    assert not states.stiffness[2:, :2].any()
    assert not states.damping[:2, 2:].any()


def test_states_that_do_not_tell_the_force_are_refused(monkeypatch):
    monkeypatch.setattr(void_states, "MOST_ERROR", 1e-7)
    with pytest.raises(ArithmeticError, match="do not tell what its voids remember"):
        _ = oil(nodes=120).equilibrium(SPEED, LOAD).void_states


# ------------------------------------------------------------------ rotors


@pytest.mark.parametrize("nodes", [24, 120])
def test_exponents_are_those_of_the_film(nodes):
    """Roots of ``det(M s² + Z(s))`` with the film's own Z, for each half of a rigid rotor.

    With 120 nodes a motion near the spin speed grows, which no fixed ratio of the whirl shows.
    """
    reduced = rotor()
    supports = bearings(reduced, nodes=nodes)
    found = stability(reduced, [SPEED], supports=supports, accuracy=None)
    state = supports[0]._state(SPEED, None)
    motions = found.exponents[0].real + 1j * found.frequencies_inertial[0]
    for start in (-3.0 + 289.0j, (-100.0 if nodes == 24 else 20.0) + 612.0j):
        s = exponent(state, 0.5 * reduced.invariants.mass, start)
        error = off(impedance(state.void_states, s), impedance_of_film(state, s))
        assert error < 1e-3
        assert np.abs(motions - s).min() < (error + 1e-7) * abs(s)
    assert found.stable[0] == (nodes == 24)


def fixed(supports, ratio):
    """Return supports with the coefficients of one whirl."""
    return [
        Support(one.interface, *one._state(SPEED, None).coefficients(ratio)) for one in supports
    ]


def test_responses_have_the_coefficients_of_their_frequency():
    """To the error of Z times the condition of the dynamic stiffness, near a resonance."""
    reduced, load = rotor(), Unbalance("left", 1e-4)
    supports = bearings(reduced)
    found, expected = (
        unbalance_response(reduced, [SPEED], load, supports=each, accuracy=None).motion
        for each in (supports, fixed(supports, 1.0))
    )
    assert np.abs(found - expected).max() < 1e-4 * np.abs(expected).max()
    options = {"loads": HarmonicForce("left", [1.0, 0.5, 0.0]), "speed": SPEED, "accuracy": None}
    found, expected = (
        harmonic_response(reduced, [0.4 * SPEED], supports=each, **options).motion
        for each in (supports, fixed(supports, 0.4))
    )
    assert np.abs(found - expected).max() < 1e-4 * np.abs(expected).max()


def test_scenes_without_damping_have_the_coefficients_of_unbalance():
    reduced = rotor()
    supports = bearings(reduced)
    _, body, _ = scene(reduced, supports, spin=SPEED)
    in_scene = linear_model(body.mbs, body=body, about="equilibrium").undamped()
    in_list = linear_model(reduced, supports=fixed(supports, 1.0)).undamped()
    first, second = (exponents(each, SPEED) for each in (in_list, in_scene))
    for s in first[np.abs(first.imag) > 1.0]:
        assert np.abs(second - s).min() < 1e-6 * SPEED


def test_a_limit_of_stability_is_that_of_the_film():
    reduced = rotor()
    supports = bearings(reduced)
    found = stability_threshold(reduced, 640.0, 656.0, supports=supports, samples=3, accuracy=None)
    state = supports[0]._state(found.values[0], None)
    s = exponent(state, 0.5 * reduced.invariants.mass, 0.5j * found.values[0])
    assert abs(s.real) < 1e-5 * abs(s)
    assert s.imag == pytest.approx(found.frequencies_inertial[0], rel=1e-5)


def test_unstable_ranges_begin_at_the_limit_of_the_film():
    supports = bearings(rotor())
    (found,) = unstable_ranges(rotor(), [600.0, 700.0], supports=supports, accuracy=None)
    s = exponent(supports[0]._state(found[0], None), 53.5, 0.5j * found[0])
    assert abs(s.real) < 1e-6 * abs(s)
    assert found[1] == 700.0


def test_ground_that_shakes_on_and_on_has_the_response_in_harmonics():
    """After exp(−16 · 0.7) of the start, with straight lines between samples: (ν h)²/12 = 8e-5."""
    reduced, speed, nu = rotor(), 300.0, 120.0
    time = np.linspace(0.0, 0.8, 3201)
    shaken = BaseRecord(time, np.outer(np.sin(nu * time), [1.0, 0.0, 0.0]))
    given = {"speed": speed, "supports": bearings(reduced)}
    found = base_response(reduced, shaken, **given)
    last = found.time > 0.7
    waves = np.exp(1j * nu * found.time[last])
    fit = np.linalg.lstsq(np.column_stack([waves.real, waves.imag]), found.motion[last, 0, :2])[0]
    load = BaseAcceleration([-1j, 0.0, 0.0])
    expected = harmonic_response(reduced, [nu], loads=load, accuracy=None, **given).motion
    expected = expected[0, 0, 0, :2]
    assert np.abs(fit[0] - 1j * fit[1] - expected).max() < 2e-4 * np.abs(expected).max()


# ------------------------------------------------------------------ scenes

BLOCK = Foundation.rigid(
    80.0, [4.0, 5.0, 1.0], [0.0, -0.2, 0.0], [Mount(c, 4e6, 2e3) for c in CORNERS], POINTS
)
CASES = {
    "in the pad, skew": ({"groove": IN_PAD}, {"rotation": SKEW}),
    "to the groove": ({"groove": TO_GROOVE}, {}),
    "elliptical, x": ({"groove": IN_PAD, "preload": 0.1}, {"rotation": TO_X}),
    "light": ({}, {"load": 0.2}),
    "heavy, finite length": ({"nodes": 36, "axial_nodes": 3}, {"load": 6.0}),
    "foundation": ({}, {"foundation": BLOCK}),
}


def given(name, eccentric=0.0):
    """Return a rotor, its bearings, a foundation or None, and what its scene needs beside."""
    film, options = CASES[name]
    options = {"spin": SPEED} | options
    gravity = options.pop("load", 1.0) * GRAVITY
    reduced = rotor(eccentric)
    supports = bearings(reduced, gravity=gravity, **film)
    turn = np.eye(3) if options.get("rotation") is None else options["rotation"]
    return reduced, supports, options | {"gravity": turn @ gravity}


@pytest.mark.parametrize("name", ["in the pad, skew", "light", "foundation"])
@pytest.mark.parametrize("eccentric", [0.0, 0.1])
def test_scenes_are_linearised_as_lists(name, eccentric):
    """To what differences in a scene leave: rounding of 1e-11 times the condition."""
    reduced, supports, options = given(name, eccentric)
    foundation = options.get("foundation")
    mbs, body, _ = scene(reduced, supports, **options)
    models = (
        linear_model(reduced, supports=supports, foundation=foundation),
        linear_model(mbs, body=body, about="equilibrium"),
    )
    assert apart(*models[::-1], SPEED) < 1e-6
