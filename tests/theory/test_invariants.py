"""Inertia invariants against Exudyn's 3D matrices, closed forms and their own symmetries."""

import numpy as np
import pytest
import scipy.sparse as sp
from exudyn.FEM import FEMinterface, ObjectFFRFreducedOrderInterface
from hypothesis import given, settings
from hypothesis import strategies as st
from point_rotors import SKEW_AXIS, random_arrays, random_invariants, ring_rotor

from exudyn_rotor import Invariants, SpinAxis

EXACT = 1e-12  # sums of some hundred products of order 1
MATRICES = ("M", "K", "D", "G", "C")
seeds = st.integers(0, 2**32 - 1)
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


# ------------------------------------------------------------------ properties


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


@pytest.mark.parametrize(
    ("basis", "direction", "words"),
    [
        (np.eye(18)[:, :2], [0.0, 0.0, 2.0], "direction: needs a unit vector"),
        (np.zeros((18, 2)), SKEW_AXIS, "M: needs a positive definite mass matrix; columns of the"),
    ],
)
def test_what_has_no_invariants_is_refused(basis, direction, words):
    with pytest.raises(ValueError, match=words):
        Invariants.of(**random_arrays(1), damping=None, basis=basis, direction=direction)
    with pytest.raises(ValueError, match=r"spin axis: the direction .* has no length"):
        SpinAxis(0.0 * np.array(direction))
