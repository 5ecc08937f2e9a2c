"""Archives of ANSYS (.cdb, written by CDWRITE): nodes, solid elements, components, materials."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from pathlib import Path

from exudyn_rotor.solid.meshes.mesh_data import MeshData, reading

_TETRAHEDRA = {285: "tetra", 187: "tetra10", 92: "tetra10"}
_LINEAR, _QUADRATIC = (185, 45), (186, 95)
# Nodes of a hexahedron that are those of a wedge or tetrahedron where others are repeated.
_AS_WEDGE = [0, 1, 2, 4, 5, 6, 8, 9, 11, 12, 13, 15, 16, 17, 18]
_AS_TETRAHEDRON = [0, 1, 2, 4, 8, 9, 11, 16, 17, 18]
_KEYS = {"EX": "youngsModulus", "NUXY": "poissonsRatio", "PRXY": "poissonsRatio", "DENS": "density"}
_REFUSED = {"CE": "equations between nodes", "CP": "coupled nodes", "RBE3": "a weighted mean"}
Lines = Iterator[tuple[int, str]]


def read(path: Path) -> MeshData:
    """Return the mesh of an archive; a region is called as the number of its material."""
    data, types = MeshData(), {}
    lines = iter(enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1))
    for number, line in lines:
        fields = [field.strip() for field in line.split(",")]
        command = fields[0].upper()
        with reading(f"{command} of line {number}"):
            if command == "ET":
                types[int(fields[1])] = int(re.sub(r"\D", "", fields[2]))
            elif command == "NBLOCK":
                for node, _, _, *position in _block(lines):
                    values = [float(value) for value in position[:3]]
                    data.nodes[int(node)] = values + [0.0] * (3 - len(values))
            elif command == "EBLOCK":
                if len(fields) < 3 or fields[2].upper() != "SOLID":
                    raise ValueError("elements must be written as EBLOCK,19,SOLID")
                _read_elements(lines, types, data)
            elif command == "CMBLOCK":
                sets = data.node_sets if fields[2].upper().startswith("NODE") else data.element_sets
                sets[fields[1]] = _component(lines, int(fields[3].split("!")[0]))
            elif command == "MPDATA" and fields[1].upper().startswith("R"):
                _give(data, fields[4], fields[3], fields[6])
            elif command == "MP":
                _give(data, fields[2], fields[1], fields[3])
            elif command in _REFUSED:
                data.refused[command] = _REFUSED[command]
    return data


def _widths(line: str) -> list[int]:
    """Return the widths of the fields of a format as (3i9,6e21.13e3)."""
    widths: list[int] = []
    for count, width in re.findall(r"(\d*)[iIeE](\d+)", re.sub(r"(\.\d+)[eE]\d+", r"\1", line)):
        widths += [int(width)] * int(count or 1)
    if not widths:
        raise ValueError(f"a format as (3i9,6e21.13e3) is needed, got {line.strip()!r}")
    return widths


def _cut(line: str, widths: list[int]) -> list[str]:
    ends = itertools.accumulate(widths, initial=0)
    pieces = (line[a:b].strip() for a, b in itertools.pairwise(ends))
    return [piece for piece in pieces if piece]


def _block(lines: Lines) -> Iterator[list[str]]:
    """Return the fields of the lines of a block, whose format comes first."""
    widths = _widths(next(lines, (0, ""))[1])
    for _, line in lines:
        if line.startswith("N,") or line.strip() == "-1":
            return
        yield _cut(line, widths)
    raise ValueError("the block has no end (-1)")


def _read_elements(lines: Lines, types: dict[int, int], data: MeshData) -> None:
    block = _block(lines)
    for texts in block:
        fields = [int(value) for value in texts]
        while len(fields) < 11 + fields[8]:
            fields += [int(value) for value in next(block)]
        material, type_, number = fields[0], types[fields[1]], fields[10]
        if type_ not in (*_TETRAHEDRA, *_LINEAR, *_QUADRATIC):
            data.refused[f"element type {type_}"] = "no solid of displacements"
            continue
        kind, nodes = _solid(type_, fields[11:])
        if kind == "hexahedron":
            how = "hexahedra get all integration points, plain ones"
            data.replaced[f"SOLID{type_}"] = how
        if 0 in nodes:
            raise ValueError(f"element {number} lacks mid nodes; mesh without dropping them")
        data.add_element(kind, str(material), [number, *nodes])


def _solid(kind: int, nodes: list[int]) -> tuple[str, list[int]]:
    """Return meshio's name and nodes; repeated nodes make a wedge or tetrahedron."""
    if kind in _TETRAHEDRA:
        return _TETRAHEDRA[kind], nodes
    is_quadratic = kind in _QUADRATIC
    if len(set(nodes[4:8])) == 1:
        if nodes[2] != nodes[3]:
            raise ValueError("holds pyramids; mesh with tetrahedra, wedges or hexahedra")
        size = 10 if is_quadratic else 4
        return ("tetra10" if is_quadratic else "tetra"), [nodes[i] for i in _AS_TETRAHEDRON[:size]]
    if nodes[2] == nodes[3]:
        size = 15 if is_quadratic else 6
        return ("wedge15" if is_quadratic else "wedge"), [nodes[i] for i in _AS_WEDGE[:size]]
    if not is_quadratic:
        return "hexahedron", nodes
    return ("hexahedron20 reduced stiffness" if kind == 186 else "hexahedron20"), nodes


def _component(lines: Lines, count: int) -> list[int]:
    """Return the numbers of a component; a negative one ends a range."""
    widths = _widths(next(lines)[1])
    entries: list[int] = []
    while len(entries) < count:
        entries += [int(value) for value in _cut(next(lines)[1], widths)]
    numbers: list[int] = []
    for entry in entries:
        numbers += range(numbers[-1] + 1, -entry + 1) if entry < 0 else [entry]
    return numbers


def _give(data: MeshData, material: str, key: str, value: str) -> None:
    name = _KEYS.get(key.upper())
    if name:
        data.materials.setdefault(material, {})[name] = float(value)
