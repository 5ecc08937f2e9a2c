"""What stands between the bodies of a linear model and the ground: supports, links, gears, pads.

An element has stiffness and damping of a motion u of its own, ``f = −K u − D u̇``, in axes that
stand still or turn with a rotor. How u follows from the coordinates of the bodies, ``u = U(θ) y``,
is all that depends on the axes of the model.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from exudyn_rotor.bearings.controlled_support import (
    Controlled,
    ControlledSupport,
    FilmSupport,
    PadSupport,
)
from exudyn_rotor.bearings.given import linear_supports
from exudyn_rotor.bearings.support import OutsideTableError, Support, acts
from exudyn_rotor.drives.gear_mesh import GearMesh
from exudyn_rotor.linear.equations import (
    Terms,
    add,
    congruent,
    difference,
    rate_of,
    stacked,
    turned,
)
from exudyn_rotor.linear.model.body import Body
from exudyn_rotor.linear.model.links import Link
from exudyn_rotor.linear.model.points import ACROSS
from exudyn_rotor.theory.rotating_axes import axial_skew

_ROUNDING = 1e-12  # share of a matrix by which it may differ after a turn and be isotropic
End = tuple[str, str]  # names of a body and of its interface
Seen = Callable[[End], Terms]  # what a support acts on, seen from outside
WORDS = {ControlledSupport: "controller", FilmSupport: "voids", PadSupport: "pads"}


@dataclass(frozen=True, eq=False)
class Element:
    """A law between bodies.

    Attributes
    ----------
    ends : tuple of (str, str)
        Bodies and their interfaces.
    matrices : callable
        Takes the speed Ω [rad/s], gives stiffness and damping, each (p, p), p a multiple of 3.
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
        Takes the speed, gives a mass [kg] that goes with u across the axis, in axes that stand.
    """

    ends: tuple[End, ...]
    matrices: Callable[[float], tuple[np.ndarray, np.ndarray]]
    motion: Callable[[Seen], Terms]
    turns: float = 0.0
    varies: bool = False
    stiffness_varies: bool = False
    table_speeds: np.ndarray = field(default_factory=lambda: np.zeros(0))
    holding: Callable[[], np.ndarray] | None = None
    law: Controlled | None = None
    mass: Callable[[float], float] | None = None

    @property
    def what(self) -> str:
        """The element, for messages."""
        return " – ".join(filter(None, (":".join(filter(None, end)) for end in self.ends)))

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
        """Refuse an anisotropic element that turns otherwise than the axes do."""
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
    """Coordinates that a support brings with it, in pairs, as a body: of a controller, of voids."""

    def rows(self) -> dict[int, np.ndarray]:
        """Return the displacements of its pairs of coordinates, seen from outside, (3p, k)."""
        pairs = np.kron(np.eye(self.size // 2), ACROSS)
        return turned({0: pairs}, self.turns)


class PadBody(OwnBody):
    """The tilts of pads, which stand still."""

    def rows(self) -> dict[int, np.ndarray]:
        """Return the coordinates, (k, k)."""
        return {0: np.eye(self.size)}


def own_body(one: Controlled, number: int, turns: int) -> OwnBody:
    """Return the coordinates of a support; pairs in axes that turn with `turns` times Ω."""
    labels = tuple(
        f"{WORDS[type(one)]} {number} at {one.interface}, {n}" for n in range(1, one.size + 1)
    )
    M, none = np.diag(one.masses), np.zeros((one.size, one.size))
    name = f" {number}"
    if isinstance(one, PadSupport):
        return PadBody(name, 0, M, (none,), (none,), labels)
    quarter = np.kron(np.eye(one.size // 2), axial_skew(3)[:2, :2])
    powers_D, powers_K = (none, 2.0 * turns * M @ quarter), (none, none, -float(turns) * M)
    return OwnBody(name, turns, M, powers_D, powers_K, labels)


def _relative(end: End, base: End | None) -> Callable[[Seen], Terms]:
    """Return what gives the motion of an end against its base."""
    if base is None:
        return lambda seen: seen(end)
    return lambda seen: difference(seen(end), seen(base))


def _part(motion: Callable[[Seen], Terms], rows: slice) -> Callable[[Seen], Terms]:
    return lambda seen: {n: U[rows] for n, U in motion(seen).items()}


def support_element(
    support: Support, end: End, base: End | None, rate: float, ratio: float
) -> Element:
    """Return a support between an end and its base, the ground by default.

    Its tables are over `rate` times Ω; one in the rotor's frame turns with `ratio` times Ω.
    """

    def matrices(speed: float) -> tuple[np.ndarray, np.ndarray]:
        try:
            support.check_range(rate * speed)
        except OutsideTableError as error:
            if rate == 1.0:
                raise
            raise OutsideTableError(
                f"{error}; it turns with {rate:g} times the speed of the analysis, {speed:g} rad/s"
            ) from None
        return support.matrices(rate * speed)

    speeds = support.table_speeds / rate if rate else np.zeros(0)
    return Element(
        (end,) if base is None else (end, base),
        matrices,
        _relative(end, base),
        ratio if support.frame == "rotor" else 0.0,
        support.varies,
        support.stiffness_varies,
        speeds,
        lambda: support.matrices(0.0)[0],
        mass=(lambda speed: support.mass_at(rate * speed)) if acts(support.mass) else None,
    )


def _gear_element(gears: GearMesh, ends: tuple[End, End]) -> Element:
    return Element(ends, lambda _: gears.matrices(), lambda seen: stacked([*map(seen, ends)]))


def with_own(
    one: Controlled, end: End, bases: Mapping[str, End], rate: float, own: OwnBody
) -> list[Element]:
    """Return the elements of a support with coordinates of its own."""
    at = _part(_relative(end, bases.get(one.interface)), slice(0, 3))
    if isinstance(one, PadSupport):
        return [_pad_element(one, place, at, end, rate, own) for place in range(one.size)]
    ports = [at]
    if isinstance(one, ControlledSupport):
        sensed = _relative((end[0], one.sensor), bases.get(one.sensor))
        ports.append(_part(sensed, slice(0, 3)))
    lifted = np.kron(np.eye(len(ports) + own.size // 2), ACROSS)

    def matrices(speed: float) -> tuple[np.ndarray, np.ndarray]:
        K, D = one.stiffness, one.damping
        return lifted @ K @ lifted.T, lifted @ D @ lifted.T

    def of_film(speed: float) -> tuple[np.ndarray, np.ndarray]:
        D, K = one.matrices(rate * speed)
        return lifted @ K @ lifted.T, lifted @ D @ lifted.T

    def motion(seen: Seen) -> Terms:
        return stacked([*(port(seen) for port in ports), seen((own.name, ""))])

    ends = (end, (end[0], one.sensor))
    if isinstance(one, ControlledSupport):
        return [Element(ends, matrices, motion, law=one)]
    return [Element((end,), of_film, motion, varies=True, stiffness_varies=True)]


def _pad_element(
    one: PadSupport, place: int, at: Callable, end: End, rate: float, own: OwnBody
) -> Element:
    """Return the film of a pad, which acts on ``x − s t``."""
    film, tangent = one.films[place], np.append(one.tangents[place], 0.0)

    def matrices(speed: float) -> tuple[np.ndarray, np.ndarray]:
        film.check_range(rate * speed)
        return tuple(X[:3, :3] for X in film.matrices(rate * speed))

    def motion(seen: Seen) -> Terms:
        tilt = seen((own.name, ""))[0][place : place + 1]
        return difference(at(seen), {0: np.outer(tangent, tilt)})

    return Element((end,), matrices, motion, varies=True, stiffness_varies=True)


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

    Parameters
    ----------
    supports : mapping of str to sequence
        Supports and bearings of each rotor.
    ratios : mapping of str to float
    links : sequence of Link
    bases : mapping of str to (str, str)
        What carries the support at an interface; the ground where there is nothing.
    turns : int
        Axes of the own coordinates.
    kind : {'full', 'static', 'undamped'}
        'static' elements have their static stiffness in the place of own coordinates; 'undamped'
        ones are also without damping and the skew part of their stiffness.
    begun : int
        Number of own coordinates' bodies that there are already.

    Raises
    ------
    ValueError
        For a bearing without the load that it needs.
    """
    elements, own = [], []
    for name, given in supports.items():
        plain, controlled = linear_supports(given)
        if kind != "full":
            plain = [*plain, *(Support(c.interface, c.static_stiffness) for c in controlled)]
            controlled = ()
        if kind == "undamped":
            plain = [one.undamped() for one in plain]
        ratio = ratios[name]
        for one in plain:
            base = bases.get(one.interface)
            elements.append(support_element(one, (name, one.interface), base, ratio, ratio))
        for one in sorted(controlled, key=lambda each: list(WORDS).index(type(each))):
            own.append(own_body(one, begun + len(own) + 1, turns))
            elements += with_own(one, (name, one.interface), bases, ratio, own[-1])
    for link in links:
        first, second = link.ends
        if isinstance(link.connection, GearMesh):
            elements.append(_gear_element(link.connection, (first, second)))
            continue
        law = link.connection.undamped() if kind == "undamped" else link.connection
        rate = ratios[first[0]] - ratios[second[0]]
        elements.append(support_element(law, first, second, rate, ratios[first[0]]))
    return elements, own
