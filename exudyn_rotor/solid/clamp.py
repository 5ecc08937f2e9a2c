"""Directions in which nodes of a rotor are held in its own frame."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.nodal import coupled

MESH = ("x", "y", "z")
CYLINDER = ("radial", "tangential", "axial")
# of the rotor's size: nodes closer to the axis have no radial direction
_ON_AXIS = 1e-9
# springs, over the largest diagonal entry of the stiffness. Along mesh axes: clamped nodes move by
# less than 1e-10 of the others, and dense eigenvalues, whose error is relative to the stiffest
# spring, keep four digits. A spring across them is rounded into the node's free directions by 1e-16
# of itself, which a soft rotor shows: less stiff, and clamped nodes move by less than 1e-6
_ALONG, _ACROSS = 1e6, 1e2
_STIFFER = 1e4  # than all that is coupled: no spring to the ground that means something


def checked_directions(directions: str | Iterable[str] | None) -> tuple[str, ...]:
    """Return names of directions; all of the mesh axes for None, and for all three of the others.

    Raises
    ------
    ValueError
        If there are none, one is unknown or named twice, or both kinds are mixed.
    """
    if directions is None:
        return MESH
    names = checks.labels(directions, "directions", (*MESH, *CYLINDER))
    if not names or len(set(names)) < len(names):
        raise ValueError(f"directions: needs one or more of them, each once, got {list(names)}")
    if not (set(names) <= set(MESH) or set(names) <= set(CYLINDER)):
        raise ValueError(
            f"directions: needs some of {list(MESH)} or some of {list(CYLINDER)}, not of both, got "
            f"{list(names)}"
        )
    return MESH if len(names) == len(MESH) else names


def held_directions(
    nodes: np.ndarray, axis: SpinAxis, held: np.ndarray, directions: tuple[str, ...]
) -> sp.csr_array:
    """Return orthonormal columns D (3n, d): one for every direction of every held node.

    A node on the axis is held across it where 'radial' and 'tangential' are both given, else in
    neither of them.
    """
    if set(directions) <= set(MESH):
        units = np.repeat(np.eye(3)[None], held.size, axis=0)
        chosen = [np.full(held.size, name in directions) for name in MESH]
    else:
        arms = axis.radial(nodes[held])
        radii = np.linalg.norm(arms, axis=1)
        on_axis = radii <= _ON_AXIS * np.ptp(nodes, axis=0).max()
        radial = np.where(on_axis[:, None], axis.plane[:, 0], arms)
        radial = radial / np.linalg.norm(radial, axis=1)[:, None]
        along = np.broadcast_to(axis.direction, radial.shape)
        units = np.stack([radial, np.cross(along, radial), along], axis=1)
        across = {"radial", "tangential"} <= set(directions)
        chosen = [
            (name in directions) & (across | ~on_axis | (name == "axial")) for name in CYLINDER
        ]
    node, which = np.nonzero(np.stack(chosen, axis=1))
    rows = 3 * held[node][:, None] + np.arange(3)
    columns = np.repeat(np.arange(node.size)[:, None], 3, axis=1)
    entries = units[node, which].ravel(), (rows.ravel(), columns.ravel())
    return sp.csr_array(entries, shape=(nodes.size, node.size))


def holding_spring(columns: sp.csr_array, stiffness: sp.csr_array) -> float:
    """Return the spring [N/m] that holds the directions of :func:`held_directions`."""
    along = np.isin(np.abs(columns.data), (0.0, 1.0)).all()
    moving = stiffness.diagonal()[~clamped_coordinates(stiffness)]
    return float((_ALONG if along else _ACROSS) * moving.max())


def clamped_coordinates(stiffness: sp.csr_array) -> np.ndarray:
    """Return which coordinates are clamped along mesh axes (3n,): those on nothing but a spring."""
    joined, diagonal = coupled(stiffness), stiffness.diagonal()
    if not joined.any():
        return joined
    return ~joined & (diagonal > _STIFFER * diagonal[joined].max())
