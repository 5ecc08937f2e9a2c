"""Eigenfrequencies over spin speed in both frames (Campbell diagram)."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from exudyn_rotor import checks, plotting
from exudyn_rotor.checks import ascending
from exudyn_rotor.linear import options
from exudyn_rotor.linear.modal.campbell_diagram import draw_campbell
from exudyn_rotor.linear.modal.tracking import Tracks, track
from exudyn_rotor.linear.modal.whirl import WHIRLS, WhirlContent
from exudyn_rotor.linear.models.linear_model import (
    Target,
    linear_model,
    warn_of_structural_damping,
)
from exudyn_rotor.linear.models.protocol import LinearModel, Space
from exudyn_rotor.linear.models.supports import Support
from exudyn_rotor.linear.periodic.eigenvalues import groups
from exudyn_rotor.linear.periodic.floquet_modes import FloquetModes
from exudyn_rotor.linear.periodic.rotating_axes import FRAMES
from exudyn_rotor.multibody.rotor_body import RotorBody
from exudyn_rotor.results import Result, numbers, storable
from exudyn_rotor.sweep import ascending_from_zero, sweep

_FULL_MODES = 10
# growth below this share of frequency and speed is not marked: what is left of a free spin of a
# rotor with an uneven mesh looks like that
_UNSTABLE = 1e-4


@storable
@dataclass(frozen=True, eq=False)
class Campbell(Result):
    """Eigenfrequencies over spin speed, at every speed ascending in the rotor frame.

    In the order of :meth:`tracked`, column j is the same mode at all speeds.

    Attributes
    ----------
    speeds : ndarray, shape (s,)
        Spin speeds Ω [rad/s].
    frequencies_rotor : ndarray, shape (s, k)
        Natural frequencies ν = |Im λ| seen in the rotor frame, ascending [rad/s].
    growth : ndarray, shape (s, k)
        Real parts of the eigenvalues λ [1/s], the same in both frames; positive means unstable.
    frequencies_inertial : ndarray, shape (s, k)
        Frequency of the mode's strongest wave seen from outside, ``|ν + nΩ|`` [rad/s].
    damping_ratio, log_decrement : ndarray, shape (s, k)
        ``−Re λ / |Re λ + iω|`` and ``−2π Re λ / ω`` at the inertial frequency ω.
    whirl_codes : ndarray of int, shape (s, k)
        Index into :data:`exudyn_rotor.linear.modal.whirl.WHIRLS`; see :attr:`whirl`.
    nodal_diameters : ndarray of int, shape (s, k)
        n where ±n hold at least 70 % of the mode's energy; −1 where none does. Without mode shapes
        n comes from the interfaces and is 0 or 1.
    vectors : ndarray, shape (s, c, k)
        Modes in the coordinates of the rotor frame, unit length; the central harmonic of
        periodic systems.
    order : ndarray of int, shape (s, k)
        ``order[i, j]`` is the column at speed i that continues column j of the first speed.
    continued : ndarray of bool, shape (s, k)
        Where that is the same mode as at the speed before, by its shape and frequency; False where
        it had to be another one, as where a mode leaves those that were computed.
    free_motions : tuple of str
        Rigid motions that nothing holds.

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
      speed [Hz]  mode  rotor frame [Hz]  inertial [Hz]  damping ratio  n  whirl
               0     1                 0              0              0  0  axial
           7.958     1                 0              0              0  0  axial
    free motions: translation along axis
    """

    speeds: np.ndarray = numbers("speeds")
    frequencies_rotor: np.ndarray = numbers("speeds", "modes")
    growth: np.ndarray = numbers("speeds", "modes")
    frequencies_inertial: np.ndarray = numbers("speeds", "modes")
    damping_ratio: np.ndarray = numbers("speeds", "modes")
    log_decrement: np.ndarray = numbers("speeds", "modes", finite=False)
    whirl_codes: np.ndarray = numbers("speeds", "modes", dtype=int, least=0, most=len(WHIRLS) - 1)
    nodal_diameters: np.ndarray = numbers("speeds", "modes", dtype=int, least=-1)
    vectors: np.ndarray = numbers("speeds", "coordinates", "modes", dtype=complex)
    order: np.ndarray = numbers("speeds", "modes", dtype=int, least=0)
    continued: np.ndarray = numbers("speeds", "modes", dtype=bool)
    free_motions: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        if np.any(np.sort(self.order, axis=1) != np.arange(self.order.shape[1])):
            raise ValueError("order: needs every column once at each speed")

    @property
    def whirl(self) -> np.ndarray:
        """Sense of every mode, shape (s, k).

        'forward' and 'backward' are seen from outside, relative to the spin; 'mixed' where the
        weaker sense has more than half the amplitude of the stronger; 'axial', 'torsional' and
        'radial' for n = 0; 'static' for a wave that stands still in space, like a free rotor that
        is displaced; 'unknown' where neither shapes nor interfaces show the mode.
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
        moved = {name: np.take_along_axis(getattr(self, name), self.order, 1) for name in names}
        moved["vectors"] = np.take_along_axis(self.vectors, self.order[:, None, :], 2)
        moved["order"] = np.broadcast_to(np.arange(self.order.shape[1]), self.order.shape).copy()
        return replace(self, **moved)

    def plot(self, ax: Axes | None = None, frame: str = "inertial") -> Axes:
        """Draw the tracked modes [Hz] over the spin speed [Hz]; see :mod:`exudyn_rotor.plotting`.

        A line breaks where it would join different modes.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            A new figure without a window by default.
        frame : {'inertial', 'rotor'}

        Raises
        ------
        ValueError
            For an unknown frame.
        """
        checks.choice(frame, "frame", FRAMES)
        ax = plotting.axes_or_new(ax)
        hertz = 1.0 / (2.0 * np.pi)
        tracked, speeds = self.tracked(), hertz * self.speeds
        inertial = frame == "inertial"
        values = tracked.frequencies_inertial if inertial else tracked.frequencies_rotor
        scale = np.maximum(tracked.frequencies_inertial, np.abs(self.speeds)[:, None])
        unstable = tracked.growth > _UNSTABLE * scale
        codes, continued = tracked.whirl_codes, tracked.continued
        handles = draw_campbell(ax, speeds, hertz * values, codes, continued, unstable)
        if inertial:
            handles += ax.plot(speeds, np.abs(speeds), color="0.6", lw=0.8, label="spin speed")
        ax.set_xlabel("spin speed [Hz]")
        ax.set_ylabel(f"frequency in the {'inertial' if inertial else 'rotor'} frame [Hz]")
        ax.set_ylim(bottom=0.0)
        ax.grid(alpha=0.3)
        plotting.legend_above(ax, 3, handles)
        return ax

    def table(self, count: int | None = None) -> str:
        """Return the lowest `count` modes at every speed as lines of text, frequencies in Hz."""
        if count is not None:
            count = checks.count(count, "count", least=1)
        hertz = 1.0 / (2.0 * np.pi)
        lines = [
            "  speed [Hz]  mode  rotor frame [Hz]  inertial [Hz]  damping ratio  n  whirl",
        ]
        shown = slice(0, count)
        for i, speed in enumerate(self.speeds):
            for j in range(self.order.shape[1])[shown]:
                n = self.nodal_diameters[i, j]
                lines.append(
                    f"{hertz * speed:12.4g}{j + 1:6d}"
                    f"{hertz * self.frequencies_rotor[i, j]:18.6g}"
                    f"{hertz * self.frequencies_inertial[i, j]:15.6g}"
                    f"{self.damping_ratio[i, j]:15.3g}  {n if n >= 0 else '-'}  {self.whirl[i, j]}"
                )
        if self.free_motions:
            lines.append("free motions: " + ", ".join(self.free_motions))
        lost = hertz * self.speeds[~np.all(self.continued, axis=1)]
        if lost.size:
            lines.append("modes not followed up to [Hz]: " + ", ".join(f"{f:.4g}" for f in lost))
        return "\n".join(lines)


def campbell(
    target: Target,
    speeds: ArrayLike,
    *,
    supports: Sequence[Support] = (),
    body: RotorBody | None = None,
    modes: int | None = None,
    stiffening: str = "tilt",
    allow_negative: bool = False,
    tolerance: float = 1e-8,
    residual: float = 1e-5,
    executor: Executor | None = None,
    progress: bool = False,
) -> Campbell:
    """Compute the eigenfrequencies of a rotor on supports, or of a scene, over spin speed.

    Solves ``(λ²M + λ(D + 2ΩG) + K + Ω²(K2 − C)) x = 0``, the homogeneous Eq. (105) or (109) with
    supports and centrifugal stiffening; by Hill's method where supports that stand still differ
    in their two directions. Every conjugate pair counts once, and so does every pair of real
    eigenvalues: all modes are found, rigid and repeated ones included, or an error is raised.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, exudyn.MainSystem or linear model
        See :func:`linear_model`. A SolidRotor of more than 600 degrees of freedom is solved for
        its lowest modes, each checked by the residual of the full equations.
    speeds : array_like, shape (s,)
        Ascending spin speeds [rad/s].
    supports : sequence of Support, optional
        Of a rotor.
    body : RotorBody, optional
        The rotor in a scene.
    modes : int, optional
        How many modes to keep: those with the lowest inertial frequencies at the first speed,
        followed from there. All by default. A large SolidRotor is solved for as many modes, 10 by
        default, as are lowest in the rotor frame at each speed.
    stiffening : {'tilt', 'none', 'full'}
        Centrifugal stiffening; 'none' gives the paper's equations, 'full' needs a rotor with
        prestress (:meth:`SolidRotor.prestress`).
    allow_negative : bool, optional
        Accept speeds below zero.
    tolerance : float, optional
        Largest error of an eigenvalue by the harmonics that Hill's method leaves out, relative to
        the larger of its size and the frequency of the turning coefficients.
    residual : float, optional
        Largest relative residual of a large SolidRotor; its eigenvalues err by about the square.
    executor : concurrent.futures.Executor, optional
        Computes the speeds. A large SolidRotor does not use it: its speeds share one subspace.
    progress : bool, optional
        Show a progress bar.

    Raises
    ------
    TypeError
        If the target, the body or a support is of another kind.
    ValueError
        If speeds are not finite, ascending and non-negative, an interface is unknown, or modes
        are lost.

    Notes
    -----
    A spin that no support holds has the frequency 0 and no growth, at every speed and level of
    stiffening. Rigid lateral motion is not coupled with it but is that of a rotor driven at
    constant speed, as in :func:`stability` and the responses; elastic motion is by its Coriolis
    force alone, as a disc that breathes. Without a drive an eccentric centre of mass couples all. A
    Jeffcott rotor (mass m, eccentricity e, inertia Θ about the axis, critical speed ω) then has
    frequencies that differ, relative to ω, by ``½ m e²/Θ`` at rest and ``m r²/Θ`` near ω, with the
    whirl radius r of the centre of mass, and is unstable from ω to ``ω(1 + (½ m e²/Θ)^⅓)``. From
    0.1 % at rest on, a warning tells. In a scene with ``translation='none'`` and a prescribed spin
    the frame turns with the mean of the mass about the axis; frequencies of an eccentric rotor then
    differ by the order of ``m e²/Θ`` as well.

    Springs in the frame of the rotor that hold its spin, by torsion or off the axis, and springs
    that stand still with a distance between them, are complete, with the stiffness of the spin by
    their steady forces; tilts lack that stiffness.

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
    values = _checked_speeds(speeds, checks.flag(allow_negative, "allow_negative"))
    if modes is not None:
        checks.count(modes, "modes", least=1)
    tolerance = options.accuracy(tolerance, "tolerance")
    residual = options.accuracy(residual, "residual")
    options.check_sweep(executor, progress)
    model = linear_model(target, supports=supports, body=body, stiffening=stiffening)
    warn_of_structural_damping(model, "campbell finds modes")
    count = _checked_count(modes, model)
    space = model.space(count, np.abs(values).max(), residual=residual)
    if executor is not None:
        space = space.prepared(values)
    computed = model.size if model.gives_all else count
    task = _Task(space, computed, tolerance, WhirlContent.of(model))
    workers = None if space.is_shared else executor
    solved = sweep(task, values, executor=workers, progress=progress, label="Campbell")
    tracks = track([entry[0] for entry in solved], values, model.mass_matrix.__matmul__)
    solved, tracks = _lowest(solved, tracks, count)
    return _collected(values, solved, tracks, model.free_motions)


@dataclass(frozen=True, eq=False)
class _Task:
    """Solves one speed; picklable where the space is, so that processes can do it."""

    space: Space
    count: int
    tolerance: float
    content: WhirlContent

    def __call__(self, speed: float) -> Solved:
        modes = self.space.modes(speed, self.tolerance)
        return _classified(modes, speed, self.content, self.count)


Solved = tuple[FloquetModes, np.ndarray, np.ndarray, np.ndarray]


def _classified(modes: FloquetModes, speed: float, content: WhirlContent, count: int) -> Solved:
    """Return the modes with inertial frequency, whirl and nodal diameter, each (k,)."""
    vectors = modes.vectors.astype(complex)
    for group in groups(modes.values, modes.resolution):
        if len(group) > 1:
            vectors[:, :, group] = content.polarised(vectors[:, :, group], modes.orders)
    classified = content.classify(vectors, modes.orders, modes.values.imag, speed)
    lowest = FloquetModes(
        modes.values[:count], vectors[:, :, :count], modes.orders, modes.resolution
    )
    return lowest, *(array[:count] for array in classified)


def _lowest(solved: list[Solved], tracks: Tracks, count: int) -> tuple[list[Solved], Tracks]:
    """Keep the modes that have the lowest inertial frequencies at the first speed."""
    if count >= tracks.columns.shape[1]:
        return solved, tracks
    chosen = np.sort(np.argsort(solved[0][1][tracks.columns[0]], kind="stable")[:count])
    used = tracks.columns[:, chosen]
    kept = np.sort(used, axis=1)
    places = [np.searchsorted(*rows) for rows in zip(kept, used, strict=True)]
    fewer = [
        (entry[0].columns(row), *(array[row] for array in entry[1:]))
        for entry, row in zip(solved, kept, strict=True)
    ]
    return fewer, Tracks(np.array(places), tracks.continued[:, chosen])


def _collected(
    speeds: np.ndarray, solved: list[Solved], tracks: Tracks, free: tuple[str, ...]
) -> Campbell:
    modes, inertial, whirl, diameters = zip(*solved, strict=True)
    # adding zero turns −0 into 0
    eigenvalues = np.array([entry.values for entry in modes]) + 0.0
    inertial = np.array(inertial)
    growth = eigenvalues.real
    size = np.hypot(growth, inertial)
    still = size == 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        decrement = np.where(growth == 0.0, 0.0, -2.0 * np.pi * growth / inertial)
    return Campbell(
        speeds=speeds,
        frequencies_rotor=eigenvalues.imag,
        growth=growth,
        frequencies_inertial=inertial,
        damping_ratio=np.where(still, 0.0, -growth / np.where(still, 1.0, size)),
        log_decrement=decrement,
        whirl_codes=np.array(whirl, dtype=np.int64),
        nodal_diameters=np.array(diameters, dtype=np.int64),
        vectors=np.array([entry.central for entry in modes]),
        order=tracks.columns,
        continued=tracks.continued,
        free_motions=free,
    )


def _checked_speeds(speeds: ArrayLike, allow_negative: bool) -> np.ndarray:
    if allow_negative:
        return ascending(speeds, "speeds")
    turn = "pass allow_negative=True if the rotor is meant to spin the other way round"
    return ascending_from_zero(speeds, "speeds", turn)


def _checked_count(modes: int | None, model: LinearModel) -> int:
    if modes is None:
        return model.size if model.gives_all else min(_FULL_MODES, model.size)
    if modes > model.size:
        raise ValueError(f"modes: {modes} is not between 1 and the {model.size} there are")
    return int(modes)
