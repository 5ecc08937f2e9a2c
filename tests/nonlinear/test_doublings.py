"""Period doublings of Duffing's oscillator with two wells, against an integration in time."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from exudyn_rotor import HarmonicForce, SolidRotor, Unbalance, periodic_response
from exudyn_rotor.bearings.bearing import Bearing

DAMPING, SPEED = 0.3, 1.2  # x″ + δ x′ − x + x³ = γ cos(ωt): δ, ω of textbooks


@dataclass(frozen=True, eq=False, kw_only=True)
class Wells(Bearing):
    """Duffing's force along n1, and a spring along n2."""

    def law(self, x, y, vx, vy, angle, speed):
        return x - x**3 - DAMPING * vx, -4.0 * y - DAMPING * vy

    def _rest(self, speed, load):
        return np.array([1.0, 0.0])

    def _matrices(self, speed, load):
        return np.diag([2.0, 4.0]), DAMPING * np.eye(2)


def period_of(amount, start, turns):
    """Return the state after some revolutions, and its derivative by the start."""

    def rates(t, y):
        x, v, *flow = y
        J = np.array([[0.0, 1.0], [1.0 - 3.0 * x * x, -DAMPING]])
        push = amount * np.cos(SPEED * t)
        return np.r_[v, x - x**3 - DAMPING * v + push, (J @ np.reshape(flow, (2, 2))).ravel()]

    length = turns * 2.0 * np.pi / SPEED
    run = solve_ivp(
        rates, (0.0, length), np.r_[start, 1, 0, 0, 1], method="DOP853", rtol=1e-9, atol=1e-11
    )
    return run.y[:2, -1], run.y[2:, -1].reshape(2, 2)


def cycle(amount, start, turns):
    """Return a state on the cycle near a start, and its multipliers, by Newton's method."""
    for _ in range(3):
        end, flow = period_of(amount, start, turns)
        start = start - np.linalg.solve(flow - np.eye(2), end - start)
    return start, np.linalg.eigvals(flow)


def test_period_doubling_and_the_branch_of_twice_the_period():
    rotor = SolidRotor.from_matrices(np.eye(3), np.zeros((3, 3)), [[0.0, 0, 0]], "z")
    rotor = rotor.with_interface("seat", [0]).reduce(0)
    found = periodic_response(
        rotor, [0.05, 0.28], Unbalance("seat", 1.0 / SPEED**2), supports=Wells(interface="seat"),
        over="unbalance", speed=SPEED, tolerance=1e-5, revolutions=2,
    )  # fmt: skip
    twice = np.abs(found.phasor("seat", "n1", spin=0.5)) > 1e-3

    def begin(point):
        (a, b), step = found.displacement(point, [-1e-6, 1e-6])[:, 0], 2e-6
        return np.array([0.5 * (a + b), (b - a) / step])

    point = found.kinds.index("doubling")
    state, multipliers = cycle(found.values[point], begin(point), 1)
    np.testing.assert_allclose(begin(point), state, atol=1e-4)
    assert multipliers.real.min() == pytest.approx(-1.0, abs=1e-3)
    once, double = (
        next(p for p in found.at(0.28) if twice[p] == each and found.amplitudes()[p] > 0.3)
        for each in (False, True)
    )
    for point, turns in ((once, 1), (double, 2)):
        state, multipliers = cycle(0.28, begin(point), turns)
        np.testing.assert_allclose(begin(point), state, atol=1e-4)
        per_two = np.abs(multipliers).max() ** (2 // turns)
        assert np.abs(found.multipliers[point]) == pytest.approx(per_two, rel=1e-3)
    assert found.stable[[once, double]].tolist() == [False, True]


@dataclass(frozen=True, eq=False, kw_only=True)
class Hardening(Wells):
    """A force along n1 that is as large to both sides."""

    def law(self, x, y, vx, vy, angle, speed):
        return -0.2 * x - x**3 - 0.2 * vx, -4.0 * y - 0.2 * vy

    def _rest(self, speed, load):
        return np.zeros(2)


@pytest.mark.parametrize(("load", "stable"), [(0.0, False), (0.01, True)])
def test_a_small_load_leads_onto_the_branch_that_leaves_the_symmetry(load, stable):
    rotor = SolidRotor.from_matrices(np.eye(3), np.zeros((3, 3)), [[0.0, 0, 0]], "z")
    found = periodic_response(
        rotor.with_interface("seat", [0]).reduce(0), [1.5, 4.0], Unbalance("seat", 1.0),
        supports=Hardening(interface="seat"), over="unbalance", speed=1.0,
        revolutions=1 if load else 2,
        loads=[HarmonicForce("seat", [load, 0.0, 0.0])] if load else (),
    )  # fmt: skip
    assert ("branching" in found.kinds) == (not stable)
    end = found.at(4.0)[0]
    mean = found.phasor("seat", "n1", spin=0.0)[end].real
    assert found.stable[end] == stable
    assert (mean > 0.3) == stable
    assert found.multipliers[end].real > 1.0 or stable
