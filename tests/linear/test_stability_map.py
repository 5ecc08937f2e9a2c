"""Stability over two parameters against closed forms."""

import numpy as np
import pytest

from exudyn_rotor import SolidRotor, Support, linear_model, stability_map

MASS, STIFFNESS = 2.0, 2e4


@pytest.fixture(scope="module")
def point():
    return SolidRotor.from_matrices(
        MASS * np.eye(3), np.zeros((3, 3)), [[0, 0, 0]], axis="z", interfaces={"disc": [0]}
    ).reduce(0)


@pytest.fixture(scope="module")
def result(point):
    def build(cross: float, damping: float) -> tuple:
        K = np.array([[STIFFNESS, cross, 0.0], [-cross, STIFFNESS, 0.0], [0.0, 0.0, 1e6]])
        D = np.diag([damping, damping, 1e3])
        return linear_model(point, supports=[Support("disc", K, D)]), 300.0

    return stability_map(build, [10.0, 100.0, 1000.0], [2.0, 20.0], labels=("q", "c"))


def test_growth_verdict_and_motion(result):
    for a, q in enumerate(result.x):
        for b, c in enumerate(result.y):
            roots = np.roots([MASS, c, STIFFNESS - 1j * q])
            worst = roots[np.argmax(roots.real)]
            assert result.growth[a, b] == pytest.approx(worst.real, rel=1e-9)
            assert result.stable[a, b] == (q < c * abs(worst.imag))
            assert result.frequencies_inertial[a, b] == pytest.approx(abs(worst.imag), rel=1e-9)
            decrement = -2.0 * np.pi * worst.real / abs(worst.imag)
            assert result.log_decrement[a, b] == pytest.approx(decrement, rel=1e-7)
    assert set(result.families.ravel()) == {"lateral"}
    assert set(result.whirl.ravel()) == {"forward"}


def test_a_free_motion_does_not_hide_the_least_stable_one(point):
    """The shift along the axis is free; across it the growth is −c/2m."""

    def build(damping: float, speed: float) -> tuple:
        return linear_model(point, supports=[Support("disc", np.diag([2e4, 2e4]), damping)]), speed

    found = stability_map(build, [2.0, 8.0, 40.0], [30.0])
    assert not np.any(found.growth)
    growth = -np.array([[2.0], [8.0], [40.0]]) / (2.0 * MASS)
    np.testing.assert_allclose(found.least_stable_growth, growth, rtol=1e-9)
    assert "least stable: lateral motion, -0.5 1/s at (2, " in found.table()
    for shown in (found.columns()["growth [1/s]"], found.plot().collections[0].get_array()):
        np.testing.assert_allclose(shown, growth.ravel(), rtol=1e-9)


def test_a_point_that_fails_is_nan(point):
    def build(stiffness: float, speed: float) -> tuple:
        if stiffness > 2e4:
            raise ValueError("no such bearing")
        return linear_model(point, supports=[Support("disc", stiffness, 1.0)]), speed

    with pytest.warns(UserWarning, match="no such bearing") as heard:
        found = stability_map(build, [1e4, 2e4, 3e4], [10.0, 20.0])
    assert len(heard) == 1
    assert np.isnan(found.growth).all(axis=1).tolist() == [False, False, True]
    assert found.stable.all(axis=1).tolist() == [True, True, False]
    with pytest.raises(ValueError, match="no such bearing"):
        stability_map(build, [3e4], [10.0])
