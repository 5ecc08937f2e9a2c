"""Exponents of a linear system with constant or periodic coefficients.

A solution of ``M(θ)ẍ + D(θ)ẋ + K(θ)x = 0`` with θ = Ωt is ``x(t) = exp(λt) p(t)`` with p of the
coefficients' period T. The 2k exponents λ are determined but for multiples of ``i 2π/T``. Sources:
Floquet, Ann. sci. É.N.S. 12 (1883); Hill, Acta Math. 8 (1886); for rotors Friswell, Penny, Garvey,
Lees, Dynamics of Rotating Machines (2010), Sect. 7.

Two independent ways for periodic systems: Hill's method (:mod:`.hill`), of whose copies
``λ + i n 2π/T`` a central one is kept, and the fundamental matrix (:mod:`.fundamental`).
"""

from __future__ import annotations

from contextlib import suppress
from functools import partial

import numpy as np

from exudyn_rotor.linear.periodic.eigenvalues import all_quadratic_modes, resolved
from exudyn_rotor.linear.periodic.floquet_modes import (
    FloquetModes,
    apart_from_free,
    constant_apart_from_free,
    gone,
    one_of_each_family,
)
from exudyn_rotor.linear.periodic.fundamental import floquet_motions
from exudyn_rotor.linear.periodic.harmonics import shifted
from exudyn_rotor.linear.periodic.hill import solve_hill
from exudyn_rotor.linear.periodic.hill_motions import Chosen, HillMotions
from exudyn_rotor.linear.periodic.near_copies import with_near_copies
from exudyn_rotor.linear.periodic.periodic_system import (
    ConstantSystems,
    PeriodicSystem,
    UnconvergedError,
    fold,
)
from exudyn_rotor.linear.periodic.remainder import checked, first_or_again
from exudyn_rotor.linear.periodic.truncation import HillSolution

# distance of exponents, over the base, and cosine of shapes, from which families are conjugate
_SAME_FAMILY, _ALIKE = 1e-3, 0.7
METHODS = ("auto", "floquet", "hill", "eigen")


def exponents(system: PeriodicSystem, method: str = "auto", tolerance: float = 1e-9) -> np.ndarray:
    """Return the 2k exponents of one system [1/s], descending in their real parts.

    Those that rounding cannot tell from zero, as of free rigid motions, are returned as zeros.

    Parameters
    ----------
    system : PeriodicSystem
    method : {'auto', 'floquet', 'hill', 'eigen'}
        See :func:`exudyn_rotor.stability`.
    tolerance : float, optional
        Error of periodic exponents relative to Ω, or to a faster decay; those beyond 100 Ω are
        not waited for.

    Raises
    ------
    ValueError
        For 'eigen' where the system is periodic, and where `tolerance` is not reached.
    """
    values = fold(motions(system, method, tolerance, False).values, abs(system.base))
    return values[descending(values)]


def motions(
    system: PeriodicSystem, method: str = "auto", tolerance: float = 1e-9, shapes: bool = True
) -> FloquetModes:
    """Return the 2k exponents with their motions, in any order; arguments of :func:`exponents`.

    Without `shapes` their vectors may err by rounding, which is faster where the system is
    constant.

    Their imaginary parts are those of the most central copies. By Floquet's method they are known
    but for multiples of the base, and a motion is what it is at θ = 0, as one harmonic.
    """
    check_eigen(system, method)
    if system.stands_still and method != "floquet":
        return constant_motions(ConstantSystems.of([system]), shapes)[0]
    solve = partial(_periodic_motions, method=method, tolerance=tolerance)
    return apart_from_free(system, solve, 2)


def _periodic_motions(system: PeriodicSystem, method: str, tolerance: float) -> FloquetModes:
    """Return what :func:`motions` does of a periodic system that something resists."""
    unconverged = None
    if method != "floquet":
        try:
            found = _solve_by_hill(system, tolerance)
        except UnconvergedError as error:
            unconverged = error
        else:
            rest = found.orders, found.resolution, found.bounds
            return FloquetModes(found.values, found.shapes, *rest)
        if method == "hill":
            raise UnconvergedError(f"{unconverged}, or method='floquet'")
    try:
        values, states, bounds = floquet_motions(system, tolerance)
    except UnconvergedError:
        if unconverged is None:
            raise
        raise unconverged from None  # it says what to do
    shapes = states[None, : system.size]
    return FloquetModes(resolved(values, bounds), shapes, np.array([0]), 0.0, bounds)


def constant_motions(systems: ConstantSystems, shapes: bool = True) -> list[FloquetModes]:
    """Return what :func:`motions` does of systems that do not change in time."""
    solve = partial(all_quadratic_modes, shapes=shapes)
    return constant_apart_from_free(systems, solve, 2)


def descending(values: np.ndarray) -> np.ndarray:
    """Return the order of descending real parts."""
    return np.lexsort((-values.imag, -values.real))


def check_eigen(system: PeriodicSystem, method: str) -> None:
    """Refuse the method 'eigen' where the system is periodic."""
    if method == "eigen" and not system.stands_still:
        raise ValueError(
            f"method='eigen': at {system.speed:g} rad/s the system is periodic (anisotropic "
            "supports or a foundation); use 'auto', 'hill' or 'floquet'"
        )


def _solve_by_hill(system: PeriodicSystem, tolerance: float) -> HillMotions:
    """Return one copy of all exponents with their motions, the most central where it is told.

    Motions that fail the check, of which some are copies of others, are chosen once more: by their
    families, from all harmonics. Before that, and where the check makes bounds larger, those with
    exponents near to copies of others are found with the harmonics of these.
    """

    def check(found: HillMotions) -> HillMotions:
        told, unconverged = None, None
        try:
            told = _checked(system, found, tolerance)
        except UnconvergedError as error:
            unconverged = error
        if told is not None and np.array_equal(told.rounding, found.rounding):
            return told
        wider = with_near_copies(system, found)
        if wider is not None:
            with suppress(UnconvergedError):
                again = _checked(system, wider, tolerance)
                if told is None or again.bounds.max() < told.bounds.max():
                    return again
        if told is None:
            raise unconverged
        return told

    chosen = partial(_chosen_by_hill, system, tolerance)
    return first_or_again(chosen, check).with_conjugates()


def _checked(system: PeriodicSystem, found: HillMotions, tolerance: float) -> HillMotions:
    return checked(system, found, gone(found.values, system.speed), tolerance)


def _chosen_by_hill(system: PeriodicSystem, tolerance: float, first: bool) -> HillMotions:
    """Return motions as they are chosen at `first`, or once more."""

    def choose(solution: HillSolution) -> Chosen | None:
        count = 2 * solution.shapes.shape[1]
        if solution.pairs is not None:
            columns = np.arange(count)
        else:
            columns = _central(solution, system.step, count) if first else None
        if columns is None:  # strongly damped motions hardly have a mean harmonic
            columns = one_of_each_family(solution, system.speed)
        if columns is None:
            return None
        columns, paired = _without_conjugates(solution, columns, system.base)
        values = solution.values[columns]
        sizes = _sizes(values, abs(system.speed))
        return Chosen(columns, values, solution.shapes[:, :, columns], sizes, paired)

    return solve_hill(system, choose, tolerance, first)


def _without_conjugates(
    solution: HillSolution, columns: np.ndarray, base: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return columns without those of conjugate families of others, and which others these are.

    Two families that are their own conjugates may share their shape, and are not each other's.
    """
    values, shapes = solution.values[columns], solution.shapes[:, :, columns]
    apart = values - values[:, None].conj()
    steps = np.rint(apart.imag / base)
    near = np.nonzero(np.triu(np.abs(apart - 1j * steps * base) <= _SAME_FAMILY * abs(base)))
    near = np.column_stack(near)[_are_conjugate(shapes, *near, steps[near].astype(int))]
    paired, dropped, alone = np.zeros((3, len(columns)), dtype=bool)
    for one, other in near.tolist():
        if alone[one] or paired[one] or dropped[one] or dropped[other]:
            continue
        if one == other:
            alone[one] = True
        else:
            paired[one], dropped[other] = True, True
    return columns[~dropped], paired[~dropped]


def _are_conjugate(
    shapes: np.ndarray, ones: np.ndarray, others: np.ndarray, steps: np.ndarray
) -> np.ndarray:
    """Return which of some motions, so many steps lower, have the conjugates of others as shape."""
    alike = np.zeros(len(ones), dtype=bool)
    for step in np.unique(steps):
        chosen = steps == step
        conjugate = shifted(shapes[::-1, :, ones[chosen]].conj(), int(step))
        shape = shapes[:, :, others[chosen]]
        sizes = np.linalg.norm(conjugate, axis=(0, 1)) * np.linalg.norm(shape, axis=(0, 1))
        alike[chosen] = np.abs(np.sum(conjugate.conj() * shape, axis=(0, 1))) > _ALIKE * sizes
    return alike


def _sizes(values: np.ndarray, speed: float) -> np.ndarray:
    """Return what the error of each exponent is relative to: Ω, or a faster decay."""
    return np.where(gone(values, speed), np.inf, np.maximum(-values.real, speed))


def _central(solution: HillSolution, step: int, count: int) -> np.ndarray | None:
    """Return which solutions are the most central copies, one of each; None where unclear.

    The mean harmonic of a copy shifts by the step p from copy to copy, so every interval of that
    length holds each exponent once; it begins in the widest gap near −p/2.
    """
    weights = np.sum(np.abs(solution.shapes) ** 2, axis=1)
    means = solution.orders @ weights / np.sum(weights, axis=0)
    inner = np.sort(np.mod(means[np.abs(means) < step], step))
    if inner.size == 0:
        return None
    gaps = np.diff(inner, append=inner[0] + step)
    middles = inner + 0.5 * gaps
    distance = np.abs(np.mod(middles, step) - 0.5 * step)
    end = np.mod(middles[np.argmax(gaps - 0.5 * distance)], step)
    chosen = np.flatnonzero((means > end - step) & (means <= end))
    return chosen if len(chosen) == count else None
