"""'full' against vibrations about a geometrically nonlinear static state, on one mesh."""

import numpy as np
import pytest

from validation.stiffening import nonlinear, overhung, spun_up_blade


@pytest.fixture(scope="module")
def blade() -> nonlinear.ClampedSolid:
    return nonlinear.ClampedSolid.of(nonlinear.blade_mesh(), "root")


@pytest.fixture(scope="module")
def rows(blade) -> list[dict]:
    return [nonlinear.compare(blade, speed) for speed in (75.0, 150.0)]


def test_tangent_of_blades_that_turn_locally():
    """Rounding of a matrix whose entries are 1e5 times its lowest eigenvalues; 1e-6 is wanted."""
    solid = nonlinear.ClampedSolid.of(nonlinear.bladed_disc_mesh(0.1, blades=2), "bore")
    exact, *tangents = (
        solid.linear_preload(600.0),
        *(solid.linear_tangent(level, 600.0) for level in nonlinear.LEVELS[1:]),
    )
    basis = solid.basis(exact, 12)
    expected, alone, all_of_it = (
        solid.frequencies(tangent, 600.0, basis)[:6] for tangent in (exact, *tangents)
    )
    assert all_of_it == pytest.approx(expected, rel=1e-7)
    assert np.abs(alone / expected - 1.0).max() > 3e-4


def test_orders_in_the_square_of_the_speed(rows):
    """First order for K_G alone, second with the initial displacement; Ω² grows fourfold."""
    found = nonlinear.orders(rows)
    assert found["full"] == pytest.approx(1.0, abs=0.05)
    assert found["full, initial displacement"] == pytest.approx(2.0, abs=0.15)


def test_overhung_disc_needs_the_full_level():
    """The 3D body with its frame in the hub is level 'none'; the frequencies' own errors are h²."""
    mesh = {"element_size": 0.1, "safety": 0.7}
    solid = nonlinear.ClampedSolid.of(overhung.overhung_mesh(**mesh), "root")
    row = overhung.compare(solid, overhung.imported(solid, overhung.overhung_mesh(**mesh)), 60.0)
    assert row["reduced, full"] < 1e-5
    assert row["full, initial displacement"] < 1e-5
    assert row["reduced, tilt"] > 10 * row["reduced, full"]
    assert row["none"] > 1e-2
    assert row["3D body"] == pytest.approx(row["none"], rel=0.3)


def test_spun_up_blade_stays_with_the_nonlinear_solid_at_the_full_level():
    """The deflection is 2.6 % of the length: its square, 7e-4, is what linear theory leaves out."""
    solid = nonlinear.ClampedSolid.of(spun_up_blade.thin_blade(0.1), "root")
    tracks = spun_up_blade.compare(solid, 1e-2)
    assert np.abs(tracks["nonlinear solid"]).max() > 5e-3
    found = {row["level"]: row for row in spun_up_blade.summary(tracks, 1e-2)}
    assert found["full"]["deviation"] < 7e-4
    assert found["none"]["lost_at"] < found["tilt"]["lost_at"] < spun_up_blade.SPIN_UP
