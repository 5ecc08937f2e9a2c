"""Clamped nodes: modes, geometric stiffness, refusals."""

import ngsolve as ngs
import numpy as np
import pytest
import scipy.linalg as la
from models import STEEL, block_beam
from netgen.occ import Cylinder, OCCGeometry, Pnt, Z

from exudyn_rotor import SolidRotor, SpinAxis, craig_bampton_modes, free_modes
from exudyn_rotor.solid.clamp import held_directions


@pytest.fixture(scope="module")
def beam() -> SolidRotor:
    return SolidRotor.from_ngsolve(block_beam(), STEEL, SpinAxis((1, 0, 0), (0, 0, -0.1)))


def test_clamped_modes_are_those_without_the_held_coordinates(beam):
    held = beam.clamped("left")
    assert held.grounded
    assert held.rigid_motions == 0
    nodes = np.setdiff1d(np.arange(beam.node_count), beam.interfaces["left"].nodes)
    rows = (3 * nodes[:, None] + np.arange(3)).ravel()
    K, M = (X.toarray()[np.ix_(rows, rows)] for X in (beam.stiffness, beam.mass))
    expected = np.sqrt(la.eigh(K, M, eigvals_only=True, subset_by_index=[0, 4]))
    modes = free_modes(held, 5)
    np.testing.assert_allclose(modes.frequencies, expected, rtol=1e-9)
    shapes = modes.matrix.reshape(-1, 3, 5)
    moved = np.abs(shapes[beam.interfaces["left"].nodes]).max()
    assert moved < 1e-9 * np.abs(shapes).max()


def test_clamped_rows_have_no_geometric_stiffness(beam):
    held = beam.clamped("left")
    matrix = held.prestress(initial_displacement=True).matrix.tolil()
    rows = (3 * beam.interfaces["left"].nodes[:, None] + np.arange(3)).ravel()
    assert matrix[rows].nnz == 0
    free = beam.prestress(clamped="left")
    assert not free.balanced
    np.testing.assert_allclose(free.displacement, held.prestress().displacement, rtol=1e-9)


def test_clamping_needs_a_known_interface(beam):
    for names, message in (("nose", "names: 'nose' is unknown"), ([], "names: needs one")):
        with pytest.raises(ValueError, match=message):
            beam.clamped(names)


DIRECTIONS = [["radial"], ["tangential"], ["axial"], ["radial", "axial"], ["radial", "tangential"]]


@pytest.mark.parametrize("directions", DIRECTIONS)
@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (0.0, 0.6, 0.8), (1.0, -0.3, 0.2)])
def test_slender_rotors_are_held_across_the_mesh_axes(axis, directions):
    """As with the held directions taken out of the equations, on a shaft of fifty diameters.

    Dense eigenvalues err by some eps of the largest, the springs' here, over the one that is asked.
    """
    shaft = Cylinder(Pnt(0, 0, 0), Z, 0.02, 2.0)
    shaft.faces.Min(Z).name = "left"
    mesh = ngs.Mesh(OCCGeometry(shaft).GenerateMesh(maxh=0.1, curvaturesafety=0.5))
    rotor = SolidRotor.from_ngsolve(mesh, STEEL, axis, order=1)
    held = rotor.clamped("left", directions)
    nodes = rotor.interfaces["left"].nodes
    allowed = la.null_space(held_directions(rotor.nodes, rotor.axis, nodes, directions).T.toarray())
    K, M = (allowed.T @ (matrix @ allowed) for matrix in (rotor.stiffness, rotor.mass))
    values = la.eigvalsh(K, M)
    expected = values[held.rigid_motions :][:3]
    found = free_modes(held, 3).frequencies ** 2
    precision = np.finfo(float).eps * 1e3 * values[-1] / expected[0]
    np.testing.assert_allclose(found, expected, rtol=precision)


def test_springs_of_a_second_clamp_are_no_stiffer(beam):
    twice, once = beam.clamped("left").clamped("right"), beam.clamped(["left", "right"])
    assert twice.stiffness.diagonal().max() == once.stiffness.diagonal().max()


@pytest.mark.parametrize("coupling", ["RBE2", "RBE3"])
def test_craig_bampton_modes_leave_out_a_clamped_interface(beam, coupling):
    """Its motions are those of the springs that hold it, a thousand times those of the mesh."""
    held = beam.clamped("left")
    modes = craig_bampton_modes(held, 4, coupling=coupling)
    assert {label.split()[0] for label in modes.labels[:6]} == {"right"}
    chosen = craig_bampton_modes(held, 4, ["right"], coupling=coupling)
    np.testing.assert_allclose(modes.matrix, chosen.matrix)
    bound = np.sqrt((beam.stiffness.diagonal() / beam.mass.diagonal()).max())
    assert held.reduce(modes).frequencies.max() < bound


def test_craig_bampton_modes_say_what_is_held_in_part(beam):
    held = beam.clamped("left", "z")
    with pytest.raises(ValueError, match=r"clamped in some directions: leave it out, interfaces="):
        craig_bampton_modes(held, 4, coupling="RBE3")
    assert len(craig_bampton_modes(held, 4, ["right"], coupling="RBE3").labels) == 10
