"""Films that conserve mass: their voids remember the motion, in coefficients and in scenes."""

import numpy as np
import pytest
from void_films import (
    CLEARANCE,
    SPEED,
    bearings,
    exponent,
    kick,
    oil,
    oscillations,
    rotor,
    scene,
    solve,
)

from exudyn_rotor import (
    steady_state,
)
from exudyn_rotor.bearings.journal_bearing import RememberingLaw


def circle(place, radius, whirl):
    """Return a motion (x, y, ẋ, ẏ) by time about a place, on a circle."""

    def motion(t):
        c, s = radius * np.cos(whirl * t), radius * np.sin(whirl * t)
        return place[0] + c, place[1] + s, -whirl * s, whirl * c

    return motion


def followed(film, motion, step, count, speed=SPEED):
    """Return the forces (count, 2) on a journal that moves as given, and the law at the end."""
    law, forces = RememberingLaw(film, torque=False), []
    for i in range(count):
        law.begin(i * step, *motion(i * step), speed, (i + 1) * step)
        forces.append(law(*motion((i + 1) * step), 0.0, speed))
    return np.array(forces), law


# ------------------------------------------------------------------ the film alone


@pytest.mark.parametrize("ratio", [0.5, -1.0])
def test_coefficients_are_those_of_small_whirl_in_time(ratio):
    """Steps of implicit Euler, first order in the step, extrapolated to its second."""
    film = oil()
    state = film.equilibrium(SPEED, [0.0, -525.0])
    whirl, radius = ratio * SPEED, 1e-7 * CLEARANCE

    def amplitude(count):
        step, turns = 2.0 * np.pi / abs(whirl) / count, 4
        motion = circle(state.position, radius, whirl)
        force = followed(film, motion, step, turns * count)[0][-count:] - state.force
        angle = whirl * step * (np.arange(count) + 1.0)
        return np.exp(-1j * angle) @ force * 2.0 / count / radius

    coarse, fine = amplitude(60), amplitude(120)
    stiffness, damping = state.coefficients(abs(ratio))
    # x = r e^{iνt}, y = −i x, as the real part of a motion exp(i|ν|t) for either direction
    turn = np.array([1.0, -1j])
    expected = -(stiffness + 1j * whirl * damping) @ turn
    size = np.abs(expected).max()
    assert np.abs(2.0 * fine - coarse - expected).max() < 2e-3 * size
    other = state.coefficients(0.25 * abs(ratio))
    assert np.abs(other[1] - damping).max() > 0.1 * np.abs(damping).max()


# ------------------------------------------------------------------ scenes


def test_small_motion_in_a_scene_decays_as_the_linear_film_says():
    """Exponent of the film's Z(s) with voids by steps; the integrator slows by (sh)²/12."""
    reduced = rotor()
    supports = bearings(reduced)
    mbs, body, sensor = scene(reduced, supports, spin=SPEED)
    body.start_from(steady_state(body).state())
    state = supports[0]._state(SPEED, None)

    kick(body, [0.1, 0.0, 0.0])
    step = 2e-4
    solve(mbs, 0.07, step)
    record = mbs.GetSensorStoredData(sensor)
    found = max(oscillations(record[record[:, 0] > 0.02][::5, 1:3], 5 * step), key=np.real)
    s = exponent(state, 53.5, 0.5j * SPEED, step)
    expected = s * (1.0 - (abs(s) * step) ** 2 / 12.0)
    assert found.real == pytest.approx(expected.real, rel=1e-2)
    assert found.imag == pytest.approx(expected.imag, rel=1e-4)


def test_limit_of_a_rigid_mass_is_that_of_its_exponents():
    state = oil().equilibrium(SPEED, [0.0, -525.0])
    mass = state.critical_mass()
    assert exponent(state, mass, 0.5j * SPEED).real == pytest.approx(0.0, abs=1e-6 * SPEED)
    assert exponent(state, 0.9 * mass, 0.5j * SPEED).real < 0.0
