"""All motions of one truncation of Hill's equations.

Coefficients of the one harmonic ±p couple every second of the harmonics ``±p/2, ±3p/2 …`` with one
another as those of ``0, ±p …``, for copies ``λ + i ½pΩ`` of the same motions. The harmonics ±p/2
alone hold as much of a motion as two of three harmonics −p, 0, p, for a third of their cost: what
is seen from outside as one harmonic, as all lateral motions of an axisymmetric rotor, is complete.
But of each family they have, beside a copy with both, one that lacks its other half; what excites
the harmonics left out tells these apart.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from exudyn_rotor.linear.periodic.companion import Companion
from exudyn_rotor.linear.periodic.eigenvalues import resolution_of, resolved
from exudyn_rotor.linear.periodic.families import one_of_each_pair
from exudyn_rotor.linear.periodic.harmonics import (
    excitation,
    feedback,
    hill_matrices,
    in_basis,
    real_basis,
    spacing,
)
from exudyn_rotor.linear.periodic.hill_motions import Chosen, HillMotions
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem

# difference of shares that rounding leaves
_TIE = 1e-6
# relative coupling of harmonics below which rounding mixes copies of a motion
_WEAK = 1e-8


@dataclass(frozen=True, eq=False)
class HillSolution:
    """Motions ``exp(λt) Σ_m X_m exp(i m Ω t)`` of one truncation.

    Attributes
    ----------
    values : ndarray, shape (j,)
        λ [1/s].
    shapes : ndarray, shape (h, c, j)
        Harmonics X_m.
    states : ndarray, shape (2 h c, j)
        The same as vectors of the companion form in cosine and sine terms, of unit length.
    orders : ndarray of int, shape (h,)
    resolution : float
        Eigenvalues closer than this cannot be told apart [1/s].
    bounds : ndarray, shape (j,)
        By how much rounding can change the real parts [1/s].
    pairs : tuple of ndarray, optional
        What :func:`families.one_of_each_pair` gives where each family is there once.
    """

    values: np.ndarray
    shapes: np.ndarray
    states: np.ndarray
    orders: np.ndarray
    resolution: float
    bounds: np.ndarray
    pairs: tuple[np.ndarray, np.ndarray] | None = None

    @property
    def step(self) -> int:
        """Of the harmonics."""
        return spacing(self.orders)


@dataclass(frozen=True, eq=False)
class Truncation:
    """What a truncation has to choose from, and where that is in it.

    Attributes
    ----------
    companion : Companion
    solution : HillSolution
        To choose from.
    own : HillSolution
        Of the companion form; the same, or with harmonics ±p/2.
    columns, sides : ndarray of int, shape (j,)
        Where the motions of `solution` are in `own`, and by how many p/2 their harmonics have been
        raised.
    """

    companion: Companion
    solution: HillSolution
    own: HillSolution
    columns: np.ndarray
    sides: np.ndarray

    @classmethod
    def of(cls, system: PeriodicSystem, orders: np.ndarray) -> Truncation:
        """Return the truncation with some harmonics, symmetric about zero."""
        companion, solution = _solved(system, orders)
        count = len(solution.values)
        return cls(companion, solution, solution, np.arange(count), np.zeros(count, dtype=int))

    @classmethod
    def halfway(cls, system: PeriodicSystem) -> Truncation | None:
        """Return the harmonics ±p/2; None where they do not do, or some family is not told."""
        if system.step != 2 or system.order != 2 or _is_weak(system):
            return None
        companion, own = _solved(system, np.array([-1, 1]))
        lengths = np.linalg.norm(own.shapes.reshape(-1, len(own.values)), axis=0)
        upper = np.flatnonzero(own.values.imag >= 0.0)
        left_out = np.linalg.norm(excitation(system, own.values, own.shapes, own.orders), axis=0)
        inertia = np.maximum(np.abs(own.values) + abs(system.speed), own.resolution) * lengths
        ranked = upper[np.argsort((left_out / inertia)[upper])]
        # copies of real exponents, whose vectors may be complex where they are repeated
        real = np.abs(np.abs(own.values.imag) - abs(system.speed)) <= own.resolution
        found, alone = one_of_each_pair(
            own.values, own.shapes / lengths, ranked, system.base, own.resolution, real
        )
        if found is None:
            return None
        columns = _with_conjugates(own, found, alone, system.speed)
        sides = _sides(own, columns, system.speed)
        central = _central(own, columns, sides, companion, system)
        firsts = np.cumsum(np.where(alone, 1, 2)) - np.where(alone, 1, 2)
        return cls(companion, replace(central, pairs=(firsts, alone)), own, columns, sides)

    def motions(self, system: PeriodicSystem, chosen: Chosen) -> HillMotions:
        """Return chosen motions with what the first harmonics left out are and do."""
        own, columns, sides = self.own, self.columns[chosen.columns], self.sides[chosen.columns]
        shapes = own.shapes[:, :, columns]
        load, outer = feedback(system, own.values[columns], shapes, own.orders)
        load = np.einsum("nh,hkj->nkj", real_basis(len(own.orders)), load)
        given = self.solution.shapes[:, :, chosen.columns]
        scale = np.sum(given.conj() * chosen.shapes, axis=(0, 1))
        scale = scale / np.sum(np.abs(given) ** 2, axis=(0, 1))
        outer, shapes = {n: scale * X for n, X in outer.items()}, chosen.shapes
        if own is not self.solution:
            outer, shapes = _raised(outer, shapes, sides)
        return HillMotions(
            chosen.values,
            shapes,
            self.solution.orders,
            chosen.sizes,
            own.resolution,
            own.bounds[columns],
            self.companion.shifts(load.reshape(-1, len(columns)), columns),
            outer,
            chosen.paired,
        )


def _is_weak(system: PeriodicSystem) -> bool:
    """Return whether the harmonics are hardly coupled, as on supports that are nearly isotropic."""
    for terms in (system.D, system.K):
        outer = sum(np.linalg.norm(X) for n, X in terms.items() if n != 0)
        if outer > _WEAK * np.linalg.norm(terms.get(0, 0.0)):
            return False
    return True


def _with_conjugates(
    own: HillSolution, found: np.ndarray, alone: np.ndarray, speed: float
) -> np.ndarray:
    """Return columns with those of other conjugates behind, which are next to them.

    Of central copies those with a positive frequency come first.
    """
    frequencies = own.values[found].imag - _sides(own, found, speed) * speed
    below = ~alone & (frequencies < 0.0)
    pairs = np.column_stack([found + below, found + ~below])
    return pairs[np.column_stack([np.ones_like(alone), ~alone])]


def _sides(own: HillSolution, columns: np.ndarray, speed: float) -> np.ndarray:
    """Return where harmonics ±1 go, −1 or 1, so that the stronger one becomes the harmonic 0.

    Of two that are as strong as each other, the one with the lower frequency.
    """
    low, high = (np.sum(np.abs(X[:, columns]) ** 2, axis=0) for X in own.shapes)
    stronger = np.where(np.abs(low - high) > _TIE * (low + high), low - high, 0.0)
    slower = np.where(own.values[columns].imag * speed < 0.0, -1, 1)
    return np.where(stronger == 0.0, slower, np.sign(stronger)).astype(int)


def _central(
    own: HillSolution,
    columns: np.ndarray,
    sides: np.ndarray,
    companion: Companion,
    system: PeriodicSystem,
) -> HillSolution:
    """Return motions of the harmonics ±1 as copies with the harmonics −2, 0 and 2."""
    low, high = own.shapes[:, :, columns]
    nothing = np.zeros_like(low)
    up = sides > 0
    shapes = np.stack(
        [np.where(up, nothing, low), np.where(up, low, high), np.where(up, high, nothing)]
    )
    values = own.values[columns] - 1j * sides * system.speed
    # copies of a free motion are split by no more than what cannot be told apart
    errors = np.minimum(companion.errors[0][columns], own.resolution)
    return HillSolution(
        resolved(values, errors),
        shapes,
        own.states[:, columns],
        np.array([-2, 0, 2]),
        own.resolution,
        own.bounds[columns],
    )


def _raised(
    outer: dict[int, np.ndarray], shapes: np.ndarray, sides: np.ndarray
) -> tuple[dict[int, np.ndarray], np.ndarray]:
    """Return the harmonics ±3 beside ±1 as those beside −2, 0, 2; one of each is among these."""
    up, nothing = sides > 0, np.zeros_like(shapes[0])
    below, above = (outer.get(n, nothing) for n in (-3, 3))
    shapes = shapes + np.stack(
        [np.where(up, below, nothing), nothing, np.where(up, nothing, above)]
    )
    return {-4: np.where(up, nothing, below), 4: np.where(up, above, nothing)}, shapes


def _solved(system: PeriodicSystem, orders: np.ndarray) -> tuple[Companion, HillSolution]:
    """Return all motions of one truncation."""
    u = real_basis(len(orders))
    matrices = (in_basis(X, u) for X in hill_matrices(system, orders))
    companion = Companion.of(*matrices, system.rounding)
    values, states = companion.modes()
    errors, bounds = companion.errors
    half = len(states) // 2
    shapes = np.einsum("nh,nkj->hkj", u.conj(), states[:half].reshape(len(orders), -1, 2 * half))
    resolution = resolution_of(values)
    # what is beyond that would be taken for another copy
    values = resolved(values, np.minimum(errors, resolution))
    return companion, HillSolution(values, shapes, states, orders, resolution, bounds)
