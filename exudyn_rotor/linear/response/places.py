"""Where a rotor is loaded and looked at: interfaces and mesh nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.linear import options
from exudyn_rotor.linear.equations.supports import axes_of
from exudyn_rotor.linear.equations.system import PeriodicSystem

At = str | int | Sequence[float]


class Source(Protocol):
    """Linear equations at any spin speed, of a rotor with supports or of a whole scene."""

    @property
    def size(self) -> int:
        """Number of coordinates k."""

    def at(self, speed: float) -> PeriodicSystem:
        """Return the equations at a spin speed [rad/s]."""

    def interface_motion(self, name: str) -> np.ndarray:
        """Return the motion (6, k) of an interface along (n1, n2, e)."""


@dataclass(frozen=True, eq=False)
class Place:
    """A point of the rotor.

    Attributes
    ----------
    label : str
        Name of the interface, or 'node 12'.
    motion : ndarray, shape (6, k)
        Displacement and rotation along (n1, n2, e) per coordinate, rotor frame.
    is_node : bool
        True for a mesh node, which has no rotation: those rows are zero.
    """

    label: str
    motion: np.ndarray
    is_node: bool


def place(source: Source, at: At) -> Place:
    """Find an interface by its name, a mesh node by its number or by a position [m].

    Raises
    ------
    ValueError
        If there is no such interface or node, or the rotor was stored without mode shapes.
    """
    if isinstance(at, str):
        return _interface(source, at)
    if hasattr(source, "node_motion"):  # a full model
        number = _node_number(at, source.nodes)
        return Place(f"node {number}", source.node_motion(number), is_node=True)
    rotor = getattr(source, "rotor", None)
    if rotor is None or rotor.shapes is None:
        raise ValueError(
            f"place {at!r}: mesh nodes need a ReducedRotor with mode shapes; reduce with "
            "keep_shapes=True, or name an interface"
        )
    number = _node_number(at, rotor.shapes.nodes)
    rows = axes_of(rotor.axis).T @ rotor.shapes.matrix[3 * number : 3 * number + 3]
    return Place(f"node {number}", np.vstack([rows, 0.0 * rows]), is_node=True)


def checked_places(at: Sequence[At] | At | None) -> tuple[At, ...] | None:
    """Return places as a tuple; None for all interfaces.

    Raises
    ------
    TypeError, ValueError
        If one is neither a name, nor a number, nor a position.
    """
    if at is None:
        return None
    if isinstance(at, str | int | np.integer):
        at = (at,)
    listed = checks.items(at, "at", "places of the rotor in a sequence")
    return tuple(options.place(one, f"at[{index}]") for index, one in enumerate(listed))


def places(source: Source, at: Sequence[At] | None) -> list[Place]:
    """Return the places asked for; by default all interfaces."""
    found = [place(source, one) for one in (interface_names(source) if at is None else at)]
    if not found:
        raise ValueError("at: the rotor has no interfaces; name mesh nodes or positions to look at")
    labels = [one.label for one in found]
    if len(set(labels)) < len(labels):
        raise ValueError(f"at: a place is named twice: {', '.join(labels)}")
    return found


def interface_names(source: Source) -> tuple[str, ...]:
    """Return the names of all interfaces of a rotor, or of all with a marker in a scene."""
    if hasattr(source, "rotor"):
        return tuple(source.rotor.interfaces)
    return tuple(source.body.markers)


def _interface(source: Source, name: str) -> Place:
    known = interface_names(source)
    if name not in known:
        raise ValueError(
            f"place {name!r}: no such interface; the rotor has: {', '.join(known) or 'none'}"
        )
    return Place(name, np.asarray(source.interface_motion(name)), is_node=False)


def _node_number(at: int | Sequence[float], nodes: np.ndarray) -> int:
    """Return a node's number; the nearest one to a position."""
    if isinstance(at, int):
        if at >= len(nodes):
            raise ValueError(f"place {at}: no such node; the mesh has nodes 0 to {len(nodes) - 1}")
        return at
    return int(np.argmin(np.linalg.norm(nodes - np.asarray(at), axis=1)))
