"""Stability of a rotor on its supports, over the spin speed and over two parameters.

The exponents λ of all motions are eigenvalues where the equations are constant, as of a round rotor
on any supports, or of an uneven one on supports alike in all directions, else Floquet exponents
(:mod:`exudyn_rotor.linear.solve`). A rotor is stable where no motion grows by more than rounding.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike
from tqdm import tqdm

from exudyn_rotor import checks, plotting
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.linear.modal import basis_error
from exudyn_rotor.linear.modal.whirl import (
    FAMILIES,
    UNKNOWN,
    WHIRLS,
    Content,
    OfMotions,
    damping_of,
    rounded,
)
from exudyn_rotor.linear.model.build import Target, linear_model, warn_of_omissions
from exudyn_rotor.linear.model.linear_model import LinearModel, warn_of_refused
from exudyn_rotor.linear.over import (
    NOT_KNOWN,
    ModelResult,
    basis_column,
    motions_in,
    motions_over,
    table_lines,
)
from exudyn_rotor.linear.solve.motions import METHODS, Motions
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.results import Result, numbers, storable, words
from exudyn_rotor.solvers.factor import one_thread
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SHOWN = 4.0  # times the strongest decay of lateral motions: no faster one is drawn
WHAT = "stability finds exponents"  # of structural damping, for the warning
# what a map has at points without values; all else is NaN there
_NOTHING = {"stable": False, "whirl_codes": UNKNOWN, "nodal_diameters": -1}
_EVEN = 1e-6  # relative difference of ratios of values that are spaced logarithmically


@storable
@dataclass(frozen=True, eq=False)
class Stability(OfMotions, ModelResult):
    """Exponents over spin speed.

    A speed without values, as beyond a table, has a row of NaN and is not stable.

    Attributes
    ----------
    speeds : ndarray, shape (s,)
        Spin speeds [rad/s].
    exponents : ndarray, shape (s, k)
        λ, the least stable first: growth [1/s], and i times the frequency of the motion's strongest
        wave in the rotor frame [rad/s]. One of each conjugate pair, and of real ones the less
        damped half. NaN where harmonics do not converge.
    growth : ndarray, shape (s,)
        Largest real part [1/s].
    stable : ndarray of bool, shape (s,)
        No motion grows by more than :attr:`bounds`.
    bounds : ndarray, shape (s,)
        By how much rounding can change a real part [1/s]: motions that neither grow nor decay by
        more are neutral.
    frequencies_inertial : ndarray, shape (s, k)
        Frequency of the motion's strongest wave seen from outside [rad/s].
    whirl_codes, nodal_diameters : ndarray of int, shape (s, k)
        As those of :class:`Campbell`; see :attr:`whirl` and :attr:`families`.
    basis_errors : ndarray, shape (s,), or None
        Estimated relative error of the least stable motion by the basis of a reduced rotor, as
        :attr:`Campbell.basis_errors`; NaN where all motions are neutral.
    stiffening : str or None
        Level of centrifugal stiffening, 'none', 'tilt' or 'full'; None where it is not known.
    axes : {'inertial', 'rotor'}
        Axes in which the equations were solved.
    unevenness : float
        Largest share of a rotor that differs around its axis, as that of a mesh: in inertial axes
        it was averaged over a turn, in the axes of the rotor it counts.

    Examples
    --------
    >>> from exudyn_rotor import Stability
    >>> names = {"frequencies_inertial": [[150.0]], "whirl_codes": [[0]], "nodal_diameters": [[1]]}
    >>> result = Stability([50.0], [[-1.0 + 100.0j]], [-1.0], [True], [1e-9], **names)
    >>> print(result.table())
    speed [rpm]  lateral [1/s]  inertial [Hz]  n  whirl    stable
        477.465             -1        23.8732  1  forward  stable
    least stable lateral motion: -1 1/s at 477.465 rpm, 23.873 Hz, forward, n = 1, log decrement ...
    error of the basis: not known
    """

    speeds: np.ndarray = numbers("speeds")
    exponents: np.ndarray = numbers("speeds", "modes", dtype=complex, finite=False)
    growth: np.ndarray = numbers("speeds", finite=False)
    stable: np.ndarray = numbers("speeds", dtype=bool)
    bounds: np.ndarray = numbers("speeds", finite=False, least=0.0)
    frequencies_inertial: np.ndarray = numbers("speeds", "modes", finite=False)
    whirl_codes: np.ndarray = numbers("speeds", "modes", dtype=int, least=0, most=len(WHIRLS) - 1)
    nodal_diameters: np.ndarray = numbers("speeds", "modes", dtype=int, least=-1)
    basis_errors: np.ndarray | None = numbers("speeds", finite=False, optional=True)

    @property
    def log_decrement(self) -> np.ndarray:
        """``−2π Re λ / ω`` at the inertial frequency ω; NaN for motions that do not oscillate."""
        return damping_of(self.exponents.real, self.frequencies_inertial)[1]

    @property
    def _moving(self) -> np.ndarray:
        """Whether motions grow or decay by more than rounding, shape (s, k)."""
        return np.abs(self.exponents.real) > self.bounds[:, None]

    @property
    def _growth(self) -> np.ndarray:
        """Real parts [1/s], 0 of motions that are neutral, shape (s, k)."""
        known = ~np.isnan(self.exponents)
        return np.where(known & ~self._moving, 0.0, self.exponents.real)

    @property
    def least_stable(self) -> np.ndarray:
        """Column of the least stable motion at each speed, of those that are not neutral, (s,)."""
        return np.argmax(self._moving, axis=1)

    def growth_of(self, family: str) -> np.ndarray:
        """Return the largest real part within a family [1/s], shape (s,).

        0 for motions that are neutral within :attr:`bounds`, NaN where the family has none.

        Parameters
        ----------
        family : {'lateral', 'torsional', 'axial', 'disc', 'other', 'foundation'}
        """
        checks.choice(family, "family", FAMILIES)
        growth = np.where(self.families == family, self._growth, np.nan)
        return np.fmax.reduce(growth, axis=1, initial=np.nan)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns; `units` are those of :meth:`plot`.

        Where all motions are neutral none is the least stable: no growth, frequency NaN, '-'.
        """
        shown, none = Units.of(units), ~self._moving.any(axis=1)
        rows = np.arange(len(self.speeds)), self.least_stable
        heard = np.where(none, np.nan, shown.frequencies(self.frequencies_inertial[rows]))
        return {
            f"speed [{shown.speed}]": shown.speeds(self.speeds),
            "growth [1/s]": self._growth[rows],
            **{f"{name} [1/s]": self.growth_of(name) for name in FAMILIES},
            f"inertial [{shown.frequency}]": heard,
            "nodal diameters": np.where(none, -1, self.nodal_diameters[rows]),
            "whirl": np.where(none, "-", self.whirl[rows]),
            "stable": self.stable,
            **basis_column(self.basis_errors, len(self.speeds)),
        }

    def table(self, *, units: str = "rpm") -> str:
        """Return speed, growth of the families, the least stable motion and verdict as text.

        Below, the least stable motion of each family over all speeds: an undamped torsion, say, is
        the least stable of all motions at every speed, and would hide which lateral one is. Where
        all are neutral no motion is named. `units` are those of :meth:`plot`.
        """
        shown = Units.of(units)
        verdict = np.where(np.isfinite(self.growth), "unstable", "-")
        verdict = np.where(self.stable, "stable", verdict)
        lines = table_lines(self.columns(units) | {"stable": verdict}, "growth [1/s]")
        for family in FAMILIES:
            named = (self.families == family) & self._moving
            if np.any(named):
                growth = np.where(named, self.exponents.real, -np.inf)
                # the first of several that are one but for rounding
                worst, *_ = np.argwhere(growth >= growth.max() - np.nanmax(self.bounds))
                lines.append(f"least stable {family} motion: {self._told(*worst, shown)}")
        return "\n".join([*lines, *self._closing(self.basis_errors)])

    def _told(self, row: int, column: int, shown: Units) -> str:
        """Return a motion in words: growth, speed, frequency, whirl, log decrement."""
        at = row, column
        place, n = f"{shown.speeds(self.speeds[row]):.6g} {shown.speed}", self.nodal_diameters[at]
        heard = f"{shown.frequencies(self.frequencies_inertial[at]):.5g} {shown.frequency}"
        whirl = f"{self.whirl[at]}" + (f", n = {n}" if n >= 0 else "")
        return _in_words(self.exponents[at].real, place, heard, whirl, self.log_decrement[at])

    def plot(self, ax: Axes | None = None, *, units: str = "rpm") -> Axes:
        """Draw the growth of each family over the spin speed; unstable speeds are shaded.

        Decays that are much faster than the strongest one of lateral motions are left out.
        `units` are 'rpm', 'Hz' or 'SI', rad/s.
        """
        shown = Units.of(units)
        ax = plotting.axes_or_new(ax)
        speeds = shown.speeds(self.speeds)
        least = _SHOWN * np.fmin.reduce(self.growth_of("lateral"), initial=0.0) or -np.inf
        for family, color in zip(FAMILIES, plotting.COLORS, strict=True):
            growth = self.growth_of(family)
            growth[growth < least] = np.nan
            if not np.all(np.isnan(growth)):
                ax.plot(speeds, growth, ".-", color=color, lw=1.3, label=family)
        ax.fill_between(
            speeds, 0.0, 1.0, where=self.growth > self.bounds, transform=ax.get_xaxis_transform(),
            color=plotting.COLORS[1], alpha=0.2, lw=0.0,
        )  # fmt: skip
        ax.axhline(0.0, color="0.3", lw=0.8)
        ax.set(xlabel=f"spin speed [{shown.speed}]", ylabel="largest growth [1/s]")
        ax.grid(alpha=0.3)
        plotting.legend_above(ax, 4)
        return ax


def least_stable(found: Stability) -> dict[str, np.ndarray]:
    """Return the least stable motion at each speed by the names that :class:`StabilityMap` has."""
    rows = np.arange(len(found.speeds)), found.least_stable
    names = "frequencies_inertial", "log_decrement", "whirl_codes", "nodal_diameters"
    told = {name: getattr(found, name)[rows] for name in names}
    return {"least_stable_growth": found._growth[rows], **told}


def stability(
    target: Target,
    speeds: ArrayLike,
    *,
    supports: Sequence[Given] | Given = (),
    body: RotorBody | Sequence[RotorBody] | None = None,
    stiffening: str = "auto",
    axes: str = "auto",
    method: str = "auto",
    tolerance: float = 1e-6,
    accuracy: float | None = 1e-2,
    progress: bool = False,
) -> Stability:
    """Compute the exponents of a rotor over the spin speed.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, RotorTrain, exudyn.MainSystem or LinearModel
        See :func:`linear_model`.
    speeds : array_like, shape (s,)
        Spin speeds [rad/s], not negative, ascending.
    supports : sequence of Support or bearings
        For a rotor. A spin that no support holds follows θ = Ωt and gives no exponent, see the
        notes of :func:`campbell`.
    body : RotorBody or sequence of these, optional
        The rotor in a ``MainSystem``, or all of several, see :func:`linear_model`.
    stiffening : {'auto', 'none', 'tilt', 'full'}
        For a rotor; 'full' needs one with prestress.
    axes : {'auto', 'inertial', 'rotor'}
        Of the equations, see :func:`linear_model`.
    method : {'auto', 'hill', 'floquet'}
        For periodic equations, as of uneven rotors on uneven supports: sums of harmonics ('hill'),
        or integration over a period, which finds motions up to some 20 Ω only. 'auto' takes
        harmonics, but where affordable ones miss a slow motion that grows.
    tolerance : float
        Largest relative error of λ by harmonics of periodic equations that are left out.
    accuracy : float, optional
        Relative error of the least stable motion's growth by the basis of a reduced rotor,
        estimated, above which a warning is given: see :attr:`Stability.basis_errors`. None for no
        estimate.
    progress : bool
        Show a progress bar.

    Raises
    ------
    TypeError
        If the target, the body or a support is of another kind.
    ValueError
        For bad input, and where there are values at none of the speeds. A single speed without
        values is NaN, with a warning.

    Examples
    --------
    Damping in the rotor drives it unstable above its critical speed:

    >>> from exudyn_rotor import Support, rotor_example, stability
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> inner = [Support(name, damping=5.0, frame="rotor") for name in ("left", "right")]
    >>> result = stability(rotor, [100.0, 400.0], supports=supports + inner)
    >>> result.stable.tolist()
    [True, False]
    """
    values = checks.ascending_from_zero(speeds, "speeds")
    check_options(tolerance, accuracy, method)
    checks.flag(progress, "progress")
    model = linear_model(target, supports=supports, body=body, stiffening=stiffening, axes=axes)
    warn_of_omissions(model, values[-1], WHAT)
    motions = motions_over(
        model, values, held=True, method=method, tolerance=tolerance, progress=progress,
        label="stability",
    )  # fmt: skip
    result = of_motions(model, Content.of(model), motions, accuracy)

    def told(row: int) -> str:
        worst = result._told(row, result.least_stable[row], Units.of("rpm"))
        return f"the least stable motion ({worst})"

    basis_error.warn(result.basis_errors, told, model, accuracy)
    return result


def of_motions(
    model: LinearModel, content: Content, motions: Motions, accuracy: float | None
) -> Stability:
    """Return the result of motions of a model, in each row the least stable motion first."""
    named = content.named(motions)
    keys = rounded(named.inertial), -rounded(named.motions.values.real, nan=-2.0)
    found = named.columns(np.lexsort(keys))
    errors = None if accuracy is None else basis_error.motion_errors(model, found, held=True)
    values, bounds = found.motions.values, found.motions.bounds
    growth = np.fmax.reduce(values.real, axis=1, initial=np.nan)
    moving = np.abs(values.real) > bounds[:, None]
    if errors is not None:
        rows = np.arange(len(values)), np.argmax(moving, axis=1)
        errors = np.where(moving, errors, np.nan)[rows]
    return Stability(
        speeds=found.motions.speeds,
        exponents=values.real + 1j * found.rotor,
        growth=growth,
        stable=growth <= bounds,
        bounds=bounds,
        frequencies_inertial=found.inertial,
        whirl_codes=found.codes,
        nodal_diameters=found.diameters,
        basis_errors=errors,
        stiffening=model.stiffening,
        axes=model.axes,
        unevenness=model.unevenness,
    )


def check_options(tolerance: float, accuracy: float | None, method: str = "auto") -> None:
    """Check the options that all analyses of stability have."""
    checks.choice(method, "method", METHODS)
    checks.tolerance(tolerance)
    checks.accuracy(accuracy)


@storable
@dataclass(frozen=True, eq=False)
class StabilityMap(OfMotions, Result):
    """Growth over two parameters; a point without values is NaN and not stable.

    Attributes
    ----------
    x, y : ndarray, shapes (a,), (b,)
    growth : ndarray, shape (a, b)
        Largest real part of the exponents [1/s], 0 where a free motion is neutral.
    stable : ndarray of bool, shape (a, b)
    least_stable_growth : ndarray, shape (a, b), or None
        Real part of the least stable motion that is not neutral [1/s], 0 where all are; it is what
        tables and pictures show. That of :attr:`growth` by default.
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
    least_stable_growth: np.ndarray | None = numbers("x", "y", finite=False, optional=True)

    @property
    def _shown(self) -> np.ndarray:
        """Growth of the motions that tables and pictures speak of, shape (a, b)."""
        return self.growth if self.least_stable_growth is None else self.least_stable_growth

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns, one row for each point.

        `units` are those of the frequency; x and y are as they were given.
        """
        shown = Units.of(units)
        first, second = self.labels
        return {
            first: np.repeat(self.x, len(self.y)),
            second: np.tile(self.y, len(self.x)),
            "growth [1/s]": self._shown.ravel(),
            "stable": self.stable.ravel(),
            f"inertial [{shown.frequency}]": shown.frequencies(self.frequencies_inertial).ravel(),
            "log decrement": self.log_decrement.ravel(),
            "whirl": self.whirl.ravel(),
            "kind": self.families.ravel(),
            **basis_column(self.basis_errors, self.growth.size),
        }

    def table(self) -> str:
        """Return the growth [1/s] at every point as lines of text; '*' marks instability.

        Free motions, which are neutral, do not count.
        """
        first, second = self.labels
        names = "".join(f"{value:13.5g} " for value in self.y)
        lines = [f"growth [1/s]; columns: {second}", f"{first:>24}{names}".rstrip()]
        marks = np.where(self.stable | np.isnan(self.growth), " ", "*")
        for value, growth, marked in zip(self.x, self._shown, marks, strict=True):
            entries = (f"{g:13.5g}{mark}" for g, mark in zip(growth, marked, strict=True))
            lines.append(f"{value:24.6g}" + "".join(entries).rstrip())
        if np.any(np.isfinite(self.growth)):
            at = np.unravel_index(np.nanargmax(self._shown), self.growth.shape)
            place = f"({self.x[at[0]]:.5g}, {self.y[at[1]]:.5g})"
            heard = f"{Units.of('Hz').frequencies(self.frequencies_inertial[at]):.5g} Hz"
            told = _in_words(self._shown[at], place, heard, self.whirl[at], self.log_decrement[at])
            lines.append(f"least stable: {self.families[at]} motion, {told}")
        if self.basis_errors is None:
            lines.append(NOT_KNOWN)
        elif np.any(self.basis_errors > 0.0):
            lines.append(f"basis error up to {np.nanmax(self.basis_errors):.1e}")
        return "\n".join(lines)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the growth as a contour plot, with the limit of stability as a line.

        An axis is logarithmic where its values are spaced so. Where one parameter has one value,
        the picture has coloured points.
        """
        ax = plotting.axes_or_new(ax)
        ax.set(xlabel=self.labels[0], ylabel=self.labels[1])
        ax.set_xscale("log" if _is_geometric(self.x) else "linear")
        ax.set_yscale("log" if _is_geometric(self.y) else "linear")
        neutral = np.where(self.stable, np.minimum(self._shown, 0.0), self._shown)
        growth = np.ma.masked_invalid(neutral).T
        largest = np.abs(growth).max() or 1.0
        style = {"cmap": "RdBu_r", "vmin": -largest, "vmax": largest}
        if min(self.growth.shape) == 1:  # contours need two values of each
            filled = ax.scatter(*np.meshgrid(self.x, self.y), c=growth.ravel(), **style)
        else:
            filled = ax.contourf(self.x, self.y, growth, 20, **style)
            if self.stable.any() and not self.stable.all():
                verdict = np.where(self.stable, -1.0, 1.0).T
                crossing = growth if growth.min() < -1e-6 * largest else verdict
                ax.contour(self.x, self.y, crossing, [0.0], colors="black", linewidths=1.2)
        ax.figure.colorbar(filled, ax=ax, label="growth [1/s]")
        return ax


def _in_words(growth: float, place: str, heard: str, whirl: str, decrement: float) -> str:
    """Return a motion in words: growth [1/s] and place, frequency, whirl, log decrement."""
    told = f"{growth:.4g} 1/s at {place}, {heard}, {whirl}"
    return f"{told}, log decrement {decrement:.3g}" if np.isfinite(decrement) else told


def _is_geometric(values: np.ndarray) -> bool:
    """Return whether values have one ratio, and not one difference."""
    if len(values) < 3 or values[0] <= 0.0:
        return False
    return bool(np.ptp(np.diff(np.log(values))) <= _EVEN)


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
    >>> from exudyn_rotor import Support, linear_model, rotor_example, stability_map
    >>> rotor = rotor_example().reduce(1)  # two masses of 2 kg on a rod
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
    grid = [checks.ascending(values, name) for values, name in ((x, "x"), (y, "y"))]
    shape = len(grid[0]), len(grid[1])
    refused, alike = [], {}
    for at in tqdm(list(np.ndindex(*shape)), desc="stability map", disable=not progress):
        point = float(grid[0][at[0]]), float(grid[1][at[1]])
        try:
            model, speed = _built(build, point)
            one = at, model, speed, model.coefficients(speed)
        except ValueError as error:
            refused.append((f"({point[0]:.5g}, {point[1]:.5g})", error))
        else:
            alike.setdefault((*model.pattern, speed == 0.0), []).append(one)
    warn_of_refused(refused, shape[0] * shape[1])
    models = [points[0][1] for points in alike.values()]
    warn_of_omissions(max(models, key=lambda one: one.has_structural_damping), what=WHAT)
    corners = itertools.product(*((0, size - 1) for size in shape))
    judged = {*corners, (shape[0] // 2, shape[1] // 2)}
    grids, errors = {}, np.full(shape, np.nan)
    for points in alike.values():
        places, models, speeds, coefficients = zip(*points, strict=True)
        model, content = models[0], Content.of(models[0])
        stack = model.at_points(np.array(speeds), coefficients)
        motions = motions_in(model, stack, "auto", tolerance, held=True)
        found, at = of_motions(model, content, motions, None), tuple(np.array(places).T)
        growth = np.where(np.abs(found.growth) <= found.bounds, 0.0, found.growth)
        told = least_stable(found) | {"growth": growth, "stable": found.stable}
        for name, values in told.items():
            grids.setdefault(name, np.full(shape, _NOTHING.get(name, np.nan)))[at] = values
        for row, place in enumerate(places):
            if place in judged and basis_error.is_known(models[row], accuracy):
                alone = of_motions(models[row], content, motions[[row]], accuracy)
                errors[place] = alone.basis_errors[0]
    basis_error.warn(
        errors,
        lambda a, b: f"the least stable motion at ({grid[0][a]:.5g}, {grid[1][b]:.5g})",
        models[0],
        accuracy,
    )
    known = not np.all(np.isnan(errors))
    return StabilityMap(*grid, labels=names, basis_errors=errors if known else None, **grids)


def _built(build: Callable, point: tuple[float, float]) -> tuple[LinearModel, float]:
    """Return the model and the speed of a point."""
    built = build(*point)
    if not isinstance(built, tuple) or len(built) != 2:
        raise TypeError(
            "build: needs to return a target of stability and the speed, got " + checks.shown(built)
        )
    speed = checks.number(built[1], "build: the speed it returns", "rad/s", least=0.0)
    return linear_model(built[0]), speed
