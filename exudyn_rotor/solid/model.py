"""What a finite-element source delivers, before the checks: arrays, materials, units, node sets."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy.sparse as sp
from exudyn.FEM import FEMinterface
from scipy.sparse.csgraph import connected_components

from exudyn_rotor import checks
from exudyn_rotor.solid.elements import SolidElements
from exudyn_rotor.theory.axis import coupled, rigid_motions

NodeSet = tuple[Sequence[int], Sequence[float] | None]


@dataclass(frozen=True, eq=False)
class FiniteElementModel:
    """Arrays of one finite-element model as its source gave them, as of ``SolidRotor``.

    `node_sets` are node numbers and weights of every interface; weights None means equal ones.
    """

    nodes: Any
    mass: Any
    stiffness: Any
    damping: Any = None
    node_sets: Mapping[str, NodeSet] = field(default_factory=dict)
    triangles: Any = ()
    elements: SolidElements | None = None


# Face names that Netgen invents for faces without a name.
_INVENTED_NAME = re.compile(r"(default|bc_\d+)?")


def is_named(face: str) -> bool:
    """Tell whether a user gave this face name, rather than Netgen."""
    return _INVENTED_NAME.fullmatch(face) is None


def import_model(fem: FEMinterface) -> FiniteElementModel:
    """Return the model in `fem`; parameters and errors as ``SolidRotor.from_fem_interface``."""
    checks.instance(fem, "fem", FEMinterface, "of exudyn.FEM")
    for attribute in ("massMatrix", "stiffnessMatrix"):
        matrix = getattr(fem, attribute)
        if matrix is None or np.size(matrix) == 0:
            raise ValueError(f"fem: {attribute} is missing; import or compute it first")
    if list(fem.nodes) != ["Position"]:
        raise ValueError(
            f"fem: needs 'Position' nodes only, got {list(fem.nodes) or 'no nodes'}; a solid rotor "
            "has no nodes with rotations (shells, beams)"
        )
    named = [one for one in fem.nodeSets if is_named(one["Name"])]
    names = tuple(one["Name"] for one in named)
    checks.different(names, "fem: the names of its node sets")
    return FiniteElementModel(
        nodes=fem.nodes["Position"],
        mass=fem.massMatrix,
        stiffness=fem.stiffnessMatrix,
        node_sets={one["Name"]: (one["NodeNumbers"], one.get("NodeWeights")) for one in named},
        triangles=_triangles(fem.surface),
    )


def _triangles(surfaces: list[dict[str, Any]]) -> np.ndarray:
    """Return the triangles of all surfaces, 6-node triangles if every surface has them."""
    surfaces = [surface for surface in surfaces if len(surface.get("Trigs", ()))]
    if not surfaces:
        return np.zeros((0, 3), dtype=np.int64)
    kind = "Trigs6" if all("Trigs6" in surface for surface in surfaces) else "Trigs"
    return np.vstack([np.asarray(surface[kind]) for surface in surfaces])


Material = Mapping[str, float]
_KEYS = ("youngsModulus", "poissonsRatio", "density")

# With a wide margin: bar wave speed √(E/ρ) [m/s], soft foam has 30 and diamond 18 000; mass over
# bounding box [kg/m³], a bladed wheel may fill a thousandth of its box and osmium has 22 600.
_WAVE_SPEEDS, _MEAN_DENSITIES = (10.0, 1e5), (1e-2, 1e5)
_LARGEST_MASS = 5e5  # kg, of nearly all rotors; a mesh in mm has more
_ADVICE = (
    "convert to SI (m, kg, s, N, Pa), or pass check_units=False if the units of all inputs agree"
)


def materials_by_region(
    regions: Sequence[str], materials: Mapping[str, Any], check_units: bool
) -> dict[str, Material]:
    """Return one checked material for every region name; `materials` as of ``from_ngsolve``."""
    checks.mapping(materials, "materials", "material")
    names = sorted(set(regions))
    if any(key in materials for key in _KEYS):
        materials = dict.fromkeys(names, materials)
    missing = [name for name in names if name not in materials]
    if missing:
        raise ValueError(
            f"materials: the mesh regions {missing} have no material; "
            f"given are {sorted(materials)}, the mesh has {names}"
        )
    return {name: _checked_material(name, materials[name], check_units) for name in names}


def check_model_units(nodes: np.ndarray, total_mass: float) -> None:
    """Raise ValueError if size [m] and mass [kg] of a model cannot be in SI."""
    extent = np.ptp(nodes, axis=0)
    size = f"{total_mass:.3g} kg in a box of {box(nodes)}"
    if total_mass > _LARGEST_MASS:
        raise ValueError(
            f"units: {size}: few rotors are that heavy; lengths in mm, as Netgen reads all STEP "
            f"files? shape.Scale(Pnt(0, 0, 0), 1e-3) has metres; {_ADVICE}"
        )
    volume = float(np.prod(extent))
    if volume <= 1e-12 * np.max(extent) ** 3:
        return
    density, (low, high) = total_mass / volume, _MEAN_DENSITIES
    if not low <= density <= high:
        raise ValueError(
            f"units: {size}, {density:.3g} kg/m³, cannot be; {_guess(density)} {_ADVICE}"
        )


def _checked_material(name: str, material: Any, check_units: bool) -> Material:
    label = f"materials: {name!r}"
    checks.mapping(material, label, "number")
    if set(material) != set(_KEYS):
        raise ValueError(f"{label}: needs exactly the keys {list(_KEYS)}, got {sorted(material)}")
    modulus, ratio, density = (material[key] for key in _KEYS)
    modulus = checks.number(modulus, f"{label}: youngsModulus", "Pa", above=0.0)
    ratio = checks.number(ratio, f"{label}: poissonsRatio", above=-1.0, below=0.5)
    density = checks.number(density, f"{label}: density", "kg/m³", above=0.0)
    speed = np.sqrt(modulus / density)
    low, high = _WAVE_SPEEDS
    if check_units and not low <= speed <= high:
        raise ValueError(
            f"{label}: a wave speed √(E/ρ) of {speed:.3g} m/s (steel: 5200) cannot be; "
            f"{_guess(density)} {_ADVICE}"
        )
    return dict(zip(_KEYS, (modulus, ratio, density), strict=True))


def _guess(density: float) -> str:
    return (
        "mm and tonnes?" if density < 1e-7 else "mm and kg?" if density < 1e-3 else "mixed units?"
    )


def check_connected(nodes: np.ndarray, mass: sp.csr_array) -> None:
    """Raise ValueError if elements fall into parts that move by themselves."""
    count, numbers = connected_components(mass[::3, ::3], directed=False)
    if count > 1:
        part = nodes[numbers == np.bincount(numbers).argmin()]
        middle = 0.5 * (part.min(axis=0) + part.max(axis=0))
        raise ValueError(
            f"the model falls into {count} parts that nothing connects, one of {len(part)} nodes, "
            f"{box(part)} about {np.round(middle, 6).tolist()} m. Parts that touch are not "
            "connected by that; make one solid of them before meshing, "
            "OCCGeometry(netgen.occ.Glue([a, b]))"
        )


def box(nodes: np.ndarray) -> str:
    """Return the sides of the box about nodes (n, 3) as text."""
    return f"{' × '.join(f'{side:.3g}' for side in np.ptp(nodes, axis=0))} m"


# Limits of the relative residual ‖K r‖ / ‖ |K| |r| ‖ of a rigid motion r. Measured on meshes from
# 15 000 to 108 000 coordinates, the same in SI and in mm and tonnes: a free motion leaves 1e-16;
# rounding K to d digits gives 0.4·10⁻ᵈ in nearly all rows (4e-9 for 8 digits); springs of
# 1e4 N/m at one node or on one face give 1e-9 to 1e-8, bearings of 1e8 N/m 1e-6 to 1e-4, but in
# their own rows only. Where most rows cancel far better than the whole, the residual comes from
# such supports and not from lost digits.
_FREE_BELOW, _HELD_ABOVE = 1e-8, 1e-5
_LOCALLY_HELD_ABOVE, _LOCAL_RATIO = 1e-12, 1e-3


def rigid_basis(nodes: np.ndarray) -> np.ndarray:
    """Return orthonormal columns (3n, r) spanning the rigid motions that displace any node.

    r is 6, but 5 for nodes on one line and 3 for a single node.
    """
    center = nodes.mean(axis=0)
    radius = np.sqrt(np.mean(np.sum((nodes - center) ** 2, axis=1))) or 1.0
    motions = rigid_motions(nodes / radius, center / radius)
    basis, lengths, _ = np.linalg.svd(motions, full_matrices=False)
    return basis[:, : np.count_nonzero(lengths > 1e-9 * lengths[0])]


def count_rigid_motions(nodes: np.ndarray, stiffness: sp.csr_array) -> int:
    """Return how many of the six rigid motions `stiffness` leaves free.

    A rotation that displaces no node (about a line that holds all nodes) counts as free. The
    motions are combined such that each is held or free by itself (singular vectors of K R), and
    forces are compared with the terms that have to cancel, whatever the units and the mesh size.
    """
    basis = rigid_basis(nodes)
    motions = basis @ np.linalg.svd(stiffness @ basis, full_matrices=False)[2].T
    forces, terms = np.abs(stiffness @ motions), abs(stiffness) @ np.abs(motions)
    sizes = np.linalg.norm(terms, axis=0)
    residuals = np.linalg.norm(forces, axis=0) / np.where(sizes > 0.0, sizes, 1.0)
    typical = np.median(forces / np.where(terms > 0.0, terms, 1.0), axis=0)
    held = (typical < _LOCAL_RATIO * residuals) & (residuals > _LOCALLY_HELD_ABOVE)
    held |= residuals > _HELD_ABOVE
    doubtful = (residuals >= _FREE_BELOW) & ~held
    if np.any(doubtful):
        raise ValueError(
            f"stiffness matrix: {np.count_nonzero(doubtful)} rigid motions are neither free nor "
            f"held (relative residual {residuals[doubtful].max():.2g}, free is below "
            f"{_FREE_BELOW:g}, held above {_HELD_ABOVE:g}): it lost digits in an export, write "
            "all 16; or very soft springs to the ground act on most nodes"
        )
    return 6 - int(np.count_nonzero(held))


# springs of clamped nodes over the largest diagonal entry of the stiffness: they move by less than
# 1e-10 of the others; above a share of it no spring to the ground means anything else
_SPRING, _STIFFER = 1e6, 1e4


def holding_spring(stiffness: sp.csr_array) -> float:
    """Return the spring [N/m] that holds clamped coordinates."""
    return float(_SPRING * stiffness.diagonal()[~clamped_coordinates(stiffness)].max())


def clamped_coordinates(stiffness: sp.csr_array) -> np.ndarray:
    """Return which coordinates are clamped (3n,): those on nothing but a stiff spring."""
    joined, diagonal = coupled(stiffness), stiffness.diagonal()
    return ~joined & joined.any() & (diagonal > _STIFFER * diagonal[joined].max(initial=0.0))
