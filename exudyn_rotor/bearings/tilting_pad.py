"""Journal bearing with tilting pads: equilibrium of journal and pads, coefficients of the whirl.

A pad that tilts by δ about its pivot at the angle φ_p of the bore moves its centre of curvature
along the bore, by ``s t`` with ``t = (−sin φ_p, cos φ_p)`` and s = −R δ. Its film, that of a fixed
pad, sees the journal at ``q − s t``. Its pivot has neither friction nor flexibility; with the
inertia I about it,

    I/R² s̈ = −t · F(q − s t, q̇ − ṡ t),                                                    (1)

and where a pad rests, or has no inertia, the force of its film passes through the pivot. In small
whirl of pads without inertia, of the frequency ν and with the films' Z = K + i ν C, the bearing has

    Z_b = Σ Z − Z t tᵀZ/(tᵀZ t),   K_b = Re Z_b,   C_b = Im Z_b/ν.                        (2)

J. W. Lund, *Spring and damping coefficients for the tilting-pad journal bearing*, ASLE Trans. 7
(1964). A pad that no tilt brings to carry counts as absent.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import Bearing, Equilibria, Force, Linearised, Pair
from exudyn_rotor.bearings.controlled_support import ControlledSupport, impedance
from exudyn_rotor.bearings.film.film import FilmState, OilFilm
from exudyn_rotor.bearings.film.pads import direction
from exudyn_rotor.bearings.journal_bearing import JournalBearing
from exudyn_rotor.bearings.support import Support

_STARTS = (0.3, 0.6, 0.1, 0.8, 0.01, 1e-3)  # places at which a search begins, over the clearance
_STEPS, _NARROWER = 30, 0.6  # of Newton's method, what of a film one step may close
_LOOSE, _FIRM = 1e-9, 1e-5  # of the largest stiffness: none of a pad; none of all
_HELD = 1e-6  # of its stiffness: what holds the tilt of a pad that carries nothing
_STILL, _CLOSE = 1e-11, 1e-6  # of the clearance: it stops there; of the load: what may be left
_TILTS = 26  # tried, between those at which an edge is as thin as the grid resolves
_SMALL, _ROOT = 1e-9, 1e-13  # of the largest moment: none; of the radius: error of s


@dataclass(frozen=True, eq=False, kw_only=True)
class TiltingPadBearing(Bearing):
    """Journal bearing whose pads tilt about pivots.

    With `pad_inertia` the pads' tilts are coordinates, in scenes and in linear analyses. Without it
    linear analyses have stiffness and damping of whirl at the spin speed, as by unbalance, the
    tilts eliminated. Free motions and harmonic forces of other frequencies get them as well, with
    dampings that may be wrong by a factor of two: they need `pad_inertia`, of which a small one
    does. Scenes, in which a tilt has a history, take :meth:`linearised`, about the middle.

    Parameters
    ----------
    interface : str
        Interface of the rotor that is the journal.
    film : OilFilm
        With the pads as they are without tilt, the directions n1 and n2 of the rotor at rest.
    pivot : float, optional
        Place of the pivots over the arc of a pad, from its start; 0.5 is the middle.
    pad_inertia : float, optional
        Of each pad about its pivot, along the axis [kg m²]. Light pads follow the journal at once:
        the smaller it is, the less it matters.
    load : array_like, shape (2,), optional
        Static load on the journal along (n1, n2) [N], which linear analyses need.

    Raises
    ------
    TypeError, ValueError
        For bad input, and films without a gap between pads.

    Examples
    --------
    Five pads, the load between two of them:

    >>> import numpy as np
    >>> from exudyn_rotor import OilFilm, TiltingPadBearing, grooved_pads
    >>> gaps = np.radians([54.0, 126.0, 198.0, 270.0, 342.0])
    >>> pads = grooved_pads(1.5e-4, gaps, np.radians(12.0), preload=0.5)
    >>> film = OilFilm(radius=0.05, length=0.05, viscosity=0.02, pads=pads, axial_nodes=0)
    >>> bearing = TiltingPadBearing(interface="left", film=film, load=[0.0, -2000.0])
    >>> stiffness, damping = bearing.coefficients(speed=300.0)
    >>> bool(abs(stiffness[0, 1]) < 1e-6 * stiffness[1, 1])
    True
    """

    _tried: ClassVar[np.ndarray] = np.array([1e3, 1e2, 1e4, 1e5])  # at which most pads carry

    film: OilFilm
    pivot: float = 0.5
    pad_inertia: float | None = None
    _equilibria: Equilibria[_Pads] = field(default_factory=Equilibria, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.instance(self.film, "film", OilFilm)
        checks.keep_numbers(self, {"pivot": ""}, above=0.0, below=1.0)
        if self.pad_inertia is not None:
            checks.keep_numbers(self, {"pad_inertia": "kg m²"}, above=0.0)
        if self.film.pads[0].closed:
            raise ValueError(f"film: bearing at {self.interface!r}: needs pads with gaps between")

    def law(self, x: float, y: float, vx: float, vy: float, angle: float, speed: float) -> Force:
        """Refuse: the force depends on the pads' tilts, too."""
        raise ValueError(
            f"bearing at {self.interface!r}: tilting pads have no force by place and velocity "
            "alone; give pad_inertia, and their tilts become coordinates, or give the scene its "
            "linearised()"
        )

    slopes = law  # which refuses, too

    @property
    def tangents(self) -> np.ndarray:
        """Directions t at the pivots along (n1, n2), shape (pads, 2)."""
        pivots = np.array([pad.start + self.pivot * pad.arc for pad in self.film.pads])
        return direction(pivots + 0.5 * np.pi)

    @property
    def pad_mass(self) -> float:
        """``I/R²`` of (1) [kg], 0 of pads without inertia."""
        return (self.pad_inertia or 0.0) / self.film.radius**2

    @property
    def pad_bearings(self) -> list[JournalBearing]:
        """The film of every pad as a bearing of its own, between the journal and the pad."""
        films = [replace(self.film, pads=[pad]) for pad in self.film.pads]
        return [JournalBearing(interface=self.interface, film=film) for film in films]

    def _rest(self, speed: float, load: np.ndarray) -> np.ndarray:
        """Return where the pads carry the load [m]."""
        return self._state(speed, load).place.copy()

    def tilts(self, speed: float, load: ArrayLike | None = None) -> np.ndarray:
        """Return the pads' tilts in equilibrium [rad], from n1 to n2; NaN for absent pads.

        Parameters and errors are those of :meth:`equilibrium`.
        """
        return -self._state(speed, self._static_load(load)).shifts / self.film.radius

    def _matrices(self, speed: float, load: np.ndarray) -> Pair:
        """Return stiffness and damping of (2), of pads with inertia by (1)."""
        Z = self._state(speed, load).impedance(abs(speed), self.pad_mass)
        return Z.real, Z.imag / abs(speed)

    def linearised(self) -> Support | ControlledSupport:
        """Return the support for linear analyses: the coefficients under the load at every speed.

        With the pads' tilts as coordinates where these have inertia. A pad that carries nothing is
        absent but for a millionth of the bearing's stiffness, which holds its tilt.

        Raises
        ------
        ValueError
            Where the bearing has no load.
        """
        if self.pad_inertia is None:
            return super().linearised()
        self._static_load(None)
        masses = np.full(len(self.film.pads), self.pad_mass)
        return ControlledSupport(self.interface, masses, self._of_pads, Linearised(self, 0))

    def _of_pads(self, speed: float) -> np.ndarray:
        """Return stiffness and damping of the ports of pads with inertia, (2, 2 + p, 2 + p)."""
        Linearised(self, 0).check_range(speed)
        load, mass = self._static_load(None), self.pad_mass
        state, whole = self._state(speed, load), self.coefficients(speed, load)[0]
        soft = min(mass * speed**2, _HELD * float(np.abs(whole).max()))
        held = np.array([soft, 4.0 * np.sqrt(soft * mass)])  # overdamped: no vibration of its own
        return state.ports(held)

    def static_stiffness(self, speed: float, load: ArrayLike | None = None) -> np.ndarray:
        """Return the stiffness against slow changes of a load, shape (2, 2) [N/m].

        Parameters and errors are those of :meth:`equilibrium`.
        """
        return self._state(speed, self._static_load(load)).impedance(0.0).real

    def _state(self, speed: float, load: np.ndarray) -> _Pads:
        """Return the pads in equilibrium."""
        return self._equilibria.at(speed, load, self._solved)

    def _solved(self, speed: float, load: np.ndarray) -> _Pads:
        size = float(np.linalg.norm(load))
        if speed == 0.0 or size == 0.0:
            raise ValueError(
                f"speed, load: bearing at {self.interface!r}: need numbers other than 0, got "
                f"{speed:g} rad/s and {size:g} N"
            )
        beside = self._equilibria.beside(speed, load)
        found = beside and beside.together(speed, load)
        if found is not None:
            return found
        refused: Exception = ArithmeticError(
            f"bearing at {self.interface!r}: no equilibrium of the pads found under {size:g} N at "
            f"{speed:g} rad/s"
        )
        if self._equilibria.is_refused_above(speed, load):
            raise refused
        for ratio in _STARTS:
            try:
                start = _Pads.of(self, speed, ratio * self.film.clearance * load / size)
            except ValueError as error:  # a pad is pressed too thin there
                refused = error
                continue
            found = start.together(speed, load)
            if found is not None:
                return found
        raise refused


def _shift_of_pad(pad: JournalBearing, place: np.ndarray, t: np.ndarray, speed: float) -> float:
    """Return s [m] of a pad whose film has no part along t; NaN where no tilt makes it carry.

    Over all tilts: where the moment about the pivot rises through zero. A ValueError says that the
    film is pressed thinner than its grid resolves.
    """
    film = pad.film
    pressed = ValueError(
        f"load: presses the film of a pad below {film.thinnest:.3g} m, which its grid does not "
        "resolve; give more nodes, or a smaller load"
    )
    u = film.grid.u.reshape(-1, 2)
    room, lever = film.grid.offset.ravel() - u @ place - film.thinnest, u @ t
    low = np.max(-room[lever > 0.0] / lever[lever > 0.0], initial=-np.inf)
    high = np.min(-room[lever < 0.0] / lever[lever < 0.0], initial=np.inf)
    if not low < high:
        raise pressed

    def moment(s: float) -> float:
        return float(t @ pad._film_at(*(place - s * t), 0.0, 0.0, speed).force)

    # beside that of a film whose edges are equally thick, next to which a light pad is
    even = float((place - film.pads[0].center) @ t)
    tried = np.linspace(low, high, _TILTS)
    tried = np.sort(np.append(tried, even)) if low < even < high else tried
    found = np.array([moment(s) for s in tried])
    small = _SMALL * np.abs(found).max()
    rises = np.flatnonzero((found[:-1] < -small) & (found[1:] > small))
    if not len(rises):
        thin_end = found[0] if speed > 0.0 else -found[-1]  # the film narrows most there
        if thin_end > small:
            raise pressed
        return np.nan
    s = brentq(moment, tried[rises[0]], tried[rises[0] + 1], xtol=_ROOT * film.radius)
    stiffness = pad._film_at(*(place - s * t), 0.0, 0.0, speed).coefficients()[0]
    return s if t @ stiffness @ t > 0.0 else np.nan  # where no pressure is left


@dataclass(frozen=True, eq=False)
class _Pads:
    """Pads at one place of the journal, each tilted so that it obeys (1)."""

    pads: list[JournalBearing]
    tangents: np.ndarray
    speed: float
    place: np.ndarray
    shifts: np.ndarray
    states: list[FilmState | None]

    @classmethod
    def of(cls, bearing: TiltingPadBearing, speed: float, place: np.ndarray) -> _Pads:
        """Return pads with films of their own, the journal at a place [m]."""
        pads, tangents = bearing.pad_bearings, bearing.tangents
        pairs = list(zip(pads, tangents, strict=True))
        shifts = [_shift_of_pad(pad, place, t, speed) for pad, t in pairs]
        states = [
            None if np.isnan(s) else pad._film_at(*(place - s * t), 0.0, 0.0, speed)
            for (pad, t), s in zip(pairs, shifts, strict=True)
        ]
        return cls(pads, tangents, speed, place, np.array(shifts), states)

    def together(self, speed: float, load: np.ndarray) -> _Pads | None:
        """Return the equilibrium at a speed, by Newton's method for journal and tilts at once.

        None where it does not end, a film vanishes or is too thin, and where absent pads carry.
        """
        place, shifts, states = self.place, self.shifts, list(self.states)
        present = [pad for pad, state in enumerate(states) if state is not None]
        small = _STILL * min(pad.film.clearance for pad in self.pads)
        for _ in range(_STEPS):
            left, total, moved = load.copy(), np.zeros((2, 2)), np.full((len(states), 3), np.nan)
            for pad in present:
                t = self.tangents[pad]
                states[pad] = self.pads[pad]._film_at(*(place - shifts[pad] * t), 0.0, 0.0, speed)
                force, stiffness = states[pad].force, states[pad].coefficients()[0]
                rise, lever = t @ stiffness @ t, stiffness @ t
                if not rise > _LOOSE * np.abs(stiffness).max():
                    return None
                moved[pad] = *(t @ stiffness / rise), t @ force / rise
                left += force - lever * moved[pad, 2]
                total += stiffness - np.outer(lever, moved[pad, :2])
            move = np.linalg.lstsq(total, left, rcond=_FIRM)[0]  # where two pads hold one way alone
            tilting = moved[:, :2] @ move - moved[:, 2]
            if np.nanmax(np.abs([*move, *tilting])) < small:
                if np.linalg.norm(left) > _CLOSE * np.linalg.norm(load):
                    return None
                break
            seen = move - tilting[:, None] * self.tangents
            share = min(1.0, _NARROWER / max(states[pad].closing(seen[pad]) for pad in present))
            place, shifts = place + share * move, shifts + share * tilting
        else:
            return None
        for pad, t, state in zip(self.pads, self.tangents, states, strict=True):
            thin = state is not None and state.heights.min() < pad.film.thinnest
            if thin or (state is None and not np.isnan(_shift_of_pad(pad, place, t, speed))):
                return None
        return replace(self, speed=speed, place=place, shifts=shifts, states=states)

    def ports(self, held: np.ndarray | None = None) -> np.ndarray:
        """Return stiffness and damping between journal and shifts, (2, 2 + p, 2 + p).

        Of present pads, or of all, the shifts of absent ones `held` by stiffness and damping (2,).
        """
        pairs = zip(self.states, self.tangents, strict=True)
        pads = [(state, t) for state, t in pairs if state is not None or held is not None]
        total = np.zeros((2, 2 + len(pads), 2 + len(pads)))
        for pad, (state, t) in enumerate(pads):
            seen = np.eye(2, 2 + len(pads))
            seen[:, 2 + pad] = -t
            film = (
                np.multiply.outer(held, np.outer(t, t)) if state is None else state.coefficients()
            )
            total += [seen.T @ X @ seen for X in film]
        return total

    def impedance(self, whirl: float, mass: float = 0.0) -> np.ndarray:
        """Return Z_b of (2) at a frequency [rad/s], shape (2, 2); of pads with a mass I/R² [kg]."""
        K, D = self.ports()
        return impedance(K, D, np.full(len(K) - 2, mass), [whirl])[0]
