"""Blades at level 'full' beside rotating beams; long: python -m validation blade."""

import numpy as np
import pytest

from validation.references import beam
from validation.stiffening.blade import MODES, beam_frequency, blade, solid_frequencies, southwell

ETAS = (0.0, 1.0, 8.0)


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


@pytest.mark.parametrize("hub", [0.0, 1.0])
def test_solid_without_lateral_contraction_is_a_timoshenko_beam(hub):
    """Then the clamped face adds nothing, and 'full' has all terms of the beam.

    What is left is the mesh, 2e-4 at rest for the first modes (maxh 0.02 m) and falling with it,
    and Cowper's κ. The effect of the initial displacement is a difference on one mesh.
    """
    rotor = blade(0.02, hub, ratio=0.0)
    full = solid_frequencies(rotor, ETAS, "full", modes=3)
    moved = solid_frequencies(rotor, ETAS, "full, displaced", modes=3)
    for mode in MODES[:2]:
        line, other = (
            np.array([beam_frequency(mode, eta, hub, 0.0, displaced) for eta in ETAS])
            for displaced in (False, True)
        )
        assert full[mode] == pytest.approx(line, rel=4e-4)
        assert full[mode] / full[mode][0] == pytest.approx(line / line[0], rel=2e-4)
        effect = moved[mode] / full[mode] - 1
        assert effect == pytest.approx(other / line - 1, abs=0.02 * np.abs(effect).max())


def test_southwell_coefficients_of_the_levels():
    """Beam: 1.1922 and 0.1930 (hub radius zero); the clamped face changes the shape by 3e-3.

    Level 'none' knows the spin softening alone, which is −1 for a motion in the plane of rotation
    and zero across; shear and rotary inertia change that by the square of height over length.
    """
    rotor = blade(0.02)
    for level, tolerance in (("full", 4e-3), ("none", 4e-3)):
        found = solid_frequencies(rotor, ETAS[:2], level, modes=3)
        for mode, spin in zip(MODES[:2], (0.0, -1.0), strict=True):
            line = southwell(np.array([beam_frequency(mode, eta, 0.0) for eta in ETAS[:2]]), ETAS)
            expected = line if level == "full" else spin
            assert southwell(found[mode], ETAS) == pytest.approx(expected, abs=tolerance)
