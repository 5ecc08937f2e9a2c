"""Gears and couplings between spins that are both prescribed; what drives and gears refuse."""

import exudyn as exu
import numpy as np
import pytest
from rings import rings, run
from scipy.spatial.transform import Rotation
from test_gear_mesh import mesh

from exudyn_rotor import (
    DirectCurrentMotor,
    FlexibleCoupling,
    GearMesh,
    TorqueCurve,
    add_rotor,
    connect_rotors,
)

FIRST = 40.0  # rad/s
FLIP = Rotation.from_euler("x", np.pi).as_matrix()  # e becomes −e
CONNECTIONS = {  # what the second needs about the axis of the first
    "gears": (GearMesh(radii=[0.03, 0.06], stiffness=1e6), -20.0),
    "coupling": (FlexibleCoupling(torsion=1e3), 40.0),
}


def scene(connection, spin, turn=None, first=FIRST):
    """Return the scene and two rotors whose ends are where the connection needs them."""
    mbs, rotor = exu.SystemContainer().AddSystem(), rings().reduce(0)
    gears = isinstance(connection, GearMesh)
    place = [connection.center_distance, 0.0, 0.3] if gears else [0.0, 0.0, 0.3]
    end = "right" if turn is not None else "left"  # the same place, turned over
    one = add_rotor(mbs, rotor, name="one", spin=first, translation="none")
    two = add_rotor(
        mbs, rotor, name="two", spin=spin, translation="none", position=place, rotation=turn
    )
    return mbs, (connection, one, "right", two, end)


@pytest.mark.parametrize(
    ("name", "turn"),
    [*((name, None) for name in CONNECTIONS), ("gears", FLIP), ("coupling", FLIP)],
    ids=[*CONNECTIONS, "gears, turned over", "coupling, turned over"],
)
def test_speeds_that_would_wind_up_are_refused(name, turn):
    connection, needed = CONNECTIONS[name]
    needed = needed if turn is None else -needed
    for speed in (-needed, 0.0, 1.001 * needed):
        mbs, arguments = scene(connection, speed, turn)
        before = mbs.systemData.NumberOfObjects()
        with pytest.raises(ValueError, match=f"prescribe {needed!r} rad/s, or leave one spin free"):
            connect_rotors(*arguments)
        assert (mbs.systemData.NumberOfObjects(), arguments[1].drives) == (before, [])
    mbs, arguments = scene(connection, needed, turn)
    sensor = connect_rotors(*arguments).add_sensor()
    run(mbs, 0.1, 10)
    np.testing.assert_allclose(mbs.GetSensorStoredData(sensor)[:, 2], 0.0, atol=1e-12)  # energy [J]


GEARS, COUPLING = (connection for connection, _ in CONNECTIONS.values())


def placed(connection, apart, axis):
    connection.check_places(np.array(apart), np.array(axis))


REFUSED = [
    (lambda: DirectCurrentMotor(stall_torque=5.0, no_load_speed=0.0), "number .* that is not zero"),
    (lambda: TorqueCurve(([1.0], [2.0], [3.0])), "curve: needs a table"),
    (lambda: mesh(radii=[0.1, -0.1]), "radii: needs a finite number"),
    (lambda: mesh(flank=2), "flank: needs 1 or -1"),
    (lambda: mesh(teeth=[20, 33]), "teeth: 20 to 33 is not the ratio of the radii"),
    (lambda: mesh(teeth=[20]), "teeth: needs two whole numbers"),
    (lambda: mesh(variation=[0.1]), "variation: needs the numbers of teeth"),
    (lambda: mesh(variation=[0.6, 0.5], teeth=[5, 8]), "variation: needs amplitudes whose sum"),
    (lambda: mesh(backlash=-1e-4), "backlash: needs a finite number"),
    (lambda: mesh(helix_angle=1.6), "helix_angle: needs"),
    (lambda: placed(COUPLING, [0, 0, 0.1], [0, 0, 1]), "its interface is 0.1 m from that of the"),
    (
        lambda: placed(COUPLING, [0, 0, 0], [0.1, 0, 1]),
        "on one axis, and the second is 0.1 rad off",
    ),
    (lambda: placed(GEARS, [0.1, 0, 0], [0.1, 0, 1]), "other: gears need parallel axes"),
    (lambda: placed(GEARS, [0.1, 0, 0.1], [0, 0, 1]), "other: its gear is 0.1 m along the axis"),
    (lambda: placed(GEARS, [0.1, 0, 0], [0, 0, 1]), r"0.1 m .* the gears need 0.0957\d* m"),
]


@pytest.mark.parametrize(("call", "words"), REFUSED)
def test_what_is_refused_is_told(call, words):
    with pytest.raises(ValueError, match=words):
        call()
