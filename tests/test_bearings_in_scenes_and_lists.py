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
