"""Bodies and what stands between them and the ground, together, in one kind of axes.

An element, as of a support, a link, gears or pads, has stiffness and damping of a motion u of its
own, ``f = −K u − D u̇``, in axes that stand still or turn with a rotor. How u follows from the
coordinates of the bodies, ``u = U(θ) y``, is all that depends on the axes of the model.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import scipy.linalg as la

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
_CHANGE = 1e-14  # share of a stiffness that is the rounding of its change by the speed
_ROUNDING = 1e-12  # share of a matrix by which it may differ after a turn and be isotropic
End = tuple[str, str]  # names of a body and of its interface
Seen = Callable[[End], Terms]  # what a support acts on, seen from outside
WORDS = "controller", "pads", "ring"  # supports with coordinates of their own, in this order


@dataclass(frozen=True, eq=False)
class Element:
    """A law between bodies.

    Attributes
    ----------
    ends : tuple of (str, str)
        Bodies and their interfaces.
    matrices : callable
        Takes the speed Ω, and the frequency of the motion, that of Ω without it [rad/s]; gives
        stiffness and damping, each (p, p), p a multiple of 3.
    motion : callable
        Takes a function that gives the motion (6, k) of an end, gives u as Fourier terms (p, k).
    turns : float
        Speed of its axes over Ω.
    varies, stiffness_varies : bool
        Whether anything, or a stiffness, depends on the speed.
    table_speeds : ndarray
        Ω at the points of its tables [rad/s], where coefficients have kinks.
    holding : callable, optional
        Gives a stiffness that tells which motions it holds, where it may have none at rest.
    law : ControlledSupport or another with coordinates of its own, optional
        What it was made from.
    mass : callable, optional
        As `matrices`, gives a mass (p, p) [kg] that goes with u, in axes that stand.
    table_frequencies : ndarray
        Frequencies of its tables [rad/s]; none where it does not depend on the frequency.
    held_beyond : bool
        Whether it may keep the ends of its tables beyond them.
    """

    ends: tuple[End, ...]
    matrices: Callable[..., tuple[np.ndarray, np.ndarray]]
    motion: Callable[[Seen], Terms]
    turns: float = 0.0
    varies: bool = False
    stiffness_varies: bool = False
    table_speeds: np.ndarray = field(default_factory=lambda: np.zeros(0))
    holding: Callable[[], np.ndarray] | None = None
    law: Controlled | None = None
    mass: Callable[..., np.ndarray] | None = None
    table_frequencies: np.ndarray = field(default_factory=lambda: np.zeros(0))
    held_beyond: bool = False

    @property
    def what(self) -> str:
        """The element, for messages."""
        return " – ".join(filter(None, (":".join(filter(None, end)) for end in self.ends)))

    def coefficients(self, speed: float, frequency: float | None = None) -> tuple[np.ndarray, ...]:
        """Return stiffness, damping and, where there is one, the mass."""
        found = self.matrices(speed, frequency)
        return found if self.mass is None else (*found, self.mass(speed, frequency))

    def at_rest(self) -> np.ndarray:
        """Return a stiffness that tells which motions it holds, (p, p).

        Of a film it is the stiffness at a speed at which it carries.
        """
        return self.holding() if self.holding is not None else self.matrices(0.0)[0]

    def is_isotropic(self, speed: float) -> bool:
        """Return whether the coefficients at a speed are the same in all directions."""
        return all(is_isotropic_matrix(X) for X in self.matrices(speed))

    def terms(
        self,
        coefficients: tuple[np.ndarray, np.ndarray],
        speed: float | np.ndarray,
        U: Terms,
        turns: int,
    ) -> tuple[dict, dict]:
        """Return the Fourier terms of damping and stiffness, each (k, k), or (s, k, k) of a stack.

        `coefficients` are what :attr:`matrices` gives at the speed Ω [rad/s], or stacks of them at
        speeds of the shape (s, 1, 1); `U` is :attr:`motion` in axes that turn with `turns` times Ω.
        """
        K, D = coefficients
        if self.turns:
            if self.turns == turns:  # seen from axes that turn with it, it stands still
                U = turned(U, -turns)
            else:
                K = K - self.turns * speed * D @ axial_skew(D.shape[-1])
        damping, stiffness = congruent(U, D), congruent(U, K)
        if len(U) > 1:
            add(stiffness, congruent(U, D, rate_of(U)), speed)
        return damping, stiffness

    def check_axes(self, turns: int) -> None:
        """Refuse an anisotropic element that turns otherwise than the axes do, and such a mass."""
        uneven = self.mass is not None and not is_isotropic_matrix(self.mass(0.0))
        for fault, is_there in (
            ("has coefficients over the frequency", turns and self.table_frequencies.size),
            ("has a mass that is not the same in all directions", turns and uneven),
        ):
            if is_there:
                raise ValueError(
                    f"supports: {self.what} {fault}, which needs a rotor that is round, and axes "
                    "that stand still; leave axes='rotor' out, or give support.at_frequency(…)"
                )
        if self.turns and self.turns != turns and not self.is_isotropic(0.0):
            raise ValueError(
                f"supports: {self.what} is not the same in all directions and turns with "
                f"{self.turns:g} times the speed of the analysis; give a RotorTrain relative_to "
                "its rotor, or leave axes='inertial' out"
            )


def is_isotropic_matrix(X: np.ndarray) -> bool:
    quarter = axial_skew(len(X))
    return bool(np.abs(X @ quarter - quarter @ X).max() <= _ROUNDING * np.abs(X).max())


class OwnBody(Body):
    """Coordinates that a support brings with it, as a body: of a controller, of pads."""

    def rows(self) -> dict[int, np.ndarray]:
        """Return the displacements of its pairs of coordinates, seen from outside, (3p, k)."""
        return turned({0: np.kron(np.eye(self.size // 2), ACROSS)}, self.turns)


class PadBody(OwnBody):
    """The tilts of pads, which stand still."""

    def rows(self) -> dict[int, np.ndarray]:
        """Return the coordinates, (k, k)."""
        return {0: np.eye(self.size)}


def own_body(one: Controlled, number: int, turns: int) -> OwnBody:
    """Return the coordinates of a support; pairs in axes that turn with `turns` times Ω."""
    word, name = f"{one.word} {number} at {one.interface}", f" {number}"
    labels = tuple(f"{word}, {n}" for n in range(1, one.size + 1))
    M, none = np.diag(one.masses), np.zeros((one.size, one.size))
    if one.word == "pads":
        return PadBody(name, 0, M, (none,), (none,), labels)
    quarter = np.kron(np.eye(one.size // 2), axial_skew(3)[:2, :2])
    powers_D, powers_K = (none, 2.0 * turns * M @ quarter), (none, none, -float(turns) * M)
    return OwnBody(name, turns, M, powers_D, powers_K, labels)


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

    def pair(speed: float, frequency: float | None) -> tuple[float, float]:
        return rate * speed, abs(speed) if frequency is None else frequency

    def matrices(speed: float, frequency: float | None = None) -> tuple[np.ndarray, np.ndarray]:
        support.check_range(rate * speed)
        return support.matrices(*pair(speed, frequency))

    def mass(speed: float, frequency: float | None = None) -> np.ndarray:
        return support.mass_matrix(*pair(speed, frequency))

    speeds = support.table_speeds / rate if rate and support.varies else np.zeros(0)
    return Element(
        (end,) if base is None else (end, base),
        matrices,
        _relative(end, base),
        ratio if support.frame == "rotor" else 0.0,
        support.varies,
        support.stiffness_varies,
        speeds,
        lambda: support.matrices(0.0)[0],
        mass=mass if acts(support.mass) else None,
        table_frequencies=support.table_frequencies if support.varies else np.zeros(0),
        held_beyond=support.extrapolate,
    )


def own_elements(
    one: Controlled, end: End, bases: Mapping[str, End], rate: float, own: OwnBody
) -> list[Element]:
    """Return the elements of a support with coordinates of its own."""
    base = bases.get(one.interface)
    if isinstance(one, SeriesSupport):
        return _series_elements(one, end, base, rate, own)
    ends, ports = (end,), [_relative(end, base, 3)]
    if one.sensor is not None:
        ends = end, (end[0], one.sensor)
        ports.append(_relative(ends[1], bases.get(one.sensor), 3))
    inner = np.eye(own.size) if one.sensor is None else np.kron(np.eye(own.size // 2), ACROSS)
    lifted = la.block_diag(np.kron(np.eye(len(ports)), ACROSS), inner)

    def matrices(speed: float, *_: float) -> tuple[np.ndarray, np.ndarray]:
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
    bases: Mapping[str, End],
    turns: int,
    kind: str = "full",
    begun: int = 0,
) -> tuple[list[Element], list[OwnBody]]:
    """Return the elements of a model, and the coordinates that some of them bring.

    What carries a support is in `bases` by its interface, the ground where there is nothing. Pairs
    of own coordinates turn with `turns` times Ω; `begun` bodies of them there are already. Of the
    kind 'static' elements have their static stiffness in the place of own coordinates; 'undamped'
    ones are also without damping and the skew part of their stiffness, and keep rings.

    Raises
    ------
    ValueError
        For a bearing without the load that it needs.
    """
    elements, own = [], []
    for name, given in supports.items():
        plain, controlled = linear_supports(given)
        if kind != "full":
            rings = [c for c in controlled if isinstance(c, SeriesSupport) and kind == "undamped"]
            others = (c for c in controlled if c not in rings)
            plain = [*plain, *(Support(c.interface, c.static_stiffness) for c in others)]
            controlled = [ring.undamped() for ring in rings]
        if kind == "undamped":
            plain = [one.undamped() for one in plain]
        ratio = ratios[name]
        for one in plain:
            base = bases.get(one.interface)
            elements.append(support_element(one, (name, one.interface), base, ratio, ratio))
        for one in sorted(controlled, key=lambda each: WORDS.index(each.word)):
            own.append(own_body(one, begun + len(own) + 1, turns))
            elements += own_elements(one, (name, one.interface), bases, ratio, own[-1])
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

    @cached_property
    def M(self) -> np.ndarray:
        """Mass matrix, shape (k, k)."""
        return la.block_diag(*(body.M for body in self.bodies))

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
        place, body = next((i, body) for i, body in enumerate(self.bodies) if body.name == name)
        if isinstance(body, OwnBody):
            rows = body.rows()
        elif isinstance(body, RotorBody):
            rows = body.supported(interface)
        else:
            rows = body.seen(interface)
        return self.wide(rows, self.slices[place])

    @cached_property
    def motions(self) -> list[Terms]:
        """Motion of each element, by multiples of θ."""
        return [without_rounding(one.motion(self._acted_on)) for one in self.elements]

    @cached_property
    def _steady(self) -> tuple[dict[int, list], dict[int, list]]:
        """Coefficients of powers of Ω, by multiples of θ, of all that does not vary otherwise."""
        powers_D = [{} for _ in range(5)]
        powers_K = [{} for _ in range(5)]
        for body, place in zip(self.bodies, self.slices, strict=True):
            for powers, given in ((powers_D, body.D), (powers_K, body.K)):
                for power, X in enumerate(given):
                    wide = np.zeros((self.size, self.size))
                    wide[place, place] = X
                    add(powers[power], {0: wide})
        for element, U in zip(self.elements, self.motions, strict=True):
            if not element.varies:
                given = element.matrices(0.0)
                D, K = element.terms(given, 0.0, U, self.turns)
                _, faster = element.terms(given, 1.0, U, self.turns)
                add(powers_D[0], D)
                add(powers_K[0], K)
                add(powers_K[1], faster)
                add(powers_K[1], K, -1.0)
        return _without_rounding(powers_D), _without_rounding(powers_K)

    @cached_property
    def _powers(self) -> tuple[dict[int, tuple[list[int], np.ndarray]], ...]:
        """Coefficients of :attr:`_steady` by multiples of θ: powers (p,) of Ω, and (p, k, k)."""
        found = []
        for given in self._steady:
            orders = {n for terms in given for n in terms}
            which = {n: [p for p, X in enumerate(given) if n in X and np.any(X[n])] for n in orders}
            which[0] = which.get(0) or [0]
            found.append(
                {n: (p, np.stack([given[i][n] for i in p])) for n, p in which.items() if p}
            )
        return tuple(found)

    def projected(self, basis: np.ndarray) -> Assembly:
        """Return what gives the equations of motions in a real basis (k, r)."""

        def within(terms: Terms) -> dict[int, np.ndarray]:
            return {n: basis.T @ X @ basis for n, X in terms.items()}

        other = Assembly(self.bodies, self.elements, self.turns)
        vars(other).update(
            M=basis.T @ self.M @ basis,
            motions=[{n: U @ basis for n, U in terms.items()} for terms in self.motions],
            _steady=tuple([within(terms) for terms in given] for given in self._steady),
            _H=[(n, basis.T @ X @ basis) for n, X in self._H],
        )
        return other

    def system(self, speed: float, frequency: float | None = None) -> PeriodicSystem:
        """Return the equations at a spin speed, and a frequency of motions [rad/s]."""
        given = [one.coefficients(speed, frequency) for one in self._varying]
        return self._system(float(speed), given)

    def systems(
        self, speeds: np.ndarray, frequencies: np.ndarray | None = None
    ) -> tuple[PeriodicSystem | None, dict[int, Exception]]:
        """Return the equations at spin speeds (s,), stacked, and why there are none at some.

        Speeds at which there are none are left out of the stack. Frequencies of motions (s,) are
        those of the speeds by default.
        """
        found, refused = [], {}
        rates = [None] * len(speeds) if frequencies is None else frequencies.tolist()
        for place, pair in enumerate(zip(speeds.tolist(), rates, strict=True)):
            try:
                found.append([one.coefficients(*pair) for one in self._varying])
            except NO_EQUATIONS as error:
                refused[place] = error
        if not found:
            return None, refused
        return self._system(np.delete(speeds, list(refused)), stacked_coefficients(found)), refused

    def at_points(self, speeds: np.ndarray, coefficients: Sequence) -> PeriodicSystem:
        """Return the equations at points, stacked, each with coefficients of its elements.

        `coefficients` are :meth:`Element.coefficients` of each, as stacks over the points.
        """
        varying = tuple(replace(element, varies=True) for element in self.elements)
        return replace(self, elements=varying)._system(speeds, coefficients)

    @cached_property
    def _varying(self) -> list[Element]:
        return [element for element in self.elements if element.varies]

    def _system(self, speed: float | np.ndarray, coefficients: Sequence) -> PeriodicSystem:
        """Return the equations at a speed, or a stack, by the `coefficients` of what varies."""
        factor = np.asarray(speed)[..., None, None] if np.ndim(speed) else speed
        D, K = (
            {n: np.tensordot(np.power.outer(speed, powers), X, 1) for n, (powers, X) in each}
            for each in map(dict.items, self._powers)
        )
        M, rest = self.M, iter(coefficients)
        for element, U in zip(self.elements, self.motions, strict=True):
            given = next(rest) if element.varies else (None, None)
            if element.varies:
                damping, stiffness = element.terms(given[:2], factor, U, self.turns)
                add(D, damping)
                add(K, stiffness)
            if element.mass is not None:
                mass = given[2] if element.varies else element.mass(0.0)
                M = M + self._inertia(mass, U, factor, D, K)
        return PeriodicSystem(speed, M, without_rounding(D), without_rounding(K), self._H)

    @staticmethod
    def _inertia(
        mass: np.ndarray, U: Terms, factor: float | np.ndarray, D: dict, K: dict
    ) -> np.ndarray:
        """Return the mass matrix of a mass; add what follows as axes turn: ü = d²(U y)/dt².

        Of the mass matrix the mean: in axes that turn, a mass is alike in all directions.
        """
        first = rate_of(U)
        if first:
            add(D, congruent(U, mass, first), 2.0 * factor)
            add(K, congruent(U, mass, rate_of(first)), factor**2)
        return congruent(U, mass)[0].real

    @cached_property
    def _H(self) -> list[tuple[float, np.ndarray]]:
        """Structural damping of all bodies, see :class:`PeriodicSystem`."""
        return [
            (n, self.wide({0: self.wide({0: X}, place)[0].T}, place)[0].T)
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


def _without_rounding(powers: list[dict[int, np.ndarray]]) -> list[dict[int, np.ndarray]]:
    """Return coefficients of powers of Ω without the terms of θ that are rounding of the first."""
    largest = max((np.abs(X).max(initial=0.0) for X in powers[0].values()), default=0.0)
    first = without_rounding(powers[0]) if powers[0] else powers[0]
    kept = [
        {n: X for n, X in each.items() if n == 0 or np.abs(X).max() > _CHANGE * largest}
        for each in powers[1:]
    ]
    return [first, *kept]


def stacked_coefficients(found: Sequence[Sequence]) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return stiffness and damping of elements, known at points, as stacks over the points."""
    return [tuple(map(np.stack, zip(*each, strict=True))) for each in zip(*found, strict=True)]


def rotors_of(bodies: Sequence[Body]) -> list[RotorBody]:
    """Return the rotors among bodies."""
    return [body for body in bodies if isinstance(body, RotorBody)]
