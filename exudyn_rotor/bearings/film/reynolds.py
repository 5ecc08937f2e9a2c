"""Pressure of a film: Reynolds' equation with three conditions where the film would be pulled.

=====================  ==========================================================================
'none'                 negative pressures stay (Sommerfeld): a film that bears tension
'half-sommerfeld'      negative pressures are cut after the solution (Gümbel)
'reynolds'             p ≥ 0, λ ≥ 0, p λ = 0 with the residual λ: p and its slope vanish where the
                       film breaks (Swift, Stieber)
=====================  ==========================================================================

The last one is solved by a semi-smooth Newton method: each cell has one unknown, the pressure or
the residual, and changes sides when its unknown turns negative.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg.lapack import dgbsv

from exudyn_rotor.bearings.film.grid import Grid

CAVITATION = ("none", "half-sommerfeld", "reynolds")
_ITERATIONS = 200


@dataclass(frozen=True, eq=False)
class Equation:
    """Eq. (1) of a grid at one place and motion of the journal.

    `source` is 12 μ R² [N s], `heights` (3, n) the thickness in the middle, at the left and the
    right face of each volume [m], and `rates` (n,) are ∂t h [m/s].
    """

    grid: Grid
    cavitation: str
    source: float
    heights: np.ndarray
    rates: np.ndarray
    speed: float

    def pressed(self, pressure: np.ndarray, cubes: np.ndarray) -> np.ndarray:
        """Return the flow that a pressure drives out of each volume, by h³ (3, n) or many of it."""
        grid, axial, step = self.grid, self.grid.axial, self.grid.step[:, None]
        left, right = (
            cubes[..., face, :, None] * (pressure - np.where(inside[:, None], pressure[at], 0.0))
            for face, inside, at in (
                (1, grid.at_left, grid.left),
                (2, grid.at_right, grid.right),
            )
        )
        along = step * cubes[..., 0, :, None] * (pressure @ axial.stiffness)
        return axial.mass / step * (left + right) + along

    def fed(self, heights: np.ndarray, rates: np.ndarray) -> np.ndarray:
        """Return what the surface carries out of each volume, and what its growth takes in."""
        gain = 0.5 * self.speed * (heights[..., 2, :] - heights[..., 1, :])
        return self.source * self.grid.axial.weights * (gain + self.grid.step * rates)[..., None]

    def solve(self, empty: np.ndarray | None = None) -> Solution:
        """Return the pressure; `empty` is a guess of the cells without."""
        shape = (len(self.grid.angle), self.grid.width)
        load = -self.fed(self.heights, self.rates)
        breaks = self.cavitation == "reynolds"
        empty = np.zeros(shape, dtype=bool) if empty is None or not breaks else empty
        for _ in range(_ITERATIONS):
            found = self.direct(empty, load[None])[0]
            wrong = (found < 0.0) & breaks
            if not wrong.any():
                return Solution(self, np.where(empty, 0.0, found), empty)
            empty = empty ^ wrong
        raise ArithmeticError(
            f"film: its edges do not settle within {_ITERATIONS} steps at {self.speed:g} rad/s"
        )

    def direct(self, empty: np.ndarray, loads: np.ndarray) -> np.ndarray:
        """Return the unknowns for several right-hand sides, (k, n, m)."""
        grid = self.grid
        size = grid.unknown.size
        band = self._band(empty).reshape(size, grid.rows).T
        right = np.empty((size, len(loads)), order="F")
        right[grid.unknown.ravel()] = loads.reshape(len(loads), -1).T
        _, _, solved, info = dgbsv(grid.band, grid.band, band, right, 1, 1)
        if info:
            raise ArithmeticError(f"film: singular at {self.speed:g} rad/s (LAPACK's info {info})")
        return solved[grid.unknown.ravel()].T.reshape(loads.shape)

    def _band(self, empty: np.ndarray) -> np.ndarray:
        """Return the matrix: columns of the pressure, in empty cells of the residual."""
        grid = self.grid
        store = np.zeros(grid.unknown.size * grid.rows)
        own, to_left, to_right, side = self._full
        if empty.any():
            own = np.where(empty, -1.0, own)
            to_left, to_right = np.where(empty, 0.0, to_left), np.where(empty, 0.0, to_right)
        store[grid.to_own] = own
        store[grid.to_left] = to_left[grid.at_left]
        store[grid.to_right] = to_right[grid.at_right]
        store[grid.to_above] = np.where(empty[:, 1:], 0.0, side)
        store[grid.to_below] = np.where(empty[:, :-1], 0.0, side)
        return store

    @cached_property
    def _full(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return what an unbroken film couples: a node to itself, left, right and sideways."""
        grid, axial = self.grid, self.grid.axial
        cubes = self.heights**3
        across = axial.mass * (cubes[1:] / grid.step)[..., None]
        along = (grid.step * cubes[0])[:, None]
        own = across.sum(axis=0) + along * np.diag(axial.stiffness)
        return own, -across[0], -across[1], along * np.diag(axial.stiffness, 1)


@dataclass(frozen=True, eq=False)
class Solution:
    """Pressure at the nodes (n, m) [Pa], negative parts included, and where the film is broken."""

    equation: Equation
    pressure: np.ndarray
    empty: np.ndarray

    @property
    def bearing(self) -> np.ndarray:
        """Pressure that acts on the journal, (n, m) [Pa]."""
        cut = self.equation.cavitation == "half-sommerfeld"
        return np.maximum(self.pressure, 0.0) if cut else self.pressure

    def change(self, heights: np.ndarray, rates: np.ndarray) -> np.ndarray:
        """Return the change of the bearing pressure with those of h (k, 3, n) and ∂t h (k, n).

        The derivative of the discrete solution: Eq. (1), linearised, with the same cells empty.
        """
        equation = self.equation
        cubes = 3.0 * equation.heights**2 * heights
        loads = -equation.pressed(self.pressure, cubes) - equation.fed(heights, rates)
        changed = equation.direct(self.empty, loads)
        return np.where(self.empty | (self.bearing > self.pressure), 0.0, changed)
