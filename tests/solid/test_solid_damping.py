"""Rayleigh damping of solid rotors: matrices, materials, and the threshold of internal damping."""

import numpy as np
import pytest
from models import ALUMINIUM, STEEL, two_material_cylinder
from point_rotors import random_rotor

from exudyn_rotor import SolidRotor, Support, stability, stability_threshold

MATERIALS = {"steel": STEEL, "aluminium": ALUMINIUM}
FACTORS = {"mass": 0.3, "stiffness": 2e-3}


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


def test_the_order_of_damping_and_reduction_does_not_matter():
    rotor = random_rotor(6)
    first, last = (
        rotor.with_damping(**FACTORS).reduce(4),
        rotor.reduce(4).with_damping(**FACTORS),
    )
    for one, other in ((first, last), (first.with_attachments, last.with_attachments)):
        D = other.invariants.D
        # sums of 18 products of order 1
        np.testing.assert_allclose(one.invariants.D, D, rtol=0.0, atol=1e-13 * np.abs(D).max())


def test_factors_add_up_and_keep_the_elements(cylinder):
    damped = cylinder.with_damping(stiffness=1e-6).with_damping(stiffness=2e-6)
    difference = damped.damping - 3e-6 * cylinder.stiffness
    assert abs(difference).max() <= 4e-16 * abs(damped.damping).max()
    assert damped.elements is cylinder.elements
    assert damped.mass_damping == 0.0
    assert damped.prestress().balanced
    assert cylinder.with_damping(mass=2.0).mass_damping == 2.0
    assert cylinder.with_damping().damping is None
