"""What is attached to a rotor in a scene, in its linear equations: laws by their tangents.

Linear equations have a prescribed spin, and leave out moments of a static force F₀ by small motions
u: that it turns with what carries the bearing, and that friction on this changes, by about F₀ u.
A part of them would be no better than none. So a law has its torque at a place, and none beside it.
Without the rotor's own unbalance there is none at all, as in lists: by it and the drive, which act
at different places, an eccentric rotor would whirl.

Where a mesh is uneven a journal moves a little under the rotor's weight, twice in a revolution.
Without the rotor's own unbalance films are then taken about rest under their mean force: the motion
of ε clearances would change exponents by the order of ε². Off its centre the film of a damper would
change them whatever ε: it carries on the side to which the journal moves. There it has the force of
small harmonic motions, as in lists. Rolling bearings have the mean stiffness of lists then.
"""

from __future__ import annotations

from math import hypot

import exudyn
import numpy as np

from exudyn_rotor.bearings.actuator import SaturatingActuator
from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.bearings.journal_bearing import FilmLaw, JournalBearing, tangent_of
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.bearings.rolling import RollingBearing, contacts
from exudyn_rotor.bearings.short_film import ShortFilmBearing
from exudyn_rotor.bearings.squeeze_film import SqueezeFilmDamper
from exudyn_rotor.bearings.tilting_pad import TiltingPadBearing
from exudyn_rotor.multibody.supports.connector import (
    BearingConnector,
    Connector,
    Force,
    MagneticConnector,
)
from exudyn_rotor.multibody.supports.ends import FoundationEnd

_STILL = 1e-7  # of the clearance: a motion that does not matter
ROUNDED = 1e-14  # m: of differences of positions of some metres
Tangent = tuple[np.ndarray, np.ndarray]
Seen = list[tuple[np.ndarray, np.ndarray] | None]


class Attached:
    """A law that is attached to the rotor, at any state of a scene.

    Attributes
    ----------
    connector : Connector
    places : ndarray of int
        Its coordinates among those of the scene.
    """

    def __init__(self, mbs: exudyn.MainSystem, connector: Connector) -> None:
        self.connector = connector
        read = mbs.systemData.GetNodeLTGODE2
        self.places = np.concatenate([read(node) for node in connector.nodes]).astype(int)

    def read(self, q: np.ndarray, q_t: np.ndarray) -> None:
        """Take the state of the scene."""
        self.connector.read(q[self.places].tolist(), q_t[self.places].tolist())

    def force(self, t: float) -> Force:
        """Return the law's forces on its ports where it has been read, and its tangent."""
        return self.connector.tangent(t)

    def forget(self) -> None:
        """Forget where it has been seen."""

    def rest(self, rests: bool) -> None:
        """Let the law be as in lists, without torque, or its own."""

    @property
    def settles(self) -> bool:
        """Whether lists take it otherwise than where it has been seen, see :meth:`settle`."""
        return False


class AttachedMagnets(Attached):
    """A magnetic bearing. Lists take its actuators at one state, the mean of those seen.

    Under an uneven mesh a journal moves a little; what that changes is beside the square of the
    motion over the gap.
    """

    connector: MagneticConnector

    def __init__(self, mbs: exudyn.MainSystem, connector: MagneticConnector) -> None:
        super().__init__(mbs, connector)
        self._slopes = None
        self.forget()

    def force(self, t: float) -> Force:
        """Return the forces, with the slopes of the actuators here, or settled ones."""
        states = self.connector.axes_states
        self._seen.append(states)
        slopes = self._slopes or [self.connector.bearing.actuator.slopes(*one) for one in states]
        return self.connector.assembled(slopes)

    def forget(self) -> None:
        """Forget where it has been seen."""
        self._seen: list = []

    @property
    def settles(self) -> bool:
        """Whether lists take it otherwise than where it has been seen."""
        return isinstance(self.connector.bearing.actuator, SaturatingActuator)

    def settle(self, speed: float) -> None:
        """Take the slopes at the mean of the states seen."""
        actuator = self.connector.bearing.actuator
        means = np.mean(self._seen, axis=0).tolist()
        self._slopes = [actuator.slopes(*state) for state in means]

    def release(self) -> None:
        """Take back what :meth:`settle` did."""
        self._slopes = None


class AttachedBearing(Attached):
    """A bearing, or the films of its pads.

    Attributes
    ----------
    bearing : Bearing
    seen : list of list
        Of each film, place (2,) [m] and force (2,) [N] where it has been asked; None outside.
    stiff : bool
        Whether films that conserve mass have the tangent of slow motions, or none.
    """

    connector: BearingConnector

    def __init__(
        self, mbs: exudyn.MainSystem, connector: BearingConnector, cage: float | None
    ) -> None:
        super().__init__(mbs, connector)
        self.bearing, self.stiff, self._rests = connector.bearing, True, False
        self._cage, self._tangents = cage, None
        parts = connector.parts
        self._films = [FilmLaw(one.film, True) if _is_film(one) else None for one in parts]
        # what turns with a body that hardly does is left out
        base = connector.base
        self._feels = connector.feels and not isinstance(base, FoundationEnd) and base.is_rotor
        self.forget()

    def forget(self) -> None:
        """Forget where it has been seen."""
        self.seen: list[Seen] = [[] for _ in self.connector.parts]

    def rest(self, rests: bool) -> None:
        """Let films be without torque, dampers with the force of small motions; or their own."""
        self._rests = rests

    def force(self, t: float) -> Force:
        """Return the forces, and the tangents of the films here, or settled ones."""
        made = self.connector
        felt, made.feels = made.feels, self._feels
        try:
            points = [self._point(i, *motion) for i, motion in enumerate(made.motions())]
            return made.assembled(points)
        finally:
            made.feels = felt

    def _point(self, i: int, *motion: float) -> tuple:
        part, film = self.connector.parts[i], self._films[i]
        if part.uses_angle and self._cage is not None:
            motion = *motion[:4], self._cage, motion[5]
        torque, inside = (0.0,), True
        if film is not None:
            values, tangent, inside = self._of_film(film, *motion)
            torque = values[2:]
        elif self._rests and isinstance(part, SqueezeFilmDamper):
            values = part.law_of_small_motions(*motion)
            tangent = part.slopes(*motion[:2], 0.0, 0.0, *motion[4:])
        else:
            values = (part.law_with_torque or part.law)(*motion)
            tangent, torque = part.slopes(*motion), values[2:] or torque
            if isinstance(part, RollingBearing):
                # those that touch by what rounding leaves of the place would change as it turns
                K = contacts(part, np.array(motion[:2]), motion[4], ROUNDED)[2]
                tangent = K, tangent[1]
        if self._tangents is not None and self._tangents[i] is not None:
            tangent = self._tangents[i]
        if film is not None and part.remembers and not self.stiff:
            tangent = np.zeros((2, 2, 2))
        seen = (np.array(motion[:2]), np.array(values[:2])) if inside else None
        self.seen[i].append(seen)
        if self.connector.brakes:
            return (*values[:2], *(torque if not self._rests else (0.0,))), *tangent, np.zeros(3)
        return values[:2], *tangent, None

    @staticmethod
    def _of_film(film: FilmLaw, *motion: float) -> tuple[tuple[float, ...], Tangent, bool]:
        """Return values, tangent, and whether the film is resolved there."""
        place, rate, speed = np.array(motion[:2]), np.array(motion[2:4]), motion[5]
        if not hypot(*place) <= film.to_the_edge(*place.tolist()):
            return film(*motion), film.slopes(*motion), False
        state = film.state_at(place, rate, speed)
        return (*state.force.tolist(), -state.torque), tangent_of(state), True

    # ------------------------------------------------------------------ as in lists

    @property
    def settles(self) -> bool:
        """Whether lists take it otherwise than where it has been seen, see :meth:`settle`."""
        if isinstance(self.bearing, RollingBearing):
            return bool(self.bearing.clearance < 0.0 or np.any(self._forces))
        if isinstance(self.bearing, SqueezeFilmDamper) and self.bearing.orbit > 0.0:
            return True
        if not isinstance(self.bearing, ShortFilmBearing | JournalBearing | TiltingPadBearing):
            return False
        if any(point is None for one in self.seen for point in one):
            return False
        clearances = [one.clearance_along() for one in self.connector.parts]
        pairs = zip(map(moved, self.seen), clearances, strict=True)
        return any(most > _STILL * clearance for most, clearance in pairs)

    def settle(self, speed: float) -> None:
        """Let the force go on as in lists.

        Films by rest under the mean of the forces seen; that of a damper by its orbit, or by rest
        at the mean place, as another spring may carry the weight. Rolling bearings by the mean over
        the passage of an element.

        Raises
        ------
        ValueError, ArithmeticError
            Where there is no equilibrium.
        """
        load = -np.sum(self._forces, axis=0)
        if isinstance(self.bearing, SqueezeFilmDamper):
            place = np.mean([place for place, _ in self.seen[0]], axis=0)
            self._tangents = [self.bearing.coefficients_at(place, speed)]
        elif isinstance(self.bearing, TiltingPadBearing):
            self._tangents = self.bearing.film_coefficients(speed, load)
        else:
            self._tangents = [self.bearing.coefficients(speed, load)]

    @property
    def _forces(self) -> np.ndarray:
        """Mean of the forces seen of every film, shape (l, 2) [N]."""
        return np.array([np.mean([force for _, force in one], axis=0) for one in self.seen])

    def release(self) -> None:
        """Take back what :meth:`settle` did."""
        self._tangents = None


def moved(seen: Seen) -> float:
    """Return the largest distance from the mean of places seen inside a film [m]."""
    places = np.array([place for place, _ in filter(None, seen)]).reshape(-1, 2)
    apart = places - np.sum(places, axis=0) / max(len(places), 1)
    return float(np.linalg.norm(apart, axis=1).max(initial=0.0))


def attached_to(
    mbs: exudyn.MainSystem, supports: list, drives: list, cage: float | None
) -> list[Attached]:
    """Return the laws of a rotor's supports and drives; cages stand as at a spin angle [rad].

    Without an angle cages turn with the rotor.
    """
    found = []
    for one in supports:
        if isinstance(one.support, MagneticBearing):
            found.append(AttachedMagnets(mbs, one.connector))
        elif isinstance(one.support, Bearing):
            found.append(AttachedBearing(mbs, one.connector, cage))
        else:
            found.append(Attached(mbs, one.connector))
    made = [one.connector for one in drives if getattr(one, "connector", None) is not None]
    return found + [Attached(mbs, connector) for connector in made]


def _is_film(part: Bearing) -> bool:
    return isinstance(part, JournalBearing)
