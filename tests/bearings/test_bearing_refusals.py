"""What bearings refuse, and how searches end that find nothing."""

import re
import warnings
from dataclasses import replace

import numpy as np
import pytest
from rings import rings
from test_film import SPEED, STILL, film
from test_magnetic_bearing import bearing as magnets
from test_rolling_bearing import bearing as balls
from test_series import floating

from exudyn_rotor import (
    JournalBearing,
    OilFilm,
    SeriesSupport,
    ShortJournalBearing,
    SolidRotor,
    SqueezeFilmDamper,
    Support,
    TiltingPadBearing,
    bearing_loads,
    grooved_pads,
    linear_model,
    static_response,
)
from exudyn_rotor.bearings import rolling
from exudyn_rotor.bearings.film import reynolds

DOWN = [0.0, -10.0]
FILM = {"interface": "left", "radius": 0.05, "length": 0.03, "clearance": 1e-4, "viscosity": 0.1}
PLACE = np.array([5e-5, 0.0])


def short(**changes):
    return ShortJournalBearing(**(FILM | changes))


def journal(load=None):
    load = None if load is None else [0.0, -load]
    return JournalBearing(interface="left", film=film(), load=load)


def pads(count=3, preload=0.0, cavitation="reynolds", pivot=0.5, nodes=60):
    """Return pads with inertia around the journal under a small load."""
    gaps = [2.0 * np.pi * number / count for number in range(count)]
    around = film(grooves=gaps, preload=preload, cavitation=cavitation, nodes=nodes)
    given = {"load": [0.96, 0.3], "pad_inertia": 1e-4, "pivot": pivot}
    return TiltingPadBearing(interface="left", film=around, **given)


def series():
    return SeriesSupport(interface="left", inner=pads(), mass=1.0, outer=short())


def tilting_point():
    point = SolidRotor.from_matrices(np.eye(3), np.zeros((3, 3)), [[0, 0, 0]], "z")
    tilting = Support("left", 1.0, tilt_stiffness=1.0)
    linear_model(point.with_interface("left", [0]).reduce(0), supports=tilting)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: Support.from_columns("left", 3), "source: needs a path, a DataFrame or a"),
        (lambda: Support("left", 1.0, frame="rotor", mass=2.0), "mass: is for supports that"),
        (tilting_point, "'left': tilt_stiffness would act on nothing"),
        (lambda: short(load=DOWN).table(100.0, [0.0, 1.0]), "frequencies: needs values above"),
        (lambda: short(load=[0.0, -1e22]).table(100.0, 1.0), "1e+22 N at 100 rad/s leaves no film"),
        (lambda: magnets(sensor="b").table(1.0, 1.0), "'left': measures at 'b', and a table"),
        (lambda: SqueezeFilmDamper(**FILM).coefficients_at([2e-4, 0.0], 1.0), "0.0002 m off its"),
        (lambda: floating(DOWN).ring(0.0), "at 0 rad/s its films carry nothing"),
        (lambda: floating([0.0, -1e22]).ring(1e3), "no speed of the ring at which its films carry"),
        (lambda: series().linearised(), "has states of its own"),
        (lambda: pads(0), "needs pads with gaps between"),
        (lambda: pads(2, nodes=12).tilts(SPEED), "load: presses the film of a pad below"),
        (lambda: pads(2).tilts(SPEED), "no equilibrium of the pads found under 1.00578 N"),
        (lambda: pads(2, 0.0, "none").tilts(SPEED), "no equilibrium of the pads found"),
        (lambda: pads(2, 0.5, "none", 0.6).tilts(-3.0), "load: presses the film of a pad below"),
        (lambda: journal(1e12).linearised().matrices(1.0), "load: 1e+12 N at 1 rad/s presses"),
        (lambda: film(grooves=[0.0], width=340.0).equilibrium(SPEED, [1e3, 0.0]), "into a groove"),
        (lambda: OilFilm(0.05, 0.05, 0.1, grooved_pads(1e-120)).state(STILL, STILL, 1.0), "singul"),
    ],
)
def test_what_is_refused_is_told(call, words):
    with pytest.raises((TypeError, ValueError, ArithmeticError), match=re.escape(words)):
        call()


@pytest.mark.parametrize(
    ("module", "limit", "call", "words"),
    [
        (rolling, "_MOST_ITERATIONS", lambda: balls().equilibrium(1.0, DOWN), "under 10 N"),
        (reynolds, "_ITERATIONS", lambda: film().state(PLACE, STILL, SPEED), "its edges do not"),
    ],
)
def test_searches_that_end_too_early_say_so(module, limit, call, words, monkeypatch):
    monkeypatch.setattr(module, limit, 1)
    with pytest.raises((ValueError, ArithmeticError), match=words):
        call()


def test_a_pad_that_carries_nothing_is_told_once():
    """Its tilt has no place, and next to nothing holds it."""
    absent = np.isnan(pads().tilts(SPEED))
    assert absent.tolist() == [False, True, False]
    made = pads().linearised()
    with pytest.warns(UserWarning, match=r"'left': pads \[1\] carry nothing at 300 rad/s"):
        stiffness = made.matrices(SPEED)[0]
    assert 0.0 < stiffness[3, 3] < 1e-6 * stiffness[2, 2]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        made.matrices(2.0 * SPEED)


def test_a_film_from_that_of_the_speed_beside_is_the_film():
    """And its losses in the middle are Petroff's, of the share of the circle that pads cover."""
    bearing = journal(1e3)
    for speed in (SPEED, 1.1 * SPEED):
        expected = film().equilibrium(speed, bearing.load).position
        np.testing.assert_allclose(bearing.equilibrium(speed), expected, rtol=1e-6)
    petroff = 2.0 * np.pi * 0.02 * SPEED**2 * 0.05**3 * 0.05 / 1e-4 * 320.0 / 360.0
    assert film().state(STILL, STILL, SPEED).power_loss == pytest.approx(petroff, rel=1e-3)


def test_coefficients_over_the_speed_alone_are_those_at_every_frequency():
    table = Support.from_table("left", speeds=[1.0, 3.0], stiffness=[np.eye(2), 3.0 * np.eye(2)])
    stiffness = table.at_frequency(7.0).matrices([1.0, 2.0])[0]
    np.testing.assert_allclose(stiffness[:, 0, 0], [1.0, 2.0])
    assert balls().film_edge(1e-3, 0.0) == np.inf


def test_a_rigid_rotor_hangs_in_films_that_carry_half_of_it():
    """5 kg in two bearings, of which one may be rigid: films beside coordinates without springs."""
    gravity = [0.0, -800.0, 0.0]
    for one in (short(), journal(), pads(4, 0.5)):
        both = [one, replace(one, interface="right")]
        given = {"gravity": gravity, "supports": both, "speed": SPEED, "at": "left"}
        found = static_response(rings().reduce(0), **given)
        expected = one.equilibrium(SPEED, [0.0, -2000.0])
        np.testing.assert_allclose(found.displacement[0, :2], expected, rtol=1e-6, atol=1e-12)
    loads = bearing_loads(rings().reduce(0), ["right", short()], gravity, speed=SPEED)
    np.testing.assert_allclose(loads, [[0.0, -2000.0]] * 2, atol=1e-3)
