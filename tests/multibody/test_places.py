"""Bases, foundations and second shafts beside an interface by what a mesh does to its middle."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import MarkerBodyRigid, MarkerNodeRigid, SensorMarker
from point_rotors import SKEW_AXIS
from rings import rings, run
from scipy.spatial.transform import Rotation

import exudyn_rotor as er

NEAR, FAR = 3e-4, 3e-3  # m: what a mesh does to its middle, and more than that
SPRING = er.Support("left", 1e6 * np.eye(3), 500.0 * np.eye(3))


def on_a_marker(shift, axis):
    """Return a rotor whose left bearing is on a marker of the ground, `shift` along the axis."""
    mbs, rotor = exu.SystemContainer().AddSystem(), rings(axis)
    turn = Rotation.from_rotvec([0.3, -0.8, 1.1]).as_matrix()
    body = er.add_rotor(mbs, rotor.reduce(0), rotation=turn, position=[4.0, -3.0, 9.0], spin=60.0)
    place = [4.0, -3.0, 9.0] + turn @ ((-0.15 + shift) * rotor.axis.direction)
    ground = mbs.CreateGround(referencePosition=[1.0, 0.0, 2.0])
    local = place - [1.0, 0.0, 2.0]
    marker = mbs.AddMarker(MarkerBodyRigid(bodyNumber=ground, localPosition=local))
    return mbs, body, marker


@pytest.mark.parametrize("axis", [[0.0, 0.0, 1.0], SKEW_AXIS])
def test_a_marker_beside_the_middle_of_a_seat_pushes_nothing(axis):
    """300 µm on 1 MN/m would be 300 N along the axis; the bearing stands where the seat is."""
    moved = []
    for shift in (0.0, NEAR):
        mbs, body, marker = on_a_marker(shift, axis)
        er.add_supports(body, SPRING, base=marker)
        force = mbs.CreateForce(itemNumber=body.marker("right"), loadVector=[3.0, 5.0, 2.0])
        assert force is not None
        run(mbs, 2e-3, 10)
        moved.append(body.coordinates()[0])
    np.testing.assert_allclose(moved[1], moved[0], atol=1e-6 * np.abs(moved[0]).max())


def block(shift):
    """Return a rigid block whose point is off the interface by `shift` (3,)."""
    corners = [[x, -0.25, z] for x in (-0.12, 0.12) for z in (-0.3, 0.3)]
    mounts = [er.Mount(corner, stiffness=1e6, damping=2e3) for corner in corners]
    seats = {"left": np.array([0.0, 0.0, -0.15]) + shift, "right": [0.0, 0.0, 0.15]}
    return er.Foundation.rigid(60.0, [3.25, 3.65, 0.5], [0.0, -0.2, 0.0], mounts, seats)


def test_a_foundation_takes_seats_of_a_mesh():
    rotor, along = rings().reduce(0), np.array([0.0, 0.0, 1.0])
    supports = [SPRING, er.Support("right", 1e6, 500.0)]
    ends = []
    for shift in (0.0, NEAR):
        mbs, foundation = exu.SystemContainer().AddSystem(), block(shift * along)
        er.linear_model(rotor, supports=supports, foundation=foundation)
        body = er.add_rotor(mbs, rotor, spin=60.0, gravity=[0.0, -9.81, 0.0])
        er.add_supports(body, supports, base=er.add_foundation(mbs, foundation))
        run(mbs, 2e-3, 10)
        ends.append(np.array(mbs.systemData.GetODE2Coordinates()))
    # the arm of the forces on the block is longer by 3e-4/0.25
    np.testing.assert_allclose(*ends, atol=2e-3 * np.abs(ends[0]).max())
    for shift in (FAR * along, [NEAR, 0.0, 0.0]):
        with pytest.raises(ValueError, match=r"foundation: its point 'left' is .* m off"):
            er.linear_model(rotor, supports=supports, foundation=block(shift))
        mbs = exu.SystemContainer().AddSystem()
        body, base = er.add_rotor(mbs, rotor, spin=60.0), er.add_foundation(mbs, block(shift))
        before = mbs.systemData.NumberOfMarkers(), mbs.systemData.NumberOfObjects()
        with pytest.raises(ValueError, match=r"foundation: its point 'left' is .* m off"):
            er.add_supports(body, supports, base=base)
        assert before == (mbs.systemData.NumberOfMarkers(), mbs.systemData.NumberOfObjects())


@pytest.mark.parametrize("shift", [np.zeros(3), [4.0, -3.0, 9.0]])
def test_a_joint_without_a_position_holds_the_mesh_origin_of_an_unbalanced_rotor(shift):
    """The node stands beside the centre of mass, 10 mm off; a joint there would make it jump."""
    mbs, rotor = exu.SystemContainer().AddSystem(), rings([0.0, 0.0, 1.0])
    rotor = rotor.add_point_mass([0.1, 0.0, 0.0], 0.1 * rotor.mass[::3, ::3].sum())
    turn = Rotation.from_rotvec([0.3, -0.8, 1.1]).as_matrix()
    body = er.add_rotor(mbs, rotor.reduce(0), rotation=turn, position=shift, gravity=[0, 0, -9.81])
    node = mbs.AddMarker(MarkerNodeRigid(nodeNumber=body.nodes["rigid"]))
    mbs.CreateGenericJoint(itemNumbers=[mbs.CreateGround(), node])
    joint = mbs.AddSensor(
        SensorMarker(
            markerNumber=node,
            outputVariableType=exu.OutputVariableType.Displacement,
            storeInternal=True,
            writeToFile=False,
        )
    )
    run(mbs, 0.01, 10)
    moved = mbs.GetSensorStoredData(joint)[1:, 1:]
    assert np.abs(moved).max() < 1e-9
