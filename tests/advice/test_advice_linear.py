"""Frequencies that a proposal looks at, against closed forms of rigid rotors."""

import numpy as np
import pytest
from models import centered_disc
from point_rotors import ring_rotor

from exudyn_rotor import Support, craig_bampton_modes, unbalance_response
from exudyn_rotor.advice import mode_choice
from exudyn_rotor.advice.candidate import candidate
from exudyn_rotor.advice.mode_choice import resonances
from exudyn_rotor.advice.request import Request
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor

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
