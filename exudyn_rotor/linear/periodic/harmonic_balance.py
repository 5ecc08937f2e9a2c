"""Steady forced motion of a periodic system, by harmonic balance (Hill's method).

In the rotor frame, loads ``f(t) = Re Σ F_n exp(i(ω + nΩ)t)`` give
``x(t) = Re Σ X_m exp(i(ω + mΩ)t)`` with the equations of
:mod:`exudyn_rotor.linear.periodic.hill` at λ = iω, and ``i sign(ν) H`` of structural damping with
the frequency ``ν = ω + mΩ`` of each harmonic.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

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
    if system.speed == 0.0:  # θ stands still: all harmonics are one
        system = PeriodicSystem(0.0, *({0: terms} for terms in system.matrices(0.0)), system.H)
        loads = {0: sum(loads.values())}
    balance = _Balance(system, loads, rate, list(driven))
    step, change = system.step, np.inf
    reach = max(abs(n) for n in loads) + step
    motion = balance.solved(reach)
    while step:
        reach += step
        if reach > HIGHEST_HARMONIC:
            raise ValueError(
                f"the harmonics do not converge: at order {reach - step} the motion still changes "
                f"by more than {tolerance:g}; the system is close to a parametric instability"
            )
        earlier, motion = motion, balance.solved(reach)
        before, change = change, _change(system.M[0], earlier, motion)
        at_rounding = change <= balance.rounding and change >= 0.5 * before
        if change <= tolerance or at_rounding:
            break
    return motion


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
class _Balance:
    """The equations for the harmonics of one load."""

    system: PeriodicSystem
    loads: Harmonics
    rate: float
    driven: list[int]
    conditions: list[float] = field(default_factory=list)  # reciprocal, of all solutions so far
    # of each harmonic its matrix, load and held coordinates, and the inverse of the matrix
    known: dict[int, tuple[np.ndarray, ...]] = field(default_factory=dict)
    inverses: dict[int, np.ndarray] = field(default_factory=dict)

    @property
    def rounding(self) -> float:
        """Relative error of a solution by rounding, at most."""
        return EPSILON / min(self.conditions)

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

    def solved(self, reach: int) -> dict[int, np.ndarray]:
        """Solve for the harmonics −reach … reach that the loads excite."""
        motion: dict[int, np.ndarray] = {}
        waiting = set(self.loads)
        while waiting:
            group = [min(waiting)]
            if self.system.step:
                every = range(-reach, reach + 1)
                group = [n for n in every if (n - group[0]) % self.system.step == 0]
            waiting -= set(group)
            motion |= dict(zip(group, self._solve(np.array(group)), strict=True))
        return motion

    def _solve(self, orders: np.ndarray) -> np.ndarray:
        """Return the harmonics (h, k) of one group of coupled ones."""
        matrices, loads, held = self._alone(orders)
        found = None
        if worth_it(self.system, len(orders)):
            found = self._by_ports(orders, matrices, held).solved(loads)
        if found is None or not found[1] > _SURELY * _SINGULAR:
            found = _solved_as_one(self._whole(orders, matrices, held), loads)
        self.conditions.append(found[1])
        return self.scale * found[0]

    def _alone(self, orders: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return what each harmonic's matrix (h, k, k) and load (h, k) are, scaled.

        And which coordinates are held in it, (h, k). It does not matter what others there are.
        """
        new = np.array([n for n in orders.tolist() if n not in self.known], dtype=int)
        senses = senses_of_turning(self.rate, new, self.system.speed)
        rates = 1j * (self.rate + new * self.system.speed)
        for n, sense, matrix in zip(
            new.tolist(), senses, self.system.dynamic(0, rates), strict=True
        ):
            load = self.scale * self.loads.get(n, np.zeros(self.system.size, dtype=complex))
            if self.system.H is not None:
                matrix = matrix + 1j * sense * self.system.H
            matrix = self.scale[:, None] * matrix * self.scale
            held = np.zeros(self.system.size, dtype=bool)
            if sense == 0.0:
                held[self.driven] = True
                matrix[held] = matrix[:, held] = load[held] = 0.0
                free = self._free(load)
                # a spring on what is free changes nothing else
                matrix += free @ free.T
                load -= free @ (free.T @ load)
            self.known[n] = matrix, load, held
        matrices, loads, held = zip(*(self.known[n] for n in orders.tolist()), strict=True)
        return np.stack(matrices), np.stack(loads), np.stack(held)

    def _whole(self, orders: np.ndarray, matrices: np.ndarray, held: np.ndarray) -> np.ndarray:
        """Return the equations of all harmonics as one matrix, scaled."""
        count, size = held.shape
        M, D, K = hill_matrices(self.system, orders)
        scale = np.where(held, 0.0, self.scale).ravel()
        A = scale[:, None] * (K + 1j * self.rate * D - self.rate**2 * M) * scale
        A.reshape(count, size, count, size)[range(count), :, range(count)] = matrices
        return A

    def _by_ports(
        self, orders: np.ndarray, matrices: np.ndarray, held: np.ndarray
    ) -> CoupledHarmonics:
        """Return the same equations by what couples harmonics."""
        inverses = self.inverses
        new = [i for i, n in enumerate(orders.tolist()) if n not in inverses]
        inverses |= zip(orders[new].tolist(), inverted(matrices[new]), strict=True)
        ports = np.where(held, 0.0, self.scale)[..., None] * self.system.ports
        links = links_of(self.system.between_ports, orders, self.rate)
        return CoupledHarmonics(
            matrices, np.stack([inverses[n] for n in orders.tolist()]), ports, links
        )

    def _free(self, load: np.ndarray) -> np.ndarray:
        """Return the motions (k, r) of :attr:`soft` that stay where they are under a load (k,).

        The load is scaled, and has nothing that acts on a drive.

        Raises
        ------
        ValueError
            If the load acts on a motion that nothing but rounding resists.
        """
        columns, unresisted = self.soft
        loaded = np.abs(columns.T @ load) > _LOAD_ON_FREE * np.linalg.norm(load)
        if np.any(loaded & unresisted):
            raise ValueError(
                "a constant load acts on a motion that nothing holds: there is no steady state. "
                "Either a support is missing there, or this is a resonance without any damping; a "
                "bearing that is rigid needs no more than a thousand times the rotor's stiffness"
            )
        return columns[:, ~loaded]


def _solved_as_one(matrix: np.ndarray, loads: np.ndarray) -> tuple[np.ndarray, float]:
    """Return the harmonics (h, k) under loads, and the reciprocal condition number.

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
    return zgetrs(factor, pivots, loads.ravel())[0].reshape(loads.shape), float(condition)
