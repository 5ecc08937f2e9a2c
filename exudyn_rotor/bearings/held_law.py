"""Laws of bearings in the linear equations of a scene, as lists of supports have them.

Linear equations have a prescribed spin, and leave out moments of a static force F₀ by small motions
u: that it turns with what carries the bearing, and that friction on this changes, by about F₀ u.
A part of them would be no better than none. So a law is held at a place: it has its torque there,
and none beside it, where that would tilt with the journal. Without the rotor's own unbalance there
is none at all, as in lists: by it and the drive, which act at different places, an eccentric rotor
would whirl.

Where a mesh is uneven a journal moves a little under the rotor's weight, twice in a revolution.
Without the rotor's own unbalance films are then taken about rest under their mean force: the motion
of ε clearances would change exponents by the order of ε². Off its centre the film of a damper would
change them whatever ε: it carries on the side to which the journal moves. There it has the force of
small harmonic motions, as in lists. Rolling bearings have the mean stiffness of lists then.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot

import numpy as np

from exudyn_rotor.bearings.bearing import Bearing, Law, LawWithTorque
from exudyn_rotor.bearings.film.state import FilmState
from exudyn_rotor.bearings.journal_bearing import FilmLaw, JournalBearing
from exudyn_rotor.bearings.rolling import RollingBearing, contacts
from exudyn_rotor.bearings.short_film import ShortFilmBearing, Tangent
from exudyn_rotor.bearings.squeeze_film import SqueezeFilmDamper
from exudyn_rotor.bearings.tilting_pad import TiltingPadBearing

_REST = 1e-6  # of c Ω: the velocity of a journal at rest
_STILL = 1e-7  # of the clearance: a motion that does not matter
_ROUNDED = 1e-14  # m: of differences of positions of some metres


class MovingJournalError(ValueError):
    """A journal moves in a film whose force depends on its past."""


class HeldLaw:
    """Law of a bearing that, once held, has a torque at the next place alone.

    Attributes
    ----------
    bearing : Bearing
    tangent : tuple of ndarray or None
        Stiffness and damping (2, 2) by which the force, once held, goes on; by default by the law.
    seen : list of tuple or None
        Place (2,) [m] and force (2,) [N] wherever it has been held; None outside a film.
    """

    def __init__(self, bearing: Bearing) -> None:
        self.bearing, self.clearance_along = bearing, bearing.clearance_along
        self.uses_angle = bearing.uses_angle
        self.tangent: Tangent | None = None
        self.seen: list[tuple[np.ndarray, np.ndarray] | None] = []
        self._whole = self._law_of(bearing)
        self._held = self._rests = False
        self._point: tuple[list[float], Sequence[float], list[list[float]] | None] | None = None

    @staticmethod
    def _law_of(bearing: Bearing) -> Law | LawWithTorque:
        return bearing.law_with_torque or bearing.law

    @property
    def moved(self) -> float:
        """Largest distance from the mean of places seen inside films [m]."""
        places = np.array([place for place, _ in filter(None, self.seen)]).reshape(-1, 2)
        apart = places - np.sum(places, axis=0) / max(len(places), 1)
        return float(np.linalg.norm(apart, axis=1).max(initial=0.0))

    def hold(self, held: bool) -> None:
        """Let the law be held at the next place, or not any more."""
        self._held, self._point = held, None

    def rest(self, rests: bool) -> None:
        """Let the law be without torque as in lists, or the bearing's own."""
        self._rests = rests

    def law(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, float]:
        """Return the force as :attr:`Bearing.law`."""
        return self._values(x, y, vx, vy, angle, speed)[:2]

    @property
    def law_with_torque(self) -> LawWithTorque | None:
        """As :attr:`Bearing.law_with_torque`."""
        return None if self.bearing.law_with_torque is None else self._values

    def _values(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, ...]:
        """Return force and, where the bearing has one, torque."""
        begins = self._held and self._point is None
        if begins:
            self._begin(np.array([x, y, vx, vy]), angle, speed)
        values = self._values_beside(x, y, vx, vy, angle, speed)
        brakes = begins or self._point is None
        return values if brakes and not self._rests else (*values[:2], 0.0)

    def _values_beside(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, ...]:
        """Return the values beside the place where the law is held, if it is."""
        if self._point is None:
            return self._free(x, y, vx, vy, angle, speed)
        (x0, y0, vx0, vy0), (fx, fy, *torque), gradient = self._point
        if gradient is None:
            fx, fy = self._whole(x, y, vx, vy, angle, speed)[:2]
        else:
            x, y, vx, vy = x - x0, y - y0, vx - vx0, vy - vy0
            (a, b, c, d), (e, f, g, h) = gradient
            fx -= a * x + b * y + c * vx + d * vy
            fy -= e * x + f * y + g * vx + h * vy
        return fx, fy, *torque

    def _free(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, ...]:
        """Return the values where nothing is held."""
        return self._whole(x, y, vx, vy, angle, speed)

    def _begin(self, motion: np.ndarray, angle: float, speed: float) -> None:
        """Hold the law at a place and velocity (4,)."""
        tangent = self.tangent or self._tangent_at(motion, angle, speed)
        gradient = None if tangent is None else np.hstack(tangent)
        self._hold_at(motion, self._whole(*motion.tolist(), angle, speed), gradient)

    def _tangent_at(self, motion: np.ndarray, angle: float, speed: float) -> Tangent | None:
        """Return the tangent at a place and velocity (4,); None where the law itself goes on."""
        return None

    def _hold_at(
        self, motion: np.ndarray, values: Sequence[float], gradient: np.ndarray | None
    ) -> None:
        by_motion = None if gradient is None else gradient.tolist()
        self._point = motion.tolist(), values, by_motion
        self.seen.append((motion[:2], np.array(values[:2])))


class TangentShortFilm(HeldLaw):
    """Law of a bearing with a short film that, once held, goes on by its tangent.

    Where the film begins to push it has no second derivative: differences would have a little of
    both sides.

    Attributes
    ----------
    bearing, tangent, seen
        See :class:`HeldLaw`.
    """

    bearing: ShortFilmBearing

    def _tangent_at(self, motion: np.ndarray, angle: float, speed: float) -> Tangent | None:
        return self.bearing._law_tangent(motion, speed)


class TangentDamper(TangentShortFilm):
    """Law of a squeeze-film damper that, once held, goes on by its tangent.

    Attributes
    ----------
    bearing, tangent, seen
        See :class:`HeldLaw`.
    """

    bearing: SqueezeFilmDamper

    def rest(self, rests: bool) -> None:
        """As :meth:`HeldLaw.rest`, and with the force of small harmonic motions, or the film's."""
        super().rest(rests)
        damper = self.bearing
        self._whole = damper._law_of_small_motions if rests else self._law_of(damper)

    def _tangent_at(self, motion: np.ndarray, angle: float, speed: float) -> Tangent | None:
        held = np.r_[motion[:2], 0.0, 0.0] if self._rests else motion
        return super()._tangent_at(held, angle, speed)


class TangentFilm(HeldLaw):
    """Law of a journal bearing of finite length that, once held, goes on by its tangent.

    The tangent is :func:`tangent_of` by default: differences would cross the places at which the
    film's edge moves to the next node.

    Attributes
    ----------
    bearing, tangent, seen
        See :class:`HeldLaw`.
    stiff : bool
        Whether the force changes by the tangent; without, it stays that of the place.
    """

    bearing: JournalBearing

    def __init__(self, bearing: JournalBearing) -> None:
        super().__init__(bearing)
        self.stiff = True

    @staticmethod
    def _law_of(bearing: JournalBearing) -> FilmLaw:
        return FilmLaw(bearing.film, torque=True)

    @property
    def law_with_torque(self) -> LawWithTorque:
        """As :attr:`Bearing.law_with_torque`, of films that conserve mass, too."""
        return self._values

    def _begin(self, motion: np.ndarray, angle: float, speed: float) -> None:
        """Take the tangent at a place and velocity (4,), if the film is resolved there."""
        self._held = hypot(*motion[:2]) <= self._whole._to_the_edge(*motion[:2].tolist())
        if not self._held:
            self.seen.append(None)
            return
        state = self.bearing.film.law(motion[:2], motion[2:], speed)
        gradient = np.hstack(self.tangent or tangent_of(state))
        values = *state.force.tolist(), -state.torque
        self._hold_at(motion, values, gradient if self.stiff else 0.0 * gradient)

    def _free(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, ...]:
        """Return the values where nothing is held; refuse the motion of a film with a memory."""
        clearance = self.bearing.film.clearance
        if self.bearing.remembers and hypot(vx, vy) > _REST * clearance * abs(speed):
            raise MovingJournalError(
                f"bearing at {self.bearing.interface!r}: a film with cavitation="
                "'mass-conserving' has no force by place and velocity alone, so that a moving "
                "journal is found by a run only; leave the unbalance out (linear_model(…, "
                "about='equilibrium')), or begin a run with the steady_state of the same scene "
                "with cavitation='reynolds'"
            )
        return super()._free(x, y, vx, vy, angle, speed)


class TangentContacts(HeldLaw):
    """Law of a rolling bearing that, once held, goes on by the stiffness of its contacts there.

    Within a step of differences elements begin to carry, some in one direction and others in the
    next: those that no load presses would have a stiffness that changes as the rotor turns. So
    would elements without clearance that touch by what rounding leaves of the journal's place.
    """

    bearing: RollingBearing

    def _tangent_at(self, motion: np.ndarray, angle: float, speed: float) -> Tangent:
        stiffness = contacts(self.bearing, motion[:2], angle, _ROUNDED)[2]
        return stiffness, self.bearing.damping * np.eye(2)


def tangent_of(state: FilmState) -> Tangent:
    """Return stiffness and damping (2, 2) of the tangent at a place of the journal.

    Of films that conserve mass those of slow motion: the derivatives of the force that scenes have
    where they look for an equilibrium.
    """
    if state.film.cavitation == "mass-conserving":
        return state.slow_stiffness, state.slow_damping
    return state.coefficients()


@dataclass(frozen=True, eq=False)
class HeldBearing:
    """A bearing in the linear equations of a scene: the law of its film, or of every pad's.

    Attributes
    ----------
    bearing : Bearing
    laws : tuple of HeldLaw
    """

    bearing: Bearing
    laws: tuple[HeldLaw, ...]

    @classmethod
    def of(cls, bearing: Bearing) -> HeldBearing:
        """Return the laws of a bearing."""
        pads = isinstance(bearing, TiltingPadBearing)
        parts = bearing.pad_bearings if pads else [bearing]
        return cls(bearing, tuple(_held_law(one) for one in parts))

    @property
    def settles(self) -> bool:
        """Whether lists take it otherwise than where it has been seen, see :meth:`settle`."""
        if isinstance(self.bearing, RollingBearing):
            return bool(self.bearing.clearance < 0.0 or np.any(self._forces))
        if isinstance(self.bearing, SqueezeFilmDamper) and self.bearing.orbit > 0.0:
            return True
        if not isinstance(self.bearing, ShortFilmBearing | JournalBearing | TiltingPadBearing):
            return False
        if any(point is None for one in self.laws for point in one.seen):
            return False
        return any(one.moved > _STILL * one.clearance_along() for one in self.laws)

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
            place = np.mean([place for place, _ in self.laws[0].seen], axis=0)
            tangents = [self.bearing._coefficients_at(place, speed)]
        elif isinstance(self.bearing, TiltingPadBearing):
            tangents = self.bearing.film_coefficients(speed, load)
        else:
            tangents = [self.bearing.coefficients(speed, load)]
        for law, tangent in zip(self.laws, tangents, strict=True):
            law.tangent = tangent

    @property
    def _forces(self) -> np.ndarray:
        """Mean of the forces seen of every law, shape (l, 2) [N]."""
        return np.array([np.mean([force for _, force in one.seen], axis=0) for one in self.laws])

    def release(self) -> None:
        """Take back what :meth:`settle` did."""
        for law in self.laws:
            law.tangent = None


def _held_law(bearing: Bearing) -> HeldLaw:
    if isinstance(bearing, JournalBearing):
        return TangentFilm(bearing)
    if isinstance(bearing, SqueezeFilmDamper):
        return TangentDamper(bearing)
    if isinstance(bearing, ShortFilmBearing):
        return TangentShortFilm(bearing)
    return TangentContacts(bearing) if isinstance(bearing, RollingBearing) else HeldLaw(bearing)
