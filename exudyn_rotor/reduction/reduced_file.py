"""Lossless storage of reduced rotors."""

from __future__ import annotations

from dataclasses import MISSING, fields, replace
from functools import partial
from os import PathLike
from typing import Any, TypeVar

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.storage import Entries, read_arrays, write_arrays
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.invariants import Invariants

Rotor = TypeVar("Rotor")  # ReducedRotor, which has the methods that call this module

_KIND = "reduced rotor"
_ATTACHED = "attached."
_IN_ATTACHED = "in_attached"


def save_reduced(rotor: Rotor, path: str | PathLike) -> None:
    """Write `rotor` to `path`; a file of that name is replaced only by a complete one."""
    write_arrays(path, _KIND, _entries(rotor))


def _entries(rotor: Rotor) -> dict[str, object]:
    data = {
        "axis": np.vstack([rotor.axis.direction, rotor.axis.point]),
        "center_of_mass": rotor.center_of_mass,
        "rigid_kinds": np.array([kind.name for kind in rotor.rigid_kinds], dtype=str),
        "interface_names": np.array(list(rotor.interfaces), dtype=str),
        "mode_mass": rotor.mode_mass,
        "dropped": np.array(rotor.dropped, dtype=str),
        "grounded": rotor.grounded,
    }
    groups = {"invariants": rotor.invariants, "centrifugal": rotor.centrifugal}
    groups |= {f"interface{i}": one for i, one in enumerate(rotor.interfaces.values())}
    groups["shapes"] = rotor.shapes
    for group, owner in groups.items():
        for field in fields(owner) if owner is not None else ():
            value = getattr(owner, field.name)
            data |= {} if value is None else {f"{group}.{field.name}": value}
    if rotor.with_attachments is not None:
        added = _entries(rotor.with_attachments)
        data |= {_ATTACHED + key: value for key, value in added.items()}
        data[_IN_ATTACHED] = rotor.in_attached
    return data


def load_reduced(path: str | PathLike, classes: tuple[type, ...]) -> Rotor:
    """Read a rotor from `path`; `classes` are its own and those of its parts.

    OSError when there is no such file; ValueError when it is damaged or describes no reduced rotor.
    """
    entries = Entries(read_arrays(path, _KIND))
    try:
        return _rotor(entries, classes)
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(
            f"{path}: describes no reduced rotor, or was written by another version ({error})"
        ) from error


def _rotor(entries: Entries, classes: tuple[type, ...]) -> Rotor:
    """Return a rotor, which checks shapes and values, of all entries."""
    make, mode_kind, interface, shapes, centrifugal = classes
    attached = entries.group(_ATTACHED)
    columns = entries.array(_IN_ATTACHED) if attached else None
    rotor = make(
        axis=SpinAxis(*entries.array("axis")),
        center_of_mass=entries.array("center_of_mass"),
        invariants=_made(Invariants, entries.group("invariants.")),
        rigid_kinds=tuple(mode_kind[name] for name in entries.words("rigid_kinds", unique=False)),
        interfaces={
            name: _made(interface, entries.group(f"interface{index}."))
            for index, name in enumerate(entries.words("interface_names"))
        },
        mode_mass=entries.array("mode_mass"),
        dropped=entries.words("dropped", unique=False),
        grounded=entries.flag("grounded"),
        shapes=_made(shapes, entries.group("shapes."), optional=True),
        centrifugal=_made(centrifugal, entries.group("centrifugal."), optional=True),
    )
    entries.close()
    if columns is None:
        return rotor
    finer = _rotor(attached, classes)
    columns = checks.array(columns, _IN_ATTACHED, shape=(finer.size, rotor.size))
    if finer.interfaces.keys() != rotor.interfaces.keys():
        raise ValueError("with_attachments: needs the interfaces of the rotor")
    return replace(rotor, attached=partial(tuple, (finer, columns)))


def _made(kind: type, entries: Entries, optional: bool = False) -> Any:
    """Return an object of a dataclass from the entries of its fields; None of none if optional."""
    if optional and not entries:
        return None
    values = {}
    for field in fields(kind):
        if field.name in entries or field.default is MISSING:
            read = entries.number if field.type.startswith("float") else entries.array
            whole = field.name == "triangles"
            values[field.name] = entries.array(field.name, int) if whole else read(field.name)
    entries.close()
    return kind(**values)
