"""Films answer by their tangents where Exudyn differentiates connectors by differences."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import ring_rotor
from void_films import CLEARANCE, SPEED, bearings, oil, rotor, scene

from exudyn_rotor import recommended_settings
from exudyn_rotor.bearings.film.reynolds import CAVITATION
from exudyn_rotor.bearings.journal_bearing import FilmLaw, RememberingLaw
from exudyn_rotor.multibody.evaluation import evaluating
from exudyn_rotor.multibody.supports import support_connectors
from exudyn_rotor.multibody.supports.differences import Differences

MOTION = np.array([0.3, -0.4, 0.05, 0.02]) * CLEARANCE * np.array([1.0, 1.0, SPEED, SPEED])
SIZES = CLEARANCE * np.array([1.0, 1.0, SPEED, SPEED])
STEP = 1e-5  # of SIZES: the error of central differences is its square, beside 1e-15/STEP


def differences(function, at, sizes):
    """Return central differences of a function by each of its arguments, in columns."""
    moves = np.diag(STEP * sizes)
    ends = [np.subtract(function(at + move), function(at - move)) for move in moves]
    return np.array(ends).T / (2.0 * STEP * sizes)


def asked_films(monkeypatch):
    """Return a list that grows with every motion for which a film is asked for its force."""
    asked, call = [], FilmLaw.__call__

    def asking(law, *motion):
        asked.append(motion)
        return call(law, *motion)

    monkeypatch.setattr(FilmLaw, "__call__", asking)
    return asked


@pytest.mark.parametrize("cavitation", CAVITATION)
def test_tangent_of_a_film_is_its_derivative(cavitation):
    """Of one that conserves mass within a step, from the voids at its beginning."""
    film = oil(cavitation=cavitation)
    law = FilmLaw(film, torque=False)
    if cavitation == "mass-conserving":
        law = RememberingLaw(film, torque=False)
        law.begin(0.0, *MOTION, SPEED, 1e-4)
        law.begin(1e-4, *(0.9 * MOTION), SPEED, 3e-4)
    law(*MOTION, 0.0, SPEED)
    found = -np.hstack(law.tangent(*MOTION[:2]))
    expected = differences(lambda at: law(*at, 0.0, SPEED), MOTION, SIZES)
    np.testing.assert_allclose(
        found * SIZES, expected * SIZES, rtol=0.0, atol=1e-7 * np.abs(expected * SIZES).max()
    )


@pytest.mark.parametrize("column", range(5))
def test_film_of_the_last_call_is_that_of_the_same_motion_alone(column):
    law = FilmLaw(oil(cavitation="reynolds"), torque=False)
    law(*MOTION, 0.0, SPEED)
    *motion, speed = np.r_[MOTION, SPEED] + 0.1 * np.r_[SIZES, SPEED] * np.eye(5)[column]
    alone = FilmLaw(oil(cavitation="reynolds"), torque=False)(*motion, 0.0, speed)
    np.testing.assert_allclose(law(*motion, 0.0, speed), alone, rtol=1e-9)


def test_film_of_the_last_call_is_that_of_the_same_voids_alone():
    """They grow from step to step where the journal moves off."""
    law, forces, duration = RememberingLaw(oil(), torque=False), [], 2.0**-13
    for step in range(3):
        law.begin(step * duration, *MOTION, SPEED, (step + 1) * duration)
        forces.append(law(*MOTION, 0.0, SPEED))
    assert np.linalg.norm(np.subtract(forces[2], forces[1])) > 1e-3 * np.linalg.norm(forces[1])


def test_tangent_ends_where_the_film_is_too_thin():
    law = FilmLaw(oil(cavitation="reynolds"), torque=False)
    law(0.999 * CLEARANCE, 0.0, 0.0, 0.0, 0.0, SPEED)
    assert law.tangent(0.999 * CLEARANCE, 0.0) is None


def test_jacobian_of_a_scene_with_films(monkeypatch):
    """Exudyn's of all forces against central differences of them; each film is asked once."""
    reduced = rotor()
    mbs, body, _ = scene(reduced, bearings(reduced, cavitation="reynolds"), spin=SPEED)
    asked, data = asked_films(monkeypatch), mbs.systemData
    rest, place = np.array(data.GetODE2Coordinates()), np.eye(data.ODE2Size())[:, :2] @ MOTION[:2]
    rate = np.eye(data.ODE2Size())[:, :2] @ MOTION[2:]
    rate[body.locks.spin] = SPEED
    size = len(rest)
    free = np.delete(np.arange(size), [2, 3, 4, 5])  # the others are held

    def put(q, q_t):
        data.SetODE2Coordinates(rest + q)
        data.SetODE2Coordinates_t(q_t)

    def forces(state):
        q, q_t = place.copy(), rate.copy()
        q[free], q_t[free] = np.split(state, 2)
        put(q, q_t)
        solver.ComputeODE2RHS(mbs)
        return np.array(solver.GetSystemResidual())[free]

    with evaluating(mbs) as solver:
        state = np.r_[place[free], rate[free]]
        ones = np.ones(len(free))
        expected = differences(forces, state, CLEARANCE * np.r_[ones, SPEED * ones])
        forces(state)
        asked.clear()
        found = []
        for factors in ((1.0, 0.0), (0.0, 1.0)):
            solver.SetSystemJacobian(np.zeros((size + solver.GetAEsize(),) * 2))
            solver.ComputeJacobianODE2RHS(mbs, *factors, 0.0)
            found.append(np.array(solver.GetSystemJacobian())[np.ix_(free, free)])
    assert len(asked) == 2 * (2 + 1)  # in each Jacobian, and by the rate of the spin
    scale = np.r_[ones, SPEED * ones]
    np.testing.assert_allclose(
        np.hstack(found) * scale,
        expected * scale,
        rtol=0.0,
        atol=1e-6 * np.abs(expected * scale).max(),
    )


def test_forces_after_a_jacobian_are_those_of_the_film():
    """Far from its place at once, and near it from the next evaluation of all forces on."""
    reduced = rotor()
    mbs, body, _ = scene(reduced, bearings(reduced, cavitation="reynolds"), spin=SPEED)
    data, connector = mbs.systemData, body.supports[0].objects[0]
    law = FilmLaw(body.supports[0].support.film, torque=False)
    rest, rate = (np.array(X) for X in (data.GetODE2Coordinates(), data.GetODE2Coordinates_t()))
    with evaluating(mbs) as solver:
        for ratio, evaluated in ((0.1, False), (0.3, False), (0.3005, True)):
            data.SetODE2Coordinates(rest + ratio * CLEARANCE * np.eye(len(rest))[0])
            data.SetODE2Coordinates_t(rate)
            if evaluated:
                solver.ComputeODE2RHS(mbs)
            found = mbs.GetObjectOutput(connector, exu.OutputVariableType.Force)
            expected = law(ratio * CLEARANCE, 0.0, 0.0, 0.0, 0.0, SPEED)
            np.testing.assert_allclose(-found[:2], expected, rtol=1e-9)
            solver.ComputeJacobianODE2RHS(mbs, 1.0, 0.0, 0.0)


@pytest.mark.parametrize("cavitation", ["reynolds", "mass-conserving"])
@pytest.mark.parametrize("spin", [{"spin": SPEED}, {"initial_speed": SPEED}], ids=["held", "free"])
def test_runs_with_films_take_the_same_steps(monkeypatch, cavitation, spin):
    """As by differences, to Newton's tolerance of 1e-5, and ask a film four times less."""
    reduced, asked = rotor(), asked_films(monkeypatch)
    paths, counts, iterations = [], [], []
    for noted in (True, False):
        if not noted:
            monkeypatch.setattr(support_connectors, "differences_of", lambda body: Differences())
        asked.clear()
        films = bearings(reduced, cavitation=cavitation)
        mbs, _, sensors = scene(reduced, films, **spin)
        settings = recommended_settings(end_time=1.5e-3, step=1.5e-4)
        settings.timeIntegration.newton.useModifiedNewton = False
        settings.solution.file.write = False
        mbs.SolveDynamic(settings)
        paths.append(mbs.GetSensorStoredData(sensors[0])[:, 1:3])
        counts.append(len(asked))
        iterations.append(mbs.sys["dynamicSolver"].it.newtonStepsCount)
    moved = np.abs(paths[1]).max()
    assert moved > 0.02 * CLEARANCE
    np.testing.assert_allclose(*paths, rtol=0.0, atol=1e-5 * moved)
    assert iterations[0] <= iterations[1]
    assert counts[0] < 0.25 * counts[1]


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_film_has_the_rotors_speed_about_either_axis(sign):
    ring = ring_rotor(0.1, 0.15, 107.0, axis=[0.0, 0.0, sign])
    reduced = ring.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(0)
    mbs, body, _ = scene(reduced, bearings(reduced, cavitation="reynolds"), spin=SPEED)
    place = 0.3 * CLEARANCE * body.standing_axes[:, 0]
    with evaluating(mbs):
        q = np.array(mbs.systemData.GetODE2Coordinates())
        q[:3] += place
        mbs.systemData.SetODE2Coordinates(q)
        found = mbs.GetObjectOutput(body.supports[0].objects[0], exu.OutputVariableType.Force)
    law = FilmLaw(body.supports[0].support.film, torque=False)
    expected = law(0.3 * CLEARANCE, 0.0, 0.0, 0.0, 0.0, SPEED)
    np.testing.assert_allclose(-found @ body.standing_axes[:, :2], expected, rtol=1e-9)
