"""Unbalance until small deformations are small no longer."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from exudyn_rotor import Support, unbalance_response
from validation.extremes.rotors import two_rings
from validation.extremes.rows import Row, breaking_point

SPEED, TILT = 200.0, 2e3  # rad/s, N m/rad
RADIUS, HALF_LENGTH, MASS = 0.1, 0.06, 2.0  # of the two rings


def linear_tilt(share: float) -> float:
    """Return the steady tilt of the package's linear equations [rad].

    A `share` of two masses of each ring is exchanged crosswise: the centre of mass stays, and the
    product of inertia grows in proportion.
    """
    rotor = two_rings(MASS, RADIUS, HALF_LENGTH, unbalance=share).reduce(0)
    support = Support("all", np.diag([1e6] * 3), tilt_stiffness=TILT)
    motion = unbalance_response(rotor, [SPEED], supports=[support], frame="rotor").motion
    return float(np.linalg.norm(motion[0, 0, :, 3:5]))


def exact_tilt(share: float) -> float:
    """Return the steady tilt φ of the same body by exact rotation [rad].

    The moment of inertia about the spin axis is ``I(φ) = I_p cos²φ + I_t sin²φ + P sin 2φ``, with
    P the product of inertia, and ``k φ = ½ Ω² dI/dφ``.
    """
    polar, transverse = MASS * RADIUS**2, MASS * (RADIUS**2 / 2 + HALF_LENGTH**2)
    product = 4.0 * share * MASS / 8 * RADIUS * HALF_LENGTH

    def balance(tilt: float) -> float:
        slope = (transverse - polar) * np.sin(2 * tilt) + 2.0 * product * np.cos(2 * tilt)
        return TILT * tilt - 0.5 * SPEED**2 * slope

    return brentq(balance, 0.0, 1.0, xtol=1e-15, rtol=1e-14)


def deviation(share: float) -> float:
    """Return the relative deviation of the linear from the exact tilt."""
    return abs(linear_tilt(share) / exact_tilt(share) - 1.0)


def limit_of_small_tilts(quick: bool = False) -> Row:
    """Tilt a rigid rotor ever more by its own dynamic unbalance."""
    shares = np.array([0.02, 0.2])
    tilts = np.array([exact_tilt(share) for share in shares])
    order = np.diff(np.log([deviation(share) for share in shares])) / np.diff(np.log(tilts))
    largest = breaking_point(lambda share: deviation(share) < 0.01, 1e-3, 0.999)
    return Row(
        "large unbalance, steady tilt",
        f"tilts of {tilts[0]:.2g} to {exact_tilt(0.999):.2g} rad",
        "order of the deviation from exact rotation, less 2; limit: the next order, 10 × squared "
        "tilt",
        abs(order[0] - 2.0),
        10.0 * tilts[-1] ** 2,
        f"1 % at {exact_tilt(largest):.3g} rad",
        "physics",
        "README: small tilts; check_run: 'tilt'",
    )
