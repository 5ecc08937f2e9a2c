"""Equations of the harmonics of periodic systems, and what the harmonics left out do to those kept.

With ``x(t) = exp(λt) Σ_m X_m exp(i m Ω t)`` the equations of :class:`PeriodicSystem` become, for
every harmonic n,

    Σ_m [(λ + imΩ)² M_{n−m} + (λ + imΩ) D_{n−m} + K_{n−m}] X_m = F_n
"""

from __future__ import annotations

import numpy as np

from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, Terms, times

# shares of the speed of which the first keeps matrices invertible
_OFF_ROOT = 0.0, 1e-9, 1e-6, 1e-3


def hill_matrices(
    system: PeriodicSystem, orders: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return (M, D, K) of ``(λ²M + λD + K) X = F`` for the harmonics `orders`.

    Shape (h k, h k), complex, harmonic by harmonic in the order given. Orders are whole numbers
    apart.
    """
    if len(orders) == 1 and orders[0] == 0:
        return tuple(terms[0].astype(complex) for terms in (system.M, system.D, system.K))
    M, D, K = (_blocks(terms, orders, system.size) for terms in (system.M, system.D, system.K))
    rate = np.repeat(1j * orders * system.speed, system.size)
    return M, D + 2.0 * M * rate, K + D * rate + M * rate**2


def dynamic_stiffness(
    system: PeriodicSystem, multiples: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the Hermitian part of the dynamic stiffness at the frequencies `multiples`·Ω, and M.

    Shape (h k, h k), harmonic by harmonic, real for the harmonic 0 alone. The multiples are whole
    numbers apart.
    """
    if len(multiples) == 1 and multiples[0] == 0:
        M, K = system.M[0].real, system.K[0].real
        return 0.5 * (K + K.T), M
    M, _, H = hill_matrices(system, multiples)
    return 0.5 * (H + H.conj().T), M


def _blocks(terms: Terms, orders: np.ndarray, size: int) -> np.ndarray:
    """Return the block matrix with ``terms[n − m]`` at row n, column m."""
    blocks = np.zeros((len(orders), size, len(orders), size), dtype=complex)
    places = {round(m - orders[0]): j for j, m in enumerate(orders)}
    for n, term in terms.items():
        for m, j in places.items():
            i = places.get(m + n)
            if i is not None:
                blocks[i, :, j, :] = term
    return blocks.reshape(len(orders) * size, -1)


def real_basis(count: int) -> np.ndarray:
    """Return the unitary matrix from harmonics −N … N to cosine and sine terms.

    In these Hill's matrices are real, which is three times faster to solve.
    """
    u = np.zeros((count, count), dtype=complex)
    if count % 2:
        u[count // 2, count // 2] = 1.0
    for low in range(count // 2):
        high = count - 1 - low
        u[high, [high, low]] = np.sqrt(0.5)
        u[low, [high, low]] = -1j * np.sqrt(0.5), 1j * np.sqrt(0.5)
    return u


def in_basis(matrices: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Return matrices of harmonics (…, h k, h k) in cosine and sine terms, :func:`real_basis`."""
    count, size = len(u), matrices.shape[-1] // len(u)
    blocks = matrices.reshape(-1, count, size, count, size)
    turned = np.tensordot(np.tensordot(blocks, u, (1, 1)), u.conj(), (2, 1))  # …, a, b, n, m
    return turned.transpose(0, 3, 1, 4, 2).reshape(matrices.shape).real


def feedback(
    system: PeriodicSystem, values: np.ndarray, shapes: np.ndarray, orders: np.ndarray
) -> tuple[np.ndarray, dict[int, np.ndarray]]:
    """Return what the first harmonics left out do to those kept, as `shapes`, and what they are."""
    highest, result = int(orders[-1]), np.zeros_like(shapes)
    terms = (system.M, system.D, system.K)
    links = {n: _links(terms, n) for n in {n for X in terms for n in X}}
    reach = range(highest + 1, highest + system.order + 1)
    excited = {}
    for n in [*reach, *(-m for m in reach)]:
        for place, m in enumerate(orders.tolist()):
            if n - m in links:
                rate = values + 1j * m * system.speed
                excited[n] = excited.get(n, 0.0) + _applied(*links[n - m], rate, shapes[place])
    answers = {}
    for n, forces in excited.items():
        rate = values + 1j * n * system.speed
        answers[n] = -_answer(system, rate, forces)
        for place, m in enumerate(orders.tolist()):
            if m - n in links:
                result[place] += _applied(*links[m - n], rate, answers[n])
    return result, answers


def _answer(system: PeriodicSystem, rates: np.ndarray, forces: np.ndarray) -> np.ndarray:
    """Return what mean coefficients answer to forces (k, j), at a root what they do beside it."""
    for share in _OFF_ROOT:
        dynamic = system.dynamic(0, rates + 1j * share * system.speed)
        try:
            solved = np.linalg.solve(dynamic, forces.T[:, :, None])
            break
        except np.linalg.LinAlgError:
            if share == _OFF_ROOT[-1]:
                raise
    return solved[:, :, 0].T


def excitation(
    system: PeriodicSystem, values: np.ndarray, shapes: np.ndarray, orders: np.ndarray
) -> np.ndarray:
    """Return what motions (h, k, j) do to the first harmonic left out on both sides, (2k, j)."""
    step, result = spacing(orders), []
    for place, n in ((0, -step), (-1, step)):
        links = _links((system.M, system.D, system.K), n)
        rate = values + 1j * orders[place] * system.speed
        result.append(_applied(*links, rate, shapes[place]))
    return np.vstack(result)


def _links(terms: tuple, n: int) -> tuple | None:
    """Return the Fourier terms n of M, D, K; None where there is none."""
    entries = [X.get(int(n)) for X in terms]
    if all(X is None for X in entries):
        return None
    return tuple(0.0 if X is None else X for X in entries)


def _applied(
    M: np.ndarray, D: np.ndarray, K: np.ndarray, rate: np.ndarray, shape: np.ndarray
) -> np.ndarray:
    """Return ``(λ²M + λD + K) X`` column by column; absent matrices are 0.0."""
    parts = ((M, shape * rate**2), (D, shape * rate), (K, shape))
    return sum(X @ column for X, column in parts if np.ndim(X))


def shifted(shapes: np.ndarray, steps: int) -> np.ndarray:
    """Return harmonics (h, …) of the copy of a motion that is `steps` of pΩ higher in λ.

    ``exp((λ + ipsΩ)t) Σ Y_m exp(imΩt)`` is the same motion for ``Y_m = X_{m + ps}``.
    """
    moved, count = np.zeros_like(shapes), len(shapes)
    kept = max(count - abs(steps), 0)
    first, last = max(-steps, 0), max(steps, 0)
    moved[first : first + kept] = shapes[last : last + kept]
    return moved


def slopes(
    system: PeriodicSystem, values: np.ndarray, shapes: np.ndarray, orders: np.ndarray
) -> np.ndarray:
    """Return ``dH/dλ X`` of harmonics X (h, k, j): ``Σ_m [2(λ + imΩ) M_n−m + D_n−m] X_m``."""
    rates = values + 1j * system.speed * orders[:, None, None]
    by_mass = convolved(system.M, 2.0 * rates * shapes, orders)
    return by_mass + convolved(system.D, shapes, orders)


def adjoint_slopes(
    system: PeriodicSystem, values: np.ndarray, shapes: np.ndarray, orders: np.ndarray
) -> np.ndarray:
    """Return ``(dH/dλ)ᴴ W`` of harmonics W (h, k, j)."""
    rates = values.conj() - 1j * system.speed * orders[:, None, None]
    M, D = ({n: X.T for n, X in terms.items()} for terms in (system.M, system.D))
    return 2.0 * rates * convolved(M, shapes, orders) + convolved(D, shapes, orders)


def convolved(terms: Terms, shapes: np.ndarray, orders: np.ndarray) -> np.ndarray:
    """Return ``Σ_m X_n−m Y_m`` of Fourier terms X and harmonics Y (h, k, j)."""
    result = np.zeros_like(shapes)
    for n, X in terms.items():
        steps, between = divmod(n, spacing(orders))
        kept = len(orders) - abs(steps)
        if kept > 0 and not between:
            to, at = max(steps, 0), max(-steps, 0)
            given = shapes[at : at + kept]
            result[to : to + kept] += X @ given if np.iscomplexobj(X) else times(X, given)
    return result


def spacing(orders: np.ndarray) -> int:
    """Return the distance of neighbouring harmonics."""
    return int(orders[1] - orders[0]) if len(orders) > 1 else 1
