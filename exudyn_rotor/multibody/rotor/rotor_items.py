"""What stands for a rotor in an Exudyn ``mbs``: its plan, and the numbers of its items."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import exudyn
import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.multibody.evaluation import STATES
from exudyn_rotor.multibody.mark import Mark, mark_of, set_mark
from exudyn_rotor.multibody.rotor.equations import Layout
from exudyn_rotor.multibody.rotor.frame import BodyFrame
from exudyn_rotor.multibody.rotor.inputs import main_system
from exudyn_rotor.multibody.rotor.locking import Locks
from exudyn_rotor.multibody.rotor.plan import Plan
from exudyn_rotor.reduction.selection import Selection
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.formulation import Formulation
from exudyn_rotor.theory.motion import Motion
from exudyn_rotor.theory.rotating_axes import axes_of

_INDICES = {
    "nodes": exudyn.NodeIndex,
    "objects": exudyn.ObjectIndex,
    "markers": exudyn.MarkerIndex,
    "constraints": exudyn.ObjectIndex,
}


@dataclass(frozen=True, eq=False, repr=False)
class RotorItems:
    """A rotor's items in an ``mbs``.

    Attributes
    ----------
    mbs : exudyn.MainSystem
    plan : Plan
        How the rotor was laid out; ``plan.setup`` is what was asked for.
    nodes : mapping of str
        ``'rigid'`` (frame) and ``'modes'`` (modal coordinates); without the marker body only
        ``'coordinates'``.
    objects : mapping of str
        ``'physics'`` (the equations) and ``'marker_body'`` (markers, sensors, drawing).
    markers : mapping of str
        Marker number of every interface.
    constraints : mapping of str
        Locking constraints, where ``locking='constraints'``: ``'locks'`` holds what stands still
        or turns at a constant speed; motions that vary with time have one each.
    gravity_load : LoadIndex or None
        None without gravity, and where it is part of the equations (``motion.gravity``): without
        the marker body, and for a free spin without translation.
    mesh_node_count : int
        Mesh nodes that native sensors can be put at.
    mesh_stress : bool
        Whether these sensors know the stress.
    supports : list
        What :func:`exudyn_rotor.add_supports` added.
    drives : list
        What :func:`exudyn_rotor.add_drive` added.
    node_places : dict
        By marker number, mesh nodes and weights of markers that ``add_marker`` put there.
    """

    mbs: exudyn.MainSystem
    plan: Plan
    nodes: Mapping[str, exudyn.NodeIndex]
    objects: Mapping[str, exudyn.ObjectIndex]
    markers: Mapping[str, exudyn.MarkerIndex] = field(default_factory=dict)
    constraints: Mapping[str, exudyn.ObjectIndex] = field(default_factory=dict)
    gravity_load: exudyn.LoadIndex | None = None
    mesh_node_count: int = 0
    mesh_stress: bool = False
    supports: list = field(default_factory=list, init=False)
    drives: list = field(default_factory=list, init=False)
    node_places: dict = field(default_factory=dict, init=False)
    record_sensors: dict = field(default_factory=dict, init=False)
    mark: Mark | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        main_system(self.mbs)
        checks.instance(self.plan, "plan", Plan, "add_rotor makes one")
        for name, kind in _INDICES.items():
            numbers = checks.mapping(getattr(self, name), name, kind.__name__)
            for item, number in numbers.items():
                checks.instance(number, f"{name}: {item!r}", kind)
            object.__setattr__(self, name, checks.read_only_mapping(numbers))
        if self.gravity_load is not None:
            checks.instance(self.gravity_load, "gravity_load", exudyn.LoadIndex)
        checks.count(self.mesh_node_count, "mesh_node_count")
        checks.flag(self.mesh_stress, "mesh_stress")
        physics = self.objects["physics"]
        object.__setattr__(self, "mark", set_mark(self.mbs, physics))

    @property
    def name(self) -> str | None:
        """Name of the rotor."""
        return self.plan.setup.name

    @property
    def axis(self) -> SpinAxis:
        """Spin axis, mesh coordinates."""
        return self.selection.source.axis

    @property
    def standing_axes(self) -> np.ndarray:
        """(n1, n2, e) as columns (3, 3) in inertial axes, where the spin angle is zero."""
        return self.plan.setup.placement.rotation @ axes_of(self.axis)

    @property
    def formulation(self) -> Formulation:
        """Which coordinates the rotor has."""
        return self.plan.setup.formulation

    @property
    def stiffening(self) -> str:
        """Level of the centrifugal stiffening."""
        return self.plan.setup.stiffening

    @property
    def selection(self) -> Selection:
        """The component modes in use; ``selection.labels`` names the modal coordinates."""
        return self.plan.selection

    @property
    def motion(self) -> Motion:
        """Equations of motion, inertial and mesh axes.

        In a plane of rotation that is skew to the inertial axes they have three translations, and
        a constraint holds the plane.
        """
        return self.plan.motion

    @property
    def frame(self) -> BodyFrame:
        """Where mesh, marker body and scene stand to each other."""
        return self.plan.frame

    @property
    def layout(self) -> Layout:
        """Where the unknowns stand among the coordinates of the nodes."""
        return self.plan.layout

    @property
    def locks(self) -> Locks:
        """What happens to the six rigid coordinates of the marker body."""
        return self.plan.locks

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
        kinds = exudyn.OutputVariableType
        place = self.layout

        def values(kind: exudyn.OutputVariableType) -> np.ndarray:
            nodes = self.nodes.values()
            parts = [self.mbs.GetNodeOutput(node, kind, configuration) for node in nodes]
            return np.hstack(parts)[place.unknowns]

        return tuple(map(values, (kinds.Coordinates, kinds.Coordinates_t, kinds.Coordinates_tt)))

    def check_present(self) -> None:
        """Raise ValueError where the system no longer holds this rotor."""
        if self.mark is None or mark_of(self.mbs, self.objects["physics"]) != self.mark:
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
