"""A journal bearing with an oil film of finite length, in scenes and in linear analyses."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import hypot

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import Bearing, Law, LawWithTorque, by_tangent
from exudyn_rotor.bearings.film.film import OilFilm
from exudyn_rotor.bearings.film.state import FilmState

_STEP = 1e-4  # of the clearance: of the tangent by which a film too thin goes on


@dataclass(frozen=True, eq=False, kw_only=True)
class JournalBearing(Bearing):
    """Journal bearing whose film is an :class:`OilFilm`.

    Linear analyses take its coefficients in the equilibrium under the load; scenes its force at
    every evaluation, with one axial profile (``axial_nodes=0``) twenty times as long as that of a
    :class:`ShortJournalBearing`. In scenes the journal's centre has its film where it
    is thicker all around than ``film.thinnest``, which the grid resolves; beyond, the force goes on
    by its tangent, so that Newton's method comes back.

    Parameters
    ----------
    interface : str
        Interface of the rotor that is the journal.
    film : OilFilm
        With the directions n1 and n2 of the rotor at rest.
    load : array_like, shape (2,), optional
        Static load on the journal along (n1, n2) [N], which linear analyses need.

    Raises
    ------
    TypeError, ValueError
        For bad input.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import JournalBearing, OilFilm, grooved_pads
    >>> pads = grooved_pads(1e-4, [0.0, np.pi], np.radians(20.0))
    >>> film = OilFilm(radius=0.05, length=0.05, viscosity=0.02, pads=pads, axial_nodes=0)
    >>> bearing = JournalBearing(interface="left", film=film, load=[0.0, -5000.0])
    >>> stiffness, damping = bearing.coefficients(speed=300.0)
    >>> bool(np.hypot(*bearing.equilibrium(300.0)) < film.clearance)
    True
    """

    film: OilFilm
    _last: dict[tuple[float, ...], FilmState] = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.instance(self.film, "film", OilFilm)

    def _reach(self, direction: np.ndarray) -> float:
        return self.film._reach(direction)

    @property
    def _law(self) -> Law:
        return self._film_law(torque=False)

    @property
    def law_with_torque(self) -> LawWithTorque:
        """As :attr:`law`, with the torque on the journal [N m]; see :attr:`FilmState.torque`.

        Each begins with the voids of its last call, which are few steps away in a scene. That saves
        time; the pressure, which is unique, stays the same to rounding.

        Raises
        ------
        ValueError
            For a film that conserves mass: it has a memory of its own.
        """
        return self._film_law(torque=True)

    def _film_law(self, torque: bool) -> _FilmLaw:
        if self.film.cavitation == "mass-conserving":
            raise ValueError(
                f"bearing at {self.interface!r}: a film with cavitation='mass-conserving' has no "
                "force by place and velocity alone; scenes need another cavitation"
            )
        return _FilmLaw(self.film, torque)

    def equilibrium(self, speed: float, load: ArrayLike | None = None) -> np.ndarray:
        """Return where the journal rests under a static load [m], shape (2,).

        Parameters
        ----------
        speed : float
            Spin speed [rad/s].
        load : array_like, shape (2,), optional
            On the journal [N]; that of the bearing by default.

        Raises
        ------
        TypeError, ValueError, ArithmeticError
            As :meth:`OilFilm.equilibrium`, and for a missing load.
        """
        return self._state(speed, load).position.copy()

    def coefficients(
        self, speed: float, load: ArrayLike | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return stiffness [N/m] and damping [N s/m] about the equilibrium, each (2, 2).

        Parameters and errors are those of :meth:`equilibrium`.
        """
        return self._state(speed, load).coefficients()

    def _state(self, speed: float, load: ArrayLike | None) -> FilmState:
        """Return the film in equilibrium; the last one is kept, for several ask for it in turn."""
        load = self._static_load(load)
        key = checks.number(speed, "speed", "rad/s"), *load.tolist()
        if key not in self._last:
            state = self.film.equilibrium(speed, load)
            self._last.clear()
            self._last[key] = state
        return self._last[key]


class TangentFilm:
    """Force of a journal bearing that goes on by its tangent, once held, from the next place.

    The tangent is that of :meth:`FilmState.coefficients`: differences would cross the places at
    which the film's edge moves to the next node.
    """

    def __init__(self, bearing: JournalBearing) -> None:
        self._film, self._whole = bearing.film, bearing.law_with_torque
        self._tangent: tuple[FilmState, np.ndarray] | None = None
        self._held = False

    def hold(self, held: bool) -> None:
        """Hold the force by the tangent from the next place on, or let it go."""
        self._held, self._tangent = held, None

    def law(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, float]:
        """Return the force as :attr:`Bearing.law`."""
        motion = np.array([x, y, vx, vy])
        if self._held and self._tangent is None:
            self._held = hypot(x, y) <= self._film.clearance - self._film.thinnest
            if self._held:
                state = self._film._state(motion[:2], motion[2:], speed)
                self._tangent = state, np.hstack(state.coefficients())
        if self._tangent is None:
            return self._whole(x, y, vx, vy, angle, speed)[:2]
        state, gradient = self._tangent
        change = gradient @ (motion - np.append(state.position, state.velocity))
        fx, fy = (state.force - change).tolist()
        return fx, fy

    def law_with_torque(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, float, float]:
        """Return force and torque as :attr:`Bearing.law_with_torque`; the torque has no tangent."""
        torque = self._whole(x, y, vx, vy, angle, speed)[2]
        return *self.law(x, y, vx, vy, angle, speed), torque


class _FilmLaw:
    """Force of a film and, where asked for, torque; it remembers its voids."""

    def __init__(self, film: OilFilm, torque: bool) -> None:
        self._film, self._torque = film, torque
        self._most = film.clearance - film.thinnest
        self._step = _STEP * film.clearance
        self._empty: np.ndarray | None = None

    def __call__(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, ...]:
        rate = np.array([vx, vy])

        def force(a: float, b: float) -> tuple[float, ...]:
            state = self._film._state(np.array([a, b]), rate, speed, self._empty)
            self._empty = state.solution.empty
            torque = (-state.torque,) if self._torque else ()
            return *state.force.tolist(), *torque

        distance = hypot(x, y)
        if distance <= self._most:
            return force(x, y)
        most = self._film._reach(np.array([x, y]) / distance)
        return force(x, y) if distance <= most else by_tangent(force, x, y, most, self._step)
