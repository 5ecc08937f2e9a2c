"""Rotors on ground that shakes: closed forms, other steps, stiff supports, films."""

import numpy as np
import pytest
from point_rotors import ring_rotor
from shaken_rotors import ENDS, record, rigid, springs

from exudyn_rotor import (
    BaseAcceleration,
    BaseRecord,
    Support,
    base_response,
    harmonic_response,
    linear_model,
)
from exudyn_rotor.theory.rotating_axes import axes_of


@pytest.mark.parametrize("speed", [0.0, 180.0])
def test_harmonic_ground_from_rest(speed):
    """One mass: u = −A (sin νt − (ν/ω) sin ωt) / (ω² − ν²), whatever the spin."""
    omega, nu = 120.0, 70.0
    shaken = record(lambda t: 2.0 * np.sin(nu * t), 0.3, 2e-4)
    found = base_response(rigid(), shaken, speed=speed, supports=springs(omega), tolerance=1e-7)
    t = found.time
    expected = -2.0 * (np.sin(nu * t) - nu / omega * np.sin(omega * t)) / (omega**2 - nu**2)
    # straight lines between samples: (ν h)² / 12 of the load
    scale = np.abs(expected).max()
    along = axes_of(rigid().axis).T[:, 0]
    np.testing.assert_allclose(
        found.displacement("left"), np.outer(expected, along), rtol=0.0, atol=3e-5 * scale
    )


@pytest.mark.parametrize("omega", [20.0, 100.0, 200.0])
def test_half_sine_shock_spectrum(omega):
    """Residual response of one mass: 2β cos(π/2β) / |1 − β²| of a/ω², β = T/(2τ) > 1.

    Chopra, Dynamics of Structures (2012), Eq. (4.8.4).
    """
    duration, beta = 0.01, np.pi / (0.01 * omega)
    shock = record(lambda t: 40.0 * np.sin(np.pi * t / duration), duration, 5e-5)
    given = {"speed": 300.0, "supports": springs(omega), "at": "right"}
    found = base_response(rigid(), shock, end_time=duration + 7.0 / omega, **given)
    expected = 40.0 / omega**2 * 2.0 * beta * np.cos(np.pi / 2.0 / beta) / (beta**2 - 1.0)
    assert found.peak("right")[0] == pytest.approx(expected, rel=3e-4)


def test_damped_rest_under_a_lasting_acceleration():
    """Half a critical damping, a long step: the mass ends at −a/ω², along the axis, too."""
    step = record(lambda t: np.ones_like(t), 1.0, 0.01, (1.0, 2.0, 3.0))
    found = base_response(rigid(), step, speed=50.0, supports=springs(100.0, 0.5))
    ends = -np.array([1.0, 2.0, 3.0]) @ axes_of(rigid().axis) / 100.0**2
    np.testing.assert_allclose(found.displacement("left")[-1], ends, rtol=1e-6)


@pytest.mark.parametrize("samples", [2, 11])
@pytest.mark.parametrize("speed", [0.0, 5.0, 500.0])
def test_peaks_are_those_of_the_motion_and_not_of_the_record(samples, speed):
    """A sudden acceleration a moves an undamped mass by 2 a/ω² at most, here after 3 ms.

    Lines between the times are within 1 % of the motion, and a peak is between two of them at most.
    """
    omega, times = 1000.0, np.linspace(0.0, 0.05, samples)
    sudden = BaseRecord(times, np.tile([1.0, 0.0, 0.0], (samples, 1)))
    found = base_response(rigid(), sudden, speed=speed, supports=springs(omega))
    assert found.peak("left")[0] == pytest.approx(2.0 / omega**2, rel=0.01)
    assert found.time[-1] == pytest.approx(0.05, abs=2e-3)


def noise(end, step=5e-3):
    t = np.linspace(0.0, end, round(end / step) + 1)
    return BaseRecord(t, np.random.default_rng(1).normal(size=(len(t), 3)))


@pytest.mark.parametrize(
    ("stiffness", "damping"), [((1e8, 3e8), 1e5), ((1e10, 3e10), 1e7), ((1e7, 3e7), 10.0)]
)
def test_what_decays_or_swings_fast_takes_no_short_steps(stiffness, damping):
    """In axes that stand still the equations are constant, and steps exact; else they repeat."""
    supports = [Support(name, np.diag(stiffness), damping) for name in ENDS]
    rotor = ring_rotor(0.1, 0.15, 5.0)
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(6)
    models = (linear_model(rotor, supports=supports, axes=a) for a in ("rotor", "inertial"))
    one, other = (base_response(m, noise(1.0), speed=314.0, at="left") for m in models)
    assert one.time[-1] == pytest.approx(1.0, abs=5e-3)
    assert one.peak("left")[0] == pytest.approx(other.peak("left")[0], rel=0.02)


@pytest.mark.parametrize("speed", [0.0, 0.5, 60.0])
def test_ground_in_steady_motion_ends_in_the_harmonic_response(speed):
    """On uneven supports, from slow spin, a step for each piece of the record, to fast."""
    nu, supports = 80.0, [Support(name, np.diag([4e4, 9e4]), 300.0) for name in ENDS]
    shaken = record(lambda t: np.cos(nu * t), 2.0, 5e-4, (1.0, 0.5, 0.0))
    found = base_response(rigid(), shaken, speed=speed, supports=supports, at="left")
    ground = BaseAcceleration((1.0, 0.5))
    steady = harmonic_response(rigid(), [nu], ground, speed=speed, supports=supports, at="left")
    t = found.time[-200:]
    waves = np.exp(1j * np.outer(t, nu + steady.orders * speed))[..., None]
    expected = (waves * steady.motion[0, 0, :, :2]).sum(axis=1).real
    off = found.displacement("left")[-200:, :2] - expected
    assert np.abs(off).max() < 2e-3 * np.abs(expected).max()
