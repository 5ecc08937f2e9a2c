"""Stability over two parameters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from operator import itemgetter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from tqdm import tqdm

from exudyn_rotor import checks, plotting
from exudyn_rotor.checks import ascending
from exudyn_rotor.linear.modal import basis_error
from exudyn_rotor.linear.modal.whirl import (
    UNKNOWN,
    WHIRLS,
    Content,
    Named,
    damping_of,
    families,
)
from exudyn_rotor.linear.model.build import Target, linear_model, warn_of_structural_damping
from exudyn_rotor.linear.model.linear_model import LinearModel, warn_of_refused
from exudyn_rotor.linear.over import NOT_KNOWN, motions_in
from exudyn_rotor.linear.stability.stability import (
    WHAT,
    check_options,
    least_stable_of,
)
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
    labels : tuple of str
        Names of x and y.
    basis_errors : ndarray, shape (a, b), or None
        Estimated relative error of the least stable motion by the basis of a reduced rotor, as
        :attr:`Stability.basis_errors`, at the corners and in the middle; NaN elsewhere, None where
        nothing is known.
    frequencies_inertial : ndarray, shape (a, b), or None
        Of the least stable motion that is not neutral, seen from outside [rad/s].
    whirl_codes, nodal_diameters : ndarray of int, shape (a, b), or None
        Of that motion, as those of :class:`Campbell`; see :attr:`whirl` and :attr:`families`.
    log_decrement : ndarray, shape (a, b), or None
        Of that motion; NaN where it does not oscillate.

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
    growth: np.ndarray = numbers("x", "y", finite=False)
    stable: np.ndarray = numbers("x", "y", dtype=bool)
    labels: tuple[str, ...] = words(2, default=("x", "y"))
    basis_errors: np.ndarray | None = numbers("x", "y", finite=False, optional=True)
    frequencies_inertial: np.ndarray | None = numbers("x", "y", finite=False, optional=True)
    whirl_codes: np.ndarray | None = numbers(
        "x", "y", dtype=int, least=0, most=len(WHIRLS) - 1, optional=True
    )
    nodal_diameters: np.ndarray | None = numbers("x", "y", dtype=int, least=-1, optional=True)
    log_decrement: np.ndarray | None = numbers("x", "y", finite=False, optional=True)

    @property
    def whirl(self) -> np.ndarray:
        """Sense of the least stable motion at each point, shape (a, b); as Campbell.whirl."""
        return np.array(WHIRLS)[self._codes]

    @property
    def families(self) -> np.ndarray:
        """Kind of the least stable motion at each point, shape (a, b); as Stability.families."""
        diameters = np.full(self.growth.shape, -1)
        return families(
            self._codes, diameters if self.nodal_diameters is None else self.nodal_diameters
        )

    @property
    def _codes(self) -> np.ndarray:
        unknown = np.full(self.growth.shape, UNKNOWN)
        return unknown if self.whirl_codes is None else self.whirl_codes

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns, one row for each point.

        `units` are those of the frequency; x and y are as they were given.
        """
        shown = Units.of(units)
        first, second = self.labels
        unknown = np.full(self.growth.shape, np.nan)
        heard, decrement, errors = (
            unknown if each is None else each
            for each in (self.frequencies_inertial, self.log_decrement, self.basis_errors)
        )
        return {
            first: np.repeat(self.x, len(self.y)),
            second: np.tile(self.y, len(self.x)),
            "growth [1/s]": self.growth.ravel(),
            "stable": self.stable.ravel(),
            f"inertial [{shown.frequency}]": shown.frequencies(heard).ravel(),
            "log decrement": decrement.ravel(),
            "whirl": self.whirl.ravel(),
            "kind": self.families.ravel(),
            "basis error": errors.ravel(),
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
        elif np.nanmax(self.basis_errors, initial=0.0) > 0.0:
            lines.append(f"basis error up to {np.nanmax(self.basis_errors):.1e}")
        return "\n".join(lines)

    def _worst_line(self) -> list[str]:
        """Return which motion grows most, where that is known."""
        if self.whirl_codes is None or np.all(np.isnan(self.growth)):
            return []
        at = np.unravel_index(np.nanargmax(self.growth), self.growth.shape)
        parts = [f"{self.growth[at]:.4g} 1/s at ({self.x[at[0]]:.5g}, {self.y[at[1]]:.5g})"]
        parts.append(f"{Units.of('Hz').frequencies(self.frequencies_inertial[at]):.5g} Hz")
        parts.append(self.whirl[at])
        if np.isfinite(self.log_decrement[at]):
            parts.append(f"log decrement {self.log_decrement[at]:.3g}")
        return [f"least stable: {self.families[at]} motion, " + ", ".join(parts)]

    def plot(
        self, ax: Axes | None = None, *, log_x: bool | None = None, log_y: bool | None = None
    ) -> Axes:
        """Draw the growth as a contour plot, with the limit of stability as a line.

        Where one parameter has one value, as a curve over the other one.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
        log_x, log_y : bool, optional
            Whether an axis is logarithmic; by default where its values are spaced so.
        """
        ax = plotting.axes_or_new(ax)
        logarithmic = [
            _is_geometric(values) if given is None else checks.flag(given, name)
            for values, given, name in ((self.x, log_x, "log_x"), (self.y, log_y, "log_y"))
        ]
        if min(self.growth.shape) == 1:
            return self._plot_curve(ax, logarithmic)
        from matplotlib.ticker import MaxNLocator

        neutral = np.where(self.stable, np.minimum(self.growth, 0.0), self.growth)
        growth = np.ma.masked_invalid(neutral).T
        largest = np.abs(growth).max() or 1.0
        levels = MaxNLocator(20, symmetric=True).tick_values(-largest, largest)
        filled = ax.contourf(self.x, self.y, growth, levels, cmap="RdBu_r")
        ax.figure.colorbar(filled, ax=ax, label="growth [1/s]")
        if not (self.stable.all() or not self.stable.any()):
            verdict = np.where(self.stable, -1.0, 1.0).T
            crossing = growth if growth.min() < -1e-6 * largest else verdict
            ax.contour(self.x, self.y, crossing, [0.0], colors="black", linewidths=1.2)
        ax.set_xscale("log" if logarithmic[0] else "linear")
        ax.set_yscale("log" if logarithmic[1] else "linear")
        ax.set_xlabel(self.labels[0])
        ax.set_ylabel(self.labels[1])
        return ax

    def _plot_curve(self, ax: Axes, logarithmic: list[bool]) -> Axes:
        """Draw the growth over one parameter, at the one value of the other."""
        along = int(len(self.y) > 1)
        values, fixed = (self.y, self.x) if along else (self.x, self.y)
        growth, unstable = self.growth.ravel(), (~self.stable & np.isfinite(self.growth)).ravel()
        ax.axhline(0.0, color="0.6", lw=0.8)
        ax.plot(values, growth, ".-", color=plotting.COLORS[0])
        if unstable.any():
            marks = {"color": plotting.COLORS[1], "label": "unstable"}
            ax.plot(values[unstable], growth[unstable], "x", **marks)
            ax.legend()
        ax.set_xscale("log" if logarithmic[along] else "linear")
        ax.set_title(f"{self.labels[1 - along]} = {fixed[0]:g}")
        ax.set_xlabel(self.labels[along])
        ax.set_ylabel("growth [1/s]")
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
    method: str = "auto",
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
    method, tolerance, progress
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
    check_options(method, tolerance, accuracy)
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
        shown = f"({point[0]:.5g}, {point[1]:.5g})"
        try:
            model, speed = _built(build, point)
            one = _Point(at, shown, model, speed, model.coefficients(speed))
        except ValueError as error:
            refused.append((shown, error))
        else:
            alike.setdefault((*model.pattern, speed == 0.0), []).append(one)
    warn_of_refused(refused, shape[0] * shape[1])
    models = [points[0].model for points in alike.values()]
    lossy = next((model for model in models if model.has_structural_damping), None)
    if lossy is not None:
        warn_of_structural_damping(lossy, WHAT)
    made = {name: np.full(shape, np.nan) for name in ("growth", "least", "inertial", "errors")}
    stable, codes = np.zeros(shape, dtype=bool), np.full(shape, UNKNOWN, dtype=np.int64)
    diameters, worst = np.full(shape, -1, dtype=np.int64), (0.0, "", None)
    for points in alike.values():
        places, model = tuple(np.array([one.at for one in points]).T), points[0].model
        speeds = np.array([one.speed for one in points])
        stack = model.at_points(speeds, [one.coefficients for one in points])
        motions = motions_in(model, stack, method, tolerance, held=True, least_stable=True)
        named = Content.of(model).named(motions)
        which = least_stable_of(named.motions)[:, None]
        found = named.columns(which)
        made["growth"][places] = np.fmax.reduce(motions.values.real, axis=1, initial=np.nan)
        stable[places] = made["growth"][places] <= motions.bounds
        made["least"][places] = found.motions.values[:, 0].real
        made["inertial"][places], codes[places] = found.inertial[:, 0], found.codes[:, 0]
        diameters[places] = found.diameters[:, 0]
        for row, one in enumerate(points):
            if one.at in judged and basis_error.is_known(one.model, accuracy):
                error = _basis_error(one.model, named.rows([row]), which[[row]])
                made["errors"][one.at] = error
                worst = max(worst, (np.nan_to_num(error), one.shown, one.model), key=itemgetter(0))
    if worst[2] is not None:
        basis_error.warn(worst[0], f"the least stable motion at {worst[1]}", worst[2], accuracy)
    return StabilityMap(
        *grid,
        made["growth"],
        stable,
        names,
        basis_errors=None if np.all(np.isnan(made["errors"])) else made["errors"],
        frequencies_inertial=made["inertial"],
        whirl_codes=codes,
        nodal_diameters=diameters,
        log_decrement=damping_of(made["least"], made["inertial"])[1],
    )


class _Point(NamedTuple):
    """A point of a map: its place, its name, its model, speed, and coefficients of supports."""

    at: tuple[int, int]
    shown: str
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


def _basis_error(model: LinearModel, named: Named, which: np.ndarray) -> float:
    """Return the relative error of the least stable motion; NaN where it is not found again."""
    shift = np.take_along_axis(basis_error.shifts_over(model, named, held=True), which, 1)
    growth, inertial = (
        np.take_along_axis(X, which, 1) for X in (named.motions.values.real, named.inertial)
    )
    return float(basis_error.relative_errors(shift, growth, inertial, named.motions.speeds)[0, 0])
