"""Magnetic bearings against state spaces written here, and scenes against lists."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg as la
from apart import distance
from point_rotors import ring_rotor
from test_supports_in_scenes import SKEW, SPEED, on_supports, rings

from exudyn_rotor import (
    LinearActuator,
    MagneticBearing,
    PIDController,
    SaturatingActuator,
    SolidRotor,
    Support,
    bearing_loads,
    campbell,
    linear_model,
    sensitivity,
    stability,
    steady_state,
)

K_I, K_S = 80.0, 3e5
LINEAR = LinearActuator(K_I, K_S)
MAGNETS = SaturatingActuator(constant=1e-5, bias_current=2.0, gap=4e-4, current_limit=6.0)
GAINS = {"proportional": 2e4, "derivative": 25.0}
BANDS = {"filter_frequency": 2e4, "amplifier_frequency": 1e4}
PD = PIDController(**GAINS, **BANDS)
PID = PIDController(**GAINS, **BANDS, integral=2e5)
DELAYED = PIDController(**GAINS, **BANDS, integral=2e5, delay=5e-5)
CONTROLLERS = {"PD": PD, "PID": PID, "delayed": DELAYED}


def bearing(interface="left", controller=DELAYED, actuator=LINEAR, **changes):
    return MagneticBearing(interface=interface, actuator=actuator, controller=controller, **changes)


# ------------------------------------------------------------------ state spaces by hand


def controller_states(one):
    """Return A, b, c of states of first order: (delay, its rate,) filter, its rate, ∫, current.

    ``ż = A z + b y``, ``i = c z``.
    """
    w, a, tau = one.filter_frequency, one.amplifier_frequency, one.delay
    A, b = np.zeros((6, 6)), np.zeros(6)
    tau = tau or 1.0
    A[0, 1], A[1, :2], b[1] = 1.0, [-12.0 / tau**2, -6.0 / tau], 12.0 / tau**2
    A[2, 3], A[3, 2:4], b[3] = 1.0, [-(w**2), -np.sqrt(2.0) * w], w**2
    A[3, 1] = -(w**2) * tau  # the filter sees y − τ q̇
    A[4, 2] = 1.0
    A[5, 2:6] = [a * one.proportional, a * one.derivative, a * one.integral, -a]
    c = np.eye(6)[5]
    kept = [*([0, 1] if one.delay else []), 2, 3, *([4] if one.integral else []), 5]
    return A[np.ix_(kept, kept)], b[kept], c[kept]


def closed_loop(M, G, K, places, sensors, one):
    """Return A of a plant ``M ẍ − iG ẋ + K x = Σ f`` with complex x on equal linear bearings.

    `places` and `sensors` are rows of the plant's coordinates. Returned are also the input of a
    signal at the first sensor, and the output of that sensor.
    """
    n, (C, b, c) = len(M), controller_states(one)
    inverse, count = la.inv(M), len(b)
    A = np.zeros((2 * n + count * len(places),) * 2, dtype=complex)
    A[:n, n : 2 * n] = np.eye(n)
    A[n : 2 * n, :n] = -inverse @ (K - K_S * sum(np.outer(p, p) for p in places))
    A[n : 2 * n, n : 2 * n] = 1j * inverse @ G
    for index, (p, s) in enumerate(zip(places, sensors, strict=True)):
        own = slice(2 * n + count * index, 2 * n + count * (index + 1))
        A[own, own], A[own, :n] = C, np.outer(b, s)
        A[n : 2 * n, own] = -K_I * np.outer(inverse @ p, c)
    drive, seen = np.zeros(len(A)), np.zeros(len(A))
    drive[2 * n : 2 * n + count], seen[:n] = b, sensors[0]
    return A, drive, seen


def apart(found, expected):
    """Return how far the expected exponents are from the found ones, over their size."""
    found, expected = (np.asarray(each)[:, None] for each in (found, expected))
    gap = np.abs(found.T - expected).min(axis=1) / np.maximum(np.abs(expected[:, 0]), 10.0)
    return gap.max()


@pytest.mark.parametrize("name", CONTROLLERS)
def test_rigid_rotor_has_the_eigenvalues_of_its_state_space(name):
    """Translation and tilt with the gyroscopic moment, all complex: x + iy, inertial axes."""
    one = CONTROLLERS[name]
    m, r, half = 20.0, 0.1, 0.15
    rotor = rigid()
    polar, across = m * r**2, m * (0.5 * r**2 + half**2)
    places = [np.array([1.0, side * half]) for side in (-1.0, 1.0)]
    plant = np.diag([m, across]), np.diag([0.0, SPEED * polar]), np.zeros((2, 2))
    A, *_ = closed_loop(*plant, places, places, one)
    found = stability(rotor, [SPEED], supports=pair(controller=one), accuracy=None).exponents[0]
    values = la.eigvals(A)
    copies = np.r_[found, found.conj()] + 1j * SPEED * np.arange(-2, 3)[:, None]
    assert apart(copies.ravel(), values[np.abs(values.imag) > 1.0]) < 1e-7


def rigid(mass=20.0):
    rotor = ring_rotor(0.1, 0.15, mass)
    return rotor.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(0)


def pair(**changes):
    return [bearing(name, **changes) for name in ("left", "right")]


BENDING = 4e5 * np.outer([1.0, -2.0, 1.0], [1.0, -2.0, 1.0])
MASSES = np.diag([2.0, 6.0, 2.0])


def three_masses():
    """Return three masses on an elastic shaft, with interfaces at each."""
    along = 1e8 * np.array([[1.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])
    K = np.kron(BENDING, np.diag([1.0, 1.0, 0.0])) + np.kron(along, np.diag([0.0, 0.0, 1.0]))
    nodes = [[0.0, 0.0, z] for z in (-0.2, 0.0, 0.2)]
    rotor = SolidRotor.from_matrices(np.kron(MASSES, np.eye(3)), K, nodes, "z")
    for number, name in enumerate(("left", "middle", "right")):
        rotor = rotor.with_interface(name, [number])
    return rotor


@pytest.mark.parametrize("sensor", [0, 1])
def test_flexible_rotor_with_sensors_elsewhere(sensor):
    """Three masses: exponents and sensitivity; with its sensor in the middle it is unstable."""
    rows, names = np.eye(3), ("left", "middle", "right")
    sensors = [rows[sensor], rows[2]]
    A, drive, seen = closed_loop(
        MASSES, np.zeros((3, 3)), BENDING, [rows[0], rows[2]], sensors, DELAYED
    )
    values = la.eigvals(A)
    supports = [bearing("left", sensor=names[sensor]), bearing("right")]
    rotor = three_masses()
    found = stability(rotor, [0.0], supports=supports).exponents[0]
    swinging = values[np.abs(values.imag) > 1.0]
    assert apart(np.r_[found, found.conj()], swinging) < 1e-7
    assert (values.real.max() > 0.0) == (sensor == 1)
    frequencies = np.geomspace(10.0, 4e3, 9)
    if sensor:
        with pytest.raises(ValueError, match=r"unstable at 0 rad/s: a motion of .* grows by"):
            sensitivity(rotor, frequencies, supports=supports)
        return
    result = sensitivity(rotor, frequencies, supports=supports)
    assert len(result.frequencies) > 9
    unit = np.eye(len(A))
    expected = [1.0 + seen @ la.solve(1j * w * unit - A, drive) for w in result.frequencies]
    for row in (0, 1):
        np.testing.assert_allclose(result.values[row], expected, rtol=1e-9)


# ------------------------------------------------------------------ scenes and lists


AXIAL = Support("right", np.diag([0.0, 0.0, 5e5]), 10.0)
KINDS = {
    "PD": [bearing(controller=PD), bearing("right", PID)],
    "delayed, elsewhere, turned": [bearing(angle=0.5, sensor="right"), bearing("right", angle=9.0)],
    "magnets": [bearing(actuator=MAGNETS), bearing("right", actuator=MAGNETS)],
    "beside a spring": [bearing(), Support("right", [[2e6, 5e5], [-5e5, 1e6]], 400.0)],
}


@pytest.mark.parametrize(
    ("turn", "rotation"), [(None, None), (SKEW, SKEW)], ids=["upright", "skew"]
)
@pytest.mark.parametrize("kind", KINDS)
def test_scene_and_list_have_the_same_exponents(kind, turn, rotation):
    # a heavy spot would turn journals on a circle, on which magnets have other slopes
    reduced, supports = rings(turn, 0.0 if kind == "magnets" else 1e-3), [*KINDS[kind], AXIAL]
    mbs, body, added = on_supports(reduced, supports, rotation, spin=9.0)
    found = linear_model(mbs, body=body)
    # differences of Exudyn's forces give the slopes of the magnets
    assert distance(found, linear_model(reduced, supports=supports), SPEED) < 1e-7
    assert added[0].uses_python


@pytest.mark.parametrize("controller", ["PD", "PID"])
def test_magnets_under_weight_are_stiffer_in_one_direction(controller):
    """The list takes the slopes where the scene's steady state finds the journal."""
    one, gravity = CONTROLLERS[controller], [0.0, -50.0, 0.0]
    loads = bearing_loads(rigid(), ["left", "right"], gravity)
    supports = [
        bearing(name, one, MAGNETS, load=load, angle=0.6)
        for name, load in zip(("left", "right"), loads, strict=True)
    ]
    mbs, body, _ = on_supports(rigid(), [*supports, AXIAL], spin=SPEED, gravity=gravity)
    place = steady_state(body).interface_motion("left", 0.3)[:2]
    rest = supports[0].equilibrium(SPEED)
    np.testing.assert_allclose(place, rest, atol=1e-9)
    if one.integral:
        np.testing.assert_allclose(rest, 0.0, atol=1e-15)
    else:
        assert rest[1] < -1e-5
    in_list = linear_model(rigid(), supports=[*supports, AXIAL])
    assert distance(linear_model(mbs, body=body), in_list, SPEED) < 1e-6


# ------------------------------------------------------------------ laws and refusals


def test_magnets_pull_by_the_square_of_current_over_gap():
    """4.1 of Schweitzer and Maslen (2009), and its derivatives; a limit and no push."""
    k, i_0, s_0 = 1e-5, 2.0, 4e-4
    i, x = 0.7, 5e-5
    pull = k * (((i_0 + i) / (s_0 - x)) ** 2 - ((i_0 - i) / (s_0 + x)) ** 2)
    assert MAGNETS.law(i, x) == pytest.approx(pull, rel=1e-14)
    assert MAGNETS.law(50.0, 0.0) == pytest.approx(k * (6.0 / s_0) ** 2, rel=1e-14)
    for current, place in ((0.0, 0.0), (i, x), (-3.0, -x), (5.0, x)):
        step = 1e-6
        found = (
            (MAGNETS.law(current + step, place) - MAGNETS.law(current - step, place)) / step,
            (MAGNETS.law(current, place + step * s_0) - MAGNETS.law(current, place - step * s_0))
            / (step * s_0),
        )
        np.testing.assert_allclose(MAGNETS.slopes(current, place), 0.5 * np.array(found), rtol=1e-7)
    first, second = bearing(angle=0.3).control_axes  # from n1 to n2
    c, s = np.cos(0.3), np.sin(0.3)
    np.testing.assert_allclose([*first, *second], [c, s, -s, c])
    centre = MAGNETS.slopes(0.0, 0.0)
    assert centre == pytest.approx((4 * k * i_0 / s_0**2, 4 * k * i_0**2 / s_0**3), rel=1e-14)
    assert (MAGNETS.force_current, MAGNETS.negative_stiffness) == pytest.approx(centre, rel=1e-14)


@pytest.mark.parametrize("integral", [0.0, 2e4, 2e5])
def test_an_integral_leaves_the_motions_their_names(integral):
    """Of a rotor they are four, at 43 to 61 Hz; those of the controller alone are its own."""
    given = replace(DELAYED, integral=integral)
    found = campbell(rigid(), [300.0], supports=pair(controller=given), accuracy=None)
    own = np.abs(found.frequencies_inertial[0] / (2.0 * np.pi) - 52.0) < 10.0
    assert sorted(found.whirl[0, own]) == 2 * ["backward"] + 2 * ["forward"]
    assert np.all(found.nodal_diameters[0, own] == 1)
    assert sorted(set(found.families[0, ~own])) == ["axial", "foundation", "torsional"]


def test_a_weak_controller_does_not_hold_its_magnets():
    weak = PIDController(**(GAINS | {"proportional": 3e3}), **BANDS)
    assert stability(rigid(), [0.0], supports=pair(controller=weak)).growth[0] > 10.0
    with pytest.raises(ValueError, match=r"K_i P of 2.4e.05 N/m is not above"):
        bearing(controller=weak, load=[0.0, 1.0]).linearised()
