"""Wrong input of the finite-element layer: every error names the value and what to do."""

import netgen.occ as occ
import ngsolve as ngs
import numpy as np
import pytest
import scipy.sparse as sp
from exudyn.FEM import FEMinterface
from models import STEEL, block_beam, two_masses, two_material_cylinder

from exudyn_rotor.solid.units import check_model_units
from exudyn_rotor.solid_rotor import SolidRotor


@pytest.fixture(scope="module")
def mesh():
    return block_beam()


@pytest.fixture(scope="module")
def beam(mesh):
    return SolidRotor.from_ngsolve(mesh, STEEL, "z")


def chain(count=3, spring=1e6):
    """Return `count` unit masses on a curve, each held by springs to the ground."""
    number = np.arange(count, dtype=float)
    return {
        "mass": np.eye(3 * count),
        "stiffness": spring * np.eye(3 * count),
        "nodes": np.stack([number, 0.1 * number**2, 0.1 * number**3], axis=1),
    }


def make(changes):
    return SolidRotor.from_matrices(**{**chain(), **changes}, axis="x")


def test_the_chain_itself_is_accepted():
    assert make({}).rigid_motions == 0


# ------------------------------------------------------------------ arrays


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"nodes": np.zeros((3, 2))}, r"nodes: the shape must be \(n, 3\), got \(3, 2\)"),
        ({"nodes": np.zeros((0, 3))}, r"nodes: the shape must be \(n, 3\)"),
        ({"nodes": np.zeros((3, 6))}, "6 coordinates per node mean rotation-carrying"),
        ({"nodes": [[0, 0, np.nan], [1, 0, 0], [2, 1, 0]]}, "1 of 3 positions are not finite"),
        ({"mass": np.eye(8)}, r"mass matrix: the shape must be \(9, 9\).*got \(8, 8\)"),
        ({"stiffness": np.ones(9)}, r"stiffness matrix: needs a square matrix.*\(9,\)"),
        ({"mass": np.eye(18)}, "mass matrix: 6 coordinates for each of 3 nodes.*rotation-carrying"),
        ({"stiffness": None}, r"stiffness matrix: is missing"),
        ({"damping": np.eye(6)}, r"damping matrix: the shape must be \(9, 9\)"),
        ({"stiffness": 1j * np.eye(9)}, "stiffness matrix: needs real numbers, got imaginary"),
        ({"triangles": [[0.5, 1, 2]]}, "triangles: needs whole numbers, got"),
        ({"triangles": [[0, 1]]}, r"triangles: the shape must be \(t, 3\) or \(t, 6\)"),
        ({"triangles": [[0, 1, 3]]}, "triangles: node numbers 0 to 3 are outside"),
    ],
)
def test_shapes(changes, message):
    with pytest.raises(ValueError, match=message):
        make(changes)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"nodes": "nodes.txt"}, r"nodes: needs numbers \[m\], got 'nodes.txt'"),
        ({"mass": "mass.txt"}, "mass matrix: needs numbers, got 'mass.txt'"),
        ({"triangles": [[0.0, 1.0, 2.0]]}, "triangles: needs whole numbers of an integer type"),
        (
            {"interfaces": {"a": [0.0, 1.0]}},
            "interfaces: 'a': nodes: needs whole numbers of an integer type",
        ),
    ],
)
def test_types(changes, message):
    with pytest.raises(TypeError, match=message):
        make(changes)


@pytest.mark.parametrize("label", ["mass", "stiffness", "damping"])
def test_entries_that_are_not_finite_are_counted(label):
    matrix = np.eye(9)
    matrix[1, 1], matrix[2, 4] = np.nan, np.inf
    with pytest.raises(ValueError, match=f"{label} matrix: 2 entries are not finite"):
        make({label: matrix})


@pytest.mark.parametrize("label", ["mass", "stiffness", "damping"])
def test_asymmetry(label):
    matrix = np.eye(9)
    matrix[0, 3] = 1e-7
    with pytest.raises(ValueError, match=rf"{label} matrix: is not symmetric.*1e-07.*triangle"):
        make({label: matrix})
    matrix[0, 3] = 1e-9
    symmetrised = getattr(make({label: matrix}), label)
    assert abs(symmetrised - symmetrised.T).max() == 0.0


# ------------------------------------------------------------------ mass


def test_another_order_of_coordinates_is_recognised(beam):
    count = beam.node_count
    by_direction = np.arange(3 * count).reshape(-1, 3).T.ravel()
    mass = beam.mass[by_direction][:, by_direction]
    stiffness = beam.stiffness[by_direction][:, by_direction]
    with pytest.raises(ValueError, match=r"ordered x0 x1 … y0 y1.*M\[p\]\[:, p\]"):
        SolidRotor.from_matrices(mass, stiffness, beam.nodes, "z")
    # the permutation that the message names
    p = np.arange(3 * count).reshape(3, count).T.ravel()
    rotor = SolidRotor.from_matrices(mass[p][:, p], stiffness[p][:, p], beam.nodes, "z")
    assert abs(rotor.stiffness - beam.stiffness).max() == 0.0


def test_direction_dependent_lumped_masses():
    mass = np.diag([1.0, 1, 1, 1, 2, 1, 1, 1, 1])
    with pytest.raises(ValueError, match=r"direction-dependent masses at 1 nodes, nodes 1.*2\.0"):
        make({"mass": mass})


def test_a_mass_matrix_without_identity_blocks():
    mass = np.eye(9)
    mass[0, 4] = mass[4, 0] = 0.1
    with pytest.raises(ValueError, match="multiples of the 3×3 identity"):
        make({"mass": mass})


@pytest.mark.parametrize(
    ("masses", "message"),
    [
        ([1.0, -1.0, 5.0], "1 nodes have a negative mass, nodes 1"),
        ([1.0, 0.0, 0.0], "2 nodes have no mass, nodes 1, 2"),
    ],
)
def test_nodal_masses_must_be_positive(masses, message):
    with pytest.raises(ValueError, match=message):
        make({"mass": np.kron(np.diag(masses), np.eye(3))})


def test_the_total_mass_must_be_positive():
    coupled = np.array([[1.0, -2.0, 0.0], [-2.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    with pytest.raises(ValueError, match="total mass must be positive, got -1 kg"):
        make({"mass": np.kron(coupled, np.eye(3))})


@pytest.mark.parametrize("mass", [0.0, np.nan, np.inf])
def test_a_point_mass_must_be_finite_and_not_zero(beam, mass):
    with pytest.raises(ValueError, match=r"mass: needs a (finite )?number \[kg\].*got"):
        beam.add_point_mass([0, 0, 0], mass)


def test_the_position_of_a_point_mass_must_be_finite(beam):
    with pytest.raises(
        ValueError, match=r"position: needs finite numbers \[m\] of shape \(3,\), got \[0, 0, nan\]"
    ):
        beam.add_point_mass([0, 0, np.nan], 1.0)


# ------------------------------------------------------------------ stiffness


def test_a_negative_diagonal_of_the_stiffness():
    stiffness = np.diag([1e6] * 8 + [-1e6])
    with pytest.raises(ValueError, match="1 diagonal entries are negative, at nodes 2"):
        make({"stiffness": stiffness})


def test_grounded_must_not_contradict_the_matrix(beam):
    with pytest.raises(ValueError, match="grounded=True, but all six rigid motions are free"):
        SolidRotor.from_matrices(beam.mass, beam.stiffness, beam.nodes, "z", grounded=True)
    with pytest.raises(ValueError, match="grounded=False, but 5 rigid motions are held"):
        SolidRotor.from_matrices(**two_masses(), axis="x", grounded=False)


# ------------------------------------------------------------------ interfaces


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ([], "interface 'a' has no nodes"),
        ([0, 3], "interface 'a': there is no node 3; the model has the nodes 0 to 2"),
        ([-1], "interface 'a': there is no node -1"),
        ([0, 1, 1], "interface 'a': repeated node numbers 1"),
        (([0, 1], [1.0, -0.5]), "interface 'a': weights.*cannot be negative, got -0.5"),
        (
            ([0, 1], [1.0]),
            r"interface 'a': weights: needs finite numbers of shape \(2,\), got \[1.0\]",
        ),
    ],
)
def test_wrong_interfaces(entry, message):
    with pytest.raises(ValueError, match=message):
        make({"interfaces": {"a": entry}})


def test_interface_names(mesh, beam):
    with pytest.raises(
        ValueError, match="interfaces: 'top' is unknown; there are: 'left', 'right'"
    ):
        SolidRotor.from_ngsolve(mesh, STEEL, "z", interfaces=["left", "top"])
    with pytest.raises(ValueError, match="repeated"):
        SolidRotor.from_ngsolve(mesh, STEEL, "z", interfaces=["left", "left"])
    with pytest.raises(TypeError, match="needs a list of face names, got the text 'left'"):
        SolidRotor.from_ngsolve(mesh, STEEL, "z", interfaces="left")
    with pytest.raises(ValueError, match="'left' exists already"):
        beam.with_interface("left", [0])
    with pytest.raises(ValueError, match="names: 'top' is unknown; there are: 'left', 'right'"):
        beam.center_interfaces(["top"])


# ------------------------------------------------------------------ meshes


def test_the_mesh_must_be_an_ngsolve_mesh(mesh):
    with pytest.raises(TypeError, match="wrap a Netgen mesh with"):
        SolidRotor.from_ngsolve(mesh.ngmesh, STEEL, "z")


def test_the_order_must_be_one_or_two(mesh):
    with pytest.raises(ValueError, match="order: needs a whole number ≥ 1 and ≤ 2, got 3"):
        SolidRotor.from_ngsolve(mesh, STEEL, "z", order=3)


def test_linear_elements_need_a_straight_mesh(mesh, beam):
    with pytest.raises(ValueError, match=r"order=1.*cannot even describe a rigid rotation"):
        SolidRotor.from_ngsolve(mesh, STEEL, "z", order=1)


def test_a_surface_mesh_is_refused():
    surface = occ.OCCGeometry(occ.Box(occ.Pnt(0, 0, 0), occ.Pnt(1, 1, 1)))
    only_faces = ngs.Mesh(surface.GenerateMesh(maxh=1.0, perfstepsend=4))
    with pytest.raises(ValueError, match="needs volume elements, and tetrahedra only"):
        SolidRotor.from_ngsolve(only_faces, STEEL, "z")


def test_a_mesh_made_second_order_twice_is_refused():
    mesh = block_beam()
    mesh.ngmesh.SecondOrder()
    mesh.ngmesh.SecondOrder()
    with pytest.raises(ValueError, match="belong to no volume element"):
        SolidRotor.from_ngsolve(mesh, STEEL, "z")


# ------------------------------------------------------------------ materials and units


def test_regions_without_material():
    with pytest.raises(ValueError, match=r"\['aluminium'\] have no material; given are \['steel'"):
        SolidRotor.from_ngsolve(two_material_cylinder(0.2), {"steel": STEEL}, "z")
    with pytest.raises(ValueError, match="one material was given, but the mesh has 2 regions"):
        SolidRotor.from_ngsolve(two_material_cylinder(0.2), STEEL, "z")


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
        ({"youngsModulus": 2.1e5}, "wave speed of 5.17 m/s.*cannot be"),
        ({"youngsModulus": 2.1e14}, r"wave speed of 1\.64e\+05 m/s"),
    ],
)
def test_materials_that_cannot_be(mesh, changes, message):
    with pytest.raises(ValueError, match=message):
        SolidRotor.from_ngsolve(mesh, {"steel": {**STEEL, **changes}}, "z")


def test_materials_must_be_a_dictionary(mesh):
    with pytest.raises(TypeError, match="materials: needs a dictionary"):
        SolidRotor.from_ngsolve(mesh, "steel", "z")


def test_a_mesh_in_millimetres_with_si_materials():
    with pytest.raises(ValueError, match=r"cannot be a rotor; lengths in mm, as Netgen.*Scale"):
        SolidRotor.from_ngsolve(block_beam(scale=1e3), STEEL, "z")


@pytest.mark.parametrize(
    ("scale", "mass", "message"),
    [
        (100.0, 7.85e-9 * 1e6, "mm and tonnes"),
        (100.0, 7.85e-6 * 1e6, "mm and kg"),
        (1e-4, 1.0, "mixed units"),
    ],
)
def test_mass_and_size_that_cannot_be(scale, mass, message):
    nodes = scale * np.array([[0, 0, 0], [1, 1, 1]], dtype=float)
    with pytest.raises(ValueError, match=message):
        check_model_units(nodes, mass)


def test_units_are_checked_for_plain_matrices():
    with pytest.raises(ValueError, match="mm and tonnes"):
        make({"mass": 1e-9 * np.eye(9), "nodes": 100 * chain()["nodes"]})
    nodes = 100 * chain()["nodes"]
    rotor = SolidRotor.from_matrices(1e-9 * np.eye(9), np.eye(9), nodes, "x", check_units=False)
    assert rotor.total_mass == pytest.approx(3e-9, rel=1e-12)


def test_the_axis_must_have_a_direction(mesh):
    with pytest.raises(ValueError, match="no length"):
        SolidRotor.from_ngsolve(mesh, STEEL, [0, 0, 0])


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


def test_fem_interface_without_surface_and_weights():
    fem = fem_interface(nodeSets=[node_set("end", 2, 0), node_set("default", 1)])
    rotor = SolidRotor.from_fem_interface(fem, "x")
    assert list(rotor.interfaces) == ["end"]
    np.testing.assert_array_equal(rotor.interfaces["end"].weights, [0.5, 0.5])
    assert rotor.triangles.shape == (0, 3)


def test_fem_interface_of_parts_that_nothing_connects():
    fem = fem_interface(stiffnessMatrix=sp.csr_matrix(np.diag([1e6] * 6 + [0.0] * 3)))
    with pytest.raises(ValueError, match=r"falls into 3 parts .*allow_parts"):
        SolidRotor.from_fem_interface(fem, "x")
    rotor = SolidRotor.from_fem_interface(fem, "x", allow_parts=True)
    np.testing.assert_array_equal(rotor.stiffness.diagonal(), [1e6] * 6 + [0.0] * 3)


@pytest.mark.parametrize(("grounded", "free"), [(False, 6), (True, 0)])
def test_fem_interface_that_lost_digits(beam, grounded, free):
    data = np.array([float(f"{value:.6e}") for value in beam.stiffness.data])
    lossy = sp.csr_matrix((data, beam.stiffness.indices, beam.stiffness.indptr))
    fem = fem_interface(
        nodes={"Position": beam.nodes},
        massMatrix=sp.csr_matrix(beam.mass),
        stiffnessMatrix=lossy,
    )
    with pytest.raises(ValueError, match=r"lost digits.*grounded=False.*soft springs"):
        SolidRotor.from_fem_interface(fem, "z")
    rotor = SolidRotor.from_fem_interface(fem, "z", grounded=grounded)
    assert rotor.rigid_motions == free


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"nodes": {"RigidBodyRxyz": np.zeros((3, 6))}}, "rotation-carrying"),
        ({"nodes": {"Position2D": np.zeros((3, 2))}}, r"'Position' nodes only.*Position2D"),
        ({"nodes": {}}, "got no nodes"),
        ({"massMatrix": None}, "massMatrix is missing"),
        ({"stiffnessMatrix": None}, "stiffnessMatrix is missing"),
        ({"nodeSets": [node_set("a", 0), node_set("a", 1)]}, r"several node sets.*\['a'\]"),
        ({"nodeSets": [node_set("a")]}, "interface 'a' has no nodes"),
    ],
)
def test_wrong_fem_interface(changes, message):
    with pytest.raises(ValueError, match=message):
        SolidRotor.from_fem_interface(fem_interface(**changes), "x")


def test_something_else_than_a_fem_interface():
    with pytest.raises(TypeError, match=r"fem: needs FEMinterface, got \{\}"):
        SolidRotor.from_fem_interface({}, "x")
