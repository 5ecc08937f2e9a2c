"""Supports put into a scene, against the same list in linear analyses and against closed forms."""

import exudyn as exu
import numpy as np
import pytest
from apart import distance
from point_rotors import ring_rotor
from scipy.spatial.transform import Rotation

import exudyn_rotor as er
from exudyn_rotor.reduction.selection import without_spin

SPEED = 200.0
FULL = np.array([[2.0e6, 4e5, 1e5], [-3e5, 1.2e6, 2e5], [5e4, -1e5, 3e6]])
DAMPING = np.array([[300.0, 40.0, 10.0], [-30.0, 200.0, 20.0], [5.0, -10.0, 100.0]])
COUPLED = np.zeros((2, 6, 6))  # with lateral motion and tilts coupled
COUPLED[:, :3, :3], COUPLED[:, 3:5, 3:5] = (
    (FULL, DAMPING),
    ([[4e3, 1e3], [-5e2, 2e3]], 9.0 * np.eye(2)),
)
COUPLED[:, :3, 3:5] = 0.1 * COUPLED[:, :3, :2]
COUPLED[:, 3:5, :3] = 0.05 * COUPLED[:, :2, :3]
HELD = er.Support("right", np.diag([1e6, 2e6, 5e5]), 150.0)
KINDS = {
    "number": er.Support("left", 1e6, 200.0),
    "2 x 2": er.Support("left", [[2e6, 0.0], [0.0, 1e6]], [[300.0, 0.0], [0.0, 100.0]]),
    "cross-coupled": er.Support("left", [[2e6, 5e5], [-5e5, 2e6]], 400.0),
    "3 x 3": er.Support("left", FULL, DAMPING),
    "tilt": er.Support("left", 1e6, 0.0, [[4e3, 1e3], [-5e2, 2e3]]),
    "tilt, damped": er.Support("left", 1e6, 0.0, [[4e3, 1e3], [-5e2, 2e3]], [[9, 2], [1, 5]]),
    "tilts alone": er.Support("left", tilt_stiffness=3e3, tilt_damping=4.0),
    "about the axis": er.Support("left", 1e6, 0.0, np.diag([3e3, 2e3, 4e3]), np.diag([3, 2, 1e-5])),
    "rotor frame": er.Support("left", FULL, DAMPING, frame="rotor"),
    "rotor frame, tilts": er.Support(
        "left", 0.0, 0.0, np.diag([3e3, 2e3, 4e3]), np.diag([3.0, 2.0, 1.0]), frame="rotor"
    ),
    "table": er.Support(
        "left", ([0.0, 150.0, 300.0], [FULL, 2.0 * FULL, 3.0 * FULL.T]), ([9.0, 300.0], [3e2, 5e2])
    ),
    "6 x 6": er.Support("left", *COUPLED),
    "tilt table": er.Support(
        "left", 1e6, 0.0, ([0.0, 300.0], [1e3, 5e3]), ([0.0, 300.0], [[[9, 2], [1, 5]]] * 2)
    ),
    "function": er.Support("left", lambda speed: 1e6 + 1e3 * speed, lambda speed: 1.5 * speed),
}  # fmt: skip
WITH_A_HELD_SPIN = ("about the axis", "rotor frame, tilts")


def rings(turn=None, heavy=1e-3, modes=2):
    """Return a rotor with flexible modes and a heavy spot [kg]; `turn` turns the mesh."""
    Q = np.eye(3) if turn is None else turn
    upright = ring_rotor(0.1, 0.15, 5.0)
    whole = np.kron(np.eye(10), Q)
    rotor = er.SolidRotor.from_matrices(
        upright.mass, whole @ upright.stiffness @ whole.T, upright.nodes @ Q.T, Q[:, 2]
    )
    rotor = rotor.add_point_mass(Q @ [0.1, 0.0, 0.15], heavy) if heavy else rotor
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10))
    return rotor.reduce(modes)


def on_supports(reduced, supports, rotation=None, base=None, **options):
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, reduced, rotation=rotation, **options)
    added = er.add_supports(body, supports, base)
    mbs.Assemble()
    return mbs, body, added


def compared(kind, turn=None, rotation=None, **options):
    """Return the distance between a scene on supports and the linear rotor on the same list."""
    reduced, supports = rings(turn), [KINDS[kind], HELD]
    held = {"spin": SPEED} if kind in WITH_A_HELD_SPIN else {}
    mbs, body, _ = on_supports(reduced, supports, rotation, **(options or held))
    in_list = er.linear_model(without_spin(reduced) if held else reduced, supports=supports)
    return distance(er.linear_model(mbs, body=body), in_list, SPEED)


@pytest.mark.parametrize("kind", KINDS)
def test_scene_and_linear_rotor_have_the_same_exponents(kind):
    assert compared(kind) < 1e-7


SKEW = Rotation.from_euler("XYZ", [0.7, -0.4, 1.1]).as_matrix()
TO_X, TO_Y = (Rotation.from_euler(a, 90.0, degrees=True).as_matrix() for a in ("y", "x"))


RISING = ([0.0, 100.0], [[[2e5, 3e4], [0.0, 1e5]], [[8e5, 0.0], [-6e4, 3e5]]])


def run_up(supports, torque=200.0, end_time=0.02):
    """Run the rotor up from rest by a torque: 80 rad/s at the end where nothing brakes it."""
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(
        mbs, rings(), translation="free", gravity=[0.0, -9.81, 0.0], markers="rigid"
    )
    added = er.add_supports(body, supports)
    mbs.CreateTorque(itemNumber=body.marker("left"), loadVector=[0.0, 0.0, torque])
    mbs.Assemble()
    settings = er.recommended_settings(end_time=end_time, step=1e-4)
    settings.solution.file.write = False
    mbs.SolveDynamic(settings)
    return mbs, body, added


def test_a_table_follows_a_free_spin():
    """The connector's force at the end is that of the table at the speed of the end."""
    table = er.Support("left", RISING, 50.0)
    _, body, added = run_up([table, HELD])
    _, q_t, _ = body.coordinates()
    speed = q_t[3]
    assert 50.0 < speed < 100.0
    u, v, force = (each[:2] for each in added[0].values())
    stiffness = (
        np.array(RISING[1][0]) * (1.0 - speed / 100.0) + np.array(RISING[1][1]) * speed / 100.0
    )
    np.testing.assert_allclose(force, -stiffness @ u - 50.0 * v, rtol=1e-6)
    assert body.uses_python
    assert "left by Python function; right by Exudyn" in body.report()


@pytest.mark.parametrize("driven", [{"spin": SPEED}, {"initial_speed": SPEED}])
def test_a_film_takes_the_rotor_that_carries_it_along(driven):
    """Its torque in the middle is 2πμR³LΩ/c, whether the journal's spin is prescribed or free."""
    mbs, reduced, start = exu.SystemContainer().AddSystem(), rings(heavy=0.0), 50.0
    film = {"radius": 0.02, "length": 0.02, "clearance": 1e-4, "viscosity": 0.01}
    inner = er.add_rotor(mbs, reduced, name="inner", **driven)
    outer = er.add_rotor(mbs, reduced, name="outer", initial_speed=start)
    for body in (inner, outer):
        er.add_supports(
            body, [er.Support(end, 1e6 * np.eye(3), 100.0) for end in ("left", "right")]
        )
    er.add_supports(inner, er.ShortJournalBearing(interface="left", **film), outer.marker("left"))
    mbs.Assemble()
    settings = er.recommended_settings(end_time=0.05, step=1e-3)
    settings.solution.file.write = False
    mbs.SolveDynamic(settings)
    torque = 2.0 * np.pi * 0.01 * 0.02**3 * 0.02 / 1e-4 * (SPEED - start)
    speed = outer.coordinates()[1][3]  # after the translations
    assert reduced.invariants.Theta * (speed - start) == pytest.approx(torque * 0.05, rel=2e-3)


@pytest.mark.parametrize("change", [{"stiffness": [4e6] * 3}, {"activeConnector": False}])
def test_a_connector_that_was_changed_or_deleted_is_named(change):
    """What analyses of a model that was made before do to the scene leaves it changed."""
    stop = er.ClearanceStop(interface="right", radius=0.1, clearance=1e-3, stiffness=1e6)
    mbs, body, added = on_supports(rings(), [er.Support("left", 1e6), HELD, stop], spin=SPEED)
    (number,), ((name, value),) = added[0].objects, change.items()
    before = er.linear_model(mbs, body=body)
    mbs.SetObjectParameter(number, name, value)
    before.at(SPEED)
    np.testing.assert_array_equal(mbs.GetObjectParameter(number, name), value)
    with pytest.raises(ValueError, match=f"'left': {name} of its connector was changed"):
        er.linear_model(mbs, body=body)
    with pytest.warns(UserWarning, match=f"'left': {name} of its"):
        assert np.isnan(added[0].values()[2]).all()
    mbs.DeleteObject(number, suppressWarnings=True)
    mbs.Assemble()
    with pytest.raises(ValueError, match=r"'rotor' under its numbers: left by .* build the scene"):
        er.linear_model(mbs, body=body)
