"""The fixed-axis body against Exudyn's own 3D body with the same modes, bearings and start."""

import numpy as np
import pytest

from validation.exudyn_3d import against_3d, scenes

DURATION, STEP = 0.02, 5e-5  # one turn


@pytest.fixture(scope="module")
def model():
    return scenes.Model.of(scenes.disc_on_shaft(), 6)


@pytest.fixture(scope="module")
def rows(model):
    """Return deviations by nominal tilt, on anisotropic bearings."""
    given = against_3d.SUPPORTS["anisotropic"]
    return {
        tilt: against_3d.compare(model, given, tilt, DURATION, STEP, 100, ["tilt"])[0]
        for tilt in (1e-3, 1e-4)
    }


def worst(row):
    return max(row[name] for name in ("lateral", "axial", "rim"))


def test_relative_deviation_falls_with_the_tilt(rows):
    """First-order agreement: a tenth of the tilt, a tenth of the relative deviation."""
    np.testing.assert_allclose(worst(rows[1e-3]) / worst(rows[1e-4]), 10.0, rtol=0.3)


def test_bodies_agree_at_small_tilts(rows):
    row = rows[1e-4]
    assert worst(row) < 1e-3
    assert row["lateral"] < 1e-4
    assert row["rim"] < 1e-4
    assert row["step error"] < 2e-4


@pytest.fixture(scope="module")
def unstable():
    model = scenes.Model.of(scenes.cylinder(0.15, 0.1, 0.08), 4)
    return against_3d.instability(model, 1.2, steps=1600)


def test_papers_terms_grow_at_the_predicted_rate(unstable):
    assert unstable["peak none"] > 1e-2
    # the rest is the stiffness of the modes and the step
    np.testing.assert_allclose(unstable["growth"], unstable["expected growth"], rtol=5e-3)


def test_stiffened_body_swings_as_far_as_the_3d_body(unstable):
    np.testing.assert_allclose(unstable["peak tilt, free spin"], unstable["peak 3D"], rtol=1e-3)


def test_family_is_one_motion_up_to_the_step(model):
    coarse, fine = against_3d.family(model, [1e6], DURATION, STEP)
    assert fine["in-plane"] < 1e-10
    for member in ("none", "none, constant speed"):
        assert fine[member] < 1e-5
        np.testing.assert_allclose(coarse[member] / fine[member], 4.0, rtol=0.1)
