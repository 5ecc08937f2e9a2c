"""A published dual spool on unequal bearings, of the same beams here and in ROSS.

M. I. Friswell, J. E. T. Penny, S. D. Garvey, A. W. Lees, Dynamics of Rotating Machines, Cambridge
2010, Example 6.6.1; ROSS's results by validation/references/rotor_trains_ross.py.
"""

from functools import cache

import numpy as np
import pytest
from beam_models import BeamRotor
from spool_models import ROSS
from train_models import lateral

from exudyn_rotor import Link, RotorTrain, Support, campbell, linear_model, stability

DATA = ROSS["published"]
SPEEDS = np.pi / 30.0 * np.array(DATA["rpm"])


@cache
def dual_spool() -> RotorTrain:
    """Return both spools of beams."""
    rotors, supports = {}, {}
    for name, one in DATA["rotors"].items():
        discs = tuple(map(tuple, one["discs"]))
        size = one["bore"], one["diameter"], DATA["material"]
        rotors[name] = BeamRotor(tuple(one["stations"]), *size, discs).reduced()
        supports[name] = [
            Support(str(at), np.diag([kx, ky]), np.diag([cx, cy]))
            for at, kx, ky, cx, cy in one["bearings"]
        ]
    between = DATA["between"]
    first, second = (str(between[name]) for name in rotors)
    spring = Support(first, between["stiffness"], between["damping"])
    links = [Link(f"inner:{first}", f"outer:{second}", spring)]
    origins = dict.fromkeys(rotors, np.zeros(3))
    return RotorTrain(rotors, DATA["ratios"], supports, links, positions=origins)


def test_beams_turn_without_a_mesh_to_average():
    assert max(linear_model(dual_spool()).unevenness.values()) < 1e-12


def test_exponents_are_those_of_ross():
    """The same elements: to the rounding of the eigenvalues."""
    found = campbell(dual_spool(), SPEEDS, accuracy=None)
    for row, reference in enumerate(DATA["exponents"]):
        values = lateral(found, row)[: len(reference["frequencies"])]
        np.testing.assert_allclose(values.imag, reference["frequencies"], rtol=1e-9)
        np.testing.assert_allclose(values.real, reference["growth"], rtol=1e-5)


@pytest.mark.parametrize("method", ["auto", "hill"])
def test_exponents_in_turning_axes_are_those_of_ross(method):
    """By constant equations at rest, and by Hill's method: but for multiples of iΩ."""
    speed = SPEEDS[2]
    found = stability(dual_spool(), [speed], accuracy=None, method=method).exponents[0]
    copies = found + 1j * speed * np.arange(-4, 5)[:, None]
    reference = DATA["exponents"][2]
    exact = np.array(reference["growth"]) + 1j * np.array(reference["frequencies"])
    assert np.abs(copies.ravel() - exact[:, None]).min(axis=1).max() < 1e-6
