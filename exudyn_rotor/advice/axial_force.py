"""Axial force of a run over the load at which the shaft buckles.

Axial forces at the interfaces are found from the loads on the modes. Between interfaces the shaft
bends as their deflections and rotations say, by cubic lines, so that a tension N between them has
the stiffness ``N ∫ v'² dz``. Beside it the elastic stiffness of the modes tells the buckling load
of the shaft, as if hinged where the forces act.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la

from exudyn_rotor.advice.run_loads import instants, interface_loads
from exudyn_rotor.multibody.rotor.record import Record
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.reduction.reduced_rotor import ModeKind
from exudyn_rotor.theory.rotating_axes import axes_of

_LOOKED_AT = 20  # instants
_BENT = np.array([[36, 3, -36, 3], [3, 4, -3, -1], [-36, -3, 36, -3], [3, -1, -3, 4]]) / 30.0


def axial_share(body: RotorBody, record: Record, size: float) -> float | None:
    """Return the largest axial force over the buckling load; None where the modes show none.

    Less what the prestress of the rotor has of it. `size` [m] makes forces and moments comparable.
    """
    source = body.selection.source
    if len(source.interfaces) < 2 or len(record.time) < 2:
        return None
    loads = interface_loads(body, record, instants(record, _LOOKED_AT), size)
    if loads is None:
        return None
    axes, interfaces = axes_of(source.axis), list(source.interfaces.values())
    places = np.array([one.reference @ source.axis.direction for one in interfaces])
    order = np.argsort(places, kind="stable")
    motions = [
        np.vstack([axes.T @ part for part in np.split(interfaces[i].motion, 2)]) @ body.selection.T
        for i in order
    ]
    forces = np.einsum("a,pas->sp", source.axis.direction, loads[order, :3])
    tensions = -np.cumsum(forces, axis=1)[:, :-1]
    return max(_share(body, _stiffness(places[order], motions, each)) for each in tensions)


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
    if inv.K0 is not None and body.stiffening != "none":
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
