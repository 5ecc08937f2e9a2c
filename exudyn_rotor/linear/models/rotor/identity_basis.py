"""A small full model as a reduced rotor whose basis is the identity."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exudyn_rotor.prestress.static_solution import relief_rotations
from exudyn_rotor.reduction.fields import ModeShapes, ReducedInterface
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid.damping import dense_damping
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.stiffening import with_prestress


def as_reduced(rotor: SolidRotor) -> ReducedRotor:
    """Return a small solid rotor as a reduced one whose basis is the identity."""
    size = 3 * rotor.node_count
    return ReducedRotor(
        axis=rotor.axis,
        center_of_mass=rotor.center_of_mass,
        invariants=_invariants(rotor),
        rigid_kinds=(),
        interfaces={
            name: ReducedInterface(
                entry.reference,
                entry.center,
                entry.radius,
                entry.mean_motion(rotor.node_count).toarray(),
            )
            for name, entry in rotor.interfaces.items()
        },
        mode_mass=rotor.mass.toarray(),
        grounded=rotor.grounded,
        shapes=ModeShapes(rotor.nodes, np.eye(size), rotor.triangles),
    )


def _invariants(rotor: SolidRotor) -> Invariants:
    """Return the dense invariants about the centre of mass, with a carried prestress."""
    matrices = rotor.mass.toarray(), rotor.stiffness.toarray(), dense_damping(rotor)
    arms, identity = rotor.nodes - rotor.center_of_mass, np.eye(3 * rotor.node_count)
    invariants = Invariants.of(arms, *matrices, identity, rotor.axis.direction)
    if rotor.structural_damping is not None:
        invariants = replace(invariants, H=rotor.structural_damping.toarray())
    carried = rotor.carried_prestress
    if carried is None:
        return invariants
    euler = None if carried.euler is None else carried.euler.toarray()
    K4 = None if carried.per_fourth_power is None else carried.per_fourth_power.toarray()
    K2 = carried.per_square.toarray()
    return with_prestress(invariants, K2, euler, relief_rotations(rotor), K4)
