"""Upright rotors: what rounding leaves of the weight across a skew axis is no load."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import SKEW_AXIS, free_stiffness

from exudyn_rotor import (
    JournalBearing,
    OilFilm,
    RollingBearing,
    ShortJournalBearing,
    SolidRotor,
    SpinAxis,
    Support,
    TiltingPadBearing,
    add_rotor,
    add_supports,
    grooved_pads,
    steady_state,
)
from exudyn_rotor.bearings.held_law import HeldBearing
from exudyn_rotor.theory.rotating_axes import axes_of

MASS, RADIUS, ARM, SPEED = 10.0, 0.1, 0.15, 300.0
CONTACT = {"balls": 7e9, "rollers": 5e8}  # N/m^1.5, N/m^(10/9)


def short(name):
    sizes = {"radius": 0.025, "length": 0.02, "clearance": 5e-5, "viscosity": 0.005}
    return ShortJournalBearing(interface=name, **sizes)


def grooved(name):
    pads = grooved_pads(1e-4, [0.3, 3.4], 0.3)
    film = OilFilm(radius=0.05, length=0.05, viscosity=0.02, pads=pads, nodes=24, axial_nodes=0)
    return JournalBearing(interface=name, film=film)


def tilting(name):
    gaps = np.radians([54.0, 126.0, 198.0, 270.0, 342.0])
    pads = grooved_pads(1e-4, gaps, np.radians(12.0), preload=0.5)
    film = OilFilm(radius=0.05, length=0.05, viscosity=0.02, pads=pads, nodes=20, axial_nodes=0)
    return TiltingPadBearing(interface=name, film=film, pad_inertia=1e-5)


def rolling(elements):
    """Return bearings without clearance: in the middle all elements just touch."""
    return lambda name: RollingBearing(
        interface=name,
        count=8,
        pitch_radius=0.0326,
        element_radius=0.006,
        stiffness=CONTACT[elements],
        clearance=0.0,
        damping=10.0,
        elements=elements,
    )


def rings(direction, heavy):
    """Return five masses on each of two rings with an unbalance [kg], and the axes (n1, n2, e)."""
    axes = axes_of(SpinAxis(direction))
    angle = 2.0 * np.pi * np.arange(5) / 5
    ring = RADIUS * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(5)])
    nodes = np.vstack([ring + np.array([0.0, 0.0, z]) for z in (-ARM, ARM)]) @ axes.T
    stiffness = free_stiffness(nodes, 1e8 * np.eye(30))
    rotor = SolidRotor.from_matrices(MASS / 10 * np.eye(30), stiffness, nodes, direction)
    rotor = rotor.add_point_mass(nodes[0], heavy) if heavy else rotor
    return rotor.with_interface("left", range(5)).with_interface("right", range(5, 10)), axes


def whirl(made, direction, heavy, angles=(0.0, 1.0, 2.5)):
    """Return the journal's motion along (n1, n2) in its steady motion, upright."""
    rotor, axes = rings(np.array(direction), heavy)
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(
        mbs, rotor.reduce(0), spin=SPEED, translation="none", gravity=-9.81 * axes[:, 2]
    )
    thrust = Support("left", np.diag([0.0, 0.0, 1e7]), np.diag([0.0, 0.0, 1e3]))
    add_supports(body, [made("left"), made("right"), thrust])
    mbs.Assemble()
    steady = steady_state(body)
    return np.array([steady.interface_motion("left", angle)[:2] for angle in angles])


@pytest.mark.parametrize("load", [1e-15, 1e-12, 1e-6])
def test_short_film_carries_the_slightest_load(load):
    """Near the centre F = (μ Ω R L³/c²) π ε/4 across the eccentricity."""
    bearing = short("left")
    stiff = 0.005 * SPEED * 0.025 * 0.02**3 / 5e-5**3 * np.pi / 4.0
    place = bearing.equilibrium(SPEED, [0.0, -load])
    # the radial force is smaller by 4 ε/π; the search for ε ends at 1e-15
    near = 4.0 / np.pi * load / (stiff * 5e-5)
    assert place == pytest.approx([load / stiff, 0.0], rel=1e-9, abs=(2e-15 + near**2) * 5e-5)


@pytest.mark.parametrize("made", [short, grooved, tilting])
def test_balanced_upright_rotor_stays_in_the_middle_of_its_films(made):
    # the clearances are 1e-4 m and 5e-5 m, and the rounding of loads is 1e-16 of the weight
    assert np.abs(whirl(made, SKEW_AXIS, 0.0)).max() < 1e-12


def test_elements_that_touch_by_rounding_have_no_stiffness():
    """1e-17 m of depth, what rounding leaves of positions of 0.1 m, are 1e7 N/m of a roller."""
    law = HeldBearing.of(rolling("rollers")("left")).laws[0]
    law.hold(True)
    law.law(1e-17, 0.0, 0.0, 0.0, 0.0, 0.0)
    assert law.law(1e-6, 0.0, 0.0, 0.0, 0.0, 0.0) == pytest.approx((0.0, 0.0), abs=1e-9)
