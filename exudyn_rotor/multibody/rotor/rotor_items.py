"""What stands for a rotor in an ``mbs``: plan, items, markers, and how it is known again.

Every marker of the package is on virtual nodes, which are added to a flexible body, since a marker
on many mesh nodes costs Exudyn an evaluation of each: one node for a position, three around it for
a rotation. They move as the mean rigid motion of an interface, of mesh nodes or of the whole rotor.
Offsets shift the nodes: in Exudyn, a force at a marker's own offset exerts no moment on modes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from typing import Any

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

from exudyn_rotor import checks
from exudyn_rotor.multibody import ENTRY
from exudyn_rotor.multibody.evaluation import STATES
from exudyn_rotor.multibody.rotor.plan import Plan, add_constraints, marker_name
from exudyn_rotor.reduction.reduced_rotor import ModeShapes
from exudyn_rotor.solid.rotor import Interface, rotation_moments
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.rotating_axes import axes_of

_KINDS = exudyn.OutputVariableType
RATES = (_KINDS.Coordinates, _KINDS.Coordinates_t, _KINDS.Coordinates_tt)
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
            triangleMesh=triangles, color=plan.color, showNodes=False
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
    """A point of a flexible body with a mean rigid motion, to which markers can be added."""

    body: exudyn.ObjectIndex  # the flexible body
    point: np.ndarray  # (3,) Axes of the body [m]
    motion: np.ndarray  # (6, m) Displacement and rotation by coordinates, axes of the body
    radius: float  # of the nodes that a rotation is read from [m]

    def shifted(self, arm: np.ndarray) -> Carrier:
        """Return the point at an arm (3,), axes of the body, that turns with the rotation."""
        motion = self.motion.copy()
        motion[:3] += np.cross(motion[3:], arm, axisa=0, axisc=0)
        return replace(self, point=self.point + arm, motion=motion)

    def virtual_nodes(self, kind: str) -> tuple[np.ndarray, np.ndarray]:
        """Return the nodes (k, 3) of a marker, and their columns (3k, m).

        Three nodes of a rigid one are around the place and move rigidly with it.
        """
        if kind == "position":
            return self.point[None, :], self.motion[:3]
        angles = 2.0 * np.pi / 3.0 * np.arange(3)
        # any plane serves, and any radius of a single node, which has no rotation
        arms = (self.radius or 1.0) * np.column_stack([np.cos(angles), np.sin(angles), np.zeros(3)])
        nodes = [self.shifted(arm) for arm in arms]
        return np.array([one.point for one in nodes]), np.vstack([one.motion[:3] for one in nodes])

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


def interface_of_nodes(positions: np.ndarray, where: Sequence[int], kind: str) -> Interface:
    """Return mesh nodes among `positions` (n, 3) as an interface; rigid ones show a rotation."""
    described = "where: an interface, or mesh nodes"
    nodes = checks.whole_numbers(where, described, most=len(positions) - 1)
    if len(nodes) == 0 or len(set(nodes.tolist())) != len(nodes):
        raise ValueError(f"{described}: needs different nodes, got {checks.shown(where)}")
    interface = Interface("nodes", nodes, None, positions[nodes])
    if kind == "rigid" and not shows_rotation(interface):
        raise ValueError(
            f"where: the nodes {checks.shown(nodes.tolist())} lie on a line or in a point and show "
            "no rotation; give more nodes, an interface, or kind='position'"
        )
    return interface


def shows_rotation(interface: Interface) -> bool:
    """Return whether the nodes of an interface do not lie on a line or in a point."""
    arms = interface.positions - interface.center
    sizes = np.linalg.eigvalsh(rotation_moments(arms, interface.weights)[0])
    return bool(sizes[0] > _FLAT * sizes[-1])


def nodes_of(mbs: exudyn.MainSystem, body: exudyn.ObjectIndex) -> np.ndarray:
    """Return the nodes (n, 3) of a flexible body, virtual ones too, in its axes [m]."""
    return np.reshape(mbs.GetObjectParameter(body, "referencePositions"), (-1, 3))


def carrier_of(mbs: exudyn.MainSystem, body: exudyn.ObjectIndex, interface: Interface) -> Carrier:
    """Return what moves with the mean motion of nodes of a flexible body."""
    columns = np.asarray(mbs.GetObjectParameter(body, "modeBasis"))
    motion = interface.mean_motion(len(columns) // 3) @ columns
    return Carrier(body, interface.reference, motion, interface.radius)


def marker_interface(mbs: exudyn.MainSystem, marker: dict) -> Interface:
    """Return the nodes of a super-element marker, axes of its body."""
    numbers = np.asarray(marker["meshNodeNumbers"])
    points = nodes_of(mbs, marker["bodyNumber"])[numbers]
    return Interface("marker", numbers, marker["weightingFactors"], points)


def marker_carrier(mbs: exudyn.MainSystem, marker: dict) -> Carrier:
    """Return what moves with the mean motion of the nodes of a super-element marker."""
    return carrier_of(mbs, marker["bodyNumber"], marker_interface(mbs, marker))


_ROTORS = "rotors"


def entry(mbs: exudyn.MainSystem) -> dict:
    """Return the package's own entry of ``mbs.sys``."""
    return mbs.sys.setdefault(ENTRY, {})


@dataclass(eq=False)
class ScriptMarkers:
    """What ``mbs.Assemble()`` has done with a script's own markers on a rotor."""

    # markers that carry tilts, by those of a script at the node
    carriers: dict[int, int] = field(default_factory=dict)
    turned: set[int] = field(default_factory=set)  # markers that have been given mesh axes
    told: set[str] = field(default_factory=set)  # warnings that have been given
    is_watched: bool = False  # by a sensor that sees the solver
    # (r, k − r) Motion of the frame of Exudyn's own body by the elastic columns of the reduced
    # rotor, in shares of its r rigid ones
    frame_shares: np.ndarray | None = None


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class RotorItems(Plan):
    """A rotor's items in an ``mbs``; attributes as of :class:`exudyn_rotor.RotorBody`."""

    mbs: exudyn.MainSystem
    nodes: Mapping[str, exudyn.NodeIndex]
    objects: Mapping[str, exudyn.ObjectIndex]
    constraints: Mapping[str, exudyn.ObjectIndex]
    gravity_load: exudyn.LoadIndex | None
    mesh_node_count: int = 0
    markers: dict = field(default_factory=dict, init=False)
    supports: list = field(default_factory=list, init=False)
    drives: list = field(default_factory=list, init=False)
    record_sensors: dict = field(default_factory=dict, init=False)
    script: ScriptMarkers = field(default_factory=ScriptMarkers, init=False)

    def __post_init__(self) -> None:
        known = copy(self)
        object.__setattr__(known, "mbs", None)
        entry(self.mbs).setdefault(_ROTORS, {})[int(self.nodes["rigid"])] = known

    @property
    def axis(self) -> SpinAxis:
        """Spin axis, mesh coordinates."""
        return self.selection.source.axis

    @property
    def standing_axes(self) -> np.ndarray:
        """(n1, n2, e) as columns (3, 3) in inertial axes, where the spin angle is zero."""
        return self.placement.rotation @ axes_of(self.axis)

    def coordinates(
        self, configuration: exudyn.ConfigurationType = exudyn.ConfigurationType.Current
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the unknowns q, q̇, q̈ of :attr:`motion` in a configuration, each (size,).

        Raises
        ------
        TypeError, ValueError
            For a configuration without coordinates, or a system that is not assembled.
        """
        checks.instance(configuration, "configuration", exudyn.ConfigurationType)
        if configuration not in STATES:
            known = ", ".join(kind.name for kind in STATES)
            raise ValueError(f"configuration: needs one of {known}, got {configuration.name}")
        self.check_assembled()
        nodes = self.nodes.values()
        return tuple(
            np.hstack([self.mbs.GetNodeOutput(node, kind, configuration) for node in nodes])[
                self.layout.unknowns
            ]
            for kind in RATES
        )

    def check_present(self) -> None:
        """Raise ValueError where the system no longer holds this rotor."""
        if not any(rotor.nodes is self.nodes for rotor in known_rotors(self.mbs)):
            raise ValueError(
                f"mbs: no longer holds rotor {self.name!r} under its numbers: the system was "
                "reset, or objects were deleted; use the RotorBody that adding the rotor returned "
                "last"
            )

    def check_assembled(self) -> None:
        """Raise ValueError where the system does not hold this rotor, or has no state yet."""
        self.check_present()
        if not self.mbs.systemIsConsistent:
            raise ValueError(
                f"mbs: the system of rotor {self.name!r} has no state; call mbs.Assemble() first"
            )

    def interface_carrier(self, interface: str) -> Carrier:
        """Return what moves with the mean motion of an interface, to which markers can be added."""
        known = self.selection.source.interfaces
        found = known[checks.choice(interface, "interface", tuple(known))]
        return Carrier(
            self.objects["marker_body"],
            self.frame.points(found.reference),
            self.frame.columns(found.motion @ self.selection.T),
            found.radius,
        )

    def marker(self, interface: str) -> exudyn.MarkerIndex:
        """Return the marker of an interface.

        Raises
        ------
        TypeError, ValueError
            For an interface without a marker; the message lists the known ones.
        """
        self.check_present()
        if checks.label(interface, "interface") not in self.markers:
            known = ", ".join(self.markers) or "none"
            raise ValueError(
                f"interface: rotor {self.name!r} has no marker for {interface!r}; markers: {known}"
            )
        return self.markers[interface]


def finished(kind: type, mbs: exudyn.MainSystem, plan: Plan, **items: Any) -> Any:
    """Return a body of a `kind` with its `items`, its frame held, its weight and markers added."""
    rigid, marker_body = items["nodes"]["rigid"], items["objects"]["marker_body"]
    held = {} if plan.locking == "mass" else add_constraints(mbs, plan.locks, rigid)
    # what the equations do not hold
    load = add_weight(mbs, marker_body, plan.gravity - plan.motion.gravity)
    body = kind(**vars(plan), mbs=mbs, constraints=held, gravity_load=load, **items)
    for name, of_marker in body.marker_kinds.items():
        body.markers[name] = body.interface_carrier(name).add_marker(
            mbs, of_marker, body.frame.B, name=marker_name(body.name, name), show=True
        )
    return body


def known_rotors(mbs: exudyn.MainSystem) -> Iterator[RotorItems]:
    """Yield the rotors that still stand in a scene: it can be reset.

    The entry of ``mbs.sys`` must not hold the ``mbs`` as bodies do: it holds copies without one.
    """
    for rotor in entry(mbs).get(_ROTORS, {}).values():
        if _stands(mbs, rotor):
            body = copy(rotor)
            object.__setattr__(body, "mbs", mbs)
            yield body


def _stands(mbs: exudyn.MainSystem, rotor: RotorItems) -> bool:
    """Return whether the object with the rotor's equations is still on the rotor's nodes."""
    try:
        found = mbs.GetObjectParameter(rotor.objects["physics"], "nodeNumbers")
    except Exception:  # none, or of another kind; Exudyn's errors have no common base but this
        return False
    return list(map(int, found)) == list(map(int, rotor.nodes.values()))


def carrying_rotor(mbs: exudyn.MainSystem, base: object) -> RotorItems | None:
    """Return the rotor to which a marker belongs; None for the ground, bodies and foundations."""
    if not isinstance(base, exudyn.MarkerIndex):
        return None
    body = mbs.GetMarker(base).get("bodyNumber")
    nodes = [] if body is None else mbs.GetObject(body).get("nodeNumbers", [])
    first = int(nodes[0]) if len(nodes) else None
    return next((rotor for rotor in known_rotors(mbs) if int(rotor.nodes["rigid"]) == first), None)
