"""What reduced and full rotor bodies in an Exudyn ``mbs`` have in common: report and sensors."""

from __future__ import annotations

import warnings
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import exudyn

from exudyn_rotor import checks
from exudyn_rotor.multibody.rotor import sensors
from exudyn_rotor.multibody.rotor.connections import ConnectionWarning, lost_connections
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems, known_rotor


@dataclass(frozen=True, eq=False, repr=False)
class SceneBody(RotorItems, ABC):
    """A rotor body in a scene, reduced or full.

    The attributes are those of :class:`~exudyn_rotor.multibody.rotor.rotor_items.RotorItems`.
    """

    _kind: ClassVar[str] = ""

    def __repr__(self) -> str:
        """Return one line; :meth:`report` says more."""
        return (
            f"{type(self).__name__}({self.name!r}, Sect. {self.formulation.section}, "
            f"stiffening {self.stiffening!r}, {self._size_in_words}, "
            f"markers: {', '.join(self.markers) or 'none'})"
        )

    @property
    @abstractmethod
    def _size_in_words(self) -> str:
        """Number of modes or nodes."""

    @abstractmethod
    def _report_of_coordinates(self) -> list[str]:
        """Return lines of :meth:`report` about modes or displacements."""

    @property
    def uses_python(self) -> bool:
        """True when a time step calls Python user functions, of the rotor or its supports."""
        return not self.motion.is_constant or any(
            each.uses_python for each in (*self.supports, *self.drives)
        )

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
            f"{self._kind}stiffening {self.stiffening!r}",
            f"  translations   {frame}",
            f"  spin           {spin}",
            *self._report_of_coordinates(),
            f"  locked         {', '.join(self.locked) or 'none'}",
            f"  constraints    {len(self.constraints)}",
            f"  supports       {'; '.join(map(str, self.supports)) or 'none added'}",
            *([f"  drives         {'; '.join(map(str, self.drives))}"] if self.drives else []),
            f"  per step       {'Python user functions' if self.uses_python else 'no Python call'}",
        ]
        return "\n".join(lines)

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
        if "marker_body" not in self.objects:
            return ()
        lost = lost_connections(self.mbs, known_rotor(self))
        for sentence in lost if warn else ():
            warnings.warn(f"rotor {self.name!r}: {sentence}", ConnectionWarning, stacklevel=2)
        return lost

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
