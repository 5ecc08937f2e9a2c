"""A full body in an Exudyn ``mbs``: markers, sensors, and displacements at instants of a run.

All displacements at all steps would fill the memory; a sensor keeps those of chosen instants, and
their rates. Exudyn calls it whenever sensors are stored, and at all other times it reads nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import exudyn
import numpy as np
import scipy.sparse as sp
from exudyn.itemInterface import SensorSuperElement, SensorUserFunction
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.full.ties import Ties, add_ties
from exudyn_rotor.multibody.rotor import sensors
from exudyn_rotor.multibody.rotor.markers import (
    Carrier,
    append_nodes,
    flexible_body,
    interface_of_nodes,
)
from exudyn_rotor.multibody.rotor.record import Record, read_record, spin_speeds
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody, SceneBody
from exudyn_rotor.solid.interface import Interface

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


@dataclass(eq=False)
class Stored:
    """Which instants are wanted, and what has been stored."""

    instants: np.ndarray
    time: list[float] = field(default_factory=list)
    states: list[tuple[np.ndarray, ...]] = field(default_factory=list)
    latest: float = np.inf

    def is_due(self, t: float) -> bool:
        """Return whether `t` is the next instant; a run that begins anew forgets the last one."""
        if t < self.latest:
            self.time, self.states = [], []
        self.latest = t
        done = len(self.time)
        return done < len(self.instants) and t >= self.instants[done] * (1.0 - _ROUNDING)


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


def recorded_states(body: FullRotorBody) -> Record:
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
    ties : ObjectIndex
        The object that holds the conditions of the frame.

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

    ties: exudyn.ObjectIndex | None = None
    stored: list = field(default_factory=list, init=False, repr=False)
    carriers: dict = field(default_factory=dict, init=False, repr=False)

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
        self.check_present()
        wanted = checks.ascending(instants, "instants", "s")
        if wanted[0] < 0.0:
            raise ValueError(f"instants: needs none before the start at 0 s, got {wanted[0]:.6g} s")
        if self.mbs.systemIsConsistent:
            raise ValueError(
                f"start_recording: the system of rotor {self.name!r} is assembled already; call "
                "this before mbs.Assemble()"
            )
        if self.stored:
            raise ValueError(f"start_recording: rotor {self.name!r} has its instants already")
        self.stored.append(Stored(wanted))
        self.mbs.AddSensor(
            SensorUserFunction(
                sensorUserFunction=_storing(self.stored[0], tuple(self.nodes.values())),
                storeInternal=True,
                writeToFile=False,
            )
        )

    def recorded(self) -> FullRecord:
        """Return displacements and stress at the instants of :meth:`start_recording`.

        Raises
        ------
        ValueError
            If there are no instants, or the run has not stored all.
        """
        self.check_assembled()
        if not self.stored:
            raise ValueError(
                f"rotor {self.name!r} stores nothing; call body.start_recording(instants) before "
                "mbs.Assemble()"
            )
        stored = self.stored[0]
        done = len(stored.time)
        if done < len(stored.instants):
            raise ValueError(
                f"rotor {self.name!r} stored {done} of {len(stored.instants)} instants, and "
                f"nothing for {stored.instants[done]:.6g} s: the run ended before, or sensors were "
                "stored too seldom; let solution.sensors.writePeriod be the step"
            )
        fields = self.layout.unknowns[self.motion.modes]
        displacement = np.array([q[fields] for q, *_ in stored.states]).reshape(done, -1, 3)
        recover, stress = self.selection.source.stress_recovery, None
        if recover is not None:
            stress = np.moveaxis(recover(displacement.reshape(done, -1).T), -1, 0)
        return FullRecord(np.array(stored.time), displacement, stress)

    def interface_carrier(self, interface: str) -> Carrier:
        """Return what moves with the mean motion of an interface; there is one for each."""
        known = self.selection.source.interfaces
        checks.choice(interface, "interface", tuple(known))
        if interface not in self.carriers:
            self.carriers[interface] = self._tied(known[interface])
        return self.carriers[interface]

    def _nodes_carrier(self, where: Sequence[int], weights: ArrayLike | None, kind: str) -> Carrier:
        """Return what moves with the mean rigid motion of mesh nodes."""
        nodes = self.selection.source.nodes
        return self._tied(interface_of_nodes(nodes, where, weights, kind))

    def _tied(self, interface: Interface) -> Carrier:
        """Add a flexible body whose six coordinates are tied to the nodes of an interface."""
        inv, size = self.motion.invariants, self.motion.invariants.size
        rows, none = sp.csr_array(interface.mean_motion(size // 3)), np.zeros((0, size))
        ties = Ties(rows, none, none)
        tied, _ = add_ties(self.mbs, self.nodes["fields"], ties, inv, self.plan.start)
        nodes = self.nodes["rigid"], tied
        return Carrier(
            self.mbs.AddObject(flexible_body(self.plan, nodes, np.zeros((3, 6)))),
            self.frame.points(interface.reference),
            np.kron(np.eye(2), self.frame.B),
            interface.radius,
            nodes,
        )

    def add_node_sensor(self, node: int, output: exudyn.OutputVariableType, **options):
        """Add a native sensor at a mesh node; `options` go to ``SensorSuperElement``."""
        self.check_present()
        checks.count(node, "node", most=self.node_count - 1)
        settings = sensors.settings_at_mesh_node(self, output, options)
        point = self._nodes_carrier([node], None, "position")
        (number,) = append_nodes(self.mbs, point.body, *point.virtual_nodes("position"))
        return self.mbs.AddSensor(
            SensorSuperElement(
                bodyNumber=point.body, meshNodeNumber=number, outputVariableType=output, **settings
            )
        )


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
