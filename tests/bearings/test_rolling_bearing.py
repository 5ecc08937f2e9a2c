"""Rolling bearing: loads of elements, kinematics, varying compliance, in a scene."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import ring_rotor

from exudyn_rotor import (
    RollingBearing,
    add_rotor,
    add_supports,
    recommended_settings,
    spectra,
    steady_state,
)
from exudyn_rotor.bearings.rolling import contacts

BALLS = {"count": 8, "pitch_radius": 0.0326, "element_radius": 0.006, "stiffness": 7e9}


def bearing(interface="left", **changes):
    return RollingBearing(interface=interface, **(BALLS | changes))


@pytest.mark.parametrize(("elements", "factor"), [("balls", 4.37), ("rollers", 4.08)])
def test_most_loaded_element_without_clearance(elements, factor):
    """Q_max = 4.37 W/Z for balls, 4.08 W/Z for rollers; Stribeck 1901, Harris (2001) Sect. 7."""
    many = bearing(count=60, element_radius=1e-3, elements=elements, load=[300.0, 0.0])
    place = many.equilibrium(0.0)
    loads = contacts(many, place, 0.0)[0]
    assert loads.max() * 60 / 300.0 == pytest.approx(factor, rel=3e-3)
    assert np.count_nonzero(loads) in (29, 30, 31)


def test_one_ball_carries_by_hertz():
    """With a wide clearance the load is on one ball: W = k (x − c)^{3/2}."""
    place = bearing(clearance=1e-3, load=[500.0, 0.0]).equilibrium(0.0)
    np.testing.assert_allclose(place, [1e-3 + (500.0 / 7e9) ** (2.0 / 3.0), 0.0], atol=1e-12)


@pytest.mark.parametrize(("elements", "exponent"), [("balls", 1.5), ("rollers", 10.0 / 9.0)])
@pytest.mark.parametrize("count", [3, 8, 15])
def test_preloaded_elements_hold_the_centre_without_a_load(elements, exponent, count):
    """All carry k p^n at an interference p: a stiffness of n k p^(n−1) Z/2 in every direction."""
    preloaded = bearing(count=count, clearance=-5e-6, elements=elements, stiffness=1e9)
    np.testing.assert_allclose(contacts(preloaded, np.zeros(2), 0.7)[0], 1e9 * 5e-6**exponent)
    assert not np.any(preloaded.equilibrium(100.0))
    K = preloaded.coefficients(100.0)[0]
    expected = 0.5 * count * exponent * 1e9 * 5e-6 ** (exponent - 1.0)
    np.testing.assert_allclose(K, expected * np.eye(2), atol=1e-12 * expected)


def test_cage_and_passing_frequency():
    """6204-like bearing: f_c = ½ (1 − d/D cos α) f; Harris (2001) Eq. 8.13."""
    one = bearing(contact_angle=0.3)
    assert one.cage_ratio == pytest.approx(0.5 * (1.0 - 12.0 / 65.2 * np.cos(0.3)), rel=1e-12)
    assert one.passing_frequency(100.0) == pytest.approx(8.0 * 100.0 * one.cage_ratio)
    passage = 2.0 * np.pi / 8 / one.cage_ratio
    forces = [one.law(2e-5, 1e-5, 0.0, 0.0, angle, 9.0) for angle in (0.4, 0.4 + passage, 0.9)]
    np.testing.assert_allclose(forces[0], forces[1], rtol=1e-9)
    assert abs(forces[2][0] / forces[0][0] - 1.0) > 1e-4


def test_tangent_is_the_derivative_of_the_force():
    one, place, step = bearing(clearance=5e-6, load=[0.0, -500.0], damping=30.0), None, 1e-10
    place = one.equilibrium(0.0, angle=0.7)
    found = np.zeros((2, 2))
    for i, move in enumerate(step * np.eye(2)):
        up, down = (one.law(*(place + n * move), 0.0, 0.0, 0.7, 0.0) for n in (1, -1))
        found[:, i] = (np.array(down) - up) / (2.0 * step)
    np.testing.assert_allclose(
        found, one.slopes(*place, 0.0, 0.0, 0.7, 0.0)[0], rtol=1e-5, atol=1.0
    )
    assert one.law(0.0, 0.0, 1.0, -2.0, 0.0, 0.0) == (-30.0, 60.0)
    K, D = one.coefficients(100.0)
    assert abs(K[0, 1]) < 1e-6 * K[1, 1]
    np.testing.assert_allclose(D, 30.0 * np.eye(2))


def rotor():
    rings = ring_rotor(0.1, 0.15, 20.0)
    return rings.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(0)


def test_a_loaded_rotor_sways_at_the_passing_frequency():
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor(), spin=300.0, gravity=[0.0, -98.1, 0.0])
    pair = [bearing(name, damping=1500.0) for name in ("left", "right")]
    add_supports(body, pair)
    sensor = body.add_interface_sensor("left", exu.OutputVariableType.Displacement)
    mbs.Assemble()
    settings = recommended_settings(end_time=0.25, step=1e-4)
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 1e-4
    mbs.SolveDynamic(settings)
    path = mbs.GetSensorStoredData(sensor)[-1500:]
    found = spectra(path[:, 0], path[:, 2], 300.0, length=0.14)
    strongest = found.frequencies[np.argmax(found.amplitudes[-1])]
    apart = 2.0 * np.pi / 0.14
    assert strongest == pytest.approx(pair[0].passing_frequency(300.0), abs=apart)


@pytest.mark.parametrize("clearance", [-5e-6, 0.0, 5e-6])
@pytest.mark.parametrize(
    ("options", "angle"), [({"spin": 0.0}, 0.0), ({"spin": "free", "initial_angle": 0.6}, 0.6)]
)
def test_a_run_at_rest_starts_in_the_equilibrium_and_stays(clearance, options, angle):
    """Each bearing carries half the weight, 98.1 N, of a balanced rotor without elastic modes."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor(), gravity=[0.0, -9.81, 0.0], **options)
    pair = [bearing(name, clearance=clearance, damping=500.0) for name in ("left", "right")]
    add_supports(body, pair)
    mbs.Assemble()
    state = steady_state(body).state()
    body.start_from(state)
    mbs.Assemble()

    def place():
        return mbs.GetMarkerOutput(body.marker("left"), exu.OutputVariableType.Displacement)[:2]

    expected = pair[0].equilibrium(0.0, [0.0, -98.1], angle)
    np.testing.assert_allclose(place(), expected, atol=1e-6 * np.abs(expected).max())
    settings = recommended_settings(end_time=0.01, step=1e-3)
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    mbs.SolveDynamic(settings)
    np.testing.assert_allclose(place(), expected, atol=1e-6 * np.abs(expected).max())
