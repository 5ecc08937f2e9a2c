"""Inertia invariants against Exudyn's 3D matrices, closed forms and their own symmetries."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from exudyn.FEM import FEMinterface, ObjectFFRFreducedOrderInterface
from hypothesis import given, settings
from hypothesis import strategies as st
from point_rotors import SKEW_AXIS, random_arrays, random_invariants, ring_rotor
from scipy.spatial.transform import Rotation

from exudyn_rotor import Formulation, Invariants, select_modes
from exudyn_rotor.theory.nodal import rotations

EXACT = 1e-12  # sums of some hundred products of order 1
MATRICES = ("M", "K", "D", "G", "C")
seeds = st.integers(0, 2**32 - 1)
factors = st.floats(0.1, 10.0)
examples = settings(max_examples=25, deadline=None, derandomize=True)


def assert_close(actual, expected, scale=None):
    """Compare relative to the largest expected entry, or to `scale`."""
    expected = np.asarray(expected)
    scale = np.abs(expected).max() if scale is None else scale
    np.testing.assert_allclose(actual, expected, rtol=0, atol=EXACT * scale)


# ------------------------------------------------------------------ Exudyn's 3D matrices


def exudyn_matrices(arrays: dict, modes: np.ndarray) -> ObjectFFRFreducedOrderInterface:
    fem = FEMinterface()
    fem.nodes = {"Position": arrays["nodes"]}
    fem.massMatrix = sp.csr_matrix(arrays["mass"])
    fem.stiffnessMatrix = sp.csr_matrix(arrays["stiffness"])
    fem.modeBasis = {"matrix": modes, "type": "NormalModes"}
    return ObjectFFRFreducedOrderInterface(fem)


@pytest.mark.parametrize("e", [np.array([0.0, 0.0, 1.0]), SKEW_AXIS], ids=["z", "skew"])
def test_contracted_matrices_of_exudyn(e):
    invariants, modes, arrays = random_invariants(1, direction=e)
    cms = exudyn_matrices(arrays, modes)
    E = np.kron(np.eye(invariants.size), e[:, None])

    assert_close(invariants.mass, cms.totalMass)  # (31)
    assert_close(invariants.center, cms.chiU)  # (32)
    assert_close(invariants.S, cms.mPhitTPsi)  # (37)
    assert_close(invariants.M, cms.massMatrixReduced)  # (34)
    assert_close(invariants.K, cms.stiffnessMatrixReduced)  # (19)
    assert_close(invariants.Theta, e @ cms.inertiaLocal @ e)  # (79)
    assert_close(invariants.G, E.T @ cms.mPsiTildePsi)  # (80)
    assert_close(invariants.C, E.T @ cms.mPsiTildePsiTilde @ E)  # (81)
    assert_close(invariants.g, -e @ cms.mXRefTildePsi)  # (82)
    assert_close(invariants.h, e @ cms.mXRefTildePsiTilde @ E)  # (83)


def test_second_moments_are_those_of_the_inertia_of_exudyn():
    invariants, modes, arrays = random_invariants(2)
    inertia = exudyn_matrices(arrays, modes).inertiaLocal
    assert_close(np.trace(invariants.J) * np.eye(3) - invariants.J, inertia)


def test_damping_is_projected():
    invariants, modes, arrays = random_invariants(3)
    assert_close(invariants.D, modes.T @ arrays["damping"].toarray() @ modes)


# ------------------------------------------------------------------ rigid axisymmetric body


@pytest.mark.parametrize(("radius", "half_length"), [(0.3, 0.02), (0.1, 0.4)])
def test_tilts_of_a_rigid_rotor(radius, half_length):
    mass = 12.0
    polar, transverse = mass * radius**2, mass * (radius**2 / 2 + half_length**2)
    reduced = ring_rotor(radius, half_length, mass).reduce(0)
    tilts = [reduced.labels.index(name) for name in ("tilt 1", "tilt 2")]
    chosen = reduced.invariants.in_basis(np.eye(reduced.size)[:, tilts])
    expected = (transverse - polar / 2) / transverse  # the tilts have unit mass
    assert_close(chosen.Theta, polar)
    assert_close(chosen.C, expected * np.eye(2))
    assert_close(chosen.G, expected * np.array([[0.0, -1.0], [1.0, 0.0]]))


# ------------------------------------------------------------------ other origin, other basis


def recomputed(arrays: dict, modes: np.ndarray, e: np.ndarray, shift: np.ndarray) -> Invariants:
    return Invariants.of(**{**arrays, "nodes": arrays["nodes"] - shift}, basis=modes, direction=e)


def assert_same(actual: Invariants, expected: Invariants):
    for name in ("mass", "center", "J", "S", "P", "Theta", "g", "h", *MATRICES):
        assert_close(getattr(actual, name), getattr(expected, name))


@examples
@given(seeds)
def test_moved_equals_recomputed(seed):
    invariants, modes, arrays = random_invariants(seed)
    shift = np.random.default_rng(seed).normal(size=3)
    assert_same(invariants.moved(shift), recomputed(arrays, modes, SKEW_AXIS, shift))


@examples
@given(seeds)
def test_in_basis_equals_recomputed(seed):
    invariants, modes, arrays = random_invariants(seed)
    T = np.random.default_rng(seed).normal(size=(invariants.size, 3))
    assert_same(invariants.in_basis(T), recomputed(arrays, modes @ T, SKEW_AXIS, np.zeros(3)))


def test_derived_values_follow_the_new_origin():
    invariants, _, _ = random_invariants(4)
    before = invariants.Theta, invariants.g, invariants.h  # now cached in `invariants`
    there_and_back = invariants.moved([0.3, 0.2, -0.4])
    assert abs(there_and_back.Theta - before[0]) > 0.1
    there_and_back = there_and_back.moved([-0.3, -0.2, 0.4])
    for name, value in zip(("Theta", "g", "h"), before, strict=True):
        assert_close(getattr(there_and_back, name), value)


# ------------------------------------------------------------------ properties


@examples
@given(seeds)
def test_symmetry_and_sign(seed):
    invariants, _, _ = random_invariants(seed)
    assert_close(invariants.G, -invariants.G.T)
    assert_close(invariants.C, invariants.C.T)
    assert np.linalg.eigvalsh(invariants.C)[0] > -EXACT * np.abs(invariants.C).max()
    assert np.linalg.eigvalsh(invariants.M)[0] > 0.0
    assert invariants.Theta > 0.0


@examples
@given(seeds)
def test_turning_mesh_and_axis_together(seed):
    invariants, modes, arrays = random_invariants(seed)
    R = Rotation.random(rng=np.random.default_rng(seed)).as_matrix()
    R_bd = np.kron(np.eye(len(arrays["nodes"])), R)
    turned = Invariants.of(
        nodes=arrays["nodes"] @ R.T,
        mass=arrays["mass"],
        stiffness=sp.csr_array(R_bd @ arrays["stiffness"] @ R_bd.T),
        damping=sp.csr_array(R_bd @ arrays["damping"] @ R_bd.T),
        basis=R_bd @ modes,
        direction=R @ SKEW_AXIS,
    )
    for name in ("mass", "Theta", "g", "h", *MATRICES):
        assert_close(getattr(turned, name), getattr(invariants, name))
    assert_close(turned.center, R @ invariants.center)
    assert_close(turned.S, R @ invariants.S)
    assert_close(turned.J, R @ invariants.J @ R.T)


@examples
@given(seeds, factors, factors)
def test_scaling_with_mass_and_length(seed, mass_factor, length_factor):
    invariants, modes, arrays = random_invariants(seed)
    changed = {
        "nodes": length_factor * arrays["nodes"],
        "mass": sp.csr_array(mass_factor * arrays["mass"]),
    }
    scaled = Invariants.of(**{**arrays, **changed}, basis=modes, direction=SKEW_AXIS)
    for name in ("mass", "S", "M", "G", "C"):
        assert_close(getattr(scaled, name), mass_factor * getattr(invariants, name))
    for name in ("P", "g", "h"):
        assert_close(getattr(scaled, name), mass_factor * length_factor * getattr(invariants, name))
    for name in ("J", "Theta"):
        assert_close(
            getattr(scaled, name), mass_factor * length_factor**2 * getattr(invariants, name)
        )
    assert_close(scaled.center, length_factor * invariants.center)


@examples
@given(seeds)
def test_full_model_is_the_identity_basis(seed):
    arrays = {**random_arrays(seed), "damping": None, "direction": SKEW_AXIS}
    size = arrays["mass"].shape[0]
    full = Invariants.of(**arrays, basis=sp.eye_array(size, format="csr"))
    dense = Invariants.of(**arrays, basis=np.eye(size))
    assert full.is_sparse
    assert not dense.is_sparse
    for name in ("S", "P", "J", "g", "h"):
        assert_close(getattr(full, name), getattr(dense, name))
    for name in ("M", "K", "G", "C"):
        assert_close(getattr(full, name).toarray(), getattr(dense, name))
    assert full.D.nnz == 0


# ------------------------------------------------------------------ read-only


@pytest.mark.parametrize("name", ["direction", "center", "J", "S", "P", *MATRICES])
def test_arrays_cannot_be_written_to(name):
    invariants, _, _ = random_invariants(5)
    with pytest.raises(ValueError, match="read-only"):
        getattr(invariants, name)[0] = 1.0


def test_arrays_of_the_caller_stay_writable_and_apart():
    K = np.eye(2)
    invariants, _, _ = random_invariants(6, mode_count=2)
    changed = replace(invariants, K=K)
    K[0, 0] = 5.0
    assert changed.K[0, 0] == 1.0


def test_spin_of_a_fixed_axis_selection_keeps_the_moment_of_inertia():
    rotor = ring_rotor(0.2, 0.1, 5.0)
    spin = rotations(rotor.nodes, np.zeros(3))[:, 2]
    expected = spin @ (rotor.mass @ spin)  # 1/2 ω²Θ is the kinetic energy of the spin
    selection = select_modes(rotor.reduce(2), Formulation("none", "free"))
    assert_close(selection.invariants.Theta, expected)
