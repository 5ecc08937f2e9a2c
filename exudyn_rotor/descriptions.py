"""Rotors, supports and linear models as lines of text, as reports show them."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import fields, is_dataclass
from numbers import Real
from typing import Any

import numpy as np

from exudyn_rotor.bearings.bearing import Bearing, Linearised
from exudyn_rotor.bearings.coefficient_table import CoefficientTable
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.bearings.series import FloatingRingBearing, SeriesSupport
from exudyn_rotor.bearings.support import COEFFICIENTS, Support, acts
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.model.rotor_train import RotorTrain
from exudyn_rotor.linear.model.scene.scene_model import SceneModel
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid.summary import directions
from exudyn_rotor.solid_rotor import SolidRotor

SUPPORTS = (Support, Bearing, MagneticBearing, SeriesSupport, FloatingRingBearing)
DESCRIBED = (ReducedRotor, SolidRotor, RotorTrain, Foundation, LinearModel)
_FEW = 4  # entries of an array that is written out
_WIDTH = 66  # of the last column
_ROUNDING = 1e-9  # of matrices of an axisymmetric rotor
_UNITS = dict(zip(COEFFICIENTS, ("N/m", "N s/m", "N m/rad", "N m s/rad"), strict=True))


def described(item: ReducedRotor | SolidRotor | RotorTrain | Foundation | LinearModel) -> str:
    """Return what a rotor, a train, a foundation or a linear model is, as lines of text."""
    if isinstance(item, SolidRotor):
        return item.summary()
    if isinstance(item, ReducedRotor):
        return _reduced(item)
    if isinstance(item, RotorTrain):
        return _train(item)
    return repr(item) if isinstance(item, Foundation) else _model(item)


def described_supports(supports: Sequence[Given]) -> str:
    """Return supports and bearings as lines of text."""
    return _table(_lines((one.interface, one) for one in supports))


def _reduced(rotor: ReducedRotor) -> str:
    """Return mass, inertia, modes and interfaces."""
    known, e = rotor.invariants, rotor.axis.direction
    second = known.J - known.mass * np.outer(known.center, known.center)
    polar = np.trace(second) - e @ second @ e
    across = 0.5 * (np.trace(second) + e @ second @ e)
    elastic = rotor.frequencies[len(rotor.rigid_kinds) :] / (2.0 * np.pi)
    span = f", {elastic.min():.5g} to {elastic.max():.5g} Hz" if elastic.size else ""
    lines = [
        f"mass             {known.mass:.6g} kg",
        f"centre of mass   {_vector(rotor.center_of_mass)} m",
        f"moments          polar {polar:.6g}, mean transverse {across:.6g} kg m² about it",
        f"spin axis        direction {_vector(e)}, point {_vector(rotor.axis.point)} m",
        f"across the axis  {directions(rotor.axis)}",
        f"modes            {len(rotor.rigid_kinds)} rigid, {elastic.size} flexible{span}",
        f"prestress        {'none' if known.K2 is None else 'of the static state at speed'}",
    ]
    lines += [
        f"interface        {name}: centre {_vector(one.center)} m"
        for name, one in rotor.interfaces.items()
    ]
    return "\n".join(lines)


def _train(train: RotorTrain) -> str:
    """Return rotors with their ratios, supports and links."""
    return "\n".join([_ratios(train, train.driven), _acting(train)])


def _ratios(given: RotorTrain | LinearModel, driven: Sequence[str]) -> str:
    return "\n".join(
        f"rotor {name}: {ratio:.6g} times the speed, {given.rotors[name].invariants.mass:.6g} kg, "
        f"{given.rotors[name].size} coordinates{', driven' if name in driven else ''}"
        for name, ratio in given.ratios.items()
    )


def _acting(given: RotorTrain | LinearModel) -> str:
    """Return supports and links as lines of text."""
    lines = [
        (f"{name}:{one.interface}" if name else one.interface, one)
        for name, each in given.supports.items()
        for one in each
    ]
    lines += [(f"{link.first} – {link.second}", link.connection) for link in given.links]
    return _table(_lines(lines))


def _model(model: LinearModel) -> str:
    """Return supports, foundation, level of stiffening and free motions of a linear model."""
    axes = f"{model.size} coordinates in {model.axes} axes"
    uneven = f", {model.unevenness:.2g} of it averaged" if model.unevenness > _ROUNDING else ""
    stiffening = f"centrifugal stiffening: {model.stiffening}"
    if isinstance(model, SceneModel):
        about = f"scene of {axes}{uneven}, about its {model.about} state"
        return "\n".join([about, model.scene.body.report(), stiffening])
    lines = [_ratios(model, model.driven)] if len(model.rotors) > 1 else []
    lines += [axes + uneven, _acting(model)]
    lines += [repr(model.foundation)] if model.foundation is not None else []
    free = ", ".join(model.free_motions) or "none"
    return "\n".join([*lines, stiffening, f"free motions: {free}"])


Line = tuple[str, str, str, str]


def _table(lines: Iterable[Line]) -> str:
    rows = [("interface", "frame", "coefficient", ""), *lines]
    widths = [max([*(len(row[i]) for row in rows), least]) for i, least in enumerate((12, 9, 14))]
    lines = []
    for row in rows:
        start = "".join(f"{entry:{width}}  " for entry, width in zip(row[:3], widths, strict=True))
        first, *more = textwrap.wrap(row[3], _WIDTH) or [""]
        lines.append((start + first).rstrip())
        lines += [" " * len(start) + line for line in more]
    return "\n".join(lines)


def _lines(named: Iterable[tuple[str, Any]]) -> list[Line]:
    """Return lines of supports, bearings, gears and what has coordinates of its own."""
    lines: list[Line] = []
    for where, one in named:
        if isinstance(one, Support):
            lines += [
                (where, one.frame, name.replace("_", " "), _coefficient(value, _UNITS[name]))
                for name in COEFFICIENTS
                if acts(value := getattr(one, name))
            ]
        else:
            lines.append((where, "", _words(one), _values(one)))
    return lines


def _words(one: object) -> str:
    """Return the name of a class in words."""
    words = re.findall("[A-Z]+(?![a-z])|[A-Z][a-z]+", type(one).__name__)
    return " ".join(word if word.isupper() else word.lower() for word in words)


def _values(one: object) -> str:
    """Return the numbers of a bearing or of a gear mesh, those of its parts in brackets."""
    parts = []
    for name in (field.name for field in fields(one) if field.init and field.name != "interface"):
        value, label = getattr(one, name), name.replace("_", " ")
        if is_dataclass(value):
            parts.append(f"{label} ({_words(value)}: {_values(value)})")
        elif isinstance(value, str | Real) and value is not False:
            parts.append(f"{label} {value if isinstance(value, str) else f'{value:.6g}'}")
        elif isinstance(value, np.ndarray | list | tuple) and len(value) > _FEW:
            parts.append(f"{len(value)} {label}")
        elif isinstance(value, np.ndarray) and value.ndim == 1 and value.size:
            parts.append(f"{label} {_vector(value)}")
    return ", ".join(parts)


def _coefficient(value: Any, unit: str) -> str:
    if isinstance(value, Linearised):
        return f"{unit}, of the {_words(value.bearing)} at each speed"
    if callable(value):
        return f"{unit}, by a function of the speed"
    if isinstance(value, CoefficientTable):
        axes = (
            (value.speeds, "speeds", "rpm", 30.0 / np.pi),
            (value.frequencies, "frequencies", "Hz", 0.5 / np.pi),
        )
        shown = [
            f"{len(points)} {name}, {points[0] * f:.6g} to {points[-1] * f:.6g} {unit_of}"
            for points, name, unit_of, f in axes
            if points is not None
        ]
        return f"{unit}, by a table of " + " and ".join(shown)
    if np.ndim(value) == 0:
        return f"{value:.6g} {unit}"
    rows = (", ".join(f"{entry:.6g}" for entry in row) for row in value)
    return f"[{'; '.join(rows)}] {unit}"


def _vector(values: np.ndarray) -> str:
    return "[" + ", ".join(f"{value:.5g}" for value in values) + "]"
