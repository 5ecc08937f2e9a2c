"""How a rotor moves over time while a record shakes the ground: steps of a Magnus series.

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

from exudyn_rotor.foundations.record import BaseRecord
from exudyn_rotor.linear.models.rotor.extended_rotor import ExtendedRotor
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.periodic.fundamental import (
    GAUSS_POINTS,
    accelerations,
    magnus_exponent,
    sampled,
)
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, UnconvergedError
from exudyn_rotor.linear.response.places import Place
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.rotating_axes import axes_of, turning_harmonics
from exudyn_rotor.threads import one_thread

_PER_TURN, _IN_ALL = 24, 200  # least numbers of steps in a revolution and in a record
_MOST_HALVINGS = 7
_BETWEEN = 0.01  # of the largest motion: how far straight lines between the times may be off


@dataclass(frozen=True, eq=False)
class ShakenRotor:
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
    ) -> ShakenRotor:
        """Return the equations at a spin speed [rad/s], with a spin that nothing holds held."""
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
        turns = self.system.speed * step * GAUSS_POINTS
        A, B = (step * self._generator(angles + turn) for turn in turns)
        propagators = scipy.linalg.expm(magnus_exponent(A, B))
        state = 2 * self.system.size
        return propagators[:, :state, :state], propagators[:, :state, state:]

    def _generator(self, angles: np.ndarray) -> np.ndarray:
        """Return the rates of (x, ẋ, a, ȧ) at angles, shape (n, 2k + 6, 2k + 6)."""
        k = self.system.size
        M, D, K = sampled(self.system, angles)
        R = _rotations(angles)
        load = self.loads[0] @ R.transpose(0, 2, 1) + self.loads[1]
        rates = accelerations(self.system, M, np.concatenate([-K, -D, load], axis=2))
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
