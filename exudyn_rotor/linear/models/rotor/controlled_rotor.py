"""A rotor on supports with coordinates of their own: magnetic bearings, films, pads that tilt.

All equations are in the rotor frame (:mod:`.own_coordinates`). On a foundation magnets act, and
sensors measure, against its points.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from exudyn_rotor.bearings.given import check_interfaces
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.cached import cached_property
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.models.points import with_pairs
from exudyn_rotor.linear.models.protocol import PointMotions
from exudyn_rotor.linear.models.rotor.extended_rotor import ExtendedRotor
from exudyn_rotor.linear.models.rotor.own_coordinates import (
    Controlled,
    OwnCoordinates,
    in_order,
    names_of_own,
    places,
    word_of,
)
from exudyn_rotor.linear.models.rotor.rotor_on_foundation import RotorOnFoundation
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, Terms
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid_rotor import SolidRotor


@dataclass(frozen=True, eq=False)
class ControlledRotor(ExtendedRotor):
    """A rotor on supports, some of which have coordinates of their own; see :class:`LinearModel`.

    Attributes
    ----------
    plain : LinearRotor or RotorOnFoundation
        The rotor on all else, and on the stiffness that acts without controllers.
    own : OwnCoordinates
    """

    plain: LinearRotor | RotorOnFoundation
    own: OwnCoordinates

    @classmethod
    def of(
        cls,
        rotor: ReducedRotor | SolidRotor,
        supports: Sequence[Support],
        controlled: Sequence[Controlled],
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
        controlled = in_order(controlled)
        held = [each for one in controlled for each in places(one, one.static_stiffness)]
        direct = [each for one in controlled for each in places(one, one.direct_stiffness)]
        plain = made(rotor, (*supports, *held), stiffening).with_supports((*supports, *direct))
        if foundation is not None:
            plain = RotorOnFoundation.of(plain, foundation)
        return cls(plain, OwnCoordinates(tuple(controlled), (1.0,) * len(controlled)))

    @property
    def held(self) -> LinearRotor | RotorOnFoundation:
        """The rotor with the static stiffness of its controllers."""
        supports, own = list(self.plain.supports), self.own.supports
        supports[self._place(0) :: 2] = [places(one, one.static_stiffness)[0] for one in own]
        return self.plain.with_supports(tuple(supports))

    def undamped(self) -> LinearRotor | RotorOnFoundation:
        """Return the rotor with the static stiffness of its controllers, and without damping."""
        return self.held.undamped()

    @property
    def _more(self) -> int:
        return self.own.size

    @property
    def beside(self) -> tuple[str, ...]:
        """Names of the coordinates of a foundation, then of controllers, voids and pads."""
        given = self.plain.beside if isinstance(self.plain, RotorOnFoundation) else ()
        own = ((word_of(one), one.interface, one.size) for one in self.own.supports)
        return given + names_of_own(own)

    @property
    def interfaces(self) -> tuple[str, ...]:
        """Names of the rotor's interfaces."""
        return self.plain.interfaces

    @property
    def standing(self) -> np.ndarray:
        """Coordinates of a foundation, and of pads; the controllers' turn with the rotor."""
        return np.r_[self.plain.standing, self.plain.size + self.own.turning : self.size]

    @property
    def voids(self) -> np.ndarray:
        """Coordinates of what films remember."""
        return self.plain.size + self.own.voids

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
        return self._joined(self.plain.mass_matrix, np.diag(self.own.masses))

    @property
    def stiffness_varies(self) -> bool:
        """True where supports or a static displacement have a stiffness that is not in Ω²."""
        return self.plain.stiffness_varies or self.own.varies

    def interface_motion(self, name: str) -> np.ndarray:
        """Return an interface's motion (6, k): displacement and rotation along (n1, n2, e)."""
        return self._wide(self.plain.interface_motion(name))

    def point_motions(self, most: int) -> PointMotions:
        """Return points of the rotor, one for each pair of the controllers' coordinates, and pads.

        These mass for mass, as foundations.
        """
        given, rows = self.plain.point_motions(most), np.eye(self.size)[self.plain.size :]
        pads = np.sqrt(given.share(self.plain.invariants.mass) * self.own.masses)[:, None] * rows
        own = [pads[self.own.turning :]]
        if given.standing is not None:
            own.insert(0, self._wide(given.standing))
        standing = np.vstack(own)
        wide = replace(
            given,
            motion=self._wide(given.motion),
            standing=standing if len(standing) else None,
        )
        return with_pairs(wide, rows[: self.own.turning])

    def own_rows(self, index: int) -> slice:
        """Return where the coordinates of a controller are."""
        rows = self.own.rows(index)
        return slice(self.plain.size + rows.start, self.plain.size + rows.stop)

    def sensed(self, index: int) -> Terms:
        """Return the displacement (3, k) along (n1, n2, e) that a controller measures."""
        return self._displacement(self._place(index) + 1)

    def at(self, speed: float) -> PeriodicSystem:
        """Return the equations at a spin speed [rad/s]."""
        plain, inertia = self.plain.at(speed), self.own.inertia_terms(speed)
        D, K = (
            {n: self._joined(X, own if n == 0 else None) for n, X in terms.items()}
            for terms, own in zip((plain.D, plain.K), inertia, strict=True)
        )
        for between in (self._between, self.own.films(speed, self._journals)):
            for terms, added, factor in zip((D, K, K), between, (1.0, 1.0, speed), strict=True):
                for n, X in added.items():
                    terms[n] = terms.get(n, 0.0) + factor * X
        H = None if plain.H is None else self._joined(plain.H)
        return PeriodicSystem(
            plain.speed, {0: self.mass_matrix}, D, K, H, plain.rounding, plain.drift
        )

    @cached_property
    def _between(self) -> tuple[Terms, Terms, Terms]:
        """Fourier terms of damping, stiffness and stiffness per Ω that controllers bring."""
        sensed = [self.sensed(index) for index in range(len(self.own.supports))]
        return self.own.between(self._journals, sensed)

    @cached_property
    def _journals(self) -> list[Terms]:
        return [self._displacement(self._place(i)) for i in range(len(self.own.supports))]

    def _displacement(self, place: int) -> dict[int, np.ndarray]:
        """Return the displacement (3, k) of one of the plain rotor's supports."""
        motion = self.plain.supported_motion(place)
        return {n: self._wide(U[:3]) for n, U in motion.items()}

    def _place(self, index: int) -> int:
        """Return where a controller's pair of supports is among those of the plain rotor."""
        return len(self.plain.supports) - 2 * len(self.own.supports) + 2 * index
