"""What the basis of a reduced rotor leaves out: the analysis again with a richer one.

Beside its modes a reduced rotor carries static responses to loads at its interfaces
(:mod:`exudyn_rotor.reduction`). The model with these shapes, too, is solved at a few points of an
analysis, and compared.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
import scipy.linalg as la

from exudyn_rotor.calls import user_level
from exudyn_rotor.linear.modal.whirl import Content, Named, matched
from exudyn_rotor.linear.model.assembly import rotors_of
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.over import motions_over

_DAMPED = 0.01  # share of the frequency that growth counts as at least
_SLOW = 0.1  # share of the spin speed that a frequency counts as at least
_RANGE, _LOWEST = 2.0, 6  # times the fastest speed, and lowest modes: what is judged in any case
_SPREAD = 0.2  # third of the share of a frequency by which the same motion may differ
_POINTS = 3  # speeds at which the richer model is solved
_LEAST = 0.1  # of the largest motion at the same speed or frequency: smaller ones count as that

Amplitudes = Mapping[int, np.ndarray]  # harmonics (s, p, 6) over speeds or frequencies


def is_known(model: LinearModel, accuracy: float | None) -> bool:
    """Return whether an estimate is asked for and can be given."""
    return accuracy is not None and (model.is_full or model.richer is not None)


def points(count: int) -> np.ndarray:
    """Return which of so many speeds the richer model is solved at: first, middle and last."""
    return np.unique(np.linspace(0, count - 1, min(count, _POINTS)).round().astype(int))


def motion_errors(model: LinearModel, named: Named, *, held: bool = False) -> np.ndarray | None:
    """Return relative errors of motions by the basis, the larger of frequency and growth, (s, k).

    At the first, the middle and the last speed; NaN elsewhere, and where a motion is not found
    again. Zero where the basis leaves nothing out, None where that is not known. A frequency counts
    as at least a tenth of the spin speed, a growth as at least a hundredth of the frequency. At
    rest, what neither oscillates nor grows has no relative error.
    """
    richer, errors = model.richer, np.zeros(named.inertial.shape)
    if model.is_full:
        return errors
    if richer is None:
        return None
    lifted = lifting(model, richer)
    rows = named.motions.known[points(len(named.motions.known))]
    given = named.rows(rows)
    speeds = given.motions.speeds
    better = Content.of(richer).named(motions_over(richer, speeds, held=held, warns=False))
    lift = replace(given.motions, vectors=lifted @ given.motions.vectors)
    chosen, same = matched(given._replace(motions=lift), better, richer.mass_matrix, _SPREAD)
    better = better.columns(chosen)
    # of a train, which rotor's frame a motion is seen from may differ between both models
    seen, turning = better.inertial - given.inertial, better.rotor - given.rotor
    change = np.minimum(np.abs(seen), np.abs(turning))
    least = np.maximum(given.inertial, _SLOW * np.abs(speeds)[:, None])
    growth = given.motions.values.real
    grown = np.abs(better.motions.values.real - growth)
    sizes = np.maximum(np.abs(growth), _DAMPED * least)
    with np.errstate(divide="ignore", invalid="ignore"):
        found = np.maximum(change / least, grown / sizes)
    errors[:] = np.nan
    errors[rows] = np.where(same & np.isfinite(found), found, np.nan)
    return errors


def lifting(model: LinearModel, richer: LinearModel) -> np.ndarray:
    """Return the coordinates of a richer model (l, k) that are those of a model."""
    blocks = []
    for body, wide in zip(model.bodies, richer.bodies, strict=True):
        if body in rotors_of(model.bodies):
            rotor = model.rotors[body.name]
            blocks.append(wide.alone.Q.T @ rotor.in_attached @ body.alone.Q)
        else:
            blocks.append(np.eye(body.size))
    return la.block_diag(*blocks)


def judged(
    frequencies: np.ndarray, growth: np.ndarray, speeds: np.ndarray, every: bool = False
) -> np.ndarray:
    """Return which modes (s, k) an analysis of all modes is judged by.

    Those up to twice the fastest speed in the inertial frame, and the lowest six that move, or all
    if these are fewer; the highest modes of a basis are always wrong. If `every`, all that move.
    Overdamped ones count up to decays of that size.
    """
    moving = np.sort(np.where(frequencies > 0.0, frequencies, np.nan), axis=1)
    lowest = np.nanmax(moving[:, :_LOWEST], axis=1, keepdims=True, initial=0.0)
    limit = np.maximum(lowest, _RANGE * speeds[-1])
    overdamped = (frequencies == 0.0) & (-growth > limit)
    return ((frequencies <= limit) | every) & ~overdamped


# ------------------------------------------------------------------ forced motions


def basis_errors(
    model: LinearModel,
    accuracy: float | None,
    values: np.ndarray,
    motions: Amplitudes,
    solve: Callable[[LinearModel, np.ndarray], Amplitudes],
    along: float = 1.0,
) -> np.ndarray | None:
    """Return relative errors (s, p) by the basis, NaN where none is looked at; None if not known.

    Of `motions`, harmonics (s, p, 6), at speeds or frequencies `values` (s,) [rad/s]; `solve` takes
    a model and such values, and gives the motions. The harmonic that is looked at is the largest,
    with motion `along` the axis by this share of it.
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
        errors[index] = motion_error(given, {n: a[row] for n, a in better.items()}, along)
    return errors


def looked_at(sizes: np.ndarray) -> np.ndarray:
    """Return where errors are estimated, given sizes (s, p) of motions.

    At all peaks, and at the first, middle and last value.
    """
    known = np.flatnonzero(np.all(np.isfinite(sizes), axis=1))
    sizes = np.nan_to_num(sizes)
    inner = np.any((sizes[1:-1] > sizes[:-2]) & (sizes[1:-1] >= sizes[2:]), axis=1)
    even = np.linspace(0, len(sizes) - 1, min(_POINTS, len(sizes))).astype(int)
    chosen = np.r_[even, np.flatnonzero(inner) + 1, np.argmax(sizes.max(axis=1))]
    return np.intersect1d(chosen, known)


def motion_error(
    given: Mapping[int, np.ndarray], finer: Mapping[int, np.ndarray], along: float = 1.0
) -> np.ndarray:
    """Return relative errors (p,) of displacements (p, 6) in the largest harmonic.

    Which is largest, motion `along` the axis counts for by this share. Errors are relative to the
    larger one of both motions at the place, or to a tenth of the largest at any.
    """
    sizes = {n: np.linalg.norm(each[:, :3] * [1.0, 1.0, along]) for n, each in finer.items()}
    order = max(sizes, key=sizes.get)
    other = given.get(order, np.zeros_like(finer[order]))
    size = np.maximum(_size(finer[order]), _size(other))  # beside a sharp peak either is larger
    away = _size(finer[order] - other)
    least = np.maximum(size, _LEAST * size.max())
    return np.divide(away, least, out=np.zeros_like(away), where=least > 0.0)


def _size(amplitudes: np.ndarray) -> np.ndarray:
    """Return sizes (…) of displacements, of motions (…, 6)."""
    return np.linalg.norm(amplitudes[..., :3], axis=-1)


def warn(
    errors: np.ndarray | None, told: Callable[..., str], model: LinearModel, accuracy: float | None
) -> None:
    """Warn where an estimated error exceeds the accuracy; `told` names the worst by its indices."""
    worst = 0.0 if errors is None else np.max(np.nan_to_num(errors), initial=0.0)
    if accuracy is None or worst <= accuracy:
        return
    what = told(*np.argwhere(errors == worst)[0])
    bases = []
    for name, rotor in model.rotors.items():
        elastic = rotor.size - len(rotor.rigid_kinds)
        highest = rotor.frequencies[-1] / (2.0 * np.pi) if elastic else 0.0
        label = f"rotor {name!r}" if name else "the reduced rotor"
        bases.append(f"the flexible modes of {label} ({elastic}, up to {highest:.4g} Hz)")
    warnings.warn(
        f"{what} errs by about {worst:.2g} of its value, for {' and '.join(bases)} are too few for "
        f"the accuracy of {accuracy:g}: reduce the rotor with more, up to twice as many, or with "
        "craig_bampton_modes(rotor, …), whose static modes have the flexibility at the interfaces; "
        "give another accuracy=…, or None for no check",
        UserWarning,
        stacklevel=user_level(),
    )
