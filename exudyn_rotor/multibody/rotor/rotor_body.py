"""A reduced rotor in an Exudyn ``mbs``: what was added, and helpers around it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import exudyn
from numpy.typing import ArrayLike

from exudyn_rotor.multibody.rotor import more_markers, sensors
from exudyn_rotor.multibody.rotor.record import Record, add_recording, read_record
from exudyn_rotor.multibody.rotor.scene_body import SceneBody
from exudyn_rotor.multibody.rotor.start_state import StartState, start_from


@dataclass(frozen=True, eq=False, repr=False)
class RotorBody(SceneBody):
    """A fixed-axis rotor inside an ``mbs``; made by :func:`exudyn_rotor.add_rotor`.

    The attributes are those of :class:`~exudyn_rotor.multibody.rotor.rotor_items.RotorItems`.

    Examples
    --------
    >>> import exudyn
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, add_rotor
    >>> rotor = SolidRotor.from_matrices(
    ...     np.eye(6), 1e6 * np.eye(6), [[0.1, 0, 0], [-0.1, 0, 0]], "z", interfaces={"top": [0]}
    ... )
    >>> mbs = exudyn.SystemContainer().AddSystem()
    >>> body = add_rotor(mbs, rotor.reduce(2), name="fan", spin=10.0, translation="none")
    >>> displacement = body.add_interface_sensor("top", exudyn.OutputVariableType.Displacement)
    >>> force = mbs.CreateForce(itemNumber=body.marker("top"), loadVector=[0.0, 0.0, 5.0])
    >>> body.locked
    ('x', 'y', 'z', 'tilt a', 'tilt b', 'spin')
    >>> body.uses_python
    False
    """

    @property
    def _size_in_words(self) -> str:
        return f"{len(self.selection.labels)} modes"

    def _report_of_coordinates(self) -> list[str]:
        labels = self.selection.labels
        return [f"  modes          {len(labels)}: {', '.join(labels)}"]

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

        Its axes are those of the mesh, for every spin axis; forces at an offset have their whole
        lever, which they lack at the offset of a ``MarkerSuperElementRigid``; and its cost does not
        depend on the number of nodes.

        Parameters
        ----------
        where : str or sequence of int
            Interface, with or without a marker yet, or mesh nodes.
        offset : array_like, shape (3,)
            From the interface's reference point or the mean of the nodes, mesh axes [m].
        weights : array_like, optional
            Of the nodes, as Exudyn's `weightingFactors`; equal by default.
        kind : {'rigid', 'position'}
        name : str, optional
        show : bool
            Whether it is drawn.

        Raises
        ------
        TypeError, ValueError
            For bad input, e.g. nodes on a line for a rigid marker; nothing has been added then.
        """
        return more_markers.add_marker(
            self, where, offset, weights=weights, kind=kind, name=name, show=show
        )

    def add_node_sensor(self, node: int, output: exudyn.OutputVariableType, **options):
        """Add a native sensor at a mesh node; `options` go to ``SensorSuperElement``.

        Stress in Exudyn, here and in contour plots, is that of the modal coordinates alone, without
        the static centrifugal stress that the modes do not show; for a rotor with a prestress that
        warns. :class:`exudyn_rotor.StressField` gives the whole.
        """
        return sensors.add_node_sensor(self, node, output, **options)

    def start_from(self, state: StartState) -> None:
        """Make a state of the whole scene the initial state of the coming runs.

        Coordinates and velocities of all bodies are set, in the assembled system and in its nodes,
        so that they outlive another ``mbs.Assemble()``.

        Parameters
        ----------
        state : StartState
            Of this system: ``steady_state(body).state()``, or ``response.state(speed, body)`` of a
            linear response.

        Raises
        ------
        TypeError, ValueError
            For a system without a state yet, a state of another system, or one that does not agree
            with the rotor's prescribed spin.
        """
        start_from(self, state)

    def start_recording(self) -> None:
        """Record all coordinates of the coming run, for :func:`exudyn_rotor.check_run`.

        Adds native sensors, so call it before ``mbs.Assemble()``. They store as often as
        ``solution.sensors.writePeriod`` says, and a step calls no Python for them.
        """
        add_recording(self)

    def recorded(self) -> Record:
        """Return what :meth:`start_recording` recorded; without it the current state alone."""
        return read_record(self)
