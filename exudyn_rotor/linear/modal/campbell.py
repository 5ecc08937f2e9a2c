"""Eigenfrequencies over spin speed in both frames (Campbell diagram)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks, plotting
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.modal import basis_error
from exudyn_rotor.linear.modal import campbell_diagram as diagram
from exudyn_rotor.linear.modal.whirl import (
    BACKWARD,
    FORWARD,
    MIXED,
    OVERDAMPED,
    STATIC,
    WHIRLS,
    Content,
    Named,
    damping_of,
    oscillates,
    rounded,
    signed_diameters,
    track,
)
from exudyn_rotor.linear.model.build import (
    Target,
    linear_model,
    warn_of_left_out_stiffening,
    warn_of_structural_damping,
)
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.over import ModelResult, basis_column, motions_over, table_lines
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.results import numbers, storable
from exudyn_rotor.theory.rotating_axes import FRAMES
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# growth below this share of frequency and speed is not marked: what is left of a free spin of a
# rotor with an uneven mesh looks like that
_UNSTABLE = 1e-4
_SPLIT = 4e-8  # of the fastest motion: the split of a double zero by rounding
_FEWEST = 6  # modes that are listed of a basis with halves of pairs


@storable
@dataclass(frozen=True, eq=False)
class Campbell(ModelResult):
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
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, campbell
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
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
    frame: str = "inertial"

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.choice(self.frame, "frame", FRAMES)

    @property
    def whirl(self) -> np.ndarray:
        """Sense of every mode, shape (s, k).

        'forward' and 'backward' are seen from outside, relative to the spin; 'mixed' where the
        weaker sense has more than half the amplitude of the stronger; 'axial', 'torsional' and
        'radial' for n = 0; 'static' for a wave that stands still in space, like a free rotor that
        is displaced; 'overdamped' for a lateral motion that decays without oscillating;
        'unknown' where neither shapes nor interfaces show the mode, or where it has more than four
        nodal diameters: its inertial frequency is that of the rotor frame then.
        """
        return np.array(WHIRLS)[self.whirl_codes]

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
        order = checks.number(order, "order", above=0.0)
        inertial = checks.choice(frame, "frame", FRAMES) == "inertial"
        tracked = self.tracked()
        values = tracked.frequencies_inertial if inertial else tracked.frequencies_rotor
        return diagram.crossings(self.speeds, values, tracked.continued, order)

    def plot(
        self,
        ax: Axes | None = None,
        frame: str | None = None,
        *,
        units: str = "rpm",
        orders: Sequence[float] | float | None = None,
        operating_range: ArrayLike | None = None,
        margins: ArrayLike | None = None,
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
        operating_range : two floats, optional
            Lowest and highest operating speed [rad/s], shaded.
        margins : two floats, optional
            Separation margins, shaded: shares of the lowest speed below it and of the highest
            above it, as (0.16, 0.26), the largest that API 617 asks for.

        Raises
        ------
        TypeError, ValueError
            For an unknown frame or unit, or numbers out of range.
        """
        frame = self.frame if frame is None else checks.choice(frame, "frame", FRAMES)
        shown, inertial = Units.of(units), frame == "inertial"
        limits = diagram.checked_range(operating_range)
        shares = diagram.checked_margins(margins)
        if margins is not None and limits is None:
            raise ValueError("margins: are beside operating_range=(low, high), got none")
        if orders is not None:
            orders = diagram.checked_orders(orders)
        ax = plotting.axes_or_new(ax)
        tracked, speeds = self.tracked(), shown.speeds(self.speeds)
        values = tracked.frequencies_inertial if inertial else tracked.frequencies_rotor
        scale = np.maximum(tracked.frequencies_inertial, np.abs(self.speeds)[:, None])
        unstable = tracked.growth > _UNSTABLE * scale
        codes, continued = tracked.whirl_codes, tracked.continued
        moves = oscillates(tracked.growth, tracked.frequencies_inertial)
        drawn = np.where(moves, shown.frequencies(values), np.nan)
        handles = diagram.draw_campbell(ax, speeds, drawn, codes, continued, unstable)
        if limits is not None:
            handles += diagram.shade_range(ax, limits, shares, shown)
        if orders is not None:
            given = (self.speeds, values, continued, orders, shown)
            handles += diagram.draw_orders(ax, *given)
        elif inertial:
            line = shown.frequencies(np.abs(self.speeds))
            handles += ax.plot(speeds, line, color="0.6", lw=0.8, label="spin speed")
        ax.set_xlabel(f"spin speed [{shown.speed}]")
        ax.set_ylabel(f"frequency in the {frame} frame [{shown.frequency}]")
        top = max(np.nanmax(drawn, initial=0.0), shown.frequencies(np.abs(self.speeds).max()))
        ax.set_ylim(0.0, 1.05 * top or None)
        ax.grid(alpha=0.3)
        plotting.legend_above(ax, 3, handles)
        return ax

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns, one row for each speed and mode, tracked."""
        return self.tracked()._columns(Units.of(units), self.order.shape[1])

    def _columns(self, shown: Units, count: int) -> dict[str, np.ndarray]:
        """Return the first `count` columns of all speeds as those of a table."""
        speed, frequency = f"[{shown.speed}]", f"[{shown.frequency}]"
        errors = self.basis_errors
        errors = None if errors is None else errors[:, :count]
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
            f"speed {speed}": np.repeat(shown.speeds(self.speeds), count),
            "mode": np.tile(np.arange(1, count + 1), len(self.speeds)),
            **{name: values[:, :count].ravel() for name, values in given.items()},
            **basis_column(errors, count * len(self.speeds)),
        }

    def table(self, count: int | None = None, *, units: str = "rpm") -> str:
        """Return the lowest `count` modes at every speed as lines of text.

        `units` are those of :meth:`plot`.
        """
        modes = self.order.shape[1]
        count = modes if count is None else min(checks.count(count, "count", least=1), modes)
        known = Units.of(units)
        lines = table_lines(self._columns(known, count), "log decrement", "continued")
        if self.free_motions:
            lines.append("free motions: " + ", ".join(self.free_motions))
        lost = known.speeds(self.speeds[~np.all(self.continued, axis=1)])
        if lost.size:
            listed = ", ".join(f"{f:.6g}" for f in lost)
            lines.append(f"modes not followed up to [{known.speed}]: {listed}")
        return "\n".join([*lines, *self._closing(self.basis_errors)])


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
    allow_negative: bool = False,
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
        speed, followed from there, overdamped ones last. All by
        default; of a basis that cuts pairs of bending modes in halves, those below the first half.
    frame : {'inertial', 'rotor'}
        In which modes are chosen, stand in order in the result, and are drawn.
    stiffening : {'auto', 'none', 'tilt', 'full'}
        Centrifugal stiffening; 'none' gives the paper's equations, 'full' needs a rotor with
        prestress (:meth:`SolidRotor.prestress`).
    axes : {'auto', 'inertial', 'rotor'}
        Of the equations, see :func:`linear_model`.
    allow_negative : bool, optional
        Accept speeds below zero.
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
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, campbell
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> result = campbell(rotor, [0.0, 50.0], supports=supports)
    >>> result.frequencies_inertial[1, 1:5].round(2)
    array([99.97, 99.97, 99.97, 99.97])
    >>> result.whirl[1, 1:5].tolist()
    ['forward', 'forward', 'backward', 'backward']
    """
    values = checks.spin_speeds(speeds, allow_negative)
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
    warn_of_structural_damping(model, "campbell finds modes")
    warn_of_left_out_stiffening(model, np.abs(values).max())
    motions = motions_over(model, values, progress=progress, label="Campbell")
    named = Content.of(model).named(motions)
    if model.free_motions:
        named = _resting(named)
    order, continued = track(named, model.mass_matrix)
    first = named.rows(named.motions.known[:1]).columns(order[named.motions.known[:1]])
    kept = _ascending(first, frame)[0, : modes or _complete(first, model)]
    tracked = named.columns(order[:, kept])
    errors = None if accuracy is None else basis_error.motion_errors(model, tracked)
    result = _collected(tracked, continued[:, kept], errors, model, frame, modes)
    if errors is not None:
        _warn_of_basis(result, model, accuracy)
    return result


def _resting(found: Named) -> Named:
    """Return motions of which free ones, double zeros that rounding splits, do not grow."""
    values = found.motions.values
    split = _SPLIT * np.nanmax(np.abs(values), axis=1, keepdims=True, initial=0.0)
    rests = np.hypot(found.inertial, values.real) <= split
    motions = replace(found.motions, values=np.where(rests, 1j * values.imag, values))
    lateral = rests & np.isin(found.codes, (FORWARD, BACKWARD, MIXED, OVERDAMPED))
    return found._replace(
        motions=motions,
        inertial=np.where(rests, 0.0, found.inertial),
        codes=np.where(lateral, STATIC, found.codes),
    )


def _ascending(found: Named, frame: str) -> np.ndarray:
    """Return the order of motions (s, k): ascending in a frame, overdamped and lost ones last.

    Equal frequencies ascend in the other frame, then from backward to forward waves.
    """
    main, other = found.inertial, found.rotor
    if frame == "rotor":
        main, other = other, main
    last = np.isnan(found.motions.values) | _overdamped(found)
    keys = [-found.motions.values.real, signed_diameters(found.codes, found.diameters), other, main]
    return np.lexsort([*map(rounded, keys), last], axis=-1)


def _overdamped(found: Named) -> np.ndarray:
    growth, bounds = found.motions.values.real, found.motions.bounds[:, None]
    return (found.inertial == 0.0) & (growth < -bounds)


def _complete(first: Named, model: LinearModel) -> int:
    """Return how many of the motions at one speed a basis is asked for that cuts pairs."""
    below = np.count_nonzero(np.abs(first.motions.values) < model.complete_up_to)
    return max(min(_FEWEST, first.inertial.shape[1]), below)


def _collected(
    tracked: Named,
    continued: np.ndarray,
    errors: np.ndarray | None,
    model: LinearModel,
    frame: str,
    modes: int | None,
) -> Campbell:
    """Return the result, whose columns ascend at every speed."""
    speeds, upwards = tracked.motions.speeds, _ascending(tracked, frame)
    order = np.argsort(upwards, axis=1)
    order[np.isnan(tracked.motions.bounds)] = np.arange(order.shape[1])
    found = tracked.columns(upwards)
    growth, bounds = found.motions.values.real, found.motions.bounds[:, None]
    growth = np.where(np.abs(growth) <= bounds, 0.0, growth)
    if errors is not None:
        chosen = basis_error.judged(found.inertial, growth, speeds, modes is not None)
        errors = np.where(chosen, np.take_along_axis(errors, upwards, 1), np.nan)
    ratio, decrement = damping_of(growth, found.inertial)
    return Campbell(
        speeds=speeds,
        frequencies_rotor=found.rotor,
        growth=growth,
        frequencies_inertial=found.inertial,
        damping_ratio=ratio,
        log_decrement=decrement,
        whirl_codes=found.codes,
        nodal_diameters=found.diameters,
        vectors=found.motions.main,
        order=order,
        continued=continued,
        free_motions=model.free_motions,
        stiffening=model.stiffening,
        basis_errors=errors,
        frame=frame,
        axes=model.axes,
        unevenness=model.unevenness,
    )


def _warn_of_basis(result: Campbell, model: LinearModel, accuracy: float) -> None:
    """Warn where the basis leaves out too much for the modes that count."""
    errors, shown = np.nan_to_num(result.basis_errors), Units.of("rpm")
    at = np.unravel_index(np.argmax(errors), errors.shape)
    heard, speed = shown.frequencies(result.frequencies_inertial[at]), result.speeds[at[0]]
    mode = f"mode {at[1] + 1} ({result.whirl[at]}, {heard:.4g} Hz)"
    basis_error.warn(errors, f"{mode} at {shown.speeds(speed):.5g} rpm", model, accuracy)
