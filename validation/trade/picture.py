"""The picture of the trade-off: fronts, modes, and the tilt at which the 3D body is needed."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from exudyn_rotor.plotting import COLORS, save
from validation.trade.error import Row, cheapest, front
from validation.trade.run import AXES, USERS
from validation.trade.scene import (
    CONSTANT_SPEED,
    CRAIG_BAMPTON,
    FREE,
    FREE_FRAME,
    STANDARD,
    VIRTUAL,
)

GREY = "#666666"
STYLES = {  # colour, marker
    STANDARD: (GREY, "s"),
    VIRTUAL: ("#000000", "D"),
    FREE_FRAME: (COLORS[0], "o"),
    "fixed axis, in-plane": (COLORS[4], "v"),
    "fixed axis, translation none": (COLORS[3], "^"),
    CONSTANT_SPEED: (COLORS[2], "o"),
}
LABELS = {
    STANDARD: "Exudyn's 3D body, markers on all face nodes",
    VIRTUAL: "Exudyn's 3D body, virtual nodes",
    FREE_FRAME: "fixed axis, translation free",
    "fixed axis, in-plane": "fixed axis, translation in-plane",
    "fixed axis, translation none": "fixed axis, translation none",
    CONSTANT_SPEED: "fixed axis, constant speed",
}


def draw(
    path: str | PathLike,
    points: Sequence[Row],
    modes: Sequence[Row],
    tilts: Sequence[Row],
    accuracies: Sequence[float],
) -> None:
    """Write the picture as PNG."""
    made = Figure(figsize=(11.0, 7.2), layout="constrained")
    areas = made.subplot_mosaic([["front", "modes"], ["front", "tilt"]], width_ratios=[2.05, 1.0])
    draw_front(areas["front"], points, accuracies)
    draw_modes(areas["modes"], modes)
    draw_tilts(areas["tilt"], tilts, accuracies)
    save(made, path)


def draw_front(axes: Axes, points: Sequence[Row], accuracies: Sequence[float]) -> None:
    """Draw errors over times, a front for every family, and what to take for an accuracy."""
    for family, (color, marker) in STYLES.items():
        own = [row for row in points if row["family"] == family]
        x, y = ([row[name] for row in own] for name in ("seconds", "total"))
        axes.loglog(x, y, marker, color=color, ms=3.5, mew=0, alpha=0.35)
        best = front(own)
        x, y = ([row[name] for row in best] for name in ("seconds", "total"))
        axes.loglog(x, y, marker + "-", color=color, ms=4.5, lw=1.5, label=LABELS[family])
    best = front(points)
    x, y = ([row[name] for row in best] for name in ("seconds", "total"))
    axes.loglog(x, y, color="#FFD54F", lw=7.0, alpha=0.6, zorder=0, label="the best of all")
    _make_room(axes, points)
    for accuracy in accuracies:
        _advise(axes, points, accuracy)
    axes.set_xlabel("time of the simulation [s]")
    axes.set_ylabel("error of the orbits, relative to their size")
    axes.grid(alpha=0.25, which="major")
    axes.legend(loc="upper right", frameon=True, framealpha=0.9, fontsize=8.5)


def _make_room(axes: Axes, points: Sequence[Row]) -> None:
    """Leave room for words: left of the fastest, right of the slowest, above the worst."""
    for name, limits, factors in (
        ("seconds", axes.set_xlim, (0.06, 5.0)),
        ("total", axes.set_ylim, (0.4, 10.0)),
    ):
        values = [row[name] for row in points]
        limits(factors[0] * min(values), factors[1] * max(values))


def _advise(axes: Axes, points: Sequence[Row], accuracy: float) -> None:
    """Mark the cheapest configuration of all and what users pay for the same accuracy."""
    best = cheapest(points, accuracy)
    users = cheapest([row for row in points if row["group"] == USERS], accuracy)
    if best is None:
        return
    axes.axhline(accuracy, color=GREY, lw=0.7, ls=":")
    text = "\n".join(
        [
            f"{accuracy:.0e} for {best['seconds']:.2g} s",
            LABELS[best["family"]],
            f"{best['modes']} {best['basis']} modes",
            f"steps of {1e6 * best['step']:.3g} µs",
        ]
    )
    beside = {"fontsize": 8.5, "textcoords": "offset points"}
    axes.annotate(text, (best["seconds"], accuracy), (-8, -4), va="top", ha="right", **beside)
    axes.plot(best["seconds"], accuracy, "|", color=GREY, ms=12, mew=1.5)
    if users is None:
        return
    axes.plot([best["seconds"], users["seconds"]], [accuracy] * 2, color=GREY, lw=1.0)
    axes.plot(users["seconds"], accuracy, "|", color=GREY, ms=12, mew=1.5)
    ratio = f"{users['seconds']:.2g} s, {users['seconds'] / best['seconds']:.0f} times that"
    axes.annotate(ratio, (users["seconds"], accuracy), (7, 4), va="bottom", ha="left", **beside)


def draw_modes(axes: Axes, rows: Sequence[Row]) -> None:
    """Draw the error of the steady response over the number of modes."""
    lines = {FREE: ("o--", COLORS[1]), CRAIG_BAMPTON: ("o-", COLORS[0])}
    for basis, (line, color) in lines.items():
        own = [row for row in rows if row["basis"] == basis]
        x, y = ([row[name] for row in own] for name in ("modes", "error"))
        axes.semilogy(x, y, line, color=color, lw=1.3, ms=4, label=f"{basis} modes")
    axes.set_xlabel("number of flexible modes")
    axes.set_ylabel("error of the steady orbits")
    axes.set_title("modes, against all nodes", fontsize=10)
    axes.grid(alpha=0.3)
    axes.legend(frameon=False, fontsize=8.5)


def draw_tilts(axes: Axes, rows: Sequence[Row], accuracies: Sequence[float]) -> None:
    """Draw the deviation of the fixed-axis body from the 3D body over the tilt."""
    for accuracy in accuracies:
        axes.axhline(accuracy, color=GREY, lw=0.9, ls=":")
    x = [row["tilt"] for row in rows]
    styles = {"lateral": ("o-", COLORS[0]), "axial": ("v--", COLORS[1]), "rim": ("^:", COLORS[2])}
    names = {"lateral": "journals, across", "axial": "journals, axial", "rim": "rim, axial"}
    for name in AXES:
        line, color = styles[name]
        axes.loglog(x, [row[name] for row in rows], line, color=color, lw=1.3, ms=4,
                    label=names[name])  # fmt: skip
    axes.set_xlabel("tilt [rad]")
    axes.set_ylabel("deviation from the 3D body")
    axes.set_title("where a fixed axis ends", fontsize=10)
    axes.grid(alpha=0.3)
    axes.legend(frameon=False, fontsize=8.5)
