"""Steady forced motion: harmonics of the speed on a frequency, constant equations or periodic.

Loads ``f(t) = Re Σ F_n exp(i(ω + nΩ)t)`` give ``x(t) = Re Σ X_m exp(i(ω + mΩ)t)`` with

    Z_m X_m + Σ_{j≠0} (K_j + iν_{m−j} D_j) X_{m−j} = F_m,    Z_m = K_0 + iν_m D_0 − ν_m² M,

ν_m = ω + mΩ. Harmonics of constant equations stand alone. Else the coefficients that repeat are
forces of few supports, ``K_j = B k_j Bᵀ``, so that after one solution with each Z_m the harmonics
of Bᵀx alone are coupled.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from exudyn_rotor.linear.equations import PeriodicSystem, others, spanned

Harmonics = Mapping[int, np.ndarray]
_STILL = 1e-12  # share of ω and Ω: a frequency that is zero but for rounding
_FREE = 1e-12  # share of the largest stiffness: a coordinate that nothing resists
_NONE = 1e-14  # of matrices with diagonals of one: a motion that nothing resists
_FAR = 1e6  # of matrices with diagonals of one: size of a solution without free motions
_LOADED = 1e-6  # share of a load on a free motion that is the rounding of a mesh
_SINGULAR = 1e-14  # reciprocal condition of equations without a solution
_MOST = 16  # harmonics that are added on either side, in steps of the coefficients


def forced_motions(
    system: PeriodicSystem,
    loads: Harmonics,
    rates: np.ndarray,
    *,
    held: np.ndarray | None = None,
    driven: np.ndarray | None = None,
    tolerance: float = 1e-6,
) -> dict[int, np.ndarray]:
    """Return the harmonics (s, k) of the steady motions of a system, or of a stack of s.

    A motion that does not exist is NaN: a constant load on what nothing holds, a resonance without
    damping, harmonics that do not converge.

    Parameters
    ----------
    system : PeriodicSystem
        At one speed for all motions, or a stack.
    loads : mapping of int to ndarray, shape (k,) or (s, k)
    rates : ndarray, shape (s,)
        ω [rad/s].
    held : ndarray, shape (k, r), optional
        Basis of motions in which the equations are solved; all motions by default.
    driven : ndarray, shape (k, d), optional
        Momenta of motions whose constant part a drive keeps at zero: free spins.
    tolerance : float, optional
        Largest relative change of a motion by further harmonics.
    """
    if held is not None:
        loads = {n: F @ held for n, F in loads.items()}
        found = forced_motions(system.projected(held), loads, rates, tolerance=tolerance)
        return {n: X @ held.T for n, X in found.items()}
    shape = len(rates), system.size
    acting = {n: np.broadcast_to(F, shape) for n, F in loads.items() if np.any(F)}
    if system.is_constant:
        mean = system.matrices()
        return {
            n: _harmonic(system, mean, rates, n, F[..., None], driven)[..., 0]
            for n, F in acting.items()
        }
    if not np.any(rates):  # only the real part of all harmonics together is a load
        none = np.zeros(shape)
        acting = {
            n: 0.5 * (acting.get(n, none) + acting.get(-n, none).conj())
            for n in {*acting, *(-n for n in acting)}
        }
    found = {}
    for first in {n % system.step for n in acting}:  # harmonics that are coupled
        together = {n: F for n, F in acting.items() if n % system.step == first}
        found |= _coupled(system, together, rates, driven, tolerance)
    return found


def _rate(rates: np.ndarray, order: int, speed: np.ndarray) -> np.ndarray:
    """Return the frequencies ω + nΩ; zero where they are rounding."""
    nu = rates + order * speed
    return np.where(np.abs(nu) <= _STILL * np.maximum(np.abs(rates), np.abs(speed)), 0.0, nu)


def _harmonic(
    system: PeriodicSystem,
    mean: tuple[np.ndarray, ...],
    rates: np.ndarray,
    order: int,
    F: np.ndarray,
    driven: np.ndarray | None,
) -> np.ndarray:
    """Return a harmonic (s, k, c) by itself under loads (s, k, c), NaN where there is none.

    At the frequency zero it is static: free motions that a load does not act on rest.
    """
    M, D, K = mean
    nu = _rate(rates, order, system.speed)
    w = nu[:, None, None]
    Z = K - w**2 * M
    if np.any(nu):
        Z = Z + 1j * (w * D)
    for n, H in system.H:
        Z = Z + 1j * np.sign(_rate(nu, -n, system.speed))[:, None, None] * H
    X, still = np.full(F.shape, np.nan, dtype=complex), nu == 0.0
    if np.any(still):
        X[still] = static_motions(Z[still], F[still], driven)
    if not np.all(still):
        Z, F = Z[~still], F[~still]
        moved = _one_by_one(Z, F)
        size = np.sqrt(np.maximum(np.abs(Z[len(Z) // 2]).max(axis=1), 1e-300))[:, None]
        loads = np.linalg.norm(F / size, axis=(1, 2))
        moved[np.linalg.norm(size * moved, axis=(1, 2)) > loads / _SINGULAR] = np.nan
        X[~still] = moved
    return X


def _one_by_one(A: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return solutions (s, k, c), NaN of singular matrices."""
    try:
        return np.linalg.solve(A, b)
    except np.linalg.LinAlgError:
        if len(A) == 1:
            return np.full(b.shape, np.nan, dtype=np.result_type(A, b))
        return np.concatenate([_one_by_one(A[i : i + 1], b[i : i + 1]) for i in range(len(A))])


def static_motions(A: np.ndarray, F: np.ndarray, driven: np.ndarray | None = None) -> np.ndarray:
    """Return the motions (s, k, c) by stiffnesses (s, k, k) under constant loads (s, k, c).

    Free motions that a load does not act on rest; NaN where it acts on a motion that nothing holds.
    """
    if driven is not None and driven.shape[1]:
        basis = others(driven)  # mixes no soft coordinates with stiff ones
        return basis @ static_motions(basis.T @ A @ basis, basis.T @ F)
    size = np.abs(A).max(axis=2)
    resisted = size > _FREE * size.max(axis=1, initial=0.0, keepdims=True)
    scale = 1.0 / np.sqrt(np.where(resisted, size, 1.0))[..., None]
    A = scale * A * scale[:, None, :, 0] * (resisted[:, :, None] & resisted[:, None])
    b = scale * F
    X = _one_by_one(A, b)
    held = np.linalg.norm(X, axis=1) <= _FAR * np.linalg.norm(b, axis=1)
    for i in np.flatnonzero(~np.all(held, axis=1)):
        X[i] = _beside_free(A[i], b[i])
    return scale * X


def _beside_free(A: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return motions (k, c) without those that nothing resists; NaN of loads on these."""
    U, values, Vh = np.linalg.svd(A)
    free = values <= _NONE * values.max(initial=0.0)
    X = Vh[~free].conj().T @ ((U[:, ~free].conj().T @ b) / values[~free, None])
    loaded = np.linalg.norm(U[:, free].conj().T @ b, axis=0) > _LOADED * np.linalg.norm(b, axis=0)
    X[:, loaded] = np.nan
    return X


# ------------------------------------------------------------------ periodic equations


def _acting(system: PeriodicSystem) -> np.ndarray:
    """Return a basis (k, r) of the forces that repeat, and of the motions that they depend on."""
    weights, rows = np.random.default_rng(0), []
    for terms in (system.K, system.D):
        for n, X in terms.items():
            if n > 0:  # over speeds, a sum with any weights has the rows and columns of all
                each = weights.uniform(0.5, 1.5, np.size(system.speed))
                mean = np.tensordot(each, X, axes=(0, 0)) if X.ndim == 3 else X * each
                mean = mean / (np.abs(mean).max() or 1.0)
                rows += [part for Y in (mean, mean.T) for part in (Y.real, Y.imag)]
    return spanned(np.hstack(rows))


def _coupled(
    system: PeriodicSystem,
    loads: Harmonics,
    rates: np.ndarray,
    driven: np.ndarray | None,
    tolerance: float,
    more: int = 2,
) -> dict[int, np.ndarray]:
    """Return the harmonics of periodic equations, as many as the tolerance needs.

    At first so many `more` than the loads have, on either side in steps of the coefficients, then
    twice as many where these do not suffice. The next ones follow from the last two by the ratio
    of these.
    """
    far = system.highest // system.step  # neighbours that a harmonic is coupled with
    most = more * far * system.step
    orders = list(range(min(loads) - most, max(loads) + most + 1, system.step))
    X = _chain(system, loads, rates, driven, orders)
    sizes = np.abs(X).max(axis=2)
    last = np.maximum(sizes[:, :far].max(axis=1), sizes[:, -far:].max(axis=1))
    inner = sizes[:, far : len(orders) - far]
    before = np.maximum(inner[:, :far].max(axis=1), inner[:, -far:].max(axis=1))
    left = last * np.minimum(last, before) > tolerance * sizes.max(axis=1) * before
    found = dict(zip(orders, X.swapaxes(0, 1), strict=True))
    if not np.any(left):
        return found
    X[left] = np.nan
    if 2 * more <= _MOST:
        some = {n: F[left] for n, F in loads.items()}
        rest = system[left] if np.ndim(system.speed) else system
        for n, x in _coupled(rest, some, rates[left], driven, tolerance, 2 * more).items():
            found.setdefault(n, np.zeros_like(X[:, 0]))[left] = x
    return found


def _chain(
    system: PeriodicSystem,
    loads: Harmonics,
    rates: np.ndarray,
    driven: np.ndarray | None,
    orders: Sequence[int],
) -> np.ndarray:
    """Return the harmonics (s, h, k) of a chain of them.

    Each harmonic is solved by itself under its load and under the forces B. Those forces follow
    from the motions of all harmonics.
    """
    s, h, B = len(rates), len(orders), _acting(system)
    r, standing = B.shape[1], not np.any(rates)
    # at frequencies ±nΩ, under conjugate loads, motions are conjugate
    solved = [n for n in orders if n >= 0 or not standing or -n not in orders]
    mean, alone = (system.M, system.D[0].real, system.K[0].real), {}
    for n in solved:
        F = np.zeros((s, system.size, 1 + r), dtype=complex)
        F[..., 0], F[..., 1:] = loads.get(n, 0.0), B
        alone[n] = _harmonic(system, mean, rates, n, F, driven)
    alone |= {n: alone[-n].conj() for n in orders if n not in alone}
    each = np.stack([alone[n] for n in orders], axis=1)  # (s, h, k, 1 + r)
    seen = B.T @ each
    forces = np.zeros((s, h, r, h, r), dtype=complex)
    for terms, power in ((system.K, 0), (system.D, 1)):
        for m, X in terms.items():
            if m == 0:
                continue
            acting = B.T @ X @ B
            for b, n in enumerate(orders):
                if n + m in orders:
                    nu = _rate(rates, n, system.speed)[:, None, None]
                    forces[:, orders.index(n + m), :, b] += (1j * nu) ** power * acting
    A = (seen[..., 1:] @ forces.reshape(s, h, r, h * r)).reshape(s, h * r, h * r) + np.eye(h * r)
    y = _one_by_one(A, seen[..., 0].reshape(s, h * r, 1))
    pushed = (forces.reshape(s, h * r, h * r) @ y).reshape(s, h, r, 1)
    return each[..., 0] - (each[..., 1:] @ pushed)[..., 0]
