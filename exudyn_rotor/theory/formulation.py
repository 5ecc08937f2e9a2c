"""Which coordinates a rotor has: one description for all sections of the paper.

====================  ==================  =============================================
translation           spin                section
====================  ==================  =============================================
``'free'``            ``'free'``          2.2: τ ∈ R³, θ, ζ
``'in-plane'``        ``'free'``          2.3: τ* ∈ R², θ, ζ
``'none'``            ``'free'``          2.4: θ, ζ
``'none'``, τ(t)      speed or θ(t)       2.5: ζ
====================  ==================  =============================================

The other combinations follow by the same rule: a prescribed coordinate leaves the unknowns, and
its acceleration goes to the right-hand side.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from numbers import Real

import numpy as np

TRANSLATIONS = ("free", "in-plane", "none")


@dataclass(frozen=True)
class PrescribedMotion:
    """A prescribed θ(t) [rad] or τ(t) [m, inertial axes] with its first two derivatives.

    Parameters
    ----------
    value, rate, acceleration : callable
        Functions of time [s]; scalars for a spin angle, arrays of shape (3,) for a translation.
    """

    value: Callable[[float], float | np.ndarray]
    rate: Callable[[float], float | np.ndarray]
    acceleration: Callable[[float], float | np.ndarray]

    def __post_init__(self) -> None:
        for name in ("value", "rate", "acceleration"):
            if not callable(getattr(self, name)):
                raise TypeError(f"prescribed motion: {name!r} must be a function of time")

    @classmethod
    def run_up(
        cls, start_speed: float, end_speed: float, duration: float, angle: float = 0.0
    ) -> PrescribedMotion:
        """Smooth change of spin speed [rad/s] within `duration` [s], constant before and after.

        ``ω(t) = Ω₀ + ΔΩ (s − sin(2πs)/2π)`` with s = t/duration, so that ω̇ starts and ends at
        zero and is continuous.
        """
        if not duration > 0.0:
            raise ValueError(f"run-up: the duration must be positive, got {duration}")
        if not np.all(np.isfinite([start_speed, end_speed, duration, angle])):
            raise ValueError("run-up: speeds, duration and angle must be finite numbers")
        gain = end_speed - start_speed

        def share(t: float) -> float:
            return min(max(t / duration, 0.0), 1.0)

        def value(t: float) -> float:
            s = share(t)
            ramp = 0.5 * s**2 + (np.cos(2 * np.pi * s) - 1.0) / (2 * np.pi) ** 2
            after = max(t - duration, 0.0)
            return angle + start_speed * t + gain * (duration * ramp + after)

        def rate(t: float) -> float:
            s = share(t)
            return start_speed + gain * (s - np.sin(2 * np.pi * s) / (2 * np.pi))

        def acceleration(t: float) -> float:
            return gain / duration * (1.0 - np.cos(2 * np.pi * share(t)))

        return cls(value, rate, acceleration)


@dataclass(frozen=True)
class ConstantSpeed:
    """Prescribed constant spin: ``θ(t) = angle + speed · t`` [rad, rad/s, s]."""

    speed: float
    angle: float = 0.0

    def __post_init__(self) -> None:
        if not (np.isfinite(self.speed) and np.isfinite(self.angle)):
            raise ValueError(
                f"constant spin: speed {self.speed} and angle {self.angle} must be finite"
            )

    def value(self, t: float) -> float:
        """Spin angle [rad]."""
        return self.angle + self.speed * t

    def rate(self, t: float) -> float:
        """Spin speed [rad/s]."""
        return self.speed

    def acceleration(self, t: float) -> float:
        """Zero [rad/s²]."""
        return 0.0


@dataclass(frozen=True)
class Formulation:
    """One member of the formulation family.

    Parameters
    ----------
    translation : {'free', 'in-plane', 'none'} or PrescribedMotion
        Motion of the frame origin, in inertial axes. Rigid translations that the frame does not
        hold are component modes.
    spin : 'free', float, ConstantSpeed or PrescribedMotion
        A number is a constant spin speed [rad/s].
    drive : {'rigid', 'elastic'}
        Only for a prescribed spin. ``'rigid'``: the rotor's mean rotation follows θ(t).
        ``'elastic'``: the frame follows θ(t) and the rotor's own spin is a component mode, which
        the scene must hold, e.g. by a torsional spring.

    Raises
    ------
    ValueError, TypeError
        For an unknown keyword or a spin that is not finite.
    """

    translation: str | PrescribedMotion = "free"
    spin: str | float | ConstantSpeed | PrescribedMotion = "free"
    drive: str = "rigid"

    def __post_init__(self) -> None:
        known = isinstance(self.translation, PrescribedMotion) or self.translation in TRANSLATIONS
        if not known:
            raise ValueError(
                f"translation {self.translation!r} is unknown; "
                f"use one of {', '.join(TRANSLATIONS)} or a PrescribedMotion"
            )
        if isinstance(self.spin, Real) and not isinstance(self.spin, bool):
            object.__setattr__(self, "spin", ConstantSpeed(float(self.spin)))
        if self.spin != "free" and not isinstance(self.spin, (ConstantSpeed, PrescribedMotion)):
            raise ValueError(
                f"spin {self.spin!r} is unknown; "
                "use 'free', a constant speed in rad/s, or a PrescribedMotion"
            )
        if self.drive not in ("rigid", "elastic"):
            raise ValueError(f"drive {self.drive!r} is unknown; use 'rigid' or 'elastic'")
        if self.drive == "elastic" and self.spin == "free":
            raise ValueError(
                "drive='elastic' needs a prescribed spin; with spin='free' leave it out"
            )

    @property
    def has_spin(self) -> bool:
        """True when θ is an unknown."""
        return self.spin == "free"

    @property
    def translation_count(self) -> int:
        """Number of unknown translations: 3, 2 or 0."""
        return {"free": 3, "in-plane": 2}.get(self._translation_name, 0)

    @property
    def moves_origin(self) -> bool:
        """True when τ(t) is prescribed."""
        return isinstance(self.translation, PrescribedMotion)

    @property
    def is_constant_speed(self) -> bool:
        """True for a prescribed constant spin speed."""
        return isinstance(self.spin, ConstantSpeed)

    @property
    def section(self) -> str:
        """Section of the paper that this member belongs to, '2.2' to '2.5'."""
        if not self.has_spin and self.translation_count == 0:
            return "2.5"
        return {"free": "2.2", "in-plane": "2.3"}.get(self._translation_name, "2.4")

    @property
    def _translation_name(self) -> str:
        return "prescribed" if self.moves_origin else self.translation
