"""Rotors with products of inertia and the centre of mass off the axis: lists and scenes are alike.

In both the spin follows θ = Ωt. The reference is a rigid rotor with finite rotations.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from apart import apart
from models import disc_rotor
from point_rotors import free_stiffness
from rigid_rotors import RigidRotor
from test_bearings_in_scenes_and_lists import FILM
from test_eccentric import ROUTES, distance, on_route
from test_kinds_in_scenes_and_lists import BLOCK, ENDS, KINDS, on_ends, short
from test_uneven_films import HEAVY, SPEED

from exudyn_rotor import (
    JournalBearing,
    MagneticBearing,
    PIDController,
    ReducedRotor,
    SaturatingActuator,
    SolidRotor,
    Support,
    campbell,
    linear_model,
    stability,
    unbalance_response,
)

PD = PIDController(proportional=2e4, derivative=20.0, filter_frequency=6e4, amplifier_frequency=3e4)
STIFFNESS, DAMPING, SLOW = 1e6, 50.0, 10.0  # of each of two bearings; rad/s
PLACES = [-0.2, 0.2]


def uneven(couple: float, eccentricity: float) -> tuple[SolidRotor, np.ndarray, np.ndarray]:
    """Return a rotor of 2 kg with two masses on a diagonal, its nodes and masses."""
    angle = 2.0 * np.pi * np.arange(5) / 5
    ring = 0.1 * np.column_stack([np.cos(angle), np.sin(angle), 0.0 * angle])
    ring += [eccentricity, 0.0, 0.0]
    diagonal = np.array([[0.1, 0.0, 0.1], [-0.1, 0.0, -0.1]])
    ends = np.column_stack([np.zeros((2, 2)), PLACES])
    shift = np.array([0.0, 0.0, 0.05])
    nodes = np.vstack([ring - shift, ring + shift, diagonal, ends])
    masses = np.repeat([0.2, couple + 1e-6, 0.01], [10, 2, 2])
    K = free_stiffness(nodes, 1e10 * np.eye(nodes.size))
    rotor = SolidRotor.from_matrices(np.kron(np.diag(masses), np.eye(3)), K, nodes, "z")
    return rotor.with_interface("left", [12]).with_interface("right", [13]), nodes, masses


def bearings() -> list[Support]:
    K, D = np.diag([STIFFNESS] * 3), np.diag([DAMPING, DAMPING, 0.0])
    return [Support(name, K, D) for name in ENDS]


def nonlinear(nodes: np.ndarray, masses: np.ndarray, speed: float, free: bool) -> np.ndarray:
    """Return the exponents with Im s > 0 about the steady motion."""
    rotor = RigidRotor(nodes, masses, PLACES, STIFFNESS, DAMPING, STIFFNESS, speed, free)
    return np.array([s for s in rotor.exponents() if s.imag > 1.0])


@pytest.mark.parametrize("route", ROUTES)
@pytest.mark.parametrize(("couple", "eccentricity"), [(0.0, 0.01), (0.1, 0.0), (0.1, 0.01)])
def test_exponents_are_those_at_constant_speed(couple, eccentricity, route):
    """Products of inertia changed them by 4e-3 of a frequency.

    Terms of second order in the steady tilt and whirl, which are left out, are 1e-7. Unreduced,
    what holds the masses together yields by 1e-4, the ratio of both stiffnesses.
    """
    rotor, nodes, masses = uneven(couple, eccentricity)
    expected = nonlinear(nodes, masses, SLOW, free=False)
    target = rotor.reduce(0) if route == "reduced" else on_route(rotor, route)
    # the mean over a turn leaves 1e-3 of a frequency out
    target = linear_model(target, supports=bearings(), axes="rotor")
    found = stability(target, [SLOW], accuracy=None)
    exponents = np.r_[found.exponents[0], found.exponents[0].conj()]
    modes = campbell(target, [SLOW], modes=6, accuracy=None)
    frequencies = (modes.growth + 1j * modes.frequencies_rotor)[0]
    for each in (exponents, frequencies):
        error = 1e-6 if route == "reduced" else 4e-4
        assert distance(each, expected) < error * np.abs(expected).max()


# ------------------------------------------------------------------ scenes and lists


def random_masses(seed: int) -> SolidRotor:
    """Return a disc on a shaft of 17 kg with three masses of up to 1 kg, mostly on one side."""
    rng, rotor = np.random.default_rng(seed), disc_rotor()
    for mass in rng.uniform(0.1, 1.0, 3):
        angle, z = rng.uniform(-1.0, 1.0), rng.uniform(-0.1, 0.6)
        place = [0.15 * np.cos(angle), 0.15 * np.sin(angle), z]
        rotor = rotor.add_point_mass(place, mass)
    return rotor


@cache
def eccentric(seed: int, count: int) -> ReducedRotor:
    """Return these in so many modes; made once."""
    return random_masses(seed).reduce(count)


@pytest.mark.parametrize("kind", ["table", "rotor frame", "tilts", "seal", "damper", "balls"])
@pytest.mark.parametrize(
    ("seed", "count", "base"), [(1, 0, None), (2, 4, BLOCK)], ids=["rigid", "on a block"]
)
def test_scenes_of_eccentric_rotors_have_the_exponents_of_their_lists(seed, count, kind, base):
    """Centres of mass 4 to 10 mm off the axis: they differed by up to 1e-3 of the speed.

    On dampers and balls by 2e-4, in proportion to the stiffness along the axis: under five times
    the weight the mean of loads in the scene was not that of the lever rule.
    """
    rotor = eccentric(seed, count)
    assert 0.004 < np.hypot(*rotor.center_of_mass[:2]) < 0.016
    in_scene, in_list = on_ends(rotor, KINDS[kind], base, free=base is not None)
    assert apart(in_scene, in_list, SPEED) < 1e-6


@pytest.mark.parametrize("free", [False, True], ids=["driven", "free"])
def test_loads_of_short_films_are_those_of_the_lever_rule(free):
    """Exponents differed by 3e-5 of the speed, and by 6e-7 of it by friction of a free spin."""
    in_scene, in_list = on_ends(eccentric(2, 4), short, free=free)
    assert apart(in_scene, in_list, SPEED) < 1e-6


@pytest.mark.parametrize("about", ["equilibrium", "given"])
def test_eccentric_rotors_with_a_free_translation_begin_in_the_middle(about):
    """Short films without load: the search began with journals where the centre of mass is.

    It found nothing; friction that tilted with the journal changed exponents by 1e-5 of the speed.
    """
    nothing = np.zeros(3)
    in_scene, in_list = on_ends(eccentric(1, 0), short, free=True, gravity=nothing, about=about)
    assert apart(in_scene, in_list, SPEED) < 1e-6


def test_films_in_which_journals_move_a_little_are_taken_at_rest():
    """Journals that move by 1e-5 of the clearance: exponents differed by 1e-8 of the speed."""
    film = replace(FILM, cavitation="none")

    def smooth(name, load):
        return [JournalBearing(interface=name, film=film, load=load)]

    in_scene, in_list = on_ends(eccentric(2, 4), smooth, gravity=0.02 * HEAVY)
    assert apart(in_scene, in_list, SPEED) < 1e-6


def test_saturating_magnets_are_taken_at_their_mean_place_and_current():
    """Journals move by ε = 2e-5 of the gap in a turn; exponents differed by 2e-9 of the speed.

    By up to 5e-5 with eight modes and three times the weight. The mean is off by the order of ε².
    """
    magnets = SaturatingActuator(constant=1e-5, bias_current=3.0, gap=4e-4, current_limit=12.0)

    def levitated(name, load):
        return [MagneticBearing(interface=name, load=load, actuator=magnets, controller=PD)]

    in_scene, in_list = on_ends(eccentric(2, 4), levitated)
    assert apart(in_scene, in_list, SPEED) < 1e-6


@pytest.mark.parametrize(("kind", "free"), [("table", False), ("tilts", True)])
def test_public_analyses_of_rigid_eccentric_rotors_are_alike(kind, free):
    models = on_ends(eccentric(2, 0), KINDS[kind], free=free, gravity=np.zeros(3))
    frequencies = [campbell(each, [SPEED], accuracy=None).frequencies_rotor for each in models]
    growths = [stability(each, [SPEED], accuracy=None).growth for each in models]
    for found, expected in (frequencies, growths):
        found, expected = (each[np.isfinite(each)] for each in (found, expected))
        assert np.abs(found[:, None] - expected).min(axis=1).max() < 1e-8 * SPEED
    orbits = [unbalance_response(each, [SPEED], accuracy=None) for each in models]
    for name in ENDS:
        np.testing.assert_allclose(*(each.semi_axes(name)[0] for each in orbits), rtol=1e-6)


@pytest.mark.parametrize("kind", ["table", "tilts"])
def test_unbalance_responses_of_elastic_eccentric_rotors_are_alike(kind):
    """Whirl that is not circular turned the free spin of a list against its drive, by its bending.

    Orbits differed by 2e-5. The tolerance is that of the harmonics, with a margin of 100.
    """
    models = on_ends(eccentric(2, 4), KINDS[kind], free=True, gravity=np.zeros(3))
    scene, listed = (
        unbalance_response(each, [SPEED], accuracy=None, tolerance=1e-10) for each in models
    )
    for name in ENDS:
        found, expected = (np.array(each.semi_axes(name)) for each in (scene, listed))
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-8 * expected.max())


def test_the_drive_of_steady_motions_is_no_load():
    """A torque on the mean rotation does not tilt: all routes have the same whirl."""
    rotor, *_ = uneven(0.2, 0.01)
    found = [
        unbalance_response(
            rotor.reduce(0) if route == "reduced" else on_route(rotor, route),
            [300.0], supports=bearings(), accuracy=None, frame="rotor",
        ).motion
        for route in ROUTES
    ]  # fmt: skip
    for other in found[1:]:  # elastic by 1e-4
        np.testing.assert_allclose(other, found[0], atol=4e-4 * np.abs(found[0]).max())
