"""Magnetic bearings on foundations, against a state space written here and against scenes."""

import apart as models
import exudyn as exu
import numpy as np
import pytest
import scipy.linalg as la
from test_foundations import BLOCK, two_masses
from test_magnetic_bearing import (
    DELAYED,
    MAGNETS,
    PD,
    PID,
    apart,
    bearing,
    closed_loop,
    pair,
)
from test_supports_in_scenes import SKEW, SPEED, TO_X, rings

from exudyn_rotor import (
    Support,
    add_foundation,
    add_rotor,
    add_supports,
    linear_model,
    sensitivity,
    stability,
)
from exudyn_rotor.reduction.selection import without_spin

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
    on = {"supports": [*pair(controller=one), AXIAL], "foundation": foundation.undamped()}
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


def in_scene(rotor, supports, block=BLOCK, rotation=None, **options):
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor, rotation=rotation, **options)
    add_supports(body, supports, add_foundation(mbs, block, rotation=rotation))
    mbs.Assemble()
    return linear_model(mbs, body=body, about="given")


KINDS = {
    "elsewhere, turned": [bearing(angle=0.5, sensor="right"), bearing("right", angle=9.0)],
    "magnets and a spring": [
        bearing(actuator=MAGNETS, controller=PD),
        Support("right", [[2e6, 5e5], [-5e5, 1e6]], 400.0),
    ],
    "in both frames": [
        bearing(controller=PID),
        Support("right", [[2e6, 0.0], [0.0, 1e6]], frame="rotor"),
    ],
}


@pytest.mark.parametrize(("turn", "rotation"), [(TO_X, None), (SKEW, TO_X)], ids=["x", "skew"])
@pytest.mark.parametrize("kind", KINDS)
def test_scene_and_list_have_the_same_exponents(kind, turn, rotation):
    rotor, supports = rings(turn, heavy=0.0), [*KINDS[kind], AXIAL]
    block = (BLOCK if turn is None else BLOCK.turned(turn)).modal()
    options = {"spin": SPEED, "translation": "none"}
    found = in_scene(rotor, supports, block, rotation, **options)
    in_list = linear_model(without_spin(rotor), supports=supports, foundation=block)
    assert models.apart(found, in_list, SPEED) < 1e-6
