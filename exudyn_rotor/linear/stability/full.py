"""Exponents of the lowest modes of a full finite-element rotor, checked by their residual."""

from __future__ import annotations

import numpy as np

from exudyn_rotor.linear.equations.full import FullRotor, Subspace
from exudyn_rotor.linear.equations.system import PeriodicSystem, Terms
from exudyn_rotor.linear.modal.eigen import FloquetModes, floquet_modes

MODES = 10


def projected(system: PeriodicSystem, basis: np.ndarray) -> PeriodicSystem:
    """Return the equations of motions in a basis (k, r)."""

    def within(terms: Terms) -> Terms:
        return {n: basis.T @ X @ basis for n, X in terms.items()}

    return PeriodicSystem(system.speed, within(system.M), within(system.D), within(system.K))


class HeldSubspace(Subspace):
    """The subspace of a full rotor whose spin follows θ = Ωt where no support resists it.

    Parameters
    ----------
    full, count, speed
        See :class:`Subspace`; the rotor with its spin.
    tolerance : float
        Error of Hill's method relative to Ω.
    """

    def __init__(self, full: FullRotor, count: int, speed: float, tolerance: float) -> None:
        super().__init__(full, count, speed)
        self.tolerance = tolerance

    def small(self, speed: float) -> tuple[PeriodicSystem, np.ndarray]:
        """Return the projected equations at a speed, and the basis (3n, k) they are in."""
        system = self.projected.at(speed)
        if self.full.free_spin is None:
            return system, self.V
        return projected(system, np.eye(system.size)[:, 1:]), self.V[:, 1:]

    def trial(self, speed: float, count: int) -> FloquetModes:
        """Return the modes of smallest |λ| in the present subspace.

        Not of smallest |Im λ|: damping of the material makes the highest modes overdamped.
        """
        system, basis = self.small(speed)
        modes = floquet_modes(system, tolerance=self.tolerance)
        chosen = np.argsort(np.abs(modes.values), kind="stable")[:count]
        vectors = np.einsum("cv,hvk->hck", basis, modes.vectors[:, :, chosen])
        return FloquetModes(modes.values[chosen], vectors, modes.orders, modes.resolution)

    def left(self, speed: float, values: np.ndarray, stack: dict[int, np.ndarray]) -> dict:
        """Return what modes leave of the full equations but for the torque of the drive."""
        left = super().left(speed, values, stack)
        if self.full.free_spin is None:
            return left
        return {n: self.full.spin.without_torque(force) for n, force in left.items()}


class FullExponents:
    """Finds the exponents of the lowest modes at any speed, in one subspace that grows.

    Parameters
    ----------
    full : FullRotor
    count : int, optional
        Number of modes, those of smallest |λ| in the rotor frame.
    speed : float
        Largest spin speed [rad/s].
    residual : float
        Largest relative residual of a mode, see :meth:`Subspace.modes`.
    tolerance : float
        Error of Hill's method relative to Ω.

    Raises
    ------
    ValueError
        If there are more modes than a quarter of the coordinates.
    """

    def __init__(
        self, full: FullRotor, count: int | None, speed: float, residual: float, tolerance: float
    ) -> None:
        count = MODES if count is None else count
        if count > full.size // 4:
            raise ValueError(
                f"modes: {count} is not between 1 and {full.size // 4}, a quarter of the "
                "coordinates"
            )
        self.count, self.residual = count, residual
        self.subspace = HeldSubspace(full.with_spin(), self.count, speed, tolerance)

    def at(self, speed: float) -> PeriodicSystem:
        """Return the projected equations at a speed [rad/s]."""
        return self.subspace.small(speed)[0]

    def values(self, speed: float) -> np.ndarray:
        """Return one exponent of every pair, shape (count,) [1/s], in any order.

        Raises
        ------
        ValueError
            If the residual does not fall below its limit.
        """
        return self.subspace.modes(speed, self.count, self.residual).values.astype(complex)
