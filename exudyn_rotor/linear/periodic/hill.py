"""Hill's method: a periodic system as a constant one for the harmonics of its solution.

With ``x(t) = exp(λt) Σ_m X_m exp(i m Ω t)`` the equations of :class:`PeriodicSystem` become, for
every harmonic n,

    Σ_m [(λ + imΩ)² M_{n−m} + (λ + imΩ) D_{n−m} + K_{n−m}] X_m = F_n

which is a constant quadratic problem in λ, cut off at |m| ≤ N. Each exponent λ returns in copies
``λ + i n pΩ`` with shifted harmonics, p the step of the coefficients' harmonics; who asks chooses
among them. Harmonics are added until those left out, excited by a chosen motion, would shift its λ
by less than a tolerance. Source: Hill, "On the part of the motion of the lunar perigee …", Acta
Math. 8 (1886).
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace

import numpy as np
import scipy.linalg as la

from exudyn_rotor.linear.periodic.harmonics import feedback, shifted, slopes
from exudyn_rotor.linear.periodic.hill_motions import Chosen, HillMotions
from exudyn_rotor.linear.periodic.inverse_iteration import settled
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, UnconvergedError
from exudyn_rotor.linear.periodic.truncation import HillSolution, Truncation

MOST_UNKNOWNS = 1600  # in first-order form, beyond the first two harmonics
# times as many up to this many steps of harmonics, which models of 100 to 200 coordinates need: by
# Floquet's method their fast motions take longer still
_MORE_OF_FEW, _FEW = 2.25, 4
_FOLLOWED = 4  # times as many where motions follow, which costs solutions of linear equations alone
# error of λ, as a share of its distance from the next copy, from which a motion is followed
_NEAR = 1e-2
# times its estimate that a change of λ by further harmonics may be
_MORE = 30.0
# share of the tolerance up to which the smallest truncation will do
_FIRST = 1e-2
# and up to which a larger one will, where other motions need one still larger
_ALMOST = 0.1
# relative step of λ after which inverse iteration ends
_SETTLED = 1e-6
# relative distance of exponents, and cosine of shapes, that may be those of one motion
_SAME, _ALIKE = 1e-6, 0.7
_OF_DISTANCE = 1e-3  # of the next exponent: such a step, too
# unknowns of a truncation that is not solved before motions are sought by slow ones, what a mode
# has to have of a motion to be among these, and the share of the base that their exponents may err
_LONG, _SHARE, _NEAR_COPY = 800, 1e-3, 0.1
Choice = Callable[[HillSolution], Chosen | None]


def solve_hill(
    system: PeriodicSystem, choose: Choice, tolerance: float, first: bool = True
) -> HillMotions:
    """Return motions of truncations that are large enough for them.

    All are chosen from one truncation; those that lack harmonics then follow into larger ones by
    inverse iteration. If two of them become one, a larger truncation is solved as a whole.

    Parameters
    ----------
    system : PeriodicSystem
        With periodic coefficients, at a speed that is not zero.
    choose : callable
        Chooses from the motions of a truncation; None where it is too small to tell.
    tolerance : float
        Largest error of a λ, relative to :attr:`Chosen.sizes`.
    first : bool, optional
        Whether to try ways that may lose motions, which only a check tells: that of
        :meth:`.Truncation.halfway`, and that by slow motions.

    Raises
    ------
    UnconvergedError
        If that takes more than 1600 unknowns and further harmonics than two steps, or 3600 up to
        four; where motions follow, four times as many unknowns and harmonics.
    """
    order = system.step
    truncation = Truncation.halfway(system) if first else None
    if truncation is not None:
        with suppress(UnconvergedError):  # by motions that it does not have
            followed, _ = _chosen(system, truncation, choose, tolerance)
            if followed is not None:
                return followed
    while True:
        truncation = Truncation.of(system, system.harmonics(order))
        followed, motions = _chosen(system, truncation, choose, tolerance)
        if followed is None and motions is not None and first and _takes_long(system, order):
            with suppress(UnconvergedError):
                followed = _by_slow_motions(system, motions, choose, tolerance)
        if followed is not None:
            return followed
        order = _next(system, order, np.inf if motions is None else motions.error, tolerance)


def _chosen(
    system: PeriodicSystem, truncation: Truncation, choose: Choice, tolerance: float
) -> tuple[HillMotions | None, HillMotions | None]:
    """Return motions chosen from a truncation as followed into larger ones, and as they are there.

    None where it is too small for that.
    """
    chosen = choose(truncation.solution)
    if chosen is None:
        return None, None
    motions = truncation.motions(system, chosen)
    near = np.all(_are_near(system, motions))
    return _followed(system, motions, tolerance) if near else None, motions


def _larger(system: PeriodicSystem, order: int) -> int:
    """Return the highest harmonic of the truncation after one."""
    return order + system.step * max(1, order // (2 * system.step))


def _takes_long(system: PeriodicSystem, order: int) -> bool:
    """Return whether the truncation after one with harmonics up to `order` takes long."""
    return 2 * len(system.harmonics(_larger(system, order))) * system.size > _LONG


def _next(
    system: PeriodicSystem, order: int, error: float, tolerance: float, times: int = 1
) -> int:
    """Return the highest harmonic of the next truncation; limits are so many `times` as large."""
    step = system.step
    larger = _larger(system, order)
    most = times * MOST_UNKNOWNS * (_MORE_OF_FEW if larger <= times * _FEW * step else 1.0)
    if larger == 2 * step or 2 * len(system.harmonics(larger)) * system.size <= most:
        return larger
    raise UnconvergedError(
        f"Hill's method at {system.speed:g} rad/s: error {error:.1e} with harmonics up to "
        f"{order}, more than the tolerance {tolerance:.1e}: the speed is small against the "
        "frequencies that turning coefficients split; use a larger speed (or 0), or fewer "
        "high modes"
    )


def _are_near(system: PeriodicSystem, motions: HillMotions) -> np.ndarray:
    """Return which motions can be followed; those whose error does not count always can."""
    near = np.abs(motions.shifts) <= _NEAR * abs(system.base)
    return near | np.isinf(motions.sizes)


def _by_slow_motions(
    system: PeriodicSystem, motions: HillMotions, choose: Choice, tolerance: float
) -> HillMotions | None:
    """Return motions of a truncation, those that lack harmonics by way of a part of coordinates.

    They are, but for little, in some modes of the mean coefficients: these alone can be solved for
    with many more harmonics. From what that gives, inverse iteration finds motions of all
    coordinates. None where one is lost or found twice, and where none lacks harmonics.
    """
    near = _are_near(system, motions)
    if np.all(near):  # two of them became one on the way into larger truncations
        return None
    basis = _modes_of(system, motions.shapes[..., ~near])
    if 2 * basis.shape[1] > system.size:
        return None
    known = _followed(system, motions.columns(np.flatnonzero(near)), tolerance)
    if known is None:
        return None
    slow = solve_hill(system.projected(basis), choose, tolerance, first=False)
    slow = replace(
        slow,
        shapes=np.einsum("ka,haj->hkj", basis, slow.shapes),
        outer={n: basis @ X for n, X in slow.outer.items()},
        rounding=np.full(len(slow.values), motions.rounding.max()),
        resolution=motions.resolution,
    )
    known, slow = _with_alike_orders(known, slow)
    every = known.with_conjugates()
    missing = 2 * system.size - len(every.values)
    order = np.argsort(_likeness(slow, every, system.base))
    counts = np.cumsum(1 + slow.paired[order])
    if missing not in counts:
        return None
    slow = _in_all(system, slow.columns(order[: np.flatnonzero(counts == missing)[0] + 1]))
    slow = None if slow is None else _followed(system, slow, tolerance)
    if slow is None:
        return None
    every = _joined(*_with_alike_orders(known, slow))
    columns = np.arange(len(known.values), len(every.values))
    return every if differ(every, columns, system.base) else None


def _modes_of(system: PeriodicSystem, shapes: np.ndarray) -> np.ndarray:
    """Return the modes (k, r) of the mean coefficients in which motions (h, k, j) are."""
    M, K = system.M[0].real, system.K[0].real
    _, modes = la.eigh(0.5 * (K + K.T), M)
    amounts = np.abs(np.einsum("ka,hkj->haj", M @ modes, shapes))
    shares = np.max(amounts / np.linalg.norm(amounts, axis=(0, 1)), axis=(0, 2))
    return modes[:, shares > _SHARE]


def _likeness(motions: HillMotions, others: HillMotions, base: float) -> np.ndarray:
    """Return the largest cosine of each motion with copies of others, with exponents near it."""
    apart = motions.values[:, None] - others.values
    steps = np.rint(apart.imag / base).astype(int)
    near = np.abs(apart - 1j * steps * base) <= _NEAR_COPY * abs(base)
    result = np.zeros(len(motions.values))
    for row, other in zip(*np.nonzero(near), strict=True):
        one = motions.shapes[:, :, row]
        copy = shifted(others.shapes[:, :, other], int(steps[row, other]))
        cosine = abs(np.vdot(copy, one)) / max(np.linalg.norm(copy) * np.linalg.norm(one), 1e-300)
        result[row] = max(result[row], cosine)
    return result


def _in_all(system: PeriodicSystem, slow: HillMotions) -> HillMotions | None:
    """Return motions of all coordinates from those of some; None where one is lost."""
    limits = _SETTLED * np.minimum(slow.sizes, abs(system.base))
    found = settled(system, slow.orders, slow.values, slow.shapes, limits)
    if found is None:
        return None
    found = _closer(system, slow, found, _distances(slow, found[0], system.base), limits)
    values, shapes, lefts = found
    alike = np.abs(np.sum(shapes.conj() * slow.shapes, axis=(0, 1)))
    if not np.all(alike >= _ALIKE * np.sqrt(_squares(slow.shapes))):
        return None
    shifts, outer = _left_out(system, values, shapes, lefts, slow.orders)
    return replace(slow, values=values, shapes=shapes, shifts=shifts, outer=outer)


def _with_alike_orders(*motions: HillMotions) -> list[HillMotions]:
    """Return motions with as many harmonics as those of them that have most."""
    orders = max((each.orders for each in motions), key=len)
    return [replace(each, shapes=_widened(each, orders), orders=orders) for each in motions]


def _joined(one: HillMotions, other: HillMotions) -> HillMotions:
    """Return the motions of both, which have the same harmonics."""
    names = ("values", "shapes", "sizes", "rounding", "shifts", "paired")
    both = {n: np.concatenate([getattr(X, n) for X in (one, other)], axis=-1) for n in names}
    return replace(one, outer={}, **both)


def _followed(system: PeriodicSystem, motions: HillMotions, tolerance: float) -> HillMotions | None:
    """Return motions with as many harmonics as they need; None where they cannot be followed."""
    # its estimate does not see the further harmonics that the first ones left out bring along
    limit = (_FIRST if motions.orders[-1] == system.step else 1.0) * tolerance
    while motions.error > limit:
        order = _next(system, int(motions.orders[-1]), motions.error, tolerance, _FOLLOWED)
        lacking = np.flatnonzero(motions.errors > min(limit, _ALMOST * tolerance))
        larger = in_larger(system, motions, lacking, system.harmonics(order))
        if larger is None or not differ(larger, lacking, system.base):
            return None
        motions, limit = larger, tolerance
    if motions.orders[-1] == system.step:
        orders = system.harmonics(2 * system.step)
        motions = replace(motions, shapes=_widened(motions, orders), orders=orders)
    return motions


def _widened(motions: HillMotions, orders: np.ndarray) -> np.ndarray:
    """Return harmonics of the motions in a larger truncation, with the first ones left out."""
    wider = (len(orders) - len(motions.orders)) // 2
    shapes = np.zeros((len(orders), *motions.shapes.shape[1:]), dtype=complex)
    shapes[wider : len(orders) - wider] = motions.shapes
    for order, answer in motions.outer.items():
        if order in orders:
            shapes[np.flatnonzero(orders == order)] = answer
    return shapes


def _squares(shapes: np.ndarray) -> np.ndarray:
    """Return the squared length of each motion (h, c, j)."""
    return np.sum(np.abs(shapes) ** 2, axis=(0, 1))


def in_larger(
    system: PeriodicSystem, motions: HillMotions, lacking: np.ndarray, orders: np.ndarray
) -> HillMotions | None:
    """Return the motions in a larger truncation, those `lacking` harmonics by inverse iteration."""
    shapes, lengths = _widened(motions, orders), np.sqrt(_squares(motions.shapes))[lacking]
    values, shifts = motions.values.astype(complex), motions.shifts
    start, guess = shapes[..., lacking], values[lacking] + shifts[lacking]
    limits = _SETTLED * np.minimum(motions.sizes[lacking], abs(system.base))
    found = settled(system, orders, guess, start, limits)
    if found is None:
        return None
    values[lacking] = found[0]
    distances = _distances(motions, values, system.base)[lacking]
    few = replace(motions.columns(lacking), orders=orders)
    values[lacking], x, lefts = _closer(system, few, found, distances, limits)
    alike = np.sum(x.conj() * start, axis=(0, 1))
    near = np.abs(values[lacking] - guess) <= _MORE * np.abs(shifts[lacking]) + limits
    if not np.all(near & (np.abs(alike) >= _ALIKE * np.sqrt(_squares(start)))):
        return None
    shapes[..., lacking] = lengths * alike / np.abs(alike) * x
    shifts = shifts.copy()
    shifts[lacking], outer = _left_out(system, values[lacking], shapes[..., lacking], lefts, orders)
    every = {n: np.zeros((system.size, len(values)), dtype=complex) for n in outer}
    for n, answer in outer.items():
        every[n][:, lacking] = answer
    changed = {"values": values, "shapes": shapes, "shifts": shifts, "outer": every}
    return replace(motions, orders=orders, **changed)


def _distances(motions: HillMotions, values: np.ndarray, base: float) -> np.ndarray:
    """Return the distance of each of `values` to the next one of another family [1/s]."""
    apart = values[:, None] - np.append(values, values[motions.paired].conj())
    apart = np.abs(apart - 1j * base * np.rint(apart.imag / base))
    np.fill_diagonal(apart, np.inf)
    return apart.min(axis=1)


def _closer(
    system: PeriodicSystem,
    motions: HillMotions,
    found: tuple[np.ndarray, np.ndarray, np.ndarray],
    distances: np.ndarray,
    limits: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return what :func:`settled` found, those closer whose steps are not small beside distances.

    There the convergence is not cubic yet. Those that rounding keeps from that stay as they are.
    """
    finer = np.maximum(_OF_DISTANCE * distances, motions.rounding)
    near = np.flatnonzero(finer < limits)
    if not near.size:
        return found
    values, shapes, _ = found
    again = settled(system, motions.orders, values[near], shapes[..., near], finer[near])
    if again is None:
        return found
    kept = np.abs(again[0] - values[near]) < 0.5 * distances[near]
    for known, better in zip(found, again, strict=True):
        known[..., near[kept]] = better[..., kept]
    return found


def _left_out(
    system: PeriodicSystem,
    values: np.ndarray,
    shapes: np.ndarray,
    lefts: np.ndarray,
    orders: np.ndarray,
) -> tuple[np.ndarray, dict[int, np.ndarray]]:
    """Return by how much the first harmonics left out change λ, and what they are."""
    load, outer = feedback(system, values, shapes, orders)
    inertia = slopes(system, values, shapes, orders)
    work = [np.sum(lefts.conj() * X, axis=(0, 1)) for X in (load, inertia)]
    return -work[0] / work[1], outer


def differ(motions: HillMotions, columns: np.ndarray, base: float) -> bool:
    """Return True if no motion in `columns` is a copy of another or a conjugate, shifted or not."""
    every = motions.with_conjugates()
    values, shapes = every.values, every.shapes
    apart = values[columns, None] - values
    steps = np.rint(apart.imag / base)
    near = np.abs(apart - 1j * steps * base) <= _SAME * (np.abs(values) + abs(base))
    near[np.arange(columns.size), columns] = False
    for row, other in zip(*np.nonzero(near), strict=True):
        one, copy = shapes[:, :, columns[row]], shifted(shapes[:, :, other], int(steps[row, other]))
        if abs(np.vdot(copy, one)) > _ALIKE * np.linalg.norm(copy) * np.linalg.norm(one):
            return False
    return True
