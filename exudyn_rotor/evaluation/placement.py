"""Unbalances that the standard asks for, by the shape of the mode that they excite.

Source: API RP 684, 2nd ed. (2005), standard paragraph SP6.8.2.7 with its figure; API 617 asks for
the same. The residual unbalance is 4 W/N oz in with W in lb and N in rpm, which is 6350 W/N g mm
with W in kg, held constant above 25 000 rpm; twice that is placed.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.linear.response.loads import Unbalance

_RESIDUAL = 6350e-6 * np.pi / 30.0  # U Ω / W [m/s]
_FASTEST = 25_000.0 * np.pi / 30.0  # [rad/s]

# how many unbalances a mode takes
MODES = {"translatory": 1, "first bending": 1, "overhung": 1, "conical": 2, "second bending": 2}


def standard_unbalances(
    mode: str,
    at: Sequence,
    masses: ArrayLike,
    speed: float,
    *,
    multiple: float = 2.0,
) -> tuple[Unbalance, ...]:
    """Return the unbalances that API RP 684 places to excite a mode.

    ===================================  =================================  ======================
    mode                                 where                              mass of the amount
    ===================================  =================================  ======================
    ``'translatory'``                    largest deflection, between        sum of both bearings'
                                         the bearings
    ``'first bending'``                  the same                           the same
    ``'conical'``                        two ends, opposite                 that of the next bearing
    ``'second bending'``                 two antinodes, opposite            that of the next bearing
    ``'overhung'``                       end of the overhang                what overhangs
    ===================================  =================================  ======================

    Parameters
    ----------
    mode : {'translatory', 'first bending', 'conical', 'second bending', 'overhung'}
    at : sequence of places
        One place or two: interface, node, or position; see :class:`Unbalance`.
    masses : float or array_like
        Masses [kg] that the amounts follow: static loads of the bearings over g, from
        :func:`bearing_loads`, or the mass of the overhang. Two for two places; of one place
        their sum counts.
    speed : float
        Maximum continuous speed [rad/s].
    multiple : float, optional
        Of the permissible residual unbalance ``6350 W/N`` g mm.

    Raises
    ------
    TypeError, ValueError
        For an unknown mode, another number of places or masses, or numbers that are not positive.

    Examples
    --------
    >>> from exudyn_rotor import standard_unbalances
    >>> [one] = standard_unbalances("translatory", ["disc"], [60.0, 40.0], speed=1000.0)
    >>> round(1e6 * one.amount, 1)  # g mm: 2 · 6350 · 100 / 9549
    133.0
    >>> [one.amount / two.amount for one, two in
    ...  [standard_unbalances("conical", ["left", "right"], [60.0, 40.0], 1000.0)]]
    [1.5]
    """
    count = MODES[checks.choice(mode, "mode", MODES)]
    places = checks.items([at] if isinstance(at, str) else at, "at", "places of the rotor")
    if len(places) != count:
        raise ValueError(f"at: the mode {mode!r} takes {count} place(s), got {checks.shown(at)}")
    if count == 2 and places[0] == places[1]:
        raise ValueError(f"at: the mode {mode!r} takes two places, got {places[0]!r} twice")
    weights = np.atleast_1d(checks.array(masses, "masses", "kg"))
    if weights.shape not in ((2,), (count,)) or np.any(weights <= 0.0):
        wanted = "one or two" if count == 1 else "two"
        raise ValueError(f"masses: needs {wanted} positive masses [kg], got {checks.shown(masses)}")
    speed = checks.number(speed, "speed", "rad/s", above=0.0)
    multiple = checks.number(multiple, "multiple", above=0.0)
    if count == 1:
        weights = weights.sum(keepdims=True)
    amounts = multiple * _RESIDUAL * weights / min(speed, _FASTEST)
    return tuple(
        Unbalance(place, float(amount), np.pi * number)
        for number, (place, amount) in enumerate(zip(places, amounts, strict=True))
    )
