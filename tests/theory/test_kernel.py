"""The fast arrangement of the equations against their plain statement, and solver settings."""

from dataclasses import replace

import exudyn
import numpy as np
import pytest
from point_rotors import random_invariants, random_spd, ring_rotor
from test_motion import ORIENTATION, SHAKE, SWING

from exudyn_rotor import Formulation, Motion, select_modes
from exudyn_rotor.multibody.solver_settings import recommended_settings
from exudyn_rotor.theory.formulation import ConstantSpeed
from exudyn_rotor.theory.kernel import Kernel
from exudyn_rotor.theory.stiffening import stiffening

ANGLE = Formulation("none", "free")
FORMULATIONS = {
    "free spin": ANGLE,
    "constant speed": Formulation("none", ConstantSpeed(1.3, 0.2)),
    "prescribed spin": Formulation("none", SWING),
    "constant speed, shaken": Formulation(SHAKE, ConstantSpeed(1.3, 0.2)),
    "prescribed spin, shaken": Formulation(SHAKE, SWING),
    "free spin, shaken": Formulation(SHAKE, "free"),
    "frozen spin": Formulation("in-plane", "free", spin_coupling="frozen"),
    "frozen spin, free": Formulation("free", "free", spin_coupling="frozen"),
    **{
        f"{spin_name}, {translation}": Formulation(translation, spin)
        for translation in ("free", "in-plane")
        for spin_name, spin in (
            ("free spin", "free"),
            ("constant speed", ConstantSpeed(1.3, 0.2)),
            ("prescribed spin", SWING),
        )
    },
}


def motion_of(formulation: Formulation, seed: int, gravity: float) -> Motion:
    """Return a motion whose invariants have no zeros: all its coordinates are coupled."""
    invariants, _, _ = random_invariants(seed, 3)
    terms = stiffening(invariants, "tilt")
    if not formulation.has_spin:
        terms = replace(terms, K4=random_spd(np.random.default_rng([seed, 2]), 3))
    return Motion(
        invariants, formulation, terms, ORIENTATION, gravity=gravity * np.array([1.0, -2.0, 3.0])
    )


@pytest.mark.parametrize(
    "formulation",
    [
        ANGLE,
        FORMULATIONS["prescribed spin, shaken"],
        FORMULATIONS["constant speed, shaken"],
        FORMULATIONS["free spin, free"],
        FORMULATIONS["free spin, in-plane"],
        FORMULATIONS["frozen spin, free"],
        FORMULATIONS["prescribed spin, free"],
    ],
)
def test_jacobian_for_the_solver_is_the_derivative_of_its_forces(formulation):
    """Of the forces that Exudyn gets from Python; what is native it knows itself.

    Central differences of cubic polynomials with the step h err by h², 1e-10, and eps/h, 2e-11,
    of entries of order 1 to 100.
    """
    motion, step, time = motion_of(formulation, 4, 1.0), 1e-5, 0.4
    assert motion.invariants.D.any()
    size = motion.size
    kernel = Kernel(motion, np.arange(size), size)
    state = np.random.default_rng(7).normal(size=2 * size)

    def force(shift: np.ndarray) -> np.ndarray:
        q, q_t = np.split(state + shift, 2)
        return np.array(kernel.forces(time, q.tolist(), q_t.tolist()))

    shifts = step * np.eye(2 * size)
    slopes = np.array([force(shift) - force(-shift) for shift in shifts]).T / (2.0 * step)
    q, q_t = (part.tolist() for part in np.split(state, 2))
    found = kernel.jacobian(time, q, q_t, 2.0, 3.0)
    expected = -2.0 * slopes[:, :size] - 3.0 * slopes[:, size:]
    assert found == pytest.approx(expected, abs=1e-8 * np.abs(expected).max())


def test_recommended_settings_follow_the_accuracy():
    given = exudyn.SimulationSettings()
    made = recommended_settings(0.1, 3e-4, accuracy=1e-6, settings=given)
    assert made is given
    assert made.timeIntegration.numberOfSteps == 334
    assert made.timeIntegration.endTime == 0.1
    assert made.timeIntegration.newton.relativeTolerance == pytest.approx(1e-7)
    assert recommended_settings(0.1, 1e-3).timeIntegration.numberOfSteps == 100


def test_a_slight_unbalance_is_no_rounding():
    """The mass m at radius r shifts the centre by m r / M, 4.5e-6 of the radius of gyration."""
    rotor = ring_rotor(0.1, 0.2, 5.0).add_point_mass([0.1, 0.0, 0.2], 1e-5)
    kept = select_modes(rotor.reduce(0), Formulation("none", 10.0)).invariants
    assert np.linalg.norm(kept.center) == pytest.approx(1e-6 / 5.0, rel=1e-5)
    assert np.any(kept.h)
