"""Motions whose exponents are near those of copies of others, with the harmonics of these copies.

Two motions with exponents that are nearly one but for a multiple of the base, ``λ₁ ≈ λ₂ + i n pΩ``,
have a share of each other's copies, and the larger the nearer these are. A truncation that has all
harmonics of both may lack those of the copy, n p farther out, and what the first harmonics left out
answer does not tell: they are no part of the resonance.
"""

from __future__ import annotations

import numpy as np

from exudyn_rotor.linear.periodic.hill import MOST_UNKNOWNS, differ, in_larger
from exudyn_rotor.linear.periodic.hill_motions import HillMotions
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem

_NEAR = 1e-2  # of the base: distance of exponents
_PART = 1e-8  # of a motion, that a harmonic has to have


def with_near_copies(system: PeriodicSystem, motions: HillMotions) -> HillMotions | None:
    """Return motions with the harmonics of copies of others that are near.

    None where they have these, or it takes more than 1600 unknowns, or one of them is lost.
    """
    base, every = system.base, motions.with_conjugates()
    apart = motions.values[:, None] - every.values
    steps = np.rint(apart.imag / base).astype(int)
    near = np.abs(apart - 1j * steps * base) <= _NEAR * abs(base)
    np.fill_diagonal(near, False)
    sizes = np.linalg.norm(every.shapes, axis=1)
    outermost = np.abs(motions.orders[:, None]) * (sizes > _PART * np.linalg.norm(sizes, axis=0))
    highest = np.max(np.where(near, np.abs(steps) * system.step + outermost.max(axis=0), 0), axis=1)
    lacking = np.flatnonzero(highest > 0)
    orders = system.harmonics(int(highest.max(initial=0)))
    if len(orders) <= len(motions.orders) or 2 * len(orders) * system.size > MOST_UNKNOWNS:
        return None
    larger = in_larger(system, motions, lacking, orders)
    return larger if larger is not None and differ(larger, lacking, base) else None
