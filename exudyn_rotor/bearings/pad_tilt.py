"""The tilt at which a pad has no moment about its pivot, with the journal at one place.

A pad that tilts by δ moves by ``s t``, s = −R δ (:mod:`exudyn_rotor.bearings.tilting_pad`); its
moment vanishes where the force of its film has no part along t.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from exudyn_rotor.bearings.film.film import OilFilm
from exudyn_rotor.bearings.film.state import FilmState

_TILTS = 26  # tried, between those at which an edge is as thin as the grid resolves
_SMALL = 1e-9  # of the largest moment, or of a force: none
_BARELY = 1e-3  # of μ Ω L (R/c)³: the stiffness of a film about to vanish
_NEAR, _STILL = 8, 1e-12  # steps from the last tilt, and what of the radius counts as none
_ROOT = 1e-13  # of the radius: error of s


def shift_of_pad(
    film: OilFilm, place: np.ndarray, t: np.ndarray, speed: float, last: float
) -> float:
    """Return s [m] of a pad without a moment about its pivot; NaN where no tilt makes it carry.

    Sought near the `last` one, unless that is NaN, by Newton's method; else, and where this leaves
    the film, over all tilts.

    Parameters
    ----------
    film : OilFilm
        Of this pad alone.
    place : ndarray, shape (2,)
        Of the journal, along (n1, n2) [m].
    t : ndarray, shape (2,)
        Direction along the bore at the pivot.
    speed : float
        Spin speed [rad/s].
    last : float
        s at a place nearby, or NaN [m].

    Raises
    ------
    ValueError
        If the film is pressed thinner than its grid resolves.
    """
    tilting = _TiltingPad(film, place, t, speed)
    near = tilting.near(last)
    return tilting.anywhere() if np.isnan(near) else near


def stiffness_unit(film: OilFilm, speed: float) -> float:
    """Return ``μ Ω L (R/c)³`` [N/m]."""
    return film.viscosity * abs(speed) * film.length * (film.radius / film.clearance) ** 3


class _TiltingPad:
    """A pad at one place of the journal, as it tilts."""

    def __init__(self, film: OilFilm, place: np.ndarray, t: np.ndarray, speed: float) -> None:
        self._film, self._place, self._t, self._speed = film, place, t, speed
        self._empty: np.ndarray | None = None  # cells of the last tilt
        u = film.grid.u.reshape(-1, 2)
        room = film.grid.offset.ravel() - u @ place - film.thinnest
        lever = u @ t
        self._low = np.max(-room[lever > 0.0] / lever[lever > 0.0], initial=-np.inf)
        self._high = np.min(-room[lever < 0.0] / lever[lever < 0.0], initial=np.inf)
        if not self._low < self._high:
            raise self._pressed()

    def near(self, last: float) -> float:
        """Return s by Newton's method from the last one; NaN where it leaves the film."""
        film, t = self._film, self._t
        unit = stiffness_unit(film, self._speed)
        for _ in range(_NEAR):
            if not self._low < last < self._high:  # or NaN
                break
            state = self._at(last)
            rise = t @ state.coefficients()[0] @ t
            carried = np.linalg.norm(state.force)
            if not (rise > _BARELY * unit and carried > _SMALL * unit * film.clearance):
                break
            step = float(t @ state.force / rise)
            last -= step
            if abs(step) < _STILL * film.radius and self._low < last < self._high:
                return last
        return np.nan

    def anywhere(self) -> float:
        """Return s where the moment rises through zero; NaN where the pad carries at no tilt."""
        film, t, low, high = self._film, self._t, self._low, self._high
        # beside that of a film whose edges are equally thick, next to which a light pad is
        even = float((self._place - film.pads[0].center) @ t)
        tried = np.linspace(low, high, _TILTS)
        tried = np.sort(np.append(tried, even)) if low < even < high else tried
        found = np.array([self._moment(s) for s in tried])
        small = _SMALL * np.abs(found).max()
        rises = np.flatnonzero((found[:-1] < -small) & (found[1:] > small))
        if not len(rises):
            thin_end = found[0] if self._speed > 0.0 else -found[-1]  # the film narrows most there
            if thin_end > small:
                raise self._pressed()
            return np.nan
        first = rises[0]
        s = brentq(self._moment, tried[first], tried[first + 1], xtol=_ROOT * film.radius)
        held = self._at(s).coefficients()[0]
        return s if t @ held @ t > 0.0 else np.nan  # where no pressure is left

    def _at(self, s: float) -> FilmState:
        place = self._place - s * self._t
        state = self._film.law(place, np.zeros(2), self._speed, self._empty)
        self._empty = state.solution.empty
        return state

    def _moment(self, s: float) -> float:
        return float(self._t @ self._at(s).force)

    def _pressed(self) -> ValueError:
        return ValueError(
            f"load: presses the film of a pad below {self._film.thinnest:.3g} m, which its grid "
            "does not resolve; give more nodes, or a smaller load"
        )
