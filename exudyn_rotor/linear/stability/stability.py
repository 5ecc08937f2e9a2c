"""Stability of a rotor on its supports over the spin speed.

The exponents λ of all motions are eigenvalues where the equations are constant, as of a round rotor
on any supports, or of an uneven one on supports alike in all directions, else Floquet exponents
(:mod:`exudyn_rotor.linear.solve`). A rotor is stable where no motion grows by more than rounding.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks, plotting
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.linear.modal import basis_error
from exudyn_rotor.linear.modal.whirl import (
    FAMILIES,
    WHIRLS,
    Content,
    damping_of,
    families,
    rounded,
)
from exudyn_rotor.linear.model.build import (
    Target,
    linear_model,
    warn_of_left_out_stiffening,
    warn_of_structural_damping,
)
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.over import ModelResult, basis_column, motions_over, table_lines
from exudyn_rotor.linear.solve.motions import METHODS, Motions
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.results import numbers, storable
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SHOWN = 4.0  # times the strongest decay of lateral motions: what is drawn reaches down to there
WHAT = "stability finds exponents"  # of structural damping, for the warning


@storable
@dataclass(frozen=True, eq=False)
class Stability(ModelResult):
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
        Largest share of a rotor that differs around its axis and is averaged over a turn.

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
    def whirl(self) -> np.ndarray:
        """Sense of every motion, shape as exponents; the words of :attr:`Campbell.whirl`."""
        return np.array(WHIRLS)[self.whirl_codes]

    @property
    def families(self) -> np.ndarray:
        """Kind of every motion, shape as exponents.

        'lateral', 'torsional', 'axial', 'disc' (two nodal diameters and more), 'foundation', or
        'other'.
        """
        return families(self.whirl_codes, self.nodal_diameters)

    @property
    def log_decrement(self) -> np.ndarray:
        """``−2π Re λ / ω`` at the inertial frequency ω; NaN for motions that do not oscillate."""
        return damping_of(self.exponents.real, self.frequencies_inertial)[1]

    @property
    def _moving(self) -> np.ndarray:
        """Whether motions grow or decay by more than rounding, shape (s, k)."""
        return np.abs(self.exponents.real) > self.bounds[:, None]

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
        growth = np.where(self._moving, self.exponents.real, 0.0)
        own = (self.families == family) & ~np.isnan(self.exponents)
        largest = np.where(own, growth, -np.inf).max(axis=1, initial=-np.inf)
        return np.where(np.isfinite(largest), largest, np.nan)

    def least_stable_of(self, family: str) -> tuple[int, int] | None:
        """Return row and column of a family's least stable motion over all speeds.

        The first of several that are one but for their bounds; None where the family has no motion,
        or only neutral ones.

        Parameters
        ----------
        family : {'lateral', 'torsional', 'axial', 'disc', 'other', 'foundation'}
        """
        checks.choice(family, "family", FAMILIES)
        told = (self.families == family) & self._moving
        if not np.any(told):
            return None
        growth = np.where(told, self.exponents.real, -np.inf)
        largest = growth.max() - np.nanmax(self.bounds)
        row, column = np.unravel_index(np.argmax(growth >= largest), growth.shape)
        return int(row), int(column)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns; `units` are those of :meth:`plot`.

        Where all motions are neutral none is the least stable: no growth, frequency NaN, '-'.
        """
        shown = Units.of(units)
        rows, none = (np.arange(len(self.speeds)), self.least_stable), ~self._moving.any(axis=1)
        heard = np.where(none, np.nan, shown.frequencies(self.frequencies_inertial[rows]))
        growth = np.where(none & np.isfinite(self.growth), 0.0, self.exponents[rows].real)
        return {
            f"speed [{shown.speed}]": shown.speeds(self.speeds),
            "growth [1/s]": growth,
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
            found = self.least_stable_of(family)
            if found is not None:
                lines.append(f"least stable {family} motion: {self._told(found, shown)}")
        return "\n".join([*lines, *self._closing(self.basis_errors)])

    def _told(self, at: tuple[int, int], shown: Units) -> str:
        """Return a motion in words: growth, speed, frequency, whirl, log decrement."""
        speed, n = shown.speeds(self.speeds[at[0]]), self.nodal_diameters[at]
        parts = [
            f"{self.exponents[at].real:.4g} 1/s at {speed:.6g} {shown.speed}",
            f"{shown.frequencies(self.frequencies_inertial[at]):.5g} {shown.frequency}",
            f"{self.whirl[at]}" + (f", n = {n}" if n >= 0 else ""),
        ]
        if np.isfinite(self.log_decrement[at]):
            parts.append(f"log decrement {self.log_decrement[at]:.3g}")
        return ", ".join(parts)

    def plot(self, ax: Axes | None = None, *, units: str = "rpm") -> Axes:
        """Draw the growth over the spin speed, of each family and of the least stable motion.

        Unstable speeds are shaded; the picture ends below the strongest decay of lateral motions,
        which others would hide. `units` are 'rpm', 'Hz' or 'SI', rad/s.
        """
        shown = Units.of(units)
        ax = plotting.axes_or_new(ax)
        speeds = shown.speeds(self.speeds)
        found = {family: self.growth_of(family) for family in FAMILIES}
        moving = [growth for growth in found.values() if np.any(np.nan_to_num(growth))]
        if moving:  # others are free or rest at all speeds
            ax.plot(speeds, np.fmax.reduce(moving), color="0.8", lw=6.0, label="least stable")
        for (family, growth), color in zip(found.items(), plotting.COLORS, strict=True):
            if not np.all(np.isnan(growth)):
                ax.plot(speeds, growth, ".-", color=color, lw=1.3, label=family)
        drawn = [growth for growth in found.values() if not np.all(np.isnan(growth))] or [0.0]
        low, high = np.nanmin(drawn), np.nanmax(drawn)
        lateral = np.fmin.reduce(found["lateral"], initial=0.0)
        low = max(low, _SHOWN * lateral) if lateral < 0.0 else low
        room = 0.05 * (high - low) or 1.0
        limits = low - room, high + room
        shade = {"where": self.growth > self.bounds, "color": plotting.COLORS[1], "alpha": 0.2}
        ax.fill_between(speeds, *limits, lw=0.0, **shade)
        ax.set_ylim(limits)
        ax.axhline(0.0, color="0.3", lw=0.8)
        ax.set_xlabel(f"spin speed [{shown.speed}]")
        ax.set_ylabel("largest growth [1/s]")
        ax.grid(alpha=0.3)
        plotting.legend_above(ax, 4)
        return ax


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
    values = checks.ascending_from_zero(speeds, "speeds")
    check_options(tolerance, accuracy, method)
    checks.flag(progress, "progress")
    model = linear_model(target, supports=supports, body=body, stiffening=stiffening, axes=axes)
    warn_of_structural_damping(model, WHAT)
    warn_of_left_out_stiffening(model, values[-1])
    motions = motions_over(
        model, values, held=True, method=method, tolerance=tolerance, progress=progress,
        label="stability",
    )  # fmt: skip
    result = of_motions(model, Content.of(model), motions, accuracy)
    if result.basis_errors is not None:
        _warn_of_basis(result, model, accuracy)
    return result


def of_motions(
    model: LinearModel, content: Content, motions: Motions, accuracy: float | None
) -> Stability:
    """Return the result of motions of a model, in each row the least stable motion first."""
    named = content.named(motions)
    errors = None if accuracy is None else basis_error.motion_errors(model, named, held=True)
    keys = rounded(named.inertial), -rounded(named.motions.values.real, nan=-2.0)
    order = np.lexsort(keys)
    found = named.columns(order)
    values, bounds = found.motions.values, found.motions.bounds
    growth = np.fmax.reduce(values.real, axis=1, initial=np.nan)
    moving = np.abs(values.real) > bounds[:, None]
    if errors is not None:
        first = np.argmax(moving, axis=1)[:, None]  # the least stable one
        errors = np.take_along_axis(np.take_along_axis(errors, order, 1), first, 1)[:, 0]
        errors = np.where(moving.any(axis=1), errors, np.nan)
    return Stability(
        speeds=found.motions.speeds,
        exponents=values.real + 1j * np.where(np.isnan(values), np.nan, found.rotor),
        growth=growth,
        stable=growth <= bounds,
        bounds=bounds,
        frequencies_inertial=np.where(np.isnan(values), np.nan, found.inertial),
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


def least_stable_of(motions: Motions) -> np.ndarray:
    """Return which motion is the least stable one of those that are not neutral, (s,)."""
    growth = motions.values.real
    moves = np.abs(growth) > motions.bounds[:, None]
    return np.argmax(rounded(np.where(moves, growth, np.nan), nan=-2.0), axis=1)


def _warn_of_basis(result: Stability, model: LinearModel, accuracy: float) -> None:
    """Warn where the basis leaves out too much for the growth of a least stable motion."""
    row, shown = int(np.argmax(np.nan_to_num(result.basis_errors))), Units.of("rpm")
    at = row, result.least_stable[row]
    heard, speed = shown.frequencies(result.frequencies_inertial[at]), result.speeds[row]
    motion = f"the least stable motion ({result.whirl[at]}, {heard:.4g} Hz)"
    what = f"{motion} at {shown.speeds(speed):.5g} rpm"
    basis_error.warn(result.basis_errors, what, model, accuracy)
