"""A full body's equations in Exudyn: sparse matrices, and user functions for what varies.

As for a reduced rotor, Exudyn evaluates what is linear with constant
coefficients. Of a mass matrix that varies, one row and column do, that of the spin; they stand in
an object of their own, so that the rotor's matrices are handed over once.
"""

from __future__ import annotations

from collections.abc import Callable

import exudyn
import numpy as np
import scipy.sparse as sp
from exudyn.itemInterface import ObjectGenericODE2, VObjectGenericODE2

from exudyn_rotor.multibody.full.ties import container, no_jacobian
from exudyn_rotor.multibody.rotor.frame import Layout, LockedForce
from exudyn_rotor.theory.full_motion import FullMotion


def sparse_object(
    motion: FullMotion,
    layout: Layout,
    nodes: list,
    guide: LockedForce | None,
    graphics: Callable | None,
) -> ObjectGenericODE2:
    """Return the object with the constant matrices, and the forces that vary.

    `guide` drives locked coordinates; `graphics` draws the rotor.
    """
    none = np.zeros(layout.size)
    locks = (layout.lock_mass, none, none)
    mass, damping, stiffness = (
        container(_spread(matrix, layout, diagonal))
        for matrix, diagonal in zip(motion.constant_matrices(), locks, strict=True)
    )
    force = np.zeros(layout.size)
    force[layout.unknowns] = motion.constant_force()
    functions = {"jacobianUserFunction": no_jacobian(layout.size)}
    if motion.has_varying_forces or guide is not None:
        functions["forceUserFunction"] = _forces(motion, layout, guide)
    if motion.has_varying_forces and not motion.formulation.is_constant_speed:
        functions["jacobianUserFunction"] = _jacobian(motion, layout)
    drawing = {"show": graphics is not None}
    if graphics is not None:
        drawing["graphicsDataUserFunction"] = graphics
    return ObjectGenericODE2(
        nodeNumbers=nodes,
        massMatrix=mass,
        dampingMatrix=damping,
        stiffnessMatrix=stiffness,
        forceVector=force,
        **functions,
        visualization=VObjectGenericODE2(**drawing),
    )


def spin_coupling_object(motion: FullMotion, layout: Layout, nodes: list) -> ObjectGenericODE2:
    """Return the object of the inertia that varies with the displacements, (84) and (85)."""
    spin = int(layout.unknowns[motion.modes.start - 1])
    places = layout.unknowns[motion.modes]
    count, size = len(places), layout.size
    table = np.zeros((2 * count + 1, 3))
    table[0, :2] = spin
    table[1 : count + 1, 0] = table[count + 1 :, 1] = spin
    table[1 : count + 1, 1] = table[count + 1 :, 0] = places
    matrix = exudyn.MatrixContainer()

    def mass(mbs, t, item, q, q_t):
        moment, row = motion.varying_inertia(np.asarray(q)[places])
        table[0, 2] = moment
        table[1 : count + 1, 2] = table[count + 1 :, 2] = row
        matrix.SetWithSparseMatrixCSR(size, size, table, False)
        return matrix

    empty = container(sp.csr_array((size, size)))
    return ObjectGenericODE2(
        nodeNumbers=nodes,
        massMatrix=empty,
        stiffnessMatrix=empty,
        dampingMatrix=empty,
        massMatrixUserFunction=mass,
        jacobianUserFunction=no_jacobian(size),
        visualization=VObjectGenericODE2(show=False),
    )


def _spread(matrix: sp.csr_array, layout: Layout, diagonal: np.ndarray) -> sp.csr_array:
    """Return a matrix of the unknowns on all coordinates of the nodes, `diagonal` added."""
    entries = sp.coo_array(matrix)
    rows, columns = (layout.unknowns[part] for part in entries.coords)
    shape = (layout.size, layout.size)
    return sp.csr_array((entries.data, (rows, columns)), shape=shape) + sp.diags_array(diagonal)


def _forces(motion: FullMotion, layout: Layout, guide: LockedForce | None) -> Callable:
    def forces(mbs, t, item, q, q_t):
        total = np.zeros(layout.size) if guide is None else np.array(guide(t))
        if motion.has_varying_forces:
            q, q_t = (np.asarray(values)[layout.unknowns] for values in (q, q_t))
            total[layout.unknowns] += motion.varying_forces(t, q, q_t)
        return total.tolist()

    return forces


def _jacobian(motion: FullMotion, layout: Layout) -> Callable:
    none = np.zeros(layout.size)

    def jacobian(mbs, t, item, q, q_t, factor_q, factor_v):
        q, q_t = (np.asarray(values)[layout.unknowns] for values in (q, q_t))
        matrix = motion.varying_jacobian(t, q, q_t, factor_q, factor_v)
        return container(_spread(matrix, layout, none))

    return jacobian
