"""A reduced rotor for static loads: its deflection is that of the solid model."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exudyn_rotor.prestress.static_solution import centrifugal_load
from exudyn_rotor.reduction.attachment import attachment_modes
from exudyn_rotor.reduction.component import ModeBasis, free_modes
from exudyn_rotor.reduction.reduce import reduce_rotor
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid.rotor import FiniteElementRotor
from exudyn_rotor.solvers.inertia_relief import free_motions_of, inertia_relief
from exudyn_rotor.theory.nodal import translations

_MODES = 12  # free modes, for what a spin adds


def reduced_for_loads(
    rotor: FiniteElementRotor, nodes: Sequence[int], *, spins: bool, stress: bool
) -> ReducedRotor:
    """Return the rotor with its static responses to loads at interfaces and nodes.

    Parameters
    ----------
    rotor : SolidRotor
    nodes : sequence of int
        Loaded nodes.
    spins : bool
        Whether it turns: it has free modes, too, and the static centrifugal displacement.
    stress : bool
        Whether to find the stress of the modes.

    Raises
    ------
    ValueError
        If the rotor has loose parts.
    """
    columns = [attachment_modes(rotor, np.zeros((rotor.nodes.size, 0))).matrix]
    loads = [np.eye(1, rotor.nodes.size, 3 * n + i)[0] for n in nodes for i in range(3)]
    if rotor.grounded:
        loads += list((rotor.mass @ translations(rotor.node_count)).T)
    if spins:
        loads.append(centrifugal_load(rotor))
    if loads:
        columns.append(inertia_relief(rotor).solve(np.column_stack(loads)))
    if spins:
        most = rotor.nodes.size - free_motions_of(rotor).shape[1]
        columns.append(free_modes(rotor, min(_MODES, most)).matrix)
    matrix = np.hstack(columns)
    sizes = np.sqrt(np.einsum("ik,ik->k", matrix, rotor.mass @ matrix))
    matrix = matrix[:, sizes > 0.0] / sizes[sizes > 0.0]
    labels = tuple(f"static mode {i + 1}" for i in range(matrix.shape[1]))
    known = None if spins or rotor.carried_prestress is not None else False
    basis = ModeBasis(matrix, labels, rotor.nodes)
    return reduce_rotor(rotor, basis, stress=stress, prestress=known)
