"""Result of :func:`exudyn_rotor.periodic_response` and :func:`exudyn_rotor.limit_cycles`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks, plotting
from exudyn_rotor.linear.response.response import DIRECTIONS, AtPlaces
from exudyn_rotor.multibody.full.full_body import reduced_body
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody, StartState
from exudyn_rotor.nonlinear.scene import state_in_scene
from exudyn_rotor.results import numbers, storable, text_table, words
from exudyn_rotor.units import IN_HERTZ, Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_POINTS = 64  # over a phase at least, where the largest motion is looked for
_PER_WAVE = 8
_SAME = 1e-9  # relative difference of values that is rounding
_SPEED = "speed [rad/s]"  # how the names of parameters end that are shown in other units
_MARKERS = {"fold": "D", "doubling": "^", "torus": "s", "branching": "P"}


@storable
@dataclass(frozen=True, eq=False)
class PeriodicResponse(AtPlaces):
    """Branches of steady motions ``u = Re Σ a_kn exp i(kφ + nθ/r)``, in axes that stand still.

    θ is the spin angle; the second phase φ is of the ball pass, or of a limit cycle; it has no
    harmonics otherwise. The points (p) of a branch follow one another.

    Attributes
    ----------
    places : tuple of str
        Interfaces and nodes, 'node 12'.
    values : ndarray, shape (p,)
        The parameter.
    branches : ndarray of int, shape (p,)
        Number of the branch.
    kinds : tuple of str
        'computed'; 'value' (one of those asked for); 'fold', where the branch turns back;
        'doubling', where a motion of twice the period begins; 'torus', where one with a second
        frequency begins; 'branching', where branches cross.
    speeds : ndarray, shape (p,)
        Spin speeds Ω [rad/s].
    rates : ndarray, shape (p, 2)
        Frequencies of φ and of θ/r [rad/s].
    orders : ndarray of int, shape (h, 2)
        k and n; (0, 0) is the constant displacement.
    motion : ndarray of complex, shape (p, places, h, 6)
        Amplitudes of the displacement along (n1, n2, e) [m] and the rotation about them [rad]:
        peak values; rotations of a node are NaN.
    bearings : tuple of str
        Interfaces of the nonlinear bearings (b).
    forces : ndarray, shape (p, b)
        Largest force [N].
    gaps : ndarray, shape (p, b)
        Least distance to the end of the clearance [m], below zero beyond; NaN without clearance.
    element_loads : ndarray, shape (p, b)
        Largest load of an element of a rolling bearing [N]; NaN of others.
    errors : ndarray, shape (p,)
        Size of the harmonics left out, relative to the motion.
    growth : ndarray, shape (p,)
        Largest growth of small motions beside [1/s]: the motion is stable below zero.
    multipliers : ndarray of complex, shape (p,)
        Of these motions, over a period.
    revolutions : int
        r.
    label : str
        The parameter and its unit.
    coordinate_orders : ndarray of int, shape (c, 2)
        As `orders`, of `coordinates`.
    coordinates : ndarray of complex, shape (p, c, k), optional
        Harmonics of the coordinates of the reduced rotor in its own axes, from which runs begin.
    beside : tuple of str, optional
        Names of those after the reduced rotor's: of a foundation, of controllers.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import PeriodicResponse
    >>> motion = np.zeros((1, 1, 2, 6), dtype=complex)
    >>> motion[0, 0, :, 0], motion[0, 0, :, 1] = (0.0, 1e-5), (-2e-5, -1e-5j)
    >>> response = PeriodicResponse(
    ...     ("left",), [100.0], [0], ("value",), [100.0], [[0.0, 100.0]], [[0, 0], [0, 1]], motion,
    ...     ("left",), [[200.0]], [[1e-4]], [[np.nan]], [1e-4], [-20.0], [0.28], 1,
    ...     "spin speed [rad/s]", np.zeros((0, 2), dtype=int),
    ... )
    >>> response.stable.tolist(), response.at(100.0).tolist()
    ([True], [0])
    >>> response.amplitudes("left").round(8)
    array([1.e-05])
    """

    values: np.ndarray = numbers("abscissa")
    branches: np.ndarray = numbers("abscissa", dtype=int, least=0)
    kinds: tuple[str, ...] = words("abscissa")
    speeds: np.ndarray = numbers("abscissa")
    rates: np.ndarray = numbers("abscissa", 2)
    orders: np.ndarray = numbers("orders", 2, dtype=int)
    motion: np.ndarray = numbers("abscissa", "places", "orders", 6, dtype=complex, finite=False)
    bearings: tuple[str, ...] = words("bearings")
    forces: np.ndarray = numbers("abscissa", "bearings", least=0.0)
    gaps: np.ndarray = numbers("abscissa", "bearings", finite=False)
    element_loads: np.ndarray = numbers("abscissa", "bearings", finite=False)
    errors: np.ndarray = numbers("abscissa", finite=False)
    growth: np.ndarray = numbers("abscissa", finite=False)
    multipliers: np.ndarray = numbers("abscissa", dtype=complex, finite=False)
    revolutions: int
    label: str
    coordinate_orders: np.ndarray = numbers("harmonics", 2, dtype=int)
    coordinates: np.ndarray | None = numbers(
        "abscissa", "harmonics", "coordinates", dtype=complex, finite=False, optional=True
    )
    beside: tuple[str, ...] = words("beside", default=(), kw_only=True)

    def __repr__(self) -> str:
        """Return one line."""
        count = len(np.unique(self.branches))
        span = f"{self.values.min():g} to {self.values.max():g}"
        return (
            f"PeriodicResponse({len(self.values)} points on {count} branches over the "
            f"{self.label}, {span})"
        )

    @property
    def stable(self) -> np.ndarray:
        """Whether the motion of each point is stable, shape (p,)."""
        return self.growth < 0.0

    def at(self, value: float) -> np.ndarray:
        """Return the numbers of all points at a value of the parameter.

        Parameters
        ----------
        value : float
            One of those asked for.

        Raises
        ------
        TypeError, ValueError
            For no number, or a value at which there is no point.
        """
        value = checks.number(value, "value")
        wanted = np.array(self.kinds) == "value"
        near = np.abs(self.values - value) <= _SAME * max(abs(value), 1e-300)
        found = np.flatnonzero(near & wanted)
        if not found.size:
            known = np.unique(self.values[wanted])
            nearest = f"{known[np.argmin(np.abs(known - value))]:g}" if known.size else "none"
            raise ValueError(f"value: nothing was computed at {value:g}; the nearest is {nearest}")
        return found

    def phasor(
        self, place: str | None = None, direction: str = "n2", spin: float = 1.0, passing: int = 0
    ) -> np.ndarray:
        """Return complex amplitudes of one harmonic, shape (p,); zero where it does not matter.

        Parameters
        ----------
        place : str, optional
            The first one by default.
        direction : {'n1', 'n2', 'e', 'tilt n1', 'tilt n2', 'twist'}
        spin : float, optional
            Multiple of the spin frequency, such as 0.5 with two `revolutions`.
        passing : int, optional
            Multiple of the frequency of the second phase.
        """
        checks.choice(direction, "direction", DIRECTIONS)
        turns = checks.number(spin, "spin") * self.revolutions
        order = checks.count(passing, "passing"), round(turns)
        if abs(turns - order[1]) > _SAME:
            raise ValueError(
                f"spin: needs a multiple of 1/{self.revolutions}, got {spin:g}; revolutions=… of "
                "periodic_response takes longer periods"
            )
        column = self.motion[:, self._at(place), :, DIRECTIONS.index(direction)]
        return column[:, (self.orders == order).all(axis=1)].sum(axis=1)

    def displacement(self, point: int, time: ArrayLike, place: str | None = None) -> np.ndarray:
        """Return the displacement over time along (n1, n2), shape (t, 2) [m].

        Parameters
        ----------
        point : int
        time : array_like, shape (t,)
            [s]; at 0 both phases are 0.
        place : str, optional
            The first one by default.
        """
        point = self._point(point)
        time = checks.array(time, "time", "s", shape=(None,))
        waves = np.exp(1j * np.outer(time, self.orders @ self.rates[point]))
        return (waves @ self.motion[point, self._at(place), :, :2]).real

    def orbit(self, point: int, place: str | None = None) -> np.ndarray:
        """Return displacements along (n1, n2) over both phases, shape (t, 2) [m]."""
        return self._over_phases(place)[self._point(point)]

    def amplitudes(self, place: str | None = None) -> np.ndarray:
        """Return the largest distance from the mean place, shape (p,) [m]."""
        seen, constant = self._over_phases(place), ~np.any(self.orders, axis=1)
        mean = self.motion[:, self._at(place), constant, :2].real.sum(axis=1)
        return np.linalg.norm(seen - mean[:, None], axis=-1).max(axis=1)

    def _over_phases(self, place: str | None) -> np.ndarray:
        """Return displacements along (n1, n2) on a grid over both phases, (p, t, 2)."""
        tops = np.abs(self.orders).max(axis=0)
        counts = [max(_POINTS, _PER_WAVE * top) if top else 1 for top in tops]
        phases = (2.0 * np.pi * np.arange(count) / count for count in counts)
        grid = np.array(np.meshgrid(*phases, indexing="ij")).reshape(2, -1)
        waves = np.exp(1j * (self.orders @ grid).T)
        return (waves @ self.motion[:, self._at(place), :, :2]).real

    def state(self, point: int, body: RotorBody, *, angle: float | None = None) -> StartState:
        """Return the state of a scene in which a run begins in the motion of a point.

        Parameters
        ----------
        point : int
            Its number, of :meth:`at` for instance.
        body : RotorBody
            Of the reduced rotor that the response is of, in an assembled system with the same
            supports, unbalances and weight.
        angle : float, optional
            Spin angle θ [rad]; the one with which the rotor starts by default.

        Returns
        -------
        StartState
            For :meth:`RotorBody.start_from`.

        Raises
        ------
        TypeError, ValueError
            For another rotor or foundation, controllers or pads, or a system not assembled.
        """
        reduced_body(body)
        angle = body.placement.angle if angle is None else checks.number(angle, "angle", "rad")
        point = self._point(point)
        if self.coordinates is None:
            raise ValueError(
                "state: the response keeps no coordinates: supports have coordinates that turn"
            )
        rates, speed = self.coordinate_orders @ self.rates[point], float(self.speeds[point])
        phases = angle * (rates / speed) if speed else 0.0 * rates
        turned = np.exp(1j * phases)[:, None] * self.coordinates[point]
        x, x_t = turned.sum(axis=0).real, (1j * rates[:, None] * turned).sum(axis=0).real
        return state_in_scene(body, x, x_t, len(self.beside), angle, speed)

    def _point(self, point: int) -> int:
        return checks.count(point, "point", most=len(self.values) - 1)

    # ------------------------------------------------------------ tables and pictures

    def _shown(self, units: str) -> tuple[np.ndarray, str]:
        """Return values of the parameter and its name, speeds in their unit."""
        if not self.label.endswith(_SPEED):
            return self.values, self.label
        unit = Units.of(units)
        return unit.speeds(self.values), self.label.replace("rad/s", unit.speed)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return motions and forces as columns, one row for each point."""
        values, label = self._shown(units)
        columns = {label: values, "branch": self.branches, "kind": np.array(self.kinds)}
        columns |= {f"amplitude, {place} [m]": self.amplitudes(place) for place in self.places}
        for b, name in enumerate(self.bearings):
            columns |= {
                f"force, {name} [N]": self.forces[:, b],
                f"gap, {name} [m]": self.gaps[:, b],
                f"element load, {name} [N]": self.element_loads[:, b],
            }
        return columns | {
            "second frequency [Hz]": IN_HERTZ * self.rates[:, 0],
            "error": self.errors,
            "growth [1/s]": self.growth,
            "stable": self.stable,
        }

    def table(self, place: str | None = None, *, units: str = "rpm") -> str:
        """Return motions at one place as text: wanted values and changes of the motion."""
        values, label = self._shown(units)
        name = self.places[self._at(place)]
        kinds = np.array(self.kinds)
        columns = {
            label: values,
            "branch": self.branches,
            "amplitude [m]": self.amplitudes(name),
            "force [N]": self.forces.max(axis=1),
            "gap [m]": np.fmin.reduce(self.gaps, axis=1),
            "growth [1/s]": self.growth,
            "motion": np.where(
                np.isin(kinds, [*_MARKERS]), kinds, np.where(self.stable, "stable", "unstable")
            ),
        }
        shown = kinds != "computed"
        lines = text_table({title: column[shown] for title, column in columns.items()})
        return "\n".join([name, *lines])

    def plot(self, place: str | None = None, *, ax: Axes | None = None, units: str = "rpm") -> Axes:
        """Draw the largest distance from the mean place [µm] over the parameter.

        Stable parts of branches are full, unstable ones dashed; changes are marked.

        Parameters
        ----------
        place : str, optional
            The first one by default.
        ax : matplotlib.axes.Axes, optional
            A new figure by default.
        units : {'rpm', 'Hz', 'SI'}
        """
        values, label = self._shown(units)
        name = self.places[self._at(place)]
        amplitudes = 1e6 * self.amplitudes(name)
        ax = plotting.axes_or_new(ax)
        for branch in np.unique(self.branches):
            rows = np.flatnonzero(self.branches == branch)
            stable = self.stable[rows]
            ends = np.flatnonzero(stable[1:] != stable[:-1]) + 1
            color = plotting.COLORS[branch % len(plotting.COLORS)]
            for part in np.split(np.arange(len(rows)), ends):
                shown = rows[part[0] : part[-1] + 2]  # to where the next part begins
                word, line = ("stable", "-") if stable[part[0]] else ("unstable", "--")
                ax.plot(values[shown], amplitudes[shown], line, color=color, label=word)
        for kind, marker in _MARKERS.items():
            at = np.array(self.kinds) == kind
            if at.any():
                ax.plot(values[at], amplitudes[at], marker, color="k", mfc="w", label=kind)
        ax.set_xlabel(label)
        ax.set_ylabel("amplitude [µm]")
        ax.set_title(name, loc="right", fontsize=10)
        once = {line.get_label(): line for line in ax.lines}
        ax.legend(handles=list(once.values()))
        return ax
