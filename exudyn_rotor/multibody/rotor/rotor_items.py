"""What stands for a rotor in an ``mbs``: its plan, its items, and how it is known again.

Numbers and names do not say whether an item is still the one that was added: after ``mbs.Reset()``
another rotor may have the same. The mark by which a rotor is known is the colour of an object that
is never drawn. What the scene itself knows of its rotors must not hold the ``mbs``, as bodies do.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import count

import exudyn
import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.multibody import ENTRY
from exudyn_rotor.multibody.evaluation import STATES
from exudyn_rotor.multibody.rotor.equations import Layout
from exudyn_rotor.multibody.rotor.frame import BodyFrame, Locks
from exudyn_rotor.multibody.rotor.plan import Plan, main_system
from exudyn_rotor.reduction.selection import Selection
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.formulation import Formulation
from exudyn_rotor.theory.motion import Motion
from exudyn_rotor.theory.rotating_axes import axes_of

_BASE = 2**23  # single precision holds whole numbers up to twice that
_SIGN = -2.0  # no opacity of a colour
_numbers = count(1)

Mark = tuple[float, float]


def entry(mbs: exudyn.MainSystem) -> dict:
    """Return the package's own entry of ``mbs.sys``."""
    return mbs.sys.setdefault(ENTRY, {})


def mark_of(mbs: exudyn.MainSystem, item: exudyn.ObjectIndex) -> Mark | None:
    """Return the mark of an object; None where it has none, or there is no such object."""
    if int(item) >= mbs.systemData.NumberOfObjects():
        return None
    try:
        color = mbs.GetObjectParameter(item, "Vcolor")
    # an item of another kind; Exudyn's errors have no common base but this
    except Exception:
        return None
    return (color[0], color[1]) if len(color) == 4 and color[3] == _SIGN else None


def set_mark(mbs: exudyn.MainSystem, item: exudyn.ObjectIndex) -> Mark | None:
    """Put a new mark on an object that has none, and return its mark; None if it takes none."""
    known = mark_of(mbs, item)
    if known is None and int(item) < mbs.systemData.NumberOfObjects():
        high, low = divmod(next(_numbers), _BASE)
        mbs.SetObjectParameter(item, "Vcolor", [float(high), float(low), 0.0, _SIGN])
        known = mark_of(mbs, item)
    return known


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


_ROTORS = "rotors"
_KINDS = exudyn.OutputVariableType


@dataclass(eq=False)
class KnownRotor:
    """A rotor with a marker body in a scene: an ``mbs`` must not hold a body that holds it.

    Attributes
    ----------
    plan : Plan
    node, marker_body, physics : int
        Numbers of the frame's node, the flexible body and the equations.
    own : set of int
        Numbers of the objects that hold its coordinates.
    drives : list
        That of the body.
    mark : tuple or None
        By which the rotor is known again.
    mesh_node_count : int
    frame_shares : ndarray, shape (r, k − r), or None
        Motion of the frame of Exudyn's own body by the elastic columns of the reduced rotor, in
        shares of its r rigid ones (:func:`exudyn_rotor.reduction.mean_axis.frame_shares`).
    carriers : dict
        Markers that carry tilts, by those of a script at the node.
    turned : set of int
        A script's markers that have been given mesh axes.
    told : set of str
        What ``mbs.Assemble()`` has warned of.
    """

    plan: Plan
    node: int
    marker_body: int
    physics: int
    own: set[int]
    drives: list
    mark: Mark | None
    mesh_node_count: int
    frame_shares: np.ndarray | None = None
    carriers: dict[int, int] = field(default_factory=dict)
    turned: set[int] = field(default_factory=set)
    told: set[str] = field(default_factory=set)

    @property
    def axis(self) -> np.ndarray:
        """Spin axis (3,) in inertial axes."""
        return self.plan.motion.orientation @ self.plan.motion.invariants.direction

    @property
    def is_full(self) -> bool:
        """Whether its coordinates are the displacements of all nodes."""
        return self.plan.motion.invariants.is_sparse

    def spin(
        self,
        mbs: exudyn.MainSystem,
        state: exudyn.ConfigurationType = exudyn.ConfigurationType.Current,
    ) -> tuple[float, float]:
        """Return spin angle [rad] and speed [rad/s]."""
        read, place = mbs.GetNodeOutput, self.plan.locks.spin
        angle = read(self.node, _KINDS.Coordinates, state)[place]
        return float(angle), float(read(self.node, _KINDS.Coordinates_t, state)[place])


def note_rotor(body: RotorItems) -> KnownRotor:
    """Let the scene know a rotor that was added with its marker body."""
    known = KnownRotor(
        body.plan,
        int(body.nodes["rigid"]),
        int(body.objects["marker_body"]),
        int(body.objects["physics"]),
        set(map(int, body.constraints.values())),
        body.drives,
        body.mark,
        body.mesh_node_count,
    )
    entry(body.mbs).setdefault(_ROTORS, {})[known.node] = known
    return known


def known_rotors(mbs: exudyn.MainSystem) -> Iterator[KnownRotor]:
    """Yield the rotors that still stand in a scene: it can be reset."""
    for rotor in entry(mbs).get(_ROTORS, {}).values():
        if rotor.mark is not None and mark_of(mbs, exudyn.ObjectIndex(rotor.physics)) == rotor.mark:
            yield rotor


def known_rotor(body: RotorItems) -> KnownRotor:
    """Return what the scene knows of a body."""
    return entry(body.mbs)[_ROTORS][int(body.nodes["rigid"])]


def carrying_rotor(mbs: exudyn.MainSystem, base: object) -> KnownRotor | None:
    """Return the rotor to which a marker belongs; None for the ground, bodies and foundations."""
    if not isinstance(base, exudyn.MarkerIndex):
        return None
    body = mbs.GetMarker(base).get("bodyNumber")
    nodes = [] if body is None else mbs.GetObject(body).get("nodeNumbers", [])
    first = int(nodes[0]) if len(nodes) else None
    return next((rotor for rotor in known_rotors(mbs) if rotor.node == first), None)
