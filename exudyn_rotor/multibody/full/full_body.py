"""A full body in an Exudyn ``mbs``: a solid rotor with the displacements of all its nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import exudyn
import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.full import full_markers, full_record
from exudyn_rotor.multibody.full.full_plan import FullPlan
from exudyn_rotor.multibody.full.full_record import FullRecord
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.rotor.scene_body import SceneBody


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
        full_record.start_recording(self, instants)

    def recorded(self) -> FullRecord:
        """Return displacements and stress at the instants of :meth:`start_recording`.

        Raises
        ------
        ValueError
            If there are no instants, or the run has not stored all.
        """
        return full_record.recorded(self)

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
        return full_markers.add_marker(
            self, where, offset, weights=weights, kind=kind, name=name, show=show
        )

    def add_node_sensor(self, node: int, output: exudyn.OutputVariableType, **options):
        """Add a native sensor at a mesh node; `options` go to ``SensorSuperElement``."""
        return full_markers.add_node_sensor(self, node, output, options)


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
