"""Steady motions of rotors that nothing holds along their axis."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import SKEW_AXIS, free_stiffness

from exudyn_rotor import (
    RollingBearing,
    ShortJournalBearing,
    SolidRotor,
    SpinAxis,
    Support,
    add_rotor,
    add_supports,
    steady_state,
)
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene import steady_motion
from exudyn_rotor.theory.rotating_axes import axes_of

MASS, RADIUS, ARM, G = 10.0, 0.1, 0.15, 9.81
SPEED, HEAVY = 100.0, 5e-4  # rad/s, and kg at RADIUS on either ring
COUNT, STIFFNESS, DAMPING = 8, 7e9, 10.0


def two_rings(direction, heavy=0.0):
    """Return five masses on each of two rings, and the axes (n1, n2, e)."""
    axes = axes_of(SpinAxis(direction))
    angle = 2.0 * np.pi * np.arange(5) / 5
    ring = RADIUS * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(5)])
    nodes = np.vstack([ring + np.array([0.0, 0.0, z]) for z in (-ARM, ARM)]) @ axes.T
    stiffness = free_stiffness(nodes, 1e8 * np.eye(30))
    rotor = SolidRotor.from_matrices(MASS / 10 * np.eye(30), stiffness, nodes, direction)
    for node in (0, 5) if heavy else ():
        rotor = rotor.add_point_mass(nodes[node], heavy)
    return rotor.with_interface("left", range(5)).with_interface("right", range(5, 10)), axes


def scene(made, gravity, direction=(0.0, 0.0, 1.0), heavy=0.0, speed=SPEED, thrust=True):
    """Return a rotor on two bearings; gravity along (n1, n2, e)."""
    rotor, axes = two_rings(np.array(direction), heavy)
    mbs = exu.SystemContainer().AddSystem()
    load = axes @ np.array(gravity)
    body = add_rotor(mbs, rotor.reduce(0), spin=speed, translation="none", gravity=load)
    supports = [made(name) for name in ("left", "right")]
    if thrust:
        supports.append(Support("left", np.diag([0.0, 0.0, 1e7]), np.diag([0.0, 0.0, 1e2])))
    add_supports(body, supports)
    mbs.Assemble()
    return body


def balls(clearance):
    return lambda name: RollingBearing(
        interface=name,
        count=COUNT,
        pitch_radius=0.0326,
        element_radius=0.006,
        stiffness=STIFFNESS,
        clearance=clearance,
        damping=DAMPING,
    )


def short(name):
    sizes = {"radius": 0.025, "length": 0.02, "clearance": 5e-5, "viscosity": 0.005}
    return ShortJournalBearing(interface=name, **sizes)


@pytest.mark.parametrize("direction", [(0.0, 0.0, 1.0), SKEW_AXIS])
def test_free_motion_along_the_axis_stays_where_it_starts(direction):
    body = scene(short, [0.0, -G, 0.0], direction, heavy=HEAVY, thrust=False)
    steady = steady_state(body)
    along = [steady.interface_motion("left", angle)[2] for angle in (0.0, 2.0)]
    assert np.abs(along).max() < 1e-9
    held = steady_state(scene(short, [0.0, -G, 0.0], direction, heavy=HEAVY))
    assert steady.interface_motion("left")[:2] == pytest.approx(
        held.interface_motion("left")[:2], rel=1e-6
    )


@pytest.mark.parametrize("speed", [0.0, SPEED])
@pytest.mark.parametrize("direction", [(0.0, 0.0, 1.0), SKEW_AXIS])
def test_load_along_the_axis_that_nothing_holds_is_refused_at_once(direction, speed, monkeypatch):
    def fails(*args):
        raise AssertionError("searched")

    monkeypatch.setattr(steady_motion, "linearised", fails)
    body = scene(balls(0.0), [0.0, -G, -1.0], direction, speed=speed, thrust=False)
    weight = MASS * 1.0
    with pytest.raises(UnconvergedError, match=rf"along its axis, where a load of {weight:.3g} N"):
        steady_state(body)
