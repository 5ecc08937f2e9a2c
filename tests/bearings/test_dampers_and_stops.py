"""Squeeze-film dampers and stops against closed forms."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import ring_rotor

from exudyn_rotor import (
    ClearanceStop,
    SqueezeFilmDamper,
    Support,
    add_rotor,
    add_supports,
    steady_state,
)

FILM = {"radius": 0.06, "length": 0.02, "clearance": 1.5e-4, "viscosity": 0.01}
STOP = {"radius": 0.05, "clearance": 1e-4, "stiffness": 4e6, "friction": 0.2}


def damper(interface="left", **changes):
    return SqueezeFilmDamper(interface=interface, **(FILM | changes))


def stop(interface="left", **changes):
    return ClearanceStop(interface=interface, **(STOP | changes))


@pytest.mark.parametrize("ratio", [0.1, 0.5, 0.9])
def test_force_on_a_circular_centred_orbit(ratio):
    """L. San Andrés, Modern Lubrication Theory, Notes 13: short damper, film of 180°."""
    whirl, c = 300.0, FILM["clearance"]
    size = FILM["viscosity"] * FILM["radius"] * FILM["length"] ** 3 / c**2
    expected = -size * whirl * np.array(
        [2.0 * ratio**2 / (1.0 - ratio**2) ** 2, 0.5 * np.pi * ratio / (1.0 - ratio**2) ** 1.5]
    )  # fmt: skip
    one = damper(orbit=ratio)
    found = one.law(ratio * c, 0.0, 0.0, whirl * ratio * c, 0.0, 0.0)
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    spinning = one.law(ratio * c, 0.0, 0.0, whirl * ratio * c, 0.0, 900.0)
    np.testing.assert_allclose(spinning, expected, rtol=1e-12)
    K, D = one.coefficients(whirl)
    np.testing.assert_allclose(K * ratio * c, -expected[0] * np.eye(2), rtol=1e-12)
    np.testing.assert_allclose(D * whirl * ratio * c, -expected[1] * np.eye(2), rtol=1e-12)


def test_stop_pushes_back_and_rubs():
    """k δ inwards, μ N against the sliding R Ω + v_t, either way round; nothing when open."""
    normal = 4e6 * 5e-5
    for speed, tangential in ((100.0, -1.0), (-100.0, 1.0), (0.0, 0.0)):
        found = stop().law(0.0, 1.5e-4, 0.0, 0.0, 0.0, speed)
        np.testing.assert_allclose(found, [-0.2 * normal * tangential, -normal], atol=1e-9)
    backward = stop().law(1.5e-4, 0.0, 0.0, -6.0, 0.0, 100.0)  # rolls faster than it spins
    np.testing.assert_allclose(backward, [-normal, 0.2 * normal], rtol=1e-9)
    damped = stop(damping=1e4, friction=0.0)
    np.testing.assert_allclose(damped.law(1.5e-4, 0.0, 0.01, 0.0, 0.0, 0.0)[0], -normal - 50.0)
    assert not np.any(damped.law(1.5e-4, 0.0, -1.0, 0.0, 0.0, 0.0))
    x, y, vx, vy, speed = 1.2e-4, 0.9e-4, 0.02, -0.01, 100.0
    fx, fy, torque = stop().law_with_torque(x, y, vx, vy, 0.0, speed)
    tangent = np.array([-0.6, 0.8])
    drag = np.dot(tangent, [fx, fy])
    assert torque == pytest.approx(0.05 * drag)
    assert torque * speed + fx * vx + fy * vy < 0.0
    assert not np.any(stop().law(0.9e-4, 0.0, 1.0, 1.0, 0.0, 100.0))


@pytest.mark.parametrize("friction", [0.0, 0.2])
def test_rotor_that_leans_on_stops_has_a_steady_state(friction):
    """(K e + N)² + (μN)² = (W/2)² at each end, N = k (e − c), of a balanced rotor of 20 kg."""
    rings = ring_rotor(0.1, 0.15, 20.0)
    rotor = rings.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(0)
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor, spin=300.0, translation="none", gravity=[0.0, -9.81, 0.0])
    k, c, K = 1e7, 1e-5, 1e6
    for name in ("left", "right"):
        touched = stop(name, stiffness=k, clearance=c, friction=friction)
        add_supports(body, [touched, Support(name, K, 1e3)])
    mbs.Assemble()
    found = np.hypot(*steady_state(body).interface_motion("left")[:2])
    parts = np.poly1d([K + k, -k * c]), friction * k * np.poly1d([1.0, -c])
    roots = (parts[0] ** 2 + parts[1] ** 2 - (98.1) ** 2).roots
    assert found == pytest.approx(roots.real.max(), rel=1e-6)


def leaning(supports, spin, excess=0.0):
    """Return body and system of two rings of 20 kg, with an excess mass [kg] at the right one."""
    rings = ring_rotor(0.1, 0.15, 20.0)
    if excess:
        rings = rings.add_point_mass([0.1, 0.0, 0.15], excess)
    rotor = rings.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(0)
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor, spin=spin, gravity=[0.0, -9.81, 0.0])
    add_supports(body, supports)
    mbs.Assemble()
    return mbs, body


@pytest.mark.parametrize(("friction", "angle"), [(0.0, 0.0), (0.2, 0.7)])
def test_rotor_at_rest_lies_in_its_stops(friction, angle):
    """At c + W/(2k) below the centre, whatever the friction, of balanced and of uneven rotors."""
    k, c = 1e7, 1e-5
    stops = [stop(name, stiffness=k, clearance=c, friction=friction) for name in ("left", "right")]
    axial = Support("left", np.diag([0.0, 0.0, 1e6]))
    for excess in (0.0, 0.01):
        body = leaning([*stops, axial], 0.0, excess)[1]
        steady = steady_state(body)
        for name, load in (("left", 98.1), ("right", 98.1 + 9.81 * excess)):
            expected = [0.0, -c - load / k]
            found = steady.interface_motion(name, angle)[:2]
            np.testing.assert_allclose(found, expected, atol=1e-7 * c)
