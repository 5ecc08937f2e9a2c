"""Bearings between two rotors in scenes: the bore, or the outer ring, turns with one of them."""

from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest
from exudyn.rigidBodyUtilities import InertiaCuboid
from test_magnetic_bearing import DELAYED, bearing
from test_scene_trains import HELD, SPEED, accelerations_left
from train_models import FIRST, SECOND, rings

import exudyn_rotor as er

RADIUS, LENGTH, CLEARANCE, VISCOSITY, OFF = 0.02, 0.02, 1e-4, 0.02, 6e-5
SHORT = er.ShortJournalBearing(
    interface="a", radius=RADIUS, length=LENGTH, clearance=CLEARANCE, viscosity=VISCOSITY
)
BALLS = er.RollingBearing(
    interface="a", count=7, pitch_radius=0.03, element_radius=0.006, stiffness=5e8
)
CASING = InertiaCuboid(1000.0, [0.1, 0.1, 0.1])
KINDS = exu.OutputVariableType


def scene(support, outer, inner, full=False, **changes):
    """Return a system with an inner rotor on an outer one, its centre OFF along n1 = x."""
    mbs, solid = exu.SystemContainer().AddSystem(), rings(*FIRST)
    carrying = er.add_rotor(mbs, solid if full else solid.reduce(0), name="outer", **outer)
    body = er.add_rotor(mbs, rings(*SECOND).reduce(0), name="inner", **(inner | changes))
    (added,) = er.add_supports(body, [support], base=carrying.marker("a"))
    mbs.Assemble()
    q = mbs.systemData.GetODE2Coordinates()
    q[mbs.GetNodeODE2Index(body.nodes["rigid"])] += OFF
    mbs.systemData.SetODE2Coordinates(q)
    return mbs, added


def force_on_inner(mbs, added):
    """Return what the support does to the inner rotor along x and y."""
    return (added.values()[2] @ added.body.standing_axes.T)[:2]


@pytest.mark.parametrize("full", [False, True], ids=["in modes", "full"])
@pytest.mark.parametrize("kind", ["spin", "initial_speed"])
@pytest.mark.parametrize("outer", [60.0, -20.0, 0.0])
def test_a_film_is_dragged_by_both_surfaces(kind, outer, full):
    """Ocvirk's film of a journal that stands, with the sum of both speeds (Reynolds)."""
    inner = 90.0
    mbs, connector = scene(SHORT, {kind: outer}, {kind: inner}, full)
    # velocities of both middles are zero, those of the mesh are not
    ratio, speed = OFF / CLEARANCE, outer + inner
    size = VISCOSITY * speed * RADIUS * LENGTH**3 / CLEARANCE**2
    radial = size * ratio**2 / (1.0 - ratio**2) ** 2
    across = size * np.pi * ratio / (4.0 * (1.0 - ratio**2) ** 1.5)
    assert force_on_inner(mbs, connector) == pytest.approx([-radial, across], rel=1e-9)


@pytest.mark.parametrize("kind", ["spin", "initial_speed"])
def test_a_film_in_a_casing_that_turns(kind):
    """As on another rotor: N. Petroff's casing drags as much oil as the journal."""
    mbs = exu.SystemContainer().AddSystem()
    casing = mbs.CreateRigidBody(inertia=CASING, initialAngularVelocity=[0.0, 0.0, 60.0])
    body = er.add_rotor(mbs, rings(*SECOND).reduce(0), **{kind: 90.0})
    (added,) = er.add_supports(body, [SHORT], base=casing)
    mbs.Assemble()
    q = mbs.systemData.GetODE2Coordinates()
    q[mbs.GetNodeODE2Index(body.nodes["rigid"])] += OFF
    mbs.systemData.SetODE2Coordinates(q)
    other, connector = scene(SHORT, {kind: 60.0}, {kind: 90.0})
    expected = force_on_inner(other, connector)
    assert force_on_inner(mbs, added) == pytest.approx(expected, rel=1e-9)


def test_elements_go_with_both_rings():
    """The cage has turned by κ θ_i + (1 − κ) θ_o (Harris, Ch. 8)."""
    inner, outer = 0.7, -1.1
    mbs, connector = scene(
        BALLS,
        {"initial_speed": 60.0, "initial_angle": outer},
        {"initial_speed": 90.0, "initial_angle": inner},
    )
    share = 0.5 * (1.0 - 0.006 / 0.03)
    angles = 2.0 * np.pi * np.arange(7) / 7.0 + share * inner + (1.0 - share) * outer
    n = np.array([np.cos(angles), np.sin(angles)])
    expected = -n @ (5e8 * np.maximum(OFF * n[0], 0.0) ** 1.5)
    assert force_on_inner(mbs, connector) == pytest.approx(expected, rel=1e-9)


BETWEEN = {
    "table": er.Support("a", ([0.0, 100.0], [1e5, 4e5]), ([0.0, 100.0], [9.0, 30.0])),
    "tilts": er.Support("a", 1e5, 0.0, np.diag([300.0, 200.0]), 2.0),
    "table of tilts": er.Support("a", 1e5, 0.0, ([0.0, 300.0], [2e2, 3e2])),
}


@pytest.mark.parametrize("kind", BETWEEN)
def test_supports_between_rotors_are_links_of_a_train(kind):
    """Tables over the difference of the speeds: accelerations are those of the equations."""
    mbs = exu.SystemContainer().AddSystem()
    first, second = (
        er.add_rotor(mbs, rings(*sizes).reduce(0), name=name, spin=speed)
        for sizes, name, speed in ((FIRST, "LP", SPEED), (SECOND, "HP", 1.7 * SPEED))
    )
    er.add_supports(first, HELD)
    er.add_supports(second, er.Support("b", 1e5 * np.eye(3), 9.0, 1e3))
    er.add_supports(second, BETWEEN[kind], base=first.marker("a"))
    mbs.Assemble()
    model = er.linear_model(mbs, body=[first, second])
    assert accelerations_left(mbs, [first, second], model, (1.0, 1.7)) < 1e-9


PADS = er.OilFilm(
    RADIUS, LENGTH, VISCOSITY, er.grooved_pads(CLEARANCE, [0.0, 3.0], 0.5), axial_nodes=0
)
REFUSED = {
    "about the axis": er.Support("a", 1e5, 0.0, np.diag([300.0, 300.0, 50.0])),
    "unlike the bore": replace(SHORT, load=[0.0, -9.0]).linearised(),
    "its pads": er.TiltingPadBearing(interface="a", film=PADS, pad_inertia=1e-6),
    "pads or magnets": bearing("a", DELAYED, er.LinearActuator(80.0, 1e5)),
}


@pytest.mark.parametrize("match", REFUSED)
def test_what_a_marker_that_turns_cannot_carry_is_refused(match):
    with pytest.raises(ValueError, match=f"(?s)stands on another rotor.*{match}"):
        scene(REFUSED[match], {"spin": 60.0}, {"spin": 90.0})
