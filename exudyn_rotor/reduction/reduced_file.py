"""Lossless storage of reduced rotors."""

from __future__ import annotations

from os import PathLike

import numpy as np

from exudyn_rotor.reduction.reduced_rotor import (
    Centrifugal,
    ModeShapes,
    ReducedInterface,
    ReducedRotor,
)
from exudyn_rotor.storage import Entries, read_arrays, write_arrays
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.invariants import Invariants

_KIND = "reduced rotor"
_INVARIANTS = ("direction", "mass", "center", "J", "S", "P", "M", "K", "D", "G", "C")
# entries that a rotor without prestress does not have
_PRESTRESS = ("K2", "B")
_MATRICES = ("M", "K", "D", "G", "C", *_PRESTRESS)
_CENTRIFUGAL = ("displacement", "stress", "yield_stress", "constant_stress")
_SHAPES = ("nodes", "matrix", "triangles", "stress")
_ATTACHED = "attached."
_ROUNDING = 1e-8  # of the largest entry: above the rounding of sums, far below a wrong matrix
_INTERFACE = ("reference", "center", "radius", "motion")


def save_reduced(rotor: ReducedRotor, path: str | PathLike) -> None:
    """Write `rotor` to `path`; a file of that name is replaced only by a complete one."""
    write_arrays(path, _KIND, _entries(rotor))


def _entries(rotor: ReducedRotor) -> dict[str, object]:
    data = {
        "axis": np.vstack([rotor.axis.direction, rotor.axis.point]),
        "center_of_mass": rotor.center_of_mass,
        "rigid": np.array(rotor.rigid, dtype=str),
        "interface_names": np.array(list(rotor.interfaces), dtype=str),
        "mode_mass": rotor.mode_mass,
        "dropped": np.array(rotor.dropped, dtype=str),
        "grounded": rotor.grounded,
    }
    data |= {f"invariants.{key}": getattr(rotor.invariants, key) for key in _INVARIANTS}
    data |= _given("invariants", rotor.invariants, _PRESTRESS)
    data |= _given("centrifugal", rotor.centrifugal, _CENTRIFUGAL)
    for index, interface in enumerate(rotor.interfaces.values()):
        data |= {f"interface{index}.{key}": getattr(interface, key) for key in _INTERFACE}
    data |= _given("shapes", rotor.shapes, _SHAPES)
    if rotor.with_attachments is not None:
        added = _entries(rotor.with_attachments)
        data |= {_ATTACHED + key: value for key, value in added.items()}
    return data


def _given(group: str, owner: object, names: tuple[str, ...]) -> dict[str, object]:
    """Return the entries of `owner` that are not None."""
    values = {name: getattr(owner, name, None) for name in names}
    return {f"{group}.{name}": value for name, value in values.items() if value is not None}


def load_reduced(path: str | PathLike) -> ReducedRotor:
    """Read a rotor from `path`.

    Raises
    ------
    OSError
        When there is no such file.
    ValueError
        When the file is not a reduced rotor of this package, is damaged, or does not describe a
        rotor: wrong names, types, shapes, values that are not finite, matrices that are not
        symmetric or not definite.
    """
    entries = Entries(read_arrays(path, _KIND))
    try:
        rotor = _rotor_from(entries)
        entries.close()
    except (TypeError, ValueError) as error:
        raise ValueError(
            f"{path}: describes no reduced rotor, or was written by another version ({error})"
        ) from error
    return rotor


def _rotor_from(entries: Entries) -> ReducedRotor:
    axis = SpinAxis(*entries.numbers("axis", 2, 3))
    invariants = _invariants(entries.group("invariants."))
    if not np.allclose(axis.direction, invariants.direction, rtol=0.0, atol=_ROUNDING):
        raise ValueError("invariants.direction: is not the direction of the axis")
    entries.sizes["k"] = invariants.size
    rigid = entries.words("rigid", unique=True)
    if len(rigid) > invariants.size:
        raise ValueError(f"rigid: {len(rigid)} names for {invariants.size} columns")
    names = entries.words("interface_names", unique=True)
    shapes = _shapes(entries.group("shapes."))
    if shapes is not None:
        entries.sizes["n"] = len(shapes.nodes)
    attached = entries.group(_ATTACHED)
    return ReducedRotor(
        axis=axis,
        center_of_mass=entries.numbers("center_of_mass", 3),
        invariants=invariants,
        rigid=rigid,
        interfaces={
            name: _interface(entries.group(f"interface{index}."))
            for index, name in enumerate(names)
        },
        mode_mass=_definite(entries.numbers("mode_mass", "k", "k"), "mode_mass"),
        dropped=entries.words("dropped"),
        grounded=entries.flag("grounded"),
        shapes=shapes,
        centrifugal=_centrifugal(entries.group("centrifugal.")),
        with_attachments=_attached(attached, rigid) if attached else None,
    )


def _attached(entries: Entries, rigid: tuple[str, ...]) -> ReducedRotor:
    """Return the rotor with attachment modes: the same one, with other columns."""
    del entries.sizes["k"]
    rotor = _rotor_from(entries)
    entries.close()
    if rotor.rigid != rigid:
        raise ValueError(f"{_ATTACHED}rigid: are not those of the rotor without attachment modes")
    return rotor


def _invariants(entries: Entries) -> Invariants:
    values = {"S": entries.numbers("S", 3, "k")}
    for name in _MATRICES:
        if name in entries or name not in _PRESTRESS:
            values[name] = entries.numbers(name, "k", "k")
            _symmetric(values[name], name, -1 if name == "G" else 1)
    values["J"] = entries.numbers("J", 3, 3)
    for name in ("M", "K", "C", "J"):
        _definite(values[name], name, strictly=name == "M")
    values |= {name: entries.numbers(name, 3) for name in ("direction", "center")}
    values["mass"] = entries.number("mass", above=0.0)
    invariants = Invariants(**values, P=entries.numbers("P", 3, 3, "k"))
    entries.close()
    return invariants


def _interface(entries: Entries) -> ReducedInterface:
    interface = ReducedInterface(
        reference=entries.numbers("reference", 3),
        center=entries.numbers("center", 3),
        radius=entries.number("radius", least=0.0),
        motion=entries.numbers("motion", 6, "k"),
    )
    entries.close()
    return interface


def _shapes(entries: Entries) -> ModeShapes | None:
    if not entries:
        return None
    nodes = entries.numbers("nodes", "n", 3)
    triangles = entries.numbers("triangles", "t", "corners", dtype=int)
    if triangles.shape[1] not in (3, 6):
        raise ValueError(f"triangles: needs 3 or 6 columns, got {triangles.shape[1]}")
    if triangles.size and not (triangles.min() >= 0 and triangles.max() < len(nodes)):
        raise ValueError(f"triangles: needs node numbers from 0 to {len(nodes) - 1}")
    shapes = ModeShapes(
        nodes=nodes,
        matrix=entries.numbers("matrix", nodes.size, "k"),
        triangles=triangles,
        stress=entries.numbers("stress", "n", 6, "k") if "stress" in entries else None,
    )
    entries.close()
    return shapes


def _centrifugal(entries: Entries) -> Centrifugal | None:
    if not entries:
        return None
    values: dict[str, object] = {
        name: entries.numbers(name, "n", 6)
        for name in ("stress", "constant_stress")
        if name in entries
    }
    if "displacement" in entries:
        size = 3 * entries.sizes["n"] if "n" in entries.sizes else "3n"
        values["displacement"] = entries.numbers("displacement", size)
    if "yield_stress" in entries:
        values["yield_stress"] = entries.number("yield_stress", above=0.0)
    entries.close()
    return Centrifugal(**values)


def _symmetric(matrix: np.ndarray, name: str, sign: int = 1) -> np.ndarray:
    """Return a matrix whose halves agree but for the rounding of sums; sign −1: skew."""
    if np.abs(matrix - sign * matrix.T).max(initial=0.0) > _ROUNDING * np.abs(matrix).max(
        initial=0.0
    ):
        raise ValueError(f"{name}: needs a {'' if sign > 0 else 'skew-'}symmetric matrix")
    return matrix


def _definite(matrix: np.ndarray, name: str, *, strictly: bool = False) -> np.ndarray:
    """Return a symmetric matrix without negative eigenvalues; strictly: without zero ones."""
    values = np.linalg.eigvalsh(_symmetric(matrix, name))
    least = _ROUNDING * np.abs(values).max(initial=0.0) * (1.0 if strictly else -1.0)
    if values.size and (values[0] < least or (strictly and values[0] <= 0.0)):
        raise ValueError(f"{name}: has the negative eigenvalue {values[0]:.4g}")
    return matrix
