"""A script's own markers on many nodes of a rotor, before and after they are condensed."""

import exudyn
import numpy as np
import pytest
from exudyn.itemInterface import (
    CartesianSpringDamper,
    MarkerBodyRigid,
    MarkerSuperElementPosition,
    MarkerSuperElementRigid,
    ObjectGround,
    RigidBodySpringDamper,
    SensorMarker,
)
from point_rotors import random_rotor

from exudyn_rotor import RotorBody, add_rotor

NODES = [0, 2, 3, 5]
WEIGHTS = [0.1, 0.2, 0.3, 0.4]  # uneven, so that the mean is not that of the nodes
KINDS = exudyn.OutputVariableType


@pytest.fixture(scope="module")
def reduced():
    return random_rotor(3, axis="z").reduce(5)


def rotor_in(reduced, **options) -> RotorBody:
    mbs = exudyn.SystemContainer().AddSystem()
    start = {
        "modal_coordinates": 1e-2 * np.arange(1, 8),
        "modal_velocities": np.linspace(0.4, -0.3, 7),
        "initial_speed": 3.0,
        "initial_angle": 0.7,
    }
    return add_rotor(mbs, reduced, **(start | options))


def rigid(body: RotorBody, **changes) -> exudyn.MarkerIndex:
    place = np.eye(4)
    place[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    common = {"meshNodeNumbers": NODES, "weightingFactors": WEIGHTS, "localHT": place}
    number = body.objects["marker_body"]
    item = MarkerSuperElementRigid(bodyNumber=number, **(common | changes))
    return body.mbs.AddMarker(item)


def position(body: RotorBody, **changes) -> exudyn.MarkerIndex:
    common = {"meshNodeNumbers": NODES[:3], "weightingFactors": [0.5, 0.2, 0.3]}
    number = body.objects["marker_body"]
    return body.mbs.AddMarker(MarkerSuperElementPosition(bodyNumber=number, **(common | changes)))


def node_count(body: RotorBody) -> int:
    number = body.objects["marker_body"]
    return len(body.mbs.GetObjectParameter(number, "referencePositions")) // 3


def run(body: RotorBody) -> list[np.ndarray]:
    """Hold the rotor at both markers, run an explicit solver, and return what sensors saw."""
    mbs, ground = body.mbs, body.mbs.AddObject(ObjectGround())
    one, other = rigid(body), position(body)
    base = [
        mbs.AddMarker(MarkerBodyRigid(bodyNumber=ground, localPosition=place))
        for place in ([0.3, 0.1, 0.2], [0.0, -0.4, 0.1])
    ]
    stiffness = np.diag([50.0, 60.0, 70.0, 20.0, 30.0, 10.0])
    mbs.AddObject(
        RigidBodySpringDamper(
            markerNumbers=[base[0], one], stiffness=stiffness, damping=0.01 * stiffness
        )
    )
    mbs.AddObject(
        CartesianSpringDamper(
            markerNumbers=[base[1], other], stiffness=[40.0, 50.0, 60.0], damping=[1.0, 2.0, 3.0]
        )
    )
    seen = [(one, kind) for kind in (KINDS.Position, KINDS.Velocity, KINDS.RotationMatrix)]
    seen += [(one, KINDS.AngularVelocity), (other, KINDS.Position), (other, KINDS.Velocity)]
    sensors = [
        mbs.AddSensor(SensorMarker(markerNumber=m, outputVariableType=k, storeInternal=True))
        for m, k in seen
    ]
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 40, 0.04
    mbs.SolveDynamic(settings, solverType=exudyn.DynamicSolverType.RK44)
    return [mbs.GetSensorStoredData(sensor)[:, 1:] for sensor in sensors]


def test_condensed_markers_move_and_act_alike(reduced):
    """Forces, torques, velocities and angles: the whole motion is the same.

    Both sum the same numbers in another order, 1e-16 of them each; 40 steps of a motion whose
    forces grow with it leave 1e-12.
    """
    bodies = [rotor_in(reduced, condense_markers=flag, locking="mass") for flag in (False, True)]
    before = [node_count(body) for body in bodies]
    plain, condensed = (run(body) for body in bodies)
    assert [node_count(body) for body in bodies] == [before[0], before[1] + 3 + 1]
    for one, other in zip(plain, condensed, strict=True):
        assert np.ptp(one, axis=0).max() > 1e-3  # it moves
        assert other == pytest.approx(one, abs=1e-12 * np.abs(one).max())


def test_a_second_assembly_adds_nothing(reduced):
    body = rotor_in(reduced)
    marker = rigid(body)
    body.mbs.Assemble()
    count, nodes = node_count(body), body.mbs.GetMarker(marker)["meshNodeNumbers"]
    assert len(nodes) == 3
    body.mbs.Assemble()
    assert node_count(body) == count
    assert body.mbs.GetMarker(marker)["meshNodeNumbers"] == nodes


@pytest.mark.parametrize(
    "add",
    [
        lambda body: rigid(body, useAlternativeApproach=False),
        lambda body: rigid(body, weightingFactors=[0.1, 0.2, 0.3, 0.3]),
        lambda body: position(body, weightingFactors=[0.5, 0.2, 0.2]),
        lambda body: rigid(body, meshNodeNumbers=[0, 2, 3], weightingFactors=[0.2, 0.3, 0.5]),
        lambda body: position(body, meshNodeNumbers=[4], weightingFactors=[1.0]),
    ],
    ids=["other formula", "rigid, sum", "position, sum", "three nodes", "one node"],
)
def test_what_is_left_as_it_is(reduced, add):
    """Where the result would be another, or nothing is to be gained."""
    body = rotor_in(reduced)
    marker, count = add(body), node_count(body)
    before = body.mbs.GetMarker(marker)["meshNodeNumbers"]
    body.mbs.Assemble()
    assert node_count(body) == count
    assert body.mbs.GetMarker(marker)["meshNodeNumbers"] == before


def test_stress_modes_get_rows_of_zeros(reduced):
    body = rotor_in(reduced)
    number, count = body.objects["marker_body"], node_count(body)
    stress = np.arange(count * 42, dtype=float).reshape(count, 42)
    body.mbs.SetObjectParameter(number, "outputVariableModeBasis", stress)
    position(body)
    body.mbs.Assemble()
    found = body.mbs.GetObjectParameter(number, "outputVariableModeBasis")
    assert found == pytest.approx(np.vstack([stress, np.zeros((1, 42))]))


def test_another_body_after_a_reset_is_left_alone(reduced):
    body = rotor_in(reduced)
    mbs = body.mbs
    mbs.Reset()
    other = add_rotor(mbs, reduced, condense_markers=False)
    assert int(other.objects["marker_body"]) == int(body.objects["marker_body"])
    marker = position(other)
    mbs.Assemble()
    assert len(mbs.GetMarker(marker)["meshNodeNumbers"]) == 3
