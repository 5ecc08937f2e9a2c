"""Drawing of Campbell diagrams."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from exudyn_rotor import plotting
from exudyn_rotor.linear.modal import whirl

if TYPE_CHECKING:
    from exudyn_rotor.linear.modal.campbell import Campbell

_HERTZ = 1.0 / (2.0 * np.pi)
# growth below this share of frequency and speed is not marked: what is left of a free spin of a
# rotor with an uneven mesh looks like that
_UNSTABLE = 1e-4
_STYLES = {  # colour, line
    whirl.FORWARD: (plotting.COLORS[0], "-"),
    whirl.BACKWARD: (plotting.COLORS[1], "--"),
    whirl.MIXED: (plotting.COLORS[2], "-."),
    whirl.AXIAL: ("0.45", ":"),
    whirl.TORSIONAL: (plotting.COLORS[3], ":"),
    whirl.RADIAL: (plotting.COLORS[4], ":"),
    whirl.STATIC: ("0.7", ":"),
    whirl.UNKNOWN: ("0.2", "-"),
}


def draw_campbell(result: Campbell, ax: Axes | None, frame: str) -> Axes:
    """Draw tracked modes in Hz, coloured by whirl, with the line of the spin speed."""
    ax = plotting.axes_or_new(ax)
    tracked = result.tracked()
    values = tracked.frequencies_inertial if frame == "inertial" else tracked.frequencies_rotating
    speeds = _HERTZ * tracked.speeds
    for column in range(values.shape[1]):
        _draw_mode(ax, speeds, _HERTZ * values[:, column], tracked.whirl_codes[:, column])
    drawn = tracked.whirl_codes[1:] if len(speeds) > 1 else tracked.whirl_codes
    used = [code for code in _STYLES if np.any(drawn == code)]
    handles = [
        Line2D([], [], color=_STYLES[code][0], ls=_STYLES[code][1], label=whirl.WHIRLS[code])
        for code in used
    ]
    scale = np.maximum(tracked.frequencies_inertial, np.abs(tracked.speeds)[:, None])
    grows = tracked.growth > _UNSTABLE * scale
    if np.any(grows):
        at = np.broadcast_to(speeds[:, None], grows.shape)[grows]
        handles += ax.plot(at, _HERTZ * values[grows], "kx", ms=4, label="unstable")
    if frame == "inertial":
        (line,) = ax.plot(speeds, np.abs(speeds), color="0.6", lw=0.8, label="spin speed")
        handles.append(line)
    ax.set_xlabel("spin speed [Hz]")
    ax.set_ylabel(f"frequency in the {'inertial' if frame == 'inertial' else 'rotor'} frame [Hz]")
    ax.set_ylim(bottom=0.0)
    ax.grid(alpha=0.3)
    plotting.legend_above(ax, 3, handles)
    return ax


def _draw_mode(ax: Axes, speeds: np.ndarray, values: np.ndarray, codes: np.ndarray) -> None:
    """Draw one mode, changing its style where its whirl changes."""
    if len(speeds) == 1:
        ax.plot(speeds, values, "o", color=_STYLES[codes[0]][0], ms=4)
        return
    # a piece between two speeds takes the style of its end: at rest the sense is not yet settled
    start = 0
    pieces = codes[1:]
    for stop in range(1, len(pieces) + 1):
        if stop == len(pieces) or pieces[stop] != pieces[start]:
            color, line = _STYLES[pieces[start]]
            ax.plot(
                speeds[start : stop + 1], values[start : stop + 1], ls=line, color=color, lw=1.3
            )
            start = stop
