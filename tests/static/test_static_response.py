"""Deflection and reactions under loads that stand still, against closed forms and other solvers."""

from dataclasses import replace
from functools import cache

import exudyn
import numpy as np
import pytest
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from beam_models import BeamRotor
from matplotlib import pyplot
from models import STEEL, block_beam, centered_disc

import exudyn_rotor as er

G = 9.81
DOWN = [0.0, -G, 0.0]
LENGTH, DIAMETER = 2.0, 0.02


@cache
def beam(spans: int = 4) -> er.ReducedRotor:
    """Return a slender shaft with stations, four to a span, of all of its modes."""
    stations = tuple(np.linspace(0.0, LENGTH, 4 * spans + 1))
    return BeamRotor(stations, 0.0, DIAMETER, STEEL, ()).reduced()


def weight(rotor: er.ReducedRotor) -> float:
    return rotor.invariants.mass * G


# reactions of a continuous beam of equal spans under its own weight, over w l (clause of tables)
SHARES = {
    2: [1 / 2, 1 / 2],
    3: [3 / 8, 10 / 8, 3 / 8],
    5: [11 / 28, 32 / 28, 26 / 28, 32 / 28, 11 / 28],
}


@pytest.mark.parametrize("count", SHARES)
def test_reactions_of_a_continuous_beam_on_rigid_bearings(count):
    rotor, spans = beam(), count - 1
    names = [str(16 * i // spans) for i in range(count)]
    share = np.array(SHARES[count]) / spans * weight(rotor)
    supports = [er.Support(name, 1e11) for name in names]
    found = er.static_response(rotor, gravity=DOWN, supports=supports)
    # shear changes reactions by about 3 (d / l)² of a span; rounding by 1e-8
    assert found.reactions[:, 1] == pytest.approx(share, rel=5e-4)
    loads = er.bearing_loads(rotor, names, DOWN)
    assert loads[:, 1] == pytest.approx(-share, rel=5e-4)
    assert np.abs(loads[:, 0]).max() < 1e-9 * share.max()
    assert found.reactions[:, 1].sum() == pytest.approx(weight(rotor), rel=1e-7)


def test_deflection_of_a_beam_between_two_bearings():
    rotor = beam()
    supports = [er.Support(name, 1e11) for name in ("0", "16")]
    second = np.pi * DIAMETER**4 / 64.0
    sag = 5.0 * weight(rotor) * LENGTH**3 / (384.0 * STEEL["youngsModulus"] * second)
    found = er.static_response(rotor, gravity=DOWN, supports=supports, at="8")
    assert found.deflection()[1] == pytest.approx(-sag, rel=3e-4)  # shear adds 2.4 (d / L)²
    force = er.static_response(rotor, {"8": [0.0, 10.0, 0.0]}, supports=supports, at="8")
    sag = 10.0 * LENGTH**3 / (48.0 * STEEL["youngsModulus"] * second)
    assert force.deflection()[1] == pytest.approx(sag, rel=3e-4)


def test_a_rigid_rotor_shares_its_weight_between_bearings_of_equal_stiffness():
    solid = block()
    for name, z in (("a", 0.05), ("b", 0.1), ("c", 0.25)):
        solid = solid.interface_at(name, z, 0.06)
    rotor, names = solid.reduce(0), ["a", "b", "c"]
    supports = [er.Support(name, 1e8) for name in names]
    given = er.bearing_loads(rotor, supports, DOWN)
    rigid = er.bearing_loads(rotor, names, DOWN)
    assert rigid == pytest.approx(given, abs=1e-6 * np.abs(given).max())
    assert np.abs(rigid).sum() > 0.99 * weight(rotor)


@cache
def block() -> er.SolidRotor:
    return er.SolidRotor.from_ngsolve(block_beam(maxh=0.1), STEEL, "z").center_interfaces()


def test_a_solid_rotor_is_solved_as_its_matrices():
    rotor = block()
    node = rotor.nearest_node([0.0, 0.0, 0.15])
    springs = {"left": np.diag([3e7, 2e7, 4e7]), "right": np.diag([1e7, 2e7, 2e7])}
    axes = np.column_stack([rotor.axis.plane, rotor.axis.direction])
    K, F = rotor.stiffness.copy(), np.zeros(rotor.nodes.size)
    for name, spring in springs.items():
        U = rotor.interfaces[name].mean_motion(rotor.node_count)
        turn = 1e3 * np.eye(3)
        k = np.block([[axes @ spring @ axes.T, 0 * turn], [0 * turn, axes @ turn @ axes.T]])
        K = K + U.T @ sp.csr_array(k) @ U
    F += rotor.mass @ np.tile([1.0, -G, 2.0], rotor.node_count)
    F[3 * node : 3 * node + 3] += [100.0, 50.0, -20.0]
    moment = rotor.interfaces["right"].mean_motion(rotor.node_count).T @ [0, 5, 0, 3, 2, 1.0]
    expected = spla.spsolve(sp.csc_array(K), F + moment).reshape(-1, 3)
    supports = [er.Support(n, k, tilt_stiffness=1e3 * np.eye(3)) for n, k in springs.items()]
    loads = {node: [100.0, 50.0, -20.0], "right": [0.0, 5.0, 0.0, 3.0, 2.0, 1.0]}
    found = er.static_response(
        rotor, loads, gravity=[1.0, -G, 2.0], supports=supports, at=["left", node], stress=True
    )
    assert found.displacement == pytest.approx(expected, abs=1e-7 * np.abs(expected).max())
    assert axes @ found.deflection(f"node {node}") == pytest.approx(expected[node], rel=1e-6)
    stress = rotor.elements.nodal_stress(expected.reshape(-1, 1))[:, :, 0]
    assert found.stress == pytest.approx(stress, abs=1e-6 * np.abs(stress).max())
    assert found.von_mises.shape == (rotor.node_count,)
    total = axes @ found.reactions[:, :3].sum(axis=0)
    applied = rotor.total_mass * np.array([1.0, -G, 2.0]) + [100.0, 55.0, -20.0]
    assert total == pytest.approx(-applied, rel=1e-7)
    pyplot.close(found.plot().figure)


@cache
def disc() -> er.ReducedRotor:
    rotor = centered_disc()
    return rotor.reduce(er.craig_bampton_modes(rotor, 5, coupling="RBE3"))


def test_harmonic_response_at_frequency_zero_is_the_same():
    rotor, ends = disc(), ("left", "right")
    supports = [er.Support(name, [[1e7, 0.0], [0.0, 2e7]], 1e3) for name in ends]
    force, moment = [50.0, 20.0, 0.0], [1.0, 2.0, 0.0]
    loads = [er.HarmonicForce("left", force, moment), er.BaseAcceleration([0.0, G])]
    for speed, within in ((0.0, 1e-9), (200.0, 1e-4)):  # at a speed the mesh is taken for round
        found = er.static_response(
            rotor, {"left": force + moment}, gravity=DOWN, supports=supports, speed=speed
        )
        given = {"speed": speed, "supports": supports, "accuracy": None}
        harmonic = er.harmonic_response(rotor, [0.0], loads, **given)
        for name in ends:
            phasors = [harmonic.phasor(name, d, 0)[0].real for d in ("n1", "n2", "tilt n1")]
            motion = [*found.deflection(name)[:2], found.rotation(name)[0]]
            assert motion == pytest.approx(phasors, abs=within * np.abs(motion).max())
        assert found.deflection("left")[1] < 0.0 < found.reaction("right")[1]


def test_loads_that_turn_with_the_rotor():
    rotor = disc()
    supports = [er.Support(name, 1e7, 2e4) for name in ("left", "right")]
    load, speed = [50.0, 20.0, 0.0], 150.0
    given = {"supports": supports, "speed": speed}
    found, unloaded = (
        er.static_response(rotor, {"left": f}, frame="rotor", **given) for f in (load, [0.0] * 3)
    )
    force = er.HarmonicForce("left", load, frame="rotor")
    harmonic = er.harmonic_response(rotor, [0.0], force, frame="rotor", **given, accuracy=None)
    phasors = [harmonic.phasor("right", d, 0)[0].real for d in ("n1", "n2")]
    moved = (found.motion - unloaded.motion)[found.places.index("right")]
    assert moved[:2] == pytest.approx(phasors, rel=1e-6)
    # a damper that stands still resists the turning motion: −K u − Ω D (e × u)
    u = found.deflection("left")[:2]
    pull = -1e7 * u - speed * 2e4 * np.array([-u[1], u[0]])
    assert found.reaction("left")[:2] == pytest.approx(pull, rel=1e-9)
    with pytest.raises(ValueError, match="gravity: stands still"):
        er.static_response(rotor, gravity=DOWN, frame="rotor", **given)
    uneven = [er.Support("left", np.diag([1e7, 2e7])), supports[1]]
    with pytest.raises(ValueError, match="frame: the supports are not alike"):
        er.static_response(rotor, supports=uneven, speed=speed, frame="rotor")


SHORT = {"radius": 0.01, "length": 0.01, "clearance": 5e-5, "viscosity": 0.05}
ROLLING = {"count": 8, "pitch_radius": 0.0326, "element_radius": 0.006, "stiffness": 7e9}
PID = {"proportional": 2e4, "derivative": 20.0, "filter_frequency": 2e4, "amplifier_frequency": 1e4}
MAGNETS = er.SaturatingActuator(constant=1e-5, bias_current=2.0, gap=4e-4, current_limit=6.0)


def magnetic(name: str, **changes) -> er.MagneticBearing:
    pid = er.PIDController(**PID, integral=changes.pop("integral", 0.0))
    return er.MagneticBearing(interface=name, actuator=MAGNETS, controller=pid, **changes)


def films(*names: str) -> list[er.ShortJournalBearing]:
    return [er.ShortJournalBearing(interface=name, **SHORT) for name in names]


KINDS = {
    "five films": (films("0", "1", "2", "3", "4"), 300.0),
    "rolling": (
        [er.RollingBearing(interface=n, clearance=c, **ROLLING)
         for n, c in (("0", 5e-6), ("2", 2e-6), ("4", -1e-6))], 0.0,
    ),
    "a stop that rubs": (
        [*(er.Support(n, 1e5) for n in ("0", "4")),
         er.ClearanceStop(interface="2", radius=0.02, clearance=1e-5, stiffness=1e7, friction=0.1)],
        100.0,
    ),
}  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_bearings_rest_where_a_scene_has_them(kind):
    rotor, (supports, speed) = beam(1), KINDS[kind]
    found = er.static_response(rotor, gravity=DOWN, supports=supports, speed=speed)
    mbs = exudyn.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rotor, spin=speed, translation="none", gravity=DOWN)
    er.add_supports(body, supports)
    mbs.Assemble()
    steady = er.steady_state(body)
    places = np.array([steady.interface_motion(one.interface)[:2] for one in supports])
    assert found.journals[:, :2] == pytest.approx(places, abs=1e-6 * np.abs(places).max())
    assert found.reactions[:, 1].sum() == pytest.approx(weight(rotor), rel=1e-8)


def test_magnets_rest_in_the_centre_by_an_integral_and_by_the_gain_where_the_law_says():
    rotor, half = beam(), 0.5 * weight(beam())
    for integral, exact in ((0.0, 1e-9), (1e5, 1e-12)):
        ends = [magnetic(name, integral=integral) for name in ("0", "16")]
        found = er.static_response(rotor, gravity=DOWN, supports=ends)
        place = ends[0].equilibrium(0.0, [0.0, -half])
        assert found.journal("0") == pytest.approx(place, rel=exact, abs=1e-12)
        assert found.reactions[:, 1] == pytest.approx([half, half], rel=1e-6)


def test_points_of_a_foundation_that_hold_no_rotor_move_with_it():
    rotor, sway = block().interface_at("a", 0.05, 0.06).interface_at("b", 0.25, 0.06), np.eye(3, 2)
    foundation = er.Foundation(
        5.0 * np.eye(2), np.zeros((2, 2)), 2e5 * np.eye(2), dict.fromkeys(("a", "b", "motor"), sway)
    )
    supports = [er.Support(name, 1e7) for name in "ab"]
    model = er.linear_model(rotor.reduce(0), supports=supports, foundation=foundation)
    found = er.static_response(model, {"a": [30.0, 0.0, 0.0]})
    assert found.deflection("motor (foundation)") == pytest.approx([30.0 / 2e5, 0.0, 0.0])
    found.plot()
    pyplot.close("all")


FILM = films("12")[0]
BALL = er.RollingBearing(interface="12", clearance=5e-6, **ROLLING)
SPRING = er.Support("12", [[5e6, 0.0], [1e6, 4e6]])
SEAL = er.AnnularSeal(
    interface="12", radius=0.05, length=0.03, clearance=3e-4, pressure_drop=8e5, density=1000.0,
    viscosity=1e-3,
)  # fmt: skip
PAIRS = (BALL, SPRING), (FILM, SPRING), (SPRING, FILM), (FILM, BALL), (SEAL, SPRING)
SERIES = [er.SeriesSupport(interface="12", inner=a, mass=3.0, outer=b) for a, b in PAIRS]
FLOATING = er.FloatingRingBearing(interface="12", inner=FILM, outer=FILM, mass=0.1)


@pytest.mark.parametrize("one", [FILM, SEAL, FLOATING, *SERIES])
def test_parts_of_a_bearing_rest_where_each_does_alone_under_the_same_load(one):
    between, speed, ring = [4.0, -G, 0.0], 300.0, 0.0  # two balls
    supports = [one, er.Support("0", 1e7)]
    found = er.static_response(beam(), gravity=between, supports=supports, speed=speed)
    load, place = -found.reactions[0, :2], np.zeros(2)
    if one is FLOATING:
        ring = replace(one, load=load).ring(speed).speed
    parts = [one] if one in (FILM, SEAL) else [one.inner, one.outer]
    for part, rate in zip(parts, (speed + ring, ring or speed), strict=False):
        if part in (SEAL, SPRING):
            linear = part.linearised() if part is SEAL else part
            place += np.linalg.solve(linear.matrices(rate)[0][:2, :2], load)
        else:
            place += part.equilibrium(rate, load)
    assert found.journal("12") == pytest.approx(place, rel=1e-7)
    assert "2864.79 rpm" in found.table()
    assert load[1] == pytest.approx(-weight(beam()) * 2.0 / 3.0, rel=1e-8)


def geared(loads, **driven):
    """Return the force of the teeth of a pinion and a wheel of twice its radius, with torques."""
    mesh = er.Link("pinion:8", "wheel:8", er.GearMesh(radii=[0.05, 0.1], stiffness=1e7))
    held = [er.Support(name, 1e7 * np.eye(3)) for name in ("0", "16")]
    ratios = {"pinion": 1.0, "wheel": -0.5}
    rotors, supports = dict.fromkeys(ratios, beam()), dict.fromkeys(ratios, held)
    train = er.RotorTrain(rotors, ratios, supports, [mesh], **driven)
    loads = {place: [0.0] * 5 + [torque] for place, torque in loads.items()}
    return np.hypot(*er.static_response(train, loads, speed=100.0).reactions[-1, :2])


def test_teeth_carry_the_torque_that_is_balanced_or_driven():
    assert geared({"pinion:0": 10.0, "wheel:16": 20.0}) == pytest.approx(20.0 / 0.1, rel=1e-6)
    assert geared({"wheel:16": 20.0}, driven=["pinion"]) == pytest.approx(20.0 / 0.1, rel=1e-6)


def test_a_basis_without_static_flexibility_is_told():
    rotor = block()
    supports = [er.Support(n, 1e10 * np.eye(3)) for n in ("left", "right")]
    exact = er.static_response(rotor, gravity=DOWN, supports=supports)
    with pytest.warns(UserWarning, match="a static deflection or reaction errs by about"):
        found = er.static_response(rotor.reduce(2), gravity=DOWN, supports=supports, accuracy=1e-4)
    assert found.basis_errors.shape == (len(found.places),)
    assert found.reactions.sum() == pytest.approx(exact.reactions.sum(), rel=1e-6)


ALONG, ACROSS = {"8": [0.0, 0.0, 5.0]}, {"8": [0.0, 5.0, 0.0]}


def static(loads, *supports, **options):
    supports = supports or [er.Support(name, 1e7) for name in ("0", "16")]
    return er.static_response(beam(), loads, supports=supports, **options)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: static(ACROSS, *films("0"), frame="rotor", speed=9.0), "'0' stands still"),
        (lambda: static(ACROSS).von_mises, "stress=True"),
        (lambda: static(ACROSS, *films("0", "16")), "without rotation"),
        (lambda: geared({"pinion:0": 10.0, "wheel:16": -20.0}), "torque about the axis over"),
        (lambda: static(ALONG), "translation along axis.*no support holds"),
        (lambda: static(ACROSS, er.Support("0", 1e7)), "no support holds"),
        (lambda: static({"8": [1.0, 2.0]}), "needs 3 or 6 numbers"),
        (lambda: static({"no": [1.0, 2.0, 3.0]}), "no such interface"),
        (lambda: static([1.0, 2.0, 3.0]), "loads: needs a dictionary"),
    ],
)
def test_it_says_what_to_do(call, message):
    with pytest.raises((TypeError, ValueError), match=message):
        call()
