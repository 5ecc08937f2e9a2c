"""Pairs of modes in two planes that an uneven mesh or shaft splits.

On isotropic supports a round rotor bends in all planes alike. An uneven one has two frequencies, in
two planes that turn with it, up to speeds that are small against their difference; above, its modes
whirl, as those of a round one.
"""

from __future__ import annotations

import numpy as np

from exudyn_rotor.linear.modal.resonance import CIRCULAR, PAIR
from exudyn_rotor.linear.modal.whirl import MIXED, WhirlContent


def pair_splits(
    content: WhirlContent,
    vectors: np.ndarray,
    orders: np.ndarray,
    frequencies: np.ndarray,
    codes: np.ndarray,
    diameters: np.ndarray,
) -> np.ndarray:
    """Return the relative distance to the other mode of each pair, shape (k,).

    Positive at the lower mode, negative at the upper one, 0 for single modes. Those of a pair are
    less than 1 % apart and planar, and combined they turn one way and the other.

    Parameters
    ----------
    content : WhirlContent
    vectors : ndarray, shape (h, c, k)
        Harmonics of the modes.
    orders : ndarray of int, shape (h,)
    frequencies, codes, diameters : ndarray, shape (k,)
        In the inertial frame [rad/s], whirl codes and nodal diameters of the modes.
    """
    splits = np.zeros(len(frequencies))
    planar = np.flatnonzero((codes == MIXED) & (diameters > 0) & (frequencies > 0.0))
    ascending = planar[np.argsort(frequencies[planar], kind="stable")]
    for place, lower in enumerate(ascending):
        if splits[lower]:
            continue
        for upper in ascending[place + 1 :]:
            split = frequencies[upper] / frequencies[lower] - 1.0
            if split > PAIR:
                break
            alike = diameters[lower] == diameters[upper] and not splits[upper]
            pair = vectors[:, :, [lower, upper]]
            if split > 0.0 and alike and _turn_both_ways(content, pair, orders):
                splits[lower], splits[upper] = split, -split / (1.0 + split)
                break
    return splits


def _turn_both_ways(content: WhirlContent, pair: np.ndarray, orders: np.ndarray) -> bool:
    """Return whether combinations of two motions turn one way each."""
    energy = content.energies(content.polarised(pair, orders))
    mean = np.einsum("o,hok->k", content.orders, energy)
    size = np.einsum("o,hok->k", np.abs(content.orders), energy)
    return bool(mean.min() < -CIRCULAR * size.min() and mean.max() > CIRCULAR * size.min() > 0.0)
