"""Which angle of the marker body's node is the spin angle."""

import itertools

import exudyn as exu
import numpy as np
import pytest
from exudyn.rigidBodyUtilities import RotXYZ2RotationMatrix
from point_rotors import random_arrays
from scipy.spatial.transform import Rotation

from exudyn_rotor import (
    ConstantSpeed,
    PrescribedMotion,
    SolidRotor,
    SpinAxis,
    add_rotor,
    recommended_settings,
)
from exudyn_rotor.multibody.rotor.frame import BodyFrame

KINDS = exu.OutputVariableType
COORDINATE_AXES = [sign * unit for unit in np.eye(3) for sign in (1, -1)]
SKEW = Rotation.from_euler("XYZ", [0.7, -0.4, 1.1]).as_matrix()
# all 24 ways to mount coordinate axes along coordinate axes
UPRIGHT = Rotation.create_group("O").as_matrix().round()


def turned_frame(frame, theta):
    """Return the orientation of the node for a spin angle."""
    angles = frame.angles.copy()
    angles[frame.spin - 3] += theta
    return RotXYZ2RotationMatrix(angles)


def check_frame(frame, e, space):
    for theta in (0.0, 0.4, 2.0, -40.0):
        expected = space @ SpinAxis(e).rotation(theta) @ frame.B.T
        np.testing.assert_allclose(turned_frame(frame, theta), expected, rtol=0, atol=1e-13)


@pytest.mark.parametrize("e", COORDINATE_AXES, ids=str)
def test_coordinate_axes_along_coordinate_axes(e):
    """Mesh axes but for those against mesh z and along −x of space."""
    for space in UPRIGHT:
        frame = BodyFrame.of(e, np.zeros(3), np.zeros(3), space)
        n = space @ e
        along_z, along_x = abs(e[2]) > 0.5, abs(n[0]) > 0.5
        kept = (e[2] > 0.5) if along_z and not along_x else True
        if along_x:
            kept = n[0] > 0.5 or e[2] > 0.5
        assert frame.has_mesh_axes == kept
        check_frame(frame, e, space)


def test_mesh_z_keeps_the_mesh_axes_wherever_it_is_mounted():
    e = np.array([0.0, 0.0, 1.0])
    frame = BodyFrame.of(e, np.zeros(3), np.zeros(3), SKEW)
    assert frame.has_mesh_axes
    assert frame.spin == 5
    check_frame(frame, e, SKEW)


def test_skew_axes_are_turned_where_no_angle_serves():
    for e, space in itertools.product((SKEW[:, 0], -SKEW[:, 1]), (np.eye(3), SKEW)):
        frame = BodyFrame.of(e, np.zeros(3), np.zeros(3), space)
        assert not frame.has_mesh_axes
        np.testing.assert_allclose(frame.B @ e, [0, 0, 1], atol=1e-15)
        check_frame(frame, e, space)
    along_x = Rotation.align_vectors([[1.0, 0, 0]], [SKEW[:, 0]])[0].as_matrix()
    frame = BodyFrame.of(SKEW[:, 0], np.zeros(3), np.zeros(3), along_x)
    assert frame.has_mesh_axes
    check_frame(frame, SKEW[:, 0], along_x)


def rotor(direction):
    """Return a random rotor, centre of mass off the axis, turned so that z lies along one."""
    arrays = random_arrays(3)
    turn = np.eye(3) if direction[2] > 0.5 else Rotation.from_euler("x", np.pi).as_matrix()
    assert np.allclose(turn[:, 2], direction)
    blocks = np.kron(np.eye(len(arrays["nodes"])), turn)
    return SolidRotor.from_matrices(
        mass=blocks @ arrays["mass"] @ blocks.T,
        stiffness=3e5 * blocks @ arrays["stiffness"] @ blocks.T,
        nodes=arrays["nodes"] @ turn.T,
        axis=direction,
        interfaces={"a": [0, 1, 2, 3], "b": [2, 3, 4, 5]},
    ).reduce(3), turn


RUN_UP = PrescribedMotion.run_up(0.0, 20.0, 0.05, angle=0.3)
SPINS = {
    "free": {"spin": "free", "initial_speed": 20.0, "initial_angle": 0.3},
    "constant": {"spin": ConstantSpeed(20.0, 0.3)},
    "run-up by mass": {"spin": RUN_UP, "locking": "mass"},
    "run-up by constraints": {"spin": RUN_UP, "locking": "constraints"},
}


def motion_of(direction, translation, spin):
    """Return records of one rotor whose mesh z axis is turned, mounted the same way in space."""
    reduced, turn = rotor(direction)
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(
        mbs,
        reduced,
        translation=translation,
        rotation=SKEW @ turn.T,
        gravity=[1.0, -9.0, 3.0],
        **SPINS[spin],
    )
    ground = mbs.CreateGround()
    for name in ("a", "b"):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body.marker(name)],
            localPosition0=(SKEW @ turn.T @ reduced.interfaces[name].reference).tolist(),
            stiffness=[3e4, 2e4, 1e4],
            damping=[3.0, 2.0, 1.0],
        )
    mbs.CreateTorque(itemNumber=body.marker("a"), loadVector=(SKEW @ [1.0, 2.0, 40.0]).tolist())
    sensors = [body.add_spin_sensor(), body.add_interface_sensor("b", KINDS.Displacement)]
    if spin != "free":
        sensors.append(body.add_drive_torque_sensor())
    body.start_recording()
    mbs.Assemble()
    settings = recommended_settings(end_time=0.05, step=2.5e-4)
    settings.solution.file.write = False
    settings.timeIntegration.verboseMode = 0
    mbs.SolveDynamic(settings)
    return body, [mbs.GetSensorStoredData(sensor)[:, 1:] for sensor in sensors]


# in-plane, the plane is skew in space and held by a constraint
MEMBERS = [(t, s) for t in ("free", "none") for s in SPINS] + [
    ("in-plane", s) for s in SPINS if s != "run-up by mass"
]


@pytest.mark.parametrize(("translation", "spin"), MEMBERS)
def test_axis_against_mesh_z_gives_the_same_motion(translation, spin):
    """θ, its speed and the drive torque are about −z of the mesh then, not about +z."""
    one, first = motion_of(np.array([0.0, 0.0, 1.0]), translation, spin)
    two, second = motion_of(np.array([0.0, 0.0, -1.0]), translation, spin)
    assert (one.frame.has_mesh_axes, two.frame.has_mesh_axes) == (True, False)
    assert second[0][-1, 0] > 0.3
    for a, b in zip(first, second, strict=True):
        # both solve the same equations; Newton's method stops at 1e-7 of them
        np.testing.assert_allclose(b, a, rtol=0, atol=1e-6 * abs(a).max())
    np.testing.assert_allclose(two.recorded().speed, one.recorded().speed, rtol=1e-6, atol=1e-6)
    theta = two.recorded().q[-1, two.locks.spin]
    np.testing.assert_allclose(theta, second[0][-1, 0], rtol=1e-12)
    np.testing.assert_allclose(two.coordinates()[0][0], one.coordinates()[0][0], atol=1e-6)


@pytest.fixture
def skew_scene():
    arrays = random_arrays(3)
    solid = SolidRotor.from_matrices(
        **arrays | {"stiffness": 3e5 * arrays["stiffness"]},
        axis=[1.0, 2.0, 2.0],
        interfaces={"a": [0, 1, 2, 3]},
    )
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, solid.reduce(3), rotation=SKEW, initial_speed=20.0)
    return solid, mbs, body


OFFSET = np.array([0.3, -0.2, 0.5])


def test_added_markers_have_mesh_axes_and_their_offset(skew_scene):
    solid, mbs, body = skew_scene
    interface = solid.interfaces["a"]
    markers = [
        body.add_marker("a", OFFSET),
        body.add_marker([0, 1, 2, 3], OFFSET, weights=interface.weights, name="own"),
        body.add_marker("a", OFFSET, kind="position"),
    ]
    expected = solid.nodes[:4].T @ interface.weights + OFFSET
    mbs.Assemble()
    for marker in markers:
        place = mbs.GetMarkerOutput(marker, KINDS.Position, exu.ConfigurationType.Initial)
        np.testing.assert_allclose(place, SKEW @ expected, atol=1e-12)
    for marker in markers[:2]:
        turn = mbs.GetMarkerOutput(marker, KINDS.RotationMatrix, exu.ConfigurationType.Initial)
        np.testing.assert_allclose(np.reshape(turn, (3, 3)), SKEW, atol=1e-12)
    assert int(mbs.GetMarkerNumber("own")) == int(markers[1])


def test_force_at_an_added_marker_has_its_lever(skew_scene):
    """A force at the offset moves the rotor like a force and a moment at the interface."""
    force = np.array([3.0, -1.0, 2.0])
    ends = []
    for where, offset, kind in (
        ("a", OFFSET, "rigid"),
        ([0, 1, 2, 3], OFFSET, "rigid"),
        ("a", OFFSET, "position"),
        (None, np.zeros(3), "rigid"),
    ):
        solid, _, _ = skew_scene
        mbs = exu.SystemContainer().AddSystem()
        body = add_rotor(mbs, solid.reduce(3), spin=0.0, translation="none")
        marker = body.add_marker(where, offset, kind=kind) if where else body.marker("a")
        mbs.CreateForce(itemNumber=marker, loadVector=force.tolist())
        if not where:
            mbs.CreateTorque(itemNumber=marker, loadVector=np.cross(OFFSET, force).tolist())
        mbs.Assemble()
        settings = recommended_settings(end_time=1e-3, step=1e-4)
        settings.solution.file.write = False
        settings.timeIntegration.verboseMode = 0
        mbs.SolveDynamic(settings)
        ends.append(body.coordinates()[0])
    for end in ends[1:]:
        # levers change with the deflection, 1e-6 here
        np.testing.assert_allclose(end, ends[0], atol=1e-5 * abs(ends[0]).max())


@pytest.mark.parametrize(
    ("where", "change", "message"),
    [
        ([0, 1], {}, "where: the nodes"),
        ([0, 99], {}, "where"),
        ([0, 0, 1], {}, "different nodes"),
        ("nowhere", {}, "where: interface"),
        ("a", {"weights": [1.0]}, "weights: are for mesh nodes"),
        ([0, 1, 2], {"weights": [1.0, -1.0, 1.0]}, "weights: needs"),
    ],
)
def test_markers_that_cannot_be_are_refused(skew_scene, where, change, message):
    _, mbs, body = skew_scene
    before = mbs.systemData.NumberOfMarkers()
    with pytest.raises(ValueError, match=message):
        body.add_marker(where, **change)
    assert mbs.systemData.NumberOfMarkers() == before
