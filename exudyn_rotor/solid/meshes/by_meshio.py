"""Meshes in the memory or in the formats of meshio: Gmsh, MED, VTK and others."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from exudyn_rotor.solid.meshes.mesh_data import MeshData
from exudyn_rotor.solid.shapes import KINDS

if TYPE_CHECKING:
    import meshio

_SURFACES = ("triangle", "quad")
_IGNORED = ("vertex", "line")


def load(path: Path) -> meshio.Mesh:
    """Return the mesh of a file."""
    try:
        import meshio
    except ImportError as error:
        raise ImportError(
            'mesh files need the package meshio: python -m pip install "exudyn-rotor[meshes]"'
        ) from error
    try:
        return meshio.read(path)
    except (Exception, SystemExit) as error:  # meshio raises all kinds, and exits where it gives up
        raise ValueError(f"{path.name}: meshio cannot read it: {error}") from error


def convert(mesh: meshio.Mesh) -> MeshData:
    """Return nodes, solids and named sets; numbers count from zero.

    Physical groups of Gmsh, and sets of cells: those of solids are element sets and name regions,
    those of surfaces are node sets. Pyramids and hexahedra of 27 nodes are refused.
    """
    data = MeshData(dict(enumerate(np.asarray(mesh.points).tolist())))
    data.node_sets = {name: np.asarray(set_).tolist() for name, set_ in mesh.point_sets.items()}
    first = 0
    for i, cells in enumerate(mesh.cells):
        numbers = np.arange(first, first + len(cells.data))
        first += len(cells.data)
        names = _names(mesh, i)
        if cells.type in KINDS:
            rows = np.column_stack([numbers, cells.data]).tolist()
            data.elements.setdefault((cells.type, "solid"), []).extend(rows)
            for name, chosen in names:
                data.regions.update(dict.fromkeys(numbers[chosen].tolist(), name))
                data.element_sets.setdefault(name, []).extend(numbers[chosen].tolist())
        elif cells.type.startswith(_SURFACES):
            for name, chosen in names:
                nodes = np.unique(cells.data[chosen]).tolist()
                data.node_sets.setdefault(name, []).extend(nodes)
        elif not cells.type.startswith(_IGNORED):
            raise ValueError(
                f"mesh: holds {cells.type} cells; needs tetrahedra, wedges or hexahedra without "
                "nodes inside faces (in Gmsh: Mesh.SecondOrderIncomplete = 1)"
            )
    return data


def _names(mesh: meshio.Mesh, block: int) -> list[tuple[str, np.ndarray]]:
    """Return the named sets of a block of cells, and which cells they hold."""
    found = []
    if "gmsh:physical" in mesh.cell_data:
        tags = np.asarray(mesh.cell_data["gmsh:physical"][block])
        dim = mesh.cells[block].dim
        names = {int(tag): name for name, (tag, of) in mesh.field_data.items() if of == dim}
        found += [(names.get(int(tag), str(tag)), tags == tag) for tag in np.unique(tags)]
    else:
        for name, sets in mesh.cell_sets.items():
            chosen = np.zeros(len(mesh.cells[block].data), dtype=bool)
            if sets[block] is not None and len(sets[block]):
                chosen[np.asarray(sets[block], dtype=np.int64)] = True
                found.append((name, chosen))
    return found
