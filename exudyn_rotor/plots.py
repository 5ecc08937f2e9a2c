"""Pictures of results: orbits, time histories with their deviation, Campbell diagrams."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

if TYPE_CHECKING:
    from exudyn_rotor.linear.modal.campbell import Campbell

# colours that stay apart in grey and for colour-blind readers (Okabe and Ito)
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00")
LINES = ("-", "--", ":", "-.", (0, (1, 1)))


def figure(rows: int = 1, columns: int = 1, size: tuple[float, float] = (7.0, 4.5), **options):
    """Return a figure that needs no display, and its axes."""
    made = Figure(figsize=size, layout="constrained")
    return made, made.subplots(rows, columns, **options)


def save(made: Figure, path: str | PathLike) -> None:
    """Write a figure as PNG."""
    made.savefig(path, dpi=140)


def plot_orbits(axes: Axes, orbits: Mapping[str, np.ndarray]) -> Axes:
    """Draw orbits, each (steps, 2) [m], in inertial axes and micrometres."""
    for (label, points), color, line in zip(orbits.items(), COLORS, LINES, strict=False):
        axes.plot(1e6 * points[:, 0], 1e6 * points[:, 1], line, color=color, lw=1.3, label=label)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("horizontal displacement [µm]")
    axes.set_ylabel("vertical displacement [µm]")
    axes.grid(alpha=0.3)
    legend_above(axes, columns=1)
    return axes


def plot_histories(axes: Axes, time: np.ndarray, histories: Mapping[str, np.ndarray]) -> Axes:
    """Draw displacements [m] over time [s], in micrometres."""
    for (label, values), color, line in zip(histories.items(), COLORS, LINES, strict=False):
        axes.plot(time, 1e6 * values, line, color=color, lw=1.0, label=label)
    axes.set_ylabel("displacement [µm]")
    axes.grid(alpha=0.3)
    legend_above(axes)
    return axes


def plot_deviation(axes: Axes, time: np.ndarray, deviations: Mapping[str, np.ndarray]) -> Axes:
    """Draw absolute deviations [m] over time [s] on a logarithmic scale, in micrometres."""
    styles = zip(deviations.items(), COLORS[1:], LINES[1:], strict=False)
    for (label, values), color, line in styles:
        axes.semilogy(time, 1e6 * np.maximum(values, 1e-15), line, color=color, lw=1.0, label=label)
    axes.set_ylabel("deviation [µm]")
    axes.set_xlabel("time [s]")
    axes.grid(alpha=0.3, which="both")
    legend_above(axes)
    return axes


def plot_campbell(axes: Axes, result: Campbell) -> Axes:
    """Draw rotor-frame frequencies [Hz] over spin speed [Hz]."""
    hertz = 1.0 / (2.0 * np.pi)
    axes.plot(hertz * result.speeds, hertz * result.frequencies_rotating, color=COLORS[0], lw=1.3)
    axes.set_xlabel("spin speed [Hz]")
    axes.set_ylabel("frequency in the rotor frame [Hz]")
    axes.set_ylim(bottom=0.0)
    axes.grid(alpha=0.3)
    return axes


def legend_above(axes: Axes, columns: int = 2, handles: list | None = None) -> None:
    """Put the legend above the axes, where it hides nothing."""
    shown = {} if handles is None else {"handles": handles}
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns, frameon=False, **shown)
