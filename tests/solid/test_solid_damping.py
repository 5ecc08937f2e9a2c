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


def test_damping_of_one_material(cylinder):
    """A uniform strain ε_zz dissipates β (λ + 2 μ) ε² V of its material; v = x̂ has α m of it."""
    damped = cylinder.with_damping(materials={"aluminium": FACTORS})
    volume = cylinder.mass.sum() / 3.0
    steel = cylinder.nodes[:, 2] < 0.3 - 1e-9
    inside = np.kron(steel, np.ones(3)) > 0
    assert abs(damped.damping[inside][:, inside]).max() == 0.0
    stretch = np.zeros((cylinder.node_count, 3))
    stretch[:, 2] = cylinder.nodes[:, 2]
    shift = np.zeros_like(stretch)
    shift[:, 0] = 1.0
    mass = shift.ravel() @ (damped.mass_damping @ shift.ravel()) / FACTORS["mass"]
    assert 0.0 < mass < volume
    E, nu = ALUMINIUM["youngsModulus"], ALUMINIUM["poissonsRatio"]
    modulus = E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))  # λ + 2 μ
    expected = FACTORS["stiffness"] * modulus * mass / ALUMINIUM["density"]
    dissipated = stretch.ravel() @ (damped.damping @ stretch.ravel())
    # 1e-16 of terms that cancel, some 100 times their sum
    assert dissipated == pytest.approx(expected, rel=1e-12)
