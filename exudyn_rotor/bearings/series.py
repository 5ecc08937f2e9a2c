"""Bearings in series: between the rotor and a ring, and on from the ring; floating rings.

The ring, of the mass m, moves across the axis by r; with the forces of both, by what each sees,

    m r̈ = −F_inner(x − r) + F_outer(r − b),    F_rotor = F_inner(x − r).                  (1)

A floating ring turns, too. Films between surfaces that turn with Ω and Ω_r carry as with one that
turns with Ω + Ω_r. Its speed follows from the torques of both films on it, by (1) of
:mod:`exudyn_rotor.bearings.short_journal`, as without load in M. C. Shaw, T. J. Nussdorfer, *An
analysis of the full-floating journal bearing*, NACA Report 866 (1947).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import ClassVar, NamedTuple

import numpy as np
from scipy.optimize import brentq

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import HIGHER, Bearing, Linearised, NoEquilibriumError
from exudyn_rotor.bearings.short_journal import ShortJournalBearing
from exudyn_rotor.bearings.support import Support

_EDGE = 1e-9  # of the speed: how near to still, and to the journal's speed, a ring is looked for


@dataclass(frozen=True, eq=False, kw_only=True)
class SeriesSupport:
    """A bearing between the rotor and a ring of its own, and one on from the ring.

    As a rolling bearing in a squeeze film: the ring is the outer one. Linear analyses take the
    ring's two displacements as coordinates.

    Parameters
    ----------
    interface : str
        Interface of the rotor.
    inner : Support or bearing
        Between the rotor and the ring, across the axis.
    mass : float
        Of the ring [kg], above zero.
    outer : Support or bearing
        Between the ring and the ground, or the foundation with a point of the interface's name. Its
        tables over the speed are those of the rotor.

    Raises
    ------
    TypeError, ValueError
        For bad input, parts at another interface, that turn with the rotor, that act along the axis
        or on tilts, and bearings with states of their own.

    Examples
    --------
    A stiff bearing of 2e8 N/m whose outer ring of 0.5 kg stands in a squeeze film:

    >>> from exudyn_rotor import SeriesSupport, SqueezeFilmDamper, Support
    >>> damper = SqueezeFilmDamper(
    ...     interface="left", radius=0.05, length=0.02, clearance=1e-4, viscosity=0.01,
    ...     centring_stiffness=5e6,
    ... )
    >>> bearing = SeriesSupport(
    ...     interface="left", inner=Support("left", 2e8), mass=0.5, outer=damper
    ... )
    >>> print(round(bearing.static_stiffness(0.0)[0, 0]))
    4878049
    """

    word: ClassVar[str] = "ring"  # for labels

    interface: str
    inner: Support | Bearing
    mass: float
    outer: Support | Bearing

    def __post_init__(self) -> None:
        checks.label(self.interface, "interface")
        checks.keep_numbers(self, {"mass": "kg"}, above=0.0)
        for name in ("inner", "outer"):
            part = checks.instance(getattr(self, name), name, (Support, Bearing))
            _check_part(part, name, self.interface)

    @property
    def size(self) -> int:
        """Number of own coordinates: the ring's displacements."""
        return 2

    @property
    def masses(self) -> np.ndarray:
        """Mass of the ring in both directions, shape (2,) [kg]."""
        return np.full(2, self.mass)

    def linearised(self) -> SeriesSupport:
        """Return it with the coefficients of its bearings, for linear analyses.

        Raises
        ------
        ValueError
            For a bearing without the load that it needs, or with states of its own.
        """
        parts = {}
        for name in ("inner", "outer"):
            one = getattr(self, name)
            parts[name] = one if isinstance(one, Support) else one.linearised()
            if not isinstance(parts[name], Support):
                raise ValueError(
                    f"{name}: the bearing at {self.interface!r} has states of its own, which a "
                    "SeriesSupport does not take; give its table(…), or a Support"
                )
        return replace(self, **parts)

    def undamped(self) -> SeriesSupport:
        """Return it without damping and the skew parts of stiffness."""
        made = self.linearised()
        return replace(made, inner=made.inner.undamped(), outer=made.outer.undamped())

    def static_stiffness(self, speed: float) -> np.ndarray:
        """Return the stiffness of both in series, (2, 2) [N/m], at a spin speed [rad/s].

        Raises
        ------
        ValueError
            Where both together hold nothing.
        """
        speed, made = checks.number(speed, "speed", "rad/s"), self.linearised()
        inner, outer = (one.matrices(speed, 0.0)[0][:2, :2] for one in (made.inner, made.outer))
        return inner @ np.linalg.pinv(inner + outer) @ outer


def _check_part(part: Support | Bearing, name: str, interface: str) -> None:
    if part.interface != interface:
        raise ValueError(f"{name}: needs one at {interface!r}, got one at {part.interface!r}")
    if not isinstance(part, Support):
        return
    if part.frame == "rotor":
        raise ValueError(f"{name}: needs a support that stands still, got frame='rotor'")
    along = any(np.any(X[2:]) or np.any(X[:, 2:]) for X in part.matrices(0.0))
    if part.tilts or along:
        raise ValueError(
            f"{name}: acts across the axis alone in a SeriesSupport; give what acts along the axis "
            "or on tilts as another Support"
        )


class RingState(NamedTuple):
    """Equilibrium of a floating ring: its speed [rad/s], and eccentricity ratios of the films."""

    speed: float
    inner_ratio: float
    outer_ratio: float


@dataclass(frozen=True, eq=False, kw_only=True)
class FloatingRingBearing:
    """Two short films and a ring between them that turns by their friction, as in turbochargers.

    Linear analyses take films and mass of the ring about the equilibrium, its speed kept: small
    motions change it to second order only about the centre, elsewhere its inertia keeps it.

    Parameters
    ----------
    interface : str
        Interface of the rotor that is the journal.
    inner, outer : ShortJournalBearing
        Films between journal and ring, and between ring and bore; of their loads none counts.
    mass : float
        Of the ring [kg].
    load : array_like, shape (2,), optional
        Static load on the journal along (n1, n2) [N]; none by default.

    Raises
    ------
    TypeError, ValueError

    Examples
    --------
    The same oil and length, the outer film twice as thick:

    >>> from exudyn_rotor import FloatingRingBearing, ShortJournalBearing
    >>> film = {"interface": "left", "length": 0.008, "viscosity": 0.01}
    >>> bearing = FloatingRingBearing(
    ...     interface="left",
    ...     inner=ShortJournalBearing(radius=0.005, clearance=2e-5, **film),
    ...     outer=ShortJournalBearing(radius=0.008, clearance=4e-5, **film),
    ...     mass=0.01,
    ... )
    >>> round(bearing.ring(speed=5000.0).speed / 5000.0, 4)
    0.3281
    """

    carries: ClassVar[bool] = True
    _tried: ClassVar[np.ndarray] = HIGHER

    interface: str
    inner: ShortJournalBearing
    outer: ShortJournalBearing
    mass: float
    load: np.ndarray | None = None

    def __post_init__(self) -> None:
        checks.label(self.interface, "interface")
        checks.keep_numbers(self, {"mass": "kg"}, above=0.0)
        for name in ("inner", "outer"):
            checks.instance(getattr(self, name), name, ShortJournalBearing)
        load = np.zeros(2) if self.load is None else checks.vector(self.load, "load", "N", size=2)
        checks.keep(self, load=checks.read_only(load))

    def ring(self, speed: float) -> RingState:
        """Return the equilibrium of the ring under the load at a spin speed [rad/s].

        Raises
        ------
        TypeError, ValueError
            For bad input, and a speed at which a film does not carry the load.
        """
        return _ring(self, checks.number(speed, "speed", "rad/s"))

    def films(self, speed: float) -> list[tuple[ShortJournalBearing, float]]:
        """Return the films about the equilibrium, each with the speed by which it carries [rad/s].

        Errors are those of :meth:`ring`.
        """
        ring = self.ring(speed).speed
        return [(self.inner, speed + ring), (self.outer, ring)]

    def _torque(self, speed: float, ring_speed: float) -> float:
        """Return the torque of both films on the ring [N m], from n1 to n2."""
        carried, slips = (speed + ring_speed, ring_speed), (speed - ring_speed, -ring_speed)
        total = 0.0
        for film, whirl, slip in zip((self.inner, self.outer), carried, slips, strict=True):
            e = film.equilibrium(whirl, self.load) if np.any(self.load) else np.zeros(2)
            ratio = np.hypot(*e) / film.clearance
            # of the pressure, with the load on the journal, and on the ring as journal of the outer
            moment = 0.5 * (e[0] * self.load[1] - e[1] * self.load[0])
            total += film._shear * slip / np.sqrt(1.0 - ratio**2) + moment
        return float(total)

    def linearised(self) -> SeriesSupport:
        """Return both films about the equilibrium, and the ring, for linear analyses."""
        inner, outer = (
            Support(self.interface, _OfFilm(self, 0, outer), _OfFilm(self, 1, outer))
            for outer in (False, True)
        )
        return SeriesSupport(interface=self.interface, inner=inner, mass=self.mass, outer=outer)


@lru_cache(maxsize=256)
def _ring(bearing: FloatingRingBearing, speed: float) -> RingState:
    """Return the equilibrium; one speed is asked for by both films."""
    if speed == 0.0:
        if np.any(bearing.load):
            raise NoEquilibriumError(
                f"bearing at {bearing.interface!r}: at 0 rad/s its films carry nothing"
            )
        return RingState(0.0, 0.0, 0.0)

    def left(share: float) -> float:
        return bearing._torque(speed, share * speed) * np.sign(speed)

    low, high, first = _EDGE, 1.0 - _EDGE, None
    while first is None and low < high:
        try:
            first = left(low)
        except ValueError:  # a ring that hardly turns does not carry in its outer film
            low *= 2.0
    if first is None or first <= 0.0:
        raise NoEquilibriumError(
            f"bearing at {bearing.interface!r}: no speed of the ring at which its films carry the "
            "load and their torques balance"
        )
    share = brentq(left, low, high, xtol=1e-14, rtol=1e-13)
    ratio_in, ratio_out = (
        film.eccentricity_ratio(whirl * speed, bearing.load)
        for film, whirl in ((bearing.inner, 1.0 + share), (bearing.outer, share))
    )
    return RingState(share * speed, ratio_in, ratio_out)


@dataclass(frozen=True, eq=False)
class _OfFilm(Linearised):
    """Stiffness or damping of a film of a floating ring, by the spin speed."""

    outer: bool = False

    def _value(self, speed: float) -> np.ndarray:
        film, whirl = self.bearing.films(speed)[self.outer]
        return film.coefficients(whirl, self.bearing.load)[self.index]
