"""Stability of a rotor on its supports: over the spin speed, and its limits.

The exponents λ are eigenvalues where the equations are constant in the rotor frame (isotropic
supports, or none at rest), else Floquet exponents
(:mod:`exudyn_rotor.linear.stability.floquet`). Growth is the largest real part; exact zeros of it,
as without damping, count as stable.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from exudyn_rotor import checks, plotting
from exudyn_rotor.linear import options
from exudyn_rotor.linear.equations.full import FullRotor
from exudyn_rotor.linear.equations.source import linear_source
from exudyn_rotor.linear.equations.supports import Support
from exudyn_rotor.linear.equations.system import LinearRotor, PeriodicSystem
from exudyn_rotor.linear.stability import floquet
from exudyn_rotor.linear.stability.full import FullExponents, projected
from exudyn_rotor.results import Result, numbers, storable
from exudyn_rotor.sweep import ascending_from_zero, sweep

METHODS = ("auto", "floquet", "hill", "eigen")
_ROUND_OFF = 1e-13  # of eigenvalues, as a share of the highest frequency
_NEUTRAL = 1e-7  # |λ|/Ω of a free rigid motion: a double zero keeps half the digits


@storable
@dataclass(frozen=True, eq=False)
class Stability(Result):
    """Exponents over spin speed.

    Attributes
    ----------
    speeds : ndarray, shape (s,)
        Spin speeds [rad/s].
    exponents : ndarray, shape (s, 2k)
        λ, the least stable first; real part [1/s], imaginary part [rad/s] in the rotor frame.
        Where the system is periodic, frequencies are known but for multiples of `base` and lie in
        (−base/2, base/2]. Of a large SolidRotor one of each conjugate pair, and of two real ones
        the less damped, shape (s, modes).
    multipliers : ndarray, as exponents
        ``exp(2πλ/base)``; over one revolution where the system is constant; NaN at 0 rad/s.
    growth : ndarray, shape (s,)
        Largest real part [1/s].
    stable : ndarray of bool, shape (s,)
        No exponent has a real part above ``tolerance · max(Ω, |λ|)`` and round-off.
    base : ndarray, shape (s,)
        Frequency of the coefficients [rad/s], 0 where they are constant.
    tolerance : float
    """

    speeds: np.ndarray = numbers("speeds")
    exponents: np.ndarray = numbers("speeds", "modes", dtype=complex)
    multipliers: np.ndarray = numbers("speeds", "modes", dtype=complex, finite=False)
    growth: np.ndarray = numbers("speeds")
    stable: np.ndarray = numbers("speeds", dtype=bool)
    base: np.ndarray = numbers("speeds")
    tolerance: float

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the growth over the spin speed; unstable speeds are shaded."""
        ax = plotting.axes_or_new(ax)
        hertz = self.speeds / (2.0 * np.pi)
        ax.plot(hertz, self.growth, ".-", color=plotting.COLORS[0], lw=1.3)
        low, high = ax.get_ylim()
        ax.fill_between(
            hertz, low, high, where=~self.stable, color=plotting.COLORS[1], alpha=0.2, lw=0.0
        )
        ax.set_ylim(low, high)
        ax.axhline(0.0, color="0.3", lw=0.8)
        ax.set_xlabel("spin speed [Hz]")
        ax.set_ylabel("growth of the least stable motion [1/s]")
        ax.grid(alpha=0.3)
        return ax

    def table(self) -> str:
        """Return speed, growth, frequency of the least stable motion and verdict as text."""
        lines = ["speed [rad/s]   growth [1/s]   frequency [rad/s]   verdict"]
        for speed, exponent, stable in zip(
            self.speeds, self.exponents[:, 0], self.stable, strict=True
        ):
            verdict = "stable" if stable else "unstable"
            lines.append(
                f"{speed:13.4f}   {exponent.real:12.5g}   {abs(exponent.imag):17.5g}   {verdict}"
            )
        return "\n".join(lines)


def stability(
    target: object,
    speeds: ArrayLike,
    *,
    supports: Sequence[Support] = (),
    body: object = None,
    stiffening: str = "tilt",
    method: str = "auto",
    tolerance: float = 1e-9,
    modes: int | None = None,
    residual: float = 1e-7,
    executor: Executor | None = None,
    progress: bool = False,
) -> Stability:
    """Compute the exponents of a rotor over the spin speed.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, exudyn.MainSystem, LinearRotor, or with ``at(speed)``
        ``at(speed)`` returns the :class:`PeriodicSystem` at a speed. Of a SolidRotor with more than
        600 degrees of freedom only the lowest `modes` are looked at, each checked by the residual
        of the full equations.
    speeds : array_like, shape (s,)
        Spin speeds [rad/s], not negative, ascending.
    supports : sequence of Support
        For a rotor. A spin that no support holds follows θ = Ωt and gives no exponent, see the
        notes of :func:`campbell`.
    body : RotorBody, optional
        The rotor in a ``MainSystem``.
    stiffening : {'tilt', 'none', 'full'}
        For a rotor; 'full' needs one with prestress.
    method : {'auto', 'floquet', 'hill', 'eigen'}
        ``'auto'``: eigenvalues where the system is constant, else Hill's method, and Floquet's
        where that does not converge. A large SolidRotor takes 'auto' only, without Floquet's.
    tolerance : float
        Error of periodic exponents relative to Ω.
    modes : int, optional
        How many modes of a large SolidRotor, those of smallest |λ| in the rotor frame; 10 by
        default. The growth of modes above them is not looked at.
    residual : float, optional
        Largest relative residual of those modes; see :meth:`Subspace.modes`.
    executor : concurrent.futures.Executor, optional
        Where the exponents are computed; see :func:`exudyn_rotor.sweep.sweep`. A large
        SolidRotor does not use it: its speeds share one subspace.
    progress : bool

    Raises
    ------
    ValueError
        For bad input, and where `tolerance` or `residual` is not reached.
    """
    values = ascending_from_zero(speeds, "speeds")
    _check(method, tolerance, modes, residual)
    options.check_sweep(executor, progress)
    source = source_of(target, supports, body, stiffening)
    if isinstance(source, FullRotor):
        full = _full(source, modes, values[-1], residual, method, tolerance)
        found = sweep(partial(_full_exponents, full=full), values, progress=progress,
                      label="stability")  # fmt: skip
        return _result(values, [full.at(speed) for speed in values], np.array(found), tolerance)
    if modes is not None:
        raise ValueError("modes=: is only for a large SolidRotor; this target gives all exponents")
    systems = [source.at(speed) for speed in values]
    found = sweep(
        partial(exponents, method=method, tolerance=tolerance),
        systems,
        executor=executor,
        progress=progress,
        label="stability",
    )
    return _result(values, systems, np.array(found), tolerance)


def _result(
    speeds: np.ndarray, systems: list[PeriodicSystem], found: np.ndarray, tolerance: float
) -> Stability:
    base = np.array([abs(floquet.base_frequency(system)) for system in systems])
    periodic = np.where(base > 0.0, base, speeds)
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        multipliers = np.exp(2.0 * np.pi * found / periodic[:, None])
    multipliers[periodic == 0.0] = np.nan
    excess = [
        excess_growth(row, system, tolerance) for row, system in zip(found, systems, strict=True)
    ]
    return Stability(
        speeds=speeds,
        exponents=found,
        multipliers=multipliers,
        growth=found.real.max(axis=1),
        stable=np.array(excess) <= 0.0,
        base=base,
        tolerance=tolerance,
    )


def exponents(system: PeriodicSystem, method: str = "auto", tolerance: float = 1e-9) -> np.ndarray:
    """Return the 2k exponents of one system [1/s], descending in their real parts.

    Free rigid motions (``|λ| < 1e-7 Ω``) are returned as zeros.
    """
    constant = system.is_constant or system.speed == 0.0
    if method == "eigen" and not constant:
        raise ValueError(
            f"method='eigen': at {system.speed:g} rad/s the system is periodic (anisotropic "
            "supports or a foundation); use 'auto', 'hill' or 'floquet'"
        )
    if constant and method != "floquet":
        values = floquet.constant_exponents(system).astype(complex)
    elif method == "floquet":
        values = floquet.floquet_exponents(system, tolerance)
    else:
        values = _hill(system, tolerance, fall_back=method == "auto")
    return _in_order(values, system.speed)


def _in_order(values: np.ndarray, speed: float) -> np.ndarray:
    """Return exponents with neutral ones set to zero, descending in their real parts."""
    values[np.abs(values) < _NEUTRAL * speed] = 0.0
    return values[np.lexsort((-values.imag, -values.real))]


def _full(
    source: FullRotor,
    modes: int | None,
    speed: float,
    residual: float,
    method: str,
    tolerance: float,
) -> FullExponents:
    if method != "auto":
        raise ValueError(
            f"method={method!r} needs a reduced rotor; a large SolidRotor takes 'auto' only"
        )
    return FullExponents(source, modes, speed, residual, tolerance)


def _full_exponents(speed: float, full: FullExponents) -> np.ndarray:
    """Return one exponent of every pair of a full model, as :func:`exponents` does."""
    values = full.values(speed)
    return _in_order(floquet.fold(values, abs(floquet.base_frequency(full.at(speed)))), speed)


def _hill(system: PeriodicSystem, tolerance: float, fall_back: bool) -> np.ndarray:
    try:
        return floquet.hill_exponents(system, tolerance)[0]
    except floquet.UnconvergedError:
        if not fall_back:
            raise
        return floquet.floquet_exponents(system, tolerance)


def excess_growth(values: np.ndarray, system: PeriodicSystem, tolerance: float) -> float:
    """Return the largest real part above what round-off and truncation can feign."""
    fastest = np.sqrt(np.abs(np.diag(system.K[0]) / np.diag(system.M[0])).max())
    margin = tolerance * np.maximum(system.speed, np.abs(values)) + _ROUND_OFF * fastest
    return float(np.max(values.real - margin))


def stability_threshold(target: object, low: float, high: float, **given) -> float:
    """Return the speed between `low` and `high` [rad/s] where the stability changes.

    By root finding on the growth, to 1e-8 of `high`. The growth counts from `tolerance` times the
    speed on, so a threshold that is crossed slowly is found late by that over the slope.
    `given` are further arguments of :func:`stability`.

    Raises
    ------
    ValueError
        If both ends are stable, or both unstable.
    """
    low = checks.number(low, "low", "rad/s", least=0.0)
    high = checks.number(high, "high", "rad/s", above=low)
    excess = _excess_function(target, given, high)
    ends = excess(low), excess(high)
    if (ends[0] > 0.0) == (ends[1] > 0.0):
        verdict = "unstable" if ends[0] > 0.0 else "stable"
        raise ValueError(f"stability: {verdict} at {low:g} as well as at {high:g} rad/s")
    return float(brentq(excess, low, high, xtol=1e-8 * high))


def unstable_ranges(target: object, speeds: ArrayLike, **given) -> np.ndarray:
    """Return the unstable speed ranges, shape (r, 2) [rad/s].

    Every change between two neighbours of `speeds` is found to 1e-8 of the highest speed; a range
    narrower than their spacing can be missed. A range that is open at the first or last speed ends
    there. `given` are further arguments of :func:`stability`.
    """
    values = ascending_from_zero(speeds, "speeds")
    excess = _excess_function(target, given, values[-1])
    unstable = [excess(speed) > 0.0 for speed in values]
    edges = [values[0]] if unstable[0] else []
    for i in np.flatnonzero(np.diff(unstable)):
        edges.append(brentq(excess, values[i], values[i + 1], xtol=1e-8 * values[-1]))
    edges += [values[-1]] if unstable[-1] else []
    return np.array(edges).reshape(-1, 2)


def _excess_function(target: object, given: dict, highest: float) -> Callable[[float], float]:
    method, tolerance = given.pop("method", "auto"), given.pop("tolerance", 1e-9)
    modes, residual = given.pop("modes", None), given.pop("residual", 1e-7)
    _check(method, tolerance, modes, residual)
    arguments = {"supports": (), "body": None, "stiffening": "tilt"}
    unknown = set(given) - set(arguments)
    if unknown:
        raise TypeError(f"stability: unknown option {', '.join(sorted(unknown))}")
    source = source_of(target, **(arguments | given))
    if isinstance(source, FullRotor):
        full = _full(source, modes, highest, residual, method, tolerance)
        return lambda speed: excess_growth(_full_exponents(speed, full), full.at(speed), tolerance)

    def excess(speed: float) -> float:
        system = source.at(speed)
        return excess_growth(exponents(system, method, tolerance), system, tolerance)

    return excess


@dataclass(frozen=True, eq=False)
class _HeldSpin:
    """A rotor whose spin follows θ = Ωt: its coordinate is left out.

    A spin that nothing holds is neutral, which round-off would feign to be unstable.
    """

    rotor: LinearRotor
    rest: np.ndarray

    @property
    def size(self) -> int:
        return self.rotor.size - 1

    def at(self, speed: float) -> PeriodicSystem:
        return projected(self.rotor.at(speed), self.rest)


def source_of(target: object, supports: Sequence[Support], body: object, stiffening: str) -> object:
    """Return what has ``at(speed)``; a free spin is held."""
    if callable(getattr(target, "at", None)) and not isinstance(target, type):
        source = target
    else:
        source = linear_source(target, body=body, supports=supports, stiffening=stiffening)
    if not isinstance(source, LinearRotor) or source.free_spin is None:
        return source
    return _HeldSpin(source, source.spin.rest())


def check_method(method: str, tolerance: float) -> None:
    """Refuse an unknown method and an impossible tolerance."""
    checks.choice(method, "method", METHODS)
    options.accuracy(tolerance, "tolerance")


def _check(method: str, tolerance: float, modes: int | None, residual: float) -> None:
    check_method(method, tolerance)
    options.accuracy(residual, "residual")
    if modes is not None:
        checks.count(modes, "modes", least=1)
