"""What the row of the step tells of a run: the error of a period, which free vibrations add up."""

import exudyn
import numpy as np
import pytest

from exudyn_rotor import SolidRotor, StartState, add_rotor, check_run, recommended_settings

FREQUENCY, PERIODS = 1000.0, 20  # rad/s


@pytest.mark.parametrize("axis", ["x", [0.6, 0.0, 0.8]])
@pytest.mark.parametrize("step", [1e-4, 2e-4])
def test_free_vibrations_go_out_of_phase_by_the_row_of_every_period(axis, step):
    """Of masses on springs against ``cos ωt``; the next order of the period error is (ωh)²."""
    places = [[0.1, 0.0, 0.0], [-0.1, 0.0, 0.1]]
    springs = FREQUENCY**2 * np.eye(6)
    rotor = SolidRotor.from_matrices(np.eye(6), springs, places, axis, interfaces={"top": [0]})
    mbs = exudyn.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor.reduce(6), spin=0.0, translation="none")
    body.start_recording()
    mbs.Assemble()
    start = np.zeros(len(mbs.systemData.GetODE2Coordinates()))
    start[body.layout.unknowns[body.motion.modes]] = 1e-4
    body.start_from(StartState(start, 0.0 * start, 0.0, 0.0))
    count = round(PERIODS * 2.0 * np.pi / FREQUENCY / step)
    settings = recommended_settings(end_time=count * step, step=step)
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.9  # Exudyn's
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = step
    mbs.SolveDynamic(settings)
    record = body.recorded()
    place = body.layout.unknowns[body.motion.modes][-1]  # the first may be the spin, held
    phase = np.unwrap(np.arctan2(-record.q_t[:, place] / FREQUENCY, record.q[:, place]))
    row = check_run(body, warn=False)["step"]
    behind = FREQUENCY * record.time[-1] - phase[-1]
    periods = FREQUENCY * record.time[-1] / (2.0 * np.pi)
    assert behind == pytest.approx(
        2.0 * np.pi * periods * row.value, rel=2.0 * (FREQUENCY * step) ** 2
    )
    assert behind > 10.0 * row.value
    assert "out of phase" in row.meaning
