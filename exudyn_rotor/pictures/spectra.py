"""Spectra over a run, as a cascade (waterfall) over the spin speed; orbits with a keyphasor."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks, plotting
from exudyn_rotor.results import Result, numbers, storable
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes


# share of the largest amplitude up to which a cascade goes, and how much further it is drawn
_LEAST, _BEYOND = 1e-2, 1.2
# largest change of the time step, relative: rounding of what a file holds
_EVEN = 1e-3


@storable
@dataclass(frozen=True, eq=False)
class Spectra(Result):
    """Amplitudes of a run over time and frequency, made by :func:`spectra`.

    Attributes
    ----------
    times : ndarray, shape (w,)
        Middles of the windows [s].
    speeds : ndarray, shape (w,)
        Spin speeds there [rad/s].
    frequencies : ndarray, shape (f,)
        Ascending [rad/s]; of a motion in a plane those below zero turn backward, from n2 to n1.
    amplitudes : ndarray, shape (w, f)
        In the unit of the signal: of a harmonic its amplitude, of a circular motion its radius.

    Examples
    --------
    >>> from exudyn_rotor import Spectra
    >>> print(Spectra([0.5, 1.5], [60.0, 90.0], [-90.0, 0.0, 90.0], [[0, 0, 1], [2, 0, 1]]).table())
    time [s]  speed [rpm]  strongest frequency [Hz]  amplitude
         0.5      572.958                   14.3239          1
         1.5      859.437                  -14.3239          2
    """

    times: np.ndarray = numbers("windows")
    speeds: np.ndarray = numbers("windows")
    frequencies: np.ndarray = numbers("frequencies")
    amplitudes: np.ndarray = numbers("windows", "frequencies", least=0.0)

    def plot(
        self,
        ax: Axes | None = None,
        *,
        orders: ArrayLike = (1.0,),
        units: str = "rpm",
    ) -> Axes:
        """Draw the cascade: one spectrum above the other, by spin speed.

        Up to a fifth above the last frequency with a hundredth of the largest amplitude, and all
        `orders`.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            A new figure without a window by default.
        orders : array_like, optional
            Multiples of the spin speed to draw as lines.
        units : {'rpm', 'Hz', 'SI'}, optional
            'rpm' has the spin speed in rpm and frequencies in Hz, 'SI' both in rad/s.
        """
        from matplotlib.collections import PolyCollection

        shown = Units.of(units)
        orders = checks.array(orders, "orders", shape=(None,))
        sizes, apart = self.amplitudes.max(axis=0), np.diff(self.frequencies).max()
        last = np.abs(self.frequencies[sizes >= _LEAST * sizes.max()]).max()
        ordered = np.abs(orders).max(initial=0.0) * np.abs(self.speeds).max()
        inside = np.abs(self.frequencies) <= _BEYOND * max(last, ordered, apart)
        ax = plotting.axes_or_new(ax)
        base = shown.speeds(self.speeds)
        step = np.ptp(base) / max(len(base) - 1, 1) or 1.0
        scale = 4.0 * step / (sizes.max() or 1.0)
        abscissa = shown.frequencies(self.frequencies[inside])
        ends = abscissa[[-1, 0]]
        rows = []
        for index in np.argsort(-base, kind="stable"):
            heights = base[index] + scale * self.amplitudes[index, inside]
            line = np.column_stack([abscissa, heights])
            rows.append(np.vstack([line, np.column_stack([ends, np.full(2, base[index])])]))
        ax.add_collection(
            PolyCollection(rows, facecolors="white", edgecolors=plotting.COLORS[0], lw=0.7)
        )
        for order, style in zip(orders, itertools.cycle(plotting.LINES[1:]), strict=False):
            line = order * shown.frequencies(self.speeds)
            ax.plot(line, base, ls=style, color="0.4", lw=0.9, label=f"{order:g} ×")
        ax.set_xlim(abscissa.min(), abscissa.max())
        ax.set_ylim(base.min() - step, base.max() + 5.0 * step)
        ax.set_xlabel(f"frequency [{shown.frequency}]")
        per = f"{step / scale:.2g} per {step:.3g} {shown.speed}"
        ax.set_ylabel(f"spin speed [{shown.speed}]; amplitudes: {per}")
        if orders.size:
            plotting.legend_above(ax, 4)
        return ax

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the strongest frequency of every window as columns, in :meth:`Units.of`."""
        shown = Units.of(units)
        best = np.argmax(self.amplitudes, axis=1)
        return {
            "time [s]": self.times,
            f"speed [{shown.speed}]": shown.speeds(self.speeds),
            f"strongest frequency [{shown.frequency}]": shown.frequencies(self.frequencies[best]),
            "amplitude": self.amplitudes.max(axis=1),
        }


def spectra(
    time: ArrayLike,
    motion: ArrayLike,
    speed: ArrayLike,
    *,
    length: float,
    overlap: float = 0.5,
) -> Spectra:
    """Return spectra of a recorded motion in windows of time.

    Each window is weighted by Hann's function and its mean is taken out; the amplitude of a steady
    harmonic is that of the signal, up to 15 % less between two frequencies. Frequencies are told
    apart from ``2/length`` Hz on.

    Parameters
    ----------
    time : array_like, shape (s,)
        Evenly ascending [s]; the first column of what a sensor of Exudyn stored.
    motion : array_like, shape (s,) or (s, 2)
        A signal, or the two displacements across the axis, along n1 and n2: then frequencies above
        zero turn forward for a positive spin, and those below zero backward.
    speed : float or array_like, shape (s,)
        Spin speed [rad/s].
    length : float
        Of a window [s].
    overlap : float, optional
        Share of a window that the next one has, too, from 0 to below 1.

    Raises
    ------
    TypeError
        If they are no numbers.
    ValueError
        If shapes do not fit, the time is not even, or a window has less than 8 steps or more than
        there are.

    Examples
    --------
    A backward circle of radius 2 at 3 rad/s beside a forward one of radius 1 at 9 rad/s:

    >>> import numpy as np
    >>> from exudyn_rotor import spectra
    >>> time = np.arange(0.0, 2 * np.pi, 0.02 * np.pi)
    >>> z = np.exp(9j * time) + 2.0 * np.exp(-3j * time)
    >>> found = spectra(time, np.column_stack([z.real, z.imag]), 9.0, length=2 * np.pi)
    >>> best = np.argsort(found.amplitudes[0])[-1]
    >>> found.frequencies[best].round(6), found.amplitudes[0, best].round(6)
    (np.float64(-3.0), np.float64(2.0))
    """
    time = checks.array(time, "time", "s", shape=(None,))
    values = checks.array(motion, "motion")
    if values.shape not in ((len(time),), (len(time), 2)):
        raise ValueError(
            f"motion: needs the shape ({len(time)},) or ({len(time)}, 2), got {values.shape}"
        )
    speeds, step = checks.one_or_each(speed, "speed", "rad/s", len(time)), _even_step(time)
    length = checks.number(length, "length", "s", above=0.0)
    overlap = checks.number(overlap, "overlap", least=0.0, below=1.0)
    size = round(length / step)
    if not 8 <= size <= len(time):
        raise ValueError(
            f"length: a window of {length:g} s has {size} steps of {step:g} s; needs 8 to "
            f"{len(time)}"
        )
    hop = max(1, round((1.0 - overlap) * size))
    plane = values.ndim == 2
    signal = values[:, 0] + 1j * values[:, 1] if plane else values
    starts = np.arange(0, len(time) - size + 1, hop)
    weights = np.hanning(size + 1)[:-1]
    weights = weights / weights.sum()
    rows = signal[starts[:, None] + np.arange(size)]
    rows = (rows - rows @ weights[:, None]) * weights
    lines = np.fft.fftshift(np.fft.fft(rows), axes=1)
    frequencies = 2.0 * np.pi * np.fft.fftshift(np.fft.fftfreq(size, step))
    if not plane:
        shown = frequencies >= 0.0
        lines, frequencies = 2.0 * lines[:, shown], frequencies[shown]
    middles = starts + 0.5 * (size - 1)
    return Spectra(
        times=np.interp(middles, np.arange(len(time)), time),
        speeds=np.array([speeds[start : start + size].mean() for start in starts]),
        frequencies=frequencies,
        amplitudes=np.abs(lines),
    )


def plot_orbit(motion: ArrayLike, angle: ArrayLike, ax: Axes | None = None) -> Axes:
    """Draw an orbit with a dot where the keyphasor passes: at whole turns of the rotor.

    Dots that stay in place show a motion at the spin speed or its multiples; one more or less of
    them for each loop shows a fraction of it, as half of it for whirl of bearings' oil.

    Parameters
    ----------
    motion : array_like, shape (s, 2)
        Displacement across the axis, along n1 and n2 [m].
    angle : array_like, shape (s,)
        Spin angle, ascending or descending [rad].
    ax : matplotlib.axes.Axes, optional
        A new figure without a window by default.

    Raises
    ------
    TypeError
        If they are no numbers.
    ValueError
        If shapes do not fit, or the angle does not go one way.

    Examples
    --------
    >>> import numpy as np
    >>> from matplotlib import pyplot
    >>> from exudyn_rotor import plot_orbit
    >>> angle = np.linspace(0.0, 6 * np.pi, 200)
    >>> half = 1e-6 * np.column_stack([np.cos(angle / 2), np.sin(angle / 2)])
    >>> ax = plot_orbit(half, angle)
    >>> marks = ax.lines[1].get_xydata()  # [µm], on both sides of the orbit in turn
    >>> marks[:, 0].round(2).tolist()
    [1.0, -1.0, 1.0, -1.0]
    >>> pyplot.close(ax.figure)
    """
    angle = checks.array(angle, "angle", "rad", shape=(None,))
    motion = checks.array(motion, "motion", "m", shape=(len(angle), 2))
    if len(angle) < 2 or not (np.all(np.diff(angle) > 0.0) or np.all(np.diff(angle) < 0.0)):
        raise ValueError(
            "angle: needs a spin angle that goes one way all the time, at two points or more; "
            "integrate the spin speed over the time if only that was recorded"
        )
    order = slice(None) if angle[-1] > angle[0] else slice(None, None, -1)
    turns = angle[order] / (2.0 * np.pi)
    rounding = 1e-9 * max(1.0, np.abs(turns).max())
    passages = np.arange(np.ceil(turns[0] - rounding), np.floor(turns[-1] + rounding) + 1.0)
    marks = np.column_stack([np.interp(passages, turns, part) for part in motion[order].T])
    ax = plotting.axes_or_new(ax, (5.0, 5.0))
    plotting.plot_orbits(ax, {"orbit": motion})
    ax.set_xlabel("n1 [µm]")  # which need not be horizontal
    ax.set_ylabel("n2 [µm]")
    ax.plot(*(1e6 * marks.T), "o", color=plotting.COLORS[1], ms=6, label="keyphasor")
    plotting.legend_above(ax)
    return ax


def _even_step(time: np.ndarray) -> float:
    steps = np.diff(time)
    if len(steps) == 0 or steps.min() <= 0.0 or np.ptp(steps) > _EVEN * steps.mean():
        raise ValueError(
            "time: needs two instants or more, ascending in even steps; interpolate the record to "
            "such steps"
        )
    return float(steps.mean())
