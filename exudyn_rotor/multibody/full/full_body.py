"""A full body in an Exudyn ``mbs``: displacements, stress, markers and sensors at mesh nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import exudyn
import numpy as np
import scipy.sparse as sp
from exudyn.itemInterface import SensorSuperElement

from exudyn_rotor import checks
from exudyn_rotor.multibody.full.ties import add_ties
from exudyn_rotor.multibody.rotor.rotor_body import (
    Record,
    RotorBody,
    SceneBody,
    add_sensor,
    sensor_options,
)
from exudyn_rotor.multibody.rotor.rotor_items import (
    Carrier,
    append_nodes,
    flexible_body,
    interface_of_nodes,
)
from exudyn_rotor.solid.rotor import Interface


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class FullRotorBody(SceneBody):
    """A full fixed-axis rotor inside an ``mbs``; :func:`exudyn_rotor.add_rotor` makes it.

    The attributes are those of :class:`exudyn_rotor.RotorBody`, with the displacements of all
    nodes, in the rotor frame and mesh axes, in the place of modal coordinates; and these:

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

    ties: exudyn.ObjectIndex
    carriers: dict = field(default_factory=dict, init=False, repr=False)

    @property
    def node_count(self) -> int:
        """Number of nodes of the mesh."""
        return self.selection.source.node_count

    def _coordinates_in_words(self) -> tuple[str, list[str]]:
        held = len(self.selection.conditions.rows)
        return f"{self.node_count} nodes", [
            f"  nodes          {self.node_count}, {3 * self.node_count} displacements",
            f"  conditions     {held} of the frame, in mass matrix and stiffness",
        ]

    def displacement(
        self, of: exudyn.ConfigurationType | Record = exudyn.ConfigurationType.Current
    ) -> np.ndarray:
        """Return the displacements of all nodes in the rotor frame, mesh axes [m].

        Parameters
        ----------
        of : exudyn.ConfigurationType or Record
            Shape (n, 3) of a configuration, (s, n, 3) of what :meth:`recorded` returns.
        """
        checks.instance(of, "of", (exudyn.ConfigurationType, Record))
        if isinstance(of, Record):
            fields = self.layout.unknowns[self.motion.modes]
            return of.q[:, fields].reshape(len(of.q), -1, 3)
        return self.coordinates(of)[0][self.motion.modes].reshape(-1, 3)

    def stress(
        self, of: exudyn.ConfigurationType | Record = exudyn.ConfigurationType.Current
    ) -> np.ndarray:
        """Return the stress at all nodes [Pa]: xx, yy, zz, yz, xz, xy in mesh axes.

        That of the displacements, the static one by the spin among them.

        Parameters
        ----------
        of : exudyn.ConfigurationType or Record
            Shape (n, 6) of a configuration, (s, n, 6) of what :meth:`recorded` returns.

        Raises
        ------
        ValueError
            For a rotor without elements.
        """
        elements = self.selection.source.elements
        if elements is None:
            raise ValueError(
                f"stress: rotor {self.name!r} has no elements that it could be computed with; make "
                "it with SolidRotor.from_ngsolve"
            )
        moved = self.displacement(of)
        columns = moved.reshape(-1, 3 * self.node_count).T
        return np.moveaxis(elements.nodal_stress(columns), -1, 0).reshape(*moved.shape[:-1], 6)

    def interface_carrier(self, interface: str) -> Carrier:
        """Return what moves with the mean motion of an interface; there is one for each."""
        known = self.selection.source.interfaces
        checks.choice(interface, "interface", tuple(known))
        if interface not in self.carriers:
            self.carriers[interface] = self._tied(known[interface])
        return self.carriers[interface]

    def _nodes_carrier(self, where: Sequence[int], kind: str) -> Carrier:
        """Return what moves with the mean rigid motion of mesh nodes."""
        nodes = self.selection.source.nodes
        return self._tied(interface_of_nodes(nodes, where, kind))

    def _tied(self, interface: Interface) -> Carrier:
        """Add a flexible body whose six coordinates are tied to the nodes of an interface."""
        rows = sp.csr_array(interface.mean_motion(self.node_count))
        tied, _ = add_ties(self.mbs, self.nodes["fields"], self, rows)
        nodes = self.nodes["rigid"], tied
        return Carrier(
            self.mbs.AddObject(flexible_body(self, nodes, np.zeros((3, 6)))),
            self.frame.points(interface.reference),
            np.kron(np.eye(2), self.frame.B),
            interface.radius,
        )

    def add_node_sensor(self, node: int, output: exudyn.OutputVariableType, **options):
        """Add a native sensor at a mesh node; `options` go to ``SensorSuperElement``.

        It shows no stress, which :meth:`stress` gives.
        """
        self.check_present()
        checks.count(node, "node", most=self.node_count - 1)
        checks.instance(output, "output", exudyn.OutputVariableType)
        options = sensor_options(self, options)
        point = self._nodes_carrier([node], "position")
        (number,) = append_nodes(self.mbs, point.body, *point.virtual_nodes("position"))
        at = {"bodyNumber": point.body, "meshNodeNumber": number}
        return add_sensor(self, SensorSuperElement, options, outputVariableType=output, **at)


def reduced_body(body: object, how: str = "add_rotor returned it") -> RotorBody:
    """Return a rotor body in component modes, which analyses of a scene need."""
    if isinstance(body, FullRotorBody):
        raise TypeError(
            f"body: rotor {body.name!r} is a full body, whose displacements of all nodes this "
            "does not take; add the reduced rotor, add_rotor(mbs, rotor.reduce(…)), or give a "
            "linear analysis the SolidRotor and its supports"
        )
    return checks.instance(body, "body", RotorBody, how)
