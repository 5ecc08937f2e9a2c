"""All of a rotor but the contacts of its rolling bearings, as these feel it: a linear rest.

Equation (2) of :mod:`contact_balance` takes its motion under the loads alone, and its receptances.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exudyn_rotor.linear.equations import PeriodicSystem, Terms, difference, stacked
from exudyn_rotor.linear.model.linear_model import ON_FOUNDATION, LinearModel
from exudyn_rotor.linear.solve.forced import coupled_stiffness

Harmonics = Mapping[tuple[int, int], np.ndarray]  # (d,) by (k, n), of both signs

_FURTHER = 6  # harmonics of a periodic rest beside those of a load, in steps of its coefficients
_SMALL = 1e-12  # share of a receptance or a motion that is rounding


def ring_motions(model: LinearModel, names: Sequence[str], speed: float) -> Terms:
    """Return the motion (3b, k) of inner rings against outer ones, in axes that stand still."""
    found = []
    for name in names:
        inner, outer = model.seen(name, speed), ON_FOUNDATION.format(name)
        against = model.seen(outer, speed) if outer in model.standing_interfaces else {}
        moved = difference(inner, against)
        moved.setdefault(0, np.zeros((6, model.size)))
        found.append({n: U[:3] for n, U in moved.items()})
    return stacked(found)


def resisted(model: LinearModel) -> np.ndarray:
    """Return all motions but shifts along the axis and spins that nothing holds, (k, r)."""
    return np.eye(model.size) if model.moving_basis is None else model.moving_basis


@dataclass(frozen=True, eq=False)
class Rest:
    """All but the contacts at one spin speed, as the bearings feel it.

    Attributes
    ----------
    model : LinearModel
        With a spring k₀ in place of each bearing.
    bearings : sequence of str
        Interfaces of the rolling bearings.
    speed, passing : float
        Ω and ZκΩ [rad/s].
    loads : mapping of int to ndarray (k,)
        Harmonics of both signs of constant loads and unbalance.
    """

    model: LinearModel
    bearings: Sequence[str]
    speed: float
    passing: float
    loads: Terms

    @cached_property
    def _basis(self) -> np.ndarray:
        return resisted(self.model)

    @cached_property
    def _system(self) -> PeriodicSystem:
        return self.model.at(self.speed).projected(self._basis)

    @cached_property
    def _moved(self) -> Terms:
        """Motion (3b, r) of the rings."""
        rings = ring_motions(self.model, self.bearings, self.speed)
        return {n: U @ self._basis for n, U in rings.items()}

    @cached_property
    def _across(self) -> Terms:
        """Motion (d, r) of the rings across the axis."""
        rows = np.arange(3 * len(self.bearings)) % 3 < 2
        return {n: U[rows] for n, U in self._moved.items()}

    @cached_property
    def _known(self) -> dict[tuple[int, int], dict[int, np.ndarray]]:
        return {}

    @cached_property
    def _loaded(self) -> dict[int, np.ndarray]:
        """The motion under the loads alone."""
        return self._solved({n: self._basis.T @ F for n, F in self.loads.items()}, 0.0)

    def moved(self) -> Harmonics:
        """Return q⁰."""
        return {(0, n): q for n, q in _product(self._across, self._loaded).items()}

    def presses(self) -> bool:
        """Return whether the loads move a ring across the axis, rounding left out."""
        moved = list(_product(self._moved, self._loaded).values())
        sizes = np.abs(moved).reshape(len(moved), -1, 3).max(axis=(0, 1))
        return bool(sizes[:2].max() > _SMALL * sizes.max())

    def receptance(self, k: int, n: int) -> dict[int, np.ndarray]:
        """Return H^p by p, each (d, d) [m/N]: motion n + p by forces of the harmonic n."""
        if (k, n) < (0, 0):
            return {-p: H.conj() for p, H in self.receptance(-k, -n).items()}
        if (k, n) not in self._known:
            loads = {n + m: U.T for m, U in self._across.items()}
            answer = self._solved(loads, k * self.passing)
            found = _product(self._across, answer)
            size = max(np.abs(H).max() for H in found.values())
            self._known[k, n] = {
                m - n: H for m, H in found.items() if np.abs(H).max() > _SMALL * size
            }
        return self._known[k, n]

    def coordinates(self, forces: Harmonics) -> dict[tuple[int, int], np.ndarray]:
        """Return the motion ``Re Σ x_kn exp i(kψ + nθ)``, k ≥ 0, (k,) each, by forces g."""
        found = {}
        for k in range(max(k for k, _ in forces) + 1):
            given = {n: (2.0 if k else 1.0) * g for (j, n), g in forces.items() if j == k}
            loads = _product({m: U.T for m, U in self._across.items()}, given)
            if k == 0:
                for n, F in self.loads.items():
                    loads[n] = loads.get(n, 0.0) + self._basis.T @ F
            for n, x in self._solved(loads, k * self.passing).items():
                found[k, n] = self._basis @ x
        return found

    def _solved(self, loads: Mapping[int, np.ndarray], rate: float) -> dict[int, np.ndarray]:
        """Return the harmonics (r, …) of the steady motion under loads (r, …)."""
        system, step = self._system, self._system.step
        if not step:
            return {
                n: np.linalg.solve(coupled_stiffness(system, rate, [n])[0], F)
                for n, F in loads.items()
            }
        orders = np.arange(min(loads) - _FURTHER * step, max(loads) + _FURTHER * step + 1)
        shape = next(iter(loads.values())).shape
        F = np.array([loads.get(int(n), np.zeros(shape)) for n in orders])
        A = coupled_stiffness(system, rate, orders)[0]
        X = np.linalg.solve(A, F.reshape(len(A), -1)).reshape(F.shape)
        return {int(n): x for n, x in zip(orders, X, strict=True)}


def _product(U: Terms, x: Mapping[int, np.ndarray]) -> dict[int, np.ndarray]:
    """Return the harmonics of ``U(θ) x(θ)``."""
    found: dict[int, np.ndarray] = {}
    for m, rows in U.items():
        for n, each in x.items():
            found[m + n] = found.get(m + n, 0.0) + rows @ each
    return found
