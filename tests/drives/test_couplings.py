"""Flexible couplings: closed forms, energy, loads of misalignment, scenes."""

import exudyn as exu
import numpy as np
import pytest
from rings import J, rings, run, speed_of

from exudyn_rotor import (
    FlexibleCoupling,
    Support,
    TorqueCurve,
    add_drive,
    add_rotor,
    add_supports,
    connect_rotors,
)

ENDS = ("left", "right")
OFFSET = [1e-3, -4e-4, 2e-3, 1e-3]
COUPLING = FlexibleCoupling(
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
        coupling = FlexibleCoupling(torsion=1e4, **changes)
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


def two_on_one_axis(coupling, axis=(0.0, 0.0, 1.0), rotation=None, full=False, **starts):
    """Return a scene of two rotors, right end to left, where the coupling needs their axes."""
    mbs = exu.SystemContainer().AddSystem()
    rotor = rings(axis)
    rotation = np.eye(3) if rotation is None else rotation
    axes = rotation @ np.column_stack([rotor.axis.plane, rotor.axis.direction])
    apart = 0.3 * axes[:, 2]
    one = add_rotor(mbs, rotor.reduce(0), name="one", rotation=rotation, **starts)
    two = add_rotor(
        mbs, rotor if full else rotor.reduce(0), name="two", rotation=rotation,
        position=apart, initial_speed=starts.get("initial_speed"),
    )  # fmt: skip
    for body in (one, two):
        add_supports(body, [Support(name, 1e6 * np.eye(3)) for name in ENDS])
    return mbs, one, two, connect_rotors(coupling, one, "right", two, "left")


@pytest.mark.parametrize("full", [False, True])
def test_two_inertias_on_a_torsion_spring(full):
    """A torque step on two equal inertias: half of the twist at ω² = 2 k/J."""
    mbs, one, _, connection = two_on_one_axis(FlexibleCoupling(torsion=200.0), full=full)
    add_drive(one, TorqueCurve(lambda speed, t: 4.0))
    sensor = connection.add_sensor()
    run(mbs, 0.1, 200)
    time, torque = mbs.GetSensorStoredData(sensor)[:, :2].T
    expected = 2.0 * (1.0 - np.cos(np.sqrt(2.0 * 200.0 / J) * time))
    np.testing.assert_allclose(torque, expected, atol=0.01)  # h² ω³ t/12 of the phase


def swing(steps=50, **places):
    """Let a coupling go at speed; return speeds and loss, and the remainder of energy over it."""
    mbs, one, two, connection = two_on_one_axis(COUPLING, initial_speed=40.0, **places)
    sensors = [connection.add_sensor(), one.add_energy_sensor(), two.add_energy_sensor()]
    run(mbs, 0.02, steps, accuracy=1e-7)
    rows = [mbs.GetSensorStoredData(sensor) for sensor in sensors]
    springs = 0.0
    for body in (one, two):
        for support in body.supports:
            u = mbs.GetObjectOutput(support.objects[0], exu.OutputVariableType.Displacement)
            springs += 0.5e6 * u @ u
    total = rows[0][:, 2] + sum(each[:, 1:].sum(axis=1) for each in rows[1:])
    lost = np.trapezoid(rows[0][:, 3], rows[0][:, 0])
    speeds = [speed_of(one), speed_of(two), lost]
    return speeds, (total[-1] + springs + lost - total[0]) / lost


def test_energy_is_kept_but_for_the_loss():
    """But for what falls with the square of the step."""
    left = [swing(steps)[1] for steps in (80, 160)]
    assert left[0] / left[1] == pytest.approx(4.0, rel=0.1)
    assert abs(left[1]) < 0.02
