"""The marker body: a massless ``ObjectFFRFreducedOrder`` that gives markers, sensors, pictures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

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

from exudyn_rotor.multibody.rotor.frame import BodyFrame
from exudyn_rotor.multibody.rotor.plan import MarkerRequest, Setup, marker_name
from exudyn_rotor.reduction.fields import ModeShapes, ReducedInterface
from exudyn_rotor.theory.axis import SpinAxis


@dataclass(frozen=True, eq=False)
class MarkerBodyMesh:
    """Nodes of the marker body: mesh nodes first, then four virtual nodes per interface.

    The virtual nodes move as the interface's mean rigid motion says, so a marker on them is exact
    and its cost does not depend on the mesh: three around the reference point for rigid markers,
    and the point itself for position markers.

    Attributes
    ----------
    positions : ndarray, shape (N, 3)
        Axes of the marker body, from the frame origin [m].
    modes : ndarray, shape (3N, m)
        Displacement columns, axes of the marker body.
    triangles : ndarray of int
    stress : ndarray, shape (N, 6 m) or (0, 0)
        Stress columns in Exudyn's layout, mesh axes [Pa].
    rigid_nodes, point_nodes : dict of str to list of int
        Nodes of every interface's rigid and position marker.
    mesh_node_count : int
        Number of leading nodes that are mesh nodes.
    """

    positions: np.ndarray
    modes: np.ndarray
    triangles: np.ndarray
    stress: np.ndarray
    rigid_nodes: dict[str, list[int]]
    point_nodes: dict[str, list[int]]
    mesh_node_count: int


def marker_body_mesh(
    shapes: ModeShapes | None,
    interfaces: Mapping[str, ReducedInterface],
    T: np.ndarray,
    axis: SpinAxis,
    frame: BodyFrame,
    offsets: Mapping[str, np.ndarray],
) -> MarkerBodyMesh:
    """Return the nodes of the marker body for one formulation, whose basis is T (k, m).

    `offsets` shift an interface's virtual nodes [m, mesh axes]. A marker's own offset is of no use
    here: in Exudyn a force at it exerts no moment on modal coordinates.
    """
    positions, modes = [np.zeros((0, 3))], [np.zeros((0, T.shape[1]))]
    triangles, stress = np.zeros((0, 3), dtype=int), np.zeros((0, 0))
    if shapes is not None:
        positions.append(shapes.nodes)
        modes.append(shapes.matrix @ T)
        triangles = shapes.triangles
    mesh_count = count = sum(map(len, positions))
    rigid_nodes, point_nodes = {}, {}
    for name, interface in interfaces.items():
        motion = interface.motion @ T
        offset = offsets.get(name, np.zeros(3))
        motion[:3] += np.cross(motion[3:], offset, axisa=0, axisc=0)
        points, columns = virtual_nodes(
            interface.reference + offset, interface.radius, motion, axis
        )
        positions += [points, interface.reference[None, :] + offset]
        modes += [columns, motion[:3]]
        rigid_nodes[name], point_nodes[name] = [count, count + 1, count + 2], [count + 3]
        count += 4
    if shapes is not None and shapes.stress is not None:
        stress = stress_columns(shapes.stress @ T, count)
    return MarkerBodyMesh(
        positions=frame.points(np.vstack(positions)),
        modes=frame.columns(np.vstack(modes)),
        triangles=triangles,
        stress=stress,
        rigid_nodes=rigid_nodes,
        point_nodes=point_nodes,
        mesh_node_count=mesh_count,
    )


def virtual_nodes(
    reference: np.ndarray, radius: float, motion: np.ndarray, axis: SpinAxis
) -> tuple[np.ndarray, np.ndarray]:
    """Return three nodes (3, 3) that move as a rigid interface, and their columns (9, m).

    `motion` (6, m) holds displacement and rotation of the point `reference`, all in mesh axes.
    """
    radius = radius or 1.0  # a single node has no rotation, so any radius serves
    angles = 2.0 * np.pi / 3.0 * np.arange(3)
    arms = radius * np.column_stack([np.cos(angles), np.sin(angles)]) @ axis.plane.T
    columns = [motion[:3] + np.cross(motion[3:], arm, axisa=0, axisc=0) for arm in arms]
    return reference + arms, np.vstack(columns)


def append_nodes(
    mbs: exudyn.MainSystem,
    marker_body: exudyn.ObjectIndex | int,
    positions: np.ndarray,
    columns: np.ndarray,
) -> list[int]:
    """Add virtual nodes (k, 3) with mode columns (3k, m), without stress; return their numbers."""
    item = mbs.GetObject(marker_body)
    before = np.asarray(item["referencePositions"])
    mbs.SetObjectParameter(marker_body, "referencePositions", np.r_[before, positions.ravel()])
    mbs.SetObjectParameter(marker_body, "modeBasis", np.vstack([item["modeBasis"], columns]))
    stress = np.asarray(item["outputVariableModeBasis"])
    if stress.size:
        zero = np.zeros((len(positions), stress.shape[1]))
        mbs.SetObjectParameter(marker_body, "outputVariableModeBasis", np.vstack([stress, zero]))
    first = len(before) // 3
    return list(range(first, first + len(positions)))


def around(nodes: list[int]) -> list[int]:
    """Return the three nodes of an interface from those of its marker; a point comes after them."""
    return nodes if len(nodes) == 3 else [nodes[0] - 3, nodes[0] - 2, nodes[0] - 1]


def stress_columns(stress: np.ndarray, node_count: int) -> np.ndarray:
    """Return (n, 6, m) stress as Exudyn's (N, 6 m), zero at virtual nodes."""
    full = np.zeros((node_count, 6 * stress.shape[2]))
    full[: len(stress)] = stress.transpose(0, 2, 1).reshape(len(stress), -1)
    return full


def marker_body_object(
    name: str,
    nodes: list,
    mesh: MarkerBodyMesh,
    mass: float,
    center: np.ndarray,
    S: np.ndarray,
    frame: BodyFrame,
    color: Sequence[float],
) -> ObjectFFRFreducedOrder:
    """Return the marker body without inertia or stiffness of its own.

    Mass, centre of mass (mesh coordinates) and ``S = ΦᵀMΨ`` (3, m) are given for gravity by
    ``MarkerBodyMass`` alone.
    """
    size = S.shape[1]
    empty = exudyn.MatrixContainer()
    empty.SetWithDenseMatrix(np.zeros((size, size)), useDenseMatrix=False)
    stress = {}
    if mesh.stress.size:
        stress = {
            "outputVariableModeBasis": mesh.stress,
            "outputVariableTypeModeBasis": exudyn.OutputVariableType.StressLocal,
        }
    return ObjectFFRFreducedOrder(
        name=name,
        nodeNumbers=nodes,
        massMatrixReduced=empty,
        stiffnessMatrixReduced=empty,
        computeFFRFterms=False,
        modeBasis=mesh.modes,
        referencePositions=mesh.positions.ravel(),
        mass=mass,
        centerOfMass=frame.points(center),
        mPhitTPsi=frame.B @ S,
        **stress,
        visualization=VObjectFFRFreducedOrder(
            triangleMesh=mesh.triangles.tolist(), color=color, showNodes=False
        ),
    )


def add_weight(
    mbs: exudyn.MainSystem, marker_body: exudyn.ObjectIndex, gravity: np.ndarray
) -> exudyn.LoadIndex | None:
    """Add gravity (3,) [m/s²] on the marker body; None without any."""
    if not np.any(gravity):
        return None
    marker = mbs.AddMarker(MarkerBodyMass(bodyNumber=marker_body))
    return mbs.AddLoad(LoadMassProportional(markerNumber=marker, loadVector=gravity))


def interface_markers(
    mbs: exudyn.MainSystem,
    setup: Setup,
    marker_body: exudyn.ObjectIndex,
    mesh: MarkerBodyMesh,
    frame: BodyFrame,
) -> dict[str, exudyn.MarkerIndex]:
    """Add one marker per interface; rigid markers have the mesh axes as their frame."""
    return {
        interface: add_interface_marker(
            mbs, marker_name(setup.name, interface), interface, request, marker_body, mesh, frame
        )
        for interface, request in setup.markers.items()
    }


def add_interface_marker(
    mbs: exudyn.MainSystem,
    name: str,
    interface: str,
    request: MarkerRequest,
    marker_body: exudyn.ObjectIndex,
    mesh: MarkerBodyMesh,
    frame: BodyFrame,
) -> exudyn.MarkerIndex:
    """Add the marker of one interface; a rigid one has the mesh axes as its frame."""
    common = {
        "name": name,
        "bodyNumber": marker_body,
        "visualization": {"show": request.show, "showMarkerNodes": False},
    }
    if request.kind == "position":
        item = MarkerSuperElementPosition(
            meshNodeNumbers=mesh.point_nodes[interface], weightingFactors=[1.0], **common
        )
        return mbs.AddMarker(item)
    turn = np.eye(4)
    turn[:3, :3] = frame.B
    item = MarkerSuperElementRigid(
        meshNodeNumbers=mesh.rigid_nodes[interface],
        weightingFactors=[1.0 / 3.0] * 3,
        localHT=turn,
        **common,
    )
    return mbs.AddMarker(item)
