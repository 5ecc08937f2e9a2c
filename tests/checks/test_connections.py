"""What a rotor cannot carry is found, for any axis; nothing else is."""

import re
from functools import cache

import exudyn as exu
import exudyn.utilities as eu
import numpy as np
import pytest
from point_rotors import free_stiffness
from scipy.spatial.transform import Rotation

from exudyn_rotor import SolidRotor, add_rotor, check_run

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


@cache
def rotor(mount):
    """Return two rings of point masses, their axis z turned into the mesh; made once."""
    mesh = MOUNTED[mount][0]
    return rings(mesh, np.zeros(3), mesh[:, 2]).reduce(2)


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
    )


class Scene:
    """A rotor in an mbs, and directions: n along its spin axis, a and b across it."""

    def __init__(self, mount="z", source=None, **options):
        mesh, space = MOUNTED[mount]
        self.mbs = exu.SystemContainer().AddSystem()
        self.body = add_rotor(self.mbs, source or rotor(mount), rotation=space, **options)
        self.node, self.flexible = self.body.nodes["rigid"], self.body.objects["marker_body"]
        self.a, self.b, self.n = (space @ mesh).T
        self.rigid = self.mbs.AddMarker(eu.MarkerNodeRigid(nodeNumber=self.node))
        axes = np.column_stack([self.a, self.b, self.n])
        ground = self.mbs.CreateGround(referenceRotationMatrix=axes)
        # a marker at rest whose z axis is the spin axis
        self.base = self.mbs.AddMarker(eu.MarkerBodyRigid(bodyNumber=ground))
        turned = exu.HT(rotation=TO_X, translation=np.zeros(3))
        self.across = self.mbs.AddMarker(eu.MarkerBodyRigid(bodyNumber=ground, localHT=turned))

    def pair(self, **options):
        return {"markerNumbers": [self.base, self.rigid], **options}

    def found(self):
        self.mbs.Assemble()
        return self.body.check_connections(warn=False)


def springs(s, *rotations):
    return eu.RigidBodySpringDamper(
        **s.pair(stiffness=np.diag([1e3, 1e3, 1e3, *rotations]), damping=np.zeros((6, 6)))
    )


def dampers(s, *rotations):
    damping = np.diag([0.0, 0.0, 0.0, *rotations])
    return eu.RigidBodySpringDamper(**s.pair(stiffness=np.zeros((6, 6)), damping=damping))


def load(kind, vector, **options):
    return lambda s: s.mbs.AddLoad(kind(markerNumber=s.rigid, loadVector=vector(s), **options))


def on_node(kind, **options):
    return lambda s: s.mbs.AddLoad(
        eu.LoadCoordinate(
            markerNumber=s.mbs.AddMarker(kind(nodeNumber=s.node, **options)), load=1.0
        )
    )


def force(kind, **options):
    return lambda s: s.mbs.AddLoad(
        eu.Force(markerNumber=s.mbs.AddMarker(kind(s, **options)), loadVector=[1.0, 2.0, 3.0])
    )


def held_tilt(s):
    """Hold a tilt of the frame's node by a constraint of several coordinates."""
    markers = [s.mbs.AddMarker(eu.MarkerNodeCoordinates(nodeNumber=s.node)) for _ in range(2)]
    rows = np.eye(1, len(s.mbs.GetNode(s.node)["referenceCoordinates"]), s.body.locks.tilts[0])
    return eu.ObjectConnectorCoordinateVector(
        markerNumbers=markers, scalingMarker0=rows, scalingMarker1=0.0 * rows, offset=[0.0]
    )


def obj(make):
    return lambda s: s.mbs.AddObject(make(s))


CARRIED = {
    "torque about the axis": load(eu.Torque, lambda s: (50.0 * s.n).tolist()),
    "force": load(eu.Force, lambda s: [10.0, 20.0, 30.0]),
    "spring of forces": obj(lambda s: eu.CartesianSpringDamper(**s.pair(stiffness=[1e3] * 3))),
    "spring about the axis": obj(lambda s: springs(s, 0.0, 0.0, 100.0)),
    "ball joint": obj(lambda s: eu.SphericalJoint(**s.pair())),
    "joint about the axis": obj(
        lambda s: eu.GenericJoint(**s.pair(constrainedAxes=[1, 1, 1, 0, 0, 1]))
    ),
    "torque across": load(eu.Torque, lambda s: (50.0 * s.a + 20.0 * s.n).tolist()),
    "tilt spring": obj(lambda s: springs(s, 100.0, 0.0, 0.0)),
    "hinge": obj(lambda s: eu.RevoluteJointZ(**s.pair())),
    "damper about the axis": obj(lambda s: dampers(s, 0.0, 0.0, 1.0)),
    "torsional spring": obj(lambda s: eu.TorsionalSpringDamper(**s.pair(stiffness=10.0))),
    "inactive joint": obj(lambda s: eu.GenericJoint(**s.pair(activeConnector=False))),
    "position": force(lambda s: eu.MarkerNodePosition(nodeNumber=s.node)),
    "weight of the script": lambda s: s.mbs.AddLoad(
        eu.Gravity(
            markerNumber=s.mbs.AddMarker(eu.MarkerBodyMass(bodyNumber=s.flexible)),
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


def test_run_check_counts_them_and_a_warning_names_them():
    s = Scene("z along x")
    marker = s.mbs.AddMarker(
        eu.MarkerNodeCoordinate(nodeNumber=s.node, coordinate=s.body.locks.tilts[0])
    )
    s.mbs.AddLoad(eu.LoadCoordinate(markerNumber=marker, load=1.0))
    s.mbs.Assemble()
    with pytest.warns(UserWarning, match=r"load 'load0': .* does not tilt .* has no effect"):
        s.body.check_connections()
    row = check_run(s.body, warn=False)["connections"]
    assert row.value == 1
    assert not row.ok


def offset_marker(s):
    options = {"offset": [0.1, 0.0, 0.0], "useAlternativeApproach": False}
    nodes = {"meshNodeNumbers": list(range(5)), "weightingFactors": 5 * [0.2]}
    return eu.MarkerSuperElementRigid(bodyNumber=s.flexible, **nodes, **options)


def spin_sensor(s):
    rates = exu.OutputVariableType.AngularVelocityLocal
    return s.mbs.AddSensor(eu.SensorNode(nodeNumber=s.node, outputVariableType=rates, name="rates"))


BESIDE = rings(np.eye(3), np.array([0.1, 0.0, 0.0]), [0.0, 0.0, 1.0])
LOST = {
    "rotation": (on_node(eu.MarkerNodeRotationCoordinate, rotationCoordinate=0), None, "not tilt"),
    "constraint": (obj(held_tilt), None, "does not tilt .* on its coordinate 3 has no effect"),
    "offset": (force(offset_marker), None, "at a marker's own offset has no lever for tilts"),
    "sensor": (spin_sensor, None, "sensor 'rates': AngularVelocityLocal .* without tilts; take"),
    "beside": (
        on_node(eu.MarkerNodeCoordinate, coordinate=0),
        BESIDE.reduce(2),
        "0.1 m off the node",
    ),
    "full": (force(lambda s: eu.MarkerNodeRigid(nodeNumber=s.node)), BESIDE, "full body does not"),
}


@pytest.mark.parametrize("case", LOST)
def test_what_is_lost_is_told_with_what_to_do(case):
    attach, source, message = LOST[case]
    s = Scene(source=source)
    on_node(eu.MarkerNodeRotationCoordinate, rotationCoordinate=2)(s)  # about the axis is carried
    attach(s)
    (found,) = s.found()
    assert re.search(message, found), found
