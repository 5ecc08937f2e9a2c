"""Frequencies that a proposal looks at, against closed forms of rigid rotors."""

import numpy as np
import pytest
from models import centered_disc
from point_rotors import ring_rotor

from exudyn_rotor import SolidRotor, Support, craig_bampton_modes, unbalance_response
from exudyn_rotor.advice import mode_choice
from exudyn_rotor.advice.candidate import candidate
from exudyn_rotor.advice.mode_choice import critical, resonances
from exudyn_rotor.advice.request import Request
from exudyn_rotor.advice.stiffening_level import choose_level
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.theory.nodal import rotations, translations

RADIUS, HALF, MASS = 0.1, 0.2, 5.0
POLAR = MASS * RADIUS**2
TRANSVERSE = MASS * (RADIUS**2 / 2 + HALF**2)
STIFFNESS, TILT, AXIAL, TORSION = 2e5, 9e3, 5e6, 1e5


def rigid_rotor() -> ReducedRotor:
    rotor = ring_rotor(RADIUS, HALF, MASS)
    return rotor.with_interface("all", range(10)).reduce(0)


def support(cross: float = 0.0, damping: float = 0.0) -> Support:
    """Return springs at the centre of mass, with cross-coupled ones across the axis."""
    stiffness = np.diag([STIFFNESS, STIFFNESS, AXIAL])
    stiffness[0, 1], stiffness[1, 0] = cross, -cross
    tilting = np.diag([TILT, TILT, TORSION])
    return Support("all", stiffness, damping * np.eye(3), tilt_stiffness=tilting)


@pytest.mark.parametrize("speed", [30.0, 150.0])
@pytest.mark.parametrize(
    "given", [support(), support(cross=3e4), support(damping=40.0), support(-1e4, 20.0)]
)
def test_resonances_are_those_without_damping_and_cross_coupling(given, speed):
    """In the rotor frame ``|λ ± Ω|`` with ``mλ² = k`` and ``I_t λ² − I_p Ωλ = k_t``.

    To rounding, eps times the largest square of a frequency, 2e6 of the torsion, over that found.
    """
    found = resonances(candidate(rigid_rotor(), None, given, None, None), speed, 600.0)[0]
    lateral = np.sqrt(STIFFNESS / MASS) * np.array([1.0, -1.0])
    conical = np.roots([TRANSVERSE, -POLAR * speed, -TILT])
    expected = np.sort(np.abs(np.concatenate([lateral, conical]) - speed))
    np.testing.assert_allclose(np.sort(found), expected, rtol=1e-9)


def test_critical_speeds_of_a_rigid_rotor():
    """``k = mΩ²`` and ``k_t = (I_t − I_p) Ω²``; each is there in both planes."""
    rotor, given = rigid_rotor(), support()
    found = critical(candidate(rotor, None, given, None, None), Request.of((0.0, 500.0), None, 0.1))
    expected = np.sqrt([STIFFNESS / MASS, TILT / (TRANSVERSE - POLAR)])
    distances = np.abs(found[:, None] / np.sort(expected) - 1.0)
    assert distances.min(axis=0).max() < 1e-9
    assert distances.min(axis=1).max() < 1e-9


@pytest.mark.parametrize("speed", [2.0, 10.0])
def test_change_by_the_full_level_without_supports(speed):
    """Two masses on a spring across the axis; unknown stiffening is taken as Ω² per unit mass.

    Then ``ω² + Ω²`` in place of ω²: the change, to first order, errs by the square of (Ω/2ω)².
    """
    nodes = np.array([[0.1, 0, 0], [-0.1, 0, 0], [0, 0, 0.2], [0, 0, -0.2]])
    stretch = np.zeros((12, 1))
    stretch[[0, 3], 0] = np.sqrt(0.5) * np.array([1.0, -1.0])
    soft = np.hstack([translations(4), rotations(nodes, np.zeros(3)), stretch])
    rest = np.eye(12) - soft @ np.linalg.pinv(soft)
    stiffness = 100.0**2 * stretch @ stretch.T + 1e10 * rest
    rotor = SolidRotor.from_matrices(np.eye(12), stiffness, nodes, "z").with_interface("a", [2, 3])
    given = candidate(rotor.reduce(1), None, None, None, None)
    level = choose_level(given, Request.of(speed, None, 0.1), np.array([0]))
    change = np.sqrt(1.0 + (speed / 100.0) ** 2) - 1.0
    assert not level.known
    assert level.full == pytest.approx(change, rel=0.5 * (speed / 100.0) ** 2)


@pytest.mark.parametrize("stiffness", [1e7, 1e8])
def test_what_modes_miss_of_the_response_to_unbalance_is_the_error_of_that(stiffness):
    """An eccentric rotor at 300 rad/s against one with 80 modes.

    The load, the last, is at rest in the rotor frame. It grows by 0.05 Ω there, which adds 5 % to
    the stiffness of supports by their damping.
    """
    solid = centered_disc().add_point_mass([0.15, 0, 0.215], 0.05)
    reduced, speed = solid.reduce(craig_bampton_modes(solid, 12, coupling="RBE3")), 300.0
    springs = stiffness * np.eye(3)
    supports = [Support(name, springs, springs / speed) for name in ("left", "right")]
    given = candidate(reduced, None, supports, None, None)
    request, plan = Request.of(speed, None, 1e-3), [(speed, [0.0])]
    found, attached = (
        mode_choice._responses(one, request, plan).complete[0][:, -1]
        for one in (given, given.attached)
    )
    many = solid.reduce(craig_bampton_modes(solid, 80, coupling="RBE3"))
    full, ours = (
        unbalance_response(r, [speed], supports=supports, accuracy=None).motion[..., :3].ravel()
        for r in (many, reduced)
    )
    error = np.linalg.norm(ours - full) / np.linalg.norm(full)
    missing = np.linalg.norm(found - attached) / np.linalg.norm(attached)
    assert missing == pytest.approx(error, rel=0.1)
