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

from dataclasses import dataclass
from functools import cached_property

import exudyn
import numpy as np
import scipy.sparse as sp
from exudyn.itemInterface import ObjectGenericODE2, VObjectGenericODE2

from exudyn_rotor.multibody.rotor.plan import Plan, generic_node
from exudyn_rotor.theory.invariants import Invariants

_SCALE = 1e-3  # of rows over mass matrix
RATE = 100.0  # γ [rad/s]: how fast z comes back to R c after rounding


@dataclass(frozen=True, eq=False)
class Ties:
    """Rows of mean motions over the nodal displacements of a rotor."""

    local: sp.csr_array  # (a, 3n) Over few nodes; the first coordinates z
    whole: np.ndarray  # (b, 3n) Over all nodes; the other coordinates z
    held: np.ndarray  # (c, 3n) Over all nodes, of motions that are zero
    stiffness: np.ndarray | None = None  # (a + b, a + b) Acts on z

    @cached_property
    def rows(self) -> sp.csr_array:
        """Rows R (z, 3n) of the coordinates z."""
        return sp.vstack([self.local, sp.csr_array(self.whole)], format="csr")

    def matrix(self, invariants: Invariants) -> sp.csr_array:
        """Return T on (c, z, μ), symmetric, in the size of the mass matrix."""
        held, z = sp.csr_array(self.held), self.rows.shape[0]
        rows = sp.vstack([self.rows, held], format="csr")
        select = sp.eye_array(rows.shape[0], z)
        sums = np.ravel(abs(rows).sum(axis=1))
        small = _SCALE * invariants.mass / np.where(sums > 0.0, sums, 1.0)
        block = self._mix() @ sp.diags_array(small) @ sp.hstack([-rows, select])
        return sp.csr_array(sp.block_array([[None, block.T], [block, None]]))

    def _mix(self) -> sp.csr_array:
        """Return the orthogonal matrix that mixes the rows over all nodes."""
        local, count = self.local.shape[0], len(self.whole) + len(self.held)
        v = np.arange(1.0, count + 1.0)
        mixing = np.eye(count) - np.outer(v, v) * (2.0 / max(v @ v, 1.0))
        return sp.csr_array(sp.block_diag([sp.eye_array(local), sp.csr_array(mixing)]))


def add_ties(
    mbs: exudyn.MainSystem,
    fields: exudyn.NodeIndex,
    ties: Ties,
    plan: Plan,
) -> tuple[exudyn.NodeIndex, exudyn.ObjectIndex]:
    """Add the coordinates z and the ties to the node of the displacements; return their node."""
    start = (ties.rows @ plan.modal_coordinates, ties.rows @ plan.modal_velocities)
    tied = mbs.AddNode(generic_node(*start))
    T = ties.matrix(plan.motion.invariants)
    width, size = plan.motion.invariants.size, T.shape[0]
    multipliers = generic_node(*np.zeros((2, size - width - ties.rows.shape[0])))
    stiffness = RATE**2 * T
    if ties.stiffness is not None:
        entries = sp.coo_array(ties.stiffness)
        place = tuple(width + part for part in entries.coords)
        stiffness = stiffness + sp.csr_array((entries.data, place), shape=T.shape)
    item = ObjectGenericODE2(
        nodeNumbers=[fields, tied, mbs.AddNode(multipliers)],
        massMatrix=container(T),
        dampingMatrix=container(2.0 * RATE * T),
        stiffnessMatrix=container(stiffness),
        jacobianUserFunction=no_jacobian(size),
        visualization=VObjectGenericODE2(show=False),
    )
    return tied, mbs.AddObject(item)


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
