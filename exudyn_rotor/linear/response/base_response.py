"""Motion of a rotor over time while a record shakes the ground.

``ż = A(θ) z + Σ L_n exp(inθ) a(t)`` with the load ``f = −Sᵀ a`` (109). In each step the record is
the straight line with its mean and first moment. Constant equations are followed exactly by a
matrix exponential. Periodic ones take steps of Radau's method with three stages, of fifth order, in
which what decays within a step decays (Hairer, Wanner, Solving Ordinary Differential Equations II,
Sect. IV.5); a step is periodic in its first angle, and known by a few Fourier terms.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import cycle
from typing import TYPE_CHECKING

import exudyn
import numpy as np
import scipy.linalg

from exudyn_rotor import checks, plotting
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.foundations.record import BaseRecord
from exudyn_rotor.linear.equations import Terms, UnconvergedError, at_angle, states_of
from exudyn_rotor.linear.model.build import Target, linear_model, warn_of_omissions
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.response.loads import At, Place, checked_places, places
from exudyn_rotor.linear.response.response import DIRECTIONS, AtPlaces
from exudyn_rotor.results import numbers, storable, text_table
from exudyn_rotor.solvers.factor import one_thread
from exudyn_rotor.theory.rotating_axes import axes_of
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_PER_TURN, _IN_ALL = 24, 200  # least numbers of steps in a revolution and in a record
_MOST_STEPS = 2_000_000
_ANGLES = 64  # of a revolution, at which a step is computed
_AT_ONCE = 512  # steps whose matrices are made together
_HALVED = 16.0  # a halved step of fifth order errs by a sixteenth of the change, at most
_TAIL = 1e-12  # share of a step by Fourier terms that are left out
_SMALL = 1e-2  # share of a motion across the axis that counts along it
_ROUNDS = 1e-9  # share of a motion along the axis that is rounding across it
_BETWEEN = 0.01  # of the largest motion: how far straight lines between the times may be off
_S = np.sqrt(6.0)
_STAGES = np.array([(4.0 - _S) / 10.0, (4.0 + _S) / 10.0, 1.0])  # of Radau's method
_RADAU = np.array(
    [
        [(88.0 - 7.0 * _S) / 360.0, (296.0 - 169.0 * _S) / 1800.0, (-2.0 + 3.0 * _S) / 225.0],
        [(296.0 + 169.0 * _S) / 1800.0, (88.0 + 7.0 * _S) / 360.0, (-2.0 - 3.0 * _S) / 225.0],
        [(16.0 - _S) / 36.0, (16.0 + _S) / 36.0, 1.0 / 9.0],
    ]
)


@storable
@dataclass(frozen=True, eq=False)
class BaseResponse(AtPlaces):
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
    largest motion against the ground at 477.465 rpm
    place  n1 [m]  n2 [m]  e [m]  across [m]  at [s]
    left    3e-06   4e-06      0       5e-06     0.1
    """

    time: np.ndarray = numbers("steps")
    motion: np.ndarray = numbers("steps", "places", 6, finite=False)
    speed: float = 0.0

    def displacement(self, place: str, other: str | None = None) -> np.ndarray:
        """Return the displacement of a place over time, shape (t, 3) [m].

        Against another place, if one is named, as of a journal against its foundation:
        ``displacement("left", "left (foundation)")``.
        """
        moved = self.motion[:, self._at(place), :3]
        return moved if other is None else moved - self.motion[:, self._at(other, "other"), :3]

    def peak(self, place: str, other: str | None = None) -> tuple[float, float]:
        """Return the largest displacement across the axis [m], and its time [s].

        Against another place, if one is named.
        """
        across = np.hypot(*self.displacement(place, other)[:, :2].T)
        return float(across.max()), float(self.time[np.argmax(across)])

    def table(self, *, units: str = "rpm") -> str:
        """Return the largest values of every place as text; `units` are 'rpm', 'Hz' or 'SI'."""
        shown = Units.of(units)
        most = np.abs(self.motion[..., :3]).max(axis=0).T
        across, times = np.array([self.peak(place) for place in self.places]).reshape(-1, 2).T
        columns = {f"{name} [m]": most[i] for i, name in enumerate(DIRECTIONS[:3])}
        columns = {"place": np.array(self.places)} | columns
        lines = text_table(columns | {"across [m]": across, "at [s]": times})
        at = f"{shown.speeds(self.speed):g} {shown.speed}"
        return "\n".join([f"largest motion against the ground at {at}", *lines])

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return time and displacements as columns; `units` change nothing."""
        Units.of(units)
        moved = {
            f"{place} {direction} [m]": self.motion[:, index, axis]
            for index, place in enumerate(self.places)
            for axis, direction in enumerate(DIRECTIONS[:3])
        }
        return {"time [s]": self.time} | moved

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the displacement across the axis over time."""
        ax = plotting.axes_or_new(ax)
        for place, color in zip(self.places, cycle(plotting.COLORS), strict=False):
            across = np.hypot(*self.displacement(place)[:, :2].T)
            ax.plot(self.time, 1e6 * across, color=color, label=place)
        ax.set(xlabel="time [s]", ylabel="displacement across the axis [µm]")
        ax.legend()
        return ax


def base_response(
    target: Target,
    record: BaseRecord,
    *,
    speed: float = 0.0,
    supports: Sequence[Given] | Given = (),
    at: Sequence[At] | At | None = None,
    end_time: float | None = None,
    stiffening: str = "auto",
    tolerance: float = 1e-4,
) -> BaseResponse:
    """Compute the motion of a rotor at constant speed while a record shakes the ground.

    From rest against the ground. Unbalance and weight are not in it: :func:`unbalance_response` has
    the one, and linear motions add up.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, RotorTrain or LinearModel
        See :func:`linear_model`; a foundation is that of a model.
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
        Largest error by the length of steps, relative to the largest motion, estimated by halved
        steps. Constant equations are followed exactly with any step.

    Raises
    ------
    TypeError, ValueError
        For bad input, unknown places, a scene, a foundation without participation, and motions
        that leave the range of floats or do not converge.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import BaseRecord, Support, base_response, rotor_example
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> supports = [Support(name, 2e4) for name in ("left", "right")]
    >>> step = BaseRecord(np.linspace(0.0, 0.05, 101), np.tile([1.0, 0.0, 0.0], (101, 1)))
    >>> response = base_response(rotor, step, speed=50.0, supports=supports)
    >>> round(response.peak("left")[0], 6)  # 2 a / ω², ω = 100 rad/s
    0.0002
    """
    checks.instance(record, "record", BaseRecord)
    speed = checks.number(speed, "speed", "rad/s")
    tolerance = checks.tolerance(tolerance)
    start, end = record.times[[0, -1]]
    if end_time is not None:
        end = checks.number(end_time, "end_time", "s", above=start)
    at = checked_places(at)
    is_scene = isinstance(target, exudyn.MainSystem)
    model = None if is_scene else linear_model(target, supports=supports, stiffening=stiffening)
    if is_scene or model.base_loads(speed) is None:
        raise ValueError(
            "target: a motion of the ground needs a reduced rotor on supports, and a foundation "
            "with its participation; in a scene, use add_base_motion"
        )
    model.check_without_frequency("a motion of the ground")
    model = model.for_responses
    warn_of_omissions(model, speed, "base_response computes motion over time")
    observed = places(model, at, speed)
    time, motion = _ShakenRotor.of(model, speed, record, observed).converged(end, tolerance)
    motion[:, [one.is_node for one in observed], 3:] = np.nan
    return BaseResponse(tuple(one.label for one in observed), time, motion, speed)


# ------------------------------------------------------------------ steps


@dataclass(frozen=True, eq=False)
class _ShakenRotor:
    """Equations of first order by Fourier terms of the spin angle, and the record (n1, n2, e)."""

    speed: float
    A: Terms  # rates per state (2k, 2k)
    loads: Terms  # rates per acceleration of the ground (2k, 3)
    seen: Sequence[Terms]  # motion of each place per state (6, 2k), axes that stand still
    record: BaseRecord

    @classmethod
    def of(
        cls, model: LinearModel, speed: float, record: BaseRecord, observed: Sequence[Place]
    ) -> _ShakenRotor:
        """Return the equations at a spin speed [rad/s], with a spin that nothing holds held."""
        basis = np.eye(model.size) if model.held_basis is None else model.held_basis
        states = states_of(model.at(speed).projected(basis))
        k = basis.shape[1]
        shape = basis @ states.shape
        # forces act on the second half of the state, by the modes of the first
        pulled = np.vstack([np.zeros((k, model.size)), states.A[0][:k, k:] @ shape[:, :k].T])
        loads = {n: pulled @ each.T for n, each in model.base_loads(speed).items()}
        seen = [{n: U @ shape for n, U in one.seen.items()} for one in observed]
        axis = next(iter(model.rotors.values())).axis
        return cls(speed, states.A, loads, seen, record.turned(axes_of(axis).T))

    @property
    def is_constant(self) -> bool:
        """Whether the rates per state do not change in time."""
        return self.speed == 0.0 or len(self.A) == 1

    @one_thread()
    def converged(self, end: float, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
        """Return times and motions (t, p, 6), with steps small enough."""
        length = end - float(self.record.times[0])
        step, last = self._first_step(length), None
        while length / step < _MOST_STEPS:
            time, motion = self._motion(length, step)
            if not np.all(np.isfinite(motion)):
                raise ValueError(
                    "base response: the motion leaves the range of floats; is the rotor unstable "
                    "at this speed?"
                )
            # a free shift along the axis is large beside motions across it: each by its own size
            along = np.abs(motion[..., 2]).max()
            across = max(np.abs(motion[..., :2]).max(), _ROUNDS * along)
            sizes = np.array([across, across, max(along, _SMALL * across)])
            sizes[sizes == 0.0] = 1.0
            if last is not None:
                moved = motion[: 2 * len(last) - 1, :, :3] / sizes
                change = moved[::2] - last[..., :3] / sizes
                bent = moved[1::2] - 0.5 * (moved[:-1:2] + moved[2::2])
                is_settled = np.abs(change).max() <= _HALVED * tolerance
                if is_settled and np.abs(bent).max(initial=0.0) <= _BETWEEN:
                    return time[::2], motion[::2]
            step, last = 0.5 * step, motion
        raise UnconvergedError(
            f"base response: steps of {2.0 * step:.2g} s are too long for the motion; give an "
            "earlier end_time, or a reduced rotor without modes that are so fast"
        )

    def _first_step(self, length: float) -> float:
        """Return the largest step: a whole part of a step of the record, or of a revolution."""
        largest = min(self.record.step, length / _IN_ALL)
        whole, least = self.record.step, 1.0
        if not self.is_constant:
            whole, least = 2.0 * np.pi / abs(self.speed), _PER_TURN
        return whole / max(least, np.ceil(whole / largest - 1e-9))

    def _motion(self, length: float, step: float) -> tuple[np.ndarray, np.ndarray]:
        """Return times and motions of all steps in a length of time, from rest."""
        count = max(1, int(np.floor(length / step + 1e-9)))
        after = step * np.arange(count + 1)
        times, angles = self.record.times[0] + after, self.speed * after
        lines = self._lines(times, step)
        with np.errstate(over="ignore", invalid="ignore"):  # told by who asked
            if self.is_constant:
                turn = int(np.ceil(np.sqrt(count)))  # any number of steps
                by_state, by_line = self._exact(step)
                added = _moved(by_line, angles[:-1], lines)
            else:
                turn = min(round(2.0 * np.pi / abs(self.speed) / step), count)
                by_state, by_line = self._radau(step)
                added = np.zeros((count, len(self.A[0])))
                for n, X in enumerate(_matrices(by_line, angles[:turn])):
                    added[n::turn] = lines[n::turn] @ X.T
            states = _followed(by_state, angles[:turn], added)
            motion = np.stack([_moved(U, angles, states) for U in self.seen], axis=1)
        return times, motion

    def _lines(self, times: np.ndarray, step: float) -> np.ndarray:
        """Return first value and slope (t, 6) of the line in every step."""
        velocity, place = self.record.integrals(times)
        mean = np.diff(velocity, axis=0) / step
        moment = 0.5 * step * (velocity[1:] + velocity[:-1]) - np.diff(place, axis=0)
        slope = 12.0 * moment / step**3
        return np.concatenate([mean - 0.5 * step * slope, slope], axis=1)

    def _exact(self, step: float) -> tuple[Terms, Terms]:
        """Return Fourier terms of what a step does with state (2k, 2k) and line (2k, 6)."""
        A, by_line = at_angle(self.A, 0.0), {}
        size, at_rest = len(A), np.zeros((6, len(A)))
        for n, load in self.loads.items():
            turning = 1j * n * self.speed * np.eye(6) + np.eye(6, k=3)  # and a line grows
            generator = np.block([[A, load, np.zeros((size, 3))], [at_rest, turning]])
            by_line[n] = scipy.linalg.expm(step * generator)[:size, size:]
        return {0: scipy.linalg.expm(step * A)}, by_line

    def _radau(self, step: float) -> tuple[Terms, Terms]:
        """Return the same of periodic equations."""
        size, first = len(self.A[0]), 2.0 * np.pi * np.arange(_ANGLES) / _ANGLES
        stages = np.add.outer(first, self.speed * step * _STAGES)
        rates, loads = (at_angle(each, stages) for each in (self.A, self.loads))
        loads = np.concatenate([loads, (step * _STAGES)[:, None, None] * loads], axis=3)
        left = -step * np.einsum("ij,njab->niajb", _RADAU, rates).reshape(_ANGLES, 3 * size, -1)
        right = step * np.einsum("ij,njab->niab", _RADAU, loads).reshape(_ANGLES, 3 * size, 6)
        begun = np.broadcast_to(np.tile(np.eye(size), (3, 1)), (_ANGLES, 3 * size, size))
        right = np.concatenate([begun, right], axis=2)
        after = np.linalg.solve(left + np.eye(3 * size), right)[:, 2 * size :]
        spectrum = np.fft.fft(after, axis=0) / _ANGLES
        sizes = np.abs(spectrum).max(axis=1)  # the lines act on states of another size
        sizes = (sizes / np.maximum(sizes.max(axis=0), 1e-300)).max(axis=1)
        known = [n for n in range(-_ANGLES // 4, _ANGLES // 4 + 1) if sizes[n] > _TAIL]
        parts = slice(size), slice(size, None)
        return tuple({n: spectrum[n][:, part] for n in known} for part in parts)


def _matrices(terms: Terms, angles: np.ndarray) -> Iterator[np.ndarray]:
    """Give the matrices at spin angles [rad], one after the other."""
    for first in range(0, len(angles), _AT_ONCE):
        yield from at_angle(terms, angles[first : first + _AT_ONCE])


def _moved(terms: Terms, angles: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Return the products (t, r) of a matrix at spin angles [rad] and vectors (t, k)."""
    turned = ((np.exp(1j * n * angles)[:, None], X) for n, X in terms.items())
    return sum(wave * (vectors @ X.T) for wave, X in turned).real


def _followed(by_state: Terms, angles: np.ndarray, added: np.ndarray) -> np.ndarray:
    """Return ``z_{n+1} = E_n z_n + g_n`` from rest, (t + 1, 2k), given (t, 2k).

    E_n comes back after the steps of a turn, which begin at the `angles`. All turns are followed
    together: from rest, which tells where each begins, and from there.
    """
    (count, size), turn = added.shape, len(angles)
    turns = -(-count // turn)
    added = np.pad(added, ((0, turns * turn - count), (0, 0)))
    added = added.reshape(turns, turn, size).swapaxes(0, 1)
    states, whole = np.zeros((turn + 1, turns, size)), np.eye(size)
    for n, E in enumerate(_matrices(by_state, angles)):
        states[n + 1] = states[n] @ E.T + added[n]
        whole = E @ whole
    if turns > 1:
        for n in range(1, turns):
            states[0, n] = whole @ states[0, n - 1] + states[turn, n - 1]
        for n, E in enumerate(_matrices(by_state, angles)):
            states[n + 1] = states[n] @ E.T + added[n]
    states = np.concatenate([states[:turn].swapaxes(0, 1).reshape(-1, size), states[turn, -1:]])
    return states[: count + 1]
