"""Axial force of a run over the load at which the shaft buckles.

Axial forces at the interfaces are found from the loads on the modes. Between interfaces the shaft
bends as their deflections and rotations say, by cubic lines, so that a tension N between them has
the stiffness ``N ∫ v'² dz``. Beside it the elastic stiffness of the modes tells the buckling load
of the shaft, as if hinged where the forces act. Of a full body the tensions follow from how far its
interfaces part along the axis, and the stiffness is that of their stress in the solid.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la

from exudyn_rotor.advice.run_loads import instants, interface_loads
from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.rotor.rotor_body import Record, RotorBody
from exudyn_rotor.prestress.given_loads import HeldRotor
from exudyn_rotor.prestress.static_solution import stress_stiffness
from exudyn_rotor.reduction.reduced_rotor import ModeKind
from exudyn_rotor.solvers.inertia_relief import inertia_relief
from exudyn_rotor.theory.rotating_axes import axes_of

_LOOKED_AT = 20  # instants
_INDEPENDENT = 1e-6  # share of the largest elongation: interfaces at one place part by none
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


def axial_share_of_full(body: FullRotorBody, record: Record) -> float | None:
    """Return the same of a full body, when its tensions are largest; None without elements."""
    rotor, e = body.selection.source, body.axis.direction
    if rotor.elements is None or len(rotor.interfaces) < 2 or len(record.time) < 2:
        return None
    seats = sorted(rotor.interfaces.values(), key=lambda one: one.reference @ e)
    along = np.vstack([e @ one.mean_motion(rotor.node_count)[:3] for one in seats])
    apart = np.diff(along, axis=0)
    relief = inertia_relief(rotor)
    pulled = relief.solve(apart.T)
    by_spin = apart @ relief.solve(rotor.centrifugal_load)
    moved = record.q[:, body.layout.unknowns][:, body.motion.modes]
    parted = apart @ moved.T - np.outer(by_spin, record.speed**2)
    tensions = np.linalg.lstsq(apart @ pulled, parted, rcond=_INDEPENDENT)[0]
    largest = tensions[:, np.argmax(np.abs(tensions).max(axis=0))]
    geometric = stress_stiffness(rotor, pulled @ largest)
    given = getattr(rotor.carried_prestress, "by_loads", None)
    if given is not None and body.stiffening != "none":
        geometric = geometric - given
    return float(np.abs(HeldRotor(rotor, (), relief).buckling_shares(geometric)).max())
