"""Rotors with the centre of mass off the axis and a free spin: all analyses, all routes.

Their lateral motion is that of a rotor driven at constant speed, and the spin is on its own; what
that leaves out is compared with the closed form of a Jeffcott rotor that nothing drives.
"""

import numpy as np
import pytest
from models import STEEL, block_beam
from point_rotors import free_stiffness, ring_rotor

from exudyn_rotor import (
    SolidRotor,
    Support,
    campbell,
    critical_speeds,
    harmonic_response,
    stability,
    unbalance_response,
)
from exudyn_rotor.linear.models import linear_model as source
from exudyn_rotor.linear.models.rotor.eccentricity import without_drive
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.response.harmonic_loads import HarmonicForce

pytestmark = pytest.mark.filterwarnings("ignore:the (centre of mass|nearest principal axis) is")

MASS, RADIUS, ECCENTRICITY = 2.0, 0.1, 0.03
INERTIA = MASS * RADIUS**2  # about the centre of mass, along the axis
STIFFNESS, DAMPING = 2e5, 30.0
CRITICAL = np.sqrt(STIFFNESS / MASS)
SPEEDS = CRITICAL * np.array([0.0, 0.5, 0.97, 1.02, 3.0])
ROUTES = ("reduced", "dense", "full")


def ring(eccentricity: float = ECCENTRICITY) -> SolidRotor:
    """Return two rings whose centre is off the axis z."""
    rotor = ring_rotor(RADIUS, 0.1, MASS)
    moved = rotor.nodes + np.array([eccentricity, 0.0, 0.0])
    given = SolidRotor.from_matrices(rotor.mass, rotor.stiffness, moved, "z")
    return given.with_interface("all", range(10))


def hung(rotor: SolidRotor, place: float) -> SolidRotor:
    """Return a body with an interface 'root' whose point is at x = `place`."""
    hub = rotor.with_interface("root", range(10))
    root = hub.interfaces["root"].centered_on(np.array([place, 0.0, 0.0]))
    fields = {name: getattr(hub, name) for name in hub.__dataclass_fields__}
    return SolidRotor(**fields | {"interfaces": {**hub.interfaces, "root": root}})


def on_route(rotor: SolidRotor, route: str, monkeypatch: pytest.MonkeyPatch):
    """Return what takes the route: a reduced rotor, or a solid one as dense or sparse equations."""
    monkeypatch.setattr(source, "DENSE_SIZE", 0 if route == "full" else 600)
    return rotor.reduce(3 * rotor.node_count - 6) if route == "reduced" else rotor


def few(route: str) -> dict[str, int]:
    """Return how many modes a large rotor is asked for; a quarter of 30 coordinates at most."""
    return {"modes": 5} if route == "full" else {}


@pytest.fixture(params=ROUTES)
def route(request):
    return request.param


@pytest.fixture(params=[True, False], ids=["centred", "off the axis"])
def rotor(request):
    """Return the rings, held at a point of the axis, or at their centre which is off it."""
    return ring().center_interfaces() if request.param else ring()


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
def test_frequencies_are_those_at_constant_speed(rotor, route, level, monkeypatch):
    target = on_route(rotor, route, monkeypatch)
    found = campbell(target, SPEEDS, supports=carrier(), modes=8, stiffening=level)
    assert found.free_motions == ("translation along axis", "spin")
    values = found.growth + 1j * found.frequencies_rotor
    assert np.all(np.sum(values == 0.0, axis=1) == 2)
    for speed, one in zip(SPEEDS, values, strict=True):
        assert distance(one, driven(speed)) < 1e-6 * CRITICAL


@pytest.mark.parametrize("level", ["none", "tilt"])
def test_exponents_are_those_at_constant_speed(rotor, route, level, monkeypatch):
    """Nothing is neutral: the spin is left out on all routes."""
    speeds = SPEEDS[1:]
    target = on_route(rotor, route, monkeypatch)
    given = {"supports": carrier(1e5), "stiffening": level}
    found = stability(target, speeds, **given, **few(route))
    assert np.abs(found.exponents).min() > 1.0
    if route != "full":
        assert found.exponents.shape[1] == 2 * (3 * rotor.node_count - 1)
    for speed, one in zip(speeds, found.exponents, strict=True):
        one = np.where(one.imag < 0.0, one.conj(), one)
        assert distance(one, driven(speed)) < 1e-5 * CRITICAL


def test_critical_speed_is_that_at_constant_speed(rotor, route, monkeypatch):
    target = on_route(rotor, route, monkeypatch)
    found = critical_speeds(target, supports=carrier(), max_speed=2.0 * CRITICAL)
    assert np.abs(found.speeds / CRITICAL - 1.0).min() < 1e-7


def test_whirl_is_that_at_constant_speed(rotor, route, monkeypatch):
    """``(k − mΩ² + icΩ) u = m e Ω²`` in the rotor frame."""
    target, speeds = on_route(rotor, route, monkeypatch), SPEEDS[1:]
    found = unbalance_response(target, speeds, supports=carrier(1e5), frame="rotor")
    u = found.motion[:, 0, 0, :2].real @ [1.0, 1j]
    stiffness = STIFFNESS - MASS * speeds**2 + 1j * DAMPING * speeds
    np.testing.assert_allclose(u, MASS * ECCENTRICITY * speeds**2 / stiffness, rtol=1e-6)


def test_balanced_spin_is_neutral_at_every_level(route, monkeypatch):
    """At 'none' the centrifugal field must not drive it: growth Ω was found there."""
    target = on_route(ring(0.0), route, monkeypatch)
    for level in ("none", "tilt"):
        found = campbell(target, SPEEDS, supports=carrier(), modes=8, stiffening=level)
        values = found.growth + 1j * found.frequencies_rotor
        assert np.all(np.sum(values == 0.0, axis=1) == 2)


def test_torsion_spring_that_stands_still_holds_the_spin_alone(rotor, route, monkeypatch):
    target = on_route(rotor, route, monkeypatch)
    torsion = Support("all", tilt_stiffness=np.diag([0.0, 0.0, 80.0]))
    supports = [*carrier(1e5), torsion]
    for level in ("none", "tilt"):
        found = campbell(target, SPEEDS[:3], supports=supports, modes=8, stiffening=level)
        error = np.abs(found.frequencies_rotor / np.sqrt(80.0 / INERTIA) - 1.0)
        # at speed the rings breathe with it, at their 22 400 rad/s
        assert np.all(error.min(axis=1) < 1e-6 + 2.0 * (SPEEDS[:3] / 22400.0) ** 2 * 1.01)
        assert found.free_motions == ()
    held = stability(target, [300.0], supports=supports, **few(route))
    assert np.abs(np.abs(held.exponents.imag) / np.sqrt(80.0 / INERTIA) - 1.0).min() < 1e-3


def turning_hub(speed: float, torsion: float) -> np.ndarray:
    """Return the eigenvalues with Im λ > 0 of a rotor whose hub turns at constant speed.

    As :func:`undriven`, with a torsion spring between rotor and hub.
    """
    m, e, k, Z = MASS, ECCENTRICITY, STIFFNESS, np.zeros((3, 3))
    whirl = k * e / (k - m * speed**2)
    lateral = k - m * speed**2
    K = np.array([[lateral, 0, 0], [0, lateral, -k * e], [0, -k * e, k * e * whirl + torsion]])
    M = np.diag([m, m, INERTIA])
    D = 2.0 * speed * m * np.array([[0, -1.0, 0], [1.0, 0, 0], [0, 0, 0]])
    values = np.linalg.eigvals(
        np.block([[Z, np.eye(3)], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
    )
    return values[values.imag > 0.0]


@pytest.mark.parametrize("torsion", [80.0, 2000.0])
@pytest.mark.parametrize("level", ["none", "tilt"])
def test_torsion_spring_to_a_turning_hub_is_complete(route, torsion, level, monkeypatch):
    """Coupled by first order in the eccentricity, and with the bearing's steady force."""
    target = on_route(ring().center_interfaces(), route, monkeypatch)
    hub = Support("all", tilt_stiffness=np.diag([3e3, 3e3, torsion]), frame="rotor")
    supports = [Support("all", STIFFNESS), hub]
    speeds = CRITICAL * np.array([0.0, 0.5])
    found = campbell(target, speeds, supports=supports, modes=8, stiffening=level)
    values = found.growth + 1j * found.frequencies_rotor
    for speed, one in zip(speeds, values, strict=True):
        breathing = 2.0 * (speed / 22400.0) ** 2 * 1.5
        expected = turning_hub(speed, torsion)
        assert distance(one, expected) < (1e-6 + breathing) * np.abs(expected).max()


def test_hinged_blade_is_a_pendulum_in_the_centrifugal_field(route, monkeypatch):
    """``ω = Ω √(m a l/(I + m l²))``: the hinge at a pulls with m(a + l)Ω² at the arm l."""
    hinge, lever = 0.1, 0.2
    target = on_route(hung(ring(hinge + lever), hinge), route, monkeypatch)
    supports = [Support("root", 1e9, frame="rotor"), Support("root", np.diag([0.0, 0.0, 1e5]))]
    supports += [Support("root", tilt_stiffness=np.diag([1e4, 1e4, 0.0]), frame="rotor")]
    for speed in (20.0, 100.0):
        found = campbell(target, [speed], supports=supports, modes=5)
        expected = speed * np.sqrt(MASS * hinge * lever / (INERTIA + MASS * lever**2))
        assert np.abs(found.frequencies_rotor / expected - 1.0).min() < 1e-4
        assert np.abs(found.growth).max() < 1e-3 * speed


def test_feet_hold_the_spin_of_a_balanced_rotor(route, monkeypatch):
    """Ten springs at ten nodes: the six rigid motions at rest have ``ω² = 10 k/m``."""
    rotor = ring(0.0)
    for number in range(10):
        rotor = rotor.with_interface(f"foot {number}", [number])
    target = on_route(rotor, route, monkeypatch)
    supports = [Support(f"foot {number}", 1e5 * np.eye(3)) for number in range(10)]
    found = campbell(target, [0.0], supports=supports, modes=7)
    assert found.free_motions == ()
    assert np.sort(found.frequencies_rotor[0])[:6] == pytest.approx(np.sqrt(1e6 / MASS))


@pytest.mark.parametrize("torsion", [0.0, 80.0])
def test_breathing_turns_a_spin_by_the_coriolis_force(route, torsion, monkeypatch):
    """``(s² + κ − Ω²)(s² + k_t/Θ) + 4Ω²s² = 0`` of a balanced ring that breathes, κ = k/m."""
    rings, stiffness, speed = ring_rotor(RADIUS, 0.1, MASS), 2e3, 20.0
    soft = free_stiffness(rings.nodes, stiffness * np.eye(30))
    rotor = SolidRotor.from_matrices(rings.mass, soft, rings.nodes, "z")
    target = on_route(rotor.with_interface("all", range(10)), route, monkeypatch)
    held = [Support("all", tilt_stiffness=np.diag([0, 0, torsion]), frame="rotor")]
    kappa, own = 10 * stiffness / MASS, torsion / INERTIA
    squares = np.roots([1.0, kappa + 3.0 * speed**2 + own, (kappa - speed**2) * own])
    found = campbell(target, [speed], supports=carrier(1e5) + held, modes=30)
    assert distance(found.frequencies_rotor[0], np.sqrt(-squares)) < 1e-4


def test_springs_that_turn_hold_a_spin_off_the_axis(route, monkeypatch):
    """A body hung up at a root off the axis, as a blade: nothing of its equations is left out.

    With the lever l from the root to the centre of mass, ``ω² = k (1/m + l²/I)`` across it.
    """
    lever = 0.2
    target = on_route(hung(ring(0.3), 0.3 - lever), route, monkeypatch)
    supports = [Support("root", STIFFNESS, frame="rotor")]
    found = campbell(target, [0.0], supports=supports, modes=8)
    expected = np.sqrt(STIFFNESS * (1.0 / MASS + lever**2 / INERTIA))
    assert np.abs(found.frequencies_rotor / expected - 1.0).min() < 1e-4


# ------------------------------------------------------------------ meshes, flexible


@pytest.fixture(scope="module")
def beam():
    """Return a beam with a prestress and masses that put it out of balance in both senses."""
    rotor = SolidRotor.from_ngsolve(block_beam(0.1), STEEL, "z", order=1)
    rotor = rotor.add_point_mass([0.02, 0.03, 0.3], 0.4).add_point_mass([0.02, -0.03, 0.0], 0.1)
    return rotor.with_prestress(rotor.prestress())


@pytest.mark.parametrize("centred", [True, False])
@pytest.mark.parametrize("level", ["none", "tilt", "full"])
def test_routes_agree_on_a_mesh(beam, level, centred, monkeypatch):
    """All modes are kept in the reduction, so nothing but rounding may be between the routes."""
    rotor = beam.center_interfaces() if centred else beam
    supports = [Support("left", 1e6, 50.0, tilt_stiffness=1e4), Support("right", 1e5, 50.0)]
    given = {"supports": supports, "modes": 8, "stiffening": level}
    found = []
    for route in ROUTES:
        target = on_route(rotor, route, monkeypatch)
        result = campbell(target, [0.0, 300.0, 900.0], **given)
        assert "spin" in result.free_motions
        values = result.growth + 1j * result.frequencies_rotor
        assert np.all(np.sum(values == 0.0, axis=1) >= 2)
        found.append(values)
    for other in found[1:]:
        np.testing.assert_allclose(other, found[0], rtol=1e-5, atol=1e-3)


def test_analyses_of_a_mesh_agree(beam, route, monkeypatch):
    """Exponents are those of the modes, and at a critical speed a mode has its frequency."""
    tilting = np.diag([1e4, 1e4, 1e3])
    supports = [Support("left", np.diag([1e6, 1e6, 1e6]), 50.0, tilt_stiffness=tilting),
                Support("right", 1e5, 50.0)]  # fmt: skip
    target = on_route(beam, route, monkeypatch)
    given = {"supports": supports}
    modes = campbell(target, [300.0], modes=5, **given)
    expected = (modes.growth + 1j * modes.frequencies_rotor)[0]
    exponents = stability(target, [300.0], **given, **few(route)).exponents[0]
    exponents = np.where(exponents.imag < 0.0, exponents.conj(), exponents)
    assert distance(exponents, expected) < 1e-3
    undamped = [Support(s.interface, s.stiffness, 0.0, s.tilt_stiffness) for s in supports]
    found = critical_speeds(target, supports=undamped, max_speed=600.0)
    assert len(found.speeds) >= 3
    for speed, frequency in zip(found.speeds, found.frequencies_rotor, strict=True):
        near = campbell(target, [speed], supports=undamped, modes=6).frequencies_rotor[0]
        assert np.abs(near - frequency).min() < 1e-4 * speed


def test_torque_turns_a_free_spin_alone(rotor, route, monkeypatch):
    """``Θ φ̈ = T`` about the axis, whatever the unbalance; nothing moves sideways."""
    target = on_route(rotor, route, monkeypatch)
    force = HarmonicForce("all", (0.0, 0.0), (0.0, 0.0, 1.0))
    found = harmonic_response(target, [40.0], force, speed=200.0, supports=carrier(1e5))
    motion = found.motion[0, 0]
    # the rings breathe, which adds to the inertia by 4Ω² of their 22 400² 1/s²
    expected = 1.0 / (INERTIA * 40.0**2 * (1.0 + 4.0 * (200.0 / 22400.0) ** 2))
    assert np.abs(motion[:, 5]).max() == pytest.approx(expected, rel=1e-5)


# ------------------------------------------------------------------ what is left out


def undriven(epsilon: float, speed: float) -> np.ndarray:
    """Return the 6 eigenvalues of a Jeffcott rotor that nothing drives; m = k = Θ = 1.

    Centre of mass (R + u, v) and angle φ in axes that turn at Ω, about the steady whirl
    ``R = e/(1 − Ω²)``: energy ``½(u̇ − Ωv)² + ½(v̇ + Ω(R + u))² + ½(Ω + φ̇)²`` and the potential of
    the spring ``½|(R + u, v) − e(cos φ, sin φ)|²``.
    """
    e, Z = np.sqrt(epsilon), np.zeros((3, 3))
    whirl = e / (1.0 - speed**2)
    K = np.array([[1.0 - speed**2, 0, 0], [0, 1.0 - speed**2, -e], [0, -e, e * whirl]])
    D = 2.0 * speed * np.array([[0, -1.0, 0], [1.0, 0, 0], [0, 0, 0]])
    return np.linalg.eigvals(np.block([[Z, np.eye(3)], [-K, -D]]))


def change(epsilon: float, speed: float) -> float:
    """Return how far the free spin moves the frequencies at constant speed, ``|1 ± Ω|``."""
    values = np.sort(undriven(epsilon, speed).imag)[-2:]
    return float(np.abs(values - np.abs([1.0 - speed, 1.0 + speed])).max())


def estimates(epsilon: float) -> tuple[float, float]:
    e = RADIUS * np.sqrt(epsilon / (1.0 - epsilon))  # Θ is about the axis
    return without_drive(LinearRotor.of(ring(e).reduce(0)).invariants)


@pytest.mark.parametrize("epsilon", [1e-4, 1e-3, 1e-2])
def test_what_is_left_out_is_as_large_as_stated(epsilon):
    error, band = estimates(epsilon)
    assert error == pytest.approx(change(epsilon, 0.0), rel=0.01)
    for speed in (1.0 - 3.0 * band, 1.0 + 3.0 * band):
        whirl = epsilon / (1.0 - speed**2) ** 2  # m r²/Θ
        assert 0.5 < change(epsilon, speed) / whirl < 2.0
    growth = [
        undriven(epsilon, speed).real.max()
        for speed in (1.0 - 0.5 * band, 1.0 + 0.05 * band, 1.0 + 0.9 * band, 1.0 + 1.15 * band)
    ]
    assert [one > 1e-3 for one in growth] == [False, True, True, False]


def test_closed_form_without_coupling_is_the_spin_held():
    for speed in (0.3, 1.4):
        assert change(0.0, speed) < 1e-7


RUNS = {
    "campbell": lambda target, given: campbell(target, [0.0, 10.0], modes=4, **given),
    "critical speeds": lambda target, given: critical_speeds(target, max_speed=9e2, **given),
    "response": lambda target, given: unbalance_response(target, [100.0], **given),
    "stability": lambda target, given: stability(target, [100.0], **given),
}


@pytest.mark.filterwarnings("default:the centre of mass is")
@pytest.mark.parametrize("analysis", RUNS)
def test_every_analysis_on_every_route_warns_once(analysis, route, monkeypatch):
    given = {"supports": carrier(1e5)}
    if analysis == "stability":
        given |= few(route)
    target = on_route(ring(0.006), route, monkeypatch)
    with pytest.warns(UserWarning, match=r"0\.006 m off .* 0\.2% at rest.* 12% above") as caught:
        RUNS[analysis](target, given)
    assert len(caught) == 1


@pytest.mark.filterwarnings("error:the centre of mass is")
def test_small_eccentricity_does_not_warn(route, monkeypatch):
    campbell(on_route(ring(0.004), route, monkeypatch), [10.0], supports=carrier(), modes=4)


@pytest.mark.filterwarnings("default:the centre of mass is")
def test_what_is_left_out_of_a_spin_on_springs_is_told(route, monkeypatch):
    turning = [Support("all", 1e6, frame="rotor")]
    target = on_route(ring(), route, monkeypatch)
    with pytest.warns(UserWarning, match=r"tilts lack .* hold a blade by rotor\.clamped"):
        campbell(target, [10.0], supports=turning, modes=4)
