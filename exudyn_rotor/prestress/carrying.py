"""Rotors that carry a prestress."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks
from exudyn_rotor.prestress.static_solution import relief_under_stress, static_prestress
from exudyn_rotor.prestress.static_state import check_static_state
from exudyn_rotor.solid import matrices
from exudyn_rotor.solid.carried_prestress import Prestress
from exudyn_rotor.solid.rotor import Rotor, check_unstressed
from exudyn_rotor.solvers.inertia_relief import Way, free_rigid_motions, inertia_relief


def with_prestress(rotor: Rotor, prestress: Prestress) -> Rotor:
    """Return the rotor carrying a prestress; see :meth:`exudyn_rotor.SolidRotor.with_prestress`."""
    checks.instance(prestress, "prestress", Prestress, "rotor.prestress() computes one")
    check_unstressed(rotor)
    matrices.check_same_mesh(rotor.nodes, prestress.nodes, "prestress")
    check_static_state(rotor, prestress)
    stiffness = rotor.stiffness
    if prestress.constant is not None:
        stiffness = matrices.frozen(sp.csr_array(stiffness + prestress.constant))
        free = free_rigid_motions(rotor.nodes, rotor.mass, rotor.stiffness, rotor.rigid_motions)
        relief_under_stress(stiffness, rotor.mass, free, Way.of(rotor))
    return replace(rotor, stiffness=stiffness, carried_prestress=replace(prestress, constant=None))


def with_chosen_prestress(rotor: Rotor, prestress: Prestress | bool | None) -> Rotor:
    """Return the rotor with what ``reduce(prestress=…)`` asks for; None is the best there is."""
    if prestress is None:
        return rotor if rotor.carried_prestress is not None else _with_own_prestress(rotor)
    if isinstance(prestress, bool | np.bool_):
        if not prestress:
            return replace(rotor, carried_prestress=None)
        return replace(rotor, carried_prestress=static_prestress(rotor))
    return with_prestress(rotor, prestress)


def _with_own_prestress(rotor: Rotor) -> Rotor:
    """Return the rotor with the prestress of its elements; as it is where that cannot be had."""
    if rotor.elements is None:
        return rotor
    try:
        inertia_relief(rotor)
    except ValueError:  # parts that nothing connects have no static state
        return rotor
    return replace(rotor, carried_prestress=static_prestress(rotor))
