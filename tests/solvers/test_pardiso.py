"""Factors by Pardiso, where it is installed, and modes by wide blocks with any factor."""

import warnings

import numpy as np
import pytest
import scipy.sparse as sp
from netgen.occ import Cylinder, OCCGeometry, Pnt, X
from ngsolve import Mesh

from exudyn_rotor import SolidRotor, free_modes
from exudyn_rotor.solvers import choice, factor, pardiso
from exudyn_rotor.solvers.factor import SparseCholesky
from exudyn_rotor.solvers.inertia_relief import inertia_relief
from exudyn_rotor.solvers.lanczos import lanczos_modes
from exudyn_rotor.solvers.memory import TooLittleMemoryError

STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}


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


def test_pardiso_solves_many_right_hand_sides():
    pytest.importorskip("pypardiso")
    matrix = laplacian(22)
    assert matrix.shape[0] > pardiso.SMALLEST
    known = np.random.default_rng(3).standard_normal((matrix.shape[0], 4))
    made = SparseCholesky(matrix)
    assert made.uses_pardiso
    # the condition of the grid is (2 · 22/π)² ≈ 200
    assert made.solve(matrix @ known) == pytest.approx(known, abs=1e-11)
    assert made.solve(matrix @ known[:, 0]) == pytest.approx(known[:, 0], abs=1e-11)
    assert made.solve(np.zeros((matrix.shape[0], 0))).shape == (matrix.shape[0], 0)


def test_pardiso_gives_the_modes_of_ngsolve(shaft, monkeypatch):
    pytest.importorskip("pypardiso")
    expected = free_modes(shaft, 12)
    monkeypatch.setattr(pardiso, "SMALLEST", factor.DENSE_SIZE)
    again = SolidRotor.from_matrices(shaft.mass, shaft.stiffness.copy(), shaft.nodes, "x")
    found = free_modes(again, 12)
    assert inertia_relief(again)._factor.uses_pardiso
    assert found.frequencies == pytest.approx(expected.frequencies, rel=1e-9)


def test_choice_with_pardiso(shaft, monkeypatch):
    """A factor, unless it does not fit or takes much longer; asked for, an error before it."""
    pytest.importorskip("pypardiso")
    monkeypatch.setattr(pardiso, "SMALLEST", factor.DENSE_SIZE)
    monkeypatch.setattr(choice, "_QUICK", 0)
    ordered, way = pardiso.Ordered(shaft.stiffness), choice.way_of(shaft)
    assert not choice.is_iterative(way, shaft.stiffness, ordered)
    monkeypatch.setattr(ordered, "operations", 1e13)
    assert choice.is_iterative(way, shaft.stiffness, ordered)
    assert choice.fits_directly(way, shaft.stiffness, ordered)
    monkeypatch.setattr(choice, "available_memory", lambda: 0.9 * ordered.needed)
    assert not choice.fits_directly(way, shaft.stiffness, ordered)
    with pytest.raises(TooLittleMemoryError, match="needs up to"):
        inertia_relief(shaft.with_solver("direct"))
    monkeypatch.setattr(pardiso, "available_memory", lambda: 1e6)
    with pytest.raises(TooLittleMemoryError, match="to order the factor of"):
        pardiso.Ordered(shaft.stiffness)


def test_mkl_is_named_once_where_a_model_is_large(shaft, monkeypatch):
    """Not where it is installed, or where there is none for the machine."""

    def messages(calls: int = 1) -> list[str]:
        pardiso.tell_of_mkl.cache_clear()
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            for _ in range(calls):
                stiffness = shaft.stiffness.copy()  # whose factor is not known yet
                free_modes(SolidRotor.from_matrices(shaft.mass, stiffness, shaft.nodes, "x"), 1)
        return [str(one.message) for one in caught if "mkl" in str(one.message)]

    monkeypatch.setattr(pardiso, "find_spec", lambda name: None)
    monkeypatch.setattr("platform.machine", lambda: "AMD64")
    monkeypatch.setattr("sys.platform", "linux")
    assert not messages()
    monkeypatch.setattr(pardiso, "_LARGE", 100)
    assert len(messages(2)) == 1
    monkeypatch.setattr("platform.machine", lambda: "arm64")
    assert not messages()
    monkeypatch.setattr("platform.machine", lambda: "AMD64")
    monkeypatch.setattr(pardiso, "find_spec", lambda name: "installed")
    assert not messages()
