"""A reduced rotor whose supports stand on a foundation: dense equations at any spin speed.

The rotor's coordinates x are those of its basis in the rotor frame, the foundation's y those of its
modes in inertial axes. A support acts on the displacement and rotation of its interface against its
point, ``U x − Rᵀ(θ) B y`` in the rotor's axes; so the blocks that couple x and y turn once a
revolution, whatever the support is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg

from exudyn_rotor.bearings.support import Support
from exudyn_rotor.cached import cached_property
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.models.fourier_terms import join, join_turning
from exudyn_rotor.linear.models.protocol import PointMotions
from exudyn_rotor.linear.models.rotor.extended_rotor import ExtendedRotor
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor, add_terms
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, Terms
from exudyn_rotor.solid.places import leeway
from exudyn_rotor.theory.rotating_axes import axes_of, turning_harmonics

ON_FOUNDATION = "{} (foundation)"
_ROUNDING = 1e-14  # of products of coefficients with rotations
# u − Rᵀ(θ) w in axes that turn, of (u, w)
_SEEN = {-n: np.hstack([(n == 0) * np.eye(6), -R]) for n, R in turning_harmonics(6).items()}


@dataclass(frozen=True, eq=False)
class RotorOnFoundation(ExtendedRotor):
    """A reduced rotor whose supports stand on a foundation; see :class:`LinearModel`.

    Attributes
    ----------
    plain : LinearRotor
        The same rotor with its supports on the ground.
    foundation : Foundation
        In modal coordinates, along (n1, n2, e).
    """

    plain: LinearRotor
    foundation: Foundation

    @classmethod
    def of(cls, plain: LinearRotor, foundation: Foundation) -> RotorOnFoundation:
        """Put a rotor with its supports on a foundation in the axes of its mesh.

        Raises
        ------
        ValueError
            Where a support has no point there, or is off it; for springs that hold the spin by
            their distance from the axis, or turn with the rotor, whose steady forces bear on it.
        """
        axis = plain.rotor.axis
        for support in plain.supports:
            interface = plain.rotor.interfaces[support.interface]
            place = axis.project(interface.reference)
            foundation.motion(support.interface, place, leeway(interface.radius, axis.direction))
        if plain.spin is not None and plain.spin.coupled:
            raise ValueError(
                "foundation: springs that hold the rotor's spin, off its axis or turning with it, "
                "can stand on the ground only; linearise a scene with them"
            )
        model = cls(plain, foundation.modal().turned(axes_of(axis).T))
        for name in model.standing_interfaces:
            if name in plain.interfaces:
                raise ValueError(f"foundation: {name!r} is an interface of the rotor; rename it")
        return model

    # -------------------------------------------------------------- what it consists of

    @property
    def _more(self) -> int:
        return self.foundation.size

    @property
    def beside(self) -> tuple[str, ...]:
        """Names of the foundation's modes."""
        return names_of_foundation(self.foundation)

    @property
    def standing(self) -> np.ndarray:
        """Coordinates of the foundation."""
        return np.arange(self.plain.size, self.size)

    @property
    def standing_interfaces(self) -> tuple[str, ...]:
        """Names of the foundation's points."""
        return tuple(map(ON_FOUNDATION.format, self.foundation.points))

    @property
    def interfaces(self) -> tuple[str, ...]:
        """Names of the rotor's interfaces and of the foundation's points."""
        return self.plain.interfaces + self.standing_interfaces

    def interface_motion(self, name: str) -> np.ndarray:
        """Return an interface's motion (6, k) in the rotor frame, a point's in inertial axes."""
        motion = np.zeros((6, self.size))
        if name in self.standing_interfaces:
            point = list(self.foundation.points)[self.standing_interfaces.index(name)]
            motion[:, self.standing] = self.foundation.points[point]
        else:
            motion[:, : self.plain.size] = self.plain.interface_motion(name)
        return motion

    def point_motions(self, most: int) -> PointMotions:
        """Return points of the rotor, and the foundation's motion as large as theirs.

        Mass for mass: a coordinate of unit modal mass moves as much as all points of the rotor by
        ``1/√m``.
        """
        points = self.plain.point_motions(most)
        share = np.sqrt(points.share(self.plain.invariants.mass))
        return replace(
            points,
            motion=self._wide(points.motion),
            standing=share * np.eye(self.size)[self.standing],
        )

    # -------------------------------------------------------------- equations

    @property
    def mass_matrix(self) -> np.ndarray:
        """M, shape (k, k)."""
        return self._joined(self.plain.mass_matrix, self.foundation.mass)

    def at(self, speed: float) -> PeriodicSystem:
        """Return the equations at a spin speed [rad/s]."""
        system, y = self.plain.at(speed), self.foundation
        own = {"M": y.mass, "D": y.damping, "K": y.stiffness}
        terms = {
            name: {
                n: self._joined(X, own[name] if n == 0 else None)
                for n, X in getattr(system, name).items()
            }
            for name in own
        }
        for support, pulled in zip(self.supports, self._both, strict=True):
            for name, harmonics in zip("DK", _coupling(support, speed), strict=True):
                add_terms(terms[name], harmonics, pulled)
        H = system.H if system.H is None else self._joined(system.H)
        return PeriodicSystem(float(speed), *terms.values(), H, drift=system.drift)

    @cached_property
    def _both(self) -> list[np.ndarray]:
        """The motions (12, k) of each support's interface and point."""
        points = [self.foundation.points[support.interface] for support in self.supports]
        return list(map(scipy.linalg.block_diag, self.plain.supported_motions, points))

    def supported_motion(self, index: int) -> Terms:
        """Return the motion (6, k) that a support acts on, along (n1, n2, e) of the rotor frame."""
        return {n: X @ self._both[index] for n, X in _SEEN.items()}

    @property
    def base_loads(self) -> np.ndarray | None:
        """Loads of unit accelerations of the ground; None where the foundation does not tell S."""
        if self.foundation.participation is None:
            return None
        return np.hstack([self.plain.base_loads, -self.foundation.participation])

    def undamped(self) -> RotorOnFoundation:
        """Return the model without damping, and without the skew part of supports' stiffness."""
        return replace(self, plain=self.plain.undamped(), foundation=self.foundation.undamped())

    def with_supports(self, supports: tuple[Support, ...]) -> RotorOnFoundation:
        """Return the model with other supports at the same interfaces."""
        return replace(self, plain=self.plain.with_supports(supports))

    # -------------------------------------------------------------- as the rotor on the ground

    @property
    def supports(self) -> tuple[Support, ...]:
        """Supports between rotor and foundation."""
        return self.plain.supports


def names_of_foundation(foundation: Foundation) -> tuple[str, ...]:
    """Return the names of a foundation's modes as coordinates."""
    return tuple(f"foundation, {number}" for number in range(1, foundation.size + 1))


def _coupling(support: Support, speed: float) -> tuple[Terms, Terms]:
    """Return Fourier terms of damping and stiffness by (u, w), each (12, 12).

    u is the motion of the interface in the rotor frame, w that of the point in inertial axes. The
    block of u alone is left out: it is that of the rotor on the ground.
    """
    sums = {}, {}, {}
    join_turning(sums, support.parts(speed), _SEEN)
    damping, stiffness, carried = sums
    join(stiffness, {n: speed * X for n, X in carried.items()})
    K, D = support.matrices(speed)
    sizes = np.abs(D).max(), np.abs(K).max() + abs(speed) * np.abs(D).max()
    for terms in (damping, stiffness):
        for X in terms.values():
            X[:6, :6] = 0.0
    return tuple(
        {n: X for n, X in terms.items() if np.abs(X).max() > _ROUNDING * size}
        for terms, size in zip((damping, stiffness), sizes, strict=True)
    )
