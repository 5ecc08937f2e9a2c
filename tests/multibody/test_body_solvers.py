"""The rotor in Exudyn's solvers: they agree, hold what is prescribed, and balance its power."""

import exudyn as exu
import numpy as np
import pytest
from models import centered_disc

import exudyn_rotor as er

SOLVERS = exu.DynamicSolverType
IMPLICIT = (SOLVERS.GeneralizedAlpha, SOLVERS.TrapezoidalIndex2)
RUN_UP = er.PrescribedMotion.run_up(100.0, 400.0, 8e-3)
SHAKE = er.PrescribedMotion(
    lambda t: np.array([1e-5 * (1 - np.cos(600.0 * t)), 0.0, 2e-5 * np.sin(300.0 * t)]),
    lambda t: np.array([6e-3 * np.sin(600.0 * t), 0.0, 6e-3 * np.cos(300.0 * t)]),
    lambda t: np.array([3.6 * np.cos(600.0 * t), 0.0, -1.8 * np.sin(300.0 * t)]),
)
STIFFNESS, DAMPING = np.array([4e6, 3e6, 2e6]), np.array([800.0, 500.0, 300.0])
GRAVITY = np.array([0.0, -9.81, 3.0])
TORQUE = 7.0


@pytest.fixture(scope="module")
def reduced():
    rotor = centered_disc(order=1)
    return rotor.add_point_mass([0.15, 0.0, 0.2], 0.1).reduce(2)


def settings(steps, end_time):
    result = exu.SimulationSettings()
    result.timeIntegration.numberOfSteps = steps
    result.timeIntegration.endTime = end_time
    result.timeIntegration.generalizedAlpha.spectralRadius = 1.0
    result.timeIntegration.newton.relativeTolerance = 1e-10
    result.timeIntegration.verboseMode = result.staticSolver.verboseMode = 0
    result.solution.file.write = False
    result.solution.sensors.writePeriod = end_time / steps
    return result


def scene(reduced, **options):
    """Return a rotor on two bearings in gravity, with a torque at its right end."""
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, reduced, **({"gravity": GRAVITY} | options))
    ground = mbs.CreateGround()
    for name, interface in reduced.interfaces.items():
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body.marker(name)],
            localPosition0=interface.reference.tolist(),
            stiffness=STIFFNESS.tolist(),
            damping=DAMPING.tolist(),
        )
    mbs.CreateTorque(itemNumber=body.marker("right"), loadVector=[0.0, 0.0, TORQUE])
    return mbs, body


def final_state(reduced, solver, options, steps=400, end_time=4e-3):
    """Return unknowns, the right end's place and the disc's angle at the end of a short run."""
    prescribed = solver not in IMPLICIT and "spin" in options
    mbs, body = scene(reduced, **({"locking": "mass"} if prescribed else {}) | options)
    mbs.Assemble()
    run = settings(steps, end_time)
    run.timeIntegration.automaticStepSize = False  # of DOPRI5
    mbs.SolveDynamic(run, solverType=solver)
    place = mbs.GetMarkerOutput(body.marker("right"), exu.OutputVariableType.Position)
    turn = mbs.GetMarkerOutput(body.marker("right"), exu.OutputVariableType.RotationMatrix)
    return body.coordinates()[0], np.append(place, turn)


CASES = {
    "free spin": {"initial_speed": 300.0},
    "free spin, no translation": {"translation": "none", "initial_speed": 300.0},
    "constant speed": {"spin": 300.0},
    "run-up": {"spin": RUN_UP},
    "shaken": {"spin": 300.0, "translation": SHAKE},
}


@pytest.mark.parametrize("case", CASES)
def test_solvers_agree(reduced, case):
    reference = final_state(reduced, SOLVERS.RK44, CASES[case])
    for solver in (*IMPLICIT, SOLVERS.DOPRI5):
        unknowns, place = final_state(reduced, solver, CASES[case])
        limit = 1e-8 if solver == SOLVERS.DOPRI5 else 2e-3
        scale = abs(reference[0]).max()
        assert abs(unknowns - reference[0]).max() < limit * scale
        assert abs(place - reference[1]).max() < limit


def test_check_of_an_explicit_run_finds_nothing_lost(reduced):
    """Whose solver eliminates the locks, so that the forces on them are not known."""
    mbs, body = scene(reduced, translation="none", initial_speed=300.0)
    body.start_recording()
    mbs.Assemble()
    mbs.SolveDynamic(settings(400, 4e-3), solverType=SOLVERS.RK44)
    check = er.check_run(body, warn=False)
    assert check["unresisted load"].ok


@pytest.mark.parametrize("motion", [{"spin": 300.0}, {"spin": RUN_UP}, {"translation": SHAKE}])
@pytest.mark.parametrize("full", [False, True])
def test_explicit_solvers_ask_for_locking_by_mass_and_then_agree(full, motion):
    """An error names the argument, other solvers go on, and the run with it is right."""
    pair = er.SolidRotor.from_matrices(
        np.eye(6), 1e6 * np.eye(6), [[0.1, 0.0, 0.0], [-0.1, 0.0, 0.0]], "z"
    )
    motion = {"spin": 300.0, "translation": "none"} | motion

    def added(**options):
        mbs = exu.SystemContainer().AddSystem()
        body = er.add_rotor(mbs, pair if full else pair.reduce(6), **motion, **options)
        torque = body.add_drive_torque_sensor()
        mbs.Assemble()
        return mbs, body, torque

    mbs, body, torque = added()
    with pytest.raises(Exception, match=r"rotor 'rotor'.*locking='mass'"):
        mbs.SolveDynamic(settings(20, 1e-3), solverType=SOLVERS.RK44)
    assert mbs.SolveStatic(settings(20, 1e-3))
    mbs, body, torque = added()
    mbs.SolveDynamic(settings(400, 4e-3))
    other, explicit, _ = added(locking="mass")
    other.SolveDynamic(settings(400, 4e-3), solverType=SOLVERS.RK44)
    expected = body.coordinates()[0]
    assert abs(explicit.coordinates()[0] - expected).max() < 2e-3 * abs(expected).max()
    found, expected = (each.GetSensorValues(torque) for each in (other, mbs))
    assert found == pytest.approx(expected, rel=2e-3, abs=1e-6)


# ------------------------------------------------------------------ static solutions
