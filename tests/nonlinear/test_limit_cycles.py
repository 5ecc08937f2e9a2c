"""Whirl in films without unbalance, against the linear limit and a run."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import ring_rotor

from exudyn_rotor import (
    ShortJournalBearing,
    Support,
    add_rotor,
    add_supports,
    limit_cycles,
    recommended_settings,
    stability_threshold,
)

DOWN, ENDS = [0.0, -9.81, 0.0], ("left", "right")


def rings():
    solid = ring_rotor(0.1, 0.15, 20.0).with_interface("left", range(5))
    return solid.with_interface("right", range(5, 10)).reduce(0)


def films(viscosity=0.02):
    size = {"radius": 0.03, "length": 0.02, "clearance": 6e-5, "viscosity": viscosity}
    return [ShortJournalBearing(interface=end, load=[0.0, -98.1], **size) for end in ENDS] + [
        Support("left", np.diag([0.0, 0.0, 1e6]), np.diag([0.0, 0.0, 100.0]))
    ]


def test_whirl_begins_at_the_linear_limit_and_is_that_of_a_run():
    rotor, supports = rings(), films()
    onset = stability_threshold(rotor, 50.0, 3000.0, supports=supports)
    limit = onset.values[0]
    speed = 1.05 * limit
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor, spin=speed, gravity=DOWN, translation="none")
    add_supports(body, supports)
    sensor = body.add_interface_sensor("left", exu.OutputVariableType.Displacement)
    mbs.Assemble()
    found = limit_cycles(mbs, [speed], onset, body=body, tolerance=1e-4)
    assert found.values[0] == pytest.approx(limit, rel=1e-3)
    assert found.rates[0, 0] == pytest.approx(onset.frequencies_inertial[0], rel=1e-3)
    point = found.at(speed)[-1]
    assert found.stable[point]
    body.start_from(found.state(int(point), body))
    period = 2.0 * np.pi / found.rates[point, 0]
    settings = recommended_settings(end_time=period, step=period / 300)
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.newton.useModifiedNewton = False
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = period / 300
    mbs.SolveDynamic(settings)
    path = mbs.GetSensorStoredData(sensor)
    moved = found.displacement(int(point), path[:, 0], "left")
    assert np.abs(path[:, 1:3] - moved).max() < 2e-3 * found.amplitudes("left")[point]
