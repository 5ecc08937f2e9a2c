"""Algebra of block-nodal vectors: three coordinates per node, ordered x0 y0 z0 x1 y1 z1 …

The functions write out the matrices that the paper prints (Φ, ẽ_bd, x̃, Ψ̃). The run-time terms
need only products with one skew matrix, so nothing here is used inside a time step.

Source of the equation numbers: Zwölfer, Rasmussen, Santos, "Rotordynamics Local Frame
Formulations for 3D Continuum Finite Elements", SSRN 4830498.
"""

import numpy as np
import scipy.sparse as sp

Array = np.ndarray


def skew(vector: Array) -> Array:
    """Return the 3 × 3 matrix ``ṽ`` with ``ṽ u = v × u``."""
    x, y, z = np.asarray(vector, dtype=float)
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def block_diagonal(block: Array, node_count: int) -> sp.csr_array:
    """Return the block-diagonal matrix ``I_n ⊗ B`` (3n × 3n), e.g. ``ẽ_bd`` (73)."""
    return sp.csr_array(sp.kron(sp.eye_array(node_count), sp.csr_array(block)))


def turned(axis: Array, columns: Array | sp.csr_array) -> Array | sp.csr_array:
    """Return ``ẽ_bd Ψ``, ``e ×`` every nodal vector of (3n × k); sparse where Ψ is."""
    block = skew(axis)
    if sp.issparse(columns):
        return block_diagonal(block, columns.shape[0] // 3) @ columns
    nodal = columns.reshape(-1, 3, columns.shape[1])
    result = np.zeros_like(nodal)
    for i, j in np.argwhere(block):
        result[:, i] += block[i, j] * nodal[:, j]
    return result.reshape(columns.shape)


def translations(node_count: int) -> Array:
    """Return ``Φ`` (3n × 3), the unit rigid translations along x, y, z (2)."""
    return np.tile(np.eye(3), (node_count, 1))


def rotations(nodes: Array, center: Array) -> Array:
    """Return the linearised unit rotations about x, y, z through `center` (3n × 3).

    Column i is the displacement ``a_i × (x − center)`` of every node.
    """
    arms = np.asarray(nodes, dtype=float) - np.asarray(center, dtype=float)
    columns = np.cross(np.eye(3)[:, None, :], arms[None, :, :])
    return columns.reshape(3, -1).T


def tilde(nodal: Array) -> Array:
    """Return ``x̃`` (3n × 3): the skew matrices of all nodal vectors, stacked (9)."""
    return np.vstack([skew(vector) for vector in np.asarray(nodal, float).reshape(-1, 3)])


def tilde_basis(modes: Array | sp.csr_array) -> Array | sp.csr_array:
    """Return ``Ψ̃`` (3n × 3m): the tilde matrix of every mode, side by side (30).

    Sparse where the modes are.
    """
    kron = sp.kron if sp.issparse(modes) else np.kron
    units = np.eye(3)
    whole = sum(kron(modes[axis::3], skew(units[axis])) for axis in range(3))
    return sp.csr_array(whole) if sp.issparse(modes) else whole


def coupled(matrix: sp.csr_array) -> np.ndarray:
    """Return which coordinates have entries off the diagonal, (3n,); clamped nodes have none."""
    strength = abs(matrix)
    return strength.sum(axis=1) > strength.diagonal()
