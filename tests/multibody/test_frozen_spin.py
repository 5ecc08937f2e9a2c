"""A free spin whose mass matrix leaves out what varies with the deflection."""

from dataclasses import replace

import exudyn
import numpy as np
import pytest
from point_rotors import random_invariants, ring_rotor
from run_scenes import solve
from scipy.integrate import solve_ivp

from exudyn_rotor import Formulation, Motion, add_rotor
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.theory.stiffening import stiffening

SPEED = 10.0


def integrated(motion: Motion, deflection: list[float], end: float) -> tuple[np.ndarray, ...]:
    """Return coordinates and rates (30, size) of the rotor that is left to itself."""
    count = motion.formulation.translation_count
    start = np.array([*np.zeros(count + 1), *deflection])
    rate = np.array([*[0.3, -0.2, 0.1][:count], SPEED, *np.zeros(len(deflection))])

    def derivative(t, state):
        q, v = np.split(state, 2)
        return np.append(v, np.linalg.solve(motion.mass_matrix(t, q), motion.forces(t, q, v)))

    times, start = np.linspace(0.0, end, 30), np.append(start, rate)
    result = solve_ivp(derivative, (0.0, end), start, "DOP853", times, rtol=1e-10, atol=1e-12)
    return np.split(result.y.T, 2, axis=1)


def frozen_motion(translation: str, **changes) -> Motion:
    """Return a random undamped rotor with two modes of 20 rad/s."""
    invariants, _, _ = random_invariants(2, 2)
    invariants = replace(invariants, K=400.0 * invariants.M, D=np.zeros((2, 2)), **changes)
    formulation = Formulation(translation, "free", spin_coupling="frozen")
    return Motion(invariants, formulation, stiffening(invariants, "tilt"))


@pytest.mark.parametrize("translation", ["free", "in-plane"])
def test_energy_is_conserved(translation):
    """With unbalance, S, g and B, so that τ, θ and ζ all exchange energy.

    1e-10 is the integrator's tolerance, and 8 revolutions gather some of it.
    """
    motion = frozen_motion(translation)
    assert np.abs(motion.spin_terms.B).max() > 1e-3
    q, v = integrated(motion, [0.02, -0.01], 8 * 2 * np.pi / SPEED)
    energy = np.array([sum(motion.energy(0.0, *state)) for state in zip(q, v, strict=True)])
    assert energy == pytest.approx(energy[0], rel=1e-9)
    assert np.ptp(v[:, motion.formulation.translation_count]) > 1e-3  # the spin takes part


@pytest.fixture(scope="module")
def rings():
    """Two rings with an unbalance, joined by springs: rigid and flexible modes."""
    rotor = ring_rotor(0.2, 0.1, 4.0).add_point_mass([0.2, 0.0, 0.1], 0.01)
    for name, first in (("left", 0), ("right", 5)):
        rotor = rotor.with_interface(name, range(first, first + 5))
    return rotor.reduce(6)


def run(rotor, spin_coupling: str) -> RotorBody:
    """Run the rings at 100 rad/s on soft springs, driven by a torque."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor, initial_speed=100.0, spin_coupling=spin_coupling)
    for name, z in (("left", -0.1), ("right", 0.1)):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[mbs.CreateGround(), body.marker(name)],
            localPosition0=[0, 0, z],
            stiffness=[4e4] * 3,
            damping=[20.0] * 3,
        )
    mbs.CreateTorque(itemNumber=body.marker("left"), loadVector=[0.0, 0.0, 0.5])
    body.start_recording()
    mbs.Assemble()
    solve(mbs, 300, 0.15)
    return body


def test_speeds_err_by_the_change_of_the_moment_of_inertia(rings):
    """By the angular momentum ``½ωc + ζ̇ᵀWζ`` that is left out, over the whole."""
    bodies = {kind: run(rings, kind) for kind in ("full", "frozen")}
    physics = [body.mbs.GetObject(body.objects["physics"]) for body in bodies.values()]
    assert [bool(item["massMatrixUserFunction"]) for item in physics] == [True, False]
    body, record = bodies["frozen"], bodies["frozen"].recorded()
    zeta, rate = (x[:, body.layout.unknowns][:, body.motion.modes] for x in (record.q, record.q_t))
    terms = body.motion.spin_terms
    change = 2.0 * zeta @ terms.h + np.einsum("si,ij,sj->s", zeta, terms.C_hat, zeta)
    left = 0.5 * record.speed * change + np.einsum("si,ij,sj->s", rate, terms.W, zeta)
    share = np.abs(left).max() / (body.motion.invariants.Theta * np.abs(record.speed).max())
    assert 1e-8 < share < 1e-4
    speeds = [body.recorded().speed for body in bodies.values()]
    off = np.abs(speeds[1] - speeds[0]).max() / np.abs(speeds[0]).max()
    assert 0.05 * share < off < 2.0 * share
