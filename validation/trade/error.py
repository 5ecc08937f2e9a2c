"""Errors of motions, and what a set of measured points says: fronts, the cheapest, crossings."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from validation.rows import Row

JOURNALS = ("left", "right")
ACROSS, ALONG = [1, 2], 0  # the spin axis is x


@dataclass(frozen=True, eq=False)
class Motion:
    """Displacements at common times, inertial axes, each (s, 3) [m]: left, right, disc, rim."""

    tracks: Mapping[str, np.ndarray]

    def extrapolated(self, fine: Motion, ratio: float = 2.0) -> Motion:
        """Return Richardson's combination with a step `ratio` times finer, for errors of O(h²)."""
        weight = ratio**2
        return Motion(
            {n: (weight * fine.tracks[n] - u) / (weight - 1.0) for n, u in self.tracks.items()}
        )

    @property
    def size(self) -> dict[str, float]:
        """Largest displacements [m] of journals and disc; of the rim along the axis."""
        return distances(self, Motion({name: np.zeros_like(u) for name, u in self.tracks.items()}))


def distances(first: Motion, second: Motion) -> dict[str, float]:
    """Return the largest distances at equal times [m]; keys as in :func:`errors`."""
    apart = {name: first.tracks[name] - second.tracks[name] for name in first.tracks}
    across = {name: np.linalg.norm(u[:, ACROSS], axis=1).max() for name, u in apart.items()}
    return {
        "journal": float(max(across[name] for name in JOURNALS)),
        "disc": float(across["disc"]),
        "rim": float(np.abs(apart["rim"][:, ALONG]).max()),
    }


def errors(motion: Motion, reference: Motion) -> dict[str, float]:
    """Return the largest distances from a reference at equal times, relative to the motion.

    ``journal``
        Orbits of both bearings, across the axis, over their largest displacement.
    ``disc``
        Orbit of the disc's middle, across the axis, over its largest displacement.
    ``rim``
        A node at the disc's rim, along the axis, over the same: how far the disc wobbles. Across
        the axis the node goes round with the spin, which is no deformation.
    ``total``
        The largest of these.
    """
    apart, size = distances(motion, reference), reference.size
    scale = size | {"rim": size["disc"]}
    found = {name: apart[name] / scale[name] for name in apart}
    return found | {"total": max(found.values())}


def front(rows: Iterable[Row]) -> list[Row]:
    """Return the rows that no other beats in both ``seconds`` and ``total``, cheapest first."""
    best, kept = np.inf, []
    for row in sorted(rows, key=lambda row: (row["seconds"], row["total"])):
        if row["total"] < best:
            best = row["total"]
            kept.append(row)
    return kept


def cheapest(rows: Iterable[Row], accuracy: float) -> Row | None:
    """Return the row of least ``seconds`` among those with ``total`` of at most `accuracy`."""
    enough = [row for row in rows if row["total"] <= accuracy]
    return min(enough, key=lambda row: row["seconds"], default=None)


def crossing(x: Sequence[float], y: Sequence[float], level: float) -> float:
    """Return where y(x), a line between points on logarithmic scales, first rises above `level`.

    Parameters
    ----------
    x, y : sequence of float
        Positive, x ascending.
    level : float

    Returns
    -------
    float
        Infinite if y stays at or below the level, zero if it starts above.
    """
    above = np.flatnonzero(np.asarray(y) > level)
    if not above.size:
        return np.inf
    i = int(above[0])
    if i == 0:
        return 0.0
    (x0, x1), (y0, y1) = np.log(x[i - 1 : i + 1]), np.log(y[i - 1 : i + 1])
    return float(np.exp(x0 + (np.log(level) - y0) / (y1 - y0) * (x1 - x0)))
