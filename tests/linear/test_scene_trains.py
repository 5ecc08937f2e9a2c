"""Scenes of several rotors as trains: Exudyn's accelerations are those of the linear equations."""

import exudyn
import numpy as np
import pytest
import scipy.linalg as la
from test_magnetic_bearing import DELAYED, bearing
from test_supports_in_scenes import SKEW
from train_models import FIRST, SECOND, rings

import exudyn_rotor as er
from exudyn_rotor.linear.model.body import RotorBody as LinearBody
from exudyn_rotor.linear.model.scene.linear_scene import LinearScene
from exudyn_rotor.multibody.evaluation import evaluating
from exudyn_rotor.reduction.selection import _beside_spin

SPEED, ANGLE = 90.0, 0.7
HELD = [
    er.Support("a", [[3e5, 2e4], [-1e4, 2e5]], 20.0),
    er.Support("b", np.diag([4e5, 4e5, 2e5]), 30.0, np.diag([500.0, 500.0, 0.0])),
]


def scene(ratio, axis="z", rotation=None, **options):
    """Return two rigid rotors: one on springs, on it the other, which a magnetic bearing holds."""
    mbs = exudyn.SystemContainer().AddSystem()
    rotation = np.eye(3) if rotation is None else rotation
    rotors = [rings(*dimensions, axis).reduce(0) for dimensions in (FIRST, SECOND)]
    first, second = (
        er.add_rotor(mbs, rotor, name=name, spin=rate * SPEED, rotation=rotation, **options)
        for rotor, name, rate in zip(rotors, ("LP", "HP"), (1.0, ratio), strict=True)
    )
    er.add_supports(first, HELD)
    magnet = bearing("b", DELAYED, er.LinearActuator(80.0, 1e5), angle=0.3)
    er.add_supports(second, [magnet, er.Support("a", 1e5 * np.eye(3), 9.0)])
    between = er.Support("a", 2e5, 15.0, 300.0)
    er.add_supports(second, between, base=first.marker("a"))
    mbs.Assemble()
    return mbs, (first, second), rotors


def accelerations_left(mbs, bodies, model, rates):
    """Return ``M q̈ − f`` of the scene where the train's equations hold, over the largest force.

    Half the difference of a motion and its mirror image, free of terms of second order.
    """
    rng = np.random.default_rng(3)
    y, y_t = 1e-5 * rng.normal(size=model.size), 1e-3 * rng.normal(size=model.size)
    M, D, K = model.at(SPEED).matrices(ANGLE)
    y_tt = -la.solve(M, D @ y_t + K @ y)
    (upper, rows), (lower, _) = (
        forces(mbs, bodies, model, rates, sign * np.array([y, y_t, y_tt])) for sign in (1.0, -1.0)
    )
    inertia, force = 0.5 * (upper - lower)[:, rows]
    return np.abs(inertia - force).max() / np.abs(force).max()


def forces(mbs, bodies, model, rates, motion):
    """Return ``M q̈`` and f (2, n) of a motion (3, k) with its derivatives, and the unknowns."""
    y, y_t, y_tt = motion
    size = mbs.systemData.ODE2Size()
    q, q_t, q_tt, looked_at = np.zeros(size), np.zeros(size), np.zeros(size), []
    assembly = model.assembly(SPEED)
    parts = zip(assembly.bodies, assembly.slices, strict=True)
    parts = [each for each in parts if isinstance(each[0], LinearBody)]
    for (part, place), body, rate in zip(parts, bodies, rates, strict=True):
        alone = list(motion[:, place])
        if part.mean:  # x = exp(−Gα) y, α = wθ
            G, w = part.alone.turning.generator, part.drift * SPEED
            turn = la.expm(-G * part.drift * ANGLE)
            alone = [
                turn @ alone[0],
                turn @ (alone[1] - w * G @ alone[0]),
                turn @ (alone[2] - 2.0 * w * G @ alone[1] + w**2 * G @ G @ alone[0]),
            ]
        if part.spin is None:  # driven
            alone = [_beside_spin(body.selection.source) @ one for one in alone]
        given = LinearScene.of_rotor(body)
        (x, x_t, x_tt), spins = given.of_coordinates(np.array(alone))
        T, T1, T2 = given.turn(rate * ANGLE)
        T1, T2 = rate * SPEED * T1, (rate * SPEED) ** 2 * T2
        q[given.free], q_t[given.free] = T @ x, T @ x_t + T1 @ x
        q_tt[given.free] = T @ x_tt + 2.0 * T1 @ x_t + T2 @ x
        looked_at.append(given.free)
        at = given.spin_coordinate
        q[at], q_t[at], q_tt[at] = np.array([rate * ANGLE, rate * SPEED, 0.0]) + spins
        if body.formulation.has_spin:
            looked_at.append([at])
    pairs = {int(i): n for body in bodies for s in body.supports
             for n, i in enumerate(s.own_coordinates(mbs))}  # fmt: skip
    places = np.array(sorted(pairs, key=pairs.get))
    if len(places):
        at = slice(model.size - len(places), model.size)
        p, p_t, p_tt = (one[at].reshape(-1, 2) for one in (y, y_t, y_tt))
        q[places], q_t[places], q_tt[places] = p.ravel(), p_t.ravel(), p_tt.ravel()
        looked_at.append(places)
    with evaluating(mbs) as solver:
        data = mbs.systemData
        data.SetODE2Coordinates(q)
        data.SetODE2Coordinates_t(q_t)
        data.SetTime(ANGLE / SPEED)
        solver.ComputeMassMatrix(mbs)
        solver.ComputeODE2RHS(mbs)
        force = np.array(solver.GetSystemResidual())[:size]
        inertia = np.array(solver.GetSystemMassMatrix()) @ q_tt
    return np.array([inertia, force]), np.concatenate(looked_at)


@pytest.mark.parametrize(
    ("ratio", "axis", "rotation"),
    [(1.7, "z", None), (-1.3, "x", None), (1.7, "z", SKEW)],
    ids=["z", "x, the other way", "skew"],
)
def test_accelerations_of_a_scene_are_those_of_its_train(ratio, axis, rotation):
    """Uneven and cross-coupled supports, a magnetic bearing with delay, a link with damping."""
    mbs, bodies, _ = scene(ratio, axis, rotation)
    model = er.linear_model(mbs, body=bodies)
    assert model.ratios == pytest.approx({"LP": 1.0, "HP": ratio})
    assert accelerations_left(mbs, bodies, model, (1.0, ratio)) < 1e-9


def geared(connection, driven="", turned=None, speed=SPEED, **options):
    """Return two rotors, each on two springs, and what connects them; A and B may be driven."""
    mbs = exudyn.SystemContainer().AddSystem()
    apart = getattr(connection, "center_distance", 0.0)
    place = [apart, 0.0, 0.0] if apart else [0.0, 0.0, 2.0 * FIRST[1]]
    turned = np.eye(3) if turned is None else turned
    rotor = rings(*FIRST).reduce(0)
    rates = (speed, -0.5 * speed) if apart else (speed, speed)
    bodies = [
        er.add_rotor(
            mbs, rotor, name=name, position=turned @ position, rotation=turned,
            **{"spin" if name in driven else "initial_speed": rate}, **options,
        )
        for name, rate, position in zip("AB", rates, ([0.0, 0.0, 0.0], place), strict=True)
    ]  # fmt: skip
    for body in bodies:
        er.add_supports(body, [er.Support(n, np.diag([3e5, 3e5, 1e5]), 9.0) for n in "ab"])
    ends = ("a", "a") if apart else ("b", "a")
    er.connect_rotors(connection, bodies[0], ends[0], bodies[1], ends[1])
    mbs.Assemble()
    return mbs, bodies


GEARS = er.GearMesh(radii=[0.1, 0.2], stiffness=3e6, damping=30.0)
COUPLING = er.FlexibleCoupling(
    torsion=2e3, lateral=2e5, angular=50.0, damping=[9.0, 9.0, 0.1, 0.1], axial=1e5
)


@pytest.mark.parametrize("driven", ["", "A", "B", "AB"])
@pytest.mark.parametrize(
    ("connection", "turned"), [(GEARS, None), (GEARS, SKEW), (COUPLING, None)],
    ids=["gears", "gears, skew", "coupling"],
)  # fmt: skip
def test_spins_of_a_scene_that_a_drive_holds_are_held_in_its_train(connection, turned, driven):
    """Torsion is that of the spins that are free in the scene, through gears and couplings."""
    mbs, bodies = geared(connection, driven=driven, turned=turned)
    model = er.linear_model(mbs, body=bodies)
    assert model.size == 12 - len(driven)
    assert accelerations_left(mbs, bodies, model, [*model.ratios.values()]) < 1e-8


def test_gears_and_couplings_of_a_scene_are_links():
    """The same numbers as of the train that is written by hand."""
    coupling = er.FlexibleCoupling(
        torsion=2e3, lateral=[2e5, 1e5], angular=50.0, damping=[9.0, 9.0, 0.1, 0.1]
    )
    rotor = rings(*FIRST).reduce(0)
    held = [er.Support(n, np.diag([3e5, 3e5, 1e5]), 9.0) for n in "ab"]
    for connection, ratio, link in (
        (GEARS, -0.5, er.Link("A:a", "B:a", GEARS)),
        (coupling, 1.0, er.Link("A:b", "B:a", coupling.support("b"))),
    ):
        mbs, bodies = geared(connection)
        train = er.RotorTrain(dict.fromkeys("AB", rotor), {"A": 1.0, "B": ratio},
                           dict.fromkeys("AB", held), [link])  # fmt: skip
        found = er.campbell(mbs, [0.0, SPEED], body=bodies, accuracy=None).frequencies_inertial
        expected = er.campbell(train, [0.0, SPEED], accuracy=None).frequencies_inertial
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-9)
