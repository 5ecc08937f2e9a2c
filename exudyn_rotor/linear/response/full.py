"""Steady forced motion of a full finite-element rotor, checked by the residual of its equations.

The equations are projected on a subspace that holds the rigid motions, the lowest modes and the
response of ``K + αM`` to the loads, solved there by harmonic balance, and the residual r of the
full equations is formed. While ``rᴴ(K + αM)⁻¹r`` is too large against the same of the loads, the
preconditioned residuals join the subspace, which serves all speeds and frequencies.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from exudyn_rotor.linear.equations.full import FullRotor, Subspace
from exudyn_rotor.linear.response.forced import forced_motion

_MODES = 6
_MOST_ROUNDS = 30
_MOST_COLUMNS = 400
# share of the largest residual allowed below which a direction is not worth a column
_NEGLIGIBLE = 0.1


class FullSteady:
    """Solves for the steady motion of a full rotor at any speed and frequency.

    Parameters
    ----------
    full : FullRotor
        With its spin, see :meth:`FullRotor.with_spin`.
    loads : iterable of ndarray, each (3n,)
        All loads that will be applied, in any scaling; complex.
    fastest : float
        Largest spin speed or frequency [rad/s].
    residual : float
        Largest residual relative to the loads, in the norm of ``(K + αM)⁻¹``.
    """

    def __init__(
        self, full: FullRotor, loads: Iterable[np.ndarray], fastest: float, residual: float
    ) -> None:
        self.residual = residual
        self.subspace = Subspace(full, _MODES, fastest)
        columns = np.column_stack([part for load in loads for part in (load.real, load.imag)])
        self.subspace.grow(self.subspace.solve(columns[:, np.any(columns, axis=0)]))

    def seen(
        self,
        rows: np.ndarray,
        speed: float,
        loads: Mapping[int, np.ndarray],
        rate: float,
        tolerance: float,
    ) -> dict[int, np.ndarray]:
        """Return the harmonics (p, 6) of the steady motion at places, rotor frame.

        Parameters
        ----------
        rows : ndarray, shape (p, 6, 3n)
        speed, rate : float
            Spin speed Ω and angular frequency ω [rad/s].
        loads : mapping of int to ndarray, shape (3n,)
            Harmonics F_n of the load, rotor frame.
        tolerance : float
            Largest relative change of the motion by further harmonics.

        Raises
        ------
        ValueError
            If there is no steady motion, or the residual does not fall below its limit.
        """
        if speed == 0.0:  # θ stands still: all harmonics are one
            loads = {0: sum(loads.values())}
        size = self._size(loads.values())
        error = np.inf
        for _ in range(_MOST_ROUNDS):
            basis = self.subspace.V
            projected = {n: basis.T @ load for n, load in loads.items()}
            system, held = self.subspace.projected.at(speed), self._driven()
            motion = forced_motion(system, projected, rate, tolerance, held)
            error, corrections = self._left(speed, rate, loads, motion, size)
            if error <= self.residual:
                return {n: (rows @ basis) @ x for n, x in motion.items()}
            self.subspace.grow(corrections)
            if not basis.shape[1] < self.subspace.V.shape[1] <= _MOST_COLUMNS:
                break
        raise ValueError(
            f"full model at {speed:.6g} rad/s: the residual stays at {error:.1e} of the loads with "
            f"{self.subspace.V.shape[1]} vectors, above residual={self.residual:.1e}; give a "
            "larger one, or reduce the rotor"
        )

    def _driven(self) -> tuple[int, ...]:
        """Return the column of the spin where no support resists it: the drive does."""
        return () if self.subspace.full.free_spin is None else (0,)

    def _size(self, forces: Iterable[np.ndarray]) -> float:
        """Return the norm of forces, the root of ``Σ fᴴ(K + αM)⁻¹f``."""
        stack = np.column_stack([part for force in forces for part in (force.real, force.imag)])
        return float(np.sqrt(np.sum(stack * self.subspace.solve(stack))))

    def _left(
        self,
        speed: float,
        rate: float,
        loads: Mapping[int, np.ndarray],
        motion: Mapping[int, np.ndarray],
        size: float,
    ) -> tuple[float, np.ndarray]:
        """Return the relative residual, and the directions (3n, c) that would lower it."""
        basis, full = self.subspace.V, self.subspace.full
        stack = {n: (basis @ x)[:, None] for n, x in motion.items()}
        free = self.subspace.rigid
        strained = {n: (basis[:, free:] @ x[free:])[:, None] for n, x in motion.items()}
        left = full.residual(
            speed, np.array([1j * rate]), stack, strained, self.subspace.torsion(speed)
        )
        columns = []
        for n, force in left.items():
            force = force[:, 0] - loads.get(n, 0.0)
            if abs(rate + n * speed) <= 1e-12 * max(abs(rate), abs(speed)):
                force = self._without_rigid(force)
            columns += [force.real, force.imag]
        residual = np.column_stack(columns)
        answer = self.subspace.solve(residual)
        squares = np.maximum(np.sum(residual * answer, axis=0), 0.0) / size**2
        worth = np.sqrt(squares) > _NEGLIGIBLE * self.residual
        return float(np.sqrt(squares.sum())), answer[:, worth]

    def _without_rigid(self, force: np.ndarray) -> np.ndarray:
        """Return a constant force (3n,) without its resultants.

        The projected equations hold for rigid motions. What is left there is the torque of the
        drive, and the rounding of loads on free motions, which harmonic balance takes out.
        """
        rigid = self.subspace.V[:, : self.subspace.rigid]
        return force - self.subspace.full.invariants.M @ (rigid @ (rigid.T @ force))
