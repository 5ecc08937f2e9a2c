"""Bodies and what stands between them and the ground, together, in one kind of axes.

An element, as of a support, a link, gears or pads, has stiffness and damping of a motion u of its
own, ``f = −K u − D u̇``, in axes that stand still or turn with a rotor. How u follows from the
coordinates of the bodies, ``u = U(θ) y``, is all that depends on the axes of the model.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np
import scipy.linalg as la
from numpy.typing import ArrayLike

from exudyn_rotor.bearings.controlled_support import ControlledSupport
from exudyn_rotor.bearings.given import Controlled, linear_supports
from exudyn_rotor.bearings.series import SeriesSupport
from exudyn_rotor.bearings.support import NoCoefficientsError, Support, acts
from exudyn_rotor.calls import kept
from exudyn_rotor.drives.gear_mesh import GearMesh
from exudyn_rotor.linear.equations import (
    PeriodicSystem,
    Terms,
    UnconvergedError,
    add,
    congruent,
    difference,
    products,
    rate_of,
    stacked,
    turned,
    without_rounding,
)
from exudyn_rotor.linear.model.body import Body, RotorBody
from exudyn_rotor.linear.model.rotor_train import Link
from exudyn_rotor.linear.model.turning import ACROSS
from exudyn_rotor.theory.rotating_axes import axial_skew

NO_EQUATIONS = NoCoefficientsError, UnconvergedError
_SMALL = 1e-13  # share of a matrix that is rounding
_ROUNDING = 1e-12  # share of a matrix by which it may differ after a turn and be isotropic
End = tuple[str, str]  # names of a body and of its interface
Seen = Callable[[End], Terms]  # what a support acts on, seen from outside
# coefficients 'M', 'D' and 'K' by multiples of θ and powers of Ω: Σ X[name, n, p] Ωᵖ exp(inθ)
Powers = dict[tuple[str, int, int], np.ndarray]


@dataclass(frozen=True, eq=False)
class Element:
    """A law between bodies.

    Attributes
    ----------
    ends : tuple of (str, str)
        Bodies and their interfaces.
    matrices : callable
        Takes the speed Ω, and the frequency of the motion, that of Ω without it [rad/s]; gives
        stiffness, damping and, where one goes with u in axes that stand, the mass, each (p, p), p a
        multiple of 3. Of speeds (s,) it gives stacks.
    motion : callable
        Takes a function that gives the motion (6, k) of an end, gives u as Fourier terms (p, k).
    turns : float
        Speed of its axes over Ω.
    varies, stiffness_varies : bool
        Whether anything, or a stiffness, depends on the speed.
    law : Support, ControlledSupport or None
        What it was made from.
    rate : float
        Speed of the tables of a Support over Ω.
    """

    ends: tuple[End, ...]
    matrices: Callable[..., tuple[np.ndarray, np.ndarray]]
    motion: Callable[[Seen], Terms]
    turns: float = 0.0
    varies: bool = False
    stiffness_varies: bool = False
    law: Support | ControlledSupport | None = None
    rate: float = 0.0

    @property
    def what(self) -> str:
        """The element, for messages."""
        return " – ".join(filter(None, (":".join(filter(None, end)) for end in self.ends)))

    @property
    def table_speeds(self) -> np.ndarray:
        """Ω at the points of its tables [rad/s], where coefficients have kinks."""
        has_tables = self.rate and isinstance(self.law, Support)
        return self.law.table_speeds / self.rate if has_tables else np.zeros(0)

    @property
    def table_frequencies(self) -> np.ndarray:
        """Frequencies of its tables [rad/s]; none where it does not depend on the frequency."""
        return self.law.table_frequencies if isinstance(self.law, Support) else np.zeros(0)

    def at_rest(self) -> np.ndarray:
        """Return a stiffness that tells which motions it holds, (p, p).

        Of a film it is the stiffness at a speed at which it carries.
        """
        return self.law.matrices(0.0)[0] if isinstance(self.law, Support) else self.matrices(0.0)[0]

    def is_isotropic(self, speed: float) -> bool:
        """Return whether stiffness and damping at a speed are the same in all directions."""
        return all(is_isotropic_matrix(X) for X in self.matrices(speed)[:2])

    def powers(self, coefficients: Sequence[np.ndarray], U: Terms, turns: int) -> Powers:
        """Return what it adds to the equations in axes that turn with `turns` times Ω.

        `coefficients` are those of :attr:`matrices`, (p, p), or stacks of them, (s, p, p); `U` is
        :attr:`motion` in these axes.
        """
        K, D, *masses = coefficients
        found: Powers = {}
        if self.turns and self.turns == turns:  # seen from axes that turn with it, it stands still
            U = turned(U, -turns)
        elif self.turns:
            put(found, "K", 1, congruent(U, -self.turns * D @ axial_skew(D.shape[-1])))
        put(found, "D", 0, congruent(U, D))
        put(found, "K", 0, congruent(U, K))
        first = rate_of(U)
        if first and np.any(D):
            put(found, "K", 1, products(U, D, first))
        for mass in masses:  # ü = d²(U y)/dt²; in axes that turn it is alike in all directions
            put(found, "M", 0, {0: congruent(U, mass)[0]})
            if first:
                put(found, "D", 1, products(U, 2.0 * mass, first))
                put(found, "K", 2, products(U, mass, rate_of(first)))
        return found

    @property
    def stands(self) -> str:
        """Why it needs axes that stand still; empty where it takes any."""
        if self.table_frequencies.size:
            return "coefficients over the frequency"
        has_mass = isinstance(self.law, Support) and acts(self.law.mass)
        if has_mass and not is_isotropic_matrix(self.law.mass_matrix(0.0)):
            return "a mass that is not the same in all directions"
        return ""

    def check_axes(self, turns: int) -> None:
        """Refuse what needs other axes, and an anisotropic element that turns otherwise."""
        if turns and self.stands:
            other = ", or give support.at_frequency(…)" if self.table_frequencies.size else ""
            raise ValueError(
                f"supports: {self.what} has {self.stands}, which needs a rotor that is round, and "
                f"axes that stand still; leave axes='rotor' out{other}"
            )
        if self.turns and self.turns != turns and not self.is_isotropic(0.0):
            raise ValueError(
                f"supports: {self.what} is not the same in all directions and turns with "
                f"{self.turns:g} times the speed of the analysis; give a RotorTrain relative_to "
                "its rotor, or leave axes='inertial' out"
            )


def put(powers: Powers, name: str, power: int, terms: Terms) -> None:
    """Add the Fourier terms of a matrix, times a power of Ω."""
    for n, X in terms.items():
        key, part = (name, n, power), X.real if n == 0 else X
        powers[key] = powers[key] + part if key in powers else part


def is_isotropic_matrix(X: np.ndarray) -> bool:
    quarter = axial_skew(len(X))
    return bool(np.abs(X @ quarter - quarter @ X).max() <= _ROUNDING * np.abs(X).max())


@dataclass(frozen=True, eq=False)
class OwnBody(Body):
    """Coordinates that a support brings with it, as a body: of a controller, of pads.

    Attributes
    ----------
    shown : ndarray, shape (p, k)
        What elements see of them, in the axes of the body.
    integrating : ndarray, shape (k,)
        1/ω [s] of the coordinates of a controller that are integrals, of which ``q̇/ω`` is a
        displacement as other coordinates are; 0 for these.
    """

    shown: np.ndarray = field(kw_only=True)
    integrating: np.ndarray = field(kw_only=True)

    def supported(self, _: str) -> dict[int, np.ndarray]:
        """Return what elements see, from outside, (p, k)."""
        return turned({0: self.shown}, self.turns)


def own_body(one: Controlled, number: int, turns: int) -> OwnBody:
    """Return the coordinates of a support; pairs in axes that turn with `turns` times Ω."""
    word, name = f"{one.word} {number} at {one.interface}", f" {number}"
    labels = tuple(f"{word}, {n}" for n in range(1, one.size + 1))
    M, none = np.diag(one.masses), np.zeros((one.size, one.size))
    integrating = np.zeros(one.size)
    if one.word == "pads":
        given = {"shown": np.eye(one.size), "integrating": integrating}
        return OwnBody(name, 0, M, (none,), (none,), labels, **given)
    if one.word == "controller":
        K, D = (np.diag(X)[-one.size :] for X in one.matrices(0.0))
        integrating = np.where(K == 0.0, one.masses / D, 0.0)
    pairs = np.kron(np.eye(one.size // 2), ACROSS)  # displacements along (n1, n2, e)
    quarter = pairs.T @ axial_skew(len(pairs)) @ pairs
    powers_D, powers_K = (none, 2.0 * turns * M @ quarter), (none, none, -float(turns) * M)
    given = {"shown": pairs, "integrating": integrating}
    return OwnBody(name, turns, M, powers_D, powers_K, labels, **given)


def _relative(end: End, base: End | None, rows: int = 6) -> Callable[[Seen], Terms]:
    """Return what gives the first rows of the motion of an end against its base."""

    def motion(seen: Seen) -> Terms:
        found = seen(end) if base is None else difference(seen(end), seen(base))
        return {n: U[:rows] for n, U in found.items()}

    return motion


def support_element(
    support: Support, end: End, base: End | None, rate: float, ratio: float
) -> Element:
    """Return a support between an end and its base, the ground by default.

    Its tables are over `rate` times Ω; one in the rotor's frame turns with `ratio` times Ω.
    """

    def matrices(speed: ArrayLike, frequency: ArrayLike | None = None) -> tuple[np.ndarray, ...]:
        for each in np.ravel(rate * speed).tolist():
            support.check_range(each)
        at = rate * speed, abs(speed) if frequency is None else frequency
        mass = (support.mass_matrix(*at),) if acts(support.mass) else ()
        return *support.matrices(*at), *mass

    return Element(
        (end,) if base is None else (end, base),
        matrices,
        _relative(end, base),
        ratio if support.frame == "rotor" else 0.0,
        support.varies,
        support.stiffness_varies,
        support,
        rate,
    )


def own_elements(
    one: Controlled, end: End, base: Callable[[str], End | None], rate: float, own: OwnBody
) -> list[Element]:
    """Return the elements of a support with coordinates of its own, on the `base` of a place."""
    if isinstance(one, SeriesSupport):
        return _series_elements(one, end, base(one.interface), rate, own)
    ends, ports = (end,), [_relative(end, base(one.interface), 3)]
    if one.sensor is not None:
        ends = end, (end[0], one.sensor)
        ports.append(_relative(ends[1], base(one.sensor), 3))
    lifted = la.block_diag(np.kron(np.eye(len(ports)), ACROSS), own.shown)

    def matrices(speed: ArrayLike, *_: ArrayLike) -> tuple[np.ndarray, ...]:
        if np.ndim(speed):
            [found] = stacked_coefficients([[matrices(each)] for each in speed.tolist()])
            return found
        K, D = one.matrices(rate * speed)
        return lifted @ K @ lifted.T, lifted @ D @ lifted.T

    def motion(seen: Seen) -> Terms:
        return stacked([*(port(seen) for port in ports), seen((own.name, ""))])

    if one.sensor is not None:
        return [Element(ends, matrices, motion, law=one)]
    return [Element(ends, matrices, motion, varies=True, stiffness_varies=True)]


def _series_elements(
    one: SeriesSupport, end: End, base: End | None, rate: float, own: OwnBody
) -> list[Element]:
    """Return what acts between a rotor and a ring, and between the ring and its base."""

    def ring(seen: Seen) -> Terms:
        return {n: np.vstack([U, 0.0 * U]) for n, U in seen((own.name, "")).items()}

    inner = support_element(one.inner, end, None, rate, rate)
    outer = support_element(one.outer, end, base, rate, rate)
    return [
        replace(inner, motion=lambda seen: difference(seen(end), ring(seen))),
        replace(outer, motion=ring if base is None else lambda s: difference(ring(s), s(base))),
    ]


def _gear_element(gears: GearMesh, ends: tuple[End, End]) -> Element:
    return Element(ends, lambda *_: gears.matrices(), lambda seen: stacked([*map(seen, ends)]))


def elements_of(
    supports: Mapping[str, Sequence],
    ratios: Mapping[str, float],
    links: Sequence[Link],
    base: Callable[[int, str], End | None],
    turns: int,
    kind: str = "full",
) -> tuple[list[Element], list[OwnBody]]:
    """Return the elements of a model, and the coordinates that some of them bring.

    What carries a support tells `base` by the support's number and an interface. Pairs of own
    coordinates turn with `turns` times Ω. Of the kind 'static' elements have their static stiffness
    in the place of own coordinates; 'undamped' ones are also without damping and the skew part of
    their stiffness, and keep rings.
    """
    elements, own = [], []
    for name, given in supports.items():
        ratio = ratios[name]
        for number, each in enumerate(given):
            [one] = [law for laws in linear_supports([each]) for law in laws]
            end = name, one.interface
            is_ring = isinstance(one, SeriesSupport) and kind == "undamped"
            if kind != "full" and not isinstance(one, Support) and not is_ring:
                one = Support(one.interface, one.static_stiffness)
            if kind == "undamped":
                one = one.undamped()
            if isinstance(one, Support):
                below = base(number, one.interface)
                elements.append(support_element(one, end, below, ratio, ratio))
            else:
                own.append(own_body(one, len(own) + 1, turns))
                elements += own_elements(one, end, partial(base, number), ratio, own[-1])
    for link in links:
        first, second = link.ends
        if isinstance(link.connection, GearMesh):
            elements.append(_gear_element(link.connection, link.ends))
            continue
        law = link.connection.undamped() if kind == "undamped" else link.connection
        rate = ratios[first[0]] - ratios[second[0]]
        elements.append(support_element(law, first, second, rate, ratios[first[0]]))
    return elements, own


@dataclass(frozen=True, eq=False)
class Assembly:
    """Bodies and the elements between them.

    Attributes
    ----------
    bodies : sequence of Body
        Their coordinates stand one after the other.
    elements : sequence of Element
    turns : int
        Whether the axes of the rotors turn with Ω, or stand still.
    """

    bodies: tuple[Body, ...]
    elements: tuple[Element, ...]
    turns: int

    @cached_property
    def slices(self) -> list[slice]:
        """Where the coordinates of each body stand."""
        ends = np.cumsum([body.size for body in self.bodies]).tolist()
        return [slice(end - b.size, end) for b, end in zip(self.bodies, ends, strict=True)]

    @property
    def size(self) -> int:
        """Number of coordinates k."""
        return sum(body.size for body in self.bodies)

    @property
    def M(self) -> np.ndarray:
        """Mass matrix of what does not vary, shape (k, k)."""
        return self._steady["M", 0, 0]

    @property
    def K(self) -> np.ndarray:
        """Stiffness at rest of what does not vary, shape (k, k)."""
        return self._steady["K", 0, 0]

    def body(self, name: str) -> Body:
        """Return the body of a name."""
        return next(body for body in self.bodies if body.name == name)

    def square(self, X: np.ndarray, place: slice) -> np.ndarray:
        """Return a matrix of one body as a matrix of all coordinates."""
        wide = np.zeros((self.size, self.size), dtype=X.dtype)
        wide[place, place] = X
        return wide

    def wide(self, terms: Terms, place: slice) -> dict[int, np.ndarray]:
        """Return rows of one body as rows of all coordinates."""
        wide = {}
        for n, X in terms.items():
            wide[n] = np.zeros((*X.shape[:-1], self.size), dtype=X.dtype)
            wide[n][..., place] = X
        return wide

    def _acted_on(self, end: End) -> dict[int, np.ndarray]:
        """Return the motion that an element acts on, seen from outside."""
        name, interface = end
        body = self.body(name)
        return self.wide(body.supported(interface), self.slices[self.bodies.index(body)])

    @cached_property
    def motions(self) -> list[Terms]:
        """Motion of each element, by multiples of θ."""
        return [without_rounding(one.motion(self._acted_on)) for one in self.elements]

    @cached_property
    def _steady(self) -> Powers:
        """What does not vary otherwise than by powers of Ω; without rounding."""
        found: Powers = {}
        for body, place in zip(self.bodies, self.slices, strict=True):
            for name, given in (("M", [body.M]), ("D", body.D), ("K", body.K)):
                for power, X in enumerate(given):
                    if power == 0 or np.any(X):
                        put(found, name, power, {0: self.square(X, place)})
        for element, U in zip(self.elements, self.motions, strict=True):
            if not element.varies:
                given = element.powers(element.matrices(0.0), U, self.turns)
                for (name, n, power), X in given.items():
                    put(found, name, power, {n: X})
        largest = {name: np.abs(found[name, 0, 0]).max(initial=0.0) for name in "MDK"}
        return {
            key: X
            for key, X in found.items()
            if key[1] == 0 or np.abs(X).max() > _SMALL * largest[key[0]]
        }

    def system(
        self,
        speed: float | np.ndarray,
        frequency: float | np.ndarray | None = None,
        more: Powers | None = None,
    ) -> PeriodicSystem:
        """Return the equations at a spin speed, and a frequency of motions [rad/s]; stacks of (s,).

        With `more` forces that hold at this speed.
        """
        found = {"M": {}, "D": {}, "K": {}}
        parts, factor = [self._steady, more or {}], speed
        if np.ndim(speed):
            factor = speed[:, None, None]
        for one, U in zip(self.elements, self.motions, strict=True):
            if one.varies:
                parts.append(one.powers(one.matrices(speed, frequency), U, self.turns))
        for (name, n, power), X in (item for part in parts for item in part.items()):
            add(found[name], {n: X}, factor**power if power else None)
        if np.ndim(speed):
            for name in "DK":
                shape = len(speed), self.size, self.size
                found[name] = {n: np.broadcast_to(X, shape) for n, X in found[name].items()}
        D, K = without_rounding(found["D"]), without_rounding(found["K"])
        return PeriodicSystem(speed, found["M"][0], D, K, self._H)

    def at_points(self, speeds: np.ndarray, coefficients: Sequence) -> PeriodicSystem:
        """Return the equations at points, stacked, each with coefficients of its elements.

        `coefficients` are :attr:`Element.matrices` of each, as stacks over the points.
        """
        given = zip(self.elements, coefficients, strict=True)
        varying = (replace(one, varies=True, matrices=lambda *_, X=X: X) for one, X in given)
        return replace(self, elements=tuple(varying)).system(speeds)

    @cached_property
    def _H(self) -> list[tuple[float, np.ndarray]]:
        """Structural damping of all bodies, see :class:`PeriodicSystem`."""
        return [
            (n, self.square(X, place))
            for body, place in zip(self.bodies, self.slices, strict=True)
            for n, X in body.H
        ]

    @kept
    def seen(self, body: Body, interface: str) -> dict[int, np.ndarray]:
        """Return the motion (6, k) of an interface, seen from outside, for loads and results."""
        return self.wide(body.seen(interface), self.slices[self.bodies.index(body)])

    def labels(self) -> tuple[str, ...]:
        """Return the names of all coordinates."""
        several = sum(isinstance(body, RotorBody) for body in self.bodies) > 1
        return tuple(
            f"{body.name}: {label}" if several and isinstance(body, RotorBody) else label
            for body in self.bodies
            for label in body.labels
        )


def stacked_coefficients(found: Sequence[Sequence]) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return stiffness and damping of elements, known at points, as stacks over the points."""
    return [tuple(map(np.stack, zip(*each, strict=True))) for each in zip(*found, strict=True)]


def rotors_of(bodies: Sequence[Body]) -> list[RotorBody]:
    """Return the rotors among bodies."""
    return [body for body in bodies if isinstance(body, RotorBody)]
