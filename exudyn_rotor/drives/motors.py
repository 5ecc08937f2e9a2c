"""Torque curves of motors over the spin speed Ω, at steady supply.

Induction motor, by Kloss's formula (M. Kloss, Archiv für Elektrotechnik 5 (1916) 59):

    T = 2 T_b/(s/s_b + s_b/s),   s = 1 − Ω/Ω_s,                                             (1)

direct-current motor with separate excitation (W. Leonhard, Control of Electrical Drives, ch. 5):

    T = T_0 (1 − Ω/Ω_0).                                                                   (2)

Transients of the currents are left out: they are over within some periods of the supply.
"""

from __future__ import annotations

from dataclasses import dataclass

from exudyn_rotor import checks
from exudyn_rotor.drives.drive import Drive


@dataclass(frozen=True, eq=False, kw_only=True)
class InductionMotor(Drive):
    """Induction motor by Kloss's formula (1); a generator above its synchronous speed.

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
        checks.keep_numbers(self, {"synchronous_speed": "rad/s"})
        self._refuse_zero("synchronous_speed", "rad/s")

    def law(self, speed: float, time: float) -> float:
        """Return the torque [N m]."""
        sense = 1.0 if self.synchronous_speed > 0.0 else -1.0
        slip, most = 1.0 - speed / self.synchronous_speed, self.breakdown_slip
        return 2.0 * sense * self.breakdown_torque * most * slip / (slip * slip + most**2)


@dataclass(frozen=True, eq=False, kw_only=True)
class DirectCurrentMotor(Drive):
    """Direct-current motor: a torque that falls linearly with the speed (2).

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
        checks.keep_numbers(self, {"no_load_speed": "rad/s"})
        self._refuse_zero("no_load_speed", "rad/s")

    def law(self, speed: float, time: float) -> float:
        """Return the torque [N m]."""
        sense = 1.0 if self.no_load_speed > 0.0 else -1.0
        return sense * self.stall_torque * (1.0 - speed / self.no_load_speed)
