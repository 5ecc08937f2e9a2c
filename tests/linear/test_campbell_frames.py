"""Campbell diagrams in both frames: closed forms, whirl, tracking, periodic and full models."""

import numpy as np
import pytest
from bodies import BODIES, moments, point_mass, rings
from models import two_masses
from point_rotors import random_rotor

from exudyn_rotor import SolidRotor, campbell
from exudyn_rotor.bearings.support import Support

HERTZ = 2.0 * np.pi
# ------------------------------------------------------------------ closed forms


@pytest.mark.parametrize("modes", [None, 6])
def test_whole_diagram_of_appendix_b(modes):
    """Fig. 2: ``(k_y − Ω² − ν²)(k_z − Ω² − ν²) = 4Ω²ν²`` for each unit mass, axial ones apart."""
    data = two_masses()
    rotor = SolidRotor.from_matrices(data["mass"], data["stiffness"], data["nodes"], "x")
    speeds = np.linspace(0.0, 1800.0, 37)
    result = campbell(rotor if modes is None else rotor.reduce(modes), speeds)
    ky, kz = 196e4, 100e4
    half = 0.5 * (ky + kz) + speeds**2
    root = np.sqrt(half**2 - (ky - speeds**2) * (kz - speeds**2))
    squares = np.array([half - root, half + root])
    axial = np.full((2, 37), 1e4) * np.array([[144.0], [400.0]])  # (125)
    squares = np.sort(np.vstack([squares, squares, axial]).T, axis=1)
    eigenvalues = result.growth + 1j * result.frequencies_rotor
    found = np.sort(-(eigenvalues**2).real, axis=1)
    # between 1000 and 1400 rad/s one ν² of each mass is negative: growth
    np.testing.assert_allclose(found, squares, rtol=0, atol=1e-12 * squares.max())
    grows = np.any(result.growth > 1.0, axis=1)
    np.testing.assert_array_equal(grows, (speeds > 1000.0) & (speeds < 1400.0))


@pytest.mark.parametrize("reduced", [True, False])
def test_point_mass_in_both_frames(reduced):
    """100 Hz in the inertial frame are 50 and 150 Hz from a frame that spins with 50 Hz."""
    rotor = point_mass()
    support = Support("at", (HERTZ * 100.0) ** 2 * np.eye(3))
    model = rotor.reduce(0) if reduced else rotor
    speeds = HERTZ * np.array([0.0, 50.0, 130.0])
    result = campbell(model, speeds, supports=[support], frame="rotor")
    np.testing.assert_allclose(
        result.frequencies_rotor / HERTZ, [[100] * 3, [50, 100, 150], [30, 100, 230]], rtol=1e-12
    )
    np.testing.assert_allclose(result.frequencies_inertial / HERTZ, 100.0, rtol=1e-12)
    words = ["forward", "axial", "backward"]
    assert result.whirl[1:].tolist() == [words, words]
    assert sorted(result.whirl[0]) == sorted(words)  # the repeated mode parts into circles
    assert result.nodal_diameters[1:].tolist() == [[1, 0, 1]] * 2
    assert result.free_motions == ()


@BODIES
def test_conical_modes_of_a_stiff_rotor_and_the_papers_terms(shape):
    """Elasticity adds about (ω/ω_elastic)² = 1e-7 with ω_elastic = 9e3 rad/s."""
    polar, transverse = moments(shape)
    speed, k = 3.0, 9.0 * transverse
    supports = [Support("all", 1e4 * np.eye(3), tilt_stiffness=np.diag([k, k, 1e5]))]
    exact = np.abs(np.roots([-transverse, polar * speed, k]))
    found = {}
    for level in ("tilt", "none"):
        result = campbell(rings(shape), speed, supports=supports, stiffening=level, modes=8)
        inertial = result.frequencies_inertial[0]
        found[level] = [np.abs(inertial / value - 1.0).min() for value in exact]
    assert max(found["tilt"]) < 1e-6
    assert min(found["none"]) > 1e-2


# ------------------------------------------------------------------ zero and repeated modes


@pytest.mark.filterwarnings("ignore:the centre of mass is")
def test_free_rotor_keeps_all_rigid_modes_and_names_them():
    rotor = random_rotor(31)
    result = campbell(rotor.reduce(3), [0.0, 5.0])
    names = ("translation 1", "translation 2", "translation along axis", "spin", "tilt 1", "tilt 2")
    assert result.free_motions == names
    assert campbell(rotor, 0.0).free_motions == names
    np.testing.assert_array_equal(result.frequencies_rotor[0, :6], 0.0)
    assert result.growth.shape == (2, 9)


def test_damping_is_that_of_the_inertial_frequency():
    """A damper that stands still: λ = −ζω ± iω√(1 − ζ²) in the inertial frame at every speed."""
    omega, ratio = 100.0, 0.05
    support = Support("at", omega**2 * np.eye(3), 2.0 * ratio * omega * np.eye(3))
    result = campbell(point_mass(), [0.0, 60.0, 150.0], supports=[support])
    np.testing.assert_allclose(result.damping_ratio, ratio, rtol=1e-10)
    expected = 2.0 * np.pi * ratio / np.sqrt(1.0 - ratio**2)
    np.testing.assert_allclose(result.log_decrement, expected, rtol=1e-10)


# ------------------------------------------------------------------ periodic systems


def test_anisotropic_support_of_a_point_mass():
    """In the inertial frame the two directions are apart: √k_1, √k_2, decay d/2 each."""
    k1, k2, d = 1e4, 4e4, 4.0
    support = Support("at", np.diag([k1, k2, 9e4]), d * np.eye(3))
    speeds = np.array([0.0, 30.0, 77.0, 150.0, 260.0])
    result = campbell(point_mass(), speeds, supports=[support])
    expected = np.sqrt(np.array([k1, k2, 9e4]) - d**2 / 4.0)
    for row in result.frequencies_inertial:
        np.testing.assert_allclose(np.sort(row), expected, rtol=1e-9)
    np.testing.assert_allclose(result.growth, -d / 2.0, rtol=1e-9)
    assert np.sum(result.whirl == "mixed") == 10
    tracked = result.tracked()
    np.testing.assert_allclose(np.ptp(tracked.frequencies_inertial, axis=0), 0.0, atol=1e-6)
