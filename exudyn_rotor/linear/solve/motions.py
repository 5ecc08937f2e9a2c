"""Motions of linear equations: eigenvalues where these are constant, Floquet exponents else.

The 2k exponents of k coordinates are conjugate pairs and an even number of real ones. One of every
conjugate pair stands for both (Im λ > 0), and of the real ones the less damped half, so that k
motions stand for all. A free motion, which nothing resists, has λ = 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from exudyn_rotor.linear.equations import PeriodicSystem
from exudyn_rotor.linear.solve.floquet import floquet_motions
from exudyn_rotor.linear.solve.hill import Exponents, hill_motions
from exudyn_rotor.linear.solve.state import EPSILON, States, free_directions, others, states_of

METHODS = ("auto", "hill", "floquet")
_ROUNDING = 20.0 * EPSILON  # of the size of a state matrix: what a real part may be off by
_REAL = 1e-9  # share of |λ|: a frequency that is rounding


@dataclass(frozen=True, eq=False)
class Motions:
    """Motions ``exp(λt) Σ_m X_m exp(imΩt)`` at one speed.

    Attributes
    ----------
    speed : float
        Ω [rad/s].
    values : ndarray of complex, shape (k,)
        λ [1/s], Im λ ≥ 0 but for motions of periodic equations; NaN where it did not converge.
    vectors : ndarray of complex, shape (h, c, k)
        Harmonics X_m, all together of unit length.
    orders : ndarray of int, shape (h,)
        The harmonics m; only 0 of constant equations.
    bound : float
        By how much rounding can change a real part [1/s].
    """

    speed: float
    values: np.ndarray
    vectors: np.ndarray
    orders: np.ndarray
    bound: float

    def columns(self, chosen: np.ndarray) -> Motions:
        """Return some of the motions."""
        return Motions(
            self.speed, self.values[chosen], self.vectors[:, :, chosen], self.orders, self.bound
        )

    @property
    def main(self) -> np.ndarray:
        """The largest harmonic of every motion, shape (c, k)."""
        strongest = np.argmax(np.linalg.norm(self.vectors, axis=1), axis=0)
        return np.take_along_axis(self.vectors, strongest[None, None], axis=0)[0]


def motions_of(
    systems: Sequence[PeriodicSystem | None],
    method: str = "auto",
    tolerance: float = 1e-6,
    *,
    least_stable: bool = False,
) -> list[Motions | None]:
    """Return the motions of systems of the same coordinates; None where a system is None.

    Parameters
    ----------
    systems : sequence of PeriodicSystem or None
    method : {'auto', 'hill', 'floquet'}
        For periodic equations: harmonics, or the monodromy matrix.
    tolerance : float
        Largest relative error of λ by harmonics that are left out.
    least_stable : bool
        Whether harmonics need to suffice for the least stable motion only.
    """
    known = [system for system in systems if system is not None]
    if not known:
        return [None] * len(systems)
    reduced, free, basis = _resisted(known)
    solved = iter(_solved(reduced, method, tolerance, least_stable))
    if basis is not None:
        solved = (_beside(found, free, basis) for found in solved)
    return [None if system is None else next(solved) for system in systems]


def margins_of(
    systems: Sequence[PeriodicSystem], method: str = "auto", tolerance: float = 1e-6
) -> list[float]:
    """Return by how much the least stable motion of each system grows beyond its bound [1/s].

    Of motions that are not neutral; less the bound where all are. The same as from
    :func:`motions_of` for the least stable motion, of constant equations without shapes.
    """
    reduced, _, _ = _resisted(systems)
    found = [-0.0] * len(systems)
    constant = [i for i, s in enumerate(reduced) if s.is_constant and s.size]
    if constant:
        made = [states_of(reduced[i]) for i in constant]
        for i, values, each in zip(
            constant, np.linalg.eigvals(np.stack([each.A[0] for each in made])), made, strict=True
        ):
            found[i] = _margin(values, _bound(each))
    rest = [i for i, s in enumerate(reduced) if not s.is_constant and s.size]
    solved = _solved([reduced[i] for i in rest], method, tolerance, least_stable=True)
    for i, each in zip(rest, solved, strict=True):
        found[i] = _margin(each.values, each.bound)
    return found


def _margin(values: np.ndarray, bound: float) -> float:
    growth = values.real[np.abs(values.real) > bound]
    return float(growth.max(initial=0.0 if not growth.size else -np.inf) - bound)


def _resisted(
    systems: Sequence[PeriodicSystem],
) -> tuple[list[PeriodicSystem], np.ndarray, np.ndarray | None]:
    """Return systems without what nothing resists at any of them, those motions, and a basis."""
    free = free_directions([systems[0], systems[-1]] if len(systems) > 1 else [systems[0]])
    if not free.shape[1]:
        return list(systems), free, None
    basis = others(free, systems[0].M)
    return [system.projected(basis) for system in systems], free, basis


def _solved(
    systems: list[PeriodicSystem], method: str, tolerance: float, least_stable: bool = False
) -> list[Motions]:
    """Return the motions of each system that something resists everywhere."""
    made = [states_of(system) for system in systems]
    found: list[Motions | None] = [None] * len(systems)
    constant = [i for i, system in enumerate(systems) if system.is_constant]
    if constant and systems[0].size:
        matrices = np.stack([made[i].A[0] for i in constant])
        for i, values, vectors in zip(constant, *np.linalg.eig(matrices), strict=True):
            found[i] = _constant(systems[i].speed, values, vectors, made[i])
    size = 0
    for i, system in enumerate(systems):
        if found[i] is not None:
            continue
        if not system.size:
            none = np.zeros((1, 0, 0), dtype=complex)
            found[i] = Motions(system.speed, none[0, 0], none, np.array([0]), 0.0)
            continue
        if method == "floquet":
            exponents = floquet_motions(system, made[i])
        else:
            neutral = _bound(made[i]) if least_stable else None
            exponents, size = hill_motions(system, made[i], tolerance, size, neutral)
        found[i] = _periodic(system.speed, exponents, made[i])
    return found


def _bound(made: States) -> float:
    sizes = (np.linalg.norm(X, 1) * np.linalg.norm(X, np.inf) for X in made.A.values())
    return float(_ROUNDING * np.sum(np.sqrt(list(sizes))))


def _constant(speed: float, values: np.ndarray, vectors: np.ndarray, made: States) -> Motions:
    chosen = one_of_each_pair(values)
    shapes = made.shape @ vectors[:, chosen]
    shapes = shapes / np.linalg.norm(shapes, axis=0)
    return Motions(speed, values[chosen], shapes[None], np.array([0]), _bound(made))


def one_of_each_pair(values: np.ndarray) -> np.ndarray:
    """Return which of 2k eigenvalues of a real matrix stand for all, k, ascending in frequency."""
    count = len(values) // 2
    real = np.abs(values.imag) <= _REAL * np.abs(values.real)
    upper = np.flatnonzero(~real & (values.imag > 0.0))
    single = np.flatnonzero(real)
    single = single[np.argsort(-values[single].real, kind="stable")]
    chosen = np.r_[upper, single[: count - len(upper)]]
    return chosen[np.lexsort((values[chosen].real, np.abs(values[chosen].imag)))]


def _periodic(speed: float, found: Exponents, made: States) -> Motions:
    """Return motions in ascending order, in the coordinates of the system."""
    vectors = made.shape @ found.states
    sizes = np.linalg.norm(vectors.reshape(-1, len(found.values)), axis=0)
    vectors = vectors / np.where(sizes > 0.0, sizes, 1.0)
    order = np.lexsort((found.values.real, np.abs(found.values.imag)))
    return Motions(speed, found.values[order], vectors[:, :, order], found.orders, _bound(made))


def _beside(found: Motions, free: np.ndarray, basis: np.ndarray) -> Motions:
    """Return the motions of a basis together with free ones, in all coordinates."""
    vectors = np.einsum("ck,hkj->hcj", basis, found.vectors)
    vectors = vectors / np.linalg.norm(vectors, axis=(0, 1))
    still = np.zeros((len(found.orders), *free.shape), dtype=complex)
    still[list(found.orders).index(0)] = free / np.linalg.norm(free, axis=0)
    values = np.r_[np.zeros(free.shape[1]), found.values]
    joined = np.concatenate([still, vectors], axis=2)
    return Motions(found.speed, values, joined, found.orders, found.bound)


__all__ = ["METHODS", "Motions", "margins_of", "motions_of", "one_of_each_pair"]
