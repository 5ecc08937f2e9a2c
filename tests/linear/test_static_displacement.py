"""The stiffness per Ω⁴ of a static displacement in reduced rotors, files and critical speeds."""

import numpy as np

from exudyn_rotor import Prestress, ReducedRotor, SolidRotor, critical_speeds
from exudyn_rotor.theory.stiffening import stiffening
from validation.stiffening import nonlinear

STIFFNESS, FOURTH = 1e6, 1e-7  # of a mass of 1 kg [N/m, N s⁴/m]


def point_mass() -> ReducedRotor:
    """Return a mass on springs that turn with it and on ``Ω⁴`` times a constant."""
    nodes, none = [[0.0, 0.0, 0.0]], np.zeros((3, 3))
    rotor = SolidRotor.from_matrices(np.eye(3), STIFFNESS * np.eye(3), nodes, "z")
    displaced = (none, FOURTH * np.eye(3))
    return rotor.reduce(np.eye(3), prestress=Prestress(none, nodes, initial_displacement=displaced))


def test_critical_speeds_are_zeros_of_a_polynomial_of_degree_four():
    """``k − Ω² + κΩ⁴ = 0`` for unbalance, by the formula for Ω²."""
    root = np.sqrt(1.0 - 4.0 * STIFFNESS * FOURTH)
    expected = np.sqrt((1.0 + np.array([-1.0, -1.0, 1.0, 1.0]) * root) / (2.0 * FOURTH))
    found = critical_speeds(
        point_mass(), stiffening="full", nodal_diameters=[1], max_speed=4000.0
    ).speeds
    np.testing.assert_allclose(np.unique(found.round(6)), np.unique(expected.round(6)), rtol=1e-6)


def test_a_rotor_that_tilts_takes_its_static_state_along():
    """What resists tilts is that of the level 'tilt', but for the static strain of 5e-4.

    ``a × x`` alone would be resisted by K_uu: 8e-3 of it, where the blades turn by 2e-3.
    """
    rotor = SolidRotor.from_ngsolve(nonlinear.bladed_disc_mesh(0.1, 1), nonlinear.STEEL, "z")
    reduced = rotor.reduce(2, prestress=rotor.prestress(initial_displacement=True))
    inv, speed = reduced.invariants, 600.0
    stiffness = inv.K + speed**2 * inv.K2 + speed**4 * inv.K4
    tilts = [i for i, kind in enumerate(reduced.kinds) if kind.value.startswith("tilt")]
    rest = np.arange(len(reduced.rigid), reduced.size)
    corner, side = stiffness[np.ix_(tilts, tilts)], stiffness[np.ix_(rest, tilts)]
    resisted = corner - side.T @ np.linalg.solve(stiffness[np.ix_(rest, rest)], side)
    expected = speed**2 * stiffening(inv, "tilt").K2[np.ix_(tilts, tilts)]
    assert np.abs(resisted - expected).max() < 1e-4 * np.abs(expected).max()
    assert np.abs(corner - expected).max() > 1e-3 * np.abs(expected).max()
