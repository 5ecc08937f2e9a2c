"""What a finite-element source delivers, before the checks: arrays, materials, units, node sets."""

from __future__ import annotations

import re
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy.sparse as sp
from exudyn.FEM import FEMinterface
from scipy.sparse.csgraph import breadth_first_order, connected_components

from exudyn_rotor import checks
from exudyn_rotor.calls import user_level
from exudyn_rotor.solid.elements import SolidElements
from exudyn_rotor.solvers.inertia_relief import FREE_BELOW, locally_held, rigid_residuals

_LISTED = 6  # parts that a message describes
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

    @classmethod
    def of_elements(
        cls, elements: SolidElements, node_sets: Mapping[str, NodeSet], triangles: Any
    ) -> FiniteElementModel:
        """Return the model of elements."""
        return cls(
            nodes=elements.nodes,
            mass=elements.mass_matrix(),
            stiffness=elements.stiffness_matrix(),
            node_sets=node_sets,
            triangles=triangles,
            elements=elements,
        )


def node_set(name: str, entry: Any) -> NodeSet:
    """Read one entry of ``from_matrices(interfaces=…)``: nodes, or (nodes, weights)."""
    nodes, weights = entry, None
    if isinstance(entry, tuple) and len(entry) == 2 and not np.isscalar(entry[0]):
        nodes, weights = entry
    return checks.array(nodes, f"interfaces: {name!r}: nodes", dtype=int), weights


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
    return FiniteElementModel(
        nodes=_positions(fem.nodes),
        mass=fem.massMatrix,
        stiffness=fem.stiffnessMatrix,
        node_sets=_node_sets(fem.nodeSets),
        triangles=_triangles(fem.surface),
    )


def _positions(nodes: dict[str, Any]) -> np.ndarray:
    """Return the positions of the only node list; rotations and planar nodes are refused."""
    kinds = list(nodes)
    if any(kind.startswith("RigidBody") for kind in kinds):
        raise ValueError(
            f"fem: its nodes {kinds} are rotation-carrying (shells, beams); a solid rotor needs "
            "solid elements with 'Position' nodes"
        )
    if kinds != ["Position"]:
        raise ValueError(f"fem: needs 'Position' nodes only, got {kinds or 'no nodes'}")
    return nodes["Position"]


def _triangles(surfaces: list[dict[str, Any]]) -> np.ndarray:
    """Return the triangles of all surfaces, 6-node triangles if every surface has them."""
    surfaces = [surface for surface in surfaces if len(surface.get("Trigs", ()))]
    if not surfaces:
        return np.zeros((0, 3), dtype=np.int64)
    kind = "Trigs6" if all("Trigs6" in surface for surface in surfaces) else "Trigs"
    return np.vstack([np.asarray(surface[kind]) for surface in surfaces])


def _node_sets(node_sets: list[dict[str, Any]]) -> dict[str, NodeSet]:
    """Return node numbers and weights by name, without the sets of faces that have no name."""
    named = [node_set for node_set in node_sets if is_named(node_set["Name"])]
    names = [node_set["Name"] for node_set in named]
    repeated = sorted({name for name in names if names.count(name) > 1})
    if repeated:
        raise ValueError(f"fem: several node sets are named {repeated}; rename them")
    return {s["Name"]: (s["NodeNumbers"], s.get("NodeWeights")) for s in named}


Material = Mapping[str, float]
MATERIAL_KEYS = ("youngsModulus", "poissonsRatio", "density")

# Bar wave speed √(E/ρ) [m/s] from soft foam (about 30) to diamond (18 000), with a wide margin.
WAVE_SPEED_RANGE = (10.0, 1e5)
# Solids from aerogel (about 1) to osmium (22 600) [kg/m³].
DENSITY_RANGE = (1.0, 1e5)
# Mass over bounding box [kg/m³]; a bladed wheel may fill a thousandth of its box.
MEAN_DENSITY_RANGE = (1e-2, 1e5)
# Ten thousand tonnes [kg]; the heaviest turbine-generator rotors have about two thousand.
LARGEST_MASS = 1e7
# Few rotors but those of large hydroelectric generators are heavier [kg].
USUAL_MASS = 5e5

_ADVICE = (
    "convert to SI (m, kg, s, N, Pa), or pass check_units=False if the units of all inputs agree"
)


def materials_by_region(
    regions: Sequence[str], materials: Mapping[str, Any], check_units: bool
) -> dict[str, Material]:
    """Return one checked material for every region name; `materials` as of ``from_ngsolve``."""
    checks.mapping(materials, "materials", "material")
    names = sorted(set(regions))
    if any(key in materials for key in MATERIAL_KEYS):
        if len(names) > 1:
            raise ValueError(
                f"materials: one material was given, but the mesh has {len(names)} regions "
                f"{names}; give a dictionary by region name"
            )
        materials = {names[0]: materials}
    missing = [name for name in names if name not in materials]
    if missing:
        raise ValueError(
            f"materials: the mesh regions {missing} have no material; "
            f"given are {sorted(materials)}, the mesh has {names}"
        )
    checked = {name: _checked_material(name, materials[name]) for name in names}
    for name, material in checked.items() if check_units else ():
        _check_material_units(name, material)
    return checked


def _check_material_units(name: str, material: Material) -> None:
    """Raise ValueError if the material `name` cannot be in SI units."""
    density = material["density"]
    speed = np.sqrt(material["youngsModulus"] / density)
    if not _inside(density, DENSITY_RANGE):
        raise ValueError(
            f"materials: {name!r}: a density of {density:g} kg/m³ cannot be; "
            f"{_guess(density)} {_ADVICE}"
        )
    if not _inside(speed, WAVE_SPEED_RANGE):
        raise ValueError(
            f"materials: {name!r}: Young's modulus and density give a wave speed of "
            f"{speed:.3g} m/s (steel: 5200), which cannot be; {_ADVICE}"
        )


def check_model_units(nodes: np.ndarray, total_mass: float) -> None:
    """Raise ValueError if size [m] and mass [kg] of a model cannot be in SI, warn if hardly."""
    extent = np.ptp(nodes, axis=0)
    size = f"{total_mass:.3g} kg in a box of {' × '.join(f'{side:.3g}' for side in extent)} m"
    if total_mass > LARGEST_MASS:
        raise ValueError(
            f"units: {size} cannot be a rotor; lengths in mm, as Netgen reads all STEP files? "
            f"shape.Scale(Pnt(0, 0, 0), 1e-3) has metres; {_ADVICE}"
        )
    if total_mass > USUAL_MASS:
        warnings.warn(
            f"units: {size}: few rotors are that heavy; lengths in mm? Arrays are in m, kg, s; "
            "check_units=False takes them as they are",
            stacklevel=user_level(),
        )
    volume = float(np.prod(extent))
    if volume <= 1e-12 * np.max(extent) ** 3:
        return
    density = total_mass / volume
    if not _inside(density, MEAN_DENSITY_RANGE):
        raise ValueError(
            f"units: {size}, {density:.3g} kg/m³, cannot be; {_guess(density)} {_ADVICE}"
        )


def _checked_material(name: str, material: Any) -> Material:
    label = f"materials: {name!r}"
    checks.mapping(material, label, "number")
    if set(material) != set(MATERIAL_KEYS):
        raise ValueError(
            f"{label}: needs exactly the keys {list(MATERIAL_KEYS)}, got {sorted(material)}"
        )
    modulus, ratio, density = (material[key] for key in MATERIAL_KEYS)
    return {
        "youngsModulus": checks.number(modulus, f"{label}: youngsModulus", "Pa", above=0.0),
        "poissonsRatio": checks.number(ratio, f"{label}: poissonsRatio", above=-1.0, below=0.5),
        "density": checks.number(density, f"{label}: density", "kg/m³", above=0.0),
    }


def _inside(value: float, limits: tuple[float, float]) -> bool:
    return limits[0] <= value <= limits[1]


def _guess(density: float) -> str:
    return (
        "mm and tonnes?" if density < 1e-7 else "mm and kg?" if density < 1e-3 else "mixed units?"
    )


def loose_parts(nodes: np.ndarray, stiffness: sp.csr_array) -> list[np.ndarray]:
    """Return node numbers of the parts that the stiffness does not connect, largest first.

    None are returned if all nodes are connected, or if springs to the ground hold every part.
    """
    # a node has three rows: every third row pointer starts a node
    pointers, columns = stiffness.indptr[::3].copy(), stiffness.indices // 3
    graph = sp.csr_array((np.ones(columns.size), columns, pointers), shape=2 * (len(nodes),))
    # the pattern is symmetric; one search is a tenth of the cost of all components
    if len(breadth_first_order(graph, 0, return_predecessors=False)) == len(nodes):
        return []
    _, numbers = connected_components(graph, directed=False)
    order = np.argsort(numbers, kind="stable")
    parts = np.split(order, np.cumsum(np.bincount(numbers))[:-1])
    parts.sort(key=len, reverse=True)
    return parts if any(_is_free(nodes, stiffness, part) for part in parts) else []


def _is_free(nodes: np.ndarray, stiffness: sp.csr_array, part: np.ndarray) -> bool:
    """Return whether a rigid motion of a part is clearly free."""
    rows = (3 * part[:, None] + np.arange(3)).ravel()
    residuals, typical = rigid_residuals(nodes[part], stiffness[rows][:, rows])
    return bool(np.any((residuals < FREE_BELOW) & ~locally_held(residuals, typical)))


def described_part(
    part: np.ndarray, nodes: np.ndarray, mass: sp.csr_array, elements: SolidElements | None
) -> str:
    """Return materials, number of nodes, mass, box and its middle of a part as text."""
    names = () if elements is None else elements.materials_at(part)
    weight = mass[3 * part].sum()
    lowest, highest = nodes[part].min(axis=0), nodes[part].max(axis=0)
    sides = " × ".join(f"{side:.3g}" for side in highest - lowest)
    # a micrometre per metre is precise enough to find a part
    size = np.ptp(nodes) or 1.0
    center = np.round(0.5 * (lowest + highest) / size, 6) * size
    place = ", ".join(f"{x:.3g}" for x in center)
    return (
        " and ".join(repr(name) for name in names)
        + (": " if names else "")
        + f"{part.size} nodes, {weight:.3g} kg, {sides} m about ({place}) m"
    )


def check_connected(
    nodes: np.ndarray,
    mass: sp.csr_array,
    stiffness: sp.csr_array,
    elements: SolidElements | None,
) -> None:
    """Raise ValueError if the model falls into parts that move by themselves."""
    parts = loose_parts(nodes, stiffness)
    if not parts:
        return
    how = "couple them by springs inside the stiffness matrix"
    if elements is not None:
        how = "make one solid of them before meshing, OCCGeometry(netgen.occ.Glue([a, b]))"
    told = "; ".join(described_part(part, nodes, mass, elements) for part in parts[:_LISTED])
    raise ValueError(
        f"the model falls into {len(parts)} parts that nothing connects: "
        f"{told}{', …' if len(parts) > _LISTED else ''}. Parts that touch are not connected by "
        f"that; {how}, or pass allow_parts=True if they are to move by themselves"
    )
