"""Markers and sensors at the node of a rotor's frame move as the node of Exudyn's body does."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import (
    Force,
    MarkerBodyRigid,
    MarkerNodeRigid,
    SensorMarker,
    Torque,
)
from exudyn.utilities import RigidBodySpringDamper
from point_rotors import free_stiffness
from scipy.spatial.transform import Rotation

from exudyn_rotor import SolidRotor, add_rotor

pytestmark = pytest.mark.filterwarnings("ignore:.*no node of Exudyn turns")

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
