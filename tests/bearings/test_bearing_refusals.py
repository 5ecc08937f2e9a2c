"""What bearings refuse, and how searches end that find nothing."""

import re
from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pytest
from rings import rings
from test_annular_seal import seal
from test_dampers_and_stops import damper, stop
from test_film import SPEED, STILL, film
from test_journal_bearing import bearing as short
from test_magnetic_bearing import AXIAL, DELAYED, MAGNETS, PD, PID, on_supports, pair, rigid
from test_magnetic_bearing import bearing as magnets
from test_rolling_bearing import bearing as balls
from test_series import floating

import exudyn_rotor as er
from exudyn_rotor import Support
from exudyn_rotor.bearings import rolling
from exudyn_rotor.bearings.film import reynolds

DOWN = [0.0, -10.0]
PLACE = np.array([5e-5, 0.0])


def journal(load=None):
    load = None if load is None else [0.0, -load]
    return er.JournalBearing(interface="left", film=film(), load=load)


def pads(count=3, preload=0.0, cavitation="reynolds", pivot=0.5, nodes=60, inertia=1e-4):
    """Return pads with inertia around the journal under a small load."""
    gaps = [2.0 * np.pi * number / count for number in range(count)]
    around = film(grooves=gaps, preload=preload, cavitation=cavitation, nodes=nodes)
    given = {"load": [0.96, 0.3], "pad_inertia": inertia, "pivot": pivot}
    return er.TiltingPadBearing(interface="left", film=around, **given)


def series(**parts):
    good = {"inner": Support("left", 1.0), "outer": Support("left", 1.0), "mass": 1.0}
    return er.SeriesSupport(interface="left", **(good | parts))


def table(size=2, **axes):
    return Support.from_table("left", stiffness=np.ones((3, size, size)), **axes)


def columns(**given):
    return Support.from_columns("left", given)


def heavy(controller=DELAYED):
    return magnets(actuator=MAGNETS, controller=controller, load=[0.0, -4e3])


def tilting_point():
    point = er.SolidRotor.from_matrices(np.eye(3), np.zeros((3, 3)), [[0, 0, 0]], "z")
    tilting = Support("left", 1.0, tilt_stiffness=1.0)
    er.linear_model(point.with_interface("left", [0]).reduce(0), supports=tilting)


def early(module, limit, call):
    """Call with a search that ends after one step."""
    with patch.object(module, limit, 1):
        call()


REFUSED = [
    (lambda: Support.from_columns("left", 3), "source: needs a path, a DataFrame or a"),
    (lambda: Support("left", 1.0, frame="rotor", mass=2.0), "mass: is for supports that"),
    (lambda: Support("left", ((0.0, 1e5), (-1e5, 0.0))), "may be a matrix or a table"),
    (lambda: Support("left", ([0.0, 1.0], [1.0])), "its table need 2 matrices"),
    (lambda: Support("left", np.eye(4)), "needs a number or a matrix of"),
    (lambda: Support("left", [[1.0, 2.0], [3.0]]), "stiffness: needs"),
    (lambda: table(), "needs speeds, frequencies"),
    (lambda: table(speeds=[2.0, 1.0, 3.0]), "ascending"),
    (lambda: table(frequencies=[-1.0, 0.0, 1.0]), "give values ≥ 0"),
    (lambda: table(speeds=[1.0, 2.0, 3.0], frequencies=[1.0, 2.0]), "need 3 × 2 matrices"),
    (lambda: table(4, speeds=[1.0, 2.0, 3.0]), "2, 3 or 6 rows"),
    (lambda: columns(speed=[1.0], stiffness=[2.0]), "neither speed"),
    (lambda: columns(kzz=[1.0]), "a column 'speed'"),
    (lambda: columns(**{"speed [1/s]": [1.0], "kxx": [1.0]}), "needs rad/s, rpm or Hz, got '1/s'"),
    (lambda: columns(**{"speed": [1.0], "cxx [lb/in]": [1.0]}), "'cxx [lb/in]': needs Ns/m, Ns"),
    (lambda: columns(speed=[1.0], kxx=[1.0], dxx=[1.0]), "needs cyy, kyy beside cxx, kxx"),
    (lambda: columns(speed=[1.0], kxy=[1.0], kxb=[1.0]), "needs kay, kbx, kya, kyx beside kxb"),
    (lambda: columns(speed=["fast"], kxx=[1.0]), "needs numbers"),
    (lambda: columns(speed=[1.0, 1.0], frequency=[1.0, 1.0], kzz=[1.0] * 2), "one row for each"),
    (lambda: columns(speed=[1.0, 2.0], kxx=[1.0, np.nan]), "needs finite"),
    (tilting_point, "'left': tilt_stiffness would act on nothing"),
    (lambda: seal(clearance=0.1), "clearance: needs the radial clearance, far below"),
    (lambda: seal(pressure_drop=0.0), "pressure_drop: needs"),
    (lambda: seal(inlet_loss=-0.1), "inlet_loss: needs"),
    (lambda: magnets(sensor="b").table(1.0, 1.0), "'left': measures at 'b', and a table"),
    (lambda: replace(PID, delay=-1e-5), "delay: needs"),
    (lambda: replace(MAGNETS, gap=-1e-4), "gap: needs"),
    (lambda: replace(MAGNETS, current_limit=1.5), "current_limit: needs"),
    (lambda: heavy().equilibrium(0.0), "carries 2250 N, not 4000 N"),
    (lambda: heavy(controller=PD).equilibrium(0.0), "not 4000 N; give a larger current_limit, or"),
    (lambda: er.stability(rigid(), 0.0, supports=pair(sensor="top")), "as that of its sensor, 't"),
    (lambda: on_supports(rigid(), pair(sensor="top")), "as that of its sensor, 'top'"),
    (lambda: er.sensitivity(rigid(), 1.0, supports=[AXIAL]), "needs a MagneticBearing"),
    (lambda: er.sensitivity(rigid(), [0.0, 2.0], supports=pair()), "needs values above zero"),
    (lambda: damper(clearance=-1e-4), "clearance: needs a finite number"),
    (lambda: damper(clearance=0.1), "far below the radius"),
    (lambda: damper(orbit=1.0), "orbit: needs"),
    (lambda: damper(centring_stiffness=-1.0), "centring_stiffness: needs"),
    (lambda: damper().coefficients_at([2e-4, 0.0], 1.0), "0.0002 m off its"),
    (lambda: stop(friction=-0.1), "friction: needs"),
    (lambda: balls(clearance=-0.007), "clearance: needs a finite number [m] > -0.006"),
    (lambda: balls(count=2), "count: needs"),
    (lambda: balls(element_radius=0.02), "8 elements of 0.02 m do not fit"),
    (lambda: balls(elements="needles"), "elements: 'needles' is unknown"),
    (lambda: balls().equilibrium(1.0, STILL), "without one no element carries"),
    (lambda: early(rolling, "_MOST_ITERATIONS", lambda: balls().equilibrium(1.0, DOWN)), "10 N"),
    (lambda: short(clearance=-1e-4), "clearance: needs a finite number"),
    (lambda: short(clearance=0.06), "clearance: needs the radial clearance, far below the radius"),
    (lambda: short(viscosity=0.0), "viscosity: needs a finite number"),
    (lambda: short((1.0, 2.0, 3.0)), "load: needs"),
    (lambda: short().coefficients(0.0), "without rotation the film does not carry"),
    (lambda: short([0.0, -1e22]).table(100.0, 1.0), "1e+22 N at 100 rad/s leaves no film"),
    (lambda: short().table(100.0, [0.0, 1.0]), "frequencies: needs values above"),
    (lambda: floating(DOWN).ring(0.0), "at 0 rad/s its films carry nothing"),
    (lambda: floating([0.0, -1e22]).ring(1e3), "no speed of the ring at which its films carry"),
    (lambda: series(inner=Support("right", 1.0)), "at 'right'"),
    (lambda: series(outer=Support("left", damping=1.0, frame="rotor")), "stands still"),
    (lambda: series(outer=Support("left", np.eye(3))), "across the axis alone"),
    (lambda: series(mass=0.0), "mass: needs"),
    (lambda: series(inner=pads()).linearised(), "has states of its own"),
    (lambda: journal(1e12).linearised().matrices(1.0), "load: 1e+12 N at 1 rad/s presses"),
    (lambda: early(reynolds, "_ITERATIONS", lambda: film().state(PLACE, STILL, 1.0)), "settle"),
    (lambda: er.grooved_pads(-1e-4), "clearance: needs a finite number [m] > 0"),
    (lambda: er.grooved_pads(1e-4, preload=0.5), "preload: needs grooves"),
    (lambda: er.grooved_pads(1e-4, [0.0, 0.1], 0.2), "grooves: need ascending"),
    (lambda: er.grooved_pads(1e-4, [0.0]), "groove_width: a single groove without width"),
    (lambda: film(preload=1.0), "preload: needs a finite number ≥ 0 and < 1"),
    (lambda: er.OilFilm(0.05, 0.05, 0.02, []), "pads: needs one at least"),
    (
        lambda: er.OilFilm(0.05, 0.05, 0.02, [er.Pad(0, 4, 1e-4), er.Pad(3, 1, 1e-4)]),
        "pads: overlap",
    ),
    (lambda: er.OilFilm(0.05, 0.05, 0.02, [er.Pad(0, 4, 1e-4, [1e-3, 0])]), "pads: their centers"),
    (lambda: film(axial_nodes=1), "axial_nodes: needs 0"),
    (lambda: er.OilFilm(0.05, 0.05, 0.02, er.grooved_pads(0.05)), "pads: needs the radial cl"),
    (lambda: film().state([1.1e-4, 0.0], STILL, 1.0), "displacement: [0.00011, 0.0"),
    (lambda: film().equilibrium(1.0, [0.0, 0.0]), "load: needs a force other than 0"),
    (lambda: film().equilibrium(0.0, [1e3, 0.0]), "speed: needs a number other than 0"),
    (lambda: film().equilibrium(10.0, [1e9, 0.0]), "load: 1e+09 N at 10 rad/s presses"),
    (lambda: film(grooves=[0.0], width=340.0).equilibrium(SPEED, [1e3, 0.0]), "into a groove"),
    (
        lambda: er.OilFilm(0.05, 0.05, 0.1, er.grooved_pads(1e-120)).state(STILL, STILL, 1.0),
        "singul",
    ),
    (lambda: pads(0), "needs pads with gaps between"),
    (lambda: pads(pivot=1.0), "pivot: needs"),
    (lambda: pads(inertia=0.0), "pad_inertia: needs"),
    (lambda: pads().equilibrium(0.0), "speed, load: bearing at 'left'"),
    (lambda: pads(2, nodes=12).tilts(SPEED), "load: presses the film of a pad below"),
    (lambda: pads(2).tilts(SPEED), "no equilibrium of the pads found under 1.00578 N"),
    (lambda: pads(2, 0.0, "none").tilts(SPEED), "no equilibrium of the pads found"),
    (lambda: pads(2, 0.5, "none", 0.6).tilts(-3.0), "load: presses the film of a pad below"),
]


@pytest.mark.parametrize(("call", "words"), REFUSED)
def test_what_is_refused_is_told(call, words):
    with pytest.raises((TypeError, ValueError, ArithmeticError), match=re.escape(words)):
        call()


def test_a_pad_that_carries_nothing_is_held_by_next_to_nothing():
    absent = np.isnan(pads().tilts(SPEED))
    assert absent.tolist() == [False, True, False]
    stiffness = pads().linearised().matrices(SPEED)[0]
    assert 0.0 < stiffness[3, 3] < 1e-6 * stiffness[2, 2]


def test_a_film_from_that_of_the_speed_beside_is_the_film():
    """And its losses in the middle are Petroff's, of the share of the circle that pads cover."""
    bearing = journal(1e3)
    for speed in (SPEED, 1.1 * SPEED):
        expected = film().equilibrium(speed, bearing.load).position
        np.testing.assert_allclose(bearing.equilibrium(speed), expected, rtol=1e-6)
    petroff = 2.0 * np.pi * 0.02 * SPEED**2 * 0.05**3 * 0.05 / 1e-4 * 320.0 / 360.0
    assert SPEED * film().state(STILL, STILL, SPEED).torque == pytest.approx(petroff, rel=1e-3)


def test_coefficients_over_the_speed_alone_are_those_at_every_frequency():
    table = Support.from_table("left", speeds=[1.0, 3.0], stiffness=[np.eye(2), 3.0 * np.eye(2)])
    stiffness = table.at_frequency(7.0).matrices([1.0, 2.0])[0]
    np.testing.assert_allclose(stiffness[:, 0, 0], [1.0, 2.0])
    assert balls().film_edge(1e-3, 0.0) == np.inf


def test_a_rigid_rotor_hangs_in_films_that_carry_half_of_it():
    """5 kg in two bearings, of which one may be rigid: films beside coordinates without springs."""
    gravity = [0.0, -800.0, 0.0]
    for one in (short(None), journal(), pads(4, 0.5)):
        both = [one, replace(one, interface="right")]
        given = {"gravity": gravity, "supports": both, "speed": SPEED, "at": "left"}
        found = er.static_response(rings().reduce(0), **given)
        expected = one.equilibrium(SPEED, [0.0, -2000.0])
        np.testing.assert_allclose(found.displacement[0, :2], expected, rtol=1e-6, atol=1e-12)
    loads = er.bearing_loads(rings().reduce(0), ["right", short()], gravity, speed=SPEED)
    np.testing.assert_allclose(loads, [[0.0, -2000.0]] * 2, atol=1e-3)
