"""Critical speeds over the stiffness of supports."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from exudyn_rotor import checks, plotting
from exudyn_rotor.bearings.given import Given, given_supports
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear import options
from exudyn_rotor.linear.modal import excitation
from exudyn_rotor.linear.modal.critical_speeds import (
    CriticalSpeeds,
    checked,
    critical_speeds_of,
    warn_of_critical,
)
from exudyn_rotor.linear.modal.whirl import BACKWARD, FORWARD, WHIRLS, WhirlContent
from exudyn_rotor.linear.models.basis.basis_error import NOT_KNOWN, BasisError, in_table
from exudyn_rotor.linear.models.linear_model import linear_model
from exudyn_rotor.linear.models.protocol import LinearModel
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.results import Result, numbers, storable
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.sweep import sweep
from exudyn_rotor.theory.stiffening import CHOICES, LEVELS
from exudyn_rotor.units import Units


@storable
@dataclass(frozen=True, eq=False)
class CriticalSpeedMap(Result):
    """Critical speeds over the stiffness of supports.

    Attributes
    ----------
    stiffnesses : ndarray, shape (s,)
        [N/m]
    speeds : ndarray, shape (s, c)
        Critical speeds at every stiffness, ascending; NaN where there are fewer [rad/s]. A pair
        that an uneven mesh splits is there once, as in :class:`CriticalSpeeds`.
    whirl_codes : ndarray of int, shape (s, c)
        Index into :data:`exudyn_rotor.linear.modal.whirl.WHIRLS`; −1 where the speed is NaN.
    order : float
    stiffening : str or None
        Level of centrifugal stiffening, 'none', 'tilt' or 'full'; None where it is not known.
    basis_errors : ndarray, shape (s, c), or None
        Estimated relative errors by the basis of a reduced rotor, NaN as in
        :class:`CriticalSpeeds`; None where they are not known.

    Examples
    --------
    >>> from exudyn_rotor import CriticalSpeedMap
    >>> print(CriticalSpeedMap([1e4, 4e4], [[50.0], [100.0]], [[0], [0]], 1.0).table())
    undamped critical speeds of order 1 [rad/s]
      stiffness [N/m]
      10000            50 forward
      40000            100 forward
    error of the basis: not known
    """

    stiffnesses: np.ndarray = numbers("stiffnesses")
    speeds: np.ndarray = numbers("stiffnesses", "speeds", finite=False)
    whirl_codes: np.ndarray = numbers(
        "stiffnesses", "speeds", dtype=int, least=-1, most=len(WHIRLS) - 1
    )
    order: float
    stiffening: str | None = None
    basis_errors: np.ndarray | None = numbers("stiffnesses", "speeds", finite=False, optional=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.stiffening is not None:
            checks.choice(self.stiffening, "stiffening", LEVELS)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns, one row for each critical speed; see :meth:`table`."""
        shown = Units.of(units)
        rows, places = np.nonzero(self.whirl_codes >= 0)
        errors = self.basis_errors
        return {
            "stiffness [N/m]": self.stiffnesses[rows],
            f"critical speed [{shown.speed}]": shown.speeds(self.speeds[rows, places]),
            "whirl": np.array(WHIRLS)[self.whirl_codes[rows, places]],
            "basis error": np.full(len(rows), np.nan) if errors is None else errors[rows, places],
        }

    def table(self, *, units: str = "SI") -> str:
        """Return the critical speeds at every stiffness as lines of text.

        Parameters
        ----------
        units : {'SI', 'rpm', 'Hz'}
            'SI' rad/s.
        """
        shown = Units.of(units)
        lines = [
            f"undamped critical speeds of order {self.order:g} [{shown.speed}]",
            "  stiffness [N/m]",
        ]
        errors = self.basis_errors
        reduced = errors is not None and np.nansum(errors) > 0.0
        for i, (stiffness, speeds, codes) in enumerate(
            zip(self.stiffnesses, shown.speeds(self.speeds), self.whirl_codes, strict=True)
        ):
            entries = (
                f"{speed:.6g} {WHIRLS[code]}"
                for speed, code in zip(speeds, codes, strict=True)
                if code >= 0
            )
            lines.append(f"  {stiffness:<15.6g}  " + (", ".join(entries) or "none"))
            if reduced and not np.all(np.isnan(errors[i])):
                lines[-1] += f" (basis error up to {in_table(np.nanmax(errors[i]))})"
        if self.stiffening:
            lines.append(f"stiffening: {self.stiffening}")
        return "\n".join(lines if errors is not None else [*lines, NOT_KNOWN])

    def plot(
        self,
        ax: Axes | None = None,
        *,
        units: str = "Hz",
        operating_range: ArrayLike | None = None,
        margins: ArrayLike | None = None,
    ) -> Axes:
        """Draw the critical speeds over the stiffness, both logarithmic.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            A new figure by default.
        units : {'Hz', 'rpm', 'SI'}
        operating_range, margins : two floats, optional
            Shaded; see :meth:`Campbell.plot`.
        """
        shown = Units.of(units)
        limits = excitation.checked_range(operating_range)
        shares = excitation.checked_margins(margins, limits is not None)
        ax = plotting.axes_or_new(ax)
        styles = {FORWARD: (plotting.COLORS[0], "o"), BACKWARD: (plotting.COLORS[1], "v")}
        for code in np.unique(self.whirl_codes[self.whirl_codes >= 0]):
            color, marker = styles.get(int(code), (plotting.COLORS[2], "s"))
            drawn = np.where(self.whirl_codes == code, shown.speeds(self.speeds), np.nan)
            lines = ax.loglog(self.stiffnesses, drawn, marker, color=color, ms=3.5)
            lines[0].set_label(WHIRLS[code])
        ends = self.stiffnesses.min(), self.stiffnesses.max()
        if ends[0] < ends[1]:  # also where no critical speed is found
            room = (ends[1] / ends[0]) ** 0.05
            ax.set_xlim(ends[0] / room, ends[1] * room)
        if limits is not None:
            excitation.shade_range(ax, limits, shares, shown, across=True)
        ax.set_xlabel("support stiffness [N/m]")
        ax.set_ylabel(f"undamped critical speed of order {self.order:g} [{shown.speed}]")
        ax.grid(alpha=0.3, which="both")
        plotting.legend_above(ax, 4)
        return ax


def critical_speed_map(
    target: ReducedRotor | SolidRotor,
    interfaces: Sequence[str] | str,
    stiffnesses: ArrayLike,
    *,
    supports: Sequence[Given] | Given = (),
    foundation: Foundation | None = None,
    order: float = 1.0,
    max_speed: float | None = None,
    nodal_diameters: Sequence[int] = (1,),
    stiffening: str = "auto",
    accuracy: float | None = 1e-2,
    executor: Executor | None = None,
    progress: bool = False,
) -> CriticalSpeedMap:
    """Compute the undamped critical speeds over the stiffness of isotropic supports.

    Parameters
    ----------
    target : ReducedRotor or SolidRotor
    interfaces : str or sequence of str
        Where a support of each stiffness is put, the same at all of them.
    stiffnesses : array_like, shape (s,)
        Positive [N/m].
    supports : sequence of Support or bearings, optional
        Further supports that do not change; magnetic bearings by their static stiffness.
    foundation : Foundation, optional
        What carries all supports, as in :func:`linear_model`.
    order, max_speed, nodal_diameters, stiffening, accuracy
        See :func:`critical_speeds`.
    executor : concurrent.futures.Executor, optional
        Computes the stiffnesses.
    progress : bool, optional
        Show a progress bar.

    Raises
    ------
    ValueError
        For stiffnesses that are not positive and finite, or an interface that is unknown or given
        twice.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, critical_speed_map
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> critical_speed_map(rotor, ["left", "right"], [5e3, 2e4]).speeds.round(6)
    array([[ 50.,  50.,  50.,  50.],
           [100., 100., 100., 100.]])
    """
    checks.instance(target, "target", (ReducedRotor, SolidRotor))
    values = np.atleast_1d(checks.array(stiffnesses, "stiffnesses", "N/m"))
    if values.ndim != 1 or values.size == 0 or np.any(values <= 0.0):
        raise ValueError(
            "stiffnesses: needs positive finite numbers [N/m], got " + checks.shown(stiffnesses)
        )
    names = checks.different(
        checks.labels(interfaces, "interfaces", target.interfaces), "interfaces"
    )
    if not names:
        raise ValueError("interfaces: needs at least one name, got none")
    supports = tuple(map(_made_once, given_supports(supports)))
    order, max_speed, waves = checked(order, max_speed, nodal_diameters)
    checks.choice(stiffening, "stiffening", CHOICES)
    options.check_basis_accuracy(accuracy)
    options.check_sweep(executor, progress)
    made = partial(linear_model, target, foundation=foundation, stiffening=stiffening)
    model = made(supports=supports).undamped()
    basis = BasisError.of(model, accuracy)
    content = WhirlContent.of(model)
    given = {"content": content, "order": order, "waves": waves, "max_speed": max_speed}
    task = partial(_at_stiffness, made, names, supports, given, accuracy)
    solved = sweep(task, values, executor=executor, progress=progress, label="critical speed map")
    most = max(len(entry.speeds) for entry in solved)
    speeds, codes = np.full((len(values), most), np.nan), np.full((len(values), most), -1)
    errors = np.full((len(values), most), np.nan) if basis.is_known else None
    for row, entry in enumerate(solved):
        count = len(entry.speeds)
        speeds[row, :count] = entry.speeds
        codes[row, :count] = [WHIRLS.index(word) for word in entry.whirl]
        if errors is not None:
            errors[row, :count] = entry.basis_errors
    result = CriticalSpeedMap(
        values,
        speeds,
        codes.astype(np.int64),
        order,
        stiffening=solved[0].stiffening,
        basis_errors=errors,
    )
    if errors is not None:
        warn_of_critical(basis, speeds, errors)
    return result


def _made_once(given: Given) -> Given:
    """Return a bearing as the support that it is for all stiffnesses, if it is one."""
    if isinstance(given, MagneticBearing | Support):
        return given
    made = given.linearised()
    return made if isinstance(made, Support) else given


def _at_stiffness(
    made: Callable[..., LinearModel],
    names: tuple[str, ...],
    supports: tuple[Given, ...],
    given: dict,
    accuracy: float | None,
    stiffness: float,
) -> CriticalSpeeds:
    varied = tuple(Support(name, stiffness) for name in names)
    model = made(supports=supports + varied).undamped()
    return critical_speeds_of(model, **given, basis=BasisError.of(model, accuracy))
