"""Axial force of a run over the load at which the shaft buckles.

Between interfaces the shaft bends as their deflections and rotations say, by cubic lines, so that a
tension N between them has the stiffness ``N ∫ v'² dz``. Beside it the elastic stiffness of the
modes tells the buckling load of the shaft, as if hinged where the forces act. Of a full body the
tensions follow from how far its interfaces part along the axis, and the stiffness is that of their
stress in the solid.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la

from exudyn_rotor.advice.recorded_run import RecordedRun
from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.prestress.given_loads import HeldRotor
from exudyn_rotor.prestress.static_solution import stress_stiffness
from exudyn_rotor.solid.places import OF_RADIUS
from exudyn_rotor.solvers.inertia_relief import inertia_relief
from exudyn_rotor.theory.rotating_axes import axes_of

_LOOKED_AT = 20  # instants
_INDEPENDENT = 1e-6  # share of the largest elongation: interfaces at one place part by none
_BENT = np.array([[36, 3, -36, 3], [3, 4, -3, -1], [-36, -3, 36, -3], [3, -1, -3, 4]]) / 30.0


def axial_share(run: RecordedRun) -> float | None:
    """Return the largest axial force over the buckling load; None where a run shows none.

    Less what the prestress of the rotor has of it.
    """
    source = run.body.selection.source
    if len(source.interfaces) < 2 or len(run.record.time) < 2:
        return None
    if isinstance(run.body, FullRotorBody):
        return _share_of_full(run)
    seats, e = list(source.interfaces.values()), source.axis.direction
    places = np.array([one.reference @ e for one in seats])
    order, turn = np.argsort(places, kind="stable"), np.kron(np.eye(2), axes_of(source.axis).T)
    motions = [turn @ seats[i].motion @ run.body.selection.T for i in order]
    forces = (e @ run.loads[order, :3]).T
    some = np.linspace(0, len(forces) - 1, _LOOKED_AT).astype(int)
    tensions = -np.cumsum(forces[np.unique(some)], axis=1)[:, :-1]
    near = OF_RADIUS * max(one.radius for one in seats)
    return max(_share(run, _stiffness(places[order], motions, each, near)) for each in tensions)


def _stiffness(
    places: np.ndarray, motions: list[np.ndarray], tension: np.ndarray, near: float
) -> np.ndarray:
    """Return the stiffness (m, m) of tensions (p − 1,) between interfaces that are not `near`."""
    K = np.zeros((motions[0].shape[1],) * 2)
    for left, right, L, N in zip(motions[:-1], motions[1:], np.diff(places), tension, strict=True):
        if near >= L:
            continue
        arm = np.array([1.0, L, 1.0, L])
        for across, about, sign in ((0, 4, 1.0), (1, 3, -1.0)):
            v = np.stack([left[across], sign * left[about], right[across], sign * right[about]])
            K += N / L * v.T @ (np.outer(arm, arm) * _BENT) @ v
    return K


def _share(run: RecordedRun, geometric: np.ndarray) -> float:
    """Return the largest size of a geometric stiffness over the elastic one, without tilts."""
    inv, f = run.body.selection.invariants, run.flexible
    if inv.K0 is not None and run.body.stiffening != "none":
        geometric = geometric - inv.K0
    if not f.size:
        return 0.0
    r = np.setdiff1d(np.arange(inv.size), f)
    coupling = geometric[np.ix_(f, r)]
    rest = np.linalg.pinv(geometric[np.ix_(r, r)], rcond=1e-9, hermitian=True)
    reduced = geometric[np.ix_(f, f)] - coupling @ rest @ coupling.T
    values = la.eigh(reduced, inv.K[np.ix_(f, f)], eigvals_only=True)
    return float(np.abs(values).max())


def _share_of_full(run: RecordedRun) -> float | None:
    """Return the share of a full body, when its tensions are largest; None without elements."""
    rotor, e = run.body.selection.source, run.body.axis.direction
    if rotor.elements is None:
        return None
    seats = sorted(rotor.interfaces.values(), key=lambda one: one.reference @ e)
    along = np.vstack([e @ one.mean_motion(rotor.node_count)[:3] for one in seats])
    apart = np.diff(along, axis=0)
    relief = inertia_relief(rotor)
    pulled = relief.solve(apart.T)
    by_spin = apart @ relief.solve(rotor.centrifugal_load)
    parted = apart @ run.zeta.T - np.outer(by_spin, run.record.speed**2)
    tensions = np.linalg.lstsq(apart @ pulled, parted, rcond=_INDEPENDENT)[0]
    largest = tensions[:, np.argmax(np.abs(tensions).max(axis=0))]
    geometric = stress_stiffness(rotor, pulled @ largest)
    given = getattr(rotor.carried_prestress, "by_loads", None)
    if given is not None and run.body.stiffening != "none":
        geometric = geometric - given
    return float(np.abs(HeldRotor(rotor, (), relief).buckling_shares(geometric)).max())
