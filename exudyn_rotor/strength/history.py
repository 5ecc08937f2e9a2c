"""Stress over a run: peaks at all nodes, and time histories where it is highest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks, plotting
from exudyn_rotor.results import Result, numbers, storable
from exudyn_rotor.solid.elements import principal, von_mises
from exudyn_rotor.strength.field import StressField, warn_without_static
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from mpl_toolkits.mplot3d import Axes3D


_CHUNK = 2_000_000  # values of a stress history held at a time


@storable
@dataclass(frozen=True, eq=False)
class StressHistory(Result):
    """Stress of a rotor over a run; made by :func:`stress_history`.

    Attributes
    ----------
    time : ndarray, shape (s,)
        [s]
    speed : ndarray, shape (s,)
        Spin speed [rad/s].
    nodes : ndarray of int, shape (c,)
        Mesh nodes with a time history, the highest peak first.
    stress : ndarray, shape (s, c, 6)
        Components xx, yy, zz, yz, xz, xy in mesh axes, which turn with the rotor [Pa]. This is the
        input of a fatigue analysis.
    peak : ndarray, shape (n,)
        Largest von Mises stress of every mesh node over the run [Pa].
    peak_time : ndarray, shape (n,)
        When it occurred [s].
    positions, triangles : ndarray
        Mesh nodes (n, 3) [m] and surface.

    Examples
    --------
    Two nodes, the second under 1 MPa along x at the end:

    >>> import numpy as np
    >>> stress = np.zeros((2, 1, 6))
    >>> stress[1, 0, 0] = 1e6
    >>> history = StressHistory(
    ...     time=[0.0, 1.0], speed=[0.0, 300.0], nodes=[1], stress=stress, peak=[0.0, 1e6],
    ...     peak_time=[0.0, 1.0], positions=[[0, 0, 0], [1, 0, 0]], triangles=np.zeros((0, 3), int),
    ... )
    >>> print(history.hottest, history.von_mises[:, 0])
    1 [      0. 1000000.]
    """

    time: np.ndarray = numbers("steps")
    speed: np.ndarray = numbers("steps")
    nodes: np.ndarray = numbers("chosen", dtype=int, least=0)
    stress: np.ndarray = numbers("steps", "chosen", 6)
    peak: np.ndarray = numbers("nodes", least=0.0)
    peak_time: np.ndarray = numbers("nodes")
    positions: np.ndarray = numbers("nodes", 3)
    triangles: np.ndarray = numbers("triangles", "corners", dtype=int, least=0)

    @property
    def von_mises(self) -> np.ndarray:
        """Von Mises stress of the nodes with a history, shape (s, c) [Pa]."""
        return von_mises(self.stress)

    @property
    def principal(self) -> np.ndarray:
        """Principal stresses of these nodes, largest first, shape (s, c, 3) [Pa]."""
        return principal(self.stress)

    @property
    def hottest(self) -> int:
        """Mesh node with the highest von Mises stress of the run."""
        return int(np.argmax(self.peak))

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return a row for each node with a history; `units` change nothing."""
        Units.of(units)
        return {
            "node": self.nodes,
            **{f"{axis} [m]": self.positions[self.nodes, i] for i, axis in enumerate("xyz")},
            "peak von Mises stress [Pa]": self.peak[self.nodes],
            "at [s]": self.peak_time[self.nodes],
            "range of the first principal stress [Pa]": np.ptp(self.principal[:, :, 0], axis=0),
        }

    def plot(self, ax: Axes | None = None, count: int = 3) -> Axes:
        """Draw the von Mises stress [MPa] of the first `count` nodes over time.

        `ax` are axes to draw in; those of a new figure by default.
        """
        count = checks.count(count, "count", least=1)
        ax = plotting.axes_or_new(ax)
        stresses = 1e-6 * self.von_mises.T[:count]
        for node, values, color in zip(self.nodes, stresses, plotting.COLORS, strict=False):
            ax.plot(self.time, values, color=color, lw=1.0, label=f"node {node}")
        ax.set_xlabel("time [s]")
        ax.set_ylabel("von Mises stress [MPa]")
        ax.grid(alpha=0.3)
        plotting.legend_above(ax, columns=3)
        return ax

    def plot_peak(self, ax: Axes3D | None = None) -> Axes3D:
        """Draw the peak of the run on the surface [MPa]; `ax` are 3D axes to draw in."""
        label = "largest von Mises stress [MPa]"
        return plotting.draw_surface(self.positions, self.triangles, 1e-6 * self.peak, label, ax)


def stress_history(
    field: StressField,
    time: ArrayLike,
    modal_coordinates: ArrayLike,
    speed: ArrayLike | float,
    *,
    nodes: Sequence[int] | None = None,
    count: int = 10,
) -> StressHistory:
    """Return peaks at all nodes and histories at chosen ones.

    Parameters
    ----------
    field : StressField
    time : array_like, shape (s,)
        [s]
    modal_coordinates : array_like, shape (s, m)
        Over time; a native sensor of ``body.nodes["modes"]`` records them.
    speed : array_like, shape (s,), or float
        Spin speed [rad/s].
    nodes : sequence of int, optional
        Mesh nodes that get a history, for instance ``rotor.interfaces[name].nodes``; the hottest
        `count` by default.
    count : int
        Number of nodes with a history, at least 1; without effect where `nodes` are given.

    Raises
    ------
    TypeError
        If an argument is of another kind.
    ValueError
        If shapes do not fit, values are not finite, a node does not exist, or `count` is below 1.

    Examples
    --------
    A bar whose stress along z is its only modal coordinate, and 1 Pa at 1 rad/s by the spin:

    >>> import numpy as np
    >>> nodes = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> along = np.zeros((4, 6))
    >>> along[:, 2] = 1.0
    >>> field = StressField(nodes, [[0, 1, 2]], along[:, :, None], along, True)
    >>> history = stress_history(field, [0.0, 1.0], [[5.0], [-2.0]], speed=[0.0, 3.0], count=1)
    >>> print(history.peak, history.von_mises[:, 0])
    [7. 7. 7. 7.] [5. 7.]
    """
    how = "make one with StressField.of(reduced, body)"
    time = checks.vector(time, "time", "s", size=None)
    shape = time.size, checks.instance(field, "field", StressField, how).modes.shape[2]
    coordinates = checks.array(modal_coordinates, "modal_coordinates", shape=shape)
    speed = checks.one_or_each(speed, "speed", "rad/s", time.size)
    count = checks.count(count, "count", least=1)
    warn_without_static(field, speed)
    peak, when = _envelope(field, coordinates, speed)
    chosen = np.argsort(peak)[::-1]
    if nodes is None:
        chosen = chosen[:count]
    else:
        given = checks.whole_numbers(nodes, "nodes", most=len(peak) - 1)
        chosen = chosen[np.isin(chosen, given)]
        if not chosen.size:
            raise ValueError(f"nodes: needs node numbers from 0 to {len(peak) - 1}, got none")
    return StressHistory(
        time=time,
        speed=speed,
        nodes=chosen,
        stress=field.history(coordinates, speed, chosen),
        peak=peak,
        peak_time=time[when],
        positions=field.positions,
        triangles=field.triangles,
    )


def _envelope(
    field: StressField, coordinates: np.ndarray, speed: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the largest von Mises stress of every node and its time index; chunks of nodes."""
    total = len(field.positions)
    width = max(1, _CHUNK // (6 * len(coordinates)))
    peak, when = np.zeros(total), np.zeros(total, dtype=np.int64)
    for start in range(0, total, width):
        rows = slice(start, start + width)
        values = von_mises(field.history(coordinates, speed, rows))
        when[rows] = np.argmax(values, axis=0)
        peak[rows] = values.max(axis=0)
    return peak, when
