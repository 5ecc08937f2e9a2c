"""Rayleigh and structural damping of the rotor's own material; it acts in the rotor frame."""

from __future__ import annotations

from dataclasses import replace

import scipy.sparse as sp

from exudyn_rotor import checks
from exudyn_rotor.solid import matrices
from exudyn_rotor.solid.rotor import FiniteElementRotor, Rotor

LOSS_LEFT_OUT = (
    "structural damping, with_damping(loss=η), belongs to one frequency at a time: only "
    "harmonic_response and unbalance_response take it. {} without it; with_damping(stiffness=η/ν) "
    "is viscous damping that is equal at the frequency ν [rad/s] seen in the rotor frame"
)


def with_damping(rotor: Rotor, mass: float, stiffness: float, loss: float) -> Rotor:
    """Return the damped rotor; see :meth:`exudyn_rotor.SolidRotor.with_damping`."""
    by_mass = checks.number(mass, "mass", "1/s", least=0.0) * rotor.mass
    by_stiffness = checks.number(stiffness, "stiffness", "s", least=0.0) * rotor.stiffness
    by_loss = checks.number(loss, "loss", least=0.0) * rotor.stiffness
    mass_damping = rotor.mass_damping
    if rotor.rigid_motions:
        mass_damping = _sum(mass_damping, by_mass)
    else:
        by_stiffness = by_stiffness + by_mass
    return replace(
        rotor,
        damping=_sum(rotor.damping, by_stiffness),
        mass_damping=mass_damping,
        structural_damping=_sum(rotor.structural_damping, by_loss),
    )


def sparse_damping(rotor: FiniteElementRotor) -> sp.csr_array | None:
    """Return the damping (3n, 3n) of a large rotor.

    ValueError if a part is proportional to the mass: without the rigid motions it is not sparse.
    """
    if rotor.mass_damping is not None:
        raise ValueError(
            "with_damping(mass=…): a large model that rigid motions are free in cannot be analysed "
            "with damping in proportion to its mass; reduce it, rotor.reduce(…), or give "
            "stiffness=… alone"
        )
    return rotor.damping


def _sum(before: sp.csr_array | None, added: sp.csr_array) -> sp.csr_array | None:
    """Return the sum; None if there is nothing in it."""
    total = added if before is None else before + added
    total = matrices.frozen(sp.csr_array(total))
    return total if total.nnz else None
