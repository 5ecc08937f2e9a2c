"""Every kind of bearing in a scene and in a list: both have the same linear equations.

An uneven mesh, its axis skew in space, under five times its weight.
"""

import exudyn as exu
import numpy as np
import pytest
from apart import apart
from models import disc_with_two_modes
from point_rotors import ring_rotor
from test_magnetic_bearing import DELAYED, LINEAR
from test_uneven_films import BLOCK, HEAVY, SPEED
from void_films import SKEW

from exudyn_rotor import (
    AnnularSeal,
    ClearanceStop,
    MagneticBearing,
    RollingBearing,
    ShortJournalBearing,
    SqueezeFilmDamper,
    Support,
    Unbalance,
    add_foundation,
    add_rotor,
    add_supports,
    bearing_loads,
    campbell,
    linear_model,
    stability,
    unbalance_response,
)
from exudyn_rotor.bearings.short_film import film_force, film_tangent

ENDS = ("left", "right")
OIL = {"radius": 0.06, "length": 0.02, "clearance": 2e-4, "viscosity": 0.01}
BALLS = {"count": 8, "pitch_radius": 0.033, "element_radius": 0.006, "stiffness": 7e9}
PUMP = {"radius": 0.04, "length": 0.03, "clearance": 3e-4, "pressure_drop": 1e6}
CROSSED = np.array([[5e6, 1e6, 2e5], [-5e5, 8e6, 1e5], [1e5, -2e5, 2e6]])
LOSSES = np.array([[500.0, 80.0, 20.0], [-60.0, 400.0, 30.0], [10.0, -20.0, 200.0]])
TILTS, TILT_LOSSES = np.array([[2e4, 5e3], [-3e3, 1e4]]), np.array([[9.0, 2.0], [1.0, 5.0]])
RISING = ([0.0, 200.0, 900.0], [CROSSED, 1.5 * CROSSED, 2.0 * CROSSED.T])


def springs(name):
    return Support(name, 5e6, 500.0)


KINDS = {
    "damper": lambda name, load: [
        SqueezeFilmDamper(interface=name, load=load, centring_stiffness=5e6, **OIL)
    ],
    "damper on an orbit": lambda name, load: [
        SqueezeFilmDamper(interface=name, load=load, centring_stiffness=5e6, orbit=0.4, **OIL)
    ],
    "balls": lambda name, load: [
        RollingBearing(interface=name, load=load, damping=500.0, clearance=1e-6, **BALLS)
    ],
    "preloaded rollers": lambda name, load: [
        RollingBearing(
            interface=name, load=load, damping=9e2, clearance=-2e-6, elements="rollers",
            **BALLS | {"stiffness": 2e8},
        )
    ],
    "seal": lambda name, load: [
        AnnularSeal(interface=name, density=1000.0, viscosity=1e-3, **PUMP), springs(name)
    ],
    "stop": lambda name, load: [
        ClearanceStop(interface=name, radius=0.02, clearance=5e-4, stiffness=1e7, friction=0.2),
        springs(name),
    ],
    "magnets": lambda name, load: [
        MagneticBearing(interface=name, load=load, actuator=LINEAR, controller=DELAYED)
    ],
    "table": lambda name, load: [Support(name, RISING, ([0.0, 900.0], [LOSSES, 2.0 * LOSSES]))],
    "rotor frame": lambda name, load: [
        Support(name, CROSSED, 0.2 * LOSSES, frame="rotor"), Support(name, 0.0, LOSSES)
    ],
    "tilts": lambda name, load: [
        Support(name, CROSSED, LOSSES, TILTS, TILT_LOSSES), springs(name)
    ],
}  # fmt: skip


def short(name, load):
    return [ShortJournalBearing(interface=name, load=load, **OIL)]


THRUST = Support("right", np.diag([0.0, 0.0, 1e6]), np.diag([0.0, 0.0, 100.0]))


def models(make, base=None, free=False, gravity=HEAVY, heavy=0.0, about="equilibrium"):
    """Return the scene and the list of a disc on a shaft, as linear models."""
    return on_ends(disc_with_two_modes(heavy), make, base, free, gravity, about)


def on_ends(reduced, make, base=None, free=False, gravity=HEAVY, about="equilibrium"):
    loads = bearing_loads(reduced, list(ENDS), gravity)
    supports = [each for pair in zip(ENDS, loads, strict=True) for each in make(*pair)]
    supports.append(THRUST)
    spin = {"initial_speed": SPEED} if free else {"spin": SPEED, "translation": "none"}
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, gravity=SKEW @ gravity, rotation=SKEW, **spin)
    add_supports(body, supports, base and add_foundation(mbs, base, rotation=SKEW))
    mbs.Assemble()
    in_list = linear_model(reduced, supports=supports, foundation=base)
    return linear_model(mbs, body=body, about=about), in_list


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_has_the_exponents_of_its_list(kind):
    """Dampers differed by 0.3 of the speed and more, rolling bearings by 0.2 of it."""
    assert apart(*models(KINDS[kind]), SPEED) < 1e-6


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_on_a_block_with_a_free_spin(kind):
    """Supports against tilts differed by 1.7e-6 of the speed."""
    assert apart(*models(KINDS[kind], BLOCK, free=True), SPEED) < 1e-6


TILTING = {
    "alike": {"tilt_stiffness": 2e4 * np.eye(2)},
    "crossed": {"tilt_stiffness": TILTS},
    "rotor frame": {"frame": "rotor", "tilt_stiffness": TILTS, "tilt_damping": TILT_LOSSES},
    "table": {"tilt_stiffness": ([0.0, 900.0], [TILTS, 2.0 * TILTS.T])},
}


@pytest.mark.parametrize("kind", TILTING)
def test_static_moments_on_a_block_leave_the_exponents(kind):
    """20 times the weight: they differed by up to 7e-6 of the speed, in proportion to it."""

    def make(name, load):
        return [Support(name, 0.0, 0.0, **TILTING[kind]), Support(name, 5e6, LOSSES)]

    in_scene, in_list = models(make, BLOCK, gravity=4.0 * HEAVY)
    before = _tilt_functions(in_scene)
    assert apart(in_scene, in_list, SPEED) < 1e-6
    assert _tilt_functions(in_scene) == before


def _tilt_functions(model):
    """Return who evaluates every support's moment."""
    body = model.scene.body
    mbs, name = body.mbs, "springForceTorqueUserFunction"
    items = [mbs.GetObject(number) for one in body.supports for number in one.objects]
    return [str(item[name]) for item in items if name in item]


@pytest.mark.parametrize("base", [None, BLOCK], ids=["ground", "block"])
@pytest.mark.parametrize("kind", ["damper", "damper on an orbit"])
def test_dampers_of_an_eccentric_rotor_in_their_centres(kind, base):
    """They differed by 3e-4 of the speed, by differences of a force with |e| e."""
    nothing = np.zeros(3)
    assert apart(*models(KINDS[kind], base, gravity=nothing, heavy=0.02), SPEED) < 1e-6


@pytest.mark.parametrize("kind", ["damper", "short"])
def test_films_in_their_centres_by_their_own_tangents(kind):
    """A rotor without unbalance, or undeformed: in the centre by default and as given, too."""
    films = {"damper": KINDS["damper"], "short": short}
    nothing, rings = np.zeros(3), ring_rotor(0.1, 0.15, 20.0)
    reduced = rings.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(0)
    assert apart(*on_ends(reduced, films[kind], gravity=nothing, about="steady"), SPEED) < 1e-6
    assert apart(*models(films[kind], gravity=nothing, about="given"), SPEED) < 1e-6


def test_public_analyses_take_dampers_alike():
    """Frequencies, growth and orbits."""
    targets, speeds = models(KINDS["damper"], gravity=np.zeros(3)), [SPEED]
    frequencies = [campbell(each, speeds, accuracy=None).frequencies_rotor for each in targets]
    growths = [stability(each, speeds, accuracy=None).growth for each in targets]
    for found, expected in (frequencies, growths):
        found, expected = (each[np.isfinite(each)] for each in (found, expected))
        assert np.abs(found[:, None] - expected).min(axis=1).max() < 1e-6 * SPEED
    unbalance = [Unbalance("left", 1e-4)]
    found = [unbalance_response(each, speeds, unbalance, accuracy=None) for each in targets]
    np.testing.assert_allclose(*(each.semi_axes("left")[0] for each in found), rtol=1e-6)


# ------------------------------------------------------------------ the short film


@pytest.mark.parametrize("speed", [0.0, 1.3, -0.4])
def test_tangents_of_a_short_film_are_those_of_its_force(speed):
    """By central differences over 1e-5: to 1e-10 of the third derivatives, 1e2 at 0.8 c."""
    random, h = np.random.default_rng(3), 1e-5
    for _ in range(20):
        ratio, angle = random.uniform(0.0, 0.8), random.uniform(0.0, 6.3)
        rates = random.normal(size=2)
        motion = np.r_[ratio * np.cos(angle), ratio * np.sin(angle), rates]
        ends = [[film_force(*(motion + s * h * d), speed) for s in (-1, 1)] for d in np.eye(4)]
        expected = np.array([np.subtract(*pair) for pair in ends]).T / (2.0 * h)
        found = film_tangent(*motion, speed)
        np.testing.assert_allclose(found, expected, atol=1e-6 * np.abs(expected).max())


@pytest.mark.parametrize("phase", [0.0, 0.7, np.pi / 2])
def test_small_harmonic_motions_off_the_centre(phase):
    """Their first harmonic has no stiffness and the damping of half of a film all around."""
    place, amplitude = np.array([3e-5, 9e-5]), 2e-10
    damper = SqueezeFilmDamper(interface="left", load=1e6 * place, centring_stiffness=1e6, **OIL)
    turn = 2.0 * np.pi * np.arange(720) / 720
    waves = amplitude * np.exp(1j * np.array([0.0, phase]) + 1j * turn[:, None])  # whirl: 0 to 1
    forces = [damper.force(place + wave.real, 200.0 * (1j * wave).real) for wave in waves]
    first = 2.0 * np.exp(-1j * turn) @ np.array(forces) / len(turn)
    K, D = damper.coefficients(200.0)
    expected = -(K + 200.0j * D) @ waves[0]
    # 720 angles resolve the kinks of the force to 1e-5, and 2e-10 m are 1e-6 of the clearance
    np.testing.assert_allclose(first, expected, atol=3e-5 * np.abs(expected).max())
    ratio = np.hypot(*place) / OIL["clearance"]
    size = 0.5 * np.pi * 0.01 * 0.06 * 0.02**3 / 2e-4**3
    along, across = (1.0 + 2.0 * ratio**2) / (1.0 - ratio**2) ** 2.5, (1.0 - ratio**2) ** -1.5
    np.testing.assert_allclose(np.linalg.eigvalsh(D), size * np.array([across, along]), rtol=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_adds_itself_as_add_supports_adds_it(kind):
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, disc_with_two_modes(), spin=SPEED)
    for given in KINDS[kind]("left", np.zeros(2)):
        (expected,) = add_supports(body, given, base=mbs.CreateGround())
        for interface in (None, "left", "right"):
            added = given.add_to(body, interface, mbs.CreateGround())
            assert added.support.interface == (interface or "left")
            assert type(added.support) is type(given)
            assert len(added.objects) == len(expected.objects)
            assert body.supports[-1] is added
    before = mbs.systemData.NumberOfObjects()
    with pytest.raises(ValueError, match="support at 'top': no such interface"):
        given.add_to(body, "top")
    assert mbs.systemData.NumberOfObjects() == before
