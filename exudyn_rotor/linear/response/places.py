"""Where rotors are loaded and looked at: interfaces, mesh nodes, points of a foundation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.linear.equations import Terms, turned
from exudyn_rotor.linear.model.linear_model import LinearModel

At = str | int | Sequence[float]


@dataclass(frozen=True, eq=False)
class Place:
    """A point of a model.

    Attributes
    ----------
    label : str
        Name of the interface, or 'node 12'.
    seen : mapping of int to ndarray, shape (6, k)
        Fourier terms of displacement and rotation along (n1, n2, e) per coordinate, in axes that
        stand still.
    is_node : bool
        True for a mesh node, which has no rotation: those rows are zero.
    ratio : float
        Speed of the body over the speed of the analysis; 0 of a foundation.
    """

    label: str
    seen: Terms
    is_node: bool
    ratio: float = 1.0

    def motion(self, coordinates: Mapping[int, np.ndarray], frame: str) -> dict[int, np.ndarray]:
        """Return the harmonics (…, 6) of the motion, given the harmonics (…, k) of coordinates.

        In axes that stand still, or in axes that turn with the speed of the analysis.
        """
        seen = self.seen if frame == "inertial" else turned(self.seen, -1)
        motion: dict[int, np.ndarray] = {}
        for m, U in seen.items():
            for n, x in coordinates.items():
                motion[m + n] = motion.get(m + n, 0.0) + x @ U.T
        return motion


def place(model: LinearModel, at: At, speed: float = 1.0) -> Place:
    """Find an interface by its name, a mesh node by its number or by a position [m].

    The motion is seen at a speed [rad/s]: at rest, or at any other.

    Raises
    ------
    ValueError
        If there is no such interface or node, or the rotor was stored without mode shapes.
    """
    if isinstance(at, str):
        known = model.interfaces
        if at not in known:
            raise ValueError(
                f"at: {at!r}: no such interface; the rotor has: {', '.join(known) or 'none'}"
            )
        body, _ = model.owner(at)
        return Place(at, model.seen(at, speed), False, getattr(body, "ratio", 0.0))
    [first, *others] = model.rotors.values()
    if others:
        raise ValueError(f"at: {at!r}: of several rotors, name an interface")
    if first.shapes is None:
        raise ValueError(
            f"at: {at!r}: mesh nodes need a rotor with mode shapes; reduce with "
            "keep_shapes=True, or name an interface"
        )
    number = _node_number(at, first.shapes.nodes)
    return Place(f"node {number}", model.seen_at_node(number, speed), is_node=True)


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
    return tuple(checks.place(one, f"at[{index}]") for index, one in enumerate(listed))


def places(model: LinearModel, at: Sequence[At] | None, speed: float = 1.0) -> list[Place]:
    """Return the places asked for; by default all interfaces."""
    observed = [place(model, one, speed) for one in (model.interfaces if at is None else at)]
    if not observed:
        raise ValueError("at: the rotor has no interfaces; name mesh nodes or positions to look at")
    labels = [one.label for one in observed]
    if len(set(labels)) < len(labels):
        raise ValueError(f"at: a place is named twice: {', '.join(labels)}")
    return observed


def _node_number(at: int | Sequence[float], nodes: np.ndarray) -> int:
    """Return a node's number; the nearest one to a position."""
    if isinstance(at, int):
        if at >= len(nodes):
            raise ValueError(f"at: {at}: no such node; the mesh has nodes 0 to {len(nodes) - 1}")
        return at
    return int(np.argmin(np.linalg.norm(nodes - np.asarray(at), axis=1)))
