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
from dataclasses import dataclass, replace

import numpy as np

from exudyn_rotor.linear.periodic.companion import Companion
from exudyn_rotor.linear.periodic.eigenvalues import resolution_of, resolved
from exudyn_rotor.linear.periodic.harmonics import feedback, hill_matrices, shifted, slopes, spacing
from exudyn_rotor.linear.periodic.inverse_iteration import settled
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, UnconvergedError

MOST_UNKNOWNS = 1600  # in first-order form, beyond the first two harmonics
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
    """

    values: np.ndarray
    shapes: np.ndarray
    states: np.ndarray
    orders: np.ndarray
    resolution: float
    bounds: np.ndarray

    @property
    def step(self) -> int:
        """Of the harmonics."""
        return spacing(self.orders)


@dataclass(frozen=True, eq=False)
class Chosen:
    """Motions chosen from a :class:`HillSolution`.

    Attributes
    ----------
    columns : ndarray of int, shape (j,)
        Where they stand there.
    values, shapes : ndarray, shapes (j,), (h, c, j)
        λ and harmonics, which may be better than those of the solution where copies coincide.
    sizes : ndarray, shape (j,)
        What the error of each λ is relative to [1/s]; infinite where none counts.
    paired : ndarray of bool, shape (j,)
        Which stand for their conjugates, too, of other families.
    """

    columns: np.ndarray
    values: np.ndarray
    shapes: np.ndarray
    sizes: np.ndarray
    paired: np.ndarray


@dataclass(frozen=True, eq=False)
class HillMotions:
    """Motions with as many harmonics as they need.

    Attributes
    ----------
    values, shapes : ndarray, shapes (j,), (h, c, j)
        λ and harmonics.
    orders : ndarray of int, shape (h,)
    sizes : ndarray, shape (j,)
        What the error of each λ is relative to [1/s].
    resolution : float
        Eigenvalues closer than this cannot be told apart [1/s].
    rounding : ndarray, shape (j,)
        By how much rounding can change the real parts [1/s].
    shifts : ndarray, shape (j,)
        By how much the first harmonics left out would change λ.
    outer : mapping of int to ndarray, shape (c, j)
        What these harmonics would be.
    paired : ndarray of bool, shape (j,)
        Which stand for their conjugates, too, of other families.
    """

    values: np.ndarray
    shapes: np.ndarray
    orders: np.ndarray
    sizes: np.ndarray
    resolution: float
    rounding: np.ndarray
    shifts: np.ndarray
    outer: dict[int, np.ndarray]
    paired: np.ndarray

    @property
    def bounds(self) -> np.ndarray:
        """By how much rounding and the harmonics left out can change the real parts [1/s]."""
        return self.rounding + np.abs(self.shifts)

    @property
    def errors(self) -> np.ndarray:
        """Error of each λ by harmonics left out, relative to its size."""
        return np.abs(self.shifts) / self.sizes

    @property
    def error(self) -> float:
        """The largest of them."""
        return float(np.max(self.errors, initial=0.0))

    def with_conjugates(self) -> HillMotions:
        """Return the motions, and then the conjugates for which they stand."""

        def both(X: np.ndarray, Y: np.ndarray) -> np.ndarray:
            return np.concatenate([X, Y[..., self.paired].conj()], axis=-1)

        each = {name: getattr(self, name) for name in ("values", "sizes", "rounding", "shifts")}
        return replace(
            self,
            shapes=both(self.shapes, self.shapes[::-1]),
            outer={n: both(X, self.outer[-n]) for n, X in self.outer.items()},
            paired=np.zeros(len(self.paired) + self.paired.sum(), dtype=bool),
            **{name: both(X, X) for name, X in each.items()},
        )


Choice = Callable[[HillSolution], Chosen | None]


def solve_hill(system: PeriodicSystem, choose: Choice, tolerance: float) -> HillMotions:
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

    Raises
    ------
    UnconvergedError
        If that takes more than 1600 unknowns, or 3200 where motions follow, and further harmonics
        than two steps.
    """
    order, error = system.step, np.inf
    while True:
        companion, solution = _solved(system, system.harmonics(order))
        chosen = choose(solution)
        if chosen is not None:
            motions = _started(system, companion, solution, chosen)
            error = motions.error
            shifts = np.abs(motions.shifts[np.isfinite(motions.sizes)])
            near = np.all(shifts <= _NEAR * abs(system.base))
            followed = _followed(system, motions, tolerance) if near else None
            if followed is not None:
                return followed
        order = _next(system, order, error, tolerance)


def _next(
    system: PeriodicSystem, order: int, error: float, tolerance: float, most: int | None = None
) -> int:
    """Return the highest harmonic of the next truncation, of MOST_UNKNOWNS or `most`."""
    step, most = system.step, MOST_UNKNOWNS if most is None else most
    larger = order + step * max(1, order // (2 * step))
    if larger == 2 * step or 2 * len(system.harmonics(larger)) * system.size <= most:
        return larger
    raise UnconvergedError(
        f"Hill's method at {system.speed:g} rad/s: error {error:.1e} with harmonics up to "
        f"{order}, more than the tolerance {tolerance:.1e}: the speed is small against the "
        "frequencies that turning coefficients split; use a larger speed (or 0), or fewer "
        "high modes"
    )


def _started(
    system: PeriodicSystem, companion: Companion, solution: HillSolution, chosen: Chosen
) -> HillMotions:
    """Return motions chosen from a truncation."""
    columns, orders = chosen.columns, solution.orders
    shapes = solution.shapes[:, :, columns]
    load, outer = feedback(system, solution.values[columns], shapes, orders)
    load = np.einsum("nh,hkj->nkj", _real_basis(len(orders)), load).reshape(-1, len(columns))
    scale = np.sum(shapes.conj() * chosen.shapes, axis=(0, 1)) / _squares(shapes)
    return HillMotions(
        chosen.values,
        chosen.shapes,
        orders,
        chosen.sizes,
        solution.resolution,
        solution.bounds[columns],
        companion.shifts(load, columns),
        {n: scale * answer for n, answer in outer.items()},
        chosen.paired,
    )


def _followed(system: PeriodicSystem, motions: HillMotions, tolerance: float) -> HillMotions | None:
    """Return motions with as many harmonics as they need; None where they cannot be followed."""
    # its estimate does not see the further harmonics that the first ones left out bring along
    limit = (_FIRST if motions.orders[-1] == system.step else 1.0) * tolerance
    while motions.error > limit:
        last, most = int(motions.orders[-1]), _FOLLOWED * MOST_UNKNOWNS
        order = _next(system, last, motions.error, tolerance, most)
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
    shapes = np.pad(motions.shapes, ((wider, wider), (0, 0), (0, 0)))
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
    values, shifts = motions.values.copy(), motions.shifts
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


def _solved(system: PeriodicSystem, orders: np.ndarray) -> tuple[Companion, HillSolution]:
    """Return all motions of one truncation."""
    u = _real_basis(len(orders))
    matrices = (_turned(X, u) for X in hill_matrices(system, orders))
    companion = Companion.of(*matrices, system.rounding)
    values, states = companion.modes()
    errors, bounds = companion.errors
    half = len(states) // 2
    shapes = np.einsum("nh,nkj->hkj", u.conj(), states[:half].reshape(len(orders), -1, 2 * half))
    resolution, values = resolution_of(values), resolved(values, errors)
    return companion, HillSolution(values, shapes, states, orders, resolution, bounds)


def _real_basis(count: int) -> np.ndarray:
    """Return the unitary matrix from harmonics −N … N to cosine and sine terms.

    In these Hill's matrices are real, which is three times faster to solve.
    """
    middle = count // 2
    u = np.zeros((count, count), dtype=complex)
    u[middle, middle] = 1.0
    for n in range(1, middle + 1):
        u[middle + n, [middle + n, middle - n]] = np.sqrt(0.5)
        u[middle - n, [middle + n, middle - n]] = -1j * np.sqrt(0.5), 1j * np.sqrt(0.5)
    return u


def _turned(matrix: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Return a matrix of harmonics in cosine and sine terms."""
    count, size = len(u), len(matrix) // len(u)
    blocks = matrix.reshape(count, size, count, size)
    turned = np.tensordot(u, np.tensordot(blocks, u.conj(), (2, 1)), (1, 0))  # n, a, b, m
    return turned.transpose(0, 1, 3, 2).reshape(matrix.shape).real
