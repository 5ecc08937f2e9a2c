"""The references of the benchmarks: against each other, and the table that is printed."""

import json

import numpy as np
import pytest

from validation.references import benchmarks
from validation.references.benchmark_rotors import Jeffcott, parametric_growth

DATA = json.loads(benchmarks.REFERENCE.read_text())


def test_published_critical_speeds_are_those_of_the_same_beams():
    """Nelson and McVaugh's from few coordinates, ROSS's without shear: two codes, one rotor."""
    rotor = DATA["nelson mcvaugh"]
    np.testing.assert_allclose(rotor["rayleigh"][:2], rotor["published"][:2], rtol=5e-4)
    np.testing.assert_allclose(rotor["rayleigh"], rotor["published"], rtol=1.5e-2)
    assert np.all(np.array(rotor["timoshenko"]) < rotor["rayleigh"])
    assert np.all(np.array(rotor["cones"]) < rotor["timoshenko"])


def test_growth_of_an_asymmetric_shaft_on_equal_rigid_bearings():
    """Zero at ``√(k/m)`` of each direction; between them the root of the constant equations."""
    rotor = Jeffcott((0.024, 0.02), 60.0)
    edges = rotor.frequencies
    bearing = (1e14, 1e14)
    for edge in edges:
        assert abs(parametric_growth(rotor, bearing, 0.0, edge)) < 1e-3
    speed = edges.mean()
    a, b = (rotor.stiffness / rotor.moving_mass).tolist()
    mean, n = 0.5 * (a + b), speed**2
    exact = np.sqrt(-(mean + n) + np.sqrt((mean + n) ** 2 - (a - n) * (b - n)))
    found = parametric_growth(rotor, bearing, 0.0, speed)
    assert found == pytest.approx(exact, rel=1e-6)


def test_seal_of_the_reference_drives_the_first_forward_mode():
    """``q = c ω``, less what the bearings' motion takes: within the effective mode shape."""
    first = DATA["frequencies"][1][1]
    assert DATA["threshold"][0] == pytest.approx(DATA["seal"]["damping"] * first, rel=0.05)


def test_rows_are_printed_with_their_deviation():
    row = benchmarks.Row("frequency", 100.0, 101.0, "mesh")
    text = benchmarks.table("rigid_rotor", [row])
    assert "1.0e-02  mesh" in text
    assert text.startswith("rigid_rotor: ``I_t")
