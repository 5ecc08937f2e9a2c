"""Markers and sensors at the node of a rotor's frame move as the node of Exudyn's body does."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import (
    Force,
    MarkerBodyRigid,
    MarkerNodePosition,
    MarkerNodeRigid,
    NodeRigidBodyRxyz,
    SensorMarker,
    Torque,
)
from exudyn.utilities import RigidBodySpringDamper
from point_rotors import free_stiffness
from scipy.spatial.transform import Rotation

from exudyn_rotor import SolidRotor, add_rotor, linear_model, steady_state
from exudyn_rotor.multibody.rotor.frame import FRAME_NODES
from exudyn_rotor.theory.nodal import rotations, translations

KINDS = exu.OutputVariableType
SKEW = Rotation.from_euler("XYZ", [0.7, -0.4, 1.1]).as_matrix()
TO_X = Rotation.from_euler("y", np.pi / 2).as_matrix()
TO_Y = Rotation.from_euler("x", -np.pi / 2).as_matrix()
AXES = {"z": np.eye(3), "x": TO_X, "y": TO_Y, "skew": SKEW}
SPEED = 50.0


def rings(axis="z", above=0.2, aside=0.02, modes=2):
    """Return two rings of unequal masses above the mesh origin, their axis z turned in the mesh.

    The centre of mass is off the axis, and no axis of inertia is along it.
    """
    turn = AXES[axis]
    angle = 2.0 * np.pi * np.arange(5) / 5
    circle = 0.2 * np.column_stack([np.cos(angle), np.sin(angle), 0.0 * angle])
    centers = np.array([[aside, 0.0, above + z] for z in (-0.1, 0.15)])
    nodes = np.vstack([circle + center for center in centers]) @ turn.T
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
    turned = np.eye(4)
    turned[:3, :3] = SKEW
    node, moved = rigid_marker(body), rigid_marker(body, localHT=turned)
    sensors, axes = (
        {kind: mbs.AddSensor(SensorMarker(markerNumber=marker, outputVariableType=kind))
         for kind in kinds}
        for marker, kinds in (
            (node, (KINDS.Position, KINDS.Displacement, KINDS.Velocity, KINDS.AngularVelocity,
                    KINDS.RotationMatrix)),
            (moved, (KINDS.RotationMatrix,)),
        )
    )  # fmt: skip
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
    axes = np.reshape(mbs.GetSensorValues(axes[KINDS.RotationMatrix]), (3, 3))
    wanted = expected[KINDS.RotationMatrix].reshape(3, 3) @ SKEW
    np.testing.assert_allclose(axes, wanted, atol=1e-6 * 0.1)


# ------------------------------------------------------------------ loads and connectors


def node_scene(translation="free", axis="z", spin="free", tilting=4e3, **options):
    """Return a rotor on a spring and a tilt spring at its node, and a spring at one end."""
    turn = AXES[axis]
    _, reduced = rings(axis)
    mbs = exu.SystemContainer().AddSystem()
    speed = {"initial_speed": SPEED} if spin == "free" else {}
    if translation != "none":  # the centre of mass circles about the axis
        speed["initial_velocity"] = np.cross(SPEED * turn[:, 2], reduced.center_of_mass)
    body = add_rotor(
        mbs,
        reduced,
        translation=translation,
        frame_node="mesh_origin",
        spin=spin,
        **speed,
        **options,
    )
    ground = mbs.CreateGround(referenceRotationMatrix=turn)
    node = rigid_marker(body, localHT=exu.HT(rotation=turn, translation=np.zeros(3)))
    seat = mbs.AddMarker(MarkerBodyRigid(bodyNumber=ground))
    stiffness = np.diag([2e5, 2e5, 2e5, tilting, tilting, 0.0])
    mbs.AddObject(RigidBodySpringDamper(markerNumbers=[seat, node], stiffness=stiffness))
    end = body.marker("right")
    mbs.CreateCartesianSpringDamper(
        itemNumbers=[ground, end],
        localPosition0=[0.02, 0.0, 0.35],
        stiffness=[1e5] * 3,
    )
    seen = SensorMarker(markerNumber=end, outputVariableType=KINDS.Displacement, storeInternal=True)
    return mbs, body, node, mbs.AddSensor(seen)


def solved(mbs, sensor, steps=40, end=8e-3):
    mbs.Assemble()
    mbs.SolveDynamic(settings(steps, end))
    return mbs.GetSensorStoredData(sensor)[:, 1:]


@pytest.fixture(scope="module")
def expected():
    """Return the motion in axes of the rotor at rest, for a free and a constant spin."""
    return {spin: moved("free", "z", spin) for spin in ("free", SPEED)}


def moved(translation, axis, spin):
    """Run a rotor with a force and a torque at its node."""
    mbs, _, node, seen = node_scene(translation, axis=axis, spin=spin)
    force, torque = AXES[axis] @ [30.0, 10.0, 20.0], AXES[axis] @ [3.0, 1.0, 0.0]
    mbs.AddLoad(Force(markerNumber=node, loadVector=force))
    mbs.AddLoad(Torque(markerNumber=node, loadVector=torque))
    return solved(mbs, seen) @ AXES[axis]


@pytest.mark.parametrize("spin", ["free", SPEED])
@pytest.mark.parametrize(
    ("axis", "translation"),
    [("z", "in-plane"), ("z", "none"), ("x", "free"), ("y", "in-plane"), ("skew", "none")],
)
def test_node_carries_forces_torques_and_springs_alike(expected, axis, translation, spin):
    """Translations that are modes turn, and their integration errs by (Ωh)² at most."""
    found, step = moved(translation, axis, spin), 2e-4
    error = (SPEED * step) ** 2 if translation == "none" else 1e-9
    assert abs(found - expected[spin]).max() < error * abs(expected[spin]).max()


def test_force_at_the_node_tilts_a_rigid_rotor_about_its_centre_of_mass():
    """``F/m + α × r`` with ``α = I⁻¹ (x − χ) × F``, at rest; the node is in the mesh origin."""
    solid, reduced = rings(modes=0)
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, frame_node="mesh_origin")
    force, torque = np.array([3.0, 1.0, 2.0]), np.array([0.2, 0.3, -0.1])
    node = rigid_marker(body)
    mbs.AddLoad(Force(markerNumber=node, loadVector=force))
    mbs.AddLoad(Torque(markerNumber=node, loadVector=torque))
    end = 1e-3
    seen = SensorMarker(
        markerNumber=body.marker("right"), outputVariableType=KINDS.Velocity, storeInternal=True
    )
    velocity = solved(mbs, mbs.AddSensor(seen), 10, end)[-1]
    center, mass = reduced.center_of_mass, np.trace(solid.mass.toarray()) / 3.0
    turns = rotations(solid.nodes, center)
    moment = torque + np.cross(-center, force)
    alpha = np.linalg.solve(turns.T @ (solid.mass @ turns), moment)
    arm = np.array([0.02, 0.0, 0.35]) - center
    np.testing.assert_allclose(velocity / end, force / mass + np.cross(alpha, arm), rtol=1e-5)


def test_position_marker_of_the_node_takes_the_lever_of_the_tilts():
    """A force there does the same as at a rigid marker, or at the node for Exudyn's calls."""
    found = []
    for kind in (MarkerNodePosition, MarkerNodeRigid, None):
        mbs, body, _, seen = node_scene(axis="skew")
        node = body.nodes["rigid"]
        at = node if kind is None else mbs.AddMarker(kind(nodeNumber=node))
        mbs.CreateForce(itemNumber=at, loadVector=[50.0, 20.0, 0.0])
        found.append(solved(mbs, seen))
    for other in found[1:]:
        assert abs(other - found[0]).max() < 1e-9 * abs(found[0]).max()


def test_place_of_the_node_changes_nothing_else():
    """Equations, weight, linear scenes and start states are those of the node elsewhere."""
    motions, states, matrices, loads = [], [], [], []
    for place in FRAME_NODES:
        _, reduced = rings(modes=0)
        mbs = exu.SystemContainer().AddSystem()
        body = add_rotor(
            mbs,
            reduced,
            initial_speed=SPEED,
            frame_node=place,
            gravity=[3.0, -9.81, 1.0],
            markers="position",
        )
        for name, z in (("left", 0.1), ("right", 0.35)):
            mbs.CreateCartesianSpringDamper(
                itemNumbers=[mbs.CreateGround(), body.marker(name)],
                localPosition0=[0.02, 0.0, z],
                stiffness=[1e5, 2e5, 1e5],
                damping=[100.0] * 3,
            )
        seen = SensorMarker(
            markerNumber=body.marker("right"), outputVariableType=KINDS.Position, storeInternal=True
        )
        motions.append(solved(mbs, mbs.AddSensor(seen)))
        steady = steady_state(body, SPEED)
        states.append(steady.state().q)
        matrices.append(linear_model(mbs, body=body).at(SPEED).K[0])
        loads.append(linear_model(mbs, body=body).unbalance(SPEED)[1])
        height = 0.0 if place == "mesh_origin" else reduced.center_of_mass[2]
        assert body.frame.position[2] == pytest.approx(height, abs=1e-15)
    for first, second in (motions, states, matrices, loads):
        assert abs(first - second).max() < 1e-9 * abs(first).max()


def test_energy_is_conserved_with_a_spring_at_the_node():
    """Of rotor and springs, 2e5 and 1e5 N/m; the error of the step is of second order."""
    drift = []
    for steps in (50, 100):
        mbs, body, node, seen = node_scene(tilting=0.0)
        place = SensorMarker(
            markerNumber=node, outputVariableType=KINDS.Position, storeInternal=True
        )
        place, energy = mbs.AddSensor(place), body.add_energy_sensor()
        end = solved(mbs, seen, steps, 0.01)
        at_node, rotor = (mbs.GetSensorStoredData(one)[:, 1:] for one in (place, energy))
        springs = 1e5 * (at_node**2).sum(axis=1) + 0.5e5 * (end**2).sum(axis=1)
        total = rotor.sum(axis=1) + springs
        drift.append(np.ptp(total) / springs.max())
    assert drift[1] < 1e-3
    assert drift[1] < 0.3 * drift[0]


def test_a_run_starts_from_the_steady_state_of_springs_at_the_node():
    """After a revolution it is back where it was."""
    mbs, body, _, seen = node_scene(spin=SPEED, gravity=[0.0, -9.81, 0.0])
    mbs.Assemble()
    steady = steady_state(body)
    body.start_from(steady.state())
    mbs.SolveDynamic(settings(200, 2.0 * np.pi / SPEED))
    found = mbs.GetSensorStoredData(seen)[:, 1:]
    assert abs(found[-1] - found[0]).max() < 1e-3 * abs(found - found[0]).max()


def test_markers_of_a_script_stay_what_they_are():
    """What uses them is pointed at others, once; nodes of other bodies are left alone."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rings()[1])
    other = mbs.AddNode(NodeRigidBodyRxyz())
    own, foreign = rigid_marker(body), mbs.AddMarker(MarkerNodeRigid(nodeNumber=other))
    load = mbs.AddLoad(Force(markerNumber=own, loadVector=[1.0, 0.0, 0.0]))
    elsewhere = mbs.AddLoad(Force(markerNumber=foreign, loadVector=[1.0, 0.0, 0.0]))
    pair = mbs.AddObject(
        RigidBodySpringDamper(
            markerNumbers=[foreign, own], stiffness=np.eye(6), damping=np.zeros((6, 6))
        )
    )
    for _ in range(2):
        mbs.Assemble()
        assert [mbs.GetMarker(m)["markerType"] for m in (own, foreign)] == ["NodeRigid"] * 2
        used = mbs.GetLoad(load)["markerNumber"]
        assert mbs.GetMarker(used)["markerType"] == "SuperElementRigid"
        assert int(mbs.GetLoad(elsewhere)["markerNumber"]) == int(foreign)
        used_by_pair = list(map(int, mbs.GetObject(pair)["markerNumbers"]))
        assert used_by_pair == [int(foreign), int(used)]
        assert mbs.systemData.NumberOfMarkers() == int(used) + 1
    assert [key for key in mbs.sys if "exudyn_rotor" in key] == ["exudyn_rotor"]
