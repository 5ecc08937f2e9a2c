"""What stands for a rotor in an ``mbs``: its plan, its items, and how it is known again.

A scene knows its rotors by an entry of ``mbs.sys``, which must not hold the ``mbs`` as bodies do:
it holds bodies without one, which share everything else with those of the script.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from copy import copy
from dataclasses import dataclass, field

import exudyn
import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.multibody import ENTRY
from exudyn_rotor.multibody.evaluation import STATES
from exudyn_rotor.multibody.rotor.equations import Layout
from exudyn_rotor.multibody.rotor.frame import BodyFrame, Locks
from exudyn_rotor.multibody.rotor.markers import Carrier
from exudyn_rotor.multibody.rotor.plan import Plan, marker_name
from exudyn_rotor.reduction.selection import Selection
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.formulation import Formulation
from exudyn_rotor.theory.motion import Motion
from exudyn_rotor.theory.rotating_axes import axes_of

_ROTORS = "rotors"


def entry(mbs: exudyn.MainSystem) -> dict:
    """Return the package's own entry of ``mbs.sys``."""
    return mbs.sys.setdefault(ENTRY, {})


@dataclass(eq=False)
class ScriptMarkers:
    """What ``mbs.Assemble()`` has done with a script's own markers on a rotor.

    Attributes
    ----------
    carriers : dict
        Markers that carry tilts, by those of a script at the node.
    turned : set of int
        Markers that have been given mesh axes.
    told : set of str
        Warnings that have been given.
    frame_shares : ndarray, shape (r, k − r), or None
        Motion of the frame of Exudyn's own body by the elastic columns of the reduced rotor, in
        shares of its r rigid ones (:func:`exudyn_rotor.reduction.mean_axis.frame_shares`).
    """

    carriers: dict[int, int] = field(default_factory=dict)
    turned: set[int] = field(default_factory=set)
    told: set[str] = field(default_factory=set)
    frame_shares: np.ndarray | None = None


@dataclass(frozen=True, eq=False, repr=False)
class RotorItems:
    """A rotor's items in an ``mbs``.

    Attributes
    ----------
    mbs : exudyn.MainSystem
    plan : Plan
        How the rotor was laid out; ``plan.setup`` is what was asked for.
    nodes : mapping of str
        ``'rigid'`` (frame), and ``'modes'`` (modal coordinates) or ``'fields'`` (displacements).
    objects : mapping of str
        ``'physics'`` (the equations) and ``'marker_body'`` (markers, sensors, drawing).
    constraints : mapping of str
        Locking constraints, where ``locking='constraints'``: ``'locks'`` holds what stands still
        or turns at a constant speed; motions that vary with time have one each.
    gravity_load : LoadIndex or None
        None without gravity, and where it is part of the equations (``motion.gravity``): for a free
        spin without translation.
    mesh_node_count : int
        Mesh nodes that native sensors can be put at.
    markers : dict of str
        Marker number of every interface.
    supports : list
        What :func:`exudyn_rotor.add_supports` added.
    drives : list
        What :func:`exudyn_rotor.add_drive` added.
    """

    mbs: exudyn.MainSystem
    plan: Plan
    nodes: Mapping[str, exudyn.NodeIndex]
    objects: Mapping[str, exudyn.ObjectIndex]
    constraints: Mapping[str, exudyn.ObjectIndex] = field(default_factory=dict)
    gravity_load: exudyn.LoadIndex | None = None
    mesh_node_count: int = 0
    markers: dict = field(default_factory=dict, init=False)
    supports: list = field(default_factory=list, init=False)
    drives: list = field(default_factory=list, init=False)
    record_sensors: dict = field(default_factory=dict, init=False)
    token: object = field(default_factory=object, init=False)  # of this rotor alone
    script: ScriptMarkers = field(default_factory=ScriptMarkers, init=False)

    def __post_init__(self) -> None:
        checks.instance(self.plan, "plan", Plan, "add_rotor makes one")
        known = copy(self)
        object.__setattr__(known, "mbs", None)
        entry(self.mbs).setdefault(_ROTORS, {})[int(self.nodes["rigid"])] = known

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
            tuple(self.nodes.values()),
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


def add_interface_markers(body: RotorItems) -> None:
    """Add the markers that ``add_rotor`` was asked for, with the axes of the mesh."""
    for interface, kind in body.plan.setup.markers.items():
        body.markers[interface] = body.interface_carrier(interface).add_marker(
            body.mbs, kind, body.frame.B, name=marker_name(body.name, interface), show=True
        )


def known_rotors(mbs: exudyn.MainSystem) -> Iterator[RotorItems]:
    """Yield the rotors that still stand in a scene: it can be reset."""
    for rotor in entry(mbs).get(_ROTORS, {}).values():
        if _stands(mbs, rotor):
            body = copy(rotor)
            object.__setattr__(body, "mbs", mbs)
            yield body


def _stands(mbs: exudyn.MainSystem, rotor: RotorItems) -> bool:
    """Return whether the object with the rotor's equations is still on the rotor's nodes."""
    physics = rotor.objects["physics"]
    if int(physics) >= mbs.systemData.NumberOfObjects():
        return False
    try:
        found = mbs.GetObjectParameter(physics, "nodeNumbers")
    except Exception:  # an object of another kind; Exudyn's errors have no common base but this
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
