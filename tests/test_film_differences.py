"""Tangents of films, and the Jacobians that Exudyn gets of scenes with them."""

import numpy as np
import pytest
from point_rotors import ring_rotor
from void_films import CLEARANCE, SPEED, bearings, oil, rotor, scene

from exudyn_rotor.bearings.film.reynolds import CAVITATION
from exudyn_rotor.bearings.journal_bearing import FilmLaw, RememberingLaw
from exudyn_rotor.multibody.evaluation import evaluating

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
    found = -np.hstack(law.slopes(*MOTION, 0.0, SPEED))
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


def test_jacobian_of_a_scene_with_films(monkeypatch):
    """Exudyn's of all forces against central differences of them; each film is asked once."""
    reduced = rotor()
    mbs, body, _ = scene(reduced, bearings(reduced, cavitation="reynolds"), spin=SPEED)
    asked, data = asked_films(monkeypatch), mbs.systemData
    rest, place = np.array(data.GetODE2Coordinates()), np.eye(data.ODE2Size())[:, :2] @ MOTION[:2]
    rate = np.eye(data.ODE2Size())[:, :2] @ MOTION[2:]
    rate[body.locks.spin] = body.locks.sign * SPEED
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
    assert len(asked) == 2 * 2  # each film once in each Jacobian
    scale = np.r_[ones, SPEED * ones]
    np.testing.assert_allclose(
        np.hstack(found) * scale,
        expected * scale,
        rtol=0.0,
        atol=1e-6 * np.abs(expected * scale).max(),
    )


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_film_has_the_rotors_speed_whatever_way_its_node_counts(sign):
    """About −z the node counts −θ."""
    ring = ring_rotor(0.1, 0.15, 107.0, axis=[0.0, 0.0, sign])
    reduced = ring.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(0)
    mbs, body, _ = scene(reduced, bearings(reduced, cavitation="reynolds"), spin=SPEED)
    assert body.locks.sign == sign
    place = 0.3 * CLEARANCE * body.standing_axes[:, 0]
    with evaluating(mbs):
        q = np.array(mbs.systemData.GetODE2Coordinates())
        q[:3] += place
        mbs.systemData.SetODE2Coordinates(q)
        found = body.supports[0].values()[2]
    law = FilmLaw(body.supports[0].support.film, torque=False)
    expected = law(0.3 * CLEARANCE, 0.0, 0.0, 0.0, 0.0, SPEED)
    np.testing.assert_allclose(found[:2], expected, rtol=1e-9)
