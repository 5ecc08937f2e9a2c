"""Reduction, selection of modes, and storage."""

import pickle
from collections.abc import Mapping
from dataclasses import fields, replace

import numpy as np
import pytest
from point_rotors import SKEW_AXIS, random_rotor

import exudyn_rotor as er
from exudyn_rotor.reduction.reduced_rotor import RIGID_KINDS, rigid_names
from exudyn_rotor.reduction.selection import without_spin
from exudyn_rotor.theory.axis import block_diagonal, rotations, translations

RIGID = rigid_names(RIGID_KINDS)
EXACT = 1e-12  # sums over six nodes with entries of order 1
OFF_ORIGIN = er.SpinAxis(SKEW_AXIS, [0.3, -0.2, 0.5])


@pytest.fixture(scope="module")
def rotor() -> er.SolidRotor:
    """Return a free random rotor whose centre of mass is off the axis."""
    return random_rotor(
        11, OFF_ORIGIN, interfaces={"left": [0, 1, 2], "right": [3, 4, 5]}, triangles=[[0, 1, 2]]
    )


@pytest.fixture(scope="module")
def reduced(rotor) -> er.ReducedRotor:
    return rotor.reduce(5)


# ------------------------------------------------------------------ basis


def test_basis_is_mass_orthonormal_and_diagonal_in_the_stiffness(rotor, reduced):
    Q = reduced.shapes.matrix
    np.testing.assert_allclose(Q.T @ (rotor.mass @ Q), np.eye(11), atol=EXACT)
    np.testing.assert_array_equal(reduced.invariants.M, np.eye(11))
    squares = reduced.frequencies**2
    np.testing.assert_allclose(Q.T @ (rotor.stiffness @ Q), np.diag(squares), atol=EXACT * 10)
    np.testing.assert_allclose(reduced.invariants.K, np.diag(squares), rtol=1e-15)
    assert reduced.rigid == RIGID
    assert np.all(np.diff(reduced.frequencies[6:]) >= 0.0)
    assert reduced.dropped == ()


def test_invariants_are_about_the_center_of_mass(rotor, reduced):
    np.testing.assert_array_equal(reduced.invariants.center, 0.0)
    np.testing.assert_allclose(reduced.center_of_mass, rotor.center_of_mass, rtol=1e-15)
    shape = reduced.shapes.matrix
    momentum = (rotor.nodes - rotor.center_of_mass).T @ rotor.mass[::3, ::3] @ shape[::3]
    np.testing.assert_allclose(reduced.invariants.P[:, 0, :], momentum, atol=EXACT)


def test_dependent_columns_are_dropped_and_named(rotor):
    modes = er.free_modes(rotor, 3).matrix
    turned = rotations(rotor.nodes, np.zeros(3))[:, :1]
    columns = np.column_stack([modes, 2.0 * modes[:, 1], turned, modes[:, 0] - modes[:, 2]])
    reduced = rotor.reduce(columns)
    assert reduced.dropped == ("column 4", "column 5", "column 6")
    expected = rotor.reduce(3)
    np.testing.assert_allclose(reduced.frequencies, expected.frequencies, rtol=EXACT)


def test_nodes_on_the_axis_have_no_spin():
    nodes = [[0, 0, 0], [0, 0, 0.3], [0, 0, 0.7]]
    springs = np.zeros((9, 9))
    springs[2, 2] = springs[5, 5] = 10.0
    springs[2, 5] = springs[5, 2] = -10.0
    rotor = er.SolidRotor.from_matrices(np.eye(9), springs, nodes, "z")
    stretch = np.eye(9)[:, 5:6] - np.eye(9)[:, 2:3]
    reduced = rotor.reduce(stretch)
    assert "spin" in reduced.dropped
    with pytest.raises(ValueError, match="no moment of inertia about its axis"):
        er.select_modes(reduced, er.Formulation("none", "free"))
    assert "spin" not in er.select_modes(reduced, er.Formulation("none", 10.0)).labels


# ------------------------------------------------------------------ selection


def tau_rows(formulation: er.Formulation, axis: er.SpinAxis) -> np.ndarray:
    """Return the mesh directions in which the frame's translation is unknown."""
    first, second = axis.plane.T
    return np.array([first, second, axis.direction])[: formulation.translation_count]


@pytest.mark.parametrize("translation", ["free", "in-plane", "none"])
@pytest.mark.parametrize("spin", ["free", 10.0])
def test_selection_leaves_out_what_its_frame_holds(rotor, reduced, translation, spin):
    """Mean translations (``S = 0``), and the mean rotation about the axis, ``e·I⁻¹ Σ M y × ψ``."""
    formulation = er.Formulation(translation, spin)
    selection = er.select_modes(reduced, formulation)
    shape = reduced.shapes.matrix @ selection.T
    scale = np.sqrt(rotor.total_mass)

    held = translations(6) @ tau_rows(formulation, rotor.axis).T
    np.testing.assert_allclose(held.T @ (rotor.mass @ shape), 0.0, atol=EXACT * scale)
    turns = rotations(rotor.nodes, rotor.center_of_mass)
    momentum = turns.T @ (rotor.mass @ shape)
    mean = np.linalg.solve(turns.T @ (rotor.mass @ turns), momentum)
    np.testing.assert_allclose(rotor.axis.direction @ mean, 0.0, atol=EXACT * abs(mean).max())
    np.testing.assert_allclose(
        selection.invariants.mean_rotation, mean, atol=EXACT * abs(mean).max()
    )
    turned = block_diagonal(rotor.axis.skew, 6) @ (rotor.nodes - selection.origin).ravel()
    unbalance = turned @ (rotor.mass @ shape)
    assert abs(unbalance).max() > 1e-3 * scale
    np.testing.assert_allclose(selection.invariants.g, unbalance, atol=EXACT * scale)
    np.testing.assert_allclose(
        selection.T.T @ selection.T, np.eye(selection.T.shape[1]), atol=1e-14
    )
    np.testing.assert_allclose(selection.invariants.M, np.eye(len(selection.labels)), atol=EXACT)
    if translation == "free":
        np.testing.assert_array_equal(selection.invariants.S, 0.0)
        np.testing.assert_array_equal(selection.invariants.center, 0.0)


@pytest.mark.parametrize(
    ("formulation", "rigid"),
    [
        (er.Formulation("free"), RIGID[4:]),
        (er.Formulation("in-plane"), (RIGID[2], *RIGID[4:])),
        (er.Formulation("none"), (*RIGID[:3], *RIGID[4:])),
        (er.Formulation("none", 5.0), (*RIGID[:3], *RIGID[4:])),
        (er.Formulation("none", 5.0, drive="elastic"), RIGID),
        (er.Formulation("free", 5.0, drive="elastic"), RIGID[3:]),
    ],
)
def test_each_formulation_has_the_rigid_modes_that_its_frame_lacks(reduced, formulation, rigid):
    selection = er.select_modes(reduced, formulation)
    assert selection.labels[: len(rigid)] == rigid
    assert len(selection.labels) == len(rigid) + 5
    assert selection.invariants.size == len(selection.labels)


# ------------------------------------------------------------------ size, immutability


def all_arrays(value, prefix: str = "") -> dict[str, np.ndarray]:
    """Return every array inside a reduced rotor with its path."""
    found = {}
    for field in fields(value):
        entry, name = getattr(value, field.name), f"{prefix}{field.name}"
        if isinstance(entry, np.ndarray):
            found[name] = entry
        elif hasattr(entry, "__dataclass_fields__"):
            found |= all_arrays(entry, f"{name}.")
        elif isinstance(entry, Mapping):
            for key, item in entry.items():
                found |= all_arrays(item, f"{name}.{key}.")
    return found


# ------------------------------------------------------------------ storage


def assert_identical(actual: er.ReducedRotor, expected: er.ReducedRotor) -> None:
    ours, theirs = all_arrays(actual), all_arrays(expected)
    assert ours.keys() == theirs.keys()
    for name, array in ours.items():
        assert array.dtype == theirs[name].dtype, name
        assert array.tobytes() == theirs[name].tobytes(), name
    for name in ("rigid", "dropped", "grounded", "labels"):
        assert getattr(actual, name) == getattr(expected, name)
    assert actual.invariants.mass == expected.invariants.mass
    assert list(actual.interfaces) == list(expected.interfaces)
    for name, interface in actual.interfaces.items():
        assert interface.radius == expected.interfaces[name].radius


def with_stress(reduced: er.ReducedRotor) -> er.ReducedRotor:
    stress = np.random.default_rng(5).normal(size=(6, 6, reduced.size))
    return replace(reduced, shapes=replace(reduced.shapes, stress=stress))


@pytest.mark.parametrize("change", [lambda r: r, er.ReducedRotor.without_shapes, with_stress])
def test_storage_is_lossless(reduced, tmp_path, change):
    changed = change(reduced)
    changed.save(tmp_path / "rotor.npz")
    assert_identical(er.ReducedRotor.load(tmp_path / "rotor.npz"), changed)


def test_selections_and_copies_know_their_rotor(rotor, reduced):
    selection = er.select_modes(reduced, er.Formulation("none", 10.0))
    assert repr(selection).startswith("Selection(10 of the 11 columns of ReducedRotor(6 rigid + 5")
    assert selection.is_of(pickle.loads(pickle.dumps(reduced)))
    assert not selection.is_of(rotor.reduce(4))
    held = without_spin(reduced)
    assert without_spin(held) is held
    # the static responses beside the modes stay, without the spin of both
    finer = held.with_attachments.invariants
    assert finer.size == reduced.with_attachments.size - 1
    assert np.abs(held.axis.direction @ finer.mean_rotation).max() < EXACT
