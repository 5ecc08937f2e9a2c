"""Critical speeds of a rotor, also over the stiffness of its supports.

The equations are in :mod:`exudyn_rotor.linear.modal.resonance`.
"""

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
from exudyn_rotor.linear.modal import basis_error
from exudyn_rotor.linear.modal.resonance import Search, Stiffness, groups_of
from exudyn_rotor.linear.modal.whirl import BACKWARD, FORWARD, WHIRLS, signed_diameters
from exudyn_rotor.linear.model.assembly import NO_EQUATIONS
from exudyn_rotor.linear.model.build import Target, linear_model, warn_of_omissions
from exudyn_rotor.linear.model.linear_model import warn_of_refused
from exudyn_rotor.linear.over import ModelResult, basis_column, table_lines
from exudyn_rotor.linear.solve.motions import Motions
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.results import numbers, storable, words
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.solvers.factor import one_thread
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_JUDGED = 6  # critical speeds that count where no largest speed is given
_ALIKE = 0.5  # likeness of two shapes below which they are not the same motion
_CURVE = 200  # speeds of a bearing's own curve


class _Undamped(ModelResult):
    """Base of results of critical speeds of one order."""

    def table(self, *, units: str = "rpm") -> str:
        """Return the critical speeds as lines of text.

        Parameters
        ----------
        units : {'rpm', 'Hz', 'SI'}
            'SI' rad/s.
        """
        lines = [f"undamped critical speeds of order {self.order:g}"]
        lines += table_lines(self.columns(units)) if np.any(self.speeds > 0.0) else ["none"]
        return "\n".join([*lines, *self._closing(self.basis_errors)])

    def _told(self, *at: int) -> str:
        """Return a critical speed in words."""
        return f"the critical speed of {Units.of('rpm').speeds(self.speeds[at]):.5g} rpm"


@storable
@dataclass(frozen=True, eq=False)
class CriticalSpeeds(_Undamped):
    """Critical speeds, ascending; an uneven rotor has both of a pair.

    Attributes
    ----------
    order : float
        Excitation order p: the excitation has the frequency pΩ in the inertial frame.
    speeds : ndarray, shape (c,)
        [rad/s]
    frequencies_rotor : ndarray, shape (c,)
        Frequency of the motion in the rotor frame [rad/s].
    whirl : tuple of str
        Words of :attr:`Campbell.whirl`; unbalance alone excites no purely backward mode.
    nodal_diameters : ndarray of int, shape (c,)
    vectors : ndarray, shape (k, c)
        Mode shapes in the coordinates of the model, unit length; the strongest harmonic.
    basis_errors : ndarray, shape (c,), or None
        Estimated relative errors by the basis of a reduced rotor; NaN above the lowest six where
        no largest speed was given, None where they are not known.
    stiffening, axes, unevenness
        See :class:`Stability`; :attr:`vectors` are in these axes.

    Examples
    --------
    >>> from exudyn_rotor import CriticalSpeeds
    >>> result = CriticalSpeeds(1.0, [100.0], [0.0], ("forward",), [1], [[1.0]])
    >>> print(result.table())
    undamped critical speeds of order 1
    critical speed [rpm]  inertial [Hz]  rotor frame [Hz]  n  whirl
                  954.93        15.9155                 0  1  forward
    error of the basis: not known
    """

    order: float
    speeds: np.ndarray = numbers("speeds")
    frequencies_rotor: np.ndarray = numbers("speeds")
    whirl: tuple[str, ...] = words("speeds")
    nodal_diameters: np.ndarray = numbers("speeds", dtype=int, least=-1)
    vectors: np.ndarray = numbers("coordinates", "speeds", dtype=complex)
    basis_errors: np.ndarray | None = numbers("speeds", finite=False, optional=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.labels(self.whirl, "whirl", WHIRLS)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns; `units` are those of :meth:`table`."""
        shown = Units.of(units)
        rotor = shown.frequencies(self.frequencies_rotor)
        return {
            f"critical speed [{shown.speed}]": shown.speeds(self.speeds),
            f"inertial [{shown.frequency}]": shown.frequencies(self.order * self.speeds),
            f"rotor frame [{shown.frequency}]": rotor,
            "nodal diameters": self.nodal_diameters,
            "whirl": np.array(self.whirl),
            **basis_column(self.basis_errors, len(self.whirl)),
        }

    @property
    def splits(self) -> None:
        """None: two planes of an averaged mesh have one critical speed."""


def critical_speeds(
    target: Target,
    *,
    supports: Sequence[Given] | Given = (),
    foundation: Foundation | None = None,
    body: RotorBody | Sequence[RotorBody] | None = None,
    order: float = 1.0,
    max_speed: float | None = None,
    nodal_diameters: Sequence[int] = (0, 1),
    stiffening: str = "auto",
    axes: str = "auto",
    accuracy: float | None = 1e-2,
) -> CriticalSpeeds:
    """Compute the undamped critical speeds of a rotor on supports, or of a scene.

    Damping, also structural, and the skew part of the supports' stiffness do not take part; in a
    scene the skew part of damping, as of an annular seal, does no work and stays.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, RotorTrain, exudyn.MainSystem or LinearModel
        See :func:`linear_model`.
    supports : sequence of Support or bearings, optional
        Of a rotor.
    foundation : Foundation, optional
        What carries them; the ground by default.
    body : RotorBody or sequence of RotorBody, optional
        The rotor in a scene, or all of several, see :func:`linear_model`.
    order : float, optional
        Excitation order p ≥ 0 in the inertial frame; 1 for unbalance, 0 for a load at rest.
    max_speed : float, optional
        Largest speed of interest [rad/s]; needed where a stiffness depends on the speed, as of
        tables, films, forces in scenes, an initial displacement: there zeros are bracketed at 200
        speeds up to it, and two of one mode that are closer than a 200th of it may be missed.
        Speeds beyond tables, and those at which a film carries nothing, are left out, with a
        warning.
    nodal_diameters : sequence of int, optional
        Which waves may be excited: 0 for axial and torsional motion, 1 for bending and tilting.
    stiffening : {'auto', 'none', 'tilt', 'full'}
    axes : {'auto', 'inertial', 'rotor'}
        Of the equations, see :func:`linear_model`.
    accuracy : float, optional
        Relative error of a critical speed by the basis of a reduced rotor, estimated, above which
        a warning is given. It looks at the speeds up to `max_speed`; without, at the lowest six.
        None for no estimate.

    Raises
    ------
    TypeError
        If the target, the body or a support is of another kind.
    ValueError
        For an order or speed that is negative or not finite, a missing `max_speed`, an unknown
        interface, or a support with a negative stiffness.

    Examples
    --------
    >>> from exudyn_rotor import Support, critical_speeds, rotor_example
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> print(critical_speeds(rotor, supports=supports, nodal_diameters=[1]).table())
    undamped critical speeds of order 1
    critical speed [rpm]  inertial [Hz]  rotor frame [Hz]  n  whirl
                  954.93        15.9155            31.831  1  backward
                  954.93        15.9155            31.831  1  backward
                  954.93        15.9155                 0  1  forward
                  954.93        15.9155                 0  1  forward
    stiffening: tilt
    """
    checks.accuracy(accuracy)
    model = linear_model(
        target, supports=supports, foundation=foundation, body=body, stiffening=stiffening,
        axes=axes,
    ).undamped()  # fmt: skip
    search = Search(model, order, nodal_diameters, max_speed)
    result = collected(search, accuracy is not None)
    search.warn()
    model.warn_beyond(result.order * result.speeds)
    if result.speeds.size:
        warn_of_omissions(model, max_speed or result.speeds[0])
    basis_error.warn(result.basis_errors, result._told, model, accuracy)
    return result


def collected(search: Search, estimate: bool) -> CriticalSpeeds:
    """Return the result of a search; errors by the basis where they are asked for.

    Critical speeds of one speed stand from backward to forward waves.
    """
    model, named = search.model, search.content.named(search.motions(), apart=True)
    senses = signed_diameters(named.codes, named.diameters)[:, 0]
    named = named.rows(np.lexsort((senses, groups_of(named.motions.speeds))))
    motions, errors = named.motions, None
    if estimate and basis_error.is_known(model, 1.0):
        errors = _basis_errors(search, motions)
    shapes = motions.main[:, :, 0].T
    return CriticalSpeeds(
        order=search.order,
        speeds=motions.speeds,
        frequencies_rotor=named.rotor[:, 0],
        whirl=tuple(WHIRLS[code] for code in named.codes[:, 0]),
        nodal_diameters=named.diameters[:, 0],
        vectors=shapes / np.maximum(np.linalg.norm(shapes, axis=0), 1e-300),
        stiffening=model.stiffening,
        basis_errors=errors,
        axes=model.axes,
        unevenness=model.unevenness,
    )


@one_thread()
def _basis_errors(search: Search, found: Motions) -> np.ndarray:
    """Return relative errors of the lowest critical speeds by the basis, NaN of others, (c,).

    Each motion is followed into the model with the shapes that the basis lacks.
    """
    model, errors = search.model, np.full(len(found.speeds), np.nan)
    judged = len(errors) if search.limit is not None else min(len(errors), _JUDGED)
    if model.is_full:
        errors[:judged] = 0.0
        return errors
    stiffness = Stiffness(model.richer, search.order)
    lifted = basis_error.lifting(model, model.richer)
    for row, speed in enumerate(found.speeds[:judged]):
        vectors, center = found.vectors[row, :, :, 0], found.values[row, 0].imag / speed
        held = np.any(vectors, axis=1)  # the harmonics that it was found with
        x = vectors[held] @ lifted.T
        try:
            better, y = stiffness.refined(speed, x, center + found.orders[held])
        except NO_EQUATIONS:
            continue
        likeness = abs(np.vdot(x, y)) ** 2 / (np.vdot(x, x) * np.vdot(y, y)).real
        if likeness > _ALIKE:
            errors[row] = abs(better / speed - 1.0)
    return errors


@storable
@dataclass(frozen=True, eq=False)
class CriticalSpeedMap(_Undamped):
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
    >>> from exudyn_rotor import Support, critical_speed_map, rotor_example
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
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
    checks.accuracy(accuracy)
    checks.flag(progress, "progress")
    if bearing is not None:
        checks.instance(bearing, "bearing", (Support, Bearing, MagneticBearing))
    kept = given_supports(supports)
    first = linear_model(
        target, supports=_with(kept, names, values[0]), foundation=foundation,
        stiffening=stiffening, axes=axes,
    ).undamped()  # fmt: skip
    judged = basis_error.points(len(values)) if basis_error.is_known(first, accuracy) else []
    solved: list[CriticalSpeeds | None] = []
    failed: list[tuple[str, Exception]] = []
    for row, stiffness in enumerate(tqdm(values, "critical speed map", disable=not progress)):
        model = replace(first, supports={"": _with(kept, names, stiffness)})
        search = Search(model, order, nodal_diameters, max_speed)
        try:
            solved.append(collected(search, row in judged))
        except ValueError as error:  # as of a support whose stiffness is negative
            solved.append(None)
            failed.append((f"{stiffness:.4g} N/m", error))
    warn_of_refused(failed, len(values))
    search.warn()
    shape = len(values), max(len(entry.speeds) for entry in solved if entry)
    speeds, errors, codes = np.full(shape, np.nan), np.full(shape, np.nan), np.full(shape, -1)
    for row, entry in enumerate(solved):
        if entry:
            here = row, slice(len(entry.speeds))
            speeds[here], codes[here] = entry.speeds, [WHIRLS.index(word) for word in entry.whirl]
            errors[here] = np.nan if entry.basis_errors is None else entry.basis_errors
    if np.any(speeds > 0.0):
        warn_of_omissions(first, max_speed or np.nanmin(speeds))
    top = max_speed or float(np.nanmax(speeds, initial=1.0))
    own = (None, None) if bearing is None else _curve(bearing, top)
    result = CriticalSpeedMap(
        values,
        speeds,
        codes,
        order,
        basis_errors=errors if len(judged) else None,
        bearing_speeds=own[0],
        bearing_stiffnesses=own[1],
        stiffening=first.stiffening,
        axes=first.axes,
        unevenness=first.unevenness,
    )
    basis_error.warn(result.basis_errors, result._told, first, accuracy)
    return result


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
