"""Flexible couplings and Cardan joints: closed forms, energy, loads of misalignment, scenes."""

import exudyn as exu
import numpy as np
import pytest
from rings import J, rings, run
from scipy.spatial.transform import Rotation

from exudyn_rotor import (
    CardanJoint,
    ConstantSpeed,
    FlexibleCoupling,
    Support,
    TorqueCurve,
    add_drive,
    add_rotor,
    add_supports,
    campbell,
    connect_rotors,
    linear_model,
)

ENDS = ("left", "right")
OFFSET = [1e-3, -4e-4, 2e-3, 1e-3]
COUPLINGS = {
    "flexible": FlexibleCoupling(
        torsion=2e4, lateral=[1e6, 3e5], angular=[4e3, 1e3], axial=2e5,
        damping=[30.0, 20.0, 2.0, 1.0], misalignment=OFFSET, runout=[2e-4, 0.0, 0.0, 1e-3],
    ),
    "cardan": CardanJoint(
        joint_angle=0.5, stiffness=3e3, damping=2.0, turn_direction=0.7, fork_angle=0.3
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", COUPLINGS)
def test_forces_are_what_energy_and_loss_say(name):
    """−f·ẋ = dE/dt + loss, by central differences of E."""
    law, rng = COUPLINGS[name].law, np.random.default_rng(4)
    for _ in range(20):
        x, x_t = 1e-3 * rng.normal(size=12), rng.normal(size=12)
        turn = 6.0 * rng.normal()
        x[5] += turn
        x[6 + 3 :] += turn * law.second_axis
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


def two_on_one_axis(coupling, full):
    """Return a scene of two rotors, one behind the other, right end to left."""
    mbs, rotor = exu.SystemContainer().AddSystem(), rings()
    one = add_rotor(mbs, rotor.reduce(0), name="one")
    behind = rotor if full else rotor.reduce(0)
    two = add_rotor(mbs, behind, name="two", position=[0.0, 0.0, 0.3])
    for body in (one, two):
        add_supports(body, [Support(name, 1e6 * np.eye(3)) for name in ENDS])
    return mbs, one, connect_rotors(coupling, one, "right", two, "left")


@pytest.mark.parametrize("full", [False, True])
def test_two_inertias_on_a_torsion_spring(full):
    """A torque step on two equal inertias: half of the twist at ω² = 2 k/J."""
    mbs, one, connection = two_on_one_axis(FlexibleCoupling(torsion=200.0), full)
    add_drive(one, TorqueCurve(lambda speed, t: 4.0))
    sensor = connection.add_sensor()
    run(mbs, 0.1, 200)
    time, torque = mbs.GetSensorStoredData(sensor)[:, :2].T
    expected = 2.0 * (1.0 - np.cos(np.sqrt(2.0 * 200.0 / J) * time))
    np.testing.assert_allclose(torque, expected, atol=0.01)  # h² ω³ t/12 of the phase


@pytest.mark.parametrize("direction", [0.0, 2.0])
def test_cardan_joint_turns_unevenly(direction):
    """The closed form of F. Duditza, on stiff bearings; a stiff joint twists by T/k."""
    joint = CardanJoint(
        joint_angle=0.5, stiffness=1e5, damping=30.0, turn_direction=direction, fork_angle=0.3
    )
    mbs = exu.SystemContainer().AddSystem()
    a = [np.cos(direction), np.sin(direction), 0.0]
    turn = Rotation.from_rotvec(0.5 * np.array(a)).as_matrix()
    place = np.array([0.0, 0.0, 0.15]) + turn @ [0.0, 0.0, 0.15]
    one = add_rotor(mbs, rings().reduce(0), name="one", spin=20.0)
    ratio = joint.speed_ratio(0.0)
    two = add_rotor(
        mbs,
        rings().reduce(0),
        name="two",
        position=place,
        rotation=turn,
        initial_speed=20.0 * ratio,
    )
    for body in (one, two):
        add_supports(body, [Support(name, 1e8 * np.eye(3)) for name in ENDS])
    connect_rotors(joint, one, "right", two, "left")
    sensor = two.add_spin_sensor()
    run(mbs, 0.4, 400)
    time, _, speed = mbs.GetSensorStoredData(sensor).T
    expected = [20.0 * joint.speed_ratio(20.0 * t) for t in time]
    np.testing.assert_allclose(speed, expected, rtol=2e-3)


def test_linear_analyses_of_a_rotor_on_a_shaft():
    """The scene is refused with what to give instead, which they take."""
    mbs, rotor = exu.SystemContainer().AddSystem(), rings().reduce(0)
    body = add_rotor(mbs, rotor, spin=30.0)
    coupling = COUPLINGS["flexible"]
    connect_rotors(coupling, body, "left", ConstantSpeed(30.0))
    mbs.Assemble()
    with pytest.raises(ValueError, match=r"with a shaft.*coupling.support\('left'\)"):
        linear_model(mbs, body=body)
    found = campbell(rotor, [30.0], supports=[coupling.support("left"), Support("right", 1e6)])
    assert found.free_motions == ()
