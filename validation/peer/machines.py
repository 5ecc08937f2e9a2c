"""Peer scenes of machines: joints, couplings, beds, moving bases, pendulums, a piston engine."""

from __future__ import annotations

import exudyn
import numpy as np
from exudyn.itemInterface import (
    CoordinateSpringDamper,
    LoadForceVector,
    LoadTorqueVector,
    MarkerBodyRigid,
    MarkerNodeCoordinate,
    MarkerNodePosition,
    MarkerNodeRigid,
    MarkerNodeRotationCoordinate,
    NodeGenericData,
    NodePointGround,
    RevoluteJointZ,
    SensorNode,
    TorsionalSpringDamper,
)
from exudyn.rigidBodyUtilities import InertiaCuboid, RotationMatrixY

from validation.peer import parts
from validation.peer.bearings import WEIGHT, on_springs, spinning
from validation.peer.scene import Flexible, Scene, Script

COUPLING = "TestModels/superElementRigidJointTest"
PENDULUM = "Examples/NGsolveCreateFFRFReducedOrder"
ENGINE = "Examples/NGsolvePistonEngine"
MOMENT = (
    "a torque T about a tilted axis has no moment Tφ across it: T over the stiffness of the tilt"
)
DAMPED = "a damper of tilts at the frame's node has a false cross stiffness, which is told"
VELOCITY = exudyn.OutputVariableType.AngularVelocity


def centred_marker(body: Flexible, end: str, at: np.ndarray):
    """Add the script's own rigid marker at a point of the axis next to a boundary."""
    return body.rigid_marker(end, offset=np.asarray(at) - parts.mean_position(body.fem, end))


def generic_joint(script: Script) -> None:
    """A GenericJoint that leaves the spin about z at one end, a spring at the other."""
    body = spinning(script)
    body.weigh([0.0, -WEIGHT, 0.0])
    held = centred_marker(body, "left", [0.0, 0.0, 0.0])
    script.mbs.CreateGenericJoint(
        itemNumbers=[script.ground_marker([0.0, 0.0, 0.0]), held],
        constrainedAxes=[1, 1, 1, 0, 0, 0],
    )
    on_springs(script, body, {"right": body.position_marker("right")})


def revolute_joint(script: Script) -> None:
    """A revolute joint about mesh x at one end of an overhung rotor that is turned by a torque."""
    body = spinning(script, "x")
    held = centred_marker(body, "left", [0.0, 0.0, 0.0])
    about_x = RotationMatrixY(np.pi / 2)  # local z, which the joint leaves free, to mesh x
    script.mbs.AddObject(
        RevoluteJointZ(
            markerNumbers=[script.ground_marker([0.0, 0.0, 0.0]), held],
            rotationMarker0=about_x,
            rotationMarker1=about_x,
        )
    )
    end = centred_marker(body, "right", [parts.SHAFT_LENGTH, 0.0, 0.0])
    script.mbs.CreateTorque(itemNumber=end, loadVector=[5.0, 0.0, 0.0])
    script.observe(end)
    script.observe(end, VELOCITY)


def prismatic_joint(script: Script) -> None:
    """A rotor on a slide: a prismatic joint guides a rigid carriage, which a spring drives."""
    carriage = script.mbs.CreateRigidBody(
        referencePosition=[0.0, -0.3, 0.25], inertia=InertiaCuboid(4000.0, [0.4, 0.1, 0.6])
    )
    script.mbs.CreatePrismaticJoint(
        itemNumbers=[script.ground, carriage], position=[0.0, -0.3, 0.25], axis=[1.0, 0.0, 0.0]
    )
    script.mbs.CreateCartesianSpringDamper(
        itemNumbers=[script.ground, carriage],
        localPosition0=[2e-3, -0.3, 0.25],
        stiffness=[1e6, 0.0, 0.0],
        damping=[1e3, 0.0, 0.0],
    )
    body = spinning(script)
    for end in parts.ENDS:
        seat = parts.mean_position(body.fem, end) - [0.0, -0.3, 0.25]
        marker = body.rigid_marker(end)
        script.mbs.CreateCartesianSpringDamper(
            itemNumbers=[carriage, marker],
            localPosition0=seat,
            stiffness=[1e6] * 3,
            damping=[1e3] * 3,
        )
        script.observe(marker)


def torsional_coupling(script: Script) -> None:
    """Two rotors in line on springs; a torsional spring couples them, one of them is driven."""
    first = spinning(script)
    second = spinning(script, referencePosition=[0.0, 0.0, 0.6])
    on_springs(script, first, {end: first.rigid_marker(end) for end in parts.ENDS})
    for end in parts.ENDS:
        seat = parts.mean_position(second.fem, end) + np.array([0.0, 0.0, 0.6])
        marker = second.rigid_marker(end)
        script.spring(script.ground_marker(seat), marker, [1e6] * 3, [1e3] * 3)
    ends = first.rigid_marker("right"), second.rigid_marker("left")
    script.mbs.AddObject(
        TorsionalSpringDamper(
            markerNumbers=list(ends),
            nodeNumber=script.mbs.AddNode(
                NodeGenericData(initialCoordinates=[0.0], numberOfDataCoordinates=1)
            ),
            stiffness=5e3,
            damping=5.0,
        )
    )
    script.mbs.CreateTorque(itemNumber=first.rigid_marker("left"), loadVector=[0.0, 0.0, 100.0])
    for marker in ends:
        script.observe(marker, VELOCITY)


def flexible_bed(script: Script) -> None:
    """A rotor on a bed that is Exudyn's flexible body in either case, and stands on springs."""
    body, bed = spinning(script), script.unchanged(parts.bed())
    for end in parts.ENDS:
        foot = parts.mean_position(bed.fem, end)
        seat, marker = bed.position_marker(end), body.position_marker(end)
        arm = parts.mean_position(body.fem, end) - foot
        script.spring(seat, marker, [1e6] * 3, [1e3] * 3, offset=arm)
        script.observe(marker)
        script.observe(seat)
    positions = bed.fem.GetNodePositionsAsArray()
    for corner in ([-0.3, -0.45, -0.1], [0.3, -0.45, -0.1], [-0.3, -0.45, 0.6], [0.3, -0.45, 0.6]):
        node = int(np.linalg.norm(positions - corner, axis=1).argmin())
        foot = script.mbs.AddMarker(
            exudyn.itemInterface.MarkerSuperElementPosition(
                bodyNumber=bed.object, meshNodeNumbers=[node], weightingFactors=[1.0]
            )
        )
        script.spring(script.ground_marker(positions[node]), foot, [5e6] * 3, [1e4] * 3)


def moving_base(script: Script) -> None:
    """Bearings on a rigid base that a user function of time shakes sideways."""
    base = script.mbs.CreateRigidBody(
        referencePosition=[0.0, -0.3, 0.25], inertia=InertiaCuboid(2000.0, [0.4, 0.1, 0.6])
    )

    def shaken(mbs, t, item, rest):
        return [1e-3 * (1.0 - np.cos(120.0 * t)), 0.0, 0.0, 0.0, 0.0, 0.0]

    def shaken_t(mbs, t, item, rest):
        return [1e-3 * 120.0 * np.sin(120.0 * t), 0.0, 0.0, 0.0, 0.0, 0.0]

    script.mbs.CreateGenericJoint(
        itemNumbers=[script.ground, base],
        position=[0.0, -0.3, 0.25],
        constrainedAxes=[1] * 6,
        offsetUserFunction=shaken,
        offsetUserFunction_t=shaken_t,
    )
    body = spinning(script)
    body.weigh([0.0, -WEIGHT, 0.0])
    for end in parts.ENDS:
        marker = body.position_marker(end)
        script.mbs.CreateCartesianSpringDamper(
            itemNumbers=[base, marker],
            localPosition0=parts.mean_position(body.fem, end) - [0.0, -0.3, 0.25],
            stiffness=[1e6] * 3,
            damping=[1e3] * 3,
        )
        script.observe(marker)


def torque_on_the_node(script: Script) -> None:
    """Run-up of a rotor along x by a torque that turns with the body, on the node of its frame."""
    body = spinning(script, "x")
    on_springs(script, body, {end: body.rigid_marker(end) for end in parts.ENDS})
    node = script.mbs.AddMarker(MarkerNodeRigid(nodeNumber=body.node))
    script.mbs.AddLoad(
        LoadTorqueVector(markerNumber=node, loadVector=[200.0, 0.0, 0.0], bodyFixed=True)
    )
    script.observe(body.markers["right"], VELOCITY)


def spring_on_the_node(script: Script) -> None:
    """A bearing of a rotor at the node of its frame, as users do who know no boundaries."""
    bearing_on_the_node(script, 0.0)


def damper_on_the_node(script: Script) -> None:
    """The same bearing, which also damps tilts."""
    bearing_on_the_node(script, 1e-3)


def bearing_on_the_node(script: Script, damping_of_tilts: float) -> None:
    """Add a rotor with a bearing at its frame's node that resists tilts, and a spring."""
    body = spinning(script)
    node = script.mbs.AddMarker(MarkerNodeRigid(nodeNumber=body.node))
    stiffness = np.diag([1e6, 1e6, 1e6, 1e5, 1e5, 0.0])
    script.mbs.CreateRigidBodySpringDamper(
        itemNumbers=[script.ground, node],
        stiffness=stiffness,
        damping=stiffness * np.repeat([1e-3, damping_of_tilts], 3),
        useIntrinsicFormulation=False,
    )
    on_springs(script, body, {"right": body.position_marker("right")})


def joint_on_the_node(script: Script) -> None:
    """A ball joint between the ground and the node of the frame, a spring at the other end."""
    body = spinning(script)
    body.weigh([0.0, -WEIGHT, 0.0])
    node = script.mbs.AddMarker(MarkerNodeRigid(nodeNumber=body.node))
    script.mbs.CreateGenericJoint(
        itemNumbers=[script.ground, node], constrainedAxes=[1, 1, 1, 0, 0, 0]
    )
    on_springs(script, body, {"right": body.position_marker("right")})


def eccentric_node(script: Script) -> None:
    """Force, torque and spring at the node of a crank, whose centre of mass is off the axis."""
    body = script.flexible(parts.crank(), axis="z", initialAngularVelocity=[0.0, 0.0, 50.0])
    body.weigh([0.0, -WEIGHT, 0.0])
    node = script.mbs.AddMarker(MarkerNodeRigid(nodeNumber=body.node))
    script.mbs.AddLoad(LoadForceVector(markerNumber=node, loadVector=[5.0, 20.0, 10.0]))
    script.mbs.AddLoad(LoadTorqueVector(markerNumber=node, loadVector=[0.1, 0.2, 0.5]))
    place = script.mbs.AddMarker(MarkerNodePosition(nodeNumber=body.node))
    script.spring(script.ground_marker([0.0, 0.0, 0.0]), place, [2e5] * 3, [50.0] * 3)
    on_springs(script, body, {end: body.position_marker(end) for end in parts.ENDS}, 1e5)
    for kind in (exudyn.OutputVariableType.Displacement, VELOCITY):
        sensor = SensorNode(
            nodeNumber=body.node, storeInternal=True, writeToFile=False, outputVariableType=kind
        )
        script.sensors.append(script.mbs.AddSensor(sensor))


def rotation_coordinate(script: Script) -> None:
    """A torsion spring to the ground on the rotation coordinate of the frame's node, about z."""
    body = script.flexible(parts.rotor("z"), axis="z", initialAngularVelocity=[0.0, 0.0, 5.0])
    on_springs(script, body, {end: body.position_marker(end) for end in parts.ENDS})
    angle = script.mbs.AddMarker(
        MarkerNodeRotationCoordinate(nodeNumber=body.node, rotationCoordinate=2)
    )
    fixed = script.mbs.AddNode(NodePointGround())
    zero = script.mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=fixed, coordinate=0))
    script.mbs.AddObject(
        CoordinateSpringDamper(markerNumbers=[zero, angle], stiffness=2e3, damping=1.0)
    )
    script.observe(body.markers["right"], VELOCITY)


def clamped_at_rest(script: Script) -> None:
    """Two rotors one behind the other, clamped at one end, under a tenth of gravity, at rest.

    So the tilt stays below 1e-3 rad.
    """
    first = script.flexible(parts.rotor("z"), axis="z")
    second = script.flexible(
        parts.rotor("z"), axis="z", referencePosition=[0.0, 0.0, parts.SHAFT_LENGTH]
    )
    for body in (first, second):
        body.weigh([0.0, -0.1 * WEIGHT, 0.0])
    start, end = [0.0, 0.0, 0.0], [0.0, 0.0, parts.SHAFT_LENGTH]
    held, last = centred_marker(first, "left", start), centred_marker(first, "right", end)
    script.mbs.CreateGenericJoint(itemNumbers=[script.ground_marker(start), held])
    script.mbs.CreateGenericJoint(itemNumbers=[last, centred_marker(second, "left", start)])
    script.observe(last)
    script.observe(second.position_marker("right"))


def pendulum(script: Script) -> None:
    """A bar on a revolute joint about z that falls from the horizontal, far from small angles."""
    body = script.flexible(parts.bar(), axis="z")
    body.weigh([0.0, -WEIGHT, 0.0])
    hinge(script, script.ground_marker([0.0, 0.0, 0.0]), centred_marker(body, "left", np.zeros(3)))
    script.observe(body.position_marker("right"))


def double_pendulum(script: Script) -> None:
    """Two bars in a plane, on revolute joints about z."""
    tip = np.array([parts.BAR_LENGTH, 0.0, 0.0])
    first = script.flexible(parts.bar(), axis="z")
    second = script.flexible(parts.bar(), axis="z", referencePosition=tip)
    for body in (first, second):
        body.weigh([0.0, -WEIGHT, 0.0])
    hinge(script, script.ground_marker(np.zeros(3)), centred_marker(first, "left", np.zeros(3)))
    inner = centred_marker(first, "right", tip)
    hinge(script, inner, centred_marker(second, "left", np.zeros(3)))
    script.observe(inner)
    script.observe(second.position_marker("right"))


def hinge(script: Script, first, second, constrained=(1, 1, 1, 1, 1, 0)) -> None:
    """Add a joint that leaves the rotation about z."""
    script.mbs.CreateGenericJoint(itemNumbers=[first, second], constrainedAxes=list(constrained))


def piston_engine(script: Script) -> None:
    """Crank and connecting rod are flexible, the piston is a rigid body on a slide."""
    speed, inner = 20.0, parts.CRANK_ARM
    crank = script.flexible(parts.crank(), axis="z", initialAngularVelocity=[0.0, 0.0, speed])
    half = parts.CONROD_LENGTH / 2
    rod_speed = -speed * inner / parts.CONROD_LENGTH
    rod = script.flexible(
        parts.conrod(),
        axis="z",
        referencePosition=[inner + half, 0.0, 0.0],
        initialVelocity=[0.0, speed * inner / 2, 0.0],
        initialAngularVelocity=[0.0, 0.0, rod_speed],
    )
    slide(script, rod, inner + 2 * half)
    for end, at in (("left", -0.041), ("right", 0.041)):
        seat, marker = script.ground_marker([0.0, 0.0, at]), crank.position_marker(end)
        script.spring(seat, marker, [1e6] * 3, [2e3] * 3)
        script.observe(marker)
    pin = centred_marker(crank, "pin", [inner, 0.0, 0.0])
    big = centred_marker(rod, "left", [-half, 0.0, 0.0])
    hinge(script, pin, big, (1, 1, 0, 0, 0, 0))
    script.observe(pin)


def slide(script: Script, rod: Flexible, reach: float) -> None:
    """Put a piston at the end of the connecting rod, which it also keeps in its plane."""
    piston = script.mbs.CreateRigidBody(
        referencePosition=[reach, 0.0, 0.0], inertia=InertiaCuboid(7850.0, [0.034, 0.05, 0.05])
    )
    script.mbs.CreatePrismaticJoint(
        itemNumbers=[script.ground, piston], position=[reach, 0.0, 0.0], axis=[1.0, 0.0, 0.0]
    )
    small = centred_marker(rod, "right", [parts.CONROD_LENGTH / 2, 0.0, 0.0])
    bolt = script.mbs.AddMarker(MarkerBodyRigid(bodyNumber=piston))
    hinge(script, bolt, small)
    script.observe(small)


def crank_slider(script: Script) -> None:
    """A flexible crank with a rigid connecting rod and a rigid piston."""
    speed, inner, long = 20.0, parts.CRANK_ARM, parts.CONROD_LENGTH
    crank = script.flexible(parts.crank(), axis="z", initialAngularVelocity=[0.0, 0.0, speed])
    rod = script.mbs.CreateRigidBody(
        referencePosition=[inner + long / 2, 0.0, 0.0],
        initialVelocity=[0.0, speed * inner / 2, 0.0],
        initialAngularVelocity=[0.0, 0.0, -speed * inner / long],
        inertia=InertiaCuboid(7850.0, [long, parts.CONROD_HEIGHT, parts.PIN_WIDTH]),
    )
    piston = script.mbs.CreateRigidBody(
        referencePosition=[inner + long, 0.0, 0.0],
        inertia=InertiaCuboid(7850.0, [0.034, 0.05, 0.05]),
    )
    script.mbs.CreatePrismaticJoint(
        itemNumbers=[script.ground, piston], position=[inner + long, 0.0, 0.0], axis=[1.0, 0.0, 0.0]
    )
    script.mbs.CreateRevoluteJoint(
        itemNumbers=[rod, piston], position=[inner + long, 0.0, 0.0], axis=[0.0, 0.0, 1.0]
    )
    for end, at in (("left", -0.041), ("right", 0.041)):
        seat, marker = script.ground_marker([0.0, 0.0, at]), crank.position_marker(end)
        script.spring(seat, marker, [1e6] * 3, [2e3] * 3)
        script.observe(marker)
    pin = crank.rigid_marker("pin")
    script.mbs.CreateCartesianSpringDamper(
        itemNumbers=[rod, pin],
        localPosition0=[-long / 2, 0.0, 0.0],
        stiffness=[1e7, 1e7, 0.0],
        damping=[1e3, 1e3, 0.0],
    )
    script.observe(pin)


SCENES = (
    Scene("spherical joint and spring, z", generic_joint, 0.1, 1e-4, COUPLING, by_class=True),
    Scene("revolute joint, overhung, x", revolute_joint, 0.1, 1e-4, note=MOMENT),
    Scene("prismatic joint under the bearings", prismatic_joint, 0.1, 1e-4, by_class=True),
    Scene("two rotors, torsional coupling", torsional_coupling, 0.1, 1e-4, COUPLING, by_class=True),
    Scene("flexible bed of Exudyn", flexible_bed, 0.1, 1e-4),
    Scene("moving base", moving_base, 0.1, 1e-4, by_class=True),
    Scene("torque on the frame's node, x", torque_on_the_node, 0.1, 1e-4),
    Scene("bearing on the frame's node", spring_on_the_node, 0.1, 1e-4),
    Scene("the same with damped tilts", damper_on_the_node, 0.1, 1e-4, note=DAMPED),
    Scene("joint on the frame's node", joint_on_the_node, 0.1, 1e-4),
    Scene("node of an eccentric crank, sensors", eccentric_node, 0.1, 1e-4),
    Scene("torsion spring on the node's angle", rotation_coordinate, 0.1, 1e-4),
    Scene("two bodies clamped at rest", clamped_at_rest, 0.1, 1e-4, COUPLING, by_class=True),
    Scene("pendulum", pendulum, 0.5, 2.5e-4, "Examples/pendulumVerify"),
    Scene("double pendulum in a plane", double_pendulum, 0.5, 2.5e-4, PENDULUM),
    Scene("piston engine, crank and rod swapped", piston_engine, 0.1, 1e-4, ENGINE, by_class=True),
    Scene(
        "crank swapped, rigid rod",
        crank_slider,
        0.1,
        1e-4,
        "Examples/sliderCrankCMSacme",
        by_class=True,
    ),
)
