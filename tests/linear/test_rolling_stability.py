"""Stability of steady motions on rolling bearings against runs, closed forms and other analyses."""

import numpy as np
import pytest
from point_rotors import ring_rotor
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from exudyn_rotor import (
    Foundation,
    HarmonicForce,
    Mount,
    RollingBearing,
    SolidRotor,
    Support,
    Unbalance,
    linear_model,
    rolling_bearing_response,
    stability,
)
from exudyn_rotor.linear.solve.impulses import ChangingEquations

MASS, WEIGHT = 20.0, 20.0 * 9.81
BALLS = {"count": 8, "pitch_radius": 0.0326, "element_radius": 0.006, "stiffness": 7e9}


def bearing(interface="seat", **changes):
    return RollingBearing(interface=interface, **(BALLS | changes))


def point(axis="z"):
    solid = SolidRotor.from_matrices(MASS * np.eye(3), np.zeros((3, 3)), [[0.0, 0, 0]], axis)
    return solid.with_interface("seat", [0]).reduce(0)


def meissner(share, damping, rate):
    """Return ẍ + damping ẋ + (1 ± share) x = 0, + and − for half a period each."""

    def changes(times):
        sign = np.where((times * rate) % (2.0 * np.pi) < np.pi, 1.0, -1.0)
        return share * sign[:, None, None], None

    one = np.ones((1, 1))
    return ChangingEquations(one, damping * one, one, one, changes, 1.2)


@pytest.mark.parametrize("damping", [0.02, 0.4])
def test_exponent_of_meissners_equation(damping):
    """Piecewise constant: the product of two matrix exponentials, E. Meissner (1918)."""
    share, rate = 0.4, 2.0
    halves = [
        expm(np.pi / rate * np.array([[0.0, 1.0], [-(1.0 + sign * share), -damping]]))
        for sign in (1.0, -1.0)
    ]
    period = 2.0 * np.pi / rate
    expected = np.log(np.abs(np.linalg.eigvals(halves[1] @ halves[0])).max()) / period
    found = [meissner(share, damping, rate).largest_exponent(period, n) for n in (100, 200)]
    assert expected * (0.2 - damping) > 0.0  # unstable with little damping
    assert found[1] == pytest.approx(expected, abs=1e-4)
    assert abs(found[1] - expected) < 0.3 * abs(found[0] - expected)


def test_exponent_with_dampers_that_come_and_go():
    """Of ẋ = −d(t) ẋ with no spring: the mean of d, for any change in a period."""

    def changes(times):
        damper = 0.5 * np.cos(3.0 * times)[:, None, None]
        return np.zeros_like(damper), damper

    one = np.ones((1, 1))
    equations = ChangingEquations(one, one, 1e-12 * one, one, changes, 1.0)
    period = 2.0 * np.pi / 3.0
    # the other motion stands still
    assert equations.largest_exponent(period, 64) == pytest.approx(0.0, abs=1e-9)
    monodromy, log = equations._monodromy(period / 64, 64)
    assert np.linalg.det(monodromy) * np.exp(2.0 * log) == pytest.approx(np.exp(-period), rel=1e-9)


def test_growth_beyond_the_largest_float():
    """Of ẍ = 100 x, by the right side alone: exp(10 t) over a hundred seconds."""
    one = np.ones((1, 1))
    equations = ChangingEquations(
        one, 0.0 * one, 0.0 * one, one, lambda t: (np.full((len(t), 1, 1), -100.0), None), 10.0
    )
    assert equations.largest_exponent(100.0, 40_000) == pytest.approx(10.0, rel=1e-4)


def grown(one, found, unbalance, periods):
    """Return the growth of what two runs are apart [1/s], and how much halves of it differ.

    One begins in the steady motion, the other 1e-9 m beside it; the law of contact written anew.
    A quarter of the time is left for other motions to decay.
    """
    speed = found.speeds[0]
    phases = 2.0 * np.pi / one.count * np.arange(one.count)
    passing = one.passing_frequency(speed)
    period = 2.0 * np.pi / passing

    def rates(t, y):
        angle = phases + passing / one.count * t
        n = np.array([np.cos(angle), np.sin(angle)])
        spin = unbalance * speed**2 * np.array([np.cos(speed * t), np.sin(speed * t)])
        states = y.reshape(2, 4)
        depths = np.maximum(states[:, :2] @ n - one.clearance, 0.0)
        force = spin - (one.stiffness * depths**1.5) @ n.T - one.damping * states[:, 2:]
        force[:, 1] -= WEIGHT
        return np.hstack([states[:, 2:], force / MASS]).ravel()

    h = 1e-7
    places = found.displacement(speed, [-h, 0.0, h])
    start = np.r_[places[1], (places[2] - places[0]) / (2.0 * h)]
    starts = np.r_[start, start + np.array([1e-9, 2e-9, 0.0, 0.0])]
    times = np.linspace(0.0, periods * period, 16 * periods + 1)
    # errors of both, by the same steps, are alike: of their difference they are as small a share
    run = solve_ivp(rates, (0.0, times[-1]), starts, "DOP853", t_eval=times, rtol=1e-9,
                    atol=1e-13)  # fmt: skip
    apart = np.diff(run.y.T.reshape(-1, 2, 4), axis=1)[:, 0] * [1e3, 1e3, 1.0, 1.0]
    logs = np.log(np.linalg.norm(apart, axis=1))
    first = len(times) // 4
    middle = (first + len(times)) // 2
    whole, *halves = (
        np.polyfit(times[few], logs[few], 1)[0]
        for few in (slice(first, None), slice(first, middle), slice(middle, None))
    )
    return whole, np.abs(np.array(halves) - whole).max()


@pytest.mark.parametrize(
    ("speed", "damping", "unbalance", "periods", "verdict"),
    [
        (440.0, 1800.0, 0.0, 16, "unstable"),  # resonance of the ball pass
        (400.0, 1800.0, 0.0, 40, "stable"),
        (680.0, 600.0, 0.0, 40, "unstable"),  # the sum of two natural frequencies
        (680.0, 900.0, 2e-6, 40, "unstable"),
        (600.0, 4000.0, 3e-3, 32, "stable"),
    ],
)
@pytest.mark.filterwarnings("ignore:rolling bearings")
def test_verdict_and_growth_are_those_of_runs(speed, damping, unbalance, periods, verdict):
    one = bearing(clearance=1e-5, damping=damping)
    given = [Unbalance("seat", unbalance)] if unbalance else ()
    found = rolling_bearing_response(
        point(), [speed], given, supports=one, gravity=[0.0, -9.81, 0.0], tolerance=1e-3
    )
    assert found.verdicts == (verdict,)
    measured, error = grown(one, found, unbalance, periods)
    assert error < 0.3 * abs(measured)
    assert abs(found.exponents[0] - measured) < found.exponent_errors[0] + error


def test_another_axis_has_the_same_exponent():
    one, found = bearing(clearance=1e-5, damping=1800.0), []
    for axis in ("z", [1.0, 2.0, -2.0]):
        rotor = point(axis)
        given = {"supports": one, "gravity": -9.81 * rotor.axis.plane[:, 1]}
        found.append(rolling_bearing_response(rotor, [400.0], **given).exponents[0])
    assert found[0] == pytest.approx(found[1], rel=1e-6)


@pytest.mark.parametrize(("kind", "family"), [("uneven", "lateral"), ("founded", "axial")])
def test_many_preloaded_balls_are_a_linear_bearing(kind, family):
    """Then `stability`, by Hill's method, has the same exponent."""
    speed, load = 200.0, np.array([0.0, -5e3])
    places = {"left": [0.0, 0.0, -0.15], "right": [0.0, 0.0, 0.15]}
    rings = ring_rotor(0.1, 0.15, MASS).with_interface("left", range(5))
    reduced = rings.with_interface("right", range(5, 10)).reduce(0)
    balls = [
        bearing(name, count=60, element_radius=1e-3, damping=500.0, load=load) for name in places
    ]
    rest, given = [Support("left", np.diag([0.0, 0.0, 1e6]), 100.0)], {}
    if kind == "uneven":
        rest.append(
            Support("right", [[2e6, 0.0], [0.0, 0.0]], [[0.0, 0.0], [0.0, 1e3]], frame="rotor")
        )
    else:
        mounts = [Mount([x, -0.2, z], 2e6, 2e3) for x in (-0.2, 0.2) for z in (-0.2, 0.2)]
        given["foundation"] = Foundation.rigid(
            10.0, [0.4, 0.4, 0.4], [0.0, -0.1, 0.0], mounts, places
        )
    pulls = [HarmonicForce(name, load) for name in places]
    found = rolling_bearing_response(
        reduced, [speed], supports=[*balls, *rest], loads=pulls, own=False, tolerance=1e-4, **given
    )
    linear = stability(linear_model(reduced, supports=[*balls, *rest], **given), [speed])
    assert found.linear_errors[0] < 0.1
    assert found.exponents[0] == pytest.approx(linear.growth_of(family)[0], rel=1e-2)


@pytest.mark.parametrize("speed", [30.0, 300.0])
@pytest.mark.parametrize("axis", ["z", [1.0, 2.0, -2.0]])
def test_a_bearing_that_is_not_touched_has_no_part(axis, speed):
    """Around a rotor on a spring and a damper: roots of ``mλ² + dλ + k``, also overdamped."""
    rotor, open_bearing = point(axis), bearing(clearance=1e-3)
    gravity = -9.81 * rotor.axis.plane[:, 1]
    for damping in (1e3, 1e5):
        given = {"supports": [Support("seat", 1e6, damping), open_bearing], "gravity": gravity}
        found = rolling_bearing_response(rotor, [speed], **given)
        expected = np.roots([MASS, damping, 1e6]).real.max()
        assert found.exponents[0] == pytest.approx(expected, rel=1e-6)
        assert found.open_shares[0, 0] == 1.0
        assert found.displacement(speed, [0.0])[0] == pytest.approx([0.0, -WEIGHT / 1e6], abs=1e-12)


def test_a_motion_that_decays_within_a_ball_pass_is_stable():
    """To exp(−89) of what it was, beside a motion along the axis that does not decay."""
    held = [Support("seat", 1e6, 1e4), bearing(clearance=1e-3)]
    found = rolling_bearing_response(point(), [30.0], supports=held, gravity=[0.0, -9.81, 0.0])
    assert found.verdicts == ("stable",)
    assert np.roots([MASS, 1e4, 1e6]).max() < found.exponents[0]


def test_at_rest_it_is_that_of_the_contacts_at_any_angle():
    """Every eigenvalue has the real part −c/2m, but for overdamped motions."""
    one = bearing(damping=500.0)
    found = rolling_bearing_response(point(), [0.0, 1e-3], supports=one, gravity=[0.0, -9.81, 0.0])
    np.testing.assert_allclose(found.exponents, -500.0 / (2.0 * MASS), rtol=1e-9)
    assert found.verdicts == ("stable", "stable")
