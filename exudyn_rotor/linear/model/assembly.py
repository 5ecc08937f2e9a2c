"""The equations of bodies and elements together, in one kind of axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg as la

from exudyn_rotor.bearings.support import NoCoefficientsError
from exudyn_rotor.linear.equations import (
    PeriodicSystem,
    Terms,
    UnconvergedError,
    add,
    congruent,
    rate_of,
    without_rounding,
)
from exudyn_rotor.linear.model.body import Body, RotorBody
from exudyn_rotor.linear.model.element import Element, End, OwnBody

NO_EQUATIONS = NoCoefficientsError, UnconvergedError
_ROUNDING = 1e-14  # share of a stiffness that is the rounding of its change by the speed


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

    def system(self, speed: float, frequency: float | None = None) -> PeriodicSystem:
        """Return the equations at a spin speed, and a frequency of motions [rad/s]."""
        given = [self._given(one, speed, frequency) for one in self._varying]
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
                found.append([self._given(one, *pair) for one in self._varying])
            except NO_EQUATIONS as error:
                refused[place] = error
        if not found:
            return None, refused
        stacks = [tuple(map(np.stack, zip(*each, strict=True))) for each in zip(*found)]  # noqa: B905
        return self._system(np.delete(speeds, list(refused)), stacks), refused

    @staticmethod
    def _given(one: Element, speed: float, frequency: float | None) -> tuple[np.ndarray, ...]:
        """Return stiffness, damping and, where there is one, the mass of what varies."""
        found = one.matrices(speed, frequency)
        return found if one.mass is None else (*found, one.mass(speed, frequency))

    @cached_property
    def _varying(self) -> list[Element]:
        return [element for element in self.elements if element.varies]

    def _system(self, speed: float | np.ndarray, coefficients: Sequence) -> PeriodicSystem:
        """Return the equations at a speed, or a stack, by the `coefficients` of what varies."""
        factor = np.asarray(speed)[..., None, None] if np.ndim(speed) else speed
        D, K = {}, {}
        for terms, powers in zip((D, K), self._steady, strict=True):
            for power, given in enumerate(powers):
                add(terms, given, factor**power)
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

    def seen(self, body: Body, interface: str) -> dict[int, np.ndarray]:
        """Return the motion (6, k) of an interface, seen from outside, for loads and results."""
        return self.wide(body.seen(interface), self.slices[self.bodies.index(body)])

    def summed(self, name: str) -> dict[int, np.ndarray]:
        """Return the sum over the bodies of one of their loads, as Fourier terms."""
        total: dict[int, np.ndarray] = {}
        for body, place in zip(self.bodies, self.slices, strict=True):
            given = getattr(body, name, None)
            if given:
                add(total, self.wide(given, place))
        return total

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
        {n: X for n, X in each.items() if n == 0 or np.abs(X).max() > _ROUNDING * largest}
        for each in powers[1:]
    ]
    return [first, *kept]


def rotors_of(bodies: Sequence[Body]) -> list[RotorBody]:
    """Return the rotors among bodies."""
    return [body for body in bodies if isinstance(body, RotorBody)]
