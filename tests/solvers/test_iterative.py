"""The iterative solver: what the direct one finds, in memory that is known before."""

import numpy as np
import pytest
from models import ALUMINIUM as LIGHT
from models import STEEL, block_beam, two_material_cylinder
from netgen.occ import Box, OCCGeometry
from ngsolve import Mesh

from exudyn_rotor import SolidRotor, craig_bampton_modes, free_modes
from exudyn_rotor.reduction.attachment import attachment_modes
from exudyn_rotor.solvers import davidson, two_level
from exudyn_rotor.solvers import inertia_relief as choice
from exudyn_rotor.solvers.factor import TooLittleMemoryError
from exudyn_rotor.solvers.inertia_relief import inertia_relief

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


@pytest.mark.parametrize("case", ["free", "held", "few elements"])
def test_modes_are_those_of_the_factor(cylinder, case):
    few = SolidRotor.from_ngsolve(block_beam(maxh=0.3), STEEL, "z")
    rotor = {"free": cylinder, "held": cylinder.clamped("left"), "few elements": few}[case]
    expected, found = (free_modes(one, 12) for one in both(rotor))
    np.testing.assert_allclose(found.frequencies, expected.frequencies, rtol=SAME_FREQUENCY)


@pytest.mark.parametrize("coupling", ["RBE2", "RBE3"])
def test_craig_bampton_modes_are_those_of_the_factor(cylinder, coupling, monkeypatch):
    monkeypatch.setattr("pyngcore.GetNumThreads", lambda: 2)
    monkeypatch.setattr(davidson, "_MOST_STEPS", 27)  # 25 are needed
    modes = [craig_bampton_modes(one, 4, coupling=coupling) for one in both(cylinder)]
    expected, found = (one.frequencies[12:] for one in modes)
    np.testing.assert_allclose(found, expected, rtol=SAME_FREQUENCY)
    expected, found = (one.matrix[:, :12] for one in modes)
    np.testing.assert_allclose(found, expected, atol=SAME_DISPLACEMENT * np.abs(expected).max())
    monkeypatch.setattr(davidson, "_MOST_STEPS", 1)
    with pytest.raises(ValueError, match=r"of 5 modes converged in 1 steps; use rotor\.with"):
        craig_bampton_modes(both(cylinder)[1], 4, coupling=coupling)


def test_static_solutions_are_those_of_the_factor(cylinder, monkeypatch):
    monkeypatch.setattr(two_level.conjugate_gradients, "__defaults__", (60,))  # 46 are needed
    expected, found = (one.prestress().displacement for one in both(cylinder))
    assert np.linalg.norm(found - expected) < SAME_DISPLACEMENT * np.linalg.norm(expected)
    none = np.zeros((cylinder.nodes.size, 0))
    # 1e-8 is what these leave
    expected, found = (attachment_modes(one, none) for one in both(cylinder))
    np.testing.assert_allclose(found, expected, atol=1e-6 * np.abs(expected).max())


def test_iteration_that_is_slow_says_at_once_what_to_do():
    """A plate of one element through the thickness, which linear elements cannot bend."""
    mesh = Mesh(OCCGeometry(Box((0, -0.1, 0), (0.2, 0.1, 0.001))).GenerateMesh(maxh=0.05))
    plate = SolidRotor.from_ngsolve(mesh, STEEL, "z").with_solver("iterative")
    for act in (plate.prestress, lambda: free_modes(plate, 3)):
        with pytest.raises(ValueError, match=r"after 100 steps; use rotor\.with_solver\('direct"):
            act()


def test_too_little_memory_is_told_before_anything_is_computed(cylinder, monkeypatch):
    matrices = cylinder.mass, cylinder.stiffness, cylinder.nodes, "z"
    plain = SolidRotor.from_matrices(*matrices)
    monkeypatch.setattr(choice, "_QUICK", 0)
    monkeypatch.setattr(choice, "available_memory", lambda: 1e6)
    for rotor in (plain, cylinder.with_solver("direct"), cylinder):
        with pytest.raises(
            TooLittleMemoryError, match=r"needs up to 0\.\d GB, and 0\.0 GB of memory"
        ):
            free_modes(rotor, 2)


def test_iteration_takes_over_where_a_factor_does_not_fit_or_is_slow(cylinder, monkeypatch):
    monkeypatch.setattr(choice, "_QUICK", 0)
    assert not inertia_relief(cylinder).iterative
    monkeypatch.setattr(choice, "_ITERATIVE_PER_COORDINATE", 0.0)
    monkeypatch.setattr(choice, "_ITERATIVE_PER_ENTRY", 0.0)
    monkeypatch.setattr(choice, "available_memory", lambda: 1e6)
    heavier = cylinder.add_point_mass([0.0, 0.1, 0.1], 0.1)
    assert inertia_relief(heavier).iterative
    monkeypatch.undo()
    for name in ("_QUICK", "_ITERATED", "_ITERATED_BESIDE_PARDISO"):
        monkeypatch.setattr(choice, name, 0)
    assert inertia_relief(cylinder.add_point_mass([0.0, 0.1, 0.1], 0.2)).iterative


def test_iteration_needs_elements(cylinder):
    plain = SolidRotor.from_matrices(cylinder.mass, cylinder.stiffness.copy(), cylinder.nodes, "z")
    linear = SolidRotor.from_ngsolve(block_beam(), STEEL, "z", order=1)
    for one in (plain, linear):
        with pytest.raises(ValueError, match="needs a model of second-order elements made by"):
            free_modes(one.with_solver("iterative"), 2)
    with pytest.raises(ValueError, match="solver"):
        cylinder.with_solver("quick")
