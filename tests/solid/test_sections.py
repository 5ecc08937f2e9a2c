"""Interfaces by position, rigid discs, clamps in some directions, summary and curved meshes."""

import itertools
from functools import cache

import ngsolve as ngs
import numpy as np
import pytest
from models import ALUMINIUM, STEEL, two_material_cylinder
from netgen.occ import Cylinder, Glue, OCCGeometry, Pnt, Z

from exudyn_rotor import SolidRotor, Support, campbell

HARD = {"youngsModulus": 2.1e15, "poissonsRatio": 0.3, "density": 7850.0}
RADIUS, LENGTH = 0.02, 0.4
BAND = 0.25, 0.04  # of the disc
OUTER = 0.1  # radius of the disc


@cache
def shaft(with_disc: bool = False) -> SolidRotor:
    """Return a shaft along z that is cut at the band, alone or with a meshed stiff disc there."""
    low, high = BAND[0] - 0.5 * BAND[1], BAND[0] + 0.5 * BAND[1]
    cuts = [0.0, low, high, LENGTH]
    parts = [Cylinder(Pnt(0, 0, a), Z, RADIUS, b - a) for a, b in itertools.pairwise(cuts)]
    for part in parts:
        part.mat("steel")
    parts[0].faces.Min(Z).name, parts[-1].faces.Max(Z).name = "left", "right"
    if with_disc:
        wheel = Cylinder(Pnt(0, 0, low), Z, OUTER, BAND[1])
        parts.append((wheel - Cylinder(Pnt(0, 0, low), Z, RADIUS, BAND[1])).mat("hard"))
    mesh = ngs.Mesh(OCCGeometry(Glue(parts)).GenerateMesh(maxh=0.05, curvaturesafety=1.5))
    materials = {"steel": STEEL, "hard": HARD} if with_disc else STEEL
    rotor = SolidRotor.from_ngsolve(mesh, materials, "z", check_units=False)
    return rotor.center_interfaces()


def wheel() -> tuple[float, tuple[float, float]]:
    """Return mass and moments of inertia of the meshed disc."""
    mass = STEEL["density"] * np.pi * (OUTER**2 - RADIUS**2) * BAND[1]
    polar = 0.5 * mass * (OUTER**2 + RADIUS**2)
    return mass, (polar, 0.5 * polar + mass * BAND[1] ** 2 / 12.0)


@pytest.mark.parametrize(
    ("call", "arguments", "words"),
    [
        ("interface_at", ("left", 0.2, 0.1), "exists already"),
        ("interface_at", ("seat", 0.2, 0.0), "width"),
        ("interface_at", ("seat", 0.9, 0.1), "position, width: no node of the outer .* 0 to 0.4"),
        ("interface_at", ("seat", np.nan, 0.1), "position"),
        ("add_point_mass", ([1.5 * RADIUS, 0.0, 0.25], 0.005), "0.01 m from the next node; a w"),
        ("add_point_mass", ([0.0, 0.0, LENGTH + 0.02], 0.005), "position: needs a place on the m"),
        ("add_point_mass", ([1e3 * RADIUS, 0.0, 1e3 * LENGTH], 0.005), "position: needs a place"),
    ],
)
def test_places_beside_the_rotor_are_refused(call, arguments, words):
    with pytest.raises(ValueError, match=words):
        getattr(shaft(), call)(*arguments)


def test_disc_adds_its_mass_and_moments():
    """Second moments of the rigid rotor: those of the shaft, and ``E + m c cᵀ`` of the disc."""
    mass, inertia = 5.0, np.diag([0.03, 0.03, 0.05])
    bare = shaft()
    rotor = bare.add_disc(BAND[0], mass, (0.05, 0.03), BAND[1], name="seat")

    def moments(solid):
        return solid.nodes.T @ (solid.mass[::3, ::3] @ solid.nodes)

    center = np.array([0.0, 0.0, BAND[0]])
    expected = 0.5 * np.trace(inertia) * np.eye(3) - inertia + mass * np.outer(center, center)
    np.testing.assert_allclose(moments(rotor) - moments(bare), expected, atol=1e-12)
    np.testing.assert_allclose(rotor.total_mass - bare.total_mass, mass, rtol=1e-12)
    assert rotor.rigid_motions == 6
    assert rotor.discs[0].nodes.tolist() == rotor.interfaces["seat"].nodes.tolist()


@pytest.fixture(scope="module")
def rigid_and_meshed():
    mass, inertia = wheel()
    rotors = shaft().add_disc(BAND[0], mass, inertia, BAND[1]), shaft(with_disc=True)
    return [rotor.reduce(8, prestress=True) for rotor in rotors]


@pytest.mark.parametrize("level", ["tilt", "full"])
def test_disc_whirls_as_a_meshed_stiff_one(rigid_and_meshed, level):
    """Both levels of stiffening, up to 1.5 times the first frequency.

    The meshed disc stiffens the shaft's section from its surface inwards as the rigid one does;
    1e-3 is what other meshes of the same shaft differ by.
    """
    supports = [Support(name, 1e8) for name in ("left", "right")]
    found = []
    for reduced in rigid_and_meshed:
        result = campbell(reduced, [0.0, 1500.0], supports=supports, stiffening=level)
        lateral = np.isin(result.whirl, ("forward", "backward", "mixed"))
        rows = zip(result.frequencies_inertial, lateral, strict=True)
        found.append([np.sort(values[chosen])[:4] for values, chosen in rows])
    np.testing.assert_allclose(found[0], found[1], rtol=2e-3)
    # the gyroscopic split of the second pair is well above that
    assert found[0][1][3] / found[0][1][2] > 1.3


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"mass": 0.0}, "mass"),
        ({"inertia": (0.3, 0.1)}, "polar ≤ 2 × transverse"),
        ({"inertia": (0.1, -0.1)}, "above zero"),
        ({"inertia": 0.1 * np.eye(3)}, "inertia: needs the polar and the transverse moment"),
        ({"width": 0.001}, "on one line"),
        ({"name": "left"}, "exists already"),
        ({"position": 0.3}, "shares nodes with another disc; add one disc"),
    ],
)
def test_impossible_discs_are_refused(change, words):
    given = {"position": 0.15, "mass": 1.0, "inertia": (0.02, 0.02), "width": 0.06, **change}
    with pytest.raises(ValueError, match=words):
        shaft().add_disc(0.3, 1.0, (0.02, 0.02), 0.06).add_disc(**given)


def test_summary_names_materials_and_discs():
    mesh = two_material_cylinder()
    materials = {"steel": STEEL, "aluminium": ALUMINIUM}
    rotor = SolidRotor.from_ngsolve(mesh, materials, "z").add_disc(0.2, 3.0, (0.02, 0.01), 0.12)
    text = rotor.summary()
    assert "steel: 73.97" in text  # π 0.1² 0.3 · 7850 = 73.98 kg
    assert "aluminium: 8.48" in text
    assert "E 7e+10 Pa, ν 0.33, ρ 2700 kg/m³" in text
    assert "rigid disc       3 kg at [0, 0, 0.2] m, polar 0.02, transverse 0.01 kg m²" in text
