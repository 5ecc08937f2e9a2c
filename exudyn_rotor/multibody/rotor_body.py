"""A reduced rotor in an Exudyn ``mbs``: what was added, and helpers around it."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import exudyn
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody import more_markers, sensors
from exudyn_rotor.multibody.connections import ConnectionWarning, lost_connections
from exudyn_rotor.multibody.record import Record, add_recording, read_record
from exudyn_rotor.multibody.rotor_items import RotorItems
from exudyn_rotor.multibody.start_state import StartState, start_from


@dataclass(frozen=True, eq=False, repr=False)
class RotorBody(RotorItems):
    """A fixed-axis rotor inside an ``mbs``; made by :func:`exudyn_rotor.add_rotor`.

    The attributes are those of :class:`~exudyn_rotor.multibody.rotor_items.RotorItems`.

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

    def __repr__(self) -> str:
        """Return one line; :meth:`report` says more."""
        return (
            f"RotorBody({self.name!r}, Sect. {self.formulation.section}, "
            f"stiffening {self.stiffening!r}, {len(self.selection.labels)} modes, "
            f"markers: {', '.join(self.markers) or 'none'})"
        )

    @property
    def uses_python(self) -> bool:
        """True when a time step calls Python user functions, of the rotor or its supports."""
        return not self.motion.is_constant or any(each.uses_python for each in self.supports)

    @property
    def locked(self) -> tuple[str, ...]:
        """Coordinates that exist only because the marker body's node has them."""
        return self.locks.locked_names if "marker_body" in self.objects else ()

    def report(self) -> str:
        """Return a short table of what was added and what it means at run time."""
        names = {3: "x, y, z", 2: "two in the plane of rotation", 0: "none"}
        frame = names[self.formulation.translation_count]
        spin = "unknown" if self.formulation.has_spin else "prescribed"
        lines = [
            f"rotor {self.name!r}: Sect. {self.formulation.section}, "
            f"stiffening {self.stiffening!r}",
            f"  translations   {frame}",
            f"  spin           {spin}",
            f"  modes          {len(self.selection.labels)}: {', '.join(self.selection.labels)}",
            f"  locked         {', '.join(self.locked) or 'none'}",
            f"  constraints    {len(self.constraints)}",
            f"  supports       {'; '.join(map(str, self.supports)) or 'none added'}",
            f"  per step       {'Python user functions' if self.uses_python else 'no Python call'}",
        ]
        return "\n".join(lines)

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

    def check_connections(self, *, warn: bool = True) -> tuple[str, ...]:
        """Return what the scene attaches to the rotor that it cannot carry.

        Loads and connectors on coordinates of the frame's node that are locked (tilts, translations
        that the formulation does not have) or that move the centre of mass and not the node's
        place, dampers of tilts at the node, forces at a marker's own offset that has no lever, and
        sensors of the node that show no tilts: one sentence for each, with what to use instead.
        Exudyn's own body carries them.
        ``mbs.Assemble()`` warns of each once, and :func:`exudyn_rotor.check_run` has a row of this.

        Parameters
        ----------
        warn : bool
            Whether there is a ConnectionWarning for each.

        Raises
        ------
        ValueError
            If the system is not assembled.
        """
        checks.flag(warn, "warn")
        self.check_assembled()
        lost = lost_connections(self)
        for sentence in lost if warn else ():
            warnings.warn(f"rotor {self.name!r}: {sentence}", ConnectionWarning, stacklevel=2)
        return lost

    def add_node_sensor(self, node: int, output: exudyn.OutputVariableType, **options):
        """Add a native sensor at a mesh node; `options` go to ``SensorSuperElement``.

        Stress in Exudyn, here and in contour plots, is that of the modal coordinates alone, without
        the static centrifugal stress that the modes do not show; for a rotor with a prestress that
        warns. :class:`exudyn_rotor.StressField` gives the whole.
        """
        return sensors.add_node_sensor(self, node, output, **options)

    def add_interface_sensor(self, interface: str, output: exudyn.OutputVariableType, **options):
        """Add a native sensor at an interface's marker; `options` go to ``SensorMarker``."""
        return sensors.add_interface_sensor(self, interface, output, **options)

    def add_spin_sensor(self, **options):
        """Add a sensor of spin angle [rad] and spin speed [rad/s]."""
        return sensors.add_spin_sensor(self, **options)

    def add_drive_torque_sensor(self, **options):
        """Add a sensor of the torque about e that a prescribed spin needs [N m]."""
        return sensors.add_drive_torque_sensor(self, **options)

    def add_energy_sensor(self, **options):
        """Add a sensor of kinetic energy, elastic energy and the potential of the weight [J].

        The kinetic energy is that in the inertial frame, with the spin. The weight's potential is
        zero where the rotor stands at the start, undeformed and at θ = 0. The sum changes by the
        work of all other loads and of a prescribed motion (``add_drive_torque_sensor`` gives its
        torque), less what damping takes; a drift without these is the integrator's error.
        """
        return sensors.add_energy_sensor(self, **options)

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
