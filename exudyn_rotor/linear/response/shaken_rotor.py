"""How a rotor moves over time while a record shakes the ground: steps of first-order equations.

The equations are ``ż = A(θ) z + B Σ L_n exp(inθ) a(t)`` with the load ``f = −Sᵀ a`` (109). In each
step the record is the straight line with its mean and first moment, both exact.

- Constant equations are followed exactly, whatever decays or swings fast: one matrix exponential of
  the state beside the line of the load, which turns with exp(inθ).
- Periodic equations take steps of Radau's method with three stages. It is of fifth order, and what
  decays within a step decays. What a step does is periodic in its first angle, and so known by a
  few Fourier terms. Source: Hairer, Wanner, Solving Ordinary Differential Equations II, Sect. IV.5.

Steps are halved until the motion no longer changes, and straight lines between them follow it: a
rotor may swing faster than its record.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from exudyn_rotor.calls import one_thread
from exudyn_rotor.foundations.record import BaseRecord
from exudyn_rotor.linear.equations import Terms, UnconvergedError, at_angle, states_of
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.response.loads import Place
from exudyn_rotor.theory.rotating_axes import axes_of

_PER_TURN, _IN_ALL = 24, 200  # least numbers of steps in a revolution and in a record
_MOST_STEPS = 2_000_000
_ANGLES, _MOST_ANGLES = 16, 512  # of a revolution, at which a step is computed
_ONE_BY_ONE = 512  # steps that are taken one after the other
_KEPT = 512  # steps in a revolution that are kept as matrices
_HALVED = 16.0  # a halved step of fifth order errs by a sixteenth of the change, at most
_TAIL, _ROUNDING = 1e-10, 1e-12  # shares of a step by Fourier terms that are left out
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
        model.check_without_frequency("a motion of the ground")
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
            # a free shift along the axis is large beside motions across it: each by its own size
            along = np.abs(motion[..., 2]).max()
            across = max(np.abs(motion[..., :2]).max(), _ROUNDS * along)
            sizes = np.array([across, across, max(along, _SMALL * across)])
            moved = motion[..., :3] / np.where(sizes > 0.0, sizes, 1.0)
            if last is not None and np.abs(moved[::2] - last).max() <= _HALVED * tolerance:
                strides = [every >> fewer for fewer in range(every.bit_length() - 1)]
                kept = next((n for n in strides if _follow(moved[:: n // 2])), None)
                if kept is not None:
                    return time[::kept], motion[::kept]
            last, every = moved, 2 * every
        raise UnconvergedError(
            f"base response: steps of {2.0 * coarse / every:.2g} s are too long for the motion; "
            "give an earlier end_time, or a reduced rotor without modes that are so fast"
        )

    def _first_step(self, length: float) -> float:
        """Return the largest step: a whole part of a step of the record, or of a revolution."""
        largest = min(self.record.step, length / _IN_ALL)
        whole, least = self.record.step, 1.0
        if not self.is_constant:
            whole, least = 2.0 * np.pi / abs(self.speed), _PER_TURN
        return whole / max(least, np.ceil(whole / largest - 1e-9))

    def _motion(
        self, start: float, end: float, step: float, every: int
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return times and motions of all steps, a multiple of `every`."""
        count = every * max(1, int(np.floor((end - start) / (every * step) + 1e-9)))
        times = start + step * np.arange(count + 1)
        angles = self.speed * (times - start)
        lines = self._lines(times, step)
        by_state, by_line = self._exact(step) if self.is_constant else self._radau(step)
        waves = {n: np.exp(1j * n * angles) for n in {*by_line, *by_state, *_orders(self.seen)}}
        turn = 1 if self.is_constant else round(2.0 * np.pi / abs(self.speed) / step)
        steps = {n: wave[:turn, None, None] for n, wave in waves.items()}
        with np.errstate(over="ignore", invalid="ignore"):  # told by who asked
            if turn > _KEPT or self.is_constant:
                given = sum((waves[n][:-1, None] * (lines @ P.T)).real for n, P in by_line.items())
            else:
                given = _each(sum(steps[n] * P for n, P in by_line.items()).real, lines)
            if turn <= _KEPT:
                states = _followed(sum(steps[n] * X for n, X in by_state.items()).real, given)
            else:
                states = _followed_slowly(by_state, waves, given)
            motion = np.zeros((count + 1, len(self.seen), 6))
            for place, seen in enumerate(self.seen):
                for n, U in seen.items():
                    motion[:, place] += (waves[n][:, None] * (states @ U.T)).real
        return times, motion

    def _lines(self, times: np.ndarray, step: float) -> np.ndarray:
        """Return first value and slope (t, 6) of the line in every step.

        It has the mean and the first moment of the record.
        """
        velocity, place = self.record.integrals(times)
        mean = np.diff(velocity, axis=0) / step
        moment = 0.5 * step * (velocity[1:] + velocity[:-1]) - np.diff(place, axis=0)
        slope = 12.0 * moment / step**3
        return np.concatenate([mean - 0.5 * step * slope, slope], axis=1)

    def _exact(self, step: float) -> tuple[dict, dict]:
        """Return Fourier terms of what a step does with the state (2k, 2k) and a line (2k, 6)."""
        A = at_angle(self.A, 0.0)
        size, by_line = len(A), {}
        for n, load in self.loads.items():
            generator = np.zeros((size + 6, size + 6), dtype=complex)
            generator[:size, :size], generator[:size, size : size + 3] = A, load
            generator[size : size + 3, size + 3 :] = np.eye(3)
            generator[size:, size:] += 1j * n * self.speed * np.eye(6)
            by_line[n] = scipy.linalg.expm(step * generator)[:size, size:]
        return {0: scipy.linalg.expm(step * A)}, by_line

    def _radau(self, step: float) -> tuple[dict, dict]:
        """Return what :meth:`_exact` does, of periodic equations."""
        size, count = len(self.A[0]), _ANGLES
        while True:
            angles = 2.0 * np.pi * np.arange(count) / count
            spectrum = np.fft.fft([self._stepped(step, angle) for angle in angles], axis=0) / count
            sizes = np.abs(spectrum).max(axis=1)  # the lines act on states of another size
            sizes = (sizes / np.maximum(sizes.max(axis=0), 1e-300)).max(axis=1)
            if sizes[count // 4 : -count // 4].max() <= _TAIL or count >= _MOST_ANGLES:
                break
            count *= 2
        terms = {n: spectrum[n] for n in range(-count // 4, count // 4 + 1) if sizes[n] > _ROUNDING}
        return tuple({n: X[:, part] for n, X in terms.items()}
                     for part in (slice(size), slice(size, None)))  # fmt: skip

    def _stepped(self, step: float, angle: float) -> np.ndarray:
        """Return what a step from a spin angle [rad] does with state and line, (2k, 2k + 6)."""
        size = len(self.A[0])
        stages = angle + self.speed * step * _STAGES
        rates = np.stack([at_angle(self.A, each) for each in stages])
        loads = np.stack([np.hstack([self._load(each), share * step * self._load(each)])
                          for each, share in zip(stages, _STAGES, strict=True)])  # fmt: skip
        left = np.eye(3 * size).reshape(3, size, 3, size)
        left -= step * np.einsum("ij,jab->iajb", _RADAU, rates)
        right = step * np.einsum("ij,jab->iab", _RADAU, loads).reshape(3 * size, 6)
        right = np.hstack([np.tile(np.eye(size), (3, 1)), right])
        return np.linalg.solve(left.reshape(3 * size, 3 * size), right)[2 * size :]

    def _load(self, angle: float) -> np.ndarray:
        """Return the rates per acceleration of the ground at a spin angle [rad], (2k, 3)."""
        return sum(load * np.exp(1j * n * angle) for n, load in self.loads.items()).real


def _follow(moved: np.ndarray) -> bool:
    """Return whether straight lines between every second of the displacements follow the others.

    The largest displacement is one.
    """
    return bool(np.abs(moved[1::2] - 0.5 * (moved[:-1:2] + moved[2::2])).max() <= _BETWEEN)


def _followed(each: np.ndarray, given: np.ndarray) -> np.ndarray:
    """Return ``z_{n+1} = E_n z_n + g_n`` from rest, (t + 1, 2k), E_n of a turn again and again.

    Two steps at a time are one step of another recurrence, which takes whole arrays.
    """
    count, size = given.shape
    states = np.zeros((count + 1, size))
    if count <= _ONE_BY_ONE:
        for n in range(count):
            states[n + 1] = each[n % len(each)] @ states[n] + given[n]
        return states
    if len(each) % 2:
        each = np.concatenate([each, each])
    first, second = each[::2], each[1::2]
    given = np.concatenate([given, np.zeros((count % 2, size))])
    pairs = _each(second, given[::2]) + given[1::2]
    even = _followed(second @ first, pairs)
    states = np.zeros((len(given) + 1, size))
    states[::2] = even
    states[1::2] = _each(first, even[:-1]) + given[::2]
    return states[: count + 1]


def _followed_slowly(by_state: dict, waves: dict, given: np.ndarray) -> np.ndarray:
    """Return what :func:`_followed` does, of a turn of very many steps.

    ``E(θ) = E₀ + Σ 2 Re E_n cos nθ − 2 Im E_n sin nθ`` is one tall matrix with weights.
    """
    later = [n for n in by_state if n > 0]
    parts = (2.0 * X for n in later for X in (by_state[n].real, -by_state[n].imag))
    tall = np.vstack([by_state[0].real, *parts])
    parts = (w for n in later for w in (waves[n].real, waves[n].imag))
    weights = np.column_stack([np.ones(len(given) + 1), *parts])
    states = np.zeros((len(given) + 1, given.shape[1]))
    for n, one in enumerate(given):
        stepped = (tall @ states[n]).reshape(weights.shape[1], -1)
        states[n + 1] = weights[n] @ stepped + one
    return states


def _each(E: np.ndarray, X: np.ndarray) -> np.ndarray:
    """Return ``E_n x_n`` of rows (t, 2k), with the matrices over and over."""
    result = np.empty((len(X), E.shape[1]))
    for n, matrix in enumerate(E):
        result[n :: len(E)] = X[n :: len(E)] @ matrix.T
    return result


def _orders(seen: Sequence[Terms]) -> set[int]:
    return {n for each in seen for n in each}
