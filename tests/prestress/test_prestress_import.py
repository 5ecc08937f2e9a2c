"""Prestress: a stress at rest in the static solution, few digits, soft springs, free rotors."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from models import STEEL, block_beam

from exudyn_rotor import SolidRotor, SpinAxis
from exudyn_rotor.prestress.static_solution import centrifugal_load, euler_load

ASIDE = SpinAxis((0, 0, 1), (0.1, 0, 0))
ASKEW = SpinAxis((0.3, 0.1, 1.0), (0.02, -0.03, 0.1))
# Euler: a clamped beam buckles at σ = 4π² E I / (A L²), about its weak side (it shears, too)
CRITICAL = 4 * np.pi**2 * STEEL["youngsModulus"] * 0.04**2 / 12 / 0.3**2


@pytest.fixture(scope="module")
def bar() -> SolidRotor:
    """A bar beside its axis."""
    return SolidRotor.from_ngsolve(block_beam(), STEEL, ASIDE)


@pytest.fixture(scope="module")
def held(bar) -> SolidRotor:
    return bar.clamped(["left", "right"])


@pytest.fixture(scope="module")
def askew() -> SolidRotor:
    return SolidRotor.from_ngsolve(block_beam(), STEEL, ASKEW)


def uniform(rotor: SolidRotor, value: float) -> np.ndarray:
    stress = np.zeros((rotor.node_count, 6))
    stress[:, 2] = value
    return stress


# ------------------------------------------------------------------ stress at rest


@pytest.mark.parametrize("share", [0.3, -0.3, -0.7])
def test_spin_deforms_the_stressed_rotor(held, share):
    given = held.prestress(stress=uniform(held, share * CRITICAL), euler=True)
    stiffness = (held.stiffness + given.constant).toarray()
    loads = np.stack([centrifugal_load(held), euler_load(held)], axis=1)
    spin, euler = np.linalg.solve(stiffness, loads).T
    size = np.abs(spin).max()
    np.testing.assert_allclose(given.displacement, spin, rtol=0, atol=1e-7 * size)
    assert np.abs(held.prestress().displacement / size).max() < 0.8 or share > 0
    for found, u in ((given.matrix, spin), (given.euler, euler)):
        expected = held.elements.geometric_stiffness(u)
        assert abs(found - expected).max() < 1e-7 * abs(expected).max()
    by_spin = held.stress_recovery(spin[:, None])[:, :, 0]
    np.testing.assert_allclose(given.stress, by_spin, atol=1e-6 * np.abs(by_spin).max())
    carrying = held.with_prestress(given)
    assert carrying.carried_prestress.displacement is given.displacement


def test_buckling_by_stress_at_rest_is_called_so(held):
    fine = held.prestress(stress=uniform(held, -0.4 * CRITICAL))
    held.with_prestress(fine)
    message = "buckles under its stress at rest; check sign"
    with pytest.raises(ValueError, match=message):
        held.prestress(stress=uniform(held, -1.1 * CRITICAL))
    crushed = replace(fine, constant=3.0 * fine.constant, load=None, displacement=None)
    for use in (held.with_prestress, lambda P: held.reduce(4, prestress=P)):
        with pytest.raises(ValueError, match=message):
            use(crushed)


# ------------------------------------------------------------------ few digits


def rounded(matrix: sp.csr_array, digits: int) -> sp.csr_array:
    entries = np.array([float(f"{value:.{digits - 1}e}") for value in matrix.data])
    return sp.csr_array((entries, matrix.indices, matrix.indptr), shape=matrix.shape)


def exported(rotor: SolidRotor, digits: int) -> SolidRotor:
    matrices = (rounded(matrix, digits) for matrix in (rotor.mass, rotor.stiffness))
    return SolidRotor.from_matrices(*matrices, rotor.nodes, rotor.axis)


@pytest.mark.parametrize("digits", [9, 10, 11, 16])
@pytest.mark.parametrize("names", [[], ["left"]])
def test_computed_prestress_fits_an_exported_rotor(askew, digits, names):
    rotor = askew.clamped(names) if names else askew
    exported(rotor, digits).with_prestress(rotor.prestress())


# ------------------------------------------------------------------ imported matrices
