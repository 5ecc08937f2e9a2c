"""Films that conserve mass: their voids remember the motion, in coefficients and in scenes."""

from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest
from void_films import (
    CLEARANCE,
    GRAVITY,
    SKEW,
    SPEED,
    TO_X,
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
    JournalBearing,
    OilFilm,
    StartState,
    grooved_pads,
    linear_model,
    recommended_settings,
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


def test_voids_that_end_in_a_groove_change_nothing():
    """Coefficients do not depend on the whirl where no film begins behind a void."""
    pads = grooved_pads(CLEARANCE, [0.0, np.pi], np.radians(20.0))
    state = replace(oil(), pads=pads).equilibrium(SPEED, [0.0, -525.0])
    assert np.mean(state.solution.empty) > 0.3
    for slow, fast in zip(state.coefficients(0.2), state.coefficients(1.0), strict=True):
        np.testing.assert_allclose(slow, fast, atol=1e-9 * np.abs(fast).max())


def test_oil_is_balanced_over_a_cycle_of_large_motion():
    """What flows in at the groove and out at the ends and edges, against the oil between."""
    film = oil(axial_nodes=3, nodes=48, supply_pressure=2e4)
    count, whirl = 50, 0.5 * SPEED
    step = 2.0 * np.pi / whirl / count
    motion = circle((0.0, -3e-5), 5e-5, whirl)
    _, law = followed(film, motion, step, count)
    grid, axial = film.grid, film.grid.axial
    unit = 12.0 * film.viscosity * film.radius**2

    def content(t, voids):
        h = film._heights(np.array(motion(t)[:2]))[0]
        return unit * grid.step @ (h[:, None] - voids) @ axial.weights

    before = content(count * step, law.voids), 0.0
    out, largest = 0.0, 0.0
    for i in range(count, 2 * count):
        x, y, vx, vy = motion((i + 1) * step)
        law.begin(i * step, *motion(i * step), SPEED, (i + 1) * step)
        if i == count:
            before = content(i * step, law.voids)
        state = law._state(np.array([x, y]), np.array([vx, vy]), SPEED)
        p, void = state.solution.pressure, state.solution.fraction
        _, left, right = state.solution.equation.heights
        first, last = 0, -1
        flow = 0.5 * SPEED * unit * axial.weights
        edge = film.supply_pressure * axial.weights
        through = right[last] * flow @ (1.0 - void[last]) - left[first] * flow.sum()
        through += right[last] ** 3 * (axial.mass @ p[last] - edge.sum()) / grid.step[last]
        through += left[first] ** 3 * (axial.mass @ p[first] - edge.sum()) / grid.step[first]
        ends = (grid.step * state.heights**3) @ p @ axial.stiffness.sum(axis=1)
        out += step * (through + ends)
        largest = max(largest, np.abs(step * ends))
    law.begin(2 * count * step, *motion(2 * count * step), SPEED, 2 * count * step)
    change = content(2 * count * step, law.voids) - before
    assert 0.1 < np.mean(law.voids > 0.0) < 0.9
    assert abs(change + out) < 1e-11 * count * largest


def test_a_flooded_film_is_that_without_voids():
    pads = grooved_pads(CLEARANCE, np.radians(np.arange(0.0, 360.0, 60.0)), 0.1)
    flooded = OilFilm(0.05, 0.05, 0.02, pads, "mass-conserving", 2e7, nodes=36, axial_nodes=2)
    motion = circle((1e-5, -2e-5), 3e-5, 0.5 * SPEED)
    forces, law = followed(flooded, motion, 1e-4, 8)
    assert not law.voids.any()
    full = replace(flooded, cavitation="none")
    x, y, *rate = motion(8e-4)
    np.testing.assert_allclose(forces[-1], full.force([x, y], rate, SPEED), rtol=1e-12)


def test_limit_of_a_rigid_mass_is_that_of_its_exponents():
    state = oil().equilibrium(SPEED, [0.0, -525.0])
    mass = state.critical_mass()
    assert exponent(state, mass, 0.5j * SPEED).real == pytest.approx(0.0, abs=1e-6 * SPEED)
    assert exponent(state, 0.9 * mass, 0.5j * SPEED).real < 0.0


# ------------------------------------------------------------------ scenes


def test_a_moving_journal_is_not_linearised():
    reduced = rotor(eccentric=0.1)
    mbs, body, _ = scene(reduced, bearings(reduced), spin=SPEED)
    with pytest.raises(ValueError, match="leave the unbalance out"):
        linear_model(mbs, body=body).at(SPEED)


def test_small_motion_in_a_scene_decays_as_the_linear_film_says():
    """Exponent of the film's Z(s) with voids by steps; the integrator slows by (sh)²/12."""
    reduced = rotor()
    supports = bearings(reduced)
    mbs, body, (sensor, *_) = scene(reduced, supports, spin=SPEED)
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


@pytest.mark.parametrize(
    ("rotation", "options", "solver"),
    [
        (TO_X, {"initial_speed": SPEED}, "GeneralizedAlpha"),
        (SKEW, {"spin": -SPEED, "translation": "none"}, "GeneralizedAlpha"),
        (None, {"spin": SPEED}, "RK44"),
    ],
    ids=["x, free spin", "skew, backwards", "explicit"],
)
def test_voids_in_a_scene_are_those_of_accepted_steps(rotation, options, solver):
    """Force at the end of a run with repeated steps: that of a journal on the recorded path."""
    turn = np.eye(3) if rotation is None else rotation
    reduced = rotor(eccentric=0.2)
    film = bearings(reduced)[0].film
    gravity = turn @ GRAVITY
    mbs, body, sensor = scene(reduced, bearings(reduced), gravity, rotation=rotation, **options)
    repeated = []

    def shorter(mbs, t):
        step = t - mbs.systemData.GetTime(exu.ConfigurationType.StartOfStep)
        if 2e-3 < t < 3e-3 and step > 1.5e-4:
            repeated.append(t)
            return [1e10, 1e-4]
        return [0.0, -1.0]

    if solver == "GeneralizedAlpha":
        mbs.SetPostNewtonUserFunction(shorter)
    solve(mbs, 0.006, 2e-4, solverType=getattr(exu.DynamicSolverType, solver))
    assert bool(repeated) == (solver == "GeneralizedAlpha")
    free = body.formulation.has_spin
    stored = mbs.GetSensorStoredData(sensor)
    times, place, rate, force = stored[:, 0], *(stored[:, n : n + 2] for n in (1, 4, 7))
    times, kept = np.unique(times, return_index=True)
    speed = options.get("spin", SPEED)
    law = RememberingLaw(film, torque=False)
    for before, now, i, j in zip(times, times[1:], kept, kept[1:], strict=False):
        law.begin(before, *place[i], *rate[i], speed, now)
        expected = law(*place[j], *rate[j], 0.0, speed)
    assert np.linalg.norm(place[-1]) > 1e-6
    assert law.voids.any()
    # the spin of a free rotor falls by 1e-4 of it in this time
    np.testing.assert_allclose(force[-1], expected, rtol=2e-3 if free else 1e-6)


def test_a_run_that_begins_again_forgets():
    reduced = rotor()
    mbs, _, sensor = scene(reduced, bearings(reduced), spin=SPEED)
    ends = []
    for _ in range(2):
        solve(mbs, 2e-3, 2e-4)
        ends.append(mbs.GetSensorStoredData(sensor)[-1, 1:])
    np.testing.assert_array_equal(*ends)


def test_a_run_that_goes_on_keeps_its_voids():
    """Unlike one in a system that is built anew, which has the coordinates alone."""
    reduced = rotor(eccentric=0.05)

    def run(mbs, begin, end):
        settings = recommended_settings(end_time=end, step=1e-4, accuracy=1e-8)
        settings.timeIntegration.startTime = begin
        settings.timeIntegration.numberOfSteps = round((end - begin) / 1e-4)
        settings.solution.file.write = False
        mbs.SolveDynamic(settings, updateInitialValues=True)
        data = mbs.systemData
        return np.array(data.GetODE2Coordinates()), np.array(data.GetODE2Coordinates_t())

    scenes = [scene(reduced, bearings(reduced), spin=SPEED)[:2] for _ in range(3)]
    (whole, _), (in_parts, _), (anew, body) = scenes
    one = run(whole, 0.0, 3e-3)[0][:2]
    state = run(in_parts, 0.0, 2e-3)
    two = run(in_parts, 2e-3, 3e-3)[0][:2]
    body.start_from(StartState(*state, 0.0, SPEED))
    without = run(anew, 2e-3, 3e-3)[0][:2]
    size = np.abs(one).max()
    np.testing.assert_allclose(two, one, atol=1e-5 * size)
    assert np.abs(without - one).max() > 1e-2 * size


def test_refused():
    one = JournalBearing(interface="left", film=oil())
    with pytest.raises(ValueError, match="add_supports gives it to a scene"):
        _ = one.law
    with pytest.raises(ValueError, match="coefficients at speed alone"):
        oil().state([0.0, 0.0], [0.0, 0.0], 0.0).coefficients()
