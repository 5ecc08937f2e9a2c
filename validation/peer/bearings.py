"""Peer scenes of one rotor on bearings: markers of either kind, laws of the user, all axes."""

from __future__ import annotations

import numpy as np
from exudyn.itemInterface import LoadForceVector

from exudyn_rotor import use_mean_axis_modes
from validation.peer import parts
from validation.peer.scene import Flexible, Scene, Script

SPEED = 100.0  # rad/s
WEIGHT = 9.81
COURSE = "Examples/CMSexampleCourse"
TEST_MODEL = "TestModels/objectFFRFreducedOrderTest"
DAMPED_TILTS = (
    "Exudyn gives a rigid marker's local angular velocity in axes of the frame, not of the marker; "
    "a RigidBodySpringDamper that damps tilts by d gets a false cross stiffness Ωd, from elastic "
    "slopes on Exudyn's body, from all tilts here"
)


def spinning(script: Script, axis: str = "z", modes: int = 8, **given) -> Flexible:
    """Add the rotor with its spin about an axis."""
    fem = parts.rotor(axis, modes)
    return script.flexible(
        fem, axis=parts.AXES[axis], initialAngularVelocity=SPEED * parts.AXES[axis], **given
    )


def on_springs(script: Script, body: Flexible, markers: dict, stiffness: float = 1e6) -> None:
    """Put both ends on springs to the ground, all three directions, and compare both."""
    for marker_of, marker in markers.items():
        seat = script.ground_marker(parts.mean_position(body.fem, marker_of))
        script.spring(seat, marker, [stiffness] * 3, [1e-3 * stiffness] * 3)
        script.observe(marker)


def position_markers(script: Script) -> None:
    """Springs at the script's own position markers."""
    body = spinning(script)
    on_springs(script, body, {end: body.position_marker(end) for end in parts.ENDS})
    script.observe_node(body, [0.0, 0.0, 0.25])


def rigid_markers(script: Script) -> None:
    """Springs at the script's own rigid markers, gravity by its own marker of the mass."""
    body = spinning(script)
    body.weigh([0.0, -WEIGHT, 0.0])
    on_springs(script, body, {end: body.rigid_marker(end) for end in parts.ENDS})


def markers_of_the_call(script: Script) -> None:
    """Springs at the markers that the call itself makes, gravity as its argument."""
    body = spinning(script, gravity=[0.0, -WEIGHT, 0.0])
    on_springs(script, body, body.markers)


def offsets_of_the_call(script: Script) -> None:
    """Springs at markers of the call whose offsets put them 0.05 m beyond the end faces."""
    beyond = np.array([[0.0, 0.0, -0.05], [0.0, 0.0, 0.05]])
    body = spinning(script, gravity=[0.0, -WEIGHT, 0.0], superElementRigidMarkersOffsets=beyond)
    for offset, (end, marker) in zip(beyond, body.markers.items(), strict=True):
        seat = script.ground_marker(parts.mean_position(body.fem, end) + offset)
        script.spring(seat, marker, [1e6] * 3, [1e3] * 3)
        script.observe(marker)


def mounted(script: Script) -> None:
    """The rotor stands upright along inertial y; a force that beats in space pulls at its rim."""
    upright = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
    body = script.flexible(
        parts.rotor("z"),
        axis="z",
        referencePosition=[1.0, 0.5, 0.0],
        referenceRotationMatrix=upright,
        initialAngularVelocity=SPEED * upright[:, 2],
    )
    body.weigh([0.0, -WEIGHT, 0.0])
    for end in parts.ENDS:
        marker = body.rigid_marker(end)
        seat = np.array([1.0, 0.5, 0.0]) + upright @ parts.mean_position(body.fem, end)
        script.spring(script.ground_marker(seat), marker, [1e6] * 3, [1e3] * 3)
        script.observe(marker)
    rim = [0.0, parts.DISC_RADIUS, parts.DISC_START]
    script.mbs.AddLoad(
        LoadForceVector(
            markerNumber=body.node_marker(rim),
            loadVectorUserFunction=lambda mbs, t, load: [20.0 * np.sin(150.0 * t), 0.0, 5.0],
        )
    )


def axis_x(script: Script) -> None:
    """Rotor along mesh x on the script's own rigid markers with an offset."""
    off_axis(script, "x")


def axis_y(script: Script) -> None:
    """Rotor along mesh y on the script's own rigid markers with an offset."""
    off_axis(script, "y")


def axis_skew(script: Script) -> None:
    """Rotor along a skew axis on the script's own rigid markers with an offset."""
    off_axis(script, "skew")


def off_axis(script: Script, axis: str) -> None:
    """Springs at rigid markers whose offset puts them on the axis, beyond the end face."""
    body = spinning(script, axis)
    body.weigh([0.0, -WEIGHT, 0.0])
    beyond = dict(zip(parts.ENDS, (-0.05, parts.SHAFT_LENGTH + 0.05), strict=True))
    for end, distance in beyond.items():
        seat = distance * parts.AXES[axis]
        offset = seat - parts.mean_position(body.fem, end)
        marker = body.rigid_marker(end, offset=offset)
        script.spring(script.ground_marker(seat), marker, [1e6] * 3, [1e3] * 3)
        script.observe(marker)


def rigid_body_springs(script: Script) -> None:
    """Bearings that resist tilts: a RigidBodySpringDamper at each end, ground first."""
    body = spinning(script)
    body.weigh([0.0, -WEIGHT, 0.0])
    stiffness = np.diag([1e6, 1e6, 1e6, 1e3, 1e3, 0.0])
    for end in parts.ENDS:
        marker = body.rigid_marker(end)
        seat = script.ground_marker(parts.mean_position(body.fem, end))
        script.mbs.CreateRigidBodySpringDamper(
            itemNumbers=[seat, marker],
            stiffness=stiffness,
            damping=1e-3 * stiffness,
            useIntrinsicFormulation=False,
        )
        script.observe(marker)


def journal_bearings(script: Script) -> None:
    """Journal bearings: a user function with a film that stiffens, and cross coupling."""
    body = spinning(script)
    body.weigh([0.0, -WEIGHT, 0.0])
    gap, cross = 2e-3, 3e5

    def film(mbs, t, item, u, v, k, d, offset):
        closed = (u[0] ** 2 + u[1] ** 2) / gap**2
        stiff = 1.0 + closed / (1.0 - closed)
        return [
            k[0] * stiff * u[0] + cross * u[1] + d[0] * stiff * v[0],
            k[1] * stiff * u[1] - cross * u[0] + d[1] * stiff * v[1],
            k[2] * u[2] + d[2] * v[2],
        ]

    for end in parts.ENDS:
        marker = body.position_marker(end)
        seat = script.ground_marker(parts.mean_position(body.fem, end))
        script.spring(seat, marker, [1e6] * 3, [8e3] * 3, springForceUserFunction=film)
        script.observe(marker)


def squeeze_film(script: Script) -> None:
    """A user function of six forces at a RigidBodySpringDamper: cubic, with resisted tilts."""
    body = spinning(script)

    def law(mbs, t, item, u, r, v, w, k, d, first, second, offset):
        u, v = np.array(u), np.array(v)
        force = 1e6 * (1.0 + 1e6 * (u @ u)) * u + 1e3 * v
        torque = [1e3 * r[0] + 0.2 * w[0], 1e3 * r[1] + 0.2 * w[1], 0.0]
        return [*force, *torque]

    for end in parts.ENDS:
        marker = body.rigid_marker(end)
        seat = script.ground_marker(parts.mean_position(body.fem, end))
        script.mbs.CreateRigidBodySpringDamper(
            itemNumbers=[seat, marker],
            useIntrinsicFormulation=False,
            springForceTorqueUserFunction=law,
        )
        script.observe(marker)


def boundary_modes(script: Script) -> None:
    """The first scene with Hurty–Craig–Bampton modes, with which Exudyn's body softens falsely.

    By 5e-3 of the motion here, unless they have mean axes.
    """
    fem = parts.rotor("z", 6, boundary_modes=True)
    use_mean_axis_modes(fem)
    body = script.flexible(fem, axis="z", initialAngularVelocity=[0.0, 0.0, SPEED])
    on_springs(script, body, {end: body.position_marker(end) for end in parts.ENDS})


SCENES = (
    Scene("position markers on springs, z", position_markers, 0.1, 1e-4, TEST_MODEL),
    Scene("rigid markers on springs, z", rigid_markers, 0.1, 1e-4, TEST_MODEL, by_class=True),
    Scene("markers of the call, z", markers_of_the_call, 0.1, 1e-4, TEST_MODEL),
    Scene("markers of the call with offset, z", offsets_of_the_call, 0.1, 1e-4),
    Scene("mounted along y, force at the rim", mounted, 0.1, 1e-4),
    Scene("rigid markers with offset, x", axis_x, 0.1, 1e-4, TEST_MODEL, by_class=True),
    Scene("rigid markers with offset, y", axis_y, 0.1, 1e-4, TEST_MODEL),
    Scene("rigid markers with offset, skew", axis_skew, 0.1, 1e-4, TEST_MODEL),
    Scene("bearings that resist tilts, z", rigid_body_springs, 0.1, 1e-4, note=DAMPED_TILTS),
    Scene("journal bearings, user function", journal_bearings, 0.1, 1e-4, by_class=True),
    Scene("squeeze film, six forces", squeeze_film, 0.1, 1e-4, note=DAMPED_TILTS),
    Scene("Craig–Bampton modes, z", boundary_modes, 0.1, 1e-4, COURSE, by_class=True),
)
