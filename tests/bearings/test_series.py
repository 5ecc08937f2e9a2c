"""Bearings in series, against the ring as a body; floating rings, against closed forms."""

import exudyn as exu
import numpy as np
import pytest
from test_tables import rotor

from exudyn_rotor import (
    FloatingRingBearing,
    Foundation,
    HarmonicForce,
    SeriesSupport,
    ShortJournalBearing,
    SolidRotor,
    Support,
    add_rotor,
    add_supports,
    campbell,
    critical_speeds,
    harmonic_response,
    linear_model,
    stability,
    stability_threshold,
)

NAMES = ("left", "right")
INNER = [[2e7, 1e6], [-1e6, 3e7]], [[2e3, 0.0], [0.0, 1e3]]
OUTER = [[6e6, 0.0], [0.0, 4e6]], 500.0
RING = 0.8


def in_series():
    return [
        SeriesSupport(interface=n, inner=Support(n, *INNER), mass=RING, outer=Support(n, *OUTER))
        for n in NAMES
    ]


def on_bodies():
    """The same, its rings as two points of a foundation."""
    points = {n: np.eye(4)[2 * i : 2 * i + 2] for i, n in enumerate(NAMES)}
    points = {n: np.vstack([X, np.zeros((1, 4))]) for n, X in points.items()}
    K, D = np.kron(np.eye(2), OUTER[0]), OUTER[1] * np.eye(4)
    block = Foundation(RING * np.eye(4), D, K, points)
    supports = [Support(n, *INNER) for n in NAMES]
    return linear_model(rotor(), supports=supports, foundation=block)


def test_a_ring_is_a_body_between_two_supports():
    model = linear_model(rotor(), supports=in_series())
    for analysis in (
        lambda m: np.sort_complex(
            (lambda c: c.growth + 1j * c.frequencies_inertial)(campbell(m, [300.0], accuracy=None))[
                0
            ]
        ),
        lambda m: critical_speeds(m, accuracy=None).speeds,
        lambda m: harmonic_response(
            m, [100.0, 900.0, 2500.0], HarmonicForce("left", (1.0, 0.0)), speed=300.0
        ).phasor("left", "n2"),
    ):
        assert analysis(model) == pytest.approx(analysis(on_bodies()), rel=1e-6, abs=1e-12)


def floating(load=None, name="left", **changes):
    inner = {"radius": 0.005, "length": 0.008, "clearance": 2e-5, "viscosity": 0.01}
    outer = {"radius": 0.008, "length": 0.008, "clearance": 4e-5, "viscosity": 0.012} | changes
    films = (ShortJournalBearing(interface=name, **each) for each in (inner, outer))
    inner, outer = films
    return FloatingRingBearing(interface=name, inner=inner, outer=outer, mass=0.01, load=load)


@pytest.mark.parametrize("speed", [1e3, -1e3])
@pytest.mark.parametrize("clearance", [2e-5, 4e-5, 1e-4])
def test_speed_of_a_ring_is_that_of_shaw_and_nussdorfer(clearance, speed):
    """1/(1 + (c₁/c₂)(R₂/R₁)³(L₂/L₁)(μ₂/μ₁)) in the middle; NACA Report 866 (1947)."""
    ratio = 1.0 / (1.0 + 2e-5 / clearance * (8.0 / 5.0) ** 3 * (6.0 / 8.0) * (12.0 / 10.0))
    found = floating(clearance=clearance, length=0.006).ring(speed)
    assert found.speed / speed == pytest.approx(ratio, rel=1e-9)


def test_a_loaded_ring_is_in_balance_and_loads_are_carried():
    made, speed = floating(load=[3.0, -20.0]), 3e3
    ring = made.ring(speed)
    torque = made._torque(speed, ring.speed)
    assert abs(torque) < 1e-9 * made._torque(speed, 0.9 * ring.speed)
    ratios = [film.eccentricity_ratio(*each, made.load) for film, *each in made.films(speed)]
    assert ratios == pytest.approx([ring.inner_ratio, ring.outer_ratio])
    # the films' friction: what drives the journal less what the ring takes is heat, above zero
    assert 0.0 < ring.speed < speed


def test_films_in_the_middle_whirl_with_the_means_of_their_surfaces():
    """Without a load, K = D·i·(mean speed): each film alone drives a whirl of its mean speed.

    As turbochargers whirl: B. Schweizer, Nonlinear Dynamics 57 (2009) 509.
    """
    made, speed = floating(), 2e3
    ring = made.ring(speed).speed
    linear = made.linearised()
    for support, mean in ((linear.inner, 0.5 * (speed + ring)), (linear.outer, 0.5 * ring)):
        K, D = (X[:2, :2] for X in support.matrices(speed))
        assert np.array([[0.0, 1.0], [-1.0, 0.0]]) * D[0, 0] * mean == pytest.approx(K, rel=1e-9)


def test_series_of_two_films_is_stable_where_the_eliminated_ring_says():
    """A massless journal on both films and a ring of mass: roots of the quadratic in z = x + iy."""
    made, speed = floating(), 2e3
    ring, linear = made.ring(speed).speed, made.linearised()
    d, e = (one.matrices(speed)[1][0, 0] for one in (linear.inner, linear.outer))
    a, b, m, M = 0.5 * (speed + ring), 0.5 * ring, made.mass, 2.0
    # M s² x + d (s − i a)(x − r) = 0,  m s² r + e (s − i b) r = d (s − i a)(x − r)
    inner, outer = np.array([d, -1j * a * d]), np.array([e, -1j * b * e])
    whole = (
        np.polyadd(np.array([M, 0, 0]), inner),
        np.polyadd(np.array([m, 0, 0]), np.polyadd(inner, outer)),
    )
    roots = np.roots(np.polysub(np.polymul(*whole), np.polymul(inner, inner)))
    roots = roots[np.abs(roots) > 1e-6]
    found = stability(rotor(), [speed], supports=[floating(name=n) for n in NAMES], accuracy=None)
    assert np.nanmax(found.growth) == pytest.approx(roots.real.max(), rel=1e-6)


@pytest.mark.parametrize(("clearance", "inner", "outer"), [(2e-5, 0.5, 0.5), (5e-5, 0.0, 0.5)])
def test_at_the_limit_of_stability_one_film_whirls_with_half_the_speed(clearance, inner, outer):
    """About half the ring's speed, or half of the ring's and the journal's, by the parameters.

    A. Boyaci, W. Seemann, C. Proppe, PAMM 7 (2007) 4050005.
    """
    supports = [floating(load=[0.0, -10.0], name=name, clearance=clearance) for name in NAMES]
    limit = stability_threshold(rotor(), 200.0, 4000.0, supports=supports, accuracy=None)
    [speed], [whirl] = limit.values, limit.frequencies_inertial
    expected = inner * speed + outer * supports[0].ring(speed).speed
    assert limit.onset.tolist() == [True]
    assert whirl == pytest.approx(expected, rel=0.1)


def test_scenes_ask_for_the_ring_as_a_body():
    body = add_rotor(exu.SystemContainer().AddSystem(), rotor().reduce(0), spin=50.0)
    with pytest.raises(ValueError, match="has a ring, which is a body"):
        add_supports(body, in_series())


def solid_ring(mass, radius):
    """A stiff ring of eight masses in two planes."""
    angles = np.repeat(0.5 * np.pi * np.arange(4), 2)
    heights = 0.004 * (-1.0) ** np.arange(8)
    nodes = np.column_stack([radius * np.cos(angles), radius * np.sin(angles), heights])
    K = np.zeros((24, 24))
    for i, j in zip(*np.triu_indices(8, 1), strict=True):
        d = np.zeros((8, 3))
        d[i] = (nodes[i] - nodes[j]) / np.linalg.norm(nodes[i] - nodes[j])
        d[j] = -d[i]
        K += 1e9 * np.outer(d, d)
    made = SolidRotor.from_matrices(mass / 8.0 * np.eye(24), K, nodes, "z")
    return made.with_interface("left", range(8)).reduce(0)


def test_films_take_a_ring_along_in_a_scene():
    """As a rotor of its own between two films: its angular momentum grows by their torque."""
    made, speed, start, mass, radius, end = floating(), 2e3, 8e2, 0.01, 0.0065, 2e-4
    mbs = exu.SystemContainer().AddSystem()
    shaft, ring = (
        add_rotor(mbs, solid_ring(m, r), name=name, spin="free", initial_speed=first)
        for name, m, r, first in (
            ("shaft", 0.2, 0.5, speed),
            ("ring", mass, radius, start),
        )
    )
    add_supports(ring, made.outer)
    add_supports(shaft, made.inner, base=ring.marker("left"))
    spin = ring.add_spin_sensor()
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 10, end
    settings.timeIntegration.verboseMode = 0
    mbs.SolveDynamic(settings)
    grown = mbs.GetSensorValues(spin)[-1] - start
    rate = made._torque(speed, start) / (mass * radius**2)
    assert grown == pytest.approx(rate * end, rel=5e-3)  # which falls by the decay in this time
