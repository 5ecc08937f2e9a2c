"""The iterative solver: what the direct one finds, in memory that is known before."""

import numpy as np
import pytest
from models import ALUMINIUM as LIGHT
from models import STEEL, two_material_cylinder
from netgen.occ import Box, OCCGeometry
from ngsolve import Mesh

from exudyn_rotor import SolidRotor, craig_bampton_modes, free_modes, spinning_modes
from exudyn_rotor.reduction.attachment import attachment_modes
from exudyn_rotor.solvers import choice, conjugate_gradients, davidson, memory
from exudyn_rotor.solvers.inertia_relief import inertia_relief
from exudyn_rotor.solvers.memory import TooLittleMemoryError

# a residual of 1e-6 of ω²Mφ leaves the square of that in ω; the rounding of K φ more
SAME_FREQUENCY = 1e-9
# twelve digits of the load, times a condition of 1e3 for smooth loads
SAME_DISPLACEMENT = 1e-9


@pytest.fixture(scope="module")
def cylinder():
    """Two materials, 0.4 m along a skew axis through its centre line."""
    mesh = two_material_cylinder(safety=0.5)
    return SolidRotor.from_ngsolve(mesh, {"steel": STEEL, "aluminium": LIGHT}, "z")


def both(rotor):
    return rotor.with_solver("direct"), rotor.with_solver("iterative")


@pytest.mark.parametrize("held", [None, ("x", "y", "z"), ("axial",), ("radial", "tangential")])
def test_modes_are_those_of_the_factor(cylinder, held):
    rotor = cylinder if held is None else cylinder.clamped("left", held)
    expected, found = (free_modes(one, 7) for one in both(rotor))
    np.testing.assert_allclose(found.frequencies, expected.frequencies, rtol=SAME_FREQUENCY)


@pytest.mark.parametrize("coupling", ["RBE2", "RBE3"])
def test_craig_bampton_modes_are_those_of_the_factor(cylinder, coupling, monkeypatch):
    monkeypatch.setattr(davidson, "_MOST_STEPS", 27)  # 25 are needed
    modes = [craig_bampton_modes(one, 4, coupling=coupling) for one in both(cylinder)]
    expected, found = (one.frequencies[12:] for one in modes)
    np.testing.assert_allclose(found, expected, rtol=SAME_FREQUENCY)
    expected, found = (one.matrix[:, :12] for one in modes)
    np.testing.assert_allclose(found, expected, atol=SAME_DISPLACEMENT * np.abs(expected).max())


def test_static_solutions_are_those_of_the_factor(cylinder, monkeypatch):
    monkeypatch.setattr(conjugate_gradients, "_MOST_STEPS", 60)  # 46 are needed
    expected, found = (one.prestress().displacement for one in both(cylinder))
    assert np.linalg.norm(found - expected) < SAME_DISPLACEMENT * np.linalg.norm(expected)
    none = np.zeros((cylinder.nodes.size, 0))
    # 1e-8 is what these leave
    expected, found = (attachment_modes(one, none).matrix for one in both(cylinder))
    np.testing.assert_allclose(found, expected, atol=1e-6 * np.abs(expected).max())


def test_spinning_modes_are_those_of_the_factor(cylinder):
    stressed = cylinder.with_prestress(cylinder.prestress())
    modes = [spinning_modes(one, 2, [500.0]).matrix for one in both(stressed)]
    shares = np.linalg.lstsq(*modes, rcond=None)[0]
    assert np.linalg.norm(modes[0] @ shares - modes[1]) < 1e-5 * np.linalg.norm(modes[1])


def test_cycle_is_symmetric_definite_and_near_the_inverse(cylinder):
    relief = inertia_relief(cylinder.with_solver("iterative"))
    loads = np.random.default_rng(3).standard_normal((cylinder.nodes.size, 4))
    work = loads.T @ relief.precondition(loads)
    # single precision
    assert np.abs(work - work.T).max() < 1e-4 * np.abs(work).max()
    assert np.linalg.eigvalsh(0.5 * (work + work.T))[0] > 0.0
    # 0.46 here, 0.35 on finer meshes of one material; without linear elements 0.9 and more
    load = cylinder.stiffness @ relief.precondition(loads)[:, 0]
    assert conjugate_gradients.rate(cylinder.stiffness, relief.precondition, load) < 0.5


def test_smoothing_is_two_steps_of_chebyshev_iteration(cylinder):
    """It leaves ``T₂((θ − BK)/δ) / T₂(θ/δ)`` of ``B f``, T₂ = 2x² − 1, B the blocks' inverse."""
    cycle = inertia_relief(cylinder.with_solver("iterative"))._two_level
    stiffness = cylinder.stiffness
    blocks = [stiffness[i : i + 3, i : i + 3].toarray() for i in (0, 300)]
    inverse = cycle._blocks.toarray()
    for i, block in zip((0, 300), blocks, strict=True):
        np.testing.assert_allclose(inverse[i : i + 3, i : i + 3] @ block, np.eye(3), atol=1e-5)
    load = np.random.default_rng(5).standard_normal((stiffness.shape[0], 1))
    moved = sum(cycle._smoothed(load.astype(np.float32))).astype(float)
    scaled, ratio = inverse @ load, cycle._middle / cycle._half

    def applied(column):
        return (cycle._middle * column - inverse @ (stiffness @ column)) / cycle._half

    expected = (2.0 * applied(applied(scaled)) - scaled) / (2.0 * ratio**2 - 1.0)
    left = inverse @ (load - stiffness @ moved)
    # single precision
    assert np.linalg.norm(left - expected) < 1e-4 * np.linalg.norm(scaled)


def test_slow_iteration_gives_way_to_a_factor(monkeypatch):
    """A plate of one element through the thickness, which linear elements cannot bend."""
    mesh = Mesh(OCCGeometry(Box((0, -0.1, 0), (0.2, 0.1, 0.001))).GenerateMesh(maxh=0.05))
    plate = SolidRotor.from_ngsolve(mesh, STEEL, "z")
    monkeypatch.setattr(choice, "_QUICK", 0)
    monkeypatch.setattr(choice, "_WORTH_IT", 0.0)
    assert not inertia_relief(plate).iterative
    monkeypatch.setattr(conjugate_gradients, "_MOST_STEPS", 10)
    with pytest.raises(ValueError, match=r"after 10 steps; use rotor\.with_solver\('direct'\)"):
        plate.with_solver("iterative").prestress()


def test_modes_that_do_not_converge_are_an_error(cylinder, monkeypatch):
    monkeypatch.setattr(davidson, "_MOST_STEPS", 2)
    with pytest.raises(ValueError, match="only 0 of 4 modes converged in 2 steps"):
        free_modes(cylinder.with_solver("iterative"), 4)


@pytest.fixture(scope="module")
def cube():
    mesh = Mesh(OCCGeometry(Box((0, 0, 0), (1, 1, 1))).GenerateMesh(maxh=0.25))
    return SolidRotor.from_ngsolve(mesh, STEEL, "z")


def test_linear_elements_hold_linear_displacements(cube):
    matrix = cube.elements.interpolation()
    positions = cube.nodes.ravel()
    np.testing.assert_allclose(matrix @ positions[: matrix.shape[1]], positions, atol=1e-12)
    assert matrix.shape[1] == 3 * cube.elements.mesh.nv


def test_too_little_memory_is_told_before_anything_is_computed(cylinder, monkeypatch):
    matrices = cylinder.mass, cylinder.stiffness, cylinder.nodes, "z"
    plain = SolidRotor.from_matrices(*matrices)
    monkeypatch.setattr(choice, "available_memory", lambda: 1e6)
    with pytest.raises(TooLittleMemoryError, match=r"needs up to 0\.\d GB, and 0\.0 GB of memory"):
        plain.reduce(2)
    with pytest.raises(TooLittleMemoryError, match=r"use rotor\.with_solver\('auto'\)"):
        free_modes(cylinder.with_solver("direct"), 2)
    with pytest.raises(TooLittleMemoryError, match="the iterative solver needs about"):
        cylinder.reduce(2)


def test_iteration_takes_over_where_a_factor_does_not_fit(cylinder, monkeypatch):
    monkeypatch.setattr(choice, "_ITERATIVE_PER_COORDINATE", 0.0)
    monkeypatch.setattr(choice, "_ITERATIVE_PER_ENTRY", 0.0)
    assert not inertia_relief(cylinder).iterative
    monkeypatch.setattr(choice, "available_memory", lambda: 1e6)
    heavier = cylinder.add_point_mass([0.0, 0.1, 0.1], 0.1)
    assert inertia_relief(heavier).iterative


def test_iteration_needs_elements(cylinder):
    plain = SolidRotor.from_matrices(cylinder.mass, cylinder.stiffness, cylinder.nodes, "z")
    with pytest.raises(ValueError, match="needs a model of second-order elements made by"):
        free_modes(plain.with_solver("iterative"), 2)
    with pytest.raises(ValueError, match="solver"):
        cylinder.with_solver("quick")


def test_limit_of_a_container_counts(tmp_path, monkeypatch):
    limit, used = tmp_path / "memory.max", tmp_path / "memory.current"
    monkeypatch.setattr(memory, "_GROUPS", ((str(limit), str(used)),))
    free = memory.available_memory()
    assert free > 1e6
    limit.write_text("3000000\n")
    used.write_text("1000000\n")
    assert memory.available_memory() == 2e6
    limit.write_text("max\n")
    assert memory.available_memory() > 1e6
