"""Prestress: a stress at rest in the static solution, few digits, soft springs, free rotors."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from models import STEEL, block_beam

from exudyn_rotor import Prestress, SolidRotor, SpinAxis
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


def test_static_displacement_is_the_sum_of_many_modes(held):
    given = held.prestress(stress=uniform(held, -0.7 * CRITICAL))
    reduced = held.reduce(60, prestress=given)
    shapes = reduced.shapes.matrix
    stiffness = shapes.T @ ((held.stiffness + given.constant) @ shapes)
    by_modes = shapes @ np.linalg.solve(stiffness, shapes.T @ centrifugal_load(held))
    expected = given.displacement
    assert np.linalg.norm(by_modes - expected) < 1e-3 * np.linalg.norm(expected)


def test_hub_holds_the_stressed_rotor_as_clamping_does(bar, held):
    names = ["left", "right"]
    stress = uniform(bar, -0.2 * CRITICAL)  # ends held by hinges buckle at a quarter
    by_hub = bar.prestress(clamped=names, stress=stress)
    expected = held.prestress(stress=stress).displacement
    size = np.abs(expected).max()
    np.testing.assert_allclose(by_hub.displacement, expected, rtol=0, atol=1e-6 * size)
    bar.with_prestress(by_hub)


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


@pytest.mark.parametrize("digits", [10, 16])
@pytest.mark.parametrize("names", [[], ["left"]])
def test_other_modulus_is_seen_in_an_exported_rotor(askew, digits, names):
    other = SolidRotor.from_ngsolve(block_beam(), STEEL | {"youngsModulus": 2.1021e11}, ASKEW)
    rotor, other = (r.clamped(names) if names else r for r in (askew, other))
    with pytest.raises(ValueError, match=r"none of this rotor.*rounding of an exported matrix"):
        exported(rotor, digits).with_prestress(other.prestress())


# ------------------------------------------------------------------ imported matrices


@pytest.mark.parametrize("spring", [1e2, 1e4, 1e6])
@pytest.mark.parametrize("where", ["left", "both", "all"])
@pytest.mark.parametrize("digits", [10, 16])
def test_soft_springs_take_up_the_net_load(askew, spring, where, digits):
    ends = [askew.interfaces[name].nodes for name in ("left", "right")]
    places = {"left": ends[0], "both": np.concatenate(ends), "all": slice(None)}
    held = np.zeros((askew.node_count, 3))
    held[places[where]] = spring
    stiffness = sp.csc_array(askew.stiffness + sp.diags_array(held.ravel()))
    rotor = SolidRotor.from_matrices(askew.mass, stiffness, askew.nodes, askew.axis, grounded=True)
    u = sp.linalg.spsolve(stiffness, centrifugal_load(rotor))
    matrix = rounded(askew.elements.geometric_stiffness(u), digits)
    rotor.with_prestress(Prestress.from_matrix(matrix, rotor.nodes))
    if where == "all":
        return
    for factor in (-1.0, 0.5, 0.98, 100.0):
        with pytest.raises(ValueError, match="prestress: the matrix times the nodal positions"):
            rotor.with_prestress(Prestress.from_matrix(factor * matrix, rotor.nodes))


@pytest.mark.parametrize("factor", [1.0, 1e-3, 1e-8])
def test_elastic_stiffness_in_the_matrix_of_a_free_rotor_is_refused(askew, factor):
    own = askew.prestress()
    askew.with_prestress(Prestress.from_matrix(own.matrix, askew.nodes))
    tangent = own.matrix + factor * askew.stiffness
    for wrong in (Prestress.from_matrix(tangent, askew.nodes), replace(own, matrix=tangent)):
        with pytest.raises(ValueError, match=r"uniform strains.*no elastic stiffness"):
            askew.with_prestress(wrong)


@pytest.mark.parametrize("settings", [{"initial_displacement": True}, {"clamped": "left"}])
def test_what_belongs_to_a_computed_matrix_is_no_elastic_stiffness(askew, settings):
    askew.with_prestress(askew.prestress(euler=True, **settings))


@pytest.mark.parametrize("factor", [-1.0, 0.5, 100.0])
@pytest.mark.parametrize("share", [0.0, -0.7])
def test_changed_computed_matrix_is_refused_on_grounded_rotors(held, factor, share):
    own = held.prestress(stress=uniform(held, share * CRITICAL) if share else None)
    with pytest.raises(ValueError, match="prestress: the matrix times the nodal positions"):
        held.with_prestress(replace(own, matrix=factor * own.matrix))
