"""Where the energy of a run went: against the forces of springs, dampers, loads and the drive."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import free_stiffness, ring_rotor

from exudyn_rotor import (
    PrescribedMotion,
    SolidRotor,
    add_rotor,
    energy_balance,
    recommended_settings,
)

RADIUS, LENGTH, MASS, ADDED = 0.1, 0.2, 8.0, 0.2
STIFFNESS, DAMPING = 2e4, 60.0  # N/m, N s/m, of each of the two bearings
TORQUE, GRAVITY = 20.0, 9.81
ENDS = {"left": -LENGTH, "right": LENGTH}
END = 0.2  # s
KINDS = exu.OutputVariableType


@pytest.fixture(scope="module")
def reduced():
    """Return two soft rings, eccentric by 2.4 mm."""
    ring = ring_rotor(RADIUS, LENGTH, MASS)
    soft = free_stiffness(ring.nodes, 1e6 * np.eye(ring.nodes.size))
    rotor = SolidRotor.from_matrices(ring.mass, soft, ring.nodes, "z")
    rotor = rotor.add_point_mass([RADIUS, 0.0, LENGTH], ADDED)
    for name, z in ENDS.items():
        numbers = np.flatnonzero(np.isclose(ring.nodes[:, 2], z))
        rotor = rotor.with_interface(name, numbers)
    return rotor.reduce(4)


def run(reduced, steps, torque=0.0, recording=True, radius=1.0, **options):
    """Run a rotor on two bearings; return its balance, and sensors of the bearings and the spin."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(
        mbs,
        reduced,
        mass_damping=2.0,
        stiffness_damping=1e-4,
        gravity=[3.0, -GRAVITY, 2.0],
        **options,
    )
    if recording:
        body.start_recording()
    sensors = {}
    for name, z in ENDS.items():
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[mbs.CreateGround(), body.marker(name)],
            localPosition0=[0.0, 0.0, z],
            stiffness=[STIFFNESS] * 3,
            damping=[DAMPING] * 3,
        )
        for kind in (KINDS.Displacement, KINDS.Velocity, KINDS.AngularVelocity):
            sensors[name, kind] = body.add_interface_sensor(name, kind)
    if torque:
        mbs.CreateTorque(itemNumber=body.marker("left"), loadVector=[0.0, 0.0, torque])
    if not body.formulation.has_spin:
        sensors["drive"] = body.add_drive_torque_sensor()
    mbs.Assemble()
    settings = recommended_settings(END, END / steps, accuracy=1e-6)
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.generalizedAlpha.spectralRadius = radius
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = END / steps
    mbs.SolveDynamic(settings)
    found = {key: mbs.GetSensorStoredData(number)[1:] for key, number in sensors.items()}
    return energy_balance(body), found


def work_of_supports(found, torque):
    """Return the work on the rotor at the last instant since the second, by forces × velocities."""
    total = 0.0
    for name in ENDS:
        u, v = (found[name, kind][:, 1:] for kind in (KINDS.Displacement, KINDS.Velocity))
        turning = found[name, KINDS.AngularVelocity][:, 3]
        power = -DAMPING * np.sum(v**2, axis=1) + (torque * turning if name == "left" else 0.0)
        total += np.trapezoid(power, found[name, KINDS.Velocity][:, 0])
        total -= 0.5 * STIFFNESS * (u[-1] @ u[-1] - u[0] @ u[0])
    return total


@pytest.mark.parametrize("translation", ["free", "in-plane", "none"])
def test_run_up_by_a_torque(reduced, translation):
    """To 50 rad/s, three quarters of the critical speed; the errors fall with h²."""
    errors, given = [], {"torque": TORQUE, "translation": translation}
    for steps in (400, 800):
        balance, found = run(reduced, steps, **given)
        errors.append(np.abs(balance.error).max())
    assert balance.kinetic[-1] > 50.0
    assert np.ptp(balance.weight) > 0.5
    # by the trapezoidal rule of the bearings' dampers; without the rotor's own it is off by that
    work = work_of_supports(found, TORQUE)
    assert balance.loads[-1] == pytest.approx(work, abs=0.02 * balance.damping[-1])
    assert balance.damping[-1] > 10.0 * errors[1]
    assert not np.any(balance.drive)
    assert errors[0] < 1e-3 * balance.kinetic[-1]
    assert errors[1] < 0.35 * errors[0]


@pytest.mark.parametrize("locking", ["mass", "constraints"])
@pytest.mark.parametrize(
    "spin", [40.0, PrescribedMotion.run_up(0.0, 60.0, END)], ids=["constant", "run-up"]
)
def test_drive_of_a_prescribed_spin(reduced, spin, locking):
    errors = []
    for steps in (400, 800):
        balance, found = run(
            reduced, steps, spin=spin, locking=locking, translation="none", torque=TORQUE
        )
        errors.append(np.abs(balance.error).max())
    time, torque = found["drive"].T
    rate = [40.0 if spin == 40.0 else spin.rate(t) for t in time]
    work = np.trapezoid(torque * rate, time)
    assert balance.drive[-1] == pytest.approx(work, rel=1e-6)
    assert balance.loads[-1] == pytest.approx(work_of_supports(found, TORQUE), rel=1e-3)
    largest = np.abs([balance.drive, balance.loads, balance.kinetic]).max()
    assert errors[1] < 1e-4 * largest
    assert errors[1] < 0.35 * errors[0]


def test_instants_too_far_apart_are_told(reduced):
    """Ten for three turns: what they leave of the works is told, not taken for the integrator's."""
    with pytest.warns(UserWarning, match=r"10 recorded instants are too far apart .*writePeriod"):
        balance, _ = run(reduced, 10, spin=100.0, translation="none")
    assert np.abs(balance.error).max() > 0.01 * np.abs(balance.loads).max()
