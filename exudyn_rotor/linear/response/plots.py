"""Pictures of forced responses: Bode, polar and orbit diagrams."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MultipleLocator

from exudyn_rotor import checks
from exudyn_rotor.linear.response.results import DIRECTIONS
from exudyn_rotor.plotting import COLORS, LINES, axes_or_new, figure

if TYPE_CHECKING:
    from exudyn_rotor.linear.response.results import Response

HERTZ = 1.0 / (2.0 * np.pi)


def plot_bode(
    response: Response,
    place: str | None = None,
    *,
    directions: Sequence[str] = ("n1", "n2"),
    order: int | None = None,
    ax: tuple[Axes, Axes] | None = None,
    log: bool = True,
) -> tuple[Axes, Axes]:
    """Draw size and phase of the displacement over speed or frequency [Hz].

    Parameters
    ----------
    response : Response
    place : str, optional
        The first one by default.
    directions : sequence of {'n1', 'n2', 'e', 'forward', 'backward'}
    order : int, optional
        Harmonic; the main one by default.
    ax : pair of matplotlib Axes, optional
        For size and phase; made if not given.
    log : bool, optional
        Logarithmic sizes.
    """
    names = checks.labels(directions, "directions", (*DIRECTIONS, "forward", "backward"))
    checks.flag(log, "log")
    if ax is None:
        ax = figure(2, 1, size=(7.0, 5.5), sharex=True)[1]
    pair = checks.instances(list(ax) if isinstance(ax, np.ndarray) else ax, "ax", Axes)
    if len(pair) != 2:
        raise ValueError(f"ax: needs two, for size and phase, got {len(pair)}")
    size, phase = pair
    forward, backward = response.whirl(place, order)
    circular = {"forward": forward, "backward": backward}
    hertz = HERTZ * response.abscissa
    for name, color, line in zip(names, COLORS, LINES, strict=False):
        values = circular[name] if name in circular else response.phasor(place, name, order)
        size.plot(hertz, 1e6 * np.abs(values), ls=line, color=color, lw=1.4, label=name)
        phase.plot(hertz, _phase(values), ls=line, color=color, lw=1.4)
    size.set_yscale("log" if log else "linear")
    size.set_ylabel("amplitude [µm]")
    phase.set_ylabel("phase [deg]")
    phase.yaxis.set_major_locator(MultipleLocator(90.0))
    phase.set_xlabel(f"{response._what} [Hz]")
    for one in (size, phase):
        one.grid(alpha=0.3, which="both")
    size.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=4, frameon=False)
    size.set_title(_title(response, place, order), loc="right", fontsize=10)
    return size, phase


def plot_polar(
    response: Response,
    place: str | None = None,
    *,
    direction: str = "n1",
    order: int | None = None,
    ax: Axes | None = None,
    marks: int = 5,
) -> Axes:
    """Draw the complex amplitude [µm] as a curve in its plane (Nyquist diagram).

    A damped resonance is a loop; its place across from the start is the critical speed.

    Parameters
    ----------
    response, place, order
        See :func:`plot_bode`.
    direction : {'n1', 'n2', 'e', 'forward', 'backward'}
    ax : matplotlib Axes, optional
    marks : int, optional
        How many points are labelled with their speed or frequency [Hz].
    """
    checks.choice(direction, "direction", (*DIRECTIONS, "forward", "backward"))
    marks = checks.count(marks, "marks")
    ax = axes_or_new(ax, (5.5, 5.5))
    forward, backward = response.whirl(place, order)
    circular = {"forward": forward, "backward": backward}
    values = circular.get(direction)
    values = 1e6 * (response.phasor(place, direction, order) if values is None else values)
    ax.plot(values.real, values.imag, color=COLORS[0], lw=1.4)
    for index in _spread(values, marks):
        ax.plot(values.real[index], values.imag[index], "o", color=COLORS[1], ms=4)
        ax.annotate(f"{HERTZ * response.abscissa[index]:.3g} Hz",
                      (values.real[index], values.imag[index]),
                      textcoords="offset points", xytext=(5, 4), fontsize=8)  # fmt: skip
    ax.axhline(0.0, color="0.6", lw=0.7)
    ax.axvline(0.0, color="0.6", lw=0.7)
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel(f"in phase, {direction} [µm]")
    ax.set_ylabel("a quarter turn ahead [µm]")
    ax.grid(alpha=0.3)
    ax.set_title(_title(response, place, order), loc="right", fontsize=10)
    return ax


def plot_orbit(
    response: Response,
    value: float,
    *,
    places: Sequence[str] | None = None,
    order: int | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw one revolution of the orbits [µm] at a speed or frequency [rad/s].

    A dot marks t = 0 and an arrow the sense of the motion.

    Parameters
    ----------
    response, order
        See :func:`plot_bode`.
    value : float
        The nearest computed speed or frequency is taken.
    places : sequence of str, optional
        All by default.
    ax : matplotlib Axes, optional
    """
    value = checks.number(value, "value", "rad/s")
    names = response.places
    if places is not None:
        names = checks.labels(places, "places", response.places)
    ax = axes_or_new(ax, (5.5, 5.5))
    for name, color, line in zip(names, COLORS, LINES, strict=False):
        x, y = 1e6 * response.orbit(value, name, order).T
        ax.plot(x, y, ls=line, color=color, lw=1.4, label=name)
        ax.plot(x[0], y[0], "o", color=color, ms=5)
        ax.annotate("", (x[24], y[24]), (x[20], y[20]),
                      arrowprops={"arrowstyle": "->", "color": color, "lw": 1.4})  # fmt: skip
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel("n1 [µm]")
    ax.set_ylabel("n2 [µm]")
    ax.grid(alpha=0.3)
    ax.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, frameon=False)
    nearest = response.abscissa[np.argmin(np.abs(response.abscissa - value))]
    ax.set_title(f"{response._what} {HERTZ * nearest:.4g} Hz", loc="right", fontsize=10)
    return ax


def _phase(values: np.ndarray) -> np.ndarray:
    """Return phases [deg] without jumps; none where there is no motion."""
    phase = np.full(len(values), np.nan)
    moving = np.abs(values) > 1e-12 * np.abs(values).max(initial=0.0)
    phase[moving] = np.degrees(np.unwrap(np.angle(values[moving])))
    return phase


def _spread(values: np.ndarray, count: int) -> np.ndarray:
    """Return indices of points evenly spread along a curve."""
    path = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(values)))])
    return np.unique(
        np.searchsorted(path, np.linspace(0.0, path[-1], count)).clip(0, len(path) - 1)
    )


def _title(response: Response, place: str | None, order: int | None) -> str:
    name = response.places[0] if place is None else place
    number = response.main_order if order is None else order
    return f"{name}, order {number}, {response.frame} frame"
