"""The rotor's equations as one ``ObjectGenericODE2``: user functions, or constant matrices.

The object shares its nodes with the marker body. Its coordinates are those of the nodes; the
unknowns of the formulation are placed among them, and what is left is locked. Whatever is linear
with constant coefficients is evaluated by Exudyn itself.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import exudyn
import numpy as np
from exudyn.itemInterface import ObjectGenericODE2, VObjectGenericODE2

from exudyn_rotor.theory.kernel import Kernel, constant_part
from exudyn_rotor.theory.motion import Motion

LockedForce = Callable[[float], np.ndarray]
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
    lock_mass, lock_stiffness, lock_damping : ndarray, shape (size,)
        Diagonals added for locked coordinates; zero for unknowns.
    """

    size: int
    unknowns: np.ndarray
    lock_mass: np.ndarray
    lock_stiffness: np.ndarray
    lock_damping: np.ndarray

    @classmethod
    def unlocked(cls, size: int) -> Layout:
        """Return the layout of a node that holds the unknowns alone."""
        return cls(size, np.arange(size), *np.zeros((3, size)))

    def spread(self, matrix: np.ndarray, diagonal: np.ndarray) -> np.ndarray:
        """Return a (size, size) matrix with `matrix` on the unknowns and `diagonal` added."""
        full = np.diag(diagonal)
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
    functions = {"jacobianUserFunction": _jacobian(motion, layout)}
    mass = layout.spread(motion.mass_matrix(0.0, rest), layout.lock_mass)
    if motion.is_coupled:
        functions["massMatrixUserFunction"] = _coupled_mass(motion, layout)
        forces = _coupled_forces(motion, layout)
    else:
        kernel = Kernel(motion, layout.unknowns, layout.size)
        if motion.formulation.has_spin:
            mass, functions["massMatrixUserFunction"] = _mass_of_free_spin(mass, kernel, layout)
        elif motion.formulation.is_constant_speed:
            del functions["jacobianUserFunction"]
        forces = _forces(motion, kernel)
    functions["forceUserFunction"] = _with_guide(forces, locked_force)
    return ObjectGenericODE2(
        nodeNumbers=nodes,
        massMatrix=mass,
        **_constant_items(motion, layout),
        **functions,
        visualization=VObjectGenericODE2(show=False),
    )


def _constant_items(motion: Motion, layout: Layout) -> dict[str, np.ndarray]:
    """Return the matrices and the force that Exudyn itself evaluates."""
    constant = constant_part(motion)
    force = np.zeros(layout.size)
    force[layout.unknowns] = constant.force
    return {
        "stiffnessMatrix": layout.spread(constant.stiffness, layout.lock_stiffness),
        "dampingMatrix": layout.spread(constant.damping, layout.lock_damping),
        "forceVector": force,
    }


def _forces(motion: Motion, kernel: Kernel) -> StateForce | None:
    form = motion.formulation
    if form.has_spin:
        return kernel.forces_of_free_spin
    if not form.is_constant_speed:
        return kernel.forces_of_driven_spin
    return kernel.body_force_at_constant_speed if motion.has_body_force else None


def _with_guide(forces: StateForce | None, guide: LockedForce | None) -> Callable:
    """Return the user function of the forces, with those on locked coordinates."""
    if guide is None:
        return lambda mbs, t, item, q, q_t: forces(t, q, q_t)
    if forces is None:
        return lambda mbs, t, item, q, q_t: guide(t)
    return lambda mbs, t, item, q, q_t: guide(t) + forces(t, q, q_t)


def _mass_of_free_spin(
    start: np.ndarray, kernel: Kernel, layout: Layout
) -> tuple[exudyn.MatrixContainer, Callable]:
    """Return the mass matrix and its user function: only row and column of θ vary.

    Exudyn takes entries (row, column, value) faster than a matrix.
    """
    size, first = layout.size, layout.size - kernel.spin_coupling.size
    spin = kernel.spin
    fixed = start.copy()
    fixed[spin, :] = fixed[:, spin] = 0.0
    rows, columns = np.nonzero(fixed)
    modes, count = np.arange(first, size), size - first
    table = np.zeros((rows.size + 1 + 2 * count, 3))
    table[:, 0] = np.concatenate([rows, [spin], np.full(count, spin), modes])
    table[:, 1] = np.concatenate([columns, [spin], modes, np.full(count, spin)])
    table[: rows.size, 2] = fixed[rows, columns]
    across, down = table[-2 * count : -count, 2], table[-count:, 2]
    spin_entry = rows.size
    container = exudyn.MatrixContainer

    def entries() -> exudyn.MatrixContainer:
        table[spin_entry, 2] = kernel.spin_inertia
        across[:] = down[:] = kernel.spin_coupling
        matrix = container()
        matrix.SetWithSparseMatrixCSR(size, size, table, useDenseMatrix=False)
        return matrix

    def mass_matrix(mbs, t, item, q, q_t):
        kernel.update(q)
        return entries()

    kernel.update([0.0] * size)
    return entries(), mass_matrix


def _coupled_mass(motion: Motion, layout: Layout) -> Callable:
    places = np.ix_(layout.unknowns, layout.unknowns)
    mass = np.diag(layout.lock_mass)

    def mass_matrix(mbs, t, item, q, q_t):
        mass[places] = motion.mass_matrix(t, np.array(q)[layout.unknowns])
        return mass

    return mass_matrix


def _coupled_forces(motion: Motion, layout: Layout) -> StateForce:
    """Return the forces of the general equations, less those that Exudyn evaluates itself."""
    constant = constant_part(motion)

    def forces(t, q, q_t):
        values, rates = np.array(q)[layout.unknowns], np.array(q_t)[layout.unknowns]
        force = np.zeros(layout.size)
        by_exudyn = constant.force - constant.stiffness @ values - constant.damping @ rates
        force[layout.unknowns] = motion.forces(t, values, rates) - by_exudyn
        return force

    return forces


def _jacobian(motion: Motion, layout: Layout) -> Callable:
    constant = constant_part(motion)
    places = np.ix_(layout.unknowns, layout.unknowns)
    matrix = np.zeros((layout.size, layout.size))

    def jacobian(mbs, t, item, q, q_t, factor_q, factor_v):
        values, rates = np.array(q)[layout.unknowns], np.array(q_t)[layout.unknowns]
        by_q, by_v = motion.jacobian(t, values, rates)
        by_q += constant.stiffness
        by_v += constant.damping
        matrix[places] = -factor_q * by_q - factor_v * by_v
        return matrix

    return jacobian
