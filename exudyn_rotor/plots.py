"""Pictures of results: orbits, time histories with their deviation, Campbell diagrams."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

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


def draw_surface(
    positions: np.ndarray, triangles: np.ndarray, values: np.ndarray, label: str
) -> Figure:
    """Return a picture of nodal values on a surface.

    Parameters
    ----------
    positions : ndarray, shape (n, 3)
        Nodes [m].
    triangles : ndarray of int, shape (t, 3) or (t, 6)
    values : ndarray, shape (n,)
    label : str
        Of the colour bar.
    """
    corners = triangles
    if triangles.shape[1] == 6:
        corners = triangles[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]].reshape(-1, 3)
    mapped = ScalarMappable(cmap="viridis")
    mapped.set_array(values[corners].mean(axis=1))
    colors = mapped.to_rgba(mapped.get_array())
    made = Figure(figsize=(8.0, 5.0), layout="constrained")
    axes = made.add_subplot(projection="3d")
    # edges of the faces' own colour close the gaps between them
    faces = Poly3DCollection(positions[corners], facecolors=colors, edgecolors=colors, lw=0.3)
    axes.add_collection3d(faces)
    low, high = positions.min(axis=0), positions.max(axis=0)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(np.maximum(high - low, 1e-3 * np.max(high - low)), zoom=0.85)
    for name, extent in zip("xyz", (high - low) / np.max(high - low), strict=True):
        getattr(axes, f"set_{name}label")(f"{name} [m]", labelpad=8.0)
        axes.locator_params(axis=name, nbins=max(1, round(5 * extent)))
    made.colorbar(mapped, ax=axes, label=label, shrink=0.7)
    return made


def legend_above(axes: Axes, columns: int = 2, handles: list | None = None) -> None:
    """Put the legend above the axes, where it hides nothing."""
    shown = {} if handles is None else {"handles": handles}
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns, frameon=False, **shown)
