"""A scene with films that conserve mass: what their voids remember is coordinates beside its own.

Forces by place and velocity do not tell what such films do, so the equations of the scene come
without their stiffness and damping. To them are added those of
:class:`exudyn_rotor.bearings.film.void_states.VoidStates` about a journal at rest under its mean
force, between it and what carries the bearing. Their coordinates are pairs that turn with the
rotor, as in :mod:`exudyn_rotor.linear.models.rotor.own_coordinates`.

A rotor on an uneven mesh, or with a shaft that is, moves under its weight twice in a revolution. A
motion of ε clearances changes the films' coefficients by a share of order ε, twice in a revolution,
too, and exponents by one of order ε², as at first order the mean of that change is zero. It is left
out here, as in lists of supports; scenes with other films have it about the steady motion.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import scipy.linalg as la

from exudyn_rotor.bearings.controlled_support import FilmSupport
from exudyn_rotor.bearings.film.state import FilmState
from exudyn_rotor.bearings.film.void_states import COUNT
from exudyn_rotor.bearings.journal_bearing import LITTLE, JournalBearing
from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.models.extended_model import ExtendedModel
from exudyn_rotor.linear.models.fourier_terms import add, join
from exudyn_rotor.linear.models.points import with_pairs
from exudyn_rotor.linear.models.protocol import LinearModel, PointMotions
from exudyn_rotor.linear.models.rotor.own_coordinates import OwnCoordinates
from exudyn_rotor.linear.models.scene.linear_scene import Journal, LinearScene
from exudyn_rotor.linear.periodic.periodic_system import (
    PeriodicSystem,
    Terms,
    UnconvergedError,
)
from exudyn_rotor.theory.rotating_axes import turning_harmonics

_STEPS = 3  # of Newton's method: ε², ε⁴, ε⁸
MOST_MOTION = 1e-2  # of the clearance: what it leaves out is of the order of its square


@dataclass(frozen=True, eq=False)
class RememberingScene(ExtendedModel):
    """A scene with films that conserve mass; see :class:`LinearModel`.

    Attributes
    ----------
    plain : LinearScene, or one with a finer rotor
        Its coordinates come first.
    scene : LinearScene
    with_states : bool
        Whether voids are coordinates; without, films have the stiffness of unbalance.
    """

    is_full: ClassVar[bool] = False
    mesh: ClassVar[None] = None
    base_loads: ClassVar[None] = None
    free_motions: ClassVar[tuple[str, ...]] = ()
    radius: ClassVar[float] = 1.0
    stiffness_varies: ClassVar[None] = None
    standing_interfaces: ClassVar[tuple[str, ...]] = ()

    plain: LinearModel
    scene: LinearScene
    with_states: bool = True

    @classmethod
    def of(cls, scene: LinearScene) -> LinearScene | RememberingScene:
        """Return a scene with what its films remember; itself where none does."""
        return cls(scene, scene) if scene.remembering else scene

    @property
    def _more(self) -> int:
        return COUNT * len(self.scene.remembering) * self.with_states

    @property
    def voids(self) -> np.ndarray:
        """Coordinates of what films remember."""
        return np.arange(self.plain.size, self.size)

    @property
    def stiffening(self) -> str:
        """Level of centrifugal stiffening."""
        return self.scene.stiffening

    @property
    def interfaces(self) -> tuple[str, ...]:
        """Names of the interfaces that have a marker."""
        return self.plain.interfaces

    @property
    def standing(self) -> np.ndarray:
        """Coordinates of everything but the rotor and what turns with it."""
        return self.plain.standing

    @property
    def has_structural_damping(self) -> bool:
        """True where steady motions have structural damping, which other analyses leave out."""
        return self.scene.has_structural_damping

    @property
    def mass_matrix(self) -> np.ndarray:
        """Mean mass matrix, shape (k, k)."""
        return la.block_diag(self.plain.mass_matrix, np.diag(self._masses))

    def interface_motion(self, name: str) -> np.ndarray:
        """Return an interface's motion (6, k): displacement and rotation along (n1, n2, e)."""
        return self._wide(self.plain.interface_motion(name))

    def point_motions(self, most: int) -> PointMotions:
        """Return those of the scene, and points for the pairs of the films' coordinates."""
        given = self.plain.point_motions(most)
        still = None if given.standing is None else self._wide(given.standing)
        wide = replace(given, motion=self._wide(given.motion), standing=still)
        return with_pairs(wide, np.eye(self.size)[self.plain.size :])

    def undamped(self) -> RememberingScene:
        """Return the scene with films' stiffness of unbalance; damping does not matter."""
        return replace(self, with_states=False)

    def at(self, speed: float) -> PeriodicSystem:
        """Return the equations at a spin speed [rad/s], about the equilibrium there.

        Raises
        ------
        UnconvergedError
            As :meth:`LinearScene.at`, and for a journal outside its film.
        """
        system = self.plain.at(speed)
        own = self._films(speed)
        M, D, K = (
            {n: np.pad(X, (0, self._more)) for n, X in terms.items()}
            for terms in (system.M, system.D, system.K)
        )
        add(M, 0, np.diag(np.r_[np.zeros(self.plain.size), self._masses]))
        for terms, X in zip((D, K), own.inertia_terms(speed), strict=True):
            add(terms, 0, np.pad(X, (self.plain.size, 0)))
        damping, stiffness, carried = own.films(speed, self._journals)
        join(D, damping)
        join(K, stiffness)
        join(K, {n: speed * X for n, X in carried.items()})
        H = None if system.H is None else np.pad(system.H, (0, self._more))
        return replace(system, M=M, D=D, K=K, H=H)

    def _films(self, speed: float) -> OwnCoordinates:
        """Return the films, each about a journal at rest."""
        supports = []
        for one, journal in zip(self.scene.remembering, self.scene.journals(speed), strict=True):
            state = at_rest(one.support, journal, speed)
            K, D = state.coefficients()
            both = state.void_states.matrices(self._mass) if self.with_states else (D, K)
            inertia = np.full(COUNT // 2 * self.with_states, self._mass)
            supports.append(
                FilmSupport(one.support.interface, inertia, lambda _, both=both: both, K)
            )
        return OwnCoordinates(tuple(supports), (1.0,) * len(supports))

    @property
    def _mass(self) -> float:
        return LITTLE * self.scene.mass / len(self.scene.remembering)

    @property
    def _masses(self) -> np.ndarray:
        return np.full(self._more, self._mass)

    @cached_property
    def _journals(self) -> list[Terms]:
        """Displacements (3, k) of journals against what carries the bearings, rotor frame."""
        found = []
        for one in self.scene.remembering:
            motion = {0: self._wide(self.plain.journal_motion(one.support.interface))}
            if one.base is not None:
                base = self.scene.base_motion(one)
                base = np.pad(base, ((0, 0), (0, self.size - base.shape[1])))
                for n, R in turning_harmonics(3).items():
                    motion[-n] = motion.get(-n, 0.0) - R @ base
            found.append(motion)
        return found


def at_rest(bearing: JournalBearing, journal: Journal, speed: float) -> FilmState:
    """Return the film of a journal that rests where it has the mean force of a revolution.

    By Newton's method from its mean place, which is off by the order of ε².

    Raises
    ------
    UnconvergedError
        Outside the film, and for a journal that moves.
    """
    where = f"linear scene at {speed:g} rad/s: the journal at {bearing.interface!r}"
    if any(place is None for place in journal):
        raise UnconvergedError(
            f"{where} is outside its film, which its grid does not resolve there; give more nodes"
        )
    places, forces = (np.array(each) for each in zip(*journal, strict=True))
    mean = places.mean(axis=0)
    moved = np.linalg.norm(places - mean, axis=1).max() / bearing.film.clearance
    if moved > MOST_MOTION:
        raise UnconvergedError(
            f"{where} moves by {moved:.2g} of its clearance in a revolution, and a film with "
            f"cavitation='mass-conserving' is linearised about a journal at rest, up to "
            f"{MOST_MOTION:g}; leave the unbalance out (linear_model(…, about='equilibrium')), or "
            "look at a run"
        )
    state = bearing.film.state(mean, np.zeros(2), speed)
    for _ in range(_STEPS):
        step = np.linalg.lstsq(state.slow_stiffness, state.force - forces.mean(axis=0))[0]
        state = bearing.film.state(state.position + step, np.zeros(2), speed)
    return state
