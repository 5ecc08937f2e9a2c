"""Wrong input of the finite-element layer: every error names the value and what to do."""

from dataclasses import replace

import ngsolve as ngs
import numpy as np
import pytest
import scipy.sparse as sp
from exudyn.FEM import FEMinterface
from models import STEEL, block_beam, two_material_cylinder
from netgen.geom2d import unit_square
from point_rotors import free_stiffness

import exudyn_rotor as er
from exudyn_rotor.solid_rotor import SolidRotor


@pytest.fixture(scope="module")
def mesh():
    return block_beam()


def chain(count=3, spring=1e6):
    """Return `count` unit masses on a curve, each held by springs to the ground."""
    number = np.arange(count, dtype=float)
    return {
        "mass": np.eye(3 * count),
        "stiffness": spring * np.eye(3 * count),
        "nodes": np.stack([number, 0.1 * number**2, 0.1 * number**3], axis=1),
    }


SOFT = free_stiffness(chain()["nodes"], np.eye(9)) + 1e-7 * np.eye(9)


def make(changes):
    return SolidRotor.from_matrices(**{**chain(), **changes}, axis="x")


# ------------------------------------------------------------------ arrays


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"nodes": np.zeros((3, 2))}, r"nodes: needs finite .* of shape \(any, 3\).*\(3, 2\)"),
        ({"nodes": [[0, 0, np.nan], [1, 0, 0], [2, 1, 0]]}, "nodes: needs finite numbers"),
        ({"mass": np.eye(8)}, r"mass matrix: the shape must be \(9, 9\).*got \(8, 8\)"),
        ({"stiffness": np.ones(9)}, r"stiffness matrix: needs finite numbers of shape .*\(9,\)"),
        ({"mass": np.eye(18)}, r"mass matrix: the shape must be \(9, 9\).*no nodes with rotations"),
        ({"stiffness": None}, r"stiffness matrix: needs finite numbers"),
        ({"damping": np.eye(6)}, r"damping matrix: the shape must be \(9, 9\)"),
        ({"stiffness": 1j * np.eye(9)}, "stiffness matrix: needs real numbers, got imaginary"),
        ({"mass": np.diag(np.arange(1.0, 10.0))}, "not consist of multiples of the 3×3 identity"),
        (
            {"mass": np.diag(6 * [1.0] + 3 * [0.0])},
            r"1 nodes have no mass .* nodes 2; remove nodes",
        ),
        ({"mass": 1e-9 * np.eye(9)}, r"units: .* kg/m³, cannot be"),
        ({"stiffness": np.triu(np.ones((9, 9)))}, r"is not symmetric.* pass A \+ A.T - diag"),
        ({"stiffness": SOFT}, "6 rigid motions are neither free nor held .* digits in an export"),
        ({"triangles": [[0.5, 1, 2]]}, "triangles: needs whole numbers, got"),
        ({"triangles": [[0, 1]]}, r"triangles: the shape must be \(t, 3\) or \(t, 6\)"),
        ({"triangles": [[0, 1, 3]]}, "triangles: node numbers 0 to 3 are outside"),
    ],
)
def test_shapes(changes, message):
    with pytest.raises((TypeError, ValueError), match=message):
        make(changes)


# ------------------------------------------------------------------ interfaces


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ([], "interface 'a' has no nodes"),
        ([0, 3], "interface 'a': nodes: needs whole numbers ≥ 0 and ≤ 2, got 3"),
        ([-1], "interface 'a': nodes: .*got -1"),
        ([0, 1, 1], "interface 'a': repeated node numbers 1"),
    ],
)
def test_wrong_interfaces(entry, message):
    with pytest.raises(ValueError, match=message):
        make({"interfaces": {"a": entry}})


@pytest.mark.parametrize(
    ("weights", "message"),
    [
        ([1.0, -0.5], "interface 'a': weights: needs shares of an area, none negative.*-0.5"),
        ([1.0], r"interface 'a': weights: needs finite numbers of shape \(2,\), got \[1.0\]"),
    ],
)
def test_wrong_weights(weights, message):
    with pytest.raises(ValueError, match=message):
        make({}).with_interface("a", [0, 1], weights)


# ------------------------------------------------------------------ materials and units


def test_regions_without_material():
    with pytest.raises(ValueError, match=r"\['aluminium'\] have no material; given are \['steel'"):
        SolidRotor.from_ngsolve(two_material_cylinder(0.2), {"steel": STEEL}, "z")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"youngsModulus": 0.0},
            r"materials: 'steel': youngsModulus: needs a finite number \[Pa\] > 0, got 0.0",
        ),
        ({"youngsModulus": np.nan}, "materials: 'steel': youngsModulus: .* got nan"),
        ({"poissonsRatio": 0.5}, "materials: 'steel': poissonsRatio: .* > -1 and < 0.5, got 0.5"),
        ({"poissonsRatio": -1.0}, "materials: 'steel': poissonsRatio: .* got -1.0"),
        ({"density": -7850.0}, r"materials: 'steel': density: needs a finite number \[kg/m³\] > 0"),
        ({"colour": 1.0}, "materials: 'steel': needs exactly the keys"),
        ({"density": 7.85e-9, "youngsModulus": 2.1e5}, "mm and tonnes.*check_units=False"),
        ({"density": 7.85e-6}, "mm and kg.*convert to SI"),
        ({"youngsModulus": 2.1e5}, r"wave speed .* of 5.17 m/s.*cannot be"),
        ({"youngsModulus": 2.1e14}, r"wave speed .* of 1\.64e\+05 m/s"),
    ],
)
def test_materials_that_cannot_be(mesh, changes, message):
    with pytest.raises(ValueError, match=message):
        SolidRotor.from_ngsolve(mesh, {"steel": {**STEEL, **changes}}, "z")


def ngsolve_mesh(kind):
    """Return a mesh that is flat, or made second order that often."""
    if kind == "flat":
        return ngs.Mesh(unit_square.GenerateMesh(maxh=0.5))
    mesh = block_beam()
    for _ in range(kind):
        mesh.ngmesh.SecondOrder()
    return mesh


@pytest.mark.parametrize(
    ("kind", "order", "message"),
    [
        ("flat", 1, "needs volume elements, and tetrahedra only; generate"),
        (1, 1, "its elements are curved, .* use order=2"),
        (2, 2, "nodes have no mass .*a mesh made second order"),
    ],
)
def test_meshes_that_cannot_be(kind, order, message):
    with pytest.raises(ValueError, match=message):
        SolidRotor.from_ngsolve(ngsolve_mesh(kind), STEEL, "z", order=order)


def test_a_mesh_in_millimetres_with_si_materials():
    with pytest.raises(
        ValueError, match=r"few rotors are that heavy; lengths in mm, as Netgen.*Scale"
    ):
        SolidRotor.from_ngsolve(block_beam(scale=1e3), STEEL, "z")


# ------------------------------------------------------------------ FEMinterface


def fem_interface(**changes):
    """Return a FEMinterface that holds the chain of masses."""
    fem = FEMinterface()
    arrays = chain()
    fem.nodes = {"Position": arrays["nodes"]}
    fem.massMatrix = sp.csr_matrix(arrays["mass"])
    fem.stiffnessMatrix = sp.csr_matrix(arrays["stiffness"])
    for name, value in changes.items():
        setattr(fem, name, value)
    return fem


def node_set(name, *numbers):
    return {"Name": name, "NodeNumbers": np.array(numbers)}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"nodes": {"RigidBodyRxyz": np.zeros((3, 6))}}, "no nodes with rotations"),
        ({"nodes": {"Position2D": np.zeros((3, 2))}}, r"'Position' nodes only.*Position2D"),
        ({"nodes": {}}, "got no nodes"),
        ({"massMatrix": None}, "massMatrix is missing"),
        ({"stiffnessMatrix": None}, "stiffnessMatrix is missing"),
        (
            {"nodeSets": [node_set("a", 0), node_set("a", 1)]},
            "names of its node sets: 'a' is given twice",
        ),
        ({"nodeSets": [node_set("a")]}, "interface 'a' has no nodes"),
    ],
)
def test_wrong_fem_interface(changes, message):
    with pytest.raises(ValueError, match=message):
        SolidRotor.from_fem_interface(fem_interface(**changes), "x")


# ------------------------------------------------------------------ what is asked of a rotor

CALLS = [
    (lambda r: r.interface_at("c", 0.0, 1.0), "no surface to look for nodes on; .* with_interface"),
    (lambda r: r.clamped("a"), r"the 2 nodes of \['a'\] lie on one line .* clamp three"),
    (
        lambda r: r.add_point_mass(np.zeros(3), -1.0),
        "taking 1 kg from node 0 .* give less than 1 kg",
    ),
    (lambda r: r.reduce("two"), "modes: expected a number .* got 'two'"),
    (lambda r: r.reduce(0), "basis is empty: ask for at least one component mode"),
    (lambda r: r.reduce(FEMinterface()), r"holds no modes; call fem\.ComputeEigenmodes"),
    (lambda r: r.reduce(1, stress=True), "no stress recovery; make it with from_ngsolve"),
    (lambda r: er.ModeBasis(np.ones((6, 1)), ["a"], r.nodes), "matrix: needs 9 rows, got 6"),
    (lambda r: er.Prestress(np.eye(9), r.nodes, initial_displacement=[np.eye(9)]), "K_uu, got 1"),
    (lambda r: replace(r.reduce(2), shapes=r.reduce(1).shapes), "one column for each of 2, got 1"),
    (lambda r: er.craig_bampton_modes(r, 1), "'a' and 'b' share node 1, .* use coupling='RBE3'"),
    (lambda r: er.keep_modes(r.reduce(2), []), "no rigid motions; keep at least one mode"),
    (
        lambda r: er.select_modes(r.reduce(2), er.Formulation("free", "free")),
        "holds this rotor in its own",
    ),
]


@pytest.mark.parametrize(("call", "message"), CALLS)
def test_what_a_rotor_cannot_do(call, message):
    with pytest.raises((ValueError, TypeError), match=message):
        call(make({"interfaces": {"a": [0, 1], "b": [1, 2]}}))
