"""Limits of stability over the spin speed or any other parameter."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.callers import user_level
from exudyn_rotor.linear.models.basis.basis_error import BasisError
from exudyn_rotor.linear.models.linear_model import Target
from exudyn_rotor.linear.periodic.periodic_system import UnconvergedError, fold
from exudyn_rotor.linear.stability.growth_over import (
    Finer,
    GrowthOver,
    Options,
    OverParameter,
    OverSpeed,
    Supports,
)
from exudyn_rotor.linear.stability.threshold_result import StabilityThresholds, limit_errors
from exudyn_rotor.linear.stability.threshold_search import ASIDE, STEP, Search
from exudyn_rotor.sweep import ascending_from_zero

_ROOT = 1e-8  # of the largest parameter
# share of λ or Ω, times the change by the basis: motions so near change with the root of it
_NEAR, _TIMES = 5e-3, 10.0
# of the range beside such a limit where it is searched again, in steps that grow, then at points
_REACH, _STEPS, _POINTS = 0.05, 6, 9
# of such a step: to which the distance is found
_SHARE = 0.02
_MOST = 100  # values looked at with the shapes that the basis lacks


def stability_threshold(
    target: Target | Callable[[float], Target],
    low: float,
    high: float,
    *,
    supports: Supports | Callable[[float], Supports] = (),
    speed: float | None = None,
    samples: int = 24,
    label: str | None = None,
    **given,
) -> StabilityThresholds:
    """Find all thresholds of stability over the spin speed or another parameter.

    Each to 1e-8 of the largest parameter, with the mode that grows there. Ranges between two
    samples are found where the real part of a mode, followed by its rate of change, has a peak, or
    where two lightly damped modes meet in frequency, as in a parametric resonance; gaps between two
    unstable samples by a search of few steps, and what lies between samples of different verdict by
    seven values. Of equations that turn, as of uneven rotors on uneven
    supports, the largest growth is computed at 40 values between two samples, too. A range that is
    narrower can be missed: take more `samples` where that matters. The growth counts from its bound
    on, see :attr:`Stability.bounds`, so a threshold that is crossed slowly is found late by that
    over the slope.

    Parameters
    ----------
    target : as in :func:`stability`, or callable
        A callable takes the parameter and returns such a target.
    low, high : float
        Range of the parameter; spin speeds [rad/s] unless `target` or `supports` are callable.
    supports : sequence of Support, or callable, optional
        Of a rotor; a callable takes the parameter and returns them.
    speed : float, optional
        Spin speed [rad/s], where it is not the parameter.
    samples : int, optional
        Number of steps in which the range is sampled. The speeds of supports' tables, at which
        their coefficients have kinks, are samples, too.
    label : str, optional
        Name of the parameter with its unit.
    **given
        Further arguments of :func:`stability`: `body`, `stiffening`, `method`, `tolerance`,
        `modes`, `residual`, `accuracy`. The last is the relative error of a threshold by the basis
        of a reduced rotor, estimated, above which a warning is given: see
        :attr:`StabilityThresholds.basis_errors`.

    Raises
    ------
    TypeError, ValueError
        For bad input, and a `speed` that is missing or given where it is the parameter.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, stability_threshold
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> def damped(inner: float) -> list:
    ...     outer = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    ...     return outer + [Support(s.interface, damping=inner, frame="rotor") for s in outer]
    >>> limit = stability_threshold(rotor, 100.0, 400.0, supports=damped(5.0))
    >>> limit.values.round(3)  # √(k/m) (1 + c_outer/c_inner)
    array([300.])
    >>> given = {"supports": damped, "speed": 300.0, "samples": 4}
    >>> print(stability_threshold(rotor, 2.0, 20.0, label="inner damping", **given).table())
    inner damping   above      frequency [rad/s]  n  whirl      kind
                5   unstable                 100  1  forward    lateral
    """
    low = checks.number(low, "low")
    high = checks.number(high, "high", above=low)
    samples = checks.count(samples, "samples", least=2)
    is_speed = not callable(target) and not callable(supports)
    if label is None:
        label = "speed [rad/s]" if is_speed else "parameter"
    checks.label(label, "label")
    if is_speed:
        checks.number(low, "low", "rad/s", least=0.0)
        if speed is not None:
            raise ValueError("speed: is the parameter, from low to high; leave it out")
        made: GrowthOver = OverSpeed.of(target, high, given | {"supports": supports})
    else:
        if speed is None:
            given = "target" if callable(target) else "supports"
            raise ValueError(
                f"speed: needs the spin speed [rad/s], since {given}: a function, "
                f"{checks.shown(target if callable(target) else supports)}, says that it is not "
                "the parameter"
            )
        speed = checks.number(speed, "speed", "rad/s", least=0.0)
        made = OverParameter(target, supports, speed, Options.of(given))
    search = Search(made, high - low)
    kinks = made.kinks[(made.kinks > low) & (made.kinks < high)]
    for point in np.union1d(np.linspace(low, high, samples + 1), kinks):
        search.at(float(point))
    search.refine()
    found = search.changes(_ROOT * max(abs(low), abs(high)))
    limits = _limits(search, found, 0.5 * (low + high))
    names = list(zip(*(limit.name for limit in limits), strict=True)) if limits else [(), (), ()]
    values, shifts = np.array([value for value, _ in found]), _shifts(limits, made.accuracy)
    _warn_of_basis(limits, shifts, values, high - low, label)
    return StabilityThresholds(
        values,
        np.array([on for _, on in found], dtype=bool),
        np.array(names[0], dtype=float),
        *(np.array(column, dtype=np.int64) for column in names[1:]),
        low,
        high,
        bool(search.at(low).excess > 0.0),
        label,
        basis_shifts=shifts,
    )


def unstable_ranges(target: Target, speeds: ArrayLike, **given) -> np.ndarray:
    """Return the unstable speed ranges, shape (r, 2) [rad/s].

    Every change between two neighbours of `speeds` is found to 1e-8 of the highest speed; a range
    narrower than their spacing can be missed: :func:`stability_threshold` looks for those, too. A
    range that is open at the first or last speed ends there. `given` are further arguments of
    :func:`stability`; `accuracy` is that of :func:`stability_threshold`.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, unstable_ranges
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> inner = [Support(name, damping=5.0, frame="rotor") for name in ("left", "right")]
    >>> unstable_ranges(rotor, [100.0, 250.0, 400.0], supports=supports + inner).round(3)
    array([[300., 400.]])
    """
    values = ascending_from_zero(speeds, "speeds")
    made = OverSpeed.of(target, values[-1], given)
    search = Search(made, values[-1])
    points = [float(value) for value in values]
    search.known |= zip(points, made.task.at_all(points), strict=True)
    unstable = [search.unstable(point) for point in points]
    edges = [values[0]] if unstable[0] else []
    found = search.changes(_ROOT * values[-1])
    edges += [value for value, _ in found]
    edges += [values[-1]] if unstable[-1] else []
    if made.checked.left_out is not None:
        limits = _limits(search, found, 0.5 * (values[0] + values[-1]))
        shifts, at = _shifts(limits, made.accuracy), np.array([value for value, _ in found])
        _warn_of_basis(limits, shifts, at, values[-1] - values[0], "speed [rad/s]")
    return np.array(edges).reshape(-1, 2)


class _Limit(NamedTuple):
    """The motion that grows beside a limit of stability, and what the basis does to the limit.

    `name` is inertial frequency, whirl code and n; `shift` as one of
    :attr:`StabilityThresholds.basis_shifts`, None where it is not known.
    """

    name: tuple[float, int, int]
    shift: float | None
    basis: BasisError


def _limits(search: Search, found: Sequence[tuple[float, bool]], middle: float) -> list[_Limit]:
    """Return what grows beside each limit, within its unstable range however narrow that is."""
    ends, limits = [-np.inf, *(value for value, _ in found), np.inf], []
    for place, (value, onset) in enumerate(found, start=1):
        width = ends[place + 1 if onset else place - 1] - value
        away = np.sign(width) * min(ASIDE * search.span, 0.5 * abs(width))
        limits.append(_limit(search, value, away, middle))
    return limits


def _limit(search: Search, value: float, away: float, middle: float) -> _Limit:
    """Return what grows `away` from a limit; the slope of its growth is told to the `middle`."""
    onset, beside = away > 0.0, value + away
    growth = search.known[beside] = search.made.growth(beside, named=True)
    which = growth.least_stable
    name = tuple(entries[which] for entries in growth.names)
    basis, speed = search.made.basis(beside)
    shifts = basis.shifts_of([speed], [growth.critical])
    if shifts is None or shifts[0] == 0.0:
        return _Limit(name, None if shifts is None else 0.0, basis)
    step = STEP * search.span * (1.0 if beside < middle else -1.0)
    slope = search.rate(beside, step)[which].real
    apart = np.abs(fold(np.delete(growth.values, which) - growth.values[which], growth.base))
    near = max(_NEAR * max(speed, abs(growth.values[which])), _TIMES * abs(shifts[0]))
    meets = apart.min(initial=np.inf) < near
    if np.isnan(shifts[0]) or meets or slope * away <= 0.0:
        try:
            return _Limit(name, _searched_again(search, value, onset), basis)
        except UnconvergedError:  # the shapes that the basis lacks have high frequencies
            return _Limit(name, np.nan, basis)
    return _Limit(name, float(-shifts[0].real / slope), basis)


def _searched_again(search: Search, value: float, onset: bool) -> float:
    """Return the distance to the limit with the shapes that the basis lacks; NaN if none is near.

    The growth of motions that meet changes with the root of the parameter: it has no slope there.
    The verdict at the limit tells on which side the other lies.
    """
    # without damping all motions are followed, fast ones that the basis lacks, too
    finer, reach = Search(Finer(search.made), search.span, most=_MOST), _REACH * search.span
    low, high = min(search.known), max(search.known)
    side = -1.0 if finer.unstable(value) == onset else 1.0
    for distance in reach * 4.0 ** np.arange(1.0 - _STEPS, 1.0):
        finer.at(float(np.clip(value + side * distance, low, high)))
        found = finer.changes(max(ASIDE * search.span, _SHARE * distance))
        if found:
            return found[0][0] - value
    for point in np.linspace(*np.clip([value - reach, value + reach], low, high), _POINTS):
        finer.at(float(point))
    finer.refine()
    found = [at - value for at, on in finer.changes(ASIDE * search.span) if on == onset]
    return min(found, key=abs, default=np.nan)


def _shifts(limits: Sequence[_Limit], accuracy: float | None) -> np.ndarray | None:
    shifts = [limit.shift for limit in limits]
    return None if accuracy is None or None in shifts else np.array(shifts, dtype=float)


def _warn_of_basis(
    limits: Sequence[_Limit],
    shifts: np.ndarray | None,
    values: np.ndarray,
    span: float,
    label: str,
) -> None:
    """Warn where the basis leaves out too much for the worst of the limits."""
    if shifts is None:
        return
    unknown = ", ".join(f"{value:.5g}" for value in values[np.isnan(shifts)])
    if unknown:
        warnings.warn(
            f"the error of the limit of stability at {unknown}, {label}, by the basis of the "
            "reduced rotor is not known; compare it with a rotor of more modes",
            UserWarning,
            stacklevel=user_level(),
        )
    if np.all(np.isnan(shifts)):
        return
    errors = limit_errors(shifts, values, span)
    worst = int(np.nanargmax(errors))
    what = f"the limit of stability at {values[worst]:.5g}, {label},"
    limits[worst].basis.warn(errors[worst], what)
