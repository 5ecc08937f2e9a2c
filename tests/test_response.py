"""Unbalance and harmonic responses against closed forms and against a simulation in time."""

import exudyn
import numpy as np
import pytest
import scipy.linalg as la
from point_rotors import random_rotor, ring_rotor

from exudyn_rotor import add_rotor
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.periodic import harmonic_balance
from exudyn_rotor.linear.periodic.harmonic_balance import forced_motion
from exudyn_rotor.linear.response.harmonic_loads import BaseAcceleration, HarmonicForce
from exudyn_rotor.linear.response.steady_response import harmonic_response, unbalance_response
from exudyn_rotor.linear.response.unbalance import Unbalance, permissible_unbalance

MASS, RADIUS, LENGTH = 10.0, 0.1, 0.2  # ring rotor: I_p = m r², I_t = m (r²/2 + l²)
K, C = 4e5, 200.0  # critical speed sqrt(K/MASS) = 200 rad/s
TILT_K, TILT_C = 5e4, 10.0
SPEEDS = np.linspace(0.0, 600.0, 31)
# closed forms are met to rounding times the condition of the equations near resonance
EXACT = 1e-11


def rings(modes: int = 0, point_mass: float = 0.0):
    """Return the ring rotor, rigid by default, with equal masses beside both rings' first node."""
    rotor = ring_rotor(RADIUS, LENGTH, MASS)
    if point_mass:
        for z in (-LENGTH, LENGTH):
            rotor = rotor.add_point_mass([RADIUS, 0.0, z], point_mass)
    rotor = rotor.with_interface("mid", range(10))
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10))
    return rotor.reduce(modes)


def held(stiffness=K, damping=C) -> list[Support]:
    """Return a support in the middle: translations and tilts are then oscillators of their own."""
    return [Support("mid", stiffness, damping, TILT_K, TILT_C)]


def oscillator(k, c, m, rate):
    return 1.0 / (k - m * rate**2 + 1j * c * rate)


def close(found, expected, tolerance=EXACT):
    return np.abs(found - expected).max() <= tolerance * np.abs(expected).max()


def test_own_unbalance_is_the_jeffcott_rotor():
    # Friswell, Penny, Garvey, Lees, Dynamics of Rotating Machines (2010), Sect. 6.2:
    # z = m e Ω² / (k − mΩ² + i c Ω) exp(iΩt), circular and forward
    response = unbalance_response(rings(point_mass=0.01), SPEEDS, supports=held(), at="mid")
    expected = 0.02 * RADIUS * SPEEDS**2 * oscillator(K, C, MASS + 0.02, SPEEDS)
    forward, backward = response.whirl()
    assert list(response.orders) == [1]
    assert close(forward, expected)
    assert np.abs(backward).max() < EXACT * np.abs(expected).max()
    assert close(response.phasor("mid", "n2"), -1j * expected)


def test_unbalance_at_an_interface_has_size_and_angle():
    response = unbalance_response(
        rings(), SPEEDS, [Unbalance("mid", 1e-4, 0.7)], own=False, supports=held(), at="mid"
    )
    expected = 1e-4 * np.exp(0.7j) * SPEEDS**2 * oscillator(K, C, MASS, SPEEDS)
    assert close(response.phasor(), expected)


def test_couple_unbalance_tilts_against_the_gyroscopic_moment():
    # forward synchronous whirl of a rigid rotor: (k − (I_t − I_p)Ω² + i c Ω) φ = 2 l U Ω²
    pair = [Unbalance("right", 1e-4), Unbalance("left", 1e-4, np.pi)]
    response = unbalance_response(rings(), SPEEDS, pair, supports=held(), at="mid")
    polar, transverse = MASS * RADIUS**2, MASS * (0.5 * RADIUS**2 + LENGTH**2)
    expected = 2 * LENGTH * 1e-4 * SPEEDS**2
    expected = expected * oscillator(TILT_K, TILT_C, transverse - polar, SPEEDS)
    assert close(response.phasor("mid", "tilt n2"), expected)
    assert close(response.phasor("mid", "tilt n1"), 1j * expected)


def test_anisotropic_supports_make_the_ellipse_of_two_oscillators():
    supports = held(np.diag([K, 2 * K]), np.diag([C, 3 * C]))
    response = unbalance_response(
        rings(), SPEEDS, [Unbalance("mid", 1e-4)], own=False, supports=supports, at="mid"
    )
    x = 1e-4 * SPEEDS**2 * oscillator(K, C, MASS, SPEEDS)
    y = -1j * 1e-4 * SPEEDS**2 * oscillator(2 * K, 3 * C, MASS, SPEEDS)
    assert list(response.orders) == [1]
    assert close(response.phasor(), x)
    assert close(response.phasor("mid", "n2"), y)
    # the semi-axes are the singular values of the ellipse's two phases
    phases = np.stack([[x.real, -x.imag], [y.real, -y.imag]]).transpose(2, 0, 1)
    major, minor = response.semi_axes()
    assert close(major, np.linalg.norm(phases, 2, axis=(1, 2)), 1e-9)
    assert close(minor, np.linalg.det(phases) / np.maximum(major, 1e-300), 1e-9)
    assert minor[np.argmin(np.abs(SPEEDS - 240.0))] < 0.0  # backward between the critical speeds


@pytest.mark.filterwarnings("ignore:the centre of mass is")
def test_soft_direction_beside_a_rigid_one():
    """Bearings of 1e9 and 1e12 N/m are rigid to this rotor of 1 N/m; beside them 1e3 N/m.

    In the rotor frame that is the difference of numbers of 1e12, which round by 1e-4: 1e-7 of it,
    and a tenfold response.
    """
    uneven = random_rotor(1, [0.0, 0.0, 1.0])
    rotor = uneven.with_interface("left", range(3)).with_interface("right", range(3, 6)).reduce(0)
    found = []
    for stiff in (1e9, 1e12):
        stiffness = np.diag([stiff, 1e3, 1e3])
        supports = [Support(name, stiffness, 10.0) for name in ("left", "right")]
        found.append(unbalance_response(rotor, [5.0, 30.0], supports=supports, accuracy=None))
    first, second = (one.phasor("left", "n2") for one in found)
    np.testing.assert_allclose(first, second, rtol=3e-5)


def test_between_anisotropic_criticals_the_rotor_frame_sees_twice_the_speed():
    supports = held(np.diag([K, 2 * K]))
    options = {"unbalances": [Unbalance("mid", 1e-4)], "own": False, "supports": supports}
    inertial = unbalance_response(rings(), [240.0], at="mid", **options)
    turning = unbalance_response(rings(), [240.0], at="mid", frame="rotor", **options)
    assert list(turning.orders) == [0, 2]
    forward, backward = inertial.whirl()
    constant, double = (turning.phasor("mid", "n1", n) for n in (0, 2))
    # z exp(−iθ) = forward + backward exp(−2iθ)
    assert constant == pytest.approx(forward.real, rel=1e-9)
    assert close(double, backward.conj(), 1e-9)


@pytest.mark.filterwarnings("ignore:the centre of mass is")
def test_response_at_rest_is_the_modal_sum():
    rotor = random_rotor(3).with_interface("a", [0, 1, 2, 3]).reduce(9)
    supports = [Support("a", np.diag([2.0, 3.0, 4.0]), 0.0, np.diag([1.0, 2.0, 3.0]), 0.0)]
    frequencies = np.linspace(0.0, 3.0, 17)
    response = harmonic_response(
        rotor, frequencies, HarmonicForce("a", (1.0, 0.5j, 0.2), (0, 0, 0.3)), supports=supports
    )
    source = LinearRotor.of(rotor, supports)
    U = source.interface_motion("a")
    mass, _, stiffness = source.at(0.0).matrices(0.0)
    values, modes = la.eigh(stiffness, mass)
    load = modes.T @ U.T @ np.array([1.0, 0.5j, 0.2, 0, 0, 0.3])
    expected = (U @ modes) @ (load[:, None] / (values[:, None] - frequencies**2))
    assert np.allclose(
        response.motion[:, 0, 0], expected.T, rtol=0, atol=1e-9 * abs(expected).max()
    )


@pytest.mark.parametrize("speed", [-150.0, 90.0, 250.0])
def test_force_fixed_in_space_meets_a_rotor_that_only_seems_to_stand(speed):
    response = harmonic_response(
        rings(), SPEEDS, HarmonicForce("mid", (3.0, 0.0)), speed=speed, supports=held(), at="mid"
    )
    assert close(response.phasor("mid", "n1", 0), 3.0 * oscillator(K, C, MASS, SPEEDS))
    assert list(response.orders) == [0]


def test_force_fixed_in_the_rotor_sounds_at_sum_and_difference():
    speed, rates = 250.0, SPEEDS[1:]
    force = HarmonicForce("mid", (2.0, 0.0), frame="rotor")
    response = harmonic_response(rings(), rates, force, speed=speed, supports=held(), at="mid")
    assert list(response.orders) == [-1, 1]
    # 2 cos(ωt) exp(iΩt) circles at Ω + ω, and at Ω − ω: backward where ω is the larger
    for order, circling in ((1, speed + rates), (-1, speed - rates)):
        forward, backward = response.whirl("mid", order)
        found = np.where(circling > 0.0, forward, backward)
        assert close(found, oscillator(K, C, MASS, circling))


@pytest.mark.parametrize("speed", [0.0, 200.0])
def test_base_acceleration_is_minus_mass_times_acceleration(speed):
    shaken = BaseAcceleration((2.0, 1.0j, 0.5))
    response = harmonic_response(
        rings(), SPEEDS[1:], shaken, speed=speed, supports=held(), at="mid"
    )
    expected = -MASS * oscillator(K, C, MASS, SPEEDS[1:])
    assert close(response.phasor("mid", "n1", 0), 2.0 * expected)
    assert close(response.phasor("mid", "n2", 0), 1.0j * expected)
    # along the axis nothing holds it: −a/(−ω²)
    assert close(response.phasor("mid", "e", 0), 0.5 / SPEEDS[1:] ** 2)


def test_weight_is_an_acceleration_at_zero_frequency():
    response = harmonic_response(
        rings(), [0.0], BaseAcceleration((0.0, 9.81)), speed=120.0, supports=held(), at="mid"
    )
    assert response.phasor("mid", "n2")[0] == pytest.approx(-MASS * 9.81 / K, rel=1e-10)


@pytest.mark.parametrize("pair", [(0.0, 0.0), (0.0, np.pi)])
def test_peak_lies_at_the_critical_speed(pair):
    # undamped synchronous whirl is constant in the rotor frame: K x = Ω² (C − K2) x
    rotor, ends = rings(modes=6), ("left", "right")
    source = LinearRotor.of(rotor, [Support(name, 1e5) for name in ends])
    static, turning = source.at(0.0).K[0], source.at(1.0).K[0]
    # spin and axial motion have neither: with them every number would be an eigenvalue
    held_ones = np.ix_(*2 * [np.abs(static).max(axis=0) > 1.0])
    inverse_squares = la.eigvalsh((static - turning)[held_ones], static[held_ones])
    critical = inverse_squares[inverse_squares > 1e-10] ** -0.5
    speeds = np.linspace(100.0, 200.0, 401)
    unbalances = [Unbalance(name, 1e-4, angle) for name, angle in zip(ends, pair, strict=True)]
    supports = [Support(name, 1e5, 1.0) for name in ends]
    response = unbalance_response(
        rotor, speeds, unbalances, own=False, supports=supports, refine=True
    )
    # one step of the speeds; parallel and conical mode lie 10 rad/s apart
    assert np.abs(critical - response.peak("left")[0]).min() <= 0.25
    assert np.ptp(critical[critical < 1000.0]) > 5.0


@pytest.mark.filterwarnings("ignore:the centre of mass is")
def test_unsymmetric_rotor_on_anisotropic_supports_obeys_its_equations_at_every_angle():
    rotor = random_rotor(5).with_interface("a", [0, 1, 2]).with_interface("b", [3, 4, 5]).reduce(6)
    stiffness, turn = np.diag([3.0, 5.0, 4.0]), np.diag([2.0, 3.0, 4.0])
    supports = [Support(name, stiffness, 0.3 * turn, turn, 0.2 * stiffness) for name in "ab"]
    source = LinearRotor.of(rotor, supports)
    system = source.at(0.7)
    load = source.unit_unbalance.astype(complex)
    motion = forced_motion(system, {0: load}, 0.0, 1e-12)
    assert max(motion) >= 4  # the truncation matters here
    for theta in np.linspace(0.0, 2.0 * np.pi, 7):
        turns = {n: x * np.exp(1j * n * theta) for n, x in motion.items()}
        x, v, a = (sum((1j * n * 0.7) ** p * x for n, x in turns.items()) for p in range(3))
        M, D, K = system.matrices(theta)
        assert np.abs(M @ a + D @ v + K @ x - load).max() < 1e-9 * np.abs(load).max()


def test_truncation_that_is_too_low_is_an_error(monkeypatch):
    monkeypatch.setattr(harmonic_balance, "HIGHEST_HARMONIC", 3)
    supports = held(np.diag([K, 2 * K]))
    with pytest.raises(ValueError, match=r"at 240\.0: the harmonics do not converge"):
        unbalance_response(rings(point_mass=0.01), [240.0], supports=supports)


def test_node_moves_with_a_rigid_rotor():
    pair = [Unbalance("right", 1e-4), Unbalance("left", 2e-4, 2.0)]
    options = {"supports": held(), "frame": "rotor", "own": False}
    response = unbalance_response(rings(), [150.0], pair, at=["mid", (0.1, 0, 0.2)], **options)
    assert response.places == ("mid", "node 5")
    middle, node = response.motion[0, :, 0]
    arm = np.array([RADIUS, 0.0, LENGTH])
    assert np.allclose(node[:3], middle[:3] + np.cross(middle[3:], arm), rtol=0, atol=1e-12)
    assert np.all(np.isnan(node[3:]))
    same = unbalance_response(
        rings(), [150.0], [Unbalance((0.1, 0, 0.2), 1e-4)], at="mid", **options
    )
    other = unbalance_response(rings(), [150.0], [Unbalance("right", 1e-4)], at="mid", **options)
    # through an off-axis node a radial force has the same moment about the middle
    assert np.allclose(same.motion, other.motion, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("grade", "speed_rpm", "specific"),
    [(6.3, 3000.0, 20.05e-6), (2.5, 3000.0, 7.958e-6), (1.0, 60000.0, 0.15915e-6)],
)
def test_balance_grade(grade, speed_rpm, specific):
    # ISO 21940-11:2016: G = e_per Ω; e_per in m written out to four digits
    speed = speed_rpm * np.pi / 30.0
    assert permissible_unbalance(grade, 8.0, speed) == pytest.approx(8.0 * specific, rel=2e-4)
    half = Unbalance.from_grade("left", grade, 8.0, speed, share=0.5, angle=1.0)
    assert half.amount == pytest.approx(4.0 * specific, rel=2e-4)


def scene(rotor, speed: float, stiffness, damping, translation: str = "free"):
    """Return a scene with the ring rotor on two anisotropic bearings, and its body."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor, spin=speed, translation=translation)
    ground = mbs.CreateGround()
    for name, z in (("left", -LENGTH), ("right", LENGTH)):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body.marker(name)],
            localPosition0=[0, 0, z],
            stiffness=[*stiffness, 1e5],
            damping=[*damping, 100.0],
        )
    return mbs, body


@pytest.fixture(scope="module")
def eccentric():
    """An eccentric rotor and what a scene needs: centred interfaces."""
    rotor = ring_rotor(RADIUS, LENGTH, MASS).add_point_mass([RADIUS, 0.0, LENGTH], 0.002)
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10))
    return rotor.reduce(0)


STIFFNESS, DAMPING = (2e5, 3e5), (500.0, 400.0)


def test_agrees_with_a_simulation_in_time(eccentric):
    speed, steps, periods = 150.0, 200, 14
    mbs, body = scene(eccentric, speed, STIFFNESS, DAMPING)
    sensor = body.add_interface_sensor("right", exudyn.OutputVariableType.Displacement)
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    period = 2.0 * np.pi / speed
    settings.timeIntegration.numberOfSteps = steps * periods
    settings.timeIntegration.endTime = periods * period
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = period / steps
    mbs.SolveDynamic(settings)
    time, x, y, _ = mbs.GetSensorStoredData(sensor)[-steps:].T
    supports = [Support(name, np.diag(STIFFNESS), np.diag(DAMPING)) for name in ("left", "right")]
    response = unbalance_response(eccentric, [speed], supports=supports, at="right")
    # start-up has decayed by exp(−40/s · 0.59 s), 200 steps a revolution leave 2e-4
    phase = 2.0 / steps * np.exp(-1j * speed * time)
    assert abs(phase @ x - response.phasor("right", "n1")[0]) < 1e-3 * abs(phase @ x)
    assert abs(phase @ y - response.phasor("right", "n2")[0]) < 1e-3 * abs(phase @ y)


@pytest.mark.parametrize("translation", ["free", "none"])
def test_scene_and_rotor_on_supports_give_the_same(eccentric, translation):
    speeds, given = [60.0, 150.0, 260.0], [Unbalance("left", 1e-4, 0.5)]
    mbs, body = scene(eccentric, 10.0, STIFFNESS, DAMPING, translation)
    mbs.Assemble()
    linearised = unbalance_response(mbs, speeds, given, body=body)
    supports = [
        Support(name, np.diag([*STIFFNESS, 1e5]), np.diag([*DAMPING, 100.0]))
        for name in ("left", "right")
    ]
    direct = unbalance_response(eccentric, speeds, given, supports=supports)
    assert linearised.places == direct.places
    for direction in ("n1", "n2", "tilt n1"):
        # the scene's stiffness comes from differences of Exudyn's forces
        pair = [one.phasor("right", direction, 1) for one in (linearised, direct)]
        assert close(*pair, 1e-5)


def test_free_motion_under_load_is_an_error():
    with pytest.raises(ValueError, match=r"at 0\.0: a constant load acts on a motion that nothing"):
        harmonic_response(rings(), [0.0], HarmonicForce("mid", (0, 0, 1.0)), supports=held())


@pytest.mark.parametrize("stiffness", [K, np.diag([K, 2 * K])])
def test_resonance_without_damping_is_an_error(stiffness):
    supports = [Support("mid", stiffness, 0.0, TILT_K)]
    with pytest.raises(ValueError, match=r"at 200\.0: .*resonance without any damping"):
        unbalance_response(rings(), [200.0], [Unbalance("mid", 1e-4)], supports=supports)


def test_balanced_rotor_without_unbalance_is_an_error():
    with pytest.raises(ValueError, match="the rotor itself is balanced"):
        unbalance_response(rings(), [100.0], supports=held())
    with pytest.raises(ValueError, match="own=False"):
        unbalance_response(rings(point_mass=0.1), [100.0], supports=held(), own=False)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"speeds": [1.0, -2.0]}, "speeds: needs .* in ascending order"),
        ({"speeds": [-1.0, 2.0]}, "-1 is negative"),
        ({"speeds": [1.0, np.nan]}, "finite numbers"),
        ({"speeds": []}, "speeds: needs at least one number"),
        ({"at": "top"}, "no such interface; the rotor has: mid, left, right"),
        ({"at": 10}, "nodes 0 to 9"),
        ({"at": [(0.0, 1.0)]}, "needs the name of an interface"),
        ({"at": ["mid", "mid"]}, "named twice"),
        ({"at": []}, "no interfaces"),
        ({"frame": "moving"}, "frame: 'moving' is unknown"),
        ({"tolerance": 0.0}, "tolerance"),
        ({"unbalances": [Unbalance("top", 1.0)]}, "no such interface"),
    ],
)
def test_bad_input_is_named(changes, message):
    arguments = {"speeds": [1.0], "unbalances": [Unbalance("mid", 1e-4)], "supports": held()}
    with pytest.raises(ValueError, match=message):
        unbalance_response(rings(), **(arguments | changes))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Unbalance("mid", 0.0), "leave it out"),
        (lambda: Unbalance("mid", 1.0, np.inf), "angle"),
        (lambda: permissible_unbalance(2.5, -1.0, 1.0), "mass: needs"),
        (lambda: HarmonicForce("mid", (1.0,)), "two or three"),
        (lambda: HarmonicForce("mid", (1.0, 0.0), frame="body"), "frame: 'body' is unknown"),
        (lambda: BaseAcceleration((np.nan, 0.0)), "acceleration: needs"),
        (lambda: harmonic_response(rings(), [1.0], HarmonicForce("mid")), "no load"),
        (lambda: harmonic_response(rings(), [1.0], []), "no load"),
        (
            lambda: harmonic_response(rings(), [1.0], HarmonicForce(2, (0, 0), (1, 0))),
            "a mesh node has no rotation",
        ),
        (
            lambda: harmonic_response(rings(), [1.0], HarmonicForce("mid", (1, 0)), speed=np.nan),
            "speed",
        ),
        (lambda: unbalance_response(ring_rotor(1, 1, 1), [1.0]), "no interfaces"),
        (
            lambda: unbalance_response(rings().without_shapes(), [1.0], at=3),
            "keep_shapes=True",
        ),
    ],
)
def test_impossible_loads_are_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()
