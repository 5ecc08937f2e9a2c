"""Which angle of the marker body's node is the spin angle."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import random_arrays
from scipy.spatial.transform import Rotation

from exudyn_rotor import (
    ConstantSpeed,
    PrescribedMotion,
    SolidRotor,
    add_rotor,
    recommended_settings,
)

KINDS = exu.OutputVariableType
SKEW = Rotation.from_euler("XYZ", [0.7, -0.4, 1.1]).as_matrix()


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
