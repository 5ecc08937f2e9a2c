"""Sparse equations (104) and (105) of a full finite-element rotor on supports."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
import scipy.sparse as sp

from exudyn_rotor.bearings.given import check_interfaces
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.models.rotor.eccentricity import warn_of_eccentricity
from exudyn_rotor.linear.models.rotor.spin import Spin, rotations_of
from exudyn_rotor.linear.models.rotor.supported_rotor import SupportedRotor
from exudyn_rotor.prestress.static_solution import relief_rotations
from exudyn_rotor.solid.damping import sparse_damping
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.rotating_axes import axes_of
from exudyn_rotor.theory.spin_terms import SpinTerms
from exudyn_rotor.theory.stiffening import (
    NO_PRESTRESS,
    Stiffening,
    chosen_level,
    relief_factors,
    tilt_factors,
)

Kind = TypeVar("Kind", bound="FullEquations")


def _invariants(rotor: SolidRotor, origin: np.ndarray) -> Invariants:
    basis = sp.eye_array(3 * rotor.node_count, format="csr")
    matrices = (rotor.mass, rotor.stiffness, sparse_damping(rotor))
    invariants = Invariants.of(rotor.nodes - origin, *matrices, basis, rotor.axis.direction)
    structural = rotor.structural_damping
    return invariants if structural is None else replace(invariants, H=structural)


def _second_order(
    rotor: SolidRotor, invariants: Invariants, level: str
) -> tuple[Invariants, tuple[np.ndarray, np.ndarray]]:
    """Return the invariants, with K_G at the level 'full', and the factors V and W of the rest.

    Raises
    ------
    ValueError
        For 'full' with a rotor that carries no prestress.
    """
    if level == "full":
        if rotor.carried_prestress is None:
            raise ValueError(NO_PRESTRESS)
        factors = relief_factors(invariants, relief_rotations(rotor)[0])
        carried = rotor.carried_prestress
        return replace(invariants, K2=carried.per_square, K4=carried.per_fourth_power), factors
    V, W = tilt_factors(invariants)
    return invariants, (V, W if level == "tilt" else 0.0 * W)


@dataclass(frozen=True, eq=False)
class FullEquations(SupportedRotor):
    """A solid rotor with linear supports, unreduced: sparse equations at any spin speed.

    Attributes
    ----------
    axis : SpinAxis
    nodes : ndarray, shape (n, 3)
        Mesh coordinates [m].
    supports : tuple of Support
    motions : tuple of scipy.sparse.csr_array, each (6, 3n)
        Interface motion of every support along (n1, n2, e).
    invariants : Invariants
        Sparse, about the foot of the centre of mass on the axis; K2 and K4 only at 'full'.
    tilt : tuple of ndarray, (6, 3n) and (6, 6)
        V and W of the centrifugal stiffening ``K2 + VᵀWV`` per Ω².
    rotor : SolidRotor
    stiffening : {'none', 'tilt', 'full'}
        Of centrifugal stiffening.
    spin : Spin, optional
        The spin as a coordinate; see :meth:`with_spin`.
    """

    axis: SpinAxis
    nodes: np.ndarray
    supports: tuple[Support, ...]
    motions: tuple[sp.csr_array, ...]
    invariants: Invariants
    tilt: tuple[np.ndarray, np.ndarray]
    rotor: SolidRotor
    stiffening: str
    spin: Spin | None = None

    @classmethod
    def of(
        cls: type[Kind],
        rotor: SolidRotor,
        supports: Sequence[Support] = (),
        stiffening: str = "auto",
    ) -> Kind:
        """Put a solid rotor on supports.

        Raises
        ------
        ValueError
            For an unknown interface or level of stiffening.
        """
        check_interfaces(supports, rotor.interfaces)
        origin = rotor.axis.project(rotor.center_of_mass)
        level = chosen_level(stiffening, rotor.carried_prestress is not None)
        invariants, tilt = _second_order(rotor, _invariants(rotor, origin), level)
        turn = np.kron(np.eye(2), axes_of(rotor.axis).T)
        motions = tuple(
            sp.csr_array(turn @ rotor.interfaces[s.interface].mean_motion(rotor.node_count))
            for s in supports
        )
        supports = tuple(supports)
        return cls(rotor.axis, rotor.nodes, supports, motions, invariants, tilt, rotor, level)

    def with_spin(self: Kind) -> Kind:
        """Return the same with the spin as a coordinate, as all analyses need it."""
        rotations = rotations_of(self.rotor)
        if self.spin is not None or rotations is None:
            return self
        spin = Spin.of(rotations, self.supports, self.motions, self.invariants, self.axis)
        warn_of_eccentricity(self.invariants, spin)
        return replace(self, spin=spin)

    @cached_property
    def _per_speed(self) -> tuple[sp.csr_array, sp.csr_array]:
        """Coriolis matrix per Ω, and stiffness per Ω² without that of :attr:`tilt`."""
        none = sp.csr_array(self.invariants.C.shape)
        K2 = none if self.invariants.K2 is None else self.invariants.K2
        terms = SpinTerms.of(self.invariants, Stiffening(K2, none))
        return terms.damping(1.0), terms.stiffness(1.0)

    def residual(
        self,
        speed: float,
        values: np.ndarray,
        stack: dict[int, np.ndarray],
        strained: dict[int, np.ndarray] | None = None,
        torsion: float = 0.0,
    ) -> dict[int, np.ndarray]:
        """Return what modes leave of the equations, per harmonic (3n, k) [N].

        ``r_n = (s²M + s(D + 2ΩG) + K + Ω²(K2 − C) + Ω⁴K4) X_n + supports``, ``s = λ + inΩ``. K
        is applied to `strained`, the stack itself by default; without free rigid motions in it,
        rounding does not make forces of them. `torsion` is of :meth:`LinearRotor.steady_torsion`.
        """
        inv, left = self.invariants, {}
        strained = stack if strained is None else strained
        for n, X in stack.items():
            rate = values + 1j * n * speed
            left[n] = (
                inv.M @ (X * rate**2)
                + (inv.D @ X + speed * self._coriolis(X)) * rate
                + inv.K @ strained[n]
                + self._spin_stiffness(X, speed)
            )
            if torsion:
                left[n] += torsion * np.outer(self.spin.momentum, self.spin.amount(X))
        for index, support in enumerate(self.supports):
            damping, stiffness = support.terms(speed)
            if speed == 0.0:  # θ stands still: all harmonics are one
                zero = np.zeros((6, 6))
                damping = {0: sum(damping.values(), zero)}
                stiffness = {0: sum(stiffness.values(), zero)}
            moved = {m: self._moved(index, X) for m, X in stack.items()}
            for n, residual in left.items():
                for m, u in moved.items():
                    rate = values + 1j * m * speed
                    force = 0.0
                    if n - m in stiffness:
                        force = stiffness[n - m] @ u
                    if n - m in damping:
                        force = force + damping[n - m] @ (u * rate)
                    if np.ndim(force):
                        residual += self._pulled(index, force)
        return left

    def _coriolis(self, X: np.ndarray) -> np.ndarray:
        """Return ``2G X``, shape (3n, k)."""
        force = self._per_speed[0] @ X
        return force if self.spin is None else force - 2.0 * self.spin.unturned(X)

    def _spin_stiffness(self, X: np.ndarray, speed: float) -> np.ndarray:
        """Return ``(Ω²(K2 − C) + Ω⁴K4) X``, shape (3n, k)."""
        (V, W), matrix, K4 = self.tilt, self._per_speed[1], self.invariants.K4

        def apply(Y: np.ndarray) -> np.ndarray:
            force = speed**2 * (matrix @ Y + V.T @ (W @ (V @ Y)))
            return force if K4 is None else force + speed**4 * (K4 @ Y)

        return apply(X) if self.spin is None else self.spin.uncoupled(apply, X)

    def _moved(self, index: int, X: np.ndarray) -> np.ndarray:
        """Return the motion (6, k) at a support."""
        u = self.motions[index] @ X
        if self.spin is not None:
            u = u + np.outer(self.spin.shifts[index], self.spin.amount(X))
        return u

    def _pulled(self, index: int, force: np.ndarray) -> np.ndarray:
        """Return the nodal forces (3n, k) of forces and moments (6, k) at a support."""
        nodal = self.motions[index].T @ force
        if self.spin is not None:
            nodal = nodal + np.outer(self.spin.momentum, self.spin.shifts[index] @ force)
        return nodal
