"""Pictures of results: orbits, time histories with their deviation, Campbell diagrams."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, NullLocator
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from mpl_toolkits.mplot3d.proj3d import proj_transform

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
    """Return a picture of nodal values on a surface; a long body lies across the picture.

    Parameters
    ----------
    positions : ndarray, shape (n, 3)
        Nodes [m].
    triangles : ndarray of int, shape (t, 3) or (t, 6)
    values : ndarray, shape (n,)
    label : str
        Of the colour bar.

    Raises
    ------
    ValueError
        If there are no triangles, or not one value per node.
    """
    _check_surface(positions, triangles, values)
    corners = triangles
    if triangles.shape[1] == 6:
        corners = triangles[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]].reshape(-1, 3)
    mapped = ScalarMappable(cmap="viridis")
    mapped.set_array(values[corners].mean(axis=1))
    colors = mapped.to_rgba(mapped.get_array())
    made = Figure()
    axes = made.add_subplot(projection="3d")
    # edges of the faces' own colour close the gaps between them
    faces = Poly3DCollection(positions[corners], facecolors=colors, edgecolors=colors, lw=0.3)
    axes.add_collection3d(faces)
    place = _fit(axes, *_frame(axes, positions[np.unique(corners)]))
    made.colorbar(mapped, cax=made.add_axes(place), label=label)
    return made


def _check_surface(positions: np.ndarray, triangles: np.ndarray, values: np.ndarray) -> None:
    if len(triangles) == 0:
        raise ValueError(
            "triangles: there are none, so there is no surface to draw; models from NGSolve have "
            "one, others need triangles=…"
        )
    if np.shape(values) != (len(positions),):
        raise ValueError(
            f"values: needs one for each of the {len(positions)} nodes, got the shape "
            f"{np.shape(values)}"
        )


_LONG = 1.5  # a body longer than this times its width lies across the picture, without axes
_THIN = 0.3  # tick labels of an axis shorter than this share of the longest would overlap
# elevation, azimuth and roll [deg] that let the axis x, y or z of a long body point to the right
_ACROSS = ((20.0, -75.0, 0.0), (20.0, 15.0, 0.0), (20.0, -160.0, -90.0))


def _frame(axes: Axes, points: np.ndarray) -> tuple[np.ndarray, float]:
    """Set limits, view and axes for a body; return the points to fit in and the margin [inch]."""
    low, high = points.min(axis=0), points.max(axis=0)
    size = high - low
    longest, share = int(np.argmax(size)), size / size.max()
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(np.maximum(share, 1e-3), zoom=0.85)
    axes.patch.set_visible(False)  # it may reach under the colour bar
    if np.sort(share)[1] < 1.0 / _LONG:  # ticks would stand in the body itself
        axes.view_init(*_ACROSS[longest])
        axes.set_axis_off()
        axes.figure.text(0.02, 0.03, _extents(low, high, longest))
        return points, 0.4
    for name, part, pad in zip("xyz", share, (22.0, 22.0, 12.0), strict=True):
        shown = part >= _THIN
        getattr(axes, f"set_{name}label")(f"{name} [m]" if shown else "", labelpad=pad)
        locator = MaxNLocator(max(2, round(4 * part)), prune="both") if shown else NullLocator()
        getattr(axes, f"{name}axis").set_major_locator(locator)
    return np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, 8).T, 0.7


def _extents(low: np.ndarray, high: np.ndarray, longest: int) -> str:
    others = [f"{high[i] - low[i]:.4g} m in {'xyz'[i]}" for i in range(3) if i != longest]
    along = f"{'xyz'[longest]} from {low[longest]:.4g} m to {high[longest]:.4g} m"
    return f"{along}, left to right; {', '.join(others)}"


def _fit(axes: Axes, points: np.ndarray, margin: float) -> tuple[float, float, float, float]:
    """Let a body between `points` fill the figure; return the place of the colour bar."""
    bar = 1.35  # inch
    flat = np.stack(proj_transform(*points.T, axes.get_proj())[:2], axis=1)
    flat = (axes.transData - axes.transAxes).transform(flat)
    low, size = flat.min(axis=0), np.ptp(flat, axis=0)
    side = min(6.0 / size[0], 4.5 / size[1])  # of the axes, which are square
    body = np.maximum(side * size + 2.0 * margin, (4.5, 2.5))
    whole = body + np.array([bar, 0.0])
    axes.figure.set_size_inches(whole)
    axes.set_position((*((0.5 * body - side * (low + 0.5 * size)) / whole), *(side / whole)))
    return (body[0] + 0.15) / whole[0], 0.15, 0.2 / whole[0], 0.7


def legend_above(axes: Axes, columns: int = 2, handles: list | None = None) -> None:
    """Put the legend above the axes, where it hides nothing."""
    shown = {} if handles is None else {"handles": handles}
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns, frameon=False, **shown)
