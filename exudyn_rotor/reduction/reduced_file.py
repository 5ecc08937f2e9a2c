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
from exudyn_rotor.storage import read_arrays, write_arrays
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.invariants import Invariants

_FORMAT = "exudyn_rotor reduced rotor 1"
_INVARIANTS = ("direction", "mass", "center", "J", "S", "P", "M", "K", "D", "G", "C")
# entries that a rotor without prestress does not have
_PRESTRESS = ("K2", "B")
_CENTRIFUGAL = ("displacement", "stress", "yield_stress", "constant_stress")
_SHAPES = ("nodes", "matrix", "triangles", "stress")
_ATTACHED = "attached."
_INTERFACE = ("reference", "center", "radius", "motion")


def save_reduced(rotor: ReducedRotor, path: str | PathLike) -> None:
    """Write `rotor` to `path`; a file of that name is replaced only by a complete one."""
    write_arrays(path, {"format": _FORMAT} | _entries(rotor))


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
    ValueError
        When the file is not a reduced rotor of this package, or is damaged.
    """
    data = read_arrays(path)
    if str(data.get("format")) != _FORMAT:
        raise ValueError(f"{path}: holds no reduced rotor; write one with ReducedRotor.save")
    try:
        return _rotor_from(data)
    except KeyError as error:
        raise ValueError(f"{path}: the entry {error} is missing; the file is damaged") from error


def _rotor_from(data: dict[str, np.ndarray]) -> ReducedRotor:
    invariants = {key: data[f"invariants.{key}"] for key in _INVARIANTS}
    invariants["mass"] = float(invariants["mass"])
    invariants |= {key: data.get(f"invariants.{key}") for key in _PRESTRESS}
    interfaces = {}
    for index, name in enumerate(data["interface_names"]):
        values = {key: data[f"interface{index}.{key}"] for key in _INTERFACE}
        interfaces[str(name)] = ReducedInterface(**values | {"radius": float(values["radius"])})
    shapes = None
    if "shapes.matrix" in data:
        shapes = ModeShapes(**{key: data.get(f"shapes.{key}") for key in _SHAPES})
    static = {key: data.get(f"centrifugal.{key}") for key in _CENTRIFUGAL}
    if static["yield_stress"] is not None:
        static["yield_stress"] = float(static["yield_stress"])
    has_static = any(value is not None for value in static.values())
    attached = {
        key.removeprefix(_ATTACHED): value
        for key, value in data.items()
        if key.startswith(_ATTACHED)
    }
    return ReducedRotor(
        axis=SpinAxis(*data["axis"]),
        center_of_mass=data["center_of_mass"],
        invariants=Invariants(**invariants),
        rigid=tuple(str(name) for name in data["rigid"]),
        interfaces=interfaces,
        mode_mass=data["mode_mass"],
        dropped=tuple(str(name) for name in data["dropped"]),
        grounded=bool(data["grounded"]),
        shapes=shapes,
        centrifugal=Centrifugal(**static) if has_static else None,
        with_attachments=_rotor_from(attached) if attached else None,
    )
