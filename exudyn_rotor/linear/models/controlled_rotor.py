"""A rotor on supports that have coordinates of their own: magnetic bearings, pads that tilt.

A controller's coordinates are pairs along (n1, n2). In the rotor frame, where all equations are, a
pair with the inertia μ that stands still has those of a point mass beside the rotor,

    μ (q̈ + 2Ω ẽ q̇ − Ω² q),

and what is between rotor and controller turns as any support does: where both control axes are
alike, all coefficients are constant. On a foundation magnets act, and sensors measure, against its
points. The tilts of pads stand still; their films act as supports between the journal and a pad.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from exudyn_rotor.bearings.controlled_support import ControlledSupport, PadSupport
from exudyn_rotor.bearings.given import check_interfaces
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.models.extended_rotor import ExtendedRotor
from exudyn_rotor.linear.models.links import join_turning, stacked
from exudyn_rotor.linear.models.points import ACROSS, with_pairs
from exudyn_rotor.linear.models.protocol import PointMotions
from exudyn_rotor.linear.models.rotor_on_foundation import RotorOnFoundation
from exudyn_rotor.linear.models.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, Terms
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.rotating_axes import axial_skew, into_rotor_frame, turned_harmonics


@dataclass(frozen=True, eq=False)
class ControlledRotor(ExtendedRotor):
    """A rotor on supports, some of which have coordinates of their own; see :class:`LinearModel`.

    Attributes
    ----------
    plain : LinearRotor or RotorOnFoundation
        The rotor on all else, and on the stiffness that acts without controllers.
    controlled : tuple of ControlledSupport and PadSupport
        These last.
    """

    plain: LinearRotor | RotorOnFoundation
    controlled: tuple[ControlledSupport | PadSupport, ...]

    @classmethod
    def of(
        cls,
        rotor: ReducedRotor | SolidRotor,
        supports: Sequence[Support],
        controlled: Sequence[ControlledSupport | PadSupport],
        stiffening: str = "auto",
        foundation: Foundation | None = None,
    ) -> ControlledRotor:
        """Put a rotor on supports, those with coordinates of their own apart.

        Raises
        ------
        ValueError
            For an unknown interface; as :meth:`RotorOnFoundation.of`.
        """
        made = LinearRotor.of if isinstance(rotor, ReducedRotor) else LinearRotor.of_solid
        check_interfaces(controlled, rotor.interfaces)
        controlled = sorted(controlled, key=lambda one: isinstance(one, PadSupport))
        places = [
            support
            for one in controlled
            for support in (Support(one.interface, one.static_stiffness), Support(one.sensor))
        ]
        held = made(rotor, (*supports, *places), stiffening)
        direct = [
            support
            for one in controlled
            for support in (Support(one.interface, one.direct_stiffness), Support(one.sensor))
        ]
        plain = held.with_supports((*supports, *direct))
        if foundation is not None:
            plain = RotorOnFoundation.of(plain, foundation)
        return cls(plain, tuple(controlled))

    @property
    def held(self) -> LinearRotor | RotorOnFoundation:
        """The rotor with the static stiffness of its controllers."""
        own = 2 * len(self.controlled)
        supports = list(self.plain.supports)
        supports[len(supports) - own :: 2] = [
            Support(one.interface, one.static_stiffness) for one in self.controlled
        ]
        return self.plain.with_supports(tuple(supports))

    def undamped(self) -> LinearRotor | RotorOnFoundation:
        """Return the rotor with the static stiffness of its controllers, and without damping."""
        return self.held.undamped()

    @property
    def _more(self) -> int:
        return sum(one.size for one in self.controlled)

    @property
    def beside(self) -> tuple[str, ...]:
        """Names of the coordinates of a foundation, then of controllers."""
        given = self.plain.beside if isinstance(self.plain, RotorOnFoundation) else ()
        return given + names_of_controllers((one.interface, one.size) for one in self.controlled)

    @property
    def interfaces(self) -> tuple[str, ...]:
        """Names of the rotor's interfaces."""
        return self.plain.interfaces

    @property
    def standing(self) -> np.ndarray:
        """Coordinates of a foundation, and of pads; the controllers' turn with the rotor."""
        return np.r_[self.plain.standing, self.plain.size + self._turning : self.size]

    @property
    def standing_interfaces(self) -> tuple[str, ...]:
        """Names of the foundation's points."""
        return self.plain.standing_interfaces

    @property
    def base_loads(self) -> np.ndarray | None:
        """Loads of unit accelerations of the ground; None where a foundation does not tell S."""
        loads = self.plain.base_loads
        return None if loads is None else self._wide(loads)

    @property
    def mass_matrix(self) -> np.ndarray:
        """Mass matrix, the controllers' inertia last."""
        return self._joined(self.plain.mass_matrix, np.diag(self._inertia))

    @property
    def stiffness_varies(self) -> bool:
        """True where supports or a static displacement have a stiffness that is not in Ω²."""
        return self.plain.stiffness_varies or self._turning < self._more

    def interface_motion(self, name: str) -> np.ndarray:
        """Return an interface's motion (6, k): displacement and rotation along (n1, n2, e)."""
        return self._wide(self.plain.interface_motion(name))

    def point_motions(self, most: int) -> PointMotions:
        """Return points of the rotor, one for each pair of the controllers' coordinates, and pads.

        These mass for mass, as foundations.
        """
        given, rows = self.plain.point_motions(most), np.eye(self.size)[self.plain.size :]
        pads = np.sqrt(given.share(self.plain.invariants.mass) * self._inertia)[:, None] * rows
        own = [pads[self._turning :]]
        if given.standing is not None:
            own.insert(0, self._wide(given.standing))
        standing = np.vstack(own)
        wide = replace(
            given,
            motion=self._wide(given.motion),
            standing=standing if len(standing) else None,
        )
        return with_pairs(wide, rows[: self._turning])

    def own_rows(self, index: int) -> slice:
        """Return where the coordinates of a controller are."""
        start = self.plain.size + sum(one.size for one in self.controlled[:index])
        return slice(start, start + self.controlled[index].size)

    def sensed(self, index: int) -> Terms:
        """Return the displacement (3, k) along (n1, n2, e) that a controller measures."""
        return self._displacement(self._place(index) + 1)

    def at(self, speed: float) -> PeriodicSystem:
        """Return the equations at a spin speed [rad/s]."""
        plain, own = self.plain.at(speed), self._inertia
        D, K = ({n: self._joined(X) for n, X in terms.items()} for terms in (plain.D, plain.K))
        beside, own = slice(self.plain.size, self.plain.size + self._turning), own[: self._turning]
        gyroscopic = np.kron(np.eye(len(own) // 2), axial_skew(3)[:2, :2])
        D[0][beside, beside] += 2.0 * speed * own[:, None] * gyroscopic
        K[0][beside, beside] -= speed**2 * np.diag(own)
        for between in (self._between, self._films(speed)):
            for terms, added, factor in zip((D, K, K), between, (1.0, 1.0, speed), strict=True):
                for n, X in added.items():
                    terms[n] = terms.get(n, 0.0) + factor * X
        H = None if plain.H is None else self._joined(plain.H)
        return PeriodicSystem(plain.speed, {0: self.mass_matrix}, D, K, H, plain.rounding)

    @cached_property
    def _inertia(self) -> np.ndarray:
        """Inertia of the own coordinates [kg]."""
        return np.concatenate([one.masses for one in self.controlled])

    @cached_property
    def _turning(self) -> int:
        """Number of own coordinates that turn with the rotor; they come first."""
        return sum(one.size for one in self.controlled if isinstance(one, ControlledSupport))

    @cached_property
    def _between(self) -> tuple[Terms, Terms, Terms]:
        """Fourier terms of damping, stiffness and stiffness per Ω that controllers bring."""
        sums = {}, {}, {}
        for index, one in enumerate(self.controlled):
            if isinstance(one, PadSupport):
                continue
            count = len(one.damping) // 2
            lifted = np.kron(np.eye(count), ACROSS)
            D, K = (lifted @ X @ lifted.T for X in (one.damping, one.stiffness))
            K[:3, :3] = 0.0  # of the plain rotor
            own = np.zeros((one.size, self.size))
            own[:, self.own_rows(index)] = np.eye(one.size)
            own = {0: np.kron(np.eye(count - 2), ACROSS) @ own}
            ports = stacked([self._displacement(self._place(index)), self.sensed(index), own])
            turning = D @ axial_skew(len(D))
            join_turning(sums, tuple(map(turned_harmonics, (D, K, turning))), ports)
        return sums

    def _films(self, speed: float) -> tuple[Terms, Terms, Terms]:
        """Return what :attr:`_between` is of films on pads, at a spin speed [rad/s]."""
        sums = {}, {}, {}
        for index, one in enumerate(self.controlled):
            if not isinstance(one, PadSupport):
                continue
            journal = self._displacement(self._place(index))
            own = np.eye(self.size)[self.own_rows(index)]
            for film, tangent, row in zip(one.films, one.tangents, own, strict=True):
                seen = dict(journal)
                for n, t in into_rotor_frame(np.array([*tangent, 0.0])).items():
                    seen[n] = seen.get(n, 0.0) - np.outer(t, row)
                parts = ({n: X[:3, :3] for n, X in part.items()} for part in film.parts(speed))
                join_turning(sums, tuple(parts), seen)
        return sums

    def _displacement(self, place: int) -> dict[int, np.ndarray]:
        """Return the displacement (3, k) of one of the plain rotor's supports."""
        motion = self.plain.supported_motion(place)
        return {n: self._wide(U[:3]) for n, U in motion.items()}

    def _place(self, index: int) -> int:
        """Return where a controller's pair of supports is among those of the plain rotor."""
        return len(self.plain.supports) - 2 * len(self.controlled) + 2 * index


def names_of_controllers(controllers: Iterable[tuple[str, int]]) -> tuple[str, ...]:
    """Return the names of coordinates of controllers, given their interfaces and sizes."""
    return tuple(
        f"controller {index} at {interface}, {number}"
        for index, (interface, size) in enumerate(controllers, 1)
        for number in range(1, size + 1)
    )
