"""Stability of a rotor on its supports: over the spin speed, and its limits.

The exponents λ are eigenvalues where the equations are constant in the rotor frame (isotropic
supports, or none at rest), else Floquet exponents
(:mod:`exudyn_rotor.linear.periodic.exponents`). Growth is the largest real part; exact zeros of it,
as without damping, count as stable.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from exudyn_rotor import checks, plotting
from exudyn_rotor.linear import options
from exudyn_rotor.linear.models.linear_model import (
    Target,
    linear_model,
    warn_of_structural_damping,
)
from exudyn_rotor.linear.models.protocol import LinearModel, Space
from exudyn_rotor.linear.models.supports import Support
from exudyn_rotor.linear.periodic.exponents import METHODS, in_order
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem
from exudyn_rotor.linear.periodic.verified import verified
from exudyn_rotor.multibody.rotor_body import RotorBody
from exudyn_rotor.results import Result, numbers, storable
from exudyn_rotor.sweep import ascending_from_zero, sweep
from exudyn_rotor.threads import one_thread
from exudyn_rotor.units import Units

_ROUND_OFF = 1e-13  # of eigenvalues, as a share of the highest frequency
_MODES = 10  # of a large SolidRotor


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

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import Stability
    >>> values = [[-1.0 + 100.0j, -1.0 - 100.0j]]
    >>> result = Stability([50.0], values, np.exp(values), [-1.0], [True], [0.0], 1e-9)
    >>> print(result.table())
    speed [rad/s]   growth [1/s]   frequency [rad/s]   verdict
          50.0000             -1                 100   stable
    """

    speeds: np.ndarray = numbers("speeds")
    exponents: np.ndarray = numbers("speeds", "modes", dtype=complex)
    multipliers: np.ndarray = numbers("speeds", "modes", dtype=complex, finite=False)
    growth: np.ndarray = numbers("speeds")
    stable: np.ndarray = numbers("speeds", dtype=bool)
    base: np.ndarray = numbers("speeds")
    tolerance: float

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.number(self.tolerance, "tolerance", least=0.0)

    def plot(self, ax: Axes | None = None, *, units: str = "Hz") -> Axes:
        """Draw the growth over the spin speed; unstable speeds are shaded.

        `units` are 'Hz', 'rpm' or 'SI', rad/s.
        """
        shown = Units.of(units)
        ax = plotting.axes_or_new(ax)
        speeds = shown.speeds(self.speeds)
        ax.plot(speeds, self.growth, ".-", color=plotting.COLORS[0], lw=1.3)
        low, high = ax.get_ylim()
        ax.fill_between(
            speeds, low, high, where=~self.stable, color=plotting.COLORS[1], alpha=0.2, lw=0.0
        )
        ax.set_ylim(low, high)
        ax.axhline(0.0, color="0.3", lw=0.8)
        ax.set_xlabel(f"spin speed [{shown.speed}]")
        ax.set_ylabel("growth of the least stable motion [1/s]")
        ax.grid(alpha=0.3)
        return ax

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns; `units` are those of :meth:`plot`."""
        shown = Units.of(units)
        least = np.abs(self.exponents[:, 0].imag)
        return {
            f"speed [{shown.speed}]": shown.speeds(self.speeds),
            "growth [1/s]": self.exponents[:, 0].real,
            f"frequency in the rotor frame [{shown.frequency}]": shown.frequencies(least),
            "stable": self.stable,
        }

    def table(self, *, units: str = "SI") -> str:
        """Return speed, growth, frequency of the least stable motion and verdict as text.

        `units` are those of :meth:`plot`.
        """
        shown = Units.of(units)
        speed, frequency = f"speed [{shown.speed}]", f"frequency [{shown.frequency}]"
        lines = [f"{speed:>13}   growth [1/s]   {frequency:>17}   verdict"]
        for at, exponent, stable in zip(
            shown.speeds(self.speeds), self.exponents[:, 0], self.stable, strict=True
        ):
            verdict, heard = "stable" if stable else "unstable", shown.frequencies(exponent.imag)
            lines.append(f"{at:13.4f}   {exponent.real:12.5g}   {abs(heard):17.5g}   {verdict}")
        return "\n".join(lines)


def stability(
    target: Target,
    speeds: ArrayLike,
    *,
    supports: Sequence[Support] = (),
    body: RotorBody | None = None,
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
    target : ReducedRotor, SolidRotor, exudyn.MainSystem or linear model
        See :func:`linear_model`. Of a SolidRotor with more than 600 degrees of freedom only the
        lowest `modes` are looked at, each checked by the residual of the full equations.
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

    Examples
    --------
    Damping in the rotor drives it unstable above its critical speed:

    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, stability
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> inner = [Support(name, damping=5.0, frame="rotor") for name in ("left", "right")]
    >>> result = stability(rotor, [100.0, 400.0], supports=supports + inner)
    >>> result.stable.tolist()
    [True, False]
    """
    values = ascending_from_zero(speeds, "speeds")
    _check(method, tolerance, modes, residual)
    options.check_sweep(executor, progress)
    model = linear_model(target, supports=supports, body=body, stiffening=stiffening)
    space = held_space(model, values[-1], modes, residual)
    if executor is not None:
        space = space.prepared(values)
    task = _Task(space, method, tolerance)
    workers = None if space.is_shared else executor
    solved = sweep(task, values, executor=workers, progress=progress, label="stability")
    exponents, base, excess = (np.array(column) for column in zip(*solved, strict=True))
    periodic = np.where(base > 0.0, base, values)
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        multipliers = np.exp(2.0 * np.pi * exponents / periodic[:, None])
    multipliers[periodic == 0.0] = np.nan
    return Stability(
        speeds=values,
        exponents=exponents,
        multipliers=multipliers,
        growth=exponents.real.max(axis=1),
        stable=excess <= 0.0,
        base=base,
        tolerance=tolerance,
    )


@dataclass(frozen=True, eq=False)
class _Task:
    """Exponents at one speed; picklable where the space is."""

    space: Space
    method: str
    tolerance: float

    @one_thread()
    def __call__(self, speed: float) -> tuple[np.ndarray, float, float]:
        values, system = self.space.exponents(speed, self.method, self.tolerance)
        limits = _growth_limits(values, system, self.tolerance)
        if system.is_constant:
            values = in_order(verified(values, limits, system), speed)
        return values, abs(system.base), excess_growth(values, system, self.tolerance)


def held_space(model: LinearModel, fastest: float, modes: int | None, residual: float) -> Space:
    """Return where exponents are found: a spin that nothing holds follows θ = Ωt.

    It is neutral, which round-off would feign to be unstable.

    Raises
    ------
    ValueError
        For a number of modes where all are found, or of more than a quarter of the coordinates.
    """
    warn_of_structural_damping(model, "stability finds exponents")
    if model.gives_all and modes is not None:
        raise ValueError("modes: is only for a large SolidRotor; this target gives all exponents")
    count = _MODES if modes is None else modes
    if not model.gives_all and count > model.size // 4:
        raise ValueError(
            f"modes: {count} is not between 1 and {model.size // 4}, a quarter of the coordinates"
        )
    return model.space(count, fastest, held=True, residual=residual)


def excess_growth(values: np.ndarray, system: PeriodicSystem, tolerance: float) -> float:
    """Return the largest real part above what round-off and truncation can feign.

    Neutral motions, which never exceed it, count only where there are no others: as the largest
    they would hide how stable the others are, and root finding would be slow.
    """
    limits = _growth_limits(values, system, tolerance)
    moving, excess = np.abs(values.real) > limits, values.real - limits
    return float(np.max(excess[moving] if np.any(moving) else excess))


def _growth_limits(values: np.ndarray, system: PeriodicSystem, tolerance: float) -> np.ndarray:
    fastest = np.sqrt(np.abs(np.diag(system.K[0]) / np.diag(system.M[0])).max())
    return tolerance * np.maximum(system.speed, np.abs(values)) + _ROUND_OFF * fastest


def stability_threshold(target: Target, low: float, high: float, **given) -> float:
    """Return the speed between `low` and `high` [rad/s] where the stability changes.

    By root finding on the growth, to 1e-8 of `high`. The growth counts from `tolerance` times the
    speed on, so a threshold that is crossed slowly is found late by that over the slope.
    `given` are further arguments of :func:`stability`.

    Raises
    ------
    ValueError
        If both ends are stable, or both unstable.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, stability_threshold
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> inner = [Support(name, damping=5.0, frame="rotor") for name in ("left", "right")]
    >>> limit = stability_threshold(rotor, 100.0, 400.0, supports=supports + inner)
    >>> round(limit, 3)  # √(k/m) (1 + c_outer/c_inner)
    300.0
    """
    low = checks.number(low, "low", "rad/s", least=0.0)
    high = checks.number(high, "high", "rad/s", above=low)
    excess = _excess_function(target, given, high)
    ends = excess(low), excess(high)
    if (ends[0] > 0.0) == (ends[1] > 0.0):
        verdict = "unstable" if ends[0] > 0.0 else "stable"
        raise ValueError(f"stability: {verdict} at {low:g} as well as at {high:g} rad/s")
    return float(brentq(excess, low, high, xtol=1e-8 * high))


def unstable_ranges(target: Target, speeds: ArrayLike, **given) -> np.ndarray:
    """Return the unstable speed ranges, shape (r, 2) [rad/s].

    Every change between two neighbours of `speeds` is found to 1e-8 of the highest speed; a range
    narrower than their spacing can be missed. A range that is open at the first or last speed ends
    there. `given` are further arguments of :func:`stability`.

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
    excess = _excess_function(target, given, values[-1])
    unstable = [excess(speed) > 0.0 for speed in values]
    edges = [values[0]] if unstable[0] else []
    for i in np.flatnonzero(np.diff(unstable)):
        edges.append(brentq(excess, values[i], values[i + 1], xtol=1e-8 * values[-1]))
    edges += [values[-1]] if unstable[-1] else []
    return np.array(edges).reshape(-1, 2)


def _excess_function(target: Target, given: dict, highest: float) -> Callable[[float], float]:
    """Return the growth above round-off as a function of the speed."""
    method, tolerance = given.pop("method", "auto"), given.pop("tolerance", 1e-9)
    modes, residual = given.pop("modes", None), given.pop("residual", 1e-7)
    _check(method, tolerance, modes, residual)
    unknown = set(given) - {"supports", "body", "stiffening"}
    if unknown:
        raise TypeError(f"stability: unknown option {', '.join(sorted(unknown))}")
    space = held_space(linear_model(target, **given), highest, modes, residual)
    task = _Task(space, method, tolerance)
    return lambda speed: task(speed)[2]


def check_method(method: str, tolerance: float) -> None:
    """Refuse an unknown method and an impossible tolerance."""
    checks.choice(method, "method", METHODS)
    options.accuracy(tolerance, "tolerance")


def _check(method: str, tolerance: float, modes: int | None, residual: float) -> None:
    check_method(method, tolerance)
    options.accuracy(residual, "residual")
    if modes is not None:
        checks.count(modes, "modes", least=1)
