"""A journal bearing with an oil film of finite length, in scenes and in linear analyses."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import hypot

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import (
    Bearing,
    Law,
    LawWithTorque,
    Linearised,
    by_tangent,
    differenced,
)
from exudyn_rotor.bearings.controlled_support import FilmSupport
from exudyn_rotor.bearings.film.equilibria import Equilibria
from exudyn_rotor.bearings.film.film import OilFilm
from exudyn_rotor.bearings.film.state import FilmState
from exudyn_rotor.bearings.film.void_states import COUNT
from exudyn_rotor.bearings.support import Support

_STEP = 1e-4  # of the clearance: of the tangent by which a film too thin goes on
LITTLE, _GRAVITY = 1e-2, 9.81  # of the mass that the film carries: what counts for its states
_AT_ONCE = 1e-7  # s/rad: what counts as the shortest step of time, times the step of the grid


@dataclass(frozen=True, eq=False, kw_only=True)
class JournalBearing(Bearing):
    """Journal bearing whose film is an :class:`OilFilm`.

    Linear analyses take its coefficients in the equilibrium under the load; scenes its force at
    every evaluation, with one axial profile (``axial_nodes=0``) twenty times as long as that of a
    :class:`ShortJournalBearing`, and its tangent for Jacobians. In scenes the journal's centre has
    its film where it is thicker all around than ``film.thinnest``, which the grid resolves; beyond,
    the force goes on by its tangent, so that Newton's method comes back. A film that conserves mass
    goes on with the voids of the last accepted step; a run begins with those of a journal that
    rests where it is. Linear analyses have what its voids remember as coordinates
    (:class:`VoidStates`).

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
    _equilibria: Equilibria[FilmState] = field(default_factory=Equilibria, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.instance(self.film, "film", OilFilm)

    @property
    def remembers(self) -> bool:
        """Whether the film's force depends on the motion before, as its voids do."""
        return self.film.cavitation == "mass-conserving"

    def _reach(self, direction: np.ndarray) -> float:
        return self.film.reach_along(direction, self.film.thinnest)

    def _gap(self, direction: np.ndarray | None = None) -> float:
        if direction is None:
            return self.film.clearance
        return self.film.reach_along(direction, 0.0)

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

    def _along(
        self, motion: np.ndarray, angles: np.ndarray, speed: float
    ) -> tuple[np.ndarray, np.ndarray]:
        law, forces, slopes = self._film_law(torque=False), [], []
        for x, y, vx, vy in motion.tolist():
            forces.append(law(x, y, vx, vy, 0.0, speed))
            slopes.append(np.hstack(law.slopes(x, y, vx, vy, 0.0, speed)))
        return np.array(forces), np.array(slopes)

    def _film_law(self, torque: bool) -> FilmLaw:
        if self.remembers:
            raise ValueError(
                f"bearing at {self.interface!r}: a film with cavitation='mass-conserving' has no "
                "force by place and velocity alone; add_supports gives it to a scene"
            )
        return FilmLaw(self.film, torque)

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

        Of a film that conserves mass those of unbalance, see :meth:`FilmState.coefficients`.
        Parameters and errors are those of :meth:`equilibrium`.
        """
        return self._state(speed, load).coefficients()

    def linearised(self) -> Support | FilmSupport:
        """Return the support for linear analyses: the film under the load at every speed.

        With what voids remember as coordinates where they conserve mass.

        Raises
        ------
        ValueError
            Where the bearing has no load.
        """
        if not self.remembers:
            return super().linearised()
        mass = LITTLE * float(np.linalg.norm(self._static_load(None))) / _GRAVITY
        inertia = np.full(COUNT // 2, mass)
        return FilmSupport(self.interface, inertia, _OfVoids(self, mass), Linearised(self, 0))

    def _state(self, speed: float, load: ArrayLike | None) -> FilmState:
        """Return the film in equilibrium."""
        return self._equilibria.at(speed, self._static_load(load), self._solved)

    def _solved(self, speed: float, load: np.ndarray) -> FilmState:
        """Return the film in equilibrium: from that of the speed beside, if this leads to one."""
        known = self._equilibria.beside(speed, load)
        found = known and self.film._beside(known, speed, load)
        return found or self.film.equilibrium(speed, load)


@dataclass(frozen=True, eq=False)
class _OfVoids:
    """Damping and stiffness of a :class:`FilmSupport`, whose coordinates have a mass [kg]."""

    bearing: JournalBearing
    mass: float

    def __call__(self, speed: float) -> tuple[np.ndarray, np.ndarray]:
        return self.bearing._state(speed, None).void_states.matrices(self.mass)


class FilmLaw:
    """Force of a film and, where asked for, torque; it begins with the film of the last call."""

    def __init__(self, film: OilFilm, torque: bool) -> None:
        self._film, self._torque = film, torque
        self._most = film.clearance - film.thinnest
        self._step = _STEP * film.clearance
        self._last: FilmState | None = None

    def __call__(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, ...]:
        rate = np.array([vx, vy])

        def force(a: float, b: float) -> tuple[float, ...]:
            state = self.state_at(np.array([a, b]), rate, speed)
            torque = (-state.torque,) if self._torque else ()
            return *state.force.tolist(), *torque

        most = self.to_the_edge(x, y)
        inside = hypot(x, y) <= most
        return force(x, y) if inside else by_tangent(force, x, y, most, self._step)

    def slopes(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return stiffness [N/m] and damping [N s/m], each (2, 2), as :meth:`Bearing.slopes`."""
        if hypot(x, y) > self.to_the_edge(x, y):
            size = self._film.clearance
            rate = max(size * abs(speed), hypot(vx, vy))
            steps = _STEP * np.array([size, size, rate, rate])
            found = differenced(self, np.array([x, y, vx, vy]), steps, angle, speed)
            return found[:, :2], found[:, 2:]
        return self.state_at(np.array([x, y]), np.array([vx, vy]), speed).tangent

    def torque(self, x: float, y: float, vx: float, vy: float, angle: float, speed: float) -> float:
        """Return the torque on the journal [N m]; beyond the film that at its end."""
        self(x, y, vx, vy, angle, speed)
        return -self._last.torque

    def to_the_edge(self, x: float, y: float) -> float:
        """Return how far the journal may go on its way out, the film resolved [m]."""
        distance = hypot(x, y)
        if distance <= self._most:
            return self._most
        return self._film.reach_along(np.array([x, y]) / distance, self._film.thinnest)

    def state_at(
        self,
        place: np.ndarray,
        rate: np.ndarray,
        speed: float,
        void_rate: float = 0.0,
        voids: np.ndarray | None = None,
    ) -> FilmState:
        """Return the film: that of the last call, where it is the same."""
        last = self._last
        if last is None or not last.is_at(place, rate, speed, void_rate, voids):
            empty = None if last is None else last.solution.empty
            self._last = self._film.law(place, rate, speed, empty, void_rate, voids)
        return self._last


class RememberingLaw(FilmLaw):
    """Force of a film that conserves mass, with its voids at the beginning of the step.

    To be told where each step begins, by :meth:`begin`, before it is asked for forces in the step.
    Steps may be repeated, shortened, or begin at an earlier time.
    """

    def __init__(self, film: OilFilm, torque: bool) -> None:
        super().__init__(film, torque)
        self._begun: tuple[float, float, float] | None = None
        self._voids = np.zeros((len(film.grid.angle), film.grid.width))
        self._duration = 0.0

    @property
    def voids(self) -> np.ndarray:
        """Their thickness at the beginning of the step, (n, m) [m]."""
        return self._voids

    def begin(
        self, time: float, x: float, y: float, vx: float, vy: float, speed: float, now: float
    ) -> None:
        """Take voids to the time and motion of the beginning of a step that is now at `now` [s]."""
        begun = time, x, y
        if begun != self._begun:
            goes_on = self._begun is not None and time > self._begun[0]
            self._duration = time - self._begun[0] if goes_on else np.inf
            place = np.array([x, y]) * min(1.0, self.to_the_edge(x, y) / max(hypot(x, y), 1e-300))
            if goes_on or speed != 0.0:
                rate = np.array([vx, vy]) if goes_on else np.zeros(2)
                solved = self.state_at(place, rate, speed)
                self._voids = solved.solution.void * solved.heights[:, None]
            else:
                self._voids = np.zeros_like(self._voids)
            self._begun = begun
        self._duration = now - time

    def state_at(self, place: np.ndarray, rate: np.ndarray, speed: float) -> FilmState:
        # at once where no time has passed, but for rounding
        duration = max(self._duration, _AT_ONCE * float(self._film.grid.step.min()))
        return super().state_at(place, rate, speed, 1.0 / duration, self._voids)


def tangent_of(state: FilmState) -> tuple[np.ndarray, np.ndarray]:
    """Return stiffness and damping (2, 2) of the tangent at a place of the journal.

    Of films that conserve mass those of slow motion: the derivatives of the force that scenes have
    where they look for an equilibrium.
    """
    if state.film.cavitation == "mass-conserving":
        return state.slow_stiffness, state.slow_damping
    return state.coefficients()
