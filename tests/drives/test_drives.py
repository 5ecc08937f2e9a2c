"""Motors and drag in scenes: start-up and coast-down in closed form, energy, axes, refusals."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.rigidBodyUtilities import InertiaCuboid
from rings import J, Z, rings, run, speed_of

import exudyn_rotor as er

MOTOR = er.DirectCurrentMotor(stall_torque=5.0, no_load_speed=100.0)


def from_slip(slip, motor):
    """Return the time until a slip: dΩ/dt = T/J integrated, with T by Kloss."""
    most, size = motor.breakdown_slip, J * motor.synchronous_speed / motor.breakdown_torque
    return 0.5 * size * ((1.0 - slip**2) / (2.0 * most) - most * np.log(slip))


INDUCTION = er.InductionMotor(breakdown_torque=8.0, breakdown_slip=0.25, synchronous_speed=100.0)
CLOSED = {  # drive, speed at the start, time, speed then
    "direct current": (MOTOR, 0.0, 1.0, 100.0 * (1.0 - np.exp(-1.0))),
    "induction": (INDUCTION, 0.0, from_slip(0.15, INDUCTION), 85.0),
    "table": (er.TorqueCurve(([0.0, 100.0], [5.0, 0.0])), 0.0, 1.0, 100.0 * (1.0 - np.exp(-1.0))),
    "function of time": (er.TorqueCurve(lambda speed, time: 4.0 * time), 0.0, 1.0, 2.0 / J),
    "dry": (er.Drag(constant=2.0, smooth_speed=1e-3), 60.0, 1.0, 60.0 - 2.0 / J),
    "linear": (er.Drag(linear=0.05), 60.0, 1.0, 60.0 * np.exp(-1.0)),
    "quadratic": (er.Drag(quadratic=1e-3), 60.0, 1.0, 1.0 / (1.0 / 60.0 + 1e-3 / J)),
}


@pytest.mark.parametrize("at", [None, "left"])
@pytest.mark.parametrize("name", CLOSED)
def test_start_and_coast_down_in_closed_form(name, at):
    """J dΩ/dt = T(Ω, t); the rule is of second order, its error some (h/τ)²/12."""
    drive, start, time, expected = CLOSED[name]
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rings().reduce(0), translation="none", initial_speed=start)
    er.add_drive(body, drive, at)
    run(mbs, time, 150)
    assert speed_of(body) == pytest.approx(expected, rel=2e-5)


def eccentric(axis=Z, rotation=None, at=None, steps=60, modes=0):
    """Start an eccentric rotor on springs, a full one without `modes`; return scene, sensors."""
    mbs = exu.SystemContainer().AddSystem()
    rotor = rings(axis, heavy=0.05)
    rotor = rotor if modes is None else rotor.reduce(modes)
    body = er.add_rotor(mbs, rotor, rotation=rotation, initial_speed=20.0)
    er.add_supports(body, [er.Support(name, 1e5 * np.eye(3)) for name in ("left", "right")])
    motor = er.add_drive(body, MOTOR, at)
    drag = er.add_drive(body, er.Drag(quadratic=2e-4, linear=0.01), "right" if at is None else None)
    sensors = [body.add_energy_sensor(), motor.add_sensor(), drag.add_sensor()]
    run(mbs, 0.2, steps, body)
    return mbs, body, sensors


@pytest.mark.parametrize("at", [None, "left"])
def test_energy_is_what_the_drives_give(at):
    """Of the rotor: the work of drives and springs; the integrals are of second order."""
    errors = []
    for steps in (60, 120):
        mbs, body, (energy, *sensors) = eccentric(at=at, steps=steps)
        work = 0.0
        for sensor in sensors:
            time, _, power = mbs.GetSensorStoredData(sensor)[1:].T
            work += np.trapezoid(power, time)
        springs = 0.0
        for support in body.supports:
            u = mbs.GetObjectOutput(support.objects[0], exu.OutputVariableType.Displacement)
            springs += 0.5e5 * u @ u
        own = mbs.GetSensorStoredData(energy)[1:, 1:].sum(axis=1)
        errors.append((own[-1] - own[0] + springs - work) / work)
    assert abs(errors[0]) < 2e-3
    assert abs(errors[1]) < 0.35 * abs(errors[0])


def test_the_stator_takes_the_reaction():
    """Rotor and a free housing: no angular momentum together."""
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rings().reduce(0), translation="none", position=[0.0, 0.0, 0.15])
    inertia = InertiaCuboid(density=2500.0, sideLengths=[0.3, 0.2, 0.1])
    housing = mbs.CreateRigidBody(inertia=inertia, nodeType=exu.NodeType.RotationRxyz)
    er.add_drive(body, MOTOR, "left", base=housing)
    run(mbs, 0.5, 50)
    omega = mbs.GetObjectOutputBody(housing, exu.OutputVariableType.AngularVelocity, [0, 0, 0])
    back = inertia.GetInertia6D()[2]
    assert back * omega[2] == pytest.approx(-J * speed_of(body), rel=1e-9)
    both = J * back / (J + back)
    relative = 100.0 * (1.0 - np.exp(-0.5 * 0.05 / both))
    assert speed_of(body) - omega[2] == pytest.approx(relative, rel=1e-4)


def test_a_run_beyond_a_table_stops():
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rings().reduce(0), translation="none")
    er.add_drive(body, er.TorqueCurve(([0.0, 5.0], [5.0, 5.0])))
    with pytest.raises(Exception, match="curve: its table holds 0 to 5 rad/s"):
        run(mbs, 0.2, 20)
    assert er.TorqueCurve(([0.0, 5.0], [5.0, 4.0]), extrapolate=True).torque(9.0) == 4.0


@pytest.mark.parametrize("at", ["left", None])
def test_linear_analyses_of_a_scene_with_a_motor(at):
    """At an interface −dT/dΩ damps the twist there; on the whole spin it moves nothing else.

    At the speed without load, as a torque itself acts on shafts that bend.
    """
    rotor, slope = rings().reduce(24), MOTOR.stall_torque / MOTOR.no_load_speed
    held = [er.Support(name, 2e6 * np.eye(3), 50.0 * np.eye(3)) for name in ("left", "right")]
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rotor, spin="free", initial_speed=MOTOR.no_load_speed)
    er.add_supports(body, held)
    er.add_drive(body, MOTOR, at)
    mbs.Assemble()
    damper = [er.Support(at, tilt_damping=np.diag([0.0, 0.0, slope]))] if at else []
    models = er.linear_model(mbs, body=body), er.linear_model(rotor, supports=[*held, *damper])
    found, expected = (
        er.stability(one, [MOTOR.no_load_speed], accuracy=None).exponents[0] for one in models
    )
    distances = np.abs(found[:, None] - expected).min(axis=1)
    assert (distances / np.abs(found)).max() < 1e-6
