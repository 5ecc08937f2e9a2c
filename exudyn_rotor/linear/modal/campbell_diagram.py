"""Drawing of Campbell diagrams."""

from __future__ import annotations

import itertools

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from exudyn_rotor import plotting
from exudyn_rotor.linear.modal import whirl

_STYLES = {  # colour, line
    whirl.FORWARD: (plotting.COLORS[0], "-"),
    whirl.BACKWARD: (plotting.COLORS[1], "--"),
    whirl.MIXED: (plotting.COLORS[2], "-."),
    whirl.AXIAL: ("0.45", ":"),
    whirl.TORSIONAL: (plotting.COLORS[3], ":"),
    whirl.RADIAL: (plotting.COLORS[4], ":"),
    whirl.STATIC: ("0.7", ":"),
    whirl.UNKNOWN: ("0.2", "-"),
    whirl.FOUNDATION: (plotting.COLORS[5], "-"),
    whirl.OVERDAMPED: ("0.7", ":"),
}


def draw_campbell(
    ax: Axes,
    speeds: np.ndarray,
    values: np.ndarray,
    codes: np.ndarray,
    continued: np.ndarray,
    unstable: np.ndarray,
) -> list[Line2D]:
    """Draw modes [Hz] over the spin speed [Hz], coloured by whirl; return what the legend needs.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
    speeds : ndarray, shape (s,)
    values : ndarray, shape (s, k)
        Each column one mode.
    codes : ndarray of int, shape (s, k)
        Index into :data:`WHIRLS`.
    continued : ndarray of bool, shape (s, k)
        Where a column is the same mode as at the speed before.
    unstable : ndarray of bool, shape (s, k)
        Where a mode is marked by a cross.
    """
    for column in range(values.shape[1]):
        starts = [0, *np.flatnonzero(~continued[1:, column]) + 1, len(speeds)]
        for start, stop in itertools.pairwise(starts):
            _draw_mode(
                ax, speeds[start:stop], values[start:stop, column], codes[start:stop, column]
            )
    handles = [
        Line2D([], [], color=color, ls=line, label=whirl.WHIRLS[code])
        for code, (color, line) in _STYLES.items()
    ]
    if np.any(unstable):
        at = np.broadcast_to(speeds[:, None], unstable.shape)[unstable]
        handles += ax.plot(at, values[unstable], "kx", ms=4, label="unstable")
    return handles


def _draw_mode(ax: Axes, speeds: np.ndarray, values: np.ndarray, codes: np.ndarray) -> None:
    """Draw one mode, changing its style where its whirl changes."""
    if len(speeds) == 1:
        label = f"_{whirl.WHIRLS[codes[0]]}"
        ax.plot(speeds, values, "o", color=_STYLES[codes[0]][0], ms=4, label=label)
        return
    # a piece between two speeds takes the style of its end: at rest the sense is not yet settled
    start = 0
    pieces = codes[1:]
    for stop in range(1, len(pieces) + 1):
        if stop == len(pieces) or pieces[stop] != pieces[start]:
            color, line = _STYLES[pieces[start]]
            piece, label = slice(start, stop + 1), f"_{whirl.WHIRLS[pieces[start]]}"
            ax.plot(speeds[piece], values[piece], ls=line, color=color, lw=1.3, label=label)
            start = stop
