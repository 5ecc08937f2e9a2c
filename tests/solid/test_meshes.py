"""Meshes and matrices of other programs: elements one by one, and the same block in each format."""

import itertools
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from exudyn_rotor import SolidRotor
from exudyn_rotor.solid.shapes import KINDS

meshio = pytest.importorskip("meshio")

STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
SIZE = np.array([0.2, 0.3, 0.4])
SKEW = np.array([[1.0, 0.2, 0.1], [0.0, 1.0, 0.3], [0.0, 0.0, 1.0]])
_CORNERS = np.array(list(itertools.product((0, 1), repeat=3)))[:, ::-1]
_HEXAHEDRON = np.array([0, 1, 3, 2, 4, 5, 7, 6])
_WEDGES = np.array([[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]])
_TETRAHEDRA = np.array(
    [
        *([0, 1, 2, 6], [0, 5, 1, 6], [0, 4, 5, 6]),
        *([0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6]),
    ]
)


def block(kind: str, moved: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Return nodes and elements of a box of 2³ cells, whose middle node is moved by a share."""
    grid = np.array(list(itertools.product(range(3), repeat=3)))[:, ::-1]
    number = {tuple(point): i for i, point in enumerate(grid)}
    split = {"tet": _TETRAHEDRA, "wed": _WEDGES, "hex": np.arange(8)[None]}[kind[:3]]
    cells = []
    for origin in itertools.product((0, 1), repeat=3):
        corners = np.array([number[tuple(origin + corner)] for corner in _CORNERS[_HEXAHEDRON]])
        cells += list(corners[split])
    nodes = grid / 2.0
    nodes[number[1, 1, 1]] += moved * np.array([1.0, -0.6, 0.4])
    nodes, elements = nodes * SIZE, np.array(cells)
    shape = KINDS[kind]
    mids: dict[frozenset, int] = {}
    added, columns = [], []
    for a, b in shape.edges:
        column = []
        for edge in elements[:, [a, b]]:
            key = frozenset(edge.tolist())
            if key not in mids:
                mids[key] = len(nodes) + len(added)
                added.append(nodes[edge].mean(axis=0))
            column.append(mids[key])
        columns.append(column)
    if columns:
        nodes, elements = np.vstack([nodes, added]), np.column_stack([elements, *columns])
    return nodes, elements


def rotor_of(kind: str, moved: float = 0.0, skew: bool = False) -> SolidRotor:
    nodes, elements = block(kind, moved)
    nodes = nodes @ SKEW.T if skew else nodes
    # as meshio.Mesh, which knows no wedges of 15 nodes
    cells = [SimpleNamespace(type=kind, data=elements)]
    names = ("point_sets", "cell_sets", "cell_data", "field_data", "cells_dict")
    empty = {name: {} for name in names}
    return SolidRotor.from_mesh(SimpleNamespace(points=nodes, cells=cells, **empty), STEEL, "z")


PLAIN = [kind for kind in KINDS if " " not in kind]


@pytest.mark.parametrize("kind", PLAIN)
def test_mass_and_inertia_are_those_of_a_skew_box(kind):
    """Second moments of a box: ρ V s sᵀ ∘ (1/4, 1/3 on the diagonal), mapped by the skew."""
    rotor = rotor_of(kind, skew=True)
    mass = STEEL["density"] * SIZE.prod()
    moments = np.outer(SIZE, SIZE) * (np.full((3, 3), 0.25) + np.eye(3) / 12.0)
    found = rotor.nodes.T @ rotor.mass[::3, ::3] @ rotor.nodes
    assert rotor.total_mass == pytest.approx(mass, rel=1e-13)
    np.testing.assert_allclose(rotor.center_of_mass, SKEW @ SIZE / 2, rtol=1e-13)
    np.testing.assert_allclose(found, mass * SKEW @ moments @ SKEW.T, rtol=1e-12)


@pytest.mark.parametrize("kind", PLAIN)
def test_patch_test(kind):
    """Displacements linear in x: constant stress by Hooke's law, no force on inner nodes."""
    rotor = rotor_of(kind, moved=0.15)
    gradient = 1e-3 * np.array([[1.0, 2.0, -1.0], [0.5, -2.0, 1.5], [3.0, 0.3, 0.7]])
    u = (rotor.nodes @ gradient.T).ravel()
    strain = 0.5 * (gradient + gradient.T)
    shear = STEEL["youngsModulus"] / (2 * (1 + STEEL["poissonsRatio"]))
    stress = 2 * shear * (strain + 0.3 / 0.4 * np.trace(strain) * np.eye(3))
    expected = [stress[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))]
    found = rotor.elements.nodal_stress(u[:, None])[:, :, 0]
    np.testing.assert_allclose(found, np.tile(expected, (len(found), 1)), rtol=1e-11)
    is_inner = np.all((rotor.nodes > 1e-9) & (rotor.nodes < SIZE - 1e-9), axis=1)
    force = (rotor.stiffness @ u).reshape(-1, 3)
    assert np.abs(force[is_inner]).max() < 1e-12 * np.abs(force).max()
    assert rotor.rigid_motions == 6
    volume = 0.0  # of the closed surface, outward
    a, b, c = (rotor.nodes[rotor.triangles[:, i]] for i in range(3))
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0
    assert volume == pytest.approx(SIZE.prod(), rel=1e-12)


def test_stiffness_by_tension():
    """Uniform tension along z, and its work on a sway u_x = z: σ V."""
    for kind in PLAIN:
        rotor = rotor_of(kind)
        u = np.zeros((rotor.node_count, 3))
        u[:, 2] = rotor.nodes[:, 2]
        u[:, :2] = -0.3 * rotor.nodes[:, :2]
        sway = np.zeros_like(u)
        sway[:, 0] = rotor.nodes[:, 2]
        G = rotor.elements.geometric_stiffness(u.ravel())
        expected = STEEL["youngsModulus"] * SIZE.prod()
        assert sway.ravel() @ (G @ sway.ravel()) == pytest.approx(expected, rel=1e-12)


# ------------------------------------------------------------------ one block in every format


def rows(*values: object, each: int = 8) -> str:
    """Return values as lines of an input deck."""
    texts = [str(value) for value in values]
    parts = [", ".join(texts[i : i + each]) for i in range(0, len(texts), each)]
    return ",\n".join(parts)


_ABAQUS = {"tetra10": "C3D10", "wedge15": "C3D15", "hexahedron20": "C3D20", "hexahedron": "C3D8"}


def abaqus(kind: str, change: tuple[str, str] = ("", "")) -> str:
    """Return a deck in mm with a set, a surface, two *NODE blocks and names in both spellings."""
    nodes, elements = block(kind)
    lines = [f"{i + 5}, {x:.15g}, {y:.15g}, {z:.15g}" for i, (x, y, z) in enumerate(1e3 * nodes)]
    low = [i + 5 for i in np.flatnonzero(nodes[:, 2] == 0.0)]
    bottom = {"tetra10": "S1", "wedge15": "S1", "hexahedron20": "S1", "hexahedron": "S1"}[kind]
    deck = [
        "** comment",
        "*HEADING\nblock",
        "*NODE, NSET=All",
        *lines[:7],
        "*Node, nset=ALL",
        *lines[7:],
        "99999, 9., 9., 9.",
        f"*ELEMENT, TYPE={_ABAQUS[kind]}, ELSET=body",
        *(rows(i + 1, *(e + 5)) for i, e in enumerate(elements)),
        "*NSET, NSET=low",
        rows(*low),
        "*NSET, NSET=first, GENERATE\n5, 9, 2",
        "*ELSET, ELSET=lower, GENERATE\n1, 1",
        "*SURFACE, TYPE=NODE,\nNAME=Again\nlow",
        f"*SURFACE, NAME=Face\nLOWER, {bottom}",
        "*MATERIAL, NAME=steel\n*ELASTIC\n210000., 0.3\n*DENSITY\n7.85e-9,",
        "*SOLID SECTION, ELSET=Body, MATERIAL=STEEL",
        "*BOUNDARY\nlow, 1, 3\n*STEP\n*EQUATION\n2\n",
    ]
    text = "\n".join(deck)
    assert change[0] in text
    return text.replace(*change, 1)


def nastran(kind: str, wide: bool = False) -> str:
    """Return bulk data; hexahedra and wedges count upright mid nodes before those on top."""
    nodes, elements = block(kind)
    order = {
        "hexahedron20": [*range(12), 16, 17, 18, 19, 12, 13, 14, 15],
        "wedge15": [*range(9), 12, 13, 14, 9, 10, 11],
    }.get(kind, list(range(elements.shape[1])))
    card = {"t": "CTETRA", "w": "CPENTA", "h": "CHEXA"}[kind[0]]
    lines = [
        "SOL 103",
        "CEND",
        "BEGIN BULK",
        f"MAT1,7,2.1+11,{2.1e11 / 2.6!r},,7850.",
        "",
        "PSOLID,3,7",
    ]
    for i, (x, y, z) in enumerate(nodes):
        if wide:
            lines.append(f"GRID*   {i + 1:>16}{'':16}{x:16.9E}{y:16.9E}*\n*       {z:16.9E}")
        else:
            lines.append(f"GRID,{i + 1},,{x:.15g},{y:.15g},{z:.15g}")
    for i, element in enumerate(elements):
        fields = [i + 1, 3, *(element[order] + 1)]
        text = f"{card:8}" + "".join(f"{value:>8}" for value in fields[:8])
        for start in range(8, len(fields), 8):
            rest = "".join(f"{value:>8}" for value in fields[start : start + 8])
            text += f"+\n+       {rest}"
        lines.append(text)
    return "\n".join([*lines, "ENDDATA"])


def ansys(kind: str, types: int) -> str:
    """Return an archive; wedges and tetrahedra of SOLID186 as hexahedra with nodes repeated."""
    nodes, elements = block(kind)
    repeated = {
        (186, 15): [0, 1, 2, 2, 3, 4, 5, 5, 6, 7, 2, 8, 9, 10, 5, 11, 12, 13, 14, 14],
        (186, 10): [0, 1, 2, 2, 3, 3, 3, 3, 4, 5, 2, 6, 3, 3, 3, 3, 7, 8, 9, 9],
    }.get((types, elements.shape[1]), list(range(elements.shape[1])))
    lines = [f"ET,1,{types}", f"NBLOCK,6,SOLID,{len(nodes)},{len(nodes)}", "(3i9,6e21.13e3)"]
    for i, position in enumerate(nodes):
        while position.size and position[-1] == 0.0:  # zeros at the end are not written
            position = position[:-1]
        lines.append(f"{i + 1:9}{0:9}{0:9}" + "".join(f"{x:21.13E}" for x in position))
    lines += ["N,R5.3,LOC,       -1,", f"EBLOCK,19,SOLID,{len(elements)},{len(elements)}", "(19i9)"]
    for i, element in enumerate(elements):
        numbers = element[repeated] + 1
        fields = [4, 1, 1, 1, 0, 0, 0, 0, len(numbers), 0, i + 1, *numbers]
        lines += [
            "".join(f"{value:9}" for value in fields[start:end])
            for start, end in ((0, 19), (19, None))
            if fields[start:end]
        ]
    low = np.flatnonzero(nodes[:, 2] == 0.0) + 1
    lines += ["       -1", f"CMBLOCK,LOW,NODE,{len(low)}", "(8i10)"]
    lines += ["".join(f"{value:10}" for value in low[i : i + 8]) for i in range(0, len(low), 8)]
    lines += ["MPDATA,R5.0, 1,EX,4,1,2.1e11", "MP,NUXY,4,.3", "MP,DENS,4,7850"]
    return "\n".join(lines)


FORMATS = {
    **{f"{kind}.inp": abaqus(kind) for kind in _ABAQUS},
    **{f"{kind}.bdf": nastran(kind) for kind in _ABAQUS},
    "hexahedron wide.nas": nastran("hexahedron", wide=True),
    "tetra10 repeated.cdb": ansys("tetra10", 186),
    "wedge15 repeated.cdb": ansys("wedge15", 186),
    "tetra10.cdb": ansys("tetra10", 187),
    "hexahedron20.cdb": ansys("hexahedron20", 95),
}


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_gives_the_same_matrices(name, tmp_path):
    path = tmp_path / name
    path.write_text(FORMATS[name])
    unit = "mm" if path.suffix == ".inp" else "m"
    rotor = SolidRotor.from_mesh(path, None, "z", length_unit=unit)
    expected = rotor_of(name.partition(" ")[0].partition(".")[0])
    if path.suffix != ".bdf":
        np.testing.assert_allclose(rotor.nodes, expected.nodes, atol=1e-9)
    # coordinates and moduli of the decks have ten digits at least
    assert abs(rotor.mass - expected.mass).max() < 1e-8 * abs(expected.mass).max()
    assert abs(rotor.stiffness - expected.stiffness).max() < 1e-8 * abs(expected.stiffness).max()
    if path.suffix == ".inp":
        assert list(rotor.interfaces) == ["low", "first", "Again", "Face"]
        low = rotor.interfaces["low"]
        np.testing.assert_allclose(low.center, SIZE / 2 * [1, 1, 0], atol=1e-12)
        assert np.array_equal(rotor.interfaces["Again"].nodes, low.nodes)
        assert rotor.interfaces["first"].nodes.tolist() == [0, 2, 4]
        assert np.all(rotor.nodes[rotor.interfaces["Face"].nodes][:, 2] == 0.0)
    elif path.suffix == ".cdb":
        np.testing.assert_allclose(rotor.interfaces["LOW"].center, SIZE / 2 * [1, 1, 0], atol=1e-12)


def test_gmsh_gives_names_of_volumes_and_surfaces(tmp_path):
    nodes, elements = block("hexahedron20")
    faces = block("hexahedron")[1][:, [0, 3, 2, 1]]
    low = faces[np.all(nodes[faces][:, :, 2] == 0.0, axis=1)]
    mesh = meshio.Mesh(
        nodes,
        [("quad", low), ("hexahedron20", elements)],
        cell_data={
            "gmsh:physical": [np.full(4, 2), np.repeat([5, 6], 4)],
            "gmsh:geometrical": [np.full(4, 1), np.full(8, 1)],
        },
        field_data={"low": np.array([2, 2]), "a": np.array([5, 3]), "b": np.array([6, 3])},
    )
    mesh.write(tmp_path / "block.msh", file_format="gmsh22", binary=False)
    aluminium = {"youngsModulus": 7e10, "poissonsRatio": 0.33, "density": 2700.0}
    rotor = SolidRotor.from_mesh(tmp_path / "block.msh", {"a": STEEL, "b": aluminium}, "z")
    assert rotor.total_mass == pytest.approx((7850 + 2700) / 2 * SIZE.prod(), rel=1e-12)
    assert list(rotor.interfaces) == ["low"]
    assert rotor.elements.materials == ["a", "b"]


def test_sets_of_cells_are_materials_and_interfaces():
    nodes, elements = block("hexahedron")
    cells = [("hexahedron", elements), ("quad", elements[::2, [0, 3, 2, 1]])]
    names = {"a": [np.arange(4), []], "b": [np.arange(4, 8), None], "low": [[], np.arange(4)]}
    heavy = {**STEEL, "density": 2 * 7850.0}
    rotor = SolidRotor.from_mesh(
        meshio.Mesh(nodes, cells, cell_sets=names), {"a": STEEL, "b": heavy}, "z"
    )
    assert rotor.total_mass == pytest.approx(1.5 * 7850.0 * SIZE.prod(), rel=1e-12)
    np.testing.assert_allclose(rotor.interfaces["low"].center, SIZE / 2 * [1, 1, 0], atol=1e-12)
    with pytest.raises(ValueError, match="holds pyramid cells; needs tetrahedra, wedges or hex"):
        SolidRotor.from_mesh(meshio.Mesh(nodes, [("pyramid", elements[:, :5])]), STEEL, "z")


def test_included_files_and_element_sets_as_materials(tmp_path):
    text = abaqus("hexahedron", ("*SOLID SECTION, ELSET=Body, MATERIAL=STEEL", ""))
    head, mark, tail = text.partition("*ELEMENT")
    (tmp_path / "mesh").mkdir()
    (tmp_path / "mesh/nodes.inp").write_text(head)
    (tmp_path / "main.inp").write_text(f"*INCLUDE, INPUT=mesh/nodes.inp\n{mark}{tail}")
    heavy = {**STEEL, "density": 2 * 7850.0}
    materials = {"body": STEEL, "lower": heavy}
    mm = {"length_unit": "mm"}
    rotor = SolidRotor.from_mesh(tmp_path / "main.inp", materials, "z", **mm)
    assert rotor.total_mass == pytest.approx(7850.0 * SIZE.prod() * (1 + 1 / 8), rel=1e-12)
    more = text.replace("*MATERIAL", "*ELSET, ELSET=twice, GENERATE\n1, 4\n*MATERIAL")
    (tmp_path / "main.inp").write_text(more)
    with pytest.raises(ValueError, match="element 1 is in 'lower' and in 'twice'"):
        SolidRotor.from_mesh(tmp_path / "main.inp", materials | {"twice": STEEL}, "z", **mm)


# ------------------------------------------------------------------ what is refused, or replaced

BAD_DECKS = {
    "no file": (None, "there is no file"),
    "shells": (("TYPE=C3D8", "TYPE=S4R"), r"holds S4R .*leave_out=\['S4R'\]"),
    "equations": (("*HEADING\nblock", "*EQUATION\n2\n5,1,1.,6,1,-1."), r"holds \*EQUATION"),
    "tied": (("*HEADING\nblock", "*TIE, NAME=a\nb, c"), r"holds \*TIE \(nodes or surfaces tied"),
    "a node is missing": (("\n9, ", "\n99998, "), r"nodes that the file lacks: \[9\]"),
    "no number": (("210000.", "steel"), r"line \d+ of deck.inp: \*ELASTIC cannot be read"),
    "anisotropic": (("*ELASTIC", "*ELASTIC, TYPE=ORTHO"), "must be isotropic, got TYPE=ORTHO"),
    "no density": (("*DENSITY\n7.85e-9,", ""), "'steel'.*density"),
    "not in metres": (("7.85e-9", "7850."), "a wave speed .* of 0.005"),
    "inside out": (("\n1, 5, 6,", "\n1, 6, 5,"), r"turned inside out or have no volume"),
    "nodes are missing": (("\n1, 5, 6,", "\n1, 5,"), "no multiple of 9"),
    "unknown set": (("LOWER, S1", "LOWER, S9"), "a face S1 to S6 .*got 'S9'"),
    "no such set": (("*NSET, NSET=low", "*NSET, NSET=low\nhigh"), "there is no set 'high'"),
    "parts": (("*HEADING\nblock", "*INSTANCE, NAME=a\n*INSTANCE, NAME=b"), "one part"),
    "included": (("*HEADING\nblock", "*INCLUDE, INPUT=none.inp"), "INCLUDE needs a file"),
    "no elements": (("*ELEMENT, TYPE=C3D8, ELSET=body", "*USER"), "got no solid element"),
}


@pytest.mark.parametrize("case", BAD_DECKS)
def test_bad_decks_are_refused(case, tmp_path):
    change, message = BAD_DECKS[case]
    path = tmp_path / "deck.inp"
    if change is not None:
        path.write_text(abaqus("hexahedron", change))
    with pytest.raises((ValueError, OSError), match=message):
        SolidRotor.from_mesh(path, None, "z", length_unit="mm")


def ending(archive: str, last: list[int]) -> str:
    """Return an archive whose last element ends with other nodes."""
    head, mark, tail = archive.partition("\n       -1\nCMB")
    numbers = "".join(f"{one:9}" for one in last)
    return head[: -len(numbers)] + numbers + mark + tail


BAD_FILES = {
    "rbe2.bdf": (nastran("hexahedron").replace("ENDDATA", "RBE2,1,2,3"), "holds RBE2"),
    "shell.bdf": (nastran("hexahedron").replace("ENDDATA", "CQUAD4,1,2,3"), "holds CQUAD4"),
    "system.bdf": (nastran("hexahedron").replace("GRID,1,,", "GRID,1,4,"), "line 7: GRID"),
    "mids.bdf": (nastran("hexahedron").replace("CHEXA ", "CPENTA"), "nodes of an element"),
    "ce.cdb": (ansys("hexahedron", 185) + "\nCE,R5.0,DEFI", "holds CE"),
    "blocked.cdb": (ansys("hexahedron", 185).replace("19,SOLID", "19"), "as EBLOCK,19,SOLID"),
    "free.cdb": (
        ansys("hexahedron", 185).replace("3i9,6e21.13e3", "free"),
        "a format as .* is needed",
    ),
    "dropped.cdb": (ending(ansys("tetra10", 187), [0]), "element 48 lacks mid nodes"),
    "pyramid.cdb": (ending(ansys("hexahedron", 185), 4 * [1]), "holds pyramids; mesh with"),
    "include.bdf": (nastran("hexahedron").replace("ENDDATA", "INCLUDE 'a'"), "join the files"),
    "shell.cdb": (ansys("hexahedron", 181), "holds element type 181"),
    "cut.cdb": (ansys("hexahedron", 185)[:2000], "cannot be read"),
    "text.vtk": ("nothing", "meshio cannot read it"),
}


@pytest.mark.parametrize("name", BAD_FILES)
def test_bad_files_are_refused(name, tmp_path):
    text, message = BAD_FILES[name]
    (tmp_path / name).write_text(text)
    with pytest.raises(ValueError, match=message):
        SolidRotor.from_mesh(tmp_path / name, None, "z")


def test_a_missing_meshio_is_named(monkeypatch, tmp_path):
    (tmp_path / "mesh.vtk").write_text("")
    monkeypatch.setitem(sys.modules, "meshio", None)
    with pytest.raises(ImportError, match=r"pip install .exudyn-rotor\[meshes\]"):
        SolidRotor.from_mesh(tmp_path / "mesh.vtk", STEEL, "z")


def test_what_is_left_out_or_taken_as_another_element(tmp_path):
    path = tmp_path / "deck.inp"
    path.write_text(abaqus("hexahedron", ("*HEADING\nblock", "*EQUATION\n2\n5,1,1.,6,1,-1.")))
    rotor = SolidRotor.from_mesh(path, None, "z", length_unit="mm", leave_out=["*Equation"])
    assert rotor.node_count == 27
    path.write_text(abaqus("hexahedron", ("TYPE=C3D8", "TYPE=C3D8R")))
    with pytest.warns(UserWarning, match="C3D8R: taken as C3D8"):
        SolidRotor.from_mesh(path, None, "z", length_unit="mm")


# ------------------------------------------------------------------ matrices as files


def triangle(matrix) -> list[tuple[int, int, float]]:
    upper = np.triu(matrix.toarray())
    return [(i, j, upper[i, j]) for i, j in zip(*np.nonzero(upper), strict=True)]


def write_calculix(folder: Path, rotor: SolidRotor, order: np.ndarray) -> None:
    """Write equations in another order than that of the nodes, as CalculiX does; in mm."""
    for end, matrix in ((".sti", rotor.stiffness), (".mas", rotor.mass)):
        entries = triangle(matrix[order][:, order] * 1e-3)
        text = "\n".join(f"{j + 1} {i + 1} {value:.16e}" for i, j, value in entries)
        (folder / f"deck{end}").write_text(text)
    (folder / "deck.dof").write_text("\n".join(f"{n // 3 + 5}.{n % 3 + 1}" for n in order))


def test_matrices_of_calculix(tmp_path):
    (tmp_path / "deck.inp").write_text(abaqus("hexahedron"))
    expected = rotor_of("hexahedron")
    order = np.random.default_rng(1).permutation(81)
    write_calculix(tmp_path, expected, order)
    call = {"length_unit": "mm", "matrices": tmp_path / "deck.sti"}
    rotor = SolidRotor.from_mesh(tmp_path / "deck.inp", None, "z", **call)
    for name in ("mass", "stiffness"):
        found, wanted = getattr(rotor, name), getattr(expected, name)
        assert abs(found - wanted).max() < 1e-12 * abs(wanted).max()
    assert "low" in rotor.interfaces
    write_calculix(tmp_path, expected, order[3:])
    with pytest.raises(ValueError, match="has 78 of the 81 displacements; export without"):
        SolidRotor.from_mesh(tmp_path / "deck.inp", None, "z", **call)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("", ""), ""),
        (("       2\n", "       4\n"), ""),
        (("KAAX", "MBBX"), r"one matrix M… and one K…, got \['MAAX', 'MBBX'\]"),
        (("0       6", "0       1"), "KAAX must be symmetric and real .* got IFO 1, TIN 2"),
    ],
)
def test_matrices_of_nastran(change, message, tmp_path):
    (tmp_path / "deck.bdf").write_text(nastran("hexahedron"))
    expected = rotor_of("hexahedron")
    lines = []
    for name, matrix in (("KAAX", expected.stiffness), ("MAAX", expected.mass)):
        lines.append("PARAM,POST,-1")
        lines.append(f"DMIG    {name:8}       0       6       2       0                      81")
        for i, j, value in triangle(matrix):
            lines.append(f"DMIG*   {name:16}{j // 3 + 1:16}{j % 3 + 1:16}{'':16}*")
            number = f"{value:16.9E}".replace("E", "D")
            lines.append(f"*       {i // 3 + 1:16}{i % 3 + 1:16}{number}")
    (tmp_path / "deck.pch").write_text("\n".join(lines).replace(*change))
    call = {"matrices": tmp_path / "deck.pch"}
    if message:
        with pytest.raises(ValueError, match=message):
            SolidRotor.from_mesh(tmp_path / "deck.bdf", None, "z", **call)
        return
    rotor = SolidRotor.from_mesh(tmp_path / "deck.bdf", None, "z", **call)
    for name in ("mass", "stiffness"):
        found, wanted = getattr(rotor, name), getattr(expected, name)
        assert abs(found - wanted).max() < 1e-8 * abs(wanted).max()
