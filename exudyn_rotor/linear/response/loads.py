"""Loads on rotors and where they act: places, unbalances, harmonic forces, ground that shakes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.linear.equations import Terms, turned
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.theory.rotating_axes import FRAMES

At = str | int | Sequence[float]
Harmonics = dict[int, np.ndarray]

# ------------------------------------------------------------------ places


@dataclass(frozen=True, eq=False)
class Place:
    """A point of a model: an interface, or a mesh node 'node 12', which has no rotation.

    Displacement and rotation along (n1, n2, e) per coordinate, `seen` in axes that stand still, are
    Fourier terms (6, k). The `ratio` is the speed of the body over the speed of the analysis.
    """

    label: str
    seen: Terms
    is_node: bool
    ratio: float = 1.0

    def motion(self, coordinates: Mapping[int, np.ndarray], frame: str) -> Harmonics:
        """Return the harmonics (…, 6) of the motion, given the harmonics (…, k) of coordinates.

        In axes that stand still, or in axes that turn with the speed of the analysis.
        """
        seen = self.seen if frame == "inertial" else turned(self.seen, -1)
        pairs = product(seen.items(), coordinates.items())
        return _sum({m + n: x @ U.T} for (m, U), (n, x) in pairs)

    def pulled(self, wrench: np.ndarray, frame: str, speed: float) -> Harmonics:
        """Return the generalised force, as harmonics (k,), of a force and moment (6,).

        Along and about (n1, n2, e), which stand still or turn with the rotor at a speed [rad/s].
        """
        if frame == "rotor" and self.ratio not in (0.0, 1.0):
            owner, _, _ = self.label.partition(":")
            raise ValueError(
                f"at: {self.label!r}: turns with {self.ratio:g} times the speed of the analysis; "
                f"give train.relative_to({owner!r}), over the speed of that rotor"
            )
        seen = turned(self.seen, -1) if frame == "rotor" and speed else self.seen
        return {n: U.T @ wrench for n, U in seen.items()}


def place(model: LinearModel, at: At, speed: float = 1.0) -> Place:
    """Find an interface by its name, a mesh node by its number or by a position [m].

    The motion is seen at a speed [rad/s]: at rest, or at any other.
    """
    if isinstance(at, str):
        if at not in model.interfaces:
            known = ", ".join(model.interfaces) or "none"
            raise ValueError(f"at: {at!r}: no such interface; the rotor has: {known}")
        body, _ = model.owner(at)
        return Place(at, model.seen(at, speed), False, getattr(body, "ratio", 0.0))
    [first, *others] = model.rotors.values()
    if others:
        raise ValueError(f"at: {at!r}: of several rotors, name an interface")
    if first.shapes is None:
        raise ValueError(
            f"at: {at!r}: mesh nodes need a rotor with its mode shapes, not one "
            "without_shapes(); name an interface"
        )
    number = node_number(first.shapes.nodes, at)
    return Place(f"node {number}", model.seen_at_node(number, speed), is_node=True)


def node_number(nodes: np.ndarray, at: int | Sequence[float]) -> int:
    """Return the number of a mesh node, of the nearest one to a position [m]."""
    if not isinstance(at, int):
        return int(np.argmin(np.linalg.norm(nodes - np.asarray(at), axis=1)))
    if at >= len(nodes):
        raise ValueError(f"at: {at}: no such node; the mesh has nodes 0 to {len(nodes) - 1}")
    return at


def checked_places(at: Sequence[At] | At | None) -> tuple[At, ...] | None:
    """Return places as a tuple; None for all interfaces."""
    if at is None:
        return None
    listed = [at] if isinstance(at, str | int | np.integer) else at
    listed = checks.items(listed, "at", "places of the rotor in a sequence")
    found = tuple(checks.place(one, f"at[{index}]") for index, one in enumerate(listed))
    checks.different(found, "at")
    return found


def places(model: LinearModel, at: Sequence[At] | None, speed: float = 1.0) -> list[Place]:
    """Return the places asked for; by default all interfaces."""
    observed = [place(model, one, speed) for one in (model.interfaces if at is None else at)]
    if not observed:
        raise ValueError("at: the rotor has no interfaces; name mesh nodes or positions to look at")
    return observed


# ------------------------------------------------------------------ unbalances


def permissible_unbalance(grade: float, mass: float, speed: float) -> float:
    """Return the permissible residual unbalance of a rotor, ``U = G m / Ω`` [kg m].

    By ISO 21940-11:2016, Sect. 5 and 6, for rotors with rigid behaviour.

    Parameters
    ----------
    grade : float
        Balance quality grade G [mm/s]: 2.5 for G 2.5.
    mass : float
        Mass of the rotor [kg].
    speed : float
        Highest service speed [rad/s].

    Raises
    ------
    TypeError, ValueError
        If one of them is not a positive number.

    Examples
    --------
    >>> from exudyn_rotor import permissible_unbalance
    >>> permissible_unbalance(2.5, mass=40.0, speed=500.0)
    0.0002
    """
    grade = checks.number(grade, "grade", "mm/s", above=0.0)
    mass = checks.number(mass, "mass", "kg", above=0.0)
    speed = checks.number(speed, "speed", "rad/s", above=0.0)
    return 1e-3 * grade * mass / speed


@dataclass(frozen=True)
class Unbalance:
    """A small excess mass at a radius: a load ``Ω² U`` that stands still in the rotor frame.

    Parameters
    ----------
    at : str, int, or sequence of three floats
        Interface, mesh node, or the node nearest to a position in mesh coordinates [m]. Where on
        the radius the mass sits is in the amount already: the load acts on the mean motion of the
        interface.
    amount : float
        Mass times eccentricity U [kg m], positive.
    angle : float, optional
        Direction in the rotor frame, from n1 to n2 of :attr:`SpinAxis.plane` [rad].

    Raises
    ------
    TypeError, ValueError
        If the place is of another kind, the amount not positive, or a number not finite.

    Examples
    --------
    >>> from exudyn_rotor import Unbalance
    >>> Unbalance.from_grade("disc", 2.5, mass=40.0, speed=500.0, share=0.5)
    Unbalance(at='disc', amount=0.0001, angle=0.0)
    """

    at: str | int | Sequence[float]
    amount: float
    angle: float = 0.0

    def __post_init__(self) -> None:
        checks.keep(self, at=checks.place(self.at, "at"))
        where = f"unbalance at {self.at!r}"
        amount = checks.number(self.amount, f"{where}: amount", "kg m", above=0.0)
        angle = checks.number(self.angle, f"{where}: angle", "rad")
        checks.keep(self, amount=amount, angle=angle)

    @classmethod
    def from_grade(
        cls,
        at: str | int | Sequence[float],
        grade: float,
        mass: float,
        speed: float,
        *,
        angle: float = 0.0,
        share: float = 1.0,
    ) -> Unbalance:
        """Return the largest unbalance that a balance quality grade permits.

        Parameters
        ----------
        at : str, int, or sequence of three floats
        grade, mass, speed : float
            See :func:`permissible_unbalance`.
        angle : float, optional
            In the rotor frame [rad].
        share : float, optional
            Part of the whole in this plane: 0.5 where two tolerance planes lie at equal distances
            from the centre of mass (ISO 21940-11:2016, Sect. 7).

        Raises
        ------
        TypeError, ValueError
            If `share` is not between 0 and 1, or another argument is refused.
        """
        share = checks.number(share, "share", above=0.0, most=1.0)
        return cls(at, share * permissible_unbalance(grade, mass, speed), angle)

    def __str__(self) -> str:
        """Return place, amount [g mm] and angle [deg] in words."""
        amount, angle = 1e6 * self.amount, np.degrees(self.angle)
        return f"unbalance of {amount:.4g} g mm at {self.at!r}, angle {angle:.4g} deg"

    def _harmonics(self, model: LinearModel, speed: float) -> Harmonics:
        """Return the harmonics (k,) of the load per Ω² at a speed [rad/s]."""
        point = place(model, self.at, speed)
        if point.ratio == 0.0:
            raise ValueError(f"unbalance at {self.at!r}: a foundation does not turn")
        force = self.amount * np.array([np.cos(self.angle), np.sin(self.angle)])
        return point.pulled(np.r_[force, np.zeros(4)], "rotor", speed)


# ------------------------------------------------------------------ loads over a frequency


@dataclass(frozen=True, eq=False)
class HarmonicForce:
    """A force and a moment ``Re(F exp(iωt))`` at a place of the rotor.

    Parameters
    ----------
    at : str, int, or sequence of three floats
        Interface, mesh node, or the node nearest to a position in mesh coordinates [m].
    force : array_like, shape (2,) or (3,)
        Complex amplitude along (n1, n2[, e]) of :attr:`SpinAxis.plane` [N]. A force of constant
        size that circles forward is (1, −1j).
    moment : array_like, shape (2,) or (3,), optional
        About (n1, n2[, e]), at an interface only [N m].
    frame : {'inertial', 'rotor'}
        Whether its direction is fixed in space or in the rotor; it acts on the same material
        points either way.

    Raises
    ------
    TypeError, ValueError
        For an unknown frame, a place of another kind, a wrong shape, or an entry that is not
        finite.

    Examples
    --------
    A force of 10 N that circles forward in space:

    >>> from exudyn_rotor import HarmonicForce
    >>> HarmonicForce("disc", (10.0, -10.0j)).force
    array([10. +0.j, -0.-10.j,  0. +0.j])
    """

    at: At
    force: ArrayLike = (0.0, 0.0, 0.0)
    moment: ArrayLike = (0.0, 0.0, 0.0)
    frame: str = "inertial"

    def __post_init__(self) -> None:
        checks.choice(self.frame, "frame", FRAMES)
        checks.keep(self, at=checks.place(self.at, "at"))
        force = _vector(self.force, f"force at {self.at!r}", "N")
        moment = _vector(self.moment, f"moment at {self.at!r}", "N m")
        checks.keep(self, force=force, moment=moment)

    def _harmonics(self, model: LinearModel, speed: float) -> Harmonics:
        """Return the harmonics (k,) of the load at a spin speed [rad/s]."""
        point = place(model, self.at, speed)
        if point.is_node and np.any(self.moment):
            raise ValueError(
                f"moment at {self.at!r}: a mesh node has no rotation; use an interface"
            )
        return point.pulled(np.r_[self.force, self.moment], self.frame, speed)


@dataclass(frozen=True, eq=False)
class BaseAcceleration:
    """An acceleration ``Re(a exp(iωt))`` of the ground under all supports, fixed in space.

    The response is the motion relative to the ground: ``f = −Sᵀ Aᵀ τ̈`` (109). The ground's own
    displacement is ``−a/ω²``. Gravity g acts as the acceleration −g of the ground does, at
    frequency zero: ground that accelerates upward presses as weight does.

    Parameters
    ----------
    acceleration : array_like, shape (2,) or (3,)
        Complex amplitude along (n1, n2[, e]) of :attr:`SpinAxis.plane` [m/s²].

    Raises
    ------
    TypeError, ValueError
        For a wrong shape or an entry that is not finite.

    Examples
    --------
    Weight in the direction −n2 makes a rotor of 4 kg sag by m g/k:

    >>> from exudyn_rotor import BaseAcceleration, Support, harmonic_response, rotor_example
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> supports = [Support(name, 2e4) for name in ("left", "right")]
    >>> weight = BaseAcceleration((0.0, +9.81))
    >>> response = harmonic_response(rotor, [0.0], weight, supports=supports)
    >>> response.phasor("left", "n2").real
    array([-0.000981])
    """

    acceleration: ArrayLike

    def __post_init__(self) -> None:
        checks.keep(self, acceleration=_vector(self.acceleration, "acceleration", "m/s²"))

    def _harmonics(self, model: LinearModel, speed: float) -> Harmonics:
        """Return the harmonics (k,) of the load at a spin speed [rad/s]."""
        loads = model.base_loads(speed)
        if loads is None:
            raise ValueError(
                "gravity, or ground that moves, needs a rotor with supports, and a foundation with "
                "its participation; in a scene, put a force on the moving parts"
            )
        return {n: each.T @ self.acceleration for n, each in loads.items()}


# ------------------------------------------------------------------ all loads together


def total(
    loads: Iterable[HarmonicForce | BaseAcceleration], model: LinearModel, speed: float
) -> Harmonics:
    """Return the harmonics (k,) of the sum of all loads at a spin speed [rad/s]."""
    return _sum(load._harmonics(model, speed) for load in loads)


def unbalance_load(model: LinearModel, unbalances: Sequence[Unbalance], own: bool) -> Harmonics:
    """Return the harmonics (k,) of the load per Ω² of all unbalances."""
    of_rotor = model.unbalance() if own else {0: np.zeros(model.size)}
    if not unbalances and not any(np.any(force) for force in of_rotor.values()):
        reason = "the rotor itself is balanced" if own else "own=False leaves out the rotor's own"
        raise ValueError(f"no unbalance, so no response: {reason}; give unbalances=[Unbalance(…)]")
    return _sum([of_rotor, *(unbalance._harmonics(model, 1.0) for unbalance in unbalances)])


def _sum(parts: Iterable[Harmonics]) -> Harmonics:
    found: Harmonics = {}
    for part in parts:
        for n, force in part.items():
            found[n] = found.get(n, 0.0) + force
    return found


def in_words(model: LinearModel, unbalances: Sequence[Unbalance], own: bool) -> tuple[str, ...]:
    """Return the unbalances as text, the own one with its amount beside those that are given."""
    given, found = sum(unbalance.amount for unbalance in unbalances), list(map(str, unbalances))
    for name, rotor in model.rotors.items() if own else ():
        if model.ratios[name] != 1.0:  # it turns with another speed
            continue
        off = rotor.center_of_mass - rotor.axis.project(rotor.center_of_mass)
        amount = rotor.invariants.mass * np.linalg.norm(off)
        share = f", {amount / given:.2g} of the amount given" if given else ""
        whose = f"rotor {name!r}" if name else "the rotor"
        found.append(f"eccentricity of {whose}, with its mesh: {1e6 * amount:.4g} g mm{share}")
    return tuple(found)


def _vector(value: ArrayLike, name: str, unit: str) -> np.ndarray:
    """Return an amplitude along (n1, n2, e), shape (3,), complex and read-only."""
    vector = checks.array(value, name, unit, dtype=complex)
    if vector.shape not in ((2,), (3,)):
        raise ValueError(
            f"{name}: needs two or three numbers [{unit}] along (n1, n2[, e]), got "
            f"{checks.shown(value)}"
        )
    return checks.read_only(np.r_[vector, np.zeros(3 - len(vector))], complex)
