"""Component modes against Exudyn's FEMinterface, beam theory and dense linear algebra."""

from dataclasses import replace
from types import SimpleNamespace

import netgen.occ as occ
import ngsolve
import numpy as np
import pytest
import scipy.linalg as la
import scipy.sparse as sp
from exudyn.FEM import FEMinterface, HCBstaticModeSelection, KirchhoffMaterial

from exudyn_rotor.reduction.component import fem_interface_modes, free_modes
from exudyn_rotor.reduction.craig_bampton import craig_bampton_modes
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.solvers.factor import DENSE_SIZE, NotPositiveDefiniteError, SparseCholesky
from exudyn_rotor.theory.axis import rotations, translations

EPS = float(np.finfo(float).eps)
STEEL = {"density": 7800.0, "youngsModulus": 2.1e11, "poissonsRatio": 0.3}


def stepped_shaft(size: float = 0.02) -> ngsolve.Mesh:
    """Return a shaft along z with a disc off its middle and named end faces."""
    shaft = occ.Cylinder(occ.Pnt(0, 0, 0), occ.Z, r=0.02, h=0.3)
    disc = occ.Cylinder(occ.Pnt(0, 0, 0.1), occ.Z, r=0.08, h=0.03)
    solid = shaft + disc
    solid.faces.Min(occ.Z).name = "left"
    solid.faces.Max(occ.Z).name = "right"
    return ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=size))


@pytest.fixture(scope="module")
def shaft() -> SimpleNamespace:
    """Return the FEMinterface, its finite-element space and the rotor of one linear mesh."""
    fem = FEMinterface()
    _, _, space = fem.ImportMeshFromNGsolve(stepped_shaft(), meshOrder=1, **STEEL)
    rotor = SolidRotor.from_fem_interface(fem, "z")
    wanted = {name: rotor.interfaces[name] for name in ("left", "right")}
    assert rotor.mass.shape[0] > DENSE_SIZE
    return SimpleNamespace(fem=fem, space=space, rotor=with_interfaces(rotor, wanted))


@pytest.fixture(scope="module")
def short_fem() -> FEMinterface:
    """Return a model that is just large enough for the sparse path and quick with dense ones."""
    solid = occ.Cylinder(occ.Pnt(0, 0, 0), occ.Z, r=0.02, h=0.1)
    solid.faces.Min(occ.Z).name = "left"
    solid.faces.Max(occ.Z).name = "right"
    mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.009))
    fem = FEMinterface()
    fem.ImportMeshFromNGsolve(mesh, meshOrder=1, **STEEL)
    return fem


@pytest.fixture(scope="module")
def short_shaft(short_fem) -> SolidRotor:
    """Return the rotor of that model."""
    rotor = SolidRotor.from_fem_interface(short_fem, "z")
    assert DENSE_SIZE < rotor.mass.shape[0] < 1500
    return rotor


def with_interfaces(rotor, interfaces) -> SolidRotor:
    """Return the rotor with other interfaces."""
    return replace(rotor, interfaces=interfaces)


def supported(rotor, springs: dict[int, float], rigid_motions: int) -> SolidRotor:
    """Return the rotor with springs [N/m] from nodes to ground in x, y and z."""
    diagonal = np.zeros(rotor.mass.shape[0])
    for node, value in springs.items():
        diagonal[3 * node : 3 * node + 3] = value
    stiffness = sp.csr_array(rotor.stiffness + sp.diags_array(diagonal))
    return replace(rotor, stiffness=stiffness, rigid_motions=rigid_motions)


def nearest(rotor, point) -> int:
    return int(np.argmin(np.linalg.norm(rotor.nodes - point, axis=1)))


def rigid_columns(nodes: np.ndarray) -> np.ndarray:
    return np.hstack([translations(len(nodes)), rotations(nodes, nodes.mean(axis=0))])


def largest_angle(first: np.ndarray, second: np.ndarray) -> float:
    """Return the largest principal angle between two spans [rad]."""
    first, second = (matrix / np.linalg.norm(matrix, axis=0) for matrix in (first, second))
    return la.subspace_angles(first, second).max()


# ---- free modes


def test_free_modes_are_those_of_fem_interface(short_fem, short_shaft):
    modes = free_modes(short_shaft, 8)
    # not its sparse solver, which factorises the singular K: 1e-12 to 1e-6 remain, by chance
    short_fem.ComputeEigenmodes(8, excludeRigidBodyModes=6, useSparseSolver=False)
    values = short_fem.eigenValues
    # rounding of K moves eigenvalues by eps · highest / lowest, here 1e-11, and the span by that
    # over the distance to the next eigenvalue
    rounding = 10.0 * EPS * values[-1] / values[6]
    np.testing.assert_allclose(modes.frequencies**2, values[6:14], rtol=rounding)
    gap = values[14] / values[13] - 1.0
    assert rounding / gap < 1e-8
    assert largest_angle(modes.matrix, short_fem.modeBasis["matrix"]) < rounding / gap
    assert modes.labels[0] == "eigenmode 1"


@pytest.mark.parametrize(
    ("points", "rigid_motions"),
    [
        ([(0.02, 0, 0)], 3),
        ([(0.02, 0, 0), (0.02, 0, 0.1)], 1),
        ([(0.02, 0, 0), (0.02, 0, 0.1), (-0.02, 0, 0)], 0),
    ],
)
def test_modes_of_supported_rotors(short_shaft, points, rigid_motions):
    nodes = [nearest(short_shaft, point) for point in points]
    rotor = supported(short_shaft, dict.fromkeys(nodes, 1e8), rigid_motions)
    expected = la.eigh(rotor.stiffness.toarray(), rotor.mass.toarray(), eigvals_only=True)
    found = free_modes(rotor, 6).frequencies ** 2
    # the reference loses eps times highest over lowest eigenvalue, 1e8
    np.testing.assert_allclose(found, expected[rigid_motions : rigid_motions + 6], rtol=1e-7)


# ---- Hurty–Craig–Bampton modes


@pytest.mark.parametrize("coupling", ["RBE2", "RBE3"])
def test_craig_bampton_spans_that_of_fem_interface(shaft, coupling):
    modes = craig_bampton_modes(shaft.rotor, 6, coupling=coupling)
    interfaces = shaft.rotor.interfaces.values()
    shaft.fem.ComputeHurtyCraigBamptonModes(
        [interface.nodes for interface in interfaces],
        6,
        computationMode=getattr(HCBstaticModeSelection, coupling),
        boundaryNodesWeights=[interface.weights for interface in interfaces],
    )
    # FEMinterface leaves out the first interface: the rigid motions take its place
    theirs = np.hstack([rigid_columns(shaft.rotor.nodes), shaft.fem.modeBasis["matrix"]])
    assert modes.matrix.shape == theirs.shape
    # angles grow from rounding by the condition of the columns, at most 1e4 here
    assert largest_angle(modes.matrix, theirs) < 1e-8
    np.testing.assert_allclose(modes.frequencies[12:] ** 2, shaft.fem.eigenValues[:6], rtol=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"interfaces": ["middle"]}, "'middle' is unknown; there are: 'left', 'right'"),
        ({"interfaces": ["left", "left"]}, "each of them once"),
        ({"interfaces": []}, "interfaces: name at least one"),
        ({"coupling": "RBE4"}, "'RBE4' is unknown; use one of 'RBE2', 'RBE3'"),
        ({"count": 100_000}, r"count: needs a whole number ≥ 0 and ≤ \d+, got 100000"),
        ({"count": -1}, "count: needs a whole number ≥ 0, got -1"),
    ],
)
def test_wrong_requests_are_refused(shaft, change, message):
    with pytest.raises(ValueError, match=message):
        craig_bampton_modes(shaft.rotor, **{"count": 2, **change})


@pytest.mark.parametrize("coupling", ["RBE2", "RBE3"])
def test_interfaces_that_cannot_hold_the_rotor_are_refused(shaft, coupling):
    rotor = SolidRotor.from_fem_interface(shaft.fem, "z")
    single = rotor.with_interface("single", [0])
    with pytest.raises(ValueError, match="do not hold the rotor"):
        craig_bampton_modes(single, 2, ["single"], coupling=coupling)
    line = [nearest(rotor, (0, 0, 0)), nearest(rotor, (0, 0, 0.3))]
    with pytest.raises(ValueError, match="nodes on one line"):
        craig_bampton_modes(rotor.with_interface("line", line), 2, ["line"], coupling=coupling)


# ---- modes of a FEMinterface


def test_fem_interface_modes_with_stress(shaft):
    shaft.fem.ComputeEigenmodes(3, excludeRigidBodyModes=6)
    shaft.fem.postProcessingModes = {}
    assert fem_interface_modes(shaft.rotor, shaft.fem).stress is None
    material = KirchhoffMaterial(2.1e11, 0.3, 7800.0)
    shaft.fem.ComputePostProcessingModesNGsolve(shaft.space, material=material)
    modes = fem_interface_modes(shaft.rotor, shaft.fem)
    np.testing.assert_array_equal(modes.matrix, shaft.fem.modeBasis["matrix"])
    # FEMinterface: six columns for every mode
    stored = shaft.fem.postProcessingModes["matrix"]
    np.testing.assert_array_equal(modes.stress[:, 4, 2], stored[:, 6 * 2 + 4])
    assert modes.labels[-1] == "FEMinterface mode 3"


# ---- factorisation


@pytest.mark.parametrize("size", [50, 2000])
def test_factor_solves_and_recognises_bad_matrices(size):
    chain = sp.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(size, size)).tocsr()
    right = np.random.default_rng(1).standard_normal((size, 3))
    factor = SparseCholesky(chain)
    np.testing.assert_allclose(chain @ factor.solve(right), right, atol=1e-8)
    np.testing.assert_array_equal(factor.solve(right)[:, 1], factor.solve(right[:, 1]))
    with pytest.raises(NotPositiveDefiniteError):
        SparseCholesky(sp.csr_array(chain - 0.1 * sp.eye_array(size)))
    ends = np.zeros(size)
    ends[[0, -1]] = 1.0
    with pytest.raises(NotPositiveDefiniteError):
        SparseCholesky(sp.csr_array(chain - sp.diags_array(ends)))
    with pytest.raises(NotPositiveDefiniteError, match="diagonal"):
        SparseCholesky(sp.csr_array(chain - 2.0 * sp.eye_array(size)))
