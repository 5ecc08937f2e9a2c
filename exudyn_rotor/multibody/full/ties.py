"""Mean motions of a full body as coordinates, and the conditions of its frame.

A marker on many nodes couples all their coordinates in a dense matrix. So the mean motion of an
interface has coordinates of its own, z, without mass, tied to the nodal displacements c by
``z = R c``; connectors and loads act on z. What holds the frame's own motions out of c are rows of
the same kind, ``0 = R c``.

Both are equations of the host's own, sparse and constant:

    M c̈ + … − Rᵀλ = 0,    f_z + λ = 0,    z̈ − R c̈ = 0,    λ = μ̈ + 2γμ̇ + γ²μ

with the same operator ``∂²/∂t² + 2γ ∂/∂t + γ²`` on ``z − R c``. That is exact: a state that starts
with ``z = R c`` keeps it, and any λ has its μ. In mass, damping and stiffness matrix stands one
symmetric matrix T, times 1, 2γ and γ²; M + T is regular, so that there are no algebraic equations,
and every solver serves: implicit, explicit (γ h small) and static.

Rows over all nodes make the factor of a sparse solver full, unless its ordering sets them aside and
its pivoting leaves them to the end. The ordering does so with rows that fill more than half of the
columns, so they are mixed with each other by an orthogonal matrix without zeros; the pivoting does
so with rows that are small beside the mass matrix, so all are (21,000 coordinates: 2 s instead of
more than 130 s without the one, and of more than 60 s without the other).
"""

from __future__ import annotations

import exudyn
import numpy as np
import scipy.sparse as sp
from exudyn.itemInterface import ObjectGenericODE2, VObjectGenericODE2

from exudyn_rotor.multibody.rotor.plan import Plan, generic_node

_SCALE = 1e-3  # of rows over mass matrix
RATE = 100.0  # γ [rad/s]: how fast z comes back to R c after rounding


def add_ties(
    mbs: exudyn.MainSystem,
    fields: exudyn.NodeIndex,
    plan: Plan,
    local: sp.csr_array,
    whole: np.ndarray | None = None,
    held: np.ndarray | None = None,
    stiffness: np.ndarray | None = None,
) -> tuple[exudyn.NodeIndex, exudyn.ObjectIndex]:
    """Add the coordinates z and the ties to the node of the displacements; return their node.

    Rows over the displacements are `local` (a, 3n) over few nodes, `whole` (b, 3n) over all, and
    `held` (c, 3n) those of motions that are zero; the diagonal `stiffness` (a + b,) acts on z.
    """
    width = plan.motion.invariants.size
    whole, held = (np.zeros((0, width)) if rows is None else rows for rows in (whole, held))
    tied_rows = sp.vstack([local, sp.csr_array(whole)], format="csr")
    z = tied_rows.shape[0]
    start = (tied_rows @ plan.modal_coordinates, tied_rows @ plan.modal_velocities)
    tied = mbs.AddNode(generic_node(*start))
    rows = sp.vstack([tied_rows, sp.csr_array(held)], format="csr")
    T = _tie_matrix(rows, z, local.shape[0], plan.motion.invariants.mass)
    on_z = np.zeros(T.shape[0])
    on_z[width : width + z] = 0.0 if stiffness is None else stiffness
    multipliers = generic_node(*np.zeros((2, rows.shape[0])))
    item = ObjectGenericODE2(
        nodeNumbers=[fields, tied, mbs.AddNode(multipliers)],
        massMatrix=container(T),
        dampingMatrix=container(2.0 * RATE * T),
        stiffnessMatrix=container(RATE**2 * T + sp.diags_array(on_z)),
        jacobianUserFunction=no_jacobian(T.shape[0]),
        visualization=VObjectGenericODE2(show=False),
    )
    return tied, mbs.AddObject(item)


def _tie_matrix(rows: sp.csr_array, tied: int, local: int, mass: float) -> sp.csr_array:
    """Return T on (c, z, μ), symmetric, in the size of the mass matrix.

    The first of the rows are `tied` to z, and the first of these are `local`; the others are mixed.
    """
    count = rows.shape[0]
    sums = np.ravel(abs(rows).sum(axis=1))
    small = sp.diags_array(_SCALE * mass / np.where(sums > 0.0, sums, 1.0))
    v = np.arange(1.0, count - local + 1.0)
    mixing = sp.csr_array(np.eye(len(v)) - np.outer(v, v) * (2.0 / max(v @ v, 1.0)))
    mix = sp.csr_array(sp.block_diag([sp.eye_array(local), mixing]))
    block = mix @ small @ sp.hstack([-rows, sp.eye_array(count, tied)])
    return sp.csr_array(sp.block_array([[None, block.T], [block, None]]))


def container(matrix: sp.sparray) -> exudyn.MatrixContainer:
    """Return a sparse matrix for Exudyn."""
    entries = sp.coo_array(matrix)
    table = np.column_stack([*entries.coords, entries.data]).astype(float)
    filled = exudyn.MatrixContainer()
    filled.SetWithSparseMatrixCSR(*matrix.shape, table, False)
    return filled


def no_jacobian(size: int):
    """Return the Jacobian function of an object without user forces.

    Without it Exudyn differentiates the object numerically, with all its matrices; it is called
    where a Jacobian is made anew, not in every step.
    """
    zero = container(sp.csr_array((size, size)))
    return lambda mbs, t, item, q, q_t, factor_q, factor_v: zero
