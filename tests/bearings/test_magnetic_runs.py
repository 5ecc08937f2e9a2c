"""Magnetic bearings in runs: on a foundation, and the work of the magnets."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.rigidBodyUtilities import InertiaCuboid
from test_magnetic_bearing import MAGNETS, PID, bearing, rigid
from test_supports_in_scenes import SPEED

from exudyn_rotor import add_rotor, add_supports, energy_balance, recommended_settings


def run(mbs, end_time, step=1e-4):
    settings = recommended_settings(end_time=end_time, step=step)
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = step
    settings.timeIntegration.generalizedAlpha.spectralRadius = 1.0
    assert mbs.SolveDynamic(settings)


VELOCITY = exu.OutputVariableType.Velocity


@pytest.mark.parametrize("sensor", [None, "right"])
def test_a_foundation_carries_magnets_and_sensors(sensor):
    """Rotor and free block keep their momentum; moving alike, no magnet pulls."""
    size = InertiaCuboid(5000.0, [0.1, 0.5, 0.2])
    for together in (False, True):
        mbs = exu.SystemContainer().AddSystem()
        start = [0.1, 0.02, 0.0]
        body = add_rotor(mbs, rigid(), spin=SPEED, translation="in-plane", initial_velocity=start)
        block = mbs.CreateRigidBody(
            inertia=size, initialVelocity=start if together else [0.0, 0.0, 0.0]
        )
        supports = [bearing(sensor=sensor), bearing("right")]
        add_supports(body, supports, {"left": block, "right": block})
        mbs.Assemble()
        run(mbs, 0.004)
        across = body.coordinates()[1][:2]
        other = mbs.GetObjectOutputBody(block, VELOCITY, [0.0, 0.0, 0.0])[:2]
        momentum = (20.0 + 50.0 * together) * np.array(start)[:2]
        np.testing.assert_allclose(20.0 * across + 50.0 * other, momentum, atol=1e-9)
        assert (np.abs(across - other).max() < 1e-9) == together


def test_work_of_the_magnets_is_the_energy_of_the_rotor():
    """Force times velocity, over time, is the change of the kinetic energy: O(h²)."""
    errors = []
    for step in (1e-4, 5e-5):
        mbs = exu.SystemContainer().AddSystem()
        start = [0.1, 0.02, 0.0]
        body = add_rotor(mbs, rigid(), spin=0.0, translation="in-plane", initial_velocity=start)
        added = add_supports(body, [bearing(actuator=MAGNETS), bearing("right", PID, MAGNETS)])
        body.start_recording()
        sensors = [one.add_sensor() for one in added]
        mbs.Assemble()
        run(mbs, 0.01, step)
        stored = [mbs.GetSensorStoredData(number)[1:] for number in sensors]
        work = -sum(np.trapezoid((s[:, 4:7] * s[:, 7:]).sum(axis=1), s[:, 0]) for s in stored)
        balance = energy_balance(body)
        assert balance.time[0] == pytest.approx(stored[0][0, 0])
        errors.append(abs((balance.kinetic[0] - balance.kinetic[-1]) / work - 1.0))
        assert work > 0.9 * balance.kinetic[0]
    assert errors[1] < 0.3 * errors[0] < 3e-5
