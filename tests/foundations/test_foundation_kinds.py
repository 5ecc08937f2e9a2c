"""Foundations by modes and solids are the blocks that they stand for; refusals."""

from dataclasses import replace

import ngsolve
import numpy as np
import pytest
import scipy.linalg
from apart import distance, exponents
from netgen.occ import Box, OCCGeometry, Pnt, Y, Z
from test_foundations import BLOCK, HELD, POINTS, SPEED
from test_supports_in_scenes import KINDS, rings

from exudyn_rotor import Foundation, Mount, SolidRotor, linear_model


def test_modes_of_a_block_are_the_block():
    values, T = scipy.linalg.eigh(BLOCK.stiffness, BLOCK.mass)
    mass = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    shapes = {name: motion @ T * np.sqrt(mass) for name, motion in BLOCK.points.items()}
    even = BLOCK.with_damping_ratio(0.02)
    modes = Foundation.from_modes(np.sqrt(values), 0.02, shapes, masses=mass)
    rotor, supports = rings(), [KINDS["3 x 3"], HELD]
    found, expected = (
        linear_model(rotor, supports=supports, foundation=each) for each in (modes, even)
    )
    assert distance(found, expected, SPEED) < 1e-8


def test_a_stiff_solid_is_a_rigid_block():
    """A meshed box on mounts becomes the rigid one as its elasticity grows: errors with 1/E."""
    solid = Box(Pnt(-0.1, -0.3, -0.2), Pnt(0.1, -0.1, 0.2))
    for name, face in (("left", solid.faces.Min(Z)), ("right", solid.faces.Max(Z))):
        face.name = name
    solid.faces.Min(Y).name = "floor"
    mesh = ngsolve.Mesh(OCCGeometry(solid).GenerateMesh(maxh=0.3))
    places = {"left": [0.0, -0.2, -0.2], "right": [0.0, -0.2, 0.2], "floor": [0.0, -0.3, 0.0]}
    springs = [4e6, 3e6, 2e6], 100.0
    mass = 7850.0 * 0.2 * 0.2 * 0.4
    across = mass / 12.0 * (0.2**2 + 0.4**2)
    inertia = [across, across, mass / 12.0 * (2 * 0.2**2)]
    mounts = [Mount(place, *springs) for place in places.values()]
    block = Foundation.rigid(mass, inertia, [0.0, -0.2, 0.0], mounts, POINTS)
    rotor, supports = rings(), [KINDS["3 x 3"], HELD]
    expected = exponents(linear_model(rotor, supports=supports, foundation=block), 0.0)
    errors = []
    for modulus in (2e13, 2e14):
        steel = {"youngsModulus": modulus, "poissonsRatio": 0.3, "density": 7850.0}
        box = SolidRotor.from_ngsolve(mesh, steel, axis="z", check_units=False)
        named = [Mount(name, *springs) for name in places]
        elastic = Foundation.from_solid(box, POINTS, mounts=named, modes=0)
        found = linear_model(rotor, supports=supports, foundation=elastic)
        apart = np.abs(exponents(found, 0.0)[:, None] - expected).min(axis=0)
        errors.append((apart / np.abs(expected).max()).max())
    assert errors[1] < 1e-4
    assert errors[0] / errors[1] == pytest.approx(10.0, rel=0.05)


def test_bad_foundations_are_refused():
    unit, points = np.eye(2), {"left": np.ones((3, 2))}
    for error, match, arguments in (
        (ValueError, "mass: needs a symmetric", ([[1.0, 2.0], [0.0, 1.0]], unit, unit, points)),
        (ValueError, "mass: needs a positive definite", (0.0 * unit, unit, unit, points)),
        (ValueError, "mass: needs one coordinate or more", (unit[:0, :0], unit, unit, points)),
        (ValueError, "stiffness: needs a symmetric", (unit, unit, [[1.0, 2.0], [0, 1]], points)),
        (ValueError, "the ground holds every", (unit, unit, np.diag([1.0, 0.0]), points)),
        (ValueError, "the ground holds every", (unit, unit, np.ones((2, 2)), points)),
        (ValueError, "damping: needs a matrix ≥ 0", (unit, -unit, unit, points)),
        (ValueError, "damping: needs", (unit, np.eye(3), unit, points)),
        (ValueError, r"needs an array of shape \(6, 2\)", (unit, unit, unit, {"left": unit})),
        (ValueError, "points: needs the motion", (unit, unit, unit, {})),
        (ValueError, "places: 'top' is none", (unit, unit, unit, points, {"top": [0, 0, 0]})),
        (ValueError, "participation: needs", (unit, unit, unit, points, {}, unit)),
    ):  # fmt: skip
        with pytest.raises(error, match=match):
            Foundation(*arguments)
    one, holed = {"left": np.eye(3)[:, :1]}, replace(rings(), interfaces={})
    for call, match in (
        (lambda: Foundation.from_modes([-1.0], 0.01, one), "frequencies: needs a finite number"),
        (lambda: Foundation.from_modes([1.0], 2.0, one), "damping_ratios: needs .* ≥ 0 and ≤ 1"),
        (lambda: Foundation.from_modes([1.0], 0.0, one, masses=[[1.0], 2.0]), "masses: needs"),
        (lambda: Mount("left", -1.0), "stiffness: needs a finite number"),
        (lambda: Foundation.from_solid(holed, POINTS), "points: 'left' is unknown; there are"),
        (lambda: Foundation.from_solid(rings().with_damping(loss=0.1), POINTS), "is for steady"),
        (lambda: Foundation.rigid(1.0, [1] * 3, [0] * 3, [Mount("left", 1.0)], {}), "needs places"),
        (lambda: Foundation(unit, unit, unit, points).motion("top", [0] * 3), "only for: left"),
    ):
        with pytest.raises((TypeError, ValueError), match=match):
            call()
