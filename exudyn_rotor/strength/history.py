"""Stress over a run: peaks at all nodes, and time histories where it is highest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from numbers import Integral

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike
from tqdm import tqdm

from exudyn_rotor import checks, plotting
from exudyn_rotor.results import Result, numbers, storable
from exudyn_rotor.solid.tensor import principal, von_mises
from exudyn_rotor.strength.field import StressField, warn_without_static

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
    """

    time: np.ndarray = numbers("steps")
    speed: np.ndarray = numbers("steps")
    nodes: np.ndarray = numbers("chosen", dtype=int, least=0)
    stress: np.ndarray = numbers("steps", "chosen", 6)
    peak: np.ndarray = numbers("nodes", least=0.0)
    peak_time: np.ndarray = numbers("nodes")
    positions: np.ndarray = numbers("nodes", 3)
    triangles: np.ndarray = numbers("triangles", "corners", dtype=int, least=0)

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("nodes", "triangles"):
            checks.whole_numbers(getattr(self, name).ravel(), name, most=len(self.positions) - 1)
        if self.triangles.shape[1] not in (3, 6):
            raise ValueError(f"triangles: needs 3 or 6 columns, got {self.triangles.shape[1]}")

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

    def table(self) -> str:
        """Return the nodes with a history, their places, peaks and ranges as text."""
        ranges = 1e-6 * np.ptp(self.principal[:, :, 0], axis=0)
        lines = ["   node   place [m]                      peak [MPa]  at [s]     range σ1 [MPa]"]
        for node, span in zip(self.nodes, ranges, strict=True):
            place = " ".join(f"{x:9.4f}" for x in self.positions[node])
            lines.append(
                f"{node:7d}   {place}  {1e-6 * self.peak[node]:11.4g}  "
                f"{self.peak_time[node]:<9.4g}  {span:.4g}"
            )
        return "\n".join(lines)

    def plot(self, axes: Axes | None = None, count: int = 3) -> Figure:
        """Draw the von Mises stress of the first `count` nodes over time [MPa]."""
        made = None
        if axes is None:
            made, axes = plotting.figure()
        values = 1e-6 * self.von_mises
        for index, color in zip(range(min(count, len(self.nodes))), plotting.COLORS, strict=False):
            label = f"node {self.nodes[index]}"
            axes.plot(self.time, values[:, index], color=color, lw=1.0, label=label)
        axes.set_xlabel("time [s]")
        axes.set_ylabel("von Mises stress [MPa]")
        axes.grid(alpha=0.3)
        plotting.legend_above(axes, columns=3)
        return made or axes.figure

    def plot_peak(self) -> Figure:
        """Draw the peak of the run on the surface [MPa]."""
        label = "largest von Mises stress [MPa]"
        return plotting.draw_surface(self.positions, self.triangles, 1e-6 * self.peak, label)


def stress_history(
    field: StressField,
    time: ArrayLike,
    zeta: ArrayLike,
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
    zeta : array_like, shape (s, m)
        Modal coordinates over time; a native sensor of ``body.nodes["modes"]`` records them.
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
        If `field` is no StressField.
    ValueError
        If shapes do not fit, values are not finite, a node does not exist, or `count` is below 1.
    """
    time, zeta, speed = _checked(field, time, zeta, speed)
    chosen = None if nodes is None else _node_numbers(nodes, len(field.positions))
    if not isinstance(count, Integral) or count < 1:
        raise ValueError(f"count: needs a number of nodes, 1 or more, got {count!r}")
    warn_without_static(field, speed)
    peak, when = _envelope(field, zeta, speed)
    if chosen is None:
        chosen = np.argsort(peak)[::-1][:count]
    else:
        chosen = chosen[np.argsort(peak[chosen])[::-1]]
    return StressHistory(
        time=time,
        speed=speed,
        nodes=chosen,
        stress=field.history(zeta, speed, chosen),
        peak=peak,
        peak_time=time[when],
        positions=field.positions,
        triangles=field.triangles,
    )


def _checked(
    field: StressField, time: ArrayLike, zeta: ArrayLike, speed: ArrayLike | float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    if not isinstance(field, StressField):
        raise TypeError(
            f"field: expected a StressField, got {type(field).__name__}; make one with "
            "StressField.of(reduced, body)"
        )
    time, zeta = np.asarray(time, dtype=float), np.asarray(zeta, dtype=float)
    wanted = (time.size, field.modes.shape[2])
    if time.ndim != 1 or zeta.shape != wanted or time.size == 0:
        raise ValueError(
            f"zeta: needs one row of {wanted[1]} modal coordinates for each of the "
            f"{time.size} times, got the shape {zeta.shape}"
        )
    speed = np.asarray(speed, dtype=float)
    if speed.shape not in ((), time.shape):
        raise ValueError(
            f"speed: needs one number, or one for each of the {time.size} times, got the shape "
            f"{speed.shape}"
        )
    speed = np.broadcast_to(speed, time.shape)
    for name, values in (("time", time), ("zeta", zeta), ("speed", speed)):
        if not np.all(np.isfinite(values)):
            raise ValueError(f"{name}: has values that are not finite; the run may have failed")
    return time, zeta, speed


def _node_numbers(nodes: Sequence[int], total: int) -> np.ndarray:
    """Return chosen node numbers as an array; a message names the first that does not fit."""
    numbers, wanted = np.asarray(nodes), f"nodes: needs node numbers from 0 to {total - 1}"
    if numbers.ndim != 1 or numbers.size == 0 or numbers.dtype.kind not in "iu":
        kind = "a mask; use np.flatnonzero(mask)" if numbers.dtype.kind == "b" else numbers.dtype
        raise ValueError(f"{wanted} in one row, got the shape {numbers.shape} of {kind}")
    outside = numbers[(numbers < 0) | (numbers >= total)]
    if outside.size:
        raise ValueError(f"{wanted}, got {outside[0]}")
    return numbers


def _envelope(
    field: StressField, zeta: np.ndarray, speed: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the largest von Mises stress of every node and its time index; chunks of nodes."""
    total = len(field.positions)
    width = max(1, _CHUNK // (6 * len(zeta)))
    peak, when = np.zeros(total), np.zeros(total, dtype=np.int64)
    for start in tqdm(range(0, total, width), desc="stress", disable=total < 20 * width):
        part = slice(start, start + width)
        values = von_mises(field.history(zeta, speed, part))
        when[part] = np.argmax(values, axis=0)
        peak[part] = values.max(axis=0)
    return peak, when
