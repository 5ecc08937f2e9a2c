"""Steady motion on rolling bearings against runs, equilibria and an integration in time."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import ring_rotor
from scipy.integrate import solve_ivp
from test_supports_in_scenes import rings

from exudyn_rotor import (
    Foundation,
    HarmonicForce,
    Mount,
    RollingBearing,
    SolidRotor,
    Support,
    Unbalance,
    add_foundation,
    add_rotor,
    add_supports,
    recommended_settings,
    rolling_bearing_response,
    unbalance_response,
)

BALLS = {"count": 8, "pitch_radius": 0.0326, "element_radius": 0.006, "stiffness": 7e9}
GRAVITY = [0.0, -9.81, 0.0]
MASS = 20.0


def bearing(interface="seat", **changes):
    return RollingBearing(interface=interface, **(BALLS | {"damping": 1500.0} | changes))


def point(axis="z"):
    solid = SolidRotor.from_matrices(MASS * np.eye(3), np.zeros((3, 3)), [[0.0, 0, 0]], axis)
    return solid.with_interface("seat", [0]).reduce(0)


def integrated(one, speed, unbalance, length, kept, gravity=GRAVITY):
    """Return times and places of a mass on one bearing, after its transient; (2) written anew."""
    phases = 2.0 * np.pi / one.count * np.arange(one.count)

    def rates(t, y):
        angle = phases + 0.5 * (1.0 - one.element_radius / one.pitch_radius) * speed * t
        normals = np.array([np.cos(angle), np.sin(angle)])
        loads = one.stiffness * np.maximum(y[:2] @ normals - one.clearance, 0.0) ** 1.5
        spin = unbalance * speed**2 * np.array([np.cos(speed * t), np.sin(speed * t)])
        force = spin - normals @ loads - one.damping * y[2:] + MASS * np.array(gravity[:2])
        return np.r_[y[2:], force / MASS]

    times = np.linspace(length - kept, length, 300)
    run = solve_ivp(rates, (0.0, length), [0.0, -1e-5, 0.0, 0.0], t_eval=times, rtol=1e-6,
                    atol=1e-11, max_step=5e-4)  # fmt: skip
    return times, run.y[:2].T


@pytest.mark.parametrize(
    ("speed", "clearance", "unbalance"),
    [(280.0, 5e-6, 0.0), (100.0, 2e-5, 1e-3), (600.0, 2e-5, 3e-3)],
)
def test_motion_is_that_of_an_integration_in_time(speed, clearance, unbalance):
    """At the resonance of the ball pass; swaying by unbalance; orbiting, elements lifting off."""
    one = bearing(clearance=clearance, damping=4000.0)
    given = [Unbalance("seat", unbalance)] if unbalance else ()
    found = rolling_bearing_response(point(), [speed], given, supports=one, gravity=GRAVITY)
    times, expected = integrated(one, speed, unbalance, 0.12, 0.03)  # m/c = 5 ms
    away = np.abs(found.displacement(speed, times) - expected).max()
    assert found.errors[0] <= 1e-2
    assert away < 1e-2 * np.ptp(expected, axis=0).max()


@pytest.mark.parametrize(("clearance", "unbalance"), [(0.0, 1e-4), (1e-6, 1e-3)])
def test_soft_contacts_need_more_harmonics_than_stiff_ones(clearance, unbalance):
    """Upright, pressed by its unbalance into less than a µm, which turns against the cage."""
    one, upright = bearing(clearance=clearance, damping=3000.0), [0.0, 0.0, -9.81]
    given = {"supports": one, "gravity": upright}
    found = rolling_bearing_response(point(), [100.0], Unbalance("seat", unbalance), **given)
    times, expected = integrated(one, 100.0, unbalance, 0.15, 0.03, upright)
    away = np.abs(found.displacement(100.0, times) - expected).max()
    assert found.errors[0] <= 1e-2
    assert away < 1e-2 * np.ptp(expected, axis=0).max()


@pytest.mark.parametrize("elements", ["balls", "rollers"])
def test_at_rest_it_is_the_equilibrium_at_every_cage_angle(elements):
    one = bearing(elements=elements, clearance=2e-6)
    found = rolling_bearing_response(point(), [0.0, 1e-3], supports=one, gravity=GRAVITY)
    angles = 2.0 * np.pi / one.passing_frequency(1.0) * np.arange(7) / 7
    expected = [one.equilibrium(0.0, [0.0, -MASS * 9.81], angle) for angle in angles]
    seen = found.displacement(1e-3, angles / 1e-3)
    np.testing.assert_allclose(seen, expected, atol=2e-2 * found.end_to_end()[1].max())
    np.testing.assert_allclose(found.end_to_end()[0], found.end_to_end()[1], rtol=1e-2)
    both = zip(expected, angles, strict=True)
    loads = [one.element_loads(place, angle).max() for place, angle in both]
    assert 0.99 * max(loads) <= found.element_loads[0, 0] < 1.05 * max(loads)


def test_small_unbalance_is_linear_and_told_so():
    """Preloaded far, the bearing is a spring of the mean stiffness: m e Ω²/|k − mΩ² + icΩ|."""
    one, speed = bearing(count=60, element_radius=1e-3), 300.0
    pull = HarmonicForce("seat", (0.0, -1e4))
    given = {"supports": one, "loads": pull}
    found = rolling_bearing_response(point(), [speed], Unbalance("seat", 1e-4), **given)
    K = one.coefficients(speed, [0.0, -1e4])[0]
    expected = np.linalg.solve(
        K + (1j * one.damping * speed - MASS * speed**2) * np.eye(2),
        1e-4 * speed**2 * np.array([1.0, -1j]),
    )
    seen = [found.phasor("seat", name, 0, 1)[0] for name in ("n1", "n2")]
    np.testing.assert_allclose(seen, expected, rtol=1e-3)
    assert found.linear_errors[0] < 0.1
    unbalance = Unbalance("seat", 0.15)
    large = rolling_bearing_response(point(), [speed], unbalance, **given, tolerance=0.05)
    assert large.linear_errors[0] > 0.3


def test_vertical_rotor_circles_with_the_unbalance():
    """With many balls a circle of radius r: Q(r) = mΩ²r + √((U Ω²)² − (c Ω r)²)."""
    one, speed, amount = bearing(count=60, element_radius=1e-3, clearance=1e-5), 400.0, 1e-3
    given = {"supports": one, "gravity": [0.0, 0.0, -9.81]}
    found = rolling_bearing_response(point(), [speed], Unbalance("seat", amount), **given)
    radius = np.abs(found.phasor("seat", "n1", 0, 1)[0])
    drag = one.damping * speed * radius
    force = MASS * speed**2 * radius + np.sqrt((amount * speed**2) ** 2 - drag**2)
    assert radius == pytest.approx(one.equilibrium(0.0, [force, 0.0])[0], rel=1e-3)
    assert np.isnan(found.linear_errors[0])
    assert found.open_shares[0, 0] == 0.0


def test_another_axis_has_the_same_motion():
    one, unbalance = bearing(clearance=5e-6), Unbalance("seat", 1e-4)
    spans = []
    for axis in ("z", "x", [1.0, 2.0, -2.0]):
        rotor = point(axis)
        given = {"supports": one, "gravity": -9.81 * rotor.axis.plane[:, 1]}
        spans.append(rolling_bearing_response(rotor, [200.0], unbalance, **given).end_to_end())
    np.testing.assert_allclose(spans, [spans[0]] * 3, rtol=1e-6)


def away_in_a_run(body, found, spin, end_time=0.01, step=2e-5):
    """Return how far a run that begins in a response gets from it, over the motion; both ends."""
    sensors = {
        name: body.add_interface_sensor(name, exu.OutputVariableType.Displacement)
        for name in ("left", "right")
    }
    body.mbs.Assemble()
    body.start_from(found.state(spin, body))
    body.mbs.Assemble()
    settings = recommended_settings(end_time=end_time, step=step)
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = step
    body.mbs.SolveDynamic(settings)
    shares = []
    for name, sensor in sensors.items():
        path = body.mbs.GetSensorStoredData(sensor)
        moved = path[:, 1:] @ body.standing_axes[:, :2]
        away = np.abs(moved - found.displacement(spin, path[:, 0], name)).max()
        shares.append(away / np.ptp(moved, axis=0).max())
    return shares


@pytest.mark.parametrize("founded", [True, False])
def test_a_run_from_it_stays_on_it(founded):
    """Within the harmonics left out and the step's error.

    With clearance on a block on mounts; or with unbalance and a spring that turns with the rotor.
    """
    spin, places = 300.0, {"left": [0.0, 0.0, -0.15], "right": [0.0, 0.0, 0.15]}
    rings = ring_rotor(0.1, 0.15, MASS).with_interface("left", range(5))
    rings = rings.with_interface("right", range(5, 10))
    given = {"gravity": GRAVITY, "supports": [Support("left", np.diag([0.0, 0.0, 1e6]))]}
    if founded:
        mounts = [Mount([x, -0.2, z], 2e6, 2e3) for x in (-0.2, 0.2) for z in (-0.2, 0.2)]
        block = Foundation.rigid(10.0, [0.4, 0.4, 0.4], [0.0, -0.1, 0.0], mounts, places)
        given["foundation"] = block
    else:
        rings = rings.add_point_mass([0.1, 0.0, 0.15], 2e-4)
        given["supports"].append(Support("right", [[5e6, 0.0], [0.0, 0.0]], frame="rotor"))
    clearance = 5e-6 if founded else 0.0
    given["supports"] += [bearing(name, clearance=clearance) for name in places]
    reduced = rings.reduce(0)
    found = rolling_bearing_response(reduced, [spin], **given)
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, spin=spin, gravity=GRAVITY, translation="none")
    base = add_foundation(mbs, block, gravity=GRAVITY) if founded else None
    add_supports(body, given["supports"], base)
    assert max(away_in_a_run(body, found, spin)) < 1e-2


@pytest.mark.parametrize("speeds", [[0.0], [100.0]])
@pytest.mark.parametrize("count", [1, 2])
def test_a_rotor_that_tilts_about_its_only_bearing_is_told(speeds, count):
    solid = ring_rotor(0.1, 0.2, 8.0)
    rotor = solid.with_interface("left", range(5)).reduce(0)
    with pytest.raises(ValueError, match="against tilting: all stand at 'left'; add one at"):
        rolling_bearing_response(
            rotor, speeds, supports=count * [bearing("left")], gravity=[3.0, -9.81, 0.0]
        )


def test_a_load_along_the_axis_that_nothing_holds_is_told():
    with pytest.raises(ValueError, match=r"holds the rotor along its axis, .* 'seat'; add a stiff"):
        rolling_bearing_response(
            point(), [100.0], supports=bearing(), gravity=GRAVITY,
            loads=[HarmonicForce("seat", [0.0, 0.0, 5.0])],
        )  # fmt: skip


@pytest.mark.parametrize("axis", ["z", [0.3, 0.2, 0.9]])  # across the second it leaves rounding
def test_gravity_along_the_axis_presses_no_element(axis):
    """Upright and all but balanced, a rotor of 1 µm clearance rests at no element."""
    unbalance, rotor = [Unbalance("seat", 1e-7)], point(axis)
    given = {"supports": bearing(clearance=1e-6), "gravity": -9.81 * rotor.axis.direction}
    with pytest.raises(ValueError, match="gravity: lies along the axis, where it presses no"):
        rolling_bearing_response(rotor, [30.0], unbalance, **given)
    with pytest.raises(ValueError, match="without a load no element carries"):
        rolling_bearing_response(rotor, [30.0], own=False, **given)


@pytest.mark.parametrize("axis", ["z", [1.0, 2.0, -2.0]])
@pytest.mark.parametrize(("speeds", "amount"), [([100.0], 0.0), ([0.0, 100.0], 1e-4)])
def test_loads_along_a_held_axis_press_no_element(axis, speeds, amount):
    """On a spring along the axis, with or without clearance, at the speed without another load."""
    rotor = point(axis)
    given = {"loads": [HarmonicForce("seat", [0.0, 0.0, -5.0])], "own": False}
    for clearance in (0.0, 5e-6):
        held = [bearing(clearance=clearance), Support("seat", np.diag([0.0, 0.0, 1e6]))]
        with pytest.raises(ValueError, match=f"press no element at {speeds[0]:g} rad/s"):
            rolling_bearing_response(
                rotor, speeds, [Unbalance("seat", amount)] if amount else (), supports=held, **given
            )


@pytest.mark.parametrize(("clearance", "speed"), [(1e-6, 100.0), (5e-6, 400.0)])
def test_upright_rotors_whirl_by_a_small_unbalance(clearance, speed):
    """The motion that a run finds; Newton's method comes there from larger unbalances alone."""
    one, amount = bearing(clearance=clearance), 1e-4
    response = rolling_bearing_response(
        point(), [speed], Unbalance("seat", amount), supports=one, gravity=[0.0, 0.0, -9.81]
    )
    times, path = integrated(one, speed, amount, 0.6, 0.1, [0.0, 0.0])  # m/c = 13 ms
    away = np.abs(response.displacement(speed, times) - path)
    assert away.max() < 2e-3 * np.ptp(path)


def test_preloaded_upright_rotors_whirl_as_linear_equations_say():
    """Far below the preload their contacts are springs: unbalance_response, written apart."""
    preloaded = [bearing(clearance=-1e-5)]
    speeds, unbalance = [200.0, 500.0], Unbalance("seat", 1e-4)
    response = rolling_bearing_response(point(), speeds, unbalance, supports=preloaded)
    assert response.linear_errors.max() < 1e-3
    linear = unbalance_response(point(), speeds, unbalance, supports=preloaded)
    turning = linear.motion[:, 0, linear.orders.tolist().index(1), :2]
    for direction, expected in zip(("n1", "n2"), turning.T, strict=True):
        found = response.phasor("seat", direction, 0, 1)
        np.testing.assert_allclose(np.abs(found), np.abs(expected), rtol=1e-3)
    with pytest.raises(ValueError, match="without a load no element carries, and preloaded ones"):
        rolling_bearing_response(point(), [200.0], supports=preloaded)


@pytest.mark.parametrize("clearance", [-1e-5, 5e-6])
def test_a_sweep_from_rest_is_as_good_as_one_from_a_speed(clearance):
    """At rest there is no whirl, and of preloaded elements all but no varying compliance."""
    given = {"supports": bearing(clearance=clearance), "gravity": GRAVITY, "tolerance": 5e-3}
    unbalance = Unbalance("seat", 3e-4)
    whole = rolling_bearing_response(point(), [0.0, 300.0], unbalance, **given)
    alone = rolling_bearing_response(point(), [300.0], unbalance, **given)
    assert max(whole.errors.max(), alone.errors.max()) < 5e-3
    times = np.linspace(0.0, 0.1, 50)
    moved, expected = (each.displacement(300.0, times) for each in (whole, alone))
    np.testing.assert_allclose(moved, expected, atol=0.01 * np.ptp(expected, axis=0).max())


def test_balanced_rotors_begin_strained_by_their_spin():
    """As those with a small unbalance do: without that strain the run below began with a jump."""
    reduced = rings(heavy=0.0)
    pair = [bearing(name, clearance=5e-6) for name in ("left", "right")]
    held = [*pair, Support("left", np.diag([0.0, 0.0, 1e6]), np.diag([0.0, 0.0, 100.0]))]
    response = rolling_bearing_response(
        reduced, [300.0], supports=held, gravity=10.0 * np.array(GRAVITY), tolerance=1e-3
    )
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, spin=300.0, gravity=10.0 * np.array(GRAVITY))
    add_supports(body, held)
    sensor = body.add_interface_sensor("left", exu.OutputVariableType.Displacement)
    mbs.Assemble()
    body.start_from(response.state(300.0, body))
    settings = recommended_settings(end_time=0.01, step=2e-5)
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 2e-5
    mbs.SolveDynamic(settings)
    path = mbs.GetSensorStoredData(sensor)
    expected = response.displacement(300.0, path[:, 0], "left")
    away = np.abs(path[:, 1:3] - expected).max()
    assert away < 0.01 * np.ptp(expected, axis=0).max()  # 0.66 of it without the strain


def test_refused_input():
    balls = bearing()
    for given, match in (
        ({"supports": Support("seat", 1e6)}, "need a RollingBearing"),
        ({"supports": [balls, bearing(count=9)]}, "one kind as it is, with the other"),
        ({"supports": balls, "gravity": [0.0, 0.0, 9.81]}, "without a load no element"),
    ):
        with pytest.raises(ValueError, match=match):
            rolling_bearing_response(point(), [100.0], **({"gravity": GRAVITY} | given))
    turned = "speeds: -10 is negative; .* turn the spin axis round"  # it has no allow_negative
    with pytest.raises(ValueError, match=turned):
        rolling_bearing_response(point(), [-10.0, 10.0], supports=balls, gravity=GRAVITY)


def test_a_speed_without_a_motion_is_nan_and_costs_no_other():
    """A table that ends: beyond it there are no coefficients."""
    table = Support("seat", ([0.0, 250.0], [np.diag([1e5, 1e5, 1e6])] * 2))
    given = {"supports": [table, bearing()], "gravity": GRAVITY}
    with pytest.warns(UserWarning, match="no values at 300 rad/s, which are NaN"):
        found = rolling_bearing_response(point(), [100.0, 200.0, 300.0], **given)
    assert np.isnan(found.end_to_end()).any(axis=1).tolist() == [False, False, True]
    assert np.isnan(found.element_loads[:, 0]).tolist() == [False, False, True]
    assert found.verdicts[2] == "not determined"
    assert "nan" in found.table()
    with pytest.raises(ValueError, match="rolling bearings at 300 rad/s"):
        rolling_bearing_response(point(), [300.0], **given)
