"""Finite-element models on meshes of other programs."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks
from exudyn_rotor.solid.elements import Block, SolidElements
from exudyn_rotor.solid.meshes import abaqus, ansys, by_meshio, nastran
from exudyn_rotor.solid.meshes.mesh_data import ElementGroup, MeshData, Refusals, face_nodes, skin
from exudyn_rotor.solid.model import FiniteElementModel, NodeSet, materials_by_region
from exudyn_rotor.solid.shapes import KINDS
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
    if isinstance(leave_out, str):
        raise TypeError(f"leave_out: needs a list of names, got the text {leave_out!r}")
    names = checks.items(leave_out, "leave_out", "names")
    refusals = Refusals([checks.label(name, "leave_out") for name in names])
    data = _read(mesh, refusals)
    if not data.groups:
        raise ValueError("mesh: needs tetrahedra, wedges or hexahedra, got no solid element")
    numbers, nodes = _used_nodes(data)
    places = {number: i for i, number in enumerate(numbers)}
    regions = _regions(data, materials)
    blocks, names = _blocks(data.groups, regions, numbers)
    triangles = skin(blocks)
    sets = _node_sets(data, interfaces, places, lengths * nodes, triangles)
    if matrices is not None:
        pair = _assembled(checks.path(matrices, "matrices"), numbers)
        mass, stiffness = (matrix / lengths for matrix in pair)  # t, N/mm → kg, N/m
        return FiniteElementModel(lengths * nodes, mass, stiffness, None, sets, triangles)
    if materials is None:
        materials = {
            name: {
                "youngsModulus": moduli * values.get("youngsModulus", np.nan),
                "poissonsRatio": values.get("poissonsRatio", np.nan),
                "density": densities * values.get("density", np.nan),
            }
            for name, values in data.materials.items()
        }
    by_name = materials_by_region(names, materials, check_units)
    elements = SolidElements.of_materials(lengths * nodes, blocks, names, by_name)
    elements.check_shapes()
    refusals.warn()
    return FiniteElementModel.of_elements(elements, sets, triangles)


def _read(mesh: str | os.PathLike | meshio.Mesh, refusals: Refusals) -> MeshData:
    if hasattr(mesh, "cells_dict"):
        return by_meshio.convert(mesh)
    path = checks.file(mesh, "mesh")
    reader = _READERS.get(path.suffix.lower())
    return by_meshio.convert(by_meshio.load(path)) if reader is None else reader(path, refusals)


def _used_nodes(data: MeshData) -> tuple[list[int], np.ndarray]:
    """Return the numbers of the nodes that elements have, in the order of the file, and places."""
    table = dict(zip(data.numbers, data.nodes, strict=True))
    used = set(np.concatenate([group.nodes.ravel() for group in data.groups]).tolist())
    missing = sorted(used - table.keys())
    if missing:
        raise ValueError(f"mesh: elements have nodes that the file lacks: {missing[:5]}")
    numbers = [number for number in table if number in used]
    return numbers, np.array([table[number] for number in numbers], dtype=float)


def _regions(data: MeshData, materials: Mapping[str, Any] | None) -> dict[int, str]:
    """Return the region of elements by number, of the element sets that materials are given for."""
    given: dict[int, str] = {}
    own = {group.region for group in data.groups} | set(data.regions.values())
    sets = materials if isinstance(materials, Mapping) else ()
    for name in sets:
        if name in data.element_sets and name not in own:
            twice = [number for number in data.element_sets[name] if number in given]
            if twice:
                raise ValueError(
                    f"materials: element {twice[0]} is in {given[twice[0]]!r} and in {name!r}"
                )
            given.update(dict.fromkeys(data.element_sets[name], name))
    return data.regions | given


def _blocks(
    groups: Sequence[ElementGroup], regions: Mapping[int, str], numbers: Sequence[int]
) -> tuple[list[Block], list[str]]:
    """Return the elements of each kind by the places of their nodes, and the names of regions."""
    order = np.argsort(numbers)
    names: dict[str, int] = {}
    kinds: dict[str, list[tuple[np.ndarray, np.ndarray]]] = {}
    for group in groups:
        nodes = order[np.searchsorted(np.asarray(numbers)[order], group.nodes)]
        called = [regions.get(number, group.region) for number in group.numbers.tolist()]
        chosen = np.array([names.setdefault(name, len(names)) for name in called])
        kinds.setdefault(group.kind, []).append((nodes, chosen))
    blocks = [
        Block(kind, *(np.concatenate(parts) for parts in zip(*pieces, strict=True)))
        for kind, pieces in kinds.items()
    ]
    return blocks, list(names)


def _node_sets(
    data: MeshData,
    interfaces: Sequence[str] | None,
    places: Mapping[int, int],
    nodes: np.ndarray,
    triangles: np.ndarray,
) -> dict[str, NodeSet]:
    """Return places and weights of sets; by default of all that are not empty and not the whole."""
    sets = {**data.node_sets, **_surface_nodes(data)}
    known = {}
    for name, entries in sets.items():
        chosen = np.unique([places[number] for number in entries if number in places])
        if chosen.size and (interfaces is not None or chosen.size < len(places)):
            known[name] = chosen.astype(np.int64)
    if isinstance(interfaces, str):
        raise TypeError(f"interfaces: needs a list of names of sets, got the text {interfaces!r}")
    wanted = checks.labels(list(known) if interfaces is None else interfaces, "interfaces", known)
    flat = flat_triangles(triangles)
    return {name: _weighted(known[name], nodes, flat) for name in wanted}


def _weighted(chosen: np.ndarray, nodes: np.ndarray, flat: np.ndarray) -> NodeSet:
    """Return nodes with their shares of the surface, equal ones where they are no part of it."""
    inside = flat[np.isin(flat, chosen).all(axis=1)]
    if np.array_equal(np.unique(inside), chosen):
        return area_weights(nodes, inside)
    return chosen, None


def _surface_nodes(data: MeshData) -> dict[str, list[int]]:
    """Return the nodes of the faces of elements in every surface."""
    if not data.surfaces:
        return {}
    elements = {
        number: (group.kind, row)
        for group in data.groups
        for number, row in zip(group.numbers.tolist(), group.nodes, strict=True)
    }
    found: dict[str, list[int]] = {}
    for name, faces in data.surfaces.items():
        found[name] = []
        for number, face in faces:
            if number in elements:
                kind, row = elements[number]
                found[name] += row[face_nodes(KINDS[kind], face)].tolist()
    return found


def _assembled(path: Path, numbers: list[int]) -> tuple[sp.csr_array, sp.csr_array]:
    """Return mass and stiffness of other programs on nodes with these numbers, in file units.

    `path` is ``name.sti`` with ``name.mas`` and ``name.dof`` beside it (CalculiX, ``*FREQUENCY,
    SOLVER=MATRIXSTORAGE``), or a punch file of DMIG cards with one matrix whose name begins with M
    and one with K.
    """
    if path.suffix == ".sti":
        order = _equations(path.with_suffix(".dof"), numbers)
        mass, stiffness = (_calculix(path.with_suffix(end), order) for end in (".mas", ".sti"))
        return mass, stiffness
    names = sorted({fields[1] for _, fields in nastran.cards(path) if fields[0] == "DMIG"})
    chosen = [[name for name in names if name.upper().startswith(first)] for first in "MK"]
    if any(len(found) != 1 for found in chosen):
        raise ValueError(
            f"matrices: {path.name}: needs DMIG cards of one matrix M… and one K…, got {names}"
        )
    mass, stiffness = (nastran.read_dmig(path, numbers, found[0]) for found in chosen)
    return mass, stiffness


def _equations(path: Path, numbers: list[int]) -> np.ndarray:
    """Return the coordinate of each equation of CalculiX."""
    places = {number: 3 * i for i, number in enumerate(numbers)}
    pairs = [line.strip().partition(".") for line in _text(path).split()]
    try:
        order = np.array([places[int(node)] + int(direction) - 1 for node, _, direction in pairs])
    except (KeyError, ValueError) as error:
        raise ValueError(f"matrices: {path.name}: node {error} is none of the mesh") from error
    if not np.array_equal(np.sort(order), np.arange(3 * len(numbers))):
        raise ValueError(
            f"matrices: {path.name}: has {order.size} of the {3 * len(numbers)} displacements; "
            "export without *BOUNDARY, *EQUATION and *MPC, which take equations away"
        )
    return order


def _calculix(path: Path, order: np.ndarray) -> sp.csr_array:
    try:
        table = np.array(_text(path).split(), dtype=float).reshape(-1, 3)
        rows, columns = (order[table[:, i].astype(int) - 1] for i in (0, 1))
    except (ValueError, IndexError) as error:
        raise ValueError(
            f"matrices: {path.name}: needs lines of row, column, value: {error}"
        ) from error
    return nastran.symmetric(rows, columns, table[:, 2], order.size)


def _text(path: Path) -> str:
    if not path.is_file():
        raise ValueError(f"matrices: there is no file {path}; CalculiX writes .sti, .mas and .dof")
    return path.read_text(encoding="utf-8", errors="replace")
