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
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import eigh, orth

from exudyn_rotor.calls import kept
from exudyn_rotor.linear.equations import PeriodicSystem, Terms, difference, stacked
from exudyn_rotor.linear.model.linear_model import ON_FOUNDATION, LinearModel

Coupling = tuple[np.ndarray, np.ndarray, np.ndarray]  # rows, columns, H (h, d, d)
Waves = dict[tuple[int, int], np.ndarray]  # by harmonics (k, n)
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

    @cached_property
    def for_stability(self) -> Unloaded:
        """The rest in axes that stand still, if it can be."""
        return Unloaded(self.standing, self.names, self.speed) if self.standing else self

    def up_to(self, frequency: float) -> tuple[PeriodicSystem, Terms]:
        """Return equations and C of motions up to a frequency [rad/s], and static ones of others.

        Faster motions follow the forces of the laws as springs do: of them the basis keeps what
        they yield to constant forces.
        """
        M, _, K = self.system.matrices()
        squares, shapes = eigh(0.5 * (K + K.T), 0.5 * (M + M.T))
        fast = squares > frequency**2
        felt = real_rows(self.journals) @ shapes[:, fast]
        yields = shapes[:, fast] @ (felt / squares[fast]).T
        static = orth(yields, rcond=_DEPENDENT) if np.any(yields) else yields[:, :0]
        if static.shape[1] >= np.sum(fast):
            return self.system, self.journals
        within = np.hstack([shapes[:, ~fast], static])
        return self.system.projected(within), {n: C @ within for n, C in self.journals.items()}

    @cached_property
    def basis(self) -> np.ndarray:
        """Motions that something resists, (k, r)."""
        return resisted(self.model)

    @cached_property
    def system(self) -> PeriodicSystem:
        """The equations of these motions."""
        return self.model.at(self.speed).projected(self.basis)

    @cached_property
    def journals(self) -> Terms:
        """C (d, r)."""
        return _journals(self.model, tuple(self.names), bool(self.speed))

    def answer(self, nu: np.ndarray, F: np.ndarray) -> np.ndarray:
        """Return ``Z⁻¹ F`` at frequencies (h,), F (r, m) or (h, r, m)."""
        M, D, K = self.system.matrices()
        nu = nu[:, None, None]
        Z = K + 1j * nu * D - nu**2 * M
        for n, H in self.system.H:
            Z = Z + 1j * np.sign(nu - n * self.speed) * H
        return np.linalg.solve(Z, F.astype(complex))

    @kept
    def receptances(
        self, rates: tuple[float, float], revolutions: int, reach: tuple[int, int]
    ) -> dict[int, Coupling]:
        """Return H^p of (1) by p, for all harmonics up to K and N, in their order."""
        K, N = reach
        waves = sorted(self.journals)
        C = np.concatenate([self.journals[m] for m in waves])
        wide = N + revolutions * max(map(abs, waves))
        k, n = np.arange(K + 1)[:, None], np.arange(-wide, wide + 1)
        half = C @ self.answer((rates[0] * k + rates[1] * n).ravel(), C.T)
        d = len(C) // len(waves)
        half = half.reshape(K + 1, 2 * wide + 1, len(waves), d, len(waves), d)
        # those of −k, −n are conjugates, with opposite m
        known = np.concatenate([half[:0:-1, ::-1, ::-1, :, ::-1].conj(), half])
        inside, found = np.arange(-N, N + 1), {}
        for b, m in enumerate(waves):
            for a, other in enumerate(waves):
                p = m + other
                columns = inside[np.abs(inside + revolutions * p) <= N]
                H = known[:, columns + revolutions * m + wide][:, :, a, :, b].reshape(-1, d, d)
                place = (np.arange(2 * K + 1)[:, None] * (2 * N + 1) + columns + N).ravel()
                found[p] = place + revolutions * p, place, H + (found[p][2] if p in found else 0.0)
        sizes = {p: np.abs(H).max(initial=0.0) for p, (_, _, H) in found.items()}
        least = _SMALL * max(sizes.values())
        return {p: each for p, each in found.items() if p == 0 or sizes[p] > least}


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

    def motion(self, orders: Sequence = (), forces: Sequence[np.ndarray] = ()) -> Waves:
        """Return the resisted motion (r,) under loads and forces g (d,), by all harmonics."""
        basis, journals = self.unloaded.basis, self.unloaded.journals
        given = {(0, self.revolutions * n): basis.T @ F for n, F in self.loads.items()}
        for (k, n), g in zip(orders, forces, strict=True):
            for m, C in journals.items():
                order = k, n + self.revolutions * m
                given[order] = given.get(order, 0.0) + C.T @ g
        if not given:
            return {}
        F = np.array(list(given.values()))[..., None]
        x = self.unloaded.answer(np.array(list(given)) @ np.array(self.rates), F)[..., 0]
        return dict(zip(given, x, strict=True))


def real_rows(journals: Terms) -> np.ndarray:
    """Return all parts of C as real rows: what laws feel of the motions."""
    return np.vstack([part for C in journals.values() for part in (C.real, C.imag)])


def of_both_signs(load: Mapping[int, np.ndarray]) -> dict[int, np.ndarray]:
    """Return harmonics F of both signs of ``Re Σ F_n exp(inθ)``."""
    return {
        n: 0.5 * (load.get(n, 0.0) + np.conj(load.get(-n, 0.0)))
        for n in {*load, *(-n for n in load)}
    }
