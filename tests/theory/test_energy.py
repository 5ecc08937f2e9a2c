"""Energy of a rotor: against its nodes, against closed forms, and its conservation in a scene."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import ring_rotor
from test_motion import AXIS, FAMILY, GRAVITY, ORIENTATION, motion_of, random_state

from exudyn_rotor import (
    PrescribedMotion,
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
