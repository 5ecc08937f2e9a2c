"""Which coordinates a rotor has: one description for Sections 2.2 to 2.5 of the paper.

A prescribed coordinate leaves the unknowns, and its acceleration goes to the right-hand side.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.theory.axis import SpinAxis, skew
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.stiffening import SpinTerms, Stiffening

TRANSLATIONS = ("free", "in-plane", "none")
AUTOMATIC = "auto"
DRIVES = ("rigid", "elastic")
SPIN_COUPLINGS = ("full", "frozen")
_RATES = ("value", "rate", "acceleration")


@dataclass(frozen=True)
class PrescribedMotion:
    """A prescribed θ(t) [rad] or τ(t) [m, inertial axes] with its first two derivatives.

    Parameters
    ----------
    value, rate, acceleration : callable
        Functions of time [s]; scalars for a spin angle, arrays of shape (3,) for a translation.

    Examples
    --------
    >>> from exudyn_rotor import PrescribedMotion
    >>> spin = PrescribedMotion.run_up(0.0, 300.0, duration=2.0)
    >>> spin.rate(1.0), spin.rate(5.0), spin.acceleration(5.0)
    (150.0, 300.0, 0.0)
    """

    value: Callable[[float], float | np.ndarray]
    rate: Callable[[float], float | np.ndarray]
    acceleration: Callable[[float], float | np.ndarray]

    def __post_init__(self) -> None:
        for name in _RATES:
            checks.function(getattr(self, name), f"prescribed motion: {name} over time")

    @classmethod
    def run_up(
        cls, start_speed: float, end_speed: float, duration: float, angle: float = 0.0
    ) -> PrescribedMotion:
        """Smooth change of spin speed [rad/s] within `duration` [s], constant before and after.

        ``ω(t) = Ω₀ + ΔΩ (s − sin(2πs)/2π)`` with s = t/duration, so that ω̇ starts and ends at
        zero and is continuous. `angle` is θ(0) [rad].

        Raises
        ------
        TypeError, ValueError
            If one of them is not a finite number, or the duration not positive.
        """
        start_speed = checks.number(start_speed, "start_speed", "rad/s")
        end_speed = checks.number(end_speed, "end_speed", "rad/s")
        duration = checks.number(duration, "duration", "s", above=0.0)
        angle = checks.number(angle, "angle", "rad")
        gain = end_speed - start_speed

        def share(t: float) -> float:
            return min(max(t / duration, 0.0), 1.0)

        def value(t: float) -> float:
            s = share(t)
            ramp = 0.5 * s**2 + (math.cos(2 * math.pi * s) - 1.0) / (2 * math.pi) ** 2
            after = max(t - duration, 0.0)
            return angle + start_speed * t + gain * (duration * ramp + after)

        def rate(t: float) -> float:
            s = share(t)
            return start_speed + gain * (s - math.sin(2 * math.pi * s) / (2 * math.pi))

        def acceleration(t: float) -> float:
            return gain / duration * (1.0 - math.cos(2 * math.pi * share(t)))

        return cls(value, rate, acceleration)


@dataclass(frozen=True)
class ConstantSpeed:
    """Prescribed constant spin: ``θ(t) = angle + speed · t`` [rad, rad/s, s].

    Examples
    --------
    >>> from exudyn_rotor import ConstantSpeed
    >>> ConstantSpeed(100.0, angle=0.5).value(2.0)
    200.5
    """

    speed: float
    angle: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "speed", checks.number(self.speed, "spin: speed", "rad/s"))
        object.__setattr__(self, "angle", checks.number(self.angle, "spin: angle", "rad"))

    def value(self, t: float) -> float:
        """Spin angle [rad]."""
        return self.angle + self.speed * checks.number(t, "t", "s")

    def rate(self, t: float) -> float:
        """Spin speed [rad/s]."""
        checks.number(t, "t", "s")
        return self.speed

    def acceleration(self, t: float) -> float:
        """Zero [rad/s²]."""
        checks.number(t, "t", "s")
        return 0.0


def start_values(
    motion: PrescribedMotion | ConstantSpeed, name: str
) -> list[float] | list[np.ndarray]:
    """Return value, rate and acceleration at t = 0 of what is 'spin' or 'translation'."""
    check, found = checks.number if name == "spin" else checks.vector, []
    for rate in _RATES:
        try:
            value = getattr(motion, rate)(0.0)
        # whatever a user's function does with a time
        except Exception as error:
            raise ValueError(
                f"{name}: its {rate} needs to be a function of time alone [s]; at t = 0 it raised "
                f"{type(error).__name__}: {error}"
            ) from error
        found.append(check(value, f"{name}: its {rate} at t = 0"))
    return found


def suited_translation(
    translation: str | PrescribedMotion, grounded: bool
) -> str | PrescribedMotion:
    """Return the translation that ``'auto'`` stands for; anything else as it was given.

    Of those that represent the same displacements only ``'free'`` has loads on the frame's node act
    and does not turn backwards in modes what stands in space. A rotor that its own stiffness holds
    in its frame (`grounded`) has no other than ``'none'``.
    """
    if isinstance(translation, PrescribedMotion):
        return translation
    words = (AUTOMATIC, *TRANSLATIONS)
    if checks.choice(translation, "translation, if no PrescribedMotion", words) != AUTOMATIC:
        return translation
    return "none" if grounded else "free"


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
    spin_coupling : {'full', 'frozen'}
        ``'frozen'`` leaves the part of the mass matrix that varies with the modal coordinates out
        of a free spin, with the forces that belong to it; see
        :class:`exudyn_rotor.theory.motion.Motion`. It needs a frame that follows the rotor,
        translation 'free' or 'in-plane'.

    Raises
    ------
    TypeError, ValueError
        For an unknown keyword, a spin that is not finite, or a prescribed motion that gives no
        finite numbers at t = 0.

    Examples
    --------
    >>> from exudyn_rotor import Formulation
    >>> Formulation("in-plane", "free").section
    '2.3'
    >>> driven = Formulation("none", 300.0)
    >>> driven.section, driven.is_constant_speed
    ('2.5', True)
    """

    translation: str | PrescribedMotion = "free"
    spin: str | float | ConstantSpeed | PrescribedMotion = "free"
    drive: str = "rigid"
    spin_coupling: str = "full"

    def __post_init__(self) -> None:
        if isinstance(self.translation, PrescribedMotion):
            start_values(self.translation, "translation")
        else:
            checks.choice(self.translation, "translation, if no PrescribedMotion", TRANSLATIONS)
        if isinstance(self.spin, str):
            checks.choice(self.spin, "spin, if no number or PrescribedMotion", ("free",))
        elif isinstance(self.spin, PrescribedMotion):
            start_values(self.spin, "spin")
        elif not isinstance(self.spin, ConstantSpeed):
            needed = "spin: 'free', a PrescribedMotion, or a constant speed"
            object.__setattr__(
                self, "spin", ConstantSpeed(checks.number(self.spin, needed, "rad/s"))
            )
        checks.choice(self.drive, "drive", DRIVES)
        if self.drive == "elastic" and self.spin == "free":
            raise ValueError(
                "drive='elastic' needs a prescribed spin; with spin='free' leave it out"
            )
        checks.choice(self.spin_coupling, "spin_coupling", SPIN_COUPLINGS)
        if self.spin_coupling == "frozen" and not (self.has_spin and self.translation_count):
            raise ValueError(
                "spin_coupling='frozen' needs spin='free', whose equation it shortens, and "
                "translation='free' or 'in-plane': rigid motions that are modes err with every "
                "change of speed by the Euler force that a frozen spin leaves out"
            )

    @property
    def has_spin(self) -> bool:
        """True when θ is an unknown."""
        return self.spin == "free"

    @property
    def has_frozen_spin(self) -> bool:
        """True when the mass matrix leaves out what varies with the modal coordinates."""
        return self.spin_coupling == "frozen"

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


class Instant(NamedTuple):
    """One instant of a motion, split into its parts."""

    omega: float  # spin speed, and its prescribed rate; zero for a free spin, whose rate is unknown
    omega_t: float
    zeta: np.ndarray  # (m,) Modal coordinates and their rates
    zeta_t: np.ndarray
    A: np.ndarray  # (3, 3) Rotor axes → inertial axes (55)


class FloatingFrame:
    """Coordinates of one formulation; parameters and attributes of :class:`.motion.Motion`."""

    def __init__(
        self,
        invariants: Invariants,
        formulation: Formulation,
        second_order: Stiffening,
        orientation: ArrayLike | None = None,
        plane: ArrayLike | None = None,
        gravity: ArrayLike | None = None,
    ) -> None:
        self.invariants = checks.instance(invariants, "invariants", Invariants)
        self.formulation = checks.instance(formulation, "formulation", Formulation)
        self.spin_terms = SpinTerms.of(invariants, second_order)
        if second_order.K4 is not None and formulation.has_spin:
            raise ValueError(
                "spin: a free spin does not take the stiffness per ω⁴ of a static displacement; "
                "prescribe the spin, or compute the prestress with initial_displacement=False"
            )
        self.orientation = np.eye(3)
        if orientation is not None:
            self.orientation = checks.rotation(orientation, "orientation")
        self.gravity = checks.vector(np.zeros(3) if gravity is None else gravity, "gravity", "m/s²")
        if plane is not None:
            columns = 2 if formulation.translation_count == 2 else None
            plane = checks.array(plane, "plane", shape=(3, columns))
        self._e = skew(invariants.direction)
        self._axis = SpinAxis(invariants.direction)
        self.free_directions = self._free_directions(plane)
        counts = (formulation.translation_count, int(formulation.has_spin), invariants.size)
        ends = np.cumsum(counts)
        self.translations, self._spin, self.modes = (
            slice(end - count, end) for end, count in zip(ends, counts, strict=True)
        )
        self.size = int(ends[-1])
        self.has_body_force = bool(
            (formulation.moves_origin or np.any(self.gravity))
            and (np.any(invariants.S) or np.any(self.static_unbalance))
        )
        self.weight = invariants.mass * (self.free_directions.T @ self.gravity)

    def _free_directions(self, plane: np.ndarray | None) -> np.ndarray:
        count = self.formulation.translation_count
        if count != 2:
            return np.eye(3)[:, :count]
        return self.orientation @ self._axis.plane if plane is None else plane

    @cached_property
    def static_unbalance(self) -> np.ndarray:
        """``mχ*`` (67) [kg m], a quarter turn ahead of the centre of mass, rotor axes."""
        return self.invariants.mass * self._e @ self.invariants.center

    @cached_property
    def S1(self) -> np.ndarray:
        """``S* = ẽS`` (69), shape (3, m)."""
        return self._e @ self.invariants.S

    @cached_property
    def is_coupled(self) -> bool:
        """True when ``mχ*`` or S couple unknown translations with the other coordinates."""
        count = self.formulation.translation_count
        seen = self.invariants.S if count == 3 else self.S1  # in the plane, S* is S turned
        return bool(count and (np.any(self.static_unbalance) or np.any(seen)))

    def at(self, t: float, q: ArrayLike, q_t: ArrayLike) -> Instant:
        """Return an instant, split into its parts."""
        q, q_t = self._checked(q, "q"), self._checked(q_t, "q_t")
        form, t = self.formulation, checks.number(t, "t", "s")
        if form.has_spin:
            theta, omega, omega_t = float(q[self._spin][0]), float(q_t[self._spin][0]), 0.0
        else:
            theta, omega = form.spin.value(t), form.spin.rate(t)
            omega_t = form.spin.acceleration(t)
        A = self.orientation @ self._axis.rotation(theta)
        return Instant(omega, omega_t, q[self.modes], q_t[self.modes], A)

    def constant_force(self) -> np.ndarray:
        """Return the weight on translations and, at constant speed, ``ω²h``, shape (size,)."""
        force = np.zeros(self.size)
        force[self.translations] = self.weight
        if self.formulation.is_constant_speed:
            force[self.modes] = self.spin_terms.load(self.formulation.spin.speed)
        return force

    def unbalance(self, zeta: np.ndarray) -> np.ndarray:
        """``mχ* + S*ζ``, the bracket of (65): the static unbalance of the deformed rotor."""
        return self.static_unbalance + self.S1 @ zeta

    def _checked(self, values: ArrayLike, name: str) -> np.ndarray:
        """Return one finite number per unknown; quick where there is nothing to refuse."""
        right = type(values) is np.ndarray and values.shape == (self.size,)
        if right and values.dtype == float and math.isfinite(values.dot(values)):
            return values
        return checks.vector(values, name, size=self.size)
