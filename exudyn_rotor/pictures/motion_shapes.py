"""Shapes of harmonic motions of a rotor on its surface: pictures and animations."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.plotting import COLORS, draw_surface
from exudyn_rotor.results import Result, numbers, storable, words
from exudyn_rotor.solid.rotor import Interface
from exudyn_rotor.solid.surface import flat_triangles
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.rotating_axes import axes_of
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from mpl_toolkits.mplot3d import Axes3D


_STATIONS = 15  # along the axis
_FRAMES = 25  # of an animation
_SHARE = 0.1  # largest displacement as drawn, over the size of the rotor
_ALPHA = 0.3  # of the surface, through which the orbits are seen
_COLORS = dict(zip(("forward", "backward", "straight"), COLORS, strict=False))
# of the larger amplitude: an orbit with less of the smaller one is neither forward nor backward
_STRAIGHT = 0.02
_UNEVEN = 0.01  # of the largest displacement: what a mesh adds to torsion and axial motion
# frequencies that differ by less than this share are one
_SAME = 1e-6


@storable
@dataclass(frozen=True, eq=False)
class MotionShapes(Result):
    """Motions ``u(t) = Re Σ_m X_m exp(i(ν + mΩ)t)`` of a rotor, seen in its frame.

    Made by :func:`mode_shapes` and :func:`response_shapes`.

    Attributes
    ----------
    positions : ndarray, shape (n, 3)
        Mesh nodes, mesh coordinates [m].
    triangles : ndarray of int, shape (t, 3) or (t, 6)
        Surface of the rotor.
    direction, point : ndarray, shape (3,)
        Of the spin axis.
    speeds : ndarray, shape (k,)
        Spin speed Ω of every shape [rad/s].
    labels : tuple of str
        What every shape is.
    rates : ndarray, shape (k,)
        ν, seen in the rotor frame [rad/s].
    frequencies : ndarray, shape (k,)
        Of the strongest wave seen from outside [rad/s].
    orders : ndarray of int, shape (h,)
        The harmonics m.
    motion : ndarray of complex, shape (k, h, n, 3)
        X_m along mesh axes; of modes the size is arbitrary, of responses it is in metres.

    Examples
    --------
    A point that whirls forward at twice the spin speed of 3 rad/s, seen a quarter turn later:

    >>> import numpy as np
    >>> from exudyn_rotor import MotionShapes
    >>> axis, rate = ([0.0, 0.0, 1.0], [0.0, 0.0, 0.0]), [3.0]
    >>> circle = [[[[1.0, -1.0j, 0.0]]]]
    >>> shape = MotionShapes([[0.0, 0.0, 0.0]], np.zeros((0, 3), int), *axis, [3.0], ("whirl",),
    ...                      rate, [6.0], [0], circle)
    >>> print(shape.displacement(0, np.pi / 6.0).round(6) + 0.0)
    [[0. 1. 0.]]
    """

    positions: np.ndarray = numbers("nodes", 3)
    triangles: np.ndarray = numbers("triangles", "corners", dtype=int, least=0)
    direction: np.ndarray = numbers(3)
    point: np.ndarray = numbers(3)
    speeds: np.ndarray = numbers("shapes")
    labels: tuple[str, ...] = words("shapes")
    rates: np.ndarray = numbers("shapes")
    frequencies: np.ndarray = numbers("shapes")
    orders: np.ndarray = numbers("orders", dtype=int)
    motion: np.ndarray = numbers("shapes", "orders", "nodes", 3, dtype=complex)

    @property
    def axis(self) -> SpinAxis:
        """The spin axis in mesh coordinates."""
        return SpinAxis(self.direction, self.point)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return a row for each shape, with the `index` of :meth:`plot`, in :meth:`Units.of`."""
        shown = Units.of(units)
        return {
            "index": np.arange(len(self.labels)),
            f"speed [{shown.speed}]": shown.speeds(self.speeds),
            f"frequency [{shown.frequency}]": shown.frequencies(self.frequencies),
            "what": np.array(self.labels),
        }

    def displacement(self, index: int, time: float) -> np.ndarray:
        """Return the displacement of all nodes at a time [s], rotor frame, mesh axes, (n, 3).

        `index` counts the motions, as :attr:`labels` does.
        """
        index = checks.count(index, "index", most=len(self.labels) - 1)
        time = checks.number(time, "time", "s")
        turns = self.rates[index] + self.orders * self.speeds[index]
        return np.tensordot(np.exp(1j * turns * time), self.motion[index], 1).real

    def orbits(self, index: int, points: int = 49) -> list[tuple[np.ndarray, np.ndarray]]:
        """Return centre (3,) and orbit (points, 3) of stations along the axis.

        The orbits are those of the mean motion of a slice of the rotor at the frequency seen from
        outside, in mesh axes that stand still, relative to the centre and in the unit of `motion`.
        """
        index = checks.count(index, "index", most=len(self.labels) - 1)
        angles = np.linspace(0.0, 2.0 * np.pi, checks.count(points, "points", least=2))
        axes, axial_places = axes_of(self.axis), []
        for center, forward, backward, along in self._whirls(index):
            turn = np.exp(1j * angles)
            lateral = forward * turn + backward * turn.conj()
            local = np.stack([lateral.real, lateral.imag, (along * turn).real], axis=1)
            axial_places.append((center, local @ axes.T))
        return axial_places

    def plot(self, index: int = 0, ax: Axes3D | None = None, *, units: str = "rpm") -> Axes3D:
        """Draw the rotor at the time zero and the orbits of its centre line.

        Orbits are blue where the rotor whirls forward, seen from outside and relative to the spin,
        and orange where it whirls backward. The largest displacement is drawn as a tenth of the
        rotor's size.

        Parameters
        ----------
        index : int, optional
            Which shape, counted from 0.
        ax : Axes3D, optional
            3D axes to draw in; those of a new figure by default.
        units : {'rpm', 'Hz', 'SI'}, optional
            Of speed and frequency in the title: 'rpm' has the speed in rpm and the frequency in
            Hz, 'SI' both in rad/s.

        Raises
        ------
        ValueError
            If there is no surface, no motion, or no such shape.
        """
        index = checks.count(index, "index", most=len(self.labels) - 1)
        shown, scale = Units.of(units), self._scale(index)
        reach = scale * np.abs(self.motion[index]).sum(axis=0)
        room = np.concatenate([self.positions - reach, self.positions + reach])
        sizes = np.linalg.norm(reach, axis=1)
        places = self.positions + scale * self.displacement(index, 0.0)
        label = "displacement / largest"
        ax = draw_surface(places, self.triangles, sizes / sizes.max(), label, ax, room=room)
        ax.collections[-1].set(alpha=_ALPHA, linewidth=0.0)
        ax.computed_zorder = False
        known: set[str] = set()
        orbits = self.orbits(index)
        for (center, points), sense in zip(orbits, self._senses(index), strict=True):
            name = sense if sense not in known else None
            known.add(sense)
            line = (center + scale * points).T
            ax.plot(*line, color=_COLORS[sense], lw=1.2, zorder=5, label=name)
        if orbits:
            centers = np.array([center + scale * points[0] for center, points in orbits])
            ax.plot(*centers.T, "k.-", lw=1.0, ms=4, zorder=6, label="centre line")
            # ticks of the third axis are on the right
            ax.legend(loc="upper left", frameon=False, fontsize="small")
        ax.set_title(
            f"{self.labels[index]}\n{shown.frequencies(self.frequencies[index]):.5g} "
            f"{shown.frequency} at a spin of {shown.speeds(self.speeds[index]):.5g} {shown.speed}",
            fontsize="small",
        )
        return ax

    def animate(self, path: str | PathLike, index: int = 0) -> None:
        """Write one period of the motion, seen from outside, as an animated GIF of two seconds.

        The rotor also spins by Ω times the period. A motion that stands still in space is shown
        over one revolution.

        Parameters
        ----------
        path : str or path-like
            Ends with '.gif'; a file there is replaced.
        index : int, optional
            Which shape, counted from 0.

        Raises
        ------
        TypeError, ValueError, OSError
            If an argument is of another kind, there is no surface, or the file cannot be written.
        """
        from matplotlib import pyplot
        from matplotlib.animation import FuncAnimation, PillowWriter

        target = checks.path(path)
        if target.suffix != ".gif":
            raise ValueError(f"path: needs the ending .gif, got {str(target)!r}")
        ax = self.plot(index)
        faces, line = ax.collections[-1], ax.lines[-1]
        scale, corners = self._scale(index), flat_triangles(self.triangles)

        def show(time: float) -> None:
            moved = scale * self.displacement(index, time)
            turn = self.axis.rotation(self.speeds[index] * time).T
            nodes = (self.positions + moved - self.point) @ turn + self.point
            faces.set_verts(nodes[corners])
            faces.set_alpha(_ALPHA)
            if self._stations:
                centers = [center + mean @ moved.ravel() for center, mean in self._stations]
                line.set_data_3d(*((np.array(centers) - self.point) @ turn + self.point).T)

        rate = self.frequencies[index] or abs(self.speeds[index]) or 1.0
        times = 2.0 * np.pi / rate * np.arange(_FRAMES) / _FRAMES
        FuncAnimation(ax.figure, show, times).save(target, PillowWriter(0.5 * _FRAMES))
        pyplot.close(ax.figure)

    # ------------------------------------------------------------------ parts

    @cached_property
    def _stations(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """Points of the axis, and the mean motion (3, 3n) of a slice of the rotor there."""
        axis = self.axis
        along = (self.positions - axis.point) @ axis.direction
        edges = np.linspace(along.min(), along.max(), _STATIONS + 1)
        edges[-1] += 1e-9 * np.ptp(edges)
        stations = []
        for low, high in itertools.pairwise(edges):
            nodes = np.flatnonzero((along >= low) & (along < high))
            if nodes.size < 3:
                continue
            center = axis.point + 0.5 * (low + high) * axis.direction
            station = Interface("station", nodes, None, self.positions[nodes]).centered_on(center)
            stations.append((center, station.mean_motion(len(self.positions))[:3]))
        return stations

    def _whirls(self, index: int) -> list[tuple[np.ndarray, complex, complex, complex]]:
        """Return centre, forward and backward amplitude, and axial amplitude of all stations."""
        axes, speed, seen = axes_of(self.axis), self.speeds[index], self.frequencies[index]
        turns = self.rates[index] + self.orders * speed
        near = _SAME * max(abs(speed), seen, 1e-300)
        stations = []
        for center, mean in self._stations:
            local = np.array([axes.T @ (mean @ row.ravel()) for row in self.motion[index]])
            a = 0.5 * (local[:, 0] + 1j * local[:, 1])
            b = 0.5 * (local[:, 0] - 1j * local[:, 1]).conj()
            rates = np.concatenate([turns + speed, speed - turns])
            both = np.concatenate([a, b])
            forward = both[np.abs(rates - seen) <= near].sum()
            backward = both[(np.abs(rates + seen) <= near) & (seen > 0.0)].sum()
            axial = local[np.abs(np.abs(turns) - seen) <= near, 2].sum()
            stations.append((center, forward, backward, axial))
        return stations

    def _senses(self, index: int) -> list[str]:
        sign = np.sign(self.speeds[index]) or 1.0
        largest = np.linalg.norm(np.abs(self.motion[index]).sum(axis=0), axis=1).max()
        senses, whirls = [], self._whirls(index)
        lateral = max((abs(a) + abs(b) for _, a, b, _ in whirls), default=0.0)
        for _, forward, backward, axial in whirls:
            ahead = sign * (abs(forward) - abs(backward))
            straight = abs(ahead) <= _STRAIGHT * max(abs(forward), abs(backward), abs(axial))
            straight |= lateral <= _UNEVEN * largest
            senses.append("straight" if straight else "forward" if ahead > 0.0 else "backward")
        return senses

    def _scale(self, index: int) -> float:
        """Return by how much displacements are drawn larger than they are."""
        largest = np.linalg.norm(np.abs(self.motion[index]).sum(axis=0), axis=1).max()
        if largest == 0.0:
            raise ValueError(f"index: the shape {index}, {self.labels[index]!r}, has no motion")
        return _SHARE * np.ptp(self.positions, axis=0).max() / largest
