"""A centre of mass off the spin axis: what linear analyses neglect, and a warning of it."""

from __future__ import annotations

import warnings

import numpy as np

from exudyn_rotor.callers import user_level
from exudyn_rotor.linear.models.rotor.spin import Spin
from exudyn_rotor.theory.invariants import Invariants, inertia_tensor, inverse_inertia

_ECCENTRIC = 1e-3  # relative error of frequencies that is worth a warning
_BALANCED = 1e-13  # rounding leaves this much of the unbalance of a perfectly balanced mesh


def warn_of_eccentricity(invariants: Invariants, spin: Spin) -> None:
    """Tell that spin and lateral motion are coupled where they are taken for decoupled."""
    distance = float(np.linalg.norm(invariants.center))
    error, band = without_drive(invariants)
    tilts = tilts_without_drive(invariants) if spin.free else 0.0
    if error + tilts <= _ECCENTRIC:
        return
    found = []
    if error > tilts:
        found.append(f"the centre of mass is {distance:.4g} m off the spin axis")
    if tilts > 0.1 * error:
        angle = _skewness(invariants)
        found.append(f"the nearest principal axis is {angle:.2g} rad off the spin axis")
    near = (
        ", near a critical speed by m r²/Θ with the whirl radius r of the centre of mass, and the "
        f"rotor is unstable up to about {band:.0%} above it"
    )
    what = (
        "a load and decouple spin and lateral motion, as for a rotor driven at constant speed. "
        f"Without a drive, frequencies differ by about {error + tilts:.1%} at rest"
        f"{near if error > tilts else ''}; balance the rotor"
    )
    if spin.coupled:
        what = (
            "a load. Its spin on springs is complete, but tilts lack the stiffness by the springs' "
            "steady forces; hold a blade by rotor.clamped(…) instead"
        )
    warnings.warn(
        f"{', and '.join(found)}; linear analyses take this as " + what,
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


def tilts_without_drive(invariants: Invariants) -> float:
    """Return the relative change of a tilt's frequency at rest by a spin that nothing drives.

    A tilt with the moment of inertia ``I_t`` turns a free rotor by the product of inertia J, and
    ``J²/Θ`` of its inertia is lost: ``½ J²/(I_t Θ)``.
    """
    e = invariants.direction
    resisted, alone = e @ inertia_tensor(invariants) @ e, e @ inverse_inertia(invariants) @ e
    return 0.5 * max(1.0 - 1.0 / (resisted * alone), 0.0) if resisted * alone > 0.0 else 0.0


def _skewness(invariants: Invariants) -> float:
    """Return the angle between the spin axis and the nearest principal axis [rad]."""
    _, axes = np.linalg.eigh(inertia_tensor(invariants))
    return float(np.arccos(min(np.abs(invariants.direction @ axes).max(), 1.0)))


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
