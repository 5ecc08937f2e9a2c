"""Steady motion at one speed or frequency, as places see it: what sweeps of responses compute."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from exudyn_rotor.linear.models.protocol import LinearModel, Space
from exudyn_rotor.linear.response.places import Motion, Place, in_frame
from exudyn_rotor.linear.response.run_start import kept_basis


@dataclass(frozen=True, eq=False)
class Solved:
    """Harmonics (p, 6) of what is looked at, and (k,) of the coordinates if they are kept."""

    motion: Motion
    coordinates: Motion


@dataclass(frozen=True, eq=False)
class Observation:
    """What is looked at: rows (p, 6, k) of the places, which of them stand (p,), and how."""

    rows: np.ndarray
    stands: np.ndarray
    frame: str
    tolerance: float
    keeps: bool

    @classmethod
    def of(
        cls, observed: Sequence[Place], frame: str, tolerance: float, model: LinearModel
    ) -> Observation:
        """Return how places are looked at, and whether coordinates are kept."""
        rows = np.array([one.motion for one in observed])
        stands = np.array([one.stands for one in observed])
        return cls(rows, stands, frame, tolerance, kept_basis(model) is not None)

    def solved(
        self, space: Space, speed: float, loads: Mapping[int, np.ndarray], rate: float
    ) -> Solved:
        """Return the steady motion."""
        harmonics = space.steady_motion(speed, loads, rate, self.tolerance)
        seen = {n: self.rows @ x for n, x in harmonics.items()}
        if speed != 0.0:  # at θ = 0 the axes are the same
            seen = in_frame(seen, self.stands, self.frame)
        return Solved(seen, harmonics if self.keeps else {})


@dataclass(frozen=True, eq=False)
class UnbalanceTask:
    """Steady motion at one speed; picklable but for a full model."""

    space: Space
    load: np.ndarray
    observation: Observation

    def __call__(self, speed: float) -> Solved:
        """Return the motion at a spin speed [rad/s]."""
        if speed == 0.0:  # no load, and nothing that would have to hold the rotor
            places, rows, size = self.observation.rows.shape
            still = {0: np.zeros(size)} if self.observation.keeps else {}
            return Solved({0: np.zeros((places, rows))}, still)
        loads = {0: speed**2 * self.load + 0j}
        solved = self.observation.solved(self.space, float(speed), loads, 0.0)
        return replace(solved, motion=_folded(solved.motion))


@dataclass(frozen=True, eq=False)
class HarmonicTask:
    """Steady motion at one frequency; picklable but for a full model."""

    space: Space
    speed: float
    loads: Mapping[int, np.ndarray]
    observation: Observation

    def __call__(self, frequency: float) -> Solved:
        """Return the motion at a frequency [rad/s]."""
        return self.observation.solved(self.space, self.speed, self.loads, float(frequency))


def _folded(motion: Motion) -> Motion:
    """Return a real periodic motion by its harmonics n ≥ 0: ``Re Σ a_n exp(inΩt)``."""
    folded: dict[int, np.ndarray] = {}
    for n, a in motion.items():
        folded[abs(n)] = folded.get(abs(n), 0.0) + (a if n > 0 else a.conj())
    return folded
