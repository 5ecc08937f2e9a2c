"""Oil film of a journal bearing of finite length: force, equilibrium, coefficients, losses.

Reynolds' equation (`reynolds.py`) in the film of a journal that stays parallel to the bore:
isothermal, laminar, incompressible, without the oil's inertia.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import check_clearance
from exudyn_rotor.bearings.film.grid import Axial, Grid
from exudyn_rotor.bearings.film.pads import Pad
from exudyn_rotor.bearings.film.reynolds import CAVITATION, Equation, Solution
from exudyn_rotor.calls import kept

_PEAK = 4.5  # the pressure's peak, √(2 h_min/c) wide, holds three nodes
_STEPS, _VAIN, _HALVES = 100, 3, 12  # of Newton's method, in vain, halvings of one
_CLOSE = 1e-9  # of the load: it stops there
# places at which it begins: over the clearance, and turned from the most likely side
_STARTS = [
    (ratio, np.linalg.matrix_power(np.array([[0.0, -1.0], [1.0, 0.0]]), quarters))
    for ratio, quarters in ((0.35, 0), *itertools.product((0.5, 0.2), range(4)))
]


@dataclass(frozen=True, eq=False)
class FilmState:
    """OilFilm at one place and motion of the journal, from :meth:`OilFilm.state` and `equilibrium`.

    Attributes
    ----------
    film : OilFilm
    position, velocity : numpy.ndarray, (2,)
        Of the journal along n1 and n2 [m], [m/s].
    speed : float
        [rad/s].
    solution : Solution
        Pressure at the nodes of the grid.
    """

    film: OilFilm
    position: np.ndarray
    velocity: np.ndarray
    speed: float
    solution: Solution

    @cached_property
    def force(self) -> np.ndarray:
        """Force on the journal along n1 and n2 [N]."""
        return self._resultant(self.solution.bearing)

    @kept
    def coefficients(self) -> tuple[np.ndarray, np.ndarray]:
        """Return stiffness −∂F/∂q [N/m] and damping −∂F/∂q̇ [N s/m] along n1 and n2, each (2, 2).

        The derivatives of the discrete film's force (Lund's perturbation): where the film is
        broken it stays so, and the pressure at the rim of a void stays zero.
        """
        u = np.moveaxis(self.film.grid.u, 2, 0)
        still = np.zeros_like(u)
        heights, rates = np.concatenate([-u, still]), np.concatenate([still, -u])[:, 0]
        changes = self.solution.change(heights, rates)
        gradient = -np.array([self._resultant(change) for change in changes]).T
        return checks.read_only(gradient[:, :2]), checks.read_only(gradient[:, 2:])

    def _resultant(self, pressure: np.ndarray) -> np.ndarray:
        grid = self.film.grid
        along = grid.step * (pressure @ grid.axial.weights)
        return -(self.film.radius**2) * (along @ grid.u[0])

    @property
    def heights(self) -> np.ndarray:
        """Thickness at the nodes of the grid, (n,) [m]."""
        return self.solution.equation.heights[0]

    def closing(self, move: np.ndarray) -> float:
        """Return the largest share of its thickness that a move of the journal (2,) takes [m]."""
        taken = self.film.grid.u @ move / self.solution.equation.heights
        return float(np.max(taken, initial=1e-300))

    @property
    def minimum_thickness(self) -> float:
        """Least thickness at the nodes [m]."""
        return float(self.heights.min())

    @property
    def pressure(self) -> np.ndarray:
        """Pressure at the angles and axial places of the grid, (n, k) [Pa]."""
        return self.solution.bearing @ self.film.grid.axial.shapes.T

    @property
    def eccentricity_ratio(self) -> float:
        """Distance of the journal from the middle over the least clearance there."""
        return float(np.linalg.norm(self.position) / self.film.clearance)

    @property
    def attitude(self) -> float:
        """Angle from the load, −force, to the journal's place, positive with the spin [rad]."""
        sense = 1.0 if self.speed >= 0.0 else -1.0
        (f1, f2), (q1, q2) = -self.force, self.position
        return float(sense * np.arctan2(f1 * q2 - f2 * q1, f1 * q1 + f2 * q2))

    @property
    def torque(self) -> float:
        """Torque that the film takes from the journal, positive against a positive spin [N m].

        Shear of the surface, μ R Ω/h, where there is oil, and of the pressure, (h/2R) ∂φ p,
        integrated by parts. Where the film is broken the gap counts as full.
        """
        film, grid = self.film, self.film.grid
        axial, equation = grid.axial, self.solution.equation
        size = film.length / film.radius
        # the half volumes at edges have the thickness of their faces
        ends = ~np.array([grid.at_left, grid.at_right]) / equation.heights[1:]
        covered = grid.step * (1.0 / self.heights + 0.5 * ends.sum(axis=0))
        shear = film.viscosity * film.radius**4 * self.speed * size * covered.sum()
        slope = equation.heights[2] - equation.heights[1]
        lift = -(slope @ (self.solution.bearing @ axial.weights))
        return float(shear + 0.5 * film.radius**2 * lift)

    @property
    def side_flow(self) -> float:
        """Oil that leaves the pads at both ends [m³/s]."""
        film, grid = self.film, self.film.grid
        slope = self.solution.bearing @ grid.axial.edge
        return float((grid.step * self.heights**3) @ slope / (6.0 * film.viscosity))


@dataclass(frozen=True, eq=False)
class OilFilm:
    """Oil film in a bore of one or more pads.

    Parameters
    ----------
    radius, length : float
        Of the journal, and of the bore [m].
    viscosity : float
        Dynamic [Pa s].
    pads : sequence of Pad
        :func:`grooved_pads` makes those of plain, grooved, elliptical and lobed bores.
    cavitation : {'reynolds', 'half-sommerfeld', 'none'}, optional
        What holds where the film would be pulled. 'reynolds' (p ≥ 0, p and its slope vanish where
        the film breaks) is what tables of coefficients mostly hold.
    nodes : int, optional
        Around the whole circle.
    axial_nodes : int, optional
        Over half the length; 0 takes one profile for the pressure along the axis, exact for small
        eccentricities and for short bores, at a small part of the cost.

    Raises
    ------
    TypeError, ValueError
        For sizes that are not positive, and pads that overlap.

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

    radius: float
    length: float
    viscosity: float
    pads: Sequence[Pad]
    cavitation: str = "reynolds"
    nodes: int = 120
    axial_nodes: int = 12
    grid: Grid = field(init=False, repr=False)

    def __post_init__(self) -> None:
        units = {"radius": "m", "length": "m", "viscosity": "Pa s"}
        checks.keep_numbers(self, units, above=0.0)
        checks.choice(self.cavitation, "cavitation", CAVITATION)
        checks.count(self.nodes, "nodes", least=12, most=10_000)
        checks.count(self.axial_nodes, "axial_nodes", most=1000)
        if self.axial_nodes == 1:
            raise ValueError("axial_nodes: needs 0 (one profile), or 2 nodes or more, got 1")
        pads = _in_order(checks.instances(self.pads, "pads", Pad))
        check_clearance(max(pad.clearance for pad in pads), self.radius, "pads")
        half = 0.5 * self.length / self.radius
        axial = Axial.volumes(half, self.axial_nodes) if self.axial_nodes else Axial.profile(half)
        checks.keep(self, pads=pads, grid=Grid(pads, self.nodes, axial))
        if self.clearance <= 0.0:
            raise ValueError("pads: their centers leave no clearance for a journal in the middle")

    @cached_property
    def clearance(self) -> float:
        """Least thickness of the film about a journal in the middle [m]."""
        return float(self._heights(np.zeros(2))[0].min())

    @cached_property
    def thinnest(self) -> float:
        """Thickness of the thinnest film that the grid still resolves [m]."""
        return _PEAK * float(self.grid.step.max()) ** 2 * self.clearance

    def reach_along(self, direction: np.ndarray, thickness: float) -> float:
        """Return how far the journal may go that way, of length 1 (2,), to a thickness [m]."""
        closing = (self.grid.u @ direction).ravel()
        room = (self.grid.offset - thickness).ravel()
        near = closing > 0.0
        return float(np.min(room[near] / closing[near], initial=np.inf))

    def _heights(self, position: np.ndarray) -> np.ndarray:
        """Return h in the middle, at the left and the right face of each volume, (3, n) [m]."""
        return self.grid.offset - self.grid.u @ position

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
            If the journal touches the bore.
        """
        displacement = checks.vector(displacement, "displacement", "m", 2)
        velocity = checks.vector(velocity, "velocity", "m/s", 2)
        checks.number(speed, "speed", "rad/s")
        return self.solved(displacement, velocity, speed)

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
            If no equilibrium is found.
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

    def beside(self, known: FilmState, speed: float, load: np.ndarray) -> FilmState | None:
        """Return the film that carries a load, from one beside it; None where none is so found.

        Of films that bear tension, and where a journal would run off, none: there may be another.
        """
        found = self._newton(known.position, load, speed, known.solution.empty)
        if found is None or self.cavitation == "none":
            return None
        left = float(np.linalg.norm(found.force + load))
        held = left < _CLOSE * np.linalg.norm(load) and np.linalg.det(found.coefficients()[0]) > 0.0
        return found if held else None

    def _newton(
        self, start: np.ndarray, load: np.ndarray, speed: float, empty: np.ndarray | None = None
    ) -> FilmState | None:
        """Return where Newton's method ends; None for a film thinner than the grid resolves."""
        state, vain, size = self.solved(start, np.zeros(2), speed, empty), 0, np.linalg.norm(load)
        for _ in range(_STEPS):
            unbalanced = state.force + load
            left = np.linalg.norm(unbalanced)
            if left < _CLOSE * size or vain == _VAIN:
                break
            move = np.linalg.lstsq(state.coefficients()[0], unbalanced, rcond=1e-12)[0]
            move *= min(1.0, 0.6 / state.closing(move))
            for _ in range(_HALVES):
                # the cells that are empty now: few steps from those of the next place
                place, empty = state.position + move, state.solution.empty
                found = self.solved(place, np.zeros(2), speed, empty)
                if np.linalg.norm(found.force + load) < left:
                    break
                move *= 0.5
            vain += np.linalg.norm(found.force + load) >= left
            state = found
            if state.heights.min() < self.thinnest:
                return None
        return state

    def solved(
        self,
        position: np.ndarray,
        velocity: np.ndarray,
        speed: float,
        empty: np.ndarray | None = None,
    ) -> FilmState:
        """For bearings: :meth:`state` unchecked, by a guess of the cells in which it is broken."""
        heights = self._heights(position)
        if heights.min() <= 0.0:
            raise ValueError(
                f"displacement: {position.tolist()} m is outside the clearance of "
                f"{self.clearance:g} m"
            )
        rates = -self.grid.u[0] @ velocity
        source = 12.0 * self.viscosity * self.radius**2
        equation = Equation(self.grid, self.cavitation, source, heights, rates, speed)
        return FilmState(self, position, velocity, speed, equation.solve(empty))


def _in_order(pads: tuple[Pad, ...]) -> tuple[Pad, ...]:
    """Return pads by their angle; ValueError if two overlap."""
    if not pads:
        raise ValueError("pads: needs one at least")
    ordered = sorted(pads, key=lambda pad: pad.start % (2.0 * np.pi))
    starts = np.array([pad.start % (2.0 * np.pi) for pad in ordered])
    arcs = np.array([pad.arc for pad in ordered])
    room = np.diff(starts, append=starts[0] + 2.0 * np.pi)
    if np.any(arcs > room * (1.0 + 1e-12)):
        raise ValueError(f"pads: overlap; starts {starts} rad, arcs {arcs} rad")
    return tuple(ordered)
