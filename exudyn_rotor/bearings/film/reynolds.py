"""Pressure of a film: Reynolds' equation with four conditions where the film would be pulled.

=====================  ==========================================================================
'none'                 negative pressures stay (Sommerfeld): a film that bears tension
'half-sommerfeld'      negative pressures are cut after the solution (Gümbel)
'reynolds'             p ≥ 0, λ ≥ 0, p λ = 0 with the residual λ: p and its slope vanish where the
                       film breaks (Swift, Stieber)
'mass-conserving'      p ≥ 0, θ ≥ 0, p θ = 0 with the void fraction θ, which the surface carries:
                       (1 − θ) h in place of h (Jakobsson, Floberg, Olsson; H. G. Elrod, *A
                       cavitation algorithm*, J. Lubrication Technology 103, 1981)
=====================  ==========================================================================

The voids θ h of the last one remember. Beside ∂t h of a motion, Eq. (1) has −∂t(θ h): after a step
τ of implicit Euler from voids g, ``(θ h − g)/τ``; in a small motion exp(iνt), ``iν θ h``.

The last two are solved by a semi-smooth Newton method: each cell has one unknown, the pressure or
what stands for it in a void, and changes sides when its unknown turns negative.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg.lapack import dgbsv, zgbsv

from exudyn_rotor.bearings.film.grid import Grid

CAVITATION = ("none", "half-sommerfeld", "reynolds", "mass-conserving")
_ITERATIONS = 200


@dataclass(frozen=True, eq=False)
class Equation:
    """Eq. (1) of a grid at one place and motion of the journal.

    Parameters
    ----------
    grid : Grid
    cavitation : str
        One of CAVITATION.
    source : float
        12 μ R² [N s].
    edge : float
        Pressure at the pads' edges [Pa].
    heights : numpy.ndarray, (3, n)
        Thickness in the middle, at the left and the right face of each volume [m].
    rates : numpy.ndarray, (n,)
        ∂t h [m/s].
    speed : float
        Ω [rad/s].
    void_rate : complex, optional
        1/τ or iν of the voids [1/s]; 0 where these do not change.
    voids : numpy.ndarray, (n, m), optional
        Their thickness g at the beginning of the step [m]; none by default.
    """

    grid: Grid
    cavitation: str
    source: float
    edge: float
    heights: np.ndarray
    rates: np.ndarray
    speed: float
    void_rate: complex = 0.0
    voids: np.ndarray | None = None

    def residual(
        self,
        pressure: np.ndarray,
        void: np.ndarray,
        cubes: np.ndarray,
        heights: np.ndarray,
        rates: np.ndarray,
    ) -> np.ndarray:
        """Return the flow out of each volume, linear in the last three, one each or many."""
        return self._pressed(pressure, cubes) + self._fed(void, heights, rates)

    def _pressed(self, pressure: np.ndarray, cubes: np.ndarray) -> np.ndarray:
        """Return the flow that the pressure drives out of each volume."""
        grid, axial = self.grid, self.grid.axial
        edge = self.edge * axial.weights / axial.mass
        left, right = (
            np.where(inside[:, None], pressure[at], edge)
            for inside, at in ((grid.at_left, grid.left), (grid.at_right, grid.right))
        )
        drop_left, drop_right = pressure - left, pressure - right
        step = grid.step[:, None]
        through = (
            axial.mass
            / step
            * (cubes[..., 1, :, None] * drop_left + cubes[..., 2, :, None] * drop_right)
        )
        return through + step * cubes[..., 0, :, None] * (pressure @ axial.stiffness)

    def _fed(self, void: np.ndarray, heights: np.ndarray, rates: np.ndarray) -> np.ndarray:
        """Return what the surface carries out of each volume, and what its growth takes in."""
        step, (before, after) = self.grid.step[:, None], self._carried(void)
        ahead, behind = heights[..., 2, :, None] * after, heights[..., 1, :, None] * before
        gain = 0.5 * self.speed * (ahead - behind)
        growth = step * (rates[..., None] - self.void_rate * void * heights[..., 0, :, None])
        return self.source * self.grid.axial.weights * (gain + growth)

    def _carried(self, void: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the share of film that the surface carries through the left and right faces."""
        grid = self.grid
        if self.speed >= 0.0:
            return 1.0 - np.where(grid.at_left[:, None], void[grid.left], 0.0), 1.0 - void
        return 1.0 - void, 1.0 - np.where(grid.at_right[:, None], void[grid.right], 0.0)

    def solve(self, empty: np.ndarray | None = None) -> Solution:
        """Return the pressure; `empty` is a guess of the cells without.

        Raises
        ------
        ArithmeticError
            If the cells do not settle.
        """
        shape = (len(self.grid.angle), self.grid.width)
        nothing = np.zeros(shape)
        load = -self._fed(nothing, self.heights, self.rates)
        if self.edge:
            load -= self._pressed(nothing, self.heights**3)
        if self.voids is not None:
            gone = self.grid.step[:, None] * self.void_rate * self.voids
            load -= self.source * self.grid.axial.weights * gone
        linear = self.cavitation in CAVITATION[:2]
        empty = np.zeros(shape, dtype=bool) if empty is None or linear else empty
        for _ in range(_ITERATIONS):
            found = self.direct(empty, load[None])[0]
            if linear:
                break
            wrong = found < 0.0
            if not wrong.any():
                break
            empty = empty ^ wrong
        else:
            raise ArithmeticError(
                f"film: the voids do not settle within {_ITERATIONS} steps at {self.speed:g} rad/s "
                f"with cavitation={self.cavitation!r}; 'reynolds' always does"
            )
        void = np.where(empty, found, 0.0)
        pressure = np.where(empty, 0.0, found)
        return Solution(self, pressure, void, empty)

    def direct(self, empty: np.ndarray, loads: np.ndarray) -> np.ndarray:
        """Return the unknowns for several right-hand sides, (k, n, m)."""
        grid = self.grid
        size = grid.unknown.size
        band = self._band(empty).reshape(size, grid.rows).T
        right = np.empty((size, len(loads)), order="F", dtype=loads.dtype)
        right[grid.unknown.ravel()] = loads.reshape(len(loads), -1).T
        solver = zgbsv if np.iscomplexobj(loads) else dgbsv
        _, _, solved, info = solver(grid.band, grid.band, band, right, 1, 1)
        if info:
            raise ArithmeticError(f"film: singular at {self.speed:g} rad/s (LAPACK's info {info})")
        return solved[grid.unknown.ravel()].T.reshape(loads.shape)

    def _band(self, empty: np.ndarray) -> np.ndarray:
        """Return the matrix: columns of the pressure, in empty cells of what stands for it."""
        grid, axial = self.grid, self.grid.axial
        store = np.zeros(grid.unknown.size * grid.rows, dtype=np.result_type(self.void_rate, 1.0))
        own, to_left, to_right, side = self._full
        above = np.where(empty[:, 1:], 0.0, side)
        below = np.where(empty[:, :-1], 0.0, side)
        if empty.any():
            own = np.where(empty, self._own_void(), own)
            carried = self.cavitation == "mass-conserving"
            ahead = self.source * axial.weights * 0.5 * self.speed * carried
            faces = self.heights[1:, :, None] * ahead
            to_left = np.where(empty, -np.minimum(faces[0], 0.0), to_left)
            to_right = np.where(empty, np.maximum(faces[1], 0.0), to_right)
        store[grid.to_own] = own
        store[grid.to_left] = to_left[grid.at_left]
        store[grid.to_right] = to_right[grid.at_right]
        store[grid.to_above], store[grid.to_below] = above, below
        return store

    @cached_property
    def _full(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return what a film without voids couples: a node to itself, left, right and sideways."""
        grid, axial = self.grid, self.grid.axial
        cubes = self.heights**3
        across = axial.mass * (cubes[1:] / grid.step)[..., None]
        along = (grid.step * cubes[0])[:, None]
        own = across.sum(axis=0) + along * np.diag(axial.stiffness)
        return own, -across[0], -across[1], along * np.diag(axial.stiffness, 1)

    def _own_void(self) -> np.ndarray:
        """Return what a void adds to its own cell's residual per unit."""
        weights = self.grid.axial.weights
        if self.cavitation == "reynolds":
            return -np.ones_like(weights)
        leaving = self.heights[2] if self.speed >= 0.0 else self.heights[1]
        kept = self.grid.step * self.void_rate * self.heights[0]
        flow = 0.5 * abs(self.speed) * leaving + kept
        return -self.source * weights * flow[:, None]


@dataclass(frozen=True, eq=False)
class Solution:
    """Pressure in a film.

    Attributes
    ----------
    equation : Equation
    pressure : numpy.ndarray, (n, m)
        At the nodes, negative parts included [Pa].
    void : numpy.ndarray, (n, m)
        What stands for it in empty cells: the void fraction or the residual.
    empty : numpy.ndarray of bool, (n, m)
    """

    equation: Equation
    pressure: np.ndarray
    void: np.ndarray
    empty: np.ndarray

    @property
    def fraction(self) -> np.ndarray:
        """Void fraction, (n, m)."""
        conserving = self.equation.cavitation == "mass-conserving"
        return self.void if conserving else np.zeros_like(self.void)

    @property
    def bearing(self) -> np.ndarray:
        """Pressure that acts on the journal, (n, m) [Pa]."""
        cut = self.equation.cavitation == "half-sommerfeld"
        return np.maximum(self.pressure, 0.0) if cut else self.pressure

    def change(self, heights: np.ndarray, rates: np.ndarray) -> np.ndarray:
        """Return the change of the bearing pressure with those of h (k, 3, n) and ∂t h (k, n).

        The derivative of the discrete solution: Eq. (1), linearised, with the same cells empty: a
        void takes up what the motion of its rim does to the flow. Of films that conserve mass in a
        motion exp(iνt) where the equation's `void_rate` is iν.
        """
        equation = self.equation
        cubes = 3.0 * equation.heights**2 * heights
        loads = -equation.residual(self.pressure, self.fraction, cubes, heights, rates)
        changed = equation.direct(self.empty, loads)
        return np.where(self.empty | (self.bearing > self.pressure), 0.0, changed)
