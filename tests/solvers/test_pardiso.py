"""Factors by Pardiso, where it is installed, and modes with any factor."""

import warnings

import numpy as np
import pytest
import scipy.sparse as sp
from models import STEEL
from netgen.occ import Cylinder, OCCGeometry, Pnt, X
from ngsolve import Mesh

from exudyn_rotor import SolidRotor, free_modes
from exudyn_rotor.solvers import factor
from exudyn_rotor.solvers.factor import SparseCholesky
from exudyn_rotor.solvers.inertia_relief import inertia_relief
from exudyn_rotor.solvers.modes import lanczos_modes


@pytest.fixture(scope="module")
def shaft():
    mesh = Mesh(OCCGeometry(Cylinder(Pnt(0, 0, 0), X, 0.04, 0.4)).GenerateMesh(maxh=0.03))
    return SolidRotor.from_ngsolve(mesh, STEEL, axis="x", interfaces=())


def laplacian(points: int) -> sp.csr_array:
    """Return the stiffness of a grid of springs, all edges held, in three dimensions."""
    one = sp.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(points, points))
    unit = sp.eye_array(points)
    parts = ([one, unit, unit], [unit, one, unit], [unit, unit, one])
    return sp.csr_array(sum(sp.kron(sp.kron(a, b), c) for a, b, c in parts))


def test_modes_of_a_large_residual_leave_smooth_forces(shaft):
    relief = inertia_relief(shaft)
    values, modes = lanczos_modes(shaft.mass, relief.solve, 12, 3e-7)
    assert np.sqrt(values) == pytest.approx(free_modes(shaft, 12).frequencies, rel=1e-9)
    assert modes.T @ (shaft.mass @ modes) == pytest.approx(np.eye(12), abs=1e-10)
    inertia = shaft.mass @ (modes * values)
    left = np.linalg.norm(shaft.stiffness @ modes - inertia, axis=0)
    # 1e-4 in the forces of bare Ritz vectors
    assert np.all(left < 1e-6 * np.linalg.norm(inertia, axis=0))


def test_pardiso_solves_many_right_hand_sides_and_says_what_fails(monkeypatch):
    pytest.importorskip("pypardiso")
    matrix = laplacian(22)
    assert matrix.shape[0] > factor.PARDISO_SIZE
    known = np.random.default_rng(3).standard_normal((matrix.shape[0], 4))
    made = SparseCholesky(matrix)
    # the condition of the grid is (2 · 22/π)² ≈ 200
    assert made.solve(matrix @ known) == pytest.approx(known, abs=1e-11)
    assert made.solve(matrix @ known[:, 0]) == pytest.approx(known[:, 0], abs=1e-11)
    assert made.solve(np.zeros((matrix.shape[0], 0))).shape == (matrix.shape[0], 0)
    indefinite = sp.csr_array(matrix - sp.eye_array(matrix.shape[0]))
    with pytest.raises(factor.NotPositiveDefiniteError, match="a pivot that is not positive"):
        SparseCholesky(indefinite)
    monkeypatch.setattr(factor, "_NO_MEMORY", (-4,))  # what this error has for its number
    with pytest.raises(factor.TooLittleMemoryError, match="for 10648 coordinates; use a coarser"):
        SparseCholesky(indefinite)


def test_pardiso_gives_the_modes_of_ngsolve(shaft, monkeypatch):
    pytest.importorskip("pypardiso")
    expected = free_modes(shaft, 12)
    made = []
    by_pardiso = factor._by_pardiso
    monkeypatch.setattr(factor, "PARDISO_SIZE", factor.DENSE_SIZE)
    monkeypatch.setattr(factor, "_by_pardiso", lambda one: made.append(one) or by_pardiso(one))
    again = SolidRotor.from_matrices(shaft.mass, shaft.stiffness.copy(), shaft.nodes, "x")
    assert free_modes(again, 12).frequencies == pytest.approx(expected.frequencies, rel=1e-9)
    assert len(made) == 1


def test_mkl_is_named_once_where_a_model_is_large(shaft, monkeypatch):
    """Not where it is installed."""
    monkeypatch.setattr(factor, "_LARGE", 100)
    monkeypatch.setattr("platform.machine", lambda: "AMD64")
    monkeypatch.setattr("sys.platform", "linux")
    for installed, count in ((False, 1), (True, 0)):
        monkeypatch.setattr(factor, "has_pardiso", lambda installed=installed: installed)
        monkeypatch.setattr(factor, "PARDISO_SIZE", 0)
        monkeypatch.setattr(factor, "_by_pardiso", factor._by_ngsolve)
        factor._tell_of_mkl.cache_clear()
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            for _ in range(2):
                stiffness = shaft.stiffness.copy()  # whose factor is not known yet
                free_modes(SolidRotor.from_matrices(shaft.mass, stiffness, shaft.nodes, "x"), 1)
        assert len([one for one in caught if "mkl" in str(one.message)]) == count


def test_memory_is_that_of_the_container(monkeypatch, tmp_path):
    for name, text in (("max", "5000\n"), ("current", "3000\n")):
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(factor, "_GROUP", (tmp_path / "max", tmp_path / "current"))
    assert factor.available_memory() == 2000.0
