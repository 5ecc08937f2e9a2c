"""Drawing of a moving surface with the orbits of its centre line."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from exudyn_rotor.plotting import COLORS, draw_surface

if TYPE_CHECKING:
    from mpl_toolkits.mplot3d import Axes3D


_ALPHA = 0.3  # of the surface, through which the orbits are seen
SENSES = {"forward": COLORS[0], "backward": COLORS[1], "straight": COLORS[2]}


class Orbit(NamedTuple):
    """Orbit of a point of the centre line.

    Attributes
    ----------
    points : ndarray, shape (s, 3)
        One revolution, the first point is at the time zero.
    sense : str
        Of :data:`SENSES`.
    """

    points: np.ndarray
    sense: str


def draw_motion(
    positions: np.ndarray,
    triangles: np.ndarray,
    sizes: np.ndarray,
    orbits: Sequence[Orbit],
    room: np.ndarray,
    undeformed: np.ndarray,
    title: str,
    ax: Axes3D | None,
) -> Axes3D:
    """Draw a displaced surface, coloured by the displacement, and orbits coloured by their sense.

    The centre line joins the first points of the orbits. Parameters as of
    :func:`exudyn_rotor.plotting.draw_surface`.
    """
    from matplotlib.lines import Line2D

    new = ax is None
    given = {"room": room, "undeformed": undeformed}
    ax = draw_surface(positions, triangles, sizes, "displacement / largest", ax, **given)
    ax.collections[-1].set(alpha=_ALPHA, linewidth=0.0)
    ax.computed_zorder = False
    for orbit in orbits:
        ax.plot(*orbit.points.T, color=SENSES[orbit.sense], lw=1.2, zorder=5)
    if orbits:
        line = np.array([orbit.points[0] for orbit in orbits])
        ax.plot(*line.T, "k.-", lw=1.0, ms=4, zorder=6)
    drawn = [sense for sense in SENSES if any(orbit.sense == sense for orbit in orbits)]
    handles = [Line2D([], [], color=SENSES[sense], label=sense) for sense in drawn]
    handles += [Line2D([], [], color="k", marker=".", label="centre line")] if orbits else []
    if new:
        ax.figure.legend(handles=handles, loc="upper right", frameon=False, ncols=len(handles) or 1)
        ax.figure.text(0.02, 0.98, title, va="top")
    else:
        ax.set_title(title, fontsize="small")
    return ax


def animated(
    ax: Axes3D,
    corners: np.ndarray,
    places: Callable[[float], tuple[np.ndarray, np.ndarray]],
    times: np.ndarray,
    seconds: float,
) -> bytes:
    """Return a GIF of the figure of :func:`draw_motion`; it is closed.

    Parameters
    ----------
    ax : Axes3D
    corners : ndarray of int, shape (t, 3)
        Nodes of the drawn triangles.
    places : callable
        Nodes (n, 3) and points of the centre line (p, 3) at a time.
    times : ndarray, shape (f,)
    seconds : float
        How long the film lasts.
    """
    from matplotlib import pyplot
    from PIL import Image

    figure, faces, line = ax.figure, ax.collections[-1], ax.lines[-1]
    pictures = []
    for time in times:
        nodes, centers = places(time)
        faces.set_verts(nodes[corners])
        faces.set_alpha(_ALPHA)
        if len(centers):
            line.set_data_3d(*centers.T)
        figure.canvas.draw()
        rgb = np.asarray(figure.canvas.buffer_rgba())[..., :3]
        pictures.append(Image.fromarray(rgb).convert("P", palette=Image.Palette.ADAPTIVE))
    pyplot.close(figure)
    file = io.BytesIO()
    each = round(1000.0 * seconds / len(times))
    options = {"append_images": pictures[1:], "duration": each, "loop": 0}
    pictures[0].save(file, format="GIF", save_all=True, **options)
    return file.getvalue()
