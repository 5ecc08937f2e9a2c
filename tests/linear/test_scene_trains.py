"""Scenes of several rotors as trains: Exudyn's accelerations are those of the linear equations."""

import exudyn
import numpy as np
import pytest
import scipy.linalg as la
from exudyn.rigidBodyUtilities import InertiaCuboid
from test_magnetic_bearing import DELAYED, bearing
from test_supports_in_scenes import SKEW
from train_models import FIRST, SECOND, rings

from exudyn_rotor import (
    ConstantSpeed,
    Drag,
    FlexibleCoupling,
    GearMesh,
    LinearActuator,
    Link,
    RotorTrain,
    ShortJournalBearing,
    Support,
    add_drive,
    add_rotor,
    add_supports,
    campbell,
    connect_rotors,
    linear_model,
    stability,
)
from exudyn_rotor.linear.model.body import RotorBody as LinearBody
from exudyn_rotor.linear.model.scene.scene_coordinates import SceneCoordinates
from exudyn_rotor.linear.response.run_start import _in_body
from exudyn_rotor.multibody.evaluation import evaluating
from exudyn_rotor.reduction.driven import _others

SPEED, ANGLE = 90.0, 0.7
INERTIA = InertiaCuboid(1000.0, [0.1, 0.1, 0.1])
HELD = [
    Support("a", [[3e5, 2e4], [-1e4, 2e5]], 20.0),
    Support("b", np.diag([4e5, 4e5, 2e5]), 30.0, np.diag([500.0, 500.0, 0.0])),
]


def scene(ratio, axis="z", rotation=None, **options):
    """Return two rigid rotors: one on springs, on it the other, which a magnetic bearing holds."""
    mbs = exudyn.SystemContainer().AddSystem()
    rotation = np.eye(3) if rotation is None else rotation
    rotors = [rings(*dimensions, axis).reduce(0) for dimensions in (FIRST, SECOND)]
    first, second = (
        add_rotor(mbs, rotor, name=name, spin=rate * SPEED, rotation=rotation, **options)
        for rotor, name, rate in zip(rotors, ("LP", "HP"), (1.0, ratio), strict=True)
    )
    add_supports(first, HELD)
    magnet = bearing("b", DELAYED, LinearActuator(80.0, 1e5), angle=0.3)
    add_supports(second, [magnet, Support("a", 1e5 * np.eye(3), 9.0)])
    between = Support("a", 2e5, 15.0, 300.0)
    add_supports(second, between, base={"a": first.marker("a")})
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
        if part.name in model.driven:
            alone = [_others(body.selection.source) @ one for one in alone]
        (x, x_t, x_tt), spins = zip(*(_in_body(body, one) for one in alone), strict=True)
        given = SceneCoordinates.of(body)
        T, T1, T2 = given.turn(rate * ANGLE)
        T1, T2 = rate * SPEED * T1, (rate * SPEED) ** 2 * T2
        q[given.free], q_t[given.free] = T @ x, T @ x_t + T1 @ x
        q_tt[given.free] = T @ x_tt + 2.0 * T1 @ x_t + T2 @ x
        looked_at.append(given.free)
        at = given.spin_coordinate
        if at is not None:
            turned = np.array([rate * ANGLE, rate * SPEED, 0.0]) + spins
            q[at], q_t[at], q_tt[at] = given.spin_sign * turned
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
    model = linear_model(mbs, body=bodies)
    assert model.ratios == pytest.approx({"LP": 1.0, "HP": ratio})
    assert accelerations_left(mbs, bodies, model, (1.0, ratio)) < 1e-9


def geared(connection, other=None, driven="", turned=None, speed=SPEED, **options):
    """Return two rotors, each on two springs, and what connects them; A and B may be driven."""
    mbs = exudyn.SystemContainer().AddSystem()
    apart = getattr(connection, "center_distance", 0.0)
    place = [apart, 0.0, 0.0] if apart else [0.0, 0.0, 2.0 * FIRST[1]]
    turned = np.eye(3) if turned is None else turned
    rotor = rings(*FIRST).reduce(0)
    rates = (speed, -0.5 * speed) if apart else (speed, speed)
    bodies = [
        add_rotor(
            mbs, rotor, name=name, position=turned @ position, rotation=turned,
            **{"spin" if name in driven else "initial_speed": rate}, **options,
        )
        for name, rate, position in zip("AB", rates, ([0.0, 0.0, 0.0], place), strict=True)
    ]  # fmt: skip
    for body in bodies:
        add_supports(body, [Support(n, np.diag([3e5, 3e5, 1e5]), 9.0) for n in "ab"])
    ends = ("a", "a") if apart else ("b", "a")
    connect_rotors(connection, bodies[0], ends[0], other or bodies[1], None if other else ends[1])
    mbs.Assemble()
    return mbs, bodies


GEARS = GearMesh(radii=[0.1, 0.2], stiffness=3e6, damping=30.0)
COUPLING = FlexibleCoupling(
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
    model = linear_model(mbs, body=bodies)
    assert model.driven == tuple(driven)
    assert model.size == 12 - len(driven)
    assert accelerations_left(mbs, bodies, model, [*model.ratios.values()]) < 1e-8


def test_a_coupling_to_a_shaft_of_constant_speed_holds_torsion():
    """A's, through gears B's, too; damping across the axis turns with the shaft."""
    mbs, bodies = geared(GEARS)
    connect_rotors(COUPLING, bodies[0], "b", ConstantSpeed(SPEED))
    mbs.Assemble()
    model = linear_model(mbs, body=bodies)
    assert model.free_motions == ()
    assert accelerations_left(mbs, bodies, model, [1.0, -0.5]) < 1e-8


@pytest.mark.parametrize("driven", ["", "A", "AB"])
@pytest.mark.parametrize("connection", [GEARS, COUPLING], ids=["gears", "coupling"])
def test_frequencies_of_a_train_at_rest_are_exudyns(connection, driven):
    """Of the scene's own linearisation, torsion included; its 4 locked tilts are 1 rad/s."""
    mbs, bodies = geared(connection, driven=driven, speed=1e-6)  # undamped, no gyroscopics
    M, _, K = linear_model(mbs, body=bodies).at(1e-6).matrices(0.0)
    squares = (
        la.eigh(K, M, eigvals_only=True),
        np.sort(mbs.ComputeODE2Eigenvalues(convert2Frequencies=False)[0]),
    )
    found, expected = (given[given > 10.0] for given in squares)
    assert len(found) == (10 if driven == "AB" else 11)
    np.testing.assert_allclose(found, expected, rtol=1e-6)


def test_gears_and_couplings_of_a_scene_are_links():
    """The same numbers as of the train that is written by hand."""
    coupling = FlexibleCoupling(
        torsion=2e3, lateral=[2e5, 1e5], angular=50.0, damping=[9.0, 9.0, 0.1, 0.1]
    )
    rotor, held = rings(*FIRST).reduce(0), [Support(n, np.diag([3e5, 3e5, 1e5]), 9.0) for n in "ab"]
    for connection, ratio, link in (
        (GEARS, -0.5, Link("A:a", "B:a", GEARS)),
        (coupling, 1.0, Link("A:b", "B:a", coupling.support("b"))),
    ):
        mbs, bodies = geared(connection)
        train = RotorTrain(dict.fromkeys("AB", rotor), {"A": 1.0, "B": ratio},
                           dict.fromkeys("AB", held), [link])  # fmt: skip
        found, expected = (
            campbell(*given, accuracy=None, **more).frequencies_inertial
            for given, more in (
                ((mbs, [0.0, SPEED]), {"body": bodies}),
                ((train, [0.0, SPEED]), {}),
            )
        )
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-9)


def test_what_a_train_does_not_have_is_refused():
    mbs, (first, second), _ = scene(1.7)
    stability(mbs, [SPEED], body=[second, first], accuracy=None)
    journal = ShortJournalBearing(
        interface="b", radius=0.02, length=0.02, clearance=5e-5, viscosity=0.01, load=[0.0, -9.0]
    )

    def base(one, other):
        return {"a": other.marker("a"), "b": other.marker("b")}

    def other_spring(mbs, one, other):
        mbs.CreateSpringDamper(itemNumbers=[mbs.CreateMassPoint(mass=1.0), mbs.CreateGround()])

    def third(mbs, one, other):
        add_rotor(mbs, rings(*FIRST).reduce(0), name="C")

    changes = {
        "leaves out the rotors": third,
        r"is neither of the rotors nor added by": other_spring,
        "depends on the speed; between rotors": lambda mbs, one, other: add_supports(
            one, journal, base(one, other)
        ),
        "stands on a body or a foundation": lambda mbs, one, other: add_supports(
            one, Support("b", 1e5), mbs.CreateRigidBody(inertia=INERTIA)
        ),
        "is to a shaft and no flexible coupling": lambda mbs, one, other: connect_rotors(
            GEARS, one, "b", ConstantSpeed(-0.5 * SPEED)
        ),
    }  # fmt: skip
    for match, change in changes.items():
        mbs, bodies, _ = scene(1.7)
        change(mbs, *bodies)
        mbs.Assemble()
        with pytest.raises(ValueError, match=match):
            linear_model(mbs, body=bodies)
    mbs = exudyn.SystemContainer().AddSystem()
    bodies = [
        add_rotor(mbs, rings(*FIRST).reduce(0), name=name, initial_speed=SPEED) for name in "AB"
    ]
    connect_rotors(COUPLING, bodies[0], "b", ConstantSpeed(2.0 * SPEED))
    mbs.Assemble()
    with pytest.raises(ValueError, match="the shaft of its FlexibleCoupling at b by"):
        linear_model(mbs, body=bodies)
    mbs, bodies = geared(GearMesh(radii=[0.1, 0.2], stiffness=3e6, backlash=1e-5))
    with pytest.raises(ValueError, match=r"GearMesh at a .* has backlash"):
        linear_model(mbs, body=bodies)
    add_drive(bodies[0], Drag(linear=1e-3))
    mbs.Assemble()
    with pytest.raises(ValueError, match="rotor 'A' has a drive, Drag"):
        linear_model(mbs, body=bodies)
    for changed, match in (
        ({"stiffening": ("tilt", "none")}, "give both the same stiffening="),
        ({"spin": (SPEED, 0.0)}, "rotor '1' starts without a spin speed"),
        ({"rotation": (np.eye(3), SKEW)}, "are not parallel to those of '0'"),
        ({"mass_damping": (1.0, 0.0)}, "rotor '0' has damping from add_rotor"),
    ):
        mbs = exudyn.SystemContainer().AddSystem()
        ((option, values),) = changed.items()
        bodies = [
            add_rotor(
                mbs, rings(*FIRST).reduce(0), **{"name": str(i), "spin": SPEED, option: value}
            )
            for i, value in enumerate(values)
        ]
        mbs.Assemble()
        with pytest.raises(ValueError, match=match):
            linear_model(mbs, body=bodies)

    for given in (bodies[:1], [*bodies, bodies[0]]):
        with pytest.raises(ValueError, match="needs two rotors or more, each once"):
            linear_model(mbs, body=given)
    with pytest.raises(TypeError, match="body: needs RotorBody"):
        linear_model(mbs, body=[*bodies, mbs])


def test_a_rotor_without_marker_body_is_a_second_one():
    mbs = exudyn.SystemContainer().AddSystem()
    bodies = [
        add_rotor(mbs, rings(*FIRST).reduce(0), name=name, spin=SPEED, marker_body=shown)
        for name, shown in (("A", True), ("B", False))
    ]
    mbs.Assemble()
    for body in bodies:
        with pytest.raises(ValueError, match=r"a second rotor in this system.*body=\[…\]"):
            linear_model(mbs, body=body)
    assert linear_model(mbs, body=bodies).size == 10  # without the spins
