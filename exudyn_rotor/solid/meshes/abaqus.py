"""Input decks of Abaqus and CalculiX (.inp): mesh, sets, surfaces, sections, materials."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from exudyn_rotor.solid.meshes.mesh_data import MeshData, face_nodes, reading
from exudyn_rotor.solid.shapes import KINDS

_TYPES = {
    "C3D4": "tetra",
    "C3D10": "tetra10",
    "C3D6": "wedge",
    "C3D15": "wedge15",
    "C3D8": "hexahedron",
    "C3D20": "hexahedron20",
    "C3D20R": "hexahedron20 reduced",
}
_TAKEN_AS = {
    **dict.fromkeys(("C3D8R", "C3D8I"), "C3D8"),
    **dict.fromkeys(("C3D10M", "C3D10I", "C3D10T"), "C3D10"),
}
_STIFFER = " with all integration points, which is stiffer in bending"
_TIED = """EQUATION, MPC, TIE, CONTACT PAIR, EMBEDDED ELEMENT, RIGID BODY, COUPLING,
    KINEMATIC COUPLING, DISTRIBUTING COUPLING, CYCLIC SYMMETRY MODEL"""
_OTHERS = """SHELL SECTION, BEAM SECTION, MEMBRANE SECTION, MASS, ROTARY INERTIA, SPRING, DASHPOT,
    CONNECTOR SECTION"""
_REFUSED = {
    **dict.fromkeys(re.split(r",\s+", _TIED), "nodes or surfaces tied to others"),
    **dict.fromkeys(re.split(r",\s+", _OTHERS), "an element that is no solid"),
    **dict.fromkeys(("SYSTEM", "NGEN", "NFILL", "NCOPY", "ELGEN", "ELCOPY"), "a rule for numbers"),
}
Faces = dict[str, list[tuple[int, int]]]  # element and number of each face of a surface


def read(path: Path) -> MeshData:
    """Return what the deck holds before its first *STEP."""
    data, surfaces, instances = MeshData(), {}, 0
    sections: list[tuple[str, str]] = []
    material: dict[str, float] = {}
    for place, keyword, options, lines in _blocks(path):
        if keyword == "STEP":
            break
        with reading(f"{place}: *{keyword}"):
            match keyword:
                case "NODE":
                    _read_nodes(data, options, lines)
                case "ELEMENT":
                    _read_elements(data, options, lines)
                case "NSET":
                    _extend(data.node_sets, options["NSET"], options, lines)
                case "ELSET":
                    _extend(data.element_sets, options["ELSET"], options, lines)
                case "SURFACE":
                    _read_surface(data, surfaces, options, lines)
                case "MATERIAL":
                    material = _of(data.materials, options["NAME"], dict)
                case "ELASTIC":
                    material |= _elasticity(options, lines)
                case "DENSITY":
                    material["density"] = float(lines[0][0])
                case "SOLID SECTION":
                    sections.append((options["ELSET"], options["MATERIAL"]))
                case "INSTANCE":
                    instances += 1
                    if instances > 1 or lines:
                        raise ValueError(
                            "an assembly needs one part in its own place; write a flat deck (in "
                            "Abaqus: Model > Edit Attributes > Do not use parts and assemblies)"
                        )
                case _ if keyword in _REFUSED:
                    data.refused["*" + keyword] = _REFUSED[keyword]
    for element_set, name in sections:
        chosen = _of(data.element_sets, element_set)
        data.regions.update(dict.fromkeys(chosen, _spelled(data.materials, name)))
    _give_surfaces(data, surfaces)
    return data


def _read_nodes(data: MeshData, options: dict[str, str], lines: list[list[str]]) -> None:
    for fields in lines:
        values = [float(value or 0.0) for value in fields[1:4]]
        data.nodes[int(fields[0])] = values + [0.0] * (3 - len(values))
    if "NSET" in options:
        _of(data.node_sets, options["NSET"]).extend(int(fields[0]) for fields in lines)


def _read_elements(data: MeshData, options: dict[str, str], lines: list[list[str]]) -> None:
    name = options["TYPE"].upper()
    plain = name.removesuffix("H")  # hybrid ones have the pressure as unknown besides
    plain = _TAKEN_AS.get(plain, plain)
    if plain not in _TYPES:
        data.refused[name] = "no tetrahedron, wedge or hexahedron of displacements"
        return
    if plain != name:
        data.replaced[name] = f"taken as {plain}{_STIFFER if plain == 'C3D8' else ''}"
    size = len(KINDS[_TYPES[plain]].points) + 1
    entries = [int(value) for fields in lines for value in fields if value]
    if len(entries) % size:
        raise ValueError(
            f"{len(entries)} numbers are no multiple of {size}, those of an element and its nodes"
        )
    for start in range(0, len(entries), size):
        row = entries[start : start + size]
        data.add_element(_TYPES[plain], options.get("ELSET", "solid"), row)
    if "ELSET" in options:
        _of(data.element_sets, options["ELSET"]).extend(entries[::size])


def _read_surface(
    data: MeshData, surfaces: Faces, options: dict[str, str], lines: list[list[str]]
) -> None:
    name = options["NAME"]
    if options.get("TYPE", "ELEMENT").upper() == "NODE":
        _extend(data.node_sets, name, options, lines)
        return
    for first, face, *_ in lines:
        if face.upper() not in ("S1", "S2", "S3", "S4", "S5", "S6"):
            raise ValueError(f"a face S1 to S6 of an element is needed, got {face!r}")
        elements = [int(first)] if first.isdigit() else _of(data.element_sets, first)
        _of(surfaces, name).extend((element, int(face[1]) - 1) for element in elements)


def _elasticity(options: dict[str, str], lines: list[list[str]]) -> dict[str, float]:
    kind = options.get("TYPE", "ISO").upper()
    if not kind.startswith("ISO"):
        raise ValueError(f"the material must be isotropic, got TYPE={kind}")
    young, ratio = (float(value) for value in lines[0][:2])
    return {"youngsModulus": young, "poissonsRatio": ratio}


def _give_surfaces(data: MeshData, surfaces: Faces) -> None:
    """Make node sets of surfaces."""
    elements = {
        number: (KINDS[kind], nodes)
        for (kind, _), rows in data.elements.items()
        for number, *nodes in (rows if surfaces else ())
    }
    for name, faces in surfaces.items():
        known = [(*elements[number], face) for number, face in faces if number in elements]
        data.node_sets[name] = [
            nodes[i] for kind, nodes, face in known for i in face_nodes(kind, face)
        ]


def _blocks(path: Path) -> Iterator[tuple[str, str, dict[str, str], list[list[str]]]]:
    """Return place, keyword, options and fields of the lines of every block.

    Of included files, too.
    """
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    current: tuple[str, str, dict[str, str], list[list[str]]] | None = None
    number = 0
    while number < len(lines):
        line, number = lines[number].strip(), number + 1
        if not line or line.startswith("**"):
            continue
        if not line.startswith("*"):
            if current is not None:
                current[3].append([field.strip() for field in line.split(",")])
            continue
        start = number
        while line.endswith(",") and number < len(lines):
            line, number = line + lines[number].strip(), number + 1
        if current is not None:
            yield current
        current = (f"line {start} of {path.name}", *_keyword(line), [])
        if current[1] == "INCLUDE":
            target = path.parent / current[2].get("INPUT", "")
            if not target.is_file():
                raise ValueError(f"{path.name}: *INCLUDE needs a file beside it, got {target}")
            yield from _blocks(target)
            current = None
    if current is not None:
        yield current


def _keyword(line: str) -> tuple[str, dict[str, str]]:
    keyword, *options = line[1:].split(",")
    pairs = (option.partition("=") for option in options)
    values = {name.strip().upper(): value.strip().strip('"') for name, _, value in pairs}
    return " ".join(keyword.upper().split()), values


def _spelled(table: dict, name: str) -> str:
    """Return how a name is spelled in a table; capitals do not matter."""
    return next((known for known in table if known.upper() == name.upper()), name)


def _of(table: dict, name: str, make: type = list) -> list | dict:
    return table.setdefault(_spelled(table, name), make())


def _extend(
    table: dict[str, list[int]], name: str, options: dict[str, str], lines: list[list[str]]
) -> None:
    """Add numbers, ranges and other sets to a set."""
    entries = _of(table, name)
    for fields in lines:
        if "GENERATE" in options:
            first, last, *step = (int(field) for field in fields if field)
            entries.extend(range(first, last + 1, *step))
            continue
        for entry in filter(None, fields):
            if entry.lstrip("-").isdigit():
                entries.append(int(entry))
            elif _spelled(table, entry) in table:
                entries.extend(_of(table, entry))
            else:
                raise ValueError(f"there is no set {entry!r}")
