"""A reduced rotor in an Exudyn ``mbs``: what was added, and helpers around it."""

from __future__ import annotations

from dataclasses import dataclass, field

import exudyn
import numpy as np

from exudyn_rotor.multibody import sensors
from exudyn_rotor.multibody.equations import Layout
from exudyn_rotor.multibody.frame import ShellFrame
from exudyn_rotor.multibody.locking import Locks
from exudyn_rotor.multibody.record import Record, add_watch, read_record
from exudyn_rotor.reduction.selection import Selection
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.formulation import Formulation
from exudyn_rotor.theory.motion import Motion


@dataclass(frozen=True, eq=False)
class RotorBody:
    """A fixed-axis rotor inside an ``mbs``; made by :func:`exudyn_rotor.add_rotor`.

    Attributes
    ----------
    mbs : exudyn.MainSystem
    name : str or None
    axis : SpinAxis
        Mesh coordinates.
    formulation : Formulation
    stiffening : str
    selection : Selection
        The component modes in use; ``selection.labels`` names the modal coordinates.
    motion : Motion
        Equations of motion, inertial and mesh axes. In a plane of rotation that is skew to the
        inertial axes they have three translations, and a constraint holds the plane.
    frame : ShellFrame
        Where mesh, shell and scene stand to each other.
    nodes : dict
        ``'rigid'`` (frame) and ``'modes'`` (modal coordinates); without the native shell only
        ``'coordinates'``.
    objects : dict
        ``'physics'`` (the equations) and ``'shell'`` (markers, sensors, drawing).
    markers : dict of str
        Marker number of every interface. Apply loads here: the frame's node carries only the
        motions that the formulation has.
    constraints : dict of str
        Locking constraints by coordinate, where ``locking='constraints'``.
    gravity_load : LoadIndex or None
        None without gravity, and where it is part of the equations (``motion.gravity``): without
        the native shell, and for a free spin without translation.
    mesh_node_count : int
        Mesh nodes that native sensors can be put at.
    watched : dict
        Sensors of :meth:`watch`.
    """

    mbs: exudyn.MainSystem
    name: str | None
    axis: SpinAxis
    formulation: Formulation
    stiffening: str
    selection: Selection
    motion: Motion
    frame: ShellFrame
    layout: Layout
    locks: Locks
    nodes: dict
    objects: dict
    markers: dict = field(default_factory=dict)
    constraints: dict = field(default_factory=dict)
    gravity_load: exudyn.LoadIndex | None = None
    mesh_node_count: int = 0
    watched: dict = field(default_factory=dict)

    def __repr__(self) -> str:
        """Return one line; :meth:`report` says more."""
        return (
            f"RotorBody({self.name!r}, Sect. {self.formulation.section}, "
            f"stiffening {self.stiffening!r}, {len(self.selection.labels)} modes, "
            f"markers: {', '.join(self.markers) or 'none'})"
        )

    def marker(self, interface: str) -> exudyn.MarkerIndex:
        """Return the marker of an interface.

        Raises
        ------
        KeyError
            For an interface without a marker; the message lists the known ones.
        """
        if interface not in self.markers:
            known = ", ".join(self.markers) or "none"
            raise KeyError(
                f"rotor {self.name!r} has no marker for interface {interface!r}; markers: {known}"
            )
        return self.markers[interface]

    @property
    def uses_python(self) -> bool:
        """True when a time step calls Python user functions."""
        return not self.motion.is_constant

    @property
    def locked(self) -> tuple[str, ...]:
        """Coordinates that exist only because the native shell's node has them."""
        return self.locks.locked_names if "shell" in self.objects else ()

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
            f"  per step       {'Python user functions' if self.uses_python else 'no Python call'}",
        ]
        return "\n".join(lines)

    def coordinates(self, configuration=exudyn.ConfigurationType.Current) -> tuple:
        """Return the unknowns q, q̇, q̈ of :attr:`motion` in a configuration, each (size,)."""
        kinds = exudyn.OutputVariableType
        return tuple(
            np.concatenate(
                [
                    np.atleast_1d(self.mbs.GetNodeOutput(node, kind, configuration))
                    for node in self.nodes.values()
                ]
            )[self.layout.unknowns]
            for kind in (kinds.Coordinates, kinds.Coordinates_t, kinds.Coordinates_tt)
        )

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

    def watch(self) -> None:
        """Record all coordinates of the coming run, for :func:`exudyn_rotor.check_run`.

        Adds native sensors, so call it before ``mbs.Assemble()``. They store as often as
        ``solution.sensors.writePeriod`` says, and a step calls no Python for them.
        """
        add_watch(self)

    def record(self) -> Record:
        """Return what :meth:`watch` recorded; without it the current state alone."""
        return read_record(self)
