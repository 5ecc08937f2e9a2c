"""A linear foundation in a scene: native matrices on the coordinates of one node.

Its markers are those of a massless ``ObjectFFRFreducedOrder`` beside the equations, whose frame
constraints hold at the ground: three virtual nodes for every point move as its motion says.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import exudyn
import numpy as np
from exudyn.itemInterface import (
    NodePointGround,
    NodeRigidBodyRxyz,
    ObjectFFRFreducedOrder,
    ObjectGenericODE2,
    SensorMarker,
    VNodeRigidBodyRxyz,
    VObjectFFRFreducedOrder,
    VObjectGenericODE2,
)
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.multibody.rotor.plan import generic_node, held, main_system
from exudyn_rotor.multibody.rotor.rotor_items import Carrier, add_weight

_ARM = 0.1  # m, of the virtual nodes of a point; any does


@dataclass(frozen=True, eq=False, repr=False)
class SceneFoundation:
    """A foundation in a scene, from :func:`add_foundation`; a base for ``add_supports``.

    Attributes
    ----------
    mbs : exudyn.MainSystem
    foundation : Foundation
        In inertial axes.
    node : NodeIndex
        Of its coordinates.
    objects : mapping of str to ObjectIndex
        ``'physics'`` (the equations), ``'marker_body'`` (markers), and what holds its frame.
    gravity_load : LoadIndex or None

    Examples
    --------
    >>> import exudyn
    >>> from exudyn_rotor import Foundation, add_foundation
    >>> frame = Foundation.from_modes(
    ...     [300.0, 450.0], 0.02, {"left": [[0, 1], [1, 0], [0, 0]]},
    ...     places={"left": [0.0, 0.0, -0.1]}, masses=20.0,
    ... )
    >>> base = add_foundation(exudyn.SystemContainer().AddSystem(), frame)
    >>> base
    SceneFoundation(Foundation(2 coordinates, 47.75 to 71.62 Hz, points: left))
    >>> sensor = base.add_sensor("left")
    """

    mbs: exudyn.MainSystem
    foundation: Foundation
    node: exudyn.NodeIndex
    objects: Mapping[str, exudyn.ObjectIndex]
    gravity_load: exudyn.LoadIndex | None = None
    _markers: dict[str, exudyn.MarkerIndex] = field(default_factory=dict, init=False)

    def __repr__(self) -> str:
        """Return a short summary."""
        return f"SceneFoundation({self.foundation!r})"

    def marker(self, name: str) -> exudyn.MarkerIndex:
        """Return a rigid marker at a point whose place is known, axes x, y, z.

        Raises
        ------
        ValueError
            For an unknown point, and one without a place.
        """
        checks.choice(name, "name", self.foundation.points)
        if name not in self.foundation.places:
            raise ValueError(f"name: the place of the point {name!r} is not known; give places=…")
        if name not in self._markers:
            point = self._carrier(name, self.foundation.places[name])
            self._markers[name] = point.add_marker(self.mbs, "rigid", np.eye(3))
        return self._markers[name]

    def _carrier(self, name: str, place: np.ndarray) -> Carrier:
        """Return what moves with a point, at its place [m]."""
        return Carrier(self.objects["marker_body"], place, self.foundation.points[name], _ARM)

    def add_sensor(
        self, name: str, output: exudyn.OutputVariableType = exudyn.OutputVariableType.Displacement
    ) -> exudyn.SensorIndex:
        """Add a sensor at a point, which stores its values along x, y, z."""
        checks.instance(output, "output", exudyn.OutputVariableType)
        return self.mbs.AddSensor(
            SensorMarker(
                markerNumber=self.marker(name), outputVariableType=output, storeInternal=True
            )
        )


def add_foundation(
    mbs: exudyn.MainSystem,
    foundation: Foundation,
    *,
    position: ArrayLike = (0.0, 0.0, 0.0),
    rotation: ArrayLike | None = None,
    gravity: ArrayLike = (0.0, 0.0, 0.0),
) -> SceneFoundation:
    """Add a foundation to a scene, on which supports can stand: ``add_supports(…, base=…)``.

    Its equations are native matrices, so a step calls no Python. Its frame is held by constraints,
    which explicit solvers eliminate by default.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    foundation : Foundation
    position, rotation : array_like, optional
        Those of the rotor in :func:`add_rotor`: the foundation is described in its mesh axes.
    gravity : array_like, shape (3,), optional
        Inertial axes [m/s²]; it sags under it, by its participation.

    Raises
    ------
    TypeError, ValueError
        For bad input; nothing has been added then.

    Examples
    --------
    >>> import exudyn
    >>> from exudyn_rotor import Foundation, Mount, add_foundation
    >>> block = Foundation.rigid(50.0, [4.0, 5.0, 1.0], [0.0, -0.2, 0.0],
    ...     [Mount([x, -0.3, z], 1e6) for x in (-0.2, 0.2) for z in (-0.4, 0.4)],
    ...     {"left": [0.0, 0.0, -0.3], "right": [0.0, 0.0, 0.3]})
    >>> mbs = exudyn.SystemContainer().AddSystem()
    >>> add_foundation(mbs, block)
    SceneFoundation(Foundation(6 coordinates, 38.18 to 75.07 Hz, points: left, right))
    """
    main_system(mbs)
    checks.instance(foundation, "foundation", Foundation)
    place = checks.vector(position, "position", "m")
    turn = np.eye(3) if rotation is None else checks.rotation(rotation)
    g = checks.vector(gravity, "gravity", "m/s²")
    if np.any(g) and foundation.participation is None:
        raise ValueError("gravity: needs a foundation with its participation=…")
    placed = foundation.turned(turn, place)
    start = np.zeros(placed.size)
    coordinates = mbs.AddNode(generic_node(start, start))
    unseen, hidden = VNodeRigidBodyRxyz(show=False), VObjectGenericODE2(show=False)
    frame = mbs.AddNode(NodeRigidBodyRxyz(referenceCoordinates=np.zeros(6), visualization=unseen))
    physics = mbs.AddObject(
        ObjectGenericODE2(
            nodeNumbers=[coordinates],
            massMatrix=placed.mass,
            dampingMatrix=placed.damping,
            stiffnessMatrix=placed.stiffness,
            visualization=hidden,
        )
    )
    empty = exudyn.MatrixContainer()
    empty.SetWithDenseMatrix(np.zeros((placed.size, placed.size)), useDenseMatrix=False)
    none = np.zeros((3, placed.size))
    body = mbs.AddObject(
        ObjectFFRFreducedOrder(
            nodeNumbers=[frame, coordinates],
            massMatrixReduced=empty,
            stiffnessMatrixReduced=empty,
            computeFFRFterms=False,
            modeBasis=none,
            referencePositions=np.zeros(3),
            mPhitTPsi=none if placed.participation is None else placed.participation,  # of weight
            visualization=VObjectFFRFreducedOrder(show=False),
        )
    )
    # an inertia, which moves nothing: explicit solvers solve with the whole mass matrix
    inertia = mbs.AddObject(
        ObjectGenericODE2(nodeNumbers=[frame], massMatrix=np.eye(6), visualization=hidden)
    )
    ground = mbs.AddNode(NodePointGround())
    objects = {"physics": physics, "marker_body": body, "frame": inertia}
    objects |= {f"frame {index}": held(mbs, ground, frame, index) for index in range(6)}
    load = add_weight(mbs, body, g)
    return SceneFoundation(mbs, placed, coordinates, checks.read_only_mapping(objects), load)
