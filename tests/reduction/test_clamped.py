"""Clamped nodes: modes, geometric stiffness, refusals."""

import numpy as np
import pytest
import scipy.linalg as la
from models import STEEL, block_beam

from exudyn_rotor import SolidRotor, SpinAxis, craig_bampton_modes, free_modes


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
