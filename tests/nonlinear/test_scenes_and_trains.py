"""Harmonic balance of scenes and trains: the same motion as from lists, and refusals by name."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import CartesianSpringDamper, Force, MarkerBodyPosition
from point_rotors import ring_rotor

import exudyn_rotor as er

ENDS, SPEEDS = ("left", "right"), [200.0, 300.0]
TURN = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])  # mesh z → inertial x
DOWN, AT = np.array([0.0, 0.0, -9.81]), [0.1, 0.2, 0.3]
MESH_DOWN = TURN.T @ DOWN
UNBALANCE = er.Unbalance("left", 1e-4)


def dampers(viscosity, stiffness):
    sizes = {"radius": 0.06, "length": 0.02, "clearance": 1.5e-4, "viscosity": viscosity}
    return [
        er.SqueezeFilmDamper(interface=end, centring_stiffness=stiffness, **sizes) for end in ENDS
    ]


DAMPERS = dampers(0.003, 1e6)
THRUST = er.Support("left", np.diag([0.0, 0.0, 1e6]), np.diag([0.0, 0.0, 100.0]))


def rings(modes=0):
    solid = ring_rotor(0.1, 0.15, 20.0).with_interface("left", range(5))
    return solid.with_interface("right", range(5, 10)).reduce(modes)


def block():
    mounts = [er.Mount([x, -0.2, z], 2e6, 2e3) for x in (-0.2, 0.2) for z in (-0.2, 0.2)]
    places = {"left": [0.0, 0.0, -0.15], "right": [0.0, 0.0, 0.15]}
    return er.Foundation.rigid(10.0, [0.4, 0.4, 0.4], [0.0, -0.1, 0.0], mounts, places)


def scene(foundation=None, supports=(*DAMPERS, THRUST)):
    mbs = exu.SystemContainer().AddSystem()
    options = {"position": AT, "rotation": TURN}
    body = er.add_rotor(mbs, rings(), spin=100.0, gravity=DOWN, **options)
    base = foundation and er.add_foundation(mbs, foundation, gravity=DOWN, **options)
    er.add_supports(body, supports, base)
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
        given["loads"] = [er.HarmonicForce("left", [40.0, 30.0])]
    mbs.Assemble()
    found = er.periodic_response(mbs, SPEEDS, UNBALANCE, body=body, follow=False)
    listed = er.periodic_response(rings(), SPEEDS, UNBALANCE, follow=False, **given)
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
        (spring, "ConnectorCartesianSpringDamper 'spring' is no law of this package"),
        (hammered, r"ForceVector 'hammer'\) is no constant force"),
    ):
        mbs, body = scene()
        change(mbs, body)
        mbs.Assemble()
        with pytest.raises(ValueError, match=match):
            er.periodic_response(mbs, SPEEDS, UNBALANCE, body=body)


def test_rotors_of_a_train_see_their_own_speed():
    """A journal film under weight and dampers with unbalance, on rotors that nothing links."""
    films = [
        er.ShortJournalBearing(
            interface=end, radius=0.03, length=0.02, clearance=6e-5, viscosity=0.02
        )
        for end in ENDS
    ]  # fmt: skip
    weight = [0.0, -9.81, 0.0]
    train = er.RotorTrain(
        {"A": rings(), "B": rings()}, {"A": 1.0, "B": -2.0},
        {"A": [*DAMPERS, THRUST], "B": [*films, THRUST]},
    )  # fmt: skip
    unbalance = er.Unbalance("A:left", 1e-4)
    found = er.periodic_response(train, SPEEDS, unbalance, gravity=weight, follow=False)
    assert found.bearings == ("A:left", "A:right", "B:left", "B:right")
    alone = er.periodic_response(
        rings(), SPEEDS, UNBALANCE, supports=[*DAMPERS, THRUST], gravity=weight, follow=False
    )
    np.testing.assert_allclose(found.amplitudes("A:left"), alone.amplitudes("left"), rtol=1e-6)
    for index, speed in enumerate(SPEEDS):
        mean = found.motion[index, found.places.index("B:left"), 0, :2].real
        resting = films[0].equilibrium(-2.0 * speed, [0.0, -0.5 * 20.0 * 9.81])
        np.testing.assert_allclose(mean, resting, rtol=1e-6)
