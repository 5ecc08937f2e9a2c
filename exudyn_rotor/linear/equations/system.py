"""One representation behind all linear analyses.

    M(θ) ẍ + D(θ) ẋ + K(θ) x = f(t),    θ = Ω t

with the matrices given by their Fourier terms in θ; constant where only the term 0 exists. The
coordinates of a rotor with supports are those of its basis in the rotor frame, rigid motions
included: Eqs. (105) and (109) with centrifugal stiffening.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from exudyn_rotor.linear.equations.spin import Spin
from exudyn_rotor.linear.equations.supports import Support, axes_of, check_interfaces
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.stiffening import stiffening as second_order

Terms = Mapping[int, np.ndarray]

_ECCENTRIC = 1e-3  # relative error of frequencies that is worth a warning
_SINGULAR = 1e-12  # of a stiffness that leaves motions free


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
        The spin as a coordinate.
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
        check_interfaces(supports, rotor.interfaces)
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

    @property
    def free_spin(self) -> Spin | None:
        """The spin where nothing holds it, else None."""
        return self.spin if self.spin is not None and self.spin.free else None

    @cached_property
    def _centrifugal(self) -> np.ndarray:
        matrix = self.K2 - self.invariants.C
        if self.spin is None:
            return matrix
        return self.spin.uncoupled(matrix.__matmul__, np.eye(self.size))

    def _supported_motion(self, index: int) -> np.ndarray:
        """Return the motion (6, k) at a support, which a free spin does not displace."""
        motion = self.interface_motion(self.supports[index].interface)
        if self.spin is None:
            return motion
        return motion + np.outer(self.spin.shifts[index], self.spin.momentum)

    def at(self, speed: float) -> PeriodicSystem:
        """Return the equations at a spin speed [rad/s]."""
        inv = self.invariants
        M = {0: inv.M}
        D = {0: inv.D + 2.0 * speed * inv.G}
        K = {0: inv.K + speed**2 * self._centrifugal}
        for index, support in enumerate(self.supports):
            U = self._supported_motion(index)
            damping, stiffness = support.terms(speed)
            _add(D, damping, U)
            _add(K, stiffness, U)
        if self.spin is not None and self.spin.coupled:
            own = self.steady_torsion(speed)
            K[0] = K[0] + own * np.outer(self.spin.momentum, self.spin.momentum)
        return PeriodicSystem(float(speed), M, D, K)

    def steady_torsion(self, speed: float) -> float:
        """Return the stiffness of a coupled spin by the steady forces of the supports [rad²/s²].

        ``F·ρ``, see :mod:`exudyn_rotor.linear.equations.spin`; F is the mean over a revolution of
        what the rotor's own unbalance causes.
        """
        motions = [self._supported_motion(index) for index in range(len(self.supports))]
        pulls = [s.terms(speed)[1].get(0, np.zeros((6, 6))).real for s in self.supports]
        K = self.invariants.K + speed**2 * self._centrifugal
        for U, pull in zip(motions, pulls, strict=True):
            K = K + U.T @ pull @ U
        rest = self.spin.rest()
        load = speed**2 * (rest.T @ self.unit_unbalance)
        steady = rest @ np.linalg.lstsq(rest.T @ K @ rest, load, rcond=_SINGULAR)[0]
        forces = [(pull @ (U @ steady))[:3] for U, pull in zip(motions, pulls, strict=True)]
        return float(sum(f @ bend for f, bend in zip(forces, self.spin.bends, strict=True)))


def warn_of_eccentricity(invariants: Invariants, spin: Spin) -> None:
    """Tell that spin and lateral motion are coupled where they are taken apart."""
    distance = float(np.linalg.norm(invariants.center))
    error, band = without_drive(invariants)
    if error <= _ECCENTRIC:
        return
    what = (
        "a load and keep spin and lateral motion apart, as for a rotor driven at constant speed. "
        f"Without a drive, frequencies differ by about {error:.1%} at rest, near a critical speed "
        "by m r²/Θ with the whirl radius r of the centre of mass, and the rotor is unstable up to "
        f"about {band:.0%} above it; balance the rotor"
    )
    if spin.coupled:
        what = (
            "a load. Its spin on springs is complete, but tilts lack the stiffness by the springs' "
            "steady forces; hold a blade by rotor.clamped(…) instead"
        )
    warnings.warn(
        f"the centre of mass is {distance:.4g} m off the spin axis; linear analyses take this as "
        + what,
        UserWarning,
        stacklevel=_user_level(),
    )


def _user_level() -> int:
    """Return the stack level of the first caller outside the package."""
    frame, level = sys._getframe(1), 1
    while frame.f_back and frame.f_globals.get("__name__", "").startswith("exudyn_rotor."):
        frame, level = frame.f_back, level + 1
    return level


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
