"""Rayleigh and structural damping of the rotor's own material; it acts in the rotor frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks
from exudyn_rotor.solid import matrices
from exudyn_rotor.solid.rotor import FiniteElementRotor, Rotor

_UNITS = {"mass": "1/s", "stiffness": "s", "loss": ""}

LOSS_LEFT_OUT = (
    "structural damping, with_damping(loss=η), belongs to one frequency at a time: only "
    "harmonic_response and unbalance_response take it. {} without it; with_damping(stiffness=η/ν) "
    "is viscous damping that is equal at the frequency ν [rad/s] seen in the rotor frame"
)


def with_damping(
    rotor: Rotor,
    mass: float,
    stiffness: float,
    loss: float,
    materials: Mapping[str, Mapping[str, float]] | None,
) -> Rotor:
    """Return the damped rotor; see :meth:`exudyn_rotor.SolidRotor.with_damping`."""
    factors = _factors({"mass": mass, "stiffness": stiffness, "loss": loss}, "")
    by_mass, by_stiffness = factors["mass"] * rotor.mass, factors["stiffness"] * rotor.stiffness
    by_loss = factors["loss"] * rotor.stiffness
    if materials is not None:
        of_mass, of_stiffness, of_loss = _of_regions(rotor, materials)
        by_mass = by_mass + rotor.elements.mass_matrix(of_mass)
        by_stiffness = by_stiffness + rotor.elements.stiffness_matrix(of_stiffness)
        by_loss = by_loss + rotor.elements.stiffness_matrix(of_loss)
    damping, mass_damping = rotor.damping, rotor.mass_damping
    if rotor.rigid_motions:
        mass_damping = _sum(mass_damping, by_mass)
    else:
        by_stiffness = by_stiffness + by_mass
    return replace(
        rotor,
        damping=_sum(damping, by_stiffness),
        mass_damping=mass_damping,
        structural_damping=_sum(rotor.structural_damping, by_loss),
    )


def sparse_damping(rotor: FiniteElementRotor) -> sp.csr_array | None:
    """Return the damping (3n, 3n) of a large rotor.

    Raises
    ------
    ValueError
        If a part of it is proportional to the mass: without the rigid motions it is not sparse.
    """
    if rotor.mass_damping is not None:
        raise ValueError(
            "with_damping(mass=…): a large model that rigid motions are free in cannot be analysed "
            "with damping in proportion to its mass; reduce it, rotor.reduce(…), or give "
            "stiffness=… alone"
        )
    return rotor.damping


def _factors(given: Mapping[str, float], label: str) -> dict[str, float]:
    return {
        name: checks.number(given.get(name, 0.0), f"{label}{name}", unit, least=0.0)
        for name, unit in _UNITS.items()
    }


def _of_regions(
    rotor: FiniteElementRotor, materials: Mapping[str, Mapping[str, float]]
) -> tuple[np.ndarray, ...]:
    """Return the factors of mass, stiffness and loss for every region of the mesh."""
    checks.mapping(materials, "materials", "factors {'mass': 1/s, 'stiffness': s, 'loss': 1}")
    if rotor.elements is None:
        raise ValueError(
            "materials: this rotor has no elements that tell its materials apart; make it with "
            "SolidRotor.from_ngsolve or from_mesh"
        )
    regions = rotor.elements.materials
    checks.labels(tuple(materials), "materials", sorted(set(regions)))
    by_name = {}
    for name, factors in materials.items():
        label = f"materials: {name!r}"
        checks.mapping(factors, label, "factor")
        checks.labels(tuple(factors), label, _UNITS)
        by_name[name] = _factors(factors, f"{label}: ")
    none = dict.fromkeys(_UNITS, 0.0)
    rows = [by_name.get(region, none) for region in regions]
    return tuple(np.array([row[name] for row in rows]) for name in _UNITS)


def _sum(before: sp.csr_array | None, added: sp.csr_array) -> sp.csr_array | None:
    """Return the sum; None if there is nothing in it."""
    total = added if before is None else before + added
    total = matrices.frozen(sp.csr_array(total))
    return total if total.nnz else None
