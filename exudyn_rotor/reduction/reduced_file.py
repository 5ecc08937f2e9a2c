"""Lossless storage of reduced rotors."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from os import PathLike
from typing import Any, TypeVar

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.reduction.fields import Centrifugal, ModeKind, ModeShapes, ReducedInterface
from exudyn_rotor.storage import Entries, read_arrays, write_arrays
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.invariants import Invariants

Rotor = TypeVar("Rotor")  # ReducedRotor, which has the methods that call this module

_KIND = "reduced rotor"
_INVARIANTS = ("direction", "center", "J", "S", "P", "M", "K", "D", "G", "C")
_OPTIONAL_INVARIANTS = ("K2", "B", "K4", "K2_estimated", "H", "K0")
_INTERFACE = ("reference", "center", "motion")
_SHAPES = ("nodes", "matrix")
_CENTRIFUGAL = ("displacement", "stress", "constant_stress")
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
    data |= _given("invariants", rotor.invariants, ("mass", *_INVARIANTS, *_OPTIONAL_INVARIANTS))
    data |= _given("centrifugal", rotor.centrifugal, ("yield_stress", *_CENTRIFUGAL))
    for index, interface in enumerate(rotor.interfaces.values()):
        data |= _given(f"interface{index}", interface, ("radius", *_INTERFACE))
    data |= _given("shapes", rotor.shapes, ("triangles", "stress", *_SHAPES))
    if rotor.with_attachments is not None:
        added = _entries(rotor.with_attachments)
        data |= {_ATTACHED + key: value for key, value in added.items()}
        data[_IN_ATTACHED] = rotor.in_attached
    return data


def _given(group: str, owner: object, names: tuple[str, ...]) -> dict[str, object]:
    """Return the entries of `owner` that are not None."""
    values = {name: getattr(owner, name, None) for name in names}
    return {f"{group}.{name}": value for name, value in values.items() if value is not None}


def load_reduced(path: str | PathLike, make: Callable[..., Rotor]) -> Rotor:
    """Read a rotor from `path`; `make` is the class :class:`ReducedRotor`.

    OSError when there is no such file; ValueError when it is damaged or describes no reduced rotor.
    """
    entries = Entries(read_arrays(path, _KIND))
    try:
        rotor = make(**_fields(entries, make))
        entries.close()
    except (TypeError, ValueError) as error:
        raise ValueError(
            f"{path}: describes no reduced rotor, or was written by another version ({error})"
        ) from error
    return rotor


def _fields(entries: Entries, make: Callable[..., Rotor]) -> dict[str, Any]:
    """Return the constructor's arguments; it checks shapes and values."""
    axis = entries.array("axis")
    if axis.shape != (2, 3):
        raise ValueError(f"axis: needs the shape (2, 3), got {axis.shape}")
    attached = entries.group(_ATTACHED)
    fields = {
        "axis": SpinAxis(*axis),
        "center_of_mass": entries.array("center_of_mass"),
        "invariants": _invariants(entries.group("invariants.")),
        "rigid_kinds": _kinds(entries.words("rigid_kinds", unique=False)),
        "interfaces": {
            name: _interface(entries.group(f"interface{index}."))
            for index, name in enumerate(entries.words("interface_names"))
        },
        "mode_mass": entries.array("mode_mass"),
        "dropped": entries.words("dropped", unique=False),
        "grounded": entries.flag("grounded"),
        "shapes": _shapes(entries.group("shapes.")),
        "centrifugal": _centrifugal(entries.group("centrifugal.")),
    }
    if attached:
        finer = make(**_fields(attached, make))
        shape = finer.size, fields["invariants"].size
        columns = checks.array(entries.array(_IN_ATTACHED), _IN_ATTACHED, shape=shape)
        if finer.interfaces.keys() != fields["interfaces"].keys():
            raise ValueError("with_attachments: needs the interfaces of the rotor")
        fields["attached"] = partial(tuple, (finer, columns))
    attached.close()
    return fields


def _kinds(names: tuple[str, ...]) -> tuple[ModeKind, ...]:
    checks.labels(names, "rigid_kinds", ModeKind.__members__)
    return tuple(ModeKind[name] for name in names)


def _invariants(entries: Entries) -> Invariants:
    invariants = Invariants(
        mass=entries.number("mass"),
        **entries.arrays(*_INVARIANTS),
        **entries.arrays(*_OPTIONAL_INVARIANTS, optional=True),
    )
    entries.close()
    return invariants


def _interface(entries: Entries) -> ReducedInterface:
    interface = ReducedInterface(radius=entries.number("radius"), **entries.arrays(*_INTERFACE))
    entries.close()
    return interface


def _shapes(entries: Entries) -> ModeShapes | None:
    if not entries:
        return None
    shapes = ModeShapes(
        triangles=entries.array("triangles", int),
        **entries.arrays(*_SHAPES),
        **entries.arrays("stress", optional=True),
    )
    entries.close()
    return shapes


def _centrifugal(entries: Entries) -> Centrifugal | None:
    if not entries:
        return None
    known = "yield_stress" in entries
    fields = Centrifugal(
        yield_stress=entries.number("yield_stress") if known else None,
        **entries.arrays(*_CENTRIFUGAL, optional=True),
    )
    entries.close()
    return fields
