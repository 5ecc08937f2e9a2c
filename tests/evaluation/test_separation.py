"""Amplification factors: of each peak alone, whatever the speeds of the response are."""

import numpy as np
import pytest
from models import centered_disc
from test_evaluation import sized

from exudyn_rotor import Support, Unbalance, separation_margins, unbalance_response


@pytest.fixture(scope="module")
def disc():
    return centered_disc().reduce(8)


@pytest.mark.parametrize(
    ("stiffness", "damping", "peaks"),
    [((2e7, 4e7), 9000.0, 2), ((2e7, 2.6e7), 4000.0, 2), ((1e7, 1.3e7), 9000.0, 1)],
)
def test_factors_do_not_depend_on_the_speeds_that_are_given(disc, stiffness, damping, peaks):
    """A refined response is known within 1 %; peaks that merge keep their own flanks."""
    supports = [Support(name, np.diag(stiffness), damping) for name in ("left", "right")]
    found = []
    for count in (47, 192):
        speeds = np.linspace(100.0, 1500.0, count)
        given = {"own": False, "supports": supports, "refine": True, "accuracy": None}
        response = unbalance_response(disc, speeds, Unbalance("left", 1e-4, 0.2), **given)
        found.append(separation_margins(response, (900.0, 1000.0), places="left"))
    few, many = found
    assert len(few.peaks) == len(many.peaks) >= peaks
    np.testing.assert_allclose(few.amplification, many.amplification, rtol=0.02)
    np.testing.assert_allclose(few.peaks, many.peaks, rtol=2e-3)
    np.testing.assert_allclose(few.half_power, many.half_power, rtol=2e-3)


def test_a_resonance_without_damping_is_told():
    points = np.linspace(10.0, 300.0, 30)
    with np.errstate(divide="ignore"):
        size = 1.0 / np.abs(points - 100.0)
    response = sized(points, np.where(np.isfinite(size), size, np.nan))
    for evaluated in (response.peak, lambda: separation_margins(response, (200.0, 220.0))):
        with pytest.warns(UserWarning, match="too far apart .* nothing damps both are infinite"):
            evaluated()


def test_a_valley_above_half_power_is_the_end_of_a_flank():
    """Two peaks that merge: the sum of two resonances 3 widths apart."""
    for step in (0.02, 0.5):
        speeds = np.arange(60.0, 160.0, step)
        size = 1 / np.hypot(1, (speeds - 100) / 5) + 1 / np.hypot(1, (speeds - 115) / 5)
        with pytest.warns(UserWarning, match="rad/s count"):
            found = separation_margins(sized(speeds, size), (140.0, 150.0))
        assert np.isnan(found.half_power).tolist() == [[False, True], [True, False]]
        np.testing.assert_allclose(found.peaks, [100.3, 114.7], atol=0.3)
        outer = found.half_power[0, 0], found.half_power[1, 1]
        assert np.mean(outer) == pytest.approx(107.5, abs=0.05)
        assert found.amplification == pytest.approx(
            found.peaks / (2 * (found.peaks - outer) * [1, -1])
        )
        assert "before the valley to the next peak" in found.table()


def test_ripple_on_a_flank_does_not_end_it():
    speeds = np.linspace(60.0, 140.0, 1601)
    size = 1 / np.hypot(1, (speeds - 100) / 5) + 2e-4 * np.sin(20.0 * speeds)
    with pytest.warns(UserWarning, match="rad/s count"):
        found = separation_margins(sized(speeds, size), (150.0, 160.0))
    assert len(found.peaks) == 1
    np.testing.assert_allclose(found.half_power[0], [95.0, 105.0], atol=0.05)
