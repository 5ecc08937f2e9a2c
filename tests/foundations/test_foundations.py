"""Rotors on foundations: against closed forms, against scenes, and against a rigid body."""

from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest
import scipy.linalg
from apart import distance
from point_rotors import ring_rotor
from test_supports_in_scenes import KINDS, rings

import exudyn_rotor as er
from exudyn_rotor.reduction.selection import without_spin

SPEED = 200.0
POINTS = {"left": [0.0, 0.0, -0.15], "right": [0.0, 0.0, 0.15]}
CORNERS = [[x, -0.3, z] for x in (-0.2, 0.2) for z in (-0.2, 0.3)]
STIFFNESS = np.diag([1e6, 2e6, 1e6]) + 1e5
BLOCK = er.Foundation.rigid(
    30.0,
    [[2.0, 0.1, 0.05], [0.1, 2.0, 0.0], [0.05, 0.0, 1.0]],
    [0.05, -0.2, 0.02],
    [er.Mount(corner, STIFFNESS, 100.0) for corner in CORNERS],
    POINTS,
)
HELD = er.Support("right", np.diag([1e6, 2e6, 5e5]), 150.0)


# ------------------------------------------------------------------ closed forms


def two_masses(mass=5.0, stiffness=2e6, damping=0.0, own=(0.0, 0.0), ratio=1.0):
    """Return a rigid rotor on alike bearings and a foundation of `ratio` times its mass.

    The foundation translates only, with the stiffness `own` along x and y: in each direction two
    masses in a row.
    """
    supports = [er.Support(name, np.eye(3) * stiffness / 2, damping / 2) for name in POINTS]
    m = ratio * mass
    foundation = er.Foundation(
        m * np.eye(3),
        np.diag([30.0, 50.0, 10.0]),
        np.diag([*own, 1e6]),
        dict.fromkeys(POINTS, np.eye(3)),
        participation=m * np.eye(3),
    )
    rotor = ring_rotor(0.1, 0.15, mass)
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10))
    return rotor.reduce(0), supports, foundation


def in_a_row(frequency, own, loads, damping=0.0, foundation_damping=0.0, **given):
    """Return the motion of rotor and foundation in one direction under loads on them [N]."""
    k, m = given.get("stiffness", 2e6), 5.0
    bearing = k + 1j * frequency * damping
    ground = own + 1j * frequency * foundation_damping
    Z = np.array([[bearing, -bearing], [-bearing, bearing + ground]]) - frequency**2 * m * np.eye(2)
    return np.linalg.solve(Z, loads)


OWN = (1.5e6, 4e6)


def frequencies_in_a_row(own):
    K = np.array([[2e6, -2e6], [-2e6, 2e6 + own]])
    return np.sqrt(scipy.linalg.eigvalsh(K, 5.0 * np.eye(2)))


def test_natural_frequencies_are_those_of_two_masses_at_any_speed():
    """Rotor on a foundation of its own mass: both planes by hand, and unmoved by the spin."""
    rotor, supports, foundation = two_masses(own=OWN)
    model = er.linear_model(rotor, supports=supports, foundation=foundation.with_damping_ratio(0.0))
    result = er.campbell(model, [0.0, SPEED])
    expected = np.sort(np.concatenate([frequencies_in_a_row(own) for own in OWN]))
    for row in result.frequencies_inertial:
        apart = np.abs(row[:, None] - expected).min(axis=0)
        np.testing.assert_allclose(apart / expected, 0.0, atol=1e-9)
    lower = [np.argmin(np.abs(result.frequencies_inertial[1] - expected[i])) for i in (0, 1)]
    assert set(result.whirl[1, lower]) <= {"foundation", "mixed"}


@pytest.mark.parametrize("speed", [0.3, 0.9, 1.7])
def test_unbalance_response_is_that_of_two_masses(speed):
    """Isotropic foundation: circular orbits of rotor and foundation, amplitude and phase."""
    own, omega = 1.5e6, speed * np.sqrt(1.5e6 / 5.0)
    rotor, supports, foundation = two_masses(own=(own, own), damping=400.0)
    foundation = replace(foundation, damping=30.0 * np.eye(3))
    unbalances = [er.Unbalance(name, 1e-4) for name in POINTS]
    model = er.linear_model(rotor, supports=supports, foundation=foundation)
    at = ["left", "left (foundation)"]
    found = er.unbalance_response(model, [omega], unbalances, at=at)
    expected = in_a_row(omega, own, [2e-4 * omega**2, 0.0], 400.0, 30.0)
    ours = [found.phasor(place, "n1")[0] for place in at]
    np.testing.assert_allclose(ours, expected, rtol=1e-9)
    turning = er.unbalance_response(model, [omega], unbalances, at=at, frame="rotor")
    row = turning.motion[0, :, turning.orders.tolist().index(0)]
    np.testing.assert_allclose(np.hypot(*row[:, :2].real.T), np.abs(expected), rtol=1e-9)


def test_loads_on_the_foundation_and_its_ground():
    """A force on the foundation, one that turns with the rotor, and shaken ground."""
    rotor, supports, foundation = two_masses(own=OWN, damping=400.0)
    model = er.linear_model(rotor, supports=supports, foundation=foundation)
    at = ["right", "right (foundation)"]
    w = 700.0
    forced = er.harmonic_response(
        model, [w], er.HarmonicForce(at[1], (3.0, 0.0)), speed=SPEED, at=at
    )
    expected = in_a_row(w, OWN[0], [0.0, 3.0], 400.0, 30.0)
    np.testing.assert_allclose([forced.phasor(p, "n1")[0] for p in at], expected, rtol=1e-9)
    shaken = er.harmonic_response(model, [w], er.BaseAcceleration((0.0, 2.0)), speed=SPEED, at=at)
    expected = in_a_row(w, OWN[1], [-10.0, -10.0], 400.0, 50.0)
    np.testing.assert_allclose([shaken.phasor(p, "n2")[0] for p in at], expected, rtol=1e-9)
    # a force of frequency 0 in the rotor frame is a rotating one of frequency Ω outside
    load = er.HarmonicForce(at[1], (3.0, 0.0), frame="rotor")
    turned = er.harmonic_response(model, [0.0], load, speed=SPEED, at=at)
    found = turned.motion[0, 1, turned.orders.tolist().index(1), :2]
    expected = [
        in_a_row(SPEED, own, [0.0, force], 400.0, damping)[1]
        for own, force, damping in zip(OWN, (3.0, -3.0j), (30.0, 50.0), strict=True)
    ]
    np.testing.assert_allclose(found, expected, rtol=1e-9)


# ------------------------------------------------------------------ scenes


def compared(supports, turn=None, rotation=None, block=BLOCK, **options):
    """Return the distance between the exponents of a scene and of the linear model."""
    rotor = rings(turn)
    block = block if turn is None else block.turned(turn)
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rotor, rotation=rotation, **options)
    er.add_supports(body, supports, er.add_foundation(mbs, block, rotation=rotation))
    mbs.Assemble()
    found = er.linear_model(mbs, body=body)
    listed = without_spin(rotor) if "spin" in options else rotor
    return distance(found, er.linear_model(listed, supports=supports, foundation=block), SPEED)


CHOSEN = ["2 x 2", "3 x 3", "tilt, damped", "about the axis", "rotor frame", "table", "tilt table"]


@pytest.mark.parametrize("kind", [*CHOSEN, "rotor frame, tilts"])
def test_scene_and_linear_model_have_the_same_exponents(kind):
    held = {"spin": SPEED} if kind in ("about the axis", "rotor frame, tilts") else {}
    assert compared([KINDS[kind], HELD], **held) < 1e-7


def test_a_block_is_exudyns_rigid_body():
    """The same mass, inertia and springs as plain items of Exudyn."""
    mbs = exu.SystemContainer().AddSystem()
    supports = [KINDS["3 x 3"], KINDS["tilt"], HELD]
    body = er.add_rotor(mbs, rings(), spin=SPEED)
    inertia = exu.utilities.RigidBodyInertia(mass=30.0, inertiaTensor=np.diag([2.0, 2.5, 1.0]))
    base = mbs.CreateRigidBody(
        inertia=inertia, referencePosition=[0, -0.2, 0], nodeType=exu.NodeType.RotationRxyz
    )
    ground = mbs.CreateGround()
    for corner in np.array(CORNERS):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, base],
            localPosition0=list(corner),
            localPosition1=list(corner - [0.0, -0.2, 0.0]),
            stiffness=[1e6, 2e6, 3e6],
            damping=[100.0] * 3,
        )
    er.add_supports(body, supports, base)
    mbs.Assemble()
    expected = er.linear_model(mbs, body=body)
    mounts = [er.Mount(corner, [1e6, 2e6, 3e6], 100.0) for corner in CORNERS]
    block = er.Foundation.rigid(30.0, [2.0, 2.5, 1.0], [0.0, -0.2, 0.0], mounts, POINTS)
    scene = exu.SystemContainer().AddSystem()
    body = er.add_rotor(scene, rings(), spin=SPEED)
    er.add_supports(body, supports, er.add_foundation(scene, block))
    scene.Assemble()
    found = er.linear_model(scene, body=body)
    # differences of Exudyn's forces give K to 4e-8 of its largest entry
    assert distance(found, expected, SPEED) < 1e-6
