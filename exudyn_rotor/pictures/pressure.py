"""Picture of the pressure in a film."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from exudyn_rotor import checks, plotting
from exudyn_rotor.bearings.film.film import FilmState

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plot_pressure(state: FilmState, ax: Axes | None = None) -> Axes:
    """Draw a film's pressure over the angle from n1 and the length, grooves left white.

    Parameters
    ----------
    state : FilmState
    ax : matplotlib.axes.Axes, optional
        A new figure by default.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    TypeError
        If `state` is none.

    Examples
    --------
    >>> from exudyn_rotor import OilFilm, grooved_pads, plot_pressure
    >>> film = OilFilm(radius=0.05, length=0.05, viscosity=0.02, pads=grooved_pads(1e-4))
    >>> ax = plot_pressure(film.equilibrium(300.0, [-5000.0, 0.0]))
    """
    checks.instance(state, "state", FilmState)
    ax = plotting.axes_or_new(ax)
    film, grid = state.film, state.film.grid
    half = 1e3 * film.radius * grid.axial.places
    along = np.concatenate([-half[:0:-1], half])
    pressure = np.concatenate([state.pressure[:, :0:-1], state.pressure], axis=1) / 1e6
    levels = np.linspace(min(pressure.min(), 0.0), max(pressure.max(), 1e-12), 21)
    for number, pad in enumerate(film.pads):
        inside = grid.pad == number
        angle, values = grid.angle[inside], pressure[inside]
        if pad.closed:
            angle, values = np.append(angle, angle[0] + pad.arc), np.append(values, values[:1], 0)
        else:
            edge = np.zeros((1, len(along)))
            angle = np.concatenate([[pad.start], angle, [pad.start + pad.arc]])
            values = np.concatenate([edge, values, edge])
        drawn = ax.contourf(np.degrees(angle), along, values.T, levels, cmap="viridis")
    ax.figure.colorbar(drawn, ax=ax, label="pressure [MPa]", format="%.2g")
    thinnest = grid.angle[np.argmin(state.heights)]
    ax.axvline(np.degrees(thinnest), color="white", linestyle="--", linewidth=1.0)
    ax.set(xlabel="angle from n1 [°]", ylabel="place along the axis [mm]")
    ax.set_title(
        f"film of least thickness {1e6 * state.minimum_thickness:.3g} µm (dashed), "
        f"ε = {state.eccentricity_ratio:.3f}",
        fontsize=10,
    )
    return ax
