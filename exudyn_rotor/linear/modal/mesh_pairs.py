"""Pairs of modes in two planes that an uneven mesh or an asymmetric shaft splits.

On isotropic supports a round rotor bends in all planes alike. Any other has two frequencies, in two
planes that turn with it, up to speeds that are small against their difference; above, its modes
whirl, as those of a round one.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exudyn_rotor.linear.modal.resonance import PAIR
from exudyn_rotor.linear.modal.whirl import MIXED, WhirlContent


def pair_splits(
    content: WhirlContent,
    vectors: Sequence[np.ndarray],
    frequencies: np.ndarray,
    codes: np.ndarray,
    diameters: np.ndarray,
) -> np.ndarray:
    """Return the relative distance to the other mode of each pair at each speed, shape (s, k).

    Positive at the lower mode, negative at the upper one, 0 for single modes. Those of a pair are
    less than 1 % apart and planar, and combined they turn one way and the other.

    Parameters
    ----------
    content : WhirlContent
    vectors : sequence of ndarray, each (c, k)
        Modes of equations that do not change in time, one array for each speed.
    frequencies, codes, diameters : ndarray, shape (s, k)
        In the inertial frame [rad/s], whirl codes and nodal diameters of the modes.
    """
    splits, lower = np.zeros(frequencies.shape), frequencies[:, :, None]
    apart = frequencies[:, None, :] - lower
    planar = np.where((codes == MIXED) & (frequencies > 0.0), diameters, 0)
    alike = (planar[:, :, None] == planar[:, None, :]) & (planar > 0)[:, :, None]
    places = np.nonzero((apart > 0.0) & (apart <= PAIR * lower) & alike)
    places = np.transpose(places)[np.lexsort((apart[places], frequencies[places[:2]], places[0]))]
    if not places.size:
        return splits
    sides = (
        np.stack([vectors[place[0]][:, place[side]] for place in places], axis=1)[None]
        for side in (1, 2)
    )
    for row, low, high in places[content.turn_both_ways(*sides, np.array([0]))]:
        if splits[row, low] == splits[row, high] == 0.0:
            split = frequencies[row, high] / frequencies[row, low] - 1.0
            splits[row, [low, high]] = split, -split / (1.0 + split)
    return splits
