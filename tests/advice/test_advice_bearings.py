"""Proposals for bearings with coordinates of their own, and for tables that begin above zero."""

import pytest
from point_rotors import ring_rotor

from exudyn_rotor import (
    LinearActuator,
    MagneticBearing,
    PIDController,
    SolidRotor,
    Support,
    propose,
)

ENDS = ("left", "right")


@pytest.fixture(scope="module")
def reduced():
    """Return all modes of two rings, with a heavy spot on one."""
    upright = ring_rotor(0.1, 0.15, 5.0)
    rotor = SolidRotor.from_matrices(upright.mass, upright.stiffness, upright.nodes, "z")
    rotor = rotor.add_point_mass([0.1, 0.0, 0.15], 1e-2)
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10))
    return rotor.reduce(24)


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
