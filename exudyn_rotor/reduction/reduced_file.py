"""Lossless storage of reduced rotors."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields
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


def load_reduced(
    path: str | PathLike, make: Callable[..., Rotor], parts: Mapping[str, type]
) -> Rotor:
    """Read a rotor from `path`; `make` is the class :class:`ReducedRotor`.

    `parts` are the classes of its kinds of modes, interfaces, shapes and static fields.

    OSError when there is no such file; ValueError when it is damaged or describes no reduced rotor.
    """
    entries = Entries(read_arrays(path, _KIND))
    try:
        rotor = make(**_fields(entries, make, parts))
        entries.close()
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(
            f"{path}: describes no reduced rotor, or was written by another version ({error})"
        ) from error
    return rotor


def _fields(
    entries: Entries, make: Callable[..., Rotor], parts: Mapping[str, type]
) -> dict[str, Any]:
    """Return the constructor's arguments; it checks shapes and values."""
    attached = entries.group(_ATTACHED)
    found = {
        "axis": SpinAxis(*entries.array("axis")),
        "center_of_mass": entries.array("center_of_mass"),
        "invariants": _made(Invariants, entries.group("invariants.")),
        "rigid_kinds": tuple(
            parts["rigid_kinds"][name] for name in entries.words("rigid_kinds", unique=False)
        ),
        "interfaces": {
            name: _made(parts["interfaces"], entries.group(f"interface{index}."))
            for index, name in enumerate(entries.words("interface_names"))
        },
        "mode_mass": entries.array("mode_mass"),
        "dropped": entries.words("dropped", unique=False),
        "grounded": entries.flag("grounded"),
        "shapes": _made(parts["shapes"], entries.group("shapes."), True),
        "centrifugal": _made(parts["centrifugal"], entries.group("centrifugal."), True),
    }
    if attached:
        finer = make(**_fields(attached, make, parts))
        shape = finer.size, found["invariants"].size
        columns = checks.array(entries.array(_IN_ATTACHED), _IN_ATTACHED, shape=shape)
        if finer.interfaces.keys() != found["interfaces"].keys():
            raise ValueError("with_attachments: needs the interfaces of the rotor")
        found["attached"] = partial(tuple, (finer, columns))
    attached.close()
    return found


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
