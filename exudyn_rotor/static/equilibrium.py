"""Equilibrium of rotors on linear and nonlinear bearings under loads that stand still.

With the stiffness K of rotors and linear supports, the loads f, and forces R of the other bearings
on journals that move by ``u = U y``, Newton's method solves both equations together,

    K y − Σ Uᵀ R = f,    A u + B R = c  (:mod:`exudyn_rotor.static.resting`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from exudyn_rotor.bearings.rolling import RollingBearing
from exudyn_rotor.linear.equations import UnconvergedError, others
from exudyn_rotor.linear.solve.forced import static_motions
from exudyn_rotor.static.resting import HELD, UNLOADED, Nonlinear, Resting, resting

_MOST, _CONVERGED = 100, 1e-8  # of Newton's steps; of the largest force, of each place
_LEAST = 1e-3  # of the largest place: a smaller one, as in a rigid bearing, is rounding of it
_SLOW = 15  # steps from which they are halved: contacts that open and close by turns
_RIGID = 1e-7  # compliance of a rigid bearing, over that of the rotor's highest mode
_SHORTEST = 1e-6  # share of a step below which a film is taken not to carry


class Journals(NamedTuple):
    """Nonlinear bearings (b) at their speeds [rad/s], and the motions (b, 2, k) of the journals."""

    bearings: Sequence[Nonlinear]
    speeds: Sequence[float]
    U: np.ndarray

    def resting(self, *at: np.ndarray) -> list[Resting]:
        """Return the equations beside places of journals and forces, each (b, 2)."""
        return [resting(*each) for each in zip(self.bearings, self.speeds, *at, strict=True)]


def equilibrium(
    K: np.ndarray, load: np.ndarray, journals: Journals, driven: np.ndarray
) -> tuple[np.ndarray | None, np.ndarray]:
    """Return the coordinates (k,), and the forces of the bearings on journals (b, 2) [N].

    None for the coordinates where a load acts on a motion that nothing holds. Drives hold the spins
    with the momenta `driven` (k, d). The search begins with journals held in the centre.
    """
    basis, (bearings, speeds, U) = others(driven), journals
    K, load, U = basis.T @ K @ basis, basis.T @ load, U @ basis
    y, R = _solved(K, load, U, [HELD if one.carries else UNLOADED for one in bearings])
    if y is None or not bearings:
        return (None if y is None else basis @ y), R
    begin = np.zeros_like(R)
    for i, one in enumerate(bearings):
        if isinstance(one, RollingBearing) and np.any(R[i]):  # in contact
            begin[i] = one.equilibrium(speeds[i], -R[i])
    equations = journals.resting(begin, R)
    for step in range(_MOST):
        new_y, new_R = _solved(K, load, U, equations)
        if new_y is None:
            return None, R
        share = 1.0 if step < _SLOW else 0.5
        while True:
            tried, forces = y + share * (new_y - y), R + share * (new_R - R)
            try:
                equations = journals.resting(U @ tried, forces)
                break
            except (ValueError, ArithmeticError):
                share *= 0.5
                if share < _SHORTEST:
                    raise
        moves, places = U @ (tried - y), U @ tried
        least = _LEAST * np.abs(places).max(initial=1e-9)
        is_found = _is_small(forces - R, forces, least) and all(
            _is_small(*each, least) for each in zip(moves, places, strict=True)
        )
        y, R = tried, forces
        if step and is_found:  # the first equations are those of journals in the centre
            return basis @ y, R
    raise UnconvergedError(
        f"static_response: no equilibrium found in {_MOST} steps; a bearing with clearance or at "
        "the end of its film may have none under these loads"
    )


def _is_small(change: np.ndarray, value: np.ndarray, least: float) -> bool:
    return bool(np.abs(change).max() <= _CONVERGED * np.abs(value).max(initial=least))


def _solved(
    K: np.ndarray, load: np.ndarray, U: np.ndarray, equations: Sequence[Resting]
) -> tuple[np.ndarray | None, np.ndarray]:
    """Return coordinates and forces of the linear equations, forces in units of a stiffness."""
    k, count = len(K), 2 * len(U)
    most = np.abs(U).max(initial=0.0) or 1.0
    # forces over it are as large as coordinates, so that rounding of the one spares the other
    yielding = [one for one in equations if np.any(one.B)]
    bearing = max((np.abs(one.A).max() / np.abs(one.B).max() for one in yielding), default=0.0)
    unit = max(np.abs(K).max(initial=0.0) / most, bearing * most, 1.0 / most)
    A, b = np.zeros((k + count, k + count)), np.zeros(k + count)
    A[:k, :k], A[:k, k:], b[:k] = K, -unit * U.reshape(count, k).T, load
    for i, one in enumerate(equations):
        own = slice(k + 2 * i, k + 2 * i + 2)
        # the equation of a compliance counts as many times as its forces do
        scale = unit if np.array_equal(one.A, np.eye(2)) else 1.0
        A[own, :k] = -scale * one.A @ U[i]
        A[own, own] = -scale * unit * one.B - one.is_rigid * _RIGID * unit * most * np.eye(2)
        b[own] = -scale * one.c
    x = static_motions(A[None], b[None, :, None])[0, :, 0]
    if np.any(np.isnan(x)):
        return None, np.zeros((len(U), 2))
    return x[:k], unit * x[k:].reshape(-1, 2)
