"""What every bearing with a law of its own offers to scenes and linear analyses."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from math import hypot, inf
from typing import ClassVar, Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.controlled_support import ControlledSupport, table_of
from exudyn_rotor.bearings.support import COEFFICIENTS, NoCoefficientsError, Support

_REMEMBERED = 1000  # coefficients of a bearing
_FAILED = ValueError, ArithmeticError
_INSIDE = 1.0 - 1e-9  # of the way to the last film, by rounding
_DIFFERENCE, _STILL = 1e-4, 1e-6  # of a motion, which is at least that in SI units
HIGHER = 10.0 ** np.arange(7)  # rad/s, where only the directions that a bearing holds count

Numbers = float | np.ndarray
Force = tuple[float, float]  # on the journal along n1 and n2 [N]
Pair = tuple[np.ndarray, np.ndarray]  # by place and by velocity
LawWithTorque = Callable[[float, float, float, float, float, float], tuple[float, float, float]]


State = TypeVar("State")


class Equilibria(Generic[State]):
    """The last equilibria, or what follows from them, by speed and load; or why there is none."""

    def __init__(self, most: int = 64) -> None:
        self._known: dict[tuple[float, ...], State | Exception] = {}
        self._most = most

    def at(
        self, speed: float, load: np.ndarray, solve: Callable[[float, np.ndarray], State]
    ) -> State:
        """Return ``solve(speed, load)``; its errors are kept, too."""
        key = checks.number(speed, "speed", "rad/s"), *load.tolist()
        found = self._known.get(key)
        if found is None:
            try:
                found = solve(speed, load)
            except _FAILED as error:
                found = error.with_traceback(None)
            while len(self._known) >= self._most:
                self._known.pop(next(iter(self._known)), None)
            self._known[key] = found
        if isinstance(found, _FAILED):
            raise type(found)(*found.args)
        return found

    def _under(self, load: np.ndarray) -> list[tuple[float, State | Exception]]:
        """Return the speeds at which something is known under a load, and what it is."""
        wanted = (*load.tolist(),)
        return [(key[0], found) for key, found in list(self._known.items()) if key[1:] == wanted]

    def beside(self, speed: float, load: np.ndarray) -> State | None:
        """Return what is known at the nearest speed of the same sense, if any."""
        known = [
            (abs(other - speed), found)
            for other, found in self._under(load)
            if other * speed > 0.0 and not isinstance(found, _FAILED)
        ]
        return min(known, key=lambda each: each[0])[1] if known else None

    def is_refused_above(self, speed: float, load: np.ndarray) -> bool:
        """Return whether there is none at a faster speed of the same sense, nor a known slower one.

        Films carry less at slower speeds.
        """
        own = [(other / speed, found) for other, found in self._under(load)]
        refused = any(ratio > 1.0 and isinstance(one, _FAILED) for ratio, one in own)
        return refused and all(ratio > 1.0 or isinstance(one, _FAILED) for ratio, one in own)


class NoEquilibriumError(NoCoefficientsError):
    """A bearing under load has no equilibrium at a speed, as films at rest."""


@dataclass(frozen=True, eq=False, kw_only=True)
class LoadedBearing(ABC):
    """A bearing across the axis that holds its journal in an equilibrium under a static load.

    Components are along (n1, n2) of :attr:`SpinAxis.plane`, which stand still, from the centre of
    the bearing, where the axis of the rotor at rest passes. Linear analyses take the bearing about
    its equilibrium under the static `load` on the journal [N], see
    :func:`exudyn_rotor.bearing_loads`; scenes do not need it. What `carries` takes a share of the
    rotor's weight.
    """

    carries: ClassVar[bool] = True
    _unloaded: ClassVar[bool] = False  # whether no load counts as one of zero

    interface: str
    load: np.ndarray | None = None

    def __post_init__(self) -> None:
        checks.label(self.interface, "interface")
        if self.load is not None:
            checks.keep(self, load=checks.vector(self.load, "load", "N", size=2))

    def equilibrium(self, speed: float, load: ArrayLike | None = None) -> np.ndarray:
        """Return where the journal rests under a static load [m], shape (2,).

        Parameters
        ----------
        speed : float
            Spin speed [rad/s].
        load : array_like, shape (2,), optional
            On the journal along (n1, n2) [N]; that of the bearing by default.

        Raises
        ------
        TypeError, ValueError, ArithmeticError
            For bad input, a missing load, and where there is no equilibrium, as in a film at rest.
        """
        return self._rest(checks.number(speed, "speed", "rad/s"), self._static_load(load))

    def _rest(self, speed: float, load: np.ndarray) -> np.ndarray:
        """Return where the journal rests [m]: the centre, of what carries nothing."""
        return np.zeros(2)

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
            Ascending spin speeds, and frequencies > 0 of the motion [rad/s].

        Raises
        ------
        TypeError, ValueError
            For bad input, a missing load, a speed without an equilibrium, as films at rest, and
            sensors elsewhere than where the bearing acts.

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
    def linearised(self) -> Support | ControlledSupport:
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

    Scenes ask for :attr:`law` and :meth:`slopes` in every step, harmonic balance for
    :meth:`law_along`, all without checks. Where the spin is free, scenes ask for `law_with_torque`:
    the force, and the torque on the journal about the axis [N m]; None of bearings without one.
    """

    law_with_torque: ClassVar[LawWithTorque | None] = None

    _tried: ClassVar[np.ndarray] = HIGHER
    _linear: Equilibria[tuple[np.ndarray, ...]] = field(
        default_factory=lambda: Equilibria(_REMEMBERED), init=False, repr=False
    )

    def law(self, x: float, y: float, vx: float, vy: float, angle: float, speed: float) -> Force:
        """Return the force on the journal [N] by x, y, ẋ, ẏ, θ and Ω, anywhere, unchecked."""
        return self.law_with_torque(x, y, vx, vy, angle, speed)[:2]

    def slopes(self, x: float, y: float, vx: float, vy: float, angle: float, speed: float) -> Pair:
        """Return less the derivatives (2, 2) of :meth:`law` by place and by velocity.

        By central differences in this class.
        """
        return differences(self.law, x, y, vx, vy, angle, speed)

    def law_along(self, motion: np.ndarray, angles: np.ndarray, speed: float) -> Pair:
        """Return forces and their derivatives along motions (t, 4).

        Of displacements and velocities [m], [m/s], spin angles (t,) and the spin speed: forces
        (t, 2) [N], and minus their derivatives by the motion, (t, 2, 4).
        """
        states = [(*state, a) for state, a in zip(motion.tolist(), angles.tolist(), strict=True)]
        forces = [self.law(*state, speed) for state in states]
        slopes = [np.hstack(self.slopes(*state, speed)) for state in states]
        return np.reshape(forces, (-1, 2)), np.reshape(slopes, (-1, 2, 4))

    def clearance_along(self, direction: np.ndarray | None = None) -> float:
        """Return how far that way, of length 1 (2,), or at least, the journal may go [m].

        Infinity for a bearing without a clearance.
        """
        return inf

    def film_edge(self, x: float, y: float) -> float:
        """Return how far the journal may go, on the way to a place, for a film to be there [m].

        Beyond, the force is no longer the film's: it goes on by its tangent. Infinite without one.
        """
        return inf

    def _inside(self, x: float, y: float) -> tuple[float, float]:
        """Return the last place with a film on the way to a place [m]."""
        share = min(1.0, _INSIDE * self.film_edge(x, y) / max(hypot(x, y), 1e-300))
        return share * x, share * y

    def _beyond(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> Force:
        """Return the force where there is no film, by the tangent of the last one.

        So Newton's method comes back from such places.
        """
        a, b = self._inside(x, y)
        fx, fy = self.law(a, b, vx, vy, angle, speed)
        gx, gy = (self.slopes(a, b, vx, vy, angle, speed)[0] @ (x - a, y - b)).tolist()
        return fx - gx, fy - gy

    def coefficients(self, speed: float, load: ArrayLike | None = None) -> Pair:
        """Return stiffness [N/m] and damping [N s/m] about the equilibrium, each (2, 2).

        Parameters and errors are those of :meth:`equilibrium`.
        """
        return self._matrices(checks.number(speed, "speed", "rad/s"), self._static_load(load))

    @abstractmethod
    def _matrices(self, speed: float, load: np.ndarray) -> Pair:
        """Return stiffness and damping about the equilibrium."""

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
        refused: Exception | None = None
        for tried in (speed, *self.bearing._tried):
            try:
                return self._value(tried)
            except _FAILED as error:
                refused = refused or error  # that of the speed that was asked for
        raise refused

    def _value(self, speed: float) -> np.ndarray:
        bearing = self.bearing
        found = bearing._linear.at(speed, bearing._static_load(None), bearing.coefficients)
        return found[self.index]

    def check_range(self, speed: float) -> None:
        """Refuse a speed at which the bearing has no equilibrium."""
        try:
            self._value(speed)
        except _FAILED as error:
            name = f"bearing at {self.bearing.interface!r}"
            reason = "at 0 rad/s its film carries nothing" if speed == 0.0 else str(error)
            reason = reason if name in reason else f"{name}: {reason}"
            raise NoEquilibriumError(reason) from error


def differences(
    law: Callable[..., tuple[float, ...]],
    x: float,
    y: float,
    vx: float,
    vy: float,
    angle: float,
    speed: float,
) -> Pair:
    """Return less the derivatives of a law's n results by place and by velocity, each (n, 2)."""
    motion, size = np.array([x, y, vx, vy]), max(hypot(x, y), _STILL)
    steps = _DIFFERENCE * np.repeat([size, max(size * abs(speed), hypot(vx, vy), size)], 2)
    ends = [
        [law(*(motion + move), angle, speed) for move in (-each, each)] for each in np.diag(steps)
    ]
    found = np.array([np.subtract(*pair) for pair in ends]).T / (2.0 * steps)
    return found[:, :2], found[:, 2:]


def bearing_of(support: object) -> Bearing | None:
    """Return the bearing whose coefficients a support has; None for coefficients of its own."""
    given = (getattr(support, name, None) for name in COEFFICIENTS)
    return next((each.bearing for each in given if isinstance(each, Linearised)), None)


def check_clearance(clearance: float, radius: float, name: str = "clearance") -> None:
    """Refuse a clearance as large as the radius: one of a diameter, or in other units."""
    if clearance >= radius:
        raise ValueError(
            f"{name}: needs the radial clearance, far below the radius of {radius:g} m, got "
            f"{clearance:g} m"
        )


def turned(c: Numbers, s: Numbers, *entries: Numbers) -> list[Numbers]:
    """Return the four entries of ``R M Rᵀ``, row by row as M's, R the rotation of (c, s)."""
    a, b, d, e = entries
    a, b, d, e = c * a - s * d, c * b - s * e, s * a + c * d, s * b + c * e
    return [c * a - s * b, s * a + c * b, c * d - s * e, s * d + c * e]
