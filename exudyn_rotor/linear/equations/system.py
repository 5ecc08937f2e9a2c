"""One representation behind all linear analyses.

    M(θ) ẍ + D(θ) ẋ + K(θ) x = f(t),    θ = Ω t

with the matrices given by their Fourier terms in θ; constant where only the term 0 exists. The
coordinates of a rotor with supports are those of its basis in the rotor frame, rigid motions
included: Eqs. (105) and (109) with centrifugal stiffening.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exudyn_rotor.invariants import Invariants
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
    """

    rotor: ReducedRotor
    supports: tuple[Support, ...]
    invariants: Invariants
    K2: np.ndarray

    @classmethod
    def of(
        cls, rotor: ReducedRotor, supports: Sequence[Support] = (), stiffening: str = "tilt"
    ) -> LinearRotor:
        """Put a rotor on supports.

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
        if "spin" in rotor.rigid:
            _warn_of_eccentricity(invariants)
        return cls(rotor, tuple(supports), invariants, second_order(invariants, stiffening).K2)

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
    def _centrifugal(self) -> np.ndarray:
        """``K2 − C`` without what dynamic unbalance couples with the rigid spin."""
        matrix = self.K2 - self.invariants.C
        if "spin" in self.rotor.rigid:
            column = self.rotor.rigid.index("spin")
            own = matrix[column, column]
            matrix[column, :] = matrix[:, column] = 0.0
            matrix[column, column] = own
        return matrix

    def _supported_motion(self, name: str) -> np.ndarray:
        """Return the interface's motion with the spin about the axis, not the centre of mass.

        Unbalance is a load here. What it couples between spin and lateral motion is cancelled by
        the deflection of the steady state, which these equations do not have; kept alone, it makes
        false growth of the order of the eccentricity.
        """
        motion = self.interface_motion(name)
        if "spin" in self.rotor.rigid:
            column = self.rotor.rigid.index("spin")
            offset = axes_of(self.rotor.axis).T @ self.invariants.center
            motion[:3, column] += np.cross(motion[3:, column], offset)
        return motion

    def at(self, speed: float) -> PeriodicSystem:
        """Return the equations at a spin speed [rad/s]."""
        inv = self.invariants
        M = {0: inv.M}
        D = {0: inv.D + 2.0 * speed * inv.G}
        K = {0: inv.K + speed**2 * self._centrifugal}
        for support in self.supports:
            U = self._supported_motion(support.interface)
            damping, stiffness = support.terms(speed)
            _add(D, damping, U)
            _add(K, stiffness, U)
        return PeriodicSystem(float(speed), M, D, K)


def _warn_of_eccentricity(invariants: Invariants) -> None:
    """Tell that spin and lateral motion are coupled where they are taken apart."""
    distance = float(np.linalg.norm(invariants.center))
    error = 0.5 * invariants.mass * distance**2 / invariants.Theta
    if error > _ECCENTRIC:
        warnings.warn(
            f"the centre of mass is {distance:.4g} m off the spin axis; linear analyses take this "
            f"as a load and leave out that it couples spin with lateral motion, which changes "
            f"frequencies by about {error:.1%}; balance the rotor, or analyse its SolidRotor",
            UserWarning,
            stacklevel=4,
        )


def _add(terms: dict[int, np.ndarray], harmonics: Terms, U: np.ndarray) -> None:
    for n, X in harmonics.items():
        block = U.T @ X @ U
        terms[n] = terms.get(n, 0.0) + (block.real if n == 0 else block)
