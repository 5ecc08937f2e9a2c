"""Order, names and lines of motions that are equal do not depend on how they were rounded."""

import numpy as np
import pytest
from point_rotors import ring_rotor

from exudyn_rotor import (
    SolidRotor,
    Support,
    Unbalance,
    campbell,
    stability,
    unbalance_response,
)

STIFFNESS, DAMPING, MASS = 2e4, 10.0, 2.0
NATURAL = np.sqrt(STIFFNESS / MASS)
TURNS = range(4)


def rod(turn: int) -> SolidRotor:
    """Return two masses of 2 kg on a rod along the axis, in axes that make another rounding."""
    axes = np.linalg.qr(np.random.default_rng(turn).normal(size=(3, 3)))[0]
    spring = 1e8 * np.kron([[1, -1], [-1, 1]], np.outer(axes[2], axes[2]))
    nodes = np.outer([-0.1, 0.1], axes[2])
    made = SolidRotor.from_matrices(MASS * np.eye(6), spring, nodes, axes[2])
    return made.with_interface("left", [0]).with_interface("right", [1])


def both(*coefficients, **others) -> list[Support]:
    return [Support(name, *coefficients, **others) for name in ("left", "right")]


@pytest.mark.parametrize("turn", TURNS)
def test_without_damping_no_motion_is_the_least_stable(turn):
    columns = stability(rod(turn), [0.0, 50.0], supports=both(STIFFNESS)).columns()
    assert columns["growth [1/s]"].tolist() == [0.0, 0.0]
    assert np.all(np.isnan(columns["inertial [rad/s]"]))
    assert columns["nodal diameters"].tolist() == [-1, -1]
    assert columns["whirl"].tolist() == ["-", "-"]


@pytest.mark.parametrize("turn", TURNS)
def test_modes_of_one_frequency_stand_from_backward_to_forward_at_rest(turn):
    """Cross-coupling q damps backward whirl by q/2mω and drives forward whirl, at one frequency."""
    cross = 1e-2 * STIFFNESS
    supports = both([[STIFFNESS, cross], [-cross, STIFFNESS]], DAMPING)
    result = campbell(rod(turn), [0.0], supports=supports)
    assert result.whirl[0].tolist() == ["axial", *2 * ["backward"], *2 * ["forward"], "axial"]
    rates = DAMPING / (2.0 * MASS) + np.repeat([1.0, -1.0], 2) * cross / (2.0 * MASS * NATURAL)
    np.testing.assert_allclose(result.growth[0, 1:5], -rates, rtol=1e-3)  # of the order (c/2mω)²


@pytest.mark.parametrize("turn", TURNS)
def test_a_free_rotor_stands_still_in_space_at_any_speed(turn):
    result = campbell(rod(turn), [0.0, 100.0, 1000.0])
    lateral = result.nodal_diameters == 1
    assert np.all(lateral.sum(axis=1) == 4)
    assert set(result.whirl[lateral].tolist()) == {"static"}


@pytest.mark.parametrize("turn", TURNS)
def test_lines_of_a_free_rotor_go_on(turn):
    """A free rotor displaced stands still, with ν = Ω two times, and tilted, with ν = Ω, too."""
    made = ring_rotor(0.1, 0.2, 10.0)
    order = np.random.default_rng(turn).permutation(made.node_count)
    places = (3 * order[:, None] + np.arange(3)).ravel()
    matrices = (matrix.toarray()[np.ix_(places, places)] for matrix in (made.mass, made.stiffness))
    made = SolidRotor.from_matrices(*matrices, made.nodes[order], "z")
    result = campbell(made, [0.0, 50.0, 100.0, 300.0]).tracked()
    assert np.all(result.continued[:, result.frequencies_inertial[0] == 0.0])


@pytest.mark.parametrize("turn", TURNS)
def test_an_overdamped_motion_stands_still_at_rest(turn):
    """At Ω = 0 on dampers of twenty times the critical damping; all decay without oscillating."""
    supports = both(STIFFNESS, 40.0 * MASS * NATURAL)
    result = stability(rod(turn), [0.0], supports=supports)
    assert set(result.whirl[result.families == "lateral"].tolist()) == {"overdamped"}


@pytest.mark.parametrize("turn", TURNS)
def test_a_motion_against_its_unbalance_has_the_phase_180_degrees(turn):
    """Above the critical speed, without damping, it is real and negative in the rotor frame."""
    given = {"supports": both(STIFFNESS), "frame": "rotor"}
    loads = [Unbalance(name, 1e-4) for name in ("left", "right")]
    speeds = NATURAL * np.linspace(1.1, 4.0, 8)
    columns = unbalance_response(rod(turn), speeds, loads, **given).columns()
    np.testing.assert_array_equal(columns["n1 phase [deg]"], 180.0)
    np.testing.assert_array_equal(columns["e phase [deg]"], 0.0)


@pytest.mark.parametrize(("share", "step"), [(0.5, 400.0), (0.3, 500.0)])
def test_lines_in_steps_larger_than_the_distance_of_forward_and_backward_whirl(share, step):
    """A rigid rotor on bearings k and `share`·k at its ends, in z = x + iy and φ = φ_x + iφ_y:

    ``m z̈ + s₀z + s₁lφ = 0``, ``I_t φ̈ − iΩI_p φ̇ + s₁lz + s₀l²φ = 0``, s₀ and s₁ the sum and the
    difference of the stiffnesses: two frequencies each way, which never pass zero. Forward whirl of
    the frequency ω has Ω − ω in the rotor frame and the shape of backward whirl. The rotor is
    elastic, with ``(Ω/1e4)²`` of its frequencies.
    """
    radius, half, mass, k = 0.1, 0.2, 10.0, 1e4
    made = ring_rotor(radius, half, mass)
    made = made.with_interface("left", range(5)).with_interface("right", range(5, 10))
    supports = [Support("left", k), Support("right", share * k)]
    speeds = step * np.arange(6)
    result = campbell(made, speeds, supports=supports).tracked()
    lines = (result.nodal_diameters == 1).all(axis=0) & (result.frequencies_inertial[0] < 1e3)
    polar, across = mass * radius**2, mass * (0.5 * radius**2 + half**2)
    total, apart = (1.0 + share) * k, (share - 1.0) * k * half
    found = result.whirl_frequencies[:, lines]
    for speed, row in zip(speeds, found, strict=True):
        translation, tilt = [-mass, 0.0, total], [-across, polar * speed, total * half**2]
        roots = np.roots(np.polysub(np.polymul(translation, tilt), [apart**2])).real
        np.testing.assert_allclose(np.sort(row), np.sort(roots), rtol=1e-3 + (speed / 1e4) ** 2)
    np.testing.assert_array_equal(np.sign(found), np.sign(found[[0]]).repeat(6, axis=0))
    assert np.all(result.continued[:, lines])
