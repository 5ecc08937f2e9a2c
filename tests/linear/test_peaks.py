"""Peaks of responses that are sharper than the steps of the speed, or not there."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from forced_models import rings

from exudyn_rotor import (
    HarmonicForce,
    SolidRotor,
    Support,
    Unbalance,
    UnbalanceResponse,
    harmonic_response,
    separation_margins,
    unbalance_response,
)
from validation.extremes.rotors import shaft_frequencies, shaft_rotor


@pytest.mark.parametrize("count", [5, 50, 500])
def test_a_sharp_peak_is_found_between_few_speeds(count):
    """The largest ``m e Ω² / √((k − mΩ²)² + (cΩ)²)`` is ``e / (2D√(1 − D²))`` at ``ω/√(1 − 2D²)``.

    Between two of 50 speeds are thirty times the width Dω; 1 % is what a phase of 0.3 rad leaves.
    """
    mass, frequency, damping = 1.0, 100.0, 1e-3
    support = Support("at", mass * frequency**2, 2.0 * damping * frequency * mass)
    place = [[0.0, 0.0, 0.0]]
    point = SolidRotor.from_matrices(mass * np.eye(3), np.zeros((3, 3)), place, "z")
    point = point.with_interface("at", [0])
    expected = 1e-5 / (2.0 * damping * np.sqrt(1.0 - damping**2))
    given = {"supports": [support], "own": False}
    speeds = np.linspace(10.0, 163.0, count)
    response = unbalance_response(
        point, speeds, [Unbalance("at", 1e-5 * mass)], refine=True, **given
    )
    speed, size = response.peak()
    assert speed == pytest.approx(frequency / np.sqrt(1.0 - 2.0 * damping**2), rel=0.1 * damping)
    assert size == pytest.approx(expected, rel=0.01)
    assert np.isin(speeds, response.speeds).all()
    assert len(response.speeds) < count + 150
    shaken = harmonic_response(point, speeds, HarmonicForce("at", (1.0, 0.0)), refine=True, **{
        "supports": [support]
    })  # fmt: skip
    static = 1.0 / (mass * frequency**2)
    assert shaken.peak()[1] == pytest.approx(0.5 * static / damping, rel=0.01)


def test_a_peak_is_told_to_be_coarse_or_outside():
    rotor, ends = rings(modes=6), ("left", "right")
    supports = [Support(name, 1e5, 1.0) for name in ends]
    unbalances = [Unbalance("left", 1e-4)]
    given = {"supports": supports, "own": False}
    coarse = unbalance_response(rotor, np.linspace(100.0, 200.0, 12), unbalances, **given)
    with pytest.warns(UserWarning, match=r"left: the points around the peak at .* refine=True"):
        coarse.peak("left")
    below = unbalance_response(rotor, np.linspace(1.0, 50.0, 12), unbalances, **given)
    with pytest.raises(ValueError, match="left: the motion has no peak between 1 and 50 rad/s"):
        below.peak("left")


def two_masses() -> tuple[SolidRotor, list[Support]]:
    """Return two masses of 2 kg on a rod, axis z, each on its own springs, ω = 100 rad/s."""
    rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, [[0, 0, -0.1], [0, 0, 0.1]], "z")
    rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    return rotor, [Support(name, 2e4, 10.0) for name in ("left", "right")]


def test_a_peak_between_rest_and_the_second_speed_is_refined():
    """Damping ratio D = 0.025: the largest is ``e / (2D√(1 − D²))``; AF is 1/2D to order D²."""
    rotor, supports = two_masses()
    response = unbalance_response(
        rotor, [0.0, 100.0, 200.0], Unbalance("left", 1e-4), supports=supports, refine=True
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        speed, size = response.peak("left")
        margins = separation_margins(response, [130.0, 150.0], places="left")
    assert size == pytest.approx(5e-5 / (0.05 * np.sqrt(1.0 - 0.025**2)), rel=0.01)
    assert speed == pytest.approx(100.0 / np.sqrt(1.0 - 2.0 * 0.025**2), rel=1e-3)
    assert margins.amplification == pytest.approx([20.0], rel=0.02)


def test_rounding_at_a_place_that_does_not_move_is_no_peak():
    """The unbalance is at the other mass, which moves alone."""
    rotor, supports = two_masses()
    response = unbalance_response(
        rotor, np.linspace(0.0, 200.0, 21), Unbalance("left", 1e-4), supports=supports
    )
    motion = response.motion.copy()
    noise = np.random.default_rng(1).normal(size=motion[1:, 1, :, :2].shape)
    motion[1:, 1, :, :2] = 1e-20 * noise
    response = replace(response, motion=motion)
    assert not np.any(response.semi_axes("right"))
    with pytest.raises(ValueError, match="right: the motion has no peak"):
        response.peak("right")
    with pytest.warns(UserWarning, match="left: .* too far apart"):
        assert separation_margins(response, [130.0, 150.0]).places == ("left",)


def test_a_resonance_without_damping_is_left_out_where_points_are_added():
    """Halving meets it: ω = 100 rad/s is midway between two of the speeds."""
    point = SolidRotor.from_matrices(np.eye(3), np.zeros((3, 3)), [[0.0, 0.0, 0.0]], "z")
    point = point.with_interface("at", [0])
    given = {"supports": [Support("at", 1e4)], "own": False, "refine": True}
    response = unbalance_response(point, [50.0, 90.0, 110.0, 150.0], Unbalance("at", 1e-5), **given)
    speeds = response.speeds
    assert np.all(speeds != 100.0)
    exact = 1e-5 * speeds**2 / np.abs(1e4 - speeds**2)
    np.testing.assert_allclose(response.semi_axes()[0], exact, rtol=1e-11)


@pytest.mark.parametrize(
    ("bending", "bearing", "share"), [(100.0, 1e10, 0.998), (100.0, 1e11, 0.998), (1.0, 1e12, 0.5)]
)
def test_beside_a_resonance_on_rigid_bearings_without_damping(bending, bearing, share):
    """A shaft between rigid bearings: ``e Ω² / (ω² − Ω²)`` of two masses and springs.

    Stiffnesses round by ε of the bearings', which is seen beside ``k (1 − share²)``.
    """
    disc, end = 10.0, 1.0
    rotor = shaft_rotor(disc, end, (bending, bending)).with_interface("disc", range(4)).reduce(8)
    speed = share * shaft_frequencies(disc, end, bending, bearing)[0]
    stiffness = np.array([[bending, -bending], [-bending, bending + 2.0 * bearing]])
    exact = np.linalg.solve(stiffness - speed**2 * np.diag([disc, 2.0 * end]), [1.0, 0.0])[0]
    supports = [Support(name, bearing) for name in ("left", "right")]
    given = {"supports": supports, "at": "disc", "accuracy": None}
    load = [Unbalance("disc", 1.0)]
    response = unbalance_response(rotor, [speed], load, own=False, **given)
    rounding = np.finfo(float).eps * bearing / (bending * (1.0 - share**2))
    assert response.semi_axes()[0][0] == pytest.approx(exact * speed**2, rel=10.0 * rounding)
    forced = harmonic_response(rotor, [0.0, speed], HarmonicForce("disc", (1.0, 0.0)), **given)
    expected = [1.0 / bending, exact]
    assert forced.phasor().real == pytest.approx(expected, rel=10.0 * rounding)


def test_a_larger_motion_along_the_axis_is_not_the_main_one():
    """A thin disc cones by its own load: a constant motion along the axis, which no peak is of."""
    motion = np.zeros((3, 1, 2, 6), dtype=complex)
    motion[:, 0, 0, 2] = 1e-4  # order 0, along e
    motion[:, 0, 1, 0] = [1e-6, 5e-6, 1e-6]
    motion[:, 0, 1, 1] = -1j * motion[:, 0, 1, 0]
    speeds = [90.0, 100.0, 110.0]
    response = UnbalanceResponse(("left",), [0, 1], motion, "inertial", speeds)
    assert response.main_order == 1
    with pytest.warns(UserWarning, match="too far apart"):
        assert response.peak()[0] == pytest.approx(100.0)
    along = UnbalanceResponse(("left",), [0], motion[:, :, :1], "inertial", speeds)
    assert along.main_order == 0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        along.plot()  # n1 and n2 do not move: no logarithms
