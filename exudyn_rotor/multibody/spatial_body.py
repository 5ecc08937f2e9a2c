"""A solid rotor as Exudyn's own full 3D body, for runs side by side with the fixed-axis bodies.

``ObjectFFRF`` with Euler parameters holds every nodal displacement; six mean-axis (Tisserand)
conditions keep the rigid motions, which the frame describes, out of them:

    ΦᵀM c_f = 0,   x̃ᵀM c_f = 0

Zwölfer, Rasmussen, Santos, SSRN 4830498, Sect. 2.1 and :mod:`exudyn_rotor.theory.spatial`, whose
mass matrix and forces are those of the body to round-off.
"""

from __future__ import annotations

from collections.abc import Mapping
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
from exudyn.utilities import (
    AngularVelocity2EulerParameters_t,
    RotationMatrix2EulerParameters,
)
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.rotor.plan import item_name, main_system, marker_name
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.nodal import tilde, translations

LARGEST = 300  # nodes


@dataclass(frozen=True, eq=False)
class SpatialBody:
    """Exudyn's full 3D body of a rotor; :func:`add_spatial_rotor` makes it.

    Attributes
    ----------
    mbs : exudyn.MainSystem
    body : ObjectIndex
        The ``ObjectFFRF``.
    frame : NodeIndex
        The node of the frame, in the centre of mass.
    markers : mapping of str
        Position marker of every interface, at the weighted centre of its nodes; Exudyn has no
        rigid ones on this body.
    constraint : ObjectIndex
        The six mean-axis conditions.
    """

    mbs: exudyn.MainSystem
    body: exudyn.ObjectIndex
    frame: exudyn.NodeIndex
    markers: Mapping[str, exudyn.MarkerIndex]
    constraint: exudyn.ObjectIndex

    def marker(self, interface: str) -> exudyn.MarkerIndex:
        """Return the marker of an interface."""
        return self.markers[checks.choice(interface, "interface", tuple(self.markers))]

    def add_node_sensor(
        self, node: int, output: exudyn.OutputVariableType, **options
    ) -> exudyn.SensorIndex:
        """Add a sensor at a mesh node, stored internally by default."""
        return self.mbs.AddSensor(
            SensorSuperElement(
                bodyNumber=self.body,
                meshNodeNumber=checks.count(node, "node"),
                outputVariableType=checks.instance(output, "output", exudyn.OutputVariableType),
                **{"storeInternal": True, "writeToFile": False, **options},
            )
        )

    def add_interface_sensor(
        self, interface: str, output: exudyn.OutputVariableType, **options
    ) -> exudyn.SensorIndex:
        """Add a sensor at an interface, stored internally by default."""
        return self.mbs.AddSensor(
            SensorMarker(
                markerNumber=self.marker(interface),
                outputVariableType=checks.instance(output, "output", exudyn.OutputVariableType),
                **{"storeInternal": True, "writeToFile": False, **options},
            )
        )


def add_spatial_rotor(
    mbs: exudyn.MainSystem,
    rotor: SolidRotor,
    *,
    name: str | None = "rotor",
    position: ArrayLike = (0.0, 0.0, 0.0),
    rotation: ArrayLike | None = None,
    initial_velocity: ArrayLike = (0.0, 0.0, 0.0),
    initial_angular_velocity: ArrayLike = (0.0, 0.0, 0.0),
    gravity: ArrayLike = (0.0, 0.0, 0.0),
) -> SpatialBody:
    """Add a rotor as Exudyn's full 3D body with Euler parameters and mean-axis conditions.

    Exudyn computes its nonlinear terms densely, and their derivatives by differences of all
    coordinates: the time of a step grows with the square of the nodes, that of the start with
    their cube. On one slow core a start took 0.3 s and a step 0.05 s with 85 nodes, 2.8 s and
    0.15 s with 257; with 912 nodes it had not started after 250 s. Rotors of more than 300 nodes
    are refused.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    rotor : SolidRotor
        Damping of its material acts as in the other bodies. The body has no centrifugal
        stiffening beyond what rigid tilts have.
    name : str or None
    position : array_like, shape (3,)
        Place of the mesh origin, inertial axes [m].
    rotation : array_like, shape (3, 3), optional
        Mesh axes → inertial axes at the start.
    initial_velocity : array_like, shape (3,)
        Of the centre of mass, inertial axes [m/s].
    initial_angular_velocity : array_like, shape (3,)
        Inertial axes [rad/s]; along the mounted spin axis for a start without tilts.
    gravity : array_like, shape (3,)
        Inertial axes [m/s²].

    Returns
    -------
    SpatialBody

    Raises
    ------
    TypeError, ValueError
        For bad input, or a mesh that is too large; nothing has been added then.

    Notes
    -----
    Use ``LinearSolverType.EigenSparse`` and a modified Newton method; a spectral radius below one
    keeps the multiplier of the Euler parameters from swinging up.

    Examples
    --------
    >>> import exudyn
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor
    >>> from exudyn_rotor.multibody.spatial_body import add_spatial_rotor
    >>> ends = [[0, 0, -1], [0, 0, 1], [0.5, 0, 0]]
    >>> rotor = SolidRotor.from_matrices(
    ...     np.eye(9), 0.0 * np.eye(9), ends, "z", interfaces={"top": [1]}, allow_parts=True
    ... )
    >>> mbs = exudyn.SystemContainer().AddSystem()
    >>> body = add_spatial_rotor(mbs, rotor, initial_angular_velocity=[0, 0, 10])
    >>> sorted(body.markers)
    ['top']
    """
    main_system(mbs)
    checks.instance(rotor, "rotor", SolidRotor)
    if rotor.node_count > LARGEST:
        raise ValueError(
            f"rotor: has {rotor.node_count} nodes, and Exudyn's full 3D body cannot carry more "
            f"than {LARGEST}; use a coarser mesh or order=1 for a comparison, or add_rotor"
        )
    name = None if name is None else checks.label(name, "name")
    place = checks.vector(position, "position", "m")
    turn = np.eye(3) if rotation is None else checks.rotation(rotation)
    velocity = checks.vector(initial_velocity, "initial_velocity", "m/s")
    omega = checks.vector(initial_angular_velocity, "initial_angular_velocity", "rad/s")
    gravity = checks.vector(gravity, "gravity", "m/s²")

    local = rotor.nodes - rotor.center_of_mass
    parameters = np.array(RotationMatrix2EulerParameters(turn))
    frame = mbs.AddNode(
        NodeRigidBodyEP(
            name=item_name("NodeRigidBody:", name),
            referenceCoordinates=[*(place + turn @ rotor.center_of_mass), *parameters],
            initialVelocities=[*velocity, *AngularVelocity2EulerParameters_t(omega, parameters)],
        )
    )
    points = [mbs.AddNode(NodePoint(referenceCoordinates=node)) for node in local]
    damping = {} if rotor.damping is None else {"dampingMatrixFF": _container(rotor.damping)}
    body = mbs.AddObject(
        ObjectFFRF(
            name=item_name("", name),
            nodeNumbers=[frame, *points],
            massMatrixFF=_container(rotor.mass),
            stiffnessMatrixFF=_container(rotor.stiffness),
            **damping,
        )
    )
    constraint = mbs.AddObject(_mean_axis_conditions(mbs, body, rotor, local))
    if np.any(gravity):
        # LoadMassProportional reads memory that this body does not set; the conditions balance
        # the weight's part on the displacements, so that it changes their multipliers alone
        center = mbs.AddMarker(MarkerNodePosition(nodeNumber=frame))
        mbs.AddLoad(Force(markerNumber=center, loadVector=rotor.total_mass * gravity))
    markers = {
        key: mbs.AddMarker(
            MarkerSuperElementPosition(
                name=marker_name(name, key),
                bodyNumber=body,
                meshNodeNumbers=interface.nodes,
                weightingFactors=interface.weights,
            )
        )
        for key, interface in rotor.interfaces.items()
    }
    return SpatialBody(mbs, body, frame, checks.read_only_mapping(markers), constraint)


def _mean_axis_conditions(
    mbs: exudyn.MainSystem, body: exudyn.ObjectIndex, rotor: SolidRotor, local: np.ndarray
) -> CoordinateVectorConstraint:
    """Return the six conditions, each row of unit length."""
    motions = np.hstack([translations(len(local)), tilde(local)])
    rows = (rotor.mass @ motions).T
    lengths = np.linalg.norm(rows, axis=1, keepdims=True)
    rows = np.hstack([np.zeros((6, 7)), rows / np.where(lengths, lengths, 1.0)])
    ground = mbs.AddMarker(MarkerNodeCoordinates(nodeNumber=mbs.AddNode(NodePointGround())))
    coordinates = mbs.AddMarker(MarkerObjectODE2Coordinates(objectNumber=body))
    return CoordinateVectorConstraint(
        markerNumbers=[ground, coordinates], scalingMarker1=rows, offset=np.zeros(6)
    )


def _container(matrix: sp.csr_array) -> exudyn.MatrixContainer:
    container = exudyn.MatrixContainer()
    container.SetWithSparseMatrix(sp.csr_matrix(matrix), useDenseMatrix=False)
    return container
