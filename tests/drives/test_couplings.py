"""Flexible couplings: closed forms, energy, loads of misalignment, scenes."""

import exudyn as exu
import numpy as np
import pytest
from rings import J, rings, run

import exudyn_rotor as er

ENDS = ("left", "right")
OFFSET = [1e-3, -4e-4, 2e-3, 1e-3]
COUPLING = er.FlexibleCoupling(
    torsion=2e4, lateral=[1e6, 3e5], angular=[4e3, 1e3], axial=2e5,
    damping=[30.0, 20.0, 2.0, 1.0], misalignment=OFFSET, runout=[2e-4, 0.0, 0.0, 1e-3],
)  # fmt: skip


def test_forces_are_what_energy_and_loss_say():
    """−f·ẋ = dE/dt + loss, by central differences of E."""
    law, rng = COUPLING, np.random.default_rng(4)
    for _ in range(20):
        x, x_t = 1e-3 * rng.normal(size=12), rng.normal(size=12)
        turn = 6.0 * rng.normal()
        x[5] += turn
        x[11] += turn
        h = 1e-7
        growth = (law.energy(x + h * x_t) - law.energy(x - h * x_t)) / (2.0 * h)
        power = -law.forces(x, x_t) @ x_t
        tolerance = 1e-15 * law.energy(x) / h + 1e-6 * abs(power)
        assert growth + law.loss(x, x_t) == pytest.approx(power, abs=tolerance)


def test_loads_of_misalignment():
    """Turned by θ: (k₁ + k₂)/2 m stands still, (k₁ − k₂)/2 m turns with 2θ; a runout with θ."""
    angles = 2.0 * np.pi * np.arange(16) / 16

    def harmonics(**changes):
        coupling = er.FlexibleCoupling(torsion=1e4, **changes)
        x = np.zeros(12)
        loads = []
        for angle in angles:
            x[5] = x[11] = angle
            force = coupling.forces(x, np.zeros(12))
            loads.append(force[6] + 1j * force[7])
        return np.fft.fft(loads) / len(angles)

    found = harmonics(lateral=[1e6, 4e5], misalignment=[1e-3, 0.0, 0.0, 0.0])
    expected = np.zeros(16)
    expected[[0, 2]] = -700.0, -300.0
    np.testing.assert_allclose(found, expected, atol=1e-9)
    found = harmonics(lateral=4e5, runout=[1e-3, 0.0, 0.0, 0.0])
    expected = np.zeros(16)
    expected[1] = 400.0
    np.testing.assert_allclose(found, expected, atol=1e-9)


def two_on_one_axis(coupling, full):
    """Return a scene of two rotors, one behind the other, right end to left."""
    mbs, rotor = exu.SystemContainer().AddSystem(), rings()
    one = er.add_rotor(mbs, rotor.reduce(0), name="one")
    behind = rotor if full else rotor.reduce(0)
    two = er.add_rotor(mbs, behind, name="two", position=[0.0, 0.0, 0.3])
    for body in (one, two):
        er.add_supports(body, [er.Support(name, 1e6 * np.eye(3)) for name in ENDS])
    return mbs, one, er.connect_rotors(coupling, one, "right", two, "left")


@pytest.mark.parametrize("full", [False, True])
def test_two_inertias_on_a_torsion_spring(full):
    """A torque step on two equal inertias: half of the twist at ω² = 2 k/J."""
    mbs, one, connection = two_on_one_axis(er.FlexibleCoupling(torsion=200.0), full)
    er.add_drive(one, er.TorqueCurve(lambda speed, t: 4.0))
    sensor = connection.add_sensor()
    run(mbs, 0.1, 200)
    time, torque = mbs.GetSensorStoredData(sensor)[:, :2].T
    expected = 2.0 * (1.0 - np.cos(np.sqrt(2.0 * 200.0 / J) * time))
    np.testing.assert_allclose(torque, expected, atol=0.01)  # h² ω³ t/12 of the phase
