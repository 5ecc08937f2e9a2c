"""Iteration without a factor of the whole: linear elements of the same mesh, and smoothing.

One cycle approximates the elastic inverse of the stiffness K of second-order elements. Chebyshev
iteration with the 3 × 3 blocks of the nodes takes out what varies from node to node. The rest is
left to displacements ``P c`` that are linear in every element, an eighth of the coordinates, where
``PᵀKP`` is factorised. For compact solids of steel conjugate gradients then need about 25
iterations for ten digits on any mesh; for nearly incompressible materials and flat elements some
times as many, and for plates and blades of one element through the thickness too many: linear
elements hardly bend.

Sources: Saad, "Iterative methods for sparse linear systems", 2nd ed., Alg. 9.1 (conjugate
gradients), Alg. 12.1 (Chebyshev) and Sect. 13.4 (cycles).
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pyngcore
import scipy.sparse as sp
import scipy.sparse.linalg as sla

from exudyn_rotor.solvers import modes
from exudyn_rotor.solvers.factor import Solve

# smoothed are eigenvalues of the block-scaled stiffness from the largest down to this share of it
_SMOOTHED = 0.1
_POWER_STEPS = 15
# the largest eigenvalue is that much above what power iteration found
_MARGIN = 1.1
# of its diagonal: makes the linear elements' matrix definite where clamps leave it singular
_DEFINITE = 1e-12
_START_TOLERANCE = 1e-2
_SEED = 12
_MOST_STEPS = 500
_ROUGHLY = 1e-6  # share of a load that is left at first
_ROUNDING_SHARE = 0.1  # of the rounding of K u that a factorisation leaves as well


class TwoLevel:
    """Approximate inverse of a stiffness that holds all motions but `rigid`.

    `rigid` (m, r) are mass-orthonormal, `interpolation` P (m, c) gives displacements of all nodes
    from those of the vertices, which come first, and `inertia_relief` is the class of
    elastic inverses, for the linear elements.

    Cycles are done in single precision, the linear elements excepted; what uses them sees the
    rounding as a slightly worse approximation.
    """

    def __init__(self, stiffness, mass, rigid, interpolation, inertia_relief) -> None:
        self._interpolation = interpolation
        self._restriction = sp.csr_array(interpolation.T)
        linear = self._restriction @ (stiffness @ interpolation)
        linear = sp.csr_array(linear + sp.diags_array(_DEFINITE * linear.diagonal()))
        self._linear_mass = sp.csr_array(self._restriction @ (mass @ interpolation))
        motions = rigid[: interpolation.shape[1]]
        values, turn = np.linalg.eigh(motions.T @ (self._linear_mass @ motions))
        motions = motions @ (turn / np.sqrt(values))
        relief = inertia_relief(linear, self._linear_mass, motions)
        self._linear_solve: Solve = relief.solve
        self._flexible = linear.shape[0] - motions.shape[1]
        entries = stiffness.data.astype(np.float32), stiffness.indices, stiffness.indptr
        self._stiffness = sp.csr_array(entries, shape=stiffness.shape)
        self._blocks = _inverse_blocks(stiffness)
        largest = _MARGIN * self._largest_eigenvalue()
        self._middle = 0.5 * largest * (1.0 + _SMOOTHED)
        self._half = 0.5 * largest * (1.0 - _SMOOTHED)

    def __call__(self, load: np.ndarray) -> np.ndarray:
        """Return the approximate displacements (m, k) of loads (m, k); symmetric and definite."""
        threads = min(pyngcore.GetNumThreads(), load.shape[1])
        if threads < 2:
            return self._cycle(load)
        parts = np.array_split(load, threads, axis=1)
        with ThreadPoolExecutor(threads) as executor:
            return np.hstack(list(executor.map(self._cycle, parts)))

    def start(self, count: int) -> np.ndarray:
        """Return the lowest modes (m, count) of the linear elements."""
        mass, solve = self._linear_mass, self._linear_solve
        count = min(count, self._flexible)
        if 4 * count > mass.shape[0]:
            found = modes.dense_modes(mass, solve, count)[1]
        else:
            found = modes.lanczos_modes(mass, solve, count, _START_TOLERANCE)[1]
        return self._interpolation @ found

    def _cycle(self, load: np.ndarray) -> np.ndarray:
        load = load.astype(np.float32)
        before = self._smoothed(load)
        rest = load - self._stiffness @ before
        linear = self._linear_solve(self._restriction @ rest.astype(float))
        linear = (self._interpolation @ linear).astype(np.float32)
        after = self._smoothed(rest - self._stiffness @ linear)
        return (before + linear + after).astype(float)

    def _smoothed(self, load: np.ndarray) -> np.ndarray:
        """Return two steps of Chebyshev iteration from zero."""
        ratio = self._middle / self._half
        factor = 1.0 / (2.0 * ratio - 1.0 / ratio)
        again, new = np.float32(1.0 + factor / ratio), np.float32(2.0 * factor / self._half)
        first = np.float32(1.0 / self._middle) * (self._blocks @ load)
        return again * first + new * (self._blocks @ (load - self._stiffness @ first))

    def _largest_eigenvalue(self) -> float:
        vector = np.random.default_rng(_SEED).standard_normal(self._stiffness.shape[0])
        vector = vector.astype(np.float32)
        length = np.float32(np.linalg.norm(vector))
        for _ in range(_POWER_STEPS):
            vector = self._blocks @ (self._stiffness @ (vector / length))
            length = np.linalg.norm(vector)
        return float(length)


def _inverse_blocks(stiffness: sp.csr_array) -> sp.csr_array:
    """Return the inverse of the 3 × 3 blocks on the diagonal."""
    blocks = sp.bsr_array(stiffness, blocksize=(3, 3))
    nodes = np.arange(len(blocks.indptr))
    diagonal = np.repeat(nodes[:-1], np.diff(blocks.indptr)) == blocks.indices
    inverse = np.linalg.inv(blocks.data[diagonal]).astype(np.float32)
    return sp.csr_array(sp.bsr_array((inverse, nodes[:-1], nodes), shape=stiffness.shape))


def conjugate_gradients(
    stiffness: sp.csr_array,
    precondition: Solve,
    loads: np.ndarray,
    unit: float,
    tolerance: float,
    steps: int = _MOST_STEPS,
) -> np.ndarray:
    """Return the displacements (m, k) of ``K u = f``, to the precision of a factorisation.

    The loads must not push motions that K leaves free. `unit` is the rounding error of ``K u`` for
    a displacement of norm 1 [N], `tolerance` the residual over the load. ValueError where more than
    that is left after `steps`.
    """
    inverse = sla.LinearOperator(
        stiffness.shape, matvec=lambda load: precondition(load.reshape(-1, 1)).ravel(), dtype=float
    )
    solution = np.zeros_like(loads)
    for load, found in zip(loads.T, solution.T, strict=True):
        for share in (max(tolerance, _ROUGHLY), tolerance):  # what rounding leaves is known then
            left = share * np.linalg.norm(load)
            left += _ROUNDING_SHARE * unit * np.linalg.norm(found)
            found[:], failed = sla.cg(
                stiffness, load, found, rtol=0.0, atol=left, maxiter=steps, M=inverse
            )
        if failed:
            raise ValueError(
                f"the iterative solution of static loads leaves more than {left:.1e} N after "
                f"{steps} steps; use rotor.with_solver('direct'), or a mesh with less flat "
                "elements"
            )
    return solution
