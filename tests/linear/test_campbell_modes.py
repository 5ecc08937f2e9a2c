"""Eigenfrequencies over spin speed against closed forms and the full model."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg as la
import scipy.sparse as sp
from point_rotors import SKEW_AXIS, random_arrays

from exudyn_rotor import SolidRotor, Support, campbell

HERTZ = 2.0 * np.pi


def mass_on_springs(across: float, along: float, damping=None) -> SolidRotor:
    """Return 1 kg on the z axis with springs of these frequencies [Hz] across and along it."""
    stiffness = np.diag((HERTZ * np.array([across, across, along])) ** 2)
    return SolidRotor.from_matrices(np.eye(3), stiffness, [[0, 0, 0.1]], "z", damping)


@pytest.fixture(scope="module")
def rotor() -> SolidRotor:
    """Return a random rotor on springs, with damping."""
    arrays = random_arrays(21, node_count=4)
    arrays["stiffness"] = arrays["stiffness"] + 5.0 * sp.eye_array(12)
    damping = 0.02 * arrays["stiffness"]
    return SolidRotor.from_matrices(**arrays, axis=SKEW_AXIS, damping=damping)


@pytest.mark.parametrize("stiffening", ["none", "tilt"])  # the node is on the axis: K2 = 0
@pytest.mark.parametrize("full", [True, False])
def test_whirl_of_a_point_mass_on_isotropic_springs(full, stiffening):
    """A circular orbit with 100 Hz is seen with 100 ∓ 50 Hz from a frame that spins with 50 Hz."""
    rotor = mass_on_springs(100.0, 300.0)
    model = rotor if full else rotor.reduce(3)
    result = campbell(model, [0.0, HERTZ * 50.0], stiffening=stiffening)
    expected = [[100.0, 100.0, 300.0], [50.0, 150.0, 300.0]]
    np.testing.assert_allclose(result.frequencies_rotor / HERTZ, expected, rtol=1e-12)
    np.testing.assert_allclose(result.growth, 0.0, atol=1e-12 * HERTZ * 300)


def test_rotor_damping_makes_the_forward_whirl_unstable_above_the_critical_speed():
    """For ``z̈ + 2(δ + iΩ)ż + (ω₀² − Ω²)z = 0`` the roots are known; unstable from Ω = ω₀."""
    natural, decay = HERTZ * 100.0, 10.0
    rotor = mass_on_springs(100.0, 300.0, damping=2.0 * decay * np.eye(3))
    speeds = natural * np.array([0.5, 0.99, 1.01, 1.5])
    result = campbell(rotor, speeds)
    for speed, growth in zip(speeds, result.growth, strict=True):
        roots = np.roots([1.0, 2.0 * (decay + 1j * speed), natural**2 - speed**2])
        expected = np.sort([*roots.real, -decay])
        np.testing.assert_allclose(np.sort(growth), expected, rtol=0, atol=1e-10 * natural)
    np.testing.assert_array_equal(result.growth.max(axis=1) > 0, [False, False, True, True])


def test_at_rest_the_eigenfrequencies(rotor):
    undamped = replace(rotor, damping=None)
    squares = la.eigvalsh(rotor.stiffness.toarray(), rotor.mass.toarray())
    for model in (undamped, undamped.reduce(12)):
        result = campbell(model, 0.0)
        np.testing.assert_allclose(result.frequencies_rotor[0], np.sqrt(squares), rtol=1e-12)


@pytest.mark.parametrize("stiffening", ["none", "tilt"])
def test_reduced_with_all_modes_equals_full(rotor, stiffening):
    speeds = [0.0, 0.3, 1.0]
    full, reduced = (
        campbell(model, speeds, stiffening=stiffening) for model in (rotor, rotor.reduce(12))
    )
    np.testing.assert_allclose(
        reduced.frequencies_rotor, full.frequencies_rotor, rtol=0, atol=1e-12
    )
    np.testing.assert_allclose(reduced.growth, full.growth, rtol=0, atol=1e-12)


def test_softening_below_zero_shows_as_growth():
    """At twice its frequency a mass that can only move radially runs away with √(4−1) ω₀."""
    stiffness = np.diag((HERTZ * np.array([10.0, 1e4, 1e4])) ** 2)
    rotor = SolidRotor.from_matrices(np.eye(3), stiffness, [[0.0, 0.0, 0.1]], "z")
    result = campbell(rotor, HERTZ * 20.0)
    assert result.growth[0].max() / HERTZ == pytest.approx(10.0 * np.sqrt(3.0), rel=1e-4)
    assert result.frequencies_rotor.shape == (1, 3)


@pytest.mark.parametrize("speeds", [[], [np.nan], [1.0, np.inf], [[1.0, 2.0]]])
def test_wrong_speeds_are_refused(rotor, speeds):
    with pytest.raises(ValueError, match="speeds: needs"):
        campbell(rotor, speeds)


def test_unknown_stiffening_is_refused(rotor):
    with pytest.raises(ValueError, match="is unknown"):
        campbell(rotor, 1.0, stiffening="bend")


def test_progress_bar(rotor, capsys):
    campbell(rotor, [0.0, 1.0])
    assert capsys.readouterr().err == ""
    campbell(rotor, [0.0, 1.0], progress=True)
    assert "Campbell" in capsys.readouterr().err


@pytest.mark.parametrize("across", [(4e5, 4e5), (4e5, 3e5)])
def test_damping_ratios_of_undamped_motions_are_zero(across):
    """Rounding of real parts is no damping, neither by constant equations nor by Hill's."""
    point = SolidRotor.from_matrices(np.eye(3), np.zeros((3, 3)), [[0, 0, 0]], "z")
    point = point.with_interface("mass", [0])
    for damping, ratio in ((0.0, 0.0), (0.1, 0.05 / np.sqrt(4e5))):
        supports = [Support("mass", np.diag([*across, 4e5]), damping * np.eye(3))]
        result = campbell(point, [0.0, 50.0 * HERTZ, 400.0], supports=supports, frame="rotor")
        stiff = np.isclose(result.frequencies_inertial, np.sqrt(4e5))
        np.testing.assert_allclose(result.damping_ratio[stiff], ratio, rtol=1e-4, atol=0.0)
        assert np.any(result.log_decrement) == (damping > 0.0)
