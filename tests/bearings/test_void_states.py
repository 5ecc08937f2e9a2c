"""What voids remember, as a few states of linear analyses: against the film, and against runs."""

import numpy as np
import pytest
from void_films import (
    SPEED,
    bearings,
    exponent,
    oil,
    rotor,
)

from exudyn_rotor import (
    stability,
)

LOAD = np.array([0.0, -525.0])
IN_PAD, TO_GROOVE = [1.2, 1.2 + np.pi], [0.0, np.pi]  # where voids end, of two grooves


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
