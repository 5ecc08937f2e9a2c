"""How far apart the exponents of two linear models are."""

import numpy as np

from exudyn_rotor.linear.over import motions_over


def exponents(model, speed, held=True):
    """Return exponents [1/s] of a model, one of each pair; a spin that nothing holds left out."""
    [found] = motions_over(model, [speed], held=held)
    return found.values


def apart(first, second, speed, held=True):
    """Return the largest distance of exponents, but for multiples of iΩ, relative to the speed.

    Of motions that do not decay much within a turn: elsewhere the states tell the film's Z(s) to
    1e-3 only, and rounding decides 1e-7 of it.
    """
    found, expected = exponents(first, speed, held), exponents(second, speed, held)
    slow = (expected.real > -0.3 * abs(speed)) & (np.abs(expected.real) > 1e-6 * abs(speed))
    turns = 1j * speed * np.arange(-2, 3)[:, None]
    both = np.r_[found, found.conj()]
    distances = [np.abs(both - s + turns).min() for s in expected[slow]]
    assert distances
    return max(distances) / abs(speed)


def distance(first, second, speed, held=True):
    """Return the largest distance of all exponents to the other set's, over the fastest."""
    sets = [exponents(model, speed, held) for model in (first, second)]
    sets = [np.r_[each, each.conj()] for each in sets]
    turns = 1j * speed * np.arange(-2, 3)[:, None, None]
    away = np.abs(sets[0][:, None] - sets[1] + turns).min(axis=0)
    return max(away.min(axis=0).max(), away.min(axis=1).max()) / np.abs(sets[1]).max()
