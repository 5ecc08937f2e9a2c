"""Result of :func:`exudyn_rotor.rolling_bearing_response`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks, plotting
from exudyn_rotor.linear.modal.basis_error import in_table
from exudyn_rotor.linear.response.response import DIRECTIONS
from exudyn_rotor.linear.response.run_start import RunStart
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.rotor.start_state import StartState
from exudyn_rotor.results import numbers, storable, words
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_POINTS = 64  # over a ball pass and over a revolution, where the largest motion is looked for


@storable
@dataclass(frozen=True, eq=False)
class RollingBearingResponse(RunStart):
    """Steady motion ``u(t) = Re Σ a_kn exp i(kψ + nθ)``, ``ψ = qΩt``, ``θ = Ωt``, inertial axes.

    Attributes
    ----------
    places : tuple of str
        Interfaces and nodes (p), 'node 12'.
    speeds : ndarray, shape (s,)
        Spin speeds Ω [rad/s].
    orders : ndarray of int, shape (h, 2)
        k of the ball pass and n of the spin; (0, 0) is the constant displacement.
    motion : ndarray of complex, shape (s, p, h, 6)
        Amplitudes of the displacement along (n1, n2, e) [m] and the rotation about them [rad];
        rotations of a node are NaN.
    passes : float
        q: elements that pass the load in a revolution, Zκ.
    bearings : tuple of str
        Interfaces of the rolling bearings (b).
    element_loads : ndarray, shape (s, b)
        Largest load of an element [N].
    open_shares : ndarray, shape (s, b)
        Share of the time in which no element carries.
    linear_errors : ndarray, shape (s,)
        By how much linear equations err: with the mean stiffness in the mean place, and all forces
        there. Relative to the motion of the bearings; NaN where one without load has no such place.
    errors : ndarray, shape (s,)
        Size of the harmonics left out, relative to the motion.
    exponents : ndarray, shape (s,)
        Largest exponent of small motions beside the steady one [1/s]: below zero they decay, and
        far below, within a ball pass, at least as fast; NaN where it is not known.
    exponent_errors : ndarray, shape (s,)
        Its error [1/s]; infinite where it is not known.
    coordinate_orders : ndarray of int, shape (c, 2)
        As `orders`, of :attr:`coordinates`, rotor frame.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import RollingBearingResponse
    >>> motion = np.zeros((1, 1, 2, 6), dtype=complex)
    >>> motion[0, 0, :, 1] = -2e-5, 1e-6j
    >>> response = RollingBearingResponse(
    ...     ("left",), [100.0], [[0, 0], [1, 0]], motion, 3.25, ("left",), [[200.0]], [[0.0]],
    ...     [0.01], [1e-4], [-20.0], [1.0], [[0, 0]],
    ... )
    >>> response.verdicts
    ('stable',)
    >>> print(response.end_to_end("left").round(8))
    [[0.e+00 2.e-06]]
    """

    places: tuple[str, ...] = words("places")
    speeds: np.ndarray = numbers("abscissa")
    orders: np.ndarray = numbers("orders", 2, dtype=int)
    motion: np.ndarray = numbers("abscissa", "places", "orders", 6, dtype=complex, finite=False)
    passes: float
    bearings: tuple[str, ...] = words("bearings")
    element_loads: np.ndarray = numbers("abscissa", "bearings", least=0.0, finite=False)
    open_shares: np.ndarray = numbers("abscissa", "bearings", least=0.0, most=1.0, finite=False)
    linear_errors: np.ndarray = numbers("abscissa", finite=False)
    errors: np.ndarray = numbers("abscissa", least=0.0, finite=False)
    exponents: np.ndarray = numbers("abscissa", finite=False)
    exponent_errors: np.ndarray = numbers("abscissa", finite=False)
    coordinate_orders: np.ndarray = numbers("harmonics", 2, dtype=int)

    @property
    def abscissa(self) -> np.ndarray:
        """The spin speeds [rad/s]."""
        return self.speeds

    @property
    def verdicts(self) -> tuple[str, ...]:
        """'stable', 'unstable' or 'not determined' at every speed, by exponent and error."""
        sure = np.abs(self.exponents) > self.exponent_errors
        return tuple(
            ("unstable" if exponent > 0.0 else "stable") if known else "not determined"
            for exponent, known in zip(self.exponents, sure, strict=True)
        )

    def phasor(
        self, place: str | None = None, direction: str = "n2", passing: int = 1, spin: int = 0
    ) -> np.ndarray:
        """Return complex amplitudes of one harmonic, shape (s,); zero where it does not matter.

        Parameters
        ----------
        place : str, optional
            The first one by default.
        direction : {'n1', 'n2', 'e', 'tilt n1', 'tilt n2', 'twist'}
        passing, spin : int, optional
            k ≥ 0 and n: (1, 0) is the ball pass, (0, 1) the spin.
        """
        checks.choice(direction, "direction", DIRECTIONS)
        order = checks.count(passing, "passing"), checks.whole_number(spin, "spin")
        at = np.flatnonzero((self.orders == order).all(axis=1))
        column = self.motion[:, self._at(place), :, DIRECTIONS.index(direction)]
        return column[:, at[0]] if at.size else np.zeros(len(self.speeds), dtype=complex)

    def displacement(self, speed: float, time: ArrayLike, place: str | None = None) -> np.ndarray:
        """Return the displacement over time along (n1, n2), shape (t, 2) [m].

        Parameters
        ----------
        speed : float
            The nearest computed one is taken [rad/s].
        time : array_like, shape (t,)
            [s]; at 0 the spin angle is 0, and an element on n1.
        place : str, optional
            The first one by default.
        """
        time = checks.array(time, "time", "s", shape=(None,))
        index = int(np.argmin(np.abs(self.speeds - checks.number(speed, "speed", "rad/s"))))
        waves = np.exp(1j * np.outer(time, self._rates(self.orders, index)))
        return (waves @ self.motion[index, self._at(place), :, :2]).real

    def end_to_end(self, place: str | None = None) -> np.ndarray:
        """Return the way from end to end of the motion along n1 and n2, shape (s, 2) [m]."""
        angles = 2.0 * np.pi * np.arange(_POINTS) / _POINTS
        spins = angles if np.any(self.orders[:, 1]) else angles[:1]
        phases = np.multiply.outer(angles, self.orders[:, 0])[:, None] + np.multiply.outer(
            spins, self.orders[:, 1]
        )
        waves = np.exp(1j * phases).reshape(-1, len(self.orders))
        seen = np.array([(waves @ each).real for each in self.motion[:, self._at(place), :, :2]])
        return np.ptp(seen, axis=1)

    def state(self, speed: float, body: RotorBody, *, angle: float | None = None) -> StartState:
        """Return the state of a scene in which a run begins in this steady motion.

        Parameters
        ----------
        speed : float
            One of :attr:`speeds` [rad/s].
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
            As :meth:`UnbalanceResponse.state`.
        """
        return self._start_at_speed(speed, body, angle)

    def _check_harmonics(self) -> None:
        """Let every number of harmonics be."""

    def _waves(self, index: int) -> tuple[np.ndarray, np.ndarray]:
        phases = self.coordinate_orders @ [self.passes, 1.0]
        return phases, phases * self.speeds[index]

    def _rates(self, orders: np.ndarray, index: int) -> np.ndarray:
        return orders @ [self.passes, 1.0] * self.speeds[index]

    def _at(self, place: str | None) -> int:
        if place is None:
            return 0
        return self.places.index(checks.choice(place, "place", self.places))

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return motions, loads and errors as columns, one row for each speed and place."""
        unit = Units.of(units)
        count = len(self.places)
        parts = [
            {
                f"spin speed [{unit.speed}]": unit.speeds(self.speeds),
                "place": np.full(len(self.speeds), place),
                "n1, end to end [m]": self.end_to_end(place)[:, 0],
                "n2, end to end [m]": self.end_to_end(place)[:, 1],
                "n1, ball pass [m]": np.abs(self.phasor(place, "n1")),
                "n2, ball pass [m]": np.abs(self.phasor(place, "n2")),
                "n1, spin [m]": np.abs(self.phasor(place, "n1", 0, 1)),
                "n2, spin [m]": np.abs(self.phasor(place, "n2", 0, 1)),
            }
            for place in self.places
        ]
        columns = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
        for b, name in enumerate(self.bearings):
            columns[f"element load, {name} [N]"] = np.tile(self.element_loads[:, b], count)
            columns[f"open, {name}"] = np.tile(self.open_shares[:, b], count)
        ends = {
            "linear error": self.linear_errors,
            "error": self.errors,
            "exponent [1/s]": self.exponents,
            "exponent error [1/s]": self.exponent_errors,
            "motion": np.array(self.verdicts),
        }
        return columns | {name: np.tile(each, count) for name, each in ends.items()}

    def table(self, place: str | None = None, *, units: str = "SI") -> str:
        """Return motions at one place, loads and errors as text; units as in :meth:`columns`.

        'open' is the largest share of time in which a bearing does not carry at all.
        """
        unit, name = Units.of(units), self.places[self._at(place)]
        ends, loads = self.end_to_end(name), self.element_loads.max(axis=1)
        sizes = [np.abs(self.phasor(name, "n2", *order)) for order in ((1, 0), (0, 1))]
        lines = [
            f"{name}, {self.passes:.4g} elements pass in a revolution",
            f"{'spin speed':>12} {'end to end [m]':>21} {'amplitude along n2 [m]':>22} "
            f"{'element':>10} {'':>6} {'linear':>8} {'':>8} {'exponent':>9}",
            f"{'[' + unit.speed + ']':>12} {'n1':>10} {'n2':>10} {'pass':>11} {'spin':>10} "
            f"{'load [N]':>10} {'open':>6} {'error':>8} {'error':>8} {'[1/s]':>9}  motion",
        ]
        rows = zip(unit.speeds(self.speeds), *ends.T, *sizes, loads, self.open_shares.max(axis=1),
                   self.linear_errors, self.errors, self.exponents, self.verdicts,
                   strict=True)  # fmt: skip
        for at, x, y, passing, spin, load, away, linear, error, exponent, verdict in rows:
            lines.append(
                f"{at:12.6g} {x:10.3e} {y:10.3e} {passing:11.3e} {spin:10.3e} {load:10.4g} "
                f"{away:6.3f} {in_table(linear):>8} {error:8.1e} {exponent:9.3g}  {verdict}"
            )
        return "\n".join(lines)

    def plot(self, place: str | None = None, *, ax: Axes | None = None, units: str = "Hz") -> Axes:
        """Draw the motion from end to end along n1 and n2 [µm] over the spin speed.

        Crosses mark where it is unstable, circles where that is not determined.

        Parameters
        ----------
        place : str, optional
            The first one by default.
        ax : matplotlib.axes.Axes, optional
            A new figure by default.
        units : {'Hz', 'rpm', 'SI'}
        """
        unit, name = Units.of(units), self.places[self._at(place)]
        ax = plotting.axes_or_new(ax)
        colors = plotting.COLORS[:2]
        for label, values, color in zip(("n1", "n2"), self.end_to_end(name).T, colors, strict=True):
            ax.plot(unit.speeds(self.speeds), 1e6 * values, ".-", color=color, label=label)
        unsure = (("unstable", "x", "k"), ("not determined", "o", "0.5"))
        for verdict, marker, color in unsure:
            at = np.array(self.verdicts) == verdict
            if at.any():
                shown = {"color": color, "mfc": "none", "label": verdict}
                way = 1e6 * self.end_to_end(name)[at]
                ax.plot(np.repeat(unit.speeds(self.speeds)[at], 2), way.ravel(), marker, **shown)
        ax.set_xlabel(f"spin speed [{unit.speed}]")
        ax.set_ylabel("motion from end to end [µm]")
        ax.set_title(name, loc="right", fontsize=10)
        ax.legend()
        return ax
