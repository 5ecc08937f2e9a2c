"""Films that conserve mass: their voids remember the motion, in coefficients and in scenes."""

from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import LoadForceVector, SensorObject
from point_rotors import ring_rotor
from scipy.spatial.transform import Rotation

from exudyn_rotor import (
    JournalBearing,
    OilFilm,
    add_rotor,
    add_supports,
    bearing_loads,
    grooved_pads,
    linear_model,
    recommended_settings,
    stability,
    steady_state,
)
from exudyn_rotor.bearings.journal_bearing import RememberingLaw

CLEARANCE, SPEED = 1e-4, 580.0
BEHIND = 0.19  # rad: a groove behind the thinnest film, so that the film begins again in the pad
KINDS = exu.OutputVariableType
GRAVITY = np.array([0.0, -9.81, 0.0])


def oil(groove=BEHIND, cavitation="mass-conserving", **options):
    pads = grooved_pads(CLEARANCE, [groove], np.radians(20.0))
    return OilFilm(0.05, 0.05, 0.02, pads, cavitation, **{"nodes": 24, "axial_nodes": 0, **options})


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


def exponent(state, mass, start, step=0.0):
    """Return s of ``det(M s² + Z(s)) = 0`` by Newton's method, voids by steps where there are."""
    u = np.moveaxis(state.film.grid.u, 2, 0)

    def determinant(s):
        void_rate = (1.0 - np.exp(-s * step)) / step if step else s
        Z = state._gradient(-u, -s * u[:, 0], void_rate)
        return np.linalg.det((mass * s**2 * np.eye(2) + Z) / 1e8)

    s = start
    for _ in range(30):
        h = 1e-6 * abs(s)
        s -= determinant(s) * 2.0 * h / (determinant(s + h) - determinant(s - h))
    return s


# ------------------------------------------------------------------ scenes


def rotor(turn=None, eccentric=0.0):
    ring = ring_rotor(0.1, 0.15, 107.0)
    if eccentric:
        ring = ring.add_point_mass([0.1, 0.0, 0.0], eccentric)
    return ring.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(0)


def bearings(reduced, gravity=GRAVITY, **options):
    loads = bearing_loads(reduced, ["left", "right"], gravity)
    film = oil(**options)
    return [
        JournalBearing(interface=name, film=film, load=load)
        for name, load in zip(("left", "right"), loads, strict=True)
    ]


def scene(reduced, supports, gravity=GRAVITY, **options):
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, gravity=gravity, **options)
    added = add_supports(body, supports)
    sensors = [
        mbs.AddSensor(
            SensorObject(
                objectNumber=added[0].objects[0],
                outputVariableType=kind,
                storeInternal=True,
                writeToFile=False,
            )
        )
        for kind in (
            (KINDS.DisplacementLocal, KINDS.VelocityLocal, KINDS.ForceLocal)
            if body.formulation.has_spin
            else (KINDS.Displacement, KINDS.Velocity, KINDS.Force)
        )
    ]
    mbs.Assemble()
    return mbs, body, sensors


def solve(mbs, end_time, step, **options):
    settings = recommended_settings(end_time=end_time, step=step)
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 0.0
    mbs.SolveDynamic(settings, **options)


def test_scene_is_linearised_as_the_list_and_its_equilibrium_is_the_films():
    reduced = rotor(eccentric=0.1)
    supports = bearings(reduced)
    mbs, body, _ = scene(reduced, supports, spin=SPEED)
    models = (
        linear_model(mbs, body=body, about="equilibrium"),
        linear_model(reduced, supports=supports),
    )
    growths = [stability(model, [SPEED]).growth_of("lateral") for model in models]
    np.testing.assert_allclose(*growths, rtol=1e-6)
    with pytest.raises(ValueError, match="leave the unbalance out"):
        linear_model(mbs, body=body).at(SPEED)


def test_small_motion_in_a_scene_decays_as_the_linear_film_says():
    """Exponent of the film's Z(s) with voids by steps; the integrator slows by (sh)²/12."""
    reduced = rotor()
    supports = bearings(reduced)
    mbs, body, (sensor, *_) = scene(reduced, supports, spin=SPEED)
    body.start_from(steady_state(body).state())
    state = supports[0]._state(SPEED, None)

    def kick(mbs, t, load):
        return [0.1 * np.sin(np.pi * t / 5e-3) if t < 5e-3 else 0.0, 0.0, 0.0]

    for name in ("left", "right"):
        mbs.AddLoad(
            LoadForceVector(
                markerNumber=body.marker(name), loadVector=[1, 0, 0], loadVectorUserFunction=kick
            )
        )
    mbs.Assemble()
    step = 2e-4
    solve(mbs, 0.07, step)
    record = mbs.GetSensorStoredData(sensor)
    found = slowest_decay(record[record[:, 0] > 0.02][::5, 1:3], 5 * step)
    s = exponent(state, 53.5, 0.5j * SPEED, step)
    expected = s * (1.0 - (abs(s) * step) ** 2 / 12.0)
    assert found.real == pytest.approx(expected.real, rel=1e-2)
    assert found.imag == pytest.approx(expected.imag, rel=1e-4)


def slowest_decay(motion, step):
    """Return the exponent of the slowest oscillation in samples (n, 2), by the matrix pencil."""
    count = len(motion) // 2
    columns = [[signal[i : i + count] for i in range(len(motion) - count)] for signal in motion.T]
    U = np.linalg.svd(np.hstack([np.array(each).T for each in columns]), full_matrices=False)[0]
    U = U[:, :7]
    s = np.log(np.linalg.eigvals(np.linalg.pinv(U[:-1]) @ U[1:]).astype(complex)) / step
    s = s[s.imag > 50.0]
    return s[np.argmax(s.real)]


SKEW = Rotation.from_euler("XYZ", [0.7, -0.4, 1.1]).as_matrix()
TO_X = Rotation.from_euler("y", 90.0, degrees=True).as_matrix()


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
    mbs, body, sensors = scene(reduced, bearings(reduced), gravity, rotation=rotation, **options)
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
    axes = np.eye(3)[:, :2] if free else body.standing_axes[:, :2]
    place, rate, force = (mbs.GetSensorStoredData(each)[:, 1:4] @ axes for each in sensors)
    times = mbs.GetSensorStoredData(sensors[0])[:, 0]
    times, kept = np.unique(times, return_index=True)
    speed = options.get("spin", SPEED)
    law = RememberingLaw(film, torque=False)
    for before, now, i, j in zip(times, times[1:], kept, kept[1:], strict=False):
        law.begin(before, *place[i], *rate[i], speed, now)
        expected = law(*place[j], *rate[j], 0.0, speed)
    assert np.linalg.norm(place[-1]) > 1e-6
    assert law.voids.any()
    # the spin of a free rotor falls by 1e-4 of it in this time
    np.testing.assert_allclose(force[-1], np.negative(expected), rtol=2e-3 if free else 1e-6)


def test_a_run_that_begins_again_forgets():
    reduced = rotor()
    mbs, _, sensors = scene(reduced, bearings(reduced), spin=SPEED)
    ends = []
    for _ in range(2):
        solve(mbs, 2e-3, 2e-4)
        ends.append(mbs.GetSensorStoredData(sensors[0])[-1, 1:])
    np.testing.assert_array_equal(*ends)


def test_refused():
    one = JournalBearing(interface="left", film=oil())
    with pytest.raises(ValueError, match="add_supports gives it to a scene"):
        _ = one.law
    with pytest.raises(ValueError, match="coefficients at speed alone"):
        oil().state([0.0, 0.0], [0.0, 0.0], 0.0).coefficients()
