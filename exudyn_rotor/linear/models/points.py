"""Points of a rotor by which its motions are told: spread over the mesh, or rings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from exudyn_rotor.linear.models.protocol import PointMotions
from exudyn_rotor.theory.invariants import Invariants

_CORNERS = 8  # points of a ring
ACROSS = np.eye(3)[:, :2]  # a pair along (n1, n2) as a vector
_LITTLE = 1e-3  # of its coordinate: how far a point of a pair moves


@dataclass(frozen=True, eq=False)
class Ring:
    """A ring that moves with an interface.

    Attributes
    ----------
    center : ndarray, shape (3,)
        Along (n1, n2, e) from a point of the axis [m].
    radius : float
        [m]
    motion : ndarray, shape (6, k)
        Displacement and rotation of the interface along (n1, n2, e) per coordinate.
    """

    center: np.ndarray
    radius: float
    motion: np.ndarray


def ring_motions(rings: Sequence[Ring], size: int) -> PointMotions:
    """Return points on rings of a rotor with `size` coordinates."""
    # a point at rest, so that a rotor without any interface has no whirl instead of an error
    points, motion = [np.zeros((1, 3))], [np.zeros((3, size))]
    angles = 2.0 * np.pi * np.arange(_CORNERS) / _CORNERS
    circle = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(_CORNERS)])
    for ring in rings:
        U, arms = ring.motion, ring.radius * circle
        points.append(ring.center + arms)
        turned = np.cross(U[3:].T[None], arms[:, None]).transpose(0, 2, 1)
        motion.append((U[:3] + turned).reshape(3 * _CORNERS, -1))
    return PointMotions(np.vstack(points), np.vstack(motion), None, False)


def with_pairs(given: PointMotions, pairs: np.ndarray) -> PointMotions:
    """Add a point on the axis for each of the pairs of coordinates (2p, k) that turn, across it.

    It moves little: it tells the sense of motions in which the rotor itself rests.
    """
    count = len(pairs) // 2
    return replace(
        given,
        points=np.vstack([given.points, np.zeros((count, 3))]),
        motion=np.vstack([given.motion, _LITTLE * np.kron(np.eye(count), ACROSS) @ pairs]),
    )


def ring_size(rings: Sequence[Ring]) -> int:
    """Return how many points of :func:`ring_motions` move."""
    return _CORNERS * len(rings)


def spread(count: int, most: int) -> np.ndarray:
    """Return up to `most` node numbers, evenly spread over `count`."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).astype(int))


def radius_of_gyration(invariants: Invariants) -> float:
    """Return the radius of gyration about the centre of mass [m]."""
    return float(np.sqrt(np.trace(invariants.J) / invariants.mass))
