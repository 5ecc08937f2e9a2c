"""One representation behind all linear analyses.

    M(θ) ẍ + D(θ) ẋ + K(θ) x = f(t),    θ = Ω t

with the matrices given by their Fourier terms in θ; constant where only the term 0 exists. The
coordinates of a rotor with supports are those of its basis in the rotor frame, rigid motions
included: Eqs. (105) and (109) with centrifugal stiffening.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from exudyn_rotor.invariants import Invariants
from exudyn_rotor.linear.equations.spin import Spin
from exudyn_rotor.linear.equations.supports import Support, axes_of
from exudyn_rotor.reduced import ReducedRotor
from exudyn_rotor.stiffening import stiffening as second_order

Terms = Mapping[int, np.ndarray]

_ECCENTRIC = 1e-3  # relative error of frequencies that is worth a warning


@dataclass(frozen=True, eq=False)
class PeriodicSystem:
    """Linear equations with coefficients that repeat every revolution.

    Attributes
    ----------
    speed : float
        Spin speed Ω [rad/s].
    M, D, K : mapping of int to ndarray, shape (k, k)
        Fourier terms: ``K(θ) = Σ K[n] exp(i n θ)``; K[−n] is the conjugate of K[n].
    """

    speed: float
    M: Terms
    D: Terms
    K: Terms

    @property
    def size(self) -> int:
        """Number of coordinates k."""
        return len(self.M[0])

    @property
    def order(self) -> int:
        """Highest harmonic of any coefficient; 0 for a constant system."""
        return max(abs(n) for terms in (self.M, self.D, self.K) for n in terms)

    @property
    def is_constant(self) -> bool:
        """True when no coefficient depends on θ."""
        return self.order == 0

    def matrices(self, theta: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return M, D, K at a spin angle [rad]."""
        return tuple(_sum(terms, theta) for terms in (self.M, self.D, self.K))


def _sum(terms: Terms, theta: float) -> np.ndarray:
    return sum(term * np.exp(1j * n * theta) for n, term in terms.items()).real


@dataclass(frozen=True, eq=False)
class LinearRotor:
    """A reduced rotor with linear supports, ready for any spin speed.

    Attributes
    ----------
    rotor : ReducedRotor
    supports : tuple of Support
    invariants : Invariants
        In the reduced basis, about the foot of the centre of mass on the axis.
    K2 : ndarray, shape (k, k)
        Centrifugal stiffening per Ω².
    spin : Spin, optional
        The spin as a coordinate that unbalance does not couple.
    """

    rotor: ReducedRotor
    supports: tuple[Support, ...]
    invariants: Invariants
    K2: np.ndarray
    spin: Spin | None = None

    @classmethod
    def of(
        cls,
        rotor: ReducedRotor,
        supports: Sequence[Support] = (),
        stiffening: str = "tilt",
        spin: tuple[np.ndarray, np.ndarray] | None = None,
    ) -> LinearRotor:
        """Put a rotor on supports; `spin` is its s and Ms where it is no column of the basis.

        Raises
        ------
        ValueError
            If a support is at an unknown interface; the message lists the known ones.
        """
        for support in supports:
            if support.interface not in rotor.interfaces:
                known = ", ".join(rotor.interfaces) or "none"
                raise ValueError(
                    f"support at {support.interface!r}: no such interface; the rotor has: {known}"
                )
        origin = rotor.axis.project(rotor.center_of_mass)
        invariants = rotor.invariants.moved(origin - rotor.center_of_mass)
        K2 = second_order(invariants, stiffening).K2
        linear = cls(rotor, tuple(supports), invariants, K2)
        if "spin" in rotor.rigid:
            spin = (np.eye(rotor.size)[rotor.rigid.index("spin")],) * 2
        if spin is None:
            return linear
        motions = [linear.interface_motion(support.interface) for support in supports]
        found = Spin.of(*spin, supports, motions, invariants, rotor.axis)
        warn_of_eccentricity(invariants, found)
        return replace(linear, spin=found)

    @property
    def size(self) -> int:
        """Number of coordinates k."""
        return self.invariants.size

    @cached_property
    def unit_unbalance(self) -> np.ndarray:
        """Load of the rotor's own eccentricity per Ω², ``h`` (83), shape (k,), rotor frame."""
        return self.invariants.h

    def interface_motion(self, name: str) -> np.ndarray:
        """Return the interface's motion (6, k): displacement and rotation along (n1, n2, e)."""
        turn = np.kron(np.eye(2), axes_of(self.rotor.axis).T)
        return turn @ self.rotor.interfaces[name].motion

    @cached_property
    def _coriolis(self) -> np.ndarray:
        return self._without_spin(self.invariants.G)

    @cached_property
    def _centrifugal(self) -> np.ndarray:
        return self._without_spin(self.K2 - self.invariants.C)

    def _without_spin(self, matrix: np.ndarray) -> np.ndarray:
        if self.spin is None:
            return matrix
        return self.spin.uncoupled(matrix.__matmul__, np.eye(self.size))

    def _supported_motion(self, index: int) -> np.ndarray:
        """Return the motion (6, k) at a support, which the spin does not displace."""
        motion = self.interface_motion(self.supports[index].interface)
        if self.spin is None:
            return motion
        return motion + np.outer(self.spin.shifts[index], self.spin.momentum)

    def at(self, speed: float) -> PeriodicSystem:
        """Return the equations at a spin speed [rad/s]."""
        inv = self.invariants
        M = {0: inv.M}
        D = {0: inv.D + 2.0 * speed * self._coriolis}
        K = {0: inv.K + speed**2 * self._centrifugal}
        for index, support in enumerate(self.supports):
            U = self._supported_motion(index)
            damping, stiffness = support.terms(speed)
            _add(D, damping, U)
            _add(K, stiffness, U)
        return PeriodicSystem(float(speed), M, D, K)


def warn_of_eccentricity(invariants: Invariants, spin: Spin | None) -> None:
    """Tell that spin and lateral motion are coupled where they are taken apart."""
    distance = float(np.linalg.norm(invariants.center))
    error, band = without_drive(invariants)
    if spin is None or error <= _ECCENTRIC:
        return
    warnings.warn(
        f"the centre of mass is {distance:.4g} m off the spin axis; linear analyses take this as "
        "a load and keep spin and lateral motion apart, as for a rotor driven at constant speed. "
        f"Without a drive, frequencies differ by about {error:.1%} at rest, near a critical speed "
        "by m r²/Θ with the whirl radius r of the centre of mass, and the rotor is unstable up to "
        f"about {band:.0%} above it; balance the rotor",
        UserWarning,
        stacklevel=4,
    )


def without_drive(invariants: Invariants) -> tuple[float, float]:
    """Return how far an eccentric rotor that nothing drives is from one at constant speed.

    The change of frequencies at rest, and the width of the unstable speeds above a critical speed,
    both relative: ``ε/2`` and ``(ε/2)^⅓`` with ``ε = m e²/Θ``, those of a Jeffcott rotor for small
    ε. Towards the critical speed the first grows as ``m r²/Θ``, r the whirl radius of the centre of
    mass.
    """
    inertia = invariants.mass * float(invariants.center @ invariants.center)
    error = 0.5 * inertia / invariants.Theta if inertia > 0.0 else 0.0
    return error, error ** (1.0 / 3.0)


def _add(terms: dict[int, np.ndarray], harmonics: Terms, U: np.ndarray) -> None:
    for n, X in harmonics.items():
        block = U.T @ X @ U
        terms[n] = terms.get(n, 0.0) + (block.real if n == 0 else block)
