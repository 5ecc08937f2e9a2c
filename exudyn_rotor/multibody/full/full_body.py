"""A full body in an Exudyn ``mbs``: markers, sensors, and displacements at instants of a run.

Each marker has coordinates that are tied to the nodes. All displacements at all steps would fill
the memory; a sensor keeps those of the instants, and their rates. Exudyn calls it whenever sensors
are stored, and at all other times it reads nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

import exudyn
import numpy as np
import scipy.sparse as sp
from exudyn.itemInterface import SensorSuperElement, SensorUserFunction
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.full.full_plan import FullPlan
from exudyn_rotor.multibody.full.ties import FieldNode, Ties, add_ties
from exudyn_rotor.multibody.rotor import sensors
from exudyn_rotor.multibody.rotor.marker_body import (
    MarkerBodyMesh,
    add_interface_marker,
    marker_body_mesh,
    marker_body_object,
)
from exudyn_rotor.multibody.rotor.plan import MARKER_KINDS, MarkerRequest
from exudyn_rotor.multibody.rotor.record import Record, read_record, spin_speeds
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.multibody.rotor.scene_body import SceneBody
from exudyn_rotor.reduction.fields import ReducedInterface
from exudyn_rotor.solid.interface import Interface, rotation_moments

_FLAT = 1e-6  # smallest second moment of nodes over the largest for which they show a rotation


def add_marker(
    body: RotorItems,
    where: str | Sequence[int],
    offset: ArrayLike,
    *,
    weights: ArrayLike | None,
    kind: str,
    name: str | None,
    show: bool,
) -> exudyn.MarkerIndex:
    """Add a marker with the mean rigid motion of an interface or of mesh nodes."""
    _check_marker_body(body)
    shift = checks.vector(offset, "offset", "m")
    checks.choice(kind, "kind", MARKER_KINDS)
    checks.flag(show, "show")
    if name is not None:
        checks.label(name, "name")
        if int(body.mbs.GetMarkerNumber(name)) != -1:
            raise ValueError(f"name: this system already has a marker {name!r}; choose another")
    interface = _interface(body, where, weights, kind)
    marker_body, mesh = _tied_body(body, interface, shift)
    request = MarkerRequest(kind, shift, show)
    return add_interface_marker(
        body.mbs, name or "", interface.name, request, marker_body, mesh, body.frame
    )


def add_node_sensor(
    body: RotorItems, node: int, output: exudyn.OutputVariableType, options: dict[str, Any]
) -> exudyn.SensorIndex:
    """Add a native sensor at mesh node `node`, stored internally by default."""
    _check_marker_body(body)
    rotor = body.selection.source
    checks.count(node, "node", most=rotor.node_count - 1)
    settings = sensors.settings_at_mesh_node(body, output, options)
    interface = Interface("node", [node], None, rotor.nodes[[node]])
    marker_body, mesh = _tied_body(body, interface, np.zeros(3))
    number = mesh.point_nodes[interface.name][0]
    return body.mbs.AddSensor(
        SensorSuperElement(
            bodyNumber=marker_body, meshNodeNumber=number, outputVariableType=output, **settings
        )
    )


def interface_carrier(
    body: RotorItems, name: str
) -> tuple[exudyn.ObjectIndex, np.ndarray, np.ndarray, float]:
    """Add a massless body with the mean motion of an interface, for connectors to it.

    Returns
    -------
    ObjectIndex
    ndarray, shape (3,)
        The interface's point on the axis, axes of the body [m].
    ndarray, shape (6, 6)
        Displacement and rotation by the body's coordinates, its axes.
    float
        Radius of the interface [m].
    """
    interface = body.selection.source.interfaces[name]
    carrier, _ = _tied_body(body, interface, np.zeros(3))
    place = body.frame.points(body.axis.project(interface.reference))
    return carrier, place, np.kron(np.eye(2), body.frame.B), interface.radius


def _check_marker_body(body: RotorItems) -> None:
    body.check_present()
    if "marker_body" not in body.objects:
        raise ValueError(
            f"rotor {body.name!r} was added with marker_body=False; markers need the marker body"
        )


def _interface(
    body: RotorItems, where: str | Sequence[int], weights: ArrayLike | None, kind: str
) -> Interface:
    rotor, described = body.selection.source, "where: an interface, or mesh nodes"
    if isinstance(where, str):
        if weights is not None:
            raise ValueError("weights: are for mesh nodes; an interface has its own")
        known = tuple(rotor.interfaces)
        return rotor.interfaces[checks.choice(where, "where: interface", known)]
    nodes = checks.whole_numbers(where, described, most=rotor.node_count - 1)
    if len(nodes) == 0 or len(set(nodes.tolist())) != len(nodes):
        raise ValueError(f"{described}: needs different nodes, got {checks.shown(where)}")
    interface = Interface("nodes", nodes, weights, rotor.nodes[nodes])
    moments = rotation_moments(interface.positions - interface.center, interface.weights)[0]
    sizes = np.linalg.eigvalsh(moments)
    if kind == "rigid" and sizes[0] <= _FLAT * sizes[-1]:
        raise ValueError(
            f"where: the nodes {checks.shown(nodes.tolist())} lie on a line or in a point and show "
            "no rotation; give more nodes, an interface, or kind='position'"
        )
    return interface


def _tied_body(
    body: RotorItems, interface: Interface, shift: np.ndarray
) -> tuple[exudyn.ObjectIndex, MarkerBodyMesh]:
    """Add a massless body with the mean motion of an interface; return it and its nodes."""
    rotor, plan, frame = body.selection.source, body.plan, body.frame
    size, inv = 3 * rotor.node_count, body.motion.invariants
    none = np.zeros((0, size))
    rows = sp.csr_array(interface.mean_motion(rotor.node_count))
    fields = FieldNode(body.nodes["fields"], size, 0)
    tied, _ = add_ties(body.mbs, fields, Ties(rows, none, none), inv, plan.start)
    shown = ReducedInterface(interface.reference, interface.center, interface.radius, np.eye(6))
    name = interface.name
    mesh = marker_body_mesh(None, {name: shown}, np.eye(6), rotor.axis, frame, {name: shift})
    nodes, center = [body.nodes["rigid"], tied], body.selection.origin + inv.center
    S = np.zeros((3, 6))
    item = marker_body_object("", nodes, mesh, inv.mass, center, S, frame, plan.setup.color)
    return body.mbs.AddObject(item), mesh


_KINDS = exudyn.OutputVariableType
_ROUNDING = 1e-9  # of an instant, which a sum of steps may miss


@dataclass(frozen=True, eq=False)
class FullRecord:
    """Displacements of a full body at the instants of its record.

    Attributes
    ----------
    time : ndarray, shape (s,)
        When they were stored: at the instants, or when sensors were stored next [s].
    displacement : ndarray, shape (s, n, 3)
        Of all nodes, rotor frame, mesh axes [m].
    stress : ndarray, shape (s, n, 6), or None
        xx, yy, zz, yz, xz, xy at all nodes, mesh axes [Pa], as :meth:`FullRotorBody.stress`; None
        for a rotor without elements.
    """

    time: np.ndarray
    displacement: np.ndarray
    stress: np.ndarray | None


class Stored:
    """Which instants are wanted, and what has been stored."""

    def __init__(self, instants: np.ndarray) -> None:
        self.instants = instants
        self.latest = np.inf
        self.time: list[float] = []
        self.states: list[tuple[np.ndarray, ...]] = []

    def is_due(self, t: float) -> bool:
        """Return whether `t` is the next instant; a run that begins anew forgets the last one."""
        if t < self.latest:
            self.time, self.states = [], []
        self.latest = t
        done = len(self.time)
        return done < len(self.instants) and t >= self.instants[done] * (1.0 - _ROUNDING)


def start_recording(body: RotorItems, instants: ArrayLike) -> None:
    """Add the sensor that stores the displacements at ascending instants [s]."""
    body.check_present()
    wanted = checks.ascending(instants, "instants", "s")
    if wanted[0] < 0.0:
        raise ValueError(f"instants: needs none before the start at 0 s, got {wanted[0]:.6g} s")
    if body.mbs.systemIsConsistent:
        raise ValueError(
            f"start_recording: the system of rotor {body.name!r} is assembled already; call this "
            "before mbs.Assemble()"
        )
    if body.stored:
        raise ValueError(f"start_recording: rotor {body.name!r} has its instants already")
    body.stored.append(stored := Stored(wanted))
    body.mbs.AddSensor(
        SensorUserFunction(
            sensorUserFunction=_storing(stored, tuple(body.nodes.values())),
            storeInternal=True,
            writeToFile=False,
        )
    )


def _storing(stored: Stored, nodes: tuple[exudyn.NodeIndex, ...]) -> Callable:
    def store(mbs, t, sensors, factors, configuration):
        if configuration == exudyn.ConfigurationType.Current and stored.is_due(t):
            values = (
                np.hstack([mbs.GetNodeOutput(node, kind, configuration) for node in nodes])
                for kind in (_KINDS.Coordinates, _KINDS.Coordinates_t, _KINDS.Coordinates_tt)
            )
            stored.time.append(t)
            stored.states.append(tuple(values))
        return [float(len(stored.time))]

    return store


def recorded(body: RotorItems) -> FullRecord:
    """Return what was stored at all the instants."""
    body.check_assembled()
    stored = body.stored[0] if body.stored else None
    if stored is None:
        raise ValueError(
            f"rotor {body.name!r} stores nothing; call body.start_recording(instants) before "
            "mbs.Assemble()"
        )
    done = len(stored.time)
    if done < len(stored.instants):
        raise ValueError(
            f"rotor {body.name!r} stored {done} of {len(stored.instants)} instants, and nothing "
            f"for {stored.instants[done]:.6g} s: the run ended before, or sensors were stored too "
            "seldom; let solution.sensors.writePeriod be the step"
        )
    fields = body.layout.unknowns[body.motion.modes]
    displacement = np.array([q[fields] for q, *_ in stored.states]).reshape(done, -1, 3)
    recover, stress = body.selection.source.stress_recovery, None
    if recover is not None:
        columns = displacement.reshape(done, -1).T
        stress = np.moveaxis(recover(columns), -1, 0)
    return FullRecord(np.array(stored.time), displacement, stress)


def recorded_states(body: RotorItems) -> Record:
    """Return all coordinates, rates and accelerations at the instants that were stored.

    The current state where nothing was stored.
    """
    body.check_assembled()
    stored = body.stored[0] if body.stored else None
    if stored is None or not stored.time:
        return read_record(body)
    time = np.array(stored.time)
    q, q_t, q_tt = (np.array(rows) for rows in zip(*stored.states, strict=True))
    speed = spin_speeds(body, time, q_t)
    return Record(time, q, q_t, q_tt, np.zeros_like(q), speed, len(time) > 1)


@dataclass(frozen=True, eq=False, repr=False)
class FullRotorBody(SceneBody):
    """A full fixed-axis rotor inside an ``mbs``; :func:`exudyn_rotor.add_rotor` makes it.

    The attributes are those of :class:`~exudyn_rotor.multibody.rotor.rotor_items.RotorItems`, with
    the displacements of all nodes, in the rotor frame and mesh axes, in the place of modal
    coordinates; and these:

    Attributes
    ----------
    plan : FullPlan
    ties : ObjectIndex or None
        The object that ties interfaces to the nodes and holds the conditions of the frame.

    Examples
    --------
    >>> import exudyn
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, add_rotor
    >>> rotor = SolidRotor.from_matrices(
    ...     np.eye(6), 1e6 * np.eye(6), [[0.1, 0, 0], [-0.1, 0, 0]], "z", interfaces={"top": [0]}
    ... )
    >>> mbs = exudyn.SystemContainer().AddSystem()
    >>> body = add_rotor(mbs, rotor, spin=10.0, translation="none")
    >>> body
    FullRotorBody('rotor', Sect. 2.5, stiffening 'tilt', 2 nodes, markers: top)
    >>> mbs.Assemble()
    >>> settings = exudyn.SimulationSettings()
    >>> settings.staticSolver.verboseMode = 0
    >>> mbs.SolveStatic(settings)
    True
    >>> bool(np.isclose(body.displacement()[0, 0], 10.0 / (1e6 - 100.0), rtol=1e-9))
    True
    """

    plan: FullPlan
    ties: exudyn.ObjectIndex | None = None
    stored: list = field(default_factory=list, init=False, repr=False)

    _kind: ClassVar[str] = "full, "

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.instance(self.plan, "plan", FullPlan, "add_rotor makes one")
        if self.ties is not None:
            checks.instance(self.ties, "ties", exudyn.ObjectIndex)

    @property
    def node_count(self) -> int:
        """Number of nodes of the mesh."""
        return self.selection.source.node_count

    @property
    def condition_count(self) -> int:
        """Number of conditions that keep the frame's motions out of the displacements."""
        return len(self.selection.conditions.rows)

    @property
    def _size_in_words(self) -> str:
        return f"{self.node_count} nodes"

    def _report_of_coordinates(self) -> list[str]:
        return [
            f"  nodes          {self.node_count}, {3 * self.node_count} displacements",
            f"  conditions     {self.condition_count} of the frame, in mass matrix and stiffness",
        ]

    def displacement(
        self, configuration: exudyn.ConfigurationType = exudyn.ConfigurationType.Current
    ) -> np.ndarray:
        """Return the displacements of all nodes in the rotor frame, mesh axes, (n, 3) [m]."""
        return self.coordinates(configuration)[0][self.motion.modes].reshape(-1, 3)

    def stress(
        self, configuration: exudyn.ConfigurationType = exudyn.ConfigurationType.Current
    ) -> np.ndarray:
        """Return the stress at all nodes, (n, 6) [Pa]: xx, yy, zz, yz, xz, xy in mesh axes.

        That of the displacements, the static one by the spin among them. A stress at rest, of
        ``prestress(stress=…)``, is not in it.

        Raises
        ------
        ValueError
            For a rotor without elements.
        """
        recover = self.selection.source.stress_recovery
        if recover is None:
            raise ValueError(
                f"stress: rotor {self.name!r} has no elements that it could be computed with; make "
                "it with SolidRotor.from_ngsolve"
            )
        return recover(self.displacement(configuration).reshape(-1, 1))[:, :, 0]

    def start_recording(self, instants: ArrayLike) -> None:
        """Store the displacements of all nodes at chosen instants of the coming run.

        Adds a sensor, so call it before ``mbs.Assemble()``. Sensors are stored every
        ``solution.sensors.writePeriod``; the first time at or after an instant serves it.

        Parameters
        ----------
        instants : array_like, shape (s,)
            Ascending, from 0 [s].

        Raises
        ------
        TypeError, ValueError
            For bad input, and if the system is assembled; nothing has been added then.
        """
        start_recording(self, instants)

    def recorded(self) -> FullRecord:
        """Return displacements and stress at the instants of :meth:`start_recording`.

        Raises
        ------
        ValueError
            If there are no instants, or the run has not stored all.
        """
        return recorded(self)

    def add_marker(
        self,
        where: str | Sequence[int],
        offset: ArrayLike = (0.0, 0.0, 0.0),
        *,
        weights: ArrayLike | None = None,
        kind: str = "rigid",
        name: str | None = None,
        show: bool = True,
    ) -> exudyn.MarkerIndex:
        """Add a marker that moves with the mean rigid motion of an interface or of mesh nodes.

        Arguments and axes are those of :meth:`RotorBody.add_marker`; a single node has a marker of
        `kind` 'position'. Every marker has twelve unknowns of its own.

        Raises
        ------
        TypeError, ValueError
            For bad input, e.g. nodes on a line for a rigid marker; nothing has been added then.
        """
        return add_marker(self, where, offset, weights=weights, kind=kind, name=name, show=show)

    def add_node_sensor(self, node: int, output: exudyn.OutputVariableType, **options):
        """Add a native sensor at a mesh node; `options` go to ``SensorSuperElement``."""
        return add_node_sensor(self, node, output, options)


def reduced_body(body: object, how: str = "add_rotor returned it") -> RotorBody:
    """Return a rotor body in component modes, which analyses of a scene need.

    Raises
    ------
    TypeError
        For a full body, or anything else.
    """
    if isinstance(body, FullRotorBody):
        raise TypeError(
            f"body: rotor {body.name!r} is a full body, whose displacements of all nodes this "
            "does not take; add the reduced rotor, add_rotor(mbs, rotor.reduce(…)), or give a "
            "linear analysis the SolidRotor and its supports"
        )
    return checks.instance(body, "body", RotorBody, how)
