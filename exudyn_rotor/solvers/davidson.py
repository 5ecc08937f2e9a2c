"""Lowest modes of ``K φ = ω² M φ`` by block Davidson iteration, without a factor of K."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp

from exudyn_rotor.solvers.factor import rounding_unit

Inverse = Any  # an InertiaRelief or a ConstrainedInverse, which import this file
_BLOCKS = 4  # of as many columns as modes are sought are kept
_MORE = 5  # modes are sought beside those that are wanted
_GUARDS = 2  # of them must nearly converge, so that none below is missed
_GUARD_MULTIPLE = 1e4
_RESIDUAL = 3e-7  # of ω² M φ; the error of eigenvalues is of second order in it
_ROUNDING_SHARE = 0.1
_MOST_STEPS = 300
_DEPENDENT = 1e-13
_SEED = 6


def davidson_modes(
    stiffness: sp.csr_array, mass: sp.csr_array, inverse: Inverse, count: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the `count` lowest modes by Davidson iteration with an approximate ``K⁻¹``.

    Returns as :func:`exudyn_rotor.solvers.modes.lanczos_modes`; ValueError without convergence.

    Restarts keep the latest Ritz vectors and those before them ("GD+k"): Stathopoulos, Saad,
    "Restarting techniques for the (Jacobi-)Davidson symmetric eigenvalue methods", ETNA 7 (1998).
    """
    size, unit = stiffness.shape[0], rounding_unit(stiffness)
    sought = min(count + _MORE, size)
    factors = np.where(np.arange(sought) < count, 1.0, _GUARD_MULTIPLE)[: count + _GUARDS]
    seeded = np.random.default_rng(_SEED).standard_normal((size, _GUARDS))
    new = inverse.precondition(mass @ np.hstack([inverse.start(sought), seeded]))
    basis = momenta = forces = np.zeros((size, 0))
    turn = before = np.zeros((0, 0))
    for _ in range(_MOST_STEPS):
        if basis.shape[1] + new.shape[1] > _BLOCKS * sought + _GUARDS:
            before = np.pad(before, ((0, len(turn) - len(before)), (0, 0)))
            kept = np.linalg.qr(np.hstack([turn, before]))[0]
            basis, momenta, forces = basis @ kept, momenta @ kept, forces @ kept
            turn = kept.T @ turn
        new, weighted = _orthonormal(new, basis, momenta, mass)
        basis, momenta = np.hstack([basis, new]), np.hstack([momenta, weighted])
        forces = np.hstack([forces, stiffness @ new])
        energy = basis.T @ forces
        before = turn
        values, turn = np.linalg.eigh(0.5 * (energy + energy.T))
        values, turn = values[:sought], turn[:, :sought]
        modes, inertia = basis @ turn, (momenta @ turn) * values
        residual = inverse.without_reactions(forces @ turn - inertia)
        allowed = _RESIDUAL * np.linalg.norm(inertia, axis=0)
        allowed += _ROUNDING_SHARE * unit * np.linalg.norm(modes, axis=0)
        excess = np.linalg.norm(residual, axis=0) / allowed
        done = excess[: factors.size] <= factors[: excess.size]
        if np.all(done):
            return values[:count], modes[:, :count]
        new = inverse.precondition(residual[:, excess > 1.0])
    raise ValueError(
        f"only {np.count_nonzero(done[:count])} of {count} modes converged in {_MOST_STEPS} "
        "steps; use rotor.with_solver('direct'), or a mesh with less flat elements"
    )


def _orthonormal(
    columns: np.ndarray, basis: np.ndarray, momenta: np.ndarray, mass: sp.csr_array
) -> tuple[np.ndarray, np.ndarray]:
    """Return what is new in `columns`, mass-orthonormal, and its product with the mass matrix."""
    columns = columns / np.linalg.norm(columns, axis=0)
    weighted = mass @ columns
    for _ in range(2):
        share = momenta.T @ columns
        columns, weighted = columns - basis @ share, weighted - momenta @ share
        gram = columns.T @ weighted
        scale = 1.0 / np.sqrt(np.diag(gram))
        values, turn = np.linalg.eigh(scale[:, None] * gram * scale)
        new = values > _DEPENDENT * values[-1]
        turn = (scale[:, None] * turn[:, new]) / np.sqrt(values[new])
        columns, weighted = columns @ turn, weighted @ turn
    return columns, weighted
