"""Lowest modes of ``K φ = ω² M φ``: Lanczos iteration for large models, LAPACK for small ones."""

from __future__ import annotations

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import scipy.sparse.linalg as sla

from exudyn_rotor.solvers.davidson import Inverse, davidson_modes
from exudyn_rotor.solvers.factor import DENSE_SIZE, Solve, one_thread, rounding_unit

Modes = tuple[np.ndarray, np.ndarray]
_SEED = 4830498
# share of ω² M φ that Lanczos iteration is asked to leave, and that any may leave
_RESIDUAL, _RESIDUAL_LIMIT = 1e-7, 1e-6


def lowest_modes(
    stiffness: sp.csr_array, mass: sp.csr_array, inverse: Inverse, count: int
) -> Modes:
    """Return the `count` lowest modes; parameters as of :func:`davidson_modes`."""
    size = mass.shape[0]
    # Lanczos iteration loses its advantage where a large part of the spectrum is wanted
    if 4 * count > size or (size <= DENSE_SIZE and not inverse.iterative):
        return dense_modes(mass, inverse.solve, count)
    if inverse.iterative:
        return davidson_modes(stiffness, mass, inverse, count)
    return lanczos_modes(mass, inverse.solve, count, _RESIDUAL)


def dense_modes(mass: sp.csr_array, inverse: Solve, count: int) -> Modes:
    """Return what :func:`lanczos_modes` does, from the eigenvalues of ``Lᵀ K⁻¹ L``, ``M = L Lᵀ``.

    Their rounding is relative to the lowest frequency, however stiff a spring beside is.
    """
    root = la.cholesky(mass.toarray(), lower=True)
    values, vectors = la.eigh(root.T @ inverse(root))
    squares, vectors = 1.0 / values[: -count - 1 : -1], vectors[:, : -count - 1 : -1]
    modes = la.solve_triangular(root, vectors, lower=True, trans="T")
    return _one_step_further(mass, inverse, squares, modes)


def lanczos_modes(mass: sp.csr_array, inverse: Solve, count: int, tolerance: float) -> Modes:
    """Return the `count` lowest modes by Lanczos iteration on ``K⁻¹ M`` (ARPACK).

    `inverse` is that of the stiffness on the motions that are allowed, of loads (n, k): symmetric,
    positive semi-definite; motions in its null space are left out. `tolerance` is the residual of
    the eigenvalues of ``K⁻¹ M``, relative to them. Returned are ``ω²``, ascending, and
    mass-normalised modes (n, count); ValueError if the iteration does not converge.

    The start vector is seeded, so that results repeat. Three and more exactly equal frequencies of
    parts that nothing couples may be found once or twice only. Source: of the transformation,
    Ericsson, Ruhe, "The spectral transformation Lanczos method", Math. Comp. 35 (1980).
    """
    size = mass.shape[0]
    operator = sla.LinearOperator((size, size), matvec=inverse, dtype=float)
    start = inverse(mass @ np.random.default_rng(_SEED).standard_normal(size))
    try:
        with one_thread():  # threads of thin products would wait for those of the solutions
            squares, modes = sla.eigsh(
                mass, count, M=mass, sigma=0.0, OPinv=operator, v0=start, tol=tolerance
            )
    except sla.ArpackError as error:
        raise ValueError(
            f"{count} modes did not converge to {tolerance:.0e} ({error}); ask for more modes (a "
            "cluster may be cut), or for fewer (not all nodes may have mass)"
        ) from error
    return _one_step_further(mass, inverse, squares, modes)


def _one_step_further(
    mass: sp.csr_array, inverse: Solve, squares: np.ndarray, modes: np.ndarray
) -> Modes:
    """Return ``ω²`` and modes after a step of inverse iteration, which leaves smooth forces."""
    momenta = mass @ (modes * squares)
    further = inverse(momenta)
    values, turn = la.eigh(further.T @ momenta, further.T @ (mass @ further))
    return values, further @ turn


def check_modes(
    stiffness: sp.csr_array,
    mass: sp.csr_array,
    inverse: Inverse,
    eigenvalues: np.ndarray,
    modes: np.ndarray,
) -> None:
    """Check ``K φ − ω² M φ + Cᵀ λ = 0`` for the best ``λ``.

    ValueError if the residual is larger than 1e-6 of ``ω² M φ`` and what the precision of the
    stiffness leaves in ``K φ`` at best.
    """
    inertia = mass @ (modes * eigenvalues)
    residual = inverse.without_reactions(stiffness @ modes - inertia)
    allowed = _RESIDUAL_LIMIT * np.linalg.norm(inertia, axis=0)
    allowed += rounding_unit(stiffness, inverse.precision) * np.linalg.norm(modes, axis=0)
    excess = np.linalg.norm(residual, axis=0) - allowed
    if np.any(excess > 0.0):
        raise ValueError(
            f"eigenmode {np.argmax(excess) + 1} does not satisfy K φ = ω² M φ; the matrices may "
            "not be symmetric"
        )
