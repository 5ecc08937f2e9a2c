"""Modes of a ``FEMinterface`` seen from the mean motion of the rotor (Tisserand frame).

Exudyn's floating frame moves with whatever its modes do not move. Craig–Bampton modes hold it at
their first boundary; what tilts the rotor against that boundary is then a deformation, linear in
its coordinate. Its second-order displacement is missing, and with it the work of the centrifugal
field (:mod:`exudyn_rotor.theory.stiffening`): such deformations soften with Ω². Without their share
in the rigid motions R, the same modes leave tilts to the frame, whose equations hold them to every
order.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg
from exudyn.FEM import FEMinterface

from exudyn_rotor import checks
from exudyn_rotor.reduction.component import gram_schmidt, modes_of
from exudyn_rotor.solid.matrices import as_mass, as_nodes
from exudyn_rotor.solid.model import import_model
from exudyn_rotor.theory.axis import rigid_motions


def use_mean_axis_modes(fem: FEMinterface) -> tuple[int, ...]:
    """Put the modes of a ``FEMinterface`` into a mean-axis frame, in place.

    Exudyn's own flexible body then has the same mode space as a fixed-axis rotor with the same
    ``FEMinterface``, and the two can be run side by side. As they are computed, Craig–Bampton modes
    hold Exudyn's frame at the first boundary, and what tilts the rotor against it softens falsely
    with the square of the speed. Free eigenmodes stay as they are.

    Parameters
    ----------
    fem : exudyn.FEM.FEMinterface
        With nodes, mass matrix and modes. ``modeBasis['matrix']`` is replaced by
        ``Ψ − R (RᵀMR)⁻¹ RᵀMΨ``, R the six rigid motions. Stress modes remain right, since rigid
        motions have no stress.

    Returns
    -------
    tuple of int
        Numbers of the modes that are left out, usually none: rigid motions, and combinations of
        others, with their stress.

    Raises
    ------
    TypeError, ValueError
        For bad input, or if nothing but rigid motions remains.

    Examples
    --------
    Two masses on a spring, and a mode that holds the first of them:

    >>> import numpy as np
    >>> import scipy.sparse as sp
    >>> from exudyn.FEM import FEMinterface
    >>> from exudyn_rotor import use_mean_axis_modes
    >>> fem = FEMinterface()
    >>> fem.nodes = {"Position": np.array([[0.0, 0, 0], [1.0, 0, 0]])}
    >>> fem.massMatrix = sp.diags([1.0, 1, 1, 3, 3, 3]).tocsr()
    >>> fem.stiffnessMatrix = sp.csr_matrix(np.kron([[1, -1], [-1, 1]], np.diag([1.0, 0, 0])))
    >>> fem.modeBasis = {"matrix": np.array([[0.0, 0, 0, 1, 0, 0]]).T, "type": "HCBmodes"}
    >>> use_mean_axis_modes(fem)
    ()
    >>> print(fem.modeBasis["matrix"].T)
    [[-0.75  0.    0.    0.25  0.    0.  ]]
    """
    checks.instance(fem, "fem", FEMinterface)
    model = import_model(fem)
    nodes = as_nodes(model.nodes)
    mass = as_mass(model.mass, len(nodes))
    modes = modes_of(fem, nodes)
    rigid = rigid_motions(nodes, nodes.mean(axis=0))
    weighted = mass @ rigid
    flexible = modes - rigid @ (scipy.linalg.pinvh(rigid.T @ weighted) @ (weighted.T @ modes))
    count = rigid.shape[1]
    used = gram_schmidt(np.hstack([rigid, modes]), mass)[2]
    elastic = [index - count for index in used if index >= count]
    if not elastic:
        raise ValueError("fem: its modes are rigid motions alone; no flexible mode would remain")
    fem.modeBasis = fem.modeBasis | {"matrix": flexible[:, elastic]}
    stress = fem.postProcessingModes.get("matrix")
    if stress is not None and np.shape(stress)[1] == 6 * modes.shape[1]:
        columns = [6 * index + component for index in elastic for component in range(6)]
        kept = {"matrix": np.asarray(stress)[:, columns]}
        fem.postProcessingModes = fem.postProcessingModes | kept
    return tuple(index for index in range(modes.shape[1]) if index not in elastic)
