"""Equilibrium of rotors on linear and nonlinear bearings under loads that stand still.

With the stiffness K of rotors and linear supports, the loads f, and forces R of the other bearings
on journals that move by ``u = U y``, Newton's method solves both equations together,

    K y − Σ Uᵀ R = f,    A u + A_s u_s + B R = c  (:mod:`exudyn_rotor.bearings.resting`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from exudyn_rotor.bearings.resting import (
    HELD,
    UNLOADED,
    Nonlinear,
    Resting,
    RigidBearing,
    resting,
    starting_place,
)
from exudyn_rotor.linear.equations import UnconvergedError, others
from exudyn_rotor.linear.solve.forced import static_motion

_MOST, _CONVERGED = 100, 1e-10  # of Newton's steps; of the largest force and place
_SLOW = 15  # steps from which they are halved: contacts that open and close by turns
_RIGID = 1e-7  # compliance of a rigid bearing, over that of the rotor's highest mode
_SHORTEST = 1e-6  # share of a step below which a film is taken not to carry


class Journal(NamedTuple):
    """A nonlinear bearing at its speed [rad/s], and what it acts on, along (n1, n2).

    Motions (2, k) of the journal in the bearing, and of its sensor.
    """

    bearing: Nonlinear
    speed: float
    U: np.ndarray
    U_s: np.ndarray


def equilibrium(
    K: np.ndarray, load: np.ndarray, journals: Sequence[Journal], driven: np.ndarray
) -> tuple[np.ndarray | None, np.ndarray]:
    """Return the coordinates (k,), and the forces of the journals' bearings on them (b, 2) [N].

    None for the coordinates where a load acts on a motion that nothing holds. Drives hold the spins
    with the momenta `driven` (k, d). The search begins with journals held in the centre.
    """
    basis = others(driven)
    K, load = basis.T @ K @ basis, basis.T @ load
    journals = [one._replace(U=one.U @ basis, U_s=one.U_s @ basis) for one in journals]
    begin = [HELD if one.bearing.carries else UNLOADED for one in journals]
    y, R = _solved(K, load, journals, begin)
    if y is None or all(isinstance(one.bearing, RigidBearing) for one in journals):
        return (None if y is None else basis @ y), R
    pairs = zip(journals, R, strict=True)
    places = [(starting_place(one.bearing, one.speed, F), one.U_s @ y) for one, F in pairs]
    equations = _equations(journals, places, R)
    for step in range(_MOST):
        new_y, new_R = _solved(K, load, journals, equations)
        if new_y is None:
            return None, R
        share = 1.0 if step < _SLOW else 0.5
        while True:
            tried, forces = y + share * (new_y - y), R + share * (new_R - R)
            places = [(one.U @ tried, one.U_s @ tried) for one in journals]
            try:
                equations = _equations(journals, places, forces)
                break
            except (ValueError, ArithmeticError):
                share *= 0.5
                if share < _SHORTEST:
                    raise
        changes = [(forces - R, forces)]
        changes += [(one.U @ (tried - y), one.U @ tried) for one in journals]
        y, R = tried, forces
        # the first equations are those of journals in the centre
        if step and all(
            np.abs(d).max() <= _CONVERGED * np.abs(x).max(initial=1e-12) for d, x in changes
        ):
            return basis @ y, R
    raise UnconvergedError(
        f"static_response: no equilibrium found in {_MOST} steps; a bearing with clearance or at "
        "the end of its film may have none under these loads"
    )


def _equations(journals: Sequence[Journal], places: Sequence, forces: np.ndarray) -> list[Resting]:
    """Return the equations of bearings at places of journals and sensors, and forces."""
    return [
        resting(one.bearing, one.speed, u, u_s, R)
        for one, (u, u_s), R in zip(journals, places, forces, strict=True)
    ]


def _solved(
    K: np.ndarray,
    load: np.ndarray,
    journals: Sequence[Journal],
    equations: Sequence[Resting],
) -> tuple[np.ndarray | None, np.ndarray]:
    """Return coordinates and forces of the linear equations, forces in units of a stiffness."""
    k, count = len(K), 2 * len(journals)
    most = max((np.abs(one.U).max(initial=0.0) for one in journals), default=0.0)
    unit = max(np.abs(K).max(initial=0.0), 1.0) / (most or 1.0)
    A, b = np.zeros((k + count, k + count)), np.zeros(k + count)
    A[:k, :k], b[:k] = K, load
    for i, ((*_, U, U_s), one) in enumerate(zip(journals, equations, strict=True)):
        own = slice(k + 2 * i, k + 2 * i + 2)
        # the equation of a compliance counts as many times as its forces do
        scale = unit if np.array_equal(one.A + one.A_s, np.eye(2)) else 1.0
        A[:k, own] = -unit * U.T
        A[own, :k] = -scale * (one.A @ U + one.A_s @ U_s)
        A[own, own] = -scale * unit * one.B
        if one.is_rigid:
            A[own, own] -= _RIGID * unit * (most or 1.0) * np.eye(2)
        b[own] = -scale * one.c
    x = static_motion(A, b)
    if np.any(np.isnan(x)):
        return None, np.zeros((len(journals), 2))
    return x[:k], unit * x[k:].reshape(-1, 2)
