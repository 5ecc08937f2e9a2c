"""Annular seal: coefficients against the perturbed bulk flow, and in a scene."""

from dataclasses import replace
from unittest.mock import patch

import exudyn as exu
import numpy as np
import pytest
from test_supports_in_scenes import SPEED, rings

import exudyn_rotor as er

WATER = {"pressure_drop": 1.2e6, "density": 1000.0, "viscosity": 1e-3}
SIZE = {"radius": 0.1, "length": 0.05, "clearance": 3e-4}


def seal(**changes):
    return er.AnnularSeal(interface="left", **(SIZE | WATER | changes))


def mean_pressure(s, sigma, xi):
    """Return the mean pressure by a gap that narrows by ε e^{st}, per ε, over ρV²; L/V = 1.

    Continuity: w_1 = a + s z. Momentum: −p' = s w_1 + w_1' + σ(2 w_1 + 1); at the inlet
    p = −(1 + ξ) a, at the exit zero; integrated over z by hand.
    """
    a = -(0.5 * s**2 + s + sigma * (s + 1.0)) / (1.0 + xi + s + 2.0 * sigma)
    drop = 0.5 * s * a + s**2 / 6.0 + 0.5 * s + sigma * (a + s / 3.0 + 0.5)
    return -(1.0 + xi) * a - drop


@pytest.mark.parametrize("xi", [0.0, 0.1, 0.5])
@pytest.mark.parametrize("length", [0.02, 0.08])
def test_coefficients_are_those_of_the_perturbed_bulk_flow(xi, length):
    """Taylor's coefficients by Cauchy's integral, in axes that turn at half of the speed."""
    one = seal(inlet_loss=xi, length=length)
    velocity = one.axial_velocity(SPEED)
    reynolds = np.array([2.0 * velocity, one.radius * SPEED]) * one.clearance * 1e6
    friction = 0.079 / reynolds[0] ** 0.25
    friction *= (1.0 + (7.0 * reynolds[1] / (8.0 * reynolds[0])) ** 2) ** 0.375
    sigma = friction * length / one.clearance
    drop = 0.5 * 1000.0 * velocity**2 * (1.0 + xi + 2.0 * sigma)
    assert drop == pytest.approx(1.2e6, rel=1e-12)
    circle = 0.05 * np.exp(2j * np.pi * np.arange(64) / 64)
    taylor = np.fft.fft(mean_pressure(circle, sigma, xi))[:3].real / 64 / 0.05 ** np.arange(3)
    size = np.pi * one.radius * length / one.clearance * 1000.0 * velocity**2
    k, d, m = size * taylor * (length / velocity) ** np.arange(3)
    K, D = one.coefficients(SPEED)
    assert one.added_mass(SPEED) == pytest.approx(m, rel=1e-9)
    # (d/dt − iΩ/2) z: of a whirl that turns with the leakage only k is left
    whirl = np.array([1.0, -1.0j])
    force = (K + 0.5j * SPEED * D - 0.25 * SPEED**2 * m * np.eye(2)) @ whirl
    np.testing.assert_allclose(force, k * whirl, rtol=1e-9)
    np.testing.assert_allclose(np.diag(K), k - 0.25 * SPEED**2 * m, rtol=1e-9)
    np.testing.assert_allclose(np.diag(D), d, rtol=1e-9)
    np.testing.assert_allclose(K[0, 1], 0.5 * SPEED * d, rtol=1e-9)


def test_slow_leakage_of_a_long_and_narrow_gap():
    """Friction by the journal's turn alone: λ = 0.079 (7/16 RΩ)^{3/4} (2 ρc/η)^{−1/4}/V."""
    with pytest.warns(UserWarning, match="may be laminar"):
        one = seal(length=0.5, clearance=1e-6, viscosity=1e-3)
    friction = 0.079 * (7.0 / 16.0 * one.radius * SPEED) ** 0.75 * (2e6 * 1e-6) ** -0.25
    velocity = 1.2e6 / (1000.0 * friction * 0.5 / 1e-6)  # Δp = ρ V² σ
    assert one.axial_velocity(SPEED) == pytest.approx(velocity, rel=1e-3)


def test_without_friction_nothing_centres_and_a_seal_carries_no_load():
    smooth = seal(viscosity=1e-12)
    assert smooth.coefficients(0.0)[0][0, 0] < 0.1 * seal().coefficients(0.0)[0][0, 0]
    assert smooth.axial_velocity(0.0) == pytest.approx(np.sqrt(2.0 * 1200.0 / 1.1), rel=0.01)
    np.testing.assert_array_equal(seal().equilibrium(10.0, [0.0, -100.0]), [0.0, 0.0])


def test_inertia_of_a_fluid_is_that_of_a_mass_in_scenes_and_lists():
    """A rigid rotor between two springs k, with m at both: ω² = 2 k/(M + 2 m)."""
    reduced, k, m = rings(heavy=0.0, modes=0), 1e6, 3.0
    supports = [er.Support(name, k, mass=m) for name in ("left", "right")]
    expected = np.sqrt(2.0 * k / (reduced.invariants.mass + 2.0 * m))
    found = er.campbell(reduced, [0.0], supports=supports, accuracy=None).frequencies_rotor
    assert np.abs(found - expected).min() < 1e-9 * expected
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, reduced, spin=0.0, initial_velocity=[0.1, 0.0, 0.0])
    er.add_supports(body, supports)
    mbs.Assemble()
    settings = er.recommended_settings(end_time=0.5 * np.pi / expected, step=0.005 / expected)
    settings.solution.file.write = False
    mbs.SolveDynamic(settings)
    amplitude = 0.1 / expected
    assert body.coordinates()[0][0] == pytest.approx(amplitude, rel=1e-4)


def test_the_leakage_is_found_once_for_a_speed():
    with patch.object(er.AnnularSeal, "axial_velocity", return_value=10.0) as find:
        one = seal()
        for law in (one.added_mass, one.coefficients, lambda speed: one.law(*5 * [0.0], speed)):
            law(SPEED)
    assert find.call_count == 2  # and once at rest, for the Reynolds number


@pytest.mark.parametrize("spin", [{"spin": SPEED}, {}], ids=["prescribed", "free"])
def test_whirl_in_a_seal_is_that_of_the_theory(spin):
    """Of a rigid rotor in two seals: M λ² + 2 [k + d (λ − iΩ/2) + m (λ − iΩ/2)²] = 0."""
    reduced = rings(heavy=0.0, modes=0)
    seals = [seal(), replace(seal(), interface="right")]
    k, d, m = seals[0]._terms(SPEED)
    half, mass = 0.5j * SPEED, reduced.invariants.mass
    polynomial = [mass + 2 * m, 2 * (d - 2 * m * half), 2 * (k - d * half + m * half**2)]
    expected = np.roots(polynomial)
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, reduced, **spin)
    er.add_supports(body, seals)
    mbs.Assemble()
    for model in (er.linear_model(reduced, supports=seals), er.linear_model(mbs, body=body)):
        system = model.at(SPEED)
        M, D, K = system.matrices()
        A = np.block([[0 * M, np.eye(len(M))], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
        exponents = np.linalg.eigvals(A) + 1j * SPEED * model.turns
        for each in expected:
            assert np.abs(exponents - each).min() < 1e-8 * abs(each)
