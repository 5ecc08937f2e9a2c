"""Error of a response by the basis of reduced rotors: the difference to that of a richer one.

The reduced rotor carries the shapes that its basis lacks first. Its response with these is solved
for, not estimated from the other, because near a resonance the difference is not small. Mesh nodes
move in it as far as the reduced rotor knows; interfaces move with all shapes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from exudyn_rotor.linear.modal.basis_error import is_known
from exudyn_rotor.linear.model.linear_model import LinearModel

_LEAST = 0.1  # of the largest motion at the same speed or frequency: smaller ones count as that
_AXIAL = 1e-6  # share of a motion across the axis that is rounding
_FEW = 3  # speeds or frequencies that are looked at beside the peaks

Motions = Mapping[int, np.ndarray]  # harmonics (s, p, 6) over speeds or frequencies


def basis_errors(
    model: LinearModel,
    accuracy: float | None,
    values: np.ndarray,
    motions: Motions,
    solve: Callable[[LinearModel, np.ndarray], Motions],
) -> np.ndarray | None:
    """Return relative errors (s, p) by the basis, NaN where none is looked at.

    None where they are not known.

    Parameters
    ----------
    model : LinearModel
    accuracy : float or None
        None for no estimate.
    values : ndarray, shape (s,)
        Speeds or frequencies [rad/s].
    motions : mapping of int to ndarray, shape (s, p, 6)
        Harmonics there.
    solve : callable
        Takes a model, and speeds or frequencies; gives the motions.
    """
    if not is_known(model, accuracy):
        return None
    sizes = np.sqrt(sum(_size(each) ** 2 for each in motions.values()))
    if model.is_full:
        return np.zeros(sizes.shape)
    errors = np.full(sizes.shape, np.nan)
    at = looked_at(sizes)
    better = solve(model.richer, values[at])
    for row, index in enumerate(at):
        given = {n: a[index] for n, a in motions.items()}
        errors[index] = motion_error(given, {n: a[row] for n, a in better.items()})
    return errors


def looked_at(sizes: np.ndarray) -> np.ndarray:
    """Return where errors are estimated, given sizes (s, p) of motions.

    At all peaks, and at the first, middle and last value.
    """
    known = np.flatnonzero(np.all(np.isfinite(sizes), axis=1))
    sizes = np.nan_to_num(sizes)
    inner = np.any((sizes[1:-1] > sizes[:-2]) & (sizes[1:-1] >= sizes[2:]), axis=1)
    even = np.linspace(0, len(sizes) - 1, min(_FEW, len(sizes))).astype(int)
    chosen = np.r_[even, np.flatnonzero(inner) + 1, np.argmax(sizes.max(axis=1))]
    return np.intersect1d(chosen, known)


def motion_error(given: Mapping[int, np.ndarray], finer: Mapping[int, np.ndarray]) -> np.ndarray:
    """Return relative errors (p,) of displacements (p, 6) in the largest harmonic across the axis.

    Relative to the larger one of the two motions at the place, or to a tenth of the largest at any.
    """
    across = {n: np.linalg.norm(each[:, :2]) for n, each in finer.items()}
    largest = {n: _size(each).max() for n, each in finer.items()}
    sizes = across if max(across.values()) > _AXIAL * max(largest.values()) else largest
    order = max(sizes, key=sizes.get)  # not the static stretch by the rotation
    other = given.get(order, np.zeros_like(finer[order]))
    size = np.maximum(_size(finer[order]), _size(other))  # beside a sharp peak either is larger
    away = _size(finer[order] - other)
    least = np.maximum(size, _LEAST * size.max())
    return np.divide(away, least, out=np.zeros_like(away), where=least > 0.0)


def _size(amplitudes: np.ndarray) -> np.ndarray:
    """Return sizes (…) of displacements, of motions (…, 6)."""
    return np.linalg.norm(amplitudes[..., :3], axis=-1)
