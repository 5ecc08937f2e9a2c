"""Films that conserve mass under a rotor of an uneven mesh: scenes and lists of supports agree."""

from dataclasses import replace

import numpy as np
import pytest
from apart import apart
from models import disc_with_two_modes
from void_films import CLEARANCE, SKEW, TO_X, bearings, oil, rotor, scene
from void_films import SPEED as RIGID_SPEED

from exudyn_rotor import Foundation, JournalBearing, Mount, Support, bearing_loads, linear_model
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene import films

SPEED, HEAVY = 300.0, 5.0 * np.array([0.0, -9.81, 0.0])
CORNERS = [[x, -0.3, z] for x in (-0.2, 0.2) for z in (-0.1, 0.6)]
BLOCK = Foundation.rigid(
    80.0,
    [4.0, 5.0, 1.0],
    [0.0, -0.2, 0.2],
    [Mount(corner, 4e6, 2e3) for corner in CORNERS],
    {"left": [0.0, 0.0, 0.0], "right": [0.0, 0.0, 0.5]},
)
SEAL = Support("right", 0.0, ([0.0, 400.0], [[[500.0, 90.0], [-90.0, 800.0]], 900.0 * np.eye(2)]))
CASES = {
    "backwards and skew": ({}, {"rotation": SKEW, "speed": -SPEED}),
    "eccentric": ({"heavy": 0.02}, {"rotation": SKEW}),
    "foundation, table": ({"more": [SEAL]}, {"foundation": BLOCK}),
    "free spin, x": ({}, {"rotation": TO_X, "free": True}),
    "two lobes": ({"groove": [0.0, np.pi], "preload": 0.5}, {}),
}


def given(heavy=0.0, more=(), rotation=None, free=False, speed=SPEED, foundation=None, **film):
    """Return the scene and the list of a disc on a shaft, each as a linear model.

    Its coarse mesh is uneven enough that the shaft bends by its weight unlike in two directions.
    """
    reduced = disc_with_two_modes(heavy)
    turn = np.eye(3) if rotation is None else rotation
    oiled = replace(oil(**{"nodes": 48, **film}), radius=0.02, length=0.02)
    loads = zip(BLOCK.points, bearing_loads(reduced, list(BLOCK.points), HEAVY), strict=True)
    supports = [JournalBearing(interface=name, film=oiled, load=load) for name, load in loads]
    supports += more
    spin = {"initial_speed": speed} if free else {"spin": speed, "translation": "none"}
    mbs, body, _ = scene(reduced, supports, turn @ HEAVY, foundation, rotation=rotation, **spin)
    in_list = linear_model(reduced, supports=supports, foundation=foundation)
    return linear_model(mbs, body=body, about="equilibrium"), in_list


@pytest.mark.parametrize("name", CASES)
def test_scenes_are_linearised_as_lists(name):
    """Journals move by ε = 4e-4 to 3e-3 of the clearance; their mean place is off by ε²."""
    film, placed = CASES[name]
    in_scene, in_list = given(**film, **placed)
    speed = placed.get("speed", SPEED)
    assert apart(in_scene, in_list, speed) < 1e-6
    bearing, journal = in_scene.scene.remembering[0].support, in_scene.scene.points(speed)[1][0]
    assert np.ptp([place for place, _ in journal], axis=0).max() > 4e-4 * CLEARANCE
    rests = films.at_rest(bearing, journal, speed).position
    np.testing.assert_allclose(rests, bearing.equilibrium(speed), rtol=0.0, atol=1e-8 * CLEARANCE)


@pytest.mark.parametrize(
    ("cavitation", "rotation"),
    [
        ("none", SKEW),
        ("reynolds", SKEW),
        ("mass-conserving", None),
        ("mass-conserving", SKEW),
    ],
    ids=["none-skew", "reynolds-skew", "mass-conserving-z", "mass-conserving-skew"],
)
def test_films_on_a_base_are_linearised_alike_with_a_free_spin(cavitation, rotation):
    """The static force keeps its direction where the base tilts."""
    models = given(free=True, foundation=BLOCK, cavitation=cavitation, rotation=rotation)
    assert apart(*models, SPEED) < 1e-6


def test_a_journal_that_moves_is_linearised_about_rest_as_long_as_it_moves_little():
    in_list = linear_model(rotor(), supports=bearings(rotor()))
    for eccentric, moves in ((1e-4, False), (1e-2, True)):
        reduced = rotor(eccentric)
        mbs, body, _ = scene(reduced, bearings(reduced), spin=RIGID_SPEED)
        model = linear_model(mbs, body=body)
        if moves:
            with pytest.raises(UnconvergedError, match="is linearised about a journal at rest"):
                model.at(RIGID_SPEED)
        else:
            assert apart(model, in_list, RIGID_SPEED) < 1e-6
