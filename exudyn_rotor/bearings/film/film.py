"""Oil film of a journal bearing of finite length: force, equilibrium, coefficients, losses.

Reynolds' equation (`reynolds.py`) in the film of a journal that stays parallel to the bore:
isothermal, laminar, incompressible, without the oil's inertia.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.film.data import FilmData
from exudyn_rotor.bearings.film.reynolds import Equation
from exudyn_rotor.bearings.film.state import FilmState

_STEPS, _VAIN = 100, 3  # of Newton's method, of those in vain
_CLOSE = 1e-9  # of the load: it stops there
# places at which it begins: over the clearance, and turned from the most likely side
_STARTS = [
    (ratio, np.linalg.matrix_power(np.array([[0.0, -1.0], [1.0, 0.0]]), quarters))
    for ratio, quarters in ((0.35, 0), *itertools.product((0.5, 0.2), range(4)))
]


@dataclass(frozen=True, eq=False)
class OilFilm(FilmData):
    """Oil film in a bore of one or more pads.

    Parameters
    ----------
    radius, length : float
        Of the journal, and of the bore [m].
    viscosity : float
        Dynamic [Pa s].
    pads : sequence of Pad
        :func:`grooved_pads` makes those of plain, grooved, elliptical and lobed bores.
    cavitation : {'reynolds', 'half-sommerfeld', 'mass-conserving', 'none'}, optional
        What holds where the film would be pulled. 'reynolds' (p ≥ 0, p and its slope vanish where
        the film breaks) is what tables of coefficients mostly hold; 'mass-conserving' adds the
        oil's balance in the void. It has a memory, which a force of place and velocity has not:
        steady states and coefficients are here, motions by :class:`JournalBearing` in scenes. It
        needs a groove, from which the oil comes.
    supply_pressure : float, optional
        In the grooves, which are as long as the bore, above the ambient [Pa].
    nodes : int, optional
        Around the whole circle.
    axial_nodes : int, optional
        Over half the length; 0 takes one profile for the pressure along the axis, exact for small
        eccentricities and for short bores, at a small part of the cost.

    Raises
    ------
    TypeError, ValueError
        For sizes that are not positive, pads that overlap, a supply without a groove.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import OilFilm, grooved_pads
    >>> pads = grooved_pads(1e-4, [np.pi / 2, 3 * np.pi / 2], np.radians(20.0))
    >>> film = OilFilm(radius=0.05, length=0.05, viscosity=0.02, pads=pads, axial_nodes=0)
    >>> state = film.equilibrium(300.0, load=[-5000.0, 0.0])
    >>> round(state.eccentricity_ratio, 2), round(np.degrees(state.attitude))
    (0.66, 40)
    >>> stiffness, damping = state.coefficients()
    """

    def force(self, displacement: ArrayLike, velocity: ArrayLike, speed: float) -> np.ndarray:
        """Return the force of the film on the journal along n1 and n2, (2,) [N].

        Parameters are those of :meth:`state`.
        """
        return self.state(displacement, velocity, speed).force

    def state(self, displacement: ArrayLike, velocity: ArrayLike, speed: float) -> FilmState:
        """Return the film at one place and motion of the journal.

        Parameters
        ----------
        displacement, velocity : array_like, (2,)
            Of the journal's centre against the bearing's, along n1 and n2 [m], [m/s].
        speed : float
            Of the journal, positive from n1 to n2 [rad/s].

        Raises
        ------
        TypeError
        ValueError
            If the journal touches the bore, or moves in a film that conserves mass.
        ArithmeticError
            If the voids do not settle.
        """
        displacement = checks.vector(displacement, "displacement", "m", 2)
        velocity = checks.vector(velocity, "velocity", "m/s", 2)
        checks.number(speed, "speed", "rad/s")
        if self.cavitation == "mass-conserving" and velocity.any():
            raise ValueError(
                "velocity: a film with cavitation='mass-conserving' remembers how its voids grew, "
                "which a force of place and velocity cannot; put a JournalBearing into a scene, or "
                "use 'reynolds'"
            )
        return self._state(displacement, velocity, speed)

    @property
    def law(self) -> Callable[..., FilmState]:
        """For bearings: :meth:`state` without its checks, also of a film that conserves mass.

        After place, velocity and speed it takes the cells that were empty before, to begin with,
        the rate [1/s] at which voids grow from the content before, and that content.
        """
        return self._state

    def equilibrium(self, speed: float, load: ArrayLike) -> FilmState:
        """Return the film that carries a load, by Newton's method with the film's stiffness.

        It begins on the side where a plain bore carries, and where that fails, all around. Of
        several equilibria, as films that bear tension may have them, the first found is returned.

        Parameters
        ----------
        speed : float
            [rad/s], not 0.
        load : array_like, (2,)
            On the journal along n1 and n2 [N].

        Raises
        ------
        TypeError
        ValueError
            For no load, no speed, and a load under which the film is thinner than the grid
            resolves.
        ArithmeticError
            If no equilibrium is found, as under a load that points into the only groove of a film
            that conserves mass.
        """
        load = checks.vector(load, "load", "N", 2)
        checks.number(speed, "speed", "rad/s")
        size = float(np.linalg.norm(load))
        if size == 0.0:
            raise ValueError("load: needs a force other than 0: without one a film has no side")
        if speed == 0.0:
            raise ValueError(
                "speed: needs a number other than 0 rad/s: at rest a film carries nothing"
            )
        ahead = np.array([[1.0, -np.sign(speed)], [np.sign(speed), 1.0]]) @ load / size
        left, thin = np.inf, False
        for ratio, turn in _STARTS:
            state = self._newton(ratio * self.clearance * turn @ ahead, load, speed)
            if state is None:
                thin = True
                continue
            left = min(left, float(np.linalg.norm(state.force + load)) / size)
            if left < _CLOSE:
                return state
        if thin:
            raise ValueError(
                f"load: {size:g} N at {speed:g} rad/s presses the film below "
                f"{self.thinnest:.3g} m, which {self.nodes} nodes do not resolve; give more "
                "nodes, or a smaller load"
            )
        raise ArithmeticError(
            f"film: no equilibrium found for the load {load} N at {speed:g} rad/s: {left:.1e} of "
            "it is left; a load that points into a groove may have none"
        )

    def _beside(self, known: FilmState, speed: float, load: np.ndarray) -> FilmState | None:
        """Return the film that carries a load, from one beside it; None where none is so found.

        Of films that bear tension, and where a journal would run off, none: there may be another.
        """
        found = self._newton(known.position, load, speed, known.solution.empty)
        if found is None or self.cavitation == "none":
            return None
        left = float(np.linalg.norm(found.force + load))
        held = left < _CLOSE * np.linalg.norm(load) and np.linalg.det(found.slow_stiffness) > 0.0
        return found if held else None

    def _newton(
        self, start: np.ndarray, load: np.ndarray, speed: float, empty: np.ndarray | None = None
    ) -> FilmState | None:
        """Return where Newton's method ends; None for a film thinner than the grid resolves."""
        state, vain, size = self._state(start, np.zeros(2), speed, empty), 0, np.linalg.norm(load)
        for _ in range(_STEPS):
            unbalanced = np.linalg.norm(state.force + load)
            if unbalanced < _CLOSE * size or vain == _VAIN:
                break
            state = self._next(state, load)
            if self._heights(state.position).min() < self.thinnest:
                return None
            vain += np.linalg.norm(state.force + load) >= unbalanced
        return state

    def _next(self, state: FilmState, load: np.ndarray) -> FilmState:
        """Return the state after one step, shortened until the force comes closer to the load."""
        unbalanced = state.force + load
        move = np.linalg.lstsq(state.slow_stiffness, unbalanced, rcond=1e-12)[0]
        move *= min(1.0, 0.6 / state.closing(move))
        for _ in range(12):
            # the cells that are empty now: few steps from those of the next place
            motion = state.position + move, state.velocity, state.speed
            found = self._state(*motion, state.solution.empty)
            if np.linalg.norm(found.force + load) < np.linalg.norm(unbalanced):
                break
            move *= 0.5
        return found

    def _state(
        self,
        position: np.ndarray,
        velocity: np.ndarray,
        speed: float,
        empty: np.ndarray | None = None,
        void_rate: float = 0.0,
        voids: np.ndarray | None = None,
    ) -> FilmState:
        heights = self._heights(position)
        if heights.min() <= 0.0:
            raise ValueError(
                f"displacement: {position.tolist()} m is outside the clearance of "
                f"{self.clearance:g} m"
            )
        rates = -self.grid.u[0] @ velocity
        source = 12.0 * self.viscosity * self.radius**2
        film = self.grid, self.cavitation, source, self.supply_pressure
        equation = Equation(*film, heights, rates, speed, void_rate, voids)
        return FilmState(self, position, velocity, speed, equation.solve(empty))
