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

from exudyn_rotor.linear.periodic.harmonics import feedback, shifted, slopes
from exudyn_rotor.linear.periodic.hill_motions import Chosen, HillMotions
from exudyn_rotor.linear.periodic.inverse_iteration import settled
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, UnconvergedError
from exudyn_rotor.linear.periodic.truncation import HillSolution, Truncation

MOST_UNKNOWNS = 1600  # in first-order form, beyond the first two harmonics
# times as many up to this many steps of harmonics, which models of 100 to 200 coordinates need: by
# Floquet's method their fast motions take longer still
_MORE_OF_FEW, _FEW = 2.25, 4
_FOLLOWED = 2  # times as many where motions follow, which costs solutions of linear equations alone
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
Choice = Callable[[HillSolution], Chosen | None]


def solve_hill(
    system: PeriodicSystem, choose: Choice, tolerance: float, halfway: bool = True
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
    halfway : bool, optional
        Whether to try :meth:`.Truncation.halfway` first.

    Raises
    ------
    UnconvergedError
        If that takes more than 1600 unknowns and further harmonics than two steps, or 3600 up to
        four; where motions follow, twice as many unknowns and harmonics.
    """
    order, error = system.step, np.inf
    truncation = Truncation.halfway(system) if halfway else None
    if truncation is not None:
        with suppress(UnconvergedError):  # by motions that it does not have
            followed, _ = _chosen(system, truncation, choose, tolerance)
            if followed is not None:
                return followed
    while True:
        truncation = Truncation.of(system, system.harmonics(order))
        followed, error = _chosen(system, truncation, choose, tolerance)
        if followed is not None:
            return followed
        order = _next(system, order, error, tolerance)


def _chosen(
    system: PeriodicSystem, truncation: Truncation, choose: Choice, tolerance: float
) -> tuple[HillMotions | None, float]:
    """Return motions chosen from a truncation, followed into larger ones, and their error there.

    None where it is too small for that.
    """
    chosen = choose(truncation.solution)
    if chosen is None:
        return None, np.inf
    motions = truncation.motions(system, chosen)
    shifts = np.abs(motions.shifts[np.isfinite(motions.sizes)])
    near = np.all(shifts <= _NEAR * abs(system.base))
    return _followed(system, motions, tolerance) if near else None, motions.error


def _next(
    system: PeriodicSystem, order: int, error: float, tolerance: float, times: int = 1
) -> int:
    """Return the highest harmonic of the next truncation; limits are so many `times` as large."""
    step = system.step
    larger = order + step * max(1, order // (2 * step))
    most = times * MOST_UNKNOWNS * (_MORE_OF_FEW if larger <= times * _FEW * step else 1.0)
    if larger == 2 * step or 2 * len(system.harmonics(larger)) * system.size <= most:
        return larger
    raise UnconvergedError(
        f"Hill's method at {system.speed:g} rad/s: error {error:.1e} with harmonics up to "
        f"{order}, more than the tolerance {tolerance:.1e}: the speed is small against the "
        "frequencies that turning coefficients split; use a larger speed (or 0), or fewer "
        "high modes"
    )


def _followed(system: PeriodicSystem, motions: HillMotions, tolerance: float) -> HillMotions | None:
    """Return motions with as many harmonics as they need; None where they cannot be followed."""
    # its estimate does not see the further harmonics that the first ones left out bring along
    limit = (_FIRST if motions.orders[-1] == system.step else 1.0) * tolerance
    while motions.error > limit:
        order = _next(system, int(motions.orders[-1]), motions.error, tolerance, _FOLLOWED)
        lacking = np.flatnonzero(motions.errors > min(limit, _ALMOST * tolerance))
        larger = _in_larger(system, motions, lacking, system.harmonics(order))
        if larger is None or not _differ(larger, lacking, system.base):
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
        shapes[np.flatnonzero(orders == order)] = answer
    return shapes


def _squares(shapes: np.ndarray) -> np.ndarray:
    """Return the squared length of each motion (h, c, j)."""
    return np.sum(np.abs(shapes) ** 2, axis=(0, 1))


def _in_larger(
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
    values[lacking], x, lefts = found
    alike = np.sum(x.conj() * start, axis=(0, 1))
    near = np.abs(values[lacking] - guess) <= _MORE * np.abs(shifts[lacking]) + limits
    if not np.all(near & (np.abs(alike) >= _ALIKE * np.sqrt(_squares(start)))):
        return None
    shapes[..., lacking] = lengths * alike / np.abs(alike) * x
    load, outer = feedback(system, values[lacking], shapes[..., lacking], orders)
    inertia = slopes(system, values[lacking], shapes[..., lacking], orders)
    work = [np.sum(lefts.conj() * X, axis=(0, 1)) for X in (load, inertia)]
    shifts = shifts.copy()
    shifts[lacking] = -work[0] / work[1]
    every = {n: np.zeros((system.size, len(values)), dtype=complex) for n in outer}
    for n, answer in outer.items():
        every[n][:, lacking] = answer
    changed = {"values": values, "shapes": shapes, "shifts": shifts, "outer": every}
    return replace(motions, orders=orders, **changed)


def _differ(motions: HillMotions, columns: np.ndarray, base: float) -> bool:
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
