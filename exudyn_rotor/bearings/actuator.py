"""Actuators of magnetic bearings: the force of one control axis by its current and the place.

Linear about the centre (1), or of two opposite magnets (2), driven in differential mode with the
bias current i_0, ``k = ¼ μ_0 N² A cos α`` of N turns, the pole area A and the angle α between pole
and axis: in the centre the derivatives are ``K_i = 4 k i_0/s_0²`` and ``K_s = 4 k i_0²/s_0³``.
G. Schweitzer, E. H. Maslen (eds.), *Magnetic Bearings* (Springer, 2009), Sect. 4.1. Iron that
saturates magnetically, hysteresis, eddy currents and leakage are left out: a limit of the current
stands for the first. The voltage that limits the rate of the current is left out, too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from exudyn_rotor import checks

_LEAST_GAP = 0.05  # of the gap in the centre: the magnets do not come closer
_TRIED = 200  # places or currents, between which an equilibrium is looked for


@dataclass(frozen=True)
class LinearActuator:
    """Actuator ``F = K_i i + K_s x`` (1) of a control axis.

    Parameters
    ----------
    force_current : float
        K_i [N/A], above zero.
    negative_stiffness : float
        K_s [N/m], zero or above: a displacement is pulled further.

    Raises
    ------
    TypeError, ValueError

    Examples
    --------
    >>> from exudyn_rotor import LinearActuator
    >>> LinearActuator(force_current=80.0, negative_stiffness=3e5).law(1.0, 1e-4)
    110.0
    """

    force_current: float
    negative_stiffness: float

    def __post_init__(self) -> None:
        checks.keep_numbers(self, {"force_current": "N/A"}, above=0.0)
        checks.keep_numbers(self, {"negative_stiffness": "N/m"}, least=0.0)

    def law(self, current: float, place: float) -> float:
        """Return the force (1) [N] by current [A] and place [m], unchecked."""
        return self.force_current * current + self.negative_stiffness * place

    def slopes(self, current: float, place: float) -> tuple[float, float]:
        """Return the derivatives of (1) by current [N/A] and place [N/m]: K_i and K_s."""
        return self.force_current, self.negative_stiffness

    def _carrying(self, load: float, current: float, place: float) -> float:
        """Return s with ``F(s current, s place) + load = 0``."""
        return -load / self.law(current, place)


@dataclass(frozen=True)
class SaturatingActuator:
    """Two opposite magnets (2) of a control axis.

    ``F = k (I₊²/(s_0 − x)² − I₋²/(s_0 + x)²)``, ``I± = i_0 ± i`` between 0 and the limit.

    Parameters
    ----------
    constant : float
        k [N m²/A²].
    bias_current : float
        i_0 [A].
    gap : float
        Air gap s_0 in the centre [m]. In the law, no gap gets smaller than a twentieth of it: a
        back-up bearing (:class:`ClearanceStop`) holds the rotor off. A run stops with an error
        where a rotor without one has moved by the gap.
    current_limit : float
        Largest current of a magnet [A], above the bias.

    Raises
    ------
    TypeError, ValueError

    Examples
    --------
    >>> from exudyn_rotor import SaturatingActuator
    >>> magnets = SaturatingActuator(
    ...     constant=1e-5, bias_current=2.0, gap=4e-4, current_limit=6.0
    ... )
    >>> print(round(magnets.force_current), round(magnets.negative_stiffness))
    500 2500000
    >>> round(magnets.law(2.0, 0.0)), round(magnets.law(9.0, 0.0))  # the latter at the limit
    (1000, 2250)
    """

    constant: float
    bias_current: float
    gap: float
    current_limit: float

    def __post_init__(self) -> None:
        units = {"constant": "N m²/A²", "bias_current": "A", "gap": "m"}
        checks.keep_numbers(self, units, above=0.0)
        checks.keep_numbers(self, {"current_limit": "A"}, above=self.bias_current)

    @property
    def force_current(self) -> float:
        """K_i in the centre [N/A]."""
        return 4.0 * self.constant * self.bias_current / self.gap**2

    @property
    def negative_stiffness(self) -> float:
        """K_s in the centre [N/m]."""
        return 4.0 * self.constant * self.bias_current**2 / self.gap**3

    def law(self, current: float, place: float) -> float:
        """Return the force (2) [N] by current [A] and place [m], unchecked."""
        (pull, near), (push, far) = self._magnets(current, place)
        return self.constant * ((pull / near) ** 2 - (push / far) ** 2)

    def slopes(self, current: float, place: float) -> tuple[float, float]:
        """Return the derivatives of (2) by current [N/A] and place [N/m].

        That by the current is zero of a magnet without current, or at its limit.
        """
        magnets = self._magnets(current, place)
        by_current = [i / gap**2 for i, gap in magnets if 0.0 < i < self.current_limit]
        by_place = [i**2 / gap**3 for i, gap in magnets]
        return 2.0 * self.constant * sum(by_current), 2.0 * self.constant * sum(by_place)

    def _carrying(self, load: float, current: float, place: float) -> float:
        """Return s, next to 0, with ``F(s current, s place) + load = 0``, for a current below 0."""

        def left(s: float) -> float:
            return load + self.law(s * current, s * place)

        side = 1.0 if load >= 0.0 else -1.0
        reach = (1.0 - _LEAST_GAP) * self.gap if place else self.current_limit
        tried = side * reach * np.linspace(0.0, 1.0, _TRIED)
        spare = np.array([-side * left(s) for s in tried])
        if not np.any(spare > 0.0):
            raise ValueError(
                f"load: a control axis of these magnets carries {abs(load) + spare.max():.4g} N, "
                f"not {abs(load):.4g} N; give a larger current_limit"
                + (", or an integral" if place else "")
            )
        first = int(np.argmax(spare > 0.0))
        return brentq(left, tried[first - 1], tried[first], xtol=1e-15, rtol=1e-14)

    def _magnets(
        self, current: float, place: float
    ) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return current [A] and air gap [m] of the magnets on the positive and negative side."""
        bias, limit, least = self.bias_current, self.current_limit, _LEAST_GAP * self.gap
        return (
            (min(max(bias + current, 0.0), limit), max(self.gap - place, least)),
            (min(max(bias - current, 0.0), limit), max(self.gap + place, least)),
        )


Actuator = LinearActuator | SaturatingActuator
