"""Finite-element models on meshes of NGSolve: tetrahedra of order 1 or 2."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import ngsolve as ngs
import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.solid.elements import Block, SolidElements
from exudyn_rotor.solid.model import FiniteElementModel, NodeSet, is_named, materials_by_region
from exudyn_rotor.solid.surface import area_weights

_TETRAHEDRA = {20: 4, 21: 10}  # Netgen's types of elements, and their nodes
_MESHIO_ORDER = [0, 1, 2, 3, 4, 7, 5, 6, 8, 9]  # of Netgen's nodes


def assemble_model(
    mesh: ngs.Mesh,
    materials: Mapping[str, Any],
    *,
    order: int = 2,
    interfaces: Sequence[str] | None = None,
    check_units: bool = True,
) -> FiniteElementModel:
    """Return the model of an NGSolve mesh; parameters as ``SolidRotor.from_ngsolve``."""
    checks.flag(check_units, "check_units")
    _prepare_mesh(mesh, order)
    regions = mesh.GetMaterials()
    by_region = materials_by_region(regions, materials, check_units)
    tetrahedra, region_numbers = _tetrahedra(mesh)
    nodes = np.array(mesh.ngmesh.Coordinates(), dtype=float)
    nodes = nodes if order == 2 else nodes[: mesh.nv]
    blocks = [Block("tetra10" if order == 2 else "tetra", tetrahedra, region_numbers)]
    elements = SolidElements.of_materials(nodes, blocks, regions, by_region)
    triangles, faces = _triangles(mesh, order)
    sets = _node_sets(nodes, triangles, faces, interfaces)
    mass, stiffness = elements.mass_matrix(), elements.stiffness_matrix()
    return FiniteElementModel(nodes, mass, stiffness, None, sets, triangles, elements)


def _prepare_mesh(mesh: ngs.Mesh, order: int) -> None:
    """Check the mesh and give it the mid nodes that `order` needs."""
    checks.instance(mesh, "mesh", ngs.Mesh, "wrap a Netgen mesh with ngsolve.Mesh(...)")
    checks.count(order, "order", least=1, most=2)
    counts = set(_node_counts(mesh.ngmesh.Elements3D().NumPy())) if mesh.ne else set()
    if not counts or not counts <= set(_TETRAHEDRA.values()):
        raise ValueError(
            "mesh: needs volume elements, and tetrahedra only; generate a 3D tetrahedral mesh"
        )
    is_quadratic = counts == {_TETRAHEDRA[21]}
    if order == 1 and (is_quadratic or mesh.GetCurveOrder() > 1):
        raise ValueError(
            "mesh: its elements are curved, where linear displacements (order=1) cannot even "
            "describe a rigid rotation; use order=2 or a new mesh that is not made second order"
        )
    # a second call would add the mid nodes once more and leave the first ones without elements
    if order == 2 and not is_quadratic:
        mesh.ngmesh.SecondOrder()


def _node_counts(elements: np.ndarray) -> list[int]:
    """Return the number of nodes of each tetrahedron, 0 of other elements.

    Up to release 6.2.2606 NGSolve gives it, later the type of each element.
    """
    if "np" in elements.dtype.names:
        return elements["np"].tolist()  # no other element has as many
    return [_TETRAHEDRA.get(kind, 0) for kind in elements["type"].tolist()]


def _tetrahedra(mesh: ngs.Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return node numbers (t, 4) or (t, 10) and region numbers (t,), counted from zero."""
    elements = mesh.ngmesh.Elements3D().NumPy()
    order = _MESHIO_ORDER[: _node_counts(elements[:1])[0]]
    nodes = elements["nodes"].astype(np.int64)[:, order]
    return nodes - 1, elements["index"].astype(np.int64) - 1


def _triangles(mesh: ngs.Mesh, order: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the surface triangles (t, 3) or (t, 6) and the name of the face of each."""
    netgen = mesh.ngmesh
    elements = netgen.Elements2D().NumPy()
    numbers = elements["nodes"].astype(np.int64) - 1
    # Netgen puts the mid node opposite to corner i at 3 + i
    numbers = numbers[:, [0, 1, 2, 5, 3, 4] if order == 2 else [0, 1, 2]]
    count = netgen.GetNFaceDescriptors()
    names = np.array([netgen.FaceDescriptor(i + 1).bcname for i in range(count)])
    return numbers, names[elements["index"] - 1]


def _node_sets(
    nodes: np.ndarray,
    triangles: np.ndarray,
    faces: np.ndarray,
    interfaces: Sequence[str] | None,
) -> dict[str, NodeSet]:
    """Return node numbers and area weights of the faces named in `interfaces`."""
    known = sorted(name for name in set(faces.tolist()) if is_named(name))
    wanted = checks.labels(known if interfaces is None else interfaces, "interfaces", known)
    checks.different(wanted, "interfaces")
    return {name: area_weights(nodes, triangles[faces == name]) for name in wanted}
