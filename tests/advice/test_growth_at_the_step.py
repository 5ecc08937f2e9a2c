"""Growth of close whirls at the proposed step: its sign is right, and wrong at steps for phases."""

import exudyn
import numpy as np
import pytest
from point_rotors import ring_rotor

import exudyn_rotor as er
from exudyn_rotor.advice.candidate import Candidate
from exudyn_rotor.advice.request import Request
from exudyn_rotor.advice.step_size import choose_step

SPEED, MASS, STIFFNESS, BEAT = 300.0, 5.0, 2e5, 0.92  # rad/s, kg, N/m, s
FREQUENCY = np.sqrt(STIFFNESS / MASS)


def run(rotor, support, step):
    """Return the growth over two beats of two whirls in the rotor frame [1/s], and its check."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rotor, spin=SPEED, translation="none")
    er.add_supports(body, support)
    body.start_recording()
    sensor = body.add_interface_sensor("all", exudyn.OutputVariableType.Displacement)
    mbs.Assemble()
    start = np.zeros(len(mbs.systemData.GetODE2Coordinates()))
    moved = np.linalg.pinv(body.motion.invariants.S) @ [1e-4 * MASS, 0.0, 0.0]
    start[body.layout.unknowns[body.motion.modes]] = moved
    body.start_from(er.StartState(start, 0.0 * start, 0.0, SPEED))
    settings = er.recommended_settings(2.0 * BEAT, step, accuracy=1e-9)
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.9  # Exudyn's
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = step
    mbs.SolveDynamic(settings)
    squares = np.sum(mbs.GetSensorStoredData(sensor)[:, 1:3] ** 2, axis=1)
    first, second = np.array_split(squares, 2)
    growth = 0.5 * np.log(second.mean() / first.mean()) / BEAT
    return growth, er.check_run(body, warn=False)["growth"]


def test_growth_of_close_whirls_is_right_at_the_proposed_step():
    """Uneven bearings split two whirls by 4 %, and hold back their cross-coupling of 2 %.

    A step shifts the whirls by different amounts in the rotor frame. Where that is more than the
    bearings split, one of them grows.
    """
    rotor = ring_rotor(0.1, 0.2, MASS).with_interface("all", range(10)).reduce(0)
    stiffness = STIFFNESS * np.array([[0.96, 0.02, 0.0], [-0.02, 1.04, 0.0], [0.0, 0.0, 25.0]])
    damping = np.diag([0.01 * STIFFNESS / FREQUENCY] * 2 + [50.0])
    tilting = {"tilt_stiffness": np.diag([9e3, 1.2e4, 1e5]), "tilt_damping": 3.0 * np.eye(3)}
    support = er.Support("all", stiffness, damping, **tilting)
    growth = er.stability(rotor, [SPEED], supports=support).growth[0]
    request = Request.of(SPEED, None, 0.1)
    step = choose_step(Candidate.of(rotor, support), request).size
    found, row = run(rotor, support, request.step)  # right for periods
    assert found > 0.5
    assert row.value == pytest.approx(1.0 - found / growth, rel=0.1)
    assert not row.ok
    found, row = run(rotor, support, step)
    assert found == pytest.approx(growth, rel=0.5)
    assert row.ok
