"""Energy and momentum that the equations of motion keep."""

from dataclasses import replace

import numpy as np
import pytest
from point_rotors import random_invariants
from scipy.integrate import solve_ivp
from test_motion import FREE_SPIN

from exudyn_rotor import Formulation, Motion
from exudyn_rotor.theory.stiffening import stiffening


def drifts(motion: Motion, revolutions: int, start: np.ndarray, rate: np.ndarray, tolerance: float):
    """Integrate the torque-free rotor; return the relative drifts of energy and momentum."""
    count = motion.formulation.translation_count

    def derivative(t, state):
        q, v = np.split(state, 2)
        return np.append(v, np.linalg.solve(motion.mass_matrix(t, q), motion.forces(t, q, v)))

    end = revolutions * 2 * np.pi / rate[count]
    result = solve_ivp(
        derivative,
        (0.0, end),
        np.append(start, rate),
        method="DOP853",
        rtol=tolerance,
        atol=1e-2 * tolerance,
        t_eval=np.linspace(0.0, end, 30),
    )
    states = [np.split(state, 2) for state in result.y.T]
    turned = states[-1][0][count] / (2 * np.pi)
    assert turned == pytest.approx(revolutions, rel=0.2)
    energy = np.array([motion.energy(0.0, q, v) for q, v in states])
    spin = np.array([momentum_about_axis(motion, q, v) for q, v in states])
    return np.abs(energy / energy[0] - 1.0).max(), np.abs(spin / spin[0] - 1.0).max()


def momentum_about_axis(motion: Motion, q: np.ndarray, v: np.ndarray) -> float:
    """Return the angular momentum about the inertial axis e through the inertial origin."""
    count = motion.formulation.translation_count
    momenta, axis = motion.momentum(0.0, q, v), motion.invariants.direction
    place = motion.free_directions @ q[:count]
    return float(momenta[count] + axis @ np.cross(place, motion.free_directions @ momenta[:count]))


@FREE_SPIN
def test_conservation_with_every_coupling(translation):
    """Random modes and an origin off the centre of mass: τ, θ and ζ all exchange energy."""
    invariants, _, _ = random_invariants(2, 2)
    conservative = replace(invariants, K=400.0 * invariants.M, D=np.zeros((2, 2)))
    motion = Motion(conservative, Formulation(translation), stiffening(conservative, "tilt"))
    count = motion.formulation.translation_count
    start = np.array([*np.zeros(count + 1), 0.02, -0.01])
    rate = np.array([*[0.3, -0.2, 0.1][:count], 10.0, 0.0, 0.0])
    assert max(drifts(motion, 8, start, rate, 1e-10)) < 1e-9  # 5e-11, falls with the tolerance
