"""Harmonic balance of scenes and trains: the same motion as from lists, and refusals by name."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import CartesianSpringDamper, Force, MarkerBodyPosition
from point_rotors import ring_rotor

from exudyn_rotor import (
    Foundation,
    HarmonicForce,
    Mount,
    RotorTrain,
    ShortJournalBearing,
    SqueezeFilmDamper,
    StartState,
    Support,
    Unbalance,
    add_foundation,
    add_rotor,
    add_supports,
    periodic_response,
    recommended_settings,
)

ENDS, SPEEDS = ("left", "right"), [200.0, 300.0]
TURN = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])  # mesh z → inertial x
DOWN, AT = np.array([0.0, 0.0, -9.81]), [0.1, 0.2, 0.3]
MESH_DOWN = TURN.T @ DOWN
UNBALANCE = Unbalance("left", 1e-4)


def dampers(viscosity, stiffness):
    sizes = {"radius": 0.06, "length": 0.02, "clearance": 1.5e-4, "viscosity": viscosity}
    return [SqueezeFilmDamper(interface=end, centring_stiffness=stiffness, **sizes) for end in ENDS]


DAMPERS = dampers(0.003, 1e6)
THRUST = Support("left", np.diag([0.0, 0.0, 1e6]), np.diag([0.0, 0.0, 100.0]))


def rings():
    solid = ring_rotor(0.1, 0.15, 20.0).with_interface("left", range(5))
    return solid.with_interface("right", range(5, 10)).reduce(0)


def block():
    mounts = [Mount([x, -0.2, z], 2e6, 2e3) for x in (-0.2, 0.2) for z in (-0.2, 0.2)]
    places = {"left": [0.0, 0.0, -0.15], "right": [0.0, 0.0, 0.15]}
    return Foundation.rigid(10.0, [0.4, 0.4, 0.4], [0.0, -0.1, 0.0], mounts, places)


def scene(foundation=None, supports=(*DAMPERS, THRUST)):
    mbs = exu.SystemContainer().AddSystem()
    options = {"position": AT, "rotation": TURN}
    body = add_rotor(mbs, rings(), spin=100.0, gravity=DOWN, **options)
    base = foundation and add_foundation(mbs, foundation, gravity=DOWN, **options)
    add_supports(body, supports, base)
    return mbs, body


def spring(mbs, body, **changes):
    """Add one of Exudyn's springs at the right end, along mesh (z, x, y)."""
    ground = mbs.CreateGround(referencePosition=np.array(AT) + TURN @ [0.0, 0.0, 0.15])
    ends = [mbs.AddMarker(MarkerBodyPosition(bodyNumber=ground)), body.marker("right")]
    options = {"stiffness": [3e5, 1e5, 2e5], "damping": [0.0, 10.0, 20.0]} | changes
    mbs.AddObject(CartesianSpringDamper(markerNumbers=ends, name="spring", **options))


@pytest.mark.parametrize("founded", [True, False])
def test_a_scene_has_the_motion_of_its_lists(founded):
    given = {"supports": [*DAMPERS, THRUST], "gravity": MESH_DOWN}
    mbs, body = scene(block() if founded else None)
    if founded:
        given["foundation"] = block()
    else:
        mbs.AddLoad(Force(markerNumber=body.marker("left"), loadVector=[0.0, 40.0, 30.0]))
        given["loads"] = [HarmonicForce("left", [40.0, 30.0])]
    mbs.Assemble()
    found = periodic_response(mbs, SPEEDS, UNBALANCE, body=body, follow=False)
    listed = periodic_response(rings(), SPEEDS, UNBALANCE, follow=False, **given)
    np.testing.assert_array_equal(found.orders, listed.orders)
    size = np.abs(listed.motion[..., :3]).max()
    np.testing.assert_allclose(found.motion[..., :3], listed.motion[..., :3], atol=1e-7 * size)


def test_items_that_may_be_nonlinear_are_named():
    def hammered(mbs, body):
        mbs.AddLoad(
            Force(
                markerNumber=body.marker("left"), loadVector=[0.0, 0.0, 1.0], name="hammer",
                loadVectorUserFunction=lambda mbs, t, load: [0.0, 0.0, float(np.sin(t))],
            )
        )  # fmt: skip

    for change, match in (
        (spring, r"ConnectorCartesianSpringDamper 'spring'\) is no law of this package"),
        (hammered, r"ForceVector 'hammer'\) is no constant force"),
    ):
        mbs, body = scene()
        change(mbs, body)
        mbs.Assemble()
        with pytest.raises(ValueError, match=match):
            periodic_response(mbs, SPEEDS, UNBALANCE, body=body)


def test_rotors_of_a_train_see_their_own_speed():
    """A journal film under weight and dampers with unbalance, on rotors that nothing links."""
    films = [
        ShortJournalBearing(
            interface=end, radius=0.03, length=0.02, clearance=6e-5, viscosity=0.02
        )
        for end in ENDS
    ]  # fmt: skip
    weight = [0.0, -9.81, 0.0]
    train = RotorTrain(
        {"A": rings(), "B": rings()}, {"A": 1.0, "B": -2.0},
        {"A": [*DAMPERS, THRUST], "B": [*films, THRUST]},
    )  # fmt: skip
    unbalance = Unbalance("A:left", 1e-4)
    found = periodic_response(train, SPEEDS, unbalance, gravity=weight, follow=False)
    assert found.bearings == ("A:left", "A:right", "B:left", "B:right")
    alone = periodic_response(
        rings(), SPEEDS, UNBALANCE, supports=[*DAMPERS, THRUST], gravity=weight, follow=False
    )
    np.testing.assert_allclose(found.amplitudes("A:left"), alone.amplitudes("left"), rtol=1e-6)
    for index, speed in enumerate(SPEEDS):
        mean = found.motion[index, found.places.index("B:left"), 0, :2].real
        resting = films[0].equilibrium(-2.0 * speed, [0.0, -0.5 * 20.0 * 9.81])
        np.testing.assert_allclose(mean, resting, rtol=1e-6)


def test_runs_come_back_to_stable_orbits_and_leave_an_unstable_one():
    """Of three orbits of a squeeze film, 1 % beside each."""
    supports = dampers(0.0015, 5e5)
    solid = ring_rotor(0.1, 0.15, 20.0).with_interface("left", range(5))
    solid = solid.with_interface("right", range(5, 10))
    for z in (-0.15, 0.15):
        solid = solid.add_point_mass([0.1, 0.0, z], 5.5e-3)
    rotor, speed = solid.reduce(0), 500.0
    found = periodic_response(
        rotor, [0.0, 1.0, 2.0], supports=supports, over="unbalance", speed=speed
    )
    points = found.at(1.0)
    assert found.stable[points].tolist() == [True, False, True]
    for point in points:
        mbs = exu.SystemContainer().AddSystem()
        body = add_rotor(mbs, rotor, spin=speed, translation="none")
        add_supports(body, [*supports, THRUST])
        sensor = body.add_interface_sensor("left", exu.OutputVariableType.Displacement)
        mbs.Assemble()
        start = found.state(int(point), body)
        body.start_from(StartState(1.01 * start.q, start.q_t, start.angle, speed))
        turn = 2.0 * np.pi / speed
        settings = recommended_settings(end_time=30 * turn, step=turn / 40)
        settings.timeIntegration.verboseMode = 0
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = turn / 40
        mbs.SolveDynamic(settings)
        path = mbs.GetSensorStoredData(sensor)[-40:, 1:3]
        reached = np.linalg.norm(path - path.mean(axis=0), axis=1).max()
        away = abs(reached / found.amplitudes("left")[point] - 1.0)
        assert (away < 5e-3) == found.stable[point]
        assert found.stable[point] or away > 0.05
