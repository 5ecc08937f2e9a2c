"""How large the factor of a stiffness matrix will be, before it is computed.

Nodes are taken apart by nested dissection: a plane cuts a part in two, the nodes next to it form
a separator, and so on. Elimination from the smallest parts up leaves dense columns of a
separator, over itself and over the earlier separators that its part touches. A fill-reducing
ordering needs about as much.

Source: George, "Nested dissection of a regular finite element mesh", SIAM J. Numer. Anal. 10
(1973).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

# nodes that are not taken apart further
_SMALLEST = 30
# places of the planes, in shares of a part's nodes, and how much equal halves count
_SHARES = (0.5, 0.3, 0.7, 0.15, 0.85)
_BALANCE = 0.67
_CUT, _DONE = -1, -2


class Fill(NamedTuple):
    """Entries of a Cholesky factor, and multiplications to compute it."""

    entries: float
    operations: float


def estimated_fill(matrix: sp.csr_array, nodes: np.ndarray) -> Fill:
    """Return what the factor of a matrix of solid elements will have.

    Parameters
    ----------
    matrix : scipy.sparse.csr_array, shape (3n, 3n)
    nodes : ndarray, shape (n, 3)
        Node positions; any unit.
    """
    first, second = _edges(matrix, len(nodes))
    part = np.zeros(len(nodes), dtype=np.int64)
    entries = operations = 0.0
    count = 1
    while count:
        border = _borders(part, first, second, count)
        sizes = np.bincount(part[part >= 0], minlength=count)
        small = sizes <= _SMALLEST
        side = _best_sides(part, nodes, first, second, count)
        cut = _next_to_cut(part, side, first, second)
        own = np.where(small, sizes, np.bincount(part[cut], minlength=count))
        entries += np.sum(4.5 * own * (own + 2 * border))
        operations += 27.0 * np.sum(own**3 / 3 + own**2 * border + own * border**2)
        finished = (part >= 0) & small[np.maximum(part, 0)]
        part = np.where(part >= 0, 2 * part + side, part)
        part[cut] = _CUT
        part[finished] = _DONE
        used = np.unique(part[part >= 0])
        part[part >= 0] = np.searchsorted(used, part[part >= 0])
        count = len(used)
        needed = (part[first] >= 0) & (part[second] != _DONE)
        first, second = first[needed], second[needed]
    return Fill(float(entries), float(operations))


def _edges(matrix: sp.csr_array, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the pairs of nodes that the matrix couples, both ways."""
    length = np.diff(matrix.indptr)[::3]
    starts = np.repeat(matrix.indptr[:-1:3], length)
    offset = np.arange(starts.size) - np.repeat(np.cumsum(length) - length, length)
    columns = matrix.indices[starts + offset]
    first, second = np.repeat(np.arange(count), length), columns // 3
    kept = (first != second) & (columns % 3 == 0)
    return first[kept], second[kept]


def _borders(part, first, second, count: int) -> np.ndarray:
    """Return how many nodes of earlier separators each part touches."""
    touching = (part[first] >= 0) & (part[second] == _CUT)
    pairs = np.unique(part[first[touching]] * len(part) + second[touching])
    return np.bincount(pairs // len(part), minlength=count)


def _best_sides(part, nodes, first, second, count: int) -> np.ndarray:
    """Return the side (n,) of every node of the best of some planes across x, y and z.

    A plane is good that touches few nodes and does not leave too small a part.
    """
    active = np.flatnonzero(part >= 0)
    sizes = np.bincount(part[active], minlength=count)
    starts = np.cumsum(sizes) - sizes
    best, lowest = np.zeros(len(part), dtype=np.int64), np.full(count, np.inf)
    for axis in range(3):
        order = active[np.lexsort((nodes[active, axis], part[active]))]
        rank = np.arange(order.size) - starts[part[order]]
        for share in _SHARES:
            side = np.zeros(len(part), dtype=np.int64)
            side[order] = rank >= share * sizes[part[order]]
            cut = np.bincount(part[_next_to_cut(part, side, first, second)], minlength=count)
            score = (cut + 1) / min(share, 1.0 - share) ** _BALANCE
            better = score < lowest
            chosen = active[better[part[active]]]
            best[chosen] = side[chosen]
            lowest = np.where(better, score, lowest)
    return best


def _next_to_cut(part, side, first, second) -> np.ndarray:
    """Return the nodes on side 0 that touch side 1 of their part."""
    across = (part[first] == part[second]) & (part[first] >= 0)
    across &= (side[first] == 0) & (side[second] == 1)
    touching = np.zeros(len(part), dtype=bool)
    touching[first[across]] = True
    return np.flatnonzero(touching)
