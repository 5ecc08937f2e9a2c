"""Tables of coefficients over the spin speed, the frequency of a motion, or both."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PchipInterpolator

from exudyn_rotor import checks
from exudyn_rotor.storage import read_rows

_KINDS = {"k": "stiffness", "c": "damping", "m": "mass"}
_AXES = dict.fromkeys(("speed", "speeds", "rpm", "w", "omega"), "speeds")
_AXES |= dict.fromkeys(("frequency", "frequencies", "freq", "whirl"), "frequencies")
_TO_RADIANS = dict.fromkeys(("rpm", "1/min", "min-1", "u/min", "r/min", "cpm"), np.pi / 30.0)
_TO_RADIANS |= {"rad/s": 1.0, "hz": 2.0 * np.pi}
_TO_SI = {  # of coefficients, those by or of rotations among them
    "k": {"N/m": 1.0, "N/mm": 1e3, "kN/m": 1e3, "kN/mm": 1e6, "MN/m": 1e6, "N": 1.0, "Nm": 1.0},
    "c": {"Ns/m": 1.0, "Ns/mm": 1e3, "kNs/m": 1e3, "Ns": 1.0, "Nms": 1.0},
    "m": {"kg": 1.0, "kgm": 1.0, "kgm²": 1.0},
}
_ROUNDING = 1e-6  # of the largest speed of a table
_LETTERS = "xyzabc"  # displacement along n1, n2, e, then rotation about them
_TURNED = str.maketrans("xyab", "yxba")  # a quarter turn about the axis


@dataclass(frozen=True, eq=False)
class CoefficientTable:
    """A coefficient over the spin speed, the frequency of the motion, or both.

    Between its points it is a piecewise cubic polynomial that does not overshoot (PCHIP), along
    one axis after the other; beyond its ends it keeps the value there. Values have the shape
    (s, f, …), without the axis of what they do not depend on.
    """

    speeds: np.ndarray | None
    frequencies: np.ndarray | None
    values: np.ndarray
    _last: list = field(default_factory=list, init=False, repr=False)

    @classmethod
    def of(
        cls,
        name: str,
        speeds: ArrayLike | None,
        frequencies: ArrayLike | None,
        values: ArrayLike,
        shapes: Sequence[tuple[int, ...]],
    ) -> CoefficientTable:
        """Return a table of numbers or matrices of some `shapes`, checked under a `name`."""
        if speeds is None and frequencies is None:
            raise ValueError(f"{name}: needs speeds, frequencies, or both [rad/s]")
        if speeds is not None:
            speeds = checks.ascending(speeds, f"{name}: the speeds of its table", "rad/s")
        if frequencies is not None:
            where = f"{name}: the frequencies of its table"
            frequencies = checks.ascending_from_zero(frequencies, where, "ω in place of −ω")
        lengths = tuple(len(axis) for axis in (speeds, frequencies) if axis is not None)
        kept = checks.array(values, f"{name}: the values of its table")
        if kept.shape[: len(lengths)] != lengths or kept.shape[len(lengths) :] not in shapes:
            raise ValueError(
                f"{name}: the values of its table need {' × '.join(map(str, lengths))} matrices of "
                f"{rows_of(shapes)} rows{' or numbers' if () in shapes else ''}, as many as "
                f"points, got the shape {kept.shape}"
            )
        return cls(speeds, frequencies, kept)

    def at(self, speed: ArrayLike, frequency: ArrayLike) -> float | np.ndarray:
        """Return the value at a spin speed and the frequency of a motion [rad/s], or at pairs."""
        if self.frequencies is None:
            return self._first(speed)
        if self.speeds is None:
            return self._first(frequency)
        if np.ndim(speed):
            pairs = zip(speed.tolist(), frequency.tolist(), strict=True)
            return np.array([self.at(*pair) for pair in pairs])
        known = self._last[-1:]  # one speed is asked for at many frequencies
        if not known or known[0][0] != speed:
            known = [(speed, _smooth(self.frequencies, self._first(speed)))]
            self._last[:] = known
        return known[0][1](frequency)

    @cached_property
    def _first(self) -> Callable[[float], np.ndarray]:
        """Interpolation along the first axis of the values."""
        return _smooth(self.frequencies if self.speeds is None else self.speeds, self.values)

    def at_frequency(self, frequency: float) -> CoefficientTable | float | np.ndarray:
        """Return what is left at one frequency [rad/s]: a table over the speed, or a value."""
        if self.frequencies is None:
            return self
        axis = 0 if self.speeds is None else 1
        values = _smooth(self.frequencies, np.moveaxis(self.values, axis, 0))(frequency)
        return values if self.speeds is None else CoefficientTable(self.speeds, None, values)


def outside(speeds: np.ndarray, speed: float) -> str:
    """Return what is wrong with a speed beyond the ends of a table, but for rounding, or nothing.

    Differences by the speed leave the end by a little.
    """
    slack = _ROUNDING * np.abs(speeds).max()
    if speeds[0] - slack <= speed <= speeds[-1] + slack:
        return ""
    return (
        f"holds {speeds[0]:g} to {speeds[-1]:g} rad/s, not {speed:g} rad/s: give more of it, or "
        "extrapolate=True to keep the value at its end"
    )


def rows_of(shapes: Sequence[tuple[int, ...]]) -> str:
    """Return how many rows matrices of some shapes have, in words."""
    *some, last = (str(shape[0]) for shape in shapes if shape)
    return f"{', '.join(some)} or {last}"


def _smooth(points: np.ndarray, values: np.ndarray) -> Callable[[float], np.ndarray]:
    """Return the interpolation along the first axis, constant beyond the ends."""
    if len(points) == 1:
        return lambda at: np.broadcast_to(values[0], (*np.shape(at), *values.shape[1:]))
    curve, low, high = PchipInterpolator(points, values, axis=0), *points[[0, -1]].tolist()
    return lambda at: curve(np.minimum(np.maximum(at, low), high))  # np.clip is slow


def read_columns(source: str | Path | Any) -> dict[str, np.ndarray]:
    """Return axes and coefficients, named as for :meth:`Support.from_table`, of a table."""
    axes: dict[str, np.ndarray] = {}
    entries: dict[str, np.ndarray] = {}
    for header, values in _columns(source).items():
        name, _, unit = header.replace("[", "(").partition("(")
        name = re.sub(r"[\s_]", "", name).lower()
        if name in _AXES:
            unit = unit.strip(" )]").lower() or ("rpm" if name == "rpm" else "rad/s")
            if unit not in _TO_RADIANS:
                raise ValueError(f"source: {header!r}: needs rad/s, rpm or Hz, got {unit!r}")
            axes[_AXES[name]] = values * _TO_RADIANS[unit]
        elif re.fullmatch(f"[kcdm][{_LETTERS}]{{2}}", name):
            name = name.replace("d", "c")
            known, unit = _TO_SI[name[0]], re.sub(r"[\s·*.)\]]|/rad", "", unit)
            if unit and unit not in known:
                raise ValueError(f"source: {header!r}: needs {', '.join(known)}, got {unit!r}")
            entries[name] = values * known.get(unit, 1.0)
        else:
            raise ValueError(
                f"source: {header!r} is neither speed, frequency, nor a coefficient as kxx, cxy or "
                "myy; rename it or leave it out"
            )
    _check_whole(entries)
    if not axes:
        raise ValueError("source: needs a column 'speed' or 'frequency'")
    names = [name for name in ("speeds", "frequencies") if name in axes]
    points, places = zip(*(np.unique(axes[n], return_inverse=True) for n in names), strict=True)
    lengths = tuple(map(len, points))
    count = int(np.prod(lengths))
    if len({*zip(*places, strict=True)}) != count or len(places[0]) != count:
        raise ValueError(
            f"source: needs one row for each pair of its {' and '.join(names)}, {count} in all, "
            f"got {len(places[0])} rows"
        )
    last = max((_LETTERS.index(letter) for name in entries for letter in name[1:]), default=0)
    size = 2 if last < 2 else 3 if last == 2 else 6
    found = dict(zip(names, points, strict=True))
    for (kind, *place), values in entries.items():
        table = found.setdefault(_KINDS[kind], np.zeros((*lengths, size, size)))
        table[(*places, *map(_LETTERS.index, place))] = values
    return found


def _check_whole(names: Collection[str]) -> None:
    """Refuse kxx without kyy, kxy without kyx, and so on: hardly one of them is zero."""
    alike = {*names, *(name.translate(_TURNED) for name in names)}
    missing = {kind + pair for kind, i, j in alike for pair in (i + j, j + i)}.difference(names)
    if missing:
        raise ValueError(
            f"source: needs {', '.join(sorted(missing))} beside {', '.join(sorted(names))}; give "
            "columns of zeros for what does not act"
        )


def _columns(source: str | Path | Any) -> dict[str, np.ndarray]:
    """Return the columns of a file of text, or of a DataFrame or mapping, by their headers."""
    if isinstance(source, str | os.PathLike):
        rows = read_rows(source, "source")
        for number, words in rows:
            if len(words) != len(rows[0][1]):
                raise ValueError(
                    f"source: line {number} of {str(source)!r} needs {len(rows[0][1])} values, got "
                    f"{len(words)}"
                )
        columns = zip(*(words for _, words in rows), strict=True)
        source = {name: values for name, *values in columns}
    elif not hasattr(source, "items"):
        raise TypeError(
            f"source: needs a path, a DataFrame or a mapping, got {checks.shown(source)}"
        )
    columns = {}
    for name, values in source.items():
        what = f"source: {str(name)!r}"
        try:
            numbers = np.asarray(values, dtype=float)
        except (TypeError, ValueError):
            raise ValueError(f"{what}: needs numbers, got other text") from None
        columns[str(name)] = checks.vector(numbers, what, size=None)
    return columns
