"""Markers of a rotor: nodes of a massless flexible body that move as a mean rigid motion says.

A marker on many mesh nodes costs Exudyn an evaluation of each. So every marker of the package is on
virtual nodes, which are added to a flexible body: one node for a position, three around it for a
rotation. They move as the mean rigid motion of an interface, of mesh nodes or of the whole rotor.
Offsets shift the nodes: in Exudyn, a force at a marker's own offset exerts no moment on modes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import exudyn
import numpy as np
from exudyn.itemInterface import (
    LoadMassProportional,
    MarkerBodyMass,
    MarkerSuperElementPosition,
    MarkerSuperElementRigid,
    ObjectFFRFreducedOrder,
    VObjectFFRFreducedOrder,
)
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.rotor.plan import Plan
from exudyn_rotor.reduction.fields import ModeShapes
from exudyn_rotor.solid.interface import Interface, rotation_moments

_FLAT = 1e-6  # smallest second moment of nodes over the largest for which they show a rotation


def flexible_body(
    plan: Plan,
    nodes: Sequence[exudyn.NodeIndex],
    S: np.ndarray,
    shapes: ModeShapes | None = None,
    name: str = "",
) -> ObjectFFRFreducedOrder:
    """Return a flexible body without inertia or stiffness: for markers, sensors and drawing.

    ``S = ΦᵀMΨ`` (3, m), with the rotor's mass and its centre, serves ``MarkerBodyMass`` alone.
    Without `shapes` it has no mesh, but one node that does not move.
    """
    size, inv, frame = S.shape[1], plan.motion.invariants, plan.frame
    empty = exudyn.MatrixContainer()
    empty.SetWithDenseMatrix(np.zeros((size, size)), useDenseMatrix=False)
    # Exudyn needs a node
    points, columns, triangles, stress = np.zeros((1, 3)), np.zeros((3, size)), [], {}
    if shapes is not None:
        T = plan.selection.T
        points, columns = frame.points(shapes.nodes), frame.columns(shapes.matrix @ T)
        triangles = shapes.triangles.tolist()
        if shapes.stress is not None:
            table = (shapes.stress @ T).transpose(0, 2, 1).reshape(len(points), -1)
            stress = {
                "outputVariableModeBasis": table,
                "outputVariableTypeModeBasis": exudyn.OutputVariableType.StressLocal,
            }
    return ObjectFFRFreducedOrder(
        name=name,
        nodeNumbers=list(nodes),
        massMatrixReduced=empty,
        stiffnessMatrixReduced=empty,
        computeFFRFterms=False,
        modeBasis=columns,
        referencePositions=points.ravel(),
        mass=inv.mass,
        centerOfMass=frame.points(plan.selection.origin + inv.center),
        mPhitTPsi=frame.B @ S,
        **stress,
        visualization=VObjectFFRFreducedOrder(
            triangleMesh=triangles, color=plan.setup.color, showNodes=False
        ),
    )


def add_weight(
    mbs: exudyn.MainSystem, body: exudyn.ObjectIndex, gravity: np.ndarray
) -> exudyn.LoadIndex | None:
    """Add gravity (3,) [m/s²] on a flexible body; None without any."""
    if not np.any(gravity):
        return None
    marker = mbs.AddMarker(MarkerBodyMass(bodyNumber=body))
    return mbs.AddLoad(LoadMassProportional(markerNumber=marker, loadVector=gravity))


@dataclass(frozen=True, eq=False)
class Carrier:
    """A point of a flexible body with a mean rigid motion, to which markers can be added.

    Attributes
    ----------
    body : ObjectIndex
        The flexible body.
    point : ndarray, shape (3,)
        Axes of the body [m].
    motion : ndarray, shape (6, m)
        Displacement and rotation of the point by its coordinates, axes of the body.
    radius : float
        Of the nodes that a rotation is read from [m].
    nodes : tuple of NodeIndex
        Of a rotor: that of the frame, and that of the body's coordinates.
    """

    body: exudyn.ObjectIndex
    point: np.ndarray
    motion: np.ndarray
    radius: float
    nodes: tuple[exudyn.NodeIndex, ...] = ()

    def shifted(self, arm: np.ndarray) -> Carrier:
        """Return the point at an arm (3,), axes of the body, that turns with the rotation."""
        motion = np.vstack([_at_arm(self.motion, arm), self.motion[3:]])
        return replace(self, point=self.point + arm, motion=motion)

    def virtual_nodes(self, kind: str) -> tuple[np.ndarray, np.ndarray]:
        """Return the nodes (k, 3) of a marker, and their columns (3k, m)."""
        if kind == "position":
            return self.point[None, :], self.motion[:3]
        return virtual_nodes(self.point, self.radius, self.motion)

    def add_marker(
        self,
        mbs: exudyn.MainSystem,
        kind: str,
        axes: np.ndarray | None = None,
        *,
        name: str = "",
        show: bool = False,
    ) -> exudyn.MarkerIndex:
        """Add a marker of a `kind`; `axes` (3, 3) are those of a rigid one in the body's."""
        nodes = append_nodes(mbs, self.body, *self.virtual_nodes(kind))
        common = {
            "name": name,
            "bodyNumber": self.body,
            "meshNodeNumbers": nodes,
            "weightingFactors": [1.0 / len(nodes)] * len(nodes),
            "visualization": {"show": show, "showMarkerNodes": False},
        }
        if kind == "position":
            return mbs.AddMarker(MarkerSuperElementPosition(**common))
        frame = np.eye(4)
        frame[:3, :3] = axes
        return mbs.AddMarker(MarkerSuperElementRigid(localHT=frame, **common))


def virtual_nodes(
    place: np.ndarray, radius: float, motion: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return three nodes (3, 3) around a place that move rigidly with it, and columns (9, m)."""
    angles = 2.0 * np.pi / 3.0 * np.arange(3)
    # any plane serves, and any radius of a single node, which has no rotation
    arms = (radius or 1.0) * np.column_stack([np.cos(angles), np.sin(angles), np.zeros(3)])
    return place + arms, np.vstack([_at_arm(motion, arm) for arm in arms])


def _at_arm(motion: np.ndarray, arm: np.ndarray) -> np.ndarray:
    """Return the displacements (3, m) at an arm (3,) from a point with the motion (6, m)."""
    return motion[:3] + np.cross(motion[3:], arm, axisa=0, axisc=0)


def append_nodes(
    mbs: exudyn.MainSystem, body: exudyn.ObjectIndex, positions: np.ndarray, columns: np.ndarray
) -> list[int]:
    """Add virtual nodes (k, 3) with mode columns (3k, m), without stress; return their numbers."""
    added = {"referencePositions": positions.ravel(), "modeBasis": columns}
    stress = np.asarray(mbs.GetObjectParameter(body, "outputVariableModeBasis"))
    if stress.size:
        added["outputVariableModeBasis"] = np.zeros((len(positions), stress.shape[1]))
    first = len(mbs.GetObjectParameter(body, "referencePositions")) // 3
    for name, rows in added.items():
        before = mbs.GetObjectParameter(body, name)
        mbs.SetObjectParameter(body, name, np.concatenate([before, rows]))
    return list(range(first, first + len(positions)))


def interface_of_nodes(
    positions: np.ndarray, where: Sequence[int], weights: ArrayLike | None, kind: str
) -> Interface:
    """Return mesh nodes among `positions` (n, 3) as an interface; rigid ones show a rotation."""
    described = "where: an interface, or mesh nodes"
    nodes = checks.whole_numbers(where, described, most=len(positions) - 1)
    if len(nodes) == 0 or len(set(nodes.tolist())) != len(nodes):
        raise ValueError(f"{described}: needs different nodes, got {checks.shown(where)}")
    interface = Interface("nodes", nodes, weights, positions[nodes])
    moments, _ = rotation_moments(interface.positions - interface.center, interface.weights)
    sizes = np.linalg.eigvalsh(moments)
    if kind == "rigid" and sizes[0] <= _FLAT * sizes[-1]:
        raise ValueError(
            f"where: the nodes {checks.shown(nodes.tolist())} lie on a line or in a point and show "
            "no rotation; give more nodes, an interface, or kind='position'"
        )
    return interface
