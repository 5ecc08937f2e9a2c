"""Harmonics of single motions of periodic equations, as many as a motion has, by inverse iteration.

    (A_0 − imΩ) Z_m + U Σ_n S_n Z_{m−n} = λ Z_m

The coefficients that repeat are forces of few supports, ``A_n = U S_n``. In the eigenvectors of A_0
each harmonic is solved by itself, and those forces alone are coupled, each harmonic with its next
ones. So a step of the iteration costs little beside the eigenvalues of all harmonics together, and
takes all motions at once.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exudyn_rotor.linear.equations import PeriodicSystem, States, spanned

_SIZES = (2, 4, 8, 16)  # harmonics on either side, in steps of the coefficients
_FEW = 2  # harmonics with which a motion need not settle
_MOST = 6  # iterations, each of which squares the error
_ENOUGH = 1e-10  # of |λ| and Ω: the last change
_ASIDE = 1e-10  # of |λ| and Ω: how far the shift is from λ, where the equations are singular
_NONE = 1e-12  # share of the energy: a harmonic that no motion has


class Chain(NamedTuple):
    """Equations of harmonics at one speed.

    Attributes
    ----------
    speed : float
        Ω [rad/s].
    step : int
        Common step of the harmonics of the coefficients.
    rates : ndarray, shape (2k,)
        Eigenvalues of A_0.
    shapes, inverse : ndarray, shape (2k, 2k)
        Its eigenvectors, and their inverse.
    pushed : ndarray, shape (2k, r)
        U in eigenvectors.
    seen : mapping of int to ndarray, shape (r, 2k)
        S_n of eigenvectors, by n in steps.
    """

    speed: float
    step: int
    rates: np.ndarray
    shapes: np.ndarray
    inverse: np.ndarray
    pushed: np.ndarray
    seen: dict[int, np.ndarray]


def chain_of(system: PeriodicSystem, made: States) -> Chain:
    """Return the equations of harmonics of a system."""
    rates, shapes = np.linalg.eig(made.A[0])
    repeating = {n: A for n, A in made.A.items() if n}
    columns = np.hstack([part for A in repeating.values() for part in (A.real, A.imag)])
    U, inverse = spanned(columns), np.linalg.inv(shapes)
    seen = {n // system.step: U.T @ A @ shapes for n, A in repeating.items()}
    return Chain(system.speed, system.step, rates, shapes, inverse, inverse @ U, seen)


def shares(states: np.ndarray) -> np.ndarray:
    """Return the share of each harmonic in the energy of motions with states (h, 2k, n), (h, n)."""
    energy = np.sum(np.abs(states) ** 2, axis=1)
    return energy / energy.sum(axis=0)


def edge_energy(states: np.ndarray) -> np.ndarray:
    """Return the share (n,) of the outermost harmonics in the energy of states (h, 2k, n)."""
    energy = shares(states)
    return energy[0] + energy[-1]


def with_all_harmonics(
    chain: Chain, values: np.ndarray, states: np.ndarray, edges: np.ndarray, least: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return motions with so many harmonics that those at the edge have the energy `least`.

    Parameters
    ----------
    chain : Chain
    values : ndarray, shape (n,)
        Exponents, about.
    states : ndarray, shape (h, 2k, n)
        Harmonics around zero, about.
    edges : ndarray, shape (n,)
        Share of the energy of each motion at the edge of the sum in which it is exact; ∞ where it
        is exact in none.
    least : float

    Returns
    -------
    values, states, orders
        With common orders (h,).
    edges : ndarray, shape (n,)
        Those of the largest sums in which the motions have settled.
    """
    values, edges = values.copy(), edges.copy()
    most = max(_SIZES[-1], len(states) // 2)
    padding = most - len(states) // 2
    states = np.pad(states, [(padding, padding), (0, 0), (0, 0)]).astype(complex)
    energy = shares(states)
    # within which the motions are, as far as is known
    outside = [energy[: most - n + 1].sum(axis=0) + energy[most + n :].sum(axis=0) for n in _SIZES]
    enough = [*(np.array(outside[:-1]) <= least), np.ones(len(values), dtype=bool)]
    within = np.array(_SIZES)[np.argmax(enough, axis=0)]
    hopeful = np.ones(len(values), dtype=bool)
    done = ~hopeful  # a guess is less exact than what is at its edge tells
    for size in _SIZES:
        waiting = np.flatnonzero(~done & (within <= size) & hopeful)
        if not waiting.size:
            continue
        inner = slice(most - size, most + size + 1)
        better, shapes, settled = _settled(chain, values[waiting], states[inner][:, :, waiting])
        at = waiting[settled]
        hopeful[waiting[~settled]] = size <= _FEW
        values[at], states[:, :, at] = better[settled], 0.0
        states[inner, :, at] = shapes[:, :, settled]
        edges[at] = edge_energy(shapes[:, :, settled])
        done[at] = edges[at] <= least
    used = np.flatnonzero(np.any(shares(states) > _NONE, axis=1))
    most_used = np.max(np.abs(used - most), initial=0)
    inner = slice(most - most_used, most + most_used + 1)
    return values, states[inner], chain.step * np.arange(-most_used, most_used + 1), edges


def _settled(
    chain: Chain, values: np.ndarray, states: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return motions by inverse iteration from others, and which have settled."""
    top = len(states) // 2
    z = np.swapaxes(chain.inverse @ states, 1, 2)  # (h, n, 2k)
    z = z / np.linalg.norm(z, axis=(0, 2))[:, None]
    found, active = np.zeros(len(values), dtype=bool), np.arange(len(values))
    for _ in range(_MOST):
        size = np.maximum(np.abs(values[active]), abs(chain.speed))
        shifts = values[active] + _ASIDE * (1.0 + 1.0j) * size
        with np.errstate(all="ignore"):
            turned = _solved(chain, top, shifts, z[:, active])
            better = shifts + 1.0 / np.sum(z[:, active].conj() * turned, axis=(0, 2))
            turned = turned / np.linalg.norm(turned, axis=(0, 2))[:, None]
        right = np.isfinite(better)
        change = np.abs(better - values[active])
        values[active[right]], z[:, active[right]] = better[right], turned[:, right]
        still = change <= _ENOUGH * size
        found[active[still]] = True
        active = active[right & ~still]
        if not active.size:
            break
    return values, chain.shapes @ np.swapaxes(z, 1, 2), found


def _solved(chain: Chain, top: int, shifts: np.ndarray, loads: np.ndarray) -> np.ndarray:
    """Return the solutions (h, n, 2k) of the equations less shifts (n,), in eigenvectors.

    The forces of supports follow from those of the harmonics beside.
    """
    (h, n, _), r = loads.shape, chain.pushed.shape[1]
    turns = 1j * chain.speed * chain.step * np.arange(-top, top + 1)
    inverse = 1.0 / (chain.rates - turns[:, None, None] - shifts[:, None])
    alone = inverse * loads
    far = max(chain.seen)  # neighbours that a harmonic is coupled with, which are one block
    blocks = -(-h // far)
    A = np.zeros((blocks, 3, n, far, r, far, r), dtype=complex)
    b = np.zeros((blocks * far, n, r), dtype=complex)
    for by, S in chain.seen.items():
        pairs = (S.T[:, :, None] * chain.pushed[:, None]).reshape(-1, r * r)
        coupled = (inverse @ pairs).reshape(h, n, r, r)
        for source in range(max(0, -by), h - max(0, by)):
            block, place = divmod(source + by, far)
            beside = 1 + source // far - block
            A[block, beside, :, place, :, source % far] += coupled[source]
        targets = np.arange(max(0, by), h + min(0, by))
        b[targets] += alone[targets - by] @ S.T
    A = A.reshape(blocks, 3, n, far * r, far * r)
    A[:, 1] += np.eye(far * r)
    b = np.swapaxes(b.reshape(blocks, far, n, r), 1, 2).reshape(blocks, n, far * r, 1)
    forces = _along_the_chain(A, b).reshape(blocks, n, far, r)
    forces = np.swapaxes(forces, 1, 2).reshape(-1, n, r)[:h]
    return alone - inverse * (forces @ chain.pushed.T)


def _along_the_chain(A: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the solutions (m, n, s, 1) of n systems with blocks (m, 3, n, s, s) beside a diagonal.

    Gauss's elimination block by block.
    """
    upper, found = [], []
    size = b.shape[2]
    for m, (below, diagonal, above) in enumerate(A):
        right = b[m]
        if m:
            diagonal, right = diagonal - below @ upper[-1], right - below @ found[-1]
        both = np.linalg.solve(diagonal, np.concatenate([above, right], axis=2))
        upper.append(both[..., :size])
        found.append(both[..., size:])
    for m in range(len(A) - 2, -1, -1):
        found[m] = found[m] - upper[m] @ found[m + 1]
    return np.stack(found)
