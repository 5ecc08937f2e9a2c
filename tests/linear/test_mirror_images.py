"""A rotor on films in a mirror: everything turns the other way, and nothing else changes.

The mirror is a plane through the axis. It takes along supports, gravity and the rotor's own
unbalance; a rotor that keeps its unbalance is no mirror image, as that then stands elsewhere
against supports that differ in direction.
"""

from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest
from apart import exponents
from point_rotors import SKEW_AXIS, free_stiffness, ring_rotor

from exudyn_rotor import (
    AnnularSeal,
    JournalBearing,
    OilFilm,
    Pad,
    ShortJournalBearing,
    SolidRotor,
    SpinAxis,
    SqueezeFilmDamper,
    Support,
    TiltingPadBearing,
    Unbalance,
    add_rotor,
    add_supports,
    grooved_pads,
    linear_model,
    recommended_settings,
    steady_state,
    unbalance_response,
)

pytestmark = pytest.mark.filterwarnings("ignore:rotor 'rotor'. no node of Exudyn")
ANGLE = 0.37  # rad: of the mirror, from n1 to n2
MIRROR = np.array([[np.cos(2 * ANGLE), np.sin(2 * ANGLE)], [np.sin(2 * ANGLE), -np.cos(2 * ANGLE)]])
IN_SPACE = np.block([[MIRROR, np.zeros((2, 1))], [0.0, 0.0, 1.0]])
OF_MOTION = np.block([[IN_SPACE, np.zeros((3, 3))], [np.zeros((3, 3)), -IN_SPACE]])
CLEARANCE, SPEED, LOAD = 1e-4, 400.0, np.array([300.0, -900.0])
SIZE = {"radius": 0.05, "length": 0.05, "viscosity": 0.02}
PADS = {
    "plain": grooved_pads(CLEARANCE),
    "groove": grooved_pads(CLEARANCE, [1.7], 0.3),
    "lobes": grooved_pads(CLEARANCE, [0.3, 2.0, 4.1], 0.3, preload=0.4),
}


def oil(pads="lobes", cavitation="reynolds", **options):
    return OilFilm(
        pads=PADS[pads], cavitation=cavitation, **SIZE, **{"nodes": 24, "axial_nodes": 0, **options}
    )


def journal(*film, **options):
    return JournalBearing(interface="left", film=oil(*film, **options), load=LOAD)


def tilting(inertia=None):
    film = replace(oil(), pads=grooved_pads(CLEARANCE, [0.3, 1.9, 3.5, 5.0], 0.3, preload=0.5))
    return TiltingPadBearing(interface="left", film=film, pivot=0.6, pad_inertia=inertia, load=LOAD)


KINDS = {
    "short": ShortJournalBearing(interface="left", clearance=CLEARANCE, load=LOAD, **SIZE),
    "squeeze": SqueezeFilmDamper(
        interface="left", clearance=CLEARANCE, centring_stiffness=5e7, orbit=0.3, load=LOAD, **SIZE
    ),
    "seal": AnnularSeal(
        interface="left",
        radius=0.05,
        length=0.05,
        clearance=CLEARANCE,
        pressure_drop=2e6,
        density=1e3,
        viscosity=1e-3,
    ),
    "tension": journal("lobes", "none"),
    "half-sommerfeld": journal("plain", "half-sommerfeld"),
    "reynolds": journal(),
    "axial nodes": journal("groove", axial_nodes=4),
    "voids": journal("groove", "mass-conserving"),
    "pads without inertia": tilting(),
    "pads": tilting(1e-3),
}


def mirrored(support):
    """Return the image of a support."""
    if isinstance(support, Support):
        K, D = (IN_SPACE @ X @ IN_SPACE for X in (support.stiffness, support.damping))
        return Support(support.interface, K, D)
    changes = {} if support.load is None else {"load": MIRROR @ support.load}
    if isinstance(support, JournalBearing | TiltingPadBearing):
        pads = [
            Pad(2 * ANGLE - one.start - one.arc, one.arc, one.clearance, MIRROR @ one.center)
            for one in support.film.pads
        ]
        changes["film"] = replace(support.film, pads=pads)
    if isinstance(support, TiltingPadBearing):
        changes["pivot"] = 1.0 - support.pivot
    return replace(support, **changes)


def off(values, images):
    """Return the largest difference relative to the largest value."""
    return np.abs(values - images).max() / np.abs(values).max()


@pytest.mark.parametrize("speed", [SPEED, -SPEED])
@pytest.mark.parametrize("kind", KINDS)
def test_equilibrium_and_coefficients(kind, speed):
    """Newton's method leaves 1e-9 of the load; a change of K by that, K'/K x, is of its order."""
    bearing, image = KINDS[kind], mirrored(KINDS[kind])
    place, in_mirror = bearing.equilibrium(speed), image.equilibrium(-speed)
    np.testing.assert_allclose(in_mirror, MIRROR @ place, rtol=0.0, atol=1e-8 * CLEARANCE)
    both = bearing.coefficients(speed), image.coefficients(-speed)
    for X, Y in zip(*both, strict=True):
        assert off(X, MIRROR @ Y @ MIRROR) < 1e-7


@pytest.mark.parametrize("kind", [name for name in KINDS if name not in ("voids", "pads")])
def test_force_and_torque_of_any_motion(kind):
    bearing = KINDS[kind].pad_bearings[1] if kind == "pads without inertia" else KINDS[kind]
    image, rng = mirrored(bearing), np.random.default_rng(5)
    laws = [one.law_with_torque or one.law for one in (bearing, image)]
    for _ in range(4):
        place = rng.uniform(-0.4, 0.4, 2) * CLEARANCE
        rate = rng.normal(size=2) * CLEARANCE * SPEED
        fx, fy, *torque = laws[0](*place, *rate, 0.3, SPEED)
        gx, gy, *turned = laws[1](*(MIRROR @ place), *(MIRROR @ rate), -0.3, -SPEED)
        size = np.hypot(fx, fy)
        np.testing.assert_allclose(MIRROR @ [gx, gy], [fx, fy], rtol=0.0, atol=1e-10 * size)
        assert np.negative(turned) == pytest.approx(torque, rel=1e-10)


# ------------------------------------------------------------------ rotors


def rotor(axis, image, eccentric=1e-2):
    """Return an uneven, flexible rotor of two rings with an unbalance, or its mirror image."""
    axes = np.column_stack([*SpinAxis.of(axis).plane.T, SpinAxis.of(axis).direction])
    turn = axes @ (IN_SPACE if image else np.eye(3))
    phi = 2.0 * np.pi * np.arange(5) / 5
    circle = 0.1 * np.column_stack([np.cos(phi), np.sin(phi), np.zeros(5)])
    nodes = np.vstack([circle + np.array([0.0, 0.0, z]) for z in (-0.15, 0.15)])
    uneven = np.random.default_rng(3).normal(size=(30, 30)) / 10.0
    stiffness = free_stiffness(nodes, 1e8 * (np.eye(30) + uneven @ uneven.T)).toarray()
    T = np.kron(np.eye(10), turn)
    rotor = SolidRotor.from_matrices(
        10.0 * np.eye(30), T @ stiffness @ T.T, nodes @ turn.T, axes[:, 2]
    )
    rotor = rotor.add_point_mass(turn @ [0.06, 0.08, 0.05], eccentric) if eccentric else rotor
    reduced = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(2)
    return reduced, turn


HELD = Support("right", np.diag([2e7, 3e7, 1e6]), np.diag([4e4, 5e4, 1e3]))


def scene(kind, image, speed, axis, eccentric=1e-2, **options):
    reduced, turn = rotor(axis, image, eccentric)
    mbs = exu.SystemContainer().AddSystem()
    spin = -speed if image else speed
    options = {"spin": spin, "translation": "none"} | options
    if options["spin"] == "free":
        options["initial_speed"] = spin
    body = add_rotor(mbs, reduced, gravity=turn @ [3.0, -9.0, 0.0], **options)
    supports = [KINDS[kind], HELD]
    add_supports(body, [mirrored(one) for one in supports] if image else supports)
    mbs.Assemble()
    return mbs, body


SCENES = {
    "short, backwards": ("short", -SPEED, SKEW_AXIS, {}),
    "short, free spin": ("short", SPEED, "x", {"spin": "free", "translation": "free"}),
    "reynolds": ("reynolds", SPEED, SKEW_AXIS, {"eccentric": 1e-3}),
    "tension": ("tension", -SPEED, "y", {"translation": "free"}),
    "seal": ("seal", SPEED, SKEW_AXIS, {}),
    "squeeze": ("squeeze", SPEED, "z", {}),
}


@pytest.mark.parametrize("name", SCENES)
def test_steady_motions_and_runs_from_them(name):
    """Two searches end with the motion to their tolerance; ten steps of a run keep it."""
    kind, speed, axis, options = SCENES[name]
    motions, places = [], []
    for image in (False, True):
        mbs, body = scene(kind, image, speed, axis, **options)
        found, sense = steady_state(body, tolerance=1e-7), -1.0 if image else 1.0
        seen = [found.interface_motion("left", sense * angle) for angle in (0.0, 1.0, 2.5)]
        motions.append(np.array(seen) @ OF_MOTION if image else np.array(seen))
        body.start_from(found.state())
        settings = recommended_settings(end_time=1e-3, step=1e-4)
        settings.solution.file.write = False
        mbs.SolveDynamic(settings)
        place = mbs.GetMarkerOutput(body.marker("left"), exu.OutputVariableType.Displacement)
        places.append(rotor(axis, image)[1].T @ place)
    assert off(*motions) < 3e-7
    assert off(*places) < 3e-7


@pytest.mark.parametrize("kind", ["short", "reynolds", "voids", "pads"])
def test_growth_in_lists_and_in_scenes(kind):
    """Exponents are those of the mirror image, but for their sign of rotation, a multiple of iΩ."""
    models = []
    for image in (False, True):
        supports = [mirrored(one) if image else one for one in (KINDS[kind], HELD)]
        reduced = rotor(SKEW_AXIS, image, 0.0)[0]
        in_list = linear_model(reduced, supports=supports)
        mbs, body = scene(kind, image, SPEED, SKEW_AXIS, eccentric=0.0)
        models.append((in_list, linear_model(mbs, body=body, about="equilibrium")))
    for one, other in zip(*models, strict=True):
        found, images = exponents(one, SPEED), exponents(other, -SPEED)
        slow = found[np.abs(found.real) < 0.3 * SPEED]
        assert len(slow) >= 3
        turns = 1j * SPEED * np.arange(-2, 3)[:, None]
        both = np.r_[images, images.conj()]
        assert max(np.abs(both - s + turns).min() for s in slow) < 1e-6 * SPEED


def test_response_of_tables_below_zero_is_the_mirror_image():
    """Nothing asks such tables for their values above zero."""
    rotor = ring_rotor(0.1, 0.1, 2.0).with_interface("all", range(10)).reduce(0)
    stiffness, mirror = np.array([[2e5, 4e4], [-1e4, 3e5]]), np.diag([1.0, -1.0])
    found = []
    for sign, turn in ((1.0, np.eye(2)), (-1.0, mirror)):
        shares = np.array([1.0, 1.4, 1.7])[:: int(sign)]
        table = np.sort(sign * np.array([0.0, 150.0, 300.0]))
        matrices = shares[:, None, None] * (turn @ stiffness @ turn)
        response = unbalance_response(
            rotor,
            np.sort(sign * np.array([100.0, 200.0, 300.0])),
            Unbalance("all", 1e-3, sign * 0.6),
            own=False,
            supports=Support("all", (table, matrices), 20.0, tilt_stiffness=1e4 * np.eye(2)),
            allow_negative=True,
        )
        motion = np.array([response.phasor("all", name) for name in ("n1", "n2")])
        found.append(motion[:, :: int(sign)])
    np.testing.assert_allclose(found[1], mirror @ found[0].conj(), rtol=1e-9)
