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

import warnings
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import Bearing, Law, Linearised
from exudyn_rotor.bearings.controlled_support import PadSupport
from exudyn_rotor.bearings.film.equilibria import Equilibria
from exudyn_rotor.bearings.film.film import OilFilm
from exudyn_rotor.bearings.film.pads import direction
from exudyn_rotor.bearings.film.state import FilmState
from exudyn_rotor.bearings.journal_bearing import JournalBearing
from exudyn_rotor.bearings.pad_tilt import shift_of_pad, stiffness_unit
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.calls import user_level

_STEPS, _SHORTER, _VAIN = 60, 8, 12  # of Newton's method, halvings of one, steps in vain
_TOGETHER, _NARROWER = 15, 0.6  # steps of journal and tilts together, what of a film one may close
_LOOSE, _FIRM = 1e-6, 1e5  # of μ Ω L (R/c)³: no stiffness; condition of one that holds all ways
_HELD = 1e-6  # of its stiffness: what goes where no pad holds the journal
_CLOSE, _STILL = 1e-9, 1e-11  # of the load and of the clearance: it stops there


@dataclass(frozen=True, eq=False, kw_only=True)
class TiltingPadBearing(Bearing):
    """Journal bearing whose pads tilt about pivots.

    With `pad_inertia` the pads' tilts are coordinates, in scenes and in linear analyses. Without it
    linear analyses have stiffness and damping at the whirl's frequency, the tilts eliminated, and
    scenes, in which a tilt has a history, take :meth:`linearised`, about the middle of the bearing.

    Parameters
    ----------
    interface : str
        Interface of the rotor that is the journal.
    film : OilFilm
        With the pads as they are without tilt, the directions n1 and n2 of the rotor at rest.
    pivot : float, optional
        Place of the pivots over the arc of a pad, from its start; 0.5 is the middle.
    whirl_ratio : float, optional
        Frequency of the whirl over the spin speed, 1 for unbalance: of pads without inertia, and in
        critical speeds.
    pad_inertia : float, optional
        Of each pad about its pivot, along the axis [kg m²]. Light pads follow the journal at once:
        the smaller it is, the less it matters.
    load : array_like, shape (2,), optional
        Static load on the journal along (n1, n2) [N], which linear analyses need.

    Raises
    ------
    TypeError, ValueError
        For bad input, and films without a gap between pads, or that conserve mass.

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
    whirl_ratio: float = 1.0
    pad_inertia: float | None = None
    _equilibria: Equilibria[_Pads] = field(default_factory=Equilibria, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.instance(self.film, "film", OilFilm)
        checks.keep_numbers(self, {"pivot": "", "whirl_ratio": ""}, above=0.0)
        checks.number(self.pivot, "pivot", below=1.0)
        if self.pad_inertia is not None:
            checks.keep_numbers(self, {"pad_inertia": "kg m²"}, above=0.0)
        if self.film.pads[0].closed or self.film.cavitation == "mass-conserving":
            raise ValueError(
                f"film: bearing at {self.interface!r}: needs pads with gaps between them, and "
                "another cavitation than 'mass-conserving'"
            )

    def check_coordinates(self) -> None:
        """Refuse a scene pads without inertia, whose tilts are no coordinates.

        Raises
        ------
        ValueError
        """
        if self.pad_inertia is None:
            _ = self.law

    @property
    def _law(self) -> Law:
        raise ValueError(
            f"bearing at {self.interface!r}: tilting pads have no force by place and velocity "
            "alone; give pad_inertia, and their tilts become coordinates, or give the scene its "
            "linearised()"
        )

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

    def equilibrium(self, speed: float, load: ArrayLike | None = None) -> np.ndarray:
        """Return where the journal rests under a static load [m], shape (2,).

        Parameters
        ----------
        speed : float
            Spin speed [rad/s], not 0.
        load : array_like, shape (2,), optional
            On the journal [N]; that of the bearing by default.

        Raises
        ------
        TypeError, ValueError
            For bad input, a missing load, no speed, and a load that presses a film below what the
            grid resolves.
        ArithmeticError
            If no equilibrium is found.
        """
        return self._state(speed, load).place.copy()

    def tilts(self, speed: float, load: ArrayLike | None = None) -> np.ndarray:
        """Return the pads' tilts in equilibrium [rad], from n1 to n2; NaN for absent pads.

        Parameters and errors are those of :meth:`equilibrium`.
        """
        return -self._state(speed, load).shifts / self.film.radius

    def coefficients(
        self, speed: float, load: ArrayLike | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return stiffness [N/m] and damping [N s/m] of (2) about the equilibrium, each (2, 2).

        Parameters and errors are those of :meth:`equilibrium`.
        """
        whirl = self.whirl_ratio * abs(checks.number(speed, "speed", "rad/s"))
        Z = self._state(speed, load).impedance(whirl)
        return Z.real, Z.imag / whirl

    def film_coefficients(
        self, speed: float, load: ArrayLike | None = None
    ) -> list[tuple[np.ndarray, np.ndarray] | None]:
        """Return stiffness and damping of each pad's film, (2, 2); None for absent pads.

        Parameters and errors are those of :meth:`equilibrium`.
        """
        return self._state(speed, load).coefficients

    def linearised(self) -> Support | PadSupport:
        """Return the support for linear analyses: the coefficients under the load at every speed.

        With the pads' tilts as coordinates where these have inertia. A pad that carries nothing is
        absent but for a millionth of the bearing's stiffness, which holds its tilt.

        Raises
        ------
        ValueError
            Where the bearing has no load.

        Warns
        -----
        UserWarning
            Of pads with inertia, by the analysis, at the first speed at which one carries nothing.
        """
        if self.pad_inertia is None:
            return super().linearised()
        self._static_load(None)
        count = len(self.film.pads)
        films = [
            Support(self.interface, *(_OfPads(self, index, pad) for index in (0, 1)))
            for pad in range(count)
        ]
        masses = np.full(count, self.pad_mass)
        static = _OfPads(self, 0)
        return PadSupport(self.interface, masses, self.tangents, tuple(films), static)

    def _of_pads(self, speed: float, load: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return stiffness and damping of each pad's film (p, 2, 2), and stiffness of all."""
        state, mass = self._state(speed, load), self.pad_mass
        whole = state.impedance(self.whirl_ratio * abs(speed), mass).real
        absent = [pad for pad, each in enumerate(state.states) if each is None]
        if absent and not self.__dict__.get("_told"):
            object.__setattr__(self, "_told", True)
            warnings.warn(
                f"bearing at {self.interface!r}: pads {absent} carry nothing at {speed:g} rad/s: "
                "they count as absent, their tilts as held by next to nothing",
                stacklevel=user_level(),
            )
        soft = min(mass * speed**2, _HELD * float(np.abs(whole).max()))
        held = np.array([soft, 4.0 * np.sqrt(soft * mass)])  # overdamped: no vibration of its own
        films = [
            np.multiply.outer(held, np.outer(t, t)) if each is None else each
            for each, t in zip(state.coefficients, self.tangents, strict=True)
        ]
        return *np.moveaxis(np.array(films), 1, 0), whole

    def _state(self, speed: float, load: ArrayLike | None) -> _Pads:
        """Return the pads in equilibrium."""
        return self._equilibria.at(speed, self._static_load(load), self._solved)

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
        pads, far = _Pads.of(self, speed), 0.2 * self.film.clearance
        state, best, vain = pads.at(1.5 * far * load / size), np.inf, 0
        found = state.together(speed, load)
        if found is not None:
            return found
        for _ in range(_STEPS):
            left = state.force + load
            if np.linalg.norm(left) < _CLOSE * size:
                return state
            vain = 0 if np.linalg.norm(left) < best else vain + 1
            best = min(best, np.linalg.norm(left))
            if vain == _VAIN:
                break
            stiffness = state.impedance(0.0).real
            held = stiffness + _HELD * max(np.trace(stiffness), size / far) * np.eye(2)
            move = np.linalg.solve(held, left)
            state = state.after(move * min(1.0, far / np.linalg.norm(move)), load)
        raise ArithmeticError(
            f"bearing at {self.interface!r}: no equilibrium of the pads found under {size:g} N at "
            f"{speed:g} rad/s: {np.linalg.norm(left) / size:.1e} of the load is left"
        )


@dataclass(frozen=True, eq=False)
class _Pads:
    """Pads at one place of the journal, each tilted so that it obeys (1)."""

    films: list[OilFilm]
    tangents: np.ndarray
    speed: float
    place: np.ndarray
    shifts: np.ndarray
    states: list[FilmState | None]

    @classmethod
    def of(cls, bearing: TiltingPadBearing, speed: float) -> _Pads:
        """Return pads with films of their own, before they are at a place."""
        films = [each.film for each in bearing.pad_bearings]
        none = np.full(len(films), np.nan)
        return cls(films, bearing.tangents, speed, np.zeros(2), none, [])

    def at(self, place: np.ndarray) -> _Pads:
        """Return the pads with the journal at a place [m]."""
        pairs = list(zip(self.films, self.tangents, strict=True))
        shifts = np.array(
            [
                shift_of_pad(film, place, t, self.speed, last)
                for (film, t), last in zip(pairs, self.shifts, strict=True)
            ]
        )
        still = np.zeros(2)
        states = [
            None if np.isnan(s) else film.state(place - s * t, still, self.speed)
            for (film, t), s in zip(pairs, shifts, strict=True)
        ]
        return replace(self, place=place, shifts=shifts, states=states)

    def after(self, move: np.ndarray, load: np.ndarray) -> _Pads:
        """Return the pads after a move, shortened until it does not overshoot.

        A pad's force goes through its pivot, and with the tilt of (1) depends on the place along
        that line alone. So force and load are the slope of a potential, with one minimum where
        each pad carries the more the closer the journal is.
        """
        ahead, found = (self.force + load) @ move, None
        for _ in range(_SHORTER):
            try:
                found = self.at(self.place + move)
                if (found.force + load) @ move > -0.5 * ahead:
                    return found
            except ValueError as error:
                refused = error
            move, ahead = 0.5 * move, 0.5 * ahead
        if found is None:
            raise refused
        return found

    def together(self, speed: float, load: np.ndarray) -> _Pads | None:
        """Return the equilibrium at a speed, by Newton's method for journal and tilts at once.

        None where it does not end, a film vanishes or is too thin, and where absent pads carry.
        """
        place, shifts, states, still = self.place, self.shifts, list(self.states), np.zeros(2)
        films, present = self.films, [pad for pad, state in enumerate(states) if state is not None]
        units = [stiffness_unit(film, speed) for film in films]
        small = _STILL * min(film.clearance for film in films)
        for _ in range(_TOGETHER):
            left, total, moved = load.copy(), np.zeros((2, 2)), np.full((len(states), 3), np.nan)
            for pad in present:
                film, t, empty = films[pad], self.tangents[pad], states[pad].solution.empty
                states[pad] = film.law(place - shifts[pad] * t, still, speed, empty)
                force, stiffness = states[pad].force, states[pad].tangent[0]
                rise, lever = t @ stiffness @ t, stiffness @ t
                if not rise > _LOOSE * units[pad]:
                    return None
                moved[pad] = *(t @ stiffness / rise), t @ force / rise
                left += force - lever * moved[pad, 2]
                total += stiffness - np.outer(lever, moved[pad, :2])
            if not np.linalg.cond(total) < _FIRM:
                return None
            move = np.linalg.solve(total, left)
            tilting = moved[:, :2] @ move - moved[:, 2]
            if np.nanmax(np.abs([*move, *tilting])) < small:
                break
            seen = move - tilting[:, None] * self.tangents
            share = min(1.0, _NARROWER / max(states[pad].closing(seen[pad]) for pad in present))
            place, shifts = place + share * move, shifts + share * tilting
        else:
            return None
        for film, t, state in zip(films, self.tangents, states, strict=True):
            thin = state is not None and state.solution.equation.heights.min() < film.thinnest
            if thin or (
                state is None and not np.isnan(shift_of_pad(film, place, t, speed, np.nan))
            ):
                return None
        return replace(self, speed=speed, place=place, shifts=shifts, states=states)

    @property
    def force(self) -> np.ndarray:
        """Force on the journal [N], shape (2,)."""
        return sum((state.force for state in self.states if state is not None), start=np.zeros(2))

    @cached_property
    def coefficients(self) -> list[tuple[np.ndarray, np.ndarray] | None]:
        """Stiffness and damping of each film, (2, 2); None for absent pads."""
        return [None if state is None else state.coefficients() for state in self.states]

    def impedance(self, whirl: float, mass: float = 0.0) -> np.ndarray:
        """Return Z_b of (2) at a frequency [rad/s], shape (2, 2); of pads with a mass I/R² [kg].

        By (1) the mass takes ``mass whirl²`` from ``tᵀZ t``.
        """
        total = np.zeros((2, 2), dtype=complex)
        for coefficients, t in zip(self.coefficients, self.tangents, strict=True):
            if coefficients is not None:
                K, C = coefficients
                Z = K + 1j * whirl * C
                total += Z - np.outer(Z @ t, t @ Z) / (t @ Z @ t - mass * whirl**2)
        return total


@dataclass(frozen=True, eq=False)
class _OfPads(Linearised):
    """Stiffness (`index` 0) or damping of one pad's film; of all in the whirl without `pad`."""

    pad: int | None = None

    def _value(self, speed: float) -> np.ndarray:
        bearing = self.bearing
        *films, whole = bearing._linear.at(speed, bearing._static_load(None), bearing._of_pads)
        return whole if self.pad is None else films[self.index][self.pad]
