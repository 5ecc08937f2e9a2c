"""A centre of mass off the spin axis: what linear analyses neglect, and a warning of it."""

from __future__ import annotations

import warnings

import numpy as np

from exudyn_rotor.callers import user_level
from exudyn_rotor.linear.models.rotor.spin import Spin
from exudyn_rotor.theory.invariants import Invariants

_ECCENTRIC = 1e-3  # relative error of frequencies that is worth a warning
_BALANCED = 1e-13  # rounding leaves this much of the unbalance of a perfectly balanced mesh


def warn_of_eccentricity(invariants: Invariants, spin: Spin) -> None:
    """Tell that spin and lateral motion are coupled where they are taken for decoupled."""
    distance = float(np.linalg.norm(invariants.center))
    error, band = without_drive(invariants)
    if error <= _ECCENTRIC:
        return
    what = (
        "a load and decouple spin and lateral motion, as for a rotor driven at constant speed. "
        f"Without a drive, frequencies differ by about {error:.1%} at rest, near a critical speed "
        "by m r²/Θ with the whirl radius r of the centre of mass, and the rotor is unstable up to "
        f"about {band:.0%} above it; balance the rotor"
    )
    if spin.coupled:
        what = (
            "a load. Its spin on springs is complete, but tilts lack the stiffness by the springs' "
            "steady forces; hold a blade by rotor.clamped(…) instead"
        )
    warnings.warn(
        f"the centre of mass is {distance:.4g} m off the spin axis; linear analyses take this as "
        + what,
        UserWarning,
        stacklevel=user_level(),
    )


def without_drive(invariants: Invariants) -> tuple[float, float]:
    """Return how far an eccentric rotor that nothing drives is from one at constant speed.

    The change of frequencies at rest, and the width of the unstable speeds above a critical speed,
    both relative: ``ε/2`` and ``(ε/2)^⅓`` with ``ε = m e²/Θ``, those of a Jeffcott rotor for small
    ε. Towards the critical speed the first grows as ``m r²/Θ``, r the whirl radius of the centre of
    mass.
    """
    inertia = invariants.mass * float(invariants.center @ invariants.center)
    error = 0.5 * inertia / invariants.Theta if inertia > 0.0 else 0.0
    return error, error ** (1.0 / 3.0)


def decoupling(invariants: Invariants) -> float:
    """Return which share of rates errs where spin and lateral motion are taken for decoupled.

    ``(J/Θ)² + m e²/Θ``, with the product of inertia J and the eccentricity e. By as much of Ω, and
    of the decay that dampers bring, a motion drifts that stands still in space, tilted or moved.
    """
    inv = invariants
    across = np.eye(3) - np.outer(inv.direction, inv.direction)
    couple, offset = across @ inv.J @ inv.direction, across @ inv.center
    return float(couple @ couple / inv.Theta**2 + inv.mass * (offset @ offset) / inv.Theta)


def is_balanced(invariants: Invariants) -> bool:
    """True where centre of mass and principal axis are on the spin axis but for rounding."""
    inv = invariants
    across = np.eye(3) - np.outer(inv.direction, inv.direction)
    static, couple = inv.mass * across @ inv.center, across @ inv.J @ inv.direction
    second = np.trace(inv.J)
    size = np.sqrt(second / inv.mass)
    return bool(np.linalg.norm(static) * size + np.linalg.norm(couple) <= _BALANCED * second)
