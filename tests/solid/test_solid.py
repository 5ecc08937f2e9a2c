"""The finite-element layer: sources of models, masses, interfaces, rigid motions, stress."""

from types import SimpleNamespace

import numpy as np
import pytest
import scipy.sparse as sp
from exudyn.FEM import FEMinterface
from models import ALUMINIUM, STEEL, block_beam, disc_rotor, two_masses, two_material_cylinder

from exudyn_rotor.solid import ngsolve_model
from exudyn_rotor.solid.point_mass import PointMass
from exudyn_rotor.solid.rigid import rigid_residuals
from exudyn_rotor.solid.surface import area_weights
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.nodal import rotations, translations

MATERIALS = {"steel": STEEL, "aluminium": ALUMINIUM}


def relative_difference(actual, expected):
    return abs(actual - expected).max() / abs(expected).max()


def rounded(matrix, digits):
    """Return the matrix as a text export with so many significant digits gives it back."""
    data = np.array([float(f"{value:.{digits - 1}e}") for value in matrix.data])
    return sp.csr_array((data, matrix.indices, matrix.indptr), matrix.shape)


def springs(rotor, nodes, stiffness):
    """Return a diagonal matrix of springs to the ground in x, y, z at `nodes`."""
    diagonal = np.zeros(3 * rotor.node_count)
    diagonal[(3 * np.asarray(nodes)[:, None] + np.arange(3)).ravel()] = stiffness
    return sp.csr_array(sp.diags_array(diagonal))


@pytest.fixture(scope="module")
def disc():
    return disc_rotor()


@pytest.fixture(scope="module")
def beam():
    return SolidRotor.from_ngsolve(block_beam(), STEEL, "z")


@pytest.fixture(scope="module")
def cylinder():
    return SolidRotor.from_ngsolve(two_material_cylinder(), MATERIALS, "z")


def remade(rotor, **changes):
    """Return the rotor made anew from its matrices."""
    arrays = {"mass": rotor.mass, "stiffness": rotor.stiffness, "nodes": rotor.nodes}
    return SolidRotor.from_matrices(**{**arrays, **changes}, axis="z")


# ------------------------------------------------------------------ the same as FEMinterface


@pytest.mark.parametrize("order", [1, 2])
def test_ngsolve_model_equals_the_model_of_fem_interface(order):
    mesh = two_material_cylinder()
    fem = FEMinterface()
    fem.ImportMeshFromNGsolve(mesh, materials=MATERIALS, meshOrder=order)

    rotor = SolidRotor.from_ngsolve(mesh, MATERIALS, "z", order=order)

    assert np.array_equal(rotor.nodes, fem.nodes["Position"])
    assert relative_difference(rotor.mass, fem.massMatrix) < 1e-12
    assert relative_difference(rotor.stiffness, fem.stiffnessMatrix) < 1e-12
    expected_triangles = fem.surface[0]["Trigs6" if order == 2 else "Trigs"]
    assert np.array_equal(rotor.triangles, expected_triangles)
    sets = {node_set["Name"]: node_set for node_set in fem.nodeSets}
    assert set(rotor.interfaces) == {"left", "joint"} == set(sets) - {"default"}
    for name, interface in rotor.interfaces.items():
        sorting = np.argsort(sets[name]["NodeNumbers"])
        assert np.array_equal(interface.nodes, sets[name]["NodeNumbers"][sorting])
        np.testing.assert_allclose(
            interface.weights, sets[name]["NodeWeights"][sorting], rtol=1e-12, atol=0
        )


def test_elements_are_read_from_older_releases_too():
    """Up to 6.2.2606 with the number of nodes, of 20 that are stored, and with their type later."""
    stored = np.zeros(2, dtype=[("nodes", "i4", 20), ("np", "i1"), ("index", "i4")])
    stored["nodes"][:, :4], stored["np"] = [[1, 2, 3, 4], [2, 3, 4, 5]], 4
    given = SimpleNamespace(Elements3D=lambda: SimpleNamespace(NumPy=lambda: stored))
    corners, _ = ngsolve_model._tetrahedra(SimpleNamespace(ngmesh=given))
    assert corners.tolist() == [[0, 1, 2, 3], [1, 2, 3, 4]]
    kinds = np.array([(20,), (21,), (25,)], dtype=[("type", "u1")])
    assert ngsolve_model._node_counts(kinds) == [4, 10, 0]


def test_import_of_fem_interface_keeps_the_model():
    mesh = two_material_cylinder()
    assembled = SolidRotor.from_ngsolve(mesh, MATERIALS, "z")
    fem = FEMinterface()
    # the mesh has its mid nodes already and FEMinterface would add them a second time
    fem.ImportMeshFromNGsolve(two_material_cylinder(), materials=MATERIALS, meshOrder=2)

    imported = SolidRotor.from_fem_interface(fem, "z")

    assert np.array_equal(imported.nodes, assembled.nodes)
    assert np.array_equal(imported.triangles, assembled.triangles)
    assert relative_difference(imported.mass, assembled.mass) < 1e-12
    assert relative_difference(imported.stiffness, assembled.stiffness) < 1e-12
    for name, interface in assembled.interfaces.items():
        np.testing.assert_allclose(imported.interfaces[name].center, interface.center, atol=1e-15)


def test_a_mesh_can_be_used_twice():
    mesh = block_beam()
    first = SolidRotor.from_ngsolve(mesh, STEEL, "z")
    second = SolidRotor.from_ngsolve(mesh, STEEL, "z")
    assert np.array_equal(first.nodes, second.nodes)
    assert relative_difference(second.stiffness, first.stiffness) < 1e-12


def test_interfaces_can_be_chosen():
    rotor = SolidRotor.from_ngsolve(block_beam(), STEEL, "z", interfaces=["right"])
    assert list(rotor.interfaces) == ["right"]
    assert rotor.interfaces["right"].center[2] == pytest.approx(0.3, rel=1e-12)


# ------------------------------------------------------------------ mass


def test_mass_and_inertia_of_the_cylinder(cylinder):
    # An edge of angle α as a parabola misses the share α⁴/480 of the circle's area (series of the
    # segment areas), and twice that of the polar inertia; here α ≤ maxh/radius.
    missing = (0.06 / 0.1) ** 4 / 480
    masses = np.pi * 0.1**2 * np.array([0.3 * STEEL["density"], 0.1 * ALUMINIUM["density"]])
    mass = masses.sum()
    assert mass * (1 - missing) < cylinder.total_mass < mass
    spin = rotations(cylinder.nodes, np.zeros(3))[:, 2]
    inertia = 0.5 * mass * 0.1**2
    assert inertia * (1 - 2 * missing) < spin @ cylinder.mass @ spin < inertia
    height = masses @ [0.15, 0.35] / mass
    np.testing.assert_allclose(cylinder.center_of_mass, [0, 0, height], atol=0.1 * missing)


def test_the_block_has_exact_mass_and_inertia(beam):
    mass = 7850.0 * 0.04 * 0.06 * 0.3
    assert beam.total_mass == pytest.approx(mass, rel=1e-12)
    spin = rotations(beam.nodes, np.zeros(3))[:, 2]
    inertia = mass * (0.04**2 + 0.06**2) / 12
    assert spin @ beam.mass @ spin == pytest.approx(inertia, rel=1e-12)


def test_mass_kind(beam):
    assert beam.mass_kind == "consistent"
    assert SolidRotor.from_matrices(**two_masses(), axis="x").mass_kind == "lumped"


def test_a_point_mass_moves_the_centre_of_mass(beam):
    position = np.array([0.021, 0.03, 0.3])
    heavier = beam.add_point_mass(position, 0.5)

    (placed,) = heavier.point_masses
    assert isinstance(placed, PointMass)
    assert placed.node == beam.nearest_node(position)
    # the corner of the block is a node, 1 mm beside the asked position
    np.testing.assert_allclose(beam.nodes[placed.node], [0.02, 0.03, 0.3], atol=1e-15)
    assert placed.distance == pytest.approx(0.001, rel=1e-9)
    assert heavier.total_mass == pytest.approx(beam.total_mass + 0.5, rel=1e-12)
    expected = beam.total_mass * beam.center_of_mass + 0.5 * beam.nodes[placed.node]
    np.testing.assert_allclose(
        heavier.center_of_mass, expected / heavier.total_mass, rtol=0, atol=1e-14
    )
    assert beam.point_masses == ()
    assert len(heavier.add_point_mass([0, 0, 0], 1e-3).point_masses) == 2


def test_mass_can_be_taken_away_only_while_the_matrix_stays_positive_definite(beam):
    node = beam.nearest_node([0.02, 0.03, 0.3])
    available = 1.0 / np.linalg.inv(beam.mass[::3, ::3].toarray())[node, node]
    lighter = beam.add_point_mass(beam.nodes[node], -0.99 * available)
    assert np.linalg.eigvalsh(lighter.mass[::3, ::3].toarray()).min() > 0.0
    with pytest.raises(ValueError, match="leaves a negative mass"):
        beam.add_point_mass(beam.nodes[node], -1.01 * available)


# ------------------------------------------------------------------ arrays and immutability


def test_matrices_are_symmetric_and_cannot_be_written(disc):
    for matrix in (disc.mass, disc.stiffness):
        assert isinstance(matrix, sp.csr_array)
        assert matrix.dtype == np.float64
        assert abs(matrix - matrix.T).max() == 0.0
        with pytest.raises(ValueError, match="read-only"):
            matrix.data[0] = 1.0
    for array in (disc.nodes, disc.triangles, disc.center_of_mass):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
    with pytest.raises(TypeError):
        disc.interfaces["left"] = None


def test_the_arrays_of_the_caller_stay_untouched():
    arrays = two_masses()
    rotor = SolidRotor.from_matrices(**arrays, axis="x")
    arrays["mass"][0, 0] = arrays["nodes"][0, 0] = 5.0
    assert rotor.mass[0, 0] == 1.0
    assert rotor.nodes[0, 0] == 1.0


def test_from_matrices_takes_dense_sparse_damping_and_interfaces(beam):
    damping = 1e-5 * beam.stiffness.toarray()
    nodes = beam.interfaces["left"].nodes
    rotor = SolidRotor.from_matrices(
        beam.mass.tocsc(),
        beam.stiffness.toarray(),
        beam.nodes.tolist(),
        SpinAxis([0, 0, 2.0]),
        damping,
        interfaces={"even": nodes, "weighted": (nodes, beam.interfaces["left"].weights)},
        triangles=beam.triangles,
    )
    assert relative_difference(rotor.mass, beam.mass) == 0.0
    assert relative_difference(rotor.damping, damping) == 0.0
    assert np.ptp(rotor.interfaces["even"].weights) == 0.0
    np.testing.assert_allclose(
        rotor.interfaces["weighted"].center, beam.interfaces["left"].center, atol=1e-16
    )
    assert rotor.stress_recovery is None


# ------------------------------------------------------------------ interfaces


def test_area_weights_are_the_exact_areas_of_a_triangle():
    # right triangle with legs 2 and 1: corners get 1/12 of the area, mid nodes 3/12
    corners = np.array([[0, 0, 0], [2, 0, 0], [0, 1, 0]], dtype=float)
    mids = (corners + np.roll(corners, -1, axis=0)) / 2
    nodes, weights = area_weights(np.vstack([corners, mids]), np.arange(6)[None, :])
    assert nodes.tolist() == [0, 1, 2, 3, 4, 5]
    np.testing.assert_allclose(weights, [1 / 12] * 3 + [1 / 4] * 3, rtol=1e-14)


def test_mean_motion_is_exact_for_a_rigid_motion(disc):
    shift, turn = np.array([1e-4, -2e-4, 3e-4]), np.array([2e-3, 1e-3, -3e-3])
    motion = translations(disc.node_count) @ shift + rotations(disc.nodes, np.zeros(3)) @ turn
    for interface in disc.center_interfaces().interfaces.values():
        measured = interface.mean_motion(disc.node_count) @ motion
        expected = shift + np.cross(turn, interface.reference)
        # eps of the displacement for each node in each of three sums, those of the centre, of W and
        # of the motion; rotations are those over the radius
        rounding = 3.0 * np.finfo(float).eps * len(interface.nodes) * np.abs(motion).max()
        np.testing.assert_allclose(measured[:3], expected, rtol=0, atol=rounding)
        np.testing.assert_allclose(measured[3:], turn, rtol=0, atol=rounding / interface.radius)


def test_interfaces_are_centred_on_the_axis(disc):
    axis = SpinAxis([0, 0, 1], [1e-3, 0, 0])
    rotor = SolidRotor.from_matrices(
        disc.mass,
        disc.stiffness,
        disc.nodes,
        axis,
        interfaces={name: face.nodes for name, face in disc.interfaces.items()},
    )
    moved = rotor.center_interfaces(["left"])
    np.testing.assert_allclose(moved.interfaces["left"].reference[:2], [1e-3, 0], atol=1e-16)
    np.testing.assert_allclose(
        moved.interfaces["left"].center, rotor.interfaces["left"].center, atol=1e-16
    )
    right = moved.interfaces["right"]
    np.testing.assert_array_equal(right.reference, right.center)


def test_an_interface_can_be_added(disc):
    rotor = disc.with_interface("pair", [3, 1], [1.0, 3.0])
    np.testing.assert_allclose(
        rotor.interfaces["pair"].center, 0.25 * disc.nodes[3] + 0.75 * disc.nodes[1], atol=1e-16
    )
    assert "pair" not in disc.interfaces


# ------------------------------------------------------------------ rigid motions


def test_an_assembled_rotor_is_free(disc):
    residuals, _ = rigid_residuals(disc.nodes, disc.stiffness)
    assert residuals.shape == (6,)
    assert residuals.max() < 1e-14
    assert disc.rigid_motions == 6
    assert not disc.grounded


@pytest.mark.parametrize("spring", [1e3, 1e6, 1e9])
def test_springs_at_one_node_hold_the_three_translations(disc, spring):
    stiffness = disc.stiffness + springs(disc, [0], spring)
    rotor = remade(disc, stiffness=stiffness)
    # the three rotations about the node stay free: combinations of the six motions count
    assert rotor.rigid_motions == 3
    assert rotor.grounded


def test_springs_on_both_ends_hold_all_motions(disc):
    held = np.concatenate([face.nodes for face in disc.interfaces.values()])
    rotor = remade(disc, stiffness=disc.stiffness + springs(disc, held, 1e5))
    assert rotor.rigid_motions == 0


def test_the_grounded_model_of_appendix_b_is_accepted():
    rotor = SolidRotor.from_matrices(**two_masses(), axis="x")
    # only the rotation about the line of the two nodes, which moves none of them
    assert rotor.rigid_motions == 1
    assert rotor.grounded


def test_a_single_free_mass_is_free():
    rotor = SolidRotor.from_matrices(np.eye(3), np.zeros((3, 3)), [[1.0, 0, 0]], "z")
    assert rotor.rigid_motions == 6


def test_an_export_with_ten_digits_is_free(beam):
    assert remade(beam, stiffness=rounded(beam.stiffness, 10)).rigid_motions == 6


def test_lost_digits_need_a_word_from_the_user(beam):
    lossy = rounded(beam.stiffness, 7)
    with pytest.raises(ValueError, match=r"lost digits.*grounded=False.*soft springs"):
        remade(beam, stiffness=lossy)
    assert remade(beam, stiffness=lossy, grounded=False).rigid_motions == 6
    assert remade(beam, stiffness=lossy, grounded=True).rigid_motions == 0


# ------------------------------------------------------------------ stress


def hooke(gradient, material):
    """Return xx, yy, zz, yz, xz, xy for one displacement gradient ∂u_i/∂x_j, written out."""
    modulus, ratio = material["youngsModulus"], material["poissonsRatio"]
    strain = (gradient + gradient.T) / 2
    factor = modulus / ((1 + ratio) * (1 - 2 * ratio))
    normal = [
        factor * ((1 - ratio) * strain[i, i] + ratio * (strain[j, j] + strain[k, k]))
        for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
    ]
    shear = [modulus / (1 + ratio) * strain[i, j] for i, j in ((1, 2), (0, 2), (0, 1))]
    return np.array(normal + shear)


@pytest.mark.parametrize("order", [1, 2])
def test_stress_of_linear_displacements_is_hookes_law(order):
    rotor = SolidRotor.from_ngsolve(two_material_cylinder(), MATERIALS, "z", order=order)
    gradients = np.random.default_rng(3).normal(size=(2, 3, 3)) * 1e-3
    columns = np.stack([(rotor.nodes @ g.T).ravel() for g in gradients], axis=1)

    stress = rotor.stress_recovery(columns)

    assert stress.shape == (rotor.node_count, 6, 2)
    height = rotor.nodes[:, 2]
    for column, gradient in enumerate(gradients):
        for material, inside in ((STEEL, height < 0.299), (ALUMINIUM, height > 0.301)):
            expected = hooke(gradient, material)
            error = np.abs(stress[inside, :, column] - expected).max()
            assert error < 1e-9 * np.abs(expected).max()


def test_stress_of_quadratic_displacements_is_exact_inside_one_material(beam):
    # pure bending, Euler-Bernoulli: u_z = −κ x z, u_x = κ (z² + ν(x² − y²))/2, u_y = κ ν x y
    curvature, ratio = 1e-3, STEEL["poissonsRatio"]
    x, y, z = beam.nodes.T
    motion = curvature * np.stack(
        [(z**2 + ratio * (x**2 - y**2)) / 2, ratio * x * y, -x * z], axis=1
    )
    stress = beam.stress_recovery(motion.reshape(-1, 1))[:, :, 0]
    expected = np.zeros_like(stress)
    expected[:, 2] = -STEEL["youngsModulus"] * curvature * x
    np.testing.assert_allclose(stress, expected, rtol=0, atol=1e-9 * np.abs(expected).max())


# ------------------------------------------------------------------ texts and units


def test_summary_and_repr(disc):
    rotor = disc.center_interfaces().add_point_mass([0.15, 0, 0.215], 1e-3)
    text = rotor.summary()
    for part in ("consistent", "6 of 6 free", "left:", "right:", "0.001 kg", "m away"):
        assert part in text
    assert repr(rotor).startswith(f"SolidRotor({disc.node_count} nodes")
    assert "\n" not in repr(rotor)


def test_a_consistent_system_of_units_is_possible(beam):
    material = {"youngsModulus": 2.1e5, "poissonsRatio": 0.3, "density": 7.85e-9}
    tonnes = SolidRotor.from_ngsolve(block_beam(scale=1e3), material, "z", check_units=False)
    assert tonnes.total_mass == pytest.approx(beam.total_mass / 1000, rel=1e-12)
    assert tonnes.rigid_motions == 6
