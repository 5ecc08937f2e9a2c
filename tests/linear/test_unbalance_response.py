"""Unbalance responses against closed forms, a simulation in time and the equations of motion."""

import numpy as np
import pytest
from forced_models import (
    EXACT,
    LENGTH,
    MASS,
    RADIUS,
    SPEEDS,
    TILT_C,
    TILT_K,
    C,
    K,
    close,
    held,
    oscillator,
    rings,
)
from point_rotors import random_rotor, ring_rotor

from exudyn_rotor import (
    SpinAxis,
    Support,
    Unbalance,
    linear_model,
    permissible_unbalance,
    unbalance_response,
)
from exudyn_rotor.linear.response.loads import unbalance_load
from exudyn_rotor.linear.solve.forced import forced_motions


def test_own_unbalance_is_the_jeffcott_rotor():
    # Friswell, Penny, Garvey, Lees, Dynamics of Rotating Machines (2010), Sect. 6.2:
    # z = m e Ω² / (k − mΩ² + i c Ω) exp(iΩt), circular and forward
    response = unbalance_response(rings(point_mass=0.01), SPEEDS, supports=held(), at="mid")
    expected = 0.02 * RADIUS * SPEEDS**2 * oscillator(K, C, MASS + 0.02, SPEEDS)
    forward, backward = response.whirl()
    assert list(response.orders) == [1]
    assert close(forward, expected)
    assert np.abs(backward).max() < EXACT * np.abs(expected).max()
    assert close(response.phasor("mid", "n2"), -1j * expected)


def test_unbalance_at_an_interface_has_size_and_angle():
    response = unbalance_response(
        rings(), SPEEDS, [Unbalance("mid", 1e-4, 0.7)], own=False, supports=held(), at="mid"
    )
    expected = 1e-4 * np.exp(0.7j) * SPEEDS**2 * oscillator(K, C, MASS, SPEEDS)
    assert close(response.phasor(), expected)


def test_couple_unbalance_tilts_against_the_gyroscopic_moment():
    # forward synchronous whirl of a rigid rotor: (k − (I_t − I_p)Ω² + i c Ω) φ = 2 l U Ω²
    pair = [Unbalance("right", 1e-4), Unbalance("left", 1e-4, np.pi)]
    response = unbalance_response(rings(), SPEEDS, pair, supports=held(), at="mid")
    polar, transverse = MASS * RADIUS**2, MASS * (0.5 * RADIUS**2 + LENGTH**2)
    expected = 2 * LENGTH * 1e-4 * SPEEDS**2
    expected = expected * oscillator(TILT_K, TILT_C, transverse - polar, SPEEDS)
    assert close(response.phasor("mid", "tilt n2"), expected)
    assert close(response.phasor("mid", "tilt n1"), 1j * expected)


def test_anisotropic_supports_make_the_ellipse_of_two_oscillators():
    supports = held(np.diag([K, 2 * K]), np.diag([C, 3 * C]))
    response = unbalance_response(
        rings(), SPEEDS, [Unbalance("mid", 1e-4)], own=False, supports=supports, at="mid"
    )
    x = 1e-4 * SPEEDS**2 * oscillator(K, C, MASS, SPEEDS)
    y = -1j * 1e-4 * SPEEDS**2 * oscillator(2 * K, 3 * C, MASS, SPEEDS)
    assert list(response.orders) == [1]
    assert close(response.phasor(), x)
    assert close(response.phasor("mid", "n2"), y)
    # the semi-axes are the singular values of the ellipse's two phases
    phases = np.stack([[x.real, -x.imag], [y.real, -y.imag]]).transpose(2, 0, 1)
    major, minor = response.semi_axes()
    assert close(major, np.linalg.norm(phases, 2, axis=(1, 2)), 1e-9)
    assert close(minor, np.linalg.det(phases) / np.maximum(major, 1e-300), 1e-9)
    assert minor[np.argmin(np.abs(SPEEDS - 240.0))] < 0.0  # backward between the critical speeds


def test_between_anisotropic_criticals_the_rotor_frame_sees_twice_the_speed():
    supports = held(np.diag([K, 2 * K]))
    options = {"unbalances": [Unbalance("mid", 1e-4)], "own": False, "supports": supports}
    inertial = unbalance_response(rings(), [240.0], at="mid", **options)
    turning = unbalance_response(rings(), [240.0], at="mid", frame="rotor", **options)
    assert list(turning.orders) == [0, 2]
    forward, backward = inertial.whirl()
    constant, double = (turning.phasor("mid", "n1", n) for n in (0, 2))
    # z exp(−iθ) = forward + backward exp(−2iθ)
    assert constant == pytest.approx(forward.real, rel=1e-9)
    assert close(double, backward.conj(), 1e-9)


def test_node_moves_with_a_rigid_rotor():
    pair = [Unbalance("right", 1e-4), Unbalance("left", 2e-4, 2.0)]
    options = {"supports": held(), "frame": "rotor", "own": False}
    response = unbalance_response(rings(), [150.0], pair, at=["mid", (0.1, 0, 0.2)], **options)
    assert response.places == ("mid", "node 5")
    middle, node = response.motion[0, :, 0]
    arm = np.array([RADIUS, 0.0, LENGTH])
    assert np.allclose(node[:3], middle[:3] + np.cross(middle[3:], arm), rtol=0, atol=1e-12)
    assert np.all(np.isnan(node[3:]))
    same = unbalance_response(
        rings(), [150.0], [Unbalance((0.1, 0, 0.2), 1e-4)], at="mid", **options
    )
    other = unbalance_response(rings(), [150.0], [Unbalance("right", 1e-4)], at="mid", **options)
    # through an off-axis node a radial force has the same moment about the middle
    assert np.allclose(same.motion, other.motion, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("grade", "speed_rpm", "specific"),
    [(6.3, 3000.0, 20.05e-6), (2.5, 3000.0, 7.958e-6), (1.0, 60000.0, 0.15915e-6)],
)
def test_balance_grade(grade, speed_rpm, specific):
    # ISO 21940-11:2016: G = e_per Ω; e_per in m written out to four digits
    speed = speed_rpm * np.pi / 30.0
    assert permissible_unbalance(grade, 8.0, speed) == pytest.approx(8.0 * specific, rel=2e-4)
    half = Unbalance.from_grade("left", grade, 8.0, speed, share=0.5, angle=1.0)
    assert half.amount == pytest.approx(4.0 * specific, rel=2e-4)


STIFFNESS, DAMPING = (2e5, 3e5), (500.0, 400.0)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"speeds": [1.0, -2.0]}, "speeds: needs .* in ascending order"),
        ({"speeds": [-1.0, 2.0]}, "-1 is negative"),
        ({"speeds": [1.0, np.nan]}, "finite numbers"),
        ({"speeds": []}, "speeds: needs at least one number"),
        ({"at": ["left", "left"]}, "at: 'left' is given twice"),
        ({"at": "top"}, "no such interface; the rotor has: mid, left, right"),
        ({"at": 10}, "nodes 0 to 9"),
        ({"at": [(0.0, 1.0)]}, "needs the name of an interface"),
        ({"at": []}, "no interfaces"),
        ({"frame": "moving"}, "frame: 'moving' is unknown"),
        ({"tolerance": 0.0}, "tolerance"),
        ({"unbalances": [Unbalance("top", 1.0)]}, "no such interface"),
    ],
)
def test_bad_input_is_named(changes, message):
    arguments = {"speeds": [1.0], "unbalances": [Unbalance("mid", 1e-4)], "supports": held()}
    with pytest.raises(ValueError, match=message):
        unbalance_response(rings(), **(arguments | changes))


@pytest.mark.parametrize("supports", [held(), held(np.diag([K, 2 * K]), np.diag([C, 3 * C]))])
@pytest.mark.filterwarnings("ignore:the centre of mass is")
def test_nothing_of_an_uneven_rotor_is_averaged(supports):
    """``M ẍ + D ẋ + K x = f`` at every angle, the supports turned into the rotor by sampling.

    The rotor has one mass beside its axis, and no spin that could follow: ω = Ω rotor-fixed load.
    """
    speed, rotor = 170.0, rings(modes=4, point_mass=0.3)
    model = linear_model(rotor, supports=supports, stiffening="none").for_responses
    load = {n: speed**2 * F for n, F in unbalance_load(model, (), own=True).items()}
    stack, held = model.at_all([speed]), model.held_basis
    found = forced_motions(stack, load, np.zeros(1), held=held, tolerance=1e-9)
    inv = rotor.invariants.moved(rotor.axis.project(rotor.center_of_mass) - rotor.center_of_mass)
    U = rotor.interfaces["mid"].motion
    orders, x = np.array(list(found)), np.concatenate(list(found.values()))
    for angle in np.linspace(0.0, 2.0 * np.pi, 5):
        waves = np.exp(1j * orders * angle)[:, None]
        y, v, a = ((x * waves * (1j * orders[:, None] * speed) ** p).sum(axis=0).real
                   for p in range(3))  # fmt: skip
        c, s = np.cos(angle), np.sin(angle)
        R = np.kron(np.eye(2), [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        R_t = speed * np.kron(np.eye(2), [[-s, -c, 0.0], [c, -s, 0.0], [0.0, 0.0, 0.0]])
        seen, seen_t = R @ U @ y, R @ U @ v + R_t @ U @ y
        stiffness, damping = supports[0].matrices(speed)
        force = -U.T @ R.T @ (stiffness @ seen + damping @ seen_t)
        inner = inv.M @ a + (inv.D + 2.0 * speed * inv.G) @ v
        inner += (inv.K - speed**2 * inv.C) @ y
        off = inner - force - speed**2 * inv.h
        lateral = [i for i, kind in enumerate(rotor.kinds) if kind.value != "spin"]
        assert np.abs(off[lateral]).max() < 1e-6 * speed**2 * np.abs(inv.h).max()


@pytest.mark.parametrize("arm", [3e-6, 1e-4])
def test_bearings_micrometres_off_the_axis_do_not_hold_the_spin(arm):
    """By that arm, as a mesh has it, they hold it next to nothing: the rotor would turn far."""
    rotor = ring_rotor(RADIUS, LENGTH, MASS, SpinAxis([0, 0, 1], [arm, 0, 0]))
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10))
    supports = [Support(name, np.diag([1e4, 1.5e4]), 100.0) for name in ("left", "right")]
    found = unbalance_response(rotor, [150.0], Unbalance("left", 1e-4), supports=supports)
    assert np.abs(found.motion[..., 5]).max() < 1e-6


def test_tables_that_end_early_give_what_they_cover():
    table = [Support("mid", ([0.0, 450.0], [K, K]), C, TILT_K, TILT_C)]
    given = {"own": False, "supports": table, "at": "mid"}
    with pytest.warns(UserWarning, match=r"no values at 460, 480, .* rad/s, which are NaN") as told:
        response = unbalance_response(rings(), SPEEDS, Unbalance("mid", 1e-4), **given)
    assert len(told) == 1
    known = SPEEDS <= 450.0
    expected = 1e-4 * SPEEDS**2 * oscillator(K, C, MASS, SPEEDS)
    assert close(response.phasor()[known], expected[known])
    assert np.all(np.isnan(response.motion[~known]))
    assert response.table().count("\n") > len(SPEEDS)  # also lines of speeds without a motion
    with pytest.raises(ValueError, match=r"needs the largest speed|450"):
        unbalance_response(rings(), [500.0, 600.0], Unbalance("mid", 1e-4), **given)


def test_resonance_without_damping_is_not_a_number():
    supports = [Support("mid", K, 0.0, TILT_K)]
    given = (rings(), [100.0, 200.0], Unbalance("mid", 1e-4))
    with pytest.warns(UserWarning, match=r"at 200 rad/s, NaN there: .* nothing damps a resonance"):
        response = unbalance_response(*given, own=False, supports=supports, at="mid")
    assert np.isfinite(response.phasor()).tolist() == [True, False]


def test_own_eccentricity_is_told_in_gram_millimetres():
    rotor = rings(point_mass=0.01)  # 2 x 10 g at 100 mm
    found = unbalance_response(rotor, [100.0], Unbalance("mid", 1e-3), supports=held())
    assert (
        found.loads[1]
        == "eccentricity of the rotor, with its mesh: 2000 g mm, 2 of the amount given"
    )
    alone = unbalance_response(rotor, [100.0], Unbalance("mid", 1e-3), own=False, supports=held())
    assert len(alone.loads) == 1


def test_negative_speeds_are_the_mirror_image():
    given = {"own": False, "supports": held(), "at": "mid", "allow_negative": True}
    response = unbalance_response(rings(), [-300.0, 0.0, 300.0], Unbalance("mid", 1e-4), **given)
    x, y = response.phasor(), response.phasor("mid", "n2")
    assert close(x[0], x[2].conj())
    assert close(y[0], -y[2].conj())
    assert x[1] == 0.0


def test_errors_by_the_basis_are_found_at_peaks_and_ends():
    rotor = random_rotor(7, "z").with_interface("a", [0, 1, 2]).with_interface("b", [3, 4, 5])
    supports = [Support(name, 2.0, 0.05, 1.0, 0.05) for name in "ab"]
    given = (np.linspace(0.2, 1.2, 41), Unbalance("a", 1e-2))
    options = {"supports": supports, "own": False}
    with pytest.warns(
        UserWarning, match="errs by about .* too few for the accuracy of 0.01"
    ) as told:
        few = unbalance_response(rotor.reduce(6), *given, **options)
    assert len(told) == 1
    known = np.isfinite(few.basis_errors[:, 0])
    assert known[[0, 20, 40]].all()
    assert known.sum() < 20
    assert "basis error" in few.table()
    off = unbalance_response(rotor.reduce(6), *given, **options, accuracy=None)
    assert off.basis_errors is None
    assert off.table().splitlines()[-2].startswith("error of the basis: not known")
    exact = unbalance_response(rotor.reduce(12), *given, **options)
    assert np.nanmax(exact.basis_errors) < 1e-9
