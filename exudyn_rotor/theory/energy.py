"""Energy of a rotor in the inertial frame, for every formulation.

Kinetic energy with the mean translation τ, from the velocities ``τ̇ + A (ω ẽ r + Ψζ̇)``:

    T = ½ m τ̇² + τ̇ᵀA (Sζ̇ + ω (mχ* + S*ζ))
        + ½ ω² (Θ + 2hᵀζ + ζᵀĈζ) + ω (g + Wζ)ᵀζ̇ + ½ ζ̇ᵀM_ψψζ̇

less ``(3/2)ω⁴ζᵀK4ζ`` with a stiffness per ω⁴; its mass matrix is (41–43, 65, 84, 85); θ and τ may
be unknowns or prescribed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.motion import Motion


@dataclass(frozen=True)
class Energy:
    """Energy of a rotor at an instant [J].

    Attributes
    ----------
    kinetic : float
        In the inertial frame, the spin included.
    elastic : float
    weight : float
        Potential of the weight; zero where the rotor stands as in its mesh, undeformed, at θ = 0.
    """

    kinetic: float
    elastic: float
    weight: float


def energy_of(
    motion: Motion, t: float, q: ArrayLike, q_t: ArrayLike, gravity: ArrayLike | None = None
) -> Energy:
    """Return the energy of a motion.

    Parameters
    ----------
    motion : Motion
    t : float
        Time [s].
    q, q_t : array_like, shape (size,)
        Unknowns of `motion` and their rates.
    gravity : array_like, shape (3,), optional
        Inertial axes [m/s²]; that of the equations by default.

    Raises
    ------
    TypeError, ValueError
        For coordinates of a wrong number or kind.

    Examples
    --------
    A mass of 1 kg at x = 2 m, held by a spring, at 3 rad/s:

    >>> import numpy as np
    >>> from exudyn_rotor import Formulation, Invariants, Motion
    >>> from exudyn_rotor.theory.energy import energy_of
    >>> from exudyn_rotor.theory.stiffening import stiffening
    >>> unit = np.eye(3)
    >>> point = Invariants.of([[2.0, 0, 0]], unit, 9.0 * unit, None, unit, [0, 0, 1])
    >>> motion = Motion(point, Formulation("none", 3.0), stiffening(point, "none"))
    >>> energy_of(motion, 0.0, np.zeros(3), np.zeros(3))
    Energy(kinetic=18.0, elastic=0.0, weight=0.0)
    """
    checks.instance(motion, "motion", Motion)
    t = checks.number(t, "t", "s")
    q = checks.vector(q, "q", size=motion.size)
    q_t = checks.vector(q_t, "q_t", size=motion.size)
    g = motion.gravity if gravity is None else checks.vector(gravity, "gravity", "m/s²")
    inv, terms, form = motion.invariants, motion.spin_terms, motion.formulation
    zeta, zeta_t = q[motion.modes], q_t[motion.modes]
    spin = motion.translations.stop
    theta, omega = (
        (q[spin], q_t[spin]) if form.has_spin else (form.spin.value(t), form.spin.rate(t))
    )
    shift, rate = motion.free_directions @ q[motion.translations], np.zeros(3)
    if form.moves_origin:
        shift = np.asarray(form.translation.value(t), dtype=float)
        rate = np.asarray(form.translation.rate(t), dtype=float)
    else:
        rate = motion.free_directions @ q_t[motion.translations]
    A = motion.orientation @ SpinAxis(inv.direction).rotation(float(theta))
    unbalance = motion.static_unbalance + motion.S1 @ zeta
    # a frozen spin has the inertia of the undeformed rotor, so that its equations keep the sum
    bent = np.zeros_like(zeta) if form.has_frozen_spin else zeta
    inertia = inv.Theta + 2.0 * terms.h @ bent + bent @ (terms.C_hat @ bent)
    kinetic = (
        0.5 * inv.mass * rate @ rate
        + rate @ A @ (inv.S @ zeta_t + omega * unbalance)
        + 0.5 * omega**2 * inertia
        + omega * (terms.g + terms.W @ bent) @ zeta_t
        + 0.5 * zeta_t @ (inv.M @ zeta_t)
    )
    if terms.K4 is not None and not form.has_frozen_spin:
        kinetic -= 1.5 * omega**4 * zeta @ (terms.K4 @ zeta)
    moved = inv.mass * (shift + (A - motion.orientation) @ inv.center) + A @ (inv.S @ zeta)
    return Energy(float(kinetic), float(0.5 * zeta @ (inv.K @ zeta)), float(-g @ moved))
