"""What a scene knows of its rotors: found by a mark, without the bodies, which hold the ``mbs``."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import exudyn
import numpy as np

from exudyn_rotor.multibody.mark import Mark, entry, mark_of
from exudyn_rotor.multibody.rotor.plan import Plan

if TYPE_CHECKING:
    from exudyn_rotor.multibody.rotor.rotor_items import RotorItems

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
