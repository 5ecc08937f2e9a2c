"""What every bearing with a law of its own offers to scenes and linear analyses."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from math import hypot, inf
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.controlled_support import Controlled
from exudyn_rotor.bearings.film.equilibria import Equilibria
from exudyn_rotor.bearings.own_table import table_of
from exudyn_rotor.bearings.support import COEFFICIENTS, NoCoefficientsError, Support

_REMEMBERED = 1000  # coefficients of a bearing
_DIFFERENCE, _STILL = 1e-6, 1e-6  # of the largest motion, which is at least that in SI units
_HIGHER = 10.0 ** np.arange(7)  # rad/s, where only the directions that a bearing holds count

Law = Callable[[float, float, float, float, float, float], tuple[float, float]]
ClearanceAlong = Callable[..., float]  # by a direction (2,), which may be left out
LawAlong = Callable[[np.ndarray, np.ndarray, float], tuple[np.ndarray, np.ndarray]]
LawWithTorque = Callable[[float, float, float, float, float, float], tuple[float, float, float]]


class NoEquilibriumError(NoCoefficientsError):
    """A bearing under load has no equilibrium at a speed, as films at rest."""


@dataclass(frozen=True, eq=False, kw_only=True)
class LoadedBearing(ABC):
    """A bearing across the axis that holds its journal in an equilibrium under a static load.

    Components are along (n1, n2) of :attr:`SpinAxis.plane`, which stand still, from the centre of
    the bearing, where the axis of the rotor at rest passes.

    Attributes
    ----------
    interface : str
        Interface of the rotor that is the journal.
    load : ndarray, shape (2,), or None
        Static load on the journal [N], about whose equilibrium linear analyses take the bearing;
        see :func:`exudyn_rotor.bearing_loads`. Scenes do not need it.
    carries : bool
        Whether it takes a share of the rotor's weight.
    """

    carries: ClassVar[bool] = True
    _unloaded: ClassVar[bool] = False  # whether no load counts as one of zero

    interface: str
    load: np.ndarray | None = None

    def __post_init__(self) -> None:
        checks.label(self.interface, "interface")
        if self.load is not None:
            load = checks.read_only(checks.vector(self.load, "load", "N", size=2))
            object.__setattr__(self, "load", load)

    @abstractmethod
    def equilibrium(self, speed: float, load: ArrayLike | None = None) -> np.ndarray:
        """Return where the journal rests under a static load [N], the bearing's own by default."""

    def table(self, speeds: ArrayLike, frequencies: ArrayLike) -> Support:
        """Return a support with the bearing's coefficients over speed and frequency, as tables.

        Of small motions about the equilibrium under the load, the tilts of pads with inertia and
        the states of a controller eliminated; what has none is the same at all frequencies, and
        the inertia of a fluid stays a mass. ``.stiffness.values`` and ``.damping.values`` are
        arrays of the shape (s, f, 2, 2). Tables are for other programs, and to compare: linear
        analyses take the bearing itself with its states, and growing and decaying motions exactly.

        Parameters
        ----------
        speeds, frequencies : array_like, shape (s,), (f,)
            Ascending spin speeds, and frequencies > 0 of the motion [rad/s]. Speeds at which the
            bearing has no equilibrium are left out with a warning.

        Raises
        ------
        TypeError, ValueError
            For bad input, a missing load, no speed with an equilibrium, and sensors elsewhere than
            where the bearing acts.

        Examples
        --------
        >>> from exudyn_rotor import AnnularSeal
        >>> seal = AnnularSeal(
        ...     interface="disc", radius=0.1, length=0.04, clearance=3e-4, pressure_drop=1e6,
        ...     density=1000.0, viscosity=1e-3,
        ... )
        >>> seal.table(speeds=[100.0, 300.0], frequencies=[50.0, 150.0]).mass.values.shape
        (2, 2, 2, 2)
        """
        return table_of(self.linearised(), speeds, frequencies)

    @abstractmethod
    def linearised(self) -> Support | Controlled:
        """Return the equations for linear analyses, about the equilibrium under the load."""

    def _static_load(self, load: ArrayLike | None) -> np.ndarray:
        if load is not None:
            return checks.vector(load, "load", "N", size=2)
        if self.load is None and self._unloaded:
            return np.zeros(2)
        if self.load is None:
            raise ValueError(
                f"bearing at {self.interface!r}: linear analyses need its static load; give "
                "load=…, e.g. of bearing_loads(rotor, interfaces, gravity)"
            )
        return self.load


@dataclass(frozen=True, eq=False, kw_only=True)
class Bearing(LoadedBearing):
    """A bearing whose force on the journal follows from its place, velocity and spin.

    Attributes
    ----------
    interface, load
        See :class:`LoadedBearing`.
    """

    uses_angle: ClassVar[bool] = False  # whether the law depends on the spin angle

    _tried: ClassVar[np.ndarray] = _HIGHER
    _linear: Equilibria[tuple[np.ndarray, ...]] = field(
        default_factory=lambda: Equilibria(_REMEMBERED), init=False, repr=False
    )

    @property
    def law(self) -> Law:
        """For scenes: the force on the journal [N] by x, y, ẋ, ẏ, θ and Ω, anywhere, unchecked."""
        return self._law

    @property
    def law_with_torque(self) -> LawWithTorque | None:
        """As :attr:`law`, with the torque on the journal about the axis [N m]; None without one.

        Scenes need it where the spin is free.
        """
        return None

    @property
    def law_along(self) -> LawAlong:
        """For harmonic balance: forces and their derivatives by motions (t, 4), unchecked.

        Of displacements and velocities [m], [m/s], spin angles (t,) and the spin speed: forces
        (t, 2) [N], and minus their derivatives by the motion, (t, 2, 4).
        """
        return self._along

    @property
    def clearance_along(self) -> ClearanceAlong:
        """For scenes: how far that way, of length 1 (2,), or at least, the journal may go [m].

        Unchecked; infinity for a bearing without a clearance.
        """
        return self._gap

    def film_use(self, displacement: ArrayLike) -> float | None:
        """Return a displacement over the way to the end of the film there; None without a film.

        Beyond 1 the force is no longer the film's: it goes on by its tangent.

        Parameters
        ----------
        displacement : array_like, shape (2,)
            Of the journal from the centre of the bearing along (n1, n2) [m].
        """
        place = checks.vector(displacement, "displacement", "m", size=2)
        distance = hypot(*place)
        reach = self._reach(place / distance if distance else np.array([1.0, 0.0]))
        return distance / reach if reach < inf else None

    def _reach(self, direction: np.ndarray) -> float:
        """Return how far that way, of length 1 (2,), the law is that of a film [m]."""
        return inf

    def _gap(self, direction: np.ndarray | None = None) -> float:
        """Return how far that way, of length 1 (2,), or at least, the journal may go [m]."""
        return inf

    @abstractmethod
    def _law(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, float]:
        """Return the force on the journal [N]."""

    def _along(
        self, motion: np.ndarray, angles: np.ndarray, speed: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """See :attr:`law_along`; by differences, unless a law knows better."""
        law, sizes = self.law, np.abs(motion).max(axis=0)
        steps = _DIFFERENCE * np.repeat([max(*sizes[:2], _STILL), max(*sizes[2:], _STILL)], 2)
        force, slopes = np.empty((len(motion), 2)), np.empty((len(motion), 2, 4))
        for row, (state, angle) in enumerate(zip(motion, angles.tolist(), strict=True)):
            force[row] = law(*state.tolist(), angle, speed)
            slopes[row] = differenced(law, state, steps, angle, speed)
        return force, slopes

    def slopes(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """For scenes: less the derivatives (2, 2) of :attr:`law` by place and by velocity."""
        found = self._along(np.array([[x, y, vx, vy]]), np.array([angle]), speed)[1][0]
        return found[:, :2], found[:, 2:]

    @abstractmethod
    def coefficients(
        self, speed: float, load: ArrayLike | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return stiffness [N/m] and damping [N s/m], each (2, 2), about the equilibrium."""

    def linearised(self) -> Support:
        """Return the support for linear analyses: the coefficients under the load at every speed.

        Raises
        ------
        ValueError
            Where the bearing has no load.
        """
        self._static_load(None)
        return Support(self.interface, Linearised(self, 0), Linearised(self, 1))


@dataclass(frozen=True, eq=False)
class Linearised:
    """Stiffness (`index` 0) or damping (1) of a bearing under its load, by the spin speed."""

    bearing: Bearing
    index: int

    def __call__(self, speed: float) -> np.ndarray:
        """Return the coefficient, shape (2, 2).

        Without an equilibrium, at rest above all, that at the next of some other speeds: some ask
        for the directions that a bearing holds. What asks for its size calls `check_range` before.
        """
        for tried in (speed, *self.bearing._tried):
            try:
                return self._value(tried)
            except (ValueError, ArithmeticError) as error:
                refused = error
        raise refused

    def _value(self, speed: float) -> np.ndarray:
        bearing = self.bearing
        return bearing._linear.at(speed, bearing._static_load(None), bearing.coefficients)[
            self.index
        ]

    def check_range(self, speed: float) -> None:
        """Refuse a speed at which the bearing has no equilibrium.

        Raises
        ------
        NoEquilibriumError
        """
        try:
            self._value(speed)
        except (ValueError, ArithmeticError) as error:
            raise NoEquilibriumError(self._refusal(speed, str(error))) from error

    def _refusal(self, speed: float, reason: str) -> str:
        """Return why there is no equilibrium, and the lowest higher speed tried that has one."""
        name = f"bearing at {self.bearing.interface!r}"
        if speed == 0.0:
            reason = f"{name}: at 0 rad/s its film carries nothing"
        elif name not in reason:
            reason = f"{name}: {reason}"
        for tried in sorted(self.bearing._tried[self.bearing._tried > abs(speed)]):
            try:
                self._value(tried)
            except (ValueError, ArithmeticError):
                continue
            return f"{reason}; of the higher speeds tried it carries from {tried:g} rad/s on"
        return reason


def bearing_of(support: object) -> Bearing | None:
    """Return the bearing whose coefficients a support has; None for coefficients of its own."""
    given = (getattr(support, name, None) for name in COEFFICIENTS)
    return next((each.bearing for each in given if isinstance(each, Linearised)), None)


def by_tangent(
    force: Callable[[float, float], tuple[float, ...]],
    x: float,
    y: float,
    most: float,
    step: float,
) -> tuple[float, ...]:
    """Return a force, and a torque with it, outside the radius `most`, by its tangent there.

    The tangent is that of the last `step` inside. So Newton's method comes back from places at
    which there is no force.
    """
    eccentricity = hypot(x, y)
    ex, ey = x / eccentricity, y / eccentricity
    edge = force(most * ex, most * ey)
    inside = force((most - step) * ex, (most - step) * ey)
    beyond = (eccentricity - most) / step
    return tuple(f + beyond * (f - g) for f, g in zip(edge, inside, strict=True))


def differenced(
    law: Callable[..., tuple[float, ...]],
    motion: np.ndarray,
    steps: np.ndarray,
    angle: float,
    speed: float,
) -> np.ndarray:
    """Return less the central differences (2, 4) of a law's force by place and velocity (4,)."""
    ends = [
        [law(*(motion + move).tolist(), angle, speed)[:2] for move in (-each, each)]
        for each in np.diag(steps)
    ]
    return np.array([np.subtract(*pair) for pair in ends]).T / (2.0 * steps)
