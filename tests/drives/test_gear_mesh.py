"""The law of a gear mesh: closed forms of its direction, force, energy, and of two inertias."""

import numpy as np
import pytest
import scipy.linalg

from exudyn_rotor import GearMesh

RADII, K = (0.05, 0.08), 2e8
TWIST = [5, 11]  # rows of the rotations about e


def mesh(**changes):
    return GearMesh(**({"radii": RADII, "stiffness": K} | changes))


def test_two_inertias_swing_at_the_closed_form_frequency():
    """ω² = k (r₁²/J₁ + r₂²/J₂), beside the rotation in the ratio of the radii, at 0."""
    inertias = np.array([0.01, 0.05])
    stiffness = mesh().matrices()[0][np.ix_(TWIST, TWIST)]
    squares, modes = scipy.linalg.eigh(stiffness, np.diag(inertias))
    expected = K * np.sum(np.square(RADII) / inertias)
    np.testing.assert_allclose(squares, [0.0, expected], atol=1e-12 * expected)
    assert modes[0, 0] / modes[1, 0] == pytest.approx(-RADII[1] / RADII[0], rel=1e-12)


@pytest.mark.parametrize("line_angle", [0.0, 2.1])
@pytest.mark.parametrize(("flank", "helix_angle"), [(1, 0.0), (-1, 0.0), (1, 0.35), (-1, -0.35)])
def test_forces_are_those_of_a_gear_book(flank, helix_angle, line_angle):
    """G. Niemann, H. Winter, Maschinenelemente II: F_r = F_t tan α, F_a = F_t tan β."""
    gears = mesh(flank=flank, helix_angle=helix_angle, line_angle=line_angle, pressure_angle=0.4)
    v = gears.direction
    motion = 1e-4 * v / (v @ v)
    push = -gears.forces(motion, np.zeros(12))
    assert gears.transmitted(motion, np.zeros(12)) == pytest.approx(1e-4 * K, rel=1e-12)
    pitch = np.array(RADII) / np.cos(0.4)
    radial = np.array([np.cos(line_angle), np.sin(line_angle), 0.0])
    along = np.array([-np.sin(line_angle), np.cos(line_angle), 0.0])
    first, second = push.reshape(2, 2, 3)
    tangential = first[0] @ along
    assert np.sign(tangential) == flank
    assert first[0] @ radial == pytest.approx(abs(tangential) * np.tan(0.4), rel=1e-12)
    assert first[0][2] == pytest.approx(-tangential * np.tan(helix_angle), rel=1e-12, abs=1e-9)
    np.testing.assert_allclose(first[0], -second[0])
    assert first[1][2] == pytest.approx(tangential * pitch[0], rel=1e-12)
    assert second[1][2] == pytest.approx(tangential * pitch[1], rel=1e-12)
    # forces and moments together about the first centre: no resultant
    apart = gears.center_distance * radial
    np.testing.assert_allclose(first[1] + second[1] + np.cross(apart, second[0]), 0.0, atol=1e-9)


def test_flanks_only_push_and_part_in_the_backlash():
    gears = mesh(backlash=1e-4, damping=1e3)
    turn = np.zeros(12)

    def force(depth, rate=0.0):
        x, x_t = turn.copy(), turn.copy()
        x[5], x_t[5] = depth / RADII[0], rate / RADII[0]
        return gears.transmitted(x, x_t)

    assert force(4.9e-5) == force(-4.9e-5, -1.0) == 0.0
    assert force(6e-5) == pytest.approx(K * 1e-5, rel=1e-9)
    assert force(-6e-5) == pytest.approx(-K * 1e-5, rel=1e-9)
    assert force(6e-5, 0.5) == pytest.approx(K * 1e-5 + 500.0, rel=1e-9)
    assert force(6e-5, -3.0) == pytest.approx(0.0, abs=1e-9)  # damping does not pull
    assert mesh(damping=1e3).transmitted(turn, np.eye(12)[5]) == pytest.approx(
        1e3 * RADII[0], rel=1e-12
    )


@pytest.mark.parametrize("backlash", [None, 2e-5])
def test_forces_are_what_energy_and_loss_say(backlash):
    """−f·ẋ = dE/dt + loss, with a stiffness that varies, by central differences of E."""
    gears = mesh(
        teeth=[20, 32], variation=[0.2, 0.1], backlash=backlash, helix_angle=0.2, damping=30.0
    )
    law, rng = gears, np.random.default_rng(3)
    for _ in range(20):
        x, x_t = 2e-4 * rng.normal(size=12), rng.normal(size=12)
        x[5] = 0.1 * rng.normal()
        x[11] = (2e-5 * rng.normal() - RADII[0] * x[5]) / RADII[1]
        h = 1e-9
        growth = (law.energy(x + h * x_t) - law.energy(x - h * x_t)) / (2.0 * h)
        power = -law.forces(x, x_t) @ x_t
        # of the differences: round-off of E over h
        tolerance = 4e-16 * law.energy(x) / h + 1e-6 * abs(power)
        assert growth + law.loss(x, x_t) == pytest.approx(power, abs=tolerance)
        assert law.loss(x, x_t) >= 0.0
