"""Lossless storage of reduced rotors."""

from __future__ import annotations

from dataclasses import fields
from functools import partial
from os import PathLike
from typing import Any, TypeVar

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.storage import REDUCED_ROTOR, plain, read_arrays, write_arrays
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.invariants import Invariants

Rotor = TypeVar("Rotor")  # ReducedRotor, which has the methods that call this module

_ATTACHED = "attached."
_IN_ATTACHED = "in_attached"


def save_reduced(rotor: Rotor, path: str | PathLike) -> None:
    """Write `rotor` to `path`; a file of that name is replaced only by a complete one."""
    write_arrays(path, REDUCED_ROTOR, _entries(rotor))


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
    data = {name: plain(value) for name, value in read_arrays(path, REDUCED_ROTOR).items()}
    try:
        return _rotor(data, classes)
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(
            f"{path}: describes no reduced rotor, or was written by another version ({error})"
        ) from error


def _rotor(data: dict[str, Any], classes: tuple[type, ...]) -> Rotor:
    """Return a rotor of all entries; the classes check what they are made of."""
    make, mode_kind, interface, shapes, centrifugal = classes
    attached = _taken(data, _ATTACHED)
    found = {
        "axis": SpinAxis(*data.pop("axis")),
        "invariants": Invariants(**_taken(data, "invariants.")),
        "rigid_kinds": tuple(mode_kind[name] for name in data.pop("rigid_kinds")),
        "interfaces": {
            name: interface(**_taken(data, f"interface{index}."))
            for index, name in enumerate(data.pop("interface_names"))
        },
    }
    for name, kind in (("shapes", shapes), ("centrifugal", centrifugal)):
        values = _taken(data, f"{name}.")
        found[name] = kind(**values) if values else None
    if attached:
        finer = _rotor(attached, classes)
        shape = finer.size, found["invariants"].size
        columns = checks.array(data.pop(_IN_ATTACHED), _IN_ATTACHED, shape=shape)
        found["attached"] = partial(tuple, (finer, columns))
    return make(**found, **data)


def _taken(data: dict[str, Any], prefix: str) -> dict[str, Any]:
    """Take all entries whose names begin with a prefix, without it."""
    names = [name for name in data if name.startswith(prefix)]
    return {name.removeprefix(prefix): data.pop(name) for name in names}
