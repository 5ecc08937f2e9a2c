"""Input decks of Abaqus and CalculiX (.inp): mesh, sets, surfaces, sections, materials."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from exudyn_rotor.solid.meshes.mesh_data import ElementGroup, MeshData, Refusals, reading
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
_STIFFER = "taken as C3D8 with all integration points, which is stiffer in bending"
_REPLACED = {
    "C3D8R": ("hexahedron", _STIFFER),
    "C3D8I": ("hexahedron", _STIFFER),
    "C3D10M": ("tetra10", "taken as C3D10"),
    "C3D10I": ("tetra10", "taken as C3D10"),
    "C3D10T": ("tetra10", "taken as C3D10"),
}
_CONSTRAINTS = """EQUATION, MPC, TIE, CONTACT PAIR, EMBEDDED ELEMENT, RIGID BODY, COUPLING,
    KINEMATIC COUPLING, DISTRIBUTING COUPLING, CYCLIC SYMMETRY MODEL"""
_OTHERS = """SHELL SECTION, BEAM SECTION, MEMBRANE SECTION, MASS, ROTARY INERTIA, SPRING, DASHPOT,
    CONNECTOR SECTION"""
_RULES = "SYSTEM, NGEN, NFILL, NCOPY, ELGEN, ELCOPY"
_REFUSED = {
    " ".join(name.split()): what
    for names, what in (
        (_CONSTRAINTS, "nodes or surfaces tied to others"),
        (_OTHERS, "an element that is no solid"),
        (_RULES, "nodes or elements by a rule"),
    )
    for name in names.split(",")
}
_DEEPEST = 10  # of files that include files


def read(path: Path, refusals: Refusals) -> MeshData:
    """Return what the deck holds before its first *STEP."""
    return _Deck(refusals).read(path)


class _Deck:
    """State of one reading."""

    def __init__(self, refusals: Refusals) -> None:
        self.data, self.refusals = MeshData(), refusals
        self.sections: list[tuple[str, str]] = []
        self.material = ""
        self.instances = 0

    def read(self, path: Path) -> MeshData:
        for place, keyword, options, lines in _blocks(path):
            if keyword == "STEP":
                break
            with reading(f"{place}: *{keyword}"):
                if keyword in _REFUSED:
                    self.refusals.leaves_out("*" + keyword, _REFUSED[keyword])
                elif keyword in _READ:
                    action = getattr(self, "_" + keyword.lower().replace(" ", "_"))
                    action(options, [_fields(line) for line in lines])
        self._give_materials()
        return self.data

    def _node(self, options: dict[str, str], lines: list[list[str]]) -> None:
        numbers = [int(fields[0]) for fields in lines]
        for fields in lines:
            values = [float(value or 0.0) for value in fields[1:4]]
            self.data.nodes.append(values + [0.0] * (3 - len(values)))
        self.data.numbers += numbers
        if "NSET" in options:
            _of(self.data.node_sets, options["NSET"]).extend(numbers)

    def _element(self, options: dict[str, str], lines: list[list[str]]) -> None:
        kind = self._kind(options["TYPE"].upper())
        if kind is None:
            return
        size = len(KINDS[kind].points) + 1
        entries = [int(value) for fields in lines for value in fields if value]
        if len(entries) % size:
            raise ValueError(
                f"{len(entries)} numbers are no multiple of {size}, an element with its "
                f"{size - 1} nodes"
            )
        table = np.array(entries, dtype=np.int64).reshape(-1, size)
        region = options.get("ELSET", "solid")
        self.data.groups.append(ElementGroup(kind, table[:, 0], table[:, 1:], region))
        if "ELSET" in options:
            _of(self.data.element_sets, region).extend(table[:, 0].tolist())

    def _kind(self, name: str) -> str | None:
        """Return the kind of element, None for one that is left out."""
        plain = name.removesuffix("H")  # hybrid ones have the pressure as unknown besides
        if name in _TYPES:
            return _TYPES[name]
        if plain in _TYPES or plain in _REPLACED:
            kind, how = _REPLACED.get(plain, (_TYPES.get(plain), f"taken as {plain}"))
            self.refusals.replaces(name, how)
            return kind
        self.refusals.leaves_out(name, "no tetrahedron, wedge or hexahedron of displacements")
        return None

    def _nset(self, options: dict[str, str], lines: list[list[str]]) -> None:
        _extend(self.data.node_sets, options["NSET"], options, lines)

    def _elset(self, options: dict[str, str], lines: list[list[str]]) -> None:
        _extend(self.data.element_sets, options["ELSET"], options, lines)

    def _surface(self, options: dict[str, str], lines: list[list[str]]) -> None:
        name = options["NAME"]
        if options.get("TYPE", "ELEMENT").upper() == "NODE":
            _extend(self.data.node_sets, name, options, lines)
            return
        faces = _of(self.data.surfaces, name)
        for first, face, *_ in lines:
            if face.upper() not in ("S1", "S2", "S3", "S4", "S5", "S6"):
                raise ValueError(f"a face S1 to S6 of an element is needed, got {face!r}")
            elements = [int(first)] if first.isdigit() else _of(self.data.element_sets, first)
            faces.extend((element, int(face[1]) - 1) for element in elements)

    def _material(self, options: dict[str, str], lines: list[list[str]]) -> None:
        self.material = options["NAME"]
        _of(self.data.materials, self.material, dict)

    def _elastic(self, options: dict[str, str], lines: list[list[str]]) -> None:
        kind = options.get("TYPE", "ISO").upper()
        if not kind.startswith("ISO"):
            raise ValueError(f"the material must be isotropic, got TYPE={kind}")
        values = _of(self.data.materials, self.material, dict)
        values["youngsModulus"], values["poissonsRatio"] = (float(x) for x in lines[0][:2])

    def _density(self, options: dict[str, str], lines: list[list[str]]) -> None:
        _of(self.data.materials, self.material, dict)["density"] = float(lines[0][0])

    def _solid_section(self, options: dict[str, str], lines: list[list[str]]) -> None:
        self.sections.append((options["ELSET"], options["MATERIAL"]))

    def _instance(self, options: dict[str, str], lines: list[list[str]]) -> None:
        self.instances += 1
        if self.instances > 1 or lines:
            raise ValueError(
                "an assembly needs one part in its own place; write a flat deck (in Abaqus: "
                "Model > Edit Attributes > Do not use parts and assemblies)"
            )

    def _give_materials(self) -> None:
        """Call the regions of elements as the materials of their sections."""
        for element_set, material in self.sections:
            name = _spelled(self.data.materials, material)
            chosen = _of(self.data.element_sets, element_set)
            self.data.regions.update(dict.fromkeys(chosen, name))


_READ = {
    *("NODE", "ELEMENT", "NSET", "ELSET", "SURFACE", "MATERIAL", "ELASTIC", "DENSITY"),
    *("SOLID SECTION", "INSTANCE"),
}


def _blocks(path: Path, depth: int = 0) -> Iterator[tuple[str, str, dict[str, str], list[str]]]:
    """Return place, keyword, options and data lines of every block, of included files too."""
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    current: tuple[str, str, dict[str, str], list[str]] | None = None
    number = 0
    while number < len(lines):
        line, number = lines[number].strip(), number + 1
        if not line or line.startswith("**"):
            continue
        if not line.startswith("*"):
            if current is not None:
                current[3].append(line)
            continue
        start = number
        while line.endswith(",") and number < len(lines):
            line, number = line + lines[number].strip(), number + 1
        if current is not None:
            yield current
        current = (f"line {start} of {path.name}", *_keyword(line), [])
        if current[1] == "INCLUDE":
            yield from _included(path, current[2], depth)
            current = None
    if current is not None:
        yield current


def _included(
    path: Path, options: dict[str, str], depth: int
) -> Iterator[tuple[str, str, dict[str, str], list[str]]]:
    target = path.parent / options.get("INPUT", "")
    if depth == _DEEPEST or not target.is_file():
        raise ValueError(
            f"{path.name}: *INCLUDE needs a file beside it, at most {_DEEPEST} deep, got {target}"
        )
    return _blocks(target, depth + 1)


def _keyword(line: str) -> tuple[str, dict[str, str]]:
    keyword, *options = line[1:].split(",")
    pairs = (option.partition("=") for option in options)
    values = {name.strip().upper(): value.strip().strip('"') for name, _, value in pairs}
    return " ".join(keyword.upper().split()), values


def _fields(line: str) -> list[str]:
    return [field.strip() for field in line.split(",")]


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
