"""The rotor's equations as one ``ObjectGenericODE2``: user functions, or constant matrices.

The object shares its nodes with the native shell. Its coordinates are those of the nodes; the
unknowns of the formulation are placed among them, and what is left is locked.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from exudyn.itemInterface import ObjectGenericODE2, VObjectGenericODE2

from exudyn_rotor.motion import Motion

LockedForce = Callable[[float], np.ndarray]


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

    def spread(self, matrix: np.ndarray, diagonal: np.ndarray) -> np.ndarray:
        """Return a (size, size) matrix with `matrix` on the unknowns and `diagonal` added."""
        full = np.diag(diagonal)
        full[np.ix_(self.unknowns, self.unknowns)] += matrix
        return full


def constant_object(motion: Motion, layout: Layout, nodes: list) -> ObjectGenericODE2:
    """Return the object with constant matrices (109): no Python call in a time step."""
    rest = np.zeros(motion.size)
    by_q, by_v = motion.jacobian(0.0, rest, rest)
    force = np.zeros(layout.size)
    force[layout.unknowns] = motion.forces(0.0, rest, rest)
    return ObjectGenericODE2(
        nodeNumbers=nodes,
        massMatrix=layout.spread(motion.mass_matrix(0.0, rest), layout.lock_mass),
        stiffnessMatrix=layout.spread(-by_q, layout.lock_stiffness),
        dampingMatrix=layout.spread(-by_v, layout.lock_damping),
        forceVector=force,
        visualization=VObjectGenericODE2(show=False),
    )


def user_function_object(
    motion: Motion, layout: Layout, nodes: list, locked_force: LockedForce | None
) -> ObjectGenericODE2:
    """Return the object with user functions for mass matrix, forces and Jacobian.

    `locked_force(t)` gives the forces, shape (size,), that drive locked coordinates along their
    prescribed motion.
    """
    unknowns = layout.unknowns
    places = np.ix_(unknowns, unknowns)
    mass_frame = np.diag(layout.lock_mass)
    stiffness, damping = np.diag(layout.lock_stiffness), np.diag(layout.lock_damping)

    def mass_matrix(mbs, t, item_number, q, q_t):
        mass_frame[places] = motion.mass_matrix(t, np.asarray(q)[unknowns])
        return mass_frame

    def forces(mbs, t, item_number, q, q_t):
        force = np.zeros(layout.size) if locked_force is None else locked_force(t)
        force[unknowns] = motion.forces(t, np.asarray(q)[unknowns], np.asarray(q_t)[unknowns])
        return force

    def jacobian(mbs, t, item_number, q, q_t, factor_q, factor_v):
        by_q, by_v = motion.jacobian(t, np.asarray(q)[unknowns], np.asarray(q_t)[unknowns])
        full = np.zeros((layout.size, layout.size))
        full[places] = -factor_q * by_q - factor_v * by_v
        return full

    return ObjectGenericODE2(
        nodeNumbers=nodes,
        massMatrix=np.eye(layout.size),
        stiffnessMatrix=stiffness,
        dampingMatrix=damping,
        massMatrixUserFunction=mass_matrix,
        forceUserFunction=forces,
        jacobianUserFunction=jacobian,
        visualization=VObjectGenericODE2(show=False),
    )
