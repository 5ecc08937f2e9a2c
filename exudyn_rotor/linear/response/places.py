"""Where a rotor is loaded and looked at: interfaces and mesh nodes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.linear import options
from exudyn_rotor.linear.models.protocol import LinearModel
from exudyn_rotor.theory.rotating_axes import into_inertial_frame, out_of_inertial_frame

At = str | int | Sequence[float]
Motion = Mapping[int, np.ndarray]  # harmonics (p, 6)


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


def in_frame(motion: Motion, stands: np.ndarray, frame: str) -> Motion:
    """Return motions (…, p, 6) of a rotor seen in its frame, and of what `stands`, in the frame."""
    turn, turns = into_inertial_frame, ~stands
    if frame == "rotor":
        turn, turns = out_of_inertial_frame, stands
    if not np.any(turns):
        return motion
    turned = turn({n: a * turns[:, None] for n, a in motion.items()})
    if not np.all(turns):
        for n, a in motion.items():
            turned[n] = turned.get(n, 0.0) + a * ~turns[:, None]
    return turned


def collected(
    motions: Sequence[Motion], observed: Sequence[Place], tolerance: float, length: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the orders (h,) that matter anywhere, and all motions (s, p, h, 6)."""
    orders = sorted({n for motion in motions for n in motion})
    full = np.zeros((len(motions), len(observed), len(orders), 6), dtype=complex)
    for row, motion in zip(full, motions, strict=True):
        for n, amplitudes in motion.items():
            row[:, orders.index(n)] = amplitudes
    if not np.all(np.isfinite(full)):
        raise ValueError("the response left the range of floats; check speeds and loads (SI units)")
    # a rotation counts as the displacement that it makes at the rotor's radius of gyration
    sizes = np.abs(full * np.repeat([1.0, length], 3)).max(axis=(0, 1, 3))
    keep = sizes > tolerance * sizes.max()
    if not np.any(keep):
        keep[np.argmin(np.abs(orders))] = True
    full[:, [one.is_node for one in observed], :, 3:] = np.nan
    return np.array(orders)[keep], full[:, :, keep]
