"""Error of a response by the basis of a reduced rotor: the difference to that of a finer one.

The finer rotor has the shapes that the basis lacks first (:class:`LeftOut`); its response is solved
for, not estimated from the other, because near a resonance the difference is not small. Mesh nodes
move in it as far as the reduced rotor knows; interfaces move with all shapes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeVar

import numpy as np

from exudyn_rotor.linear.models.basis.basis_error import BasisError
from exudyn_rotor.linear.response.response import Response
from exudyn_rotor.units import Units

# of the largest motion at the same speed or frequency: smaller ones count as that
_LEAST = 0.1
_AXIAL = 1e-6  # share of a motion across the axis that is rounding
HARMONICS = 1e-4  # largest relative change of the finer motion by further harmonics
_FEW = 3  # speeds or frequencies that are looked at beside the peaks

Motion = Mapping[int, np.ndarray]
Kind = TypeVar("Kind", bound=Response)


def looked_at(motions: Sequence[Motion], constant: bool) -> np.ndarray:
    """Return at which speeds or frequencies errors are estimated.

    At all where the equations are constant; solved in harmonics, the finer rotor would take ten
    times as long as the other: there at all peaks, the largest motion and some others.
    """
    if constant:
        return np.arange(len(motions))
    sizes = np.array([sum(_size(each) ** 2 for each in motion.values()) for motion in motions])
    inner = np.any((sizes[1:-1] > sizes[:-2]) & (sizes[1:-1] >= sizes[2:]), axis=1)
    even = np.linspace(0, len(motions) - 1, min(_FEW, len(motions))).astype(int)
    return np.unique(np.r_[even, np.flatnonzero(inner) + 1, np.argmax(sizes.max(axis=1))])


def motion_error(given: Motion, finer: Motion) -> np.ndarray:
    """Return relative errors (p,) of displacements (p, 6) in the largest harmonic across the axis.

    Relative to the motion of the finer rotor at the place, or to a tenth of the largest at any.
    """
    across = {n: np.linalg.norm(each[:, :2]) for n, each in finer.items()}
    largest = {n: _size(each).max() for n, each in finer.items()}
    sizes = across if max(across.values()) > _AXIAL * max(largest.values()) else largest
    order = max(sizes, key=sizes.get)  # not the static stretch by the rotation
    size = _size(finer[order])
    away = _size(finer[order] - given.get(order, 0.0))
    least = np.maximum(size, _LEAST * size.max())
    return np.divide(away, least, out=np.zeros_like(away), where=least > 0.0)


def _size(amplitudes: np.ndarray) -> np.ndarray:
    return np.linalg.norm(amplitudes[:, :3], axis=1)


def with_warning(basis: BasisError, response: Kind, unit: str) -> Kind:
    """Return the response; warn where the basis leaves out too much, in `unit`, Hz or rpm."""
    errors = response.basis_errors
    if errors is None or not errors.size:
        return response
    at, place = np.unravel_index(np.nanargmax(errors), errors.shape)
    value = Units.of(unit).speeds(response.abscissa[at])
    what = f"the motion of {response.places[place]!r} at {value:.5g} {unit}"
    basis.warn(np.nan_to_num(errors), what)
    return response
