"""Blades at level 'full' beside rotating beams; long: python -m validation blade."""

import pytest

from validation.references import beam


@pytest.mark.parametrize("mode", beam.PUBLISHED)
def test_beam_gives_the_published_frequencies(mode):
    """Wright, Smith, Thresher, Wang, J. Appl. Mech. 49 (1982): all digits that are printed."""
    found = [beam.flap_frequencies(eta)[mode] for eta in range(11)]
    assert found == pytest.approx(beam.PUBLISHED[mode], abs=0.5001e-4)


def test_beam_has_converged():
    for eta in (0.0, 10.0):
        few, many = (beam.flap_frequencies(eta, 1.0, count=count) for count in (16, 22))
        assert few == pytest.approx(many, rel=1e-12)


def test_thick_beam_becomes_the_thin_one():
    """Shear and rotary inertia are of the order of (radius of gyration over length)²."""
    for lag, thin in ((False, beam.flap_frequencies), (True, beam.lag_frequencies)):
        errors = []
        for gyration in (1e-4, 1e-5):
            section = beam.Section(gyration, 2.6, 0.85)
            errors.append(beam.thick_frequencies(3.0, 1.0, section, lag)[0] / thin(3.0, 1.0)[0] - 1)
        assert errors[0] / errors[1] == pytest.approx(10.0, rel=0.02)
