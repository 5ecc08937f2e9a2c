"""The finite-element layer: sources of models, masses, interfaces, rigid motions, stress."""

import numpy as np
import pytest
from exudyn.FEM import FEMinterface
from models import ALUMINIUM, STEEL, disc_rotor, two_material_cylinder

from exudyn_rotor.solid.surface import area_weights
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.axis import SpinAxis, rotations

MATERIALS = {"steel": STEEL, "aluminium": ALUMINIUM}


def relative_difference(actual, expected):
    return abs(actual - expected).max() / abs(expected).max()


@pytest.fixture(scope="module")
def disc():
    return disc_rotor()


@pytest.fixture(scope="module")
def cylinder():
    return SolidRotor.from_ngsolve(two_material_cylinder(), MATERIALS, "z")


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


# ------------------------------------------------------------------ interfaces


def test_area_weights_are_the_exact_areas_of_a_triangle():
    # right triangle with legs 2 and 1: corners get 1/12 of the area, mid nodes 3/12
    corners = np.array([[0, 0, 0], [2, 0, 0], [0, 1, 0]], dtype=float)
    mids = (corners + np.roll(corners, -1, axis=0)) / 2
    nodes, weights = area_weights(np.vstack([corners, mids]), np.arange(6)[None, :])
    assert nodes.tolist() == [0, 1, 2, 3, 4, 5]
    np.testing.assert_allclose(weights, [1 / 12] * 3 + [1 / 4] * 3, rtol=1e-14)


def test_interfaces_are_centred_on_the_axis(disc):
    axis = SpinAxis([0, 0, 1], [1e-3, 0, 0])
    rotor = SolidRotor.from_matrices(
        disc.mass,
        disc.stiffness,
        disc.nodes,
        axis,
        interfaces={name: face.nodes for name, face in disc.interfaces.items()},
    )
    moved = rotor.center_interfaces()
    np.testing.assert_allclose(moved.interfaces["left"].reference[:2], [1e-3, 0], atol=1e-16)
    np.testing.assert_allclose(
        moved.interfaces["left"].center, rotor.interfaces["left"].center, atol=1e-16
    )


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

    stress = rotor.elements.nodal_stress(columns)

    assert stress.shape == (rotor.node_count, 6, 2)
    height = rotor.nodes[:, 2]
    for column, gradient in enumerate(gradients):
        for material, inside in ((STEEL, height < 0.299), (ALUMINIUM, height > 0.301)):
            expected = hooke(gradient, material)
            error = np.abs(stress[inside, :, column] - expected).max()
            assert error < 1e-9 * np.abs(expected).max()
