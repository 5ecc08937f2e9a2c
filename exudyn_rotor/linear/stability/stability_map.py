"""Stability over two parameters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from tqdm import tqdm

from exudyn_rotor import checks, plotting
from exudyn_rotor.checks import ascending
from exudyn_rotor.linear.modal import basis_error
from exudyn_rotor.linear.modal.whirl import UNKNOWN, WHIRLS, Content, families
from exudyn_rotor.linear.model.build import Target, linear_model, warn_of_structural_damping
from exudyn_rotor.linear.model.linear_model import LinearModel, warn_of_refused
from exudyn_rotor.linear.over import NOT_KNOWN, basis_column, motions_in
from exudyn_rotor.linear.stability.stability import WHAT, check_options, of_motions
from exudyn_rotor.results import Result, numbers, storable, words
from exudyn_rotor.solvers.factor import one_thread
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_EVEN = 1e-6  # relative difference of ratios of values that are spaced logarithmically


@storable
@dataclass(frozen=True, eq=False)
class StabilityMap(Result):
    """Growth over two parameters; a point without values is NaN and not stable.

    Attributes
    ----------
    x, y : ndarray, shapes (a,), (b,)
    growth : ndarray, shape (a, b)
        Largest real part of the exponents [1/s], 0 where a free motion is neutral.
    stable : ndarray of bool, shape (a, b)
    frequencies_inertial : ndarray, shape (a, b)
        Of the least stable motion that is not neutral, seen from outside [rad/s].
    whirl_codes, nodal_diameters : ndarray of int, shape (a, b)
        Of that motion, as those of :class:`Campbell`; see :attr:`whirl` and :attr:`families`.
    log_decrement : ndarray, shape (a, b)
        Of that motion; NaN where it does not oscillate.
    labels : tuple of str
        Names of x and y.
    basis_errors : ndarray, shape (a, b), or None
        Estimated relative error of the least stable motion by the basis of a reduced rotor, as
        :attr:`Stability.basis_errors`, at the corners and in the middle; NaN elsewhere, None where
        nothing is known.

    Examples
    --------
    >>> from exudyn_rotor import StabilityMap
    >>> motion = {"frequencies_inertial": [[60.0], [70.0]], "log_decrement": [[0.05], [-0.04]]}
    >>> motion |= {"whirl_codes": [[0], [0]], "nodal_diameters": [[1], [1]]}
    >>> given = {"x": [1.0, 2.0], "y": [10.0], "growth": [[-0.5], [0.5]], "labels": ("c", "speed")}
    >>> print(StabilityMap(stable=[[True], [False]], **given, **motion).table())
    growth [1/s]; columns: speed
                           c           10
                           1         -0.5
                           2          0.5*
    least stable: lateral motion, 0.5 1/s at (2, 10), 11.141 Hz, forward, log decrement -0.04
    error of the basis: not known
    """

    x: np.ndarray = numbers("x")
    y: np.ndarray = numbers("y")
    growth: np.ndarray = numbers("x", "y", finite=False)
    stable: np.ndarray = numbers("x", "y", dtype=bool)
    frequencies_inertial: np.ndarray = numbers("x", "y", finite=False)
    whirl_codes: np.ndarray = numbers("x", "y", dtype=int, least=0, most=len(WHIRLS) - 1)
    nodal_diameters: np.ndarray = numbers("x", "y", dtype=int, least=-1)
    log_decrement: np.ndarray = numbers("x", "y", finite=False)
    labels: tuple[str, ...] = words(2, default=("x", "y"))
    basis_errors: np.ndarray | None = numbers("x", "y", finite=False, optional=True)

    @property
    def whirl(self) -> np.ndarray:
        """Sense of the least stable motion at each point, shape (a, b); as Campbell.whirl."""
        return np.array(WHIRLS)[self.whirl_codes]

    @property
    def families(self) -> np.ndarray:
        """Kind of the least stable motion at each point, shape (a, b); as Stability.families."""
        return families(self.whirl_codes, self.nodal_diameters)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns, one row for each point.

        `units` are those of the frequency; x and y are as they were given.
        """
        shown = Units.of(units)
        first, second = self.labels
        return {
            first: np.repeat(self.x, len(self.y)),
            second: np.tile(self.y, len(self.x)),
            "growth [1/s]": self.growth.ravel(),
            "stable": self.stable.ravel(),
            f"inertial [{shown.frequency}]": shown.frequencies(self.frequencies_inertial).ravel(),
            "log decrement": self.log_decrement.ravel(),
            "whirl": self.whirl.ravel(),
            "kind": self.families.ravel(),
            **basis_column(self.basis_errors, self.growth.size),
        }

    def table(self) -> str:
        """Return the growth [1/s] at every point as lines of text; '*' marks instability."""
        first, second = self.labels
        lines = [f"growth [1/s]; columns: {second}", f"{first:>24}"]
        lines[-1] += "".join(f"{value:13.5g} " for value in self.y).rstrip()
        marks = np.where(self.stable | np.isnan(self.growth), " ", "*")
        for value, growth, marked in zip(self.x, self.growth, marks, strict=True):
            entries = (f"{g:13.5g}{mark}" for g, mark in zip(growth, marked, strict=True))
            lines.append(f"{value:24.6g}" + "".join(entries).rstrip())
        lines += self._worst_line()
        if self.basis_errors is None:
            lines.append(NOT_KNOWN)
        elif np.any(self.basis_errors > 0.0):
            lines.append(f"basis error up to {np.nanmax(self.basis_errors):.1e}")
        return "\n".join(lines)

    def _worst_line(self) -> list[str]:
        """Return which motion grows most, where that is known."""
        if np.all(np.isnan(self.growth)):
            return []
        at = np.unravel_index(np.nanargmax(self.growth), self.growth.shape)
        parts = [f"{self.growth[at]:.4g} 1/s at ({self.x[at[0]]:.5g}, {self.y[at[1]]:.5g})"]
        parts.append(f"{Units.of('Hz').frequencies(self.frequencies_inertial[at]):.5g} Hz")
        parts.append(self.whirl[at])
        if np.isfinite(self.log_decrement[at]):
            parts.append(f"log decrement {self.log_decrement[at]:.3g}")
        return [f"least stable: {self.families[at]} motion, " + ", ".join(parts)]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the growth as a contour plot, with the limit of stability as a line.

        An axis is logarithmic where its values are spaced so. Where one parameter has one value,
        the picture has coloured points.
        """
        ax = plotting.axes_or_new(ax)
        ax.set(xlabel=self.labels[0], ylabel=self.labels[1])
        ax.set_xscale("log" if _is_geometric(self.x) else "linear")
        ax.set_yscale("log" if _is_geometric(self.y) else "linear")
        neutral = np.where(self.stable, np.minimum(self.growth, 0.0), self.growth)
        growth = np.ma.masked_invalid(neutral).T
        largest = np.abs(growth).max() or 1.0
        if min(self.growth.shape) == 1:  # contours need two values of each
            places = np.meshgrid(self.x, self.y)
            filled = ax.scatter(*places, c=growth, cmap="RdBu_r", vmin=-largest, vmax=largest)
            ax.figure.colorbar(filled, ax=ax, label="growth [1/s]")
            return ax
        from matplotlib.ticker import MaxNLocator

        levels = MaxNLocator(20, symmetric=True).tick_values(-largest, largest)
        filled = ax.contourf(self.x, self.y, growth, levels, cmap="RdBu_r")
        ax.figure.colorbar(filled, ax=ax, label="growth [1/s]")
        if not (self.stable.all() or not self.stable.any()):
            verdict = np.where(self.stable, -1.0, 1.0).T
            crossing = growth if growth.min() < -1e-6 * largest else verdict
            ax.contour(self.x, self.y, crossing, [0.0], colors="black", linewidths=1.2)
        return ax


def _is_geometric(values: np.ndarray) -> bool:
    """Return whether values have one ratio, and not one difference."""
    if len(values) < 3 or values[0] <= 0.0:
        return False
    ratios = values[1:] / values[:-1]
    return bool(np.ptp(ratios) <= _EVEN * ratios[0])


@one_thread()
def stability_map(
    build: Callable[[float, float], tuple[Target, float]],
    x: ArrayLike,
    y: ArrayLike,
    *,
    labels: tuple[str, str] = ("x", "y"),
    tolerance: float = 1e-6,
    accuracy: float | None = 1e-2,
    progress: bool = False,
) -> StabilityMap:
    """Compute the growth over a grid of two parameters.

    Parameters
    ----------
    build : callable
        ``build(x, y)`` returns a target of :func:`stability` and the speed [rad/s], e.g.
        ``(linear_model(rotor, supports=[Support('left', x)]), y)``. Points whose models differ in
        numbers of their supports alone are solved together.
    x, y : array_like, shapes (a,), (b,)
        Ascending.
    labels : tuple of str
        Names of x and y with units, for the plot.
    tolerance, progress
        See :func:`stability`.
    accuracy : float, optional
        Relative error of the growth by the basis of a reduced rotor above which a warning is given,
        estimated at the corners and in the middle. None for no estimate.

    Raises
    ------
    TypeError, ValueError
        For bad input, and where no point has values. A single point at which `build` or the
        supports raise a ValueError is NaN, with a warning.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, linear_model, stability_map
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1]).reduce(1)
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> def build(damping: float, speed: float) -> tuple:
    ...     inner = [Support(name, damping=damping, frame="rotor") for name in ("left", "right")]
    ...     return linear_model(rotor, supports=supports + inner), speed
    >>> stability_map(build, [2.0, 5.0], [200.0, 400.0]).stable
    array([[ True,  True],
           [ True, False]])
    """
    checks.function(build, "build")
    check_options(tolerance, accuracy)
    checks.flag(progress, "progress")
    names = checks.labels(labels, "labels")
    if len(names) != 2:
        raise ValueError(f"labels: needs two names, of x and of y, got {checks.shown(labels)}")
    grid = [ascending(values, name) for values, name in ((x, "x"), (y, "y"))]
    shape = len(grid[0]), len(grid[1])
    judged = {(a, b) for a in (0, shape[0] - 1) for b in (0, shape[1] - 1)}
    judged.add((shape[0] // 2, shape[1] // 2))
    refused, alike = [], {}
    for at in tqdm(list(np.ndindex(*shape)), desc="stability map", disable=not progress):
        point = float(grid[0][at[0]]), float(grid[1][at[1]])
        try:
            model, speed = _built(build, point)
            one = _Point(at, model, speed, model.coefficients(speed))
        except ValueError as error:
            refused.append((f"({point[0]:.5g}, {point[1]:.5g})", error))
        else:
            alike.setdefault((*model.pattern, speed == 0.0), []).append(one)
    warn_of_refused(refused, shape[0] * shape[1])
    models = [points[0].model for points in alike.values()]
    warn_of_structural_damping(max(models, key=lambda one: one.has_structural_damping), WHAT)
    growth, inertial, decrement, errors = np.full((4, *shape), np.nan)
    stable, codes = np.zeros(shape, dtype=bool), np.full(shape, UNKNOWN, dtype=np.int64)
    diameters = np.full(shape, -1, dtype=np.int64)
    for points in alike.values():
        model, content = points[0].model, Content.of(points[0].model)
        speeds = np.array([one.speed for one in points])
        stack = model.at_points(speeds, [one.coefficients for one in points])
        motions = motions_in(model, stack, "auto", tolerance, held=True, least_stable=True)
        found = of_motions(model, content, motions, None)
        rows = np.arange(len(points)), found.least_stable
        places = tuple(np.array([one.at for one in points]).T)
        growth[places], stable[places] = found.growth, found.stable
        inertial[places] = found.frequencies_inertial[rows]
        decrement[places] = found.log_decrement[rows]
        codes[places], diameters[places] = found.whirl_codes[rows], found.nodal_diameters[rows]
        for row, one in enumerate(points):
            if one.at in judged and basis_error.is_known(one.model, accuracy):
                alone = of_motions(one.model, content, motions[[row]], accuracy)
                errors[one.at] = alone.basis_errors[0]
    result = StabilityMap(
        *grid,
        growth,
        stable,
        inertial,
        codes,
        diameters,
        decrement,
        names,
        basis_errors=None if np.all(np.isnan(errors)) else errors,
    )
    if result.basis_errors is not None:
        a, b = np.unravel_index(np.nanargmax(errors), shape)
        worst = f"the least stable motion at ({result.x[a]:.5g}, {result.y[b]:.5g})"
        basis_error.warn(errors, worst, models[0], accuracy)
    return result


class _Point(NamedTuple):
    """A point of a map: its place, its model, speed, and coefficients of supports."""

    at: tuple[int, int]
    model: LinearModel
    speed: float
    coefficients: Sequence


def _built(build: Callable, point: tuple[float, float]) -> tuple[LinearModel, float]:
    """Return the model and the speed of a point."""
    built = build(*point)
    if not isinstance(built, tuple) or len(built) != 2:
        raise TypeError(
            "build: needs to return a target of stability and the speed, got " + checks.shown(built)
        )
    speed = checks.number(built[1], "build: the speed it returns", "rad/s", least=0.0)
    return linear_model(built[0]), speed
