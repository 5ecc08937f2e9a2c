"""Where a rotor is loaded and looked at: interfaces and mesh nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.linear import options
from exudyn_rotor.linear.models.protocol import LinearModel

At = str | int | Sequence[float]


@dataclass(frozen=True, eq=False)
class Place:
    """A point of the rotor.

    Attributes
    ----------
    label : str
        Name of the interface, or 'node 12'.
    motion : ndarray, shape (6, k)
        Displacement and rotation along (n1, n2, e) per coordinate.
    is_node : bool
        True for a mesh node, which has no rotation: those rows are zero.
    stands : bool
        True where the motion is that of a foundation, in inertial axes; else it is in the rotor's.
    """

    label: str
    motion: np.ndarray
    is_node: bool
    stands: bool = False


def place(model: LinearModel, at: At) -> Place:
    """Find an interface by its name, a mesh node by its number or by a position [m].

    Raises
    ------
    ValueError
        If there is no such interface or node, or the rotor was stored without mode shapes.
    """
    if isinstance(at, str):
        return _interface(model, at)
    mesh = model.mesh
    if mesh is None:
        raise ValueError(
            f"at: {at!r}: mesh nodes need a rotor with mode shapes; reduce with "
            "keep_shapes=True, or name an interface"
        )
    number = _node_number(at, mesh.nodes)
    return Place(f"node {number}", mesh.motion(number), is_node=True)


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


def places(model: LinearModel, at: Sequence[At] | None) -> list[Place]:
    """Return the places asked for; by default all interfaces."""
    observed = [place(model, one) for one in (model.interfaces if at is None else at)]
    if not observed:
        raise ValueError("at: the rotor has no interfaces; name mesh nodes or positions to look at")
    labels = [one.label for one in observed]
    if len(set(labels)) < len(labels):
        raise ValueError(f"at: a place is named twice: {', '.join(labels)}")
    return observed


def _interface(model: LinearModel, name: str) -> Place:
    known = model.interfaces
    if name not in known:
        raise ValueError(
            f"at: {name!r}: no such interface; the rotor has: {', '.join(known) or 'none'}"
        )
    stands = name in model.standing_interfaces
    return Place(name, np.asarray(model.interface_motion(name)), is_node=False, stands=stands)


def _node_number(at: int | Sequence[float], nodes: np.ndarray) -> int:
    """Return a node's number; the nearest one to a position."""
    if isinstance(at, int):
        if at >= len(nodes):
            raise ValueError(f"at: {at}: no such node; the mesh has nodes 0 to {len(nodes) - 1}")
        return at
    return int(np.argmin(np.linalg.norm(nodes - np.asarray(at), axis=1)))
