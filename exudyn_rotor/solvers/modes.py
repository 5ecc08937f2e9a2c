"""Lowest modes of ``K φ = ω² M φ``: Lanczos iteration for large models, LAPACK for small ones."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import scipy.sparse.linalg as sla

from exudyn_rotor.solvers.davidson import Inverse, davidson_modes
from exudyn_rotor.solvers.factor import DENSE_SIZE, one_thread, rounding_unit

Modes = tuple[np.ndarray, np.ndarray]
_SEED = 4830498
# share of ω² M φ that Lanczos iteration is asked to leave, and that any may leave
_RESIDUAL, _RESIDUAL_LIMIT = 1e-7, 1e-6
_EPS = np.finfo(float).eps


def lowest_modes(
    stiffness: sp.csr_array,
    mass: sp.csr_array,
    inverse: Inverse,
    count: int,
    balanced: Callable[[np.ndarray], np.ndarray] | None = None,
) -> Modes:
    """Return the `count` lowest modes; parameters as of :func:`davidson_modes`."""
    if inverse.iterative:
        unit = rounding_unit(stiffness)
        return davidson_modes(stiffness, mass, inverse, count, unit, balanced)
    return lanczos_modes(mass, inverse.solve, count, _RESIDUAL)


def is_small(size: int, count: int) -> bool:
    """Return whether `count` of `size` modes are better computed with dense matrices."""
    # Lanczos loses its advantage where a large part of the spectrum is wanted
    return size <= DENSE_SIZE or 4 * count > size


def dense_modes(stiffness: np.ndarray, mass: np.ndarray, count: int, skip: int = 0) -> Modes:
    """Return eigenvalues (count,) and mass-normalised modes (n, count) after `skip` lowest ones."""
    try:
        values, vectors = la.eigh(stiffness, mass)
    except la.LinAlgError as error:
        raise ValueError(
            f"the mass matrix is not positive definite ({error}); look for nodes without mass"
        ) from error
    wanted = slice(skip, skip + count)
    if count and values[skip] <= values.size * _EPS * values[-1]:
        raise ValueError(
            f"the model has more free motions than the {skip} that are left out; "
            "look for loose parts or nodes without stiffness"
        )
    return values[wanted], vectors[:, wanted]


def lanczos_modes(
    mass: sp.csr_array,
    inverse: Callable[[np.ndarray], np.ndarray],
    count: int,
    tolerance: float,
) -> Modes:
    """Return the `count` lowest modes by Lanczos iteration on ``K⁻¹ M`` (ARPACK).

    `inverse` is that of the stiffness on the motions that are allowed, of loads (n, k): symmetric,
    positive semi-definite; motions in its null space are left out. `tolerance` is the residual of
    the eigenvalues of ``K⁻¹ M``, relative to them. Returned are ``ω²``, ascending, and
    mass-normalised modes (n, count); ValueError if the iteration does not converge.

    The start vector is seeded, so that results repeat. With ``K⁻¹Mφ ≈ φ/ω²`` the modes returned are
    ``ω²K⁻¹Mφ``, one inverse iteration further, which leave smooth forces. Three and more exactly
    equal frequencies of parts that nothing couples may be found once or twice only. Source: of the
    transformation, Ericsson, Ruhe, "The spectral transformation Lanczos method", Math. Comp. 35
    (1980).
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
    modes = modes[:, np.argsort(squares)]
    further = inverse(mass @ modes)
    values, turn = la.eigh(further.T @ (mass @ modes), further.T @ (mass @ further))
    return values, further @ turn


def check_modes(
    stiffness: sp.csr_array,
    mass: sp.csr_array,
    eigenvalues: np.ndarray,
    modes: np.ndarray,
    *,
    precision: float = _EPS,
    constraints: sp.csr_array | None = None,
) -> None:
    """Check ``K φ − ω² M φ + Cᵀ λ = 0`` for the best ``λ``.

    ValueError if the residual is larger than 1e-6 of ``ω² M φ`` and what the relative `precision`
    of the stiffness leaves in ``K φ`` at best.
    """
    inertia = mass @ (modes * eigenvalues)
    residual = stiffness @ modes - inertia
    if constraints is not None:
        residual = without_reactions(residual, constraints)
    allowed = _RESIDUAL_LIMIT * np.linalg.norm(inertia, axis=0)
    allowed += rounding_unit(stiffness, precision) * np.linalg.norm(modes, axis=0)
    excess = np.linalg.norm(residual, axis=0) - allowed
    if np.any(excess > 0.0):
        raise ValueError(
            f"eigenmode {np.argmax(excess) + 1} does not satisfy K φ = ω² M φ; the matrices may "
            "not be symmetric"
        )


def without_reactions(force: np.ndarray, constraints: sp.csr_array) -> np.ndarray:
    """Return the part of `force` that reactions ``Cᵀ λ`` cannot balance."""
    gram = (constraints @ constraints.T).toarray()
    return force - constraints.T @ la.solve(gram, constraints @ force, assume_a="pos")
