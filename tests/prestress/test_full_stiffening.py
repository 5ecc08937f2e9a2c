"""Level 'full' of centrifugal stiffening: exact rotations, blades, all analyses, storage."""

from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest
from models import disc_rotor

from exudyn_rotor import (
    ConstantSpeed,
    ReducedRotor,
    SolidRotor,
    add_rotor,
    campbell,
)
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


# ------------------------------------------------------------------ invariants and storage


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
