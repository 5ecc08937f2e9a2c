"""Repeated modes, whose shapes are arbitrary, as waves that turn one way each."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from exudyn_rotor.linear.periodic.eigenvalues import repeated
from exudyn_rotor.linear.periodic.floquet_modes import FloquetModes

_MOST_ENTRIES = 1_000_000  # of the vectors that are turned at once

Polarised = Callable[[np.ndarray, np.ndarray], np.ndarray]
Places = list[tuple[int, np.ndarray]]  # entry and columns


def as_waves(modes: Sequence[FloquetModes], polarised: Polarised) -> list[np.ndarray]:
    """Return vectors (h, c, k) with Im λ ≥ 0, repeated modes as waves of one sense.

    `polarised` takes vectors (n, h, c, g), those of one eigenvalue in each of n groups, and orders.
    """
    result, alike = [], {}
    for index, entry in enumerate(modes):
        vectors = entry.vectors.astype(complex)
        negative, halves = entry.values.imag < 0.0, [np.arange(len(entry.values))]
        if np.any(negative):
            vectors[:, :, negative] = vectors[::-1][:, :, negative].conj()
            halves = [np.flatnonzero(~negative), np.flatnonzero(negative)]
        for half in halves:
            for group in _copies(entry.values[half], entry.resolution):
                known = alike.setdefault((group.size, entry.orders.tobytes()), [])
                _add(known, vectors[:, :, half[group]], (index, half[group]))
        result.append(vectors)
    for known in alike.values():
        at_once = max(1, _MOST_ENTRIES // known[0][0].size)
        for start in range(0, len(known), at_once):
            groups, places = zip(*known[start : start + at_once], strict=True)
            orders = modes[places[0][0][0]].orders
            for turned, each in zip(polarised(np.stack(groups), orders), places, strict=True):
                for index, columns in each:
                    result[index][:, :, columns] = turned
    return result


def _add(known: list[tuple[np.ndarray, Places]], group: np.ndarray, place: tuple) -> None:
    """Add a group and its place; only the place where it is the last one again.

    Free motions may be the same at all speeds.
    """
    if known and np.array_equal(known[-1][0], group):
        known[-1][1].append(place)
    else:
        known.append((group, [place]))


def _copies(values: np.ndarray, resolution: float) -> Iterator[np.ndarray]:
    """Yield the indices of values that are one; of zero only what rounding has made of it."""
    for group in repeated(values, resolution):
        zero = values[group] == 0.0
        yield from (part for part in (group[zero], group[~zero]) if part.size > 1)
