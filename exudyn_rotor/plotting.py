"""Pictures of results: one style, figures of pyplot, axes given or new.

Matplotlib takes most of a second: functions import it where they draw.
"""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from itertools import cycle
from os import PathLike
from typing import TYPE_CHECKING
from weakref import WeakSet

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.solid.matrices import as_triangles
from exudyn_rotor.solid.surface import flat_triangles
from exudyn_rotor.storage import write_bytes

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.legend import Legend
    from matplotlib.text import Annotation
    from mpl_toolkits.mplot3d import Axes3D


# colours that stay apart in grey and for colour-blind readers (Okabe and Ito)
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
LINES = ("-", "--", ":", "-.", (0, (1, 1)))

_made: WeakSet[Figure] = WeakSet()  # figures of this package that are alive

_WIDEST = 1.1  # a legend, in widths of its axes
_ZOOM = 0.75  # of a body in space, so that the labels of its axes are within the figure
_LINE = 1.2  # from a line of text to the next, in sizes of its letters


def figure(rows: int = 1, columns: int = 1, size: tuple[float, float] = (7.0, 4.5), **options):
    """Return a new figure of pyplot, and its axes; `options` go to ``pyplot.subplots``.

    As all figures of pyplot it is shown by ``pyplot.show()`` and at the end of a notebook's cell,
    and stays open until it is closed; see :func:`save`.
    """
    from matplotlib import pyplot

    made, axes = pyplot.subplots(rows, columns, figsize=size, layout="constrained", **options)
    _made.add(made)
    return made, axes


def axes_or_new(ax: Axes | None, size: tuple[float, float] = (7.0, 4.5)) -> Axes:
    """Return the given axes, or those of a new figure of pyplot for None."""
    if ax is None:
        return figure(size=size)[1]
    from matplotlib.axes import Axes

    return checks.instance(ax, "ax", Axes, "make some with matplotlib.pyplot.subplots()")


def whole_figure(drawn: Artist) -> Figure:
    """Return the figure of something drawn, also where that stands in a part of it (SubFigure)."""
    return drawn.figure.canvas.figure


def save(drawn: Axes | Figure | np.ndarray, path: str | PathLike) -> None:
    """Write the figure of axes, or of an array of them, or a figure.

    A name without an ending gets '.png'. A file of that name is replaced only by a complete one.
    Where no window and no notebook can show it, a figure that this package has made is closed
    afterwards, so that a script that saves many keeps none in memory.
    """
    from matplotlib import get_backend, pyplot
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    one = drawn.flat[0] if isinstance(drawn, np.ndarray) and drawn.size else drawn
    checks.instance(one, "drawn", (Axes, Figure))
    made = whole_figure(one)
    target, content = checks.path(path), io.BytesIO()
    if not target.suffix:
        target = target.with_suffix(".png")
    made.savefig(content, format=target.suffix[1:], dpi=140)
    write_bytes(target, content.getvalue())
    if made in _made and get_backend().lower() == "agg":  # which shows nothing
        pyplot.close(made)


def plot_orbits(ax: Axes, orbits: Mapping[str, np.ndarray]) -> Axes:
    """Draw orbits, each (steps, 2) [m], in inertial axes and micrometres."""
    for (label, points), color, line in zip(orbits.items(), cycle(COLORS), cycle(LINES)):
        ax.plot(1e6 * points[:, 0], 1e6 * points[:, 1], ls=line, color=color, lw=1.3, label=label)
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel("horizontal displacement [µm]")
    ax.set_ylabel("vertical displacement [µm]")
    ax.grid(alpha=0.3)
    legend_above(ax, columns=1)
    return ax


def draw_surface(
    positions: ArrayLike,
    triangles: ArrayLike,
    values: ArrayLike,
    label: str,
    ax: Axes3D | None = None,
    *,
    room: ArrayLike | None = None,
) -> Axes3D:
    """Draw nodal values on a surface.

    Parameters
    ----------
    positions : array_like, shape (n, 3)
        Nodes [m].
    triangles : array_like of int, shape (t, 3) or (t, 6)
    values : array_like, shape (n,)
    label : str
        Of the colour bar.
    ax : Axes3D, optional
        Made by ``pyplot.subplots(subplot_kw={"projection": "3d"})``; those of a new figure by
        default.
    room : array_like, shape (p, 3), optional
        Points between which the picture reaches, those of the surface by default [m].

    Raises
    ------
    TypeError
        If an argument is of another kind; `ax` without a third dimension is.
    ValueError
        If there are no triangles, or not one finite value per node.

    Examples
    --------
    >>> from matplotlib import pyplot
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> faces = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]
    >>> ax = draw_surface(corners, faces, [0, 1, 2, 3], "temperature [K]")
    >>> ax.figure.axes[1].get_ylabel()
    'temperature [K]'
    >>> pyplot.close(ax.figure)
    """
    from matplotlib.cm import ScalarMappable
    from matplotlib.ticker import MaxNLocator
    from mpl_toolkits.mplot3d import Axes3D
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    positions = checks.array(positions, "positions", "m", shape=(None, 3))
    corners = flat_triangles(as_triangles(triangles, len(positions)))
    if not corners.size:
        raise ValueError(
            "triangles: there are none, so there is no surface to draw; models from NGSolve have "
            "one, others need triangles=…"
        )
    values = checks.array(values, "values", shape=(len(positions),))
    checks.label(label, "label")
    mapped = ScalarMappable(cmap="viridis")
    mapped.set_array(values[corners].mean(axis=1))
    colors = mapped.to_rgba(mapped.get_array())
    points = positions[np.unique(corners)]
    if room is not None:
        points = checks.array(room, "room", "m", shape=(None, 3))
    if ax is None:
        ax = figure(subplot_kw={"projection": "3d"})[1]
    checks.instance(ax, "ax", Axes3D, 'subplot_kw={"projection": "3d"} of pyplot.subplots')
    # edges of the faces' own colour close the gaps between them
    faces = Poly3DCollection(positions[corners], facecolors=colors, edgecolors=colors, lw=0.3)
    ax.add_collection3d(faces)
    low, high = points.min(axis=0), points.max(axis=0)
    around = 0.5 * np.maximum(0.2 * np.max(high - low) - (high - low), 0.0)  # of a slender body
    for name, start, end in zip("xyz", low - around, high + around, strict=True):
        ax.set(**{f"{name}lim": (start, end)})
        getattr(ax, f"set_{name}label")(f"{name} [m]", labelpad=10.0)
        getattr(ax, f"{name}axis").set_major_locator(MaxNLocator(3))
    ax.tick_params(labelsize="small")
    ax.tick_params("z", pad=10.0)
    ax.zaxis.labelpad = 20.0  # beside its ticks, which are as long as numbers
    ax.set_aspect("equal")
    ax.set_box_aspect(np.ptp([low - around, high + around], axis=0), zoom=_ZOOM)
    ax.figure.colorbar(mapped, ax=ax, label=label, pad=0.15, shrink=0.8)
    return ax


def keep_apart(labels: Sequence[Annotation]) -> None:
    """Move each label, offset in points from its place, up until it is clear of those before."""
    for index, label in enumerate(labels):
        if index == 0:
            # limits and layout are settled by drawing
            whole_figure(label).draw_without_rendering()
        for _ in labels:
            box = label.get_window_extent()
            if not any(box.overlaps(other.get_window_extent()) for other in labels[:index]):
                break
            x, y = label.get_position()
            label.set_position((x, y + _LINE * label.get_fontsize()))


def legend_above(ax: Axes, columns: int = 2, handles: list[Artist] | None = None) -> Legend:
    """Put the legend above the axes, where it hides nothing, in fewer columns where it is wide.

    With the `handles` given, or all that have labels.
    """
    handles = ax.get_legend_handles_labels()[0] if handles is None else handles
    for count in range(columns, 0, -1):
        place = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0)}
        legend = ax.legend(handles=handles, ncols=count, frameon=False, **place)
        if legend.get_window_extent().width <= _WIDEST * ax.bbox.width:
            break
    return legend
