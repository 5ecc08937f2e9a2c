"""Steady forced motion: harmonics of the speed on a frequency, constant equations or periodic.

Loads ``f(t) = Re Σ F_n exp(i(ω + nΩ)t)`` give ``x(t) = Re Σ X_m exp(i(ω + mΩ)t)`` with

    (K_0 + iν_m D_0 − ν_m² M) X_m + Σ_j (K_j + iν_{m−j} D_j) X_{m−j} = F_m,    ν_m = ω + mΩ.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import scipy.linalg as la

from exudyn_rotor.linear.equations import PeriodicSystem
from exudyn_rotor.linear.solve.chain import chained, reach
from exudyn_rotor.linear.solve.state import others

Harmonics = Mapping[int, np.ndarray]
_STILL = 1e-12  # share of ω and Ω: a frequency that is zero but for rounding
_FREE = 1e-12  # share of the largest stiffness: a coordinate that nothing resists
_NONE = 1e-14  # of matrices with diagonals of one: a motion that nothing resists
_FAR = 1e6  # of matrices with diagonals of one: size of a solution without free motions
_LOADED = 1e-6  # share of a load on a free motion that is the rounding of a mesh
_SINGULAR = 1e-14  # reciprocal condition of equations without a solution
_MOST = 12  # harmonics that are added on either side, in steps of the coefficients


def forced_motions(
    systems: Sequence[PeriodicSystem],
    loads: Sequence[Harmonics],
    rates: Sequence[float],
    *,
    held: np.ndarray | None = None,
    driven: np.ndarray | None = None,
    tolerance: float = 1e-6,
) -> list[dict[int, np.ndarray]]:
    """Return the harmonics (k,) of the steady motion of systems of the same coordinates.

    One system, load and frequency for each motion. A motion that does not exist is NaN: a constant
    load on what nothing holds, a resonance without damping, harmonics that do not converge.

    Parameters
    ----------
    systems : sequence of PeriodicSystem
    loads : sequence of mapping of int to ndarray
    rates : sequence of float
        ω [rad/s].
    held : ndarray, shape (k, r), optional
        Motions that are possible, orthonormal; all by default.
    driven : ndarray, shape (k, d), optional
        Momenta of motions whose constant part a drive keeps at zero: free spins.
    tolerance : float, optional
        Largest relative change of a motion by further harmonics.
    """
    if driven is not None and not driven.shape[1]:
        driven = None
    if held is not None:
        momenta, driven = la.null_space(held.T), None
        systems = _each(systems, lambda system: _without(system, momenta))
        loads = [{n: F - momenta @ (momenta.T @ F) for n, F in each.items()} for each in loads]
    found: list[dict] = [{} for _ in systems]
    constant = [i for i, system in enumerate(systems) if system.is_constant]
    if constant:
        given = [[each[i] for i in constant] for each in (systems, loads, rates)]
        for i, motion in zip(constant, _constant(*given, driven), strict=True):
            found[i] = motion
    groups: dict[tuple, list[int]] = {}
    for i, system in enumerate(systems):
        if not system.is_constant:
            acting = tuple(sorted(n for n, F in loads[i].items() if np.any(F)))
            groups.setdefault((system.step, acting, reach(system)), []).append(i)
    for (step, acting, _), members in groups.items():
        for n in {n % step: n for n in acting}:  # harmonics that are coupled
            together = [m for m in acting if m % step == n]
            given = [[each[i] for i in members] for each in (systems, loads, rates)]
            motions = _periodic(*given, together, driven, tolerance)
            for i, motion in zip(members, motions, strict=True):
                found[i] |= motion
        for i in members:
            found[i] = found[i] or {n: 0j * F for n, F in loads[i].items()}
    return found


def _without(system: PeriodicSystem, momenta: np.ndarray) -> PeriodicSystem:
    """Return a system whose motions with momenta (k, r), orthonormal, are stiff by themselves."""

    def apart(X: np.ndarray) -> np.ndarray:
        X = X - momenta @ (momenta.T @ X)
        return X - (X @ momenta) @ momenta.T

    D, K = ({n: apart(X) for n, X in terms.items()} for terms in (system.D, system.K))
    K[0] = K[0] + np.abs(K[0]).max() * momenta @ momenta.T
    H = [(n, apart(X)) for n, X in system.H]
    return PeriodicSystem(system.speed, apart(system.M), D, K, H)


def _each(systems: Sequence[PeriodicSystem], change) -> list[PeriodicSystem]:
    """Return what a function makes of systems, once for those that are one object."""
    made: dict[int, PeriodicSystem] = {}
    return [made.setdefault(id(s), None) or made.update({id(s): change(s)}) or made[id(s)]
            for s in systems]  # fmt: skip


def _constant(
    systems: list[PeriodicSystem],
    loads: list[Harmonics],
    rates: list[float],
    driven: np.ndarray | None,
) -> list[dict[int, np.ndarray]]:
    """Return the motions of constant equations: every harmonic by itself, all at once."""
    places = [(i, n) for i, each in enumerate(loads) for n, F in each.items() if np.any(F)]
    found: list[dict] = [{n: 0j * F for n, F in each.items()} for each in loads]
    if not places:
        return found
    at_rest = {id(s): s.matrices() for s in systems}
    nu = np.array([_rate(rates[i], n, systems[i].speed) for i, n in places])
    F = np.array([loads[i][n] for i, n in places])
    matrices = np.stack(
        [
            _dynamic(systems[i], at_rest[id(systems[i])], v)
            for (i, _), v in zip(places, nu, strict=True)
        ]
    )
    X = _solved(matrices, F, nu == 0.0, driven)
    for (i, n), x in zip(places, X, strict=True):
        found[i][n] = x
    return found


def _rate(rate: float, order: int, speed: float) -> float:
    nu = rate + order * speed
    return 0.0 if abs(nu) <= _STILL * max(abs(rate), abs(speed)) else nu


def _dynamic(system: PeriodicSystem, matrices: tuple, nu: float) -> np.ndarray:
    """Return ``K + iνD − ν²M`` with structural damping."""
    M, D, K = matrices
    Z = K if nu == 0.0 else K + 1j * nu * D - nu**2 * M
    for n, H in system.H:
        Z = Z + 1j * np.sign(_rate(nu, -n, system.speed)) * H
    return Z


def _solved(
    matrices: np.ndarray, loads: np.ndarray, constant: np.ndarray, driven: np.ndarray | None
) -> np.ndarray:
    """Return solutions (s, k), NaN where there is none; those of `constant` loads one by one."""
    X = np.full(loads.shape, np.nan, dtype=complex)
    moving = np.flatnonzero(~constant)
    if moving.size:
        A = matrices[moving]
        scale = 1.0 / np.sqrt(np.maximum(np.abs(A).max(axis=2), 1e-300))
        A = scale[:, :, None] * A * scale[:, None, :]
        try:
            Y = np.linalg.solve(A, (scale * loads[moving])[..., None])[..., 0]
        except np.linalg.LinAlgError:
            Y = np.array([_one(a, b) for a, b in zip(A, scale * loads[moving], strict=True)])
        off = np.linalg.norm(np.einsum("sij,sj->si", A, Y) - scale * loads[moving], axis=1)
        large = (
            np.linalg.norm(Y, axis=1) > np.linalg.norm(scale * loads[moving], axis=1) / _SINGULAR
        )
        Y[large | ~np.isfinite(off)] = np.nan
        X[moving] = scale * Y
    still = np.flatnonzero(constant)
    if driven is None or not driven.shape[1]:
        still = still[~_plainly(matrices, loads, still, X)]
    for i in still:
        X[i] = static_motion(matrices[i], loads[i], driven)
    return X


def _plainly(A: np.ndarray, loads: np.ndarray, still: np.ndarray, X: np.ndarray) -> np.ndarray:
    """Put solutions under constant loads into X where no motion is free; return where that is."""
    done = np.zeros(len(still), dtype=bool)
    if not still.size:
        return done
    A, b = A[still], loads[still]
    diagonal = np.abs(A).max(axis=2)
    alone = diagonal <= _FREE * diagonal.max(axis=1, keepdims=True)
    scale = 1.0 / np.sqrt(np.where(alone, 1.0, diagonal))
    b = scale * b
    unloaded = np.abs(b * alone).max(axis=1) <= _LOADED * np.abs(b).max(axis=1)
    held = np.flatnonzero(~np.any(alone, axis=0))
    alike = unloaded & (alone.sum(axis=1) == alone.shape[1] - len(held))
    chosen = np.flatnonzero(alike)
    A = A[np.ix_(chosen, held, held)] * scale[chosen][:, held, None] * scale[chosen][:, None, held]
    try:
        Y = np.linalg.solve(A, b[np.ix_(chosen, held)][..., None])[..., 0]
    except np.linalg.LinAlgError:
        return done
    done[chosen] = np.linalg.norm(Y, axis=1) <= _FAR * np.linalg.norm(b[chosen], axis=1)
    small = chosen[done[chosen]]
    X[np.ix_(still[small], held)] = (scale[chosen][:, held] * Y)[done[chosen]]
    others = np.setdiff1d(np.arange(X.shape[1]), held)
    X[np.ix_(still[small], others)] = 0.0
    return done


def _one(A: np.ndarray, b: np.ndarray) -> np.ndarray:
    try:
        return np.linalg.solve(A, b)
    except np.linalg.LinAlgError:
        return np.full(len(b), np.nan, dtype=complex)


def static_motion(A: np.ndarray, load: np.ndarray, driven: np.ndarray | None = None) -> np.ndarray:
    """Return the motion (k,) under a constant load; free motions that it does not act on rest.

    NaN where it acts on a motion that nothing holds.

    Parameters
    ----------
    A : ndarray, shape (k, k)
        Stiffness.
    load : ndarray, shape (k,)
    driven : ndarray, shape (k, d), optional
        Momenta of motions that a drive keeps at zero.
    """
    if driven is not None and driven.shape[1]:
        basis = others(driven, np.eye(len(A)))  # mixes no soft coordinates with stiff ones
        return basis @ static_motion(basis.T @ A @ basis, basis.T @ load, None)
    diagonal = np.abs(A).max(axis=1)
    alone = diagonal <= _FREE * diagonal.max(initial=0.0)
    scale = 1.0 / np.sqrt(np.where(alone, 1.0, diagonal))
    scaled, b = scale[:, None] * A * scale, scale * load
    scaled[alone] = scaled[:, alone] = 0.0
    U, values, Vh = np.linalg.svd(scaled)
    free = values <= _NONE * values.max(initial=0.0)
    if np.linalg.norm(U[:, free].conj().T @ b) > _LOADED * np.linalg.norm(b):
        return np.full(len(load), np.nan, dtype=complex)
    kept = ~free
    return scale * (Vh[kept].conj().T @ ((U[:, kept].conj().T @ b) / values[kept]))


def _periodic(
    systems: list[PeriodicSystem],
    loads: list[Harmonics],
    rates: list[float],
    acting: list[int],
    driven: np.ndarray | None,
    tolerance: float,
) -> list[dict[int, np.ndarray]]:
    """Return the harmonics of periodic equations, as many as the tolerance needs.

    Of systems with one step, under the coupled harmonics `acting` of the loads.
    """
    step, far, found = systems[0].step, reach(systems[0]), [{} for _ in systems]
    loads = [{n: load[n] for n in acting} for load in loads]
    left = np.arange(len(systems))
    last = None
    for more in range(2, _MOST):
        most = more * far * step
        orders = range(acting[0] - most, acting[-1] + most + 1, step)
        given = [[each[i] for i in left] for each in (systems, loads, rates)]
        X = _in_chain(*given, orders, driven)
        size = np.abs(X).max(axis=(1, 2))
        done = ~np.isfinite(size)
        if last is not None:
            change = np.abs(X - np.pad(last, ((0, 0), (far, far), (0, 0)))).max(axis=(1, 2))
            done |= change <= tolerance * size
        for row in np.flatnonzero(done):
            found[left[row]] = dict(zip(orders, X[row], strict=True))
        left, last = left[~done], X[~done]
        if not left.size:
            return found
    for i in left:
        found[i] = {n: np.full(systems[i].size, np.nan, dtype=complex) for n in acting}
    return found


def _in_chain(
    systems: list[PeriodicSystem],
    loads: list[Harmonics],
    rates: list[float],
    orders: Sequence[int],
    driven: np.ndarray | None,
) -> np.ndarray:
    """Return the harmonics (s, h, k) of systems whose harmonics are coupled in a chain."""
    nu = np.array([[_rate(float(rate), n, system.speed) for n in orders]
                   for rate, system in zip(rates, systems, strict=True)])  # fmt: skip
    at_mean = {id(s): (s.M, s.D[0].real, s.K[0].real) for s in systems}

    def stiffness(i: int, a: int) -> np.ndarray:
        return _dynamic(systems[i], at_mean[id(systems[i])], nu[i, a])

    X = np.zeros((len(systems), len(orders), systems[0].size), dtype=complex)
    places = [tuple(np.flatnonzero(row == 0.0)) for row in nu]
    for place in set(places):  # where a constant harmonic stands
        few = [i for i, one in enumerate(places) if one == place]
        given = [[each[i] for i in few] for each in (systems, loads)]

        def middle(
            A: np.ndarray, b: np.ndarray, link: slice, place: tuple = place, few: list = few
        ) -> np.ndarray:
            momenta = driven
            if place and driven is not None:
                momenta = np.zeros((link.stop - link.start, *driven.shape))
                momenta[place[0] - link.start] = driven
                momenta = momenta.reshape(-1, driven.shape[1])
            return _solved(A, b, np.full(len(few), bool(place)), momenta)

        X[few] = chained(
            *given, orders, nu[few], lambda i, a, few=few: stiffness(few[i], a), middle
        )
    for i in np.flatnonzero(np.isnan(X).any(axis=(1, 2))):  # a link by itself may be singular
        X[i] = _whole(systems[i], loads[i], float(rates[i]), orders, driven)
    return X


def _whole(
    system: PeriodicSystem,
    load: Harmonics,
    rate: float,
    orders: Sequence[int],
    driven: np.ndarray | None,
) -> np.ndarray:
    """Return the harmonics (h, k) of one system from one matrix."""
    A, nu = coupled_stiffness(system, rate, orders)
    F = np.concatenate([np.zeros(system.size) + load.get(n, 0.0) for n in orders]) + 0j
    momenta, still = None, np.flatnonzero(np.array(nu) == 0.0)
    if still.size and driven is not None:
        momenta = np.zeros((len(orders), *driven.shape))
        momenta[still[0]] = driven
        momenta = momenta.reshape(-1, driven.shape[1])
    X = _solved(A[None], F[None], np.array([still.size > 0]), momenta)
    return X.reshape(len(orders), system.size)


def coupled_stiffness(
    system: PeriodicSystem, rate: float, orders: Sequence[int]
) -> tuple[np.ndarray, list[float]]:
    """Return the dynamic stiffness between harmonics, (h k, h k), and their frequencies [rad/s]."""
    h, k = len(orders), system.size
    A = np.zeros((h, k, h, k), dtype=complex)
    nu = [_rate(rate, int(n), system.speed) for n in orders]
    for a, m in enumerate(orders):
        for b, n in enumerate(orders):
            for terms, factor in ((system.K, 1.0), (system.D, 1j * nu[b])):
                if m - n in terms:
                    A[a, :, b] += factor * terms[m - n]
        A[a, :, a] -= nu[a] ** 2 * system.M
        for n, H in system.H:
            A[a, :, a] += 1j * np.sign(_rate(nu[a], -n, system.speed)) * H
    return A.reshape(h * k, h * k), nu
