"""Gears between rotors in a scene: ratios of speeds and torques, and the mesh frequency."""

import exudyn as exu
import numpy as np
import pytest
from rings import rings, run, speed_of

import exudyn_rotor as er

RADII = (0.06, 0.09)
ENDS = ("left", "right")


def mesh(**changes):
    return er.GearMesh(**({"radii": RADII, "stiffness": 2e6, "line_angle": 0.4} | changes))


def pair(gears, support=2e6, damping=0.0, first=None, second=None):
    """Return a scene of two geared rotors, the bodies and the connection."""
    mbs, rotor = exu.SystemContainer().AddSystem(), rings().reduce(0)
    along = np.cos(gears.line_angle), np.sin(gears.line_angle)
    apart = gears.center_distance * rotor.axis.plane @ along
    one = er.add_rotor(mbs, rotor, name="one", **(first or {}))
    two = er.add_rotor(mbs, rotor, name="two", position=apart, **(second or {}))
    for body in (one, two):
        er.add_supports(
            body, [er.Support(name, support * np.eye(3), damping * np.eye(3)) for name in ENDS]
        )
    return mbs, (one, two), er.connect_rotors(gears, one, "left", two, "left")


MOTOR = er.DirectCurrentMotor(stall_torque=9.0, no_load_speed=60.0)


def test_speeds_and_torques_are_in_the_ratio_of_the_radii():
    """Steady at T(Ω) r₂/r₁ = c Ω r₁/r₂; stiff bearings, or the gears would move apart."""
    mbs, bodies, connection = pair(mesh(damping=500.0), support=1e8)
    added = (
        er.add_drive(bodies[0], MOTOR),
        er.add_drive(bodies[1], er.Drag(linear=0.05)),
        connection,
    )
    sensors = [each.add_sensor() for each in added]
    run(mbs, 4.0, 200, accuracy=1e-7)
    motor, drag, gear = (mbs.GetSensorStoredData(n) for n in sensors)
    speeds = [speed_of(body) for body in bodies]
    assert speeds[1] / speeds[0] == pytest.approx(-RADII[0] / RADII[1], rel=1e-5)
    back = 0.05 * (RADII[0] / RADII[1]) ** 2
    assert speeds[0] == pytest.approx(9.0 / (9.0 / 60.0 + back), rel=1e-4)
    assert drag[-1, 1] / motor[-1, 1] == pytest.approx(RADII[1] / RADII[0], rel=1e-3)
    assert gear[-1, 1] == pytest.approx(motor[-1, 1] / RADII[0], rel=1e-3)


def test_mesh_frequency_is_that_of_the_teeth():
    """At a constant speed, 20 teeth and a stiffness that varies shake the mesh 20 times a turn."""
    gears = mesh(teeth=[20, 30], variation=[0.1], damping=2e3)
    mbs, bodies, connection = pair(
        gears, first={"spin": 30.0}, second={"initial_speed": -20.0}, damping=3e3
    )
    er.add_drive(bodies[1], er.TorqueCurve(lambda speed, t: 10.0))
    sensor = connection.add_sensor()
    run(mbs, 0.25, 500)
    time, force = mbs.GetSensorStoredData(sensor)[:, :2].T
    late = force[time > 0.05]
    share = np.abs(np.fft.rfft((late - late.mean()) * np.hanning(len(late))))
    frequencies = 2.0 * np.pi * np.fft.rfftfreq(len(late), time[1] - time[0])
    assert frequencies[share.argmax()] == pytest.approx(20 * 30.0, rel=0.02)
