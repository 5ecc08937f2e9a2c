"""Films answer by their tangents where Exudyn differentiates connectors by differences."""

import numpy as np
import pytest
from void_films import CLEARANCE, SPEED, bearings, oil, rotor, scene

from exudyn_rotor import recommended_settings
from exudyn_rotor.bearings.film.reynolds import CAVITATION
from exudyn_rotor.bearings.journal_bearing import FilmLaw, RememberingLaw
from exudyn_rotor.multibody.supports import support_connectors
from exudyn_rotor.multibody.supports.differences import Differences

MOTION = np.array([0.3, -0.4, 0.05, 0.02]) * CLEARANCE * np.array([1.0, 1.0, SPEED, SPEED])
SIZES = CLEARANCE * np.array([1.0, 1.0, SPEED, SPEED])
STEP = 1e-5  # of SIZES: the error of central differences is its square, beside 1e-15/STEP


def differences(function, at, sizes):
    """Return central differences of a function by each of its arguments, in columns."""
    moves = np.diag(STEP * sizes)
    ends = [np.subtract(function(at + move), function(at - move)) for move in moves]
    return np.array(ends).T / (2.0 * STEP * sizes)


def asked_films(monkeypatch):
    """Return a list that grows with every motion for which a film is asked for its force."""
    asked, call = [], FilmLaw.__call__

    def asking(law, *motion):
        asked.append(motion)
        return call(law, *motion)

    monkeypatch.setattr(FilmLaw, "__call__", asking)
    return asked


@pytest.mark.parametrize("cavitation", CAVITATION)
def test_tangent_of_a_film_is_its_derivative(cavitation):
    """Of one that conserves mass within a step, from the voids at its beginning."""
    film = oil(cavitation=cavitation)
    law = FilmLaw(film, torque=False)
    if cavitation == "mass-conserving":
        law = RememberingLaw(film, torque=False)
        law.begin(0.0, *MOTION, SPEED, 1e-4)
        law.begin(1e-4, *(0.9 * MOTION), SPEED, 3e-4)
    law(*MOTION, 0.0, SPEED)
    found = -np.hstack(law.tangent(*MOTION[:2]))
    expected = differences(lambda at: law(*at, 0.0, SPEED), MOTION, SIZES)
    np.testing.assert_allclose(
        found * SIZES, expected * SIZES, rtol=0.0, atol=1e-7 * np.abs(expected * SIZES).max()
    )


@pytest.mark.parametrize("cavitation", ["reynolds", "mass-conserving"])
@pytest.mark.parametrize("spin", [{"spin": SPEED}, {"initial_speed": SPEED}], ids=["held", "free"])
def test_runs_with_films_take_the_same_steps(monkeypatch, cavitation, spin):
    """As by differences, to Newton's tolerance of 1e-5, and ask a film four times less."""
    reduced, asked = rotor(), asked_films(monkeypatch)
    paths, counts, iterations = [], [], []
    for noted in (True, False):
        if not noted:
            monkeypatch.setattr(support_connectors, "differences_of", lambda body: Differences())
        asked.clear()
        films = bearings(reduced, cavitation=cavitation)
        mbs, _, sensors = scene(reduced, films, **spin)
        settings = recommended_settings(end_time=1.5e-3, step=1.5e-4)
        settings.timeIntegration.newton.useModifiedNewton = False
        settings.solution.file.write = False
        mbs.SolveDynamic(settings)
        paths.append(mbs.GetSensorStoredData(sensors[0])[:, 1:3])
        counts.append(len(asked))
        iterations.append(mbs.sys["dynamicSolver"].it.newtonStepsCount)
    moved = np.abs(paths[1]).max()
    assert moved > 0.02 * CLEARANCE
    np.testing.assert_allclose(*paths, rtol=0.0, atol=1e-5 * moved)
    assert iterations[0] <= iterations[1]
    assert counts[0] < 0.25 * counts[1]
