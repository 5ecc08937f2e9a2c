"""Position controller of a magnetic bearing's axis: PID, filter, amplifier and delay.

From the place y that its sensor measures to the current −i in the coil:

    i(s)/y(s) = e^{−sτ} · 1/(1 + √2 s/ω_f + s²/ω_f²) · (P + I/s + D s) · 1/(1 + s/ω_a)      (1)

delay, filter of the measured signal (Butterworth, so that P and D share it: K. J. Åström,
T. Hägglund, *Advanced PID Control* (2006), Sect. 3.3), PID, amplifier. In equations of motion and
linear analyses alike, these are coordinates of second order, which is exact but for the delay:

    (τ²/12) q̈_d + (τ/2) q̇_d + q_d = y,            y_d = y − τ q̇_d                          (2)
    q̈_f/ω_f² + √2 q̇_f/ω_f + q_f = y_d                                                     (3)
    q̈_a/ω_a² + q̇_a/ω_a = q_f,   i = D ω_a q_f + (I/ω_a) q_a + (P/ω_a − D) q̇_a             (4)

(2) is the Padé approximant of order 2 of the delay, whose phase errs by ``(ωτ)⁵/720`` rad: the same
in runs, where stored samples would tie the result to the step size and an implicit step asks for
the force at states that it rejects. Without an integral (4) has a factor
``(1 + s/2ω_a)`` in numerator and denominator,

    q̈_a/2ω_a² + 3 q̇_a/2ω_a + q_a = q_f,   i = D ω_a q_f + (P − D ω_a) q_a + ½(P/ω_a − D) q̇_a  (5)

so that one eigenvalue −2ω_a more appears, which nothing sees. Limits of the current do not stop the
integral (wind-up).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from exudyn_rotor import checks

_BUTTERWORTH = np.sqrt(2.0)


class Realisation(NamedTuple):
    """Equations ``M q̈ + D q̇ + K q = b y``, ``i = c q + d q̇`` of b coordinates q [m].

    `inertia` (b,), `damping` and `stiffness` (b, b), `place`, that is b, (b,), and `by_place`,
    `by_rate`, that is c and d, (b,).
    """

    inertia: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    place: np.ndarray
    by_place: np.ndarray
    by_rate: np.ndarray


@dataclass(frozen=True, kw_only=True)
class PIDController:
    """Position controller (1) of a control axis, from the measured place to minus the current.

    ``C(s) = e^{−sτ} (P + I/s + D s) / ((1 + √2 s/ω_f + s²/ω_f²)(1 + s/ω_a))``

    Parameters
    ----------
    proportional : float
        P [A/m], above zero.
    integral : float, optional
        I [A/(m s)]; none by default.
    derivative : float
        D [A s/m].
    filter_frequency : float
        ω_f [rad/s], of the filter of the measured signal, which keeps noise from P and D.
    amplifier_frequency : float
        ω_a [rad/s], the amplifier's bandwidth.
    delay : float, optional
        τ [s], of sampling and computing.

    Raises
    ------
    TypeError, ValueError
        For negative gains and delays, and frequencies or a proportional gain not above zero.

    Examples
    --------
    >>> from exudyn_rotor import PIDController
    >>> controller = PIDController(
    ...     proportional=2e4, derivative=20.0, filter_frequency=2e4, amplifier_frequency=1e4
    ... )
    >>> print(controller.realisation().inertia)
    [2.5e-09 5.0e-09]
    """

    proportional: float
    integral: float = 0.0
    derivative: float
    filter_frequency: float
    amplifier_frequency: float
    delay: float = 0.0

    def __post_init__(self) -> None:
        units = dict.fromkeys(("filter_frequency", "amplifier_frequency"), "rad/s")
        checks.keep_numbers(self, {"proportional": "A/m"} | units, above=0.0)
        units = {"integral": "A/(m s)", "derivative": "A s/m", "delay": "s"}
        checks.keep_numbers(self, units, least=0.0)

    def realisation(self) -> Realisation:
        """Return equations (3) and (4) or (5), after (2) where there is a delay."""
        w_f, w_a = self.filter_frequency, self.amplifier_frequency
        P, D = self.proportional, self.derivative
        inertia, rates, places = [1.0 / w_f**2], [_BUTTERWORTH / w_f], [1.0]
        if self.integral:
            inertia, rates, places = [*inertia, 1.0 / w_a**2], [*rates, 1.0 / w_a], [*places, 0.0]
            by_place, by_rate = [D * w_a, self.integral / w_a], [0.0, P / w_a - D]
        else:
            inertia, rates, places = [*inertia, 0.5 / w_a**2], [*rates, 1.5 / w_a], [*places, 1.0]
            by_place, by_rate = [D * w_a, P - D * w_a], [0.0, 0.5 * (P / w_a - D)]
        damping, stiffness, place = np.diag(rates), np.diag(places), np.array([1.0, 0.0])
        stiffness[1, 0] = -1.0
        tau = self.delay
        if tau:
            inertia, place = [tau**2 / 12.0, *inertia], np.r_[1.0, place]
            by_place, by_rate = [0.0, *by_place], [0.0, *by_rate]
            before = (1, 0), (1, 0)
            damping, stiffness = np.pad(damping, before), np.pad(stiffness, before)
            damping[0, 0], stiffness[0, 0] = 0.5 * tau, 1.0
            damping[1, 0] = tau
        parts = inertia, damping, stiffness, place, by_place, by_rate
        return Realisation(*(np.array(part) for part in parts))
