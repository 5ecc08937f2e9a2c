"""Level 'full' of centrifugal stiffening: exact rotations, blades, all analyses, storage."""

from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest
from models import disc_rotor

from exudyn_rotor import (
    ConstantSpeed,
    Prestress,
    ReducedRotor,
    SolidRotor,
    Support,
    add_rotor,
    campbell,
    critical_speeds,
    free_modes,
)
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.nodal import rotations
from exudyn_rotor.theory.stiffening import stiffening


@pytest.fixture(scope="module")
def rotor() -> SolidRotor:
    return disc_rotor(1, safety=2.0)  # axisymmetric enough


@pytest.fixture(scope="module")
def unbalanced(rotor) -> SolidRotor:
    """A free rotor whose axis is no principal axis."""
    return rotor.add_point_mass((0.15, 0, 0.2), 0.4).add_point_mass((-0.1, 0.1, 0.23), 0.2)


@pytest.fixture(scope="module")
def reduced(rotor) -> ReducedRotor:
    return rotor.reduce(12, prestress=rotor.prestress(yield_stress=3e8))


# ------------------------------------------------------------------ rigid rotations


def test_rotations_of_the_exact_level_are_contained(rotor, unbalanced):
    for one in (rotor, unbalanced):
        reduced = one.reduce(6, prestress=one.prestress(euler=True))
        full, tilt = (stiffening(reduced.invariants, level) for level in ("full", "tilt"))
        # rows of the six rigid motions, coupled with all modes; columns have unit mass
        np.testing.assert_allclose(full.K2[:6], tilt.K2[:6], rtol=0, atol=1e-11)
        # on a rotor that nothing holds the Euler load is all inertia and strains nothing
        np.testing.assert_allclose(full.B, tilt.B, rtol=0, atol=1e-11)
        assert np.abs(full.K2[6:, 6:] - tilt.K2[6:, 6:]).max() > 0.1
        spin = reduced.rigid.index("spin")
        if one is rotor:  # K2[e, e] = Θ, here of a column of unit mass
            assert full.K2[spin, spin] == pytest.approx(1.0, rel=1e-11)
    assert np.abs(tilt.B).max() > 1e-3


def test_geometric_stiffness_alone_holds_the_tilts(rotor):
    # K_G on a rotation about the axis is Θ, and I_p/2 on a tilt of an axisymmetric rotor
    turns = rotations(rotor.nodes, rotor.center_of_mass)
    inertia = turns.T @ (rotor.mass @ turns)
    polar = inertia[2, 2]
    found = turns.T @ (rotor.prestress().matrix @ turns)
    # inertia relief of what the mesh leaves as unbalance is of second order in it
    assert found[2, 2] == pytest.approx(polar, rel=1e-6)
    # the mesh is axisymmetric to this
    np.testing.assert_allclose(found, np.diag([polar / 2, polar / 2, polar]), atol=2e-3 * polar)


@pytest.mark.parametrize("speed", [40.0, 400.0, 4000.0])
def test_conical_modes_are_exact(rotor, speed):
    stiff = rotor.reduce(0, prestress=True)
    theta = stiff.invariants.Theta
    moments = np.trace(stiff.invariants.J) * np.eye(3) - stiff.invariants.J
    transverse = (moments[0, 0] + moments[1, 1]) / 2
    stiffness, springs = 1e4, np.zeros(6)
    springs[4:] = stiffness / transverse
    held = replace(stiff, invariants=replace(stiff.invariants, K=np.diag(springs)))
    # rigid axisymmetric rotor: I_t λ² − i I_p ω λ + k = 0 in inertial axes
    roots = np.abs(np.roots([-transverse, theta * speed, stiffness]) - speed)
    found = campbell(held, speed, stiffening="full").frequencies_rotor[0]
    for root in roots:
        assert np.abs(found / root - 1).min() < 1e-4
    paper = campbell(held, speed, stiffening="none").frequencies_rotor[0]
    if speed >= 400.0:
        assert max(np.abs(paper / root - 1).min() for root in roots) > 0.01


# ------------------------------------------------------------------ full models


def test_critical_speeds_take_the_level(reduced):
    supports = [Support("left", stiffness=1e8), Support("right", stiffness=1e8)]
    full, tilt = (
        critical_speeds(reduced, supports=supports, stiffening=level).speeds[:4]
        for level in ("full", "tilt")
    )
    assert full.shape == tilt.shape
    assert np.all(full > 1.0001 * tilt)


# ------------------------------------------------------------------ reduced rotors


def test_reduced_rotor_without_prestress_is_told_what_to_do(rotor):
    plain = rotor.reduce(2, prestress=False)
    assert plain.invariants.K2 is None
    assert plain.centrifugal is None
    with pytest.raises(ValueError, match=r"prestress=True .*from_matrix.*stiffening='tilt'"):
        stiffening(plain.invariants, "full")
    for field in (plain.static_displacement, plain.static_stress):
        with pytest.raises(ValueError, match="without the static centrifugal field"):
            field(1.0)


def test_imported_matrix_gives_the_same_rotor(rotor, reduced):
    nodes, axis = rotor.nodes, rotor.axis
    imported = SolidRotor.from_matrices(rotor.mass, rotor.stiffness, nodes, axis)
    given = Prestress.from_matrix(rotor.prestress().matrix, nodes)
    found = imported.reduce(free_modes(rotor, 12), prestress=given)
    # a mode's sign is free
    np.testing.assert_allclose(
        np.abs(found.invariants.K2), np.abs(reduced.invariants.K2), rtol=0, atol=1e-6
    )
    assert found.centrifugal is None


def test_carried_prestress_is_the_default_and_can_be_left_out(rotor, reduced):
    carrying = rotor.with_prestress(rotor.prestress())
    K2 = carrying.reduce(12).invariants.K2
    np.testing.assert_allclose(np.abs(K2), np.abs(reduced.invariants.K2), rtol=0, atol=1e-6)
    assert carrying.reduce(2, prestress=False).invariants.K2 is None


def test_stress_at_rest_is_in_the_frequencies_at_rest(rotor):
    # radial compression of the rim and tension inside, put into equilibrium
    stress = np.zeros((rotor.node_count, 6))
    stress[:, :2] = 2e8 * np.cos(15 * np.linalg.norm(rotor.nodes[:, :2], axis=1))[:, None]
    with pytest.warns(UserWarning, match="not in equilibrium"):
        prestress = rotor.prestress(stress=stress)
    modes = free_modes(rotor, 12)
    before, after = (rotor.reduce(modes, prestress=p) for p in (None, prestress))
    expected = rotor.stiffness + prestress.constant
    Q = after.shapes.matrix
    np.testing.assert_allclose(
        np.diag(Q.T @ expected @ Q)[6:], after.frequencies[6:] ** 2, rtol=1e-9
    )
    assert np.abs(after.frequencies[6:] / before.frequencies[6:] - 1).max() > 1e-4
    with pytest.warns(UserWarning, match="not in equilibrium"):
        buckling = rotor.prestress(stress=-1000 * stress)
    with pytest.raises(ValueError, match="the rotor buckles"):
        rotor.reduce(modes, prestress=buckling)


def test_static_fields_grow_with_the_square_of_the_speed(rotor, reduced):
    displacement, stress = reduced.static_displacement(200.0), reduced.static_stress(200.0)
    computed = rotor.prestress()
    for found, field in ((displacement.ravel(), "displacement"), (stress, "stress")):
        expected = 4e4 * getattr(computed, field)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * np.abs(expected).max())
    load = rotor.mass @ rotor.axis.radial(rotor.nodes).ravel()
    assert (load @ displacement.ravel()) > 0.0
    assert reduced.centrifugal.yield_stress == 3e8
    assert reduced.without_shapes().centrifugal is None


# ------------------------------------------------------------------ invariants and storage


def test_terms_follow_a_change_of_basis_and_origin(reduced):
    T = np.random.default_rng(4).normal(size=(reduced.size, 3))
    invariants = replace(reduced.invariants, B=2.0 * reduced.invariants.K2)
    changed = invariants.in_basis(T).moved(np.array([0.1, 0.0, -0.2]))
    np.testing.assert_allclose(changed.K2, T.T @ invariants.K2 @ T)
    np.testing.assert_allclose(changed.B, 2.0 * changed.K2)


def test_storage_keeps_all(reduced, tmp_path):
    whole = replace(
        reduced, invariants=replace(reduced.invariants, B=np.eye(reduced.size), mass=2.0)
    )
    whole.save(tmp_path / "a.npz")
    found = ReducedRotor.load(tmp_path / "a.npz")
    for name in ("K2", "B"):
        assert np.array_equal(getattr(found.invariants, name), getattr(whole.invariants, name))
    for name in ("displacement", "stress"):
        assert np.array_equal(getattr(found.centrifugal, name), getattr(whole.centrifugal, name))
    assert found.centrifugal.yield_stress == 3e8


def test_files_without_these_entries_are_read(rotor, tmp_path):
    rotor.reduce(2, prestress=False).save(tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz") as file:
        names = set(file.files)
    assert not [name for name in names if "K2" in name or "centrifugal" in name]
    found = ReducedRotor.load(tmp_path / "a.npz")
    assert found.centrifugal is None
    assert found.invariants.K2 is None
    assert isinstance(found.invariants, Invariants)


# ------------------------------------------------------------------ a scene


def test_body_of_this_level_takes_steps(reduced):
    system = exu.SystemContainer()
    mbs = system.AddSystem()
    body = add_rotor(mbs, reduced, spin=ConstantSpeed(300.0), stiffening="full")
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = 5
    settings.timeIntegration.endTime = 1e-3
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    mbs.SolveDynamic(settings)
    assert body.stiffening == "full"
    assert np.all(np.isfinite(mbs.systemData.GetODE2Coordinates()))


def test_body_of_this_level_needs_the_prestress(rotor):
    mbs = exu.SystemContainer().AddSystem()
    plain = rotor.reduce(2, prestress=False)
    with pytest.raises(ValueError, match="prestress=True"):
        add_rotor(mbs, plain, spin=ConstantSpeed(300.0), stiffening="full")
