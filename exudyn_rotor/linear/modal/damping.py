"""Damping of motions, and which of them do not oscillate."""

from __future__ import annotations

import numpy as np

from exudyn_rotor.linear.periodic.floquet_modes import gone

# share of |λ| below which a frequency is that of critical damping
_NO_OSCILLATION = 1e-6


def oscillates(
    growth: np.ndarray, frequency: np.ndarray, resolution: float | np.ndarray = 0.0
) -> np.ndarray:
    """Return where motions oscillate in the inertial frame: neither overdamped nor free."""
    return frequency > np.maximum(_NO_OSCILLATION * np.abs(growth), resolution)


def decays_alone(growth: np.ndarray, nu: np.ndarray, speeds: np.ndarray) -> np.ndarray:
    """Return where motions of rates `growth` and `nu` in the rotor frame are over before it turns.

    Of these the frequency Ω that they would have seen from outside says nothing.
    """
    return ~oscillates(growth, nu) & gone(growth, speeds)


def damping_of(growth: np.ndarray, frequency: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return damping ratio and logarithmic decrement at inertial frequencies [rad/s].

    The ratio lies from −1 to 1. The decrement is NaN where a motion decays or grows without
    oscillating: at critical damping the root of the rounding is the least frequency that is one.
    """
    size = np.hypot(growth, frequency)
    still = ~oscillates(growth, frequency)
    ratio = np.where(still, -np.sign(growth), -growth / np.where(size > 0.0, size, 1.0))
    decrement = -2.0 * np.pi * growth / np.where(still, np.nan, frequency)
    return ratio + 0.0, np.where(growth == 0.0, 0.0, decrement) + 0.0
