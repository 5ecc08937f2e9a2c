"""Drawing of forced responses: Bode, polar and orbit diagrams."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor.plotting import COLORS, LINES

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_NO_MOTION = 1e-12  # of the largest amplitude
_ROUNDING = 1e-9  # of an angle [rad]


def draw_bode(
    size: Axes, phase: Axes, over: np.ndarray, curves: Mapping[str, np.ndarray], log: bool
) -> None:
    """Draw amplitudes [m], complex, as sizes [µm] and phases over a speed or frequency."""
    from matplotlib.ticker import MultipleLocator

    marker = "." if len(over) == 1 else None  # a line of one point is not seen
    for (name, values), color, line in zip(curves.items(), COLORS, LINES, strict=False):
        style = {"ls": line, "color": color, "lw": 1.4, "marker": marker}
        size.plot(over, 1e6 * np.abs(values), label=name, **style)
        phase.plot(over, _phase(values), **style)
    # nothing is nowhere on a log scale
    moves = any(np.any(np.nan_to_num(values)) for values in curves.values())
    size.set_yscale("log" if log and moves else "linear")
    size.set_ylabel("amplitude [µm]")
    phase.set_ylabel("phase [deg]")
    phase.yaxis.set_major_locator(MultipleLocator(90.0))
    for one in (size, phase):
        one.grid(alpha=0.3, which="both")
    size.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=4, frameon=False)


def draw_polar(ax: Axes, at: np.ndarray, unit: str, amplitudes: np.ndarray, marks: int) -> None:
    """Draw complex amplitudes [m] in their plane [µm]; some points carry where they are."""
    known = np.isfinite(amplitudes)
    at, values = at[known], 1e6 * amplitudes[known]
    ax.plot(values.real, values.imag, color=COLORS[0], lw=1.4)
    for index in _spread(values, marks):
        ax.plot(values.real[index], values.imag[index], "o", color=COLORS[1], ms=4)
        ax.annotate(f"{at[index]:.5g} {unit}", (values.real[index], values.imag[index]),
                    textcoords="offset points", xytext=(5, 4), fontsize=8)  # fmt: skip
    ax.axhline(0.0, color="0.6", lw=0.7)
    ax.axvline(0.0, color="0.6", lw=0.7)
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_ylabel("a quarter turn ahead [µm]")
    ax.grid(alpha=0.3)


def draw_orbits(ax: Axes, orbits: Mapping[str, np.ndarray]) -> None:
    """Draw orbits, each (points, 2) [m], in µm: a dot at the first point, an arrow ahead."""
    for (name, points), color, line in zip(orbits.items(), COLORS, LINES, strict=False):
        x, y = 1e6 * points.T
        ax.plot(x, y, ls=line, color=color, lw=1.4, label=name)
        ax.plot(x[0], y[0], "o", color=color, ms=5)
        ax.annotate("", (x[24], y[24]), (x[20], y[20]),
                    arrowprops={"arrowstyle": "->", "color": color, "lw": 1.4})  # fmt: skip
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel("n1 [µm]")
    ax.set_ylabel("n2 [µm]")
    ax.grid(alpha=0.3)
    ax.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, frameon=False)


def _phase(values: np.ndarray) -> np.ndarray:
    """Return phases [deg] without jumps; none where there is no motion."""
    phase = np.full(len(values), np.nan)
    sizes_of = np.nan_to_num(np.abs(values))
    moving = sizes_of > _NO_MOTION * sizes_of.max(initial=0.0)
    phase[moving] = np.degrees(np.unwrap(_angles(values[moving])))
    return phase


def least(motion: np.ndarray) -> np.ndarray:
    """Return up to which amplitude the displacements of a motion (s, …, 6) are rounding, (s,)."""
    return _NO_MOTION * np.abs(motion[..., :3]).max(axis=(1, 2, 3), initial=0.0)


def sizes(values: ArrayLike, least: np.ndarray) -> np.ndarray:
    """Return sizes of complex amplitudes; 0 of those up to the `least` that is told."""
    found = np.abs(values)
    return np.where(found <= least, 0.0, found)


def degrees(values: np.ndarray, least: np.ndarray) -> np.ndarray:
    """Return phases, above −180° up to 180°; 0 of amplitudes up to the `least` that is told."""
    return np.where(np.abs(values) <= least, 0.0, np.degrees(_angles(values)))


def _angles(values: np.ndarray) -> np.ndarray:
    """Return angles above −π up to π; what is −π but for rounding is π."""
    found = np.angle(values)
    return np.where(found <= _ROUNDING - np.pi, found + 2.0 * np.pi, found)


def _spread(values: np.ndarray, count: int) -> np.ndarray:
    """Return indices of points evenly spread along a curve."""
    path = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(values)))])
    return np.unique(
        np.searchsorted(path, np.linspace(0.0, path[-1], count)).clip(0, len(path) - 1)
    )
