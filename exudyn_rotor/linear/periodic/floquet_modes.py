"""Modes of linear equations at one spin speed, constant or periodic.

The 2k exponents are conjugate pairs and an even number of real ones. One of every conjugate pair is
returned (Im λ > 0), and of the real ones the less damped half, with one of the two zeros of a free
motion (:func:`.eigenvalues.less_damped`), so that k modes stand for all. Of
each Floquet family ``λ + i p Ω`` the member with the largest central harmonic is taken.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from exudyn_rotor.linear.periodic.eigenvalues import (
    Solved,
    free_motions,
    less_damped,
    merged,
    quadratic_modes,
    repeated,
)
from exudyn_rotor.linear.periodic.families import one_of_each_pair
from exudyn_rotor.linear.periodic.free_directions import FreeDirections, parted
from exudyn_rotor.linear.periodic.fundamental import propagated
from exudyn_rotor.linear.periodic.hill import solve_hill
from exudyn_rotor.linear.periodic.hill_motions import Chosen, HillMotions
from exudyn_rotor.linear.periodic.periodic_system import (
    ConstantSystems,
    PeriodicSystem,
    UnconvergedError,
)
from exudyn_rotor.linear.periodic.remainder import checked, first_or_again
from exudyn_rotor.linear.periodic.truncation import HillSolution

# decay over Ω above which a motion is gone before the coefficients change
_GONE = 100.0
# share of the tolerance where the estimate of what harmonics left out do has been too small
_TIGHTER = 0.1
# times the rounding of exponents within which that of their vectors may mix them
_MIXED = 100.0


@dataclass(frozen=True, eq=False)
class FloquetModes:
    """Motions ``exp(λt) Σ_m X_m exp(i m Ω t)`` of one system, one for every pair of eigenvalues.

    Attributes
    ----------
    values : ndarray, shape (k,)
        λ [1/s], ascending in |Im λ|.
    vectors : ndarray, shape (h, c, k)
        Harmonics X_m of the coordinates, rotor frame; columns of unit Euclidean length.
    orders : ndarray of int, shape (h,)
        The harmonics m; only 0 for a constant system.
    resolution : float
        Eigenvalues closer than this cannot be told apart [1/s].
    bounds : ndarray, shape (k,), optional
        By how much rounding and the harmonics left out can change the real parts [1/s].
    """

    values: np.ndarray
    vectors: np.ndarray
    orders: np.ndarray
    resolution: float
    bounds: np.ndarray | None = None

    @property
    def central(self) -> np.ndarray:
        """The harmonic 0 of every mode, shape (c, k)."""
        return self.vectors[list(self.orders).index(0)]

    def columns(self, chosen: np.ndarray) -> FloquetModes:
        """Return some of the modes."""
        bounds = None if self.bounds is None else self.bounds[chosen]
        values, vectors = self.values[chosen], self.vectors[:, :, chosen]
        return FloquetModes(values, vectors, self.orders, self.resolution, bounds)


def floquet_modes(system: PeriodicSystem, *, tolerance: float = 1e-8) -> FloquetModes:
    """Return one motion for every pair of exponents of a constant or periodic system.

    Parameters
    ----------
    system : PeriodicSystem
    tolerance : float, optional
        Largest error of λ by harmonics that Hill's method leaves out, relative to the larger of
        |λ| and pΩ; motions that decay faster than 100 Ω are not waited for.

    Raises
    ------
    ValueError
        If modes are lost, or the harmonics do not die away.
    """
    if system.stands_still:
        return constant_modes(ConstantSystems.of([system]))[0]
    return apart_from_free(system, partial(_floquet_modes, tolerance=tolerance), 1)


def _floquet_modes(system: PeriodicSystem, tolerance: float) -> FloquetModes:
    """Return what :func:`floquet_modes` does of a periodic system that something resists."""
    try:
        found = _by_hill(system, tolerance)
    except UnconvergedError as unconverged:
        try:
            found = _checked(system, propagated(system, tolerance), tolerance)
        except UnconvergedError:
            raise UnconvergedError(
                f"{unconverged}, or stability(…), which may know exponents without their motions"
            ) from None
    found = found.columns(_for_all(system, found))
    shapes = _with_free_motions(system, found)
    return FloquetModes(found.values, shapes, found.orders, found.resolution, found.bounds)


def _by_hill(system: PeriodicSystem, tolerance: float) -> HillMotions:
    """Return motions by Hill's method; from more harmonics where they fail the check."""
    choose = partial(_one_of_each_family, speed=system.speed)

    def solve(first: bool) -> HillMotions:
        return solve_hill(system, choose, tolerance if first else _TIGHTER * tolerance, first)

    return first_or_again(solve, lambda found: _checked(system, found, tolerance))


def _checked(system: PeriodicSystem, found: HillMotions, tolerance: float) -> HillMotions:
    """Return motions, one for each pair of exponents, that pass the check of all."""
    if len(found.values) + np.count_nonzero(found.paired) != 2 * system.size:
        raise UnconvergedError(f"at {system.speed:g} rad/s: exponents are no pairs")
    return checked(system, found, gone(found.values, system.speed), tolerance)


def gone(values: np.ndarray, speed: float) -> np.ndarray:
    """Return which motions die within a small part of a turn; they need very many harmonics."""
    return -values.real > _GONE * abs(speed)


def constant_modes(systems: ConstantSystems, once: bool = False) -> list[FloquetModes]:
    """Return the motions of systems that do not change in time and have one mass matrix.

    `once` is that of :func:`.eigenvalues.less_damped`.
    """
    return constant_apart_from_free(
        systems, lambda few: quadratic_modes(few.M[0], few.D, few.K, few.rounding, once), 1
    )


def apart_from_free(
    system: PeriodicSystem, solve: Callable[[PeriodicSystem], FloquetModes], copies: int
) -> FloquetModes:
    """Return what `solve` finds of a system without its free directions, and `copies` of these."""
    apart = FreeDirections.of(system)
    if apart is None:
        return solve(system)
    found = solve(system.projected(apart.others))
    bounds = None if found.bounds is None else found.bounds[None]
    center = list(found.orders).index(0)
    given = found.values[None], found.vectors[None], bounds
    (values,), (vectors,), bounds = _beside_free(*given, center, apart, copies)
    bounds = None if bounds is None else bounds[0]
    return FloquetModes(values, vectors, found.orders, found.resolution, bounds)


def constant_apart_from_free(
    systems: ConstantSystems, solve: Callable[[ConstantSystems], Solved], copies: int
) -> list[FloquetModes]:
    """Return as :func:`apart_from_free` of systems that do not change in time.

    `solve` returns what eigenvalue problems give of several of them.
    """
    found: dict[int, FloquetModes] = {}
    for rows, few, apart in parted(systems):
        values, vectors, resolutions, bounds = solve(few)
        vectors = vectors[:, None]
        if apart is not None:
            values, vectors, bounds = _beside_free(values, vectors, bounds, 0, apart, copies)
        each = zip(rows.tolist(), values, vectors, resolutions, bounds, strict=True)
        for row, found_values, found_vectors, *rest in each:
            found[row] = FloquetModes(found_values, found_vectors, np.array([0]), *rest)
    return [found[row] for row in range(len(systems.D))]


def _beside_free(
    values: np.ndarray,
    vectors: np.ndarray,
    bounds: np.ndarray | None,
    center: int,
    apart: FreeDirections,
    copies: int,
) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    """Return motions of all other directions together with `copies` of the free ones.

    Of s systems: values and bounds (s, k), and vectors (s, h, c, k), of which one harmonic is the
    `center`.
    """
    given, count = apart.others @ vectors, copies * apart.free.shape[1]
    joined = np.zeros((*given.shape[:3], count + given.shape[3]), dtype=complex)
    joined[:, center, :, :count] = np.tile(apart.free, copies)
    joined[..., count:] = given / np.linalg.norm(given, axis=(1, 2), keepdims=True)
    none = np.zeros((len(values), count))
    values = np.hstack([none, values])
    order = np.lexsort((values.real, np.abs(values.imag)))
    joined = np.take_along_axis(joined, order[:, None, None], axis=3)
    if bounds is not None:
        bounds = np.take_along_axis(np.hstack([none, bounds]), order, axis=1)
    return np.take_along_axis(values, order, axis=1), joined, bounds


def one_of_each_family(solution: HillSolution, speed: float) -> np.ndarray | None:
    """Return the columns of one motion for each Floquet family; None where some are not found."""
    _, _, columns, alone = _apart(solution, speed)
    if columns is None:
        return None
    return np.concatenate([columns, columns[~alone] + 1])  # conjugates follow each other


def _one_of_each_family(solution: HillSolution, speed: float) -> Chosen | None:
    """Choose one motion for each family and its conjugate; None where some are not found."""
    values, shapes, columns, alone = _apart(solution, speed)
    if columns is None:
        return None
    values = values[columns]
    sizes = np.maximum(np.abs(values), solution.step * abs(speed))
    # what is zero to rounding has no error of truncation that could be told
    sizes[(values == 0.0) | gone(values, speed)] = np.inf
    return Chosen(columns, values, shapes[:, :, columns], sizes, ~alone)


def _for_all(system: PeriodicSystem, found: HillMotions) -> np.ndarray:
    """Return which motions stand for all: of those without a conjugate the less damped half."""
    values, real = found.values, np.flatnonzero(~found.paired)
    ranks = less_damped(values[real][None], system.M[0].real, [_stiffnesses(system)])[0]
    real = real[np.argsort(-ranks, kind="stable")][: len(real) // 2]
    kept = np.concatenate([np.flatnonzero(found.paired), real])
    return kept[np.lexsort((values[kept].real, values[kept].imag))]


def _apart(
    solution: HillSolution, speed: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray | None, np.ndarray]:
    """Return all exponents, unit shapes, and what :func:`families.one_of_each_pair` does."""
    orders, resolution = solution.orders, solution.resolution
    values = merged(solution.values, solution.states, resolution)
    lengths = np.linalg.norm(solution.shapes.reshape(-1, len(values)), axis=0)
    shapes = solution.shapes / lengths
    groups = list(repeated(values, resolution))
    for group in groups:
        mixed = min(resolution, _MIXED * solution.bounds[group].max())
        for few in (group[part] for part in repeated(values[group], mixed)):
            shapes[:, :, few] = _unmixed(shapes[:, :, few], orders)
    if solution.pairs is not None:
        return values, shapes, *solution.pairs
    center = np.flatnonzero(orders == 0)[0]
    # motions in two planes at nearly one frequency are ranked as the waves that they hold together;
    # in ascending order, so that all copies of a family rank as copies of one wave
    waves = shapes.copy()
    for group in groups:
        ascending = group[np.argsort(values[group].imag, kind="stable")]
        waves[:, :, ascending] = _unmixed(shapes[:, :, ascending], orders)
    share = np.sum(np.abs(waves[center]) ** 2, axis=0)
    spread = np.einsum("h,hcj->j", np.abs(orders), np.abs(waves) ** 2)
    upper = np.flatnonzero(values.imag >= 0.0)
    ranked = upper[np.lexsort((spread[upper], -np.round(share[upper], 6)))]
    pairs = one_of_each_pair(values, shapes, ranked, solution.step * speed, resolution)
    return values, shapes, *pairs


def _with_free_motions(system: PeriodicSystem, found: HillMotions) -> np.ndarray:
    """Return the harmonics found, those of free motions as constant displacements without force.

    ``K_n x = 0`` for all Fourier terms n of K: at λ = 0 Hill's equations hold with x alone.
    """
    free = np.flatnonzero(found.values == 0.0)
    if free.size < 2:
        return found.shapes
    center = np.flatnonzero(found.orders == 0)[0]
    given = found.shapes[center][:, free]
    free_ones = free_motions(system.M[0].real, _stiffnesses(system), given)
    if free_ones is given:
        return found.shapes
    shapes = found.shapes.copy()
    shapes[:, :, free] = 0.0
    shapes[center][:, free] = free_ones
    return shapes


def _stiffnesses(system: PeriodicSystem) -> np.ndarray:
    """Return the parts of all Fourier terms of the stiffness, shape (n, k, k)."""
    terms = [term for n, term in system.K.items() if n >= 0]
    return np.array([part for term in terms for part in (term.real, term.imag)])


def _unmixed(vectors: np.ndarray, orders: np.ndarray) -> np.ndarray:
    """Part the copies of different families that share an eigenvalue by their mean harmonic."""
    flat = vectors.reshape(-1, vectors.shape[2])
    span, lengths, _ = np.linalg.svd(flat, full_matrices=False)
    if lengths[-1] < 1e-3 * lengths[0]:  # copies of a defective eigenvalue: one vector only
        return vectors
    shaped = span.reshape(vectors.shape)
    _, turn = np.linalg.eigh(np.einsum("h,hci,hcj->ij", orders, shaped.conj(), shaped))
    return (span @ turn).reshape(vectors.shape)
