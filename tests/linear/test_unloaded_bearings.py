"""Scenes with bearings that no load presses to a side, and contacts that are just closed."""

import exudyn as exu
import numpy as np
import pytest
from apart import exponents
from point_rotors import ring_rotor

from exudyn_rotor import (
    JournalBearing,
    OilFilm,
    RollingBearing,
    Support,
    add_rotor,
    add_supports,
    grooved_pads,
    linear_model,
    steady_state,
)
from exudyn_rotor.bearings.held_law import HeldBearing
from exudyn_rotor.bearings.rolling import contacts
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene import steady_motion

CLEARANCE, MASS, RADIUS = 1e-4, 100.0, 0.1
ACROSS, UPRIGHT = [0.0, -9.81, 0.0], [0.0, 0.0, -9.81]
AXIAL = Support("left", np.diag([0.0, 0.0, 1e7]), np.diag([0.0, 0.0, 1e2]))


def balls(clearance, damping=10.0):
    return lambda name: RollingBearing(
        interface=name,
        count=8,
        pitch_radius=0.0326,
        element_radius=0.006,
        stiffness=7e9,
        clearance=clearance,
        damping=damping,
    )


def journal(load=None, grooves=(), preload=0.0, **film):
    pads = grooved_pads(CLEARANCE, grooves, 0.3 if grooves else 0.0, preload=preload)
    film = {"nodes": 24, "axial_nodes": 0} | film
    oil = OilFilm(radius=0.05, length=0.05, viscosity=0.02, pads=pads, **film)
    return lambda name: JournalBearing(interface=name, film=oil, load=load)


def scene(made, gravity, speed=100.0, eccentric=0.0, z=0.0, names=("left", "right")):
    rotor = ring_rotor(RADIUS, 0.15, MASS)
    if eccentric:
        rotor = rotor.add_point_mass([RADIUS, 0.0, z], eccentric)
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10))
    reduced = rotor.with_interface("middle", range(10)).reduce(0)
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, spin=speed, translation="none", gravity=gravity)
    supports = [*map(made, names), AXIAL]
    add_supports(body, supports)
    mbs.Assemble()
    return mbs, body, reduced


@pytest.fixture
def linearisations(monkeypatch):
    """Return the angles at which scenes were linearised."""
    angles, linearised = [], steady_motion.linearised

    def counted(probe, theta, *motion):
        angles.append(theta)
        return linearised(probe, theta, *motion)

    monkeypatch.setattr(steady_motion, "linearised", counted)
    return angles


# ------------------------------------------------------------------ elements


@pytest.mark.parametrize("place", [[0.0, -1.2e-5], [7e-6, 3e-6], [0.0, 0.0]])
def test_contacts_are_linear_by_their_stiffness_once_held(place):
    bearing = balls(5e-6)("left")
    law = HeldBearing.of(bearing).laws[0]
    law.hold(True)
    start = np.array(law.law(*place, 0.0, 0.0, 0.3, 100.0))
    dx, dv = np.array([3e-6, -2e-6]), np.array([0.1, 0.2])
    moved = np.array(law.law(*(place + dx), *dv, 0.3, 100.0))
    K = contacts(bearing, np.array(place), 0.3)[2]
    np.testing.assert_allclose(moved - start, -K @ dx - 10.0 * dv, rtol=1e-12, atol=1e-9)


def test_upright_rotor_whirls_in_the_clearance():
    """Free across the axis it turns about its centre of mass: the middle moves by m r/M."""
    _, body, _ = scene(balls(5e-6, 0.0), UPRIGHT, eccentric=2e-3)
    seen = steady_state(body).interface_motion("middle", 0.7)[:2]
    whirl = -2e-3 * RADIUS / (MASS + 2e-3) * np.array([np.cos(0.7), np.sin(0.7)])
    assert seen == pytest.approx(whirl, rel=1e-4)


def test_upright_rotor_that_hits_elements_is_refused_at_once(linearisations):
    _, body, _ = scene(balls(5e-6), UPRIGHT, eccentric=8e-3, z=0.05)
    with pytest.raises(UnconvergedError, match="nothing presses the elements of the rolling"):
        steady_state(body)
    assert len(linearisations) <= 12 * 20


# ------------------------------------------------------------------ films

WITHOUT_SIDE = {
    "plain": journal(),
    "half": journal(cavitation="half-sommerfeld"),
    "voids": journal(grooves=[1.7], cavitation="mass-conserving"),
}


@pytest.mark.parametrize("about", ["given", "equilibrium"])
@pytest.mark.parametrize("kind", WITHOUT_SIDE)
def test_film_in_whose_middle_the_journal_stands_asks_for_a_load(kind, about):
    mbs, body, _ = scene(WITHOUT_SIDE[kind], UPRIGHT)
    with pytest.raises(UnconvergedError, match=r"no load presses .* 'left' .*load=…"):
        linear_model(mbs, body=body, about=about).at(100.0)


@pytest.mark.parametrize("kind", ["reynolds", "half-sommerfeld"])
def test_load_of_a_bearing_counts_where_the_weight_loads_none(kind):
    """A belt's pull, which the scene lacks: about='given' has the film of the list."""
    made = journal([300.0, -200.0], cavitation=kind)
    mbs, body, reduced = scene(made, UPRIGHT)
    model = linear_model(mbs, body=body, about="given")
    listed = linear_model(reduced, supports=[made("left"), made("right"), AXIAL])
    found, expected = (exponents(each, 100.0) for each in (model, listed))
    turns, both = 100j * np.arange(-2, 3)[:, None], np.r_[found, found.conj()]
    slow = expected[(expected.real > -100.0) & (np.abs(expected.real) > 1e-4)]
    assert len(slow) == 3
    assert max(np.abs(both - s + turns).min() for s in slow) < 1e-2
