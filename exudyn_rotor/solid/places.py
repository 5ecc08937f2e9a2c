"""Whether ends of shafts, bearings and what carries them are in one place.

The middle of a meshed seat is the mean of its elements, which an uneven mesh puts a little beside
that of the drawing: by micrometres on a seat of 0.1 m. Across the axis all places are those of the
axis; along it a hundredth of the seat's radius counts as the mesh's.
"""

from __future__ import annotations

import numpy as np

SAME_PLACE = 1e-6  # m
OF_RADIUS = 0.01  # share of an interface's radius by which meshes may put it elsewhere


def leeway(radius: float, direction: np.ndarray) -> np.ndarray:
    """Return how far along its axis a mesh may put an interface elsewhere, shape (3,) [m].

    `radius` is that of the interface [m], `direction` (3,) the unit vector of the axis.
    """
    return OF_RADIUS * radius * direction


def off_place(apart: np.ndarray, *leeways: np.ndarray) -> np.ndarray:
    """Return by how much two places are apart (3,) [m], less the leeways (3,) of meshes."""
    for one in leeways:
        if np.any(one):
            apart = apart - np.clip(apart @ one / (one @ one), -1.0, 1.0) * one
    return apart
