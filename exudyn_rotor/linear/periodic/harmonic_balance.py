"""Steady forced motion of a periodic system, by harmonic balance (Hill's method).

In the rotor frame, loads ``f(t) = Re Σ F_n exp(i(ω + nΩ)t)`` give
``x(t) = Re Σ X_m exp(i(ω + mΩ)t)`` with the equations of
:mod:`exudyn_rotor.linear.periodic.hill` at λ = iω, and ``i sign(ν) H`` of structural damping with
the frequency ``ν = ω + mΩ`` of each harmonic.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import zip_longest

import numpy as np
from scipy.linalg.lapack import zgecon, zgetrf, zgetrs

from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.periodic.coupled_harmonics import (
    CoupledHarmonics,
    inverted,
    links_of,
    worth_it,
)
from exudyn_rotor.linear.periodic.harmonics import hill_matrices
from exudyn_rotor.linear.periodic.periodic_system import EPSILON, PeriodicSystem

Harmonics = Mapping[int, np.ndarray]
Part = tuple[int, tuple[int, ...]]  # a harmonic, and which soft motions a load leaves free in it

HIGHEST_HARMONIC = 40
# of matrices scaled to diagonals of order one: rounding leaves 1e-15 of a motion that is free. One
# above that is held where a load acts on it: a soft direction beside stiff ones is no smaller
_FREE = 1e-12
_ROUNDING = 1e-14
_SINGULAR = 1e-14
_SURELY = 10.0  # times that: an estimate from below which one matrix decides
# share of a load that may act on a free motion: the rounding of a mesh's own unbalance
_LOAD_ON_FREE = 1e-6


def forced_motion(
    system: PeriodicSystem,
    loads: Harmonics,
    rate: float,
    tolerance: float,
    driven: Sequence[int] = (),
) -> dict[int, np.ndarray]:
    """Return the harmonics X_m (k,) of the steady motion in the rotor frame.

    Harmonics are added until the motion changes by less than `tolerance`, taken relative to the
    largest harmonic in the norm of the mass matrix, or no more than by rounding: in the rotor frame
    a soft direction beside a stiff one is the difference of large numbers.

    Parameters
    ----------
    system : PeriodicSystem
    loads : mapping of int to ndarray, shape (k,)
        Harmonics F_n of the load, rotor frame.
    rate : float
        Angular frequency ω [rad/s].
    tolerance : float
    driven : sequence of int, optional
        Coordinates whose constant part in the rotor frame a drive keeps at zero: the spin.

    Raises
    ------
    ValueError
        If the harmonics do not converge, or the equations are singular: a load on a motion that
        nothing holds, or a resonance without any damping.
    """
    return forced_motions(system, [loads], rate, tolerance, driven)[0]


def forced_motions(
    system: PeriodicSystem,
    loads: Sequence[Harmonics],
    rate: float,
    tolerance: float,
    driven: Sequence[int] = (),
) -> list[dict[int, np.ndarray]]:
    """Return the steady motion under each of several loads, as :func:`forced_motion` does.

    What does not depend on a load, matrices and their factors, is computed once.
    """
    if system.speed == 0.0:  # θ stands still: all harmonics are one
        system = PeriodicSystem(0.0, *({0: terms} for terms in system.matrices(0.0)), system.H)
        loads = [{0: sum(each.values())} for each in loads]
    equations = _Equations(system, rate, list(driven))
    motions: list[dict[int, np.ndarray]] = [{} for _ in loads]
    rounds = [_approximations(_Balance(equations, each), tolerance) for each in loads]
    for found in zip_longest(*rounds):
        motions = [old if new is None else new for old, new in zip(motions, found, strict=True)]
        equations.groups.clear()  # large, and next has further harmonics
    return motions


def _approximations(balance: _Balance, tolerance: float) -> Iterator[dict[int, np.ndarray]]:
    """Yield the harmonics of one motion, each time with more of them, until these are enough."""
    system = balance.equations.system
    step, change = system.step, np.inf
    reach = max(abs(n) for n in balance.loads) + step
    motion = balance.solved(reach)
    yield motion
    while step:
        reach += step
        if reach > HIGHEST_HARMONIC:
            raise ValueError(
                f"the harmonics do not converge: at order {reach - step} the motion still changes "
                f"by more than {tolerance:g}; the system is close to a parametric instability"
            )
        earlier, motion = motion, balance.solved(reach)
        before, change = change, _change(system.M[0], earlier, motion)
        yield motion
        at_rounding = change <= balance.rounding and change >= 0.5 * before
        if change <= tolerance or at_rounding:
            break


def senses_of_turning(rate: float, orders: np.ndarray, speed: float) -> np.ndarray:
    """Return the sign of each frequency ``ω + nΩ``; 0 where that is zero but for rounding."""
    frequencies = rate + np.asarray(orders) * speed
    zero = np.abs(frequencies) <= 1e-12 * max(abs(rate), abs(speed))
    return np.where(zero, 0.0, np.sign(frequencies))


def _change(mass: np.ndarray, earlier: Harmonics, motion: Harmonics) -> float:
    """Return the largest change of a harmonic over the largest harmonic."""

    def norm(x: np.ndarray) -> float:
        return np.sqrt(max((x.conj() @ mass @ x).real, 0.0))

    largest = max(norm(x) for x in motion.values())
    change = max(norm(x - earlier.get(n, 0.0 * x)) for n, x in motion.items())
    return change / largest if largest > 0.0 else 0.0


@dataclass(frozen=True, eq=False)
class _Equations:
    """The equations for harmonics at one rate, whatever the load, in scaled unknowns."""

    system: PeriodicSystem
    rate: float
    driven: list[int]
    # of each harmonic its matrix, held coordinates, and whether its frequency is zero
    known: dict[int, tuple[np.ndarray, np.ndarray, bool]] = field(default_factory=dict)
    inverses: dict[Part, np.ndarray] = field(default_factory=dict)
    groups: dict[tuple[Part, ...], _Group] = field(default_factory=dict)

    @cached_property
    def fastest(self) -> float:
        """The rate that inertia is measured with [rad/s]."""
        return max(abs(self.rate), abs(self.system.speed))

    @cached_property
    def scale(self) -> np.ndarray:
        """Return s (k,) such that s A s has a diagonal of order one, whatever the units."""
        system = self.system
        diagonal = np.abs(np.diag(system.K[0])) + self.fastest**2 * np.abs(np.diag(system.M[0]))
        return 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))

    @cached_property
    def soft(self) -> tuple[np.ndarray, np.ndarray]:
        """Scaled motions as orthonormal columns (k, r) that next to no stiffness resists.

        Driven ones, too. And whether what resists each is rounding, (r,).
        """
        scale = self.scale.copy()
        scale[self.driven] = 0.0
        scaled = [scale[:, None] * term * scale for term in self.system.K.values()]
        stack = np.vstack([part for term in scaled for part in (term.real, term.imag)])
        # coordinates that are free by themselves: rounding would mix them with soft motions
        alone = np.linalg.norm(stack, axis=0) <= _ROUNDING
        _, values, vt = np.linalg.svd(stack[:, ~alone], full_matrices=False)
        relative = values / values.max(initial=1.0)
        columns = relative <= _FREE
        motions = np.eye(len(scale))[:, alone], np.eye(len(scale))[:, ~alone] @ vt[columns].T
        unresisted = np.r_[np.ones(alone.sum(), dtype=bool), relative[columns] <= _ROUNDING]
        return np.hstack(motions), unresisted

    def prepare(self, orders: np.ndarray) -> None:
        """Compute what each harmonic is by itself: it does not matter what others there are."""
        new = np.array([n for n in orders.tolist() if n not in self.known], dtype=int)
        senses = senses_of_turning(self.rate, new, self.system.speed)
        rates = 1j * (self.rate + new * self.system.speed)
        for n, sense, matrix in zip(
            new.tolist(), senses, self.system.dynamic(0, rates), strict=True
        ):
            if self.system.H is not None:
                matrix = matrix + 1j * sense * self.system.H
            matrix = self.scale[:, None] * matrix * self.scale
            held = np.zeros(self.system.size, dtype=bool)
            if sense == 0.0:
                held[self.driven] = True
                matrix[held] = matrix[:, held] = 0.0
            self.known[n] = matrix, held, sense == 0.0

    def group(self, parts: tuple[Part, ...]) -> _Group:
        """Return the equations of harmonics that are coupled."""
        if parts not in self.groups:
            orders, inverses = np.array([n for n, _ in parts]), None
            matrices = np.stack([self._matrix(*part) for part in parts])
            held = np.stack([self.known[n][1] for n, _ in parts])
            if worth_it(self.system, len(parts)):
                inverses = self._inverses(parts, matrices)
            self.groups[parts] = _Group(
                self.system, self.rate, self.scale, orders, matrices, held, inverses
            )
        return self.groups[parts]

    def _matrix(self, n: int, free: tuple[int, ...]) -> np.ndarray:
        """Return the matrix of a harmonic; a spring on what is free changes nothing else."""
        matrix = self.known[n][0]
        if not free:
            return matrix
        columns = self.soft[0][:, list(free)]
        return matrix + columns @ columns.T

    def _inverses(self, parts: tuple[Part, ...], matrices: np.ndarray) -> np.ndarray:
        """Return the inverses (h, k, k) of matrices; those of earlier groups are known."""
        new = [i for i, part in enumerate(parts) if part not in self.inverses]
        self.inverses.update(zip([parts[i] for i in new], inverted(matrices[new]), strict=True))
        return np.stack([self.inverses[part] for part in parts])


@dataclass(frozen=True, eq=False)
class _Group:
    """The equations of harmonics (h,) that are coupled, scaled.

    Matrices (h, k, k) and held coordinates (h, k) are those of each by itself; their inverses are
    given where it is worth it to use them.
    """

    system: PeriodicSystem
    rate: float
    scale: np.ndarray
    orders: np.ndarray
    matrices: np.ndarray
    held: np.ndarray
    inverses: np.ndarray | None

    def solved(self, loads: np.ndarray) -> tuple[np.ndarray, float]:
        """Return the harmonics (h, k) under loads, and the reciprocal condition number."""
        found = None if self.inverses is None else self._by_ports.solved(loads)
        if found is None or not found[1] > _SURELY * _SINGULAR:
            factor, pivots, condition = self._as_one
            found = zgetrs(factor, pivots, loads.ravel())[0].reshape(loads.shape), condition
        return found

    @cached_property
    def _as_one(self) -> tuple[np.ndarray, np.ndarray, float]:
        """The factor of the equations of all harmonics as one matrix, and its condition."""
        count, size = self.held.shape
        M, D, K = hill_matrices(self.system, self.orders)
        scale = np.where(self.held, 0.0, self.scale).ravel()
        A = scale[:, None] * (K + 1j * self.rate * D - self.rate**2 * M) * scale
        A.reshape(count, size, count, size)[range(count), :, range(count)] = self.matrices
        return _factorised(A)

    @cached_property
    def _by_ports(self) -> CoupledHarmonics:
        """The same equations by what couples harmonics."""
        ports = np.where(self.held, 0.0, self.scale)[..., None] * self.system.ports
        links = links_of(self.system.between_ports, self.orders, self.rate)
        return CoupledHarmonics(self.matrices, self.inverses, ports, links)


@dataclass(frozen=True, eq=False)
class _Balance:
    """The harmonics of the motion under one load."""

    equations: _Equations
    loads: Harmonics
    conditions: list[float] = field(default_factory=list)  # reciprocal, of all solutions so far
    # of each harmonic its load, and with which free motions
    known: dict[int, tuple[np.ndarray, Part]] = field(default_factory=dict)

    @property
    def rounding(self) -> float:
        """Relative error of a solution by rounding, at most."""
        return EPSILON / min(self.conditions)

    def solved(self, reach: int) -> dict[int, np.ndarray]:
        """Solve for the harmonics −reach … reach that the loads excite."""
        motion: dict[int, np.ndarray] = {}
        waiting, step = set(self.loads), self.equations.system.step
        while waiting:
            group = [min(waiting)]
            if step:
                group = [n for n in range(-reach, reach + 1) if (n - group[0]) % step == 0]
            waiting -= set(group)
            motion |= dict(zip(group, self._solve(np.array(group)), strict=True))
        return motion

    def _solve(self, orders: np.ndarray) -> np.ndarray:
        """Return the harmonics (h, k) of one group of coupled ones."""
        self.equations.prepare(orders)
        loads, parts = zip(*(self._load(n) for n in orders.tolist()), strict=True)
        found, condition = self.equations.group(parts).solved(np.stack(loads))
        self.conditions.append(condition)
        return self.equations.scale * found

    def _load(self, n: int) -> tuple[np.ndarray, Part]:
        """Return the load (k,) of a harmonic, scaled, and what stays where it is under it."""
        if n not in self.known:
            scale, free = self.equations.scale, ()
            load = scale * self.loads.get(n, np.zeros(len(scale), dtype=complex))
            _, held, constant = self.equations.known[n]
            if constant:
                load[held] = 0.0
                free = self._free(load)
                columns = self.equations.soft[0][:, list(free)]
                load -= columns @ (columns.T @ load)
            self.known[n] = load, (n, free)
        return self.known[n]

    def _free(self, load: np.ndarray) -> tuple[int, ...]:
        """Return which motions of :attr:`_Equations.soft` stay where they are under a load (k,).

        The load is scaled, and has nothing that acts on a drive.

        Raises
        ------
        ValueError
            If the load acts on a motion that nothing but rounding resists.
        """
        columns, unresisted = self.equations.soft
        loaded = np.abs(columns.T @ load) > _LOAD_ON_FREE * np.linalg.norm(load)
        if np.any(loaded & unresisted):
            raise ValueError(
                "a constant load acts on a motion that nothing holds: there is no steady state. "
                "Either a support is missing there, or this is a resonance without any damping; a "
                "bearing that is rigid needs no more than a thousand times the rotor's stiffness"
            )
        return tuple(np.flatnonzero(~loaded).tolist())


def _factorised(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Return the factor of a matrix, its pivots, and the reciprocal condition number.

    Raises
    ------
    ValueError
        If the matrix is singular to rounding.
    """
    factor, pivots, info = zgetrf(matrix)
    condition = zgecon(factor, np.abs(matrix).sum(axis=0).max())[0] if info == 0 else 0.0
    if condition < _SINGULAR:
        raise ValueError(
            "the equations are singular: a resonance without any damping, or stiffnesses that "
            "differ by more than 1e14; add damping, leave this value out, or take a bearing that "
            "is rigid as one a thousand times stiffer than the rotor"
        )
    return factor, pivots, float(condition)
