"""Eigenfrequencies over spin speed in both frames (Campbell diagram)."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks, plotting
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.modal import basis_error, whirl
from exudyn_rotor.linear.modal.whirl import WHIRLS, Content, Named, OfMotions, rounded
from exudyn_rotor.linear.model.build import Target, linear_model, warn_of_omissions
from exudyn_rotor.linear.over import ModelResult, basis_column, motions_over, table_lines, warn_of
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.results import numbers, storable
from exudyn_rotor.theory.rotating_axes import FRAMES
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

# growth below this share of frequency and speed is not marked: what is left of a free spin of a
# rotor with an uneven mesh looks like that
_UNSTABLE = 1e-4
_SPLIT = 4e-8  # of the fastest motion: the split of a double zero by rounding
_LATERAL = whirl.FORWARD, whirl.BACKWARD, whirl.MIXED, whirl.OVERDAMPED
_STYLES = {  # colour, line
    whirl.FORWARD: (plotting.COLORS[0], "-"),
    whirl.BACKWARD: (plotting.COLORS[1], "--"),
    whirl.MIXED: (plotting.COLORS[2], "-."),
    whirl.AXIAL: ("0.45", ":"),
    whirl.TORSIONAL: (plotting.COLORS[3], ":"),
    whirl.RADIAL: (plotting.COLORS[4], ":"),
    whirl.STATIC: ("0.7", ":"),
    whirl.UNKNOWN: ("0.2", "-"),
    whirl.FOUNDATION: (plotting.COLORS[5], "-"),
    whirl.OVERDAMPED: ("0.7", ":"),
}


@storable
@dataclass(frozen=True, eq=False)
class Campbell(OfMotions, ModelResult):
    """Eigenfrequencies over spin speed, at every speed ascending in the :attr:`frame`.

    Overdamped motions, which have the inertial frequency 0 and decay, stand behind the others. A
    speed at which nothing could be computed has NaN. In the order of :meth:`tracked`, column j is
    the same mode at all speeds.

    Attributes
    ----------
    speeds : ndarray, shape (s,)
        Spin speeds Ω [rad/s].
    frequencies_rotor : ndarray, shape (s, k)
        Frequency of the mode's strongest wave seen in the rotor frame [rad/s].
    growth : ndarray, shape (s, k)
        Real parts of the eigenvalues λ [1/s], the same in both frames; positive means unstable.
    frequencies_inertial : ndarray, shape (s, k)
        Frequency of the mode's strongest wave seen from outside [rad/s].
    damping_ratio, log_decrement : ndarray, shape (s, k)
        ``−Re λ / |Re λ + iω|`` and ``−2π Re λ / ω`` at the inertial frequency ω; 0 where Re λ is
        rounding.
    whirl_codes : ndarray of int, shape (s, k)
        Index into :data:`exudyn_rotor.linear.modal.whirl.WHIRLS`; see :attr:`whirl`.
    nodal_diameters : ndarray of int, shape (s, k)
        n where ±n hold at least 70 % of the mode's energy; −1 where none does. Without mode shapes
        n comes from the interfaces and is 0 or 1.
    vectors : ndarray, shape (s, c, k)
        Modes in the coordinates of the model, in its :attr:`axes`; the largest harmonic of
        periodic equations.
    order : ndarray of int, shape (s, k)
        ``order[i, j]`` is the column at speed i that continues column j of the first speed.
    continued : ndarray of bool, shape (s, k)
        Where that is the same mode as at the speed before, by its shape and frequency; False where
        it had to be another one, as where a mode leaves those that were computed.
    free_motions : tuple of str
        Rigid motions that nothing holds.
    basis_errors : ndarray, shape (s, k), or None
        Estimated relative error by the basis of a reduced rotor at the first, the middle and the
        last speed, NaN elsewhere: the larger of those of the inertial frequency and of the growth.
        A frequency counts as at least a tenth of the spin speed, a growth as at least a hundredth
        of the frequency. Zero for a full model; where no number of modes was asked for, NaN of
        those beyond twice the highest speed and the lowest six, and always of overdamped motions
        that decay faster than these. None where it is not known.
    frame : {'inertial', 'rotor'}
        In which columns ascend, and modes were chosen.
    stiffening, axes, unevenness
        See :class:`Stability`; :attr:`vectors` are in these axes.

    Examples
    --------
    >>> from exudyn_rotor import Support, campbell, rotor_example
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> result = campbell(rotor, [0.0, 50.0], supports=supports)
    >>> result.tracked().damping_ratio[:, 1].round(4)
    array([0.025, 0.025])
    >>> print(result.table(1))
    speed [rpm]  mode  rotor frame [Hz]  inertial [Hz]  growth [1/s]  damping ratio  n  whirl
              0     1                 0              0             0              0  0  axial
        477.465     1                 0              0             0              0  0  axial
    free motions: translation along axis
    stiffening: tilt
    """

    speeds: np.ndarray = numbers("speeds")
    frequencies_rotor: np.ndarray = numbers("speeds", "modes", finite=False)
    growth: np.ndarray = numbers("speeds", "modes", finite=False)
    frequencies_inertial: np.ndarray = numbers("speeds", "modes", finite=False)
    damping_ratio: np.ndarray = numbers("speeds", "modes", finite=False)
    log_decrement: np.ndarray = numbers("speeds", "modes", finite=False)
    whirl_codes: np.ndarray = numbers("speeds", "modes", dtype=int, least=0, most=len(WHIRLS) - 1)
    nodal_diameters: np.ndarray = numbers("speeds", "modes", dtype=int, least=-1)
    vectors: np.ndarray = numbers("speeds", "coordinates", "modes", dtype=complex, finite=False)
    order: np.ndarray = numbers("speeds", "modes", dtype=int, least=0)
    continued: np.ndarray = numbers("speeds", "modes", dtype=bool)
    free_motions: tuple[str, ...] = ()
    basis_errors: np.ndarray | None = numbers("speeds", "modes", finite=False, optional=True)
    frame: str = checks.one_of(FRAMES, default="inertial")

    def tracked(self) -> Campbell:
        """Return the same result with columns that follow each mode over the speeds.

        Neighbouring speeds are matched by the mass-weighted modal assurance criterion and the
        distance in frequency; steps in speed must be small where modes veer. A column holds
        different modes before and after a speed where :attr:`continued` is False.
        """
        names = ("frequencies_rotor", "growth", "frequencies_inertial", "damping_ratio",
                 "log_decrement", "whirl_codes", "nodal_diameters")  # fmt: skip
        names += ("basis_errors",) if self.basis_errors is not None else ()
        moved = {name: np.take_along_axis(getattr(self, name), self.order, 1) for name in names}
        moved["vectors"] = np.take_along_axis(self.vectors, self.order[:, None, :], 2)
        moved["order"] = np.broadcast_to(np.arange(self.order.shape[1]), self.order.shape).copy()
        return replace(self, **moved)

    def crossings(
        self, order: float = 1.0, frame: str = "inertial"
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return where modes have the frequency pΩ in a frame, p the `order`.

        By linear interpolation between neighbouring speeds, with damping; :func:`critical_speeds`
        finds undamped ones in the inertial frame without a grid.

        Parameters
        ----------
        order : float, optional
            In the rotor frame an engine order, see :meth:`plot`.
        frame : {'inertial', 'rotor'}, optional

        Returns
        -------
        speeds : ndarray, shape (c,)
            Ascending [rad/s].
        modes : ndarray of int, shape (c,)
            Columns of :meth:`tracked`.
        """
        inertial = checks.choice(frame, "frame", FRAMES) == "inertial"
        order = checks.number(order, "order", above=0.0)
        tracked, line = self.tracked(), order * self.speeds[:, None]
        values = tracked.frequencies_inertial if inertial else tracked.frequencies_rotor
        apart = values - line
        before, after = apart[:-1], apart[1:]
        crossed = (before * after < 0.0) | ((after == 0.0) & (before != 0.0))
        rows, modes = np.nonzero(crossed & tracked.continued[1:])
        share = before[rows, modes] / (before - after)[rows, modes]
        speeds = self.speeds[rows] + share * np.diff(self.speeds)[rows]
        ascending = np.argsort(speeds, kind="stable")
        return speeds[ascending], modes[ascending]

    def plot(
        self,
        ax: Axes | None = None,
        frame: str | None = None,
        *,
        units: str = "rpm",
        orders: Sequence[float] | float | None = None,
    ) -> Axes:
        """Draw the tracked modes over the spin speed; see :mod:`exudyn_rotor.plotting`.

        A line breaks where it would join different modes.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            A new figure without a window by default.
        frame : {'inertial', 'rotor'}, optional
            That of the result by default.
        units : {'rpm', 'Hz', 'SI'}
            Of the picture: 'rpm' has speeds in rpm and frequencies in Hz, 'SI' rad/s.
        orders : sequence of float, optional
            Lines of excitation pΩ with p in `orders`, with the modes' crossings marked; by default
            the spin speed alone without marks, and none in the rotor frame. There p is an engine
            order: of a load that stands in space with p periods around the circle.

        Raises
        ------
        TypeError, ValueError
            For an unknown frame or unit, or numbers out of range.
        """
        frame = self.frame if frame is None else checks.choice(frame, "frame", FRAMES)
        shown = Units.of(units)
        if orders is not None:
            orders = checks.vector(np.atleast_1d(orders), "orders", size=None)
            if orders.size == 0 or np.any(orders <= 0.0):
                raise ValueError(f"orders: needs positive numbers, got {checks.shown(orders)}")
        ax = plotting.axes_or_new(ax)
        handles = self.tracked()._draw_modes(ax, frame, shown)
        if orders is not None:
            handles += self._draw_orders(ax, frame, shown, orders)
        elif frame == "inertial":
            line = shown.speeds(self.speeds), shown.frequencies(self.speeds)
            handles += ax.plot(*line, color="0.6", lw=0.8, label="spin speed")
        ax.set_xlabel(f"spin speed [{shown.speed}]")
        ax.set_ylabel(f"frequency in the {frame} frame [{shown.frequency}]")
        ax.grid(alpha=0.3)
        plotting.legend_above(ax, 3, handles)
        return ax

    def _draw_modes(self, ax: Axes, frame: str, units: Units) -> list[Line2D]:
        """Draw each column, coloured by whirl, unstable ones with a cross; return handles."""
        from matplotlib.lines import Line2D

        values = self.frequencies_inertial if frame == "inertial" else self.frequencies_rotor
        moves = whirl.oscillates(self.growth, self.frequencies_inertial)
        speeds = units.speeds(self.speeds)
        values = units.frequencies(np.where(moves, values, np.nan))
        marker, seen = {"marker": "o", "ms": 4} if len(speeds) == 1 else {}, set()
        for column in range(values.shape[1]):
            code, joined = self.whirl_codes[:, column], self.continued[:, column]
            # the way to a speed takes its style: at rest the sense is not yet settled
            style = np.r_[code[:2][-1:], code[1:]]
            starts = np.flatnonzero(np.r_[True, (style[1:] != style[:-1]) | ~joined[1:]])
            for start, stop in itertools.pairwise([*starts, len(speeds)]):
                first = max(start - 1, 0) if joined[start] else start
                color, line = _STYLES[style[start]]
                part = slice(first, stop)
                ax.plot(speeds[part], values[part, column], ls=line, color=color, lw=1.3, **marker)
                if np.any(np.isfinite(values[part, column])):
                    seen.add(int(style[start]))
        handles = [
            Line2D([], [], color=color, ls=line, label=WHIRLS[code])
            for code, (color, line) in _STYLES.items()
            if code in seen
        ]
        sizes = np.maximum(self.frequencies_inertial, self.speeds[:, None])
        unstable = self.growth > _UNSTABLE * sizes
        if np.any(unstable):
            rows = np.nonzero(unstable)[0]
            handles += ax.plot(speeds[rows], values[unstable], "kx", ms=4, label="unstable")
        top = max(np.nanmax(values, initial=0.0), units.frequencies(self.speeds[-1]))
        ax.set_ylim(0.0, 1.05 * top or None)
        return handles

    def _draw_orders(self, ax: Axes, frame: str, units: Units, orders: np.ndarray) -> list[Line2D]:
        """Draw the lines pΩ and mark where modes cross them; return what the legend needs."""
        handles, places = [], []
        for order, style in zip(orders, itertools.cycle(plotting.LINES)):
            label = "spin speed" if order == 1.0 else f"{order:g} × spin speed"
            line = units.speeds(self.speeds), units.frequencies(order * self.speeds)
            handles += ax.plot(*line, color="0.6", lw=0.8, ls=style, label=label)
            end = line[0][-1], line[1][-1]
            ax.annotate(f"{order:g}×", end, textcoords="offset points", xytext=(2, 0), fontsize=8,
                        color="0.4", annotation_clip=True)  # fmt: skip
            met, _ = self.crossings(order, frame)
            places += zip(units.speeds(met), units.frequencies(order * met), strict=True)
        if places:
            style = {"mfc": "none", "mec": "0.2", "ms": 6, "label": "crossing"}
            handles += ax.plot(*zip(*places, strict=True), "o", **style)
        return handles

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns, one row for each speed and mode, tracked."""
        return self.tracked()._columns(Units.of(units))

    def _columns(self, shown: Units) -> dict[str, np.ndarray]:
        """Return the table as columns, in the order of the result."""
        speed, frequency = f"[{shown.speed}]", f"[{shown.frequency}]"
        modes = self.order.shape[1]
        given = {
            f"rotor frame {frequency}": shown.frequencies(self.frequencies_rotor),
            f"inertial {frequency}": shown.frequencies(self.frequencies_inertial),
            "growth [1/s]": self.growth,
            "damping ratio": self.damping_ratio,
            "log decrement": self.log_decrement,
            "nodal diameters": self.nodal_diameters,
            "whirl": self.whirl,
            "continued": self.continued,
        }
        return {
            f"speed {speed}": np.repeat(shown.speeds(self.speeds), modes),
            "mode": np.tile(np.arange(1, modes + 1), len(self.speeds)),
            **{name: values.ravel() for name, values in given.items()},
            **basis_column(self.basis_errors, self.order.size),
        }

    def table(self, count: int | None = None, *, units: str = "rpm") -> str:
        """Return the lowest `count` modes at every speed as lines of text.

        `units` are those of :meth:`plot`.
        """
        modes = self.order.shape[1]
        count = modes if count is None else min(checks.count(count, "count", least=1), modes)
        known = Units.of(units)
        columns = self._columns(known)
        shown = {name: values[columns["mode"] <= count] for name, values in columns.items()}
        lines = table_lines(shown, "log decrement", "continued")
        if self.free_motions:
            lines.append("free motions: " + ", ".join(self.free_motions))
        lost = known.speeds(self.speeds[~np.all(self.continued, axis=1)])
        if lost.size:
            listed = ", ".join(f"{f:.6g}" for f in lost)
            lines.append(f"modes not followed up to [{known.speed}]: {listed}")
        return "\n".join([*lines, *self._closing(self.basis_errors)])

    def _told(self, row: int, column: int) -> str:
        """Return a mode in words."""
        shown = Units.of("rpm")
        heard = shown.frequencies(self.frequencies_inertial[row, column])
        mode = f"mode {column + 1} ({self.whirl[row, column]}, {heard:.4g} Hz)"
        return f"{mode} at {shown.speeds(self.speeds[row]):.5g} rpm"


def campbell(
    target: Target,
    speeds: ArrayLike,
    *,
    supports: Sequence[Given] | Given = (),
    foundation: Foundation | None = None,
    body: RotorBody | Sequence[RotorBody] | None = None,
    modes: int | None = None,
    frame: str = "inertial",
    stiffening: str = "auto",
    axes: str = "auto",
    accuracy: float | None = 1e-2,
    progress: bool = False,
) -> Campbell:
    """Compute the eigenfrequencies of a rotor on supports, or of a scene, over spin speed.

    Solves ``(λ²M + λ(D + 2ΩG) + K + Ω²(K2 − C)) x = 0``, the homogeneous Eq. (105) or (109) with
    supports and centrifugal stiffening, in axes in which it is constant (:func:`linear_model`).
    Every conjugate pair counts once, and so does every pair of real eigenvalues.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, RotorTrain, exudyn.MainSystem or LinearModel
        See :func:`linear_model`.
    speeds : array_like, shape (s,)
        Ascending spin speeds [rad/s].
    supports : sequence of Support or bearings, optional
        Of a rotor.
    foundation : Foundation, optional
        What carries them; the ground by default.
    body : RotorBody or sequence of RotorBody, optional
        The rotor in a scene, or all of several, see :func:`linear_model`.
    modes : int, optional
        How many modes to keep: those with the lowest frequencies in the `frame` at the first
        speed, followed from there, overdamped ones last; of a mode that is NaN there, at the
        first speed at which it is found. All by default.
    frame : {'inertial', 'rotor'}
        In which modes are chosen, stand in order in the result, and are drawn.
    stiffening : {'auto', 'none', 'tilt', 'full'}
        Centrifugal stiffening; 'none' gives the paper's equations, 'full' needs a rotor with
        prestress (:meth:`SolidRotor.prestress`).
    axes : {'auto', 'inertial', 'rotor'}
        Of the equations, see :func:`linear_model`.
    accuracy : float, optional
        Relative error of frequencies and growth by the basis of a reduced rotor, estimated, above
        which a warning is given: see :attr:`Campbell.basis_errors`. It looks at the modes asked
        for by `modes`; without, at those up to twice the highest speed and at the lowest six. None
        for no estimate.
    progress : bool, optional
        Show a progress bar.

    Raises
    ------
    TypeError
        If the target, the body or a support is of another kind.
    ValueError
        If speeds are not finite, ascending and non-negative, an interface is unknown, or nothing
        can be computed at any speed. A single speed that fails is NaN, with a warning.

    Notes
    -----
    A spin that no support holds has the frequency 0 and no growth, at every speed and level of
    stiffening. Lateral motion is that of a rotor driven at constant speed, as in :func:`stability`
    and the responses. Without a drive an eccentric centre of mass couples both: a Jeffcott rotor
    (mass m, eccentricity e, inertia Θ about the axis, critical speed ω) then has frequencies that
    differ, relative to ω, by ``½ m e²/Θ`` at rest and ``m r²/Θ`` near ω, with the whirl radius r of
    the centre of mass.

    Examples
    --------
    >>> from exudyn_rotor import Support, campbell, rotor_example
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> result = campbell(rotor, [0.0, 50.0], supports=supports)
    >>> result.frequencies_inertial[1, 1:5].round(2)
    array([99.97, 99.97, 99.97, 99.97])
    >>> result.whirl[1, 1:5].tolist()
    ['forward', 'forward', 'backward', 'backward']
    """
    values = checks.ascending_from_zero(speeds, "speeds")
    if modes is not None:
        modes = checks.count(modes, "modes", least=1)
    checks.accuracy(accuracy)
    checks.flag(progress, "progress")
    checks.choice(frame, "frame", FRAMES)
    model = linear_model(
        target, supports=supports, foundation=foundation, body=body, stiffening=stiffening,
        axes=axes,
    )  # fmt: skip
    if modes is not None and modes > model.size:
        raise ValueError(f"modes: {modes} is not between 1 and the {model.size} there are")
    warn_of_omissions(model, values[-1], "campbell finds modes")
    motions = motions_over(model, values, warns=False, progress=progress, label="Campbell")
    named = Content.of(model).named(motions)
    if model.free_motions:
        named = _resting(named)
    order, continued = whirl.track(named, model.mass_matrix)
    every = named.columns(order)
    kept = _ascending(whirl.first_known(every), frame)[:, :modes]
    named = every.columns(np.repeat(kept, len(values), axis=0))
    warn_of(model, every.motions, named.motions)
    upwards = _ascending(named, frame)
    found = named.columns(upwards)
    growth, bounds = found.motions.values.real, found.motions.bounds[:, None]
    growth = np.where(np.abs(growth) <= bounds, 0.0, growth)
    errors = None if accuracy is None else basis_error.motion_errors(model, found)
    if errors is not None:
        judged = basis_error.judged(found.inertial, growth, values, modes is not None)
        errors = np.where(judged, errors, np.nan)
    ratio, decrement = whirl.damping_of(growth, found.inertial)
    result = Campbell(
        speeds=values,
        frequencies_rotor=found.rotor,
        growth=growth,
        frequencies_inertial=found.inertial,
        damping_ratio=ratio,
        log_decrement=decrement,
        whirl_codes=found.codes,
        nodal_diameters=found.diameters,
        vectors=found.motions.main,
        order=np.argsort(upwards, axis=1),
        continued=continued[:, kept[0]],
        free_motions=model.free_motions,
        stiffening=model.stiffening,
        basis_errors=errors,
        frame=frame,
        axes=model.axes,
        unevenness=model.unevenness,
    )
    basis_error.warn(errors, result._told, model, accuracy)
    return result


def _resting(found: Named) -> Named:
    """Return motions of which free ones, double zeros that rounding splits, do not grow."""
    values = found.motions.values
    split = _SPLIT * np.nanmax(np.abs(values), axis=1, keepdims=True, initial=0.0)
    rests = np.hypot(found.inertial, values.real) <= split
    lateral = rests & np.isin(found.codes, _LATERAL)
    return found._replace(
        motions=replace(found.motions, values=np.where(rests, 1j * values.imag, values)),
        inertial=np.where(rests, 0.0, found.inertial),
        codes=np.where(lateral, whirl.STATIC, found.codes),
    )


def _ascending(found: Named, frame: str) -> np.ndarray:
    """Return the order of motions (s, k): ascending in a frame, overdamped and lost ones last.

    Equal frequencies ascend in the other frame, then from backward to forward waves.
    """
    main, other = found.inertial, found.rotor
    if frame == "rotor":
        main, other = other, main
    growth = found.motions.values.real
    overdamped = (found.inertial == 0.0) & (growth < -found.motions.bounds[:, None])
    keys = [-growth, whirl.signed_diameters(found.codes, found.diameters), other, main]
    return np.lexsort([*map(rounded, keys), np.isnan(growth) | overdamped], axis=-1)
