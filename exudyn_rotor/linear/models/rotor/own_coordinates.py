"""Coordinates that supports bring with them: of controllers, of films that remember, of pads.

A controller's coordinates are pairs along (n1, n2). In axes that turn with Ω, a pair with the
inertia μ that stands still has the equations of a point mass beside the rotor,

    μ (q̈ + 2Ω ẽ q̇ − Ω² q),

and what is between rotor and controller turns as any support does: where both control axes are
alike, all coefficients are constant. What films remember are such pairs, too, so that equations
repeat with every half turn, as those of supports do. The tilts of pads stand still; their films act
as supports between the journal and a pad.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from exudyn_rotor.bearings.controlled_support import (
    Controlled,
    ControlledSupport,
    FilmSupport,
    PadSupport,
)
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.models.fourier_terms import join_turning, stacked, turned_terms
from exudyn_rotor.linear.models.links import Element
from exudyn_rotor.linear.models.points import ACROSS
from exudyn_rotor.linear.periodic.periodic_system import Terms
from exudyn_rotor.theory.rotating_axes import axial_skew, into_rotor_frame

Entry = TypeVar("Entry")
_KINDS = ControlledSupport, FilmSupport, PadSupport  # in the order of their coordinates
WORDS = "controller", "voids", "pads"
Sums = tuple[dict[int, np.ndarray], dict[int, np.ndarray], dict[int, np.ndarray]]


@dataclass(frozen=True, eq=False)
class OwnCoordinates:
    """Those of some supports, after the coordinates of everything else.

    Attributes
    ----------
    supports : tuple of ControlledSupport, FilmSupport and PadSupport
        In this order.
    rates : tuple of float
        Speed of the rotor of each, over that of the axes, Ω.
    frame : {1.0, 0.0}
        Whether the axes turn with Ω, or stand still.
    """

    supports: tuple[Controlled, ...] = ()
    rates: tuple[float, ...] = ()
    frame: float = 1.0

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return sum(one.size for one in self.supports)

    @cached_property
    def masses(self) -> np.ndarray:
        """Inertia of every coordinate [kg]."""
        return np.concatenate([np.zeros(0), *(one.masses for one in self.supports)])

    @cached_property
    def turning(self) -> int:
        """Number of coordinates that turn with the axes; they come first."""
        return sum(one.size for one in self.supports if not isinstance(one, PadSupport))

    @property
    def voids(self) -> np.ndarray:
        """Which coordinates are those of voids."""
        films = [i for i, one in enumerate(self.supports) if isinstance(one, FilmSupport)]
        rows = (np.arange(self.size)[self.rows(index)] for index in films)
        return np.concatenate([np.zeros(0, dtype=int), *rows])

    @property
    def varies(self) -> bool:
        """Whether films are among them, which depend on the speed."""
        return not all(isinstance(one, ControlledSupport) for one in self.supports)

    def rows(self, index: int) -> slice:
        """Return where the coordinates of a support are, from the first one of all."""
        start = sum(one.size for one in self.supports[:index])
        return slice(start, start + self.supports[index].size)

    def inertia_terms(self, speed: float) -> tuple[np.ndarray, np.ndarray]:
        """Return damping and stiffness of coordinates that turn, by inertia alone."""
        rate, turning, D, K = self.frame * speed, self.turning, *np.zeros((2, self.size, self.size))
        own, pairs = self.masses[:turning], np.kron(np.eye(turning // 2), axial_skew(3)[:2, :2])
        D[:turning, :turning] = 2.0 * rate * own[:, None] * pairs
        K[:turning, :turning] = -(rate**2) * np.diag(own)
        return D, K

    def between(self, journals: Sequence[Terms], sensed: Sequence[Terms]) -> Sums:
        """Return Fourier terms of damping, stiffness and stiffness per Ω that controllers bring.

        From the motions (3, k) of journals and of what sensors show.
        """
        sums = {}, {}, {}
        for index, one in enumerate(self.supports):
            if isinstance(one, ControlledSupport):
                K = one.stiffness.copy()
                K[:2, :2] = 0.0  # a support beside it
                ends = [journals[index], sensed[index]]
                self._join_pairs(sums, index, (one.damping, K), ends)
        return sums

    def films(self, speed: float, journals: Sequence[Terms]) -> Sums:
        """Return what :meth:`between` does of films, at a speed Ω [rad/s]."""
        sums = {}, {}, {}
        for index, one in enumerate(self.supports):
            if isinstance(one, FilmSupport):
                matrices = one.matrices(self.rates[index] * speed)
                self._join_pairs(sums, index, matrices, [journals[index]])
            if not isinstance(one, PadSupport):
                continue
            own = self._selected(index, journals[index])
            for film, tangent, row in zip(one.films, one.tangents, own, strict=True):
                seen, t = dict(journals[index]), np.array([*tangent, 0.0])
                for n, turned in (into_rotor_frame(t) if self.frame else {0: t}).items():
                    seen[n] = seen.get(n, 0.0) - np.outer(turned, row)
                end = (("", one.interface),)
                parts = Element(end, film, 0.0, self.rates[index], self.frame).parts(speed)
                cut = tuple({n: X[:3, :3] for n, X in part.items()} for part in parts)
                join_turning(sums, cut, seen)
        return sums

    def _join_pairs(
        self,
        sums: Sums,
        index: int,
        matrices: tuple[np.ndarray, np.ndarray],
        ends: Sequence[Terms],
    ) -> None:
        """Add damping and stiffness between ends, motions (3, k), and own pairs of coordinates."""
        pairs = self._selected(index, ends[0])
        own = np.kron(np.eye(len(pairs) // 2), ACROSS) @ pairs
        lifted = np.kron(np.eye(len(matrices[0]) // 2), ACROSS)
        D, K = (lifted @ X @ lifted.T for X in matrices)
        turning = self.frame * D @ axial_skew(len(D))
        where = self.supports[index].interface
        parts = tuple(turned_terms(X, self.frame, where) for X in (D, K, turning))
        join_turning(sums, parts, stacked([*ends, {0: own}]))

    def _selected(self, index: int, motion: Terms) -> np.ndarray:
        """Return the coordinates of a support as rows of all."""
        count = next(iter(motion.values())).shape[1]
        return np.eye(count)[count - self.size :][self.rows(index)]


def places(one: Controlled, stiffness: object) -> tuple[Support, Support]:
    """Return plain supports where one acts, with a stiffness, and where its sensors are."""
    return Support(one.interface, stiffness), Support(one.sensor)


def in_order(
    supports: Iterable[Entry], support_of: Callable[[Entry], Controlled] = lambda one: one
) -> list[Entry]:
    """Return supports, or what holds them, in the order of their coordinates."""
    return sorted(supports, key=lambda one: _KINDS.index(type(support_of(one))))


def word_of(one: Controlled) -> str:
    """Return what the coordinates of a support are those of, one of :data:`WORDS`."""
    return WORDS[_KINDS.index(type(one))]


def names_of_own(supports: Iterable[tuple[str, str, int]]) -> tuple[str, ...]:
    """Return the names of own coordinates, given their words, interfaces and sizes."""
    return tuple(
        f"{word} {index} at {interface}, {number}"
        for index, (word, interface, size) in enumerate(supports, 1)
        for number in range(1, size + 1)
    )
