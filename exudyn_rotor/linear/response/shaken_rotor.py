"""How a rotor moves over time while a record shakes the ground: steps of first-order equations.

The equations are ``ż = A(θ) z + B Σ L_n exp(inθ) a(t)`` with the load ``f = −Sᵀ a`` (109). In each
step the record is the straight line with its mean and first moment, both exact.

- Constant equations are followed exactly, whatever decays or swings fast: one matrix exponential of
  the state beside the line of the load, which turns with exp(inθ).
- Periodic equations take steps of Radau's method with three stages, one for each part of a
  revolution. It is of fifth order, and what decays within a step decays. Source: Hairer, Wanner,
  Solving Ordinary Differential Equations II, Sect. IV.5.

Steps are halved until the motion no longer changes, and straight lines between them follow it: a
rotor may swing faster than its record.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from exudyn_rotor.foundations.record import BaseRecord
from exudyn_rotor.linear.equations import Terms, UnconvergedError, at_angle
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.response.places import Place
from exudyn_rotor.linear.solve.state import states_of
from exudyn_rotor.theory.rotating_axes import axes_of
from exudyn_rotor.threads import one_thread

_PER_TURN, _IN_ALL = 24, 200  # least numbers of steps in a revolution and in a record
_MOST_STEPS = 2_000_000
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


@dataclass(frozen=True, eq=False)
class ShakenRotor:
    """Equations of first order, the record along (n1, n2, e), and what is looked at.

    Attributes
    ----------
    speed : float
        Ω [rad/s].
    A : mapping of int to ndarray, shape (2k, 2k)
        Fourier terms of the rates per state.
    loads : mapping of int to ndarray, shape (2k, 3)
        Fourier terms of the rates per acceleration of the ground.
    seen : sequence of mapping of int to ndarray, shape (6, 2k)
        Fourier terms of the motion of each place per state, axes that stand still.
    record : BaseRecord
    """

    speed: float
    A: Terms
    loads: Terms
    seen: Sequence[Terms]
    record: BaseRecord

    @classmethod
    def of(
        cls, model: LinearModel, speed: float, record: BaseRecord, observed: Sequence[Place]
    ) -> ShakenRotor:
        """Return the equations at a spin speed [rad/s], with a spin that nothing holds held."""
        system, basis = model.at(speed), model.held_basis
        basis = np.eye(model.size) if basis is None else basis
        states = states_of(system.projected(basis))
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
        start = float(self.record.times[0])
        coarse, last, every = self._first_step(end - start), None, 1
        while last is None or (end - start) * every / coarse < _MOST_STEPS:
            time, motion = self._motion(start, end, coarse / every, every)
            if not np.all(np.isfinite(motion)):
                raise ValueError(
                    "base response: the motion leaves the range of floats; is the rotor unstable "
                    "at this speed?"
                )
            moved = motion[..., :3]
            size = np.abs(moved).max()
            if last is not None and np.abs(moved[::2] - last).max() <= tolerance * size:
                strides = [every >> fewer for fewer in range(every.bit_length() - 1)]
                kept = next((n for n in strides if _follow(moved[:: n // 2], size)), None)
                if kept is not None:
                    return time[::kept], motion[::kept]
            last, every = moved, 2 * every
        raise UnconvergedError(
            f"base response: steps of {2.0 * coarse / every:.2g} s are too long for the motion; "
            "give an earlier end_time, or a reduced rotor without modes that are so fast"
        )

    def _first_step(self, length: float) -> float:
        """Return the largest step: a whole part of a step of the record, or of a revolution."""
        given = self.record.step
        largest = min(given, length / _IN_ALL)
        if self.is_constant:
            return given / np.ceil(given / largest - 1e-9)
        turn = 2.0 * np.pi / abs(self.speed)
        return turn / max(_PER_TURN, int(np.ceil(turn / largest)))

    def _motion(
        self, start: float, end: float, step: float, every: int
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return times and motions of all steps, a multiple of `every`."""
        count = every * max(1, int(np.floor((end - start) / (every * step) + 1e-9)))
        times = start + step * np.arange(count + 1)
        mean, slope = self._lines(times, step)
        lines = np.concatenate([mean - 0.5 * step * slope, slope], axis=1)
        angles = self.speed * (times - start)
        if self.is_constant:
            by_state, given = self._exact(step, angles[:-1], lines)
        else:
            by_state, given = self._radau(step, angles[:-1], lines)
        states, turn = np.zeros((count + 1, len(self.A[0]))), len(by_state)
        with np.errstate(over="ignore", invalid="ignore"):  # told by who asked
            for n in range(count):
                states[n + 1] = by_state[n % turn] @ states[n] + given[n]
        motion = np.zeros((count + 1, len(self.seen), 6))
        for place, seen in enumerate(self.seen):
            for n, U in seen.items():
                motion[:, place] += (np.exp(1j * n * angles)[:, None] * (states @ U.T)).real
        return times, motion

    def _lines(self, times: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the line of every step that has the record's mean and first moment."""
        velocity, place = self.record.integrals(times)
        mean = np.diff(velocity, axis=0) / step
        moment = 0.5 * step * (velocity[1:] + velocity[:-1]) - np.diff(place, axis=0)
        return mean, 12.0 * moment / step**3

    def _exact(
        self, step: float, angles: np.ndarray, lines: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the step of the state (1, 2k, 2k), and what each line (t, 6) adds, (t, 2k)."""
        A = at_angle(self.A, 0.0)
        size, given = len(A), np.zeros((len(angles), len(A)))
        for n, load in self.loads.items():
            generator = np.zeros((size + 6, size + 6), dtype=complex)
            generator[:size, :size], generator[:size, size : size + 3] = A, load
            generator[size : size + 3, size + 3 :] = np.eye(3)
            generator[size:, size:] += 1j * n * self.speed * np.eye(6)
            stepped = scipy.linalg.expm(step * generator)
            turned = np.exp(1j * n * angles)[:, None] * lines
            given += (turned @ stepped[:size, size:].T).real
        return scipy.linalg.expm(step * A)[None], given

    def _radau(
        self, step: float, angles: np.ndarray, lines: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the steps of the state in a revolution, and what each line adds, (t, 2k)."""
        size = len(self.A[0])
        turn = min(len(angles), round(2.0 * np.pi / abs(self.speed) / step))
        by_state = np.zeros((turn, size, size))
        by_line = np.zeros((turn, size, 6))
        ones = np.tile(np.eye(size), (3, 1))
        for number in range(turn):
            stages = angles[number] + self.speed * step * _STAGES
            rates = np.stack([at_angle(self.A, angle) for angle in stages])
            left = np.eye(3 * size).reshape(3, size, 3, size)
            left -= step * np.einsum("ij,jab->iajb", _RADAU, rates)
            loads = [
                np.hstack([load, share * step * load])
                for load, share in zip((self._load(angle) for angle in stages), _STAGES, strict=True)
            ]
            right = step * np.einsum("ij,jab->iab", _RADAU, np.array(loads))
            right = np.hstack([ones, right.reshape(3 * size, 6)])
            stepped = np.linalg.solve(left.reshape(3 * size, 3 * size), right)[2 * size :]
            by_state[number], by_line[number] = stepped[:, :size], stepped[:, size:]
        given = np.zeros((len(angles), size))
        for number in range(turn):
            given[number::turn] = lines[number::turn] @ by_line[number].T
        return by_state, given

    def _load(self, angle: float) -> np.ndarray:
        """Return the rates per acceleration of the ground at a spin angle [rad], (2k, 3)."""
        return sum(load * np.exp(1j * n * angle) for n, load in self.loads.items()).real


def _follow(moved: np.ndarray, size: float) -> bool:
    """Return whether straight lines between every second of the displacements follow the others."""
    between = 0.5 * (moved[:-1:2] + moved[2::2])
    return bool(np.abs(moved[1::2] - between).max() <= _BETWEEN * size)
