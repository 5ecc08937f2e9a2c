"""A preconditioner for second-order elements: smoothing, and the linear elements of the same mesh.

One cycle approximates the elastic inverse of a stiffness K. Chebyshev iteration with the 3 × 3
blocks of the nodes takes out what varies from node to node. The rest is left to displacements
``P c`` that are linear in every element, an eighth of the coordinates, where ``PᵀKP`` is
factorised. For compact solids of steel conjugate gradients then need about 25 iterations for ten
digits on any mesh; for nearly incompressible materials and flat elements some times as many, and
for plates and blades of one element through the thickness too many: linear elements hardly bend.

Source: Saad, "Iterative methods for sparse linear systems", 2nd ed., Alg. 12.1 (Chebyshev) and
Sect. 13.4 (cycles).
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pyngcore
import scipy.linalg as la
import scipy.sparse as sp

from exudyn_rotor.solvers import lanczos
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


class TwoLevel:
    """Approximate inverse of a stiffness that holds all motions but `rigid`.

    Parameters
    ----------
    stiffness, mass : scipy.sparse.csr_array, shape (m, m)
    rigid : ndarray, shape (m, r)
        Mass-orthonormal free rigid motions.
    interpolation : scipy.sparse.csr_array, shape (m, c)
        ``P``: displacements of all nodes from those of the vertices, which come first.
    factorised : callable
        ``factorised(PᵀKP, PᵀMP, rigid motions)`` returns the elastic inverse of linear elements.

    Notes
    -----
    Cycles are done in single precision, the linear elements excepted; what uses them sees the
    rounding as a slightly worse approximation.
    """

    def __init__(self, stiffness, mass, rigid, interpolation, factorised) -> None:
        self._interpolation = interpolation
        self._restriction = sp.csr_array(interpolation.T)
        self._coarse_stiffness = _definite(self._restriction @ (stiffness @ interpolation))
        self._coarse_mass = sp.csr_array(self._restriction @ (mass @ interpolation))
        self._coarse_solve: Solve = factorised(
            self._coarse_stiffness,
            self._coarse_mass,
            _orthonormal(rigid[: interpolation.shape[1]], self._coarse_mass),
        )
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
        """Return the lowest modes (m, count) of the linear elements, and some random motions."""
        size = self._coarse_mass.shape[0]
        if lanczos.is_small(size, count):
            matrices = (X.toarray() for X in (self._coarse_stiffness, self._coarse_mass))
            modes = la.eigh(*matrices, subset_by_index=[0, min(count, size) - 1])[1]
        else:
            modes = lanczos.lanczos_modes(
                self._coarse_mass, self._coarse_solve, count, _START_TOLERANCE
            )[1]
        return self._interpolation @ modes

    def _cycle(self, load: np.ndarray) -> np.ndarray:
        load = load.astype(np.float32)
        before, change = self._smoothed(load)
        rest = load - self._stiffness @ (before + change)
        linear = self._coarse_solve(self._restriction @ rest.astype(float))
        linear = (self._interpolation @ linear).astype(np.float32)
        after = self._smoothed(rest - self._stiffness @ linear)
        return (before + change + linear + after[0] + after[1]).astype(float)

    def _smoothed(self, load: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return two steps of Chebyshev iteration from zero."""
        ratio = self._middle / self._half
        factor = 1.0 / (2.0 * ratio - 1.0 / ratio)
        again, new = np.float32(factor / ratio), np.float32(2.0 * factor / self._half)
        first = np.float32(1.0 / self._middle) * (self._blocks @ load)
        return first, again * first + new * (self._blocks @ (load - self._stiffness @ first))

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
    size = stiffness.shape[0]
    diagonals = [np.append(stiffness.diagonal(k), np.zeros(k)).reshape(-1, 3) for k in range(3)]
    blocks = np.empty((size // 3, 3, 3))
    for row in range(3):
        for column in range(row, 3):
            blocks[:, row, column] = blocks[:, column, row] = diagonals[column - row][:, row]
    nodes = np.arange(size // 3 + 1)
    inverse = sp.bsr_array((np.linalg.inv(blocks), nodes[:-1], nodes), shape=stiffness.shape)
    return sp.csr_array(inverse.astype(np.float32))


def _definite(matrix: sp.csr_array) -> sp.csr_array:
    return sp.csr_array(matrix + sp.diags_array(_DEFINITE * matrix.diagonal()))


def _orthonormal(motions: np.ndarray, mass: sp.csr_array) -> np.ndarray:
    values, vectors = np.linalg.eigh(motions.T @ (mass @ motions))
    return motions @ (vectors / np.sqrt(values))
