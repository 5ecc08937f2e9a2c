"""Structural damping in the frequency domain: one mass, materials, files, scenes."""

import warnings

import exudyn
import numpy as np
import pytest

import exudyn_rotor as er

MASS, K, ETA = 3.0, 1.2e5, 0.04  # critical speed √(K/MASS) = 200 rad/s
OMEGA = np.sqrt(K / MASS)
FREQUENCIES = np.array([20.0, 150.0, OMEGA, 300.0, 700.0])
# rounding of one mass times the condition 1/η of the equations at resonance, times 1e4
EXACT = 1e-10
KINDS = ("full", "reduced")


def one_mass(kind: str = "reduced", **factors: float):
    """Return a mass on an isotropic shaft, Genta's Jeffcott rotor, as each kind of linear model."""
    rotor = er.SolidRotor.from_matrices(
        MASS * np.eye(3), K * np.eye(3), [[0, 0, 0]], "z", interfaces={"disc": [0]}
    )
    rotor = rotor.with_damping(**factors)
    return rotor.reduce(3) if kind == "reduced" else rotor


def model_of(kind: str, supports: tuple[er.Support, ...] = (), **factors: float):
    return er.linear_model(one_mass(kind, **factors), supports=supports)


def close(found, expected, tolerance=EXACT):
    return np.all(np.abs(found - expected) <= tolerance * np.abs(expected))


@pytest.mark.parametrize("kind", KINDS)
def test_one_mass_at_rest(kind):
    """``F/(K √((1 − r²)² + η²))``; Genta, "Dynamics of Rotating Systems" (2005), section 1.5."""
    force = er.HarmonicForce("disc", (6.0, 0.0))
    response = er.harmonic_response(model_of(kind, loss=ETA), FREQUENCIES, force)
    r = FREQUENCIES / OMEGA
    size = 6.0 / (K * np.hypot(1.0 - r**2, ETA))
    assert close(np.abs(response.phasor()), size)
    assert close(response.phasor(), 6.0 / (K * (1.0 - r**2 + 1j * ETA)))  # it lags behind the force


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("speed", [120.0, -120.0, 500.0])
def test_whirl_of_a_turning_rotor(kind, speed):
    """``m z'' + k (1 ± iη) z = F``, Genta (2005), section 4.5: the sign is that of ω − Ω.

    A force along n1 is half a forward and half a backward one. Forward of lower frequency than the
    spin the rotor sees ν < 0, and its damping drives the whirl.
    """
    frequencies = np.sort(np.append(FREQUENCIES, abs(speed)))
    force = er.HarmonicForce("disc", (2.0, 0.0))
    response = er.harmonic_response(model_of(kind, loss=ETA), frequencies, force, speed=speed)
    for whirl, omega in zip(response.whirl(), (frequencies, -frequencies), strict=True):
        stiffness = K * (1.0 + 1j * ETA * np.sign(omega - speed))
        assert close(whirl, 1.0 / (stiffness - MASS * omega**2))


# ------------------------------------------------------------------ materials


# ------------------------------------------------------------------ scenes and analyses in time


def test_analyses_in_time_say_that_they_leave_it_out():
    rotor = one_mass(loss=ETA)
    with pytest.warns(UserWarning, match=r"campbell finds modes without it; .*stiffness=η/ν"):
        found = er.campbell(rotor, [0.0, 50.0])
    np.testing.assert_array_equal(found.growth, er.campbell(one_mass(), [0.0, 50.0]).growth)
    with pytest.warns(UserWarning, match="stability finds exponents without it"):
        er.stability(rotor, [50.0])
    without = pytest.warns(UserWarning, match="stability finds exponents without it")
    with without:
        assert not er.stability_threshold(rotor, 10.0, 20.0).values.size
    with pytest.warns(UserWarning, match="stability finds exponents without it"):
        unstable = er.unstable_ranges(rotor, [10.0, 20.0])
    assert unstable.shape == (0, 2)
    with pytest.warns(UserWarning, match="stability finds exponents without it") as told:
        er.stability_map(lambda x, y: (rotor, y), [0.0, 1.0], [10.0, 20.0])
    assert len(told) == 1
    with pytest.warns(UserWarning, match="A scene runs without it"):
        er.add_rotor(exudyn.SystemContainer().AddSystem(), rotor, spin=40.0, translation="none")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        er.critical_speeds(rotor)  # undamped by definition
        er.campbell(one_mass(), [0.0, 50.0])
