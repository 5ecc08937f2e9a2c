"""Overdamped, free and split modes, and signed frequencies of whirl."""

import numpy as np
import pytest
from bodies import SHAFT, rings
from models import disc_rotor, disc_with_craig_bampton_modes

from exudyn_rotor import ShortJournalBearing, SolidRotor, Support, bearing_loads, campbell
from exudyn_rotor.reduction.craig_bampton import craig_bampton_modes


def test_overdamped_motions_stand_behind_the_others():
    """Two masses, one of them overdamped across the axis: λ = −5 ± √24 times 100."""
    rotor = SolidRotor.from_matrices(
        np.eye(6), np.zeros((6, 6)), [[0, 0, 0], [0, 0, 1.0]], "z",
        interfaces={"damped": [0], "free": [1]},
    )  # fmt: skip
    supports = [
        Support("damped", 1e4 * np.eye(3), 1e3 * np.eye(3)),
        Support("free", 4e4 * np.eye(3)),
    ]
    result = campbell(rotor, [0.0, 50.0], supports=supports)
    np.testing.assert_allclose(result.frequencies_inertial[:, :3], 200.0, rtol=1e-9)
    np.testing.assert_array_equal(result.frequencies_inertial[:, 3:], 0.0)
    slow = 100.0 * (np.sqrt(24.0) - 5.0)
    np.testing.assert_allclose(result.growth[0, 3:], slow, rtol=1e-6)
    np.testing.assert_allclose(result.growth[1, 3:], slow, rtol=1e-6)
    assert np.all(result.damping_ratio[:, 3:] == 1.0)
    assert [sorted(row) for row in result.whirl[:, 3:]] == [["axial"] + 2 * ["overdamped"]] * 2
    assert np.all(result.continued)
    few = campbell(rotor, [0.0, 50.0], supports=supports, modes=3)
    np.testing.assert_allclose(few.frequencies_inertial, 200.0, rtol=1e-9)


@pytest.mark.parametrize("stiffness", [1e6, np.diag([1e6, 2e6, 0.0])], ids=["even", "uneven"])
def test_free_motions_keep_their_names(stiffness):
    """Lateral springs alone leave the spin and the axial motion free, at rest and at speed."""
    rotor = rings(SHAFT).reduce(2)
    support = Support("all", stiffness, 10.0, 1e4)
    result = campbell(rotor, [0.0, 30.0, 50.0, 90.0], supports=[support])
    for row, words in enumerate(result.whirl):
        free = words[result.frequencies_inertial[row] == 0.0]
        assert sorted(free) == ["axial", "torsional"]


def test_motions_of_a_free_rotor_have_no_damping():
    rotor = disc_rotor()
    reduced = rotor.reduce(craig_bampton_modes(rotor, 2, coupling="RBE3"))
    result = campbell(reduced, [0.0, 100.0, 600.0], accuracy=None)
    free = result.frequencies_inertial == 0.0
    assert np.count_nonzero(free, axis=1).tolist() == [6, 5, 5]
    assert not np.any(result.growth[free])
    assert not np.any(result.damping_ratio[free])
    assert not np.any(result.log_decrement[free])


@pytest.mark.filterwarnings("ignore:the harmonics")  # of decays alone
def test_what_ends_within_a_fraction_of_a_revolution_stands_behind_oscillations():
    """A mesh in films has periodic equations, which give decays of 1e6 1/s multiples of Ω."""
    reduced = disc_with_craig_bampton_modes()
    ends = list(reduced.interfaces)
    size = {"radius": 0.015, "length": 0.015, "clearance": 4e-5, "viscosity": 0.02}
    loads = bearing_loads(reduced, ends, [0.0, -9.81, 0.0])
    films = [
        ShortJournalBearing(interface=end, load=load, **size)
        for end, load in zip(ends, loads, strict=True)
    ]
    result = campbell(reduced, [300.0], supports=films, modes=7, accuracy=None)
    assert np.all(result.growth > -1e4)
