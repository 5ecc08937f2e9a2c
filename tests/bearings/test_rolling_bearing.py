"""Rolling bearing: loads of elements, kinematics, varying compliance, in a scene."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import ring_rotor

from exudyn_rotor import (
    RollingBearing,
    Support,
    add_rotor,
    add_supports,
    bearing_loads,
    recommended_settings,
    spectra,
    stability,
    steady_state,
)

BALLS = {"count": 8, "pitch_radius": 0.0326, "element_radius": 0.006, "stiffness": 7e9}


def bearing(interface="left", **changes):
    return RollingBearing(interface=interface, **(BALLS | changes))


@pytest.mark.parametrize(("elements", "factor"), [("balls", 4.37), ("rollers", 4.08)])
def test_most_loaded_element_without_clearance(elements, factor):
    """Q_max = 4.37 W/Z for balls, 4.08 W/Z for rollers; Stribeck 1901, Harris (2001) Sect. 7."""
    many = bearing(count=60, element_radius=1e-3, elements=elements, load=[300.0, 0.0])
    place = many.equilibrium(0.0)
    loads = many.element_loads(place)
    assert loads.max() * 60 / 300.0 == pytest.approx(factor, rel=3e-3)
    assert np.count_nonzero(loads) in (29, 30, 31)


def test_one_ball_carries_by_hertz():
    """With a wide clearance the load is on one ball: W = k (x − c)^{3/2}."""
    place = bearing(clearance=1e-3, load=[500.0, 0.0]).equilibrium(0.0)
    np.testing.assert_allclose(place, [1e-3 + (500.0 / 7e9) ** (2.0 / 3.0), 0.0], atol=1e-12)


@pytest.mark.parametrize("load", [(0.0, -98.1), (-100.0, 0.0), (0.0, 1e-3)])
@pytest.mark.parametrize("count", [4, 8])
def test_one_ball_straight_below_the_load_carries(load, count):
    """Others stand aside of a wide clearance, so that across the load nothing resists."""
    size = np.hypot(*load)
    place = bearing(count=count, clearance=2e-5).equilibrium(0.0, load)
    expected = np.array(load) / size * (2e-5 + (size / 7e9) ** (2.0 / 3.0))
    np.testing.assert_allclose(place, expected, atol=1e-7 * 2e-5)


@pytest.mark.parametrize(("elements", "exponent"), [("balls", 1.5), ("rollers", 10.0 / 9.0)])
@pytest.mark.parametrize("count", [3, 8, 15])
def test_preloaded_elements_hold_the_centre_without_a_load(elements, exponent, count):
    """All carry k p^n at an interference p: a stiffness of n k p^(n−1) Z/2 in every direction."""
    preloaded = bearing(count=count, clearance=-5e-6, elements=elements, stiffness=1e9)
    np.testing.assert_allclose(preloaded.element_loads([0.0, 0.0], 0.7), 1e9 * 5e-6**exponent)
    assert not np.any(preloaded.equilibrium(100.0))
    K = preloaded.coefficients(100.0)[0]
    expected = 0.5 * count * exponent * 1e9 * 5e-6 ** (exponent - 1.0)
    np.testing.assert_allclose(K, expected * np.eye(2), atol=1e-12 * expected)


@pytest.mark.parametrize("load", [1e-6, 1.0, 1e5])
@pytest.mark.parametrize("clearance", [-1e-3, -1e-5, -1e-9])
def test_preloaded_elements_balance_every_load(load, clearance):
    preloaded = bearing(clearance=clearance)
    force = load * np.array([0.6, -0.8])
    place = preloaded.equilibrium(0.0, force, 0.3)
    rounding = 1e-15 * preloaded.element_loads([0.0, 0.0]).sum()
    found = preloaded.law(*place, 0.0, 0.0, 0.3, 0.0)
    np.testing.assert_allclose(found, -force, atol=1e-9 * load + 100.0 * rounding)


@pytest.mark.filterwarnings("ignore:rotor 'rotor'. a contact that opens")
@pytest.mark.parametrize("spin", [0.0, 300.0])
def test_uneven_rotor_on_balls_has_a_steady_start(spin):
    """At rest the equilibrium of each end's weight; at a speed near it, by the small unbalance."""
    rings = ring_rotor(0.1, 0.15, 20.0).add_point_mass([0.1, 0.0, 0.15], 1e-3)
    uneven = rings.with_interface("left", range(5)).with_interface("right", range(5, 10))
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, uneven.reduce(0), spin=spin, gravity=[0.0, -9.81, 0.0])
    pair = [bearing(name, damping=1500.0) for name in ("left", "right")]
    add_supports(body, [*pair, Support("left", np.diag([0.0, 0.0, 1e6]))])
    mbs.Assemble()
    steady = steady_state(body, tolerance=1e-5)
    for one, load in zip(pair, (98.1, 98.1 + 9.81e-3), strict=True):
        expected = one.equilibrium(0.0, [0.0, -load])
        near = 1e-6 if spin == 0.0 else 0.3  # 9 N of unbalance, 98 N of weight
        found = steady.interface_motion(one.interface, 0.0)[:2]
        np.testing.assert_allclose(found, expected, atol=near * np.abs(expected).max())


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
    np.testing.assert_allclose(found, one._tangent(place, 0.7), rtol=1e-5, atol=1.0)
    assert one.law(0.0, 0.0, 1.0, -2.0, 0.0, 0.0) == (-30.0, 60.0)
    K, D = one.coefficients(100.0)
    assert abs(K[0, 1]) < 1e-6 * K[1, 1]
    np.testing.assert_allclose(D, 30.0 * np.eye(2))


@pytest.mark.parametrize("elements", ["balls", "rollers"])
def test_force_and_torque_are_the_slopes_of_what_the_contacts_store(elements):
    """V = Σ k δ^{n+1}/(n+1), n = 3/2 or 10/9, of place and spin angle."""
    one = bearing(clearance=5e-6, elements=elements)
    exponent = {"balls": 1.5, "rollers": 10.0 / 9.0}[elements]
    at, steps = np.array([2e-5, -1e-5, 0.7]), (1e-9, 1e-9, 1e-4)

    def stored(x, y, angle):
        turned = 2.0 * np.pi / 8 * np.arange(8) + one.cage_ratio * angle
        depth = np.maximum(x * np.cos(turned) + y * np.sin(turned) - 5e-6, 0.0)
        return np.sum(7e9 * depth ** (exponent + 1.0)) / (exponent + 1.0)

    expected = [
        (stored(*(at - move)) - stored(*(at + move))) / (2.0 * step)
        for move, step in zip(np.diag(steps), steps, strict=True)
    ]
    found = one.law_with_torque(*at[:2], 0.0, 0.0, at[2], 50.0)
    np.testing.assert_allclose(found, expected, rtol=1e-5)


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


def test_a_run_at_a_speed_starts_near_and_turns_its_cage():
    """Held at the start angle, the cage gives the equilibrium of (2) there; the run then sways."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor(), spin=300.0, gravity=[0.0, -9.81, 0.0])
    pair = [bearing(name, clearance=5e-6, damping=1500.0) for name in ("left", "right")]
    add_supports(body, pair)
    sensor = body.add_interface_sensor("left", exu.OutputVariableType.Displacement)
    mbs.Assemble()
    steady = steady_state(body)
    first, later = (pair[0].equilibrium(0.0, [0.0, -98.1], angle) for angle in (0.0, 0.6))
    np.testing.assert_allclose(steady.interface_motion("left", 0.0)[:2], first, atol=1e-12)
    body.start_from(steady.state())
    settings = recommended_settings(end_time=0.005, step=1e-4)
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 1e-4
    mbs.SolveDynamic(settings)
    away = np.abs(mbs.GetSensorStoredData(sensor)[:, 1:3] - first)
    assert away[:2].max() < 1e-3 * np.abs(later - first).max()
    assert away.max() > np.abs(later - first).max()


def test_linear_analyses_take_it():
    pair = [bearing(name, load=[0.0, -98.0], damping=500.0) for name in ("left", "right")]
    assert stability(rotor(), [100.0], supports=pair).growth_of("lateral")[0] < -1.0
    upright = [bearing(name, clearance=-2e-6, damping=500.0) for name in ("left", "right")]
    assert stability(rotor(), [100.0], supports=upright).growth_of("lateral")[0] < -1.0


def test_refused_input():
    for changes, match in (
        ({"clearance": -0.007}, "clearance: needs a finite number .m. > -0.006"),
        ({"count": 2}, "count: needs"),
        ({"element_radius": 0.02}, "8 elements of 0.02 m do not fit"),
        ({"elements": "needles"}, "elements: 'needles' is unknown"),
    ):
        with pytest.raises(ValueError, match=match):
            bearing(**changes)
    with pytest.raises(ValueError, match="without one no element carries"):
        bearing().equilibrium(1.0, [0.0, 0.0])


def test_cages_stand_in_the_linear_equations_of_a_scene():
    """Its frequencies are those on the tangents of the contacts as they are at the start."""
    gravity, reduced = [0.0, -9.81, 0.0], rotor()
    loads = bearing_loads(reduced, ["left", "right"], gravity)
    pair = [
        bearing(name, load=load, damping=500.0, clearance=5e-6)
        for name, load in zip(("left", "right"), loads, strict=True)
    ]
    thrust = Support("right", np.diag([0.0, 0.0, 1e6]), 100.0)
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, spin=100.0, gravity=gravity)
    add_supports(body, [*pair, thrust])
    mbs.Assemble()
    springs = [
        Support(one.interface, one._tangent(one.equilibrium(0.0, angle=0.0), 0.0), 500.0)
        for one in pair
    ]
    found = stability(mbs, [100.0], body=body, accuracy=None).exponents[0]
    expected = stability(reduced, [100.0], supports=[*springs, thrust], accuracy=None).exponents[0]
    oscillating = expected[expected.imag > 0.0]
    assert np.abs(found - oscillating[:, None]).min(axis=1).max() < 1e-5 * np.abs(oscillating).max()
