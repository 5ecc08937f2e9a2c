"""The largest growth at many values of a parameter at once, to tell where to look closer.

Its equations are periodic, and known at a few values; their Fourier terms in between are those of
a polynomial through these. The fundamental matrix is that of Magnus steps of fourth order in the
rational form of their exponential, which lets no damped motion grow, however long a step is: fast
motions need no short ones. Sources: Blanes, Casas, Oteo, Ros, Phys. Rep. 470 (2009), Eq. (254);
Hairer, Wanner, Solving Ordinary Differential Equations II (1996), Sect. IV.3, on Padé's (2, 2).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.interpolate import BarycentricInterpolator

from exudyn_rotor.linear.periodic.fundamental import (
    GAUSS_POINTS,
    magnus_exponent,
    state_matrix,
    unit_state_matrix,
)
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, Terms
from exudyn_rotor.threads import one_thread

_PHASE, _FASTEST = 0.4, 15.0  # of a step [rad], and times Ω up to which frequencies are followed
_ENTRIES = 2_000_000  # of matrices that are made at once


class GrowthScan:
    """Largest growth between values at which the equations are known.

    Parameters
    ----------
    values : sequence of float
    systems : sequence of PeriodicSystem
        Of one size and one step of harmonics, that turn.
    """

    def __init__(self, values: Sequence[float], systems: Sequence[PeriodicSystem]) -> None:
        self.size, self.step = systems[0].size, systems[0].step
        self.terms = {
            name: BarycentricInterpolator(values, _waves([getattr(X, name) for X in systems]))
            for name in "MDK"
        }
        self.orders = {name: _orders([getattr(X, name) for X in systems]) for name in "MDK"}
        self.speeds = BarycentricInterpolator(values, [X.speed for X in systems])
        self.steps = max(_steps(X) for X in systems)

    @staticmethod
    def can(systems: Sequence[PeriodicSystem | None]) -> bool:
        """Return whether equations are there, turn, and are of one kind."""
        if any(X is None or X.stands_still for X in systems):
            return False
        return len({(X.size, X.step) for X in systems}) == 1

    @one_thread()
    def growths(self, values: np.ndarray) -> np.ndarray:
        """Return the largest real part of the exponents at values, NaN where it is not known."""
        few = max(1, _ENTRIES // (2 * self.size) ** 2 // 8)
        parts = [self._growths(values[i : i + few]) for i in range(0, len(values), few)]
        return np.concatenate(parts)

    def _growths(self, values: np.ndarray) -> np.ndarray:
        terms = {name: X(values) for name, X in self.terms.items()}
        if len(self.orders["M"]) == 1:
            for name in "DK":
                terms[name] = np.linalg.solve(terms["M"][:, :1], terms[name])
            del terms["M"]
        periods = 2.0 * np.pi / (self.step * self.speeds(values))
        turn = 2.0 * np.pi / self.step
        h = (periods / self.steps)[:, None, None]
        one = np.eye(2 * self.size)
        result = np.broadcast_to(one, (len(values), *one.shape))
        with np.errstate(all="ignore"):
            for step in range(self.steps):
                angles = turn * (step + GAUSS_POINTS) / self.steps
                X = magnus_exponent(*(h * self._matrix(terms, angle) for angle in angles))
                even, odd = one + X @ X / 12.0, 0.5 * X
                result = np.linalg.solve(even - odd, (even + odd) @ result)
        good = np.all(np.isfinite(result), axis=(1, 2))
        found = np.full(len(values), np.nan)
        multipliers = np.abs(np.linalg.eigvals(result[good])).max(axis=1)
        found[good] = np.log(multipliers) / periods[good]
        return found

    def _matrix(self, terms: dict[str, np.ndarray], angle: float) -> np.ndarray:
        """Return the state matrices at a spin angle; of unit masses without M."""
        at = {}
        for name, given in terms.items():
            turned = angle * np.array(self.orders[name][1:])
            waves = np.array([1.0, *2.0 * np.cos(turned), *-2.0 * np.sin(turned)])
            at[name] = np.tensordot(waves, given, (0, 1))
        return state_matrix(**at) if "M" in at else unit_state_matrix(**at)


def _orders(terms: Sequence[Terms]) -> list[int]:
    """Return the harmonics that some have, 0 first."""
    return sorted({0} | {n for each in terms for n in each if n >= 0})


def _waves(terms: Sequence[Terms]) -> np.ndarray:
    """Return the real parts of Fourier terms and then the imaginary ones, (values, waves, k, k)."""
    orders, none = _orders(terms), np.zeros_like(terms[0][0])
    parts = [[each.get(n, none).real for n in orders] for each in terms]
    rest = [[each.get(n, none).imag for n in orders[1:]] for each in terms]
    return np.array([[*one, *other] for one, other in zip(parts, rest, strict=True)])


def _steps(system: PeriodicSystem) -> int:
    """Return the steps of a period that follow frequencies up to a multiple of the speed."""
    squares = np.linalg.eigvals(np.linalg.solve(system.M[0].real, system.K[0].real))
    turns = np.sqrt(np.abs(squares)) / system.speed
    highest = max(turns[turns < _FASTEST].max(initial=0.0), system.order)
    return int(np.ceil(2.0 * np.pi / system.step * highest / _PHASE)) + 8
