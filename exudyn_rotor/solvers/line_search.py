"""How far along a step of Newton's method the forces of a potential do work.

With the unbalanced forces r and the step Δ the share s is sought at which |Δ·r(y + sΔ)| is below a
share of its size at s = 0; M. A. Crisfield, *Non-linear Finite Element Analysis of Solids and
Structures* 1 (1991), Sect. 9.2. Of convex potentials, as contact and springs have, Newton's method
so finds the minimum from anywhere.
"""

from __future__ import annotations

from collections.abc import Callable

_MOST_CUTS = 40
_LEFT = 0.5  # share of the work along a step that may be left


def step_share(slope: Callable[[float], float]) -> float:
    """Return the share of a step to go, by bisection.

    `slope` is that of the potential along the step, by the share of it: below zero at its
    beginning, unless the forces have no potential, and then the whole step is taken.
    """
    first, low, high = slope(0.0), 0.0, 1.0
    if first >= 0.0 or slope(high) <= _LEFT * abs(first):
        return 1.0
    for _ in range(_MOST_CUTS):
        share = 0.5 * (low + high)
        found = slope(share)
        if abs(found) <= _LEFT * abs(first):
            break
        low, high = (share, high) if found < 0.0 else (low, share)
    return share
