"""Stress modes that a script gives a flexible body after it was added.

Scripts set ``outputVariableModeBasis`` of Exudyn's body with one set of six columns for every mode
of the ``FEMinterface``. The marker body has rigid motions beside these modes, the modes themselves
mass-orthonormal, and virtual nodes, so such columns are converted to its coordinates.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import exudyn
import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.mark import mark_of
from exudyn_rotor.multibody.rotor.marker_body import stress_columns
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.wrapping import wraps_method
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor

_PARAMETER = "outputVariableModeBasis"


@dataclass(frozen=True, eq=False)
class StressConversion:
    """From stress of a FEMinterface's modes to that of a reduced rotor's columns.

    Attributes
    ----------
    modes : ndarray, shape (3n, r)
        The modes of the FEMinterface.
    reduced : ReducedRotor
        Made of these modes, with its shapes.
    recovered : mapping
        Post-processing modes of the FEMinterface. The rotor has their stress already; strain is
        set by :func:`accept_stress_modes`.
    """

    modes: np.ndarray
    reduced: ReducedRotor
    recovered: Mapping[str, Any]

    def __post_init__(self) -> None:
        if self.has_strain:
            self.checked(self.recovered["matrix"], "femInterface: its strain modes", "")

    @property
    def has_strain(self) -> bool:
        """Whether the FEMinterface holds strain modes."""
        return str(self.recovered.get("outputVariableType", "")).endswith("StrainLocal")

    def checked(self, columns: ArrayLike, name: str, unit: str = "Pa") -> np.ndarray:
        """Return six columns for each mode, or refuse another shape."""
        shape = (len(self.reduced.shapes.nodes), 6 * self.modes.shape[1])
        return checks.array(columns, name, unit, shape=shape)

    def columns(self, stress: np.ndarray) -> np.ndarray:
        """Return the stress (n, 6, k) of the reduced rotor's columns from that of the modes.

        Rigid motions have no stress, so the modes' shares in the elastic columns suffice.
        """
        shapes = self.reduced.shapes
        rigid = len(self.reduced.rigid_kinds)
        known = np.hstack([shapes.matrix[:, :rigid], self.modes])
        shares = np.linalg.lstsq(known, shapes.matrix[:, rigid:], rcond=_DEPENDENT)[0]
        by_mode = stress.reshape(len(shapes.nodes), -1, 6).transpose(0, 2, 1)
        zero = np.zeros((len(shapes.nodes), 6, rigid))
        return np.concatenate([zero, by_mode @ shares[rigid:]], axis=2)


_DEPENDENT = 1e-10  # singular values below this share of the largest: dependent modes

# key in mbs.sys: physics object's mark → numbers of physics and marker body, conversion, selection
_CONVERSIONS = "exudyn_rotor: conversion of stress modes that are set later"


def accept_stress_modes(body: RotorBody, conversion: StressConversion) -> None:
    """Let ``mbs.SetObjectParameter`` convert stress modes that are set for this body later."""
    marker_body, T = int(body.objects["marker_body"]), body.selection.T
    physics = body.objects["physics"]
    entry = (physics, marker_body, conversion, T)
    body.mbs.sys.setdefault(_CONVERSIONS, {})[body.mark] = entry
    if conversion.has_strain:
        strain = exudyn.OutputVariableType.StrainLocal
        body.mbs.SetObjectParameter(marker_body, _PARAMETER, conversion.recovered["matrix"])
        body.mbs.SetObjectParameter(marker_body, "outputVariableTypeModeBasis", strain)


def _converted(mbs: exudyn.MainSystem, number: object, value: object) -> object:
    """Return stress modes for a marker body; anything else as it was given."""
    for mark, (physics, marker_body, conversion, T) in mbs.sys[_CONVERSIONS].items():
        if int(number) != marker_body or mark_of(mbs, physics) != mark:
            continue
        there = np.shape(mbs.GetObjectParameter(marker_body, "modeBasis"))
        if np.shape(value) == (there[0] // 3, 6 * there[1]) or np.size(value) == 0:
            return value
        stress = conversion.checked(value, f"value: {_PARAMETER}")
        return stress_columns(conversion.columns(stress) @ T, there[0] // 3)
    return value


@wraps_method("SetObjectParameter")
def _set_object_parameter(
    set_parameter: Callable,
    mbs: exudyn.MainSystem,
    objectNumber: object,
    parameterName: str,
    value: object,
) -> None:
    """Set a parameter as Exudyn does; stress modes for a fixed-axis rotor are converted."""
    if parameterName == _PARAMETER and _CONVERSIONS in mbs.sys:
        value = _converted(mbs, objectNumber, value)
    set_parameter(mbs, objectNumber, parameterName, value)
