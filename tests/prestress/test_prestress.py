"""Static prestress: equilibrium, closed solutions, the derivative of the tangent, and refusals."""

import warnings

import ngsolve as ngs
import numpy as np
import pytest
import scipy.sparse as sp
from models import STEEL, block_beam, disc_rotor
from netgen.occ import Cylinder, OCCGeometry, Pnt, Z

from exudyn_rotor import Prestress, SolidRotor, SpinAxis, free_modes
from exudyn_rotor.solid.elements import von_mises
from exudyn_rotor.theory.axis import rotations

RADIUS, THICKNESS = 0.2, 0.008


def thin_disc(order: int = 2) -> SolidRotor:
    """Return a free steel disc that spins about its axis z."""
    solid = Cylinder(Pnt(0, 0, -THICKNESS / 2), Z, RADIUS, THICKNESS)
    solid.mat("steel")
    mesh = ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=0.03))
    return SolidRotor.from_ngsolve(mesh, STEEL, "z", order=order)


@pytest.fixture(scope="module")
def disc() -> SolidRotor:
    return thin_disc()


@pytest.fixture(scope="module")
def beam() -> SolidRotor:
    return SolidRotor.from_ngsolve(block_beam(), STEEL, SpinAxis((1, 0, 0), (0, 0, -0.1)))


@pytest.fixture(scope="module")
def unbalanced() -> SolidRotor:
    """A free rotor whose axis is no principal axis."""
    rotor = disc_rotor()
    return rotor.add_point_mass((0.15, 0, 0.2), 0.4).add_point_mass((-0.1, 0.1, 0.23), 0.2)


def balanced_load(rotor: SolidRotor) -> np.ndarray:
    """Return the centrifugal load per ω² less the inertia of the rigid motion it causes."""
    load = rotor.mass @ rotor.axis.radial(rotor.nodes).ravel()
    rigid = np.hstack([np.tile(np.eye(3), (rotor.node_count, 1)), rotations(rotor.nodes, (0,) * 3)])
    acceleration = np.linalg.solve(rigid.T @ rotor.mass @ rigid, rigid.T @ load)
    return load - rotor.mass @ (rigid @ acceleration)


# ------------------------------------------------------------------ equilibrium


def test_displacement_is_in_equilibrium_with_the_balanced_load(unbalanced):
    displacement = unbalanced.prestress().displacement
    load = balanced_load(unbalanced)
    left = unbalanced.stiffness @ displacement - load
    assert np.abs(left).max() < 1e-9 * np.abs(load).max()
    momentum = unbalanced.mass @ displacement
    assert np.abs(rotations(unbalanced.nodes, (0, 0, 0)).T @ momentum).max() < 1e-20


# ------------------------------------------------------------------ closed solutions


def test_thin_disc_grows_and_is_stressed_as_in_plane_stress(disc):
    # Timoshenko and Goodier, Theory of Elasticity, rotating disk without hole
    prestress, nu = disc.prestress(), STEEL["poissonsRatio"]
    E, rho = STEEL["youngsModulus"], STEEL["density"]
    at = disc.nodes[:, :2]
    r = np.linalg.norm(at, axis=1)
    rim = np.flatnonzero(r > 0.999 * RADIUS)
    radial = np.sum(prestress.displacement.reshape(-1, 3)[:, :2] * at, axis=1)[rim] / r[rim]
    np.testing.assert_allclose(radial.mean(), rho * (1 - nu) / (4 * E) * RADIUS**3, rtol=2e-3)
    hoop_at_rim = rho * (1 - nu) / 4 * RADIUS**2
    np.testing.assert_allclose(von_mises(prestress.stress[rim]).mean(), hoop_at_rim, rtol=0.02)
    middle = prestress.stress[r < 0.3 * RADIUS]
    radius = r[r < 0.3 * RADIUS]
    both = rho / 8 * (2 * (3 + nu) * RADIUS**2 - (4 + 4 * nu) * radius**2)
    np.testing.assert_allclose(middle[:, 0] + middle[:, 1], both, rtol=0.02)


def test_tension_at_rest_lifts_the_frequency_of_a_clamped_beam(beam):
    held = beam.clamped(["left", "right"])
    tension = np.zeros((held.node_count, 6))
    tension[:, 2] = 2e7
    stretched = held.with_prestress(held.prestress(stress=tension))
    before, after = (free_modes(rotor, 1).frequencies[0] ** 2 for rotor in (held, stretched))
    # Rayleigh's quotient σ ∫w'² / ρ∫w² with the first mode of a clamped Euler beam
    root, length = 4.730040744862704, 0.3
    ratio = (np.cosh(root) - np.cos(root)) / (np.sinh(root) - np.sin(root))
    s = np.linspace(0, 1, 20001)
    w = np.cosh(root * s) - np.cos(root * s) - ratio * (np.sinh(root * s) - np.sin(root * s))
    slope = np.gradient(w, s) / length
    expected = 2e7 / STEEL["density"] * np.sum(slope**2) / np.sum(w**2)
    # a beam of this thickness also shears, which makes its mode shape a little rounder
    assert after - before == pytest.approx(expected, rel=0.05)


# ------------------------------------------------------------------ initial displacement


def test_both_parts_are_the_derivative_of_the_tangent(beam):
    """Automatic differentiation of St. Venant–Kirchhoff energy; its tangent is quadratic in u."""
    mesh, count = block_beam(), beam.node_count
    mesh.ngmesh.SecondOrder()
    double = STEEL["youngsModulus"] / (1 + STEEL["poissonsRatio"])
    first = double * STEEL["poissonsRatio"] / (1 - 2 * STEEL["poissonsRatio"])
    scalar = ngs.NodalFESpace(mesh, order=2)
    space = scalar * scalar * scalar
    rows = [ngs.grad(component) for component in space.TrialFunction()]
    F = ngs.Id(3) + ngs.CoefficientFunction(tuple(row[j] for row in rows for j in range(3)), (3, 3))
    E = 0.5 * (F.trans * F - ngs.Id(3))
    energy = 0.5 * (double * ngs.InnerProduct(E, E) + first * ngs.Trace(E) ** 2)
    form = ngs.BilinearForm(space)
    form += ngs.Variation(energy * ngs.dx)
    u = np.random.default_rng(2).normal(size=3 * count)

    def tangent(scale: float) -> sp.csr_array:
        static = ngs.GridFunction(space)
        static.vec.FV().NumPy()[:] = scale * u.reshape(-1, 3).T.ravel()
        form.AssembleLinearization(static.vec)
        order = np.arange(3 * count).reshape(3, count).T.ravel()
        return sp.csr_array(form.mat.CSR(), copy=True)[order][:, order]

    step = 1e-3
    expected = (tangent(step) - tangent(-step)) / (2 * step)
    elements = beam.elements
    geometric = elements.geometric_stiffness(u)
    found = geometric + elements.initial_displacement_stiffness(u)
    assert abs(found - expected).max() < 1e-9 * abs(expected).max()
    assert abs(geometric - expected).max() > 0.1 * abs(expected).max()


# ------------------------------------------------------------------ yielding


def test_yielding_is_reported_with_its_place(disc):
    prestress = disc.prestress()
    worst = int(np.argmax(von_mises(prestress.stress)))
    limit = np.sqrt(3e8 / von_mises(prestress.stress)[worst])
    with pytest.warns(UserWarning, match=rf"node {worst} \(.*yield_stress=3e\+08"):
        disc.prestress(yield_stress=3e8, speed=1.01 * limit)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        disc.prestress(yield_stress=3e8, speed=0.99 * limit)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"yield_stress": -1.0}, r"yield_stress: needs a finite number \[Pa\] > 0, got -1.0"),
        (
            {"yield_stress": 1e8, "speed": np.inf},
            r"speed: needs a finite number \[rad/s\] > 0, got inf",
        ),
        ({"speed": 100.0}, "give yield_stress="),
        ({"clamped": ["nose"]}, "clamped: 'nose' is unknown; there are: 'left', 'right'"),
    ],
)
def test_impossible_arguments_are_refused(beam, given, message):
    with pytest.raises(ValueError, match=message):
        beam.prestress(**given)


# ------------------------------------------------------------------ imported matrices, refusals


def test_imported_matrix_is_taken_as_it_is(disc):
    computed = disc.prestress(euler=True)
    imported = Prestress.from_matrix(computed.matrix, disc.nodes, computed.matrix.toarray())
    assert abs(imported.matrix - computed.matrix).max() == 0.0
    assert abs(imported.euler - computed.matrix).max() == 0.0
    assert imported.displacement is None
    assert imported.per_fourth_power is None
    K_u, K_uu = 2.0 * computed.matrix, 3.0 * computed.matrix
    more = Prestress.from_matrix(computed.matrix, disc.nodes, initial_displacement=(K_u, K_uu))
    assert abs(more.per_square - 3.0 * computed.matrix).max() < 1e-12 * abs(K_u).max()
    assert abs(more.per_fourth_power - K_uu).max() == 0.0
    assert "initial_displacement" in repr(more)
