"""All of a rotor but its nonlinear laws, as these feel it: the linear rest.

Motions are sums of two waves, ``Σ x_kn exp i(kφ + nθ/r)`` with the spin angle θ, r revolutions that
a motion takes to repeat, and a second phase φ of its own frequency: of the ball pass, or of a whirl
that has no period in common with the spin. The journals move by ``q = C(θ) x`` against what carries
them, so that forces g of the harmonic (k, n) move them in the harmonics (k, n + rp),

    q_{k, n+rp} = q⁰_{k, n+rp} + Σ H^p_kn g_kn,
    H^p_kn = Σ_m C_{p−m} Z⁻¹(ν_{k, n+rm}) C_mᵀ,   Z(ν) = K + iνD − ν²M.                     (1)

In axes that stand still C is constant and p = 0; in the axes of the rotor p ≠ 0 is what an uneven
rotor has.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.linalg import eigh, orth

from exudyn_rotor.calls import kept
from exudyn_rotor.linear.equations import PeriodicSystem, Terms, difference, stacked
from exudyn_rotor.linear.model.linear_model import ON_FOUNDATION, LinearModel

Coupling = tuple[np.ndarray, np.ndarray, np.ndarray]  # rows, columns, H (h, d, d)
_SMALL = 1e-12  # share of a receptance or a motion that is rounding
_DEPENDENT = 1e-8  # of singular values of static motions


def resisted(model: LinearModel) -> np.ndarray:
    """Return all motions but shifts along the axis and spins that nothing holds, (k, r)."""
    return np.eye(model.size) if model.moving_basis is None else model.moving_basis


@kept
def _journals(model: LinearModel, names: tuple[str, ...], moves: bool) -> Terms:
    """Return the motion (d, r) of journals against what carries them, by resisted motions.

    Across the axis, in axes that stand still.
    """
    speed, basis, found = float(moves), resisted(model), []
    for name in names:
        outer = ON_FOUNDATION.format(name)
        against = model.seen(outer, speed) if outer in model.interfaces else {}
        moved = difference(model.seen(name, speed), against)
        moved.setdefault(0, np.zeros((6, model.size)))
        waves = moved if model.turns else [0]  # supports act on the mean motion
        found.append({n: moved[n][:2] @ basis for n in waves})
    motions = stacked(found)
    largest = max(np.abs(U).max() for U in motions.values())
    return {n: U for n, U in motions.items() if np.abs(U).max() > _SMALL * largest}


@dataclass(frozen=True, eq=False)
class Unloaded:
    """The rest at one spin speed, without loads."""

    model: LinearModel  # with a spring and a damper in place of each law
    names: Sequence[str]  # interfaces of the laws
    speed: float  # Ω [rad/s]
    # the same in axes that stand still, of a round rotor: there what laws do to motions beside a
    # steady one changes little, and not at all on a circle
    standing: LinearModel | None = None
    within: np.ndarray | None = None  # (r', r) Columns of fewer motions, see :meth:`up_to`
    known: dict = field(default_factory=dict, repr=False)  # receptances

    @cached_property
    def for_stability(self) -> Unloaded:
        """The rest in axes that stand still, if it can be."""
        return Unloaded(self.standing, self.names, self.speed) if self.standing else self

    def up_to(self, frequency: float) -> Unloaded:
        """Return the rest in its motions up to a frequency [rad/s], and static ones of the others.

        Faster motions follow the forces of the laws as springs do: of them the basis keeps what
        they yield to constant forces.
        """
        M, _, K = self.system.matrices()
        squares, shapes = eigh(0.5 * (K + K.T), 0.5 * (M + M.T))
        fast = squares > frequency**2
        yields = shapes[:, fast] @ ((self.rows @ shapes[:, fast]) / squares[fast]).T
        static = orth(yields, rcond=_DEPENDENT) if np.any(yields) else yields[:, :0]
        if static.shape[1] >= np.sum(fast):
            return self
        return replace(self, within=np.hstack([shapes[:, ~fast], static]), known={})

    @cached_property
    def basis(self) -> np.ndarray:
        """Motions that something resists, (k, r)."""
        resists = resisted(self.model)
        return resists if self.within is None else resists @ self.within

    @cached_property
    def system(self) -> PeriodicSystem:
        """The equations of these motions."""
        return self.model.at(self.speed).projected(self.basis)

    @cached_property
    def journals(self) -> Terms:
        """C (d, r)."""
        found = _journals(self.model, tuple(self.names), bool(self.speed))
        return found if self.within is None else {n: C @ self.within for n, C in found.items()}

    @cached_property
    def rows(self) -> np.ndarray:
        """All parts of C as real rows: what laws feel of the motions."""
        return np.vstack([np.vstack([C.real, C.imag]) for C in self.journals.values()])


@dataclass(frozen=True, eq=False)
class Rest:
    """The rest at one spin speed, under loads."""

    unloaded: Unloaded
    rates: tuple[float, float]  # of the second phase, and Ω/r [rad/s]
    revolutions: int  # r
    loads: Terms  # harmonics of θ, of both signs

    @property
    def speed(self) -> float:
        """Ω [rad/s]."""
        return self.unloaded.speed

    def frequencies(self, orders: np.ndarray) -> np.ndarray:
        """Return ν (h,) of harmonics (k, n) (h, 2) [rad/s]."""
        return orders @ np.array(self.rates)

    def _stiffness(self, nu: np.ndarray) -> np.ndarray:
        """Return Z (h, r, r) at frequencies (h,)."""
        M, D, K = self.unloaded.system.matrices()
        nu = nu[:, None, None]
        Z = K + 1j * nu * D - nu**2 * M
        for n, H in self.unloaded.system.H:
            Z = Z + 1j * np.sign(nu - n * self.speed) * H
        return Z

    def moved(self) -> dict[tuple[int, int], np.ndarray]:
        """Return q⁰ (d,) by its harmonics (0, n)."""
        found: dict[tuple[int, int], np.ndarray] = {}
        for n, x in self._loaded.items():
            for m, C in self.unloaded.journals.items():
                order = 0, self.revolutions * (n + m)
                found[order] = found.get(order, 0.0) + C @ x
        return found

    @cached_property
    def _loaded(self) -> dict[int, np.ndarray]:
        """The motion (r,) under the loads alone, by harmonics of θ."""
        orders = [n for n, F in self.loads.items() if np.any(F)]
        if not orders:
            return {}
        F = np.array([self.unloaded.basis.T @ self.loads[n] for n in orders])
        Z = self._stiffness(self.speed * np.array(orders))
        return dict(zip(orders, np.linalg.solve(Z, F[..., None])[..., 0], strict=True))

    def receptances(self, reach: tuple[int, int]) -> dict[int, Coupling]:
        """Return H^p of (1) by p, for all harmonics up to K and N, in their order."""
        key = reach, self.rates, self.revolutions
        if key not in self.unloaded.known:
            self.unloaded.known[key] = self._receptances(reach)
        return self.unloaded.known[key]

    def _receptances(self, reach: tuple[int, int]) -> dict[int, Coupling]:
        K, N = reach
        waves = sorted(self.unloaded.journals)
        C = np.concatenate([self.unloaded.journals[m] for m in waves])
        wide = N + self.revolutions * max(map(abs, waves))
        n = np.arange(-wide, wide + 1)
        orders = np.array([(k, each) for k in range(K + 1) for each in n if k or each >= 0])
        Z = self._stiffness(self.frequencies(orders))
        half = C @ np.linalg.solve(Z, C.T.astype(complex))
        d = len(C) // len(waves)
        known = half.reshape(len(orders), len(waves), d, len(waves), d)
        # those of −k, −n are conjugates, with opposite m
        turned = known[::-1, ::-1, :, ::-1].conj()
        known = np.concatenate([turned[:-1], known]).reshape(
            2 * K + 1, 2 * wide + 1, len(waves), d, len(waves), d
        )
        inside, found = np.arange(-N, N + 1), {}
        for b, m in enumerate(waves):
            for a, other in enumerate(waves):
                p = m + other
                columns = inside[np.abs(inside + self.revolutions * p) <= N]
                H = known[:, columns + self.revolutions * m + wide][:, :, a, :, b]
                place = (np.arange(2 * K + 1)[:, None] * (2 * N + 1) + columns + N).ravel()
                H = H.reshape(-1, d, d)
                if p in found:
                    H = H + found[p][2]
                found[p] = place + self.revolutions * p, place, H
        largest = max((np.abs(H).max(initial=0.0) for *_, H in found.values()), default=0.0)
        return {
            p: each
            for p, each in found.items()
            if p == 0 or np.abs(each[2]).max(initial=0.0) > _SMALL * largest
        }

    def coordinates(
        self, forces: np.ndarray, orders: np.ndarray
    ) -> dict[tuple[int, int], np.ndarray]:
        """Return the motion (k,) under loads and forces g (h, d), by all harmonics."""
        loads: dict[tuple[int, int], np.ndarray] = {}
        for (k, n), g in zip(orders.tolist(), forces, strict=True):
            for m, C in self.unloaded.journals.items():
                order = k, n + self.revolutions * m
                loads[order] = loads.get(order, 0.0) + C.T @ g
        for n, F in self.loads.items():
            order = 0, self.revolutions * n
            loads[order] = loads.get(order, 0.0) + self.unloaded.basis.T @ F
        keys = [order for order in loads if order >= (0, 0)]
        Z = self._stiffness(self.frequencies(np.array(keys)))
        F = np.array([loads[order] for order in keys], dtype=complex)
        x = np.linalg.solve(Z, F[..., None])[..., 0] @ self.unloaded.basis.T
        found = dict(zip(keys, x, strict=True))
        return found | {(-k, -n): each.conj() for (k, n), each in found.items()}


def of_both_signs(load: Mapping[int, np.ndarray]) -> dict[int, np.ndarray]:
    """Return harmonics F of both signs of ``Re Σ F_n exp(inθ)``."""
    return {
        n: 0.5 * (load.get(n, 0.0) + np.conj(load.get(-n, 0.0)))
        for n in {*load, *(-n for n in load)}
    }
