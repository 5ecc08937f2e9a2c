"""A warning where the number of modes cuts a pair in two, and none elsewhere."""

import warnings

import ngsolve
import numpy as np
import pytest
from models import STEEL, disc_rotor
from netgen.occ import Cylinder, Dir, OCCGeometry, Pnt

from exudyn_rotor import SolidRotor, Support, craig_bampton_modes, free_modes, static_response
from exudyn_rotor.theory.axis import rotations, translations

CUT = "one of a pair"


def cut(make, numbers):
    """Return the numbers of modes that cut a pair in two."""
    found = []
    for number in numbers:
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            make(number)
        if any(CUT in str(one.message) for one in told):
            found.append(number)
    return found


def rod(axis):
    """Return a round steel rod of 0.4 m × 0.08 m about an axis in any direction."""
    direction = np.asarray(axis) / np.linalg.norm(axis)
    start = Pnt(*(-0.2 * direction))
    solid = Cylinder(start, Dir(*direction), 0.04, 0.4)
    mesh = ngsolve.Mesh(OCCGeometry(solid).GenerateMesh(maxh=0.06, curvaturesafety=1.0))
    return SolidRotor.from_ngsolve(mesh, STEEL, axis)


@pytest.mark.parametrize("axis", [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [2.0, -1.0, 2.0]])
def test_pairs_of_a_rod(axis):
    """Bending twice, torsion at √(G/ρ)/2l, bending, the axis at about √(E/ρ)/2l; all in pairs."""
    rotor = rod(axis)
    hertz = free_modes(rotor, 6).frequencies / (2.0 * np.pi)
    torsion = np.sqrt(2.1e11 / 2.6 / 7850.0) / 0.8
    single = np.abs(hertz / torsion - 1.0) < 0.02
    assert single.sum() == 1
    bending = np.flatnonzero(~single)
    expected = [int(bending[0]) + 1, int(bending[2]) + 1]
    assert cut(lambda number: free_modes(rotor, number), range(1, 6)) == expected


def test_pairs_of_a_disc_on_a_shaft_on_held_interfaces():
    """With rigid interfaces, and with mean motions, pairs are neighbours of one frequency."""
    rotor = disc_rotor()
    for coupling in ("RBE2", "RBE3"):
        modes = craig_bampton_modes(rotor, 6, coupling=coupling)
        values = modes.frequencies[-6:]
        ends = [i + 1 for i in range(5) if values[i + 1] < 1.03 * values[i]]
        found = cut(
            lambda number, c=coupling: craig_bampton_modes(rotor, number, coupling=c), range(1, 4)
        )
        assert found
        assert set(found) <= set(ends)


@pytest.mark.parametrize(
    ("hertz", "expected"),
    [
        ([10.0, 10.03, 10.13, 10.15, 14.0, 16.0], [1, 3]),  # pairs that are nearly alike
        ([8.0, 10.0, 10.03, 10.13, 10.15, 16.0], [2, 4]),
        ([8.0, 10.0, 10.02, 10.13, 12.0, 12.01], [2, 5]),  # beside a mode without a pair
    ],
)
def test_of_near_neighbours_the_nearest_is_the_pair(hertz, expected):
    nodes = np.array([[0.0, 0, 0], [1.0, 0, 0], [0.0, 1, 0], [0.0, 0, 1]])
    rigid = np.hstack([translations(4), rotations(nodes, nodes[0])])
    flexible = np.linalg.svd(rigid)[0][:, 6:]
    stiffness = flexible @ np.diag((2.0 * np.pi * np.array(hertz)) ** 2) @ flexible.T
    rotor = SolidRotor.from_matrices(np.eye(12), stiffness, nodes, "z")
    assert cut(lambda number: free_modes(rotor, number), range(1, 6)) == expected


def test_reduce_says_what_to_do(monkeypatch):
    with pytest.warns(UserWarning, match=r"^mode 1 .* ask for 2 modes, .* by rotor\.reduce\(2\)"):
        disc_rotor().reduce(1)
    monkeypatch.setattr("exudyn_rotor.reduction.reduce._FREE_MODES", 1)
    with warnings.catch_warnings():  # beside static modes nobody asked for one of a pair
        warnings.simplefilter("error")
        pins = [Support(name, 1e9) for name in ("left", "right")]
        static_response(disc_rotor(), {"left": [1.0, 0.0, 0.0]}, supports=pins, speed=100.0)
