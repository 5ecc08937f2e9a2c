"""Eigenfrequencies over spin speed in both frames (Campbell diagram)."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import exudyn
import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.checks import ascending
from exudyn_rotor.linear import options
from exudyn_rotor.linear.equations.free import free_motions
from exudyn_rotor.linear.equations.full import FullRotor, Subspace
from exudyn_rotor.linear.equations.source import linear_source
from exudyn_rotor.linear.equations.supports import Support
from exudyn_rotor.linear.equations.system import LinearRotor
from exudyn_rotor.linear.modal.eigen import FloquetModes, floquet_modes, groups
from exudyn_rotor.linear.modal.tracking import track
from exudyn_rotor.linear.modal.whirl import WHIRLS, WhirlContent
from exudyn_rotor.linear.response.places import Source
from exudyn_rotor.multibody.rotor_body import RotorBody
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.results import Result, numbers, storable
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.sweep import ascending_from_zero, sweep

FRAMES = ("inertial", "rotating")
_FULL_MODES = 10


@storable
@dataclass(frozen=True, eq=False)
class Campbell(Result):
    """Eigenfrequencies over spin speed; column j at every speed is the j-th lowest mode.

    In the order of :meth:`tracked`, column j is the same mode at all speeds.

    Attributes
    ----------
    speeds : ndarray, shape (s,)
        Spin speeds Ω [rad/s].
    frequencies_rotating : ndarray, shape (s, k)
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
    free_motions : tuple of str
        Rigid motions that nothing holds.
    """

    speeds: np.ndarray = numbers("speeds")
    frequencies_rotating: np.ndarray = numbers("speeds", "modes")
    growth: np.ndarray = numbers("speeds", "modes")
    frequencies_inertial: np.ndarray = numbers("speeds", "modes")
    damping_ratio: np.ndarray = numbers("speeds", "modes")
    log_decrement: np.ndarray = numbers("speeds", "modes", finite=False)
    whirl_codes: np.ndarray = numbers("speeds", "modes", dtype=int, least=0, most=len(WHIRLS) - 1)
    nodal_diameters: np.ndarray = numbers("speeds", "modes", dtype=int, least=-1)
    vectors: np.ndarray = numbers("speeds", "coordinates", "modes", dtype=complex)
    order: np.ndarray = numbers("speeds", "modes", dtype=int, least=0)
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
        distance in frequency; steps in speed must be small where modes veer.
        """
        names = ("frequencies_rotating", "growth", "frequencies_inertial", "damping_ratio",
                 "log_decrement", "whirl_codes", "nodal_diameters")  # fmt: skip
        moved = {name: np.take_along_axis(getattr(self, name), self.order, 1) for name in names}
        moved["vectors"] = np.take_along_axis(self.vectors, self.order[:, None, :], 2)
        moved["order"] = np.broadcast_to(np.arange(self.order.shape[1]), self.order.shape).copy()
        return replace(self, **moved)

    def plot(self, ax: Axes | None = None, frame: str = "inertial") -> Axes:
        """Draw the tracked modes [Hz] over the spin speed [Hz]; see :mod:`exudyn_rotor.plotting`.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Those of a new figure by default.
        frame : {'inertial', 'rotating'}

        Raises
        ------
        ValueError
            For an unknown frame.
        """
        from exudyn_rotor.linear.modal.diagram import draw_campbell

        checks.choice(frame, "frame", FRAMES)
        return draw_campbell(self, ax, frame)

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
                    f"{hertz * self.frequencies_rotating[i, j]:18.6g}"
                    f"{hertz * self.frequencies_inertial[i, j]:15.6g}"
                    f"{self.damping_ratio[i, j]:15.3g}  {n if n >= 0 else '-'}  {self.whirl[i, j]}"
                )
        if self.free_motions:
            lines.append("free motions: " + ", ".join(self.free_motions))
        return "\n".join(lines)


def campbell(
    target: ReducedRotor | SolidRotor | exudyn.MainSystem,
    speeds: ArrayLike,
    *,
    supports: Sequence[Support] = (),
    body: RotorBody | None = None,
    modes: int | None = None,
    stiffening: str = "tilt",
    allow_negative: bool = False,
    tolerance: float = 1e-5,
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
    target : ReducedRotor, SolidRotor or exudyn.MainSystem
        A SolidRotor of more than 600 degrees of freedom is solved for its lowest modes, each
        checked by the residual of the full equations.
    speeds : array_like, shape (s,)
        Ascending spin speeds [rad/s].
    supports : sequence of Support, optional
        Of a rotor.
    body : RotorBody, optional
        The rotor in a scene.
    modes : int, optional
        How many of the lowest modes in the rotor frame to keep; all by default, 10 for a large
        SolidRotor.
    stiffening : {'tilt', 'none', 'full'}
        Centrifugal stiffening; 'none' gives the paper's equations, 'full' needs a rotor with
        prestress (:meth:`SolidRotor.prestress`).
    allow_negative : bool, optional
        Accept speeds below zero.
    tolerance : float, optional
        Relative residual of a large SolidRotor; eigenvalues are about its square.
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
    """
    values = _checked_speeds(speeds, checks.flag(allow_negative, "allow_negative"))
    if modes is not None:
        checks.count(modes, "modes", least=1)
    tolerance = options.accuracy(tolerance, "tolerance")
    options.check_sweep(executor, progress)
    source = linear_source(target, body=body, supports=supports, stiffening=stiffening)
    count = _checked_count(modes, source)
    content = WhirlContent.of(source)
    if isinstance(source, FullRotor):
        solver = _FullTask(Subspace(source, count, np.abs(values).max()), count, tolerance, content)
        executor, mass = None, source.invariants.M
    else:
        solver, mass = _Task(light(source), count, content), source.at(0.0).M[0]
    solved = sweep(solver, values, executor=executor, progress=progress, label="Campbell")
    order = track([entry[0] for entry in solved], values, mass.__matmul__)
    apart = getattr(source, "free_spin", None) is not None
    free = free_motions(target, getattr(source, "supports", ()), apart)
    return _collected(values, solved, order, free)


@dataclass(frozen=True, eq=False)
class _Task:
    """Solves one speed; picklable, so that processes can do it."""

    source: Source
    count: int
    content: WhirlContent

    def __call__(self, speed: float) -> Solved:
        return _classified(floquet_modes(self.source.at(speed)), speed, self.content, self.count)


@dataclass(frozen=True, eq=False)
class _FullTask:
    """Solves one speed of a full model in the subspace of all."""

    subspace: Subspace
    count: int
    tolerance: float
    content: WhirlContent

    def __call__(self, speed: float) -> Solved:
        modes = self.subspace.modes(speed, self.count, self.tolerance)
        return _classified(modes, speed, self.content, self.count)


Solved = tuple[FloquetModes, np.ndarray, np.ndarray, np.ndarray]


def _classified(modes: FloquetModes, speed: float, content: WhirlContent, count: int) -> Solved:
    """Return the modes with inertial frequency, whirl and nodal diameter, each (k,)."""
    vectors = modes.vectors.astype(complex)
    for group in groups(modes.values, modes.resolution):
        if len(group) > 1:
            vectors[:, :, group] = content.polarised(vectors[:, :, group], modes.orders)
    found = content.classify(vectors, modes.orders, modes.values.imag, speed)
    kept = FloquetModes(modes.values[:count], vectors[:, :, :count], modes.orders, modes.resolution)
    return kept, *(array[:count] for array in found)


def _collected(
    speeds: np.ndarray, solved: list[Solved], order: np.ndarray, free: tuple[str, ...]
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
        frequencies_rotating=eigenvalues.imag,
        growth=growth,
        frequencies_inertial=inertial,
        damping_ratio=np.where(still, 0.0, -growth / np.where(still, 1.0, size)),
        log_decrement=decrement,
        whirl_codes=np.array(whirl, dtype=np.int64),
        nodal_diameters=np.array(diameters, dtype=np.int64),
        vectors=np.array([entry.central for entry in modes]),
        order=order,
        free_motions=free,
    )


def light(source: Source) -> Source:
    """Return the source without mode shapes, which workers do not need."""
    if isinstance(source, LinearRotor):
        return replace(source, rotor=source.rotor.without_shapes())
    return source


def _checked_speeds(speeds: ArrayLike, allow_negative: bool) -> np.ndarray:
    if allow_negative:
        return ascending(speeds, "speeds")
    turn = "pass allow_negative=True if the rotor is meant to spin the other way round"
    return ascending_from_zero(speeds, "speeds", turn)


def _checked_count(modes: int | None, source: Source) -> int:
    if modes is None:
        return _FULL_MODES if isinstance(source, FullRotor) else source.size
    if modes > source.size:
        raise ValueError(f"modes: {modes} is not between 1 and the {source.size} there are")
    return int(modes)
