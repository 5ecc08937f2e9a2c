"""Eigenfrequencies over spin speed: what a Campbell diagram shows."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes

from exudyn_rotor import checks, plotting
from exudyn_rotor.linear.modal.campbell_diagram import draw_campbell
from exudyn_rotor.linear.modal.whirl import WHIRLS
from exudyn_rotor.linear.periodic.rotating_axes import FRAMES
from exudyn_rotor.results import Result, numbers, storable

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
