"""The rotor's equations as one ``ObjectGenericODE2``: user functions, or constant matrices.

The object shares its nodes with the marker body. Its coordinates are those of the nodes; the
unknowns of the formulation are placed among them, and what is left is locked. Whatever is linear
with constant coefficients is evaluated by Exudyn itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import exudyn
import numpy as np
from exudyn.itemInterface import ObjectGenericODE2, VObjectGenericODE2

from exudyn_rotor.multibody.rotor.frame import LockedForce
from exudyn_rotor.theory.kernel import Kernel, constant_part
from exudyn_rotor.theory.motion import Motion

_NO_FORCES = {
    "stiffnessMatrix": np.zeros((0, 0)),
    "dampingMatrix": np.zeros((0, 0)),
    "forceVector": np.zeros(0),
    "forceUserFunction": 0,
    "jacobianUserFunction": 0,
}

StateForce = Callable[[float, list, list], np.ndarray]


@dataclass(frozen=True, eq=False)
class Layout:
    """Where the unknowns of a formulation stand among the coordinates of the nodes.

    Attributes
    ----------
    size : int
        Number of node coordinates.
    unknowns : ndarray of int
        Coordinate of every unknown of the :class:`Motion`.
    lock_mass : ndarray, shape (size,)
        Masses of locked coordinates; zero for unknowns.
    """

    size: int
    unknowns: np.ndarray
    lock_mass: np.ndarray

    def spread(self, matrix: np.ndarray, diagonal: np.ndarray | float = 0.0) -> np.ndarray:
        """Return a (size, size) matrix with `matrix` on the unknowns and `diagonal` added."""
        full = np.diag(np.broadcast_to(diagonal, self.size).astype(float))
        full[np.ix_(self.unknowns, self.unknowns)] += matrix
        return full


def constant_object(motion: Motion, layout: Layout, nodes: list) -> ObjectGenericODE2:
    """Return the object with constant matrices (109): no Python call in a time step."""
    rest = np.zeros(motion.size)
    return ObjectGenericODE2(
        nodeNumbers=nodes,
        massMatrix=layout.spread(motion.mass_matrix(0.0, rest), layout.lock_mass),
        **_constant_items(motion, layout),
        visualization=VObjectGenericODE2(show=False),
    )


def user_function_object(
    motion: Motion, layout: Layout, nodes: list, locked_force: LockedForce | None
) -> ObjectGenericODE2:
    """Return the object with user functions for what varies, and matrices for what does not.

    `locked_force(t)` gives the forces, shape (size,), that drive locked coordinates along their
    prescribed motion.
    """
    rest = np.zeros(motion.size)
    kernel, functions = Kernel(motion, layout.unknowns, layout.size), {}
    mass = layout.spread(motion.mass_matrix(0.0, rest), layout.lock_mass)
    if kernel.rows.size:
        mass, functions["massMatrixUserFunction"] = _varying_mass(mass, kernel, layout.size)
    functions["jacobianUserFunction"] = _jacobian(kernel)
    functions["forceUserFunction"] = _with_guide(
        kernel.forces if kernel.has_forces else None, locked_force
    )
    return ObjectGenericODE2(
        nodeNumbers=nodes,
        massMatrix=mass,
        **_constant_items(motion, layout),
        **functions,
        visualization=VObjectGenericODE2(show=False),
    )


@contextmanager
def without_forces(mbs: exudyn.MainSystem, number: exudyn.ObjectIndex) -> Iterator[None]:
    """Let an object of this module have its mass matrix alone, but no forces."""
    given = {name: mbs.GetObjectParameter(number, name) for name in _NO_FORCES}
    for name, nothing in _NO_FORCES.items():
        mbs.SetObjectParameter(number, name, nothing)
    try:
        yield
    finally:
        for name, value in given.items():
            mbs.SetObjectParameter(number, name, value)


def _constant_items(motion: Motion, layout: Layout) -> dict[str, np.ndarray]:
    """Return the matrices and the force that Exudyn itself evaluates."""
    constant = constant_part(motion)
    force = np.zeros(layout.size)
    force[layout.unknowns] = constant.force
    return {
        "stiffnessMatrix": layout.spread(constant.stiffness),
        "dampingMatrix": layout.spread(constant.damping),
        "forceVector": force,
    }


def _with_guide(forces: StateForce | None, guide: LockedForce | None) -> Callable:
    """Return the user function of the forces, with those on locked coordinates."""
    # Exudyn takes a list faster than an array
    if guide is None:
        return lambda mbs, t, item, q, q_t: forces(t, q, q_t).tolist()
    if forces is None:
        return lambda mbs, t, item, q, q_t: guide(t).tolist()
    return lambda mbs, t, item, q, q_t: (guide(t) + forces(t, q, q_t)).tolist()


def _varying_mass(
    start: np.ndarray, kernel: Kernel, size: int
) -> tuple[exudyn.MatrixContainer, Callable]:
    """Return the mass matrix and its user function: only some entries vary.

    Exudyn takes entries (row, column, value) faster than a matrix.
    """
    above, beside = kernel.rows, kernel.columns
    off = above != beside
    fixed = start.copy()
    fixed[above, beside] = fixed[beside, above] = 0.0
    rows, columns = np.nonzero(fixed)
    table = np.zeros((rows.size + above.size + np.count_nonzero(off), 3))
    table[:, 0] = np.concatenate([rows, above, beside[off]])
    table[:, 1] = np.concatenate([columns, beside, above[off]])
    table[: rows.size, 2] = fixed[rows, columns]
    one = table[rows.size : rows.size + above.size, 2]
    mirrored = table[rows.size + above.size :, 2]
    skipped = above.size - mirrored.size  # the only diagonal entry is the first
    matrix = exudyn.MatrixContainer()
    # one container, its method found once: Exudyn takes a copy, and a new one costs a microsecond
    fill = matrix.SetWithSparseMatrixCSR

    def mass_matrix(mbs, t, item, q, q_t):
        values = kernel.mass_entries(t, q)
        one[:], mirrored[:] = values, values[skipped:]
        fill(size, size, table, False)
        return matrix

    return mass_matrix(None, 0.0, None, [0.0] * size, [0.0] * size), mass_matrix


def _jacobian(kernel: Kernel) -> Callable:
    """Return the Jacobian of the user force; Exudyn adds that of its own matrices.

    It is needed even where it is zero: without it, Exudyn differentiates the object numerically
    with all its matrices, and calls the user force for every coordinate.
    """
    return lambda mbs, t, item, q, q_t, factor_q, factor_v: kernel.jacobian(
        t, q, q_t, factor_q, factor_v
    )
