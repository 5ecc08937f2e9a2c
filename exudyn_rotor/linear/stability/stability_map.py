"""Stability over two parameters."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike

from exudyn_rotor import checks, plotting
from exudyn_rotor.checks import ascending
from exudyn_rotor.linear import options
from exudyn_rotor.linear.models.basis.basis_error import NOT_KNOWN, BasisError, relative_errors
from exudyn_rotor.linear.models.linear_model import Target, linear_model
from exudyn_rotor.linear.periodic.exponents import motions
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem
from exudyn_rotor.linear.stability.growth import (
    Growth,
    GrowthAt,
    check_method,
    growth_of,
    held_space,
)
from exudyn_rotor.results import Result, numbers, storable, words
from exudyn_rotor.sweep import sweep
from exudyn_rotor.units import Units

_RESIDUAL = 1e-7  # of a large SolidRotor


@storable
@dataclass(frozen=True, eq=False)
class StabilityMap(Result):
    """Growth over two parameters.

    Attributes
    ----------
    x, y : ndarray, shapes (a,), (b,)
    growth : ndarray, shape (a, b)
        Largest real part of the exponents [1/s].
    stable : ndarray of bool, shape (a, b)
    labels : tuple of str
        Names of x and y.
    basis_errors : ndarray, shape (a, b), or None
        Estimated relative error of the least stable motion by the basis of a reduced rotor, as
        :attr:`Stability.basis_errors`; NaN where it is not known, None where it is nowhere.

    Examples
    --------
    >>> from exudyn_rotor import StabilityMap
    >>> stable = [[True], [False]]
    >>> result = StabilityMap([1.0, 2.0], [10.0], [[-0.5], [0.5]], stable, ("c", "speed"))
    >>> print(result.table())
    growth [1/s]; columns: speed
                           c           10
                           1         -0.5
                           2          0.5*
    error of the basis: not known
    """

    x: np.ndarray = numbers("x")
    y: np.ndarray = numbers("y")
    growth: np.ndarray = numbers("x", "y")
    stable: np.ndarray = numbers("x", "y", dtype=bool)
    labels: tuple[str, ...] = words(2, default=("x", "y"))
    basis_errors: np.ndarray | None = numbers("x", "y", finite=False, optional=True)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns, one row for each point; `units` change nothing."""
        Units.of(units)
        first, second = self.labels
        return {
            first: np.repeat(self.x, len(self.y)),
            second: np.tile(self.y, len(self.x)),
            "growth [1/s]": self.growth.ravel(),
            "stable": self.stable.ravel(),
            "basis error": self._errors.ravel(),
        }

    @property
    def _errors(self) -> np.ndarray:
        unknown = np.full(self.growth.shape, np.nan)
        return unknown if self.basis_errors is None else self.basis_errors

    def table(self) -> str:
        """Return the growth [1/s] at every point as lines of text; '*' marks instability."""
        first, second = self.labels
        lines = [f"growth [1/s]; columns: {second}", f"{first:>24}"]
        lines[-1] += "".join(f"{value:13.5g} " for value in self.y).rstrip()
        for value, growth, stable in zip(self.x, self.growth, self.stable, strict=True):
            entries = (f"{g:13.5g}{' ' if s else '*'}" for g, s in zip(growth, stable, strict=True))
            lines.append(f"{value:24.6g}" + "".join(entries).rstrip())
        worst = np.nanmax(self._errors, initial=0.0)
        if worst > 0.0:
            lines.append(f"basis error up to {worst:.1e}")
        elif np.any(np.isnan(self._errors)):
            lines.append(NOT_KNOWN)
        return "\n".join(lines)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the growth as a contour plot, with the limit of stability as a line.

        Where one parameter has one value, as a curve over the other one.
        """
        ax = plotting.axes_or_new(ax)
        if min(self.growth.shape) == 1:
            return self._plot_curve(ax)
        growth = np.where(self.stable, np.minimum(self.growth, 0.0), self.growth).T
        largest = np.abs(growth).max() or 1.0
        levels = MaxNLocator(20, symmetric=True).tick_values(-largest, largest)
        filled = ax.contourf(self.x, self.y, growth, levels, cmap="RdBu_r")
        ax.figure.colorbar(filled, ax=ax, label="growth [1/s]")
        if not (self.stable.all() or not self.stable.any()):
            verdict = np.where(self.stable, -1.0, 1.0).T
            crossing = growth if growth.min() < -1e-6 * largest else verdict
            ax.contour(self.x, self.y, crossing, [0.0], colors="black", linewidths=1.2)
        ax.set_xlabel(self.labels[0])
        ax.set_ylabel(self.labels[1])
        return ax

    def _plot_curve(self, ax: Axes) -> Axes:
        """Draw the growth over one parameter, at the one value of the other."""
        along = int(len(self.y) > 1)
        values, fixed = (self.y, self.x) if along else (self.x, self.y)
        growth, unstable = self.growth.ravel(), ~self.stable.ravel()
        ax.axhline(0.0, color="0.6", lw=0.8)
        ax.plot(values, growth, ".-", color=plotting.COLORS[0])
        if unstable.any():
            marks = {"color": plotting.COLORS[1], "label": "unstable"}
            ax.plot(values[unstable], growth[unstable], "x", **marks)
            ax.legend()
        ax.set_title(f"{self.labels[1 - along]} = {fixed[0]:g}")
        ax.set_xlabel(self.labels[along])
        ax.set_ylabel("growth [1/s]")
        return ax


def stability_map(
    build: Callable[[float, float], PeriodicSystem | tuple[Target, float]],
    x: ArrayLike,
    y: ArrayLike,
    *,
    labels: tuple[str, str] = ("x", "y"),
    method: str = "auto",
    tolerance: float = 1e-9,
    accuracy: float | None = 1e-2,
    executor: Executor | None = None,
    progress: bool = False,
) -> StabilityMap:
    """Compute the growth over a grid of two parameters.

    Parameters
    ----------
    build : callable
        ``build(x, y)`` returns a target of :func:`stability` and the speed [rad/s], e.g.
        ``(linear_model(rotor, supports=[Support('left', x)]), y)``, or a
        :class:`PeriodicSystem`, which is taken as it is; picklable for process pools.
    x, y : array_like, shapes (a,), (b,)
        Ascending.
    labels : tuple of str
        Names of x and y with units, for the plot.
    method, tolerance, accuracy, executor, progress
        See :func:`stability`.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, linear_model, stability_map
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> def build(damping: float, speed: float) -> tuple:
    ...     inner = [Support(name, damping=damping, frame="rotor") for name in ("left", "right")]
    ...     return linear_model(rotor, supports=supports + inner), speed
    >>> stability_map(build, [2.0, 5.0], [200.0, 400.0]).stable
    array([[ True,  True],
           [ True, False]])
    """
    checks.function(build, "build")
    check_method(method, tolerance)
    options.check_basis_accuracy(accuracy)
    options.check_sweep(executor, progress)
    names = checks.labels(labels, "labels")
    if len(names) != 2:
        raise ValueError(f"labels: needs two names, of x and of y, got {checks.shown(labels)}")
    grid = [ascending(values, name).tolist() for values, name in ((x, "x"), (y, "y"))]
    points = [(a, b) for a in grid[0] for b in grid[1]]
    point = partial(_map_point, build=build, given=(method, tolerance, accuracy))
    margins = sweep(point, points, executor=executor, progress=progress, label="stability map")
    growth, excess, errors = np.array(margins).T.reshape(3, len(grid[0]), len(grid[1]))
    if np.all(np.isnan(errors)):
        return StabilityMap(*grid, growth, excess <= 0.0, names)
    _warn_of_basis(points, errors, build, accuracy)
    return StabilityMap(*grid, growth, excess <= 0.0, names, basis_errors=errors)


def _map_point(
    point: tuple[float, float], build: Callable, given: tuple[str, float, float | None]
) -> tuple[float, float, float]:
    built, (method, tolerance, accuracy) = build(*point), given
    if isinstance(built, PeriodicSystem):
        growth, error = growth_of(motions(built, method, tolerance, False), built), np.nan
    else:
        if not isinstance(built, tuple) or len(built) != 2:
            raise TypeError(
                "build: needs to return a target of stability and the speed, or a PeriodicSystem, "
                f"got {checks.shown(built)}"
            )
        speed = checks.number(built[1], "build: the speed it returns", "rad/s", least=0.0)
        model = linear_model(built[0])
        space = held_space(model, speed, None, _RESIDUAL)
        growth = GrowthAt(space, method, tolerance)(speed)
        error = _basis_error(BasisError.of(model, accuracy, held=True), growth, speed)
    return growth.values.real.max(), growth.excess, error


def _basis_error(basis: BasisError, growth: Growth, speed: float) -> float:
    """Return the relative error of the least stable motion; NaN where it is not known."""
    shifts = basis.shifts_of([speed], [growth.critical])
    if shifts is None:
        return np.nan
    value = growth.values[[growth.least_stable]]
    given = shifts[None], value.real[None], np.abs(value.imag)[None], np.array([speed])
    return float(relative_errors(*given)[0, 0])


def _warn_of_basis(
    points: list[tuple[float, float]], errors: np.ndarray, build: Callable, accuracy: float
) -> None:
    """Warn where the basis leaves out too much for the worst of the points."""
    worst = points[int(np.nanargmax(errors))]
    basis = BasisError.of(linear_model(build(*worst)[0]), accuracy, held=True)
    basis.warn(errors, f"the least stable motion at ({worst[0]:.5g}, {worst[1]:.5g})")
