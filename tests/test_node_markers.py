"""Markers and sensors at the node of a rotor's frame move as the node of Exudyn's body does."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import (
    Force,
    MarkerNodePosition,
    MarkerNodeRigid,
    NodeRigidBodyRxyz,
    SensorMarker,
    SensorNode,
    Torque,
)
from exudyn.utilities import GenericJoint, RigidBodySpringDamper
from point_rotors import free_stiffness
from scipy.spatial.transform import Rotation

from exudyn_rotor import SolidRotor, add_rotor, campbell, linear_model, steady_state
from exudyn_rotor.multibody.frame import FRAME_NODES
from exudyn_rotor.theory.nodal import rotations, translations

KINDS = exu.OutputVariableType
SKEW = Rotation.from_euler("XYZ", [0.7, -0.4, 1.1]).as_matrix()
TO_X = Rotation.from_euler("y", np.pi / 2).as_matrix()
AXES = {"z": np.eye(3), "x": TO_X, "y": TO_X @ TO_X, "skew": SKEW}
AXES["y"] = Rotation.from_euler("x", -np.pi / 2).as_matrix()
pytestmark = pytest.mark.filterwarnings("ignore:.*no node of Exudyn turns")


def rings(axis="z", above=0.2, aside=0.02, modes=2):
    """Return two rings of unequal masses above the mesh origin, their axis z turned in the mesh.

    The centre of mass is off the axis, and no axis of inertia is along it.
    """
    turn = AXES[axis]
    angle = 2.0 * np.pi * np.arange(5) / 5
    circle = 0.2 * np.column_stack([np.cos(angle), np.sin(angle), 0.0 * angle])
    nodes = np.vstack([circle + [aside, 0.0, above + z] for z in (-0.1, 0.15)]) @ turn.T
    masses = np.repeat(0.5 + 0.02 * np.arange(10), 3)
    rotor = SolidRotor.from_matrices(
        np.diag(masses),
        free_stiffness(nodes, 1e8 * np.eye(30)),
        nodes,
        turn[:, 2],
        interfaces={"left": np.arange(5), "right": np.arange(5, 10)},
    )
    return rotor, rotor.reduce(modes)


def rigid_marker(body, **options):
    return body.mbs.AddMarker(MarkerNodeRigid(nodeNumber=body.nodes["rigid"], **options))


def settings(steps, end):
    result = exu.SimulationSettings()
    result.timeIntegration.numberOfSteps, result.timeIntegration.endTime = steps, end
    result.timeIntegration.newton.relativeTolerance = 1e-10
    result.timeIntegration.newton.useModifiedNewton = False
    result.timeIntegration.generalizedAlpha.spectralRadius = 1.0
    result.timeIntegration.verboseMode = 0
    result.solution.file.write = False
    result.solution.sensors.writePeriod = end / steps
    return result


# ------------------------------------------------------------------ motion


@pytest.mark.parametrize("place", FRAME_NODES)
@pytest.mark.parametrize("translation", ["free", "in-plane", "none"])
@pytest.mark.parametrize("axis", AXES)
def test_marker_and_sensors_have_the_mean_rigid_motion(axis, translation, place):
    """``(RᵀMR)⁻¹RᵀMu`` of the displacements u of all nodes, at the node's place, spun by θ."""
    solid, reduced = rings(axis)
    random = np.random.default_rng(1)
    count = reduced.size - {"free": 4, "in-plane": 3, "none": 1}[translation]
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(
        mbs,
        reduced,
        translation=translation,
        initial_angle=0.4,
        initial_speed=30.0,
        modal_coordinates=1e-6 * random.normal(size=count),
        modal_velocities=1e-4 * random.normal(size=count),
        frame_node=place,
    )
    node = body.nodes["rigid"]
    sensors = {
        kind: mbs.AddSensor(SensorNode(nodeNumber=node, outputVariableType=kind))
        for kind in (KINDS.Position, KINDS.Displacement, KINDS.Velocity, KINDS.AngularVelocity,
                     KINDS.RotationMatrix)
    }  # fmt: skip
    turned = np.eye(4)
    turned[:3, :3], turned[:3, 3] = SKEW, [0.01, 0.03, -0.02]
    moved = rigid_marker(body, localHT=turned)
    mbs.Assemble()

    point = np.zeros(3) if place == "mesh_origin" else body.selection.origin
    q, q_t, _ = body.coordinates(exu.ConfigurationType.Initial)
    shape = solid.nodes.size
    u, v = (reduced.shapes.matrix @ body.selection.T @ x[body.motion.modes] for x in (q, q_t))
    R = np.hstack([translations(shape // 3), rotations(solid.nodes, point)])
    mean = np.linalg.solve(R.T @ (solid.mass @ R), R.T @ (solid.mass @ np.column_stack([u, v])))
    (shift, tilt), (rate, tilt_rate) = mean.T.reshape(2, 2, 3)
    A = Rotation.from_rotvec(0.4 * solid.axis.direction).as_matrix()
    tau, tau_t = (x[body.motion.translations] @ body.motion.free_directions.T for x in (q, q_t))
    arm = point - body.selection.origin  # from the frame of the formulation
    omega = 30.0 * solid.axis.direction
    expected = {
        KINDS.Position: body.selection.origin + tau + A @ (arm + shift),
        KINDS.Displacement: tau + A @ (arm + shift) - arm,
        KINDS.Velocity: tau_t + A @ (rate + np.cross(omega, arm + shift)),
        KINDS.AngularVelocity: A @ (omega + tilt_rate),
        KINDS.RotationMatrix: (A @ Rotation.from_rotvec(tilt).as_matrix()).ravel(),
    }
    size = np.abs(tilt).max()  # linear in the tilt: the rest is of second order
    for kind, number in sensors.items():
        scale = {KINDS.AngularVelocity: 1e-9, KINDS.Velocity: 1e-9}.get(kind, size**2 + 1e-12)
        np.testing.assert_allclose(mbs.GetSensorValues(number), expected[kind], atol=scale)
    there = mbs.GetMarkerOutput(moved, KINDS.Position)
    offset = A @ (turned[:3, 3] + np.cross(tilt, turned[:3, 3]))
    np.testing.assert_allclose(there, expected[KINDS.Position] + offset, atol=1e-12)
    axes = np.reshape(mbs.GetMarkerOutput(moved, KINDS.RotationMatrix), (3, 3))
    wanted = expected[KINDS.RotationMatrix].reshape(3, 3) @ SKEW
    np.testing.assert_allclose(axes, wanted, atol=1e-6 * 0.1)
