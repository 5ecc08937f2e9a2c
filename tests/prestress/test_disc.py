"""Rotating discs beside plane stress and plate theory; long: python -m validation disc."""

from dataclasses import replace

import numpy as np
import pytest

from validation.references import plate
from validation.stiffening.disc import (
    PLATE,
    RING,
    ROUND,
    bending_modes,
    disc_rotor,
    pair,
    static_values,
)

# thick enough that a coarse mesh will do: it makes thin plates too stiff
THICK = replace(PLATE, thickness=0.02)
SPEED = 2000.0


@pytest.fixture(scope="module")
def waves():
    """Modes of the clamped plate at rest and at speed."""
    rotor = disc_rotor(THICK, (4, 24, 1))
    return [bending_modes(rotor, speed, modes=7) for speed in (0.0, SPEED)]


@pytest.mark.parametrize(("disc", "order"), [(RING, 1), (RING, 2), (ROUND, 2)])
def test_strain_energy_converges_to_plane_stress(disc, order):
    """Twice the order of the elements, 2 or 4; on coarse meshes at least 1.5 and 3."""
    cells = [(2 * k, 12 * k, k) for k in (1, 2)]
    errors = [static_values(disc_rotor(disc, one, order), disc)["work"] - 1 for one in cells]
    assert np.log2(errors[0] / errors[1]) > 1.5 * order
    # finite elements store too little energy; the limit at the full order is plane stress
    assert errors[0] < errors[1] < 0.0
    limit = errors[1] + (errors[1] - errors[0]) / (4.0**order - 1.0)
    assert abs(limit) < 0.5 * abs(errors[1])


def test_plate_gives_the_published_frequencies():
    """Three digits of the tables; Bessel functions and Ritz's method agree far better."""
    for (ratio, n), expected in plate.PUBLISHED.items():
        disc = plate.Annulus(ratio, 1.0, 0.01, 1.0, 0.3, 1.0)
        unit = np.sqrt(disc.rigidity / disc.area_density)
        found = plate.plate_frequency(disc, n)
        digit = 0.01 if expected < 10.0 else 0.1
        assert found / unit == pytest.approx(expected, abs=0.55 * digit)
        assert plate.rotating_frequency(disc, n, 0.0) == pytest.approx(found, rel=1e-9)


def test_membrane_without_a_hub_gives_the_classical_values():
    """Lamb and Southwell (1921): λ = ((n + 2s)(n + 2s + 2)(3 + ν) − n²(1 + 3ν))/8, full disc.

    A hub of a hundredth of the radius changes λ of s = 0 by about the square of that.
    """
    disc = plate.Annulus(0.002, 0.2, 0.01, 2.1e11, 0.3, 7850.0)
    for n in (2, 3, 4):
        expected = (n * (n + 2) * 3.3 - n**2 * 1.9) / 8
        assert plate.membrane_value(disc, n, count=30) == pytest.approx(expected, rel=2e-4)


def test_bending_waves_stiffen_as_plate_and_membrane(waves):
    """The slope of ω² over Ω² is free of what the mesh adds to the stiffness; 2 % is left."""
    for n in range(3):
        before, after = (np.mean(pair(one, n) ** 2) for one in waves)
        slope = (after - before) / SPEED**2
        thick = [np.mean(plate.thick_frequencies(THICK, n, one) ** 2) for one in (0.0, SPEED)]
        assert slope == pytest.approx((thick[1] - thick[0]) / SPEED**2, rel=0.02)
        assert slope > plate.membrane_value(THICK, n)
    assert np.ptp(pair(waves[0], 2)) < 1e-6 * pair(waves[0], 2)[0]


def test_waves_part_in_both_frames(waves):
    """Rotor frame: the Coriolis force on the fibres; inertial frame: ν ± nΩ."""
    moving = waves[1]
    for n in (1, 2):
        slow, fast = plate.thick_frequencies(THICK, n, SPEED)
        found = pair(moving, n)
        assert found[1] - found[0] == pytest.approx(fast - slow, rel=0.05)
        chosen = np.flatnonzero(moving.nodal_diameters[0] == n)[:2]
        assert moving.whirl[0, chosen].tolist() == ["forward", "backward"]
        expected = np.abs(found + n * SPEED * np.array([1.0, -1.0]))
        assert moving.frequencies_inertial[0, chosen] == pytest.approx(expected, rel=1e-9)
