"""Rotors with the centre of mass off the axis and a free spin: all analyses, all routes.

Their lateral motion is that of a rotor driven at constant speed, and the spin is on its own; what
that leaves out is compared with the closed form of a Jeffcott rotor that nothing drives.
"""

import numpy as np
import pytest
from point_rotors import ring_rotor

from exudyn_rotor import (
    SolidRotor,
    Support,
    campbell,
    critical_speeds,
    harmonic_response,
    stability,
)
from exudyn_rotor.linear.response.loads import HarmonicForce

MASS, RADIUS, ECCENTRICITY = 2.0, 0.1, 0.03
INERTIA = MASS * RADIUS**2  # about the centre of mass, along the axis
STIFFNESS, DAMPING = 2e5, 30.0
CRITICAL = np.sqrt(STIFFNESS / MASS)
SPEEDS = CRITICAL * np.array([0.0, 0.5, 0.97, 1.02, 3.0])
ROUTES = ("reduced", "full")


def ring(eccentricity: float = ECCENTRICITY) -> SolidRotor:
    """Return two rings whose centre is off the axis z."""
    rotor = ring_rotor(RADIUS, 0.1, MASS)
    moved = rotor.nodes + np.array([eccentricity, 0.0, 0.0])
    given = SolidRotor.from_matrices(rotor.mass, rotor.stiffness, moved, "z")
    return given.with_interface("all", range(10))


def on_route(rotor: SolidRotor, route: str):
    """Return the reduced rotor with all of its modes, or the solid one."""
    return rotor.reduce(3 * rotor.node_count - 6) if route == "reduced" else rotor


@pytest.fixture(params=ROUTES)
def route(request):
    return request.param


@pytest.fixture
def rotor():
    """Return the rings, held at a point of the axis."""
    return ring().center_interfaces()


def carrier(axial: float = 0.0) -> list[Support]:
    """Return an isotropic support; along the axis as well where all but the spin is to be held."""
    K, D = np.diag([STIFFNESS, STIFFNESS, axial]), np.diag([DAMPING, DAMPING, 1e-4 * axial])
    return [Support("all", K, D, tilt_stiffness=3e3, tilt_damping=1.0)]


def driven(speed: float) -> np.ndarray:
    """Return both eigenvalues with Im λ ≥ 0 of the lateral motion at constant speed, rotor frame.

    ``m s² + c s + k = 0`` in axes that stand still, seen from the rotor at ``s ± iΩ``.
    """
    values = np.roots([MASS, DAMPING, STIFFNESS])
    values = np.concatenate([values + 1j * speed, values - 1j * speed])
    return values[values.imag >= 0.0]


def distance(found: np.ndarray, expected: np.ndarray) -> float:
    """Return how far the worst of the expected values is from the nearest of those found."""
    return float(np.abs(found[:, None] - expected).min(axis=0).max())


# ------------------------------------------------------------------ against closed forms


@pytest.mark.parametrize("level", ["none", "tilt"])
def test_frequencies_are_those_at_constant_speed(rotor, route, level):
    target = on_route(rotor, route)
    found = campbell(target, SPEEDS, supports=carrier(), modes=8, stiffening=level)
    values = found.growth + 1j * found.frequencies_rotor
    for speed, one in zip(SPEEDS, values, strict=True):
        assert distance(one, driven(speed)) < 1e-6 * CRITICAL


@pytest.mark.parametrize("level", ["none", "tilt"])
def test_exponents_are_those_at_constant_speed(rotor, route, level):
    """Nothing is neutral: the spin is left out on all routes."""
    speeds = SPEEDS[1:]
    target = on_route(rotor, route)
    given = {"supports": carrier(1e5), "stiffening": level}
    found = stability(target, speeds, **given)
    assert np.abs(found.exponents).min() > 1.0
    for speed, one in zip(speeds, found.exponents, strict=True):
        one = np.where(one.imag < 0.0, one.conj(), one)
        assert distance(one, driven(speed)) < 1e-5 * CRITICAL


def test_critical_speed_is_that_at_constant_speed(rotor, route):
    target = on_route(rotor, route)
    found = critical_speeds(target, supports=carrier(), max_speed=2.0 * CRITICAL)
    assert np.abs(found.speeds / CRITICAL - 1.0).min() < 1e-7


# ------------------------------------------------------------------ meshes, flexible


def test_torque_turns_a_free_spin_alone(rotor, route):
    """``Θ φ̈ = T`` about the axis, whatever the unbalance; nothing moves sideways."""
    target = on_route(rotor, route)
    force = HarmonicForce("all", (0.0, 0.0), (0.0, 0.0, 1.0))
    found = harmonic_response(target, [40.0], force, speed=200.0, supports=carrier(1e5))
    motion = found.motion[0, 0]
    # the rings breathe, which adds to the inertia by 4Ω² of their 22 400² 1/s²
    expected = 1.0 / (INERTIA * 40.0**2 * (1.0 + 4.0 * (200.0 / 22400.0) ** 2))
    assert np.abs(motion[:, 5]).max() == pytest.approx(expected, rel=1e-5)
