"""A published dual spool on unequal bearings, of the same beams here and in ROSS.

M. I. Friswell, J. E. T. Penny, S. D. Garvey, A. W. Lees, Dynamics of Rotating Machines, Cambridge
2010, Example 6.6.1; ROSS's results by validation/references/rotor_trains_ross.py.
"""

from functools import cache

import numpy as np
from beam_models import BeamRotor
from spool_models import ROSS
from train_models import lateral

from exudyn_rotor import GearMesh, Link, ReducedRotor, RotorTrain, Support, campbell, linear_model

DATA = ROSS["published"]
SPEEDS = np.pi / 30.0 * np.array(DATA["rpm"])


PLACES = [f"{name}:{DATA['between'][name]}" for name in DATA["rotors"]]


@cache
def spools() -> dict[str, ReducedRotor]:
    """Return both spools of beams."""
    rotors = {}
    for name, one in DATA["rotors"].items():
        discs = tuple(map(tuple, one["discs"]))
        size = one["bore"], one["diameter"], DATA["material"]
        rotors[name] = BeamRotor(tuple(one["stations"]), *size, discs).reduced()
    return rotors


def supports(axial: float) -> dict[str, list[Support]]:
    """Return the bearings, those at the first station with a stiffness along the axis."""
    return {
        name: [
            Support(str(at), np.diag([kx, ky, axial * (at == 0)]), np.diag([cx, cy, 0.0]))
            for at, kx, ky, cx, cy in one["bearings"]
        ]
        for name, one in DATA["rotors"].items()
    }


def dual_spool() -> RotorTrain:
    """Return one spool on the other."""
    between = DATA["between"]
    spring = Support(str(between["inner"]), between["stiffness"], between["damping"])
    return RotorTrain(spools(), DATA["ratios"], supports(0.0), [Link(*PLACES, spring)])


def geared_spools() -> RotorTrain:
    """Return them side by side, with the gears of the other reference."""
    gears, (first, second) = ROSS["geared"], ROSS["geared"]["teeth"]
    given = {name: gears[name] for name in ("stiffness", "pressure_angle", "line_angle")}
    links = [Link(*PLACES, GearMesh(radii=gears["base_radii"], **given))]
    ratios = {"inner": 1.0, "outer": -first / second}
    return RotorTrain(spools(), ratios, supports(DATA["axial"]), links)


def test_beams_turn_without_a_mesh_to_average():
    assert linear_model(dual_spool()).unevenness < 1e-9  # rounding of 96 coordinates


def test_exponents_are_those_of_ross():
    """The same elements: to the rounding of the eigenvalues."""
    found = campbell(dual_spool(), SPEEDS, accuracy=None)
    for row, reference in enumerate(DATA["exponents"]):
        values = lateral(found, row)[: len(reference["frequencies"])]
        np.testing.assert_allclose(values.imag, reference["frequencies"], rtol=1e-8)
        np.testing.assert_allclose(values.real, reference["growth"], rtol=1e-5)


def test_geared_beams_are_those_of_ross():
    """Bending, torsion and stretch of both, on unequal bearings, with ``MultiRotor``."""
    found = campbell(geared_spools(), SPEEDS, accuracy=None)
    for row, reference in enumerate(DATA["geared"]):
        values = found.growth[row] + 1j * found.frequencies_inertial[row]
        values = values[values.imag > 1.0]
        values = values[np.argsort(values.imag)][: len(reference["frequencies"])]
        np.testing.assert_allclose(values.imag, reference["frequencies"], rtol=1e-8)
        np.testing.assert_allclose(values.real, reference["growth"], atol=1e-6)
