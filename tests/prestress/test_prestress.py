"""Static prestress: equilibrium, closed solutions, the derivative of the tangent, and refusals."""

import ngsolve as ngs
import numpy as np
import pytest
import scipy.sparse as sp
from models import STEEL, block_beam, disc_rotor
from netgen.occ import Cylinder, OCCGeometry, Pnt, Z

from exudyn_rotor import Prestress, SolidRotor, SpinAxis
from exudyn_rotor.prestress.carrying import estimated_stiffness
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
    found = geometric + elements.displacement_stiffness(u)[0]
    assert abs(found - expected).max() < 1e-9 * abs(expected).max()
    assert abs(geometric - expected).max() > 0.1 * abs(expected).max()


# ------------------------------------------------------------------ imported matrices, refusals


def test_imported_matrix_is_taken_as_it_is(disc):
    computed = disc.prestress()
    imported = Prestress(computed.matrix.toarray(), disc.nodes)
    assert abs(imported.matrix - computed.matrix).max() == 0.0
    assert imported.displacement is imported.per_fourth_power is None
    assert disc.with_prestress(imported).carried_prestress is imported


def softened(disc: SolidRotor) -> Prestress:
    """Return an imported matrix that holds the spin softening as well."""
    across = np.diag(np.tile([1.0, 1.0, 0.0], disc.node_count))
    return Prestress(disc.prestress().matrix - across @ disc.mass, disc.nodes)


@pytest.mark.parametrize(
    ("carrying", "message"),
    [
        (lambda disc, _: disc.prestress(yield_stress=-1.0), r"yield_stress: needs .*got -1.0"),
        (lambda disc, beam: disc.with_prestress(beam.prestress()), "prestress from another mesh"),
        (
            lambda disc, _: disc.add_point_mass([RADIUS, 0, 0], 0.1).with_prestress(
                disc.prestress()
            ),
            "belongs to another rotor: its elastic forces differ by",
        ),
        (
            lambda _, beam: beam.clamped(["left"]).with_prestress(beam.prestress()),
            "belongs to another rotor",
        ),
        (lambda disc, _: disc.with_prestress(softened(disc)), r"alone \(no spin softening"),
        (
            lambda disc, _: disc.with_prestress(disc.prestress()).prestress(),
            "carries a prestress already",
        ),
    ],
)
def test_prestress_of_another_state_is_refused(disc, beam, carrying, message):
    with pytest.raises(ValueError, match=message):
        carrying(disc, beam)


@pytest.mark.parametrize("places", [np.arange(51.0), np.arange(51.0) // 2.0])
def test_points_that_no_truss_holds_have_no_estimate(places):
    """In a row, where bars hold nothing across it; and of which two are at one place."""
    path = np.diag([1.0, *[2.0] * 49, 1.0]) - np.eye(51, k=1) - np.eye(51, k=-1)
    nodes = np.outer(places, [0.0, 0.0, 1.0])
    row = SolidRotor.from_matrices(np.eye(153), np.kron(path, np.eye(3)), nodes, "z")
    assert estimated_stiffness(row) is None
    with pytest.raises(ValueError, match="prestress: this rotor has no elements"):
        row.prestress()
