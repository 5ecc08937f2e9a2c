"""What the basis of a reduced rotor leaves out of critical speeds.

As in :mod:`exudyn_rotor.linear.models.basis.left_out`, by one inverse iteration with the shapes
that lack first, of the undamped ``H(Ω) = Z(ifΩ, Ω)``, which is close to quadratic in Ω. Critical
speeds that lie close are moved together, from their mean Ω: of

    Z = H⁻¹ H' X,   W = H⁻¹ M X,   Wᴴ[H + δ H' + δ² H''/2]Z y = 0

with all their motions X, each root δ is a critical speed Ω + δ in both, and Zy its motion, which
tells by its likeness to X whose it is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment

from exudyn_rotor.linear.models.basis.left_out import LeftOut
from exudyn_rotor.linear.models.protocol import LinearModel
from exudyn_rotor.linear.periodic.harmonics import dynamic_stiffness
from exudyn_rotor.linear.periodic.inverse_iteration import OFF_ROOT, nearest_root

_FREE = 1e-6  # of the inertia at the speed: a stiffness that leaves a motion free
_STEP = 1e-3  # of differences by the speed, relative
_CLOSE = 1e-2  # relative distance of critical speeds that are moved together
# MAC of motions that are surely one, and of those that may be
_SURE, _PERHAPS = 0.8, 0.2


class CriticalMotion(NamedTuple):
    """A critical speed [rad/s], and harmonics (h, k) of its motion at `multiples` (h,) of it."""

    speed: float
    multiples: np.ndarray
    vectors: np.ndarray


class _Dynamic(NamedTuple):
    """H and its derivatives H' and H''/2 by the speed, and M, at one speed."""

    H: np.ndarray
    slope: np.ndarray
    square: np.ndarray
    M: np.ndarray

    def among(self, held: np.ndarray) -> _Dynamic:
        """Return the matrices of some coordinates."""
        rows = held[:, None]
        return _Dynamic(*(matrix[rows, held] for matrix in self))


def critical_shifts(
    left_out: LeftOut, critical: Sequence[CriticalMotion]
) -> tuple[np.ndarray, np.ndarray]:
    """Return the estimated critical speeds without what the basis leaves out, and their errors.

    Both (n,) [rad/s]. The error is the distance of the two, or the largest that it may be where
    the motions of several speeds do not tell which is which.
    """
    speeds = np.array([motion.speed for motion in critical])
    errors = np.zeros(len(critical))
    lacking = left_out.finer.lacking
    if not np.any(lacking):
        return speeds, errors
    for columns in _of_the_same_harmonics(critical):
        multiples, fastest = critical[columns[0]].multiples, speeds[columns].max()
        dynamic = _around(left_out.equations, multiples, fastest)
        for group in _close(columns, speeds):
            x = np.zeros((len(multiples), len(lacking), len(group)), dtype=complex)
            x[:, ~lacking] = np.stack([critical[i].vectors for i in group], axis=2)
            x = x.reshape(-1, len(group))
            speeds[group], errors[group] = _moved(dynamic, speeds[group], x)
    return speeds, errors


def _of_the_same_harmonics(critical: Sequence[CriticalMotion]) -> list[list[int]]:
    alike: dict[bytes, list[int]] = {}
    for index, motion in enumerate(critical):
        alike.setdefault(motion.multiples.tobytes(), []).append(index)
    return list(alike.values())


def _close(columns: list[int], speeds: np.ndarray) -> Iterator[list[int]]:
    """Yield groups of columns whose speeds are close to the lowest of them."""
    left = sorted(columns, key=speeds.__getitem__)
    while left:
        count = int(np.searchsorted(speeds[left], (1.0 + _CLOSE) * speeds[left[0]], side="right"))
        yield left[:count]
        left = left[count:]


def _around(
    equations: LinearModel, multiples: np.ndarray, fastest: float
) -> Callable[[float], _Dynamic]:
    """Return the dynamic stiffness as a function of the speed."""

    def at(speed: float) -> tuple[np.ndarray, np.ndarray]:
        return dynamic_stiffness(equations.at(speed), multiples)

    if equations.stiffness_varies:
        return lambda speed: _by_differences(at, speed)
    at_rest, (moving, M) = at(0.0)[0], at(fastest)
    B = (moving - at_rest) / fastest**2
    return lambda speed: _Dynamic(at_rest + speed**2 * B, 2.0 * speed * B, B, M)


def _by_differences(at: Callable[[float], tuple[np.ndarray, np.ndarray]], speed: float) -> _Dynamic:
    step = _STEP * speed
    low, high, (H, M) = at(speed - step)[0], at(speed + step)[0], at(speed)
    slope, square = (high - low) / (2.0 * step), (high - 2.0 * H + low) / (2.0 * step**2)
    return _Dynamic(H, slope, square, M)


def _moved(
    dynamic: Callable[[float], _Dynamic], speeds: np.ndarray, x: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return :func:`critical_shifts` of speeds (g,) that lie close, with motions (n, g)."""
    center = float(speeds.mean()) * (1.0 + OFF_ROOT)
    given = dynamic(center)
    inertia = center**2 * given.M.diagonal().real
    # free rigid motions have neither stiffness nor, where they stand still, inertia
    sizes = np.maximum(np.abs(given.H), center * np.abs(given.slope)).max(axis=1)
    held = np.flatnonzero(sizes > _FREE * inertia)
    given, x = given.among(held), x[held]
    forces, momenta = given.slope @ x, given.M @ x
    answers = np.linalg.solve(given.H, np.hstack([forces, momenta]))
    z, w = answers[:, : len(speeds)], answers[:, len(speeds) :]
    adjoint = w.conj().T
    constant = adjoint @ forces
    linear, square = (adjoint @ X @ z for X in (given.slope, given.square))
    if len(speeds) == 1:
        moved = center + nearest_root(square[0], linear[0], constant[0]).real
        return moved, np.abs(moved - speeds)
    roots, y = np.linalg.eig(-np.linalg.pinv(linear) @ constant)
    bend = np.einsum("jk,kj->j", np.linalg.pinv(linear @ y), square @ y)
    moved = center + nearest_root(bend, np.ones_like(bend), -roots).real
    return _assigned(speeds, moved, _likeness(x, momenta, z @ y, given.M))


def _likeness(x: np.ndarray, momenta: np.ndarray, z: np.ndarray, M: np.ndarray) -> np.ndarray:
    """Return the MAC of motions x with motions z, by mass."""
    lengths = (np.einsum("kj,kj->j", a.conj(), b).real for a, b in ((x, momenta), (z, M @ z)))
    return np.abs(momenta.conj().T @ z) ** 2 / np.outer(*lengths)


def _assigned(
    speeds: np.ndarray, moved: np.ndarray, mac: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return what each of the speeds becomes, and by how much it changes at most."""
    _, chosen = linear_sum_assignment(-mac)
    apart = np.abs(moved - speeds[:, None])
    own = np.take_along_axis(apart, chosen[:, None], axis=1)[:, 0]
    unsure = np.take_along_axis(mac, chosen[:, None], axis=1)[:, 0] < _SURE
    perhaps = np.max(apart, axis=1, where=mac > _PERHAPS, initial=0.0)
    return moved[chosen], np.where(unsure, np.maximum(own, perhaps), own)
