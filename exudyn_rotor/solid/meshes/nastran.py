"""Bulk data of Nastran (.bdf, .dat, .nas): mesh, solid properties, materials, DMIG matrices."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import scipy.sparse as sp

from exudyn_rotor.solid.meshes.mesh_data import MeshData, reading

# Kinds by card and number of nodes, and the order of meshio: mid nodes on top before upright ones.
_SOLIDS = {
    ("CTETRA", 4): ("tetra", range(4)),
    ("CTETRA", 10): ("tetra10", range(10)),
    ("CPENTA", 6): ("wedge", range(6)),
    ("CPENTA", 15): ("wedge15", [*range(9), 12, 13, 14, 9, 10, 11]),
    ("CHEXA", 8): ("hexahedron", range(8)),
    ("CHEXA", 20): ("hexahedron20", [*range(12), 16, 17, 18, 19, 12, 13, 14, 15]),
}
_REFUSED = {
    **dict.fromkeys(("MPC", "RBE1", "RBE2", "RBE3", "RBAR", "RROD"), "a constraint between nodes"),
    **dict.fromkeys(("CONM1", "CONM2"), "a point mass"),
}
# Cards with C that are no elements.
_NO_ELEMENTS = ("CORD", "CMASS", "CTYPE")


def read(path: Path) -> MeshData:
    """Return mesh and materials of a bulk data file; a region is called as its property."""
    data, properties, materials = MeshData(), {}, {}
    for place, fields in cards(path):
        card = fields[0]
        with reading(f"{place}: {card}"):
            if card == "GRID":
                if fields[2] not in ("", "0"):
                    raise ValueError("positions must be in the basic system of coordinates")
                data.nodes[int(fields[1])] = [_real(value) for value in fields[3:6]]
            elif card in ("CTETRA", "CPENTA", "CHEXA"):
                entries = [int(value) for value in fields[3:] if value]
                if (card, len(entries)) not in _SOLIDS:
                    raise ValueError("nodes of an element are missing")
                kind, order = _SOLIDS[card, len(entries)]
                row = [int(fields[1]), *(entries[i] for i in order)]
                data.add_element(kind, fields[2], row)
            elif card == "PSOLID":
                properties[fields[1]] = fields[2]
            elif card == "MAT1":
                materials[fields[1]] = _material(fields)
            elif card in _REFUSED:
                data.refused[card] = _REFUSED[card]
            elif card.startswith("C") and not card.startswith(_NO_ELEMENTS):
                data.refused[card] = "no tetrahedron, wedge or hexahedron"
    found = {region: materials.get(name) for region, name in properties.items()}
    data.materials = {region: material for region, material in found.items() if material}
    return data


def read_dmig(path: Path, nodes: list[int]) -> dict[str, sp.csr_array]:
    """Return the symmetric real matrices of DMIG cards on the displacements of `nodes`, by name."""
    places = {
        (str(number), direction): 3 * i + k
        for i, number in enumerate(nodes)
        for k, direction in enumerate("123")
    }
    entries: dict[str, list[tuple[int, int, float]]] = {}
    for place, fields in cards(path):
        if fields[0] != "DMIG":
            continue
        with reading(f"DMIG of {place} of {path.name}"):
            name, node, direction, kind = fields[1:5]
            found = entries.setdefault(name, [])
            if node == "0":
                if direction != "6" or kind not in ("1", "2"):
                    raise ValueError(
                        f"matrix {name} must be symmetric and real (IFO 6, TIN 1 or 2), got IFO "
                        f"{direction}, TIN {kind}"
                    )
                continue
            column = places[node, direction]
            for start in range(5, len(fields) - 2, 4):
                if fields[start]:
                    row = places[fields[start], fields[start + 1]]
                    found.append((row, column, _real(fields[start + 2])))
    return {
        name: symmetric(*zip(*found, strict=True), 3 * len(nodes))
        for name, found in entries.items()
        if found
    }


def symmetric(rows: list, columns: list, values: list, size: int) -> sp.csr_array:
    """Return the symmetric matrix of one triangle (either, or some of both)."""
    first, second = np.minimum(rows, columns), np.maximum(rows, columns)
    upper = sp.csr_array((np.asarray(values, float), (first, second)), shape=(size, size))
    return sp.csr_array(upper + upper.T - sp.diags_array(upper.diagonal()))


def cards(path: Path) -> Iterator[tuple[str, list[str]]]:
    """Return place and fields of every card; small, large and free fields, continued lines."""
    text = path.read_text(encoding="utf-8", errors="replace")
    lines = text.splitlines()
    start = next((i for i, x in enumerate(lines) if x.upper().startswith("BEGIN BULK")), -1)
    place, fields = "", []
    for number, line in enumerate(lines[start + 1 :], start + 2):
        line = line.partition("$")[0].rstrip().expandtabs(8)
        if not line:
            continue
        found = _split(line)
        if fields and found[0][:1] in ("", "+", "*"):
            fields += found[1:]
            continue
        if fields:
            yield place, fields
        if found[0].upper() == "ENDDATA":
            return
        if found[0].upper().startswith("INCLUDE"):
            raise ValueError(f"{path.name}: line {number}: INCLUDE is not read; join the files")
        place, fields = f"line {number}", [found[0].upper().rstrip("*").strip(), *found[1:]]
    if fields:
        yield place, fields


def _split(line: str) -> list[str]:
    """Return the fields of one line but the last one, which names the continuation."""
    if "," in line:
        fields = [field.strip() for field in line.split(",")]
        fields += [""] * (9 - len(fields))
        return fields[:9]
    width, count = (16, 4) if "*" in line[:8] else (8, 8)
    line = line.ljust(80)
    cuts = [line[8 + i * width : 8 + (i + 1) * width].strip() for i in range(count)]
    return [line[:8].strip(), *cuts]


def _material(fields: list[str]) -> dict[str, float]:
    fields = fields + [""] * 6
    young, shear, ratio = (_real(value) for value in fields[2:5])
    if not fields[4]:
        ratio = 0.5 * young / shear - 1.0
    return {"youngsModulus": young, "poissonsRatio": ratio, "density": _real(fields[5])}


def _real(text: str) -> float:
    """Return a number, also of the form 1.5-3 for 1.5e-3."""
    text = text.upper().replace("D", "E")
    if "E" not in text:
        text = text[:1] + text[1:].replace("-", "E-").replace("+", "E+")
    return float(text or 0.0)
