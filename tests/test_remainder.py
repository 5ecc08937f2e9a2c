"""Exponents are held to the equations: closed forms, and known exponents of any stiffness."""

from dataclasses import replace
from unittest import mock

import numpy as np
import pytest
from asymmetric import asymmetric_shaft
from hypothesis import given, settings
from hypothesis import strategies as st
from models import disc_with_craig_bampton_modes
from scipy.special import mathieu_a, mathieu_b
from test_stability import anisotropic, mathieu
from transformed import transformed

from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.modal.campbell import campbell
from exudyn_rotor.linear.models.linear_model import linear_model
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.periodic import floquet_modes as modes_module
from exudyn_rotor.linear.periodic import fundamental, hill
from exudyn_rotor.linear.periodic.exponents import motions
from exudyn_rotor.linear.periodic.floquet_modes import floquet_modes, gone
from exudyn_rotor.linear.periodic.fundamental import floquet_motions
from exudyn_rotor.linear.periodic.hill_motions import HillMotions
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, UnconvergedError, fold
from exudyn_rotor.linear.periodic.remainder import _fastest, _Remainder, checked
from exudyn_rotor.linear.stability.growth import growth_of
from exudyn_rotor.solid_rotor import SolidRotor


def swelling(a: float, stiffness: float) -> PeriodicSystem:
    """Return the equation of ``x = y exp(a sin 2t)`` with ``ÿ + 0.3ẏ + stiffness y = 0``."""
    one = np.eye(1)
    return transformed(2.0, 0.3 * one, stiffness * one, {0: one}, swell=a)[0]


@pytest.mark.parametrize("stiffness", [40.0, -2.0])
@pytest.mark.parametrize("a", [5.0, 10.0, 20.0, 30.0])
def test_exponents_of_motions_that_swell_within_a_turn(a, stiffness):
    """By up to e⁶⁰, at which Hill's method alone takes stable ones for unstable."""
    system, exact = swelling(a, stiffness), np.roots([1.0, 0.3, stiffness]).astype(complex)
    found = motions(system)
    apart = np.abs(fold(found.values[:, None] - exact, system.base))
    assert np.all(apart.min(axis=1) <= 2.0 * found.bounds + 1e-8)
    if a >= 20.0:
        with pytest.raises(UnconvergedError, match=r"may be off by.*, or method='floquet'"):
            motions(system, "hill")
    else:
        assert np.array_equal(motions(system, "hill").values, found.values)


def test_modes_that_are_not_determined_are_refused():
    """What calls for them has no `method`; exponents alone are found, as above."""
    with pytest.raises(UnconvergedError, match=r"may be off by.*, or stability\(…\)") as refused:
        floquet_modes(swelling(20.0, 40.0))
    assert "method" not in str(refused.value).replace("Hill's method", "")


def test_where_no_method_gets_through_none_is_named(monkeypatch):
    monkeypatch.setattr("exudyn_rotor.linear.periodic.fundamental.MOST_STEPS", 8)
    with pytest.raises(UnconvergedError, match=r"within a turn; use a larger speed \(or 0\)$"):
        motions(swelling(20.0, 40.0))


def far_from_resonance(speed: float) -> PeriodicSystem:
    """Return ``ẍ + 0.1 ẋ + (4e3 cos 2θ − 1.35e5) x = 0``, at low speed without any oscillation.

    With λ² + 0.1λ = 1.35e5 ± 4e3 motions grow with 361.8 to 372.8 1/s at any angle.
    """
    one = np.eye(1)
    return PeriodicSystem(
        speed, {0: one}, {0: 0.1 * one}, {0: -1.35e5 * one, 2: 2e3 * one, -2: 2e3 * one}
    )


@pytest.mark.parametrize("speed", [0.05, 0.1, 0.2])
def test_growth_is_not_lost_at_low_speed(speed):
    """Hill's method alone finds two motions that decay with 364 1/s, at 0.05 rad/s."""
    system = far_from_resonance(speed)
    try:
        found = motions(system)
    except UnconvergedError:
        return
    assert 361.0 < growth_of(found, system).excess < 373.0


def test_growth_at_low_speed_is_that_of_a_frozen_angle():
    """Mean of √(1.35e5 − 4e3 cos 2θ) − 0.05 over a period, to second order in Ω over λ."""
    angles = np.pi * np.arange(64) / 64
    expected = np.mean(np.sqrt(1.35e5 + 0.0025 - 4e3 * np.cos(2.0 * angles))) - 0.05
    found = motions(far_from_resonance(0.5)).values.real.max()
    assert found == pytest.approx(expected, rel=1e-7)


@st.composite
def transformed_systems(draw) -> tuple[PeriodicSystem, np.ndarray, float]:
    """Return equations with known exponents, which swell and stretch, and the speed."""
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    size, speed = draw(st.integers(1, 3)), 10.0 ** draw(st.floats(-1.0, 3.0))
    rates = speed * 10.0 ** rng.uniform(-1.0, draw(st.sampled_from([0.5, 1.0, 1.7])), size)
    loss = draw(st.sampled_from([0.0, 1e-4, 1e-2, 1.0, 30.0]))
    skew = speed * rng.normal(size=(size, size)) * draw(st.sampled_from([0.0, 1.0]))
    damping = np.diag(2.0 * loss * rates) + skew - skew.T
    damping -= draw(st.sampled_from([0.0, 0.02])) * speed * np.diag(rng.uniform(size=size))
    signs = np.where(rng.uniform(size=size) < 0.1, -1.0, 1.0)
    mixed = np.eye(size) + 0.3 * rng.normal(size=(size, size))
    damping, stiffness = (
        np.linalg.solve(mixed, X @ mixed) for X in (damping, np.diag(signs * rates**2))
    )
    shears = {
        n: 10.0 ** rng.uniform(-3.0, 0.0) * rng.normal(size=(size, size)) * (1.0 - 0.5j)
        for n in rng.choice([1, 2, 3, 4], 2, replace=False)
    }
    swell = draw(st.sampled_from([0.0, 0.0, 0.5, 3.0, 8.0, 15.0, 25.0]))
    system, exact = transformed(speed, damping, stiffness, shears, swell, draw(st.integers(0, 2)))
    return system, exact, speed


@settings(max_examples=20, deadline=None, derandomize=True)
@given(transformed_systems())
def test_verdicts_are_right_or_refused(given):
    """Those of ``y`` with constant coefficients, by Hill's and by Floquet's method.

    The equations are rounded to 1e-14 of their largest entry, and exponents with them.
    """
    system, exact, speed = given
    if system.step == 0:
        return
    with mock.patch.object(hill, "MOST_UNKNOWNS", 150):  # what needs more is refused in less time
        _compare(system, exact, speed)


def _compare(system: PeriodicSystem, exact: np.ndarray, speed: float) -> None:
    largest = max(np.abs(X).max() for X in (*system.K.values(), *system.D.values()))
    rounding = 1e-11 * max(largest / speed, speed)
    for method in ("hill", "floquet"):
        try:
            found = motions(system, method)
        except UnconvergedError:
            continue
        growth = exact.real.max()
        if abs(growth) > 1e-6 * speed + rounding + np.median(found.bounds):
            assert (growth_of(found, system).excess > 0.0) == (growth > 0.0)
        if method == "hill":
            slow = ~gone(found.values, speed)
            apart = np.abs(fold(found.values[slow, None] - exact, speed)).min(axis=1)
            told = 1e-8 * np.maximum(-found.values.real, speed) + 10.0 * found.bounds + rounding
            assert np.all(apart <= told[slow])


def all_motions(system: PeriodicSystem) -> HillMotions:
    found = motions(system, "hill", 1e-12)
    one, none = np.ones(len(found.values)), np.zeros(len(found.values))
    each = np.maximum(found.bounds, 1e-12)
    return HillMotions(
        found.values, found.vectors, found.orders, one, 0.0, each, none, {}, none > 0.0
    )


@pytest.mark.parametrize("wrong", ["value", "twice"])
def test_a_motion_that_is_wrong_is_seen(wrong):
    """λ off by 1e-5 where it is told to 1e-8; one motion twice, and another one not at all."""
    system, _ = transformed(
        3.0, np.diag([0.2, 0.4]), np.diag([20.0, 70.0]), {2: np.full((2, 2), 0.3)}, 0.3
    )
    right = all_motions(system)
    values, shapes = right.values.copy(), right.shapes.copy()
    decays = np.zeros(4, dtype=bool)
    checked(system, right, decays, 1e-8)
    if wrong == "value":
        values[1] += 1e-5
    else:
        values[1], shapes[..., 1] = values[0], shapes[..., 0]
    found = replace(right, values=values, shapes=shapes)
    with pytest.raises(UnconvergedError, match="may be off by"):
        checked(system, found, decays, 1e-8)


@pytest.mark.parametrize("order", [1, 2])
def test_mathieu_at_the_edges_of_instability(order):
    """Beside a_n(q) and b_n(q), by 1e-6, one verdict each (McLachlan 1947)."""
    low, high = sorted((mathieu_a(order, 1.0), mathieu_b(order, 1.0)))
    for value, unstable in ((low - 1e-6, 0), (low + 1e-6, 1), (high - 1e-6, 1), (high + 1e-6, 0)):
        system = mathieu(value, 1.0)
        assert (growth_of(motions(system, "hill"), system).excess > 0.0) == unstable


def test_meissner_square_wave_by_its_fourier_terms():
    """``x″ + (a ± b) x``, Σ of 31 terms: growth of the piecewise solution (Meissner 1918).

    Terms left out change λ by their squares over n², less than 1e-3 of it here.
    """
    a, b, one = 1.0, 0.5, np.eye(1)
    halves = []
    for square in (a + b, a - b):
        w, t = np.sqrt(square), 0.5 * np.pi
        halves.append([[np.cos(w * t), np.sin(w * t) / w], [-w * np.sin(w * t), np.cos(w * t)]])
    exact = np.log(np.abs(np.linalg.eigvals(np.array(halves[1]) @ halves[0]))).max() / np.pi
    stiffness = {0: a * one}
    for n in range(1, 32, 2):
        stiffness |= {2 * n: -2j * b / (np.pi * n) * one, -2 * n: 2j * b / (np.pi * n) * one}
    system = PeriodicSystem(1.0, {0: one}, {0: 0.0 * one}, stiffness)
    for method in ("hill", "floquet"):
        assert motions(system, method).values.real.max() == pytest.approx(exact, rel=1e-3)


def test_two_motions_that_turn_half_a_period_are_both_found():
    """On stiff dampers, seen from outside: overdamped tilts at −92.27 and −92.18 1/s."""
    reduced = disc_with_craig_bampton_modes()
    uneven = 1e8 * np.array([[1.0, 0.3], [-0.2, 2.0]]), 1e6 * np.diag([1.0, 3.0])
    system = LinearRotor.of(reduced, [Support(name, *uneven) for name in ("left", "right")]).at(
        100.0
    )
    values = motions(system, "hill").values
    slow = np.sort(values.real[np.abs(np.abs(values.imag) - 100.0) < 1.0])
    assert len(slow) == 4
    assert np.diff(slow).min() > 1e-2


@pytest.mark.parametrize("speed", [30.0, 50.0])
def test_modes_by_floquets_method_where_hills_fails(speed, monkeypatch):
    system = LinearRotor.of(asymmetric_shaft(), anisotropic()).at(speed)
    expected = floquet_modes(system)

    def refused(*_):
        raise UnconvergedError("refused")

    monkeypatch.setattr(modes_module, "solve_hill", refused)
    found = floquet_modes(system)
    assert np.abs(found.values - expected.values).max() < 1e-6 * speed
    for j in range(len(found.values)):
        one, other = (X.central[:, j] / np.linalg.norm(X.central[:, j]) for X in (found, expected))
        apart = np.abs(np.delete(expected.values, j) - expected.values[j]).min()
        if apart > 1e-3 * speed:
            assert abs(np.vdot(one, other)) > 1.0 - 1e-6


def test_a_free_motion_beside_a_frequency_that_is_a_multiple_of_the_base():
    """Two masses on a rod: free and 1e4 rad/s along the axis, which is 100 times 2Ω."""
    rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, [[0, 0, -0.1], [0, 0, 0.1]], "z")
    rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    supports = [Support(n, np.diag([2e4, 3e4]), 10.0) for n in ("left", "right")]
    told = campbell(rotor, [50.0], supports=supports)
    across = told.growth[0] < -1.0
    exact = np.sqrt(np.array([2e4, 3e4]) / 2.0 - 2.5**2)
    assert np.allclose(told.growth[0, across], -2.5, rtol=1e-9)
    frequencies = np.abs(told.frequencies_inertial[0, across])
    assert np.allclose(np.unique(frequencies.round(6)), exact, rtol=1e-8)


def test_growth_that_rounding_hides_is_refused(monkeypatch):
    """A multiplier of 0.9 beside a fundamental matrix of 1e12: 1.1 could be in its place."""
    matrix = np.array([[0.9, 1e12], [0.0, 0.8]])
    monkeypatch.setattr(fundamental, "monodromy", lambda *_: (matrix, 8, 1e3))
    with pytest.raises(UnconvergedError, match="not told whether"):
        floquet_motions(mathieu(2.0, 1.0))
    monkeypatch.setattr(fundamental, "monodromy", lambda *_: (np.diag([0.9, 0.8]), 8, 1e-9))
    assert np.all(floquet_motions(mathieu(2.0, 1.0))[0].real < 0.0)


@pytest.mark.parametrize("size", [1e-2, 1e-3])
def test_a_change_of_coordinates_leaves_the_square(size):
    """Of a rest F with any harmonics: terms of F G, with divisors of 0.4 and more."""
    rng = np.random.default_rng(1)
    angles = 2.0 * np.pi * np.arange(33) / 33
    terms = rng.normal(size=(3, 3, 3)) + 1j * rng.normal(size=(3, 3, 3))
    F = size * sum(np.exp(1j * n * angles)[:, None, None] * X for n, X in enumerate(terms, -1))
    values, one = np.array([-0.1 + 0.4j, -0.2 - 0.5j, -0.3]), np.ones(3)
    rest = _Remainder(F, values, one, 1.0, 0.0 * one)._smaller()
    np.testing.assert_allclose(rest.shifts, np.diagonal(size * terms[1]), atol=1e-12)
    assert np.abs(rest.F).max() < 300.0 * size**2


def test_frozen_directions_come_back_after_a_period():
    """A plane whose normal goes round a cone turns by ``2π (1 − cos α)``, if it is only carried."""
    angles, cone = 2.0 * np.pi * np.arange(17) / 17, 0.7
    around = np.array([np.cos(angles), np.sin(angles)]) * np.sin(cone)
    normals = np.array([*around, np.full(17, np.cos(cone))]).T
    along = normals[:, :, None] * normals[:, None]
    found = _fastest(-1e3 * (np.eye(3) - along) - along, 2)
    assert np.abs(normals[:, None] @ found).max() < 1e-12
    steps = np.linalg.norm(found - np.roll(found, 1, axis=0), axis=(1, 2))
    assert steps[0] == pytest.approx(steps[1:].mean(), rel=0.05)


def test_entries_of_very_different_sizes_are_weighed_without_a_warning():
    """Factors of balancing beyond 1e18 would overflow; an exact triangle needs no share at all."""
    F = np.triu(np.full((1, 6, 6), 1e-200), 2) + np.triu(np.ones((1, 6, 6)), 4)
    rest = _Remainder(F, np.arange(6.0) + 0j, np.full(6, 1e-3), 1.0, np.zeros(6))
    assert rest.share < 1e-6


def test_more_harmonics_where_the_estimate_of_those_left_out_is_too_small():
    """Two masses on a shaft that is uneven, as all bearings are; against Floquet's method."""
    shaft = np.kron([[1.0, -1.0], [-1.0, 1.0]], np.diag([3039108.0, 3343019.0, 4.33e7]))
    mass = np.kron(np.diag([0.3741, 7.1276]), np.eye(3))
    rotor = SolidRotor.from_matrices(mass, shaft, [[0.0, 0.0, 0.1], [0.0, 0.0, 0.3]], "z")
    rotor = rotor.with_interface("light", [0]).with_interface("heavy", [1])
    supports = [
        Support("light", [[59229.0, 6e4], [-6e4, 5800399.0]], 10.0),
        Support("heavy", [[558734.0, 1e5], [-1e5, 1337696.0]], 10.0),
        Support("heavy", damping=np.diag([20.0, 60.0]), frame="rotor"),
    ]
    model = linear_model(rotor, supports=supports, stiffening="none")
    system = model.space(0, 100.0, held=True).at(100.0)
    exact = motions(system, "floquet", 1e-11).values
    found = fold(floquet_modes(system).values, system.base)
    lateral = np.abs(found.real) > 1e-6  # the axial motion is free of damping
    apart = np.abs(fold(found[lateral, None] - exact, system.base)).min(axis=1)
    assert apart.max() < 1e-5
