"""What a rotor cannot carry is found, for any axis; nothing else is."""

import warnings
from functools import cache

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import (
    CartesianSpringDamper,
    CoordinateSpringDamper,
    CoordinateVectorConstraint,
    Force,
    LoadCoordinate,
    MarkerBodyMass,
    MarkerBodyRigid,
    MarkerNodeCoordinate,
    MarkerNodeCoordinates,
    MarkerNodeRigid,
    MarkerNodeRotationCoordinate,
    MarkerSuperElementRigid,
    NodePointGround,
    SensorNode,
    Torque,
)
from exudyn.utilities import (
    GenericJoint,
    Gravity,
    InertiaCuboid,
    RevoluteJointZ,
    RigidBodySpringDamper,
    SphericalJoint,
    TorsionalSpringDamper,
)
from point_rotors import free_stiffness
from scipy.spatial.transform import Rotation

from exudyn_rotor import ConnectionWarning, SolidRotor, add_rotor, check_run

# every assembly of these scenes warns of what is asked for here
pytestmark = pytest.mark.filterwarnings("ignore::exudyn_rotor.ConnectionWarning")

SKEW = Rotation.from_euler("XYZ", [0.7, -0.4, 1.1]).as_matrix()
TO_X = Rotation.from_euler("y", np.pi / 2).as_matrix()
# z axis to the mesh's spin axis, and mesh to space
MOUNTED = {
    "z": (np.eye(3), np.eye(3)),
    "z along x": (np.eye(3), TO_X),
    "x": (TO_X, np.eye(3)),
    "-y along z": (Rotation.from_euler("x", 90, degrees=True).as_matrix(), TO_X @ TO_X.T),
    "skew": (SKEW, SKEW),
}


def hanging():
    """Return the rings of :func:`rotor`, 0.3 m off their spin axis z."""
    return rings(np.eye(3), np.array([0.3, 0.0, 0.0]), "z")


@cache
def rotor(mount):
    """Return two rings of point masses, their axis z turned into the mesh; made once."""
    mesh = MOUNTED[mount][0]
    return rings(mesh, np.zeros(3), mesh[:, 2])


def rings(mesh, center, axis):
    angle = 2.0 * np.pi * np.arange(5) / 5
    circle = 0.2 * np.column_stack([np.cos(angle), np.sin(angle), 0.0 * angle])
    nodes = np.vstack([circle + np.array([0.0, 0.0, z]) for z in (-0.1, 0.1)]) @ mesh.T + center
    return SolidRotor.from_matrices(
        0.5 * np.eye(30),
        free_stiffness(nodes, 1e8 * np.eye(30)),
        nodes,
        axis,
        interfaces={"left": np.arange(5), "right": np.arange(5, 10)},
    ).reduce(2)


class Scene:
    """A rotor in an mbs, and directions: n along its spin axis, a and b across it."""

    def __init__(self, mount="z", **options):
        mesh, space = MOUNTED[mount]
        self.mbs = exu.SystemContainer().AddSystem()
        self.body = add_rotor(self.mbs, rotor(mount), rotation=space, **options)
        self.node, self.flexible = self.body.nodes["rigid"], self.body.objects["marker_body"]
        self.a, self.b, self.n = (space @ mesh).T
        self.rigid = self.mbs.AddMarker(MarkerNodeRigid(nodeNumber=self.node))
        axes = np.column_stack([self.a, self.b, self.n])
        ground = self.mbs.CreateGround(referenceRotationMatrix=axes)
        # a marker at rest whose z axis is the spin axis
        self.base = self.mbs.AddMarker(MarkerBodyRigid(bodyNumber=ground))
        turned = exu.HT(rotation=TO_X, translation=np.zeros(3))
        self.across = self.mbs.AddMarker(MarkerBodyRigid(bodyNumber=ground, localHT=turned))

    def pair(self, **options):
        return {"markerNumbers": [self.base, self.rigid], **options}

    def found(self):
        self.mbs.Assemble()
        return self.body.check_connections(warn=False)


def springs(s, *rotations):
    return RigidBodySpringDamper(
        **s.pair(stiffness=np.diag([1e3, 1e3, 1e3, *rotations]), damping=np.zeros((6, 6)))
    )


def dampers(s, *rotations):
    damping = np.diag([0.0, 0.0, 0.0, *rotations])
    return RigidBodySpringDamper(**s.pair(stiffness=np.zeros((6, 6)), damping=damping))


def load(kind, vector, **options):
    return lambda s: s.mbs.AddLoad(kind(markerNumber=s.rigid, loadVector=vector(s), **options))


def obj(make):
    return lambda s: s.mbs.AddObject(make(s))


CARRIED = {
    "torque about the axis": load(Torque, lambda s: (50.0 * s.n).tolist()),
    "force": load(Force, lambda s: [10.0, 20.0, 30.0]),
    "spring of forces": obj(lambda s: CartesianSpringDamper(**s.pair(stiffness=[1e3] * 3))),
    "spring about the axis": obj(lambda s: springs(s, 0.0, 0.0, 100.0)),
    "ball joint": obj(lambda s: SphericalJoint(**s.pair())),
    "joint about the axis": obj(
        lambda s: GenericJoint(**s.pair(constrainedAxes=[1, 1, 1, 0, 0, 1]))
    ),
    "torque across": load(Torque, lambda s: (50.0 * s.a + 20.0 * s.n).tolist()),
    "tilt spring": obj(lambda s: springs(s, 100.0, 0.0, 0.0)),
    "hinge": obj(lambda s: RevoluteJointZ(**s.pair())),
    "damper about the axis": obj(lambda s: dampers(s, 0.0, 0.0, 1.0)),
    "torsional spring": obj(lambda s: TorsionalSpringDamper(**s.pair(stiffness=10.0))),
    "inactive joint": obj(lambda s: GenericJoint(**s.pair(activeConnector=False))),
    "weight of the script": lambda s: s.mbs.AddLoad(
        Gravity(
            markerNumber=s.mbs.AddMarker(MarkerBodyMass(bodyNumber=s.flexible)),
            loadVector=[0.0, -9.81, 0.0],
        )
    ),
}


@pytest.mark.parametrize("mount", MOUNTED)
def test_only_what_the_node_cannot_carry_is_found(mount):
    """Markers at the node carry everything but dampers of tilts."""
    for name, attach in CARRIED.items():
        s = Scene(mount)
        attach(s)
        assert s.found() == (), name
    s = Scene(mount)
    obj(lambda s: dampers(s, 2.0, 0.0, 0.0))(s)
    (found,) = s.found()
    assert "damping of tilts, 2 N m s/rad, comes with a false cross stiffness" in found


@pytest.mark.parametrize("mount", ["z", "-y along z"])
def test_coordinates_of_the_node(mount):
    """Markers on the node's coordinates: tilts are locked, spin and translations are not."""
    for index in range(6):
        s = Scene(mount)
        marker = s.mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=s.node, coordinate=index))
        s.mbs.AddLoad(LoadCoordinate(markerNumber=marker, load=1.0))
        assert len(s.found()) == (index in s.body.locks.tilts)
    for axis in range(3):
        s = Scene(mount)
        turning = MarkerNodeRotationCoordinate(nodeNumber=s.node, rotationCoordinate=axis)
        zero = MarkerNodeCoordinate(nodeNumber=s.mbs.AddNode(NodePointGround()), coordinate=0)
        markers = [s.mbs.AddMarker(item) for item in (zero, turning)]
        s.mbs.AddObject(CoordinateSpringDamper(markerNumbers=markers, stiffness=1.0))
        assert len(s.found()) == (abs(s.n[axis]) < 0.5)
    for index in range(6):
        s = Scene(mount)
        ground = s.mbs.AddNode(NodePointGround())
        markers = [
            s.mbs.AddMarker(MarkerNodeCoordinates(nodeNumber=node)) for node in (ground, s.node)
        ]
        s.mbs.AddObject(
            CoordinateVectorConstraint(
                markerNumbers=markers,
                scalingMarker0=np.zeros((1, 0)),
                scalingMarker1=np.eye(6)[[index]],
                offset=[0.0],
            )
        )
        assert len(s.found()) == (index in s.body.locks.tilts)


@pytest.mark.parametrize("locking", ["mass", "constraints"])
def test_forces_on_a_node_that_stands_still(locking):
    """Those at a marker move the modes, those on a coordinate nothing."""
    for translation, across, along in (("none", 1, 1), ("in-plane", 0, 1), ("free", 0, 0)):
        for index, expected in ((0, across), (2, along)):
            s = Scene(translation=translation, locking=locking)
            s.mbs.AddLoad(Force(markerNumber=s.rigid, loadVector=[10.0, 20.0, 30.0]))
            assert s.found() == ()
            marker = s.mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=s.node, coordinate=index))
            s.mbs.AddLoad(LoadCoordinate(markerNumber=marker, load=1.0))
            found = s.found()
            assert len(found) == expected
            assert all("does not move" in sentence for sentence in found)


def test_coordinates_of_a_node_off_the_centre_of_mass_move_that():
    """As in a swapped body, whose node is in the mesh origin, 0.2 m below the centre of mass."""
    for place, expected in (("mesh_origin", 1), ("centre_of_mass", 0)):
        for index in (1, 5):
            mbs = exu.SystemContainer().AddSystem()
            body = add_rotor(
                mbs, rings(np.eye(3), np.array([0.0, 0.0, 0.2]), "z"), frame_node=place
            )
            node = body.nodes["rigid"]
            marker = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=index))
            mbs.AddLoad(LoadCoordinate(markerNumber=marker, load=1.0))
            mbs.Assemble()
            found = body.check_connections(warn=False)
            assert len(found) == (expected if index == 1 else 0)
            assert all("0.2 m off the node's place" in sentence for sentence in found)


def test_sensors_that_show_the_frame_alone():
    kinds = exu.OutputVariableType
    for kind, expected in (
        (kinds.AngularVelocityLocal, 1),
        (kinds.Acceleration, 1),
        (kinds.AngularVelocity, 0),
        (kinds.Coordinates, 0),
    ):
        s = Scene()
        s.mbs.AddSensor(SensorNode(nodeNumber=s.node, outputVariableType=kind))
        found = s.found()
        assert len(found) == expected
        assert all("without tilts" in sentence for sentence in found)


def test_offset_without_a_lever():
    """A marker that assembly leaves as it is: its offset turns with the frame alone."""
    for condense, expected in ((True, 0), (False, 1)):
        s = Scene(condense_markers=condense)
        marker = s.mbs.AddMarker(
            MarkerSuperElementRigid(
                bodyNumber=s.flexible,
                meshNodeNumbers=[0, 1, 2, 3],
                weightingFactors=[0.25] * 4,
                offset=[0.0, 0.0, 0.1],
            )
        )
        s.mbs.CreateForce(itemNumber=marker, loadVector=[1.0, 2.0, 3.0])
        found = s.found()
        assert len(found) == expected
        assert all("no lever for tilts" in sentence for sentence in found)


def test_run_check_counts_them_and_a_warning_names_them():
    s = Scene("z along x")
    marker = s.mbs.AddMarker(
        MarkerNodeCoordinate(nodeNumber=s.node, coordinate=s.body.locks.tilts[0])
    )
    s.mbs.AddLoad(LoadCoordinate(markerNumber=marker, load=1.0))
    s.mbs.Assemble()
    with pytest.warns(UserWarning, match=r"load 'load0': .* does not tilt .* has no effect"):
        s.body.check_connections()
    row = check_run(s.body, warn=False)["connections"]
    assert row.value == 1
    assert not row.ok


@pytest.mark.parametrize("spin", ["free", 5.0])
def test_weight_of_a_pendulum_is_no_lost_load(spin):
    """Its centre of mass is far off the axis, so that its weight acts on modes and spin together.

    All equations are linear here but for 1e-5 of deflection; Newton's method stops at 1e-7.
    """
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, hanging(), translation="none", spin=spin)
    mass = mbs.AddMarker(MarkerBodyMass(bodyNumber=body.objects["marker_body"]))
    mbs.AddLoad(Gravity(markerNumber=mass, loadVector=[3.0, -9.0, 2.0]))
    bolt = body.add_marker("left", [-0.3, 0.0, 0.1])
    base = mbs.AddMarker(MarkerBodyRigid(bodyNumber=mbs.CreateGround()))
    mbs.AddObject(GenericJoint(markerNumbers=[base, bolt], constrainedAxes=[1, 1, 1, 1, 1, 0]))
    assert unresisted(mbs, body) < 1e-5


def test_torque_on_a_rotor_of_dynamic_unbalance_is_no_lost_load():
    """It turns about its axis, across which its angular momentum has a share of 0.08.

    Nothing holds it, and the torque has a share across the axis by the tilt, 4e-5 at the end.
    """
    mbs = exu.SystemContainer().AddSystem()
    tilt = Rotation.from_euler("y", 20, degrees=True).as_matrix()
    body = add_rotor(mbs, rings(tilt, np.zeros(3), "z"))
    mbs.CreateTorque(itemNumber=body.marker("left"), loadVector=[0.0, 0.0, 0.1])
    assert unresisted(mbs, body) < 1e-4


def unresisted(mbs, body):
    """Run the scene for a short time, and return the check's share of lost loads."""
    body.start_recording()
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 60, 0.06
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 1e-3
    mbs.SolveDynamic(settings)
    return check_run(body, warn=False)["unresisted load"].value


def test_own_locks_are_none_of_them():
    for options in (
        {"spin": 10.0},
        {"spin": 10.0, "locking": "constraints"},
        {"marker_body": False},
    ):
        mbs = exu.SystemContainer().AddSystem()
        body = add_rotor(mbs, rotor("z"), translation="none", **options)
        mbs.Assemble()
        assert body.check_connections() == ()


@pytest.mark.filterwarnings("default::exudyn_rotor.ConnectionWarning")
def test_assembly_warns_of_each_item_once_and_of_this_rotor_alone():
    s = Scene()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        s.mbs.Assemble()
    s.mbs.AddObject(springs(s, 0.0, 0.0, 10.0))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        s.mbs.Assemble()
    lost = s.mbs.AddLoad(LoadCoordinate(markerNumber=tilt_of(s), load=1.0))
    with pytest.warns(ConnectionWarning, match=s.mbs.GetLoad(lost)["name"]):
        s.mbs.Assemble()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        s.mbs.Assemble()
        s.mbs.Reset()
        add_rotor(s.mbs, rotor("z"))
        s.mbs.Assemble()
        # another body in the place of the rotor, with a load that it can carry
        s.mbs.Reset()
        inertia = InertiaCuboid(density=1e3, sideLengths=[0.1, 0.1, 0.1])
        s.mbs.CreateRigidBody(inertia=inertia, nodeType=exu.NodeType.RotationRxyz)
        s.mbs.AddLoad(LoadCoordinate(markerNumber=tilt_of(s), load=1.0))
        s.mbs.Assemble()


def tilt_of(s):
    return s.mbs.AddMarker(
        MarkerNodeCoordinate(nodeNumber=s.node, coordinate=s.body.locks.tilts[0])
    )
