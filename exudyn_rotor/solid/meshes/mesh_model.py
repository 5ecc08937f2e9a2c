"""Finite-element models on meshes of other programs."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks
from exudyn_rotor.calls import user_level
from exudyn_rotor.solid.elements import Block, SolidElements
from exudyn_rotor.solid.meshes import abaqus, ansys, by_meshio, nastran
from exudyn_rotor.solid.meshes.mesh_data import MeshData, reading, skin
from exudyn_rotor.solid.model import FiniteElementModel, NodeSet, materials_by_region
from exudyn_rotor.solid.surface import area_weights, flat_triangles

if TYPE_CHECKING:
    import meshio

_READERS = {
    ".inp": abaqus.read,
    ".cdb": ansys.read,
    ".bdf": nastran.read,
    ".nas": nastran.read,
    ".dat": nastran.read,
}
# lengths, moduli and densities in SI of one unit of the file: of m, N, kg or of mm, N, t
_SI = {"m": (1.0, 1.0, 1.0), "mm": (1e-3, 1e6, 1e12)}


def import_model(
    mesh: str | os.PathLike | meshio.Mesh,
    materials: Mapping[str, Any] | None,
    *,
    interfaces: Sequence[str] | None,
    length_unit: str,
    leave_out: Sequence[str],
    matrices: str | os.PathLike | None,
    check_units: bool,
) -> FiniteElementModel:
    """Return the model of a mesh; parameters as ``SolidRotor.from_mesh``."""
    checks.flag(check_units, "check_units")
    lengths, moduli, densities = _SI[checks.choice(length_unit, "length_unit", _SI)]
    data = _read(mesh)
    _refuse(data, checks.labels(leave_out, "leave_out"))
    numbers, nodes = _used_nodes(data)
    blocks, names = _blocks(data.elements, _regions(data, materials), np.array(numbers))
    triangles = skin(blocks)
    sets = _node_sets(data, interfaces, numbers, lengths * nodes, triangles)
    if matrices is not None:
        pair = _assembled(checks.path(matrices, "matrices"), numbers)
        mass, stiffness = (matrix / lengths for matrix in pair)  # t, N/mm → kg, N/m
        return FiniteElementModel(lengths * nodes, mass, stiffness, None, sets, triangles)
    if materials is None:
        units = {"youngsModulus": moduli, "poissonsRatio": 1.0, "density": densities}
        materials = {
            name: {key: units[key] * values.get(key, np.nan) for key in units}
            for name, values in data.materials.items()
        }
    by_name = materials_by_region(names, materials, check_units)
    elements = SolidElements.of_materials(lengths * nodes, blocks, names, by_name)
    elements.check_shapes()
    if data.replaced:
        told = "; ".join(f"{name}: {how}" for name, how in sorted(data.replaced.items()))
        warnings.warn(f"mesh: {told}", UserWarning, stacklevel=user_level())
    mass, stiffness = elements.mass_matrix(), elements.stiffness_matrix()
    return FiniteElementModel(lengths * nodes, mass, stiffness, None, sets, triangles, elements)


def _read(mesh: str | os.PathLike | meshio.Mesh) -> MeshData:
    if hasattr(mesh, "cells_dict"):
        return by_meshio.convert(mesh)
    path = checks.file(mesh, "mesh")
    reader = _READERS.get(path.suffix.lower())
    return by_meshio.convert(by_meshio.load(path)) if reader is None else reader(path)


def _refuse(data: MeshData, left_out: Sequence[str]) -> None:
    """Refuse what a solid rotor does not have, unless it is to be left out."""
    known = {name.upper().lstrip("*") for name in left_out}
    refused = {
        name: what for name, what in data.refused.items() if name.upper().lstrip("*") not in known
    }
    if refused:
        told = ", ".join(f"{name} ({what})" for name, what in refused.items())
        raise ValueError(
            f"mesh: holds {told}, which a rotor of solid elements does not have; pass "
            f"leave_out={[*left_out, *refused]} to do without, and join what it joined by "
            "interfaces, supports, add_disc or add_point_mass"
        )
    if not data.elements:
        raise ValueError("mesh: needs tetrahedra, wedges or hexahedra, got no solid element")


def _used_nodes(data: MeshData) -> tuple[list[int], np.ndarray]:
    """Return the numbers of the nodes that elements have, in the order of the file, and places."""
    used = {node for rows in data.elements.values() for _, *nodes in rows for node in nodes}
    missing = sorted(used - data.nodes.keys())
    if missing:
        raise ValueError(f"mesh: elements have nodes that the file lacks: {missing[:5]}")
    numbers = [number for number in data.nodes if number in used]
    return numbers, np.array([data.nodes[number] for number in numbers], dtype=float)


def _regions(data: MeshData, materials: Mapping[str, Any] | None) -> dict[int, str]:
    """Return the region of elements by number, of the element sets that materials are given for."""
    given: dict[int, str] = {}
    own = {region for _, region in data.elements} | set(data.regions.values())
    sets = materials if isinstance(materials, Mapping) else ()
    for name in sets:
        if name in data.element_sets and name not in own:
            twice = [number for number in data.element_sets[name] if number in given]
            if twice:
                raise ValueError(
                    f"materials: element {twice[0]} is in {given[twice[0]]!r} and in {name!r}; "
                    "give sets that have no element in common"
                )
            given.update(dict.fromkeys(data.element_sets[name], name))
    return data.regions | given


def _blocks(
    elements: Mapping[tuple[str, str], list[list[int]]],
    regions: Mapping[int, str],
    numbers: np.ndarray,
) -> tuple[list[Block], list[str]]:
    """Return the elements by the places of their nodes, and the names of regions."""
    order = np.argsort(numbers)
    names: dict[str, int] = {}
    blocks = []
    for (kind, region), rows in elements.items():
        table = np.array(rows, dtype=np.int64)
        called = [regions.get(number, region) for number in table[:, 0].tolist()]
        chosen = np.array([names.setdefault(name, len(names)) for name in called])
        nodes = order[np.searchsorted(numbers[order], table[:, 1:])]
        blocks.append(Block(kind, nodes, chosen))
    return blocks, list(names)


def _node_sets(
    data: MeshData,
    interfaces: Sequence[str] | None,
    numbers: list[int],
    nodes: np.ndarray,
    triangles: np.ndarray,
) -> dict[str, NodeSet]:
    """Return places and weights of sets; by default of all that are not empty and not the whole.

    Weights are shares of the surface, equal ones where nodes are no part of it.
    """
    places = {number: i for i, number in enumerate(numbers)}
    known = {}
    for name, entries in data.node_sets.items():
        chosen = np.unique([places[number] for number in entries if number in places])
        if chosen.size and (interfaces is not None or chosen.size < len(places)):
            known[name] = chosen.astype(np.int64)
    wanted = checks.labels(list(known) if interfaces is None else interfaces, "interfaces", known)
    flat, sets = flat_triangles(triangles), {}
    for name in wanted:
        inside = flat[np.isin(flat, known[name]).all(axis=1)]
        whole = np.array_equal(np.unique(inside), known[name])
        sets[name] = area_weights(nodes, inside) if whole else (known[name], None)
    return sets


def _assembled(path: Path, numbers: list[int]) -> tuple[sp.csr_array, sp.csr_array]:
    """Return mass and stiffness of other programs on nodes with these numbers, in file units.

    `path` is ``name.sti`` of CalculiX, with ``.mas`` and ``.dof`` beside it, or has DMIG cards.
    """
    if path.suffix == ".sti":
        order = _equations(path.with_suffix(".dof"), numbers)
        mass, stiffness = (_calculix(path.with_suffix(end), order) for end in (".mas", ".sti"))
        return mass, stiffness
    found = nastran.read_dmig(path, numbers)
    pair = [[found[name] for name in found if name.upper().startswith(first)] for first in "MK"]
    if any(len(matrices) != 1 for matrices in pair):
        raise ValueError(
            f"matrices: {path.name}: needs DMIG cards of one matrix M… and one K…, got "
            f"{sorted(found)}"
        )
    return pair[0][0], pair[1][0]


def _equations(path: Path, numbers: list[int]) -> np.ndarray:
    """Return the coordinate of each equation of CalculiX."""
    places = {str(number): 3 * i for i, number in enumerate(numbers)}
    with reading(path.name):
        pairs = [text.split(".") for text in checks.file(path, "matrices").read_text().split()]
        order = np.array([places[node] + int(direction) - 1 for node, direction in pairs])
    if not np.array_equal(np.sort(order), np.arange(3 * len(numbers))):
        raise ValueError(
            f"matrices: {path.name}: has {order.size} of the {3 * len(numbers)} displacements; "
            "export without *BOUNDARY, *EQUATION and *MPC, which take equations away"
        )
    return order


def _calculix(path: Path, order: np.ndarray) -> sp.csr_array:
    """Return a matrix whose lines are row, column and value of an entry."""
    with reading(path.name):
        rows, columns, values = np.loadtxt(checks.file(path, "matrices"), ndmin=2).T
        places = [order[numbers.astype(int) - 1] for numbers in (rows, columns)]
    return nastran.symmetric(*places, values, order.size)
