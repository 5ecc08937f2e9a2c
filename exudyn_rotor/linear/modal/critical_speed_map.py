"""Critical speeds over the stiffness of supports."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike
from tqdm import tqdm

from exudyn_rotor import checks, plotting
from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.bearings.given import Given, given_supports
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.modal.basis_error import is_known, points
from exudyn_rotor.linear.modal.critical_speeds import (
    CriticalSpeeds,
    checked,
    collected,
    warn_of_critical,
)
from exudyn_rotor.linear.modal.resonance import NO_EQUATIONS, Search
from exudyn_rotor.linear.modal.whirl import BACKWARD, FORWARD, WHIRLS
from exudyn_rotor.linear.model.build import linear_model, warn_of_left_out_stiffening
from exudyn_rotor.linear.model.linear_model import AXES, warn_of_refused
from exudyn_rotor.linear.over import ModelResult, basis_column, table_lines
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.results import numbers, storable
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.stiffening import CHOICES
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_CURVE = 200  # speeds of a bearing's own curve
_FILM = 1e-3  # error of a critical speed on films


@storable
@dataclass(frozen=True, eq=False)
class CriticalSpeedMap(ModelResult):
    """Critical speeds over the stiffness of supports.

    Attributes
    ----------
    stiffnesses : ndarray, shape (s,)
        [N/m]
    speeds : ndarray, shape (s, c)
        Critical speeds at every stiffness, ascending; NaN where there are fewer [rad/s].
    whirl_codes : ndarray of int, shape (s, c)
        Index into :attr:`CriticalSpeeds.whirl` words; −1 where the speed is NaN.
    order : float
    basis_errors : ndarray, shape (s, c), or None
        Estimated relative errors by the basis of a reduced rotor, at the first, the middle and the
        last stiffness, NaN as in :class:`CriticalSpeeds`; None where they are not known.
    bearing_speeds : ndarray, shape (b,), or None
        Speeds at which the stiffness of a given bearing is known [rad/s].
    bearing_stiffnesses : ndarray, shape (b, 2), or None
        Its direct stiffnesses k11 and k22 there [N/m].
    stiffening, axes, unevenness
        See :class:`Stability`.

    Examples
    --------
    >>> from exudyn_rotor import CriticalSpeedMap
    >>> print(CriticalSpeedMap([1e4, 4e4], [[50.0], [100.0]], [[0], [0]], 1.0).table())
    undamped critical speeds of order 1
    stiffness [N/m]  critical speed [rpm]  whirl
              10000               477.465  forward
              40000                954.93  forward
    error of the basis: not known
    """

    stiffnesses: np.ndarray = numbers("stiffnesses")
    speeds: np.ndarray = numbers("stiffnesses", "speeds", finite=False)
    whirl_codes: np.ndarray = numbers(
        "stiffnesses", "speeds", dtype=int, least=-1, most=len(WHIRLS) - 1
    )
    order: float
    basis_errors: np.ndarray | None = numbers("stiffnesses", "speeds", finite=False, optional=True)
    bearing_speeds: np.ndarray | None = numbers("points", optional=True)
    bearing_stiffnesses: np.ndarray | None = numbers("points", 2, optional=True)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns, one row for each critical speed; see :meth:`table`."""
        shown = Units.of(units)
        rows, places = np.nonzero(self.whirl_codes >= 0)
        errors = self.basis_errors
        errors = None if errors is None else errors[rows, places]
        return {
            "stiffness [N/m]": self.stiffnesses[rows],
            f"critical speed [{shown.speed}]": shown.speeds(self.speeds[rows, places]),
            "whirl": np.array(WHIRLS)[self.whirl_codes[rows, places]],
            **basis_column(errors, len(rows)),
        }

    def table(self, *, units: str = "rpm") -> str:
        """Return the critical speeds at every stiffness as lines of text.

        Parameters
        ----------
        units : {'rpm', 'Hz', 'SI'}
            'SI' rad/s.
        """
        lines = [f"undamped critical speeds of order {self.order:g}"]
        lines += table_lines(self.columns(units))
        return "\n".join([*lines, *self._closing(self.basis_errors)])

    def plot(self, ax: Axes | None = None, *, units: str = "rpm") -> Axes:
        """Draw the critical speeds over the stiffness, both logarithmic, as lines.

        A bearing is drawn by its own direct stiffnesses over the speed. `units` are those of
        :meth:`table`.
        """
        shown = Units.of(units)
        ax = plotting.axes_or_new(ax)
        styles = {FORWARD: (plotting.COLORS[0], "o"), BACKWARD: (plotting.COLORS[1], "v")}
        for code in np.unique(self.whirl_codes[self.whirl_codes >= 0]):
            color, marker = styles.get(int(code), (plotting.COLORS[2], "s"))
            # the first, second, … of a whirl at each stiffness make a line; NaN are sorted last
            drawn = np.sort(np.where(self.whirl_codes == code, shown.speeds(self.speeds), np.nan))
            handles = ax.loglog(self.stiffnesses, drawn, marker + "-", color=color, ms=3.5, lw=0.9)
            handles[0].set_label(WHIRLS[code])
        if self.bearing_speeds is not None:
            for column, style in enumerate(("--", ":")):
                ax.loglog(
                    self.bearing_stiffnesses[:, column], shown.speeds(self.bearing_speeds), style,
                    color="0.3", lw=1.2, label=f"bearing, k{column + 1}{column + 1}",
                )  # fmt: skip
        ends = self.stiffnesses.min(), self.stiffnesses.max()
        if ends[0] < ends[1]:  # also where no critical speed is found
            room = (ends[1] / ends[0]) ** 0.05
            ax.set_xlim(ends[0] / room, ends[1] * room)
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
    bearing: Given | None = None,
    stiffening: str = "auto",
    axes: str = "auto",
    accuracy: float | None = 1e-2,
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
    order, max_speed, nodal_diameters, stiffening, axes, accuracy
        See :func:`critical_speeds`; the basis is looked at at the first, the middle and the last
        stiffness.
    bearing : Support or bearing, optional
        One whose own stiffness over the speed is drawn beside the critical speeds: these meet it
        where they are those of the rotor on such bearings.
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
    given = checked(order, max_speed, nodal_diameters)
    checks.choice(stiffening, "stiffening", CHOICES)
    checks.choice(axes, "axes", AXES)
    checks.accuracy(accuracy)
    checks.flag(progress, "progress")
    if bearing is not None:
        checks.instance(bearing, "bearing", (Support, Bearing, MagneticBearing))
    kept = given_supports(supports)
    first = linear_model(
        target, supports=_with(kept, names, values[0]), foundation=foundation,
        stiffening=stiffening, axes=axes,
    ).undamped()  # fmt: skip
    judged = set() if accuracy is None else set(points(len(values)).tolist())
    solved: dict[int, CriticalSpeeds] = {}
    failed: list[tuple[str, Exception]] = []
    for row, stiffness in enumerate(tqdm(values, "critical speed map", disable=not progress)):
        model = replace(first, supports={"": _with(kept, names, stiffness)})
        # a map takes what a film is within its own smoothness
        search = Search(model, *given, 1e-7 if model.table_speeds.size else _FILM)
        try:
            solved[row] = collected(search, row in judged)
        except ValueError as error:  # as of a support whose stiffness is negative
            failed.append((f"{stiffness:.4g} N/m", error))
    warn_of_refused(failed, len(values))
    search.warn()
    shape = len(values), max(len(entry.speeds) for entry in solved.values())
    speeds, errors, codes = np.full(shape, np.nan), np.full(shape, np.nan), np.full(shape, -1)
    for row, entry in solved.items():
        count = len(entry.speeds)
        speeds[row, :count] = entry.speeds
        codes[row, :count] = [WHIRLS.index(word) for word in entry.whirl]
        if entry.basis_errors is not None:
            errors[row, :count] = entry.basis_errors
    if np.any(speeds > 0.0):
        warn_of_left_out_stiffening(first, max_speed or np.nanmin(speeds))
    known = is_known(first, accuracy)
    if known:
        warn_of_critical(first, speeds, errors, accuracy)
    top = max_speed or float(np.nanmax(speeds, initial=1.0))
    own = (None, None) if bearing is None else _curve(bearing, top)
    return CriticalSpeedMap(
        values,
        speeds,
        codes,
        order,
        basis_errors=errors if known else None,
        bearing_speeds=own[0],
        bearing_stiffnesses=own[1],
        stiffening=first.stiffening,
        axes=first.axes,
        unevenness=first.unevenness,
    )


def _with(supports: tuple[Given, ...], names: Sequence[str], stiffness: float) -> tuple[Given, ...]:
    return (*supports, *(Support(name, float(stiffness)) for name in names))


def _curve(bearing: Given, top: float) -> tuple[np.ndarray, np.ndarray]:
    """Return speeds up to the largest [rad/s], and the direct stiffnesses (b, 2) of a bearing."""
    one = bearing if isinstance(bearing, Support) else bearing.linearised()
    if not isinstance(one, Support):  # it has states of its own
        one = Support(one.interface, one.static_stiffness)
    speeds, stiffnesses = [], []
    for speed in np.linspace(top / _CURVE, top, _CURVE).tolist():
        try:
            one.check_range(speed)
            stiffnesses.append(np.diag(one.matrices(speed)[0])[:2])
            speeds.append(speed)
        except NO_EQUATIONS:
            continue
    return np.array(speeds), np.array(stiffnesses).reshape(-1, 2)
