"""Harmonic responses against closed forms and against K − ω²M with the spin as a coordinate."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
from forced_models import MASS, SPEEDS, TILT_C, TILT_K, C, K, close, held, oscillator, rings
from models import disc_with_craig_bampton_modes
from point_rotors import ring_rotor

from exudyn_rotor import (
    BaseAcceleration,
    HarmonicForce,
    SolidRotor,
    Support,
    Unbalance,
    harmonic_response,
    permissible_unbalance,
    unbalance_response,
)

ENDS = ("left", "right")


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


@pytest.mark.parametrize(
    ("load", "direction", "unit"),
    [
        (HarmonicForce("left", (0.0, 0.0, 1.0)), "e", "m"),
        (BaseAcceleration((0.0, 0.0, 1.0)), "e", "m"),
        (HarmonicForce("left", moment=(0.0, 0.0, 1.0)), "twist", "rad"),
    ],
)
def test_a_motion_along_or_about_the_axis_is_shown_at_speed(load, direction, unit):
    """Across it the unevenness of the mesh makes small motions in other harmonics."""
    supports = [Support(name, 1e7 * np.eye(3), 500.0) for name in ENDS]
    at_rest, found = (
        harmonic_response(
            disc_with_craig_bampton_modes(), [200.0, 400.0], load, speed=speed, supports=supports
        )
        for speed in (0.0, 100.0)
    )
    assert list(found.orders) == [-1, 0, 1]
    assert found.main_order == 0
    expected = at_rest.phasor("right", direction)
    np.testing.assert_allclose(found.phasor("right", direction), expected, rtol=1e-4)
    (size, _), polar = found.plot("right", directions=[direction]), found.plot_polar("right")
    np.testing.assert_allclose(size.lines[0].get_ydata(), 1e6 * np.abs(expected), rtol=1e-4)
    assert size.get_ylabel() == f"amplitude [µ{unit}]"
    assert polar.get_ylabel().endswith("[µm]")
    assert f"{direction} [{unit}]" in found.table("right")
    plt.close("all")


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Unbalance("mid", 0.0), "needs a finite number \\[kg m\\] > 0"),
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
            "need a rotor with its mode shapes",
        ),
    ],
)
def test_impossible_loads_are_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()


# ------------------------------------------------------------------ the spin as a coordinate


def eccentric(modes=6, mass=5e-3):
    rotor = ring_rotor(0.06, 0.2, 4.0).add_point_mass([0.0, 0.06, 0.2], mass)
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10))
    return rotor.with_interface("rim", [5]).reduce(modes)


def by_hand(rotor, supports, omega, load):
    """Return the motion of the rim, ``K − ω²M`` with the spin as a coordinate."""
    inv = rotor.invariants
    stiffness, damping = inv.K.copy(), inv.D.copy()
    for support in supports:
        U = rotor.interfaces[support.interface].motion
        K_s, D_s = support.matrices(0.0)
        stiffness, damping = stiffness + U.T @ K_s @ U, damping + U.T @ D_s @ U
    x = np.linalg.solve(stiffness + 1j * omega * damping - omega**2 * inv.M, load(rotor))
    return rotor.interfaces["rim"].motion @ x


def wrench(place, *values):
    return lambda rotor: rotor.interfaces[place].motion.T @ np.array(values)


LOADS = {
    "force": (HarmonicForce("rim", (1.0, 0.0)), wrench("rim", 1.0, 0, 0, 0, 0, 0)),
    "torque": (HarmonicForce("left", moment=(0, 0, 1.0)), wrench("left", 0, 0, 0, 0, 0, 1.0)),
    "ground along n1": (BaseAcceleration((1.0, 0.0)), lambda r: -r.invariants.S[0]),
    "ground along n2": (BaseAcceleration((0.0, 1.0)), lambda r: -r.invariants.S[1]),
}


@pytest.mark.parametrize("omega", [1.0, 190.0])
@pytest.mark.parametrize("load", LOADS)
@pytest.mark.parametrize("torsion", [0.0, 40.0])
def test_a_spin_at_rest_is_a_coordinate_as_any(load, omega, torsion):
    rotor, (given, pulled) = eccentric(), LOADS[load]
    supports = [Support(name, 1e6 * np.eye(3), tilt_stiffness=np.diag([0.0, 0.0, torsion]))
                for name in ENDS]  # fmt: skip
    response = harmonic_response(rotor, [omega], given, supports=supports, at="rim")
    expected = by_hand(rotor, supports, omega, pulled)
    assert np.abs(response.motion[0, 0, 0] - expected).max() <= 1e-9 * np.abs(expected).max()


@pytest.mark.parametrize("omega", [50.0, 180.0, 230.0])
def test_a_free_spin_at_speed_follows_moments_about_the_axis(omega):
    """``Θ φ̈ = r cos(Ωt + α) cos(ωt)`` of a force fixed in space at the rim, in the mean.

    The rim moves with the spin as ``r φ``; what eccentricity adds is ``m e²/Θ`` of it.
    """
    speed, rotor = 200.0, eccentric(mass=1e-9)
    supports = [Support(name, 1e9 * np.eye(3)) for name in ENDS]
    force = HarmonicForce("rim", (1.0, 0.0))
    given = {"speed": speed, "supports": supports, "at": "rim", "frame": "rotor"}
    found = harmonic_response(rotor, [omega], force, **given)
    inertia = 4.0 * 0.06**2
    for order in (-1, 1):
        # R(−θ) e1 along n2 of the rotor at the rim's node, which lies along n1: −sin θ
        rate = omega + order * speed
        moment = 0.06 * (0.5j if order == 1 else -0.5j)
        spin = moment / (-(rate**2) * inertia)
        assert found.phasor("rim", "n2", order)[0] == pytest.approx(0.06 * spin, rel=5e-3)


# ------------------------------------------------------------------ harmonics of one frequency

UNEVEN = held(np.diag([K, 2 * K]), np.diag([C, 3 * C]))


def test_weight_of_a_shaft_on_uneven_supports_is_whole():
    """Of a rotor on supports that turn with it: harmonics 0, ±2 in its axes, at ω = 0 two pairs."""
    turning = [Support("mid", np.diag([K, 2 * K]), 0.0, TILT_K, TILT_C, frame="rotor")]
    weight = BaseAcceleration((0.0, 9.81))
    given = {"speed": 90.0, "supports": turning, "at": "mid"}
    response = harmonic_response(rings(), [0.0, 1e-7], weight, **given)
    assert not np.any(response.motion[0, :, response.orders < 0])
    time = np.linspace(0.0, 0.1, 23)

    def moved(row):
        rates = response.frequencies[row] + response.orders * 90.0
        return (
            (response.motion[row, 0, :, :2] * np.exp(1j * np.outer(time, rates))[..., None])
            .sum(axis=1)
            .real
        )

    np.testing.assert_allclose(moved(0), moved(1), rtol=0.0, atol=1e-6 * np.abs(moved(0)).max())


def test_a_constant_force_in_the_rotor_is_an_unbalance():
    speed = 250.0
    force = HarmonicForce("mid", (2.0, 0.0), frame="rotor")
    for supports in (held(), UNEVEN):
        given = {"supports": supports, "at": "mid"}
        found = harmonic_response(rings(), [0.0], force, speed=speed, **given)
        other = unbalance_response(
            rings(), [speed], Unbalance("mid", 2.0 / speed**2), own=False, **given
        )
        assert found.main_order == 1
        assert close(found.phasor("mid", "n1", 1), other.phasor("mid", "n1", 1), 1e-9)
        assert close(found.semi_axes()[0], other.semi_axes()[0], 1e-9)


@pytest.mark.parametrize("speed", [120.0, -120.0])
@pytest.mark.parametrize("share", [0.5, 1.0, 1.5])
def test_meeting_harmonics_are_one_motion(speed, share):
    """Beside 2ω/Ω = n two harmonics beat slowly; there they are one, with a positive rate."""
    turning = [Support("mid", np.diag([K, 2 * K]), 50.0, TILT_K, TILT_C, frame="rotor"),
               Support("left", np.diag([K, 3 * K]), 10.0)]  # fmt: skip
    omega = abs(speed) * share
    force = HarmonicForce("mid", (1.0, 0.3))
    given = {"speed": speed, "supports": turning, "at": "mid", "accuracy": None}
    response = harmonic_response(rings(), [omega, omega * (1 + 1e-7)], force, **given)
    rates = omega + response.orders * speed
    assert not np.any(response.motion[0, :, rates < -1e-9])
    time = np.linspace(0.0, 0.1, 23)
    both = []
    for row in (0, 1):
        rate = response.frequencies[row] + response.orders * speed
        waves = np.exp(1j * np.outer(time, rate))[..., None]
        both.append((waves * response.motion[row, 0, :, :2]).sum(axis=1).real)
    np.testing.assert_allclose(*both, rtol=0.0, atol=1e-4 * np.abs(both[0]).max())


def test_a_free_shift_along_the_axis_does_not_hinder_a_constant_load():
    point = SolidRotor.from_matrices(np.eye(3), np.zeros((3, 3)), [[0, 0, 0]], "z")
    rotor = point.with_interface("at", [0])
    given = {"supports": [Support("at", 1e4, 1.0)]}
    for at in ("at", 0):
        found = harmonic_response(rotor, [0.0, 1.0], HarmonicForce(at, (1.0, 0.0)), **given)
        assert found.phasor()[0] == pytest.approx(1e-4)
    with pytest.warns(UserWarning, match="at 0 rad/s, NaN there: a constant load"):
        along = harmonic_response(rotor, [0.0, 10.0], HarmonicForce("at", (0, 0, 1.0)), **given)
    assert np.isnan(along.phasor("at", "e")[0])
    assert along.phasor("at", "e")[1] == pytest.approx(-0.01)
    with pytest.raises(ValueError, match="at 0 rad/s: a constant load acts on a motion"):
        harmonic_response(rotor, [0.0], HarmonicForce("at", (0, 0, 1.0)), **given)
