"""Magnetic bearings on foundations, against a state space written here and against scenes."""

import numpy as np
import scipy.linalg as la
from test_foundations import two_masses
from test_magnetic_bearing import DELAYED, PD, apart, closed_loop, pair

from exudyn_rotor import Support, linear_model, sensitivity, stability

AXIAL = Support("right", np.diag([0.0, 0.0, 5e5]), 0.0, np.diag([0.0, 0.0, 4e3]))
OWN = (1.5e6, 4e6)
FAST = 800.0


def levitated(one, own, speed):
    """Return the state space of a rigid rotor of 5 kg above a foundation of 5 kg, as x + iy.

    Coordinates: translation and tilt of the rotor, translation of the foundation on the stiffness
    `own`.
    """
    m, r, half = 5.0, 0.1, 0.15
    inertia = np.diag([m, m * (0.5 * r**2 + half**2), m])
    places = [np.array([1.0, side * half, -1.0]) for side in (-1.0, 1.0)]
    gyroscopic = np.diag([0.0, speed * m * r**2, 0.0])
    return closed_loop(inertia, gyroscopic, np.diag([0.0, 0.0, own]), places, places, one)


def on_foundation(one, own):
    """Return the rotor and what it stands on, without damping but that of the controllers."""
    rotor, _, foundation = two_masses(own=(own, own))
    on = {
        "supports": [*pair(controller=one), AXIAL],
        "foundation": foundation.with_damping_ratio(0.0),
    }
    return rotor, on


def test_exponents_at_rest_are_those_of_the_state_space():
    rotor, on = on_foundation(DELAYED, OWN[0])
    values = la.eigvals(levitated(DELAYED, OWN[0], 0.0)[0])
    found = stability(linear_model(rotor, **on), [0.0], accuracy=None).exponents[0]
    values = values[np.abs(values.imag) > 1.0]
    assert apart(np.r_[found, found.conj()], values) < 1e-7


def test_sensitivity_is_that_of_the_state_space():
    """Of the rotor that spins: the mean of forward and backward whirl."""
    frequencies = np.array([300.0, 310.0])
    rotor, on = on_foundation(PD, OWN[0])
    found = sensitivity(rotor, frequencies, **on, speed=FAST)
    A, drive, seen = levitated(PD, OWN[0], FAST)
    for w, values in zip(frequencies, found.values[:, [0, -1]].T, strict=True):
        sides = [seen @ la.solve(1j * w * np.eye(len(A)) - X, drive) for X in (A, A.conj())]
        np.testing.assert_allclose(values, 1.0 + 0.5 * sum(sides), rtol=1e-8)
