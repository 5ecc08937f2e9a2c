"""Motion of a rotor over time while a record shakes the ground.

The equations of :class:`PeriodicSystem` with ``f = −Sᵀ Aᵀ a(t)`` (109), in first order with the
load beside the state, ``(x, ẋ, a, ȧ)``: one matrix exponential of a fourth-order Magnus series for
each step of a revolution, and then nothing but products. In each step the record is the straight
line with its mean and first moment, both exact. Steps are halved until the motion no longer
changes, and straight lines between them follow it: a rotor may swing faster than its record.
Source of the series: Blanes, Casas, Oteo, Ros, Phys. Rep. 470 (2009), Sect. 5.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from matplotlib.axes import Axes

from exudyn_rotor import checks, plotting
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.foundations.record import BaseRecord
from exudyn_rotor.linear import options
from exudyn_rotor.linear.models.linear_model import (
    Target,
    linear_model,
    warn_of_left_out_stiffening,
    warn_of_structural_damping,
)
from exudyn_rotor.linear.models.rotor.extended_rotor import ExtendedRotor
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, UnconvergedError
from exudyn_rotor.linear.response.places import At, Place, checked_places, places
from exudyn_rotor.linear.response.response import DIRECTIONS
from exudyn_rotor.results import Result, numbers, storable, words
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.rotating_axes import axes_of, turning_harmonics
from exudyn_rotor.threads import one_thread

_PER_TURN, _IN_ALL = 24, 200  # least numbers of steps in a revolution and in a record
_MOST_HALVINGS = 7
_BETWEEN = 0.01  # of the largest motion: how far straight lines between the times may be off


@storable
@dataclass(frozen=True, eq=False)
class BaseResponse(Result):
    """Motion against the ground over time, along and about (n1, n2, e), inertial axes.

    Attributes
    ----------
    places : tuple of str
    time : ndarray, shape (t,)
        So close that straight lines between them are within 1 % of the largest displacement [s].
    motion : ndarray, shape (t, p, 6)
        Displacement [m] and rotation [rad]; NaN for rotations of mesh nodes.
    speed : float
        Spin speed [rad/s].

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import BaseResponse
    >>> motion = np.zeros((3, 1, 6))
    >>> motion[1, 0, :2] = 3e-6, 4e-6
    >>> print(BaseResponse(("left",), [0.0, 0.1, 0.2], motion, 50.0).table())
    largest motion against the ground at 50 rad/s
    place                     n1 [m]      n2 [m]       e [m]  across [m]  at [s]
    left                   3.000e-06   4.000e-06   0.000e+00   5.000e-06  0.1
    """

    places: tuple[str, ...] = words("places")
    time: np.ndarray = numbers("steps")
    motion: np.ndarray = numbers("steps", "places", 6, finite=False)
    speed: float = 0.0

    def displacement(self, place: str) -> np.ndarray:
        """Return the displacement of a place over time, shape (t, 3) [m]."""
        return self._moved(place, "place")

    def between(self, place: str, other: str) -> np.ndarray:
        """Return the displacement of a place against another, shape (t, 3) [m].

        Of a journal against its foundation: ``between("left", "left (foundation)")``.
        """
        return self._moved(place, "place") - self._moved(other, "other")

    def peak(self, place: str, other: str | None = None) -> tuple[float, float]:
        """Return the largest displacement across the axis [m], and its time [s].

        Against another place, if one is named.
        """
        moved = self.displacement(place) if other is None else self.between(place, other)
        across = np.hypot(moved[:, 0], moved[:, 1])
        return float(across.max()), float(self.time[np.argmax(across)])

    def table(self) -> str:
        """Return the largest values of every place as text."""
        lines = [
            f"largest motion against the ground at {self.speed:g} rad/s",
            "place                     n1 [m]      n2 [m]       e [m]  across [m]  at [s]",
        ]
        for place in self.places:
            most = np.abs(self.displacement(place)).max(axis=0)
            across, time = self.peak(place)
            values = "".join(f"{value:12.3e}" for value in (*most, across))
            lines.append(f"{place:20}{values}  {time:.6g}")
        return "\n".join(lines)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return time and displacements as columns."""
        checks.choice(units, "units", ("SI", "Hz", "rpm"))
        moved = {
            f"{place} {direction} [m]": self.motion[:, index, axis]
            for index, place in enumerate(self.places)
            for axis, direction in enumerate(DIRECTIONS[:3])
        }
        return {"time [s]": self.time} | moved

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the displacement across the axis over time."""
        ax = plotting.axes_or_new(ax)
        for index, place in enumerate(self.places):
            across = np.hypot(*self.motion[:, index, :2].T)
            color = plotting.COLORS[index % len(plotting.COLORS)]
            ax.plot(self.time, 1e6 * across, color=color, label=place)
        ax.set_xlabel("time [s]")
        ax.set_ylabel("displacement across the axis [µm]")
        ax.legend()
        return ax

    def _moved(self, place: str, name: str) -> np.ndarray:
        return self.motion[:, self.places.index(checks.choice(place, name, self.places)), :3]


def base_response(
    target: Target,
    record: BaseRecord,
    *,
    speed: float = 0.0,
    supports: Sequence[Support] = (),
    at: Sequence[At] | At | None = None,
    end_time: float | None = None,
    stiffening: str = "auto",
    tolerance: float = 1e-5,
) -> BaseResponse:
    """Compute the motion of a rotor at constant speed while a record shakes the ground.

    From rest against the ground. Unbalance and weight are not in it: :func:`unbalance_response` has
    the one, and linear motions add up.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor or linear model
        See :func:`linear_model`; a large SolidRotor must be reduced, and a foundation is that of a
        model.
    record : BaseRecord
        Its axes are those of the rotor's mesh at the spin angle 0.
    speed : float, optional
        Spin speed Ω [rad/s].
    supports : sequence of Support, optional
        Of a rotor.
    at : sequence of str, int or position, optional
        All interfaces and points of a foundation by default.
    end_time : float, optional
        [s]; the end of the record by default.
    stiffening : {'auto', 'none', 'tilt', 'full'}
    tolerance : float, optional
        Largest change of a motion by halved steps, relative to the largest motion.

    Raises
    ------
    TypeError, ValueError
        For bad input, unknown places, a scene, a foundation without participation, and motions
        that leave the range of floats or do not converge.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import BaseRecord, SolidRotor, Support, base_response
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4) for name in ("left", "right")]
    >>> step = BaseRecord(np.linspace(0.0, 0.05, 101), np.tile([1.0, 0.0, 0.0], (101, 1)))
    >>> response = base_response(rotor, step, speed=50.0, supports=supports)
    >>> round(response.peak("left")[0], 6)  # 2 a / ω², ω = 100 rad/s
    0.0002
    """
    checks.instance(record, "record", BaseRecord)
    speed = checks.number(speed, "speed", "rad/s")
    tolerance = options.accuracy(tolerance, "tolerance")
    start, end = record.times[[0, -1]]
    if end_time is not None:
        end = checks.number(end_time, "end_time", "s", above=start)
    at = checked_places(at)
    model = linear_model(target, supports=supports, stiffening=stiffening)
    known = isinstance(model, LinearRotor | ExtendedRotor)
    if not known or model.base_loads is None:
        raise ValueError(
            "target: a motion of the ground needs a reduced rotor on supports, and a foundation "
            "with its participation; in a scene, use add_base_motion"
        )
    warn_of_structural_damping(model, "base_response computes motion over time")
    warn_of_left_out_stiffening(model, speed)
    observed = places(model, at)
    problem = _Problem.of(model, speed, record, observed)
    time, motion = problem.converged(float(start), float(end), tolerance)
    motion[:, [one.is_node for one in observed], 3:] = np.nan
    return BaseResponse(tuple(one.label for one in observed), time, motion, speed)


@dataclass(frozen=True, eq=False)
class _Problem:
    """Equations without a free spin, the record along (n1, n2, e), and what is looked at."""

    system: PeriodicSystem
    loads: np.ndarray
    record: BaseRecord
    rows: np.ndarray
    stands: np.ndarray

    @classmethod
    def of(
        cls,
        model: LinearRotor | ExtendedRotor,
        speed: float,
        record: BaseRecord,
        observed: Sequence[Place],
    ) -> _Problem:
        space = model.space(1, abs(speed), held=True)
        T = np.eye(model.size) if space.others is None else space.others
        standing = np.isin(np.arange(model.size), model.standing)
        turned = record.turned(axes_of(SpinAxis(model.invariants.direction)).T)
        loads = np.stack([T.T @ np.where(which, model.base_loads, 0.0).T
                          for which in (~standing, standing)])  # fmt: skip
        rows = np.array([one.motion @ T for one in observed])
        stands = np.array([one.stands for one in observed])
        return cls(space.at(speed), loads, turned, rows, stands)

    @one_thread()
    def converged(
        self, start: float, end: float, tolerance: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return times and motions (t, p, 6), with steps small enough."""
        coarse, last = self._first_step(end - start), None
        for halving in range(_MOST_HALVINGS):
            every = 2**halving
            time, motion = self._motion(start, end, coarse / every, every)
            if not np.all(np.isfinite(motion)):
                raise ValueError(
                    "base response: the motion leaves the range of floats; is the rotor unstable "
                    "at this speed?"
                )
            moved = motion[..., :3]
            size = np.abs(moved).max()
            if last is not None and np.abs(moved[::2] - last).max() <= tolerance * size:
                strides = (every >> fewer for fewer in range(halving))
                kept = next((n for n in strides if _follow(moved[:: n // 2], size)), None)
                if kept is not None:
                    return time[::kept], motion[::kept]
            last = moved
        raise UnconvergedError(
            f"base response: steps of {coarse / every:.2g} s are too long for the motion; give an "
            "earlier end_time, or a reduced rotor without modes that are so fast"
        )

    def _first_step(self, length: float) -> float:
        """Return the largest step: a whole part of a revolution, and of the record's at rest."""
        largest = min(self.record.step, length / _IN_ALL)
        if self.system.speed == 0.0:
            return largest
        turn = 2.0 * np.pi / abs(self.system.speed)
        return turn / max(_PER_TURN, int(np.ceil(turn / largest)))

    def _motion(
        self, start: float, end: float, step: float, every: int
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return times and motions of all steps, a multiple of `every`."""
        count = every * max(1, int(np.floor((end - start) / (every * step) + 1e-9)))
        times = start + step * np.arange(count + 1)
        speed = self.system.speed
        per_turn = 1 if speed == 0.0 else round(2.0 * np.pi / abs(speed) / step)
        angles = speed * step * np.arange(min(per_turn, count))
        by_state, by_load = self._propagators(angles, step)
        mean, slope = self._lines(times, step)
        loads = np.concatenate([mean - 0.5 * step * slope, slope], axis=1)
        size = self.system.size
        states = np.zeros((count + 1, 2 * size))
        with np.errstate(over="ignore", invalid="ignore"):  # told by who asked
            for n in range(count):
                place = n % len(angles)
                states[n + 1] = by_state[place] @ states[n] + by_load[place] @ loads[n]
        return times, self._seen(states[:, :size], speed * (times - start))

    def _lines(self, times: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the line of every step that has the record's mean and first moment."""
        velocity, place = self.record.integrals(times)
        mean = np.diff(velocity, axis=0) / step
        moment = 0.5 * step * (velocity[1:] + velocity[:-1]) - np.diff(place, axis=0)
        return mean, 12.0 * moment / step**3

    def _propagators(self, angles: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
        """Return what the state and the line of the load do in the steps from these angles."""
        nodes = 0.5 + np.array([-1.0, 1.0]) * np.sqrt(3.0) / 6.0
        A, B = (self._generator(angles + self.system.speed * step * node) for node in nodes)
        exponent = 0.5 * step * (A + B) - np.sqrt(3.0) / 12.0 * step**2 * (A @ B - B @ A)
        propagators = scipy.linalg.expm(exponent)
        state = 2 * self.system.size
        return propagators[:, :state, :state], propagators[:, :state, state:]

    def _generator(self, angles: np.ndarray) -> np.ndarray:
        """Return the rates of (x, ẋ, a, ȧ) at angles, shape (n, 2k + 6, 2k + 6)."""
        k = self.system.size
        M, D, K = (
            sum(np.exp(1j * n * angles)[:, None, None] * X for n, X in terms.items()).real
            for terms in (self.system.M, self.system.D, self.system.K)
        )
        R = _rotations(angles)
        load = self.loads[0] @ R.transpose(0, 2, 1) + self.loads[1]
        wide = [np.broadcast_to(X, (len(angles), *X.shape[-2:])) for X in (-K, -D, load)]
        rates = np.linalg.solve(np.broadcast_to(M, wide[0].shape), np.concatenate(wide, axis=2))
        generator = np.zeros((len(angles), 2 * k + 6, 2 * k + 6))
        generator[:, :k, k : 2 * k] = np.eye(k)
        generator[:, k : 2 * k, : 2 * k + 3] = rates
        generator[:, 2 * k : 2 * k + 3, 2 * k + 3 :] = np.eye(3)
        return generator

    def _seen(self, x: np.ndarray, angles: np.ndarray) -> np.ndarray:
        """Return the motions (t, p, 6) in inertial axes."""
        motion = np.einsum("pik,tk->tpi", self.rows, x)
        both = np.kron(np.eye(2), np.ones((3, 3))) * np.tile(_rotations(angles), (1, 2, 2))
        turned = np.einsum("tij,tpj->tpi", both, motion)
        return np.where(self.stands[:, None], motion, turned)


def _follow(moved: np.ndarray, size: float) -> bool:
    """Return whether straight lines between every second of the displacements follow the others."""
    between = 0.5 * (moved[:-1:2] + moved[2::2])
    return bool(np.abs(moved[1::2] - between).max() <= _BETWEEN * size)


def _rotations(angles: np.ndarray) -> np.ndarray:
    """Return R(θ) from rotor into inertial axes, shape (n, 3, 3)."""
    return sum(
        np.exp(1j * n * angles)[:, None, None] * R for n, R in turning_harmonics(3).items()
    ).real
