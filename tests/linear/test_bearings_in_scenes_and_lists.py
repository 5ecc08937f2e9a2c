"""Scenes and lists of bearings that differ in kind, on a block, skew, with an eccentric rotor."""

from dataclasses import replace

import numpy as np
import pytest
from apart import apart
from models import disc_with_two_modes
from test_uneven_films import BLOCK, HEAVY, SPEED
from void_films import CLEARANCE, SKEW, oil, scene

from exudyn_rotor import (
    JournalBearing,
    OilFilm,
    ShortJournalBearing,
    TiltingPadBearing,
    bearing_loads,
    grooved_pads,
    linear_model,
)
from exudyn_rotor.bearings.held_law import HeldBearing, HeldLaw

GAPS = np.radians([10.0, 130.0, 250.0])
PADS = OilFilm(0.02, 0.02, 0.1, grooved_pads(2e-4, GAPS, 0.2, 0.5), "none", nodes=48, axial_nodes=0)
SIZES = {"radius": 0.02, "length": 0.02, "clearance": CLEARANCE, "viscosity": 0.02}
FILM = replace(oil(cavitation="reynolds", nodes=48), radius=0.02, length=0.02)
KINDS = {
    "short": lambda **given: ShortJournalBearing(**given, **SIZES),
    "pads": lambda **given: TiltingPadBearing(**given, film=PADS, pad_inertia=1e-6),
    "reynolds": lambda **given: JournalBearing(**given, film=FILM),
}


def models(left, right, free, base=None, heavy=0.0, gravity=HEAVY):
    """Return the scene, skew in space, and the list of a disc on a shaft, as linear models."""
    reduced = disc_with_two_modes(heavy)
    loads = bearing_loads(reduced, ["left", "right"], gravity)
    supports = [
        KINDS[kind](interface=name, load=load)
        for kind, name, load in zip((left, right), ("left", "right"), loads, strict=True)
    ]
    spin = {"initial_speed": SPEED} if free else {"spin": SPEED, "translation": "none"}
    mbs, body, _ = scene(reduced, supports, SKEW @ gravity, base, rotation=SKEW, **spin)
    in_list = linear_model(reduced, supports=supports, foundation=base)
    return linear_model(mbs, body=body, about="equilibrium"), in_list


@pytest.mark.parametrize(
    ("left", "right", "free"),
    [("short", "short", False), ("short", "pads", True)],
    ids=["short-short-prescribed", "short-pads-free"],
)
def test_friction_on_a_block_changes_no_exponent(left, right, free):
    """A free spin differed by 3e-5 to 7e-5; a prescribed one, skew, found no steady motion."""
    assert apart(*models(left, right, free, BLOCK, heavy=0.02), SPEED) < 1e-6


@pytest.mark.parametrize(("left", "right"), [("reynolds", "reynolds"), ("pads", "reynolds")])
def test_films_under_an_uneven_mesh_are_taken_about_rest(left, right):
    """Journals move by ε of the clearance under the weight; exponents would by the order of ε²."""
    in_scene, in_list = models(left, right, False)
    assert apart(in_scene, in_list, SPEED) < 1e-6


def test_a_law_that_is_held_has_its_torque_there_alone():
    """Beside the place a torque would tilt with the journal, which linear equations leave out."""
    bearing = KINDS["short"](interface="left")
    law, place = HeldLaw(bearing), (5e-5, -2e-5, 1e-3, 0.0, 0.0, SPEED)
    law.hold(True)
    assert law.law_with_torque(*place) == bearing.law_with_torque(*place)
    moved = (6e-5, *place[1:])
    assert law.law_with_torque(*moved) == (*bearing.law(*moved), 0.0)
    law.hold(False)
    assert law.law_with_torque(*moved) == bearing.law_with_torque(*moved)


def test_films_go_on_as_from_rest_under_their_mean_force():
    """A motion across a film has its mean force where the journal rests beside its mean place."""
    held = HeldBearing.of(KINDS["short"](interface="left"))
    (law,), places = held.laws, np.array([[4e-5, -5e-5], [4.4e-5, -5.4e-5]])
    for place in places:
        law.hold(True)
        law.law(*place, 0.0, 0.0, 0.0, SPEED)
    assert held.settles
    held.settle(SPEED)
    mean = np.mean([force for _, force in law.seen], axis=0)
    np.testing.assert_allclose(law.tangent, held.bearing.coefficients(SPEED, -mean), rtol=1e-12)
    law.hold(True)
    start = np.array(law.law(*places[0], 0.0, 0.0, 0.0, SPEED))
    change = np.array(law.law(*(places[0] + [1e-6, 0.0]), 0.0, 0.0, 0.0, SPEED)) - start
    np.testing.assert_allclose(change, -1e-6 * law.tangent[0][:, 0], rtol=1e-9)
    held.release()
    assert law.tangent is None
