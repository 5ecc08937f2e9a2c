"""Proposals for bearings with coordinates of their own, and for tables that begin above zero."""

import exudyn
import pytest
from point_rotors import ring_rotor

from exudyn_rotor import (
    LinearActuator,
    MagneticBearing,
    PIDController,
    SolidRotor,
    Support,
    add_rotor,
    add_supports,
    propose,
)

ENDS = ("left", "right")
GRAVITY = [0.0, -9.81, 0.0]


@pytest.fixture(scope="module")
def reduced():
    """Return all modes of two rings, with a heavy spot on one."""
    upright = ring_rotor(0.1, 0.15, 5.0)
    rotor = SolidRotor.from_matrices(upright.mass, upright.stiffness, upright.nodes, "z")
    rotor = rotor.add_point_mass([0.1, 0.0, 0.15], 1e-2)
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10))
    return rotor.reduce(24)


def scene(reduced, supports):
    """Return a scene with the rotor on supports, and its body."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, spin=300.0, gravity=GRAVITY, markers="position")
    add_supports(body, supports)
    mbs.Assemble()
    return mbs, body


def in_scene(reduced, supports, **options):
    """Return the proposal for a scene with the rotor on supports."""
    mbs, body = scene(reduced, supports)
    return propose(mbs, body=body, **options)


def numbers(proposal):
    return [proposal.error, proposal.step]


@pytest.mark.parametrize("speeds", [(50.0, 2000.0), 700.0])
@pytest.mark.parametrize("loads", [None, [3000.0]])
def test_magnets_with_ideal_controllers_are_springs_and_dampers(reduced, speeds, loads):
    """``k = K_i P − K_s``, ``d = K_i D``; filter and amplifier lag by 2ω/10⁸."""
    current, pull, P, D = 80.0, 1e5, 3e4, 60.0
    controller = PIDController(
        proportional=P, derivative=D, filter_frequency=1e8, amplifier_frequency=1e8
    )
    actuator = LinearActuator(current, pull)
    magnets = [
        MagneticBearing(interface=name, actuator=actuator, controller=controller) for name in ENDS
    ]
    springs = [Support(name, current * P - pull, damping=current * D) for name in ENDS]
    asked = {"speeds": speeds, "load_frequencies": loads}
    found, expected = (propose(reduced, supports=s, **asked) for s in (magnets, springs))
    assert found.modes == expected.modes
    assert numbers(found) == pytest.approx(numbers(expected), rel=1e-3)
    assert found.translation == expected.translation


def test_scene_and_list_of_magnets_agree(reduced):
    controller = PIDController(
        proportional=3e4,
        integral=2e5,
        derivative=60.0,
        filter_frequency=2e4,
        amplifier_frequency=1e4,
    )
    actuator = LinearActuator(80.0, 1e5)
    magnets = [
        MagneticBearing(interface=name, actuator=actuator, controller=controller) for name in ENDS
    ]
    found = in_scene(reduced, magnets, speeds=(100.0, 400.0), axial=False)
    expected = propose(reduced, supports=magnets, speeds=(100.0, 400.0))
    assert found.modes == expected.modes
    assert numbers(found) == pytest.approx(numbers(expected), rel=1e-5)
