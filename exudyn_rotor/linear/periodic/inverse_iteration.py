"""Inverse iteration on both sides for eigenvalues of Hill's equations near known motions."""

from __future__ import annotations

import numpy as np

from exudyn_rotor.linear.periodic import harmonic_chain
from exudyn_rotor.linear.periodic.harmonics import adjoint_slopes, convolved, slopes
from exudyn_rotor.linear.periodic.periodic_system import (
    ConstantSystems,
    PeriodicSystem,
    dynamic_matrices,
    times,
)
from exudyn_rotor.threads import shared

# relative distance from an eigenvalue that keeps its matrix invertible
OFF_ROOT = 1e-9
_MOST_STEPS = 5
_MOST_ENTRIES = 1_000_000  # of the matrices of motions that are iterated at once
_LARGE = 60  # coordinates from which on threads do not mostly wait for one another


def nearest_root(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """Return the root δ of ``aδ² + bδ + c = 0`` next to zero."""
    root = np.sqrt(b**2 - 4.0 * a * c + 0j)
    larger = np.where(np.abs(b + root) > np.abs(b - root), b + root, b - root)
    with np.errstate(invalid="ignore"):  # NaN of a singular matrix
        return np.where(c == 0.0, 0.0, -2.0 * c / np.where(larger == 0.0, 1.0, larger))


def moved(
    system: PeriodicSystem,
    orders: np.ndarray,
    values: np.ndarray,
    shapes: np.ndarray,
    forces: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return eigenvalues near others by one inverse iteration, with right and left vectors.

    With H(λ) of Hill's equations, ``z = H⁻¹ H' x`` and ``w = H⁻ᴴ f``; the root δ next to zero of
    ``wᴴ(H + δH' + δ²M)z = 0`` gives λ + δ.

    Parameters
    ----------
    system : PeriodicSystem
    orders : ndarray of int, shape (h,)
    values : ndarray, shape (j,)
        λ to begin with.
    shapes : ndarray, shape (h, k, j)
        Harmonics x to begin with.
    forces : ndarray, shape (h, k, j), optional
        f; Mx by default.

    Returns
    -------
    values : ndarray, shape (j,)
        NaN where the matrix is singular.
    z, w : ndarray, shape (h, k, j)
        Of any length.
    """
    shifted = values * (1.0 + OFF_ROOT)
    forces = convolved(system.M, shapes, orders) if forces is None else forces
    loads = slopes(system, shifted, shapes, orders)
    answers = np.empty((2, *loads.shape), dtype=complex)
    at_once = max(1, _MOST_ENTRIES // (len(orders) * system.size**2))
    for start in range(0, len(values), at_once):
        few = slice(start, start + at_once)
        given = shifted[few], loads[..., few], forces[..., few]
        answers[..., few] = harmonic_chain.solved(system, orders, *given)
    z, w = answers
    square, linear = convolved(system.M, z, orders), slopes(system, shifted, z, orders)
    a, b, c = (np.sum(w.conj() * X, axis=(0, 1)) for X in (square, linear, loads))
    return shifted + nearest_root(a, b, c), z, w


def moved_together(
    systems: ConstantSystems, values: np.ndarray, shapes: np.ndarray, wanted: np.ndarray
) -> np.ndarray:
    """Return the eigenvalues of :func:`moved` of several systems that do not change in time.

    Parameters
    ----------
    systems : ConstantSystems
        s of them.
    values : ndarray, shape (s, j), complex
        λ to begin with.
    shapes : ndarray, shape (s, k, j), complex
        x to begin with.
    wanted : ndarray of bool, shape (s, j)
        Which λ to move; the others are returned as they are.
    """
    shifted = values * (1.0 + OFF_ROOT)
    rates = shifted[:, None]

    def inertia_and_slopes(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        inertia = times(systems.M, x)
        return inertia, 2.0 * rates * inertia + times(systems.D, x)

    forces, loads = inertia_and_slopes(shapes)
    both = np.stack([loads, forces]).transpose(1, 3, 0, 2)[..., None]
    answers = np.zeros_like(both)
    masses = np.broadcast_to(systems.M, systems.D.shape)

    def solve(place: int) -> None:
        terms, kept = (masses[place], systems.D[place], systems.K[place]), wanted[place]
        matrices = dynamic_matrices(terms, shifted[place, kept])
        answers[place, kept] = harmonic_chain.on_both_sides(matrices, both[place, kept])

    # one system after the other: its matrices stay in the cache
    places = np.flatnonzero(np.any(wanted, axis=1))
    if systems.M.shape[1] >= _LARGE:
        shared(solve, places)
    else:
        for place in places:
            solve(place)
    z, w = answers[..., 0].transpose(2, 0, 3, 1)
    a, b, c = (np.einsum("skj,skj->sj", w.conj(), X) for X in (*inertia_and_slopes(z), loads))
    return np.where(wanted, shifted + nearest_root(a, b, c), values)


def settled(
    system: PeriodicSystem,
    orders: np.ndarray,
    values: np.ndarray,
    shapes: np.ndarray,
    limits: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """Return the eigenvalues near `values` (j,), with right and left vectors (h, k, j).

    Begins with the harmonics `shapes` (h, k, j) and ends with the first step below `limits` (j,)
    [1/s]; as convergence is cubic, the error is far smaller then. The vectors have unit length.
    None where that takes more than five steps.
    """
    values, rights = values.astype(complex), shapes.astype(complex)
    lefts, forces = np.zeros_like(rights), convolved(system.M, rights, orders)
    open_ones = np.arange(len(values))
    for _ in range(_MOST_STEPS):
        last, given = values[open_ones], rights[..., open_ones]
        found, *sides = moved(system, orders, last, given, forces)
        if not np.all(np.isfinite(found)):
            return None
        values[open_ones] = found
        for known, side in zip((rights, lefts), sides, strict=True):
            known[..., open_ones] = side / np.linalg.norm(side, axis=(0, 1))
        open_ones = open_ones[np.abs(found - last) > limits[open_ones]]
        if open_ones.size == 0:
            return values, rights, lefts
        forces = adjoint_slopes(system, values[open_ones], lefts[..., open_ones], orders)
    return None
