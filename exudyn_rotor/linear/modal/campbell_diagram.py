"""Campbell diagrams as pictures: modes, lines of excitation, crossings, the operating range."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks, plotting
from exudyn_rotor.linear.modal import whirl
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

# of the excitation's frequency: a mode that keeps to its line, as one fixed in the rotor, does
# not cross it by rounding
_ON_THE_LINE = 1e-9
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


def checked_orders(orders: Sequence[float] | float) -> np.ndarray:
    """Return positive orders of excitation, shape (p,)."""
    values = checks.vector(np.atleast_1d(orders), "orders", size=None)
    if values.size == 0 or np.any(values <= 0.0):
        raise ValueError(f"orders: needs positive numbers, got {checks.shown(orders)}")
    return values


def checked_range(values: ArrayLike | None) -> np.ndarray | None:
    """Return the lowest and the highest operating speed [rad/s], or None."""
    if values is None:
        return None
    low, high = checks.vector(values, "operating_range", "rad/s", size=2)
    if not 0.0 <= low < high:
        raise ValueError(
            "operating_range: needs the lowest and the highest speed [rad/s], got "
            f"{checks.shown(values)}"
        )
    return np.array([low, high])


def checked_margins(margins: ArrayLike | None) -> np.ndarray:
    """Return the shares of separation below and above the range; zeros for None."""
    values = checks.vector((0.0, 0.0) if margins is None else margins, "margins", size=2)
    if np.any(values < 0.0) or values[0] >= 1.0:
        raise ValueError(
            "margins: needs shares of the lowest and of the highest speed, as (0.16, 0.26), got "
            + checks.shown(margins)
        )
    return values


def crossings(
    speeds: np.ndarray, values: np.ndarray, continued: np.ndarray, order: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return where modes have the frequency pΩ, (c,) ascending [rad/s], and their columns, (c,).

    Frequencies `values` (s, k) [rad/s] of modes that are `continued` (s, k) since the speed before,
    are straight lines between speeds (s,); p is the `order`.
    """
    line = order * np.abs(speeds)[:, None]
    apart = values - line
    apart[np.abs(apart) <= _ON_THE_LINE * np.maximum(values, line)] = 0.0
    before, after = apart[:-1], apart[1:]
    crossed = (before * after < 0.0) | ((after == 0.0) & (before != 0.0))
    rows, columns = np.nonzero(crossed & continued[1:])
    share = before[rows, columns] / (before - after)[rows, columns]
    crossings = speeds[rows] + share * np.diff(speeds)[rows]
    ascending = np.argsort(crossings, kind="stable")
    return crossings[ascending], columns[ascending]


def draw_orders(
    ax: Axes,
    speeds: np.ndarray,
    values: np.ndarray,
    continued: np.ndarray,
    orders: np.ndarray,
    units: Units,
) -> list[Line2D]:
    """Draw the lines pΩ and mark where modes cross them; return what the legend needs.

    `speeds`, `values` and `continued` are those of :func:`crossings`.
    """
    handles, last, places = [], speeds[np.argmax(np.abs(speeds))], []
    for order, style in zip(orders, itertools.cycle(plotting.LINES)):
        label = "spin speed" if order == 1.0 else f"{order:g} × spin speed"
        drawn = units.frequencies(order * np.abs(speeds))
        handles += ax.plot(units.speeds(speeds), drawn, color="0.6", lw=0.8, ls=style, label=label)
        ax.annotate(f"{order:g}×", (units.speeds(last), units.frequencies(order * abs(last))),
                    textcoords="offset points", xytext=(2, 0), fontsize=8, color="0.4",
                    annotation_clip=True)  # fmt: skip
        met, _ = crossings(speeds, values, continued, order)
        places += zip(units.speeds(met), units.frequencies(order * np.abs(met)), strict=True)
    if places:
        style = {"mfc": "none", "mec": "0.2", "ms": 6, "label": "crossing"}
        handles += ax.plot(*zip(*places, strict=True), "o", **style)
    return handles


def shade_range(ax: Axes, limits: np.ndarray, margins: np.ndarray, units: Units) -> list[Patch]:
    """Shade operating speeds [rad/s] and the margins beside them; return what the legend needs."""
    low, high = units.speeds(limits)
    handles = [ax.axvspan(low, high, color=plotting.COLORS[2], alpha=0.15, lw=0.0)]
    handles[0].set_label("operating range")
    if np.any(margins > 0.0):
        beside = [((1.0 - margins[0]) * low, low), (high, (1.0 + margins[1]) * high)]
        drawn = [ax.axvspan(*span, color="0.75", alpha=0.5, lw=0.0) for span in beside]
        drawn[0].set_label("separation margin")
        handles.append(drawn[0])
    return handles


def draw_campbell(
    ax: Axes,
    speeds: np.ndarray,
    values: np.ndarray,
    codes: np.ndarray,
    continued: np.ndarray,
    unstable: np.ndarray,
) -> list[Line2D]:
    """Draw modes over the spin speed, coloured by whirl; return what the legend needs.

    Each column of `values` (s, k) is a mode of whirl `codes`, the same as at the speed before where
    it is `continued`; `unstable` ones are marked by a cross.
    """
    from matplotlib.lines import Line2D

    marker, seen = {"marker": "o", "ms": 4} if len(speeds) == 1 else {}, set()
    for column in range(values.shape[1]):
        code, joined = codes[:, column], continued[:, column]
        # the way to a speed takes its style: at rest the sense is not yet settled
        style = np.r_[code[1:2] if len(code) > 1 else code, code[1:]]
        starts = np.flatnonzero(np.r_[True, (style[1:] != style[:-1]) | ~joined[1:]])
        for start, stop in itertools.pairwise([*starts, len(speeds)]):
            first = max(start - 1, 0) if joined[start] else start
            color, line = _STYLES[style[start]]
            part = slice(first, stop)
            ax.plot(speeds[part], values[part, column], ls=line, color=color, lw=1.3, **marker)
            if np.any(np.isfinite(values[part, column])):
                seen.add(int(style[start]))
    handles = [
        Line2D([], [], color=color, ls=line, label=whirl.WHIRLS[code])
        for code, (color, line) in _STYLES.items()
        if code in seen
    ]
    if np.any(unstable):
        at = np.broadcast_to(speeds[:, None], unstable.shape)[unstable]
        handles += ax.plot(at, values[unstable], "kx", ms=4, label="unstable")
    return handles
