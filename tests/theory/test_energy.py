"""Energy of a rotor: against its nodes, against closed forms, and its conservation in a scene."""

import numpy as np
import pytest
from test_motion import AXIS, FAMILY, GRAVITY, ORIENTATION, motion_of, random_state

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
    found = motion.energy(T, q, v)
    assert found.kinetic == pytest.approx(0.5 * p_t @ (mass @ p_t), rel=1e-12)
    bent = modes @ zeta
    assert found.elastic == pytest.approx(0.5 * bent @ (arrays["stiffness"] @ bent), rel=1e-12)
    moved = (p - nodes @ ORIENTATION.T).ravel()
    weight = -np.tile(GRAVITY, len(nodes)) @ (mass @ moved)
    # sums of terms of the size of m g p
    assert found.weight == pytest.approx(weight, abs=1e-12 * abs(mass).sum() * abs(p).max() * 4)
