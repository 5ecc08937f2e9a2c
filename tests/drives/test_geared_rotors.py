"""Gears between rotors in a scene: ratios, frequencies, energy, backlash, mesh frequency, axes."""

import exudyn as exu
import numpy as np
import pytest
import scipy.linalg
from rings import J, Z, rings, run, speed_of
from scipy.spatial.transform import Rotation

from exudyn_rotor import (
    DirectCurrentMotor,
    Drag,
    GearMesh,
    Support,
    TorqueCurve,
    add_drive,
    add_rotor,
    add_supports,
    connect_rotors,
)

RADII = (0.06, 0.09)
ENDS = ("left", "right")
ACROSS = exu.OutputVariableType.Displacement, exu.OutputVariableType.Velocity


def mesh(**changes):
    return GearMesh(**({"radii": RADII, "stiffness": 2e6, "line_angle": 0.4} | changes))


def pair(
    gears,
    axis=Z,
    rotation=None,
    support=2e6,
    heavy=0.0,
    flip=False,
    full=False,
    first=None,
    second=None,
    damping=0.0,
):
    """Return a scene of two geared rotors, the bodies and the connection.

    `flip` mounts the second one with its axis the other way.
    """
    mbs = exu.SystemContainer().AddSystem()
    rotor = rings(axis, heavy)
    rotation = np.eye(3) if rotation is None else rotation
    n = np.column_stack([rotor.axis.plane, rotor.axis.direction])
    apart = gears.center_distance * n @ [np.cos(gears.line_angle), np.sin(gears.line_angle), 0.0]
    turn = Rotation.from_rotvec(np.pi * n[:, 0]).as_matrix() if flip else np.eye(3)
    reduced = rotor.reduce(0)
    one = add_rotor(mbs, reduced, name="one", rotation=rotation, **(first or {}))
    two = add_rotor(
        mbs, rotor if full else reduced, name="two", rotation=rotation @ turn,
        position=rotation @ apart, **(second or {}),
    )  # fmt: skip
    for body in (one, two):
        add_supports(
            body, [Support(name, support * np.eye(3), damping * np.eye(3)) for name in ENDS]
        )
    # turned over, the right ring is where the left one was
    connection = connect_rotors(gears, one, "left", two, "right" if flip else "left")
    return mbs, (one, two), connection


def closed_form(gears, support, speed=0.0):
    """Return M, G, K (12, 12) of two rigid rotors in axes that stand still, by hand.

    Each has u, φ; masses, springs of the supports, k v vᵀ; J Ω × φ̇ of the tilts.
    """
    mass, across = 5.0, 5.0 * (0.5 * 0.1**2 + 0.15**2)
    M = np.diag([mass] * 3 + [across] * 2 + [J])
    arm = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]) * 0.15
    K, gear = np.zeros((6, 6)), np.eye(6)
    for side in (-1, 1):  # u of a ring is u + φ × (side · 0.15 e)
        move = np.hstack([np.eye(3), -side * arm])
        K += support * move.T @ move
        if side < 0:
            gear[:3] = move
    v = np.hstack([gears.direction[:6] @ gear, gears.direction[6:] @ gear])
    K = scipy.linalg.block_diag(K, K) + gears.stiffness * np.outer(v, v)
    G = np.zeros((12, 12))
    for first, own in ((3, speed), (9, -speed * RADII[0] / RADII[1])):
        G[first, first + 1], G[first + 1, first] = J * own, -J * own
    return scipy.linalg.block_diag(M, M), G, K


@pytest.mark.parametrize("helix_angle", [0.0, 0.3])
def test_frequencies_at_rest_are_those_of_masses_and_springs(helix_angle):
    gears = mesh(helix_angle=helix_angle)
    options = {"locking": "constraints"}
    mbs, _, _ = pair(gears, first=options, second=options)
    mbs.Assemble()
    squares = mbs.ComputeODE2Eigenvalues()[0]
    M, _, K = closed_form(gears, 2e6)
    expected = np.sqrt(np.abs(scipy.linalg.eigvalsh(K, M)))
    found = np.sqrt(np.abs(np.sort(squares)))[-len(expected) + 1 :]
    np.testing.assert_allclose(found, expected[1:], rtol=1e-5)


MOTOR = DirectCurrentMotor(stall_torque=9.0, no_load_speed=60.0)


def driven(steps=100, end_time=0.1, **options):
    """Run a motor on the first rotor against drag on the second; return all that was added."""
    mbs, bodies, gears = pair(**options)
    drives = [add_drive(bodies[0], MOTOR), add_drive(bodies[1], Drag(linear=0.05))]
    sensors = [each.add_sensor() for each in (*drives, gears)]
    energies = [body.add_energy_sensor() for body in bodies]
    run(mbs, end_time, steps, accuracy=1e-7)
    return mbs, bodies, [mbs.GetSensorStoredData(n) for n in (*sensors, *energies)]


def test_speeds_and_torques_are_in_the_ratio_of_the_radii():
    """Steady at T(Ω) r₂/r₁ = c Ω r₁/r₂; stiff bearings, or the gears would move apart."""
    _, bodies, (motor, drag, gear, *_) = driven(200, 4.0, gears=mesh(damping=500.0), support=1e8)
    speeds = [speed_of(body) for body in bodies]
    assert speeds[1] / speeds[0] == pytest.approx(-RADII[0] / RADII[1], rel=1e-5)
    back = 0.05 * (RADII[0] / RADII[1]) ** 2
    assert speeds[0] == pytest.approx(9.0 / (9.0 / 60.0 + back), rel=1e-4)
    assert drag[-1, 1] / motor[-1, 1] == pytest.approx(RADII[1] / RADII[0], rel=1e-3)
    assert gear[-1, 1] == pytest.approx(motor[-1, 1] / RADII[0], rel=1e-3)


TEETH = {"damping": 3e3, "helix_angle": 0.2, "teeth": [20, 30], "variation": [0.2]}


def motion_of(mbs, sensors):
    """Return displacement and rotation of a gear, and their rates, (s, 6); the rotor is rigid."""
    left, right = (
        [mbs.GetSensorStoredData(n)[:, 1:] for n in each] for each in (sensors[:2], sensors[2:4])
    )
    spin = mbs.GetSensorStoredData(sensors[4])[:, 1:3].T
    tilts = [(b - a)[:, [1, 0]] * [-1.0, 1.0] / 0.3 for a, b in zip(left, right, strict=True)]
    return [np.column_stack(each) for each in zip(left, tilts, spin, strict=True)]


def teeth(x, x_t, backlash):
    """Return k(θ) δ²/2 and (N − k δ) δ̇ of all flanks by the motion of both gears (s, 12)."""
    stored = lost = 0.0
    k = 2e6 * (1.0 + 0.2 * np.cos(20.0 * x[:, 5]))
    for flank in (1, -1) if backlash else (1,):
        v = mesh(flank=flank, **TEETH).direction
        depth, rate = x @ v, x_t @ v
        push = k * depth + 3e3 * rate
        if backlash:
            depth = np.maximum(depth - 0.5 * backlash, 0.0)
            push = np.where(depth > 0.0, np.maximum(k * depth + 3e3 * rate, 0.0), 0.0)
        stored, lost = stored + 0.5 * k * depth**2, lost + (push - k * depth) * rate
    return stored, lost


@pytest.mark.parametrize("backlash", [None, 2e-5])
def test_energy_goes_into_drives_springs_and_losses(backlash):
    """The integrals over the steps are of second order, nearly so where flanks hit."""
    left = []
    for steps in (75, 150):
        mbs, bodies, _ = pair(mesh(backlash=backlash, **TEETH), heavy=0.02)
        drives = [add_drive(bodies[0], MOTOR), add_drive(bodies[1], Drag(linear=0.05))]
        powers = [drive.add_sensor() for drive in drives]
        energies = [body.add_energy_sensor() for body in bodies]
        moves = [
            [body.add_interface_sensor(name, kind) for name in ENDS for kind in ACROSS]
            + [body.add_spin_sensor()]
            for body in bodies
        ]
        run(mbs, 0.05, steps, accuracy=1e-7)
        x, x_t = (np.hstack(each) for each in zip(*(motion_of(mbs, m) for m in moves), strict=True))
        energy, lost = teeth(x, x_t, backlash)
        energy = energy + sum(mbs.GetSensorStoredData(n)[:, 1:].sum(axis=1) for n in energies)
        for sensor in (moves[0][0], moves[0][2], moves[1][0], moves[1][2]):
            energy += 0.5 * 2e6 * np.sum(mbs.GetSensorStoredData(sensor)[:, 1:] ** 2, axis=1)
        time, *_ = mbs.GetSensorStoredData(powers[0]).T
        given = sum(mbs.GetSensorStoredData(n)[:, 2] for n in powers)
        lost, given = np.trapezoid(lost, time), np.trapezoid(given, time)
        left.append((energy[-1] - energy[0] + lost - given) / lost)
    assert left[0] / left[1] == pytest.approx(4.0, rel=0.2 if backlash else 0.05)
    assert abs(left[1]) < 0.02


def test_mesh_frequency_is_that_of_the_teeth():
    """At a constant speed, 20 teeth and a stiffness that varies shake the mesh 20 times a turn."""
    gears = mesh(teeth=[20, 30], variation=[0.1], damping=2e3)
    mbs, bodies, connection = pair(
        gears, first={"spin": 30.0}, second={"initial_speed": -20.0}, damping=3e3
    )
    add_drive(bodies[1], TorqueCurve(lambda speed, t: 10.0))
    sensor = connection.add_sensor()
    run(mbs, 0.4, 800)
    time, force = mbs.GetSensorStoredData(sensor)[:, :2].T
    late = force[time > 0.2]
    share = np.abs(np.fft.rfft((late - late.mean()) * np.hanning(len(late))))
    frequencies = 2.0 * np.pi * np.fft.rfftfreq(len(late), time[1] - time[0])
    assert frequencies[share.argmax()] == pytest.approx(gears.mesh_frequency(30.0), rel=0.02)
