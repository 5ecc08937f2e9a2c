"""Damping of solid rotors: before and after reduction, and the threshold of internal damping."""

import numpy as np
import pytest
from models import ALUMINIUM, STEEL, two_material_cylinder

from exudyn_rotor import SolidRotor, Support, stability, stability_threshold

MATERIALS = {"steel": STEEL, "aluminium": ALUMINIUM}


@pytest.fixture(scope="module")
def cylinder():
    return SolidRotor.from_ngsolve(two_material_cylinder(0.15), MATERIALS, "z", order=1)


@pytest.mark.parametrize("ratio", [0.5, 2.0, 6.0])
def test_internal_damping_makes_a_jeffcott_rotor_unstable(ratio):
    """Above ω₀ (1 + c_e/c_i); Genta, "Dynamics of Rotating Systems" (2005), section 4.4.

    The equation ``m z'' + (c_e + c_i) z' + (k − i ω c_i) z = 0`` has the root i ω₀ there.
    """
    mass, omega, internal = 3.0, 200.0, 20.0
    rotor = SolidRotor.from_matrices(
        mass * np.eye(3),
        mass * omega**2 * np.eye(3),
        [[0, 0, 0]],
        "z",
        interfaces={"disc": [0]},
    ).with_damping(stiffness=internal / (mass * omega**2))
    supports = [Support("disc", damping=ratio * internal)]
    threshold = omega * (1.0 + ratio)
    # the growth is c_i/(2m) per (ω − threshold)/ω₀ to first order: 3e-6 at 1e-6 of the threshold
    for side, stable in ((1.0 - 1e-6, True), (1.0 + 1e-6, False)):
        growth = stability(rotor, threshold * side, supports=supports).growth
        assert (growth.max() < 0.0) == stable
    found = stability_threshold(rotor, 0.5 * threshold, 2.0 * threshold, supports=supports)
    # the growth counts from 1e-9 of the speed on: at 2e-7 of the threshold or less
    assert found.values == pytest.approx([threshold], rel=1e-6)


def test_factors_add_up_before_and_after_reduction(cylinder):
    damped = cylinder.with_damping(stiffness=1e-6)
    damped = damped.with_damping(stiffness=1e-6, mass=0.3, loss=0.01).reduce(4)
    reduced = cylinder.reduce(4).with_damping(mass=0.3, stiffness=2e-6, loss=0.01)
    pairs = ((damped, reduced), (damped.with_attachments, reduced.with_attachments))
    for one, other in pairs:
        for name in "DH":
            expected = getattr(other.invariants, name)
            found = getattr(one.invariants, name)
            np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())


def test_mass_damping_of_a_held_rotor_is_on_the_ground():
    held = SolidRotor.from_matrices(2.0 * np.eye(9), 1e6 * np.eye(9), np.eye(3), "z")
    damped = held.with_damping(mass=3.0, stiffness=1e-5)  # 3 · 2 + 10 N s/m
    np.testing.assert_allclose(damped.damping.toarray(), 16.0 * np.eye(9))
