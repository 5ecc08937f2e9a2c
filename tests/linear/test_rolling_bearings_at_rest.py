"""Rotors at rest in rolling bearings with clearance: between elements nothing holds them yet."""

from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest
from point_rotors import SKEW_AXIS, free_stiffness, ring_rotor

from exudyn_rotor import (
    RollingBearing,
    SolidRotor,
    SpinAxis,
    Support,
    add_rotor,
    add_supports,
    steady_state,
)
from exudyn_rotor.theory.rotating_axes import axes_of

pytestmark = pytest.mark.filterwarnings("ignore:rotor 'rotor'. no node of Exudyn")

MASS, RADIUS, ARM, HEAVY = 10.0, 0.1, 0.15, 5e-4
COUNTS, CLEARANCES = {"left": 7, "right": 12}, {"left": 3e-6, "right": 1e-5}
pytestmark = pytest.mark.filterwarnings("ignore:rotor 'rotor'. no node of Exudyn")

STIFFNESS = {"balls": 7e9, "rollers": 2e9}
UPRIGHT = (0.0, 0.0, 1.0)


def bearing(name, elements):
    return RollingBearing(
        interface=name,
        count=COUNTS[name],
        pitch_radius=0.06,
        element_radius=0.007,
        stiffness=STIFFNESS[elements],
        clearance=CLEARANCES[name],
        elements=elements,
    )


def scene(elements, gravity, direction):
    """Return two rings with a mass HEAVY beside either bearing; gravity along (n1, n2, e)."""
    axes = axes_of(SpinAxis(direction))
    angle = 2.0 * np.pi * np.arange(5) / 5
    ring = RADIUS * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(5)])
    nodes = np.vstack([ring + np.array([0.0, 0.0, z]) for z in (-ARM, ARM)]) @ axes.T
    stiffness = free_stiffness(nodes, 1e8 * np.eye(30))
    rotor = SolidRotor.from_matrices(MASS / 10 * np.eye(30), stiffness, nodes, direction)
    for node in (0, 5):
        rotor = rotor.add_point_mass(nodes[node], HEAVY)
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10))
    mbs = exu.SystemContainer().AddSystem()
    load = axes @ np.array(gravity)
    body = add_rotor(mbs, rotor.reduce(0), spin=0.0, translation="none", gravity=load)
    thrust = Support("left", np.diag([0.0, 0.0, 1e7]), np.diag([0.0, 0.0, 1e2]))
    add_supports(body, [*(bearing(name, elements) for name in COUNTS), thrust])
    mbs.Assemble()
    return body


@pytest.mark.parametrize(
    ("elements", "direction", "gravity"),
    [
        ("rollers", UPRIGHT, [0.3, -0.2, -9.8]),
        ("rollers", SKEW_AXIS, [6.0, -7.0, 0.0]),
        ("balls", SKEW_AXIS, [0.3, -0.2, -9.8]),
    ],
)
def test_rotor_at_rest_lies_in_its_elements(elements, direction, gravity):
    """The elements of either bearing carry its half of the weight."""
    steady = steady_state(scene(elements, gravity, np.array(direction)))
    weight = (0.5 * MASS + HEAVY) * np.array(gravity[:2])
    # the weight at an arm across the axis tilts the rotor; the last step, 1e-8 of 1e-5 m, is one
    # against 1e10 N/m
    tilting = HEAVY * RADIUS * abs(gravity[2]) / ARM
    for name in COUNTS:
        place = steady.interface_motion(name, 0.0)[:2]
        force = np.array(bearing(name, elements).law(*place, 0.0, 0.0, 0.0, 0.0))
        assert force == pytest.approx(-weight, abs=2.0 * tilting + 1e-3)


@pytest.mark.filterwarnings("ignore:rotor .rotor.. a contact that opens")
@pytest.mark.parametrize("heavy", [1e-4, 5e-3])
def test_upright_rotor_in_balls_without_clearance_whirls_by_its_unbalance(heavy):
    """Newton's steps are shortened: without load balls have no stiffness, and more with any."""
    rotor = ring_rotor(RADIUS, ARM, MASS).add_point_mass([RADIUS, 0.0, ARM], heavy)
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10))
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor.reduce(0), spin=100.0, translation="none", gravity=[0, 0, -9.81])
    balls = [replace(bearing(name, "balls"), clearance=0.0, damping=500.0) for name in COUNTS]
    add_supports(body, [*balls, Support("left", np.diag([0.0, 0.0, 1e7]), 100.0)])
    mbs.Assemble()
    away = steady_state(body).interface_motion("right", 0.0)[0]
    # e m Ω² against 6.03 k x^1.5, the sum of cos^2.5 over twelve balls, and the damping
    assert 0.5 < away / (heavy * RADIUS * 100.0**2 / (3.0 * 7e9)) ** (2.0 / 3.0) < 1.5
