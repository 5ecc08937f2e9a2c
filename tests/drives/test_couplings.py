"""Flexible couplings and Cardan joints: closed forms, energy, loads of misalignment, scenes."""

from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest
from rings import J, rings, run, speed_of
from scipy.spatial.transform import Rotation

from exudyn_rotor import (
    CardanJoint,
    ConstantSpeed,
    Drag,
    FlexibleCoupling,
    Support,
    TorqueCurve,
    add_drive,
    add_rotor,
    add_supports,
    campbell,
    check_run,
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


@pytest.mark.parametrize("name", COUPLINGS)
def test_tangent_is_that_of_a_relaxed_coupling(name):
    """Without force only the part that is kept is left."""
    coupling = FlexibleCoupling(torsion=2e4, lateral=[1e6, 3e5], angular=5e3, damping=[9, 8, 7, 6])
    law = coupling.law if name == "flexible" else COUPLINGS[name].law
    rest, step = np.zeros(12), 1e-7
    for place, matrix in zip((0, 1), law.tangent(rest, rest), strict=True):
        columns = []
        for move in step * np.eye(12):
            ahead, back = [rest, rest], [rest, rest]
            ahead[place], back[place] = rest + move, rest - move
            columns.append((law.forces(*back) - law.forces(*ahead)) / (2.0 * step))
        np.testing.assert_allclose(np.transpose(columns), matrix, atol=1e-6 * np.abs(matrix).max())


def test_linear_analyses_take_the_same_matrices():
    coupling = COUPLINGS["flexible"]
    aligned = replace(coupling, misalignment=np.zeros(4), runout=np.zeros(4))
    tangent = aligned.law.tangent(np.zeros(12), np.zeros(12))
    support = coupling.support("right")
    assert (support.interface, support.frame) == ("right", "rotor")
    for found, expected in zip(support.matrices(0.0), tangent, strict=True):
        np.testing.assert_allclose(found, expected[6:, 6:], rtol=1e-12)


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
    turn = Rotation.align_vectors([axes @ coupling.law.second_axis], [axes[:, 2]])[0].as_matrix()
    apart = 0.15 * (axes[:, 2] + turn @ axes[:, 2])
    one = add_rotor(mbs, rotor.reduce(0), name="one", rotation=rotation, **starts)
    two = add_rotor(
        mbs, rotor if full else rotor.reduce(0), name="two", rotation=turn @ rotation,
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


def swing(name, steps=50, **places):
    """Let a coupling go at speed; return speeds and loss, and the remainder of energy over it."""
    mbs, one, two, connection = two_on_one_axis(COUPLINGS[name], initial_speed=40.0, **places)
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


@pytest.mark.parametrize("name", COUPLINGS)
def test_energy_is_kept_but_for_the_loss(name):
    """But for what falls with the square of the step."""
    left = [swing(name, steps)[1] for steps in (80, 160)]
    assert left[0] / left[1] == pytest.approx(4.0, rel=0.1)
    assert abs(left[1]) < 0.02


@pytest.mark.parametrize("name", COUPLINGS)
@pytest.mark.parametrize(
    "places",
    [
        {"axis": [1.0, 0.0, 0.0]},
        {"axis": [2.0, -1.0, 2.0], "rotation": Rotation.from_euler("x", 0.7).as_matrix()},
    ],
    ids=["x", "skew"],
)
def test_axes_change_nothing(places, name):
    np.testing.assert_allclose(swing(name, **places)[0], swing(name)[0], rtol=1e-6)


@pytest.mark.parametrize("axis", [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [2, -1, 2]])
@pytest.mark.parametrize("name", COUPLINGS)
def test_what_holds_the_frame_has_the_reaction(name, axis):
    """As of a load at any marker, whichever angle of the node spins.

    But for moments by the deflection of 0.5 mm at most over the length of 0.3 m, second order.
    """
    mbs, one, two, _ = two_on_one_axis(COUPLINGS[name], axis, initial_speed=40.0)
    for body in (one, two):
        body.start_recording()
    run(mbs, 0.02, 50, accuracy=1e-7)
    for body in (one, two):
        assert check_run(body, warn=False)["unresisted load"].value < 2e-3


def test_a_shaft_turns_a_rotor():
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rings().reduce(0), initial_speed=30.0)
    add_supports(body, [Support(name, 1e6 * np.eye(3)) for name in ENDS])
    coupling = FlexibleCoupling(torsion=500.0, damping=[0.0, 0.0, 0.0, 5.0])
    sensor = connect_rotors(coupling, body, "right", ConstantSpeed(30.0, 0.4)).add_sensor()
    add_drive(body, Drag(linear=0.1))
    run(mbs, 1.0, 200)
    assert speed_of(body) == pytest.approx(30.0, rel=1e-6)
    assert mbs.GetSensorStoredData(sensor)[-1, 1] == pytest.approx(-3.0, rel=1e-6)


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


def test_cardan_joint_bends_its_shafts():
    """The cross turns the torque T about the first axis into T tan β about the direction across.

    At α = 90° the first pin stands across the plane of the axes (F. Duditza, ch. 4).
    """
    joint = CardanJoint(joint_angle=0.4, stiffness=1e4)
    for angle, first, second in ((0.0, np.tan(0.4), 0.0), (0.5 * np.pi, 0.0, np.sin(0.4))):
        x = np.zeros(12)
        x[5], x[9:] = angle, (angle + 1e-4) * joint.second_axis
        f = joint.forces(x, 0.0 * x)
        about = [f[3:6] @ [0.0, 0.0, 1.0], f[9:] @ joint.second_axis]
        assert about[0] / about[1] == pytest.approx(-joint.speed_ratio(angle), rel=1e-9)
        assert np.linalg.norm(f[3:5]) / abs(about[0]) == pytest.approx(first, abs=1e-9)
        across = f[9:] - about[1] * joint.second_axis
        assert np.linalg.norm(across) / abs(about[1]) == pytest.approx(
            second / np.cos(0.4), abs=1e-9
        )


@pytest.mark.parametrize(
    ("make", "match"),
    [
        (lambda: FlexibleCoupling(torsion=0.0), "torsion: needs a finite number"),
        (lambda: FlexibleCoupling(torsion=1.0, lateral=[1.0, -1.0]), "lateral: needs numbers ≥ 0"),
        (lambda: FlexibleCoupling(torsion=1.0, angular=[1.0] * 3), "angular: needs a number or"),
        (lambda: FlexibleCoupling(torsion=1.0, damping=[-1.0, 0, 0, 0]), "damping: needs four"),
        (lambda: CardanJoint(joint_angle=1.6, stiffness=1.0), "joint_angle: needs"),
    ],
)
def test_bad_numbers_are_refused(make, match):
    with pytest.raises(ValueError, match=match):
        make()


def test_shafts_elsewhere_are_refused():
    mbs = exu.SystemContainer().AddSystem()
    rotor = rings().reduce(0)
    one = add_rotor(mbs, rotor, name="one")
    two = add_rotor(mbs, rotor, name="two", position=[0.0, 0.0, 0.3])
    before = mbs.systemData.NumberOfObjects()
    flexible, cardan = COUPLINGS.values()
    shaft = ConstantSpeed(1.0)
    for match, arguments in (
        ("other: the interface of the second rotor is 0.3 m", (flexible, one, "left", two, "left")),
        ("other: its axis is", (cardan, one, "right", two, "left")),
        ("other_at: a shaft has no interface", (flexible, one, "right", shaft, "left")),
    ):
        with pytest.raises(ValueError, match=match):
            connect_rotors(*arguments)
        assert mbs.systemData.NumberOfObjects() == before


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
