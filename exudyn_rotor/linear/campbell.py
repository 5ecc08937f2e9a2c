"""Eigenfrequencies over spin speed in the rotor frame (Campbell diagram)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import ArrayLike
from tqdm import tqdm

from exudyn_rotor.invariants import Invariants
from exudyn_rotor.reduced import ReducedRotor
from exudyn_rotor.solid.rotor import SolidRotor
from exudyn_rotor.stiffening import stiffening as second_order

_DENSE_LIMIT = 1500


@dataclass(frozen=True, eq=False)
class Campbell:
    """Eigenfrequencies over spin speed.

    Attributes
    ----------
    speeds : ndarray, shape (s,)
        Spin speeds [rad/s].
    frequencies_rotating : ndarray, shape (s, k)
        Natural frequencies seen in the rotor frame, ascending [rad/s].
    growth : ndarray, shape (s, k)
        Real parts of the eigenvalues [1/s]; positive means unstable.
    """

    speeds: np.ndarray
    frequencies_rotating: np.ndarray
    growth: np.ndarray


def campbell(
    rotor: ReducedRotor | SolidRotor,
    speeds: ArrayLike,
    *,
    stiffening: str = "tilt",
    progress: bool = False,
) -> Campbell:
    """Compute the eigenfrequencies of an unsupported or grounded rotor over spin speed.

    Solves ``(λ²M + λ(D + 2ΩG) + K + Ω²(K2 − C)) x = 0``, the homogeneous Eq. (105) or (109) with
    centrifugal stiffening, for all modes including the rigid ones. Every conjugate pair counts
    once, and so does every pair of real eigenvalues.

    Parameters
    ----------
    rotor : ReducedRotor or SolidRotor
        The full model is solved densely and may have up to 1500 degrees of freedom.
    speeds : array_like, shape (s,)
        Spin speeds [rad/s].
    stiffening : {'tilt', 'none'}
    progress : bool, optional
        Show a progress bar.

    Raises
    ------
    ValueError
        If speeds are not finite, or the full model is too large.
    """
    values = np.atleast_1d(np.asarray(speeds, dtype=float))
    if values.ndim != 1 or values.size == 0 or not np.all(np.isfinite(values)):
        raise ValueError(f"speeds: needs a list of finite numbers [rad/s], got {speeds!r}")
    invariants = _invariants(rotor)
    K2 = second_order(invariants, stiffening).K2
    M, K, D, G, C = (getattr(invariants, name) for name in ("M", "K", "D", "G", "C"))
    solved = [
        _eigenvalues(M, D + 2.0 * speed * G, K + speed**2 * (K2 - C))
        for speed in tqdm(values, desc="Campbell", disable=not progress)
    ]
    eigenvalues = np.array(solved)
    return Campbell(values, np.abs(eigenvalues.imag), eigenvalues.real)


def _invariants(rotor: ReducedRotor | SolidRotor) -> Invariants:
    """Return dense invariants about the foot of the centre of mass on the axis."""
    if isinstance(rotor, ReducedRotor):
        origin = rotor.axis.project(rotor.center_of_mass)
        return rotor.invariants.moved(origin - rotor.center_of_mass)
    size = 3 * rotor.node_count
    if size > _DENSE_LIMIT:
        raise ValueError(
            f"campbell: the full model has {size} degrees of freedom, more than {_DENSE_LIMIT}; "
            "reduce the rotor first"
        )
    origin = rotor.axis.project(rotor.center_of_mass)
    return Invariants.of(
        rotor.nodes - origin,
        rotor.mass.toarray(),
        rotor.stiffness.toarray(),
        None if rotor.damping is None else rotor.damping.toarray(),
        np.eye(size),
        rotor.axis.direction,
    )


def _eigenvalues(M: np.ndarray, D: np.ndarray, K: np.ndarray) -> np.ndarray:
    """Return one eigenvalue of each pair of ``λ²M + λD + K``, ascending in frequency."""
    size = len(M)
    factor = scipy.linalg.cho_factor(M)
    state = np.block(
        [
            [np.zeros((size, size)), np.eye(size)],
            [-scipy.linalg.cho_solve(factor, K), -scipy.linalg.cho_solve(factor, D)],
        ]
    )
    values = np.linalg.eigvals(state)
    upper = values[np.argsort(values.imag)][size:]
    return upper[np.lexsort((upper.real, upper.imag))]
