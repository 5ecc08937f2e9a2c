"""The first forward mode under cross-coupling."""

import numpy as np
import pytest

from exudyn_rotor import SolidRotor, Support, stability, stability_level_one


@pytest.fixture(scope="module")
def rotor():
    """Return three masses on a shaft with bending stiffness in both directions."""
    beam = 4e5 * np.array([[1.0, -2.0, 1.0], [-2.0, 4.0, -2.0], [1.0, -2.0, 1.0]])
    K = np.kron(beam, np.diag([1.0, 1.0, 0.0]))
    K += 1e9 * np.kron([[1, -1, 0], [-1, 2, -1], [0, -1, 1]], np.diag([0.0, 0.0, 1.0]))
    nodes = [[0.0, 0.0, -0.3], [0.0, 0.0, 0.0], [0.0, 0.0, 0.3]]
    rotor = SolidRotor.from_matrices(np.kron(np.diag([1.0, 10.0, 1.0]), np.eye(3)), K, nodes, "z")
    for number, name in enumerate(("left", "disc", "right")):
        rotor = rotor.with_interface(name, [number])
    return rotor.reduce(np.eye(9))


def seal(q: float) -> Support:
    return Support("disc", [[0.0, q], [-q, 0.0]])


@pytest.mark.parametrize("damping", [50.0, 2e3, 1e4])
@pytest.mark.parametrize("ratio", [1.0, 3.0])
def test_the_mode_followed_is_the_one_that_turns_unstable(rotor, damping, ratio):
    """Bearings from light to heavy damping, in which others are overdamped."""
    supports = [Support(n, np.diag([1e6, ratio * 1e6]), damping) for n in ("left", "right")]
    result = stability_level_one(rotor, 300.0, 2e4, "disc", supports=supports)
    assert 0.0 < result.log_decrement[0] < 7.0
    assert np.all(np.diff(result.log_decrement) < 1e-9)
    for q, decrement, frequency in zip(
        result.applied, result.log_decrement, result.frequencies, strict=True
    ):
        found = stability(rotor, [300.0], supports=[*supports, seal(q)])
        off = np.abs(found.frequencies_inertial[0] - frequency) / frequency
        off += np.abs(np.nan_to_num(found.log_decrement[0], nan=1e3) - decrement)
        assert off.min() < 1e-6
        if decrement < 0.0:
            assert not found.stable[0]
    if result.threshold:
        found = stability(rotor, [300.0], supports=[*supports, seal(result.threshold)])
        assert abs(found.growth[0]) < 1e-6


OMEGA = 100.0  # of a point of 1 kg [rad/s]


def on_bearings(ratio, q, damping=20.0):
    """Return level I of the point on bearings k ± Δk/2."""
    point = SolidRotor.from_matrices(
        np.eye(3), np.zeros((3, 3)), [[0, 0, 0]], axis="z", interfaces={"disc": [0]}
    ).reduce(0)
    bearing = Support("disc", 1e4 * np.diag([1.0 - ratio, 1.0 + ratio]), damping * np.eye(2))
    return stability_level_one(point, 300.0, q, "disc", supports=bearing)


@pytest.mark.parametrize("q", [50.0, 300.0, 500.0, 999.0, 1500.0])
def test_anisotropic_bearings_raise_the_threshold(q):
    """Forward and backward whirl share the forces: Q₀² = (c ω̄)² + (Δk/2)² for k ± Δk/2.

    From (λ² + cλ + k₁)(λ² + cλ + k₂) + Q² = 0 at λ = iν: ν² = (k₁ + k₂)/2. Up to Q = Δk/2 the
    planes do not join, and no mode changes its growth.
    """
    found, limit = on_bearings(0.1, q), np.hypot(20.0 * OMEGA, 1e3)
    apart = found.applied < 1e3
    growth = found.log_decrement * found.frequencies / (2.0 * np.pi)
    np.testing.assert_allclose(growth[apart], 10.0, rtol=1e-9)
    planes = np.sqrt([0.9e4 - 100.0, 1.1e4 - 100.0])  # which are alike
    assert np.abs(found.frequencies[0] / planes - 1.0).min() < 1e-6
    if 10.0 * q < limit:
        assert found.threshold is None
    else:
        assert found.threshold == pytest.approx(limit, rel=1e-6)


def test_a_rotor_that_is_overdamped_has_a_limit_but_no_decrement():
    """``c ż + (k − iq) z = 0`` beside little mass."""
    result = on_bearings(0.0, 5e4, 1e3)
    assert np.isinf(result.log_decrement[0])
    assert result.threshold == pytest.approx(1e3 * 100.0, rel=1e-6)  # c ω
    assert "inf" in result.table()
