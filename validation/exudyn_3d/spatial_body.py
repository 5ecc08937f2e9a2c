"""A solid rotor as Exudyn's own full 3D body, for runs side by side with the fixed-axis bodies.

``ObjectFFRF`` with Euler parameters holds every nodal displacement; six mean-axis (Tisserand)
conditions keep the rigid motions, which the frame describes, out of them:

    ΦᵀM c_f = 0,   x̃ᵀM c_f = 0

Zwölfer, Rasmussen, Santos, SSRN 4830498, Sect. 2.1 and
``tests/theory/spatial_frame.py``, whose mass matrix and forces are those of the body to
round-off. Exudyn computes its nonlinear terms densely, and their derivatives by differences of all
coordinates: 0.15 s a step with 257 nodes.
"""

from __future__ import annotations

from dataclasses import dataclass

import exudyn
import numpy as np
import scipy.sparse as sp
from exudyn.itemInterface import (
    CoordinateVectorConstraint,
    Force,
    MarkerNodeCoordinates,
    MarkerNodePosition,
    MarkerObjectODE2Coordinates,
    MarkerSuperElementPosition,
    NodePoint,
    NodePointGround,
    NodeRigidBodyEP,
    ObjectFFRF,
    SensorMarker,
    SensorSuperElement,
)
from exudyn.utilities import AngularVelocity2EulerParameters_t

from exudyn_rotor import SolidRotor
from exudyn_rotor.theory.axis import rotations, translations

STORED = {"storeInternal": True, "writeToFile": False}


@dataclass(frozen=True, eq=False)
class SpatialBody:
    """The ``ObjectFFRF``, the node of its frame in the centre of mass, and position markers."""

    mbs: exudyn.MainSystem
    body: exudyn.ObjectIndex
    frame: exudyn.NodeIndex
    markers: dict[str, exudyn.MarkerIndex]

    def add_node_sensor(self, node: int, output: exudyn.OutputVariableType) -> exudyn.SensorIndex:
        """Add a sensor at a mesh node."""
        item = SensorSuperElement(
            bodyNumber=self.body, meshNodeNumber=node, outputVariableType=output, **STORED
        )
        return self.mbs.AddSensor(item)

    def add_interface_sensor(
        self, interface: str, output: exudyn.OutputVariableType
    ) -> exudyn.SensorIndex:
        """Add a sensor at an interface."""
        marker = self.markers[interface]
        item = SensorMarker(markerNumber=marker, outputVariableType=output, **STORED)
        return self.mbs.AddSensor(item)


def add_spatial_rotor(
    mbs: exudyn.MainSystem,
    rotor: SolidRotor,
    *,
    velocity: np.ndarray = (0.0, 0.0, 0.0),
    angular_velocity: np.ndarray = (0.0, 0.0, 0.0),
    gravity: np.ndarray = (0.0, 0.0, 0.0),
) -> SpatialBody:
    """Add a rotor with the `velocity` of its centre of mass [m/s], in the place of its mesh.

    Use ``LinearSolverType.EigenSparse`` and a modified Newton method; a spectral radius below one
    keeps the multiplier of the Euler parameters from swinging up.
    """
    local, parameters = rotor.nodes - rotor.center_of_mass, [1.0, 0.0, 0.0, 0.0]
    turning = AngularVelocity2EulerParameters_t(angular_velocity, parameters)
    frame = mbs.AddNode(
        NodeRigidBodyEP(
            referenceCoordinates=[*rotor.center_of_mass, *parameters],
            initialVelocities=[*velocity, *turning],
        )
    )
    points = [mbs.AddNode(NodePoint(referenceCoordinates=node)) for node in local]
    damping = {} if rotor.damping is None else {"dampingMatrixFF": _container(rotor.damping)}
    body = mbs.AddObject(
        ObjectFFRF(
            nodeNumbers=[frame, *points],
            massMatrixFF=_container(rotor.mass),
            stiffnessMatrixFF=_container(rotor.stiffness),
            **damping,
        )
    )
    motions = np.hstack([translations(len(local)), rotations(local, np.zeros(3))])
    rows = (rotor.mass @ motions).T
    lengths = np.linalg.norm(rows, axis=1, keepdims=True)
    rows = np.hstack([np.zeros((6, 7)), rows / np.where(lengths, lengths, 1.0)])
    ground = mbs.AddMarker(MarkerNodeCoordinates(nodeNumber=mbs.AddNode(NodePointGround())))
    coordinates = mbs.AddMarker(MarkerObjectODE2Coordinates(objectNumber=body))
    mbs.AddObject(
        CoordinateVectorConstraint(
            markerNumbers=[ground, coordinates], scalingMarker1=rows, offset=np.zeros(6)
        )
    )
    # LoadMassProportional reads memory that this body does not set; the conditions balance the
    # weight's part on the displacements, so that it changes their multipliers alone
    center = mbs.AddMarker(MarkerNodePosition(nodeNumber=frame))
    mbs.AddLoad(Force(markerNumber=center, loadVector=rotor.total_mass * np.asarray(gravity)))
    markers = {
        key: mbs.AddMarker(
            MarkerSuperElementPosition(
                bodyNumber=body,
                meshNodeNumbers=interface.nodes,
                weightingFactors=interface.weights,
            )
        )
        for key, interface in rotor.interfaces.items()
    }
    return SpatialBody(mbs, body, frame, markers)


def _container(matrix: sp.csr_array) -> exudyn.MatrixContainer:
    container = exudyn.MatrixContainer()
    container.SetWithSparseMatrix(sp.csr_matrix(matrix), useDenseMatrix=False)
    return container
