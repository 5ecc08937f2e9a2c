"""Annular seal of a pump: turbulent leakage through a short plain gap, in closed form.

Bulk flow with the mean axial velocity V, a friction coefficient λ that the small motion does not
change, and the loss coefficient ξ at the inlet. With ``σ = λ L/c`` the pressure drop is

    Δp = ½ ρ V² (1 + ξ + 2σ).                                                              (1)

The leakage turns at half of the spin speed, so that in axes that turn with it, and with
``T = L/V``, z = x + iy, the force on the rotor to second order in the frequency is

    F = −(π R Δp/λ) [μ_0 + μ_1 T d + μ_2 T² d²] z,   d = d/dt − iΩ/2                       (2)

This is the theory of H. F. Black, D. N. Jenssen, Proc. IMechE 184 (1970), and D. W. Childs,
*Turbomachinery Rotordynamics* (1993), Ch. 4; the coefficients are integrated anew, which gives
4/3 ξ in μ_1 where reprints of the formula have 2 ξ. λ is that of Y. Yamada, Bull. JSME 5 (1962),

    λ = 0.079 Ra^{−1/4} [1 + (7 Rc/8 Ra)²]^{3/8},   Ra = 2 ρVc/η,   Rc = ρRΩc/η.           (3)

Limits: centred, L well below the diameter (no flow around), turbulent (Ra above some 2000), smooth,
inlet swirl of half of the speed.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from functools import lru_cache
from math import pi
from typing import ClassVar

import numpy as np
from scipy.optimize import brentq

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import Bearing, Force, Pair, check_clearance
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.calls import user_level

_TURBULENT = 2000.0  # Reynolds number Ra, below which a leakage without spin may be laminar
_LEAST = 1e-15  # of the axial velocity without friction: no leakage is so slow


@dataclass(frozen=True, eq=False, kw_only=True)
class AnnularSeal(Bearing):
    """Plain annular seal with turbulent leakage (2), for small motions about the centre.

    Scenes and linear analyses take stiffness and damping, and the inertia of the leakage, that of
    :meth:`added_mass`.

    Parameters
    ----------
    interface : str
        Interface of the rotor that turns in the seal.
    radius, length : float
        Of the gap [m].
    clearance : float
        Radial clearance [m].
    pressure_drop : float
        Δp [Pa].
    density : float
        ρ [kg/m³].
    viscosity : float
        Dynamic viscosity η [Pa s].
    inlet_loss : float, optional
        ξ; 0.1 by default.
    load : array_like, shape (2,), optional
        Of no influence.

    Raises
    ------
    TypeError, ValueError
        For sizes and properties that are not above zero, and a clearance as large as the radius.

    Warns
    -----
    UserWarning
        Where the leakage is so slow, or so viscous, that (3) may not hold: Ra below 2000 at rest.

    Examples
    --------
    >>> from exudyn_rotor import AnnularSeal
    >>> seal = AnnularSeal(
    ...     interface="disc", radius=0.1, length=0.04, clearance=3e-4, pressure_drop=1e6,
    ...     density=1000.0, viscosity=1e-3,
    ... )
    >>> stiffness, damping = seal.coefficients(speed=300.0)
    >>> print((1e-6 * stiffness).round(2))
    [[ 4.62  2.96]
     [-2.96  4.62]]
    """

    carries: ClassVar[bool] = False
    _unloaded: ClassVar[bool] = True

    radius: float
    length: float
    clearance: float
    pressure_drop: float
    density: float
    viscosity: float
    inlet_loss: float = 0.1

    def __post_init__(self) -> None:
        super().__post_init__()
        units = {"radius": "m", "length": "m", "clearance": "m", "pressure_drop": "Pa"}
        checks.keep_numbers(self, units | {"density": "kg/m³", "viscosity": "Pa s"}, above=0.0)
        checks.keep_numbers(self, {"inlet_loss": ""}, least=0.0)
        check_clearance(self.clearance, self.radius)
        reynolds = self._relative * 2.0 * self.axial_velocity(0.0)
        if reynolds < _TURBULENT:
            warnings.warn(
                f"AnnularSeal: the friction is that of a turbulent leakage, whose Reynolds number "
                f"is {reynolds:.3g} here; below {_TURBULENT:g} the leakage may be laminar, with "
                "other coefficients: take measured or computed ones, in a Support",
                stacklevel=user_level(),
            )

    @property
    def _relative(self) -> float:
        """Reynolds number of a flow over the clearance, for each m/s of its velocity."""
        return self.density * self.clearance / self.viscosity

    def axial_velocity(self, speed: float) -> float:
        """Return the mean velocity V of the leakage [m/s], by (1) and (3).

        Raises
        ------
        TypeError, ValueError
        """
        checks.number(speed, "speed", "rad/s")
        free = np.sqrt(2.0 * self.pressure_drop / self.density)

        def left(share: float) -> float:
            velocity = share * free
            friction = self._friction(velocity, speed) * self.length / self.clearance
            return share**2 * (1.0 + self.inlet_loss + 2.0 * friction) - 1.0

        return free * brentq(left, _LEAST, 1.0, xtol=_LEAST**2, rtol=1e-14)

    def _friction(self, velocity: float, speed: float) -> float:
        """Return λ by (3)."""
        axial, around = (self._relative * v for v in (2.0 * velocity, self.radius * abs(speed)))
        return 0.079 * axial**-0.25 * (1.0 + (7.0 * around / (8.0 * axial)) ** 2) ** 0.375

    def _terms(self, speed: float) -> tuple[float, float, float]:
        """Return what (2) multiplies z, d z and d² z by: [N/m], [N s/m], [kg]."""
        velocity, xi = self.axial_velocity(speed), self.inlet_loss
        friction, f = self._friction(velocity, speed), 1.0 + xi
        s = friction * self.length / self.clearance
        n, time = f + 2.0 * s, self.length / velocity
        mu_0 = f * s**2 / n**2
        mu_1 = f**2 * s + f * (7.0 + 4.0 * xi) / 3.0 * s**2 + 10.0 / 3.0 * f * s**3
        mu_2 = f**2 * (2.0 * xi - 1.0) / 3.0 * s + f * (1.0 + 2.0 * xi) * s**2 + 2.0 * f * s**3
        last = 4.0 / 3.0 * s**4
        size = pi * self.radius * self.pressure_drop / friction
        return (
            size * mu_0,
            size * time * (mu_1 + last) / n**3,
            size * time**2 * (mu_2 + last) / n**4,
        )

    def added_mass(self, speed: float) -> float:
        """Return the inertia of the leakage, alike in all directions [kg].

        Raises
        ------
        TypeError, ValueError
        """
        return _of_leakage(self, checks.number(speed, "speed", "rad/s"))[2]

    def linearised(self) -> Support:
        """Return the support for linear analyses, with the inertia of the leakage."""
        return replace(super().linearised(), mass=self.added_mass)

    def _matrices(self, speed: float, load: np.ndarray) -> Pair:
        """Return stiffness and damping of (2), without its inertia."""
        return _of_leakage(self, float(speed))[:2]

    def clearance_along(self, direction: np.ndarray | None = None) -> float:
        """Return the clearance [m], which is the same in all directions."""
        return self.clearance

    def law(self, x: float, y: float, vx: float, vy: float, angle: float, speed: float) -> Force:
        """Return the force on the journal but for its inertia [N]."""
        K, D, _ = _of_leakage(self, speed)
        (k, c), (d, g) = K[0].tolist(), D[0].tolist()  # alike in all directions
        return -k * x - c * y - d * vx - g * vy, c * x - k * y + g * vx - d * vy

    def slopes(self, x: float, y: float, vx: float, vy: float, angle: float, speed: float) -> Pair:
        """Return less the derivatives (2, 2) of :meth:`law` by place and by velocity."""
        return _of_leakage(self, speed)[:2]


@lru_cache(maxsize=64)
def _of_leakage(seal: AnnularSeal, speed: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Return stiffness, damping and mass; one speed is asked for at many instants."""
    k, d, m = seal._terms(speed)
    turn, half = np.array([[0.0, 1.0], [-1.0, 0.0]]), 0.5 * speed
    stiffness = (k - half**2 * m) * np.eye(2) + half * d * turn
    damping = d * np.eye(2) + 2.0 * half * m * turn
    return checks.read_only(stiffness), checks.read_only(damping), m
