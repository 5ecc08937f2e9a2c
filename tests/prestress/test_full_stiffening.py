"""Level 'full' of centrifugal stiffening: exact rotations, blades, all analyses, storage."""

import numpy as np
import pytest
from models import disc_rotor

from exudyn_rotor import ReducedRotor, SolidRotor
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
        reduced = one.reduce(6, prestress=True)
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


# ------------------------------------------------------------------ reduced rotors


def test_reduced_rotor_without_prestress_is_told_what_to_do(rotor):
    plain = rotor.reduce(2, prestress=False)
    assert plain.invariants.K2 is None
    assert plain.centrifugal is None
    with pytest.raises(ValueError, match=r"prestress=True .*Prestress\(matrix.*stiffening='tilt'"):
        stiffening(plain.invariants, "full")
    for field in (plain.static_displacement, plain.static_stress):
        with pytest.raises(ValueError, match="without the static centrifugal field"):
            field(1.0)
