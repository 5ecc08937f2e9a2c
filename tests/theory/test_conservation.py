"""Energy and momentum that the equations of motion keep."""

from dataclasses import replace

import numpy as np
import pytest
from point_rotors import random_invariants, ring_rotor
from scipy.integrate import solve_ivp
from test_motion import FREE_SPIN

from exudyn_rotor import Formulation, Invariants, Motion, select_modes
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


def test_conservation_over_1000_revolutions():
    """Unbalanced body on its centre of mass in the slow one of its wobbles, for long steps."""
    balanced = ring_rotor(0.3, 0.19, 12.0)
    rotor = balanced.add_point_mass(balanced.nodes[2], 0.1)
    invariants = select_modes(rotor.reduce(0), Formulation("free")).invariants
    motion = Motion(invariants, Formulation("free"), stiffening(invariants, "tilt"))
    speed, count = 100.0, motion.formulation.translation_count
    zeta, zeta_t = slow_wobble(invariants, speed, 0.05)
    assert np.abs(invariants.h).max() > 1e-3  # the unbalance tilts the body
    start = np.array([*np.zeros(count + 1), *zeta])
    rate = np.array([*[0.3, -0.2, 0.1][:count], speed, *zeta_t])
    assert max(drifts(motion, 1000, start, rate, 1e-7)) < 1e-8  # 5e-10, falls with the tolerance


def slow_wobble(invariants: Invariants, speed: float, amplitude: float) -> tuple:
    """Return the state of steady rotation plus the slowest whirl in the rotor frame."""
    steady = Motion(invariants, Formulation("none", speed), stiffening(invariants, "tilt"))
    rest = np.zeros(2)
    by_q, by_v = steady.jacobian(0.0, rest, rest)
    state = np.block([[np.zeros((2, 2)), np.eye(2)], [by_q, by_v]])  # the mass matrix is I
    values, vectors = np.linalg.eig(state)
    slowest = vectors[:, np.argmin(np.abs(values.imag))].real
    slowest *= amplitude / np.linalg.norm(slowest[:2])
    static = -np.linalg.solve(by_q, steady.forces(0.0, rest, rest))
    return static + slowest[:2], slowest[2:]
