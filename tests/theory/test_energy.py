"""Energy of a rotor: against its nodes, against closed forms, and its conservation in a scene."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import free_stiffness, ring_rotor
from test_motion import AXIS, FAMILY, GRAVITY, ORIENTATION, motion_of, random_state

from exudyn_rotor import (
    Formulation,
    PrescribedMotion,
    SolidRotor,
    add_rotor,
    recommended_settings,
)
from exudyn_rotor.theory.energy import energy_of

T = 0.7  # s, of prescribed motions


@FAMILY
def test_energy_is_that_of_the_nodes(formulation):
    """½ ṗᵀMṗ, ½ c_fᵀKc_f and −gᵀMp with ``p = τ + R A(θ)(x + Ψζ)``, ``ṗ`` by its definition."""
    motion, modes, arrays = motion_of(formulation, "none")
    q, v = random_state(motion.size, 2)
    nodes, zeta, zeta_t = arrays["nodes"], q[motion.modes], v[motion.modes]
    count = motion.translations.stop
    theta, omega = q[count], v[count]
    if not formulation.has_spin:
        theta, omega = formulation.spin.value(T), formulation.spin.rate(T)
    tau = motion.free_directions @ q[:count]
    tau_t = motion.free_directions @ v[:count]
    if formulation.moves_origin:
        tau, tau_t = formulation.translation.value(T), formulation.translation.rate(T)
    turn = ORIENTATION @ AXIS.rotation(theta)
    local = nodes + (modes @ zeta).reshape(-1, 3)
    rate = omega * np.cross(AXIS.direction, local) + (modes @ zeta_t).reshape(-1, 3)
    p, p_t = tau + local @ turn.T, (tau_t + rate @ turn.T).ravel()
    mass = arrays["mass"]
    found = energy_of(motion, T, q, v)
    assert found.kinetic == pytest.approx(0.5 * p_t @ (mass @ p_t), rel=1e-12)
    bent = modes @ zeta
    assert found.elastic == pytest.approx(0.5 * bent @ (arrays["stiffness"] @ bent), rel=1e-12)
    moved = (p - nodes @ ORIENTATION.T).ravel()
    weight = -np.tile(GRAVITY, len(nodes)) @ (mass @ moved)
    # sums of terms of the size of m g p
    assert found.weight == pytest.approx(weight, abs=1e-12 * abs(mass).sum() * abs(p).max() * 4)


@pytest.mark.parametrize(
    ("translation", "coupling"),
    [("free", "full"), ("in-plane", "full"), ("none", "full"), ("free", "frozen")],
)
def test_energy_with_stiffening_is_that_of_the_equations(translation, coupling):
    """With a free spin all of the energy is in the unknowns; the equations conserve it."""
    formulation = Formulation(translation, "free", spin_coupling=coupling)
    motion, _, _ = motion_of(formulation, "tilt")
    q, v = random_state(motion.size, 2)
    found = energy_of(motion, 0.0, q, v)
    assert found.kinetic + found.elastic == pytest.approx(motion.energy(0.0, q, v), rel=1e-12)


def run(reduced, end_time, steps, setup=lambda mbs, body: None, **arguments):
    """Run a rotor, and return time and energies (s, 3)."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, **arguments)
    sensor = body.add_energy_sensor()
    others = setup(mbs, body)
    mbs.Assemble()
    settings = recommended_settings(end_time=end_time, step=end_time / steps)
    settings.timeIntegration.generalizedAlpha.spectralRadius = 1.0
    settings.timeIntegration.newton.relativeTolerance = 1e-10
    settings.timeIntegration.newton.absoluteTolerance = 1e-10
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = end_time / steps
    mbs.SolveDynamic(settings)
    data = mbs.GetSensorStoredData(sensor)
    return data[:, 0], data[:, 1:], mbs, others


def test_two_masses_at_constant_speed():
    """Each moves out to ``r + u``, ``u = Ω² m r/(k − Ω² m)``, from where it rotates at rest."""
    mass, stiffness, radius, speed = 1.0, 1e6, 0.1, 300.0
    rotor = SolidRotor.from_matrices(
        mass * np.eye(6), stiffness * np.eye(6), [[radius, 0, 0], [-radius, 0, 0]], "z"
    )
    out = speed**2 * mass * radius / (stiffness - speed**2 * mass)
    start = rotor.reduce(6)
    columns = start.shapes.matrix
    moved = np.array([out, 0, 0, -out, 0, 0])
    _, energy, _, _ = run(
        start,
        1e-3,
        2,
        spin=speed,
        translation="none",
        stiffening="none",
        modal_coordinates=columns.T @ moved * mass,
    )
    expected = [mass * (speed * (radius + out)) ** 2, stiffness * out**2, 0.0]
    # at rest in the rotor frame to Newton's tolerance
    np.testing.assert_allclose(energy, np.tile(expected, (len(energy), 1)), rtol=1e-8)


def test_rigid_ring_that_flies_and_spins():
    """½ m v² + ½ m r² Ω², and the weight m g h of a free fall: the sum stays."""
    velocity, speed = [0.3, -0.2, 0.4], 50.0
    time, energy, _, _ = run(
        ring_rotor(0.1, 0.05, 3.0).reduce(0),
        0.1,
        20,
        gravity=[0.0, 0.0, -9.81],
        initial_velocity=velocity,
        initial_speed=speed,
    )
    height = velocity[2] * time - 0.5 * 9.81 * time**2
    spin = 0.5 * 3.0 * 0.1**2 * speed**2
    flying = 0.5 * 3.0 * (velocity[0] ** 2 + velocity[1] ** 2 + (velocity[2] - 9.81 * time) ** 2)
    # a parabola is integrated exactly
    np.testing.assert_allclose(energy[:, 0], spin + flying, rtol=1e-9)
    np.testing.assert_allclose(energy[:, 2], 3.0 * 9.81 * height, atol=1e-9)
    assert np.all(energy[:, 1] == 0.0)


@pytest.mark.parametrize("translation", ["free", "none"])
def test_an_eccentric_rotor_exchanges_energy_and_keeps_the_sum(translation):
    """A pendulum (none) or a body in free fall, with vibrating masses; the error falls with h²."""
    ring = ring_rotor(0.2, 0.1, 4.0)
    soft = free_stiffness(ring.nodes, 1e5 * np.eye(ring.nodes.size))
    rotor = SolidRotor.from_matrices(ring.mass, soft, ring.nodes, "z")
    reduced = rotor.add_point_mass([0.2, 0.0, 0.1], 1.0).reduce(6)
    size = 8 + 3 * (translation == "none")
    drift, exchanged = [], []
    for steps in (100, 200):
        _, energy, _, _ = run(
            reduced,
            0.02,
            steps,
            translation=translation,
            gravity=[0.0, -500.0, 0.0],
            initial_speed=40.0,
            modal_velocities=np.eye(size)[-6] * 0.5,
        )
        total = energy.sum(axis=1)
        drift.append(np.abs(total - total[0]).max())
        exchanged.append(np.ptp(energy, axis=0))
    assert np.all(exchanged[0][[0, 2]] > 1.0)
    assert exchanged[0][1] > 1e-3
    assert drift[0] < 1e-3 * exchanged[0][0]
    assert drift[1] < 0.3 * drift[0]  # 0.25 and terms of higher order


def test_a_driven_rotor_gains_what_the_drive_supplies():
    """Run-up of an eccentric rotor: change of energy = ∫ T ω dt."""
    end = 0.1
    spin = PrescribedMotion.run_up(0.0, 80.0, end)
    rotor = ring_rotor(0.2, 0.1, 4.0).add_point_mass([0.2, 0.0, 0.1], 1.0)
    time, energy, mbs, torque = run(
        rotor.reduce(4),
        end,
        400,
        lambda mbs, body: body.add_drive_torque_sensor(),
        spin=spin,
        translation="none",
        locking="constraints",
    )
    power = mbs.GetSensorStoredData(torque)[:, 1] * [spin.rate(t) for t in time]
    work = np.trapezoid(power, time)
    gained = np.ptp(energy[[0, -1]].sum(axis=1))
    assert energy[-1, 0] > 100.0
    # trapezoidal rule and integrator: O(h²) of the run of 400 steps
    assert work == pytest.approx(gained, rel=1e-3)
