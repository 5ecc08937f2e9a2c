"""Rotors that carry bearings of others: how they turn, known by the markers at their interfaces."""

from __future__ import annotations

from dataclasses import dataclass

import exudyn

from exudyn_rotor.multibody.mark import Mark, mark_of

_ROTORS = "exudyn_rotor: how rotors turn, by the node of the frame"  # key in mbs.sys
_KINDS = exudyn.OutputVariableType


@dataclass(frozen=True)
class CarryingRotor:
    """The spin of a rotor, without the rotor itself: an ``mbs`` must not hold what holds it.

    Attributes
    ----------
    node : int
        Of its frame.
    place : int
        Coordinate of the node that is the spin angle.
    sign : float
        In which it counts.
    axis : tuple of float
        Spin axis in inertial axes.
    physics : int
        Object of its equations.
    mark : tuple or None
        By which that is known again.
    """

    node: int
    place: int
    sign: float
    axis: tuple[float, ...]
    physics: int
    mark: Mark | None

    def spin(
        self,
        mbs: exudyn.MainSystem,
        state: exudyn.ConfigurationType = exudyn.ConfigurationType.Current,
    ) -> tuple[float, float]:
        """Return spin angle [rad] and speed [rad/s]."""
        read = mbs.GetNodeOutput
        angle = read(self.node, _KINDS.Coordinates, state)[self.place]
        rate = read(self.node, _KINDS.Coordinates_t, state)[self.place]
        return self.sign * float(angle), self.sign * float(rate)


def note_rotor(mbs: exudyn.MainSystem, rotor: CarryingRotor) -> None:
    """Let :func:`carrying_rotor` find a rotor that was added."""
    mbs.sys.setdefault(_ROTORS, {})[rotor.node] = rotor


def carrying_rotor(mbs: exudyn.MainSystem, base: object) -> CarryingRotor | None:
    """Return the rotor to which a marker belongs; None for the ground, bodies and foundations."""
    if not isinstance(base, exudyn.MarkerIndex):
        return None
    body = mbs.GetMarker(base).get("bodyNumber")
    nodes = [] if body is None else mbs.GetObject(body).get("nodeNumbers", [])
    found = mbs.sys.get(_ROTORS, {}).get(int(nodes[0])) if len(nodes) else None
    if found is None or mark_of(mbs, exudyn.ObjectIndex(found.physics)) != found.mark:
        return None
    return found
