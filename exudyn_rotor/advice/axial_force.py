"""Axial force of a run over the load at which the shaft buckles.

Axial forces at the interfaces are found from the loads on the modes. Between interfaces the shaft
bends as their deflections and rotations say, by cubic lines, so that a tension N between them has
the stiffness ``N ∫ v'² dz``. Beside it the elastic stiffness of the modes tells the buckling load
of the shaft, as if hinged where the forces act.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la

from exudyn_rotor.advice.run_loads import external_load, instants, turned
from exudyn_rotor.multibody.rotor.record import Record
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.reduction.fields import ModeKind
from exudyn_rotor.theory.rotating_axes import axes_of

_LOOKED_AT = 20  # instants
_UNKNOWN = 1e-6  # of the largest: forces that the modes do not show
_BENT = np.array([[36, 3, -36, 3], [3, 4, -3, -1], [-36, -3, 36, -3], [3, -1, -3, 4]]) / 30.0


def axial_share(body: RotorBody, record: Record, size: float) -> float | None:
    """Return the largest axial force over the buckling load; None where the modes show none.

    Less what the prestress of the rotor has of it. `size` [m] makes forces and moments comparable.
    """
    source, T = body.selection.source, body.selection.T
    if len(source.interfaces) < 2 or len(record.time) < 2:
        return None
    axes, order = axes_of(source.axis), []
    for one in source.interfaces.values():
        motion = np.vstack([axes.T @ one.motion[:3], axes.T @ one.motion[3:]]) @ T
        order.append((float(one.reference @ source.axis.direction), motion))
    order.sort(key=lambda each: each[0])
    places, motions = np.array([each[0] for each in order]), [each[1] for each in order]
    forces = [_axial_forces(body, record, i, motions, size) for i in
              instants(record, _LOOKED_AT)]  # fmt: skip
    tension = -np.cumsum(forces, axis=1)[:, :-1]
    shares = [_share(body, _stiffness(places, motions, each)) for each in tension]
    return max(shares)


def _axial_forces(
    body: RotorBody, record: Record, index: int, motions: list[np.ndarray], size: float
) -> np.ndarray:
    """Return the axial forces at the interfaces (p,) at an instant [N]."""
    motion, unit = body.motion, np.repeat([1.0, 1.0 / size], 3)
    external = external_load(body, record, index)[1]
    e = turned(body, record.q[index]) @ motion.invariants.direction
    total = e @ (motion.free_directions @ external[motion.translations])
    columns = np.hstack([(unit[:, None] * U).T for U in motions])
    loads = external[motion.modes]
    if body.formulation.translation_count == 3:
        sums = np.tile([0.0, 0.0, 1.0, 0.0, 0.0, 0.0], len(motions))
        columns, loads = np.vstack([columns, sums]), np.append(loads, total)
    found = np.linalg.lstsq(columns, loads, rcond=_UNKNOWN)[0]
    return found.reshape(-1, 6)[:, 2]


def _stiffness(places: np.ndarray, motions: list[np.ndarray], tension: np.ndarray) -> np.ndarray:
    """Return the stiffness (m, m) of tensions (p − 1,) between interfaces."""
    K = np.zeros((motions[0].shape[1],) * 2)
    for left, right, L, N in zip(motions[:-1], motions[1:], np.diff(places), tension, strict=True):
        if L <= 0.0:
            continue
        arm = np.array([1.0, L, 1.0, L])
        for across, about, sign in ((0, 4, 1.0), (1, 3, -1.0)):
            v = np.stack([left[across], sign * left[about], right[across], sign * right[about]])
            K += N / L * v.T @ (np.outer(arm, arm) * _BENT) @ v
    return K


def _share(body: RotorBody, geometric: np.ndarray) -> float:
    """Return the largest size of a geometric stiffness over the elastic one, without tilts."""
    inv = body.selection.invariants
    if inv.K0 is not None and body.plan.setup.stiffening != "none":
        geometric = geometric - inv.K0
    elastic = np.array([kind is ModeKind.ELASTIC for kind in body.selection.kinds])
    flexible = elastic & (np.diag(inv.K) > 0.0)
    if not np.any(flexible):
        return 0.0
    f, r = np.flatnonzero(flexible), np.flatnonzero(~flexible)
    coupling = geometric[np.ix_(f, r)]
    rest = np.linalg.pinv(geometric[np.ix_(r, r)], rcond=1e-9, hermitian=True)
    reduced = geometric[np.ix_(f, f)] - coupling @ rest @ coupling.T
    values = la.eigh(reduced, inv.K[np.ix_(f, f)], eigvals_only=True)
    return float(np.abs(values).max())
