"""Several rotors in linear analyses: against closed forms, ROSS, and one rotor of their parts."""

import dataclasses
import itertools
import json
from functools import cache
from pathlib import Path

import exudyn
import numpy as np
import pytest
import scipy.linalg as la
from netgen import occ
from point_rotors import free_stiffness, ring_rotor
from scipy.integrate import solve_ivp

from exudyn_rotor import (
    GearMesh,
    HarmonicForce,
    Link,
    ReducedRotor,
    RotorTrain,
    SolidRotor,
    Support,
    Unbalance,
    add_rotor,
    add_supports,
    campbell,
    craig_bampton_modes,
    critical_speeds,
    harmonic_response,
    linear_model,
    recommended_settings,
    stability,
    unbalance_response,
)
from validation.references.benchmark_rotors import meshed

ROSS = json.loads(
    (Path(__file__).parents[1] / "validation/references/rotor_trains_ross.json").read_text()
)
LATERAL = ("forward", "backward", "mixed")
AXIS = {"x": [1.0, 0.0, 0.0], "z": [0.0, 0.0, 1.0]}
# radius, half length and mass of two rigid rotors; stiffness and damping of springs
FIRST, SECOND = (0.2, 0.05, 4.0), (0.15, 0.08, 3.0)
GROUND, BETWEEN = (3e5, 20.0), (2e5, 15.0)
UNEVEN = np.array([[3e5, 2e4], [-1e4, 2e5]])


def rings(radius: float, half: float, mass: float, axis: str = "z") -> SolidRotor:
    """Return two rings of masses with the interfaces 'a' (lower) and 'b'."""
    made = ring_rotor(radius, half, mass)
    turned = np.roll(np.array(made.nodes), 1 if axis == "x" else 0, axis=1)
    made = SolidRotor.from_matrices(
        made.mass, free_stiffness(turned, 1e8 * np.eye(30)), turned, axis
    )
    along = turned @ AXIS[axis]
    return made.with_interface("a", np.flatnonzero(along < 0)).with_interface(
        "b", np.flatnonzero(along > 0)
    )


@cache
def rigid(*dimensions: float, axis: str = "z") -> ReducedRotor:
    """Return a rigid rotor."""
    return rings(*dimensions, axis).reduce(0)


def two_discs(ratio: float, ground=GROUND[0], axis: str = "z", **changes) -> RotorTrain:
    """Return two rigid rotors, the second on the first and softly on the ground."""
    k, c = BETWEEN
    links = [Link(f"A:{n}", f"B:{n}", Support(n, f * k, c)) for n, f in (("a", 1.0), ("b", 1.5))]
    stiff = np.asarray(ground) * np.ones((2, 2)) if np.ndim(ground) else ground * np.eye(2)
    supports = {
        "A": [Support("a", stiff, GROUND[1]), Support("b", 1.3 * stiff, GROUND[1])],
        "B": [Support("b", 5e4)],
    }
    rotors = {"A": rigid(*FIRST), "B": rigid(*SECOND, axis=axis)}
    return RotorTrain(rotors, {"A": 1.0, "B": ratio}, supports, links, **changes)


def at(rotor: int, z: float) -> np.ndarray:
    """Return displacement at z, x + βz and y − αz, by the coordinates of both rotors."""
    rows = np.zeros((2, 8))
    rows[:, 4 * rotor : 4 * rotor + 4] = [[1.0, 0.0, 0.0, z], [0.0, 1.0, -z, 0.0]]
    return rows


def by_hand(
    ratio: float, speed: float, ground=GROUND[0], damped: bool = True, second=SECOND
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return M, D and K of two rigid rotors: per rotor x, y and the tilts α, β about them.

    ``I_t α̈ + I_p Ω β̇ = M_α, I_t β̈ − I_p Ω α̇ = M_β``.
    """
    M, D, K = np.zeros((8, 8)), np.zeros((8, 8)), np.zeros((8, 8))
    for o, (r, half, m), rate in ((0, FIRST, speed), (4, second, ratio * speed)):
        polar, transverse = m * r**2, m * (0.5 * r**2 + half**2)
        M[range(o, o + 4), range(o, o + 4)] = m, m, transverse, transverse
        D[o + 2, o + 3], D[o + 3, o + 2] = polar * rate, -polar * rate
    stiff = ground if np.ndim(ground) else ground * np.eye(2)
    (za, zb), (k, c) = (FIRST[1], second[1]), BETWEEN
    for rows, spring, damper in (
        (at(0, -za), stiff, GROUND[1]),
        (at(0, za), 1.3 * stiff, GROUND[1]),
        (at(1, zb), 5e4 * np.eye(2), 0.0),
        (at(0, -za) - at(1, -zb), k * np.eye(2), c),
        (at(0, za) - at(1, zb), 1.5 * k * np.eye(2), c),
    ):
        K += rows.T @ spring @ rows
        D += damped * damper * rows.T @ rows
    return M, D, K


def exponents_of(M: np.ndarray, D: np.ndarray, K: np.ndarray) -> np.ndarray:
    """Return the exponents with Im λ > 0."""
    zero, one = np.zeros_like(M), np.eye(len(M))
    values = la.eigvals(np.block([[zero, one], [-la.solve(M, K), -la.solve(M, D)]]))
    return values[values.imag > 0.0]


def lateral(result, row: int = -1) -> np.ndarray:
    """Return growth + i inertial frequency of lateral modes, ascending in frequency."""
    chosen = np.isin(result.whirl[row], LATERAL)
    values = result.growth[row, chosen] + 1j * result.frequencies_inertial[row, chosen]
    return values[np.argsort(values.imag)]


@pytest.mark.parametrize("ratio", [1.7, -1.3, 1.0])
@pytest.mark.parametrize("ground", [GROUND[0], UNEVEN], ids=["isotropic", "cross-coupled"])
def test_two_rigid_discs_are_those_of_the_closed_form(ratio, ground):
    """Constant equations, or Hill's method: both to the rounding of an eigenvalue."""
    found = campbell(two_discs(ratio, ground), [0.0, 300.0])
    for row, speed in enumerate(found.speeds):
        exact = exponents_of(*by_hand(ratio, speed, ground))
        exact = exact[np.argsort(exact.imag)]
        np.testing.assert_allclose(lateral(found, row), exact, rtol=1e-9, atol=1e-7)


def test_axes_of_meshes_do_not_matter():
    """Axes (n1, n2, e) of all rotors are parallel, wherever the axis is in the mesh."""
    straight, turned = (
        lateral(campbell(two_discs(1.7, axis=axis), [0.0, 300.0])) for axis in ("z", "x")
    )
    np.testing.assert_allclose(turned, straight, rtol=1e-9, atol=1e-7)


def test_a_counter_rotating_pair_has_no_preferred_sense():
    """Two equal rotors, one turning back: every frequency twice, forward and backward alike."""
    rotor = rigid(*FIRST)
    supports = {name: [Support("a", 3e5), Support("b", 3e5)] for name in "AB"}
    links = [Link(f"A:{n}", f"B:{n}", Support(n, 2e5)) for n in "ab"]
    train = RotorTrain({"A": rotor, "B": rotor}, {"A": 1.0, "B": -1.0}, supports, links)
    values = lateral(campbell(train, [0.0, 400.0])).imag
    np.testing.assert_allclose(values[::2], values[1::2], rtol=1e-9)
    assert np.ptp(values[::2]) > 100.0


@pytest.mark.parametrize("order", [1.0, 1.7])
def test_critical_speeds_by_unbalance_of_either_rotor(order):
    """``Im λ(Ω) = pΩ`` of the closed form without damping; relative to the rotor as well."""
    train = two_discs(1.7)
    found = critical_speeds(train, order=order, nodal_diameters=[1]).speeds
    for speed in found:
        exact = exponents_of(*by_hand(1.7, speed, damped=False)).imag
        assert np.abs(exact / (order * speed) - 1.0).min() < 1e-9
    if order != 1.0:
        again = critical_speeds(train.relative_to("B"), nodal_diameters=[1]).speeds
        np.testing.assert_allclose(again / order, found, rtol=1e-8)


def test_rotors_of_one_speed_are_one_rotor():
    """At the ratio 1, springs between two rotors are springs inside one."""
    first, second = rings(*FIRST), rings(*SECOND)
    K = la.block_diag(first.stiffness.toarray(), second.stiffness.toarray())
    spring = np.diag([2e5, 2e5, 3e5])
    for name in "ab":
        U = np.hstack(
            [s * r.interfaces[name].mean_motion(10).toarray()[:3]
             for s, r in ((1.0, first), (-1.0, second))]
        )  # fmt: skip
        K += U.T @ spring @ U
    mass = la.block_diag(first.mass.toarray(), second.mass.toarray())
    joined = SolidRotor.from_matrices(mass, K, np.vstack([first.nodes, second.nodes]), "z")
    ground = [Support("a", 3e5, 20.0), Support("b", 4e5, 5.0)]
    inner = Support("b", damping=30.0, frame="rotor")
    for n in "ab":
        joined = joined.with_interface(n, first.interfaces[n].nodes)
    single = stability(joined, [250.0], supports=[*ground, inner], stiffening="none")
    rotors = {"A": first.reduce(24), "B": second.reduce(24)}
    links = [Link(f"A:{n}", f"B:{n}", Support(n, spring)) for n in "ab"]
    train = RotorTrain(rotors, {"A": 1.0, "B": 1.0}, {"A": [*ground, inner]}, links)
    both = stability(train, [250.0], stiffening="none")
    # the one rotor has more: the turn of its parts against each other, softened without a spring
    exact, found = (r.exponents[0][np.abs(r.exponents[0]) < 2e3] for r in (single, both))
    found = found[np.abs(found) > 0.1]
    assert len(found) == 18
    assert np.abs(found[:, None] - exact).min(axis=1).max() < 1e-6


@cache
def spool(name: str) -> ReducedRotor:
    """Return a spool of the reference as a solid, its discs rigid."""
    data, cut = ROSS["spools"][name], ROSS["between"]["position"]
    start, end = data["start"], data["start"] + data["length"]
    ends = [start, cut, end] if cut < end - 1e-9 else [start, end]
    parts = []
    for low, high in itertools.pairwise(ends):
        tube = [
            occ.Cylinder(occ.Pnt(0, 0, low), occ.Z, 0.5 * data[d], high - low)
            for d in ("diameter", "bore")
            if data[d] > 0.0
        ]
        parts.append(tube[0] - tube[1] if len(tube) == 2 else tube[0])
    parts[0].faces.Max(occ.Z).name = "middle"
    parts[0].faces.Min(occ.Z).name, parts[-1].faces.Max(occ.Z).name = "front", "rear"
    size = 0.06 if len(parts) == 2 else 0.03
    rotor = meshed(occ.Glue(parts), size, ROSS["material"], 1.0)
    for disc in data["discs"]:
        inertia = disc["polar"], disc["transverse"]
        rotor = rotor.add_disc(disc["position"], disc["mass"], inertia, disc["width"])
    return rotor.reduce(craig_bampton_modes(rotor, 8, coupling="RBE3"), prestress=True)


def dual_spool(ratio: float) -> RotorTrain:
    """Return the dual spool of the reference."""
    (_, _, front), (_, _, rear), (_, _, outer) = ROSS["springs"]
    between = Support("middle", ROSS["between"]["stiffness"], ROSS["between"]["damping"])
    return RotorTrain(
        {name: spool(name) for name in ("inner", "outer")},
        {"inner": 1.0, "outer": ratio},
        {"inner": [Support("front", front), Support("rear", rear)],
         "outer": [Support("front", outer)]},
        [Link("inner:middle", "outer:rear", between)],
    )  # fmt: skip


@pytest.mark.parametrize("ratio", [1.5, -1.3])
def test_dual_spool_against_ross(ratio):
    """Frequencies of beams within the give of a solid's sections, which speed does not change."""
    found = campbell(dual_spool(ratio), ROSS["speeds"], accuracy=None)
    exact = ROSS["dual"][str(ratio)]
    errors = []
    for row, reference in enumerate(exact):
        values = lateral(found, row)[: len(reference["frequencies"])]
        errors.append(values.imag / reference["frequencies"] - 1.0)
        np.testing.assert_allclose(values.real, reference["growth"], rtol=0.05, atol=0.1)
    # the mesh of this test errs by 1 %, one with three times the nodes by half of that
    assert np.abs(errors).max() < 1.2e-2
    assert np.abs(np.diff(errors, axis=0)).max() < 2.5e-3
    assert stability(dual_spool(ratio), ROSS["speeds"][-1:], accuracy=None).stable[0]


@pytest.mark.parametrize(("name", "order"), [("inner", 1.0), ("outer", 1.5)])
def test_critical_speeds_of_the_dual_spool_against_ross(name, order):
    """By unbalance of each spool, in speeds of the inner one."""
    found = critical_speeds(
        dual_spool(1.5), order=order, nodal_diameters=[1], max_speed=4000.0, accuracy=None
    )
    forward = found.speeds[np.array(found.whirl) == "forward"][:4]
    np.testing.assert_allclose(forward, ROSS["critical"][name], rtol=1.2e-2)


def test_stiffness_of_a_link_moves_between_free_and_one():
    """A link that gives way leaves two rotors alone; a stiff one makes them move as one."""
    free = two_discs(1.7)
    soft = [Link(link.first, link.second, Support(link.connection.interface, 1e-6))
            for link in free.links]  # fmt: skip
    parted = campbell(RotorTrain(free.rotors, free.ratios, free.supports, soft), [0.0, 300.0])
    alone = campbell(free.rotors["A"], [0.0, 300.0], supports=free.supports["A"])
    for value in lateral(alone):
        assert np.abs(lateral(parted) - value).min() < 1e-5


def test_axisymmetric_part_and_what_is_left():
    """Mean over a turn: even to rounding for rings, of the mesh for a solid."""
    assert linear_model(two_discs(1.7)).unevenness["B"] < 1e-12
    train = dual_spool(1.5)
    assert 1e-3 < linear_model(train).unevenness["outer"] < 5e-2
    assert 1e-3 < linear_model(train.relative_to("outer")).unevenness["inner"] < 5e-2


def bar() -> ReducedRotor:
    """Return a rigid rotor whose transverse moments differ: four masses on two bars."""
    nodes = np.array([[0.2, 0, -0.05], [-0.2, 0, -0.05], [0.2, 0, 0.05], [-0.2, 0, 0.05]])
    K = free_stiffness(nodes, 1e8 * np.eye(12))
    made = SolidRotor.from_matrices(np.eye(12), K, nodes, "z")
    return made.with_interface("a", [0, 1]).with_interface("b", [2, 3]).reduce(0)


def test_bad_trains_are_refused():
    rotor, spring = rigid(*FIRST), Support("a", 1e5)
    both, ratios = {"A": rotor, "B": rotor}, {"A": 1.0, "B": 1.5}
    refused = [
        ({"A": rings(*FIRST)}, {"A": 1.0}, {}, "reduce a SolidRotor"),
        ({}, {}, {}, "at least one"),
        ({"A:1": rotor}, {"A:1": 1.0}, {}, "without a colon"),
        (both, {"A": 1.0}, {}, "one for each"),
        (both, {"A": 1.0, "B": 0.0}, {}, "foundation"),
        (both, ratios, {"supports": {"C": [spring]}}, "'C' is unknown"),
        (both, ratios, {"supports": {"A": [Support("c", 1.0)]}}, "no such interface"),
        (both, ratios, {"links": [Link("A:a", "C:a", spring)]}, "'C' is unknown"),
        (both, ratios, {"links": [Link("A:a", "B:c", spring)]}, "'c' is unknown"),
    ]
    for rotors, speeds, more, words in refused:
        with pytest.raises((TypeError, ValueError), match=words):
            RotorTrain(rotors, speeds, **more)
    with pytest.raises(ValueError, match="'rotor:interface', got 'Aa'"):
        Link("Aa", "B:a", spring)
    with pytest.raises(ValueError, match="is at 'a'"):
        Link("A:b", "B:a", spring)
    with pytest.raises(ValueError, match="same rotor"):
        Link("A:a", "A:b", spring)
    with pytest.raises(ValueError, match="'D' is unknown"):
        two_discs(1.7).relative_to("D")


def test_what_does_not_repeat_is_refused():
    """Uneven rotors and supports that turn, at ratios that are no whole numbers."""
    uneven = {"A": rigid(*FIRST), "B": bar()}
    springs = {"B": [Support("a", 1e5)]}
    with pytest.raises(ValueError, match=r"rotor 'B', whose unevenness is 0\.\d+ "):
        linear_model(RotorTrain(uneven, {"A": 1.0, "B": 1.7}, springs))
    linear_model(RotorTrain(uneven, {"A": 1.7, "B": 1.0}, springs))
    turning = Support("a", [[1e5, 0.0], [0.0, 2e5]], frame="rotor")
    train = two_discs(1.7)
    with pytest.raises(ValueError, match="B:a is not the same in all directions"):
        linear_model(RotorTrain(train.rotors, train.ratios, {"B": [turning]}))
    lossy = {"A": train.rotors["A"], "B": train.rotors["B"].with_damping(loss=0.01)}
    with pytest.raises(ValueError, match="structural damping"):
        linear_model(RotorTrain(lossy, train.ratios))
    with pytest.raises(ValueError, match="has its own"):
        linear_model(train, supports=[turning])


@pytest.mark.parametrize("ratio", [1.7, -1.3])
@pytest.mark.parametrize("ground", [GROUND[0], UNEVEN], ids=["isotropic", "cross-coupled"])
def test_unbalance_of_either_rotor(ratio, ground):
    """``(K + iωD − ω²M) x = ω²U(1, −i)``, ω the speed of the unbalanced rotor."""
    train, speeds = two_discs(ratio, ground), np.array([90.0, 250.0])
    for name, rate, rotor, half in (("A", 1.0, 0, FIRST[1]), ("B", ratio, 1, SECOND[1])):
        given = train.relative_to(name)
        values = np.sort(rate * speeds)
        found = unbalance_response(
            given, values, Unbalance(f"{name}:b", 1e-4), own=False, allow_negative=True
        )
        for row, omega in enumerate(values):
            M, D, K = by_hand(ratio, omega / rate, ground)
            load = 1e-4 * omega**2 * at(rotor, half).T @ [1.0, -1.0j]
            x = la.solve(K + 1j * omega * D - omega**2 * M, load)
            for place, exact in (("A:a", at(0, -FIRST[1]) @ x), ("B:b", at(1, SECOND[1]) @ x)):
                motion = found.motion[
                    row, found.places.index(place), found.orders.tolist().index(1)
                ]
                np.testing.assert_allclose(motion[:2], exact, rtol=1e-8, atol=1e-16)


def test_loads_that_turn_with_another_rotor_are_refused():
    train = two_discs(1.7)
    with pytest.raises(ValueError, match=r"'B:b': turns with 1\.7 times .*relative_to\('B'\)"):
        unbalance_response(train, [100.0], Unbalance("B:b", 1e-4))
    turning = HarmonicForce("B:b", [1.0, 0.0], frame="rotor")
    with pytest.raises(ValueError, match=r"turns with 1\.7 times"):
        harmonic_response(train, [100.0], turning, speed=50.0)
    still = harmonic_response(train, [100.0], HarmonicForce("B:b", [1.0, 0.0]), speed=50.0)
    M, D, K = by_hand(1.7, 50.0)
    x = la.solve(K + 100j * D - 1e4 * M, at(1, SECOND[1]).T @ [1.0, 0.0])
    np.testing.assert_allclose(still.phasor("A:a"), (at(0, -FIRST[1]) @ x)[0], rtol=1e-8)


def gears(lines: float = 0.3) -> GearMesh:
    """Return a mesh of ratio −0.5 with a helix, its line of action askew."""
    angles = {"line_angle": lines, "helix_angle": 0.2, "pressure_angle": 0.35}
    return GearMesh(radii=[0.1, 0.2], stiffness=3e6, damping=30.0, **angles)


def test_geared_rotors_are_those_of_constant_equations_at_rest():
    """In axes at rest everything is constant, and six coordinates a rotor give the exponents."""
    mesh, speed = gears(), 200.0
    v, (k, c) = mesh.direction, (mesh.stiffness, mesh.damping)
    held = np.diag([3e5, 2e5, 1e5])
    supports = {n: [Support(p, held, 10.0 * np.eye(3)) for p in "ab"] for n in "AB"}
    M, D, K = np.zeros((12, 12)), c * np.outer(v, v), k * np.outer(v, v)
    for o, (r, half, m), rate in ((0, FIRST, speed), (6, SECOND, -0.5 * speed)):
        polar, transverse = m * r**2, m * (0.5 * r**2 + half**2)
        M[range(o, o + 6), range(o, o + 6)] = m, m, m, transverse, transverse, polar
        D[o + 3, o + 4] += polar * rate
        D[o + 4, o + 3] -= polar * rate
        for z in (-half, half):
            rows = np.zeros((3, 12))
            rows[:, o : o + 6] = np.eye(3, 6)
            rows[0, o + 4], rows[1, o + 3] = z, -z
            K += rows.T @ held @ rows
            D += 10.0 * rows.T @ rows
    # the mesh is at the middle of both rotors
    rotors = {n: rings(*d).with_interface("gear", range(10)).reduce(0)
              for n, d in (("A", FIRST), ("B", SECOND))}  # fmt: skip
    links = [Link("A:gear", "B:gear", mesh)]
    train = RotorTrain(rotors, {"A": 1.0, "B": -0.5}, supports, links)
    found = campbell(train, [0.0, speed])
    exact = exponents_of(M, D, K)
    exact = exact[exact.imag > 1.0]  # without the common spin, which is free
    assert len(exact) == 11
    values = found.growth[-1] + 1j * found.frequencies_inertial[-1]
    assert np.abs(exact[:, None] - values).min(axis=1).max() < 1e-6
    assert sum("spin" in motion for motion in found.free_motions) == 1
    assert stability(train, [speed]).exponents.shape == (1, 22)  # without the free spin
    with pytest.raises(ValueError, match=r"turn with 1 and -0.5, not 0.5, times"):
        RotorTrain(rotors, {"A": 1.0, "B": 0.5}, supports, links)


def test_geared_inertias_have_their_torsion():
    """``ω² = k (r₁²/Θ₁ + r₂²/Θ₂)`` where bearings hold the axes of the gears."""
    mesh = GearMesh(radii=[0.1, 0.2], stiffness=1e4)
    rotors = {"A": rigid(*FIRST), "B": rigid(*SECOND)}
    supports = {n: [Support(p, 1e12) for p in "ab"] for n in "AB"}
    train = RotorTrain(rotors, {"A": 1.0, "B": -0.5}, supports, [Link("A:a", "B:a", mesh)])
    inertias = [d[2] * d[0] ** 2 for d in (FIRST, SECOND)]
    exact = np.sqrt(1e4 * (0.1**2 / inertias[0] + 0.2**2 / inertias[1]))
    found = campbell(train, [0.0, 50.0]).frequencies_inertial[-1]
    assert np.abs(found / exact - 1.0).min() < 1e-6


def test_uneven_rotor_at_a_whole_ratio_against_the_monodromy_matrix():
    """A bar that turns twice as fast on a disc on unequal supports, integrated by itself.

    In the frame of the bar ``I₁φ̈₁ − (I₁+I₂−I₃)ωφ̇₂ + (I₃−I₂)ω²φ₁ = m₁``, likewise φ₂ (Euler).
    """
    speed, ratio = 150.0, 2.0
    disc, omega = rigid(*FIRST), ratio * speed
    spring = 8e4
    supports = {"A": [Support(n, [[3e5, 0.0], [0.0, 1e5]], 20.0) for n in "ab"]}
    links = [Link(f"A:{n}", f"B:{n}", Support(n, spring, 3.0)) for n in "ab"]
    train = RotorTrain({"A": disc, "B": bar()}, {"A": 1.0, "B": ratio}, supports, links)
    found = stability(train, [speed]).exponents[0]
    half, (r, za, m) = 0.05, FIRST
    I1, I2, I3 = 4 * half**2, 4 * (0.2**2 + half**2), 4 * 0.2**2
    polar, transverse = m * r**2, m * (0.5 * r**2 + za**2)
    inertia = np.array([m, m, transverse, transverse, 4.0, 4.0, I1, I2])
    D, K = np.zeros((8, 8)), np.zeros((8, 8))
    D[2, 3], D[3, 2] = polar * speed, -polar * speed
    D[6, 7], D[7, 6] = -(I1 + I2 - I3) * omega, (I1 + I2 - I3) * omega
    K[6, 6], K[7, 7] = (I3 - I2) * omega**2, (I3 - I1) * omega**2

    def rate(time: float, state: np.ndarray) -> np.ndarray:
        c, s = np.cos(omega * time), np.sin(omega * time)
        x, v = state.reshape(2, 8, -1)
        force = -(K @ x + D @ v)
        for z_a, z_b in ((-za, -half), (za, half)):
            tilts, drift = np.array([[c, -s], [s, c]]), omega * np.array([[-s, -c], [c, -s]])
            lever = z_b * np.array([[0.0, 1.0], [-1.0, 0.0]])
            A, B = at(0, z_a), at(1, z_b)
            B[:, 6:], B_t = lever @ tilts, np.zeros((2, 8))
            B_t[:, 6:] = lever @ drift
            pull = spring * (A - B) @ x + 3.0 * ((A - B) @ v - B_t @ x)
            force = force - (A - B).T @ pull
            force -= A.T @ (np.diag([3e5, 1e5]) @ A @ x + 20.0 * A @ v)
        return np.concatenate([v, force / inertia[:, None]]).ravel()

    period = 2.0 * np.pi / speed
    end = solve_ivp(rate, (0.0, period), np.eye(16).ravel(), method="DOP853",
                    rtol=1e-9, atol=1e-12).y[:, -1]  # fmt: skip
    multipliers = np.linalg.eigvals(end.reshape(16, 16))
    distance = np.abs(np.exp(found * period)[:, None] - multipliers).min(axis=0)
    assert distance.max() < 1e-6


def test_turned_mesh_in_full_and_in_the_mean():
    """A solid at the ratio 2 with all its harmonics: the mean errs by the unevenness squared."""
    train = dual_spool(2.0)
    exact = dataclasses.replace(train, largest_unevenness=0.0)
    mean, full = (lateral(campbell(one, [0.0, 500.0], accuracy=None))[:8] for one in (train, exact))
    uneven = linear_model(train).unevenness["outer"]
    assert 1e-9 < np.abs(mean.imag / full.imag - 1.0).max() < 5.0 * uneven**2


def test_constant_equations_at_rest_are_those_of_hills_method():
    """Cross-coupled supports: exponents by inertial axes, and by Hill's method in turning ones."""
    train = two_discs(1.7, UNEVEN)
    standing, turning = (stability(train, [300.0], method=m) for m in ("auto", "hill"))
    distances = np.abs(standing.exponents[0][:, None] - turning.exponents[0])
    assert max(distances.min(axis=0).max(), distances.min(axis=1).max()) < 1e-6


def test_geared_pair_at_a_low_speed():
    """Where turning axes split high frequencies by little, which Hill's method does not resolve."""
    rotors = {"A": rings(*FIRST).reduce(0), "B": rings(*SECOND).reduce(0)}
    supports = {n: [Support(p, 3e9 * np.eye(3)) for p in "ab"] for n in "AB"}
    mesh = GearMesh(radii=[0.1, 0.2], stiffness=3e6)
    train = RotorTrain(rotors, {"A": 1.0, "B": -0.5}, supports, [Link("A:a", "B:a", mesh)])
    slow, still = (np.sort(row) for row in campbell(train, [0.0, 1.0]).frequencies_inertial)
    np.testing.assert_allclose(slow, still, rtol=1e-3, atol=1e-3)


def test_modes_from_axes_at_rest_hold_in_turning_ones():
    """``λ_m² M X_m + Σ_j (λ_{m−j} D_j + K_j) X_{m−j} = 0`` with λ_m = λ + imΩ for all m."""
    model, speed = linear_model(two_discs(1.7, UNEVEN)), 300.0
    system, modes = model.at(speed), model.space(1, speed).modes(speed, 1e-8)
    top = int(modes.orders.max())
    given = dict(zip(modes.orders.tolist(), modes.vectors, strict=True))
    size = np.abs(system.K[0]).max()
    for m in range(-top - 2, top + 3):
        left = np.zeros(modes.central.shape, dtype=complex)
        for j in range(-2, 3):
            if m - j in given:
                rate = modes.values + 1j * (m - j) * speed
                left += (system.D.get(j, 0.0 * system.M[0]) @ given[m - j]) * rate
                left += system.K.get(j, 0.0 * system.M[0]) @ given[m - j]
                left += (system.M[0] @ given[m - j]) * rate**2 if j == 0 else 0.0
        assert np.abs(left).max() < 1e-9 * size


def test_inter_shaft_bearings_in_a_scene():
    """Two bodies of different speeds under a step of force: the solution of the linear equations.

    The integrator errs by h²: by 2e-4 of the motion with 500 steps, by 5e-5 with 1000.
    """
    speed, ratio, end = 300.0, 1.7, 0.02
    mbs = exudyn.SystemContainer().AddSystem()
    second = (SECOND[0], FIRST[1], SECOND[2])  # bearings at the same places
    a, b = (
        add_rotor(mbs, rigid(*d), spin=rate * speed, name=name)
        for name, d, rate in (("A", FIRST, 1.0), ("B", second, ratio))
    )
    k, c = BETWEEN
    add_supports(a, [Support("a", GROUND[0], GROUND[1]), Support("b", 1.3 * GROUND[0], GROUND[1])])
    add_supports(b, Support("b", 5e4))
    links = [Support("a", k, c), Support("b", 1.5 * k, c)]
    add_supports(a, links, base={n: b.marker(n) for n in "ab"})
    mbs.AddLoad(exudyn.itemInterface.Force(markerNumber=a.marker("a"), loadVector=[100.0, 0, 0]))
    sensors = [
        mbs.AddSensor(exudyn.itemInterface.SensorMarker(
            markerNumber=marker, storeInternal=True,
            outputVariableType=exudyn.OutputVariableType.Displacement,
        ))
        for marker in (a.marker("a"), b.marker("b"))
    ]  # fmt: skip
    mbs.Assemble()
    mbs.SolveDynamic(recommended_settings(end_time=end, step=end / 1000))
    M, D, K = by_hand(ratio, speed, second=second)
    steady = la.solve(K, at(0, -FIRST[1]).T @ [100.0, 0.0])
    companion = np.block([[np.zeros((8, 8)), np.eye(8)], [-la.solve(M, K), -la.solve(M, D)]])
    x = steady + (la.expm(end * companion) @ np.r_[-steady, np.zeros(8)])[:8]
    for sensor, rows in zip(sensors, (at(0, -FIRST[1]), at(1, FIRST[1])), strict=True):
        found = mbs.GetSensorStoredData(sensor)[-1, 1:3]
        np.testing.assert_allclose(found, rows @ x, atol=1e-4 * np.abs(rows @ x).max())
