"""Torques on a shaft by its spin speed: motors at steady supply, drag, and curves.

M. Kloss, Archiv für Elektrotechnik 5 (1916) 59, for induction motors; W. Leonhard, Control of
Electrical Drives, ch. 5, for direct-current motors with separate excitation. Transients of the
currents are left out: they are over within some periods of the supply.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.coefficient_table import outside


@dataclass(frozen=True, eq=False)
class Drive(ABC):
    """A torque about the spin axis by spin speed and time."""

    # made of + − · / and powers alone, without the time: `law` takes symbols, Exudyn evaluates it
    is_formula: ClassVar[bool] = True

    @abstractmethod
    def law(self, speed: float, time: float) -> float:
        """For scenes: return the torque [N m] by spin speed [rad/s] and time [s], unchecked."""

    def torque(self, speed: float, time: float = 0.0) -> float:
        """Return the torque about e on the rotor [N m].

        Parameters
        ----------
        speed : float
            Spin speed [rad/s].
        time : float, optional
            [s]; only a :class:`TorqueCurve` may depend on it.

        Raises
        ------
        TypeError, ValueError
            For bad input, and a speed beyond the table of a :class:`TorqueCurve`, or where its
            function returns something else than a number.
        """
        return float(
            self.law(checks.number(speed, "speed", "rad/s"), checks.number(time, "time", "s"))
        )

    def _keep_sense(self, name: str) -> None:
        """Keep a speed, whose sign is the sense of the rotor."""
        checks.keep_numbers(self, {name: "rad/s"})
        if getattr(self, name) == 0.0:
            raise ValueError(f"{name}: needs a number [rad/s] that is not zero, got 0.0")


@dataclass(frozen=True, eq=False)
class TorqueCurve(Drive):
    """Torque by a table over the spin speed, or by a function.

    Parameters
    ----------
    curve : (speeds, torques) or callable
        A table: speeds, ascending [rad/s], and the torques about e on the rotor there [N m],
        interpolated linearly; or a function of spin speed and time [s] that returns the torque.
    extrapolate : bool, optional
        Whether a table goes on beyond its ends with the value there; an error by default.

    Raises
    ------
    TypeError, ValueError
        For bad input.

    Examples
    --------
    >>> from exudyn_rotor import TorqueCurve
    >>> TorqueCurve(([0.0, 100.0, 150.0], [20.0, 30.0, 0.0])).torque(125.0)
    15.0
    >>> TorqueCurve(lambda speed, time: 5.0 * time - 0.1 * speed).torque(10.0, time=2.0)
    9.0
    """

    is_formula = False

    curve: tuple[ArrayLike, ArrayLike] | Callable[[float, float], float]
    extrapolate: bool = False

    def __post_init__(self) -> None:
        checks.flag(self.extrapolate, "extrapolate")
        if callable(self.curve):
            return
        needed = "a table (speeds, torques) or a function of speed and time"
        table = checks.items(self.curve, "curve", needed)
        if len(table) != 2:
            raise ValueError(f"curve: needs {needed}, got {checks.shown(self.curve)}")
        speeds = checks.ascending(table[0], "curve: its speeds", "rad/s")
        torques = checks.vector(table[1], "curve: its torques", "N m", size=len(speeds))
        object.__setattr__(self, "curve", (speeds, torques))

    def law(self, speed: float, time: float) -> float:
        """Return the torque [N m]."""
        if callable(self.curve):
            return checks.number(self.curve(speed, time), "curve: its torque", "N m")
        speeds, torques = self.curve
        if not self.extrapolate and (wrong := outside(speeds, speed)):
            raise ValueError(f"curve: its table {wrong}")
        return float(np.interp(speed, speeds, torques))


@dataclass(frozen=True, eq=False, kw_only=True)
class Drag(Drive):
    """Drag of bearings, air and seals: it opposes the spin.

    ``T = −(c₀ Ω/√(Ω² + Ω_s²) + c₁ Ω + c₂ |Ω| Ω)``: dry friction, smooth below the speed Ω_s; linear
    and quadratic drag.

    Parameters
    ----------
    constant : float, optional
        c₀ [N m].
    linear : float, optional
        c₁ [N m s/rad].
    quadratic : float, optional
        c₂ [N m s²/rad²].
    smooth_speed : float, optional
        Ω_s [rad/s].

    Raises
    ------
    TypeError, ValueError
        For negative numbers.

    Examples
    --------
    >>> from exudyn_rotor import Drag
    >>> Drag(linear=0.1, quadratic=2e-3).torque(100.0)
    -30.0
    """

    constant: float = 0.0
    linear: float = 0.0
    quadratic: float = 0.0
    smooth_speed: float = 0.1

    def __post_init__(self) -> None:
        units = {"constant": "N m", "linear": "N m s/rad", "quadratic": "N m s²/rad²"}
        checks.keep_numbers(self, units, least=0.0)
        checks.keep_numbers(self, {"smooth_speed": "rad/s"}, above=0.0)

    def law(self, speed: float, time: float) -> float:
        """Return the torque [N m]."""
        square = speed * speed
        dry = self.constant * speed / (square + self.smooth_speed**2) ** 0.5
        return -(dry + self.linear * speed + self.quadratic * speed * square**0.5)


@dataclass(frozen=True, eq=False, kw_only=True)
class InductionMotor(Drive):
    """Induction motor by Kloss's formula; a generator above its synchronous speed.

    ``T = 2 T_b/(s/s_b + s_b/s)`` at the slip ``s = 1 − Ω/Ω_s``.

    Parameters
    ----------
    breakdown_torque : float
        Largest torque T_b [N m], a size.
    breakdown_slip : float
        Slip s_b at which it is reached, above 0 and below 1.
    synchronous_speed : float
        Ω_s [rad/s]; negative for a motor that turns the rotor backwards.

    Raises
    ------
    TypeError, ValueError
        For numbers out of these ranges.

    Examples
    --------
    >>> from exudyn_rotor import InductionMotor
    >>> motor = InductionMotor(breakdown_torque=50.0, breakdown_slip=0.2, synchronous_speed=100.0)
    >>> motor.torque(80.0), round(motor.torque(0.0), 3), motor.torque(100.0)
    (50.0, 19.231, 0.0)
    """

    breakdown_torque: float
    breakdown_slip: float
    synchronous_speed: float

    def __post_init__(self) -> None:
        checks.keep_numbers(self, {"breakdown_torque": "N m"}, above=0.0)
        checks.keep_numbers(self, {"breakdown_slip": ""}, above=0.0, below=1.0)
        self._keep_sense("synchronous_speed")

    def law(self, speed: float, time: float) -> float:
        """Return the torque [N m]."""
        sense = 1.0 if self.synchronous_speed > 0.0 else -1.0
        slip, most = 1.0 - speed / self.synchronous_speed, self.breakdown_slip
        return 2.0 * sense * self.breakdown_torque * most * slip / (slip * slip + most**2)


@dataclass(frozen=True, eq=False, kw_only=True)
class DirectCurrentMotor(Drive):
    """Direct-current motor: a torque that falls linearly with the speed.

    ``T = T_0 (1 − Ω/Ω_0)``.

    Parameters
    ----------
    stall_torque : float
        T_0 [N m], a size.
    no_load_speed : float
        Ω_0 [rad/s]; negative for a motor that turns the rotor backwards.

    Raises
    ------
    TypeError, ValueError
        For numbers that are not above zero, a speed that is zero.

    Examples
    --------
    >>> from exudyn_rotor import DirectCurrentMotor
    >>> DirectCurrentMotor(stall_torque=10.0, no_load_speed=200.0).torque(50.0)
    7.5
    """

    stall_torque: float
    no_load_speed: float

    def __post_init__(self) -> None:
        checks.keep_numbers(self, {"stall_torque": "N m"}, above=0.0)
        self._keep_sense("no_load_speed")

    def law(self, speed: float, time: float) -> float:
        """Return the torque [N m]."""
        sense = 1.0 if self.no_load_speed > 0.0 else -1.0
        return sense * self.stall_torque * (1.0 - speed / self.no_load_speed)
