"""Blades at level 'full' beside rotating beams; long: python -m validation blade."""

import pytest

from validation.references import beam


@pytest.mark.parametrize("mode", beam.PUBLISHED)
def test_beam_gives_the_published_frequencies(mode):
    """Wright, Smith, Thresher, Wang, J. Appl. Mech. 49 (1982): all digits that are printed."""
    found = [beam.flap_frequencies(eta)[mode] for eta in range(11)]
    assert found == pytest.approx(beam.PUBLISHED[mode], abs=0.5001e-4)
