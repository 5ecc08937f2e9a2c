"""All of a rotor but the contacts of its rolling bearings, as these feel it: a linear rest.

Equation (2) of :mod:`contact_balance` takes its motion under the loads alone, and its receptances.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.models.protocol import Space
from exudyn_rotor.linear.response.places import Motion, Place, in_frame
from exudyn_rotor.theory.rotating_axes import into_rotor_frame

Harmonics = Mapping[tuple[int, int], np.ndarray]  # (d,) by (k, n), of both signs

_HARMONICS = 1e-10  # largest relative change of the rest's motion by its own further harmonics
_SMALL = 1e-12  # share of a receptance or a motion that is rounding


@dataclass(frozen=True, eq=False)
class Rest:
    """All but the contacts at one spin speed, as the bearings feel it.

    Attributes
    ----------
    space : Space
        Equations with a spring k₀ in place of each bearing.
    speed, passing : float
        Ω and ZκΩ [rad/s].
    seats : sequence of tuples of (Place, float)
        Rings of each bearing: the inner one with 1, one that a foundation carries with −1.
    loads : mapping of int to ndarray (k,)
        Constant loads and unbalance, harmonics in the rotor frame.
    """

    space: Space
    speed: float
    passing: float
    seats: Sequence[Sequence[tuple[Place, float]]]
    loads: Mapping[int, np.ndarray]

    @cached_property
    def _known(self) -> dict[tuple[int, int], dict[int, np.ndarray]]:
        return {}

    @cached_property
    def _unit_loads(self) -> list[dict[int, np.ndarray]]:
        """Loads of a force of 1 N on each inner ring along each axis."""
        return [self.pulled({0: unit}) for unit in np.eye(2 * len(self.seats))]

    @cached_property
    def _loaded(self) -> dict[int, np.ndarray]:
        """The motion under the loads alone, rotor frame."""
        return self._solved(self.loads, 0.0)

    def moved(self) -> Harmonics:
        """Return q⁰."""
        return {(0, n): q for n, q in self._seen(self._loaded).items()}

    def presses(self) -> bool:
        """Return whether the loads move a ring across the axis, rounding left out."""
        rows = np.array([ring.motion[:3] for seat in self.seats for ring, _ in seat])
        moved = np.array([np.abs(rows @ x).max(axis=0) for x in self._loaded.values()])
        return bool(moved[:, :2].max() > _SMALL * moved.max())

    def receptance(self, k: int, n: int) -> dict[int, np.ndarray]:
        """Return H^p by p, each (d, d) [m/N]: motion n + p by forces of the harmonic n."""
        if (k, n) < (0, 0):
            return {-p: H.conj() for p, H in self.receptance(-k, -n).items()}
        if (k, n) not in self._known:
            rate = k * self.passing + n * self.speed
            answers = self.space.steady_motions(self.speed, self._unit_loads, rate, _HARMONICS)
            zero = np.zeros_like(next(iter(answers[0].values())))
            orders = sorted({p for answer in answers for p in answer})
            stacks = {p: np.array([each.get(p, zero) for each in answers]) for p in orders}
            seen = self._seen(stacks)
            found = {p: seen[p].T for p in sorted(seen)}
            size = max(np.abs(H).max() for H in found.values())
            self._known[k, n] = {p: H for p, H in found.items() if np.abs(H).max() > _SMALL * size}
        return self._known[k, n]

    def pulled(self, forces: Mapping[int, np.ndarray]) -> dict[int, np.ndarray]:
        """Return forces (d,) on the inner rings by n as loads (k,) in the rotor frame."""
        loads: dict[int, np.ndarray] = {}
        for n, force in forces.items():
            for seat, pair in zip(self.seats, force.reshape(-1, 2), strict=True):
                for ring, sign in seat:
                    wrench = np.concatenate([sign * pair, np.zeros(4)])
                    still = ring.stands or self.speed == 0.0
                    for m, part in ({0: wrench} if still else into_rotor_frame(wrench)).items():
                        loads[n + m] = loads.get(n + m, 0.0) + ring.motion.T @ part
        return loads

    def coordinates(self, forces: Harmonics) -> dict[tuple[int, int], np.ndarray]:
        """Return the motion ``Re Σ x_kn exp i(kψ + nθ)``, k ≥ 0, in the rotor frame, (k,) each.

        `forces` are g.
        """
        found = {}
        for k in range(max(k for k, _ in forces) + 1):
            loads = self.pulled(
                {n: (2.0 if k else 1.0) * g for (j, n), g in forces.items() if j == k}
            )
            if k == 0:
                for n, load in self.loads.items():
                    loads[n] = loads.get(n, 0.0) + load
            moved = self._solved(loads, k * self.passing) if loads else {}  # else no force at all
            found.update({(k, n): x for n, x in moved.items()})
        return found

    def _solved(self, loads: Mapping[int, np.ndarray], rate: float) -> dict[int, np.ndarray]:
        return self.space.steady_motion(self.speed, loads, rate, _HARMONICS)

    @cached_property
    def _rings(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Motions of all rings (6p, k), which of them stand (p,), and signs by seat (s, p)."""
        rings = [ring for seat in self.seats for ring, _ in seat]
        signs = la.block_diag(*([[sign for _, sign in seat]] for seat in self.seats))
        return (
            np.vstack([ring.motion for ring in rings]),
            np.array([ring.stands for ring in rings]),
            signs,
        )

    def _seen(self, answer: Motion) -> dict[int, np.ndarray]:
        """Return the motions (…, d) of the inner rings against the outer ones, inertial axes.

        Of motions (…, k) in the rotor frame.
        """
        rows, stands, signs = self._rings
        motion = {n: (x @ rows.T).reshape(*x.shape[:-1], -1, 6) for n, x in answer.items()}
        if self.speed != 0.0:
            motion = in_frame(motion, stands, "inertial")
        return {
            n: (signs @ each[..., :2]).reshape(*each.shape[:-2], -1) for n, each in motion.items()
        }
