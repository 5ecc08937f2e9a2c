"""A journal bearing with an oil film of finite length, in scenes and in linear analyses."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import hypot

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import Bearing, Equilibria, Force, Pair
from exudyn_rotor.bearings.film.film import FilmState, OilFilm


@dataclass(frozen=True, eq=False, kw_only=True)
class JournalBearing(Bearing):
    """Journal bearing whose film is an :class:`OilFilm`.

    Linear analyses take its coefficients in the equilibrium under the load; scenes its force at
    every evaluation, with one axial profile (``axial_nodes=0``) twenty times as long as that of a
    :class:`ShortJournalBearing`, and its tangent for Jacobians. In scenes the journal's centre has
    its film where it is thicker all around than ``film.thinnest``, which the grid resolves; beyond,
    the force goes on by its tangent, so that Newton's method comes back.

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
    # of the last call: the next one begins with its cells, the pressure stays the same to rounding
    _last: dict[tuple, FilmState] = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.instance(self.film, "film", OilFilm)

    def film_edge(self, x: float, y: float) -> float:
        """Return how far the grid resolves a film on the way to a place, or less [m]."""
        distance, most = hypot(x, y), self.film.clearance - self.film.thinnest
        if distance <= most:
            return most
        return self.film.reach_along(np.array([x, y]) / distance, self.film.thinnest)

    def clearance_along(self, direction: np.ndarray | None = None) -> float:
        """Return how far that way, of length 1 (2,), or at least, the journal may go [m]."""
        if direction is None:
            return self.film.clearance
        return self.film.reach_along(direction, 0.0)

    def law(self, x: float, y: float, vx: float, vy: float, angle: float, speed: float) -> Force:
        """Return the force on the journal [N]; a film too thin for the grid goes on straight."""
        if hypot(x, y) > self.film_edge(x, y):
            return self._beyond(x, y, vx, vy, angle, speed)
        return tuple(self._film_at(x, y, vx, vy, speed).force.tolist())

    def law_with_torque(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, float, float]:
        """As :meth:`law`, with the torque on the journal [N m]; see :attr:`FilmState.torque`."""
        force = self.law(x, y, vx, vy, angle, speed)
        return *force, -self._film_at(*self._inside(x, y), vx, vy, speed).torque

    def slopes(self, x: float, y: float, vx: float, vy: float, angle: float, speed: float) -> Pair:
        """Return less the derivatives (2, 2) of :meth:`law` by place and by velocity."""
        if hypot(x, y) > self.film_edge(x, y):
            return super().slopes(x, y, vx, vy, angle, speed)
        return self._film_at(x, y, vx, vy, speed).coefficients()

    def _film_at(self, x: float, y: float, vx: float, vy: float, speed: float) -> FilmState:
        """Return the film; that of the last call, where it is the same."""
        key = x, y, vx, vy, speed
        found = self._last.get(key)
        if found is None:
            known = next(iter(self._last.values()), None)
            empty = None if known is None else known.solution.empty
            found = self.film.solved(np.array([x, y]), np.array([vx, vy]), speed, empty)
            self._last.clear()
            self._last[key] = found
        return found

    def _rest(self, speed: float, load: np.ndarray) -> np.ndarray:
        """Return where the film carries the load [m]."""
        return self._state(speed, load).position.copy()

    def _matrices(self, speed: float, load: np.ndarray) -> Pair:
        """Return the film's coefficients in equilibrium."""
        return self._state(speed, load).coefficients()

    def _state(self, speed: float, load: np.ndarray) -> FilmState:
        """Return the film in equilibrium."""
        return self._equilibria.at(speed, load, self._solved)

    def _solved(self, speed: float, load: np.ndarray) -> FilmState:
        """Return the film in equilibrium: from that of the speed beside, if this leads to one."""
        known = self._equilibria.beside(speed, load)
        found = known and self.film.beside(known, speed, load)
        return found or self.film.equilibrium(speed, load)
