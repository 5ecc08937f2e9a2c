"""Pictures of results: one style, figures of pyplot, axes given or new.

Matplotlib takes most of a second: functions import it where they draw.
"""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING
from weakref import WeakSet

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.storage import write_bytes

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.legend import Legend
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch
    from matplotlib.text import Annotation
    from mpl_toolkits.mplot3d import Axes3D


# colours that stay apart in grey and for colour-blind readers (Okabe and Ito)
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
LINES = ("-", "--", ":", "-.", (0, (1, 1)))

_made: WeakSet[Figure] = WeakSet()  # figures of this package that are alive

_WIDEST = 1.1  # a legend, in widths of its axes
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
    _close_unseen(made)


def _close_unseen(made: Figure) -> None:
    """Take a figure of this package from those of pyplot, where the backend only writes files."""
    from matplotlib import get_backend, pyplot
    from matplotlib.backends import BackendFilter, backend_registry

    files_only = backend_registry.list_builtin(BackendFilter.NON_INTERACTIVE)
    if made in _made and get_backend().lower() in files_only:
        pyplot.close(made)


def plot_orbits(ax: Axes, orbits: Mapping[str, np.ndarray]) -> Axes:
    """Draw orbits, each (steps, 2) [m], in inertial axes and micrometres."""
    for (label, points), color, line in zip(orbits.items(), COLORS, LINES, strict=False):
        ax.plot(1e6 * points[:, 0], 1e6 * points[:, 1], line, color=color, lw=1.3, label=label)
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel("horizontal displacement [µm]")
    ax.set_ylabel("vertical displacement [µm]")
    ax.grid(alpha=0.3)
    legend_above(ax, columns=1)
    return ax


def plot_histories(ax: Axes, time: np.ndarray, histories: Mapping[str, np.ndarray]) -> Axes:
    """Draw displacements [m] over time [s], in micrometres."""
    for (label, values), color, line in zip(histories.items(), COLORS, LINES, strict=False):
        ax.plot(time, 1e6 * values, line, color=color, lw=1.0, label=label)
    ax.set_ylabel("displacement [µm]")
    ax.grid(alpha=0.3)
    legend_above(ax)
    return ax


def plot_deviation(ax: Axes, time: np.ndarray, deviations: Mapping[str, np.ndarray]) -> Axes:
    """Draw absolute deviations [m] over time [s] on a logarithmic scale, in micrometres."""
    styles = zip(deviations.items(), COLORS[1:], LINES[1:], strict=False)
    for (label, values), color, line in styles:
        ax.semilogy(time, 1e6 * np.maximum(values, 1e-15), line, color=color, lw=1.0, label=label)
    ax.set_ylabel("deviation [µm]")
    ax.set_xlabel("time [s]")
    ax.grid(alpha=0.3, which="both")
    legend_above(ax)
    return ax


def draw_surface(
    positions: ArrayLike,
    triangles: ArrayLike,
    values: ArrayLike,
    label: str,
    ax: Axes3D | None = None,
    *,
    room: ArrayLike | None = None,
    undeformed: ArrayLike | None = None,
) -> Axes3D:
    """Draw nodal values on a surface.

    In a new figure, a long body lies across the picture, which is as large as the body needs.

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
        Points between which the picture reaches, where that is more than the surface [m].
    undeformed : array_like, shape (n, 3), optional
        Nodes of the body at rest, where `positions` are displaced ones [m]; a picture without axes
        gives their extents.

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
    from matplotlib import pyplot
    from matplotlib.cm import ScalarMappable
    from mpl_toolkits.mplot3d import Axes3D
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    positions, triangles, values = _checked_surface(positions, triangles, values)
    checks.label(label, "label")
    corners = triangles
    if triangles.shape[1] == 6:
        corners = triangles[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]].reshape(-1, 3)
    mapped = ScalarMappable(cmap="viridis")
    mapped.set_array(values[corners].mean(axis=1))
    colors = mapped.to_rgba(mapped.get_array())
    # edges of the faces' own colour close the gaps between them
    faces = Poly3DCollection(positions[corners], facecolors=colors, edgecolors=colors, lw=0.3)
    points = positions[np.unique(corners)]
    body = points
    if undeformed is not None:
        body = checks.array(undeformed, "undeformed", "m", shape=positions.shape)
        body = body[np.unique(corners)]
    if room is not None:
        points = np.vstack([points, checks.array(room, "room", "m", shape=(None, 3))])
    if ax is not None:
        checks.instance(ax, "ax", Axes3D, 'subplot_kw={"projection": "3d"} of pyplot.subplots')
        ax.add_collection3d(faces)
        _frame(ax, points)
        if _is_long(points):
            ax.set_title(_extents(body, points), fontsize="small")
        for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
            axis.labelpad = 8.0  # given axes are small
        ax.figure.colorbar(mapped, ax=ax, label=label, pad=0.15, shrink=0.8)
        return ax
    made = pyplot.figure()
    _made.add(made)
    ax = made.add_subplot(projection="3d")
    ax.add_collection3d(faces)
    place = _fit(ax, *_frame(ax, points))
    if _is_long(points):
        made.text(0.02, 0.03, _extents(body, points))
    made.colorbar(mapped, cax=made.add_axes(place), label=label)
    pyplot.sca(ax)
    return ax


def _checked_surface(
    positions: ArrayLike, triangles: ArrayLike, values: ArrayLike
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    if np.size(triangles) == 0:
        raise ValueError(
            "triangles: there are none, so there is no surface to draw; models from NGSolve have "
            "one, others need triangles=…"
        )
    positions = checks.array(positions, "positions", "m", shape=(None, 3))
    triangles = checks.array(triangles, "triangles", shape=(None, None), dtype=int)
    if triangles.shape[1] not in (3, 6):
        raise ValueError(f"triangles: needs 3 or 6 nodes each, got {triangles.shape[1]}")
    checks.whole_numbers(triangles.ravel(), "triangles", most=len(positions) - 1)
    values = checks.array(values, "values")
    if values.shape != (len(positions),):
        raise ValueError(
            f"values: needs one for each of the {len(positions)} nodes, got the shape "
            f"{values.shape}"
        )
    return positions, triangles, values


_LONG = 1.5  # a body longer than this times its width lies across the picture, without axes
_THIN = 0.3  # tick labels of an axis shorter than this share of the longest would overlap
# elevation, azimuth and roll [deg] that let the axis x, y or z of a long body point to the right
_ACROSS = ((20.0, -75.0, 0.0), (20.0, 15.0, 0.0), (20.0, -160.0, -90.0))


def _frame(ax: Axes3D, points: np.ndarray) -> tuple[np.ndarray, float]:
    """Set limits, view and axes for a body; return the points to fit in and the margin [inch]."""
    from matplotlib.ticker import MaxNLocator, NullLocator

    low, high = points.min(axis=0), points.max(axis=0)
    size = high - low
    longest, share = int(np.argmax(size)), size / size.max()
    around = 0.5 * np.maximum(1e-3 * size.max() - size, 0.0)  # of a flat body
    limits = zip(low - around, high + around, strict=True)
    ax.set(**dict(zip(("xlim", "ylim", "zlim"), limits, strict=True)))
    ax.set_box_aspect(np.maximum(share, 1e-3), zoom=0.85)
    ax.patch.set_visible(False)  # it may reach under the colour bar
    if _is_long(points):  # ticks would stand in the body itself
        ax.view_init(*_ACROSS[longest])
        ax.set_axis_off()
        return points, 0.4
    for name, part, pad in zip("xyz", share, (22.0, 22.0, 12.0), strict=True):
        shown = part >= _THIN
        getattr(ax, f"set_{name}label")(f"{name} [m]" if shown else "", labelpad=pad)
        locator = MaxNLocator(max(2, round(4 * part)), prune="both") if shown else NullLocator()
        getattr(ax, f"{name}axis").set_major_locator(locator)
    return np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, 8).T, 0.7


def _is_long(points: np.ndarray) -> bool:
    _, width, length = np.sort(np.ptp(points, axis=0))
    return width < length / _LONG


def _extents(body: np.ndarray, points: np.ndarray) -> str:
    """Return where a body begins and ends that lies across a picture of `points`."""
    low, high = body.min(axis=0), body.max(axis=0)
    longest = np.argmax(np.ptp(points, axis=0))
    others = [f"{high[i] - low[i]:.4g} m in {'xyz'[i]}" for i in range(3) if i != longest]
    along = f"{'xyz'[longest]} from {low[longest]:.4g} m to {high[longest]:.4g} m"
    return f"{along}, left to right; {', '.join(others)}"


def _fit(ax: Axes3D, points: np.ndarray, margin: float) -> tuple[float, float, float, float]:
    """Let a body between `points` fill the figure; return the place of the colour bar."""
    from mpl_toolkits.mplot3d.proj3d import proj_transform

    bar = 1.35  # inch
    flat = np.stack(proj_transform(*points.T, ax.get_proj())[:2], axis=1)
    flat = (ax.transData - ax.transAxes).transform(flat)
    low, size = flat.min(axis=0), np.ptp(flat, axis=0)
    side = min(6.0 / size[0], 4.5 / size[1])  # of the axes, which are square
    body = np.maximum(side * size + 2.0 * margin, (4.5, 2.5))
    with_bar = body + np.array([bar, 0.0])
    ax.figure.set_size_inches(with_bar)
    ax.set_position((*((0.5 * body - side * (low + 0.5 * size)) / with_bar), *(side / with_bar)))
    return (body[0] + 0.15) / with_bar[0], 0.15, 0.2 / with_bar[0], 0.7


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


def legend_above(ax: Axes, columns: int = 2) -> None:
    """Put the legend above the axes, where it hides nothing, in fewer columns where it is wide."""
    _put_above(ax, columns, ax.get_legend_handles_labels()[0])


def legend_of_seen(ax: Axes, columns: int, handles: list[Artist]) -> None:
    """Put a legend above the axes that has only what lies within their limits, also later ones.

    A handle stands for all lines and patches of the axes with its label, also behind an underscore,
    which keeps them out of other legends.
    """

    def update(ax: Axes) -> None:
        if ax.get_legend() is shown[0]:  # not one that a script has put in its place
            seen = [each.get_label() for each in (*ax.lines, *ax.patches) if _is_seen(ax, each)]
            labels = {label.removeprefix("_") for label in seen}
            kept = [handle for handle in handles if handle.get_label() in labels]
            shown[0] = _put_above(ax, columns, kept)

    shown = [ax.get_legend()]
    update(ax)
    for changed in ("xlim_changed", "ylim_changed"):
        ax.callbacks.connect(changed, update)


def _is_seen(ax: Axes, artist: Line2D | Patch) -> bool:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    if isinstance(artist, Line2D) and artist.get_linestyle() == "None":  # markers alone
        places = artist.get_transform().transform(artist.get_xydata())
        return ax.bbox.count_contains(places) > 0
    path = artist.get_transform().transform_path(artist.get_path())
    filled = isinstance(artist, Patch)
    return path.cleaned(remove_nans=True).intersects_bbox(ax.bbox, filled=filled)


def _put_above(ax: Axes, columns: int, handles: list[Artist]) -> Legend:
    for ncols in range(columns, 0, -1):
        legend = ax.legend(
            handles=handles,
            loc="lower left",
            bbox_to_anchor=(0.0, 1.0),
            ncols=ncols,
            frameon=False,
        )
        if legend.get_window_extent().width <= _WIDEST * ax.bbox.width:
            break
    return legend
