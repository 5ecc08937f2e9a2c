"""Pictures of surfaces: in true proportion, labels beside the axes and inside the figure."""

import matplotlib
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from mpl_toolkits.mplot3d.proj3d import proj_transform

from exudyn_rotor import plotting


def box(size):
    """Return nodes and triangles of a box."""
    nodes = np.array(np.meshgrid(*[[0.0, x] for x in size], indexing="ij")).reshape(3, 8).T
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return nodes, np.array([t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))])


def drawn(size):
    """Return the axes, the pixels of a body drawn in violet, and the renderer."""
    nodes, triangles = box(size)
    with matplotlib.rc_context(matplotlib.rcParamsDefault):  # Exudyn's plots set another font size
        made = plotting.draw_surface(nodes, triangles, np.zeros(8), "stress").figure
        canvas = FigureCanvasAgg(made)
        canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba()).astype(int)
    axes = made.axes[0]
    violet = np.abs(pixels[:, :, :3] - [68, 1, 84]).sum(axis=2) < 6
    violet[:, int(made.axes[1].get_window_extent().x0) :] = False
    return axes, violet, canvas.get_renderer()


@pytest.mark.parametrize("along", [0, 1, 2])
@pytest.mark.parametrize("width", [0.002, 0.02, 0.1])
def test_a_long_body_fills_the_picture_from_left_to_right(along, width):
    size = np.full(3, width)
    size[along] = 0.4
    axes, body, _ = drawn(size)
    columns = np.flatnonzero(body.any(axis=0))
    assert columns[0] < 0.1 * body.shape[1]
    assert np.ptp(columns) > 0.7 * body.shape[1]
    assert body.shape[0] < 0.6 * body.shape[1]
    ends = np.zeros((2, 3))
    ends[1, along] = 0.4
    across, _, _ = proj_transform(*ends.T, axes.get_proj())
    assert across[0] < across[1]
    note = axes.figure.texts[0].get_text()
    assert note.startswith(f"{'xyz'[along]} from 0 m to 0.4 m, left to right; {width:g} m in")


COMPACT = [
    (0.4, 0.4, 0.02),
    (0.1, 0.11, 0.02),
    (0.1, 0.11, 0.04),
    (0.1, 0.4, 0.4),
    (0.4, 0.1, 0.4),
    (0.1, 0.11, 0.12),
    (0.1, 0.1, 0.14),
]


@pytest.mark.parametrize("size", COMPACT)
def test_labels_of_a_compact_body_stand_apart_and_inside(size):
    axes, body, renderer = drawn(size)
    assert np.ptp(np.flatnonzero(body.any(axis=1))) > 0.4 * body.shape[0]
    texts = [axis.label for axis in (axes.xaxis, axes.yaxis, axes.zaxis)]
    texts += [t.label1 for axis in (axes.xaxis, axes.yaxis, axes.zaxis) for t in axis.majorTicks]
    extents = [t.get_window_extent(renderer) for t in texts if t.get_text()]
    assert len(extents) >= 6
    for i, one in enumerate(extents):
        assert not any(one.overlaps(other) for other in extents[i + 1 :])
        assert one.x0 > 0
        assert one.y0 > 0
        assert one.x1 < axes.figure.axes[1].get_window_extent().x0
        assert one.y1 < body.shape[0]


def test_a_surface_that_cannot_be_drawn_is_refused():
    nodes, triangles = box((1.0, 1.0, 1.0))
    with pytest.raises(ValueError, match=r"values: .* the 8 nodes, got the shape \(3,\)"):
        plotting.draw_surface(nodes, triangles, np.ones(3), "stress")
    with pytest.raises(ValueError, match="triangles: there are none"):
        plotting.draw_surface(nodes, triangles[:0], np.ones(8), "stress")
