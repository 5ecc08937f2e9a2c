"""The formulations of the family lead to each other where springs hold what one of them lacks."""

import numpy as np
import pytest
from point_rotors import SKEW_AXIS, random_invariants

from exudyn_rotor import Formulation, Motion
from exudyn_rotor.theory.nodal import skew
from exudyn_rotor.theory.stiffening import stiffening

GRAVITY = np.array([1.0, -2.0, 3.0])
MODES = 3


def assert_falls_with_stiffness(deviation):
    """Check that a deviation falls with 1/k for springs far stiffer than the rotor (order 1)."""
    soft, stiff = deviation(1e5), deviation(1e6)
    assert soft > 1e-8
    # the next term of the series in 1/k is smaller by 1e-4
    assert np.log10(soft / stiff) == pytest.approx(1.0, abs=1e-3)


def steady_whirl(translation: str, springs: np.ndarray) -> np.ndarray:
    """Return deflection of the origin and modal coordinates, both constant in rotor axes.

    Constant spin, weight along the axis, and springs (3, 3) on the origin that are isotropic
    across the axis. The residual of the equations is linear in the unknowns.
    """
    invariants, _, _ = random_invariants(1, MODES)
    spin = Formulation(translation, 1.3)
    terms = stiffening(invariants, "tilt")
    motion = Motion(invariants, spin, terms, gravity=0.7 * SKEW_AXIS)
    N, turning = motion.free_directions, 1.3 * skew(SKEW_AXIS)
    count = N.shape[1]

    def residual(unknowns: np.ndarray) -> np.ndarray:
        place, zeta = N @ unknowns[:count], unknowns[count:]
        at_rest = np.zeros(MODES)
        q = np.append(N.T @ place, zeta)
        v = np.append(N.T @ turning @ place, at_rest)
        a = np.append(N.T @ turning @ turning @ place, at_rest)
        force = motion.forces(0.0, q, v)
        force[:count] -= N.T @ springs @ place
        return motion.mass_matrix(0.0, q) @ a - force

    offset = residual(np.zeros(motion.size))
    matrix = np.stack([residual(unit) - offset for unit in np.eye(motion.size)], axis=1)
    unknowns = np.linalg.solve(matrix, -offset)
    return np.append(N @ unknowns[:count], unknowns[count:])


ALONG = np.outer(SKEW_AXIS, SKEW_AXIS)


@pytest.mark.parametrize(
    ("richer", "poorer", "held"),
    [
        ("free", "in-plane", ALONG),
        ("in-plane", "none", np.eye(3) - ALONG),
        ("free", "none", np.eye(3)),
    ],
    ids=["2.2 to 2.3", "2.3 to 2.4", "2.2 to 2.4"],
)
def test_stiff_springs_on_the_origin_lead_to_the_poorer_formulation(richer, poorer, held):
    rest = 2.0 * (np.eye(3) - held)  # ordinary springs in the directions that stay free
    expected = steady_whirl(poorer, rest)
    assert_falls_with_stiffness(
        lambda k: np.linalg.norm(steady_whirl(richer, rest + k * held) - expected)
    )


def test_a_stiff_torsional_spring_leads_to_the_prescribed_spin():
    invariants, _, _ = random_invariants(1, MODES)
    terms = stiffening(invariants, "tilt")

    def sag(spin, k: float) -> np.ndarray:
        """Return (θ, ζ) at rest under transverse gravity, by Newton's method."""
        motion = Motion(invariants, Formulation("none", spin), terms, gravity=GRAVITY)
        q, rest = np.zeros(motion.size), np.zeros(motion.size)
        spring = np.zeros((motion.size, motion.size))
        spring[0, 0] = k
        for _ in range(8):
            by_q, _ = motion.jacobian(0.0, q, rest)
            q = q - np.linalg.solve(by_q - spring, motion.forces(0.0, q, rest) - spring @ q)
        return q

    expected = np.append(0.0, sag(0.0, 0.0))
    assert_falls_with_stiffness(lambda k: np.linalg.norm(sag("free", k) - expected))
