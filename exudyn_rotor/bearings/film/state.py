"""What a film does at one place and motion of the journal."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from exudyn_rotor import checks
from exudyn_rotor.bearings.film.data import FilmData
from exudyn_rotor.bearings.film.reynolds import Solution
from exudyn_rotor.bearings.film.void_states import VoidStates

_AT_ONCE = 1e12  # of the speed: rate at which voids let go what they take up
_WHIRLS = np.geomspace(0.05, 2.0, 24)  # ratios between which that of a limit is looked for


@dataclass(frozen=True, eq=False)
class FilmState:
    """OilFilm at one place and motion of the journal, from :meth:`OilFilm.state` and `equilibrium`.

    Attributes
    ----------
    film : FilmData
        The OilFilm.
    position, velocity : numpy.ndarray, (2,)
        Of the journal along n1 and n2 [m], [m/s].
    speed : float
        [rad/s].
    solution : Solution
        Pressure and voids at the nodes of the grid.
    """

    film: FilmData
    position: np.ndarray
    velocity: np.ndarray
    speed: float
    solution: Solution

    @cached_property
    def force(self) -> np.ndarray:
        """Force on the journal along n1 and n2, that of the supply in the grooves with it [N].

        The supply's pressure all around has no resultant, so the pads' excess over it is enough.
        """
        film, grid = self.film, self.film.grid
        supply = film.radius * film.length * film.supply_pressure * (grid.step @ grid.u[0])
        return supply + self._resultant(self.solution.bearing)

    def is_at(
        self,
        position: np.ndarray,
        velocity: np.ndarray,
        speed: float,
        void_rate: float,
        voids: np.ndarray | None,
    ) -> bool:
        """Return whether it is the film of this place and motion, and of these voids before."""
        equation = self.solution.equation
        return (
            np.array_equal(position, self.position)
            and np.array_equal(velocity, self.velocity)
            and (speed, void_rate) == (self.speed, equation.void_rate)
            and voids is equation.voids
        )

    def coefficients(self, whirl_ratio: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
        """Return stiffness −∂F/∂q [N/m] and damping −∂F/∂q̇ [N s/m] along n1 and n2, each (2, 2).

        The derivatives of the discrete film's force (Lund's perturbation): where the film is
        broken it stays so, and the pressure at the rim of a void stays zero. Voids that conserve
        mass arrive late at the film behind them; these films have, at rest and moved by
        ``Re x exp(iνt)``, the force ``−Re (K + iν C) x exp(iνt)``, whose K and C depend on ν.

        Parameters
        ----------
        whirl_ratio : float, optional
            ν over the speed, 1 for unbalance; of no influence on films that do not conserve mass.

        Raises
        ------
        TypeError, ValueError
            For a ratio not above zero, and for a film that conserves mass without a speed.
        """
        checks.number(whirl_ratio, "whirl_ratio", above=0.0)
        u = np.moveaxis(self.film.grid.u, 2, 0)
        if self.film.cavitation == "mass-conserving":
            whirl = whirl_ratio * abs(self.speed)
            if whirl == 0.0:
                raise ValueError("speed: films that conserve mass have coefficients at speed alone")
            impedance = self._gradient(-u, -1j * whirl * u[:, 0], 1j * whirl)
            return impedance.real, impedance.imag / whirl
        stiffness, damping = self.tangent
        return stiffness.copy(), damping.copy()

    @cached_property
    def tangent(self) -> tuple[np.ndarray, np.ndarray]:
        """Stiffness −∂F/∂q [N/m] and damping −∂F/∂q̇ [N s/m] at this instant, each (2, 2).

        Voids that conserve mass grow from those at the beginning of a step.
        """
        u = np.moveaxis(self.film.grid.u, 2, 0)
        still = np.zeros_like(u)
        heights, rates = np.concatenate([-u, still]), np.concatenate([still, -u])[:, 0]
        gradient = self._gradient_of(self.solution, heights, rates)
        return gradient[:, :2], gradient[:, 2:]

    @cached_property
    def void_states(self) -> VoidStates:
        """Linear equations of a film that conserves mass, with what its voids remember as states.

        Raises
        ------
        ArithmeticError
            Where their force differs by more than 1 % from that of :meth:`coefficients`.
        """
        u = np.moveaxis(self.film.grid.u, 2, 0)

        def transfer(s: complex) -> np.ndarray:
            return self._gradient(-u, -s * u[:, 0], s)

        at_once = self._gradient(np.zeros_like(u), -u[:, 0], _AT_ONCE * abs(self.speed))
        return VoidStates.of(transfer, at_once, self.speed)

    @property
    def slow_stiffness(self) -> np.ndarray:
        """Stiffness of a motion so slow that voids follow at once, (2, 2) [N/m]."""
        if self.film.cavitation != "mass-conserving":
            return self.tangent[0]
        u = np.moveaxis(self.film.grid.u, 2, 0)
        return self._gradient(-u, np.zeros_like(u)[:, 0])

    @property
    def slow_damping(self) -> np.ndarray:
        """Damping of a velocity that stays while voids do not change any more, (2, 2) [N s/m]."""
        u = np.moveaxis(self.film.grid.u, 2, 0)
        return self._gradient(np.zeros_like(u), -u[:, 0])

    def _gradient(
        self, heights: np.ndarray, rates: np.ndarray, void_rate: complex = 0.0
    ) -> np.ndarray:
        """Return −∂F by changes of h (k, 3, n) and ∂t h (k, n), in columns (2, k)."""
        equation = replace(self.solution.equation, void_rate=void_rate, voids=None)
        return self._gradient_of(replace(self.solution, equation=equation), heights, rates)

    def _gradient_of(
        self, solution: Solution, heights: np.ndarray, rates: np.ndarray
    ) -> np.ndarray:
        changes = solution.change(heights, rates)
        return -np.array([self._resultant(change) for change in changes]).T

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
    def sommerfeld_number(self) -> float:
        """S = μ N L D/W (R/c)², N in revolutions per second, c the least clearance."""
        film = self.film
        turns = abs(self.speed) / (2.0 * np.pi)
        load = np.linalg.norm(self.force)
        area = 2.0 * film.radius * film.length
        return float(film.viscosity * turns * area / load * (film.radius / film.clearance) ** 2)

    @property
    def torque(self) -> float:
        """Torque that the film takes from the journal, positive against a positive spin [N m].

        Shear of the surface, μ R Ω/h, where there is oil, and of the pressure, (h/2R) ∂φ p,
        integrated by parts. Voids of films that do not conserve mass count as full.
        """
        film, grid = self.film, self.film.grid
        axial, equation = grid.axial, self.solution.equation
        size = film.length / film.radius
        filled = size * (1.0 - self.solution.fraction @ axial.weights / axial.weights.sum())
        # the half volumes at edges have the thickness of their faces
        ends = ~np.array([grid.at_left, grid.at_right]) / equation.heights[1:]
        covered = grid.step * (1.0 / self.heights + 0.5 * ends.sum(axis=0))
        shear = film.viscosity * film.radius**4 * self.speed * (covered @ filled)
        slope = equation.heights[2] - equation.heights[1]
        excess = self.solution.bearing @ axial.weights - size * film.supply_pressure
        lift = -(slope @ excess)
        return float(shear + 0.5 * film.radius**2 * lift)

    @property
    def power_loss(self) -> float:
        """Power that the journal's rotation loses to the film [W]."""
        return self.torque * self.speed

    @property
    def side_flow(self) -> float:
        """Oil that leaves the pads at both ends [m³/s].

        A supply pressure drops to zero where a pad's edge meets an end, so that the flow there is
        not bounded: every doubling of the nodes, along and around, adds ``ln 2 h³ p_s/(6π μ)`` at
        each such corner. What leaves the grooves' own ends is not in it.
        """
        film, grid = self.film, self.film.grid
        slope = self.solution.bearing @ grid.axial.edge
        return float((grid.step * self.heights**3) @ slope / (6.0 * film.viscosity))

    def critical_mass(self) -> float:
        """Return the rigid mass on this film above which it whirls unstably [kg]; inf for none.

        Routh–Hurwitz for M q̈ + C q̇ + K q = 0: at the limit M ν² = k with ``k = (K11 C22 +
        K22 C11 − K12 C21 − K21 C12)/(C11 + C22)``, ``ν² = ((K11 − k)(K22 − k) − K12 K21)/det C``.
        Of films that conserve mass, ``M ν²`` is the eigenvalue of K + iν C with the least imaginary
        part, at the lowest ν where that turns positive.
        """
        if self.film.cavitation == "mass-conserving":
            return self._critical_mass_with_voids()
        (k11, k12, k21, k22), (c11, c12, c21, c22) = (m.ravel() for m in self.coefficients())
        k = (k11 * c22 + k22 * c11 - k12 * c21 - k21 * c12) / (c11 + c22)
        square = ((k11 - k) * (k22 - k) - k12 * k21) / (c11 * c22 - c12 * c21)
        return float(k / square) if square > 0.0 else float("inf")

    def _critical_mass_with_voids(self) -> float:
        def least_damped(ratio: float) -> complex:
            stiffness, damping = self.coefficients(ratio)
            values = np.linalg.eigvals(stiffness + 1j * ratio * abs(self.speed) * damping)
            return complex(values[np.argmin(values.imag)])

        damped = [least_damped(ratio).imag for ratio in _WHIRLS]
        for low, high, before, after in zip(_WHIRLS, _WHIRLS[1:], damped, damped[1:], strict=False):
            if before < 0.0 <= after:
                ratio = brentq(lambda r: least_damped(r).imag, low, high, xtol=1e-12)
                return max(least_damped(ratio).real, 0.0) / (ratio * self.speed) ** 2
        return float("inf")
